"""Compare each bridge with boxes or regions that are examined directly."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi import bridges
from deixis.reasoning.qualitative.calculi.bridges import Bridge

DC, EC, PO, TPP, NTPP, TPPI, NTPPI, EQ = range(8)
ALL = [
    bridges.boxes_to_directions,
    bridges.boxes_to_regions,
    bridges.bounds_to_regions,
    bridges.directions_to_distances,
    bridges.joint_to_directions,
    bridges.joint_to_distances,
    bridges.names_to_boxes,
]


@pytest.fixture(scope="module")
def boxes() -> NDArray[np.int64]:
    """All boxes between six points on each axis, shape (225, 2, 2)."""
    intervals = list(combinations(range(6), 2))
    return np.array([[[x0, y0], [x1, y1]] for (x0, x1), (y0, y1) in product(intervals, repeat=2)])


def rectangle_codes(low: NDArray[np.int64], high: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the codes of all pairs, from corners (n, 2)."""
    a, b = low.astype(float), high.astype(float)
    x, y = (allen_relations(a[:, None, i], b[:, None, i], a[None, :, i], b[None, :, i]).astype(int) for i in (0, 1))
    codes: NDArray[np.int64] = x * 13 + y
    return codes


def shown(bridge: Bridge, source: NDArray[np.int64], target: NDArray[np.int64]) -> list[int]:
    """Return, for each atom of the source, the target atoms that occur together with it in the pairs."""
    seen = np.zeros((len(bridge.source.atoms), len(bridge.target.atoms)), dtype=bool)
    seen[source, target] = True
    return [sum(1 << int(code) for code in np.flatnonzero(row)) for row in seen]


def test_centres_agree_with_the_bridge_from_boxes(boxes: NDArray[np.int64]) -> None:
    bridge = bridges.boxes_to_directions()
    low, high = boxes[:, 0], boxes[:, 1]
    centres = low + high
    order = np.sign(centres[:, None] - centres[None, :])
    tiles = np.array([["SW", "W", "NW"], ["S", "EQ", "N"], ["SE", "E", "NE"]])
    names = tiles[order[..., 0] + 1, order[..., 1] + 1]
    codes = np.vectorize(bridge.target.code)(names)
    assert shown(bridge, rectangle_codes(low, high), codes) == list(bridge.admits)


def test_regions_that_are_boxes_agree_with_the_bridge(boxes: NDArray[np.int64]) -> None:
    bridge = bridges.boxes_to_regions()
    low, high = boxes[:, 0], boxes[:, 1]
    a_low, a_high, b_low, b_high = low[:, None], high[:, None], low[None, :], high[None, :]
    conditions = [
        ((a_low == b_low) & (a_high == b_high)).all(axis=2),
        ((a_low > b_low) & (a_high < b_high)).all(axis=2),
        ((a_low >= b_low) & (a_high <= b_high)).all(axis=2),
        ((a_low < b_low) & (a_high > b_high)).all(axis=2),
        ((a_low <= b_low) & (a_high >= b_high)).all(axis=2),
        ((a_low < b_high) & (b_low < a_high)).all(axis=2),
        ((a_low <= b_high) & (b_low <= a_high)).all(axis=2),
    ]
    codes = np.select(conditions, [EQ, NTPP, TPP, NTPPI, TPPI, PO, EC], default=DC)
    assert shown(bridge, rectangle_codes(low, high), codes) == list(bridge.admits)


def widened(cells: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return sets of cells of an 8 by 8 board (a bit each) with all their neighbours; the outermost cells stay free."""
    one, row = np.uint64(1), np.uint64(8)
    beside: NDArray[np.uint64] = cells | cells << one | cells >> one
    around: NDArray[np.uint64] = beside | beside << row | beside >> row
    return around


def grown(rng: np.random.Generator) -> int:
    """Return a connected set of cells of the inner 6 by 6, corners counting as contact, within a random box."""
    (x0, x1), (y0, y1) = np.sort(rng.integers(1, 7, (2, 2)), axis=1).tolist()
    box = sum(1 << (8 * y + x) for y in range(y0, y1 + 1) for x in range(x0, x1 + 1))
    cells = 1 << int(8 * rng.integers(y0, y1 + 1) + rng.integers(x0, x1 + 1))
    for _ in range(int(rng.integers(0, 18))):
        around = int(widened(np.array([cells], dtype=np.uint64))[0]) & box & ~cells
        if not around:
            break
        choices = [bit for bit in range(64) if around >> bit & 1]
        cells |= 1 << choices[int(rng.integers(len(choices)))]
    return cells


def test_connected_regions_agree_with_the_bridge_from_bounds() -> None:
    rng = np.random.default_rng(5)
    cells = np.unique(np.array([grown(rng) for _ in range(7_000)], dtype=np.uint64))
    board = (cells[:, None] >> np.arange(64, dtype=np.uint64) & np.uint64(1)).astype(bool).reshape(-1, 8, 8)
    columns, rows = np.any(board, axis=1), np.any(board, axis=2)
    low = np.stack([columns.argmax(axis=1), rows.argmax(axis=1)], axis=1)
    high = np.stack([8 - columns[:, ::-1].argmax(axis=1), 8 - rows[:, ::-1].argmax(axis=1)], axis=1)
    wide = widened(cells)
    part, deep = ((some[:, None] & ~cells[None, :]) == 0 for some in (cells, wide))
    common, touch = ((some[:, None] & cells[None, :]) != 0 for some in (cells, wide))
    conditions = [part & part.T, deep, part, deep.T, part.T, common, touch]
    codes = np.select(conditions, [EQ, NTPP, TPP, NTPPI, TPPI, PO, EC], default=DC)
    bridge = bridges.bounds_to_regions()
    assert shown(bridge, rectangle_codes(low, high), codes) == list(bridge.admits)


@pytest.mark.parametrize("make", ALL)
@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_a_bridge_is_sound_and_agrees_with_its_inverse(make: object, data: st.DataObject) -> None:
    assert callable(make)
    bridge = make()
    r = data.draw(st.sets(st.integers(0, len(bridge.source.atoms) - 1), max_size=4).map(mask))
    s = data.draw(st.sets(st.integers(0, len(bridge.target.atoms) - 1), max_size=4).map(mask))
    assert bool(bridge.forward(r) & s) == bool(r & bridge.backward(s))
    assert bridge.inverse.forward(s) == bridge.backward(s)
    assert bridge.inverse.backward(r) == bridge.forward(r)
    assert r & ~bridge.backward(bridge.forward(r)) == 0
    assert bridge.target.converse(bridge.forward(r)) == bridge.forward(bridge.source.converse(r))


def mask(codes: set[int]) -> int:
    return sum(1 << code for code in codes)


@pytest.mark.parametrize("make", ALL)
def test_every_atom_is_reached_on_both_sides(make: object) -> None:
    assert callable(make)
    bridge = make()
    assert all(bridge.admits)
    assert bridge.forward(bridge.source.universal) == bridge.target.universal
    assert bridge.forward(1 << bridge.source.identity) >> bridge.target.identity & 1


def test_regions_restrict_boxes_as_topology_requires() -> None:
    back = bridges.boxes_to_regions().inverse
    rcc8, ra = back.source, back.target
    assert ra.members(back.forward(rcc8.relation(["EQ"]))) == ("=,=",)
    assert ra.members(back.forward(rcc8.relation(["NTPP"]))) == ("d,d",)
    assert len(ra.members(back.forward(rcc8.relation(["TPP"])))) == 14  # of {s, =, d, f} twice, except d,d and =,=
