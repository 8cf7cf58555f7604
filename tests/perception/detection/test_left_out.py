"""Notes on points above a table that are not reported, and no notes on an ordinary table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import detect
from deixis.perception.detection.left_out import odd_sizes
from deixis.perception.detection.settings import DetectionSettings, NoteSettings

Look = Callable[..., PointCloud]
Box = tuple[tuple[float, float, float], tuple[float, float, float]]

CUBE: Box = ((-0.04, -0.04, 0.0), (0.04, 0.04, 0.08))
ARM: Box = ((0.1, 0.0, 0.08), (0.7, 0.07, 0.15))
TALL: Box = ((-0.2, 0.1, 0.0), (0.2, 0.2, 0.5))
SHELF: Box = ((0.45, -0.2, -0.3), (0.6, 0.2, 0.3))


@pytest.mark.parametrize(
    ("things", "half", "said"),
    [
        ([CUBE, ARM], 0.35, "reaches over the edge"),
        ([CUBE, TALL], 0.5, "more than 20 cm above the table"),
        ([CUBE, SHELF], 0.35, "beside the table"),
    ],
)
def test_unreported_points_get_a_note(boxes_seen: Look, things: list[Box], half: float, said: str) -> None:
    notes = detect(boxes_seen(things, half=half), DetectionSettings(reach=0.2)).notes
    assert any(said in note for note in notes), notes


def test_an_ordinary_table_has_no_notes(boxes_seen: Look) -> None:
    assert detect(boxes_seen([CUBE, ((0.1, 0.1, 0.0), (0.3, 0.14, 0.01))])).notes == ()


def test_points_in_very_small_pieces_get_a_note(boxes_seen: Look) -> None:
    rng = np.random.default_rng(0)
    specks = [((x, y, 0.0), (x + 0.012, y + 0.012, 0.03)) for x, y in rng.uniform(-0.3, 0.3, (40, 2)).tolist()]
    strict = DetectionSettings(least_length=0.05)
    assert any("too small or too low" in note for note in detect(boxes_seen([CUBE, *specks]), strict).notes)


def test_a_hole_in_the_depth_of_a_table_gets_a_note(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE])
    assert cloud.organised is not None
    points = cloud.points.copy().reshape(*cloud.organised, 3)
    points[60:120, 130:190] = np.nan
    notes = detect(replace(cloud, points=points.reshape(-1, 3))).notes
    assert any("has no depth: shiny, dark or transparent" in note for note in notes)


@pytest.mark.parametrize(("axis", "name"), [(0, "rows"), (1, "columns")])
def test_lines_without_depth_get_a_note(boxes_seen: Look, axis: int, name: str) -> None:
    cloud = boxes_seen([CUBE])
    assert cloud.organised is not None
    points = cloud.points.copy()
    points[(np.indices(cloud.organised)[axis] % 2 == 0).ravel()] = np.nan
    (note,) = detect(replace(cloud, points=points)).notes
    assert f"{name} of the image have no depth" in note


def test_sizes_unusual_for_tableware_get_a_note() -> None:
    usual, limits = np.array([0.2, 0.15, 0.05]), NoteSettings()
    assert odd_sizes(usual, limits) == ()
    for factor in (10.0, 0.1):
        (note,) = odd_sizes(factor * usual, limits)
        assert note.endswith("check the unit")
    assert odd_sizes(np.array([3.0]), limits) == ()  # one object shows nothing about the unit
