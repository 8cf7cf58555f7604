"""Check that conflicts are inconsistent, minimal, and found in bounded time among thousands of constraints."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.conflict import NetworkConflict, minimal_conflict, without_leaves
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve

ALLEN, POINT = calculus("allen"), calculus("point")


def assert_minimal(network: Network, conflict: NetworkConflict | None) -> None:
    assert conflict is not None and conflict.minimal
    assert set(conflict.constraints) <= set(network.constraints)
    assert solve(network.only(conflict.constraints)).verdict is Verdict.INCONSISTENT
    for left_out in range(len(conflict.constraints)):
        rest = conflict.constraints[:left_out] + conflict.constraints[left_out + 1 :]
        assert solve(network.only(rest)).verdict is Verdict.CONSISTENT


@pytest.mark.parametrize("name", ["point", "allen", "rcc8", "ra", "cd"])
@settings(max_examples=25, deadline=None)
@given(st.data())
def test_leaving_out_any_one_restores_consistency(name: str, data: st.DataObject) -> None:
    chosen = calculus(name)
    thing, code = st.integers(0, 5), st.integers(0, len(chosen.atoms) - 1)
    lines = data.draw(st.lists(st.tuples(thing, thing, code, code).filter(lambda t: t[0] != t[1]), max_size=25))
    network = Network(chosen, 6, tuple(Constraint(i, j, 1 << a | 1 << b) for i, j, a, b in lines))
    if solve(network).verdict is Verdict.INCONSISTENT:
        assert_minimal(network, minimal_conflict(network))
    else:
        assert minimal_conflict(network) is None


def test_a_conflict_that_only_search_finds_is_minimal_too() -> None:
    lines = ["3 0 m s", "3 1 o", "3 2 m s", "0 1 d di", "1 2 d di", "0 2 f fi", "2 4 <", "4 5 m o", "5 6 s"]
    parts = (line.split(maxsplit=2) for line in lines)
    constraints = tuple(Constraint(int(i), int(j), ALLEN.relation(signs.split())) for i, j, signs in parts)
    conflict = minimal_conflict(Network(ALLEN, 7, constraints))
    assert_minimal(Network(ALLEN, 7, constraints), conflict)


# Allen's (1983) Figure 5, which only search finds inconsistent, with one of its pairs repeated
FIGURE_5 = ((3, 0, "m s"), (3, 1, "o"), (3, 2, "m s"), (0, 1, "d di"), (1, 2, "d di"), (0, 2, "f fi"))
STATED = tuple(Constraint(i, j, ALLEN.relation(signs.split())) for i, j, signs in FIGURE_5)


def test_a_conflict_found_by_closure_is_minimised_by_search() -> None:
    network = Network(ALLEN, 4, (*STATED, Constraint(0, 1, ALLEN.relation(["o", "di"]))))
    assert solve(network).refuted
    conflict = minimal_conflict(network)
    assert conflict == NetworkConflict(STATED, True)
    assert_minimal(network, conflict)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4), st.integers(0, ALLEN.universal)), max_size=4))
def test_conflicts_that_closure_misses_are_minimal_by_search(more: list[tuple[int, int, int]]) -> None:
    network = Network(ALLEN, 5, STATED + tuple(Constraint(i, j, r) for i, j, r in more if i != j))
    assert_minimal(network, minimal_conflict(network))


def test_a_known_conflict_is_returned_even_without_time() -> None:
    conflict = minimal_conflict(Network(ALLEN, 4, STATED), deadline=Deadline.after(0.0), inconsistent=True)
    assert conflict == NetworkConflict(STATED, False)


def test_conflicts_of_the_ten_names_are_minimised_by_rectangles() -> None:
    ten = calculus("ten")
    circle = [(0, 1), (1, 2), (2, 0), (0, 3)]
    network = Network(ten, 4, tuple(Constraint(i, j, ten.relation(["left"])) for i, j in circle))
    assert_minimal(network, minimal_conflict(network))


@pytest.mark.parametrize("things", [2, 150, 2000])
def test_ten_thousand_constraints_take_bounded_time(things: int) -> None:
    rng = np.random.default_rng(things)
    ends = [(int(i), int(j)) for i, j in rng.integers(0, things, (10_000, 2)) if i != j]
    network = Network(POINT, things, tuple(Constraint(i, j, POINT.relation(["<"])) for i, j in ends))
    with processor_time_below(20):
        conflict = minimal_conflict(network)
    assert conflict is not None
    assert solve(network.only(conflict.constraints)).verdict is Verdict.INCONSISTENT
    if conflict.minimal:
        assert_minimal(network, conflict)


def test_a_constraint_can_contradict_itself() -> None:
    empty, self_related = Constraint(0, 1, 0), Constraint(1, 1, POINT.relation(["<"]))
    for wrong in (empty, self_related):
        conflict = minimal_conflict(Network(POINT, 3, (Constraint(1, 2, 1), wrong)))
        assert conflict == NetworkConflict((wrong,), True)


def test_without_time_a_conflict_is_not_called_minimal() -> None:
    circle = tuple(Constraint(i, (i + 1) % 3, 1) for i in range(3))
    conflict = minimal_conflict(Network(POINT, 3, circle), deadline=Deadline.after(-1.0))
    assert conflict is None or not conflict.minimal


def test_dead_ends_are_removed_and_cycles_are_kept() -> None:
    tree = tuple(Constraint(i, i + 1, 1) for i in range(5))
    assert without_leaves(Network(POINT, 6, tree)) == ()
    circle = (*tree, Constraint(4, 2, 1))
    assert without_leaves(Network(POINT, 6, circle)) == (tree[2], tree[3], circle[5])
