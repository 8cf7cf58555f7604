"""The index of intervals: exact at every tick, and cheap for windows anywhere."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as st

from deixis.memory.episodes.store.intervals import endings_meeting, fork, interval_keys
from deixis.memory.episodes.store.keys import TransientKeys

ENDS = st.one_of(st.integers(-40, 40).map(lambda n: n / 1e6), st.just(4e9), st.just(-4e9))


@given(
    st.lists(st.tuples(st.one_of(ENDS, st.just(-math.inf)), st.one_of(ENDS, st.just(math.inf))), max_size=15),
    ENDS,
    ENDS,
)
def test_index_finds_the_intervals_that_meet_a_window(
    intervals: list[tuple[float, float]], one: float, other: float
) -> None:
    kept = [(start, finish) for start, finish in intervals if start < finish]
    keys = TransientKeys()
    for number, (start, finish) in enumerate(kept):
        keys.write(dict.fromkeys(interval_keys(start, finish, b"%d" % number), b""))
    first, last = min(one, other), max(one, other)
    found = sorted(int(ending) for ending in endings_meeting(keys, first, last))
    assert found == [n for n, (start, finish) in enumerate(kept) if start <= last and finish > first]


@given(st.integers(1, 70) | st.integers(1, 2**53 - 1), st.integers(1, 70) | st.integers(1, 2**53 - 1))
def test_fork_is_the_number_divisible_by_most_twos(one: int, other: int) -> None:
    lower, upper = min(one, other), max(one, other)
    node = fork(lower, upper)
    assert lower <= node <= upper
    step = 2 * (node & -node)
    assert upper // step == (lower - 1) // step
