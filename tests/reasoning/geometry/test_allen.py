"""The thirteen relations between intervals, compared with their textbook definitions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.relations.allen import Allen
from deixis.reasoning.geometry.allen import allen_relations

Interval = tuple[int, int]
intervals = st.tuples(st.integers(0, 6), st.integers(0, 4)).map(lambda e: (e[0], e[0] + e[1]))


def definitions(a: Interval, b: Interval) -> list[Allen]:
    """Return all relations whose textbook definition holds; touching comes before lying inside."""
    (p, q), (r, s) = a, b
    if (p, q) == (r, s):
        return [Allen.EQUALS]
    if q == r:
        return [Allen.MEETS]
    if p == s:
        return [Allen.MET_BY]
    tests = {
        Allen.BEFORE: q < r,
        Allen.AFTER: s < p,
        Allen.OVERLAPS: p < r < q < s,
        Allen.OVERLAPPED_BY: r < p < s < q,
        Allen.CONTAINS: p < r and s < q,
        Allen.DURING: r < p and q < s,
        Allen.STARTS: p == r and q < s,
        Allen.STARTED_BY: p == r and s < q,
        Allen.FINISHES: q == s and r < p,
        Allen.FINISHED_BY: q == s and p < r,
    }
    return [relation for relation, holds in tests.items() if holds]


def relation(a: Interval, b: Interval, tolerance: float = 0.0) -> Allen:
    ends = [np.array([float(value)]) for value in (*a, *b)]
    return Allen(int(allen_relations(ends[0], ends[1], ends[2], ends[3], tolerance)[0]))


@settings(max_examples=80, deadline=None)
@given(intervals, intervals)
def test_the_only_relation_that_holds_is_the_defined_one(a: Interval, b: Interval) -> None:
    assert definitions(a, b) == [relation(a, b)]


def test_all_pairs_of_small_intervals_match_the_definitions() -> None:
    small = [(p, q) for p in range(5) for q in range(p, 5)]
    low = np.array([p for p, _ in small], dtype=float)
    high = np.array([q for _, q in small], dtype=float)
    codes = allen_relations(low[:, None], high[:, None], low[None, :], high[None, :])
    expected = [[definitions(a, b) for b in small] for a in small]
    assert [[[Allen(int(code))] for code in row] for row in codes] == expected
    assert len(np.unique(codes)) == 13


@pytest.mark.parametrize("tolerance", [0.0, 1.0, 2.5])
@settings(max_examples=100, deadline=None)
@given(a=intervals, b=intervals)
def test_the_relation_of_the_reversed_pair_is_the_converse(a: Interval, b: Interval, tolerance: float) -> None:
    assert relation(b, a, tolerance) is relation(a, b, tolerance).converse


@pytest.mark.parametrize(
    ("a", "b", "symbol"),
    [
        ((0, 1), (2, 3), "<"),
        ((0, 1), (1, 3), "m"),
        ((0, 2), (1, 3), "o"),
        ((0, 3), (1, 3), "fi"),
        ((0, 3), (1, 2), "di"),
        ((0, 1), (0, 3), "s"),
        ((0, 3), (0, 3), "="),
        ((0, 3), (0, 1), "si"),
        ((1, 2), (0, 3), "d"),
        ((1, 3), (0, 3), "f"),
        ((1, 3), (0, 2), "oi"),
        ((1, 3), (0, 1), "mi"),
        ((2, 3), (0, 1), ">"),
        ((1, 1), (1, 3), "m"),
        ((3, 3), (1, 3), "mi"),
        ((2, 2), (1, 3), "d"),
        ((2, 2), (2, 2), "="),
    ],
)
def test_intervals_and_points_worked_out_by_hand(a: Interval, b: Interval, symbol: str) -> None:
    assert relation(a, b).symbol == symbol


def test_ends_within_the_tolerance_are_equal() -> None:
    def code(shift: float) -> str:
        low_a, high_a, low_b, high_b = (np.array([v]) for v in (0.0, 1.0, 1.0 + shift, 2.0))
        return Allen(int(allen_relations(low_a, high_a, low_b, high_b, tolerance=0.25)[0])).symbol

    assert [code(s) for s in (-0.5, -0.25, 0.0, 0.25, 0.5)] == ["o", "m", "m", "m", "<"]


def test_the_arrays_broadcast() -> None:
    low = np.arange(4.0)
    assert allen_relations(low[:, None], low[:, None] + 1, low[None, :], low[None, :] + 1).shape == (4, 4)
