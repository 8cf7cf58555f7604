"""Sizes of things that were seen on a table."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.learning.layouts.experience import SIZE_ERROR, log_sizes
from deixis.perception.scene import PerceivedObject


def test_a_thing_tracked_below_the_table_has_no_height() -> None:
    sunk = PerceivedObject("o1", (0.0, 0.0, -0.06), (0.2, 0.1, -0.04))
    cup = PerceivedObject("o2", (0.5, 0.0, 0.0), (0.6, 0.1, 0.09))
    sizes = log_sizes([sunk, cup])
    assert np.exp(sizes[0]) - SIZE_ERROR == pytest.approx([0.2, 0.1, 0.0])
    assert np.exp(sizes[1]) - SIZE_ERROR == pytest.approx([0.1, 0.1, 0.09])
