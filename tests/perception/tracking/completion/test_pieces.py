"""Pieces of things: handles, stems and feet that are hidden or were taken for things."""

import numpy as np
import pytest
from flat_tables import BLUE, OPTICS, SHAPE, STEEL, lay, table, thing_at, view

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.completion.pieces import (
    floating_parts,
    stands_behind,
    stands_on_table,
    supporting_parts,
)
from deixis.perception.tracking.frames.image import FrameImage
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.things.pipeline import Pipeline


@pytest.mark.parametrize(("colour", "above", "aside", "is_one"), [
    (BLUE, 0.1, 0.0, True), (STEEL, 0.1, 0.0, False), (BLUE, 0.01, 0.0, False), (BLUE, 0.1, 0.1, False),
])  # fmt: skip
def test_stem_and_foot_are_parts_of_the_bowl_above(
    colour: tuple[int, int, int], above: float, aside: float, is_one: bool
) -> None:
    bowl, foot = thing_at(np.s_[20:40, 50:70], 1, BLUE), thing_at(np.s_[22:38, 52:68], 2, colour)
    bowl.pose = bowl.pose.copy()
    bowl.pose[:3, 3] += aside, 0.0, above
    assert supporting_parts(bowl, [foot]) == ([foot] if is_one else [])
    assert supporting_parts(foot, [bowl]) == []


def test_half_hidden_foot_is_a_part_of_the_bowl_above() -> None:
    bowl, foot = thing_at(np.s_[20:40, 50:70], 1, BLUE), thing_at(np.s_[20:40, 50:60], 2, BLUE)
    bowl.pose = bowl.pose.copy()
    bowl.pose[2, 3] += 0.1
    disc = np.linalg.norm(foot.placed_points[:, :2] - bowl.pose[:2, 3], axis=1) < 0.05
    foot.cloud = foot.cloud.take(disc)
    assert supporting_parts(bowl, [foot]) == [foot], "the middle of what is seen of it is not below the bowl"


@pytest.mark.parametrize(("is_hidden", "stands"), [(True, True), (False, False)])
def test_thing_with_a_hidden_foot_stands_on_the_table(is_hidden: bool, stands: bool) -> None:
    on, glass = table(), thing_at(np.s_[25:35, 55:65], 1, BLUE)
    glass.pose = glass.pose.copy()
    glass.pose[2, 3] = 0.2
    glass.oriented = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.05, 0.05, 0.06))
    if is_hidden:
        lay(on, np.s_[20:40, 50:70], STEEL, 2, 0.22)
    image = FrameImage(np.zeros((*SHAPE, 3), np.float32), on.depth, on.colour, OPTICS)
    assert stands_behind(glass, [glass], image, view()) == stands
    glass.stand()
    assert glass.pose[2, 3] == pytest.approx(0.115) and glass.oriented.extents[2] == pytest.approx(0.23)
    assert not stands_behind(glass, [glass], image, view())


@pytest.mark.parametrize(
    ("lowest", "colour", "is_part"), [(0.02, STEEL, True), (0.0, STEEL, False), (0.02, BLUE, False)]
)
def test_handle_taken_for_a_thing_is_a_part_of_its_cup(
    lowest: float, colour: tuple[int, int, int], is_part: bool
) -> None:
    z = np.arange(0.0, 0.08, 0.002)
    angle = np.linspace(0, 2 * np.pi, 100)
    body = np.array([(0.04 * np.cos(a), 0.04 * np.sin(a), h) for a in angle for h in z])
    ear = np.array([(x, 0.0, h) for x in np.arange(0.042, 0.07, 0.002) for h in z if lowest <= h < 0.07])
    cup, handle = (
        Pipeline(
            f"t{slot}", slot, PointCloud(points.astype(np.float32), np.full((len(points), 3), tint, np.uint8)),
            np.array([0.04, 0.04, 0.04]), OrientedBox((0.0, 0.0, 0.04), 0.0, (0.08, 0.08, top)), np.eye(4), 0.0,
            TrackingSettings(),
        )
        for slot, points, tint, top in ((1, body, STEEL, 0.08), (2, ear, colour, 0.07))
    )  # fmt: skip
    assert floating_parts(cup, [handle]) == ([handle] if is_part else [])
    assert floating_parts(handle, [cup]) == []


@pytest.mark.parametrize(
    ("bottom", "height", "stands"), [(0.005, 0.08, True), (0.0, 0.08, False), (0.005, 0.01, False), (0.05, 0.08, False)]
)
def test_high_thing_a_little_above_the_table_stands_on_it(bottom: float, height: float, stands: bool) -> None:
    mug = thing_at(np.s_[25:35, 55:65], 1, BLUE)
    mug.oriented = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.05, 0.05, height))
    mug.pose = mug.pose.copy()
    mug.pose[2, 3] = bottom + height / 2
    assert stands_on_table(mug, [mug]) == stands
    plate = thing_at(np.s_[20:40, 50:70], 2)
    assert not stands_on_table(mug, [mug, plate]), "it may stand on the plate"
