"""Medians and percentiles equal those of numpy in every bit."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.detection.quantiles import median, medians, percentiles


@pytest.mark.parametrize("size", [1, 2, 3, 10, 101, 5000])
@pytest.mark.parametrize("distinct", [False, True])
def test_quantiles_equal_those_of_numpy(size: int, distinct: bool) -> None:
    rng = np.random.default_rng(size)
    values = rng.normal(size=(size, 3)) if distinct else rng.integers(4, size=(size, 3)).astype(np.float64)
    percents = (0, 0.5, 1, 5, 50, 95, 99, 99.5, 100)
    assert median(values[:, 0]) == np.median(values[:, 0])
    assert medians(values).tolist() == np.median(values, axis=0).tolist()
    assert percentiles(values, percents).tolist() == np.percentile(values, percents, axis=0).tolist()
