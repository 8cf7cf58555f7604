"""Mean of the last frames of a camera that stands still or moves."""

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.depth import Intrinsics, back_projected
from deixis.perception.tracking.frames.image import Optics, table_view
from deixis.perception.tracking.frames.recent import RecentFrames

SHAPE = ROWS, COLUMNS = 60, 80
LENS = Intrinsics(COLUMNS, ROWS, 100.0, 100.0, 39.5, 29.5)
OPTICS = Optics(np.array([[100.0, 0, 39.5], [0, 100.0, 29.5], [0, 0, 1]]), np.zeros(3))
NOISE = 0.002


def pose(shift: float) -> np.ndarray:
    """Return the pose of a camera one metre above the table, which has moved to the right."""
    back = np.diag([1.0, -1.0, -1.0, 1.0])
    back[:3, 3] = shift, 0.0, 1.0
    return back


def table_seen(seed: int, shift: float, tint: int = 120) -> PointCloud:
    """Return a noisy frame of a bare table, whose right half, from x = 0, has another colour."""
    depth = np.random.default_rng(seed).normal(1.0, NOISE, SHAPE)
    x = (np.arange(COLUMNS) - 39.5) / 100 + shift
    colours = np.where(np.tile(x, ROWS)[:, None] < 0, tint, 220) * np.ones(3)
    return PointCloud(back_projected(depth, LENS), colours.astype(np.uint8), organised=SHAPE)


def mean_of(frames: list[tuple[PointCloud, float]]) -> PointCloud:
    recent = RecentFrames(OPTICS, 6)
    for cloud, shift in frames:
        recent.add(cloud, pose(shift))
    return recent.mean(0.01, 0.0, 40.0)


@pytest.mark.parametrize("step", [0.0, 0.013])
def test_mean_has_less_noise_than_one_frame(step: float) -> None:
    frames = [(table_seen(k, k * step), k * step) for k in range(6)]
    found = mean_of(frames)
    inner = found.points.reshape(*SHAPE, 3)[:, :60, 2]  # in view in all frames
    assert np.std(inner) < 0.6 * NOISE
    before = frames[-1][0]
    assert found.colours is not None and before.colours is not None
    assert np.array_equal(found.colours, before.colours), "colours are not mixed across an edge"
    ratio = found.points[:, 0] / found.points[:, 2] - before.points[:, 0] / before.points[:, 2]
    assert np.abs(ratio).max() < 1e-6, "points stay on their rays"


def test_what_has_changed_is_not_in_the_mean() -> None:
    last = table_seen(5, 0.0, tint=180)
    depth = last.points[:, 2].reshape(SHAPE).copy()
    depth[20:30, 50:60] -= 0.05  # something was laid there
    depth[0, 0] = np.nan
    last = PointCloud(back_projected(depth, LENS), last.colours, organised=SHAPE)
    found = mean_of([*((table_seen(k, 0.0), 0.0) for k in range(5)), (last, 0.0)])
    heights = found.points[:, 2].reshape(SHAPE)
    assert np.array_equal(heights[20:30, 50:60], depth[20:30, 50:60].astype(np.float32))
    assert found.colours is not None and (found.colours.reshape(*SHAPE, 3)[:, :39] == 180).all()
    assert np.isnan(heights[0, 0])


def test_old_frames_are_dropped() -> None:
    recent = RecentFrames(OPTICS, 2)
    for k in range(4):
        recent.add(table_seen(k, 0.0), pose(0.0))
    assert len(recent) == 2


def test_places_behind_surfaces_and_out_of_the_image_are_hidden() -> None:
    view = table_view(OPTICS, pose(0.0), SHAPE)
    depth = np.ones(SHAPE, np.float32)
    depth[:, 60:], depth[0] = 0.9, 0.0
    places = np.array([(0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.3, 0.0, 0.095), (0.0, 0.295, 0.0), (2.0, 0.0, 0.0)])
    assert view.hides(places, depth, 0.01).tolist() == [False, True, False, False, True]
