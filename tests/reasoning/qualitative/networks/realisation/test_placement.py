"""Test placing boxes by linear programming, and rounding them so that equations hold exactly."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.networks.realisation.pair_types import ANY, EQUAL, LESS, Piece
from deixis.reasoning.qualitative.networks.realisation.placement import Placement, place, rounded

TWO = np.array([[[0.0, 0.0], [1.0, 1.0]], [[0.5, 0.5], [2.0, 3.0]]])
PAIR = np.array([[0, 1]])


def piece(*signs: tuple[int, int, int], nearest: int = 0, farthest: int = 3) -> Piece:
    found = np.full((2, 5), ANY, dtype=np.int8)
    for axis, row, sign in signs:
        found[axis, row] = sign
    return Piece(found, nearest, farthest)


def test_boxes_move_into_their_piece() -> None:
    apart = piece((0, 2, LESS), (1, 4, EQUAL))  # 0 ends before 1 begins; centres level on y
    placement = place(TWO, PAIR, [apart], np.ones(1), 1.0)
    assert placement is not None and placement.fits
    exact = rounded(placement, whole=True)
    assert exact is not None
    assert exact[0, 1, 0] + 1 <= exact[1, 0, 0]
    assert exact[0, :, 1].sum() == exact[1, :, 1].sum()
    assert (exact[:, 1] > exact[:, 0]).all()


def test_distances_respect_their_bounds() -> None:
    for reach, least, most in ((1, 0.0, 1.0), (2, 1.0, 3.0), (3, 3.0, np.inf)):
        placement = place(TWO, PAIR, [piece(nearest=reach, farthest=reach)], np.ones(1), 2.0**-5)
        assert placement is not None and placement.fits
        distance = np.hypot(*np.subtract(*placement.boxes.mean(axis=1)))
        assert least < distance < most


def test_impossible_pieces_give_slack_and_no_time_gives_none() -> None:
    pieces = [piece((0, 2, LESS)), piece((0, 2, LESS))]
    placement = place(TWO, np.array([[0, 1], [1, 0]]), pieces, np.ones(2), 1.0)
    assert placement is not None and not placement.fits
    assert place(TWO, PAIR, pieces[:1], np.ones(1), 1.0, Deadline.after(-1.0)) is None


@given(
    st.lists(st.dictionaries(st.integers(0, 11), st.sampled_from([-2, -1, 1, 2]), min_size=2, max_size=4), max_size=8),
    st.integers(0, 2**32 - 1),
)
def test_rounding_solves_equations_exactly(equations: list[dict[int, int]], seed: int) -> None:
    boxes = np.random.default_rng(seed).uniform(0, 10, (3, 2, 2))
    exact = rounded(Placement(boxes, np.zeros(0), tuple(equations)), whole=False)
    if exact is None:  # numbers that are too large
        return
    values = [Fraction(value) for value in exact.transpose(2, 0, 1).ravel().tolist()]
    assert all(sum(factor * values[k] for k, factor in equation.items()) == 0 for equation in equations)
    assert equations or np.abs(exact - boxes).max() < 1e-6
