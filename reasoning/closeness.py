"""How close the exact name of a pair comes to what a fact admits: by steps between directions.

A direction is one of the 3 by 3 tiles around a box; two directions are as many steps apart as there are tiles from the
one to the other, diagonals taking two (Goyal and Egenhofer, "Similarity of Cardinal Directions", SSTD 2001). *On* and
*under* share the middle tile, two steps apart.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import Allen, allen_mask
from deixis.ontology.relation import Reading, Relation, Relations

Array = NDArray[np.float64]

STEP = 0.5
"""By what similarity is multiplied for every step: it falls exponentially with distance (Shepard 1987)."""


class Closeness:
    """How close each exact name is to what a fact admits, by relation index: 1 admitted, half with every step."""

    def __init__(self, vocabulary: Relations) -> None:
        self._vocabulary = vocabulary
        exact = vocabulary.of_reading(Reading.EXACT)
        tiles = {relation.index: _tile(relation) for relation in exact}
        self._steps = {
            (a, b): sum(abs(x - y) for x, y in zip(tiles[a], tiles[b], strict=True)) for a in tiles for b in tiles
        }
        self._names = tuple(tiles)
        self._known: dict[tuple[int, bool], Array] = {}

    def __call__(self, mask: int, positive: bool) -> Array:
        if (mask, positive) not in self._known:
            self._known[mask, positive] = self._work_out(mask, positive)
        return self._known[mask, positive]

    def _work_out(self, mask: int, positive: bool) -> Array:
        members = [relation.index for relation in self._vocabulary.members(mask)]
        implied = self._vocabulary.degrees[members].max(axis=0, initial=0.0) > 0
        admitted = [name for name in self._names if implied[name] == positive]
        result = np.zeros(len(self._vocabulary))
        for name in self._names:
            if admitted:
                result[name] = STEP ** min(self._steps[name, other] for other in admitted)
        return result


def _tile(relation: Relation) -> tuple[int, int, int]:
    """Where the subject lies about the object: -1, 0 or 1 on x and y, and 1 or -1 on top of it or below."""
    before, after = allen_mask([Allen.BEFORE, Allen.MEETS]), allen_mask([Allen.AFTER, Allen.MET_BY])
    x, y = (
        -1 if not atoms & ~before else 1 if not atoms & ~after else 0 for atoms in (relation.x_atoms, relation.y_atoms)
    )
    above = 0 if x or y else 1 if relation.word == "on" else -1
    return x, y, above
