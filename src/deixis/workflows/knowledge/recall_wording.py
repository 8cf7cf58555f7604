"""Word the answers to questions about then and now, with the times and sources of the fluents that answer them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from datetime import datetime
from typing import TYPE_CHECKING

from deixis.answers import count
from deixis.memory.episodes.fluents.episode import Origin
from deixis.memory.episodes.predicates import (
    ACTS,
    AT,
    CONTRADICTED,
    EXPECTED,
    FAULT,
    IS_A,
    LAYOUT,
    MOVED,
    NAMED,
    PUT,
    SAID,
    SAME_AS,
    SAYS,
    TOOK,
)
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.kinds import with_article

if TYPE_CHECKING:
    from deixis.workflows.knowledge.recall_answer import Recall, Recalled


def sentence(found: Recall) -> str:
    """Return the answer to a question in words.

    Parameters
    ----------
    found
        The answer with its facts, of which there is at least one.

    Returns
    -------
    str
        A sentence.
    """
    question, facts = found.question, found.facts
    kind = question.kind
    if kind == "whether_there" and all(fact.fluent.statement.predicate == EXPECTED for fact in facts):
        sure = max(fact.fluent.certainty for fact in facts)
        statement = "; ".join(distinct(fact_words(found, fact) for fact in facts))
        return f"Probably{'' if sure >= 0.5 else ' not'}: {statement}."
    if kind in (
        "whether",
        "whether_there",
        "whether_did_by",
        "whether_called",
    ) and not question.text.lower().startswith("what"):
        return f"Yes: {'; '.join(fact_words(found, fact) for fact in facts)}."
    if kind == "how_many_did_by":
        number = len({fact.fluent.statement.object for fact in facts})
        return f"{number}: {'; '.join(distinct(fact_words(found, fact) for fact in facts))}."
    if kind == "how_often_by":
        sentences = distinct(fact_words(found, fact) for fact in facts)
        return f"{count(len(sentences), 'time')}: {'; '.join(sentences)}."
    if kind in ("how_many", "how_many_did", "how_many_shown"):
        number = len({fact.fluent.statement.subject for fact in facts})
        return f"{number}: {', '.join(sorted(distinct(definite(fact.name) for fact in facts)))}."
    if kind in ("who_there", "how_many_persons", "whether_present", "where_person"):
        persons = distinct(fact.fluent.statement.subject for fact in facts)
        sentences = [_presence(found, [each for each in facts if each.fluent.statement.subject == person])
                     for person in persons]  # fmt: skip
        starts = {"how_many_persons": f"{len(persons)}: ", "whether_present": "Yes: "}
        ending = "; the places of persons are not recorded" if kind == "where_person" else ""
        return f"{starts.get(kind, '')}{'; '.join(sentences)}{ending}."
    if kind in ("gone", "come", "moved", "when_did", "whether_did", "how_often"):
        words = {"gone": "went", "come": "came", "returned": "came back", "moved": "was moved", "shown": "was shown"}[
            question.event or kind
        ]
        edge = [fact.fluent.finish if words == "went" else fact.fluent.start for fact in facts]
        sentences = distinct(f"{definite(fact.name)} {words} {_time_phrase(found, end.lower, end.upper)}{_source(fact)}"
                         for fact, end in zip(facts, edge, strict=True))  # fmt: skip
        if kind == "how_often":
            return f"{count(len(sentences), 'time')}: {'; '.join(sentences)}."
        return f"Yes: {'; '.join(sentences)}." if kind == "whether_did" else _capital("; ".join(sentences))
    if kind in ("shown", "who", "said_about") and all(fact.fluent.statement.predicate in NAMED for fact in facts):
        sentences = distinct(
            f"{fact.fluent.source.by} {'showed' if fact.fluent.source.origin is Origin.SHOWN else 'spoke of'} "
            f"{definite(fact.name)} {_time_phrase(found, fact.fluent.start.lower, fact.fluent.start.upper)}"
            for fact in facts
        )
        return _capital("; ".join(sentences))
    return _capital("; ".join(distinct(fact_words(found, fact) for fact in facts)))


def distinct(parts: Iterable[str]) -> list[str]:
    """Return texts without those that came before.

    Parameters
    ----------
    parts
        The texts.

    Returns
    -------
    list of str
        The texts in their order, each once.
    """
    return list(dict.fromkeys(parts))


def _capital(text: str) -> str:
    """Return clauses as a sentence; an id such as ``t3`` at the beginning remains as it is."""
    first = text[0] if definite(text.split()[0]) == text.split()[0] else text[0].upper()
    return f"{first}{text[1:]}" + ("" if text.endswith(("?", "!")) else ".")


def fact_words(found: Recall, fact: Recalled) -> str:
    """Return a fluent in words: *the fork was on the plate from 12:00:01 to 12:03:05 (seen)*.

    Parameters
    ----------
    found
        The answer that the fluent belongs to, whose question has a time.
    fact
        The fluent with the names of its things.

    Returns
    -------
    str
        A clause.
    """
    statement, fluent = fact.fluent.statement, fact.fluent
    words = (statement.object or "").rstrip(".!")
    begins, ends, place = fluent.start, fluent.finish, fact.place
    if place is not None and place.relation == found.question.relation:
        begins, ends = place.start, place.finish
    is_open = math.isinf(ends.upper)
    start = "" if math.isinf(begins.lower) else f" from {_time(found, begins.lower, begins.upper)}"
    finish = "" if is_open else f" to {_time(found, ends.lower, ends.upper)}"
    since = f" since {_time(found, begins.lower, begins.upper)}" if start and is_open else ""
    verb = "has been" if since else "is" if is_open or ends.upper > found.asked else "was"
    if statement.predicate == SAYS:
        return f"the robot said at {_time(found, fluent.start.lower, fluent.start.upper)}: {words}"
    elif statement.predicate == SAID:
        return f"{fluent.source.by} said at {_time(found, fluent.start.lower, fluent.start.upper)}: {words}"
    elif statement.predicate == EXPECTED:
        sentence = f"{fluent.source.by} said at {_time(found, fluent.start.lower, fluent.start.upper)}: {words}"
        if not fluent.is_open:
            return f"{sentence}; expected until {_time(found, fluent.finish.lower, fluent.finish.upper)}"
        return f"{sentence}; {definite(fact.name)} has not been seen yet, probability {_certainty(fluent.certainty)}"
    elif statement.predicate in (CONTRADICTED, SAME_AS):
        then = f"at {_time(found, fluent.start.lower, fluent.start.upper)}"
        if statement.predicate == CONTRADICTED:
            return f"{definite(fact.name)} was not there {then}: {statement.object}{_source(fact)}"
        return f"{definite(fact.name)} was seen {then}: {statement.object}{_source(fact)}"
    elif statement.predicate in ACTS:
        time = _time_phrase(found, fluent.start.lower, fluent.start.upper)
        return f"{fact.name} {act_words(statement.predicate, fact.other or '')} {time}{_source(fact)}"
    elif statement.predicate == AT:
        text = f"{definite(fact.name)} {verb} there"
        if place is not None:
            where = f"{_phrase(place.relation)} {definite(place.other)}"
            if place.start.lower > begins.lower or place.finish.upper < ends.upper:  # the other thing came or went
                return f"{text}{since or start + finish}, {where}{_source(fact)}"
            text = f"{definite(fact.name)} {verb} {where}"
    elif statement.predicate == IS_A:
        text = f"{statement.subject} {verb} {with_article(fact.other or '')}"
    elif statement.predicate == LAYOUT:
        text = f"the layout {verb} '{statement.object}'"
    elif statement.predicate == FAULT:
        text = f"{words},"
    elif statement.predicate == "colour":
        text = f"{definite(fact.name)} {verb} {statement.object}"
    else:
        words = _phrase(statement.predicate)
        other = "" if fact.other is None else f" {definite(fact.other)}"
        text = f"{definite(fact.name)} {verb} {words}{other}"
    return f"{text}{since or start + finish}{_source(fact)}"


def act_words(act: str, thing: str) -> str:
    """Return what a person did with a thing.

    Parameters
    ----------
    act
        Predicate of the act.
    thing
        Name of the thing.

    Returns
    -------
    str
        A predicate such as *moved the fork*.
    """
    the_thing = definite(thing)
    return {PUT: f"put {the_thing} down", MOVED: f"moved {the_thing}", TOOK: f"took {the_thing} away"}[act]


def definite(name: str) -> str:
    """Return the name of a thing with the definite article; an id such as ``t3`` without one.

    Parameters
    ----------
    name
        Category of a thing in words, or its id.

    Returns
    -------
    str
        The name as it stands in a sentence.

    Examples
    --------
    >>> definite("dinner fork"), definite("t3")
    ('the dinner fork', 't3')
    """
    return name if re.fullmatch(r"[A-Za-z]+\d+", name) else f"the {name}"


def _presence(found: Recall, facts: list[Recalled]) -> str:
    """Return when a person was seen or heard: *Ada was seen and heard from 12:00:01 to 12:03:05*."""
    own = [
        fact for fact in facts if fact.fluent.statement.predicate == SAID or fact.fluent.source.origin != Origin.SAID
    ]
    facts = own or facts  # what others said about a person counts only where nothing else is known
    acts = [fact.fluent for fact in facts if fact.fluent.statement.predicate != SAID]
    ways = ["seen"] * any(act.source.origin is not Origin.SAID for act in acts)
    ways += ["heard"] * (len(acts) < len(facts))
    seen = " and ".join(ways) or f"there as {acts[0].source.by} said,"
    first = min((fact.fluent.start for fact in facts), key=lambda start: start.upper)
    last = max((fact.fluent.start for fact in facts), key=lambda start: start.upper)
    earliest, latest = (_time(found, each.lower, each.upper) for each in (first, last))
    time = _time_phrase(found, first.lower, first.upper) if earliest == latest else f"from {earliest} to {latest}"
    return f"{facts[0].fluent.statement.subject} was {seen} {time}"


ACT_DONE = {PUT: "put down", MOVED: "moved", TOOK: "taken away"}
"""Participles of acts."""


def _phrase(relation: str) -> str:
    """Return the words of a relation."""
    known = default_ontology().relations.get(relation)
    return known.phrase if known is not None else relation.replace("_", " ")


def _source(fact: Recalled) -> str:
    sure = "" if fact.fluent.certainty == 1 else f", certainty {_certainty(fact.fluent.certainty)}"
    source = fact.fluent.source
    by = f" by {source.by}" if source.origin in (Origin.SAID, Origin.SHOWN) else ""
    return f" ({source.origin.value}{by}{sure})"


def _certainty(certainty: float) -> str:
    """Return a certainty with two digits; 1 only where it is certain."""
    return f"{certainty if certainty == 1 else min(certainty, 0.99):.2g}"


def _time_phrase(found: Recall, lower: float, upper: float) -> str:
    """Return a time in words; for *how long ago …?* with the time that has passed."""
    time = f"at {_time(found, lower, upper)}" if lower == upper else _time(found, lower, upper)
    if not found.question.asks_how_long_ago or math.isinf(upper):
        return time
    return f"{time}, {_duration(found.asked - upper)} ago"


def _duration(seconds: float) -> str:
    """Return a duration in the one or two largest units: *1 hour 10 minutes*."""
    minutes, rest = divmod(max(round(seconds), 0), 60)
    hours, minutes = divmod(minutes, 60)
    days, hours = divmod(hours, 24)
    parts = [(days, "day"), (hours, "hour"), (minutes, "minute"), (rest, "second")]
    first = next((number for number, (amount, _) in enumerate(parts) if amount), len(parts) - 1)
    return " ".join(count(amount, unit) for amount, unit in parts[first : first + 2] if amount) or "0 seconds"


def _time(found: Recall, lower: float, upper: float) -> str:
    """Return a time within bounds in words."""
    first, last = found.moment(lower), found.moment(upper)
    present = found.moment(found.asked)
    assert present is not None
    if first is not None and last is not None:
        earliest, latest = clock_time(first, present), clock_time(last, present)
        return earliest if earliest == latest else f"between {earliest} and {latest}"
    if last is not None:
        return f"by {clock_time(last, present)}"
    return "an unknown time" if first is None else f"after {clock_time(first, present)}"


def clock_time(moment: datetime, present: datetime) -> str:
    """Return a moment as a clock time, with its date where that is not today.

    Parameters
    ----------
    moment
        The moment.
    present
        The time of asking.

    Returns
    -------
    str
        The time, such as ``12:03:05``.
    """
    clock = moment.strftime("%H:%M:%S")
    return clock if moment.date() == present.date() else f"{moment.date().isoformat()} {clock}"
