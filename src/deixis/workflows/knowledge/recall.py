"""Answer questions about then and now from the episodes of a memory.

A question is read by :mod:`deixis.grammar.recall`, its nouns are resolved to things of the blackboard and its times to
a window, and the fluents that answer it are found by one :class:`~deixis.memory.episodes.search.FluentSearch`, which
can be printed as SPARQL.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

from deixis.answers import count
from deixis.grammar.recall.acts import ToldAct
from deixis.grammar.recall.questions import BY_PERSON, Moment, RecallQuestion, RecallQuestionError, When, read_question
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin
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
    POINTED_AT,
    PUT,
    SAID,
    SAME_AS,
    SAYS,
    TOOK,
)
from deixis.memory.episodes.search import Edge, Event, FluentSearch, Pick
from deixis.ontology.inflection import plural, singular
from deixis.ontology.tbox import Ontology, default_ontology
from deixis.ontology.things.kinds import plain_name
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Pattern
from deixis.workflows.knowledge.recall_answer import Recall, Recalled
from deixis.workflows.knowledge.recall_places import RecordedBoxes, RelatedPlace
from deixis.workflows.knowledge.recall_wording import (
    ACT_DONE,
    act_words,
    clock_time,
    definite,
    distinct,
    fact_words,
    sentence,
)

if TYPE_CHECKING:
    from deixis.memory.episodes.search import Episodes

MOMENT = 1e-3
"""Seconds between *before* or *after* a moment and the moment itself."""

AROUND = 60.0
"""Seconds before and after a moment at which an event is looked for: *what was taken away at noon?*"""

ANY = frozenset({"one", "ones", "thing", "things", "object", "objects", "something", "anything", "everything"})
"""Nouns that stand for all things."""

SURFACES = frozenset({"table", "desk", "counter", "surface"})
"""Nouns of what everything stands on, where no thing has the name: *what is on the table?*"""

SIDES = frozenset({"left", "right", "middle", "centre", "center", "front", "back", "far side", "near side"})
"""Nouns of parts of the table: *is there a ball on the left?*"""

OF_EXPECTED = {"unseen": EXPECTED, "contradicted": CONTRADICTED, "confirmed": SAME_AS}
"""Predicate that answers each kind of question about what persons said is there."""

OF_SITUATION = {
    "called": NAMED,
    "whether_called": NAMED,
    "layout": frozenset({LAYOUT}),
    "fault": frozenset({FAULT}),
    "colour": frozenset({"colour"}),
}
"""Predicates that answer questions about the names and colours of things, and about the layout and its mistakes."""

EVENTS = {"gone": Event.GOES, "come": Event.COMES, "moved": Event.MOVES, "returned": Event.COMES}

EVENT_OF_ACT = {PUT: Event.COMES, MOVED: Event.MOVES, TOOK: Event.GOES}
"""Change of the presence of a thing that each act of a person is."""

PRESENT_SECONDS = 60.0
"""Seconds since a person was last seen or heard up to which the person counts as there now."""

MAX_AT_ONCE = 2
"""Maximum number of things that persons bring or take at the same time; more were found by a new look at the table."""

MAX_UNATTRIBUTED = 3
"""Maximum number of changes by unknown persons that an answer lists."""

PRONOUNS = frozenset({"it", "them", "that", "this"})
"""Nouns that stand for the thing that the question is about."""

ROBOT = "robot"
"""Name of the robot in questions about what it said."""

ABOUT_PERSONS = ("who_there", "how_many_persons", "whether_present", "where_person")
"""Kinds of questions about the presence of persons."""

OF_PRESENCE = {
    "whether_there": "whether_present",
    "whether_did": "whether_present",
    "when_there": "who_there",
    "when_did": "who_there",
    "where": "where_person",
    "where_was": "where_person",
    "seen_last": "who_there",
}
"""Kind of the question about a person by that of a question about a thing, if the noun is the name of a person."""

PEOPLE = re.compile(r"(?:any|some)(?:one|body)|people|persons?|they")
"""Nouns that stand for any person."""


def recall(
    question: str,
    board: Episodes,
    at: float | None = None,
    ontology: Ontology | None = None,
    speaker: str | None = None,
) -> Recall:
    """Answer a question about then and now.

    Parameters
    ----------
    question
        The question, in English.
    board
        The blackboard, or a module's board.
    at
        Time of asking in seconds since the origin of the memory; default: the present, or the time of the last thing
        recorded where that is later, as after a recording that was played faster than it was made.
    ontology
        Words of relations and kinds; default: the shipped ones.
    speaker
        Name of the person who says *I*; by default, *I* may be any person.

    Returns
    -------
    Recall
        The answer, with the fluents that it rests on.

    Raises
    ------
    RecallQuestionError
        If the question is not understood; the message has wordings that would be.
    """
    ontology = ontology or default_ontology()
    read = read_question(question, ontology)
    asked = _present_time(board) if at is None else at
    return _Remembering(board, asked, ontology, speaker).answer(read)


def _present_time(board: Episodes) -> float:
    """Return the time of the clock in seconds, or the last time that is recorded where that is later."""
    now = (datetime.now(UTC) - board.origin).total_seconds()
    times = (time for each in board.holding() for time in (each.start.upper, each.finish.lower))
    return max(now, max((time for time in times if math.isfinite(time)), default=now))


def arrivals(
    board: Episodes, start: float | None = None, end: float | None = None
) -> tuple[tuple[EpisodicFluent, str], ...]:
    """Return the fluents with which things came, each with the category of its thing.

    Parameters
    ----------
    board
        The blackboard.
    start, end
        Window in seconds since the origin of the memory; without them, all that is recorded.

    Returns
    -------
    tuple of tuple
        Fluents of place and names of things, one for each time that a thing came, in order of time.
    """
    last = math.inf if end is None else end
    known = _Remembering(board, last, default_ontology(), None)
    search = known.event_search(Event.COMES, None, -math.inf if start is None else start, last)
    found = {(each.statement.subject, each.start): each for each in reversed(search.run(board))}
    return tuple((each, known.name(each.statement.subject)) for each in reversed(found.values()))


def told_change(told: ToldAct, board: Episodes, at: float) -> tuple[str, str, Bounds] | None:
    """Return the change of the blackboard that a person told of.

    Parameters
    ----------
    told
        What a person is said to have done.
    board
        The blackboard.
    at
        Time at which it was said, in seconds since the origin of the memory.

    Returns
    -------
    tuple or None
        Predicate of the act, the thing, and when it was done: the last such change of the thing, or an unknown time
        before the words if none was seen. None if no thing, or more than one, may be meant.
    """
    known = _Remembering(board, at, default_ontology(), None)
    try:
        things = known.resolve(told.thing)
    except _NotKnownError:
        return None
    searches = {act: known.event_search(EVENT_OF_ACT[act], things, -math.inf, at) for act in told.acts}
    changes = [(_time_of(act, each), act, each) for act, search in searches.items() for each in search.run(board)]
    last = max((time for time, _, _ in changes), default=None)
    meant = {(act, each.statement.subject) for time, act, each in changes if time == last}
    if last is None:
        meant = {(told.acts[0], thing) for thing in things or ()}
    if len(meant) != 1:
        return None
    ((act, thing),) = meant
    return act, thing, Bounds(-math.inf, at) if last is None else Bounds(last, last)


def moment_of(time: str) -> datetime:
    """Return a time that is written in ISO 8601, in local time where it has no time zone.

    Parameters
    ----------
    time
        The time, such as ``2026-11-23T12:30``.

    Returns
    -------
    datetime
        The time with a time zone.

    Raises
    ------
    SettingError
        If it is not a time.
    """
    try:
        found = datetime.fromisoformat(time)
        return found if found.tzinfo else found.astimezone()
    except (ValueError, OverflowError) as error:
        raise SettingError(f"a time must be as in 2026-11-23T12:30, got {time!r}") from error


class _NotKnownError(Exception):
    """A question that nothing recorded can answer, with the reason."""


class _Remembering:
    """The blackboard at the time of a question: the names of its things, and the searches of questions."""

    def __init__(self, board: Episodes, asked: float, ontology: Ontology, speaker: str | None) -> None:
        self.board, self.asked, self.ontology, self.speaker = board, asked, ontology, speaker
        self.names: dict[str, list[tuple[float, str]]] = defaultdict(list)
        self.things: set[str] = set()
        self.predicates: set[str] = set()
        self._meant: frozenset[str] | None = None  # things that the question is about
        self._known_boxes: dict[str, RecordedBoxes] = {}
        self.said_of: dict[str, set[str]] = defaultdict(set)  # words that were said about each thing
        self.expected: dict[str, str] = {}  # persons by the objects that they said are there
        relations = {relation.name for relation in ontology.relations.values()}
        related: set[str] = set()
        for each in board.holding():
            statement = each.statement
            if statement.predicate == EXPECTED:
                self.expected[statement.subject] = each.source.by
            if statement.predicate == SAME_AS and statement.object is not None:
                self.said_of[statement.object] |= self.said_of[statement.subject]
            elif statement.object is not None and statement.predicate not in (AT, SAID, EXPECTED):
                self.said_of[statement.subject].add(statement.object)
            if statement.predicate in NAMED and statement.object is not None and self._is_name(each):
                self.names[statement.subject].append((each.start.lower, statement.object))
            if statement.predicate in (AT, IS_A) or statement.predicate in relations:
                self.things.add(statement.subject)
                related.add(statement.predicate)
                if statement.subject not in self.expected:
                    self.predicates.add(statement.predicate)
            if statement.predicate in relations and statement.object is not None:
                self.things.add(statement.object)
        self.relations = frozenset(related & relations)
        self.places = frozenset({AT} if AT in self.predicates else self.predicates & relations)

    # ---- names

    def _is_name(self, fluent: EpisodicFluent) -> bool:
        """Return whether a fluent names its thing; a name that a person gave and then corrected does not count."""
        return fluent.statement.predicate == IS_A or fluent.is_open

    def name(self, thing: str, at: float = math.inf) -> str:
        """Return the category that a thing had at a time, in words; else its id."""
        known = sorted(self.names.get(thing, ()))
        then = [category for start, category in known if start <= at] or [category for _, category in known]
        return (then[-1] if then else thing).replace("_", " ")

    def resolve(self, noun: str) -> frozenset[str] | None:
        """Return the things that a noun stands for; None for all things."""
        words = noun if noun in ANY else singular(noun)
        if words in ANY:
            return None
        if noun in PRONOUNS:
            raise _NotKnownError(f"the question does not say what '{noun}' is")
        found = {thing for thing in self.things if thing.lower() in (noun, noun.replace(" ", "_"))}
        found |= self._called(words, exactly=words == noun)
        adjective, _, rest = words.partition(" ")
        if not found and rest:  # the red ball
            try:
                of_noun = self.resolve(rest)
            except _NotKnownError:
                of_noun = frozenset()
            found = {thing for thing in self.things if adjective in self.said_of[thing]}
            found &= self.things if of_noun is None else of_noun
        parts = re.split(r" (?:or|and) ", noun)
        if not found and len(parts) > 1:  # the fork and the cup
            several = [self.resolve(part) for part in parts]
            return None if None in several else frozenset().union(*(each or () for each in several))
        if not found:
            known = sorted({self.name(thing) for thing in self.things})
            has = f"; it has: {', '.join(known[:8])}{' …' if len(known) > 8 else ''}" if known else ", which is empty"
            raise _NotKnownError(f"nothing on the blackboard is called '{noun}'{has}")
        return frozenset(found)

    def _called(self, noun: str, exactly: bool) -> set[str]:
        """Return the things that had a name, or that of a narrower kind.

        If ``exactly`` is True, things with the name of a narrower kind are meant only if no thing has that name itself.
        """
        by_name = {thing: {plain_name(kind) for _, kind in kinds} for thing, kinds in self.names.items()}
        own = {thing for thing, kinds in by_name.items() if noun.replace(" ", "_") in kinds}
        fitting = {thing for thing, kinds in by_name.items() if any(self._fits(kind, noun) for kind in kinds)}
        return (own if exactly else set()) or fitting

    def _fits(self, category: str, noun: str) -> bool:
        plain, wanted = plain_name(category).replace("_", " ").lower(), noun.lower()
        if plain == wanted or plain.endswith(f" {wanted}"):
            return True
        (own, _), (broader, rest) = self.ontology.kinds.head_noun(plain), self.ontology.kinds.head_noun(wanted)
        return not rest and any(self.ontology.kinds.is_a(kind, each) for kind in own[:1] for each in broader)

    # ---- times

    def window(self, when: When, event: bool) -> tuple[float, float, Pick]:
        """Return the window that a question asks about, and which of the fluents in it."""
        now, kind = self.asked, when.kind
        if kind == "unstated":
            return (-math.inf, now, Pick.ALL) if event else (now, now, Pick.ALL)
        if kind == "now":
            return now, now, Pick.ALL
        if kind == "ever":
            return -math.inf, now, Pick.ALL
        if kind == "before":
            return -math.inf, now, Pick.LAST
        if kind == "at_first":
            return -math.inf, now, Pick.FIRST
        spans = [self.span(moment) for moment in when.moments]
        first, last = spans[0]
        if kind in ("since", "within"):
            return first, now, Pick.ALL
        if kind == "after":
            return last + MOMENT, now if event else last + MOMENT, Pick.ALL
        if kind == "before_time":
            return (-math.inf, first, Pick.ALL) if event else (first - MOMENT, first - MOMENT, Pick.ALL)
        if kind == "between":
            return first, spans[1][1], Pick.ALL
        around = AROUND if event and first == last else 0.0
        return first - around, min(last + around, max(now, first)), Pick.ALL

    def span(self, moment: Moment) -> tuple[float, float]:
        """Return the first and last second of a moment that a question names."""
        if moment.kind == "ago":
            then = self.asked - float(moment.value)
            return then, then
        if moment.kind in EVENTS:
            return self._span_of_event(moment)
        if moment.kind == "by":
            return self._span_of_act(moment)
        first, last = _local_span(moment, self._present())
        return (first - self.board.origin).total_seconds(), (last - self.board.origin).total_seconds()

    def _span_of_event(self, moment: Moment) -> tuple[float, float]:
        things = self._meant if moment.value in PRONOUNS else self.resolve(moment.value)
        search = self.event_search(EVENTS[moment.kind], things, -math.inf, self.asked, Pick.LAST)
        found = search.run(self.board)
        if not found:
            raise _NotKnownError(f"nothing recorded says that {definite(moment.value)} {_DID[moment.kind]}")
        ends = [each.finish if search.edge is Edge.FINISHES else each.start for each in found]
        return min(end.lower for end in ends), max(end.upper for end in ends)

    def _span_of_act(self, moment: Moment) -> tuple[float, float]:
        """Return the time at which a person did something with a thing last."""
        things = self._meant if moment.value in PRONOUNS else self.resolve(moment.value)
        of_asker = moment.person is None
        asked = RecallQuestion("", "what_did", speaker=moment.person, of_asker=of_asker, acts=moment.acts)
        acts = FluentSearch(self._persons(asked), frozenset(moment.acts), things, end=self.asked, pick=Pick.LAST)
        found = acts.run(self.board)
        if not found:
            thing = "it" if moment.value in PRONOUNS else definite(moment.value)
            done, by = ACT_DONE[moment.acts[0]], moment.person or "you"
            raise _NotKnownError(f"nothing recorded says that {thing} was {done} by {by}")
        return min(each.start.lower for each in found), max(each.start.upper for each in found)

    # ---- searches

    def event_search(
        self, event: Event, things: frozenset[str] | None, start: float, end: float, pick: Pick = Pick.ALL
    ) -> FluentSearch:
        """Return the search of the times at which things come, go or move."""
        edge = Edge.FINISHES if event is Event.GOES else Edge.STARTS
        return FluentSearch(things, self.places, None, None, None, edge, start, end, pick, event, self.places)

    def search(self, question: RecallQuestion) -> FluentSearch:
        """Return the search of the fluents that answer a question."""
        kind = question.kind
        if kind == "why":
            raise _NotKnownError("the reasons for which persons do things are not recorded")
        if kind == "future":
            raise _NotKnownError("what will happen is not recorded")
        things = None
        if question.thing is not None and kind != "said_about":
            things = self._things_of(question.thing) if kind in BY_PERSON else self.resolve(question.thing)
        self._meant = things
        if kind in EVENTS or kind in ("when_did", "whether_did", "how_many_did", "how_often"):
            return self._search_of_event(question, things)
        if kind == "happened":
            return self._search_of_happenings(question, things)
        if kind in ABOUT_PERSONS:
            return self._search_of_presence(question)
        if kind in ("shown", "how_many_shown", "said", "who"):
            return self._search_of_statements(question, things)
        if kind in OF_EXPECTED:
            return self._search_of_expected(question)
        if kind in BY_PERSON:
            return self._search_of_acts(question, things)
        if kind == "said_about":
            return self._search_of_words(question)
        if kind == "where_put":
            return self._search_where_put(question, things)
        if kind in OF_SITUATION:
            return self._search_of_situation(question, things)
        if kind in ("unmoved", "always"):
            return self._search_of_lasting(question, things)
        start, end, pick = self.window(question.when, event=False)
        edge = Edge.FINISHES if pick is Pick.LAST else Edge.STARTS if pick is Pick.FIRST else Edge.HOLDS
        if kind in ("when_held", "when_there"):
            start, end, pick, edge = -math.inf, self.asked, Pick.ALL, Edge.HOLDS
        found = FluentSearch(things, self.places, edge=edge, start=start, end=end, pick=pick)
        if kind == "seen_last":
            found = replace(found, edge=Edge.HOLDS, pick=Pick.LAST, start=-math.inf, end=self.asked)
        if question.relation is None:
            if kind in ("where", "where_was", "seen_last") and self.relations:
                by_relation = replace(found, predicates=self.relations)
                found = by_relation if by_relation.run(self.board) else found
            if kind == "where_was" and not found.run(self.board):  # it has left its place
                found = self._search_of_last_places(found)
            if things is not None and things & self.expected.keys():
                words = frozenset({EXPECTED})
                if kind == "whether_there":
                    return replace(found, predicates=found.predicates and found.predicates | words)
                if kind in ("where", "where_was") and not found.run(self.board):
                    return replace(found, predicates=words)
            return found
        related = replace(found, predicates=frozenset({question.relation}))
        if question.other in SURFACES and question.relation == "on" and not self._is_known(question.other):
            return related if related.run(self.board) else found
        others = None if question.other is None else self.resolve(question.other)
        stated = replace(related, objects=others)
        if AT not in self.places or stated.run(self.board):
            return stated
        in_boxes = [each for each in found.run(self.board) if self._related_place(each, question.relation, others)]
        return replace(found, ids=frozenset(each.id for each in in_boxes)) if in_boxes else stated

    # ---- places in boxes

    def _boxes(self, fluent: EpisodicFluent) -> RecordedBoxes:
        """Return the boxes that hold while that of a fluent does, up to the time of asking."""
        key = fluent.id
        if key not in self._known_boxes:
            end = min(fluent.finish.upper, self.asked)
            self._known_boxes[key] = RecordedBoxes(self.board.holding(Pattern(predicate=AT), fluent.start.lower, end))
        return self._known_boxes[key]

    def _related_place(
        self, fluent: EpisodicFluent, relation: str, others: frozenset[str] | None
    ) -> RelatedPlace | None:
        if fluent.statement.predicate != AT:
            return None
        return self._boxes(fluent).related(fluent.id, relation, others)

    def _search_of_last_places(self, search: FluentSearch) -> FluentSearch:
        """Return the search of where the things of a search were before they left their places."""
        last = replace(search, edge=Edge.FINISHES, start=-math.inf, pick=Pick.LAST, objects=None)
        by_relation = replace(last, predicates=self.relations)
        return by_relation if by_relation.run(self.board) else replace(last, predicates=self.places)

    def _last_places(self, search: FluentSearch) -> tuple[EpisodicFluent, ...]:
        """Return where the things of a search were before they left their places; nothing if one is in its place."""
        if search.subjects is None or replace(search, predicates=self.places, objects=None).run(self.board):
            return ()
        return self._search_of_last_places(search).run(self.board)

    def _is_known(self, noun: str) -> bool:
        try:
            return bool(self.resolve(noun))
        except _NotKnownError:
            return False

    def _search_of_expected(self, question: RecallQuestion) -> FluentSearch:
        """Return the search of objects that persons said are there: those not seen yet, not there, or seen."""
        by = self._persons(question)
        things = frozenset(thing for thing, person in self.expected.items() if by is None or person in by)
        predicate = frozenset({OF_EXPECTED[question.kind]})
        if question.kind == "unseen":
            return FluentSearch(things, predicate, edge=Edge.HOLDS, start=self.asked, end=self.asked)
        return FluentSearch(things, predicate, edge=Edge.STARTS, end=self.asked)

    def _search_of_event(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        start, end, pick = self.window(question.when, event=True)
        pick = Pick(question.order) if question.order else pick
        if question.event == "shown":
            return FluentSearch(things, NAMED, None, frozenset({Origin.SHOWN}), None, Edge.STARTS, start, end, pick)
        event = EVENTS[question.event or question.kind]
        if question.event == "returned":  # after the thing went
            gone = self.event_search(Event.GOES, things, -math.inf, self.asked).run(self.board)
            start = max(start, min((each.finish.lower for each in gone), default=self.asked))
        return self.event_search(event, things, start, end, pick)

    def _search_of_statements(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        start, end, pick = self.window(question.when, event=True)
        pick = Pick(question.order) if question.order else pick
        if question.kind == "said" and (question.speaker or "").removeprefix("the ") == ROBOT:
            end = min(end, self.asked - MOMENT)
            return FluentSearch(None, frozenset({SAYS}), edge=Edge.STARTS, start=start, end=end, pick=pick)
        by = self._persons(question)
        if question.kind == "said":
            end = min(end, self.asked - MOMENT)  # without the question itself
            statement = FluentSearch(None, None, None, frozenset({Origin.SAID}), by, Edge.STARTS, start, end, pick)
            sentences = replace(statement, predicates=frozenset({SAID}))
            return sentences if sentences.run(self.board) else statement
        origins = frozenset({Origin.SHOWN, Origin.SAID} if question.kind == "who" else {Origin.SHOWN})
        return FluentSearch(things, NAMED, None, origins, by, Edge.STARTS, start, end, pick)

    def _search_of_situation(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        """Return the search of names or colours of things, or of the layout or its mistakes, that held at a time."""
        start, end, pick = self.window(question.when, event=False)
        edge = Edge.FINISHES if pick is Pick.LAST else Edge.STARTS if pick is Pick.FIRST else Edge.HOLDS
        held = FluentSearch(things, OF_SITUATION[question.kind], edge=edge, start=start, end=end, pick=pick)
        if question.kind != "whether_called":
            return held
        kind = singular(question.other or "")
        so_called = [each.id for each in held.run(self.board) if self._fits(str(each.statement.object), kind)]
        return replace(held, ids=frozenset(so_called))

    def _search_of_lasting(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        """Return the search of the things that did not move, or were always there, in the window of a question."""
        start, end, _ = self.window(question.when, event=True)
        first = min((each.start.upper for each in self._all_places()), default=start)
        start = max(start, first)
        places = FluentSearch(things, self.places, start=end, end=end)
        changed = [self.event_search(Event.MOVES, things, start, end)]
        if question.kind == "always":
            changed = [self.event_search(event, things, start + MOMENT, end) for event in (Event.COMES, Event.GOES)]
        others = {each.statement.subject for search in changed for each in search.run(self.board)}
        lasting = {each.statement.subject for each in places.run(self.board)} - others
        return replace(places, subjects=frozenset(lasting))

    def _search_of_happenings(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        """Return the search of what came, moved and went, with the acts of the persons who did it."""
        start, end, pick = self.window(question.when, event=True)
        pick = Pick(question.order) if question.order else pick
        places = FluentSearch(things, self.places, edge=Edge.STARTS, start=start, end=end)
        searches = [places, replace(places, subjects=None, predicates=ACTS, objects=things)]
        if pick is Pick.ALL:
            searches.append(self.event_search(Event.GOES, things, start, end))
        ids = frozenset(each.id for search in searches for each in search.run(self.board))
        return FluentSearch(edge=Edge.HOLDS if pick is Pick.ALL else Edge.STARTS, pick=pick, ids=ids)

    def _search_of_presence(self, question: RecallQuestion) -> FluentSearch:
        """Return the search of what shows that persons were there: what they did, pointed at and said."""
        start, end, pick = self.window(question.when, event=True)
        start -= PRESENT_SECONDS if question.when.kind == "now" else 0.0
        end = min(end, self.asked - MOMENT)  # without the question itself
        shown = ACTS | {SAID, POINTED_AT}
        pick = Pick(question.order) if question.order else pick
        return FluentSearch(self._persons(question), shown, edge=Edge.STARTS, start=start, end=end, pick=pick)

    def _of_person(self, question: RecallQuestion) -> RecallQuestion:
        """Return a question for the presence of a person, if the noun of a question for a thing is a person's name."""
        kind = OF_PRESENCE.get(question.kind)
        if kind is None or question.thing is None or question.relation is not None or self._is_known(question.thing):
            return question
        if question.thing.lower() not in {name.lower() for name in self._known_persons()}:
            return question
        order = question.order
        if question.event == "gone" or question.kind in ("seen_last", "where", "where_was"):
            order, kind = "last", "who_there" if question.kind == "seen_last" else "where_person"
        elif question.kind == "when_did":
            order = order or "first"
        return replace(question, kind=kind, thing=None, speaker=question.thing, event=None, order=order)

    def _search_of_words(self, question: RecallQuestion) -> FluentSearch:
        """Return the search of what was said about things: words that name them, else names that they were given."""
        start, end, pick = self.window(question.when, event=True)
        by, noun = self._persons(question), question.thing or ""
        things = self.resolve(noun) if self._is_known(noun) else frozenset()
        named = {name for thing in things or () for _, name in self.names[thing] if self._fits(name, singular(noun))}
        words = {form for name in (singular(noun), *named) for form in (name, plural(name))} | {noun}
        said = FluentSearch(None, frozenset({SAID}), None, None, by, Edge.STARTS, start, end, pick)
        said = replace(said, words=frozenset(word.replace("_", " ") for word in words))
        if said.run(self.board) or not things:
            return said
        origins = frozenset({Origin.SHOWN, Origin.SAID})
        return FluentSearch(things, NAMED, None, origins, by, Edge.STARTS, start, end, pick)

    # ---- acts of persons

    def _search_of_acts(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        """Return the search of what persons did with things."""
        start, end, pick = self.window(question.when, event=True)
        acts = FluentSearch(self._persons(question), frozenset(question.acts), things, start=start, end=end)
        if question.relation is not None:
            acts = replace(
                acts, ids=frozenset(each.id for each in acts.run(self.board) if self._led_to(question, each))
            )
        return replace(acts, pick=Pick(question.order) if question.order else pick)

    def _led_to(self, question: RecallQuestion, act: EpisodicFluent) -> bool:
        """Return whether a thing is in the relation that a question names, from an act on."""
        places = self.event_search(EVENT_OF_ACT[act.statement.predicate], frozenset({act.statement.object or ""}),
                                   act.start.lower - MOMENT, act.start.upper + MOMENT)  # fmt: skip
        return any(self._is_as_asked(question, each) for each in places.run(self.board))

    def _is_as_asked(self, question: RecallQuestion, place: EpisodicFluent) -> bool:
        """Return whether the thing of a place is in the relation that a question names."""
        if question.relation is None:
            return True
        if question.other in SURFACES and not self._is_known(question.other or ""):
            return True
        others = None if question.other is None else self.resolve(question.other)
        if self._related_place(place, question.relation, others) is not None:
            return True
        at = place.start.upper
        things, words = frozenset({place.statement.subject}), frozenset({question.relation})
        return bool(FluentSearch(things, words, others, start=at, end=at).run(self.board))

    def _search_where_put(self, question: RecallQuestion, things: frozenset[str] | None) -> FluentSearch:
        """Return the search of where things are since a person put them there."""
        acts = replace(self._search_of_acts(question, things), pick=Pick(question.order or "last")).run(self.board)
        if not acts:
            raise _NotKnownError(self._reason(question))
        first, last = min(each.start.lower for each in acts), max(each.start.upper for each in acts)
        moved = frozenset(each.statement.object for each in acts if each.statement.object is not None)
        return FluentSearch(moved, self.places, None, None, None, Edge.STARTS, first - MOMENT, last + MOMENT)

    def _unattributed(self, question: RecallQuestion) -> list[tuple[str, EpisodicFluent]]:
        """Return the changes that a question asks about and whose actor is unknown.

        Each has the predicate of the act that it would be. What lay on the table when it was looked at was not put
        there while the robot looked.
        """
        start, end, pick = self.window(question.when, event=True)
        pick = Pick(question.order) if question.order else pick
        things = None if question.thing is None else self._things_of(question.thing)
        acts = FluentSearch(None, ACTS, things, end=self.asked).run(self.board)
        found = []
        for act in question.acts:
            search = self.event_search(EVENT_OF_ACT[act], None, -math.inf, self.asked)
            changes = search.run(self.board)
            times = [_time_of(act, each) for each in changes]
            first = min((each.start.lower for each in self._all_places()), default=-math.inf)
            for change, time in zip(changes, times, strict=True):
                looked = times.count(time) > MAX_AT_ONCE or (act == PUT and time <= first)
                by_someone = any(
                    each.statement.predicate == act
                    and each.statement.object == change.statement.subject
                    and each.start.lower - MOMENT <= time <= each.start.upper + MOMENT
                    for each in acts
                )
                asked = (things is None or change.statement.subject in things) and start <= time <= end
                if asked and not looked and not by_someone and (act == TOOK or self._is_as_asked(question, change)):
                    found.append((act, change))
        found.sort(key=lambda each: _time_of(*each))
        if pick is not Pick.ALL:
            found = found[:1] if pick is Pick.FIRST else found[-1:]
        return found

    def _all_places(self) -> tuple[EpisodicFluent, ...]:
        return tuple(each for name in sorted(self.places) for each in self.board.holding(Pattern(predicate=name)))

    def _things_of(self, noun: str) -> frozenset[str] | None:
        """Return the things that a noun stands for; all things for the table that they are on."""
        return None if noun in SURFACES and not self._is_known(noun) else self.resolve(noun)

    def _persons(self, question: RecallQuestion) -> frozenset[str] | None:
        wanted = question.speaker or (self.speaker if question.of_asker else None)
        kinds = ("shown", "how_many_shown", "said", "said_about", "where_put", *ABOUT_PERSONS, *BY_PERSON, *OF_EXPECTED)
        if wanted is None or PEOPLE.fullmatch(wanted.lower()) or question.kind not in kinds:
            return None
        known = self._known_persons()
        called = {wanted.lower(), wanted.lower().removeprefix("the ")}  # 'the teacher' is called 'teacher'
        named = frozenset(name for name in known if name.lower() in called)
        if not named:
            raise _NotKnownError(f"nothing is recorded that '{wanted}' said, showed or did")
        return named

    def _known_persons(self) -> set[str]:
        """Return the names of all persons who said, showed or did something."""
        known = set()
        for each in self.board.holding():
            if each.source.origin in (Origin.SAID, Origin.SHOWN):
                known.add(each.source.by)
            if each.statement.predicate in ACTS or each.statement.predicate == POINTED_AT:
                known.add(each.statement.subject)
        return known

    # ---- answers

    def answer(self, question: RecallQuestion) -> Recall:
        """Return the answer to a question."""
        search, question = None, self._of_person(question)
        if question.kind == "whether" and question.other in SIDES and not self._is_known(question.other):
            question = replace(
                question, kind="whether_there", thing=f"{question.other} {question.thing}", relation=None, other=None
            )
        try:
            search = self.search(question)
            found = search.run(self.board)
            unseen = frozenset(each.statement.subject for each in found) & self.expected.keys()
            if question.kind == "whether" and unseen and len(unseen) == len({each.statement.subject for each in found}):
                question, words = replace(question, kind="whether_there"), frozenset({EXPECTED})
                search = replace(search, subjects=unseen, predicates=words, objects=None)
                found = search.run(self.board)
            unknown = self._unknown_actors(question)
            otherwise = self._otherwise(question, search, unknown) if not found else ()
            if not found and not otherwise:
                raise _NotKnownError(self._reason(question))
            if question.order is not None and found and question.kind in BY_PERSON:
                unknown = [each for each in unknown if self._is_before(question.order, each, found[0])]
                if unknown:
                    raise _NotKnownError(self._words_of_unknown(unknown))
        except _NotKnownError as error:
            reason = str(error) + self._said_instead(question)
            return Recall(question, (), search, f"Not known: {reason}.", reason, self.asked, self.board.origin)
        made = Recall(question, self._named(found, question), search, "", None, self.asked, self.board.origin)
        if otherwise:
            sentences = "; ".join(distinct(fact_words(made, fact) for fact in self._named(otherwise)))
            return replace(made, answer=f"No: {sentences}.")
        told = sentence(made)
        if unknown and question.kind in ("who_did", "what_did", "how_many_did_by", "happened"):
            told = f"{told.removesuffix('.')}; {self._words_of_unknown(unknown)}."
        return replace(made, answer=told)

    def _unknown_actors(self, question: RecallQuestion) -> list[tuple[str, EpisodicFluent]]:
        """Return the changes that a question asks about, of which it is not known who made them.

        For *what happened?*, only a memory with acts of persons says that it does not know one.
        """
        if question.kind == "happened" and question.order is None:
            return self._unattributed(replace(question, acts=(PUT, MOVED, TOOK))) if self._has_acts() else []
        return self._unattributed(question) if question.kind in BY_PERSON else []

    def _has_acts(self) -> bool:
        return any(self.board.holding(Pattern(predicate=act)) for act in ACTS)

    def _said_instead(self, question: RecallQuestion) -> str:
        """Return what persons said about a thing that no name stands for, as the end of a reason."""
        if question.kind not in BY_PERSON or question.thing is None or question.thing in ANY | SURFACES:
            return ""
        if self._is_known(question.thing):
            return ""
        search = self._search_of_words(replace(question, kind="said_about", speaker=None, of_asker=False, when=When()))
        made = Recall(question, self._named(search.run(self.board)), search, "", None, self.asked, self.board.origin)
        return "".join(f"; {words}" for words in distinct(fact_words(made, fact) for fact in made.facts))

    def _named(self, found: Iterable[EpisodicFluent], question: RecallQuestion | None = None) -> tuple[Recalled, ...]:
        """Return fluents with the names that their things had, and with the places that their boxes say."""
        at = self.asked if question is None else self._time_of_places(question)
        return tuple(
            Recalled(
                each,
                self.name(each.statement.subject, each.start.lower),
                None if each.statement.object is None else self.name(each.statement.object, each.start.lower),
                self._place_in_words(each, question, at),
            )
            for each in found
        )

    def _time_of_places(self, question: RecallQuestion) -> float:
        """Return the time at which the places that a question asks about are described."""
        _, end, pick = self.window(question.when, event=False)
        return -math.inf if pick is Pick.FIRST else end

    def _place_in_words(
        self, fluent: EpisodicFluent, question: RecallQuestion | None, at: float
    ) -> RelatedPlace | None:
        """Return where the box of a thing is: as a question asks, else as it is said best."""
        if fluent.statement.predicate != AT:
            return None
        place = None
        if question is not None and question.relation is not None and self._is_known(question.other or ""):
            place = self._related_place(fluent, question.relation, self.resolve(question.other or ""))
        if place is None:
            own = self.name(fluent.statement.subject, fluent.start.lower)
            others = frozenset(thing for thing in self.names if self.name(thing, fluent.start.lower) != own)
            place = self._boxes(fluent).described(fluent.id, others, at)
        return None if place is None else replace(place, other=self.name(place.other, place.start.lower))

    def _otherwise(
        self, question: RecallQuestion, search: FluentSearch, unknown: Sequence[tuple[str, EpisodicFluent]]
    ) -> tuple[EpisodicFluent, ...]:
        """Return what was true instead of what a yes-or-no question asks, if that is recorded."""
        if question.kind == "whether_did_by":
            return () if unknown else replace(search, subjects=None).run(self.board)
        return self._actual_places(question, search)

    @staticmethod
    def _is_before(order: str, change: tuple[str, EpisodicFluent], act: EpisodicFluent) -> bool:
        """Return whether a change was before an act, or after it if the last one is asked for."""
        time = _time_of(*change)
        return time < act.start.lower if order == "first" else time > act.start.upper

    def _words_of_unknown(self, unknown: Sequence[tuple[str, EpisodicFluent]]) -> str:
        """Return which changes have unknown actors: *who moved the fork at 11:40:00 was not seen*."""
        sentences = []
        for act, change in unknown[:MAX_UNATTRIBUTED]:
            at = clock_time(self._moment(_time_of(act, change)), self._present())
            sentences.append(f"who {act_words(act, self.name(change.statement.subject))} at {at} was not seen")
        if len(unknown) > MAX_UNATTRIBUTED:
            sentences.append(f"nor who made {count(len(unknown) - MAX_UNATTRIBUTED, 'other such change')}")
        return "; ".join(sentences)

    def _reason_of_acts(self, question: RecallQuestion) -> str:
        """Return why it is not known who did something, or what a person did."""
        unknown = self._unattributed(question)
        done = "put" if question.relation is not None else ACT_DONE[question.acts[0]]
        done = done if len(question.acts) < len(ACTS) else "handled"
        what = "nothing" if question.thing is None else definite(question.thing)
        persons = self._persons(question)
        by = "" if persons is None else f" by {' or '.join(sorted(persons))}"
        where = ""
        if question.relation is not None and question.other is not None:
            where = f" {self.ontology.relations[question.relation].phrase} {definite(question.other)}"
        recorded = f"{what} is {'' if question.thing is None else 'not '}recorded as {done}{where}{by}"
        if unknown:
            unseen = self._words_of_unknown(unknown)
            return f"{recorded}; {unseen}" if persons is not None else unseen
        others = self._search_of_acts(question, None if question.thing is None else self._things_of(question.thing))
        others = replace(others, subjects=None)
        if persons is not None and (made := others.run(self.board)):
            answer = Recall(question, self._named(made), others, "", None, self.asked, self.board.origin)
            return f"{recorded}; " + "; ".join(distinct(fact_words(answer, fact) for fact in answer.facts))
        if PUT in question.acts and question.thing is not None and question.relation is None:
            return f"{recorded}; it was there when the table was first seen" if self._is_first(question) else recorded
        return recorded

    def _is_first(self, question: RecallQuestion) -> bool:
        """Return whether the thing of a question was there at the beginning of what is recorded."""
        things = self._things_of(question.thing or "")
        times = [each.start.lower for each in self._all_places()]
        own = [each.start.lower for each in self._all_places() if things is None or each.statement.subject in things]
        return bool(own) and min(own) <= min(times)

    def _actual_places(self, question: RecallQuestion, search: FluentSearch) -> tuple[EpisodicFluent, ...]:
        """Return where the thing of a yes-or-no question was instead, or what it is called, if that is recorded."""
        if question.kind == "whether_called":
            return replace(search, ids=None).run(self.board)
        if question.kind == "whether_did" and question.event != "shown":
            held = replace(search, edge=Edge.HOLDS, event=None, pick=Pick.ALL, predicates=self.relations or self.places)
            at_other_times = replace(search, start=-math.inf, end=self.asked)
            return held.run(self.board) or at_other_times.run(self.board)
        if question.kind not in ("whether", "whether_there"):
            return ()
        wrong = replace(search, predicates=frozenset({CONTRADICTED}), edge=Edge.STARTS, objects=None)
        missing = replace(wrong, start=-math.inf, pick=Pick.LAST).run(self.board)
        elsewhere = replace(search, predicates=self.relations or self.places, objects=None).run(self.board)
        if question.kind == "whether" and (elsewhere or missing):
            return elsewhere or missing
        if missing or question.when.kind in ("unstated", "now"):
            return missing or self._last_places(search)
        at_other_times = replace(search, predicates=self.relations or self.places, objects=None, ids=None)
        return (
            () if search.subjects is None else replace(at_other_times, start=-math.inf, end=self.asked).run(self.board)
        )

    def _reason(self, question: RecallQuestion) -> str:
        """Return why nothing answers a question."""
        if question.kind in BY_PERSON:
            return self._reason_of_acts(question)
        if question.kind == "where_put":
            return self._reason_of_where_put(question)
        if question.kind in ("where", "where_was") and question.when.kind in ("unstated", "now"):
            gone = self.event_search(Event.GOES, self.resolve(question.thing or ""), -math.inf, self.asked, Pick.LAST)
            found = gone.run(self.board)
            if found:
                clock = clock_time(self._moment(found[-1].finish.upper), self._present())
                return f"{definite(question.thing or '')} has been gone since {clock}"
            return f"no place of {definite(question.thing or '')} is recorded"
        if question.kind == "where" and question.when.kind == "before":
            return f"no place of {definite(question.thing or '')} has ended; it is where it was at first"
        if question.kind == "whether_present" and question.when.kind == "now":
            earlier = self.answer(replace(question, kind="who_there", when=When(), order="last"))
            return f"this person was not seen or heard just now; {earlier.answer.removesuffix('.')}"
        what = _UNRECORDED.get(question.kind, "nothing that answers it is recorded")
        return what if question.when.kind in ("unstated", "now", "ever") else f"{what} for that time"

    def _reason_of_where_put(self, question: RecallQuestion) -> str:
        """Return why it is not known where a person put a thing, and where the thing is."""
        where = self.answer(replace(question, kind="where_was", acts=(), speaker=None, of_asker=False))
        reason = self._reason_of_acts(question)
        return f"{reason}; {where.answer[0].lower()}{where.answer[1:-1]}" if where.known else reason

    def _present(self) -> datetime:
        return self._moment(self.asked)

    def _moment(self, seconds: float) -> datetime:
        return (self.board.origin + timedelta(seconds=seconds)).astimezone()


def _time_of(act: str, change: EpisodicFluent) -> float:
    """Return the time of a change that an act is: the end of a place for things that are taken, else its start."""
    return change.finish.upper if act == TOOK else change.start.lower


_DID = {"gone": "went", "come": "came", "moved": "moved", "returned": "came back"}

_UNRECORDED = {
    "gone": "nothing is recorded as taken away",
    "come": "nothing is recorded as put down",
    "moved": "nothing is recorded as moved",
    "shown": "nothing is recorded as shown",
    "how_many_shown": "nothing is recorded as shown",
    "said": "nothing is recorded as said",
    "said_about": "nothing is recorded that was said about it",
    "who": "no person is recorded as having shown or named it",
    "who_there": "no person was seen or heard",
    "how_many_persons": "no person was seen or heard",
    "whether_present": "this person was not seen or heard",
    "present": "nothing is recorded as there",
    "called": "no name of it is recorded",
    "whether_called": "no name of it is recorded",
    "layout": "no layout of the table is recorded",
    "fault": "nothing is recorded as wrong",
    "colour": "no colour of it is recorded",
    "unmoved": "no thing is recorded as unmoved",
    "always": "no thing is recorded as always there",
    "unseen": "nothing that was said to be there is still to be seen",
    "contradicted": "nothing that was said to be there was found missing",
    "confirmed": "nothing that was said to be there was seen",
}


def _local_span(moment: Moment, present: datetime) -> tuple[datetime, datetime]:
    """Return the first and last moment of a named time, the last such time that is not after the present."""
    midnight = present.replace(hour=0, minute=0, second=0, microsecond=0)
    if moment.kind == "day":
        first, last = {
            "today": (0, 24),
            "yesterday": (-24, 0),
            "this morning": (0, 12),
            "this afternoon": (12, 18),
            "this evening": (18, 24),
        }[moment.value]
        return midnight + timedelta(hours=first), midnight + timedelta(hours=last)
    try:
        if moment.kind == "stamp":
            found = datetime.fromisoformat(moment.value.upper())
            found = found if found.tzinfo else found.replace(tzinfo=present.tzinfo)
            return found, found + timedelta(days=1) if "t" not in moment.value else found
        words = moment.value.split()
        clock = {"noon": "12:00", "midnight": "00:00"}.get(words[0], words[0])
        hour, minute, second = (*map(int, clock.split(":")), 0, 0)[:3]
        if words[-1] in ("am", "pm"):
            hour = hour % 12 + (12 if words[-1] == "pm" else 0)
        then = midnight.replace(hour=hour, minute=minute, second=second)
    except ValueError as error:
        raise RecallQuestionError(f"'{moment.value}' is not a time; write, say, '12:30', '3 pm' or 'noon'") from error
    then = then if then <= present else then - timedelta(days=1)
    return then, then
