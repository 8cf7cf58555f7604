"""Gaps and overlaps of pairs of boxes."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from laid_boxes import tables
from numpy.typing import NDArray

from deixis.reasoning.geometry.overlap import common_lengths, gaps, overlapping


@given(tables(axes=3))
def test_a_gap_and_a_common_length_exclude_each_other(boxes: NDArray[np.float64]) -> None:
    apart, common = gaps(boxes), common_lengths(boxes)
    assert (apart >= 0).all() and (common >= 0).all()
    assert not ((apart > 0) & (common > 0)).any()
    np.testing.assert_array_equal(apart, apart.swapaxes(0, 1))
    np.testing.assert_array_equal(common, common.swapaxes(0, 1))


@given(tables(axes=2))
def test_boxes_with_an_extent_overlap_by_common_lengths(boxes: NDArray[np.float64]) -> None:
    solid = (boxes[:, 1] > boxes[:, 0]).all(axis=1)
    boxes = boxes[solid]
    np.testing.assert_array_equal(overlapping(boxes), (common_lengths(boxes) > 0).all(axis=2))
