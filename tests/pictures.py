"""All pictures of a few things, by brute force: every order of their edges, axis by axis, as integer end points."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact
from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.ontology.relations.relation import Relation
from deixis.reasoning.geometry.allen import allen_relations


@cache
def orders(n: int) -> NDArray[np.int8]:
    """Compute the distinct Allen codes of n proper intervals on one axis, of shape (pictures, n, n)."""
    spans = [(low, high) for low in range(2 * n) for high in range(low + 1, 2 * n)]
    ends = np.array(list(product(spans, repeat=n)), dtype=np.float64)
    low, high = ends[:, :, 0], ends[:, :, 1]
    codes = allen_relations(low[:, :, None], high[:, :, None], low[:, None, :], high[:, None, :])
    return np.unique(codes, axis=0)


def bears(relation: Relation, s: int, o: int, n: int, axes: int) -> NDArray[np.bool_]:
    """Mark the pictures in which s has the relation to o; each axis of the result is an axis of space."""
    masks = (relation.x_atoms, relation.y_atoms, relation.z_atoms or ALL_ALLEN)[:axes]
    held = [(mask >> orders(n)[:, s, o].astype(np.int64) & 1).astype(bool) for mask in masks]
    result = held[0]
    for more in held[1:]:
        result = result[..., None] & more
    return result


def satisfying(facts: list[Fact], names: str, axes: int) -> NDArray[np.bool_]:
    """Mark the pictures in which all firm facts hold."""
    n = len(names)
    kept = np.ones((len(orders(n)),) * axes, dtype=bool)
    for fact in facts:
        if not fact.optional and fact.weight >= 1:
            s, o = names.index(fact.subject), names.index(fact.object)
            some = np.logical_or.reduce([bears(relation, s, o, n, axes) for relation in fact.relations])
            kept &= some if fact.positive else ~some
    return kept
