"""Thinning of bare points that are denser on things than on their table."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.density import evenly_dense
from deixis.perception.detection.detect import detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.viewpoint import View, camera_pose_of

Look = Callable[..., PointCloud]
Scan = Callable[..., PointCloud]
Box = tuple[tuple[float, float, float], tuple[float, float, float]]

CUBES: list[Box] = [((x, y, 0.0), (x + 0.06, y + 0.06, 0.06)) for x, y in ((-0.28, -0.23), (0.07, 0.07), (0.27, -0.33))]


@pytest.mark.parametrize(("table", "things"), [(0.005, 0.0005), (0.01, 0.001), (0.01, 0.0005), (0.02, 0.001)])
def test_things_denser_than_their_table_are_found(boxes_scanned: Scan, table: float, things: float) -> None:
    cloud = boxes_scanned(CUBES, table, things)
    truth = cloud.labels
    assert truth is not None
    found = detect(cloud)
    assert len(found.boxes) == len(CUBES)
    for thing in range(1, len(CUBES) + 1):
        labels = found.labels[truth == thing]
        assert (labels == np.bincount(labels + 1).argmax() - 1).mean() > 0.9


def test_points_of_a_camera_are_not_thinned(boxes_seen: Look) -> None:
    cloud = boxes_seen(CUBES)
    cloud = cloud.take(np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite)))
    settings = DetectionSettings()
    places = np.arange(len(cloud))
    view = View(cloud.points.astype(np.float64), places, None, camera_pose_of(cloud, settings))
    assert evenly_dense(view, settings) is view


def test_left_out_points_stand_for_their_neighbours(boxes_scanned: Scan) -> None:
    cloud, settings = boxes_scanned(CUBES, 0.02, 0.001), DetectionSettings()
    view = View(cloud.points.astype(np.float64), np.arange(len(cloud)), None, camera_pose_of(cloud, settings))
    thinned = evenly_dense(view, settings)
    assert thinned.same is not None and len(thinned.points) < len(cloud) / 2
    assert len(thinned.points) + thinned.same.shape[1] == thinned.counts.sum() == len(cloud)
    apart = np.linalg.norm(cloud.points[thinned.same[0]] - cloud.points[thinned.same[1]], axis=1)
    assert apart.max() <= np.sqrt(3) * settings.density.max_cell
