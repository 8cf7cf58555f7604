"""Pictures of consistent orders: boxes of small whole numbers that bear out every bound, and nothing about sizes.

Every edge lies at minus the number of edges on its axis that must be after it: where u must not be after v, all that is
after v is after u, so that u lies no farther; and where u must be before v, v itself is one more.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.entailment.bounds import AXES
from deixis.reasoning.entailment.choices import State
from deixis.reasoning.entailment.closed import Orders


def picture_of(state: State, n: int) -> NDArray[np.float64]:
    """Boxes of n objects that satisfy a closed, consistent state: shape (n, 2, 3), least and greatest corner."""
    after = np.bitwise_count(state.strong).sum(axis=1, dtype=np.int64)
    return _boxes(after.reshape(AXES, 2, n))


def picture_of_group(orders: Orders, group: int) -> NDArray[np.float64]:
    """The same for the objects of a connected group, in its order, by closed orders in which no choice is left."""
    n, words = int(orders.groups.sizes[group]), int(orders.groups.words[group])
    after = np.tile(np.array([[1], [0]], np.int64), (AXES, 1, n))
    for axis, rows in enumerate(orders.axes):
        if rows is not None:
            strong = rows.strong[rows.start[group] : rows.start[group + 1]].reshape(2 * n, 2 * words)
            after[axis] = np.bitwise_count(strong).sum(axis=1, dtype=np.int64).reshape(2, n)
    return _boxes(after)


def _boxes(after: NDArray[np.int64]) -> NDArray[np.float64]:
    """Boxes from how many edges must be after each, shape (axes, 2, n): the levels counted from 0."""
    levels = [np.unique(-part, return_inverse=True)[1].reshape(part.shape) for part in after]
    return np.stack(levels).transpose(2, 1, 0).astype(np.float64)
