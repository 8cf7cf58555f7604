"""Spin images: compared with a plain reference implementation, with values by hand, and under rigid motion.

The golden values beside this file are those of the reference; this file, run as a script, writes them again.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from deixis.perception.errors import CloudError
from deixis.perception.features.descriptors.spin_images import spin_images

GOLDEN = Path(__file__).with_name("spin_images.golden.json")

OPTIONS: dict[str, dict[str, Any]] = {
    "rectangular": {"support": 0.08, "width": 8},
    "coarse": {"support": 0.05, "width": 3},
    "radial": {"support": 0.08, "width": 4, "radial": True},
    "support angle": {"support": 0.08, "width": 4, "support_angle_cos": 0.5},
    "angular": {"support": 0.08, "width": 4, "angular": True},
    "radial, angular, support angle": {
        "support": 0.06,
        "width": 4,
        "radial": True,
        "angular": True,
        "support_angle_cos": 0.3,
    },
}


def reference(
    points: NDArray[np.floating],
    normals: NDArray[np.floating],
    keypoint: int,
    support: float,
    width: int,
    support_angle_cos: float = 0.0,
    radial: bool = False,
    angular: bool = False,
) -> NDArray[np.float64]:
    """Compute spin images by the definition, point by point, in double precision."""
    counts, angles = np.zeros((width + 1, 2 * width + 1)), np.zeros((width + 1, 2 * width + 1))
    bin_size = support / width if radial else support / width / math.sqrt(2.0)
    place, axis = points[keypoint].astype(float), normals[keypoint].astype(float)
    for point, normal in zip(points.astype(float), normals.astype(float), strict=True):
        direction = point - place
        distance = math.sqrt(float(direction @ direction))
        if not 0.0 < distance < support:
            continue
        angle = 0.0
        if support_angle_cos > 0 or angular:
            cosine = min(1.0, abs(float(normal @ axis)))
            if cosine < support_angle_cos:
                continue
            angle = math.acos(cosine)
        slope = min(1.0, max(-1.0, float(direction @ axis) / distance))
        if radial:
            row, column = distance / bin_size, math.asin(slope) / (math.pi / 2 / width) + width
        else:
            beta, alpha = distance * slope, distance * math.sqrt(1.0 - slope * slope)
            if abs(beta) >= bin_size * width or alpha >= bin_size * width:
                continue
            row, column = alpha / bin_size, beta / bin_size + width
        i, j = min(math.floor(row), width - 1), min(math.floor(column), 2 * width - 1)
        a, b = row - i, column - j
        for di, dj, share in ((0, 0, (1 - a) * (1 - b)), (1, 0, a * (1 - b)), (0, 1, (1 - a) * b), (1, 1, a * b)):
            counts[i + di, j + dj] += share
            angles[i + di, j + dj] += share * angle
    if angular:
        return np.asarray(angles / (counts + np.finfo(float).eps)).ravel()
    return (counts / counts.sum() if counts.any() else counts).ravel()


def cup() -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return points and normals of a wall, a bottom and a handle; no two keypoints are alike."""
    points, normals = [], []
    for i in range(40):
        for j in range(12):
            angle, height = 0.157 * i + 0.01 * j, 0.008 * j
            points.append((0.04 * math.cos(angle), 0.04 * math.sin(angle), height))
            normals.append((math.cos(angle), math.sin(angle), 0.0))
        radius, angle = 0.001 * i, 2.4 * i
        points.append((radius * math.cos(angle), radius * math.sin(angle), 0.0))
        normals.append((0.0, 0.0, 1.0))
        points.append((0.04 + 0.03 * math.sin(0.08 * i), 0.002 * math.sin(i), 0.02 + 0.0015 * i))
        normals.append((0.6, 0.0, 0.8))
    return np.array(points, np.float32), np.array(normals, np.float32)


CUP_KEYPOINTS = np.array([3, 14, 13, 250, 301])


def random_cloud(seed: int, n: int = 150) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rng = np.random.default_rng(seed)
    points, normals = rng.uniform(-0.1, 0.1, (n, 3)), rng.normal(size=(n, 3))
    return points, normals / np.linalg.norm(normals, axis=1, keepdims=True)


