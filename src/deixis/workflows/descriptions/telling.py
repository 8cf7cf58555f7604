"""A text under way: facts, words for their objects, and sentences that are read as the facts."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.grammar.english.telling.telling import MAX_NUMBERED, Designation, ToldSentence, tell_facts
from deixis.grammar.english.vocabulary.adjectives import adjectives
from deixis.grammar.errors import ScriptError
from deixis.grammar.reading import Reading, StatedFact, joined_choices
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.tbox import Ontology, default_ontology

ROUNDS = 8
"""Maximum number of times that a text is read again and the sentences that were misread are said otherwise."""


NOT_READ = "time limit reached: the text was not read again"
"""Note of a text that may be read as something else."""


@dataclass(frozen=True, slots=True)
class ToldObject:
    """An object, the words that the text first names it by, and a description that singles it out.

    ``description`` is None for an object of a layout. ``found`` is True if the description, or the text as a whole,
    refers to this object and no other; it is None where that was not tried.
    """

    id: str
    words: str
    description: str | None = None
    found: bool | None = None


@dataclass(frozen=True, repr=False)
class Telling(Answer):
    """A layout or a scene in English.

    ``facts`` are the facts that the sentences state; a sentence holds their indices. ``left_out`` are facts that
    follow from them, ``misread`` facts that the text states but that :func:`deixis.read_script` does not read in it.

    Examples
    --------
    >>> import deixis
    >>> telling = deixis.tell(deixis.read_script(text="fork left of plate; napkin on plate"))
    >>> telling.text
    'The fork is left of the plate. The napkin is on the plate.'
    >>> len(telling.sentences), [str(fact.content) for fact in telling.facts]
    (2, ['left(fork, plate)', 'on(napkin, plate)'])
    """

    file: str
    sentences: tuple[ToldSentence, ...]
    facts: tuple[StatedFact, ...]
    objects: tuple[ToldObject, ...]
    left_out: tuple[Fact, ...] = ()
    misread: tuple[Fact | Claim, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """All sentences."""
        return " ".join(sentence.text for sentence in self.sentences)

    def summary(self) -> str:
        """Return the file, and the numbers of sentences and facts."""
        return f"{self.file}: {count(len(self.sentences), 'sentence')}, {count(len(self.facts), 'fact')}"


def objects_of(content: Fact | Claim) -> tuple[str, ...]:
    """Return the objects that a fact or a claim is about.

    Parameters
    ----------
    content
        Fact or claim.

    Returns
    -------
    tuple of str
        Subjects first, then objects; a name is repeated if it is mentioned twice.
    """
    return (content.subject, content.object) if isinstance(content, Fact) else (*content.subjects, *content.arguments)


def each_denied(stated: StatedFact) -> Iterator[StatedFact]:
    """Yield a fact; of a denied choice, the denial of each alternative.

    Parameters
    ----------
    stated
        Stated fact or claim.

    Yields
    ------
    StatedFact
        The fact itself if it is positive or a claim; else one denied fact for each of its relations.
    """
    content = stated.content
    if isinstance(content, Claim) or content.positive:
        yield stated
        return
    for relation in content.relations:
        yield replace(stated, content=replace(content, relations=(relation,)))


# Words for objects ----------------------------------------------------------------------------------------------------


def designations(names: Sequence[str]) -> dict[str, Designation]:
    """Return words for the objects of a layout: their names, and ordinals for ``cup_1``, ``cup_2`` and so on.

    Parameters
    ----------
    names
        Names of all objects of the layout.

    Returns
    -------
    dict
        Words for each object, by its name.

    Examples
    --------
    >>> designations(["cup_1", "plate", "cup_2", "2nd?"])["cup_2"]
    Designation(words='cup', number=2, literal=False)
    """
    found: dict[str, Designation] = {}
    groups: dict[str, dict[int, str]] = {}
    plain = {name.casefold() for name in names}
    for name in names:
        numbered = re.fullmatch(r"(.+)_([1-9]\d?)", name)
        if numbered is not None and numbered[1].casefold() not in plain:
            groups.setdefault(numbered[1].casefold(), {})[int(numbered[2])] = name
    counted = {
        name: (stem, number) for stem, group in groups.items() if _is_counted(group) for number, name in group.items()
    }
    for name in names:
        stem, number = counted.get(name, (name.casefold(), None))
        words = stem.replace("_", " ")
        if re.fullmatch(r"[^\W\d_]+([ -][^\W\d_]+)*( [1-9]\d?)?", words) and not _is_elliptic(words):
            found[name] = Designation(words, number)
        else:
            found[name] = literal(name)
    return found


def _is_elliptic(words: str) -> bool:
    """Return True for words that end in an adjective, as *the red* stands for a thing that was named before."""
    last = words.split()[-1]
    dimension = adjectives().get(last)
    return dimension == "colour" or (dimension is not None and default_ontology().kinds.of_word(last) is None)


def _is_counted(group: Mapping[int, str]) -> bool:
    """Return True for numbers from 1 on without a gap."""
    return len(group) > 1 and set(group) == set(range(1, len(group) + 1)) and len(group) <= MAX_NUMBERED


def literal(name: str) -> Designation:
    """Return the name as it is, which the reader takes without reading it.

    Parameters
    ----------
    name
        Name of an object.

    Returns
    -------
    Designation
        Designation that is written between backticks.
    """
    return Designation(name, None, True)


# Reading again --------------------------------------------------------------------------------------------------------


class Plan:
    """Facts and the words for their objects, which are made plainer until reading the text gives the same facts.

    ``misread`` are the facts for which no wording was found; ``read_again`` is False if the time limit was reached
    before the sentences were read.
    """

    def __init__(
        self,
        facts: Sequence[StatedFact],
        words: Mapping[str, Designation],
        surface: str,
        ontology: Ontology,
        literals: Mapping[str, str] | None = None,
    ) -> None:
        self.facts = facts
        self.designations = dict(words)
        self.surface = surface
        self.ontology = ontology
        self.literals = dict(literals or {})
        self.misread: set[int] = set()
        self.quoted: set[int] = set()
        self.read_again = True

    def words(self, name: str) -> str:
        """Return the words for an object without an article.

        Parameters
        ----------
        name
            Name of an object.

        Returns
        -------
        str
            Words with a number where several objects share them, such as ``cup 2``.
        """
        chosen = self.designations[name]
        return chosen.words if chosen.number is None else f"{chosen.words} {chosen.number}"

    def readable(self, deadline: Deadline) -> tuple[ToldSentence, ...]:
        """Return sentences that are read as the facts; ``misread`` are the facts for which no wording was found.

        Parameters
        ----------
        deadline
            Time limit for reading the sentences again.

        Returns
        -------
        tuple of ToldSentence
            Sentences in the order of the facts, joined where they are still read correctly.
        """
        apart: set[int] = set()
        sentences: tuple[ToldSentence, ...] = ()
        for _ in range(ROUNDS):
            sentences = tell_facts(self._worded(), self.designations, self.surface, frozenset(apart))
            self.misread = self._misread(sentences, deadline)
            if not self.misread:
                return self._joined_again(sentences, apart, deadline)
            if self.misread <= apart:
                before = dict(self.designations)
                self._name_literally()
                if before == self.designations and self.misread <= self.quoted:
                    break
            apart |= self.misread
        return sentences

    def _joined_again(
        self, sentences: tuple[ToldSentence, ...], apart: set[int], deadline: Deadline
    ) -> tuple[ToldSentence, ...]:
        """Join the facts that were said apart, now that their objects have other words, if they are read as well."""
        if apart:
            shorter = tell_facts(self._worded(), self.designations, self.surface)
            if not deadline.passed and not self._misread(shorter, deadline) and self.read_again:
                return shorter
            self.read_again = True
        return sentences

    def _worded(self) -> list[StatedFact]:
        """Return the facts with the kinds between backticks that are not read as they are, such as *red wine glass*."""
        worded = list(self.facts)
        self.quoted |= self.misread
        for number in self.quoted:
            content = worded[number].content
            if isinstance(content, Claim) and content.relation == "kind":
                worded[number] = replace(worded[number], content=replace(content, value=f"`{content.value}`"))
        return worded

    def _name_literally(self) -> None:
        """Say the objects that most of the misread facts have in common by their names."""
        named = Counter(name for i in self.misread for name in objects_of(self.facts[i].content))
        named = Counter({name: n for name, n in named.items() if not self.designations[name].literal})
        most = max(named.values(), default=0)
        stems = {self.designations[name].words for name, n in named.items() if n == most}
        for name, chosen in self.designations.items():
            if chosen.words in stems:
                self.designations[name] = literal(self.literals.get(name, name))

    def _misread(self, sentences: Sequence[ToldSentence], deadline: Deadline) -> set[int]:
        """Return the facts of the sentences that are read as something else."""
        from deixis.grammar.english.reader import read_english

        self.read_again = not deadline.passed
        if not self.read_again:
            return set()
        try:
            reading = read_english(" ".join(s.text for s in sentences), "<told>", self.ontology, deadline).reading
        except ScriptError:
            return set(range(len(self.facts)))
        assert reading is not None
        names = self.names_read(reading)
        read: dict[int, set[object]] = {}
        for fact in joined_choices(reading.stated):
            read.setdefault(fact.sentence, set()).update(_parts(fact, names))
        wrong: set[int] = set()
        starts = [start for start, _ in (s.span for s in reading.sentences)]
        if len(starts) != len(sentences):
            return set(range(len(self.facts)))
        for number, sentence in enumerate(sentences):
            intended = {part: i for i in sentence.facts for part in _parts(self.facts[i], {})}
            got = read.get(number, set())
            if not set(intended) <= got or any(part not in intended and not self._is_of_a_name(part) for part in got):
                wrong.update(sentence.facts)
        return wrong

    def _is_of_a_name(self, part: object) -> bool:
        """Return True for what is read in the words for an object: its number, its colour, its size."""
        relation, subjects, value = part[0], part[1], part[3]  # type: ignore[index]
        if relation == "count":
            return True
        words = {
            word for name in subjects if name in self.designations for word in self.designations[name].words.split()
        }
        return relation in ("colour", "size", "material", "shape") and value in words

    def names_read(self, reading: Reading) -> dict[str, str]:
        """Return the object that each name of the reading stands for.

        No two names stand for one object: *the shoes* can be read as two objects, of which one is the object meant.

        Parameters
        ----------
        reading
            What the English reader makes of the sentences.

        Returns
        -------
        dict
            Name of the object by the name that the reader gave it. Names that fit no words of the plan are missing.
        """
        by_words = {self.words(name).replace(" ", "_").casefold(): name for name in self.designations}
        found: dict[str, str] = {}
        for read, mentions in reading.mentions.items():
            phrases = [re.sub(r"^(the|an?) ", "", m.casefold()).replace("`", "") for m in mentions]
            for key in (read, *(phrase.replace(" ", "_") for phrase in phrases)):
                if key in by_words:
                    found[read] = by_words.pop(key)
                    break
        return found


def _parts(stated: StatedFact, names: Mapping[str, str]) -> set[object]:
    """Return the meanings of a fact, several for a denied choice, with what qualifies it."""
    how = (stated.condition, stated.past)
    return {(*meaning_of(one.content, names), how) for one in each_denied(stated)}


def meaning_of(content: Fact | Claim, names: Mapping[str, str]) -> tuple[Any, ...]:
    """Return what a fact says in one form: relation, subjects, arguments, value, and whether and how surely it holds.

    Of a relation and its inverse, the first by name is taken. A fact with a weight of at most one half need not hold,
    so it is optional anyway.

    Parameters
    ----------
    content
        Fact or claim.
    names
        Names by which objects are replaced; names that are missing here stay.

    Returns
    -------
    tuple of Any
        Tuple that is equal for statements with the same meaning.
    """
    weight = min(0.2, content.weight) if content.weight < 0.3 else round(content.weight, 2)
    how = (content.positive, content.optional or content.weight <= 0.5, weight)
    if isinstance(content, Claim):
        subjects = tuple(names.get(name, name) for name in content.subjects)
        arguments = tuple(names.get(name, name) for name in content.arguments)
        return content.relation, subjects, arguments, content.value, content.metres, how
    ends = names.get(content.subject, content.subject), names.get(content.object, content.object)
    forward = tuple(sorted(relation.name for relation in content.relations)), ends
    backward = tuple(sorted(relation.inverse for relation in content.relations)), ends[::-1]
    relations, (subject, thing) = min(forward, backward)
    return relations, (subject,), (thing,), None, None, how
