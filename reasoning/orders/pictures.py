"""Pictures of consistent orders: boxes of small whole numbers that bear out every bound, and nothing about sizes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.orders.bounds import AXES
from deixis.reasoning.orders.choices import State


def picture_of(state: State, n: int) -> NDArray[np.float64]:
    """Boxes of n objects that satisfy a closed, consistent state: shape (n, 2, 3), least and greatest corner.

    Every edge lies at the number of edges on its axis that must be before it: where u must not be after v, all that is
    before u is before v, so that it lies no farther; and where u must be before v, u itself is one more.
    """
    points = 2 * AXES * n
    before = np.unpackbits(state.strong.view(np.uint8), axis=1, bitorder="little")[:, :points].sum(axis=0)
    levels = [np.unique(part, return_inverse=True)[1] for part in before.reshape(AXES, 2 * n)]
    return np.stack(levels).reshape(AXES, 2, n).transpose(2, 1, 0).astype(np.float64)
