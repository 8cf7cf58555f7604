"""Read the joints of a sentence otherwise, choose a reading, and find what only some of the readings say.

A comma or *and* can join noun phrases, modifiers or clauses, and the words seldom tell which. Of readings that are
understood equally well, the one with the fewest propositions about the same things is kept. What it says and a rival
does not say is contested.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from deixis.grammar.english.chunking.chunk import Chunk
from deixis.grammar.english.clauses.joints import is_within_list
from deixis.grammar.english.clauses.places import is_place
from deixis.grammar.english.tree import NounPhrase, Predicate, Sentence, Span

MAX_OTHER_JOINTS = 6
"""Number of joints of a sentence that are read as the end of a clause."""
_GAPS = frozenset({"between", "among"})
"""Relations to at least two things."""


def other_joints(chunks: list[Chunk]) -> Iterator[tuple[list[Chunk], bool]]:
    """Yield the chunks of a sentence with one comma or *and* as the end of a clause.

    Parameters
    ----------
    chunks
        Chunks of the sentence as the chunker found them.

    Yields
    ------
    tuple of (list of Chunk, bool)
        Copy of the chunks in which one joint ends a clause; True if the joint is a conjunction.
    """
    joints = [
        i for i, chunk in enumerate(chunks)
        if chunk.type in ("COMMA", "AND")
        and not (_in_list(chunks, i) or _joins_directions(chunks, i) or _shares_article(chunks, i))
    ]  # fmt: skip
    for i in joints[:MAX_OTHER_JOINTS]:
        copies = [replace(chunk) for chunk in chunks]
        copies[i].type = "CUT"
        yield copies, chunks[i].type == "AND"


def _in_list(chunks: list[Chunk], at: int) -> bool:
    """Return True for a comma between bare noun phrases of a list: *a drum, a doll and a kite*, *cup, jug, tin*."""
    types = [chunk.type for chunk in chunks]
    if is_within_list(chunks, at):
        return True  # also 'a mug, a bar on a dish and a comb'
    if types[at : at + 2] != ["COMMA", "NP"] or at == 0 or types[at - 1] != "NP":
        return False
    first = last = at
    while types[max(0, first - 2) : first] == ["COMMA", "NP"]:
        first -= 2
    while types[last + 2 : last + 4] == ["COMMA", "NP"]:
        last += 2
    last += types[last + 2 : last + 4] == ["COMMA", "AND"]
    return last > first or types[last + 2 : last + 4] == ["AND", "NP"]


def _joins_directions(chunks: list[Chunk], at: int) -> bool:
    """Return True for *and* between two relations of one thing: *to the left of and above the napkin and fork*."""
    if at == 0 or chunks[at].type != "AND" or [chunk.type for chunk in chunks[at + 1 : at + 3]] != ["PREP", "NP"]:
        return False
    if not chunks[at + 2].value.head:
        return False  # 'in the centre, and around it lay almonds'
    before = chunks[at - 1]
    return before.type in ("OF", "ADV") or (before.type == "NP" and is_place(before.value))


def _shares_article(chunks: list[Chunk], at: int) -> bool:
    """Return True for *and* between two nouns with one article: *the knife and spoon*, *the cups and saucers*."""
    if chunks[at].type != "AND" or [chunk.type for chunk in chunks[at - 1 : at + 2 : 2]] != ["NP", "NP"]:
        return False
    before, after = chunks[at - 1].value, chunks[at + 1].value
    bare = bool(after.head) and after.determiner is None and after.owner is None and after.count is None
    return bare and before.determiner is not None and after.plural <= before.plural


def settled(first: Sentence, others: Iterable[tuple[Sentence, bool]]) -> Sentence:
    """Return the reading of a sentence to keep, with the predicates that a rival does not have.

    Parameters
    ----------
    first
        Reading of the sentence as it stands.
    others
        Readings that are understood as well, and True for each in which a conjunction is read otherwise.

    Returns
    -------
    Sentence
        The reading with the fewest propositions about the same things. Its ``contested`` has the spans of the
        predicates of which a rival lacks a proposition. A rival reads a conjunction otherwise, or says less.

    Examples
    --------
    >>> from deixis.grammar.english.parse import parse_english
    >>> sentence, = parse_english("The fork is left of the plate.")
    >>> settled(sentence, [(sentence, True)]).contested
    frozenset()
    """
    rivals = [(_Propositions.by(other), other, in_conjunction) for other, in_conjunction in others]
    if not rivals:
        return first
    kept, ours = first, _Propositions.by(first)
    rejected = ours.all
    guessed = any(clause.guesses for clause in first.clauses) or bool(first.guesses)
    for theirs, other, _ in rivals:
        simpler = (theirs.odd, theirs.number) < (ours.odd, ours.number) and theirs.number <= ours.number
        if not guessed and simpler and theirs.can_replace(ours):
            kept, ours = other, theirs
    contested: set[Span] = set()
    for theirs, _, in_conjunction in rivals:
        if kept is not first and theirs.all == rejected:
            continue  # as the reading that was replaced
        if (in_conjunction or theirs.number < ours.number) and theirs.can_replace(ours):
            contested |= {span for span, proposition in ours.spans if not theirs.has(proposition)}
    return replace(kept, contested=frozenset(contested))


@dataclass(frozen=True, slots=True)
class _Proposition:
    """A relation of two things, which are known by their places in the text; None where there is none."""

    relation: str
    first: int | None
    second: int | None
    value: str
    positive: bool


@dataclass(frozen=True, slots=True)
class _Propositions:
    """Propositions of a reading, with the places of its pronouns."""

    spans: list[tuple[Span, _Proposition]]
    all: set[_Proposition]
    pronouns: set[int]
    odd: (
        int  # unlike coordinations, gaps with one side ('between the cup'), several things without a place after *with'
    )

    @property
    def number(self) -> int:
        """Number of propositions that do not equate two things."""
        return sum(proposition.relation != "kind" for proposition in self.all)

    @staticmethod
    def by(sentence: Sentence) -> _Propositions:
        """Return what a sentence says."""
        pronouns: set[int] = set()
        odd = 0
        spans = []
        for subject, predicate, positive in _predicates(sentence):
            ends = [end for argument in predicate.arguments for end in _things(argument)]
            firsts = [] if subject is None else list(_things(subject))
            pronouns |= {phrase.span[0] for phrase in (*firsts, *ends) if phrase.pronoun in ("it", "they")}
            odd += predicate.relation in _GAPS and len(ends) == 1 and not (ends[0].plural or ends[0].pronoun)
            odd += sum(_is_unlike(argument) for argument in predicate.arguments)
            odd += predicate.relation == "with" and all(not a.predicates and not a.owner for a in predicate.arguments)
            if predicate.reversed:
                firsts, ends = ends, firsts
            value = predicate.value.word if predicate.value is not None else predicate.part or ""
            for first in _places(firsts):
                for second in _places(ends):
                    sign = positive and predicate.positive
                    spans.append((predicate.span, _Proposition(predicate.relation, first, second, value, sign)))
        return _Propositions(spans, {proposition for _, proposition in spans}, pronouns, odd)

    def can_replace(self, other: _Propositions) -> bool:
        """Return True if the same things take part, no two more are equated, and no gap has only one side."""
        equated = any(p.relation == "kind" and p not in other.all for p in self.all)
        idle = {place for p in other.all for place in (p.first, p.second)}
        idle -= {place for p in self.all for place in (p.first, p.second)}
        return not equated and self.odd <= other.odd and not idle - {None}

    def has(self, proposition: _Proposition) -> bool:
        """Return True for a proposition of this reading, one of whose things may be a pronoun or left out."""
        return proposition in self.all or any(
            (p.first == proposition.first and (p.second is None or p.second in self.pronouns))
            or (p.second == proposition.second and p.first in self.pronouns)
            for p in self.all
            if (p.relation, p.value, p.positive) == (proposition.relation, proposition.value, proposition.positive)
        )


def _predicates(sentence: Sentence) -> Iterator[tuple[NounPhrase | None, Predicate, bool]]:
    """Yield the predicates of a sentence with what they are said about, and False for those of a denied clause."""
    for clause in sentence.clauses:
        if clause.subject is not None:
            yield from _restrictions(clause.subject)
        for predicates in (clause.predicates, *clause.choices):
            yield from _with_inner(clause.subject, predicates, clause.positive)
    if sentence.fragment is not None:
        yield from _restrictions(sentence.fragment)


def _with_inner(
    subject: NounPhrase | None, predicates: tuple[Predicate, ...], positive: bool
) -> Iterator[tuple[NounPhrase | None, Predicate, bool]]:
    """Yield predicates, and the restrictions of their arguments."""
    for predicate in predicates:
        yield subject, predicate, positive
        for argument in predicate.arguments:
            yield from _restrictions(argument)


def _restrictions(phrase: NounPhrase) -> Iterator[tuple[NounPhrase | None, Predicate, bool]]:
    """Yield the restrictions of a phrase and of its parts."""
    yield from _with_inner(phrase, phrase.predicates, True)
    for part in (*phrase.members, *([phrase.of] if phrase.of is not None else [])):
        yield from _restrictions(part)


def _is_unlike(phrase: NounPhrase) -> bool:
    """Return True for a coordination that begins with an article, and goes on without one: *the tray and forks*."""
    first, *rest = phrase.members or (phrase,)
    bare = (p for p in rest if p.determiner is None and p.owner is None and p.count is None)
    return first.determiner is not None and any(p.plural or p.pronoun == "one" for p in bare)


def _places(phrases: list[NounPhrase]) -> list[int | None]:
    """Return where phrases begin, or None alone."""
    return [phrase.span[0] for phrase in phrases] or [None]


def _things(phrase: NounPhrase) -> Iterator[NounPhrase]:
    """Yield the members of a coordination, or the phrase."""
    if not phrase.members:
        yield phrase
    for member in phrase.members:
        yield from _things(member)
