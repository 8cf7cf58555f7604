"""Bounds as codes: exact order, exact sums, and text."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.reasoning.constraints.difference import UNBOUNDED, add, add_arrays
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds, encode, text_of_ticks

MICROSECONDS = st.integers(-4_000_000_000_000_000, 4_000_000_000_000_000)
CODES = st.one_of(st.just(UNBOUNDED), st.builds(lambda t, s: 2 * t + s, MICROSECONDS, st.integers(0, 1)))


@given(st.tuples(MICROSECONDS, st.booleans()), st.tuples(MICROSECONDS, st.booleans()))
def test_the_tighter_bound_is_the_smaller_code(a: tuple[int, bool], b: tuple[int, bool]) -> None:
    codes = [encode(ticks / 1e6, strict) for ticks, strict in (a, b)]
    assert (codes[0] < codes[1]) == ((a[0], not a[1]) < (b[0], not b[1]))


@given(CODES, CODES, CODES)
def test_sums_do_not_depend_on_their_order(a: int, b: int, c: int) -> None:
    assert add(add(a, b), c) == add(a, add(b, c)) == add(c, add(b, a))
    assert add_arrays(np.array([a]), b)[0] == add(a, b)


def test_tenths_of_a_second_add_up_exactly() -> None:
    assert 0.1 + 0.2 != 0.3
    assert add(encode(0.1), encode(0.2)) == encode(0.3)
    assert add(encode(0.1, strict=True), encode(0.2)) == encode(0.3, strict=True)


@given(MICROSECONDS)
def test_seconds_survive_the_round_trip_through_ticks(ticks: int) -> None:
    assert encode(ticks / 1_000_000) >> 1 == ticks
    assert round(float(text_of_ticks(ticks)) * 1e6) == pytest.approx(ticks, abs=1)


@given(CODES, CODES)
def test_bounds_survive_the_round_trip_through_codes(at_least: int, at_most: int) -> None:
    if add(at_least, at_most) < 1:
        with pytest.raises(SettingError, match="no time lies in"):
            Bounds.from_codes(at_least, at_most)
    else:
        bounds = Bounds.from_codes(at_least, at_most)
        assert (bounds.at_least, bounds.at_most) == (at_least, at_most)


def test_open_bounds_are_printed_as_open() -> None:
    assert str(Bounds(0, 2, lower_open=True)) == "(0, 2]"
    assert str(Bounds()) == "(-∞, ∞)"


@pytest.mark.parametrize("bounds", [(1, 0), (math.nan, 1), (0, math.nan), (math.inf, math.inf), (0, 1e30)], ids=str)
def test_invalid_bounds_are_refused(bounds: tuple[float, float]) -> None:
    with pytest.raises(SettingError):
        Bounds(*bounds)


def test_an_open_point_is_empty() -> None:
    with pytest.raises(SettingError, match=r"no time lies in \[2, 2\)"):
        Bounds(2, 2, upper_open=True)
