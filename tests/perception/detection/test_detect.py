"""Detection of objects in a cloud: results, numbering, and changes that do not affect them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
import pytest
from hard_tables import odd_clouds
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.detection.settings import (
    BoundarySettings,
    DetectionSettings,
    JoiningSettings,
    PlaneSettings,
    SurfaceSettings,
)
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.errors import CloudError

Look = Callable[..., PointCloud]
ToTable = Callable[[NDArray[np.floating]], NDArray[np.float64]]

CUBE, PLANK = ((-0.25, -0.1, 0.0), (-0.17, -0.02, 0.08)), ((0.0, -0.1, 0.0), (0.25, -0.06, 0.008))
LOW, STACKED = ((-0.1, 0.0, 0.0), (0.1, 0.16, 0.05)), ((-0.04, 0.04, 0.05), (0.03, 0.1, 0.13))


def overlaps(found: Detection, cloud: PointCloud) -> list[float]:
    """Return the best intersection over union of each true object with a detected one."""
    truth = cloud.labels
    assert truth is not None
    result = []
    for thing in range(1, truth.max() + 1):
        of = truth == thing
        numbers = np.unique(found.labels[of & (found.labels >= 0)])
        shares = [(of & (found.labels == k)).sum() / (of | (found.labels == k)).sum() for k in numbers]
        result.append(float(max(shares, default=0.0)))
    return result


def test_separate_objects_are_found_placed_and_numbered(boxes_seen: Look, to_table: ToTable) -> None:
    cloud = boxes_seen([PLANK, CUBE])
    found = detect(cloud)
    assert min(overlaps(found, cloud)) > 0.8
    assert found.scene().ids == ("o1", "o2")
    back = np.linalg.inv(found.frame)
    centres = to_table(found.boxes.mean(axis=1) @ back[:3, :3].T + back[:3, 3])
    assert centres[0, :2] == pytest.approx([-0.21, -0.06], abs=0.006)
    assert centres[1, :2] == pytest.approx([0.125, -0.08], abs=0.006)
    assert found.boxes[1, 1, 2] == pytest.approx(0.008, abs=0.002)
    assert found.oriented[1].extents[:2] == pytest.approx([0.25, 0.04], abs=0.01)
    assert [thing.oriented for thing in found.scene().objects] == [box.rounded(6) for box in found.oriented]


def test_an_object_on_an_object_is_two_objects(boxes_seen: Look) -> None:
    cloud = boxes_seen([LOW, STACKED])
    assert min(overlaps(detect(cloud), cloud)) > 0.8


def test_touching_objects_are_two_if_one_is_higher(boxes_seen: Look) -> None:
    cloud = boxes_seen([((-0.1, 0.0, 0.0), (0.0, 0.1, 0.04)), ((0.0, 0.0, 0.0), (0.1, 0.1, 0.10))])
    assert min(overlaps(detect(cloud), cloud)) > 0.7


def test_an_object_behind_another_is_separate(boxes_seen: Look) -> None:
    cloud = boxes_seen([((-0.05, -0.1, 0.0), (0.05, -0.04, 0.1)), ((-0.12, 0.1, 0.0), (0.12, 0.14, 0.15))])
    assert min(overlaps(detect(cloud), cloud)) > 0.8


@pytest.mark.parametrize("clear", [0.03, 0.0])
def test_a_raised_part_beside_an_object_is_its_handle(boxes_seen: Look, clear: float) -> None:
    mug, handle = ((-0.1, 0.0, 0.0), (-0.02, 0.08, 0.09)), ((-0.016, 0.03, clear), (0.014, 0.05, 0.07))
    cloud = boxes_seen([mug, handle], colours=[(200, 60, 50), (200, 60, 50)])
    assert len(detect(cloud).boxes) == (1 if clear else 2)


def test_a_plate_of_one_colour_continues_below_a_knife(boxes_seen: Look) -> None:
    plate, knife = ((-0.1, -0.1, 0.0), (0.1, 0.1, 0.02)), ((-0.018, -0.1, 0.02), (0.018, 0.1, 0.045))
    cloud = boxes_seen([plate, knife], colours=[(230, 230, 225), (90, 95, 100)])
    found = detect(cloud)
    assert min(overlaps(found, cloud)) > 0.75 and len(found.boxes) == 2


def test_labels_are_those_of_the_points_in_the_order_of_the_file(boxes_seen: Look, to_table: ToTable) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    found = detect(cloud)
    assert found.labels.shape == (len(cloud),) and found.labels.dtype == np.int32
    assert (found.labels[~cloud.finite] == -1).all()
    for number, box in enumerate(found.boxes):
        points = cloud.points[found.labels == number] @ found.frame[:3, :3].T + found.frame[:3, 3]
        assert ((points > box[0] - 0.004) & (points < box[1] + 0.004)).all(axis=1).mean() > 0.99


def test_true_labels_in_a_cloud_are_ignored(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, LOW, STACKED])
    assert (detect(cloud).labels == detect(replace(cloud, labels=None)).labels).all()


def test_the_same_cloud_gives_the_same_answer(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, LOW, STACKED], noise=2e-3)
    one, other = detect(cloud), detect(cloud)
    assert (one.labels == other.labels).all() and (one.boxes == other.boxes).all() and (one.frame == other.frame).all()


@pytest.mark.parametrize("seed", range(3))
def test_moving_the_whole_cloud_changes_nothing(boxes_seen: Look, seed: int) -> None:
    cloud = boxes_seen([CUBE, PLANK, LOW, STACKED])
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    shift = rng.uniform(-2, 2, 3)
    moved = replace(cloud, points=(cloud.points @ turn.T + shift).astype(np.float32), origin=tuple(shift.tolist()))
    before, after = detect(cloud), detect(moved)
    assert after.boxes == pytest.approx(before.boxes, abs=0.002)
    assert (after.labels == before.labels).mean() > 0.995


def test_an_unorganised_cloud_gives_the_same_objects(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, LOW, STACKED])
    shuffled = cloud.take(np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite)))
    assert shuffled.organised is None
    found = detect(shuffled)
    assert min(overlaps(found, shuffled)) > 0.8


def test_from_the_other_side_left_is_right(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE, PLANK])
    here = detect(cloud)
    beyond = np.linalg.inv(here.frame) @ (0.0, 3.0, 0.5, 1.0)
    x, y, z = beyond[:3].tolist()
    there = detect(cloud, DetectionSettings(viewer=(x, y, z)))
    assert len(there.boxes) == 2
    assert there.boxes[0, 0, :2] == pytest.approx(-here.boxes[1, 1, :2], abs=0.01)


def test_a_few_points_are_not_an_error() -> None:
    one = detect(PointCloud(np.array([[0.0, 0.0, 1.0]], np.float32)))
    assert one.table is None and one.labels.tolist() == [-1] and "no table" in one.notes[0]
    corner = detect(PointCloud(np.array([[0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]], np.float32)))
    assert corner.boxes.shape == (0, 2, 3) and corner.scene().objects == ()


def test_an_empty_table_gets_a_note(boxes_seen: Look) -> None:
    found = detect(boxes_seen([]))
    assert found.table is not None and found.notes == ("nothing is on the table",)


def test_a_cloud_without_a_finite_point_is_bad_input() -> None:
    with pytest.raises(CloudError, match="without one finite point"):
        detect(PointCloud(np.full((4, 3), np.nan, np.float32), organised=(2, 2)))
    with pytest.raises(CloudError, match="without one finite point"):
        detect(PointCloud(np.zeros((0, 3), np.float32)))


@pytest.mark.parametrize(
    ("group", "wrong", "message"),
    [
        (
            SurfaceSettings,
            {"min_jump": -0.1},
            "`min_jump` of SurfaceSettings must be a finite number of at least 0",
        ),
        (
            SurfaceSettings,
            {"min_radius": 0.5},
            "`max_radius` of SurfaceSettings must be at least the corresponding minimum, 0.5",
        ),
        (PlaneSettings, {"max_planes": 0}, "`max_planes` of PlaneSettings must be a whole number of at least 1, got 0"),
        (JoiningSettings, {"patch_width": math.nan}, "`patch_width` of JoiningSettings must be a finite number"),
        (DetectionSettings, {"joining": {"patch_width": 0.1}}, "`joining` must be JoiningSettings"),
    ],
)
def test_impossible_thresholds_are_refused(
    group: Callable[..., object], wrong: dict[str, object], message: str
) -> None:
    with pytest.raises(CloudError, match=re.escape(message)):
        group(**wrong)


def test_other_thresholds_give_other_objects(boxes_seen: Look) -> None:
    cloud = boxes_seen([LOW, STACKED])
    unjoined = DetectionSettings(
        boundaries=BoundarySettings(merge_limit=0.0), joining=JoiningSettings(fragment_area=0.0)
    )
    assert len(detect(cloud).boxes) == 2 < len(detect(cloud, unjoined).boxes)


@pytest.mark.parametrize(
    "wrong", [{"height": 0.0}, {"reach": float("nan")}, {"up": (0.0, 0.0, 0.0)}, {"least_points": 0}]
)
def test_impossible_settings_are_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(CloudError, match=r"^`\w+` must "):
        DetectionSettings(**wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", ["x", True, (), float("nan"), (1.0, 2.0, "z"), -1])
@pytest.mark.parametrize("name", [field.name for field in fields(DetectionSettings)])
def test_a_setting_of_another_type_is_refused(name: str, value: object) -> None:
    with pytest.raises(CloudError, match=r"^`\w+` must "):
        DetectionSettings(**{name: value})  # type: ignore[arg-type]


def test_a_very_small_table_gets_a_note(boxes_seen: Look) -> None:
    small = boxes_seen([((-0.04, -0.04, 0.0), (0.04, 0.04, 0.08)), ((0.3, 0.3, -0.6), (0.6, 0.6, -0.5))], half=0.12)
    notes = detect(small).notes
    assert any(note.startswith("the detected table is only 2") for note in notes)


@pytest.mark.parametrize("organised", [None, (80, 80)])
def test_a_small_cloud_is_one_object_without_a_table(organised: tuple[int, int] | None) -> None:
    y, x = (axis.ravel() for axis in np.mgrid[-1:1:80j, -1:1:80j])
    depth = 0.7 + 0.06 * (1 - np.sqrt(np.maximum(2.0 - x**2 - y**2, 0)))
    ball = np.stack([0.085 * x, 0.085 * y, np.ones_like(x)], axis=1) * depth[:, None]
    cloud = PointCloud(ball.astype(np.float32), organised=organised)
    found = detect(cloud)
    assert found.table is None and (found.labels == 0).all()
    low, high = found.boxes[0]
    inside = (moved(ball, found.frame) >= low - 1e-4) & (moved(ball, found.frame) <= high + 1e-4)
    assert inside.all(axis=1).mean() > 0.98 and low[2] == pytest.approx(0.0, abs=0.002)
    assert high[:2] == pytest.approx(-low[:2], abs=0.005) and found.scene().ids == ("o1",)
    assert found.notes[0].startswith("no table was found: the whole cloud, 12 by")


def test_a_surface_as_wide_as_a_table_is_not_one_object(boxes_seen: Look) -> None:
    assert detect(boxes_seen([CUBE], half=0.22)).table is not None


def test_a_wall_detected_as_a_table_gets_a_note() -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-1:1:0.02, -1:1:0.02])
    turn, z = np.random.default_rng(0).uniform((0, 1.0), (2 * np.pi, 2.5), (12_000, 2)).T
    near = np.stack([0.3 * np.cos(turn), 0.3 * np.sin(turn), z], axis=1)
    cloud = np.concatenate([np.stack([x, y, np.full(x.shape, 3.4)], axis=1), near])
    found = detect(PointCloud(cloud.astype(np.float32)), DetectionSettings(up=(0.0, 0.0, -1.0)))
    assert found.notes[0] == "nothing is on the table" and found.notes[1].endswith("it may be a wall")


@pytest.mark.parametrize(("scale", "hint"), [(1000.0, "millimetres by 1000"), (0.001, "depth_scale")])
def test_a_cloud_in_another_unit_is_refused_with_a_hint(scale: float, hint: str) -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.01, 0.5:1.5:0.01])
    points = scale * np.stack([x, y, np.full(x.shape, -0.7)], axis=1)
    with pytest.raises(CloudError, match=hint):
        detect(PointCloud(points.astype(np.float32)))


def test_a_very_large_table_gets_a_note() -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-8:8:0.05, 4:14:0.05])
    found = detect(PointCloud(np.stack([x, y, np.full(x.shape, -5.0)], axis=1).astype(np.float32)))
    assert found.notes[0] == "nothing is on the table"
    assert any(note.endswith("coordinates must be metres: check the unit") for note in found.notes)


@pytest.mark.parametrize(("share", "nearest", "farthest"), [(0.5, 0.6, 1.0), (0.3, 0.9, 1.1)])
def test_scattered_depth_takes_seconds(share: float, nearest: float, farthest: float, boxes_seen: Look) -> None:
    """Check the time for scattered points, which form tens of thousands of pieces next to one large piece."""
    cloud = boxes_seen([CUBE])
    rng = np.random.default_rng(0)
    moved = np.where(rng.random(len(cloud)) < share, rng.uniform(nearest, farthest, len(cloud)), 1.0)
    detect(cloud)  # the first call compiles
    with processor_time_below(3.0):
        detect(replace(cloud, points=(cloud.points * moved[:, None]).astype(np.float32)))


@pytest.mark.parametrize("bare", [False, True])
def test_depth_with_5_percent_noise_takes_seconds(bare: bool) -> None:
    """Check the time for an image in which half of the pixels are moved along their rays by up to 5 %."""
    cloud = odd_clouds(0)["half the pixels within 5 % of their depth"]
    if bare:
        cloud = cloud.take(np.random.default_rng(0).permutation(np.flatnonzero(cloud.finite)))
    detect(cloud)  # the first call compiles
    with processor_time_below(3.0):
        detect(cloud)


def test_a_surface_of_bumps_takes_seconds() -> None:
    """Check the time for hundreds of level parts, of which each may be a part of the table."""
    cloud = odd_clouds(0)["a surface of bumps"]
    with processor_time_below(3.0):
        detect(cloud)


def test_a_heap_of_bare_points_takes_seconds() -> None:
    cloud = odd_clouds(0)["a heap of points"]
    with processor_time_below(3.0):
        detect(cloud)


def test_the_order_of_bare_points_changes_little(boxes_seen: Look) -> None:
    cloud = boxes_seen([PLANK, CUBE, LOW, STACKED])
    kept = np.flatnonzero(cloud.finite)
    rng = np.random.default_rng(2)
    looks = [detect(cloud.take(rng.permutation(kept))) for _ in range(2)]
    assert looks[0].boxes.shape == looks[1].boxes.shape
    assert looks[0].boxes == pytest.approx(looks[1].boxes, abs=0.005)


def test_scattered_points_are_not_a_table() -> None:
    found = detect(PointCloud(np.random.default_rng(0).random((50, 3)).astype(np.float32)))
    assert found.table is None and found.notes[0].startswith("no table was found")


@pytest.mark.filterwarnings("error")
def test_infinite_depth_counts_as_missing(boxes_seen: Look) -> None:
    cloud = boxes_seen([PLANK, CUBE])
    points = cloud.points.copy()
    points[::3] = np.inf
    points[1::3, 1:] = -np.inf
    nothing = points.copy()
    nothing[~np.isfinite(points).all(axis=1)] = np.nan
    found, wanted = (detect(replace(cloud, points=each)) for each in (points, nothing))
    assert np.array_equal(found.labels, wanted.labels)
