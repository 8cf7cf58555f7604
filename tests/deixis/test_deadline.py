"""Tests of deadlines, on a clock that the tests set."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.deadline import Clock, Deadline, clock_stopped

NOW = 1000.0


@pytest.fixture
def set_clock(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    def set_to(now: float) -> None:
        monkeypatch.setattr("deixis.deadline.time.monotonic", lambda: now)

    monkeypatch.setattr("deixis.deadline.CLOCK", Clock())
    set_to(NOW)
    return set_to


def test_a_deadline_passes_when_its_seconds_are_over(set_clock: Callable[[float], None]) -> None:
    deadline = Deadline.after(2.0)
    assert deadline.left == 2.0 and not deadline.passed
    set_clock(NOW + 2.0)
    assert deadline.left == 0.0 and deadline.passed
    set_clock(NOW + 5.0)
    assert deadline.left == 0.0 and deadline.passed


def test_no_limit_never_passes_and_shares_to_no_limit() -> None:
    for deadline in (Deadline.never(), Deadline.after(None), Deadline.after(1e300), Deadline.never().share(0.1)):
        assert deadline.left == math.inf and not deadline.passed


def test_shares_are_of_the_time_left(set_clock: Callable[[float], None]) -> None:
    deadline = Deadline.after(10.0)
    set_clock(NOW + 4.0)
    assert deadline.share(0.5).at == NOW + 7.0
    set_clock(NOW + 11.0)
    assert deadline.share(0.5).passed


def test_within_never_extends_a_deadline(set_clock: Callable[[float], None]) -> None:
    assert Deadline.after(10.0).within(3.0).left == 3.0
    assert Deadline.after(2.0).within(3.0).left == 2.0


@given(seconds=st.floats(0, 1e6), fraction=st.floats(0, 1))
def test_a_share_never_ends_after_the_whole(seconds: float, fraction: float) -> None:
    deadline = Deadline.after(seconds)
    assert deadline.share(fraction) <= deadline


def test_deadlines_do_not_pass_while_the_clock_stands_still(set_clock: Callable[[float], None]) -> None:
    deadline = Deadline.after(2.0)
    set_clock(NOW + 1.0)
    with clock_stopped():
        set_clock(NOW + 50.0)
        assert deadline.left == 1.0
        with clock_stopped():
            set_clock(NOW + 60.0)
        assert deadline.left == 1.0
    assert deadline.left == 1.0
    set_clock(NOW + 61.0)
    assert deadline.passed


def test_slowness_is_the_clock_over_the_processor(
    set_clock: Callable[[float], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    worked = [7.0]
    monkeypatch.setattr("deixis.deadline.time.process_time", lambda: worked[0])
    deadline = Deadline.after(10.0)
    set_clock(NOW + 4.0)
    assert deadline.slowness == 1.0  # too little work to tell
    worked[0] += 0.5
    assert deadline.slowness == deadline.share(0.5).slowness == deadline.within(1.0).slowness == 8.0
    worked[0] += 7.5  # several processors
    assert deadline.slowness == 1.0
    assert Deadline.never().slowness == 1.0
