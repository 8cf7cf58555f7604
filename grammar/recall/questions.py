"""Read questions about then and now.

>>> question = read_question("Where was the fork before?")
>>> question.kind, question.thing, question.when.kind
('where', 'fork', 'before')
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedInput

from deixis.errors import DeixisError
from deixis.grammar.layout.words import phrase_pattern
from deixis.grammar.recall.acts import act_terminals, acts_of, reworded
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
)
"""Wordings of all kinds of questions; a question that is not understood is answered with the nearest ones."""

_NUMBERS = {
    name: str(number)
    for number, name in enumerate(("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"), 1)
} | {"a": "1", "an": "1", "half an": "0.5"}
_NUMBER_WORDS = "|".join(sorted(_NUMBERS, key=len, reverse=True))
_COUNTED = re.compile(rf"\b({_NUMBER_WORDS}) (?=(?:second|minute|hour|day|week)s?\b)")

_HERE = r"(?:here|there|around|present|at (?:the|this|my|our) (?:table|desk)|in (?:the|this|my|our) (?:room|kitchen))"
_ANYONE = r"(?:(?:any|some) ?(?:one|body)|people)"
_REWORDED = tuple(
    (re.compile(pattern), wording)
    for pattern, wording in (
        (r"^where (?:had|has|have) (.+?) been\b", r"where was \1"),
        (r"^where (?:is|are|has|have) (.+?) (?:gone|went)\b(?: to\b)?", r"where did \1 go"),
        (r"^(?:since when|how long) (?:is|are|was|were|has|have) (.+?) (?:been )?where (?:it is|they are)(?: now)?$",
         r"where is \1"),
        (rf"^who is (?:now )?{_HERE}(?: (?:right )?now)?$", "who was there in the last 1 minute"),
        (rf"^who (?:was|were|has been|have been)(?: (?:just|still))? {_HERE}\b", "who was there"),
        (r"^(?:whom?|which (?:people|persons)) (?:did|have) you (?:see|seen|meet|met|hear|heard)\b", "who was there"),
        (rf"^(?:was|were|has|have) (?:{_ANYONE})(?: been)? {_HERE}\b", "who was there"),
        (rf"^how many (?:people|persons) (?:were|are|have been) {_HERE}\b", "how many people were there"),
        (r"^who (?:came|dropped|stopped)(?: (?:by|in|round|over|along|here))*"
         r"(?= (?:today|yesterday|since|before|after|at|in|between|this)\b|$)", "who was there"),
        (rf"^(?:any|some) ?(?:one|body) {_HERE}\b", "who was there"),
        (rf"^who was the (first|last)(?: one| person)? (?:to be )?{_HERE}$", r"who was there \1"),
        (r"^(?:was|were|has|have|is|are) ([\w ]+?)(?: still)?(?: ever)?(?: been)? (?:here|around|present)\b",
         r"was \1 there"),
        (r"^(what|which [\w ]+?) (?:stood|lay|sat)\b", r"\1 was"),
        (r"^(where (?:is|are|was|were) .+?) (?:standing|lying|sitting|placed)\b", r"\1"),
        (r"^what (?:is|was) different(?: now)?\b", "what changed"),
        (r"^(?:when|how long) (?:was|were|has|have) ([\w ]+?)(?: been)? (?:here|around|present)\b",
         r"how long was \1 there"),
        (r"^who (?:spoke|talked|said (?:any|some)thing)(?: to you)?\b", "what did anyone say"),
        (r"^who did you (?:talk|speak|listen) (?:to|with)\b", "what did anyone say"),
        (r"^what (?:was|were) the (first|last) (?:thing|sentence|word)s? (?:that )?(.+?) (?:said|told you)\b",
         r"what did \2 say \1"),
        (r"^what (?:did|have) you (?:say|said)\b", "what did the robot say"),
        (r"^what (?:have|did) you (?:ever )?learn(?:ed|t)? from (.+)", r"what did \1 show you"),
        (r"^what (?:did|has|have) (.+?) (?:teach|taught) you\b", r"what did \1 show you"),
        (r"^(?:has|have|is|was|were) (.+?) always (?:been )?there\b", r"how long was \1 there"),
        (r"^did (.+?) (?:always )?(?:stay|remain)(?: (?:where (?:it|they) (?:was|were)|there|in (?:its|their) place))?"
         r"(?: all the time)?$", r"how long was \1 there"),
        (r"^(?:since when|how long) (?:is|are|was|were|has|have) (.+?)(?: been)? (?:gone|missing|away)\b",
         r"when did \1 go"),
        (r"^where do(?:es)? (.+?) (?:belong|live)\b|^where (?:is|are) (.+?) (?:usually |normally )?(?:kept|stored)\b",
         lambda found: f"what did anyone say about {found[1] or found[2]}"),
        (r"^where should (.+?) (?:be (?:put|kept|stored)|be|go|stand|lie)\b", r"what did anyone say about \1"),
        (r"^where did (.+?) end up\b", r"where did \1 go"),
        (r"^where (?:is|are) (?:everything|all (?:of )?the (?:things|objects))\b", "what is there"),
        (r"^(?:what|how) did (?:the|this|my|our) (?:table|desk) look(?: like)?\b", "what was there"),
        (r"^who (?:told|said)(?: (?:you|us|me|anything|something))* about\b", "what did anyone say about"),
        (r"^where did (.+?) used? to be\b", r"where was \1 before"),
        (r"\b(?:has|have) gone\b", "went"),
        (r"\b(?:has|have) come\b", "came"),
        (r"\b(?:has|have) (?=(?:left|disappeared|vanished|arrived|appeared|moved)\b)", ""),
        (r"^what have you been shown\b", "what was shown"),
        (r"^what (?:(?:was|has been) said|(?:have you been|were you) (?:told|taught)) about\b",
         "what did anyone say about"),
        (r"^(?:did|have|has) (.+?) (?:ever )?(?:mention(?:ed)?|talk(?:ed)? about|sa(?:y|id) anything about) ",
         r"what did \1 say about "),
        (r"^what do you (?:know|remember) about\b", "what did anyone say about"),
        (rf"^did {_ANYONE} (?:take|remove|clear)(?: away| off)? (.+?)(?=$| since| before| after| at| in| between)",
         r"was \1 taken away"),
        (rf"^what did {_ANYONE} (?:take|clear|remove)(?: away| off)?\b", "what was taken away"),
        (rf"^did {_ANYONE} (?:move|shift|push)\b (.+?)(?=$| since| before| after| at| in| between)", r"was \1 moved"),
        (rf"^what did {_ANYONE} move\b", "what was moved"),
        (rf"^what did {_ANYONE} (?:(?:put|lay|set) down|bring|add)\b", "what was put down"),
        (r"\b(?:most recently|lastly)\b", "last"),
        (r"^what (?:is|was) the (first|last|latest) (?:thing|object|one) (?:that |which )?"
         r"((?:was |has been )?(?:moved|removed|taken away|put down|placed|added|shown)|came|went|appeared|vanished)\b",
         lambda found: f"what {found[2].replace('has been', 'was')} {found[1]}"),
        (r"\blatest\b", "last"),
        (r"^(what (?:came|appeared)) (after|before) ((?:the|an?) (?:(?!came|went|moved|was|were|left)\w+ ?)+)$",
         r"\1 \2 \3 came"),
        (r"^what (?:do|can) you see\b", "what is there"),
        (r"^(what|which [\w ]+?) (?:did|have) you (?:see|seen)\b(?! yet)", r"\1 came"),
        (r"^(?:did|have) you (?:ever )?(?:see|seen) (.+?)(?=$| since| before| after| at| in| between)", r"did \1 come"),
        (r"^when did you first see (.+)$", r"when did \1 come first"),
        (r"^(where|when) (?:have|did) you (?:last (?:see|seen) (.+)|(?:see|seen) (.+) last)$",
         lambda found: f"{found[1]} did you last see {found[2] or found[3]}"),
        (r"^when (was|were) (.+) there$", r"how long \1 \2 there"),
        (r"^(?:has|did) (?:any|some)thing (?:changed?|happen(?:ed)?)\b(?! to)", "what changed"),
        (r"^(?:has|did) (?:any|some)thing happen(?:ed)? to ", "what happened about "),
        (r"^what (?:(?:has |had )?(?:happened (?:to|with)|become of)|became of) ", "what happened about "),
        (r"^what (?:is|has|was) (?:been )?(?:going on|happening)\b|^what went on\b", "what happened"),
    )
)  # fmt: skip
"""Wordings that ask for the same as others, each a pattern and its replacement."""

_HOURS = ["one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve"]
_PARTS = {"quarter": 15, "a quarter": 15, "half": 30, "five": 5, "ten": 10, "twenty": 20, "twenty five": 25}
_SPOKEN = re.compile(
    rf"\b(?:({'|'.join(sorted(_PARTS, key=len, reverse=True))}) (?:minutes )?(past|to) )?({'|'.join(_HOURS)}|\d{{1,2}})"
    r"(?: (o'clock|oclock))?\b"
)


def _spoken_time(found: re.Match[str]) -> str:
    """Return a spoken time of day in digits: *half past eleven* as 11:30; a plain number remains unchanged."""
    part, side, hour, o_clock = found.groups()
    if part is None and o_clock is None:
        return found[0]
    hours = int(hour) if hour.isdigit() else _HOURS.index(hour) + 1
    minutes = 60 * hours + (_PARTS[part] * (1 if side == "past" else -1) if part else 0)
    return f"{minutes // 60}:{minutes % 60:02d}"


_PREFACE = (
    r"^\s*((please|hey|hi|hello|so|now|and|well|ok|okay|excuse me|((can|could|would|will) you (please )?)?tell me|"
    r"do you (know|remember)|can you remember|i (want|would like|'d like) to know|i wonder)\s+)+"
)
"""Words before a question that do not belong to it."""

_ASKS = re.compile(
    r"\s*(?:please |can you |tell me |do you (?:know|remember) )*"
    r"(?:where|what|which|who|when|since when|how (?:many|long)|is|are|was|were|did|has|have)\b",
    re.IGNORECASE,
)
"""Beginning of a text that may be a question."""


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
    """The time that a question asks about: ``kind`` is a rule of the grammar, with up to two moments."""

    kind: str = "unstated"
    moments: tuple[Moment, ...] = ()


@dataclass(frozen=True, slots=True)
class RecallQuestion:
    """A question about then and now.

    ``kind`` is the alternative of the grammar (``where``, ``related``, ``gone``, …), ``thing`` and ``other`` are nouns
    without articles, ``relation`` is the name of a relation, ``event`` what happened to the thing, ``speaker`` the
    person named, ``of_asker`` True if the person is the one who asks, and ``order`` ``first`` or ``last``. ``acts`` is
    what a person did: some of ``put``, ``moved`` and ``took``.
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
    if len(text) > MAX_QUESTION:
        raise RecallQuestionError(f"a question must have at most {MAX_QUESTION} characters, got {len(text)}")
    ontology = ontology or default_ontology()
    try:
        tree = _parser(tuple(_relation_words(ontology))).parse(_plain(text))
    except UnexpectedInput as error:
        raise _not_understood(text) from error
    return _question(text, tree.children[0], ontology)


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


