"""Models of things: the points of a detected object that show the thing, hidden backs and hidden feet."""

from dataclasses import replace

import numpy as np
import pytest
from first_looks import HALF, first_look

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.outline import oriented_box, upright_box
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.oriented_box import OrientedBox, turned_axes
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.things.model import Model, extended, model_of, standing, without_table

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


@pytest.mark.parametrize(
    ("yaw", "middle", "half"), [(0.0, (0.018, 0.0), (0.058, 0.04)), (0.5, (0.0125, 0.0069), (0.054, 0.04))]
)
def test_handle_that_comes_into_view_keeps_the_back(
    yaw: float, middle: tuple[float, float], half: tuple[float, float]
) -> None:
    rng = np.random.default_rng(4)
    angle, z = rng.uniform(np.pi, 2 * np.pi, 3000), rng.uniform(0.005, 0.1, 3000)
    front = np.column_stack([0.04 * np.cos(angle), 0.04 * np.sin(angle), z])
    body = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.08, 0.08, 0.1))
    pose = np.eye(4)
    pose[:2, :2], pose[2, 3] = [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]], 0.05
    own = (front - pose[:3, 3]) @ pose[:3, :3]
    cloud = PointCloud(own.astype(np.float32), np.full((len(front), 3), 120, np.uint8))
    mug = Model(cloud, np.array([0.04, 0.04, 0.05]), body, pose)
    handle = np.array([0.04, -0.004, 0.03]) + rng.uniform(0, [0.036, 0.008, 0.05], (300, 3))
    whole = extended(mug, handle, np.full((300, 3), 120, np.float32), HALF.detection.outlines)
    assert whole.pose[:2, 3] == pytest.approx(middle, abs=0.002), "the middle of the box along the axes of the mug"
    assert whole.half[:2] == pytest.approx(half, abs=0.003)
    assert whole.pose[2, 3] - whole.half[2] == pytest.approx(0.0, abs=5e-4), "it stands on the table as before"
    assert len(whole.cloud) == len(front) + 300 and mug.pose[0, 3] == 0.0, "the first model stays as it is"


def test_thing_with_a_hidden_foot_reaches_down_to_the_table() -> None:
    bowl = np.random.default_rng(5).uniform((-0.04, -0.04, -0.03), (0.04, 0.04, 0.03), (400, 3)).astype(np.float32)
    pose = np.eye(4)
    pose[:3, 3] = 0.1, 0.2, 0.15
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.08, 0.08, 0.06))
    glass = standing(Model(PointCloud(bowl), np.array([0.04, 0.04, 0.03]), box, pose))
    assert glass.pose[:3, 3] == pytest.approx([0.1, 0.2, 0.09]) and glass.half[2] == pytest.approx(0.09)
    assert glass.oriented.extents == pytest.approx((0.08, 0.08, 0.18))
    assert glass.cloud.points + glass.pose[:3, 3] == pytest.approx(bowl + pose[:3, 3], abs=1e-6)


def test_boxes_of_cutlery_hold_no_points_of_the_table() -> None:
    look = first_look([Placement("knife", "butter knife", 0.1, 0.0, seed=3)])
    own = np.flatnonzero(look.found.labels == 0)
    wide = look.found.boxes[0] + np.array([[-0.02, -0.02, 0.0], [0.03, 0.03, 0.0]])
    box = replace(look.found.oriented[0], extents=(look.found.oriented[0].extents[0] + 0.03, 0.04, 0.01))
    found = replace(look.found, boxes=wide[None], oriented=(box,))
    model = model_of(found, look.cloud, own, 0, np.eye(4), HALF.detection.outlines)
    points = model.cloud.points + model.pose[:3, 3]
    assert 2 * model.half == pytest.approx(np.ptp(points, axis=0), abs=0.002)
    assert model.oriented.extents[0] < box.extents[0] - 0.02


@pytest.mark.parametrize("yaw", [0.0, 0.9])
def test_hidden_corner_of_a_napkin_is_within_its_box(yaw: float) -> None:
    turn, pose = turned_axes(0.6).T, np.eye(4)
    pose[:3, :3], pose[:3, 3] = turned_axes(yaw).T, (0.3, 0.2, 0.005)
    whole = np.random.default_rng(6).uniform((-0.1, -0.08, -0.005), (0.1, 0.08, 0.005), (8000, 3))
    seen = whole[whole[:, 0] + whole[:, 1] < 0.1] @ turn.T
    first, later = seen[:4000], seen[4000:] @ pose[:3, :3].T + pose[:3, 3]
    cloud = PointCloud(first.astype(np.float32), np.full((len(first), 3), 120, np.uint8))
    napkin = Model(cloud, np.array([0.1, 0.1, 0.005]), OrientedBox((0.0, 0.0, 0.0), 0.6, (0.2, 0.16, 0.01)), pose)
    model = extended(napkin, later, np.full((len(later), 3), 120, np.float32), HALF.detection.outlines)
    assert model.pose[:2, 3] == pytest.approx(pose[:2, 3], abs=0.002)
    assert model.half[:2] == pytest.approx(np.abs(whole[:, :2] @ turn[:2, :2].T).max(axis=0), abs=0.004)


def test_first_model_of_a_napkin_has_its_hidden_corner() -> None:
    look = first_look([Placement("napkin", "napkin", 0.0, 0.0, 0.6, seed=2)])
    own = np.flatnonzero(look.found.labels == 0)
    points = moved(look.cloud.points[own].astype(np.float64), look.found.frame)
    along = (
        (points - look.found.oriented[0].centre)
        @ look.found.oriented[0].axes[:2].T
        / look.found.oriented[0].extents[:2]
    )
    seen = along.sum(axis=1) < 0.5
    outlines = HALF.detection.outlines
    found = replace(
        look.found,
        boxes=upright_box(points[seen], outlines)[None],
        oriented=(oriented_box(points[seen], outlines),),
    )
    model = model_of(found, look.cloud, own[seen], 0, np.eye(4), outlines)
    assert model.pose[:2, 3] == pytest.approx(look.found.boxes[0].mean(axis=0)[:2], abs=0.004)
    assert np.abs(found.boxes[0].mean(axis=0) - model.pose[:3, 3]).max() > 0.008, "the corner counts"
