"""Check that every pair of boxes has one type, and that pieces contain only permitted types."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from laid_boxes import tables

from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.realisation.pair_types import (
    BOUNDS,
    COMPARED,
    EQUAL,
    pair_types,
    piece_around,
)
from deixis.reasoning.qualitative.relate import relate

TYPES = pair_types()


@given(tables(least=2, most=2), st.sampled_from([1.0, 4.0, 10.0]))
def test_boxes_have_the_one_type_with_their_atoms(boxes: np.ndarray, reference: float) -> None:
    boxes[:, 1] += 1  # no box without an extent
    said = {name: 1 << int(relate(boxes, name, reference=reference)[0, 1]) for name in TYPES.atoms}
    differences = COMPARED @ boxes.reshape(4, 2)  # (5, 2)
    order = np.int8(1) << (1 + np.sign(differences.T)).astype(np.int8)
    mine = np.flatnonzero((TYPES.orders[TYPES.axes] == order).all(axis=(1, 2)))
    left = TYPES.permitted(said)
    assert left[mine].sum() == 1
    assert (TYPES.axes[left] == TYPES.axes[mine[left[mine]][0]]).all(axis=1).any()


def test_every_atom_occurs_in_a_type() -> None:
    for name, codes in TYPES.atoms.items():
        assert set(codes.tolist()) == set(range(len(calculus(name).atoms)))


@given(
    st.sets(st.integers(0, 168), min_size=1, max_size=168),
    st.sets(st.integers(0, 3), min_size=1),
    st.permutations(range(11)),
    st.integers(0, 10**6),
)
def test_a_piece_contains_its_type_and_only_permitted_ones(
    rectangles: set[int], distances: set[int], order: list[int], pick: int
) -> None:
    permitted = TYPES.permitted(
        {"ra": sum(1 << code for code in rectangles), "distance": sum(1 << code for code in distances)}
    )
    candidates = np.flatnonzero(permitted)
    if not len(candidates):
        return
    kept = int(candidates[pick % len(candidates)])
    piece = piece_around(permitted, kept, np.array(order))
    within = ((TYPES.orders[TYPES.axes] & piece.signs) != 0).all(axis=(1, 2))
    within &= (TYPES.reaches >= piece.nearest) & (TYPES.reaches <= piece.farthest)
    assert within[kept]
    assert not (within & ~permitted).any()


def test_distance_ranges_are_in_order() -> None:
    assert BOUNDS.tolist() == [0.0, 0.0, 1.0, 3.0, np.inf]
    piece = piece_around(TYPES.permitted({"distance": 1}), int(np.flatnonzero(TYPES.reaches == 0)[0]), np.arange(11))
    assert (piece.signs[:, -1] == EQUAL).all()
