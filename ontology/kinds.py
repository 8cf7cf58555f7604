"""Kinds of things: the taxonomy of tableware, looked up by the words that people use."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property


def plain_name(name: str) -> str:
    """Return the name of an object without its trailing number.

    >>> plain_name("wine_glass_2"), plain_name("fork")
    ('wine_glass', 'fork')
    """
    return re.sub(r"_\d+$", "", name)


def with_article(noun: str) -> str:
    """Return a noun with its indefinite article, chosen by its spelling.

    >>> with_article("egg cup"), with_article("utensil"), with_article("fork")
    ('an egg cup', 'a utensil', 'a fork')
    """
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


class Kinds:
    """All kinds, by IRI and by word.

    >>> from deixis.ontology.tbox import default_ontology
    >>> kinds = default_ontology().kinds
    >>> kinds.of_word("Dessert_Fork").name, kinds.of_word("serviette").name
    ('DessertFork', 'Napkin')
    >>> kinds.is_a(kinds.of_word("dessert fork"), kinds.of_word("cutlery"))
    True
    """

    def __init__(self, kinds: tuple[Kind, ...]) -> None:
        self._all = kinds
        self._by_iri = {kind.iri: kind for kind in kinds}

    def __iter__(self) -> Iterator[Kind]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __contains__(self, iri: object) -> bool:
        """Return whether a kind has this IRI."""
        return iri in self._by_iri

    def __getitem__(self, iri: str) -> Kind:
        return self._by_iri[iri]

    @cached_property
    def words(self) -> dict[str, Kind]:
        """Kinds by word, single-spaced and case-folded; the first of two kinds keeps a word that both have."""
        words: dict[str, Kind] = {}
        for kind in self._all:
            for word in (*kind.words, kind.name.casefold()):
                words.setdefault(word, kind)
        return words

    def of_word(self, word: str) -> Kind | None:
        """Return the kind that a word stands for; ``dinner_plate``, ``Dinner plate`` and ``DinnerPlate`` are equal."""
        return self.words.get(" ".join(word.casefold().replace("_", " ").replace("-", " ").split()))

    def is_a(self, kind: Kind, broader: Kind) -> bool:
        """Return whether ``kind`` is ``broader`` or a subclass of it."""
        return kind.iri == broader.iri or broader.iri in kind.broader
