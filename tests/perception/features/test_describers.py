"""Properties that all describers share, and the values of each."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from deixis.errors import UnknownTermError
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import Describer
from deixis.perception.features.descriptors.d2_extents import D2ExtentsDescriber
from deixis.perception.features.descriptors.good import GoodDescriber
from deixis.perception.features.descriptors.spin_images import SpinImageDescriber
from deixis.perception.features.registry import DESCRIBERS, describer_named

ALL = [describer_named(name) for name in DESCRIBERS]
POSE_FREE = [describer for describer in ALL if not describer.local and describer.name != "form"]


def mug(seed: int = 0, n: int = 4000) -> NDArray[np.float32]:
    """Return the front of a cylinder with a handle to one side, 1 m in front of the sensor."""
    rng = np.random.default_rng(seed)
    angle, height = rng.uniform(-1.4, 1.4, n), rng.uniform(0, 0.1, n)
    wall = np.column_stack([0.04 * np.sin(angle), height, 1.0 - 0.04 * np.cos(angle)])
    turn = rng.uniform(-1.5, 1.5, n // 5)
    ring = np.column_stack([0.04 + 0.03 * np.cos(turn), 0.05 + 0.03 * np.sin(turn), 1.0 + rng.normal(0, 0.003, n // 5)])
    return np.concatenate([wall, ring]).astype(np.float32)


@pytest.mark.parametrize("describer", ALL, ids=lambda d: d.name)
def test_the_protocol_of_describers(describer: Describer) -> None:
    found = describer.describe(PointCloud(mug()))
    assert DESCRIBERS[describer.name]() == describer
    assert found.shape[1] == describer.size and found.dtype == np.float32 and np.isfinite(found).all()
    assert len(found) > 10 if describer.local else len(found) == 1
    np.testing.assert_array_equal(describer.describe(PointCloud(mug())), found)


@pytest.mark.parametrize("describer", ALL, ids=lambda d: d.name)
def test_lost_points_and_their_order_do_not_matter(describer: Describer) -> None:
    points = mug()
    shuffled = np.random.default_rng(1).permutation(np.concatenate([points, np.full((50, 3), np.nan, np.float32)]))
    expected = describer.describe(PointCloud(points))
    np.testing.assert_allclose(describer.describe(PointCloud(shuffled)), expected, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("describer", ALL, ids=lambda d: d.name)
@pytest.mark.parametrize(
    "points",
    [
        np.empty((0, 3)),
        np.full((9, 3), np.nan),
        np.zeros((1, 3)),
        np.zeros((9, 3)),
        np.array([[0, 0, 1], [0.01, 0, 1]]),
        np.eye(3) * 0.01,
        np.arange(20)[:, None] * np.array([[0.01, 0, 0]]),
        np.eye(3) * 1e6,
    ],
    ids=["none", "lost", "one", "one place", "two", "three", "line", "huge"],
)
def test_odd_clouds_give_finite_descriptors_or_none(describer: Describer, points: NDArray[np.float64]) -> None:
    found = describer.describe(PointCloud(points.astype(np.float32)))
    assert found.shape[1] == describer.size and found.dtype == np.float32 and np.isfinite(found).all()
    if len(np.unique(points[np.isfinite(points).all(axis=1)], axis=0)) < 2:
        assert len(found) == 0


@pytest.mark.parametrize("describer", POSE_FREE, ids=lambda d: d.name)
@pytest.mark.parametrize("seed", range(5))
def test_global_descriptors_hardly_change_with_pose(describer: Describer, seed: int) -> None:
    """Compare the change with the distance to a flat thing of the same size."""
    points = mug()
    rotation = Rotation.random(random_state=seed).as_matrix()
    flat = points * [1, 1, 0.02] + [0, 0, 1]
    here, there, other = (
        describer.describe(PointCloud(cloud.astype(np.float32))) for cloud in (points, points @ rotation.T, flat)
    )
    assert np.linalg.norm(here - there) < 0.25 * np.linalg.norm(here - other)


def test_good_ignores_scale_and_each_view_sums_to_one() -> None:
    small = GoodDescriber(threshold=0).describe(PointCloud(mug()))
    large = GoodDescriber(threshold=0).describe(PointCloud(mug() * np.float32(4)))
    np.testing.assert_allclose(small, large, atol=0.002)
    np.testing.assert_allclose(small.reshape(3, -1).sum(axis=1), 1.0, atol=1e-6)


def test_good_of_a_slab_by_hand() -> None:
    """Check a centred slab of 4 x 2 x 0 in cells of 1: the views are the slab, its long edge and its short edge."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(4) - 1.5, np.arange(2) - 0.5))
    corners = np.array([[2, 1, 0], [-2, -1, 0], [2, -1, 0], [-2, 1, 0]]) * 0.999999
    points = np.concatenate([np.repeat(np.column_stack([x, y, 0 * x]), 500, axis=0), corners])
    whole, *edges = GoodDescriber(bins=4).describe(PointCloud(points.astype(np.float32)))[0].reshape(3, 4, 4)
    np.testing.assert_allclose(whole[:, 1:3].sum(axis=1), 0.25, atol=0.001)
    np.testing.assert_allclose(whole.sum(axis=0)[1:3], 0.5, atol=0.001)
    for edge, shares in zip(edges, ([0.0, 0.5, 0.5, 0.0], [0.25, 0.25, 0.25, 0.25]), strict=True):
        np.testing.assert_allclose(edge.sum(axis=1), shares, atol=0.001)


def test_d2_ends_with_the_extents_in_falling_order() -> None:
    found = D2ExtentsDescriber().describe(PointCloud(mug()))[0]
    assert found[:-3].sum() == pytest.approx(1.0)
    assert 0.13 > found[-3] > found[-2] > found[-1] > 0.01
    heavier = D2ExtentsDescriber(weight=2.0).describe(PointCloud(mug()))[0]
    np.testing.assert_allclose(heavier[-3:], 2 * found[-3:], rtol=1e-6)


def test_d2_of_two_points_is_one_distance() -> None:
    found = D2ExtentsDescriber(bins=4).describe(PointCloud(np.array([[0, 0, 0], [0, 0.3, 0]], np.float32)))[0]
    np.testing.assert_allclose(found, [0, 0, 0, 1, 0.3, 0, 0], atol=1e-6)


def test_spin_images_use_the_normals_of_the_cloud() -> None:
    points = mug()
    upward = np.tile(np.array([0, 1, 0], np.float32), (len(points), 1))
    about = SpinImageDescriber().describe(PointCloud(points, normals=upward))
    assert not np.allclose(about, SpinImageDescriber().describe(PointCloud(points)), atol=0.01)


def test_spin_images_with_angles_estimate_normals_everywhere() -> None:
    found = SpinImageDescriber(width=4, angular=True, support_angle_cos=0.2).describe(PointCloud(mug()))
    assert found.shape[1] == 45 and 0.5 < found.max() < math.pi


def test_an_unknown_name_lists_the_known_ones() -> None:
    with pytest.raises(
        UnknownTermError, match="unknown descriptor 'shot'; choose one of spin_images, fpfh, good, d2_ext"
    ):
        describer_named("shot")


def test_naming_a_descriptor_imports_no_heavy_library() -> None:
    code = (
        "import sys; from deixis.perception.features.registry import describer_named; describer_named('fpfh');"
        "sys.exit(any(name in sys.modules for name in ('numba', 'scipy', 'open3d')))"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
