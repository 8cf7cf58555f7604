"""The colour terms: their words, and the region of the colour space that people call by each."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from deixis.errors import OntologyError
from deixis.ontology.rdf.vocabulary import DX, W3C

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from deixis.ontology.rdf.triple_index import TripleIndex

Rgb = tuple[int, int, int]
"""Red, green and blue in sRGB, each from 0 to 255."""


@dataclass(frozen=True, slots=True)
class Colour:
    """A colour term: its words (label and synonyms, case-folded) and the distribution of colours called by it.

    ``prototype`` is the mean of the distribution, ``covariance`` its covariance in CIELAB, as LL, La, Lb, aa, ab, bb.
    ``broader`` is the IRI of the basic term above a narrower one (blue for navy), None for a basic term.
    """

    iri: str
    label: str
    words: tuple[str, ...]
    prototype: Rgb
    covariance: tuple[float, float, float, float, float, float]
    broader: str | None = None

    def matrix(self) -> NDArray[np.float64]:
        """Return the covariance as a symmetric matrix, shape (3, 3).

        Returns
        -------
        ndarray
            The matrix, in CIELAB.
        """
        import numpy as np

        ll, la, lb, aa, ab, bb = self.covariance
        return np.array([[ll, la, lb], [la, aa, ab], [lb, ab, bb]])


class Colours:
    """All colours, by IRI and by word.

    >>> from deixis.ontology.tbox import default_ontology
    >>> colours = default_ontology().colours
    >>> colours.of_word("Gray").label, colours.of_word("dark_blue").label, colours.of_word("loud")
    ('grey', 'blue', None)
    """

    def __init__(self, colours: tuple[Colour, ...]) -> None:
        self._all = colours
        self._by_iri = {colour.iri: colour for colour in colours}

    def __iter__(self) -> Iterator[Colour]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __getitem__(self, iri: str) -> Colour:
        return self._by_iri[iri]

    @cached_property
    def basic(self) -> tuple[Colour, ...]:
        """The basic terms, which together cover all colours."""
        return tuple(colour for colour in self._all if colour.broader is None)

    @cached_property
    def words(self) -> dict[str, Colour]:
        """Colours by word, single-spaced and case-folded; the first of two colours keeps a word that both have."""
        words: dict[str, Colour] = {}
        for colour in self._all:
            for word in colour.words:
                words.setdefault(word, colour)
        return words

    @cached_property
    def _first_words(self) -> frozenset[str]:
        return frozenset(word.split()[0] for word in self.words)

    @cached_property
    def _longest(self) -> int:
        return max((len(word.split()) for word in self.words), default=0)

    def of_word(self, word: str) -> Colour | None:
        """Return the colour that a word stands for.

        Parameters
        ----------
        word
            The word; ``dark_blue``, ``Dark blue`` and ``dark-blue`` are equal.

        Returns
        -------
        Colour or None
            The colour, or None for other words.
        """
        return self.words.get(" ".join(_parts(word)))

    def split(self, name: str) -> tuple[Colour | None, str]:
        """Return the longest colour at the start of a name, and the rest of the name.

        Parameters
        ----------
        name
            The name.

        Returns
        -------
        tuple
            The colour and the rest. The colour is None where the name starts with no colour, or is a colour and nothing
            else.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> colours = default_ontology().colours
        >>> [(colour and colour.label, rest) for colour, rest in map(colours.split, ("light_blue_mug", "orange"))]
        [('blue', 'mug'), (None, 'orange')]
        """
        parts = _parts(name)
        if len(parts) < 2 or parts[0] not in self._first_words:
            return None, name
        for end in range(min(self._longest, len(parts)), 0, -1):
            colour = self.words.get(" ".join(parts[:end]))
            if colour is not None:
                return (colour, " ".join(parts[end:])) if end < len(parts) else (None, name)
        return None, name


def _parts(name: str) -> list[str]:
    return name.casefold().replace("_", " ").replace("-", " ").split()


def rgb_of_hex(text: str) -> Rgb | None:
    """Return the colour that ``#rrggbb`` stands for.

    Parameters
    ----------
    text
        The text.

    Returns
    -------
    Rgb or None
        Red, green and blue, 0 to 255, or None for any other text.

    Examples
    --------
    >>> rgb_of_hex("#Ff8000"), rgb_of_hex("#f80")
    ((255, 128, 0), None)
    """
    if not re.fullmatch("#[0-9A-Fa-f]{6}", text):
        return None
    red, green, blue = (int(text[start : start + 2], 16) for start in (1, 3, 5))
    return red, green, blue


def hex_of_rgb(rgb: Rgb) -> str:
    """Return the colour as ``#rrggbb``.

    Parameters
    ----------
    rgb
        Red, green and blue, 0 to 255.

    Returns
    -------
    str
        The text, in lower case.

    Examples
    --------
    >>> hex_of_rgb((255, 128, 0))
    '#ff8000'
    """
    return "#{:02x}{:02x}{:02x}".format(*rgb)


def colours_from_triples(triples: TripleIndex, words: dict[str, tuple[str, ...]]) -> Colours:
    """Read all colours from the TBox.

    Parameters
    ----------
    triples
        The statements of the TBox.
    words
        The words of each colour, by IRI.

    Returns
    -------
    Colours
        The colours.

    Raises
    ------
    OntologyError
        If a prototype is not written as ``#rrggbb``, or a spread is not a covariance matrix.
    """
    return Colours(tuple(_colour(iri, triples, words[iri]) for iri in words))


def _colour(iri: str, triples: TripleIndex, words: tuple[str, ...]) -> Colour:
    prototype = rgb_of_hex(triples.only(iri, DX.PROTOTYPE))
    if prototype is None:
        raise OntologyError(f"<{iri}>: a prototype must be written as #rrggbb, got '{triples.only(iri, DX.PROTOTYPE)}'")
    text = triples.only(iri, DX.SPREAD)
    try:
        ll, la, lb, aa, ab, bb = map(float, text.split())
    except ValueError:
        raise OntologyError(f"<{iri}>: a spread must be six numbers (LL La Lb aa ab bb), got '{text}'") from None
    spread = (ll, la, lb, aa, ab, bb)
    minors = (ll, ll * aa - la**2, ll * (aa * bb - ab**2) - la * (la * bb - ab * lb) + lb * (la * ab - aa * lb))
    if not all(map(math.isfinite, spread)) or min(minors) <= 0:  # Sylvester's criterion
        raise OntologyError(f"<{iri}>: its spread must be a positive definite matrix, got '{text}'")
    broader = triples.value(iri, W3C.SKOS_BROADER)
    return Colour(iri, triples.only(iri, W3C.RDFS_LABEL), words, prototype, spread, broader)
