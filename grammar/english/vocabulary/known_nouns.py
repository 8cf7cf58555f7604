"""Nouns that the ontology knows: they decide the singular of open cases, and compounds that begin with an adjective."""

from __future__ import annotations

from functools import lru_cache

from deixis.grammar.english.vocabulary.adjectives import adjectives
from deixis.grammar.english.vocabulary.tables import LITERAL, word_set
from deixis.ontology.inflection import SAME, singulars
from deixis.ontology.things.kinds import Kinds

_PART_OF_NAME = frozenset({"other", "state", "shape", "thickness", "position", "count"})
"""Dimensions of adjectives that can be part of a compound; a colour, a size or a material describes the thing."""
_NAMING = word_set("light cream olive orange chocolate tin cotton rubber steel iron pine mini full")
_BOARDS = frozenset({("white", "board"), ("black", "board")})


class KnownNouns:
    """Nouns of an ontology and its lexicon."""

    def __init__(self, kinds: Kinds) -> None:
        self._words = kinds.every_word
        self._singulars: dict[str, tuple[str, bool]] = {}
        self._compounds: dict[str, list[tuple[str, ...]]] = {}
        dimensions = adjectives()
        for phrase in self._words:
            words = tuple(phrase.split())
            dimension = dimensions.get(words[0])
            names = dimension in _PART_OF_NAME or words[0] in _NAMING or words in _BOARDS
            if len(words) > 1 and dimension is not None and "of" not in words and names:
                self._compounds.setdefault(words[0], []).append(words)
        for entries in self._compounds.values():
            entries.sort(key=len, reverse=True)

    def knows(self, noun: str) -> bool:
        """Return True for a noun of the ontology, in the singular or the plural.

        Parameters
        ----------
        noun
            Noun or compound.

        Returns
        -------
        bool
            True if the ontology or its lexicon has the noun.
        """
        return any(one in self._words for one in (noun, *singulars(noun)))

    def singular(self, noun: str) -> tuple[str, bool]:
        """Return the singular of a noun, and whether the noun is a plural.

        Parameters
        ----------
        noun
            Noun or compound in lower case; one from backticks stays as it is.

        Returns
        -------
        tuple of str and bool
            Singular, and True for a plural. A singular that the ontology knows is preferred.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> nouns = known_nouns(default_ontology().kinds)
        >>> nouns.singular("vases"), nouns.singular("glass"), nouns.singular("scissors"), nouns.singular("cookies")
        (('vase', True), ('glass', False), ('scissors', True), ('cookie', True))
        """
        if noun.startswith(LITERAL):
            return noun, False
        found = self._singulars.get(noun)
        if found is None:
            candidates = singulars(noun)
            one = next((candidate for candidate in candidates if candidate in self._words), candidates[0])
            found = one, one != noun or (noun in SAME and noun.endswith("s"))
            if len(self._singulars) < MAX_REMEMBERED:
                self._singulars[noun] = found
        return found

    def compound(self, norms: list[str], at: int) -> int | None:
        """Return the end of a known compound that begins with an adjective: *light switch*, *hot plate*.

        Parameters
        ----------
        norms
            Normal forms of the words of the sentence.
        at
            Index of the adjective.

        Returns
        -------
        int or None
            Index after the last word of the longest such compound; None if no compound begins there.
        """
        for words in self._compounds.get(norms[at], ()):
            end = at + len(words)
            if norms[at : end - 1] == list(words[:-1]) and words[-1] in (
                norms[end - 1],
                self.singular(norms[end - 1])[0],
            ):
                return end
        return None


MAX_REMEMBERED = 50_000
"""Number of nouns whose singular is kept."""


@lru_cache(maxsize=8)
def known_nouns(kinds: Kinds) -> KnownNouns:
    """Return the known nouns of an ontology, made once."""
    return KnownNouns(kinds)
