"""Read questions about then and now.

>>> question = read_question("Where was the fork before?")
>>> question.kind, question.thing, question.when.kind
('where', 'fork', 'before')
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from deixis.errors import DeixisError
from deixis.grammar.layout.words import phrase_pattern
from deixis.grammar.recall.acts import act_terminals, acts_of
from deixis.grammar.recall.rewording import plain_question
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import Ontology, default_ontology

MAX_QUESTION = 1000
"""Maximum length of a question in characters."""

WORDINGS = (
    "where is the fork?",
    "where was the fork before?",
    "where was the fork at noon?",
    "where was the fork at first?",
    "where was the fork?",
    "where did the cup go?",
    "where was the fork when the cup was taken away?",
    "what is on the plate?",
    "what was left of the plate before 12:30?",
    "which forks were on the tray at 12:30?",
    "what is there now?",
    "what was there at noon?",
    "what was taken away?",
    "what was taken away since noon?",
    "what was put down after the cup was moved?",
    "what was moved in the last 5 minutes?",
    "what is new?",
    "what was taken away first?",
    "which one did I show you first?",
    "what was shown last?",
    "what was the first thing I showed you?",
    "when did the cup go?",
    "when was the cup taken away?",
    "when did the cup come first?",
    "when was the fork moved last?",
    "when was the fork shown?",
    "since when is the fork on the plate?",
    "when was the fork on the plate?",
    "how long was the fork on the plate?",
    "is the fork on the plate?",
    "was the fork left of the plate before noon?",
    "was the fork there yesterday?",
    "was the cup taken away?",
    "has the fork been moved since noon?",
    "did the cup come back?",
    "where did I put the fork?",
    "when did you last see the cup?",
    "what have I shown you?",
    "what changed since noon?",
    "what happened to the cup?",
    "who was here?",
    "who was here since noon?",
    "how many people were here?",
    "what did Ada say?",
    "what did I say in the last 5 minutes?",
    "who showed you the fork?",
    "who moved the fork?",
    "who took the cup away first?",
    "what did Ada put on the plate?",
    "what did I move?",
    "when did Ben take the cup away?",
    "did Ada move the fork?",
    "what did Ben do?",
    "where was the fork when Ben took the cup away?",
    "how many things did Ada move?",
    "how often did Ada move the fork?",
    "what did I tell you about the cups?",
    "what happened since noon?",
    "how many things were taken away since noon?",
    "how often was the fork moved?",
    "how many things did I show you?",
    "how long was the cup there?",
    "how many forks are on the plate?",
    "how many forks were there at noon?",
    "is there a ball?",
    "was there a ball on the tray at noon?",
    "what did I tell you that you have not seen?",
    "what did Ada tell you that was not there?",
    "what did I tell you that you have seen?",
    "what did Ada tell you?",
    "what have you not seen yet?",
    "what do you expect?",
    "what is t4?",
    "is t4 a fork?",
    "which one is the fork?",
    "what layout is this?",
    "what was wrong at noon?",
    "what was never moved?",
    "what was there the whole time?",
    "which came first, the fork or the cup?",
    "how long ago was the cup taken away?",
    "what colour is the ball?",
)
"""Wordings of all kinds of questions; a question that is not understood is answered with the nearest ones."""


_ASKS = re.compile(
    r"\s*(?:please |can you |tell me |do you (?:know|remember) )*"
    r"(?:where|what|which|who|when|since when|how (?:many|long)|is|are|was|were|did|has|have)\b",
    re.IGNORECASE,
)
"""Beginning of a text that may be a question."""


_HOW_LONG_AGO = re.compile(r"\bhow long ago\b", re.IGNORECASE)


class RecallQuestionError(DeixisError, ValueError):
    """A question about then and now that is not understood."""


@dataclass(frozen=True, slots=True)
class Moment:
    """A moment that a question names.

    ``kind`` is ``clock`` (``12:30``, ``3 pm``, ``noon``), ``stamp`` (an ISO date or time), ``day`` (``yesterday``),
    ``ago`` (``value`` seconds), or an event of the thing ``value``: ``gone``, ``come`` or ``moved``. It is ``by`` if a
    ``person`` (None for the one who asks) did one of ``acts`` with that thing.
    """

    kind: str
    value: str
    person: str | None = None
    acts: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class When:
    """The time that a question asks about: ``kind`` is a rule of the grammar, with up to two moments.

    It is ``unstated`` if the question names no time, and ``ever`` if it is then in the past tense.
    """

    kind: str = "unstated"
    moments: tuple[Moment, ...] = ()


@dataclass(frozen=True, slots=True)
class RecallQuestion:
    """A question about then and now.

    ``kind`` is the alternative of the grammar (``where``, ``related``, ``gone``, …), ``thing`` and ``other`` are nouns
    without articles (of *which came first, the fork or the cup?* both: *fork or cup*), ``relation`` is the name of a
    relation, ``event`` what happened to the thing, ``speaker`` the person named, ``of_asker`` True if the person is the
    one who asks, and ``order`` ``first`` or ``last``. ``acts`` is what a person did: some of ``put``, ``moved`` and
    ``took``.
    """

    text: str
    kind: str
    thing: str | None = None
    other: str | None = None
    relation: str | None = None
    event: str | None = None
    speaker: str | None = None
    order: str | None = None
    when: When = When()
    of_asker: bool = False
    acts: tuple[str, ...] = ()
    asks_how_long_ago: bool = False


def read_question(text: str, ontology: Ontology | None = None) -> RecallQuestion:
    """Read a question about then and now.

    Parameters
    ----------
    text
        The question, in English.
    ontology
        Words of the relations; default: the shipped ones.

    Returns
    -------
    RecallQuestion
        What is asked.

    Raises
    ------
    RecallQuestionError
        If the question is not understood; the message has wordings that would be.
    """
    if not isinstance(text, str) or not text.strip():
        raise RecallQuestionError(f"a question must be a string; ask, for example: {WORDINGS[1]}")
    if re.match(r"\s*(?:why|for what reason|what for)\b", text, re.IGNORECASE):
        return RecallQuestion(text, "why")
    if re.match(r"\s*(?:will|(?:what|where|who|when|which \w+) will|(?:is|are) .+ going to)\b", text, re.IGNORECASE):
        return RecallQuestion(text, "future")
    if len(text) > MAX_QUESTION:
        raise RecallQuestionError(f"a question must have at most {MAX_QUESTION} characters, got {len(text)}")
    ontology = ontology or default_ontology()
    try:
        plain = plain_question(text)
        tree = _parser(tuple(_relation_words(ontology))).parse(plain)
    except UnexpectedInput as error:
        raise _not_understood(text) from error
    question = _question(text, plain, tree.children[0], ontology)
    return replace(question, asks_how_long_ago=_HOW_LONG_AGO.search(text) is not None)


def is_question(text: str, ontology: Ontology | None = None) -> bool:
    """Return whether a text asks about then and now, also without a question mark, as recognised speech comes.

    Parameters
    ----------
    text
        A text in English.
    ontology
        Words of the relations; default: the shipped ones.

    Returns
    -------
    bool
        True if it ends in a question mark, or begins as a question and is understood.

    Examples
    --------
    >>> is_question("where was the fork before"), is_question("When there is soup, the spoon is right of the plate.")
    (True, False)
    """
    if text.strip().endswith("?"):
        return True
    if _ASKS.match(text) is None:
        return False
    try:
        read_question(text, ontology)
    except RecallQuestionError:
        return False
    return True


def _not_understood(text: str) -> RecallQuestionError:
    near = difflib.get_close_matches(plain_question(text), [plain_question(each) for each in WORDINGS], n=2, cutoff=0.0)
    wordings = {plain_question(each): each for each in WORDINGS}
    examples = " or ".join(f"'{wordings[each]}'" for each in near)
    return RecallQuestionError(
        f"the question '{' '.join(text.split())[:80]}' is not understood; ask, for example, {examples}"
    )


def _relation_words(ontology: Ontology) -> dict[str, str]:
    """Return the names of relations by their phrases, without words that mean something else in a question."""
    words = {"in": "inside", "upon": "on"}
    for relation in ontology.relations.values():
        if relation.reading is not Reading.EXACT:
            phrases = (relation.phrase, *(word for word in relation.words if " " in word), *relation.words[1:])
            words |= {phrase: relation.name for phrase in phrases if phrase not in words and phrase not in _OTHERWISE}
    return words


_OTHERWISE = {"by", "left", "right", "top", "bottom", "holding"}


@lru_cache(maxsize=4)
def _parser(relations: tuple[str, ...]) -> Lark:
    grammar = (files("deixis.grammar.recall") / "recall.lark").read_text(encoding="utf-8")
    phrases = phrase_pattern(relations).replace("/", r"\/")
    terminals = [f"RELATION.4: /(?!in the (?:last|past)\\b){phrases}/"]
    terminals += [f"{name}.3: /{pattern}/" for name, pattern in act_terminals().items()]
    return Lark("\n".join((grammar, *terminals, "")), parser="lalr", maybe_placeholders=False)


_AT_A_TIME = frozenset({"whether", "whether_there", "related", "present", "how_many", "layout", "fault"})
"""Kinds of questions about what holds at a time; in the past tense and without a time, at any time."""

_BE = re.compile(r"\b(?:is|are|(?P<past>was|were))\b")


def _question(text: str, plain: str, tree: Any, ontology: Ontology) -> RecallQuestion:
    kind, person = str(tree.data), None
    nouns: list[str | None] = [" ".join(each.children[0].children) for each in tree.children if _is(each, "np")]
    named = [" ".join(each.children) for each in tree.children if _is(each, "nouns")]
    relation = next((str(each) for each in tree.children if _is_token(each, "RELATION")), None)
    events = [each for each in tree.children if isinstance(each, Token) and each.type in _EVENTS]
    which = next((each for each in tree.children if _is(each, "what")), None)
    asked: list[str | None] = list(named) if which is None else [" ".join(each.children) for each in which.children]
    speaker = next((each.children[0] for each in tree.children if _is(each, "speaker")), None)
    of_asker = _is_token(speaker, "ME") or any(_is_token(each, "ME") for each in tree.children)
    if kind == "shown_by":  # the last thing Bob showed
        kind, words = "shown", " ".join(named).split()
        person = None if of_asker or not words else words.pop()
        asked = [" ".join(words)] if words else []
    act = next((str(each.children[0]) for each in tree.children if _is(each, "act")), None)
    if kind in _WITH_AGENT and not of_asker:
        person = nouns.pop(0)
    order = next((str(each.children[0]) for each in tree.children if _is(each, "order")), None)
    whens = [each for each in tree.children if isinstance(each, Tree) and each.data in _WHENS]
    if kind in _ASKING_FOR_THINGS:
        thing, other = (asked or [None])[0], (nouns or [None])[0]
    else:
        thing, other = (nouns or [None])[0], (nouns[1:] or [None])[0]
    if kind == "whether_called":
        other = named[0]
    first = _BE.search(plain)
    is_past = first is not None and first["past"] is not None
    return RecallQuestion(
        text=text,
        kind=kind,
        thing=thing,
        other=other,
        relation=None if relation is None else _relation_words(ontology)[_phrase(relation, ontology)],
        event=_EVENTS[events[0].type](str(events[0])) if events and kind in _DONE else None,
        speaker=" ".join(map(str, speaker.children)) if isinstance(speaker, Tree) else person,
        order=order,
        when=_when(whens[0]) if whens else When("ever") if kind in _AT_A_TIME and is_past else When(),
        of_asker=of_asker,
        acts=() if act is None else acts_of(act),
    )


def _phrase(words: str, ontology: Ontology) -> str:
    """Return the phrase of a relation that words were matched with, which may have articles."""
    known = _relation_words(ontology)
    plain = " ".join(words.replace("_", " ").split())
    bare = " ".join(word for word in plain.split() if word not in ("the", "a", "an"))
    by_bare = {" ".join(w for w in phrase.split() if w not in ("the", "a", "an")): phrase for phrase in known}
    return plain if plain in known else by_bare[bare]


_WHENS = {"now", "before", "at_first", "since", "after", "before_time", "at_time", "between", "ago", "within", "on_day"}


def _of_verb(verb: str) -> str:
    if verb.startswith(("come back", "came back")):
        return "returned"
    if verb.startswith(("come", "came", "arrive", "appear")):
        return "come"
    return "gone"


_EVENTS: dict[str, Callable[[str], str]] = {
    "GONE": lambda _: "gone",
    "PLACED": lambda _: "come",
    "MOVED": lambda _: "moved",
    "SHOWN": lambda _: "shown",
    "VERB": _of_verb,
    "WENT": lambda _: "gone",
    "LEFT": lambda _: "gone",
    "CAME": _of_verb,
}

BY_PERSON = ("who_did", "what_did", "when_did_by", "whether_did_by", "how_many_did_by", "how_often_by")
"""Kinds of questions about what persons did with things."""

_WITH_AGENT = frozenset(BY_PERSON) - {"who_did"} | {"where_put"}
"""Kinds of questions whose first noun phrase is the person who acts."""

_ASKING_FOR_THINGS = frozenset(
    {"related", "present", "gone", "come", "moved", "shown", "how_many", "how_many_did", "how_many_shown"}
    | {"unmoved", "always"}
    | {"what_did", "how_many_did_by"}
)
"""Kinds of questions for things, whose first noun phrase is a landmark."""

_DONE = ("when_did", "whether_did", "how_many_did", "how_often")
"""Kinds of questions about what happened to things."""

SECONDS = {"second": 1.0, "minute": 60.0, "hour": 3600.0, "day": 86_400.0, "week": 604_800.0}
"""Units of time in seconds."""


def _seconds(tree: Any) -> str:
    number = next((float(each) for each in tree.children if _is_token(each, "NUMBER")), 1.0)
    unit = next(str(each) for each in tree.children if _is_token(each, "UNIT"))
    return repr(number * SECONDS[unit.removesuffix("s")])


def _when(tree: Any) -> When:
    kind = str(tree.data)
    if kind in ("ago", "within"):
        return When(kind, (Moment("ago", _seconds(tree)),))
    if kind == "on_day":
        return When(kind, (Moment("day", str(tree.children[0])),))
    return When(kind, tuple(_moment(each) for each in tree.children if isinstance(each, Tree)))


def _moment(tree: Any) -> Moment:
    kind = str(tree.data)
    if kind == "ago":
        return Moment("ago", _seconds(tree))
    if kind == "event_by":
        nouns = [" ".join(each.children[0].children) for each in tree.children if _is(each, "np")]
        act = next(str(each.children[0]) for each in tree.children if _is(each, "act"))
        return Moment("by", nouns[-1], nouns[0] if len(nouns) == 2 else None, acts_of(act))
    if kind.startswith("event_"):
        return Moment(kind.removeprefix("event_"), " ".join(tree.children[0].children[0].children))
    return Moment(kind, " ".join(map(str, tree.children)))


def _is(part: object, rule: str) -> bool:
    return isinstance(part, Tree) and part.data == rule


def _is_token(part: object, name: str) -> bool:
    return isinstance(part, Token) and part.type == name