def _plain(text: str) -> str:
    """Return a question in lower case, without punctuation, with contractions and numbers written out."""
    plain = text.lower().replace("\u2019", "'").replace("which ones", "which one")
    plain = re.sub(r"\b(where|what|who|when|it|that|there)'s\b", r"\1 is", plain)
    plain = re.sub(r"\b(is|are|was|were|has|have|did|do|does)n't\b", r"\1 not", plain)
    plain = re.sub(r"\b(have|has|did|were|was|are|is) you not\b|\b(have|has) not you\b", r"you \1\2 not", plain)
    plain = re.sub(r"\b(have|has) (i|we) told\b", r"did \2 tell", plain)
    plain = re.sub(r"[?!,;\"]|\.(?=\s|$)", " ", plain)
    plain = re.sub(r"\b(a|p)\.m\.?(?=\s|$)", r"\1m", plain)
    plain = re.sub(_PREFACE, "", plain)
    plain = re.sub(r"\bwhich (?=did\b)|\bwhich (one )?of (them|these|those)\b", "which one ", plain)
    plain = re.sub(r"\s+please\s*$", "", plain.replace("how many times", "how often"))
    plain = reworded(_SPOKEN.sub(_spoken_time, " ".join(plain.split())))
    for pattern, wording in _REWORDED:
        plain = pattern.sub(wording, plain)
    plain = re.sub(r"\bstill\b|(?<=\w )here\b", "", plain)
    return " ".join(_COUNTED.sub(lambda found: f"{_NUMBERS[found[1]]} ", plain).split())