@pytest.mark.parametrize("name", OPTIONS)
def test_golden_values_of_a_cup(name: str) -> None:
    points, normals = cup()
    golden = np.array(json.loads(GOLDEN.read_text(encoding="utf-8"))[name])
    np.testing.assert_allclose(spin_images(points, normals, CUP_KEYPOINTS, **OPTIONS[name]), golden, atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", OPTIONS)
def test_random_clouds_agree_with_the_definition(name: str, seed: int) -> None:
    points, normals = random_cloud(seed)
    keypoints = np.arange(0, 150, 15)
    expected = [reference(points, normals, int(k), **OPTIONS[name]) for k in keypoints]
    np.testing.assert_allclose(spin_images(points, normals, keypoints, **OPTIONS[name]), expected, atol=1e-6)


def test_a_point_adds_to_its_four_bins_by_hand() -> None:
    """Use bins of 1 m: a point 0.25 m off the axis and 0.5 m up is in row 0, half-way between columns 2 and 3."""
    points = np.array([[0, 0, 0], [0.25, 0, 0.5]], np.float32)
    image = spin_images(points, np.array([[0, 0, 1.0]] * 2), np.array([0]), support=2 * math.sqrt(2), width=2)
    expected = np.zeros((3, 5))
    expected[0, 2:4], expected[1, 2:4] = 0.75 * 0.5, 0.25 * 0.5
    np.testing.assert_allclose(image[0].reshape(3, 5), expected, atol=1e-7)


def test_the_cylinder_excludes_its_border_and_the_keypoint() -> None:
    """Use a cylinder of radius 1: of points at 1 and 0.5, along the axis and across it, only those at 0.5 count."""
    points = np.array([[0, 0, 0], [0, 0, 0], [1, 0, 0], [0, 0, -1], [0.5, 0, 0], [0, 0, -0.5]])
    image = spin_images(points, np.array([[0, 0, 1.0]] * 6), np.array([0]), support=math.sqrt(2), width=2)[0]
    expected = np.zeros((3, 5))
    expected[1, 2] = expected[0, 1] = 0.5
    np.testing.assert_allclose(image.reshape(3, 5), expected, atol=1e-7)


def test_the_border_of_the_ball_is_outside() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0.5]])
    image = spin_images(points, np.array([[0, 0, 1.0]] * 3), np.array([0]), support=1.0, width=2, radial=True)[0]
    expected = np.zeros((3, 5))
    expected[1, 4] = 1.0  # straight up: the last column, to which border points are moved
    np.testing.assert_allclose(image.reshape(3, 5), expected, atol=1e-7)


def test_an_image_without_neighbours_is_zero() -> None:
    points, normals = np.array([[0, 0, 0], [9, 9, 9.0]]), np.array([[0, 0, 1.0]] * 2)
    for options in ({}, {"radial": True}, {"angular": True}):
        assert not spin_images(points, normals, np.array([0, 1]), support=0.1, **options).any()


def test_images_sum_to_one_and_have_153_bins() -> None:
    points, normals = cup()
    images = spin_images(points, normals, CUP_KEYPOINTS, support=0.08)
    assert images.shape == (5, 153) and images.dtype == np.float32
    np.testing.assert_allclose(images.sum(axis=1), 1.0, atol=1e-6)


def test_points_without_depth_change_nothing() -> None:
    points, normals = cup()
    holed = np.concatenate([points, np.full((7, 3), np.nan, np.float32)])
    filled = np.concatenate([normals, np.full((7, 3), np.nan, np.float32)])
    for options in OPTIONS.values():
        expected = spin_images(points, normals, CUP_KEYPOINTS, **options)
        np.testing.assert_array_equal(spin_images(holed, filled, CUP_KEYPOINTS, **options), expected)


def test_points_without_a_normal_are_ignored_if_needed() -> None:
    points, normals = cup()
    lost = normals.copy()
    lost[100:200] = np.nan
    kept = np.r_[0:100, 200 : len(points)]
    where = np.searchsorted(kept, CUP_KEYPOINTS)
    expected = spin_images(points[kept], normals[kept], where, support=0.08, support_angle_cos=0.2)
    found = spin_images(points, lost, CUP_KEYPOINTS, support=0.08, support_angle_cos=0.2)
    np.testing.assert_allclose(found, expected, atol=1e-7)


