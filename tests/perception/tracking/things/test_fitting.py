"""Fitting of lost things to the pixels that show them at rest."""

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.frames.image import FrameImage, Optics, table_view
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.things.fitting import fits
from deixis.perception.tracking.things.pipeline import Pipeline

SHAPE = 120, 160
OPTICS = Optics(np.array([[200.0, 0, 79.5], [0, 200.0, 59.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down: a pixel is 5 mm
WOOD, STEEL = (140, 105, 73), (190, 190, 195)
LENGTH, WIDTH, HEIGHT = 0.18, 0.02, 0.01
TURN = np.deg2rad(25.0)
PLACE = np.array([0.12, -0.06, HEIGHT / 2])


def knife() -> Pipeline:
    """Return a knife that lay along the x axis at the middle of the table."""
    rng = np.random.default_rng(0)
    points = rng.uniform(-0.5, 0.5, (600, 3)) * (LENGTH, WIDTH, 0.0) + (0.0, 0.0, HEIGHT / 2)
    cloud = PointCloud(points.astype(np.float32), np.tile(np.array(STEEL, np.uint8), (len(points), 1)))
    pose = np.eye(4)
    pose[2, 3] = HEIGHT / 2
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (LENGTH, WIDTH, HEIGHT))
    return Pipeline("t1", 1, cloud, np.array([LENGTH, WIDTH, HEIGHT]) / 2, box, pose, 0.0, TrackingSettings())


def frame_with_knife(hidden: float) -> tuple[FrameImage, np.ndarray]:
    """Return a frame of the knife at ``PLACE``, of which another thing hides a share, and its pixels."""
    rng = np.random.default_rng(1)
    depth = rng.normal(1.0, 0.0015, SHAPE).astype(np.float32)
    colour = np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    rows, columns = np.indices(SHAPE)
    plan = np.stack([(columns - 79.5) / 200, -(rows - 59.5) / 200], axis=-1) - PLACE[:2]
    along = plan @ (np.cos(TURN), np.sin(TURN))
    inside = (np.abs(along) < LENGTH / 2) & (np.abs(plan @ (-np.sin(TURN), np.cos(TURN))) < WIDTH / 2)
    depth[inside] -= HEIGHT
    colour[inside] = STEEL
    covered = (along < (hidden - 0.5) * LENGTH) & (np.abs(along) < LENGTH)
    depth[covered] = 0.85
    colour[covered] = (40, 60, 160)
    rays = np.stack([(columns - 79.5) / 200, (rows - 59.5) / 200, np.ones(SHAPE)], axis=-1)
    image = FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, OPTICS)
    return image, np.flatnonzero(inside & ~covered)


@pytest.mark.parametrize("hidden", [0.0, 0.25])
def test_thin_thing_is_laid_where_few_pixels_show_it(hidden: float) -> None:
    image, pixels = frame_with_knife(hidden)
    thing, view = knife(), table_view(OPTICS, BACK, SHAPE)
    taken = np.ones(SHAPE, np.bool_)
    taken.ravel()[pixels] = False
    start = np.eye(4)
    start[:2, :2] = [[np.cos(TURN + 0.1), -np.sin(TURN + 0.1)], [np.sin(TURN + 0.1), np.cos(TURN + 0.1)]]
    start[:3, 3] = PLACE + np.array([0.015, -0.01, 0.0])
    pose, agreement, visible = thing.laid(start, image, view, taken, image.places(pixels, BACK), 0.0015)
    assert pose[2, 2] == 1.0 and pose[2, 3] == start[2, 3], "it neither tilts nor rises"
    turn = np.arctan2(pose[1, 0], pose[0, 0])
    assert turn == pytest.approx(TURN, abs=0.06)
    assert pose[:2, 3] == pytest.approx(PLACE[:2], abs=0.008)
    assert agreement > 0.8 and visible > 0.5 * (1 - hidden)


def test_one_of_the_fits_lies_flat() -> None:
    image, pixels = frame_with_knife(0.0)
    taken = np.ones(SHAPE, np.bool_)
    taken.ravel()[pixels] = False
    thing, before = knife(), knife().pose
    found = list(fits(thing, image, table_view(OPTICS, BACK, SHAPE), pixels, taken, 0.0015))
    flat = [fit for fit in found if fit.pose[2, 2] > 1 - 1e-9]
    best = max(flat, key=lambda fit: fit.score)
    assert best.agreement > thing.settings.fit and best.explained > 0.9
    assert best.pose[:2, 3] == pytest.approx(PLACE[:2], abs=0.008)
    assert np.array_equal(thing.pose, before), "the thing keeps its pose"
