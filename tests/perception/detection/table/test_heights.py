"""Points above the table, in the noise of a sensor."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.detection.settings import DetectionSettings, SurfaceSettings
from deixis.perception.detection.table.heights import raised
from deixis.perception.detection.table.neighbours import ListedNeighbours, neighbour_table

ROWS, COLUMNS = 60, 80


@pytest.mark.parametrize("noise", [0.0, 5e-4, 1.4e-3])
def test_a_strip_of_a_few_millimetres_is_kept_without_the_table(noise: float) -> None:
    heights = np.random.default_rng(0).normal(0, noise, (ROWS, COLUMNS))
    strip = np.zeros((ROWS, COLUMNS), dtype=np.bool_)
    strip[25:32, 10:70] = True
    heights[strip] += 0.005
    neighbours = neighbour_table(
        np.zeros((ROWS * COLUMNS, 3)), np.arange(ROWS * COLUMNS), (ROWS, COLUMNS), SurfaceSettings()
    )
    found = raised(heights.ravel(), np.full(ROWS * COLUMNS, 1.0), ListedNeighbours(neighbours), DetectionSettings())
    above = found.above.reshape(ROWS, COLUMNS)
    assert above[strip].mean() > 0.97
    away = np.ones_like(strip)
    away[21:36, 6:74] = False
    assert above[away].mean() < 0.005
    assert found.noise == pytest.approx(max(noise, 1e-4), rel=0.15)


def test_low_points_count_if_connected_to_high_ones() -> None:
    heights = np.zeros(30)
    heights[5:10], heights[10:15], heights[22:26] = 0.01, 0.0012, 0.0012
    line = np.full((30, 2), -1, np.int32)
    line[1:, 0], line[:-1, 1] = np.arange(29), np.arange(1, 30)
    above = raised(heights, np.full(30, 0.5), ListedNeighbours(line), DetectionSettings()).above
    assert above[5:14].all() and not above[20:].any()