def _not_understood(text: str) -> RecallQuestionError:
    near = difflib.get_close_matches(_plain(text), [_plain(each) for each in WORDINGS], n=2, cutoff=0.0)
    wordings = {_plain(each): each for each in WORDINGS}
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


def _question(text: str, tree: Any, ontology: Ontology) -> RecallQuestion:
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
    return RecallQuestion(
        text=text,
        kind=kind,
        thing=thing,
        other=other,
        relation=None if relation is None else _relation_words(ontology)[_phrase(relation, ontology)],
        event=_EVENTS[events[0].type](str(events[0])) if events and kind in _DONE else None,
        speaker=" ".join(map(str, speaker.children)) if isinstance(speaker, Tree) else person,
        order=order,
        when=_when(whens[0]) if whens else When(),
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
    if verb.startswith(("come", "arrive", "appear")):
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
    "CAME": lambda _: "come",
}

BY_PERSON = ("who_did", "what_did", "when_did_by", "whether_did_by", "how_many_did_by", "how_often_by")
"""Kinds of questions about what persons did with things."""

_WITH_AGENT = frozenset(BY_PERSON) - {"who_did"} | {"where_put"}
"""Kinds of questions whose first noun phrase is the person who acts."""

_ASKING_FOR_THINGS = frozenset(
    {"related", "present", "gone", "come", "moved", "shown", "how_many", "how_many_did", "how_many_shown"}
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
