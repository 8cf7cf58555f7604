"""Kinds of things: the taxonomy of everyday things, looked up by the words that people use."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from deixis.ontology.inflection import is_plural, singulars


def plain_name(name: str) -> str:
    """Return the name of an object without its trailing number.

    Parameters
    ----------
    name
        The name.

    Returns
    -------
    str
        The name without the number and the underscore before it.

    Examples
    --------
    >>> plain_name("wine_glass_2"), plain_name("fork")
    ('wine_glass', 'fork')
    """
    return re.sub(r"_\d+$", "", name)


def with_article(noun: str) -> str:
    """Return a noun with its indefinite article, chosen by its spelling; without one for a plural.

    Parameters
    ----------
    noun
        The noun.

    Returns
    -------
    str
        Article and noun.

    Examples
    --------
    >>> with_article("egg cup"), with_article("utensil"), with_article("fork"), with_article("kitchen scissors")
    ('an egg cup', 'a utensil', 'a fork', 'kitchen scissors')
    """
    if is_plural(noun):
        return noun
    return f"{'an' if re.match(r'(?!eu|one|uni|us|ute)[aeiou]', noun, re.IGNORECASE) else 'a'} {noun}"


@dataclass(frozen=True, slots=True)
class Kind:
    """A class of the taxonomy: its words (label and synonyms, case-folded) and the IRIs of all broader classes."""

    iri: str
    label: str
    words: tuple[str, ...]
    broader: frozenset[str]

    @property
    def name(self) -> str:
        """Local name of the class, such as ``DessertFork``."""
        return self.iri.rsplit("#", 1)[-1]


MEASURES = frozenset({
    "array", "assortment", "bar", "bit", "blob", "bunch", "bundle", "cake", "chunk", "clump", "cluster",
    "collection", "column", "cone", "couple", "crumb", "cube", "dab", "deck", "dollop", "dozen", "drop", "fan",
    "fistful", "flight", "group", "handful", "heap", "hunk", "kind", "knob", "lot", "lump", "number", "pair", "pat",
    "pellet", "piece", "pile", "pinch", "portion", "puddle", "range", "row", "scoop", "scrap", "selection",
    "series", "serving", "set", "sheet", "shred", "slab", "slice", "sliver", "sort", "splash", "sprig", "stack",
    "stalk", "stick", "strand", "strip", "suite", "tablet", "tangle", "teaspoonful", "tuft", "type", "variety",
    "wad", "wedge", "wisp",
})  # fmt: skip
"""Nouns before *of* that leave the kind to the noun after it: a pair of scissors is scissors, a bar of soap is soap.

