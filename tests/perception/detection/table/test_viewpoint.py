"""Unorganised clouds with a known viewpoint, an unknown one, or none."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.detection.settings import DetectionSettings, SurfaceSettings, ViewpointSettings
from deixis.perception.detection.table.neighbours import neighbour_table
from deixis.perception.detection.table.viewpoint import apart, camera_pose_of
from deixis.perception.errors import CloudError

Look = Callable[..., PointCloud]
ToTable = Callable[[NDArray[np.floating]], NDArray[np.float64]]

CUBE, PLANK = ((-0.25, -0.1, 0.0), (-0.17, -0.02, 0.08)), ((0.0, -0.1, 0.0), (0.25, -0.06, 0.008))
LOW, STACKED = ((-0.1, 0.0, 0.0), (0.1, 0.16, 0.05)), ((-0.04, 0.04, 0.05), (0.03, 0.1, 0.13))
CENTRES = [[-0.21, -0.06], [0.125, -0.08]]


def no_image(cloud: PointCloud) -> PointCloud:
    return cloud.take(np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite)))


def centres(found: Detection) -> NDArray[np.float64]:
    """Return the centres of the detected objects in the frame of the cloud."""
    back = np.linalg.inv(found.frame)
    result: NDArray[np.float64] = found.boxes.mean(axis=1) @ back[:3, :3].T + back[:3, 3]
    return result


def test_neighbours_in_direction_are_the_pixels_around_a_pixel(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, STACKED])
    kept = np.flatnonzero(cloud.finite)
    points = cloud.points[kept].astype(np.float64)
    pixels = neighbour_table(points, kept, cloud.organised, SurfaceSettings())
    inner = (pixels >= 0).all(axis=1)
    found = neighbour_table(points, kept, None, SurfaceSettings(), np.zeros(3))
    assert inner.sum() > 10_000
    assert (np.sort(found[inner], axis=1) == np.sort(pixels[inner], axis=1)).all()


def test_an_image_without_its_order_gives_the_same_objects(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, PLANK, LOW, STACKED])
    order = np.random.default_rng(1).permutation(np.flatnonzero(cloud.finite))
    as_image, as_points = detect(cloud), detect(cloud.take(order))
    assert len(as_points.boxes) == len(as_image.boxes) == 4
    image = as_image.labels[order]
    whose = np.array([np.bincount(as_points.labels[image == k] + 1).argmax() - 1 for k in range(-1, 4)])
    assert sorted(whose.tolist()) == [-1, 0, 1, 2, 3]
    assert (whose[image + 1] == as_points.labels).mean() > 0.99


def test_neighbours_from_a_wrong_viewpoint_are_far_apart(boxes_seen: Look, to_table: ToTable) -> None:
    points = no_image(boxes_seen([CUBE, STACKED, LOW])).points.astype(np.float64)
    limits = ViewpointSettings()
    assert apart(points, np.zeros(3), limits) < limits.max_far_share / 2
    assert apart(to_table(points), np.zeros(3), limits) > 2 * limits.max_far_share


@pytest.mark.parametrize("shift", [(0.0, 0.0, 0.0), (0.8, 0.1, 0.75), (3.0, 2.0, 1.0)])
@pytest.mark.parametrize("organised", [True, False])
def test_a_cloud_with_a_wrong_origin_keeps_its_own_y_axis(
    boxes_seen: Look, to_table: ToTable, shift: tuple[float, float, float], organised: bool
) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    cloud = cloud if organised else no_image(cloud)
    found = detect(replace(cloud, points=(to_table(cloud.points) + shift).astype(np.float32)))
    assert found.frame[:3, :3] == pytest.approx(np.eye(3), abs=0.01)
    assert len(found.boxes) == 2
    assert (centres(found) - shift)[:, :2] == pytest.approx(np.array(CENTRES), abs=0.008)


def test_an_image_that_was_moved_gives_the_same_objects(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    one, other = detect(cloud), detect(replace(cloud, points=cloud.points + np.array([5, 0, 0], np.float32)))
    assert one.table is not None and other.table is not None
    assert float(one.table.normal @ other.table.normal) > 0.999
    assert len(other.boxes) == len(one.boxes) == 2
    assert ((other.labels >= 0) == (one.labels >= 0)).mean() > 0.99


@pytest.mark.parametrize("aside", [0.0, 0.3])
def test_right_in_the_image_is_right_wherever_the_table_is(boxes_seen: Look, aside: float) -> None:
    cloud = boxes_seen([CUBE, PLANK], half=0.3)
    shown = cloud.points.reshape(*(cloud.organised or ()), 3).copy()
    shown[:, : int(aside * shown.shape[1])] = np.nan  # the table begins there
    found = detect(PointCloud(shown.reshape(-1, 3), organised=cloud.organised))
    assert found.frame[0, :3] == pytest.approx([1, 0, 0], abs=0.01)


def test_a_camera_held_upside_down_sees_the_same_table(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    points = (cloud.points * np.array([-1, -1, 1]))[::-1].astype(np.float32)
    one, other = detect(cloud), detect(PointCloud(points, organised=cloud.organised))
    assert other.boxes == pytest.approx(one.boxes, abs=0.003)
    assert (other.labels[::-1] == one.labels).mean() > 0.99


@pytest.mark.parametrize("lost", ["rows", "columns", "two of three rows", "chequered", "half at random"])
def test_a_table_is_found_despite_missing_lines_of_the_image(boxes_seen: Look, lost: str) -> None:
    cloud = boxes_seen([CUBE, LOW, STACKED])
    assert cloud.organised is not None
    row, column = np.indices(cloud.organised)
    masks = {
        "rows": row % 2 == 0,
        "columns": column % 2 == 0,
        "two of three rows": row % 3 > 0,
        "chequered": (row + column) % 2 == 0,
        "half at random": np.random.default_rng(0).random(row.shape) < 0.5,
    }
    points = cloud.points.copy()
    points[masks[lost].ravel()] = np.nan
    found, whole = detect(replace(cloud, points=points)), detect(cloud)
    assert len(found.boxes) == 3
    kept = np.isfinite(points).all(axis=1)
    assert ((found.labels >= 0) == (whole.labels >= 0))[kept].mean() > 0.99


def test_the_viewpoint_is_found_despite_noise_in_all_directions(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    noise = np.random.default_rng(0).normal(0, 1e-3, cloud.points.shape)
    noisy = replace(cloud, points=(cloud.points + noise).astype(np.float32))
    assert camera_pose_of(noisy, DetectionSettings()).known
    assert detect(noisy).frame[0, :3] == pytest.approx([1, 0, 0], abs=0.01)


def test_a_cloud_in_millimetres_is_refused_with_the_reason(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE])
    with pytest.raises(CloudError, match="millimetres"):
        detect(replace(cloud, points=cloud.points * np.float32(1000)))


def test_a_few_distant_points_do_not_suggest_another_unit(boxes_seen: Look) -> None:
    cloud = no_image(boxes_seen([CUBE]))
    far = np.random.default_rng(0).uniform(100, 200, (200, 3)).astype(np.float32)
    assert len(detect(PointCloud(np.concatenate([cloud.points, far]))).boxes) == 1
