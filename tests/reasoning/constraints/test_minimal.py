"""Minimal subsets, compared with sets that are minimal by construction."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import Minimal, minimal_by, minimal_subset

CORES = st.lists(st.sets(st.integers(0, 39), min_size=1, max_size=6), min_size=1, max_size=5)
Test = Callable[[list[int]], list[int] | None]


def holding(cores: list[set[int]], narrow: bool) -> Test:
    """Return a test that holds for supersets of a core, and names the core if ``narrow``."""

    def test(chosen: list[int]) -> list[int] | None:
        core = next((core for core in cores if core <= set(chosen)), None)
        if core is None:
            return None
        return [item for item in chosen if item in core] if narrow else chosen

    return test


def assert_minimal(found: Minimal[int], cores: list[set[int]]) -> None:
    items = set(found.items)
    assert found.proved and found.items == tuple(sorted(items))
    assert any(core <= items for core in cores)
    assert not any(core < items for core in cores)


@pytest.mark.parametrize("narrow", [False, True])
@given(cores=CORES, more=st.integers(0, 60))
def test_no_item_can_be_left_out(cores: list[set[int]], more: int, narrow: bool) -> None:
    test = holding(cores, narrow)
    items = list(range(40 + more))
    assert_minimal(minimal_subset(items, test), cores)

    def first_of(candidates: Iterable[list[int]]) -> tuple[int, list[int]] | None:
        found = ((place, test(candidate)) for place, candidate in enumerate(candidates))
        return next(((place, core) for place, core in found if core is not None), None)

    assert_minimal(minimal_by(items, first_of, width=24), cores)


@given(CORES)
def test_the_first_or_the_last_items_are_kept(cores: list[set[int]]) -> None:
    kept = list(range(40))
    test = holding(cores, narrow=False)
    for item in reversed(range(40)):
        rest = [other for other in kept if other != item]
        kept = rest if test(rest) is not None else kept
    assert minimal_subset(range(40), test).items == tuple(kept)
    mirrored = holding([{39 - item for item in core} for core in cores], narrow=False)
    assert minimal_subset(range(40), mirrored, keep_last=True).items == tuple(39 - item for item in reversed(kept))


def test_few_items_of_many_take_few_tests() -> None:
    asked = 0

    def test(chosen: list[int]) -> list[int] | None:
        nonlocal asked
        asked += 1
        return chosen if {3, 500, 999} <= set(chosen) else None

    assert minimal_subset(range(1000), test) == Minimal((3, 500, 999), True)
    assert asked < 100


def test_a_property_of_the_empty_set_needs_no_items() -> None:
    for size in (0, 1, 5, 20):
        assert minimal_subset(range(size), lambda chosen: chosen) == Minimal((), True)


def test_at_the_deadline_the_items_left_are_returned() -> None:
    assert minimal_subset(range(20), lambda chosen: chosen, Deadline.after(-1.0)) == Minimal(tuple(range(20)), False)
