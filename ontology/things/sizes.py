"""Usual sizes of kinds of things in metres, as stated in the TBox with their sources."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import TYPE_CHECKING, Protocol

from deixis.errors import OntologyError
from deixis.ontology.rdf.vocabulary import DX, W3C

if TYPE_CHECKING:
    from deixis.ontology.rdf.triple_index import TripleIndex


ABOUT_AS_LARGE = 1.6
"""Maximum ratio of typical lengths of two kinds that are about as large."""


class Outline(StrEnum):
    """Shape of a thing seen from above."""

    CIRCLE = "circle"
    RECTANGLE = "rectangle"


@dataclass(frozen=True, slots=True)
class Extent:
    """A range of lengths in metres, or of ratios, with a typical value."""

    least: float
    typical: float
    greatest: float

    def __str__(self) -> str:
        return f"{100 * self.least:.3g} to {100 * self.greatest:.3g} cm"

    def admits(self, metres: float, tolerance: float = 0.0) -> bool:
        """Return whether a length lies in the range.

        Parameters
        ----------
        metres
            The length.
        tolerance
            Metres by which it may lie outside.

        Returns
        -------
        bool
            True if it does.

        Examples
        --------
        >>> Extent(0.2, 0.25, 0.3).admits(0.31), Extent(0.2, 0.25, 0.3).admits(0.31, tolerance=0.02)
        (False, True)
        """
        return self.least - tolerance <= metres <= self.greatest + tolerance


@dataclass(frozen=True, slots=True)
class SizeRange:
    """The usual size of a kind: ``length`` is the longer side seen from above, ``width`` the shorter one.

    For a circle, both are the diameter. ``reach`` is how far a handle sticks out, as a share of the length, which does
    not include it; None for kinds without a handle. ``stated_of`` is the IRI of the kind that states the size: the kind
    itself or its nearest broader one. ``source`` cites the origin of the numbers.
    """

    outline: Outline
    length: Extent
    width: Extent
    height: Extent
    stated_of: str
    source: str
    reach: Extent | None = None

    def __str__(self) -> str:
        if self.outline is Outline.CIRCLE:
            return f"{self.length} across"
        return f"{self.length} long and {self.width} wide"

    def is_about_as_large_as(self, other: SizeRange) -> bool:
        """Return whether typical length and height differ by a factor of at most ``ABOUT_AS_LARGE``.

        Parameters
        ----------
        other
            The size to compare with.

        Returns
        -------
        bool
            True if they do not differ by more.
        """
        pairs = ((self.length, other.length), (self.height, other.height))
        return all(max(a.typical, b.typical) <= ABOUT_AS_LARGE * min(a.typical, b.typical) for a, b in pairs)


class FurtherSizes(Protocol):
    """Sizes of kinds below those of the TBox, and the parents of these kinds, by IRI."""

    @property
    def sizes(self) -> Mapping[str, SizeRange]:
        """Sizes by kind."""
        ...

    @property
    def parents(self) -> Mapping[str, tuple[str, ...]]:
        """Parents by kind."""
        ...


class Sizes:
    """The size of every kind, by IRI; a kind without its own size takes that of its nearest broader kind.

    >>> from deixis.ontology.tbox import default_ontology
    >>> ontology = default_ontology()
    >>> print(ontology.sizes.of(ontology.kinds.of_word("soup spoon").iri))
    15 to 20 cm long and 3 to 5.5 cm wide
    >>> ontology.sizes.of(ontology.kinds.of_word("salt shaker").iri).stated_of.rsplit("#")[-1]
    'Shaker'
    """

    def __init__(
        self,
        stated: Mapping[str, SizeRange],
        parents: Mapping[str, Iterable[str]],
        nouns: Callable[[], FurtherSizes] | None = None,
    ) -> None:
        self._stated = dict(stated)
        self._parents = {iri: tuple(above) for iri, above in parents.items()}
        self._nouns = nouns

    def of(self, kind: str | None) -> SizeRange:
        """Return the size of a kind.

        Parameters
        ----------
        kind
            Class IRI of the kind, or None for the size of all things.

        Returns
        -------
        SizeRange
            The size, in metres.

        Raises
        ------
        OntologyError
            If the TBox states no size of all things.
        """
        if kind is not None and kind not in self._parents and self._nouns is not None:
            self._take_in(self._nouns())
        level = [kind or DX.THING.value]
        seen: set[str] = set()
        while level:
            for iri in sorted(level):
                if iri in self._stated:
                    return self._stated[iri]
            seen.update(level)
            level = [above for iri in level for above in self._parents.get(iri, ()) if above not in seen]
        if DX.THING in self._stated:
            return self._stated[DX.THING]
        raise OntologyError(f"<{DX.THING}> has no usual size, so unknown things have none; state one")

    def _take_in(self, nouns: FurtherSizes) -> None:
        self._stated.update(nouns.sizes)
        self._parents.update(nouns.parents)
        self._nouns = None


_EXTENTS = {
    "length": (DX.LEAST_LENGTH, DX.TYPICAL_LENGTH, DX.GREATEST_LENGTH),
    "width": (DX.LEAST_WIDTH, DX.TYPICAL_WIDTH, DX.GREATEST_WIDTH),
    "height": (DX.LEAST_HEIGHT, DX.TYPICAL_HEIGHT, DX.GREATEST_HEIGHT),
    "reach": (DX.LEAST_REACH, DX.TYPICAL_REACH, DX.GREATEST_REACH),
}


def sizes_from_triples(triples: TripleIndex, nouns: Callable[[], FurtherSizes] | None = None) -> Sizes:
    """Read all sizes from the TBox.

    Parameters
    ----------
    triples
        The statements of the TBox.
    nouns
        Function that reads the lexicon, with the sizes of the kinds that the TBox does not have.

    Returns
    -------
    Sizes
        The sizes.

    Raises
    ------
    OntologyError
        If a size is incomplete or its numbers are out of order.
    """
    classes = triples.subjects(W3C.RDF_TYPE, W3C.OWL_CLASS)
    stated = {iri: _size_range(iri, triples) for iri in classes if triples.values(iri, DX.OUTLINE)}
    return Sizes(stated, {iri: triples.values(iri, W3C.RDFS_SUB_CLASS_OF) for iri in classes}, nouns)


def _size_range(iri: str, triples: TripleIndex) -> SizeRange:
    named = triples.only(iri, DX.OUTLINE)
    if named not in list(Outline):
        raise OntologyError(f"<{iri}>: an outline must be one of {', '.join(Outline)}, got '{named}'")
    outline = Outline(named)
    length = _extent(iri, "length", triples)
    return SizeRange(
        outline=outline,
        length=length,
        width=length if outline is Outline.CIRCLE else _extent(iri, "width", triples),
        height=_extent(iri, "height", triples),
        stated_of=iri,
        source=triples.only(iri, W3C.DCTERMS_SOURCE),
        reach=_extent(iri, "reach", triples) if triples.values(iri, DX.TYPICAL_REACH) else None,
    )


def _extent(iri: str, name: str, triples: TripleIndex) -> Extent:
    texts = [triples.only(iri, term) for term in _EXTENTS[name]]
    try:
        least, typical, greatest = map(float, texts)
    except ValueError:
        raise OntologyError(f"<{iri}>: its {name} must be three numbers, got {', '.join(texts)}") from None
    if not 0 < least <= typical <= greatest < float("inf"):
        raise OntologyError(f"<{iri}>: its least, typical and greatest {name} must be above 0 and in that order")
    return Extent(least, typical, greatest)
