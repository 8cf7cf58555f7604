"""Counts of sizes: exact for few views, close for many, and free of the order in which views come and go."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.reasoning.grounding.fitting.size_statistics import BUCKET, SCALE, Distribution, steps

VALUES = st.lists(st.floats(-3, 0), min_size=1, max_size=40)


def counted(values: list[float]) -> Distribution:
    buckets: dict[int, tuple[int, int]] = {}
    for value in map(steps, values):
        count, total = buckets.get(value // BUCKET, (0, 0))
        buckets[value // BUCKET] = (count + 1, total + value)
    return Distribution(buckets)


@given(VALUES)
def test_medians_are_off_by_less_than_a_bucket(values: list[float]) -> None:
    found, width = counted(values), BUCKET / SCALE
    median = float(np.median(values))
    assert found.size == len(values)
    assert found.median() == pytest.approx(median, abs=width)
    assert found.median_deviation(median) == pytest.approx(np.median(np.abs(np.array(values) - median)), abs=width)
    assert found.deviations(median) == pytest.approx(np.abs(np.array(values) - median).sum(), abs=width * len(values))


@given(st.sets(st.integers(-180, 0), min_size=1, max_size=9))
def test_of_values_in_buckets_of_their_own_the_median_is_exact(places: set[int]) -> None:
    values = [place / 60 for place in places]
    assert counted(values).median() == pytest.approx(float(np.median(values)), abs=1e-7)


def test_equal_values_have_no_deviation() -> None:
    found = counted([-0.405465] * 3)
    assert found.median() == pytest.approx(-0.405465, abs=1e-7)
    assert found.median_deviation(found.median()) == 0
