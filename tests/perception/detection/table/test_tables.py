"""Several tables in one cloud: each is found, mentioned in a note, and usable alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.errors import CloudError

Look = Callable[..., PointCloud]

CUBE, PLANK = ((-0.12, -0.1, 0.0), (-0.04, -0.02, 0.08)), ((0.02, -0.15, 0.0), (0.06, 0.1, 0.01))


def beside(height: float) -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
    """Return another table, higher than the first by ``height``, and a cube on it."""
    table = ((0.32, -0.2, height - 0.03), (0.67, 0.2, height))
    return [table, ((0.4, -0.05, height), (0.47, 0.02, height + 0.07))]


def of_thing(found: Detection, cloud: PointCloud, number: int, truth: int) -> float:
    assert cloud.labels is not None
    found_one, true_one = found.labels == number, cloud.labels == truth
    return float((found_one & true_one).sum() / (found_one | true_one).sum())


@pytest.mark.parametrize("height", [-0.15, 0.0, 0.1])
def test_a_second_table_gets_a_note_and_can_be_used(boxes_seen: Look, height: float) -> None:
    cloud = boxes_seen([CUBE, PLANK, *beside(height)], half=0.2)
    first, second = (detect(cloud, DetectionSettings(table=number)) for number in (1, 2))
    assert len(first.boxes) == 2 and first.notes[-1].endswith("use perceive --table 2 to detect them")
    assert min(of_thing(first, cloud, 0, 1), of_thing(first, cloud, 1, 2)) > 0.8
    assert len(second.boxes) == 1 and second.notes == ()
    assert of_thing(second, cloud, 0, 4) > 0.8
    assert first.table is not None and second.table is not None
    assert first.frame[:2, :3] @ second.frame[:2, :3].T == pytest.approx(np.eye(2), abs=0.02)
    plan = np.concatenate([first.boxes[:, 0, :2], first.boxes[:, 1, :2]])
    assert (np.abs(plan) < 0.22).all()  # from the middle of this table, not of both
    step = first.table.heights(-second.table.normal[None] * -second.table.offset)[0]
    assert step == pytest.approx(height, abs=0.01)
    third = detect(cloud, DetectionSettings(table=3))
    assert third.table is None and third.notes == ("there is no table 3: 2 tables were found",)


@pytest.mark.parametrize("things", [[CUBE, PLANK], [CUBE, PLANK, beside(0.0)[0]], [CUBE, PLANK, *beside(-0.45)]])
def test_an_empty_surface_or_a_floor_is_not_a_second_table(boxes_seen: Look, things: list[object]) -> None:
    cloud = boxes_seen(things, half=0.2)
    assert detect(cloud).notes == ()
    assert detect(cloud, DetectionSettings(table=2)).notes == ("there is no table 2: one table was found",)


@pytest.mark.parametrize("covered", [True, False])
def test_a_pile_does_not_divide_a_table(boxes_seen: Look, covered: bool) -> None:
    """Check two slabs of one height side by side with a cube on each, and boxes or the floor between them."""
    slabs = [((-0.45, -0.3, -0.03), (-0.1, 0.3, 0.0)), ((0.1, -0.3, -0.03), (0.45, 0.3, 0.0))]
    cubes = [((-0.3, -0.05, 0.0), (-0.22, 0.03, 0.07)), ((0.22, -0.05, 0.0), (0.3, 0.03, 0.07))]
    pile = [((-0.11, y, -0.03), (0.11, y + 0.14, 0.05 + y / 5)) for y in (-0.35, -0.2, -0.05, 0.1, 0.25)]
    floor = [((-2.0, -2.0, -0.8), (2.0, 2.0, -0.75))]
    cloud = boxes_seen([*slabs, *cubes, *(pile if covered else floor)], half=0.0)
    found = detect(cloud)
    best = [max(of_thing(found, cloud, k, cube) for k in range(len(found.boxes))) for cube in (3, 4)]
    assert sum(share > 0.8 for share in best) == 1 + covered


def test_a_strip_of_a_wall_is_not_a_part_of_the_table(boxes_seen: Look) -> None:
    tall = ((-0.1, 0.2, 0.0), (0.1, 0.26, 0.5))
    cloud = boxes_seen([CUBE, tall, ((-1.0, 0.9, -0.6), (1.0, 0.95, 1.0))], half=0.4)
    found = detect(cloud)
    assert len(found.boxes) == 2 and np.abs(found.boxes[..., :2]).max() < 0.5


def test_tables_are_numbered_from_one() -> None:
    with pytest.raises(CloudError, match="`table` must be a whole number of at least 1"):
        DetectionSettings(table=0)


def test_without_a_table_there_is_no_second_one() -> None:
    y, z = (axis.ravel() for axis in np.mgrid[-1:1:0.02, -1:1:0.02])
    wall = np.stack([np.full(y.shape, 1.0), y, z], axis=1).astype(np.float32)
    found = detect(PointCloud(wall), DetectionSettings(table=2, up=(0.0, 0.0, 1.0)))
    assert found.table is None and found.notes[0].startswith("no table was found")
