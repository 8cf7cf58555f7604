"""Laying: things rest on those below them, and never intersect."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from solid_checks import boxes_within, deepest, distances, surface_points

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.laying import LaidTable, Placement, TableTop, lay
from deixis.perception.simulator.meshes.solids import thick_sheet
from deixis.perception.simulator.scatter import MAX_THINGS, MIN_GAP, scattered

TOUCHING = 0.0003
"""Maximum gap in metres between things that touch: the clearance, and rounding in single precision."""


def brick(width: float, length: float, height: float) -> Mesh:
    x, y = np.meshgrid([0.0, width], [0.0, length])
    return thick_sheet(x, y, 0 * x + 5, 0 * x + 5 + height)


def require_apart(table: LaidTable) -> None:
    for a, b in combinations(table.things, 2):
        assert deepest(a.mesh, b.mesh) < 1e-5, f"{a.name} and {b.name}"


def gap(table: LaidTable, upper: int, lower: int) -> float:
    return float(distances(surface_points(table.things[upper].mesh, 8000), table.things[lower].mesh).min())


def test_bricks_are_stacked_or_stand_on_the_table() -> None:
    stack = [Placement(name, None, 0.0, 0.0, mesh=brick(0.1, 0.1, 0.02)) for name in ("a", "b", "c")]
    table = lay([*stack, Placement("d", None, 0.2, 0.0, mesh=brick(0.1, 0.1, 0.02))])
    assert [thing.box[0, 2] for thing in table.things] == pytest.approx([0.0, 0.0202, 0.0404, 0.0], abs=1e-5)


def test_a_brick_beside_a_round_plate_stays_on_the_table() -> None:
    plate = Placement("plate", "dinner plate", 0.0, 0.0, plan=(0.28, 0.28))
    table = lay([plate, Placement("brick", None, 0.125, 0.125, mesh=brick(0.03, 0.03, 0.01))])
    assert table.things[1].box[0, 2] == 0.0
    require_apart(table)


@pytest.mark.parametrize("seed", [0, 1])
def test_a_thing_on_a_plate_touches_it(seed: int) -> None:
    table = lay(
        [
            Placement("plate", "dinner plate", 0, 0, seed=seed),
            Placement("napkin", "napkin", 0.01, 0, 0.2, seed=seed),
            Placement("bread_plate", "bread plate", 0.3, 0, seed=seed),
            Placement("butter_knife", "butter knife", 0.3, 0, 0.4, seed=seed),
            Placement("saucer", "saucer", 0.3, 0.3, seed=seed),
            Placement("cup", "teacup", 0.3, 0.3, 0.4, seed=seed),
            Placement("fork", "dinner fork", 0.0, 0.0, 0.1, seed=seed),
        ]
    )
    require_apart(table)
    for upper, lower in ((1, 0), (3, 2), (5, 4), (6, 1)):
        assert gap(table, upper, lower) < TOUCHING
    plate, napkin = table.things[0], table.things[1]
    assert (
        napkin.box[0, 2] < 0.5 * plate.box[1, 2]
    )  # it sinks into the well: cloth does not lie on the rim like a board


def test_a_napkin_larger_than_a_bread_plate_hangs_over_its_rim() -> None:
    table = lay(
        [
            Placement("plate", "bread plate", 0, 0, plan=(0.14, 0.14)),
            Placement("napkin", "napkin", 0, 0, plan=(0.2, 0.24)),
        ]
    )
    require_apart(table)
    assert table.things[1].box[0, 2] == 0.0
    assert table.things[1].box[1, 2] > table.things[0].box[1, 2]


@pytest.mark.parametrize("seed", [0, 1])
def test_things_scattered_at_random_are_apart_or_on_plates(seed: int) -> None:
    placements = scattered(16, seed)
    table = lay(placements)
    require_apart(table)
    raised = [thing for thing in table.things if thing.box[0, 2] > 0]
    assert all(thing.kind in ("napkin", "butter knife", "teaspoon", "dessert fork") for thing in raised)
    on_table = [thing for thing in table.things if thing.box[0, 2] == 0]
    for a, b in combinations(on_table, 2):
        assert not boxes_within(a.mesh, b.mesh, MIN_GAP) or distances(a.mesh.vertices, b.mesh).min() > 0.9 * MIN_GAP


def test_random_tables_depend_on_count_and_seed_only() -> None:
    assert scattered(12, 4) == scattered(12, 4)
    assert scattered(12, 4) != scattered(12, 5)
    assert len(scattered(12, 4)) == 12
    assert len({placement.kind for placement in scattered(40, 1)}) > 10
    assert any(thing.box[0, 2] > 0 for seed in range(4) for thing in lay(scattered(16, seed)).things)


def test_too_many_things_or_none_are_an_error() -> None:
    for count in (0, MAX_THINGS + 1):
        with pytest.raises(SimulationError, match="random table"):
            scattered(count, 0)


def test_the_maximum_number_of_things_finds_room() -> None:
    table = lay(scattered(MAX_THINGS, 3))
    assert len(table.things) == MAX_THINGS
    boxes = np.array([thing.box for thing in table.things if thing.box[0, 2] == 0])
    area = np.prod(boxes[:, 1, :2] - boxes[:, 0, :2], axis=1).sum()
    assert area > 1.0 and np.ptp(boxes[:, :, 0]) > np.ptp(boxes[:, :, 1])


def test_laying_is_deterministic() -> None:
    one, other = (lay(scattered(6, 2)) for _ in range(2))
    for a, b in zip(one.things, other.things, strict=True):
        assert np.array_equal(a.mesh.vertices, b.mesh.vertices)


def test_the_table_extends_beyond_the_things_on_it() -> None:
    table = lay([Placement("plate", "plate", 1.0, 2.0, plan=(0.2, 0.2))])
    assert (*table.top.low, *table.top.high) == pytest.approx((0.75, 1.75, 1.25, 2.25))
    assert table.top.mesh.vertices[:, 2].max() == 0.0


def test_bad_placements_and_tables_are_an_error() -> None:
    fork = Placement("fork", "fork", 0.0, 0.0)
    with pytest.raises(SimulationError, match="placed twice"):
        lay([fork, fork])
    with pytest.raises(SimulationError, match="must be finite"):
        lay([Placement("fork", "fork", np.nan, 0.0)])
    with pytest.raises(SimulationError, match="must have faces"):
        lay([Placement("fork", None, 0.0, 0.0, mesh=Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32)))])
    with pytest.raises(SimulationError, match="empty"):
        TableTop((0.0, 0.0), (0.0, 1.0))
