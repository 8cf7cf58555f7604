"""Kinds of clouds, and their effect on the frame of the objects and on their comparison."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.learning.views.views import COLOUR, COMPARISONS, SPIN_IMAGE_ROOTS, comparisons_in
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.shown import Shows, share_connected

Look = Callable[..., PointCloud]
Box = tuple[tuple[float, float, float], tuple[float, float, float]]

CUBE: Box = ((-0.04, -0.04, 0.0), (0.04, 0.04, 0.08))


def shell(extents: tuple[float, float, float], spacing: float = 0.004) -> NDArray[np.float64]:
    """Return three sides of a box, as a camera above one of its corners sees them."""
    x, y, z = (np.arange(0.0, side, spacing) for side in extents)
    top, front, side = (np.stack(np.meshgrid(*pair), axis=-1).reshape(-1, 2) for pair in ((x, y), (x, z), (y, z)))
    return np.concatenate(
        [
            np.column_stack([top, np.full(len(top), extents[2])]),
            np.column_stack([front[:, 0], np.zeros(len(front)), front[:, 1]]),
            np.column_stack([np.zeros(len(side)), side]),
        ]
    )


@pytest.mark.parametrize("extents", [(0.08, 0.08, 0.1), (0.45, 0.3, 0.3), (0.2, 0.06, 0.3), (0.6, 0.2, 0.2)])
def test_one_object_of_any_size_is_one_object(extents: tuple[float, float, float]) -> None:
    points = shell(extents)
    turn = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))[0]
    found = detect(PointCloud((points @ turn.T + (0.0, 0.0, 1.0)).astype(np.float32)))
    assert (found.shows, len(found.boxes), found.table) == (Shows.OBJECT, 1, None)
    assert (found.labels == 0).all()


def test_the_kind_of_a_cloud_is_reported(boxes_seen: Look) -> None:
    assert detect(boxes_seen([CUBE])).shows == Shows.TABLE
    assert detect(boxes_seen([])).shows == Shows.TABLE
    other: Box = ((0.32, -0.2, -0.03), (0.67, 0.2, 0.0))
    assert detect(boxes_seen([CUBE, other, ((0.4, -0.05, 0.0), (0.47, 0.02, 0.07))], half=0.2)).shows == Shows.TABLES
    wall: Box = ((-3.0, 2.0, -1.0), (3.0, 2.1, 3.0))
    assert detect(boxes_seen([wall], half=0.0)).shows == Shows.ROOM
    few = np.random.default_rng(0).uniform(-0.3, 0.3, (30, 3)).astype(np.float32)
    assert detect(PointCloud(few)).shows == Shows.NOTHING
    sheet = np.mgrid[0:0.5:0.005, 0:0.4:0.005, 0:1].astype(float).reshape(3, -1).T
    assert detect(PointCloud(sheet.astype(np.float32))).shows == Shows.TABLE


def test_the_rim_of_a_tray_is_not_an_object_on_a_table() -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-0.25:0.25:0.003, -0.16:0.16:0.003])
    edge = np.maximum(abs(x) - 0.2, abs(y) - 0.11)
    rim = np.where(edge > 0, edge, 0.0)  # rises at 45 degrees, all around
    tray = np.column_stack([x, y, rim]) + np.array((0.0, 0.0, -0.8))
    assert detect(PointCloud(tray.astype(np.float32))).shows == Shows.OBJECT


@pytest.mark.parametrize("rim", [0.0, 0.01, 0.03])
@pytest.mark.parametrize(("width", "depth"), [(0.45, 0.37), (0.42, 0.28), (0.6, 0.4)])
def test_a_flat_thing_without_a_table_is_one_object(width: float, depth: float, rim: float) -> None:
    x, y = (axis.ravel() for axis in np.mgrid[0:width:0.004, 0:depth:0.004])
    edge = (np.minimum(x, width - x) < 0.006) | (np.minimum(y, depth - y) < 0.006)
    layers = [np.column_stack([x[edge], y[edge], np.full(edge.sum(), z)]) for z in np.arange(0.003, rim, 0.003)]
    points = np.concatenate([np.column_stack([x, y, 0 * x]), *layers]) - (0.0, 0.0, 0.8)
    points += np.random.default_rng(0).normal(0, 5e-4, points.shape)
    shows = detect(PointCloud(points.astype(np.float32))).shows
    assert shows == (Shows.TABLE if width > 0.5 and not rim else Shows.OBJECT)  # a bare surface of 60 cm may be a table


def test_a_table_that_is_cut_by_the_image_is_a_table(boxes_seen: Look) -> None:
    cloud = boxes_seen([])
    assert cloud.organised is not None
    whole = cloud.points.reshape(*cloud.organised, 3)
    near = whole[60:140, 60:150]  # 45 by 35 cm
    assert detect(PointCloud(near.reshape(-1, 3), organised=near.shape[:2])).shows == Shows.TABLE


def test_a_table_with_objects_only_at_its_edge_is_a_table(boxes_seen: Look) -> None:
    things: list[Box] = [((x, 0.42, 0.0), (x + 0.08, 0.5, 0.1)) for x in (-0.3, 0.0, 0.3)]
    for cloud in (boxes_seen(things), boxes_seen(things).take(np.flatnonzero(boxes_seen(things).finite))):
        found = detect(cloud)
        assert (found.shows, len(found.boxes)) == (Shows.TABLE, 3)


def test_two_separate_pieces_are_not_one_object() -> None:
    one = shell((0.3, 0.1, 0.1))
    assert share_connected(one, 0.02) == 1.0
    assert share_connected(np.concatenate([one, one + np.array([0.6, 0.0, 0.0])]), 0.02) == pytest.approx(0.5, abs=0.05)


def test_without_a_table_objects_are_compared_without_a_frame() -> None:
    cloud = PointCloud(shell((0.08, 0.08, 0.1)).astype(np.float32))
    assert detect(cloud).scene().frame == "object"
    assert comparisons_in(detect(cloud).scene().frame) == ((SPIN_IMAGE_ROOTS, COLOUR), (SPIN_IMAGE_ROOTS,))
    told = detect(cloud, DetectionSettings(up=(0.0, 0.0, 1.0)))
    assert (told.shows, told.scene().frame) == (Shows.OBJECT, "table")
    assert comparisons_in(told.scene().frame) == COMPARISONS
