"""Joining of parts with patches that are placed by hand."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.examples_data import example
from deixis.grammar.layout.parser import read_layout
from deixis.perception.detection.detect import detect
from deixis.perception.detection.segmentation.boundaries import Boundaries
from deixis.perception.detection.segmentation.joining import bridged, round_rims, whole_things
from deixis.perception.detection.segmentation.parts import Parts
from deixis.perception.detection.segmentation.supervoxels import Supervoxels
from deixis.perception.detection.settings import JoiningSettings, SupervoxelSettings
from deixis.perception.simulator.cameras.camera import chair_camera
from deixis.perception.simulator.cameras.depth import see
from deixis.workflows.layouts.lay_table import lay_script

ROWS, AROUND = 8, 12
PLAIN = np.zeros(3)


def _cup(tint: NDArray[np.float64], mottle: float, handle: int = 0, behind: float = 0.0) -> Parts:
    """Return the near half of the outside of a cup and the far half of its inside, optionally with a handle.

    ``tint`` is the difference of their colours, and ``mottle`` the variation within each. The depth jumps where they
    meet. ``behind`` is the distance in metres by which the inside is farther away, so that it is that of another cup.
    """
    turn, z = (axis.ravel() for axis in np.meshgrid(np.linspace(0.1, np.pi - 0.1, AROUND), np.linspace(0, 0.1, ROWS)))
    out = np.stack([np.cos(turn), -np.sin(turn), np.zeros_like(turn)], axis=1)
    into = out * (1, -1, 1)
    grip = np.stack([0.045 + 0.03 * np.ones(handle), np.zeros(handle), np.linspace(0.02, 0.09, handle)], axis=1)
    middles = np.concatenate([0.04 * out, 0.04 * into, grip])
    middles[:, 2] += np.concatenate([z, z, np.zeros(handle)])
    middles[len(out) :, 1] += behind
    normals = np.concatenate([out, -into, np.tile([1.0, 0.0, 0.0], (handle, 1))])
    of = np.repeat([0, 1], [len(out), len(into) + handle]).astype(np.int32)
    colours = of[:, None] * tint + mottle * np.random.default_rng(0).choice([-1.0, 1.0], (len(of), 3)) / np.sqrt(3)
    ones, number = np.ones(len(of)), np.arange(len(of), dtype=np.int32)
    patches = Supervoxels(number, ones, middles, normals, colours / (0.35, 1.0, 1.0), 1e-4 * ones, SupervoxelSettings())
    top = np.arange(AROUND) + (ROWS - 1) * AROUND
    pairs = np.stack([top, len(out) + np.arange(AROUND) + (ROWS // 2) * AROUND], axis=1).astype(np.int64)
    meeting = Boundaries(pairs, np.ones(AROUND), np.full(AROUND, 1.2), np.ones(AROUND))
    return Parts(of, patches, meeting, JoiningSettings())


def test_the_inside_of_a_cup_joins_its_outside() -> None:
    assert len(whole_things(_cup(PLAIN, 0.0))) == 1


def test_the_inside_of_a_cup_does_not_join_another_cup() -> None:
    assert len(whole_things(_cup(PLAIN, 0.0, behind=0.1))) == 2


def test_the_inside_of_a_cup_joins_despite_a_handle_in_it() -> None:
    parts = _cup(PLAIN, 0.0, handle=12)
    assert -0.4 < parts.measures.bulge[1] < -0.1
    assert len(whole_things(parts)) == 1


@pytest.mark.parametrize(("mottle", "count"), [(0.0, 2), (16.0, 1)])
def test_colours_differ_only_by_more_than_they_vary(mottle: float, count: int) -> None:
    parts = _cup(np.array([0.0, 0.0, 13.0]), mottle)
    assert parts.unlike(parts.meetings())[0] > 12
    assert len(whole_things(parts)) == count


@pytest.mark.parametrize(("width", "count"), [(0.06, 1), (0.16, 2)])
def test_a_glass_with_a_stem_joins_its_foot_but_not_a_plate(width: float, count: int) -> None:
    x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:8j, -0.5:0.5:8j])
    stem = np.linspace((0.0, 0.0, 0.025), (0.0, 0.0, 0.09), 10)
    bowl = np.stack([0.07 * x, 0.07 * y, np.full(x.shape, 0.15)], axis=1)
    foot = np.stack([width * x, width * y, np.full(x.shape, 0.004)], axis=1)
    middles = np.concatenate([stem, bowl, foot])
    ones, of = np.ones(len(middles)), np.repeat([0, 1], [len(stem) + len(bowl), len(foot)]).astype(np.int32)
    normals = np.tile([0.0, 0.0, 1.0], (len(middles), 1))
    number = np.arange(len(middles), dtype=np.int32)
    patches = Supervoxels(number, ones, middles, normals, np.zeros_like(middles), 1e-4 * ones, SupervoxelSettings())
    meeting = Boundaries(np.array([[0, len(stem) + len(bowl) + 27]]), np.ones(1), np.full(1, 1.2), np.ones(1))
    parts = Parts(of, patches, meeting, JoiningSettings())
    assert 0.015 < parts.meetings().rise[0] < 0.03
    assert len(whole_things(parts)) == count


@pytest.mark.parametrize(
    ("low", "beside", "count"),
    [(0.1, 0.0, 1), (0.03, 0.0, 2), (0.1, 0.06, 2)],
    ids=["a bowl above", "a bowl on the table", "something beside it"],
)
def test_a_bowl_joins_the_foot_below_it_without_a_stem(low: float, beside: float, count: int) -> None:
    foot = _grid((beside - 0.03, beside + 0.03), (-0.03, 0.03), 0.004)
    assert len(whole_things(_apart(foot, _wall(0.035, low, low + 0.1)))) == count


def _wall(radius: float, low: float, high: float) -> NDArray[np.float64]:
    """Return patches on the near half of an upright cylinder."""
    turn, z = (axis.ravel() for axis in np.meshgrid(np.linspace(0.0, np.pi, AROUND), np.linspace(low, high, ROWS)))
    return np.stack([radius * np.cos(turn), -radius * np.sin(turn), z], axis=1)


def test_a_foot_does_not_join_its_bowl_to_the_glass_before_it() -> None:
    front, near_side, foot = _wall(0.035, 0.0, 0.2), _wall(0.035, 0.12, 0.2), _grid((-0.03, 0.03), (0.04, 0.09), 0.004)
    bowl = np.concatenate([near_side, near_side * (1, -1, 1)]) + np.array([0.0, 0.065, 0.0])
    out = near_side * (1, 1, 0) / 0.035
    normals = np.concatenate(
        [front * (1, 1, 0) / 0.035, out, -out * (1, -1, 1), np.tile([0.0, 0.0, 1.0], (len(foot), 1))]
    )
    middles = np.concatenate([front, bowl, foot])
    ones, number = np.ones(len(middles)), np.arange(len(middles), dtype=np.int32)
    of = np.repeat([0, 1, 2], [len(front), len(bowl), len(foot)]).astype(np.int32)
    patches = Supervoxels(number, ones, middles, normals, np.zeros_like(middles), 1e-4 * ones, SupervoxelSettings())
    rim = len(front) - AROUND + np.arange(AROUND)
    pairs = np.stack([rim, len(front) + np.arange(AROUND)], axis=1).astype(np.int64)
    parts = Parts(
        of, patches, Boundaries(pairs, np.ones(AROUND), np.full(AROUND, 1.2), np.ones(AROUND)), JoiningSettings()
    )
    assert -0.1 < parts.measures.bulge[1] < 0.1, "both sides of the bowl are seen"
    found = whole_things(parts).of
    assert found[0] != found[len(front)] == found[-1]


@pytest.mark.parametrize(
    ("height", "off", "count"),
    [(0.15, 0.0, 1), (0.15, 0.006, 1), (0.15, 0.02, 2), (0.07, 0.0, 2)],
    ids=["a bottle", "a bottle a little askew", "a thing on the edge of another", "a thing on a cup"],
)
def test_a_neck_joins_the_bottle_below_its_middle(height: float, off: float, count: int) -> None:
    body, neck = _wall(0.035, 0.0, height), _wall(0.013, height + 0.005, height + 0.05)
    neck[:, 0] += off
    middles = np.concatenate([body, neck])
    ones, of = np.ones(len(middles)), np.repeat([0, 1], [len(body), len(neck)]).astype(np.int32)
    number = np.arange(len(middles), dtype=np.int32)
    patches = Supervoxels(
        number, ones, middles, middles * (1.0, 1.0, 0.0), np.zeros_like(middles), 1e-4 * ones, SupervoxelSettings()
    )
    pairs = np.stack([len(body) - AROUND + np.arange(AROUND), len(body) + np.arange(AROUND)], axis=1).astype(np.int64)
    meeting = Boundaries(pairs, np.ones(AROUND), np.full(AROUND, 1.2), np.ones(AROUND))
    assert len(whole_things(Parts(of, patches, meeting, JoiningSettings()))) == count


def _grid(x: tuple[float, float], y: tuple[float, float], z: float) -> NDArray[np.float64]:
    """Return the centres of patches on a level grid, a centimetre apart."""
    plan = np.mgrid[x[0] : x[1] + 0.005 : 0.01, y[0] : y[1] + 0.005 : 0.01].reshape(2, -1).T
    return np.column_stack([plan, np.full(len(plan), z)])


def _below(cover: NDArray[np.float64], one: NDArray[np.float64], other: NDArray[np.float64]) -> Parts:
    """Return level parts of one colour; the first one is adjacent to both others, and higher."""
    middles = np.concatenate([cover, one, other])
    ones, number = np.ones(len(middles)), np.arange(len(middles), dtype=np.int32)
    of = np.repeat([0, 1, 2], [len(cover), len(one), len(other)]).astype(np.int32)
    normals, colours = np.tile([0.0, 0.0, 1.0], (len(middles), 1)), np.zeros((len(middles), 3))
    patches = Supervoxels(number, ones, middles, normals, colours, 1e-4 * ones, SupervoxelSettings())
    pairs = np.array([[0, len(cover)], [0, len(cover) + len(one)]])
    return Parts(of, patches, Boundaries(pairs, np.ones(2), np.full(2, 1.2), np.ones(2)), JoiningSettings())


def test_a_surface_continues_below_an_object_on_it() -> None:
    knife, halves = (
        _grid((-0.01, 0.01), (-0.1, 0.1), 0.02),
        [_grid((side, side + 0.06), (-0.1, 0.1), 0.01) for side in (-0.08, 0.02)],
    )
    pairs = bridged(_below(knife, *halves))
    assert (pairs.first.tolist(), pairs.second.tolist()) == ([1], [2])


def test_cutlery_on_two_sides_of_a_plate_is_not_one_object() -> None:
    plate = _grid((-0.1, 0.1), (-0.1, 0.1), 0.03)
    plate = plate[np.linalg.norm(plate[:, :2], axis=1) < 0.105]
    fork, knife = _grid((-0.08, 0.09), (0.11, 0.12), 0.004), _grid((0.11, 0.12), (-0.1, 0.09), 0.004)
    assert not len(bridged(_below(plate, fork, knife)))


@pytest.mark.parametrize(("x", "joined"), [(0.0, False), (0.12, True)], ids=["its own foot", "what lies beside it"])
def test_the_foot_of_a_glass_does_not_continue_behind_it(x: float, joined: bool) -> None:
    bowl = _grid((-0.05, 0.05), (-0.05, 0.05), 0.1)
    foot, knife = _grid((x - 0.03, x + 0.03), (-0.03, 0.03), 0.006), _grid((x - 0.02, x + 0.02), (0.07, 0.17), 0.006)
    assert len(bridged(_below(bowl, foot, knife))) == joined


def test_a_round_plate_continues_below_a_napkin_of_any_width() -> None:
    disc = _grid((-0.13, 0.13), (-0.13, 0.13), 0.01)
    disc = disc[np.linalg.norm(disc[:, :2], axis=1) < 0.132]
    halves = [disc[side * disc[:, 0] > 0.065] for side in (-1, 1)]
    pairs = round_rims(_below(_grid((-0.06, 0.06), (-0.1, 0.1), 0.02), *halves))
    assert (pairs.first.tolist(), pairs.second.tolist()) == ([1], [2])


@pytest.mark.parametrize("length", [0.06, 0.16])
def test_objects_on_two_sides_of_a_napkin_are_not_a_plate(length: float) -> None:
    sides = [_grid((x, x + 0.02), (-length / 2, length / 2), 0.01) for x in (-0.09, 0.07)]
    assert not len(round_rims(_below(_grid((-0.08, 0.08), (-0.1, 0.1), 0.02), *sides)))


def _apart(*pieces: NDArray[np.float64], normals: tuple[float, float, float] = (0.0, 0.0, 1.0)) -> Parts:
    """Return parts of one colour that do not meet; ``normals`` are those of the last one."""
    middles = np.concatenate(pieces)
    ones, number = np.ones(len(middles)), np.arange(len(middles), dtype=np.int32)
    of = np.repeat(np.arange(len(pieces)), [len(piece) for piece in pieces]).astype(np.int32)
    facing = np.where((of == of.max())[:, None], normals, (0.0, 0.0, 1.0))
    patches = Supervoxels(number, ones, middles, facing, np.zeros_like(middles), 1e-4 * ones, SupervoxelSettings())
    none = np.zeros(0)
    return Parts(of, patches, Boundaries(np.zeros((0, 2), np.int64), none, none, none), JoiningSettings())


HANDLE = _grid((0.0, 0.01), (0.0, 0.12), 0.004)


@pytest.mark.parametrize(
    ("other", "count"),
    [
        (_grid((-0.01, 0.02), (0.14, 0.18), 0.006), 1),  # the head, behind an invisible neck
        (_grid((-0.01, 0.02), (0.17, 0.21), 0.006), 2),  # too far away
        (_grid((0.03, 0.04), (0.0, 0.12), 0.004), 2),  # another handle beside it
        (_grid((0.03, 0.04), (0.13, 0.2), 0.004), 2),  # not in a line
        (_grid((-0.01, 0.02), (0.14, 0.18), 0.05), 2),  # something high
        (_grid((-0.05, 0.06), (0.14, 0.2), 0.006), 2),  # something wide
    ],
)
def test_the_head_of_a_spoon_joins_its_handle(other: NDArray[np.float64], count: int) -> None:
    assert len(whole_things(_apart(HANDLE, other))) == count
    assert len(whole_things(_apart(other, HANDLE))) == count


@pytest.mark.parametrize(
    ("heights", "count"),
    [
        (((0.0, 0.002), (0.02, 0.022)), 2),  # on the table, and on the rim of a plate
        (((0.01, 0.002), (0.018, 0.024)), 2),  # both slope, but not towards each other
        (((0.002, 0.014), (0.016, 0.026)), 1),  # leaning on the rim
        (((0.002, 0.018), (0.01, 0.002)), 1),  # both come down to the table, from an arch
    ],
)
def test_two_pieces_in_a_line_join_if_their_heights_allow_it(
    heights: tuple[tuple[float, float], tuple[float, float]], count: int
) -> None:
    pieces = [_grid((0.0, 0.01), ends, 0.0) for ends in ((0.0, 0.12), (0.14, 0.24))]
    for piece, (near, far) in zip(pieces, heights, strict=True):
        piece[:, 2] = np.interp(piece[:, 1], (piece[:, 1].min(), piece[:, 1].max()), (near, far))
    assert len(whole_things(_apart(*pieces))) == count
    assert len(whole_things(_apart(*pieces[::-1]))) == count


@pytest.mark.parametrize(("end", "count"), [(0.26, 1), (0.33, 2)])
def test_two_forks_in_a_line_are_not_one_piece(end: float, count: int) -> None:
    pieces = [_grid((0.0, 0.01), ends, 0.004) for ends in ((0.0, 0.15), (0.17, end))]
    assert len(whole_things(_apart(*pieces))) == count


@pytest.mark.parametrize(
    ("normal", "top", "count"),
    [((1.0, 0.0, 0.1), 0.06, 1), ((0.0, 0.0, 1.0), 0.06, 2), ((1.0, 0.0, 0.1), 0.12, 2)],
)
def test_a_thin_upright_piece_joins_an_object_of_its_height(
    normal: tuple[float, float, float], top: float, count: int
) -> None:
    box = _grid((0.0, 0.08), (0.0, 0.08), 0.08)
    side = np.concatenate([_grid((0.09, 0.09), (0.0, 0.08), z) for z in np.arange(0.0, top + 0.005, 0.01)])
    assert len(whole_things(_apart(box, side, normals=normal))) == count


def _lidded_pot(slope: float) -> Parts:
    """Return the shoulder of a pot, a ring that slopes outwards at an angle in radians, and the lid in it."""
    turn = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    out = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    radii, lid_radii = np.array([0.06, 0.053, 0.046]), np.array([0.039, 0.028, 0.016, 0.005])
    ring = np.concatenate([r * out + (0.06 + (0.046 - r) * np.tan(slope)) * up for r in radii])
    lid = np.concatenate([r * out + (0.075 + 0.3 * (0.039 - r)) * up for r in lid_radii])
    tilted = np.cos(slope) * up + np.sin(slope) * out
    normals = np.concatenate([np.tile(tilted, (3, 1)), np.tile(up, (len(lid), 1))])
    middles = np.concatenate([ring, lid])
    of = np.repeat([0, 1], [len(ring), len(lid)]).astype(np.int32)
    ones, number = np.ones(len(of)), np.arange(len(of), dtype=np.int32)
    patches = Supervoxels(number, ones, middles, normals, np.zeros((len(of), 3)), 1e-4 * ones, SupervoxelSettings())
    pairs = np.stack([2 * len(turn) + np.arange(24), len(ring) + np.arange(24)], axis=1).astype(np.int64)
    meeting = Boundaries(pairs, np.ones(24), np.full(24, 1.2), np.zeros(24))
    return Parts(of, patches, meeting, JoiningSettings())


@pytest.mark.parametrize(("degrees", "count"), [(45.0, 1), (5.0, 2), (88.0, 2)])
def test_a_lid_joins_a_shoulder_that_could_not_carry_it(degrees: float, count: int) -> None:
    assert len(whole_things(_lidded_pot(np.deg2rad(degrees)))) == count


@pytest.mark.parametrize("seed", [3, 7])
def test_pots_and_jugs_are_found_whole(seed: int) -> None:
    table = lay_script(read_layout(example("tea.layout")), seed).table
    cloud = see(table, chair_camera(table), seed=seed)
    assert len(detect(cloud).boxes) == len(table.things) == 8
