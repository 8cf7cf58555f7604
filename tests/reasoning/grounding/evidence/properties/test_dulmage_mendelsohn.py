"""Rows that a maximum matching can leave over."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import linear_sum_assignment

from deixis.reasoning.grounding.evidence.properties.labels import spare_rows


def largest(pairs: np.ndarray) -> int:
    rows, columns = linear_sum_assignment(pairs, maximize=True)
    return int(pairs[rows, columns].sum())


@given(arrays(bool, st.tuples(st.integers(0, 6), st.integers(0, 6))))
def test_spare_rows_leave_the_matching_size_unchanged(pairs: np.ndarray) -> None:
    without = [largest(np.delete(pairs, row, axis=0)) for row in range(len(pairs))]
    assert spare_rows(pairs).tolist() == [count == largest(pairs) for count in without]
