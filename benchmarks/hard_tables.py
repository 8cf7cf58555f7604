"""Simulate clouds on which detection may fail: piles, boxes that hide things, rooms, far and flat views, odd frames.

Each case is a cloud and the numbers of the things that its labels hold. The same seed gives the same case.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.layout.parser import read_layout
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.cameras.camera import KINECT, Camera, chair_camera, looking_pose
from deixis.perception.simulator.cameras.depth import DepthSensor, look, see
from deixis.perception.simulator.laying import LaidTable, Placement, TableTop, lay
from deixis.perception.simulator.meshes.rays import RayCaster
from deixis.workflows.layouts.lay_table import lay_random, lay_script

LAYOUT = Path(__file__).parent.parent / "examples" / "formal_dinner.layout"
TEA = LAYOUT.with_name("tea.layout")
LEAST = 200
"""Minimum number of visible points of a thing that detection should find."""


@dataclass(frozen=True, eq=False)
class Case:
    """A cloud with the truth in its labels, and the numbers of the things that should be found."""

    cloud: PointCloud
    wanted: list[int]


def formal(seed: int) -> Case:
    """Return a table laid for a formal dinner, seen from the chair."""
    table = lay_script(read_layout(LAYOUT), seed, cloth=bool(seed % 2)).table
    return _case(see(table, chair_camera(table), seed=seed))


def pots(seed: int) -> Case:
    """Return a table with a lidded pot, a jug and a covered bowl, whose parts meet in concave creases, and a cup."""
    table = lay_script(read_layout(TEA), seed, cloth=bool(seed % 2)).table
    return _case(see(table, chair_camera(table), seed=seed))


def pile(seed: int) -> Case:
    """Return large boxes in a row across the table, others on them, and things on both sides."""
    rng = np.random.default_rng([seed, 1])
    half = float(rng.uniform(0.35, 0.45))
    edges = np.linspace(-half, half, int(rng.integers(3, 5)) + 1)
    row = [
        _box((a + b) / 2, rng.normal(0.0, 0.01), (b - a - 0.004, rng.uniform(0.08, 0.14), rng.uniform(0.08, 0.2)))
        for a, b in pairwise(edges.tolist())
    ]
    on_top = [_box(rng.uniform(-0.2, 0.2), 0.0, (0.1, 0.06, rng.uniform(0.04, 0.08)))]
    beside = [
        _box(x, y + rng.uniform(-0.04, 0.04), rng.uniform((0.05, 0.05, 0.03), (0.1, 0.1, 0.09)), rng.uniform(0, 3))
        for y in (-0.27, 0.36)
        for x in (-0.22, 0.02, 0.24)
    ]
    table = _coloured(lay(_named(row + on_top + beside), TableTop((-half, -0.4), (half, 0.55))), rng)
    eye = (0.1 * rng.normal(), -rng.uniform(0.9, 1.1), rng.uniform(0.75, 0.95))
    return _case(see(table, Camera(looking_pose(eye, (0.0, 0.0, 0.0))), seed=seed))


def clutter(seed: int) -> Case:
    """Return boxes, large and small, close to each other and on each other, from one of several sides."""
    rng = np.random.default_rng([seed, 2])
    things: list[Placement] = []
    for _ in range(int(rng.integers(8, 14))):
        size = rng.uniform((0.05, 0.05, 0.03), (0.22, 0.14, 0.22))
        x, y = rng.uniform((-0.35, -0.25), (0.35, 0.25))
        things.append(_box(x, y, size, rng.uniform(0, np.pi)))
    things.sort(key=lambda thing: -float(np.ptp(thing.mesh.vertices[:, :2], axis=0).prod()))  # type: ignore[union-attr]
    table = _coloured(lay(_named(things), TableTop((-0.6, -0.45), (0.6, 0.45))), rng)
    turn = rng.uniform(0, 2 * np.pi)
    eye = (1.1 * np.sin(turn), -1.1 * np.cos(turn), rng.uniform(0.6, 1.0))
    return _case(see(table, Camera(looking_pose(eye, (0.0, 0.0, 0.05))), seed=seed))


def room(seed: int) -> Case:
    """Return a formal table before a wall, on a floor; every point is moved by 0.4 mm along each axis."""
    table = lay_script(read_layout(LAYOUT), seed).table
    camera = chair_camera(table, back=0.3, height=0.9)
    x0, x1, y1 = table.top.low[0] - 1.5, table.top.high[0] + 1.5, table.top.high[1] + 0.5
    walls = [
        _sheet((x0, -3.0, -0.74), (x1, -3.0, -0.74), (x1, y1, -0.74), (x0, y1, -0.74)),
        _sheet((x0, y1, -0.74), (x1, y1, -0.74), (x1, y1, 2.0), (x0, y1, 2.0)),
    ]
    rng = np.random.default_rng([seed, 3])
    meshes = [table.top.mesh, *(thing.mesh for thing in table.things), *walls]
    seen = look(RayCaster(meshes), camera, DepthSensor(), rng)
    labels = np.where(seen.mesh > len(table.things), 0, seen.mesh).astype(np.int32)
    palette = np.array([table.top.colour, *(thing.colour for thing in table.things), *[(200, 200, 195)] * 2, (0, 0, 0)])
    colours = np.clip(palette[seen.mesh] * seen.shade[:, None], 0, 255).astype(np.uint8)
    points = (seen.points + rng.normal(0, 4e-4, seen.points.shape)).astype(np.float32)
    return _case(PointCloud(points, colours, labels, organised=(KINECT.height, KINECT.width)))


def far(seed: int) -> Case:
    """Return ten random things from two metres."""
    table = lay_random(10, seed).table
    return _case(see(table, _camera_at(table, 2.0, np.deg2rad(45.0)), seed=seed))


def flat(seed: int) -> Case:
    """Return fourteen random things from 15 degrees above the table."""
    table = lay_random(14, seed).table
    return _case(see(table, _camera_at(table, 1.3, np.deg2rad(15.0)), seed=seed))


def every_second(seed: int, columns: bool = False) -> Case:
    """Return a formal table of which every second row, or column, has no depth."""
    case = formal(seed)
    lines = [slice(None), slice(None)]
    lines[int(columns)] = slice(None, None, 2)
    points = case.cloud.points.reshape(*(case.cloud.organised or ()), 3).copy()
    points[tuple(lines)] = np.nan
    finite = np.isfinite(points).all(axis=2).ravel()
    assert case.cloud.labels is not None
    labels = np.where(finite, case.cloud.labels, -1).astype(np.int32)
    return _case(replace(case.cloud, points=points.reshape(-1, 3), labels=labels))


def fused(seed: int) -> Case:
    """Return two views of two formal tables, 1.5 m apart, as bare points of one cloud without a viewpoint."""
    one, other = formal(seed).cloud, formal(seed + 1).cloud
    parts = [(cloud, cloud.finite) for cloud in (one, other)]
    points = np.concatenate([cloud.points[kept] for cloud, kept in parts])
    points[parts[0][1].sum() :] += np.array((1.5, 0.0, 0.0), np.float32)
    assert one.labels is not None and other.labels is not None
    assert one.colours is not None and other.colours is not None
    shifted = np.where(other.labels > 0, other.labels + one.labels.max(), other.labels)
    labels = np.concatenate([one.labels[parts[0][1]], shifted[parts[1][1]]])
    colours = np.concatenate([one.colours[parts[0][1]], other.colours[parts[1][1]]])
    return _case(PointCloud(points, colours, labels.astype(np.int32)))


def odd_clouds(seed: int) -> dict[str, PointCloud]:
    """Return clouds of 307,200 points unlike any table: depth that is random, doubled, missing, bumps or one plane."""
    seen = replace(formal(seed).cloud, labels=None)
    rng = np.random.default_rng([seed, 4])
    count = len(seen)
    pixel = np.arange(count)

    def moved(share: float, nearest: float, farthest: float) -> PointCloud:
        along = np.where(rng.random(count) < share, rng.uniform(nearest, farthest, count), 1.0)
        return replace(seen, points=(seen.points * along[:, None]).astype(np.float32))

    def points(xyz: NDArray[np.float64]) -> PointCloud:
        return PointCloud((xyz + np.array((0.0, 0.0, 1.5))).astype(np.float32))

    even = (pixel + pixel // KINECT.width) % 2 == 0
    row, column = np.divmod(pixel, KINECT.width)
    bumps = 0.05 * np.sin(row / 6) * np.sin(column / 6)
    rays = np.column_stack([(column - KINECT.width / 2) / KINECT.fx, (row - count / KINECT.width / 2) / KINECT.fx])
    bumpy = (1 - bumps + rng.normal(0.0, 0.0005, count))[:, None] * np.column_stack([rays, np.ones(count)])
    base = np.column_stack([rng.uniform(-1.0, 1.0, (count // 4, 2)), rng.normal(0.0, 0.001, count // 4)])
    heap = np.array([0.5, 0.5, -0.3]) * rng.uniform([-1.0, -1.0, 0.0], 1.0, (count - len(base), 3))
    sheet = np.column_stack([rng.uniform(-0.6, 0.6, (count, 2)), rng.normal(0.0, 0.003, count)])
    stray = np.where(rng.random((count, 1)) < 0.001, np.float32(1e6), seen.points)
    doubled = rng.choice(np.flatnonzero(seen.finite), count // 8).repeat(8)
    return {
        "half the pixels from 0.3 to 3 times as far": moved(0.5, 0.3, 3.0),
        "half the pixels within 5 % of their depth": moved(0.5, 0.95, 1.05),
        "three in ten within 10 %": moved(0.3, 0.9, 1.1),
        "one in ten from 0.3 to 3 times as far": moved(0.1, 0.3, 3.0),
        "all pixels from 0.3 to 3 times as far": moved(1.0, 0.3, 3.0),
        "every second pixel 1.3 times as far": replace(
            seen, points=(seen.points * np.where(even, 1.3, 1.0)[:, None]).astype(np.float32)
        ),
        "half the pixels without depth": replace(
            seen, points=np.where(rng.random((count, 1)) < 0.5, np.float32(np.nan), seen.points)
        ),
        "a thousandth of the points 1,000 km away": replace(seen, points=stray.astype(np.float32)),
        "depth in steps of a centimetre": replace(seen, points=(np.round(seen.points * 100) / 100).astype(np.float32)),
        "each point eight times": seen.take(doubled),
        "a surface of bumps": replace(seen, points=bumpy.astype(np.float32)),
        "a heap of points": points(np.vstack([base, heap])),
        "one plane with 3 mm of noise": points(sheet),
        "a cube full of points": points(rng.uniform(-0.5, 0.5, (count, 3))),
        "a normal density of points": points(rng.normal(0.0, 0.3, (count, 3))),
    }


CASES: dict[str, Callable[[int], Case]] = {
    "formal": formal,
    "pots and jugs": pots,
    "pile across the table": pile,
    "clutter of boxes": clutter,
    "room with jitter": room,
    "from 2 m": far,
    "15 degrees flat": flat,
    "every second row": every_second,
    "every second column": lambda seed: every_second(seed, columns=True),
    "two looks fused": fused,
}


def _case(cloud: PointCloud) -> Case:
    assert cloud.labels is not None
    counts = np.bincount(cloud.labels[cloud.labels > 0])
    return Case(cloud, np.flatnonzero(counts >= LEAST).tolist())


def _camera_at(table: LaidTable, distance: float, elevation: float) -> Camera:
    boxes = np.array([thing.box for thing in table.things])
    middle = (boxes[:, 0].min(axis=0) + boxes[:, 1].max(axis=0)) / 2 * (1, 1, 0)
    aside = (0.0, -distance * np.cos(elevation), distance * np.sin(elevation))
    return Camera(looking_pose(middle + aside, middle))


def _named(things: Sequence[Placement]) -> list[Placement]:
    return [replace(thing, name=f"thing_{number}") for number, thing in enumerate(things, start=1)]


def _coloured(table: LaidTable, rng: np.random.Generator) -> LaidTable:
    """Return the table with a colour of its own for each thing, as boxes and cartons have."""
    colours = rng.integers(40, 230, (len(table.things), 3)).tolist()
    return replace(
        table, things=tuple(replace(thing, colour=(*of,)) for thing, of in zip(table.things, colours, strict=True))
    )


def _box(x: float, y: float, size: Sequence[float] | NDArray[np.float64], yaw: float = 0.0) -> Placement:
    low, high = np.zeros(3), np.asarray(size, dtype=np.float64)
    corners = np.array([[(low, high)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)])
    quads = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return Placement("", None, float(x), float(y), float(yaw), mesh=Mesh(corners, np.array(faces, dtype=np.int32)))


def _sheet(*corners: tuple[float, float, float]) -> Mesh:
    return Mesh(np.array(corners), np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32))
