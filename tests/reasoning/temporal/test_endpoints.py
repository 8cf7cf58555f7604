"""Allen's relations from bounds, compared with all choices of end points on a sufficiently fine grid."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.relations.allen import ALL_ALLEN, Allen, members
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.endpoints import (
    allen_masks,
    converse_masks,
    distances_from_bounds,
    necessary_orders,
)
from deixis.reasoning.temporal.fluent import Fluent, Statement

STEP = 5  # four end points between two bounds need no more than five steps to take any order
LAST = 3


@st.composite
def some_bounds(draw: st.DrawFn) -> Bounds:
    lower, upper = sorted(draw(st.tuples(st.integers(0, LAST), st.integers(0, LAST))))
    if lower == upper:
        return Bounds(lower, upper)
    return Bounds(lower, upper, draw(st.booleans()), draw(st.booleans()))


@st.composite
def fluent(draw: st.DrawFn) -> Fluent:
    start, finish = draw(st.tuples(some_bounds(), some_bounds()).filter(lambda ends: ends[0].lower < ends[1].upper))
    return Fluent("f", Statement("a", "b"), start, finish)


def grid(bounds: Bounds) -> list[int]:
    """Return the points of the grid within bounds."""
    low, high = int(bounds.lower * STEP), int(bounds.upper * STEP)
    return list(range(low + bounds.lower_open, high + 1 - bounds.upper_open))


def brute_force(a: Fluent, b: Fluent) -> int:
    ends = np.meshgrid(grid(a.start), grid(a.finish), grid(b.start), grid(b.finish), indexing="ij")
    flat = np.stack([end.ravel() for end in ends]).astype(np.float64)
    proper = flat[:, (flat[0] < flat[1]) & (flat[2] < flat[3])]
    return sum(1 << int(code) for code in np.unique(allen_relations(*proper)))


def masks_from_bounds(starts: list[Bounds], finishes: list[Bounds]) -> NDArray[np.uint16]:
    """Return the Allen relations of n fluents by the bounds of their starts and finishes alone, shape (n, n)."""
    n = len(starts)
    distances = distances_from_bounds(starts, finishes)
    points = np.arange(n, dtype=np.int64)
    return allen_masks(distances, 1 + points, 1 + n + points)


@settings(max_examples=60, deadline=None)
@given(fluent(), fluent())
def test_a_relation_is_admitted_exactly_if_some_times_realise_it(a: Fluent, b: Fluent) -> None:
    masks = masks_from_bounds([a.start, b.start], [a.finish, b.finish])
    assert members(int(masks[0, 1])) == members(brute_force(a, b))


@settings(max_examples=30, deadline=None)
@given(st.lists(fluent(), max_size=6))
def test_the_masks_of_a_pair_are_converses(fluents: list[Fluent]) -> None:
    masks = masks_from_bounds([f.start for f in fluents], [f.finish for f in fluents])
    assert masks.shape == (len(fluents), len(fluents))
    assert masks.dtype == np.uint16
    assert np.array_equal(masks.T, converse_masks(masks))
    assert (masks.diagonal() == 1 << Allen.EQUALS).all()


def test_unknown_bounds_admit_everything() -> None:
    assert masks_from_bounds([Bounds()] * 2, [Bounds()] * 2)[0, 1] == ALL_ALLEN


def test_orders_possible_one_by_one_may_exclude_each_other() -> None:
    """Let a and b go from [0, 1] to [1, 2]: a start or a finish may be 1, but not both of one interval."""
    masks = masks_from_bounds([Bounds(0, 1), Bounds(1, 1)], [Bounds(1, 2), Bounds(2, 2)])
    assert [relation.symbol for relation in members(int(masks[0, 1]))] == ["m", "o", "fi", "s", "="]


@pytest.mark.parametrize(
    ("relation", "count"), [(Allen.BEFORE, 1), (Allen.MEETS, 2), (Allen.OVERLAPS, 3), (Allen.EQUALS, 4)]
)
def test_a_relation_takes_few_constraints(relation: Allen, count: int) -> None:
    assert len(necessary_orders(1 << relation)) == count


def test_the_full_set_of_relations_takes_no_constraint() -> None:
    assert necessary_orders(ALL_ALLEN) == ()
