"""Difference constraints at random, and shortest paths by an implementation of its own."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.constraints.difference import Difference, add_arrays

AXES, POINTS = 2, 5
FREE = 1 << 62

DIFFERENCE = st.builds(
    lambda axis, tail, head, bound, strict: Difference(axis, tail, head, 2 * bound + (not strict)),
    st.integers(0, AXES - 1),
    st.integers(0, POINTS - 1),
    st.integers(0, POINTS - 1),
    st.integers(-3, 4),
    st.booleans(),
).filter(lambda d: d.tail != d.head)
ORDER = st.builds(lambda d, strict: d._replace(code=int(not strict)), DIFFERENCE, st.booleans())


def floyd_warshall(constraints: list[Difference]) -> NDArray[np.int64] | None:
    """Return the codes of the shortest paths on each axis; None where there is a negative cycle."""
    table = np.full((AXES, POINTS, POINTS), FREE)
    table[:, np.arange(POINTS), np.arange(POINTS)] = 1
    for axis, tail, head, code in constraints:
        table[axis, tail, head] = min(table[axis, tail, head], code)
    for k in range(POINTS):
        table = np.minimum(table, add_arrays(table[:, :, k, None], table[:, None, k, :]))
    return None if (table[:, np.arange(POINTS), np.arange(POINTS)] < 1).any() else table
