"""Say a list of facts as English sentences that the reader reads as the same facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from deixis.grammar.english.telling.wording import (
    auxiliary,
    clause_of_claim,
    listed,
    oriented,
    said_of_claim,
    said_of_fact,
)
from deixis.grammar.english.vocabulary.function_words import NUMBERS, ORDINALS
from deixis.grammar.reading import StatedFact
from deixis.ontology.graph.facts import Fact
from deixis.ontology.inflection import is_plural, plural
from deixis.ontology.things.kinds import with_article

MAX_PREDICATES = 4
"""Maximum number of predicates in a sentence."""

MAX_NAMED = 8
"""Maximum number of objects that one phrase lists."""

_ORDINAL = {rank: word for word, rank in reversed(ORDINALS.items()) if rank > 0 and word.isalpha()}
_NUMBER = {number: word for word, number in reversed(NUMBERS.items())}
MAX_NUMBERED = max(_ORDINAL)
"""Maximum number of objects that are told apart by ordinals."""


BLOCK = 300
"""Maximum number of facts that are searched together for common subjects and predicates."""

WORDS_OF_SUBJECT = 3
"""Words that a further sentence about a subject costs."""

_Key = tuple[str, tuple[str, ...], bool]
"""Start and objects of a predicate, and whether it is denied."""


@dataclass(frozen=True, slots=True)
class Designation:
    """Words for an object: a noun phrase without its article, and a number among the objects with these words.

    ``literal`` is True for a name that is written between backticks, as the reader takes it without reading it.
    """

    words: str
    number: int | None = None
    literal: bool = False


@dataclass(frozen=True, slots=True)
class ToldSentence:
    """A sentence, and the indices of the facts that it states."""

    text: str
    facts: tuple[int, ...]


@dataclass(frozen=True)
class _Point:
    """A thing to say: a predicate of one or more subjects; ``start`` is its words before the objects."""

    number: int
    subjects: tuple[str, ...]
    start: str
    objects: tuple[str, ...]
    mode: tuple[object, ...]
    denied: bool
    stated: StatedFact

    @property
    def key(self) -> _Key:
        """Predicate without its subjects."""
        return self.start, self.objects, self.denied


@dataclass
class _Sentence:
    """Subjects that share all of the predicates; ``order`` is the place of the first of its facts."""

    subjects: tuple[str, ...]
    points: list[_Point] = field(default_factory=list)

    @property
    def order(self) -> int:
        return min(point.number for point in self.points)


def tell_facts(
    facts: Sequence[StatedFact],
    designations: Mapping[str, Designation],
    surface: str = "table",
    apart: frozenset[int] = frozenset(),
) -> tuple[ToldSentence, ...]:
    """Say facts in as few sentences as read well.

    Predicates of one subject, and subjects of one predicate, are joined. Objects that share their words are introduced
    by their number (*There are two cups.*) and are then *the first cup* and *the second cup*.

    Parameters
    ----------
    facts
        Facts and claims; a choice is one fact with several relations.
    designations
        Words for each object.
    surface
        Noun of what everything stands on.
    apart
        Indices of facts that are said in a sentence of their own.

    Returns
    -------
    tuple of ToldSentence
        Sentences in the order in which they are said, each with the indices of its facts.

    Examples
    --------
    >>> from deixis.grammar.layout.parser import parse_script
    >>> script = parse_script("fork left of plate; fork below glass; spoon left of plate; spoon below glass")
    >>> facts = [StatedFact(fact, 0, (0, 0)) for fact in script.facts]
    >>> [told.text for told in tell_facts(facts, {name: Designation(name) for name in script.objects})]
    ['The fork and the spoon are left of the plate and nearer to you than the glass.']
    """
    names = _Names(designations)
    points: list[_Point] = []
    alone: list[int] = []
    for number, stated in enumerate(facts):
        point = _point(number, stated, surface)
        if point is None or number in apart:
            alone.append(number)
        else:
            points.append(point)
    sentences = [part for joined in _aggregated(points) for part in _cut(joined)]
    plan: list[tuple[int, _Sentence | int]] = [(sentence.order, sentence) for sentence in sentences]
    plan += [(number, number) for number in alone]
    told: list[ToldSentence] = []
    for _, part in sorted(plan, key=lambda entry: entry[0]):
        text, numbers = (
            (_alone(facts[part], surface, names), (part,))
            if isinstance(part, int)
            else (_realised(part, names), tuple(sorted(point.number for point in part.points)))
        )
        told += [ToldSentence(f"There are {intro}.", ()) for intro in names.introductions()]
        told.append(ToldSentence(f"{text[0].upper()}{text[1:]}.", numbers))
    return tuple(told)


def _point(number: int, stated: StatedFact, surface: str) -> _Point | None:
    """Return a fact as a predicate that can be joined with others; None for one that needs a sentence of its own."""
    content = stated.content
    mode = (content.optional, content.weight, stated.past, stated.uncertain, stated.condition, stated.alternative)
    if isinstance(content, Fact):
        if len(content.relations) > 1 or stated.alternative is not None:
            return None
        subject, thing, words = oriented(content)
        return _Point(number, (subject,), words[0], (thing,), mode, not content.positive, stated)
    if len(content.subjects) > 1 or content.optional or content.arguments or content.weight < 1:
        return None
    clause = said_of_claim(content, surface)
    return None if clause is None else _Point(number, content.subjects, clause, (), mode, not content.positive, stated)


def _alone(stated: StatedFact, surface: str, names: _Names) -> str:
    """Return the clause of a fact that is not joined with others."""
    content = stated.content
    if isinstance(content, Fact):
        subject, _, words = oriented(content)
        subjects: tuple[str, ...] = (subject,)
        top = names.phrase(subjects, introducing=True)
        predicate: str | None = said_of_fact(content, names.phrase)[1]
        denied = not content.positive and len(words) == 1
    elif content.relation == "count" and (counted := names.counted(content.subjects)):
        return _conditional(stated, f"there are {counted}")
    else:
        subjects, denied = content.subjects, not content.positive
        own_clause = said_of_claim(content, surface) is None
        top = "" if own_clause else names.phrase(subjects, introducing=True)
        predicate = said_of_claim(content, surface, names.phrase)
    be = auxiliary(stated, plural=len(subjects) > 1 or names.is_plural(subjects[0])) + (" not" if denied else "")
    if predicate is None:
        assert not isinstance(content, Fact)
        return _conditional(stated, clause_of_claim(content, be, names.phrase))
    return _conditional(stated, f"{top} {be} {predicate}")


def _conditional(stated: StatedFact, clause: str) -> str:
    return f"{stated.condition}, {clause}" if stated.condition else clause


def _aggregated(points: Sequence[_Point]) -> list[_Sentence]:
    """Group points into sentences of common subjects and predicates; only points of one mode can be joined."""
    by_mode: dict[tuple[object, ...], list[_Point]] = {}
    for point in points:
        by_mode.setdefault(point.mode, []).append(point)
    return [
        sentence
        for group in by_mode.values()
        for first in range(0, len(group), BLOCK)
        for sentence in _joined(group[first : first + BLOCK])
    ]


def _joined(points: Sequence[_Point]) -> Iterator[_Sentence]:
    """Yield sentences, greedily: the subjects of one predicate are joined where that saves the most words."""
    left: dict[str, dict[_Key, _Point]] = {}
    for point in points:
        left.setdefault(point.subjects[0], {}).setdefault(point.key, point)
    while left:
        by_key: dict[_Key, list[str]] = {}
        for subject, predicates in left.items():
            for key in predicates:
                by_key.setdefault(key, []).append(subject)
        best: tuple[int, tuple[str, ...], set[_Key]] = (0, (), set())
        for subjects in {tuple(subjects) for subjects in by_key.values() if len(subjects) > 1}:
            common = set.intersection(*(set(left[subject]) for subject in subjects))
            saved = (len(subjects) - 1) * sum(_words(key) for key in common)
            repeated = sum(WORDS_OF_SUBJECT for subject in subjects if len(left[subject]) > len(common))
            best = max(best, (saved - repeated, subjects, common), key=lambda found: (found[0], found[1]))
        gain, subjects, common = best
        if gain <= 0:
            break
        yield _Sentence(
            subjects, [left[subject].pop(key) for subject in subjects for key in list(left[subject]) if key in common]
        )
        left = {subject: predicates for subject, predicates in left.items() if predicates}
    for subject, predicates in left.items():
        yield _Sentence((subject,), list(predicates.values()))


def _words(key: _Key) -> int:
    start, objects, _ = key
    return len(start.split()) + 2 * len(objects)


def _cut(sentence: _Sentence) -> Iterable[_Sentence]:
    """Cut a sentence with too many subjects or predicates into several."""
    keys = list(dict.fromkeys((point.start, point.denied) for point in sentence.points))
    for first in range(0, len(sentence.subjects), MAX_NAMED):
        subjects = sentence.subjects[first : first + MAX_NAMED]
        for start in range(0, len(keys), MAX_PREDICATES):
            chosen = set(keys[start : start + MAX_PREDICATES])
            points = [p for p in sentence.points if p.subjects[0] in subjects and (p.start, p.denied) in chosen]
            yield _Sentence(subjects, points)


def _realised(sentence: _Sentence, names: _Names) -> str:
    """Return a sentence without its full stop."""
    subjects = sentence.subjects
    top = names.phrase(subjects, introducing=True)
    objects: dict[tuple[str, bool], list[str]] = {}
    for point in sentence.points:
        listed_objects = objects.setdefault((point.start, point.denied), [])
        listed_objects += [thing for thing in point.objects if thing not in listed_objects]
    predicates: list[str] = []
    for (start, denied), things in sorted(objects.items(), key=lambda entry: entry[0][1]):
        before = f"not {start}" if denied else start
        if not things:
            predicates.append(before)
        elif denied:
            predicates += [f"{before} {names.phrase([thing])}" for thing in things]
        else:
            predicates += [
                f"{before} {names.phrase(things[i : i + MAX_NAMED])}" for i in range(0, len(things), MAX_NAMED)
            ]
    stated = sentence.points[0].stated
    be = auxiliary(stated, plural=len(subjects) > 1 or names.is_plural(subjects[0]))
    clause = f"{top} {be} {_predicates(predicates)}"
    return _conditional(stated, clause)


def _predicates(said: Sequence[str]) -> str:
    """Join predicates; a comma goes before the last *and* where a predicate has one of its own."""
    if len(said) > 1 and any(" and " in predicate for predicate in said):
        return f"{', '.join(said[:-1])}, and {said[-1]}"
    return listed(said)


class _Names:
    """Namer of objects; it remembers which groups and which indefinite names were introduced."""

    def __init__(self, designations: Mapping[str, Designation]) -> None:
        self.designations = designations
        self.groups: dict[str, list[str]] = {}
        for name, designation in designations.items():
            if designation.number is not None:
                self.groups.setdefault(designation.words, []).append(name)
        self.introduced: set[str] = set()
        self.waiting: list[str] = []
        words = [d.words for d in designations.values() if not d.literal]
        self.confusable = {w for w in words if any(_contains(w, other) for other in words)}

    def introductions(self) -> list[str]:
        """Return the groups that were mentioned and not introduced yet, as one phrase, and forget them."""
        groups, self.waiting = self.waiting, []
        return [listed([self._counted(words) for words in groups])] if groups else []

    def counted(self, names: Sequence[str]) -> str | None:
        """Introduce a group that was not mentioned: *two cups*; None for what is not a whole group."""
        words = self.designations[names[0]].words
        if words in self.introduced or self.groups.get(words, []) != list(names):
            return None
        self.introduced.add(words)
        return self._counted(words)

    def _counted(self, words: str) -> str:
        return f"{_NUMBER.get(len(self.groups[words]), '')} {plural(words)}"

    def is_plural(self, name: str) -> bool:
        """Return True for an object whose words are a plural, such as *the scissors* and *the first scissors*."""
        return is_plural(self.designations[name].words)

    def phrase(self, names: Sequence[str], introducing: bool = False) -> str:
        """Return the words for objects; ``introducing`` is True for a subject, which can introduce a whole group."""
        parts: list[str] = []
        left = list(dict.fromkeys(names))
        while left:
            name = left.pop(0)
            designation = self.designations[name]
            if designation.number is None:
                parts.append(self._single(designation))
                continue
            members = self.groups[designation.words]
            whole = {name, *left}.issuperset(members)
            new = designation.words not in self.introduced
            self.introduced.add(designation.words)
            if whole:
                left = [other for other in left if other not in members]
            if whole and new and introducing:
                parts.append(self._counted(designation.words))
                continue
            if new:
                self.waiting.append(designation.words)
            if whole:
                parts.append(f"the {plural(designation.words)}")
            else:
                parts.append(f"the {_ORDINAL[designation.number]} {designation.words}")
        return listed(parts)

    def _single(self, designation: Designation) -> str:
        words = designation.words
        if designation.literal:
            return f"the {words}" if "_" in words.strip("_") and words.replace("_", "").isalnum() else f"the `{words}`"
        if words in self.confusable and words not in self.introduced:
            self.introduced.add(words)
            return with_article(words)
        return f"the {words}"


def _contains(words: str, other: str) -> bool:
    """Return True if one of two different noun phrases ends in the other, so that they could name one thing."""
    return words != other and (words.endswith(f" {other}") or other.endswith(f" {words}"))
