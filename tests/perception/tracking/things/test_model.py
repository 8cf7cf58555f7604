"""Models of things: the points of a detected object that show the thing."""

import numpy as np
import pytest
from first_looks import HALF, first_look

from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.things.model import without_table

pytest.importorskip("open3d")


def test_points_of_the_table_are_not_in_the_model_of_a_thing() -> None:
    look = first_look([Placement("fork", "dinner fork", 0.1, 0.0, seed=3)])
    cloud, back = look.cloud, look.view.back
    assert cloud.labels is not None
    own, table = (np.flatnonzero(cloud.labels == label) for label in (1, 0))
    low = table[np.abs(look.frame.camera.to_table(cloud.points[table].astype(np.float64))[:, 2]) < 0.003]
    mixed = np.concatenate([own, low[: len(own)]])
    left = without_table(cloud, mixed, look.table, back, HALF.tolerance)
    assert np.isin(own, left).mean() > 0.95 and not np.isin(low, left).any()
    mostly = np.concatenate([own, low[: 4 * len(own)]])
    assert np.array_equal(without_table(cloud, mostly, look.table, back, HALF.tolerance), mostly)
