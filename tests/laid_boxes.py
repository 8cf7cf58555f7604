"""Boxes for graded meaning: strategies, and two golden things."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

NUMBERS = st.integers(-20, 20)
SIDES = st.integers(0, 12)


@st.composite
def tables(draw: st.DrawFn, least: int = 2, most: int = 6, axes: int = 2) -> NDArray[np.float64]:
    """Draw boxes on a grid, some without an extent, shape (n, 2, axes)."""
    count = draw(st.integers(least, most))
    low = draw(st.lists(st.tuples(*[NUMBERS] * axes), min_size=count, max_size=count))
    sides = draw(st.lists(st.tuples(*[SIDES] * axes), min_size=count, max_size=count))
    corners = np.array(low, dtype=np.float64)
    return np.stack([corners, corners + np.array(sides, dtype=np.float64)], axis=1)
