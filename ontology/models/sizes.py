"""Learned sizes of kinds and their triples: one model per kind, derived (PROV-O) from the scenes that showed it.

The triples hold no time, so that the same lessons always give the same triples; the lessons state their times.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import pyoxigraph as ox

from deixis.errors import OntologyError
from deixis.ontology.rdf.triple_index import TripleIndex
from deixis.ontology.rdf.triples import LEARNED, Description, iri, learned_iri, typed
from deixis.ontology.rdf.vocabulary import BASE, DX, PROV, W3C


@dataclass(frozen=True, slots=True)
class SizeModel:
    """Log-normal length (longer side seen from above) and aspect (shorter by longer side) of a kind of thing.

    A ``relative`` model is learned from images: its length is in units of the median length in the scene, and its
    aspect is height by width, since objects in images are upright.
    """

    length: tuple[float, float]  # mean and standard deviation of the natural logarithm
    aspect: tuple[float, float]
    relative: bool = False
    views: float = 0.0


SIZE_PROPERTIES = (
    W3C.RDF_TYPE, DX.OF_KIND, DX.MEDIAN_LENGTH, DX.LENGTH_DEVIATION, DX.MEDIAN_ASPECT, DX.ASPECT_DEVIATION,
    DX.RELATIVE_LENGTH, DX.VIEW_COUNT,
)  # fmt: skip
"""Predicates of a size model, except its link to the scenes that it is derived from."""


def size_iri(kind: str) -> str:
    """Return the IRI of the size model of a kind.

    Parameters
    ----------
    kind
        Class IRI of the kind.

    Returns
    -------
    str
        The IRI of the model.
    """
    return learned_iri("size-model", kind.removeprefix(BASE).removeprefix(LEARNED))


def size_triples(kind: str, model: SizeModel, scenes: Iterable[str]) -> Iterator[ox.Triple]:
    """Yield the triples of the size model of a kind.

    Parameters
    ----------
    kind
        Class IRI of the kind.
    model
        The model.
    scenes
        IRIs of the scenes that it was learned from.

    Yields
    ------
    ox.Triple
        A triple.
    """
    about = Description(size_iri(kind))
    about.say(W3C.RDF_TYPE, iri(DX.SIZE_MODEL))
    about.say(DX.OF_KIND, iri(kind))
    about.say(DX.MEDIAN_LENGTH, typed(_median(model.length[0])))
    about.say(DX.LENGTH_DEVIATION, typed(float(model.length[1])))
    about.say(DX.MEDIAN_ASPECT, typed(_median(model.aspect[0])))
    about.say(DX.ASPECT_DEVIATION, typed(float(model.aspect[1])))
    about.say(DX.RELATIVE_LENGTH, typed(model.relative))
    about.say(DX.VIEW_COUNT, typed(int(model.views)))
    about.say(PROV.WAS_DERIVED_FROM, *(iri(scene) for scene in scenes))
    return iter(about)


def _median(logarithm: float) -> float:
    """Return the exponential of a logarithm, rounded to six digits to remove rounding errors."""
    return float(f"{math.exp(logarithm):.6g}")


def sizes_from_triples(triples: Iterable[ox.Triple]) -> dict[str, SizeModel]:
    """Return all size models in some triples.

    Parameters
    ----------
    triples
        The triples.

    Returns
    -------
    dict
        Model by the class IRI of its kind.

    Raises
    ------
    OntologyError
        If a model is incomplete.
    """
    index = TripleIndex(triples)
    sizes = {}
    for subject in index.subjects(W3C.RDF_TYPE, DX.SIZE_MODEL):
        values = {}
        for prop in (DX.MEDIAN_LENGTH, DX.LENGTH_DEVIATION, DX.MEDIAN_ASPECT, DX.ASPECT_DEVIATION, DX.VIEW_COUNT):
            written = index.only(subject, prop)
            try:
                number = float(written)
            except ValueError:
                number = math.nan
            if not 0 < number < math.inf:
                raise OntologyError(f"<{subject}>: <{prop}> must be a number above 0, got '{written}'")
            values[prop] = number
        relative = index.only(subject, DX.RELATIVE_LENGTH)
        sizes[index.only(subject, DX.OF_KIND)] = SizeModel(
            length=(math.log(values[DX.MEDIAN_LENGTH]), values[DX.LENGTH_DEVIATION]),
            aspect=(math.log(values[DX.MEDIAN_ASPECT]), values[DX.ASPECT_DEVIATION]),
            relative=relative == "true",
            views=values[DX.VIEW_COUNT],
        )
    return dict(sorted(sizes.items()))