They tell how many, how much or which shape. Vessels and rolls (*cup*, *spool*) are things of their own.
"""


class FurtherKinds(Protocol):
    """Kinds below those of the TBox by IRI, and the kinds that further words stand for, the usual one first."""

    @property
    def kinds(self) -> Mapping[str, Kind]:
        """Kinds by IRI."""
        ...

    @property
    def words(self) -> Mapping[str, tuple[Kind, ...]]:
        """Kinds by word."""
        ...


class Kinds:
    """All kinds, by IRI and by word: those of the TBox, and those of the lexicon.

    Most scripts need only the TBox. The lexicon (``nouns``) is read at the first word that it lists (``listed``), or at
    the first IRI that the TBox does not know. Iteration and ``len`` cover the TBox.

    >>> from deixis.ontology.tbox import default_ontology
    >>> kinds = default_ontology().kinds
    >>> kinds.of_word("Dessert_Fork").name, kinds.of_word("serviette").name, kinds.of_word("coffee table").name
    ('DessertFork', 'Napkin', 'CoffeeTable')
    >>> kinds.is_a(kinds.of_word("dessert fork"), kinds.of_word("cutlery"))
    True
    """

    def __init__(
        self,
        kinds: tuple[Kind, ...],
        nouns: Callable[[], FurtherKinds] | None = None,
        listed: Callable[[], frozenset[str]] | None = None,
    ) -> None:
        self._all = kinds
        self._by_iri = {kind.iri: kind for kind in kinds}
        self._nouns = nouns
        self._listed = listed
        self._heads: dict[str, tuple[tuple[Kind, ...], str]] = {}

    def __iter__(self) -> Iterator[Kind]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __contains__(self, iri: object) -> bool:
        """Return whether a kind has this IRI."""
        return iri in self._by_iri or (isinstance(iri, str) and iri in self._further_kinds)

    def __getitem__(self, iri: str) -> Kind:
        return self._by_iri[iri] if iri in self._by_iri else self._further_kinds[iri]

    @cached_property
    def words(self) -> dict[str, Kind]:
        """Kinds of the TBox by word, single-spaced and case-folded; the first of two kinds keeps a shared word."""
        words: dict[str, Kind] = {}
        for kind in self._all:
            for word in (*kind.words, kind.name.casefold()):
                words.setdefault(spaced(word), kind)
        return words

    @cached_property
    def every_word(self) -> dict[str, tuple[Kind, ...]]:
        """Kinds of the TBox and the lexicon by word, with all kinds that a word may stand for, the usual one first."""
        every: dict[str, tuple[Kind, ...]] = {word: (kind,) for word, kind in self.words.items()}
        if self._nouns is not None:
            nouns = self._nouns()
            for word, kinds in nouns.words.items():
                every[word] = (*every.get(word, ()), *kinds)
            for kind in nouns.kinds.values():
                every.setdefault(kind.name.casefold(), (kind,))
        return every

    def of_word(self, word: str) -> Kind | None:
        """Return the kind that a word stands for.

        Parameters
        ----------
        word
            The word; ``dinner_plate``, ``Dinner plate`` and ``DinnerPlate`` are equal.

        Returns
        -------
        Kind or None
            The kind, or None for other words.
        """
        plain = spaced(word)
        return self.words.get(plain) or next(iter(self.senses(plain)), None)

    def senses(self, word: str) -> tuple[Kind, ...]:
        """Return all kinds that a word stands for.

        Parameters
        ----------
        word
            The word; *arm chair* and *armchair* are equal.

        Returns
        -------
        tuple of Kind
            The kinds, the usual one first.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> [kind.name for kind in default_ontology().kinds.senses("glasses")]
        ['Glass', 'Spectacles']
        """
        plain = spaced(word)
        joined = plain.replace(" ", "")
        if "every_word" not in vars(self) and self._listed is not None and self._listed().isdisjoint((plain, joined)):
            known = self.words.get(plain) or self.words.get(joined)
            return () if known is None else (known,)
        return self.every_word.get(plain) or self.every_word.get(joined, ())

    def head_noun(self, noun: str) -> tuple[tuple[Kind, ...], str]:
        """Return all kinds that the longest known end of a noun stands for, and the words before this end.

        Plurals count; of *cup of tea*, the cup counts, and of *pair of scissors* the scissors.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        tuple
            The kinds, and the words before the known end. Without a known end, the kinds are empty and the words are
            the whole noun.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> kinds, rest = default_ontology().kinds.head_noun("old_rice_bowls")
        >>> [kind.name for kind in kinds], rest
        (['Bowl'], 'old rice')
        """
        key = spaced(noun)
        if key not in self._heads:
            self._heads[key] = self._find_head(key)
        return self._heads[key]

    def headed(self, noun: str) -> str:
        """Return the part of a noun phrase with *of* that names the thing: the cup of *cup of tea*.

        Parameters
        ----------
        noun
            A noun phrase without its article.

        Returns
        -------
        str
            The phrase before *of*; after a measure, such as *pair*, the phrase after it; a phrase that names a kind as
            a whole, and one without *of*, as it is.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> [default_ontology().kinds.headed(noun) for noun in ("cup of tea", "pair of scissors", "slice of bread")]
        ['cup', 'scissors', 'slice of bread']
        """
        if " of " not in noun or self.senses(noun):
            return noun
        first, _, second = noun.partition(" of ")
        return self.headed(second) if singulars(first)[0].rpartition(" ")[2] in MEASURES else first

    def is_a(self, kind: Kind, broader: Kind) -> bool:
        """Return whether a kind is a broader one or a subclass of it.

        Parameters
        ----------
        kind
            The kind.
        broader
            The broader kind.

        Returns
        -------
        bool
            True if it is.
        """
        return kind.iri == broader.iri or broader.iri in kind.broader

    def parent(self, kind: Kind) -> Kind:
        """Return the narrowest kind above a kind.

        Parameters
        ----------
        kind
            The kind.

        Returns
        -------
        Kind
            Its parent; the kind itself for the kind of all things.
        """
        return max((self[iri] for iri in sorted(kind.broader)), key=lambda above: len(above.broader), default=kind)

    def in_tbox(self, iri: str) -> bool:
        """Return whether the TBox, not only the lexicon, has a kind.

        Parameters
        ----------
        iri
            Class IRI of the kind.

        Returns
        -------
        bool
            True if it has.
        """
        return iri in self._by_iri

    def _find_head(self, noun: str) -> tuple[tuple[Kind, ...], str]:
        words = self.headed(noun).split()
        for start in range(len(words)):
            end = " ".join(words[start:])
            if found := dict.fromkeys(kind for one in (end, *singulars(end)) for kind in self.senses(one)):
                return tuple(found), " ".join(words[:start])
        return (), " ".join(words)

    @property
    def _further_kinds(self) -> Mapping[str, Kind]:
        return self._nouns().kinds if self._nouns is not None else {}


def spaced(word: str) -> str:
    """Return a word case-folded, with single spaces for underscores and hyphens.

    Parameters
    ----------
    word
        The word.

    Returns
    -------
    str
        The word.

    Examples
    --------
    >>> spaced("Coffee_Table")
    'coffee table'
    """
    return " ".join(word.casefold().replace("_", " ").replace("-", " ").split())