@pytest.mark.parametrize("name", OPTIONS)
def test_threads_do_not_change_a_bit(name: str) -> None:
    points, normals = random_cloud(0, 300)
    keypoints = np.arange(300)
    alone = spin_images(points, normals, keypoints, threads=1, **OPTIONS[name])
    np.testing.assert_array_equal(spin_images(points, normals, keypoints, threads=3, **OPTIONS[name]), alone)


def test_a_far_outlier_changes_only_the_grid() -> None:
    points, normals = cup()
    far = np.concatenate([points, np.array([[1e6, -1e6, 1e6]], np.float32)])
    images = spin_images(far, np.concatenate([normals, normals[:1]]), CUP_KEYPOINTS, support=0.08)
    np.testing.assert_allclose(images, spin_images(points, normals, CUP_KEYPOINTS, support=0.08), atol=1e-7)


@settings(max_examples=60, deadline=None)
@given(
    st.integers(0, 10**6),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.tuples(*[st.floats(-2, 2)] * 3),
    st.sampled_from(sorted(OPTIONS)),
)
def test_rigid_motion_changes_no_image(
    seed: int, turn: tuple[float, float, float], shift: tuple[float, float, float], name: str
) -> None:
    points, normals = random_cloud(seed, 80)
    rotation = Rotation.from_rotvec(turn).as_matrix()
    keypoints = np.arange(0, 80, 8)
    options = OPTIONS[name]
    images = spin_images(points, normals, keypoints, **options)
    moved = spin_images(points @ rotation.T + shift, normals @ rotation.T, keypoints, **options)
    np.testing.assert_allclose(moved, images, atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.01, 100), st.sampled_from(["rectangular", "radial"]))
def test_scaling_cloud_and_support_keeps_the_image(seed: int, scale: float, name: str) -> None:
    points, normals = random_cloud(seed, 60)
    keypoints = np.arange(5)
    options = OPTIONS[name]
    scaled = {**options, "support": options["support"] * scale}
    images = spin_images(points, normals, keypoints, **options)
    np.testing.assert_allclose(spin_images(points * scale, normals, keypoints, **scaled), images, atol=1e-6)


def test_too_few_neighbours_are_an_error() -> None:
    """Count the keypoint itself, as the Point Cloud Library does."""
    points, normals = np.array([[0, 0, 0], [0.5, 0, 0], [9, 9, 9.0]]), np.array([[0, 0, 1.0]] * 3)
    assert len(spin_images(points, normals, np.array([0]), support=1.0, min_points=2)) == 1
    with pytest.raises(CloudError, match="keypoint 2 must have at least 2 points within 1 m, got 1"):
        spin_images(points, normals, np.array([0, 2]), support=1.0, min_points=2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"support": 0.0}, "support must be a length above 0"),
        ({"support": math.nan}, "support must be a length above 0"),
        ({"width": 0}, "width must be at least 1 bin"),
        ({"support_angle_cos": 1.5}, "must be from 0 to 1"),
        ({"threads": 0}, "`threads` must be at least 1"),
        ({"keypoints": np.array([480 + 80])}, "must be from 0 to 559"),
        ({"keypoints": np.array([-1])}, "must be from 0 to 559"),
        ({"keypoints": np.array([0.5])}, "whole numbers"),
        ({"normals": np.zeros((3, 3))}, "shape of their points"),
        ({"normals": np.zeros((560, 3))}, "keypoint 3 must be a unit vector, got length 0"),
        ({"points": np.zeros(5)}, r"shape \(n, 3\)"),
        ({"points": np.full((560, 3), np.nan)}, "must be points with a depth, got 3"),
    ],
)
def test_bad_input_is_a_cloud_error(change: dict[str, Any], message: str) -> None:
    points, normals = cup()
    given_ = {"points": points, "normals": normals, "keypoints": CUP_KEYPOINTS, "support": 0.08, **change}
    with pytest.raises(CloudError, match=message):
        spin_images(**given_)


def test_no_keypoints_give_no_images() -> None:
    none = np.empty((0, 3), np.float32)
    assert spin_images(none, none, np.empty(0, np.int64), support=0.1, width=2).shape == (0, 15)


if __name__ == "__main__":
    shape = cup()
    values = {
        name: [[round(v, 9) for v in reference(*shape, int(k), **options).tolist()] for k in CUP_KEYPOINTS]
        for name, options in OPTIONS.items()
    }
    GOLDEN.write_text(json.dumps(values).replace("], ", "],\n") + "\n", encoding="utf-8")
