"""Concepts that a rule about things can name: kinds, groups, materials, sizes, shades and words of a name."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from deixis.ontology.inflection import plural
from deixis.ontology.lexicon.groups import Groups
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import spaced
from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

LARGE, SMALL = 0.4, 0.12
"""Usual length in metres at or above which a thing is large, and below which it is small."""

LIGHT, DARK = 65.0, 45.0
"""CIELAB lightness at or above which a colour is light, and below which it is dark."""

IMITATIONS = {
    "stuffed": "stuffed animal",
    "plush": "stuffed animal",
    "cuddly": "stuffed animal",
    "toy": "toy",
    "play": "toy",
}
"""Words before a noun that make the thing a toy, and what the whole is then."""

AMOUNTS = re.compile(
    r"(?:bag|bar|bottle|bowl|box|bunch|can|carton|case|container|cup|glass|jar|jug|loaf|pack|package|packet|pair|piece|roll"
    r"|sack|set|sheet|slice|spool|stack|stick|tin|tub|tube)s? of (?P<what>.+)"
)
"""Names of an amount of something, which goes where that goes: *bag of pretzels*, *bar of soap*."""

LIGHT_WORDS, DARK_WORDS = frozenset({"light", "pale", "pastel"}), frozenset({"dark", "deep"})

TOO_GENERAL = 0.9
"""Share of all kinds beyond which a kind says nothing about a thing."""

WORD_SIZE, DESCRIBED_SIZE = 30, 100
"""Approximate number of kinds with a given word in their name, and of those with a given material, size or shade."""


class Aspect(StrEnum):
    """Respect in which things of a concept are alike."""

    GROUP = "group"
    KIND = "kind"
    DESCRIPTION = "description"
    SIZE = "size"
    WORD = "word"


COSTS = {Aspect.GROUP: 0.0, Aspect.KIND: 0.5, Aspect.DESCRIPTION: 1.0, Aspect.WORD: 2.0, Aspect.SIZE: 3.0}
"""Description length in bits by which a concept is less likely to be meant than a group."""


@dataclass(frozen=True, order=True)
class Concept:
    """A concept with its word and the approximate number of kinds that it covers."""

    aspect: Aspect
    label: str
    size: int

    @property
    def words(self) -> str:
        """Words for all things of the concept.

        >>> Concept(Aspect.KIND, "toy", 129).words, Concept(Aspect.DESCRIPTION, "glass", 100).words
        ('toys', 'glass things')
        """
        match self.aspect:
            case Aspect.KIND:
                return plural(self.label)
            case Aspect.DESCRIPTION | Aspect.SIZE:
                return f"{self.label} things"
            case Aspect.WORD:
                return f"things with '{self.label}' in their name"
        return self.label


class Concepts:
    """The concepts of things, from the taxonomy, the groups and the adjectives of an ontology.

    >>> from deixis.ontology.tbox import default_ontology
    >>> concepts = Concepts(default_ontology())
    >>> sorted(concept.label for concept in concepts.of("copper pan") if concept.aspect is Aspect.GROUP)
    ['cookware']
    """

    def __init__(self, ontology: Ontology) -> None:
        self._ontology = ontology
        self._cache: dict[str, frozenset[Concept]] = {}

    @property
    def groups(self) -> Groups:
        """The groups of household things."""
        return self._ontology.lexicon.groups

    def of(self, thing: str) -> frozenset[Concept]:
        """Return the concepts of a thing; a number after its name distinguishes things of one name and is left out.

        Parameters
        ----------
        thing
            Name of a thing.

        Returns
        -------
        frozenset of Concept
            Its groups, kinds and descriptions, computed once for each name.
        """
        name = re.sub(r"\s+\d+$", "", spaced(thing))
        if name not in self._cache:
            whole = name if self._is_listed(name) else _meant(name)
            self._cache[name] = frozenset({*self._by_kind(whole), *self._by_description(name)})
        return self._cache[name]

    def _is_listed(self, name: str) -> bool:
        """Return whether the lexicon or a group lists the name as a whole."""
        lexicon = self._ontology.lexicon
        return lexicon.knows(name) or self.groups.known_as(name)[1] == lexicon.singular(name)

    def knows(self, thing: str) -> bool:
        """Return whether the lexicon or a group has the thing.

        Parameters
        ----------
        thing
            Name of a thing.

        Returns
        -------
        bool
            False if only its description is known, or nothing.
        """
        return any(concept.aspect in (Aspect.GROUP, Aspect.KIND) for concept in self.of(thing))

    def named(self, words: str) -> Concept | None:
        """Return the concept that the words of a stated rule name: a group, a kind, or a description of things.

        Parameters
        ----------
        words
            Words such as *cutlery*, *all cups* or *red things*.

        Returns
        -------
        Concept or None
            The concept, or None.
        """
        plain = re.sub(r"^(?:all|every|each|any|the)\s+|\s+(?:things?|items?|ones?)$", "", spaced(words))
        if group := self.groups.of_word(plain):
            return self._of_group(group.label, self.groups.size(group))
        described = (Aspect.DESCRIPTION, Aspect.SIZE)
        found = [concept for concept in self._by_description(plain) if concept.aspect in described]
        if plain != spaced(words) and found:
            return found[0]
        kind = next(iter(self._ontology.lexicon.senses(plain)), None)
        if kind is not None and self._ontology.lexicon.knows(plain):
            return Concept(Aspect.KIND, kind.label, self.groups.narrower(kind))
        return found[0] if found else None

    def _by_kind(self, name: str) -> list[Concept]:
        found = [self._of_group(group.label, self.groups.size(group)) for group in self.groups.of(name)]
        kind, _ = self.groups.known_as(name)
        if kind is not None:
            kinds = self._ontology.kinds
            total = max(self.groups.narrower(kinds[iri]) for iri in {*kind.broader, kind.iri})
            for iri in {*kind.broader, kind.iri}:
                size = self.groups.narrower(kinds[iri])
                if size <= TOO_GENERAL * total or total == size == 1:
                    found.append(Concept(Aspect.KIND, kinds[iri].label, size))
        return found

    def _by_description(self, name: str) -> list[Concept]:
        lexicon, words = self._ontology.lexicon, re.findall(r"[^\W\d_]+", name)
        found = [Concept(Aspect.WORD, lexicon.singular(word), WORD_SIZE) for word in words]
        described, sizes = set(), set()
        for word in words:
            meaning = lexicon.adjective(word)
            if meaning is None:
                continue
            if meaning.dimension == "size":
                sizes |= {"large"} if meaning.sign > 0 else {"small"} if meaning.sign < 0 else set()
                continue
            described.add(meaning.value)
            colour = self._ontology.colours.of_word(word) if meaning.dimension == "colour" else None
            if colour is not None:
                described |= _shades(colour.prototype)
        if not LIGHT_WORDS.isdisjoint(words):
            described = (described - {"dark"}) | {"light"}
        elif not DARK_WORDS.isdisjoint(words):
            described = (described - {"light"}) | {"dark"}
        if not sizes and self.groups.known_as(name)[0] is not None:
            length = lexicon.size_of(name).length.typical
            sizes |= {"large"} if length >= LARGE else {"small"} if length < SMALL else set()
        for aspect, values in ((Aspect.DESCRIPTION, described), (Aspect.SIZE, sizes)):
            found += [Concept(aspect, value, DESCRIBED_SIZE) for value in sorted(values)]
        return found

    @staticmethod
    def _of_group(label: str, size: int) -> Concept:
        return Concept(Aspect.GROUP, label, size)


def _meant(name: str) -> str:
    """Return what an imitation or an amount is: a toy for *toy fox*, soap for *bar of soap*; other names unchanged."""
    imitation = IMITATIONS.get(name.partition(" ")[0]) if " " in name else None
    amount = AMOUNTS.fullmatch(name)
    return imitation or (amount["what"] if amount else name)


def _shades(rgb: tuple[int, int, int]) -> set[str]:
    lightness = lab_of_srgb(np.array(rgb, dtype=np.float64))[..., 0].item()
    return {"light"} if lightness >= LIGHT else {"dark"} if lightness < DARK else set()
