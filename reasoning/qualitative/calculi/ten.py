"""Build a calculus of the ten exact names: unions of rectangle-algebra atoms, as the TBox states them.

The eleventh atom, ``overlap``, holds the atoms that have no single name in the plane: boxes that overlap in part, or
are equal. (Between perceived boxes, heights and offsets settle these too, which no calculus of the plane can do: see
:mod:`deixis.reasoning.geometry.rectangle`.)
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.relation import Reading, Relations
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, TableCalculus, coarsening

UNNAMED = "overlap"


def ten_names(vocabulary: Relations, rectangles: ProductCalculus) -> TableCalculus:
    """Return the calculus of the ten exact names and ``overlap``.

    Parameters
    ----------
    vocabulary
        Relations of the ontology.
    rectangles
        The rectangle algebra.

    Returns
    -------
    TableCalculus
        The calculus, with eleven atoms.
    """
    parts = named_parts(vocabulary)
    return coarsening(
        "ten",
        tuple(parts),
        tuple(parts.values()),
        rectangles,
        source="Grounding Language in Perception, its ten relations",
    )


def named_parts(vocabulary: Relations) -> dict[str, int]:
    """Map each of the eleven names to its rectangle-algebra atoms; an atom with several names goes to ``overlap``.

    Parameters
    ----------
    vocabulary
        Relations of the ontology.

    Returns
    -------
    dict
        Relation of the rectangle algebra, as a bit mask, by name.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> calculus("ra").members(named_parts(default_ontology().relations)["top_left"])
    ('<,mi', '<,>', 'm,mi', 'm,>')
    """
    exact = vocabulary.of_reading(Reading.EXACT)
    admitted = np.stack([relation.admits() for relation in exact])
    single = admitted.sum(axis=0) == 1
    named = {relation.word: _mask(table & single) for relation, table in zip(exact, admitted, strict=True)}
    return {**named, UNNAMED: _mask(~single)}


def _mask(atoms: NDArray[np.bool_]) -> int:
    """Return the relation of a (13, 13) truth table: codes of the product count y fastest, as its C order does."""
    return sum(1 << int(code) for code in np.flatnonzero(atoms))
