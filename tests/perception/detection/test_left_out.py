"""Notes on points above a table that are not reported, and no notes on an ordinary table."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import label

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import detect
from deixis.perception.detection.left_out import odd_sizes
from deixis.perception.detection.settings import DetectionSettings, NoteSettings
from deixis.perception.detection.shown import Shows

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


def test_scattered_pixels_without_depth_get_a_note(boxes_seen: Look) -> None:
    cloud = boxes_seen([CUBE])
    points = cloud.points.copy()
    points[np.random.default_rng(0).random(len(points)) < 0.5] = np.nan
    notes = detect(replace(cloud, points=points)).notes
    assert any("of the pixels on the table have no depth" in note for note in notes)


@pytest.mark.parametrize("where", [(1e6, 1e6, 1e6), (-1e6, -1e6, 1e6), (0.0, 0.0, 65.535), (0.0, -60.0, 1.0)])
@pytest.mark.parametrize("organised", [True, False])
def test_points_far_from_the_others_are_left_out_and_noted(
    boxes_seen: Look, where: tuple[float, float, float], organised: bool
) -> None:
    cloud = boxes_seen([CUBE])
    points = cloud.points.copy()
    far = np.random.default_rng(0).choice(np.flatnonzero(cloud.finite), 30, replace=False)
    points[far] = where
    changed = replace(cloud, points=points)
    found = detect(changed if organised else changed.take(changed.finite))
    assert "30 points more than 50 m from the middle of the cloud were left out" in found.notes[-1]
    assert len(found.boxes) == 1 and np.abs(found.boxes).max() < 1
    assert (found.labels[far if organised else np.isin(np.flatnonzero(changed.finite), far)] == -1).all()


def test_a_far_point_is_not_a_part_of_a_single_object() -> None:
    side = np.linspace(0, 0.1, 40)
    x, y = (axis.ravel() for axis in np.meshgrid(side, side))
    points = np.stack([x, y, 1 + x * y], axis=1).astype(np.float32)
    points[7] = 1e6
    found = detect(PointCloud(points))
    assert found.shows == Shows.OBJECT and found.labels[7] == -1 and np.abs(found.boxes).max() < 1
    assert found.notes[-1].startswith("one point more than 50 m from the middle of the cloud was left out")


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


KINDS: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {  # sides and heights of boxes, in metres
    "plain": ((0.02, 0.15), (0.015, 0.25)),
    "pile": ((0.02, 0.15), (0.015, 0.25)),
    "at the edge": ((0.02, 0.15), (0.015, 0.25)),
    "tall": ((0.02, 0.15), (0.4, 1.0)),
    "tiny": ((0.008, 0.02), (0.01, 0.03)),
}
VIEWS = ("image", "image of one colour", "image with holes", "bare points", "scan")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("kind", "view"),  # a scan without a viewpoint does not show which side of a tall box is up
    [(kind, view) for kind in KINDS for view in VIEWS if (kind, view) != ("tall", "scan")],
)
def test_every_raised_group_is_reported_or_counted(
    boxes_seen: Look, boxes_scanned: Look, kind: str, view: str, seed: int
) -> None:
    rng = np.random.default_rng([seed, list(KINDS).index(kind), VIEWS.index(view)])
    boxes = random_boxes(kind, rng)
    if view == "scan":
        spacing, ratio = rng.choice([0.003, 0.005, 0.01, 0.02]), rng.choice([0.5, 1, 3, 10, 20])
        cloud = boxes_scanned(boxes, spacing, max(spacing / ratio, 0.001))
    else:
        alike = [(150, 112, 78)] * len(boxes) if view == "image of one colour" else None
        cloud = boxes_seen(boxes, noise=rng.choice([2e-4, 5e-4, 1.5e-3]), seed=seed, colours=alike)
    if view == "image with holes":
        cloud = with_holes(cloud, rng)
    if view == "bare points":
        cloud = cloud.take(rng.permutation(np.flatnonzero(cloud.finite)))
    found = detect(replace(cloud, labels=None))
    if found.table is None:  # one object, which is all points, or a note that there is no table
        assert found.notes and ((found.labels >= 0) == cloud.finite).all() == (len(found.boxes) == 1)
        return
    points = cloud.points.astype(np.float64)
    with np.errstate(invalid="ignore"):
        missed = (found.table.heights(points) > 0.03) & (found.labels < 0)
    assert counted(found.notes) >= grouped(points[missed], DetectionSettings().least_points)


def random_boxes(kind: str, rng: np.random.Generator) -> list[Box]:
    """Return one to seven boxes on a table of a metre; in a pile, some stand on others."""
    sides, heights = KINDS[kind]
    boxes: list[Box] = []
    for _ in range(int(rng.integers(1, 8))):
        (width, depth), height = rng.uniform(*sides, 2).tolist(), float(rng.uniform(*heights))
        x, y = rng.uniform(-0.42, 0.42, 2).tolist()
        z = 0.0
        if kind == "at the edge":
            x = 0.5 * float(rng.choice([-1, 1]))
        if kind == "pile" and boxes:
            low, high = boxes[int(rng.integers(len(boxes)))]
            x, y, z = (low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2]
        boxes.append(((x - width / 2, y - depth / 2, z), (x + width / 2, y + depth / 2, z + height)))
    return boxes


def with_holes(cloud: PointCloud, rng: np.random.Generator) -> PointCloud:
    """Return an image without depth in some rectangles."""
    assert cloud.organised is not None
    points = cloud.points.reshape(*cloud.organised, 3).copy()
    for row, column in rng.integers(0, (cloud.organised[0] - 30, cloud.organised[1] - 30), (4, 2)).tolist():
        points[row : row + int(rng.integers(5, 50)), column : column + int(rng.integers(5, 50))] = np.nan
    return replace(cloud, points=points.reshape(-1, 3))


def counted(notes: tuple[str, ...]) -> int:
    """Return the sum of the points that notes count as left out."""
    said = r"^(\d+) of the \d+ points|^(\d+) points are|of (\d+) points, w"
    return sum(int(number) for note in notes for found in re.findall(said, note) for number in found if number)


def grouped(points: NDArray[np.float64], least: int) -> int:
    """Return the number of points in connected groups of at least so many points."""
    if not len(points):
        return 0
    cells = np.floor((points - points.min(axis=0)) / 0.01).astype(np.int64)
    grid = np.zeros(cells.max(axis=0) + 1, dtype=np.bool_)
    grid[tuple(cells.T)] = True
    sizes = np.bincount(label(grid, np.ones((3, 3, 3)))[0][tuple(cells.T)])
    return int(sizes[sizes >= least].sum())


def test_a_small_thing_that_is_not_reported_is_counted(boxes_seen: Look) -> None:
    speck: Box = ((0.1, 0.1, 0.0), (0.13, 0.13, 0.04))
    cloud = boxes_seen([CUBE, speck])
    assert cloud.labels is not None
    found = detect(cloud, DetectionSettings(least_length=0.07))
    (note,) = found.notes
    assert int(note.split()[0]) >= (cloud.labels == 2).sum() * 0.8 and "too small or too low" in note


def test_a_wall_beside_the_table_is_counted_whole(boxes_seen: Look) -> None:
    wall: Box = ((-0.5, 0.6, -0.7), (0.5, 0.65, 2.0))
    cloud = boxes_seen([CUBE, wall], half=0.35)
    found = detect(cloud, DetectionSettings(reach=0.1))
    assert cloud.labels is not None and found.table is not None
    higher = found.table.heights(cloud.points[cloud.labels == 2].astype(np.float64)) > 0.02
    (note,) = [note for note in found.notes if "beside the table" in note]
    assert higher.sum() <= counted((note,)) <= (cloud.labels == 2).sum()
