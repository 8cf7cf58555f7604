"""Pieces, difference constraints and the search for a choice of pieces."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.ontology.allen import Allen
from deixis.ontology.graph import Fact
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.realisation.differences import FREE, Difference, Differences
from deixis.reasoning.entailment.realisation.pieces import admitted_by, choice, region
from deixis.reasoning.entailment.realisation.search import Clause, Refuted, Solved, TimedOut, solve

R = default_ontology().relations
POINTS = 5


def in_time() -> float:
    return time.monotonic() + 20


# ---- pieces -----------------------------------------------------------------------------------------------------


@settings(max_examples=100, deadline=None)
@given(st.lists(st.integers(0, 168), max_size=40))
def test_the_pieces_of_any_set_of_atoms_admit_just_that_set(cells: list[int]) -> None:
    wanted = np.zeros(169, dtype=np.bool_)
    wanted[cells] = True
    found = choice(wanted.reshape(13, 13))
    admitted = np.zeros((13, 13), dtype=np.bool_)
    for piece in found.pieces:
        admitted |= admitted_by(found.always + piece)
    assert (admitted == wanted.reshape(13, 13)).all()


def test_wide_relations_of_one_axis_are_one_inequality() -> None:
    for word in ("left", "right", "top", "bottom"):
        found = choice(region(Fact("a", (R[word],), "b")))
        assert (len(found.always), found.pieces) == (1, ((),))


def test_the_atom_that_on_and_under_share_pictures_neither_of_them_nor_a_denial() -> None:
    for word in ("on", "under"):
        for positive in (True, False):
            assert not region(Fact("a", (R[word],), "b", positive))[Allen.EQUALS, Allen.EQUALS]
    assert not region(Fact("a", (R["left"],), "b"))[Allen.EQUALS, Allen.EQUALS]


# ---- difference constraints -------------------------------------------------------------------------------------

DIFFERENCE = st.builds(
    Difference, st.integers(0, 1), st.integers(0, POINTS - 1), st.integers(0, POINTS - 1), st.integers(-3, 4)
).filter(lambda d: d.tail != d.head)


def floyd_warshall(constraints: list[Difference]) -> NDArray[np.int64] | None:
    """Shortest paths on both axes; None where there is a negative cycle. An implementation of its own."""
    table = np.full((2, POINTS, POINTS), FREE)
    table[:, np.arange(POINTS), np.arange(POINTS)] = 0
    for axis, tail, head, bound in constraints:
        table[axis, tail, head] = min(table[axis, tail, head], bound)
    for k in range(POINTS):
        table = np.minimum(table, table[:, :, k, None] + table[:, None, k, :])
    table[table > FREE // 2] = FREE
    return None if (table[:, np.arange(POINTS), np.arange(POINTS)] < 0).any() else table


@settings(max_examples=150, deadline=None)
@given(st.lists(DIFFERENCE, max_size=25))
def test_distances_are_shortest_paths_and_what_closes_a_negative_cycle_is_refused_with_the_cycle(
    constraints: list[Difference],
) -> None:
    differences, taken = Differences(POINTS), dict[int, Difference]()
    for reason, constraint in enumerate(constraints):
        against = differences.add(constraint, reason)
        if against is None:
            taken[reason] = constraint
        else:
            assert floyd_warshall([*(taken[r] for r in against), constraint]) is None
        expected = floyd_warshall(list(taken.values()))
        assert expected is not None
        assert (np.where(differences.distances > FREE // 2, FREE, differences.distances) == expected).all()


@settings(max_examples=80, deadline=None)
@given(st.lists(DIFFERENCE, max_size=15), st.lists(DIFFERENCE, max_size=15))
def test_taking_back_restores_everything(first: list[Difference], more: list[Difference]) -> None:
    differences, once = Differences(POINTS), Differences(POINTS)
    for reason, constraint in enumerate(first):
        differences.add(constraint, reason)
        once.add(constraint, reason)
    length = len(differences)
    for reason, constraint in enumerate(more):
        differences.add(constraint, 100 + reason)
    differences.back(length)
    assert (differences.distances == once.distances).all()
    for constraint in more:
        assert differences.add(constraint, 7) == once.add(constraint, 7)


@settings(max_examples=80, deadline=None)
@given(
    st.lists(DIFFERENCE, max_size=20),
    st.lists(st.integers(-20, 20), min_size=2 * POINTS, max_size=2 * POINTS),
)
def test_the_nearest_solution_satisfies_every_constraint_and_a_solution_is_its_own(
    constraints: list[Difference], wanted: list[int]
) -> None:
    differences = Differences(POINTS)
    for constraint in constraints:
        differences.add(constraint, 0)
    found = differences.nearest(np.array(wanted).reshape(2, POINTS))
    for axis, tail, head, bound in differences.constraints():
        assert found[axis, head] - found[axis, tail] <= bound
    assert (differences.nearest(found) == found).all()


# ---- search -----------------------------------------------------------------------------------------------------

CLAUSE = st.lists(st.lists(DIFFERENCE, max_size=2).map(tuple), max_size=3).map(lambda pieces: Clause(tuple(pieces)))


def satisfiable(clauses: list[Clause]) -> bool:
    """Whether some choice of pieces has a solution: all are tried."""
    choices: list[list[Difference]] = [[]]
    for clause in clauses:
        choices = [[*taken, *piece] for taken in choices for piece in clause.pieces]
        choices = [taken for taken in choices if floyd_warshall(taken) is not None]
    return bool(choices)


@settings(max_examples=150, deadline=None)
@given(st.lists(CLAUSE, max_size=6))
def test_a_choice_is_found_just_where_there_is_one_and_a_core_has_none_by_itself(clauses: list[Clause]) -> None:
    found = solve(POINTS, clauses, in_time())
    if satisfiable(clauses):
        assert isinstance(found, Solved)
        for clause, number in zip(clauses, found.chosen, strict=True):
            pieces = clause.pieces if number < 0 else clause.pieces[number : number + 1]
            distances = found.differences.distances
            assert any(all(distances[a, t, h] <= b for a, t, h, b in piece) for piece in pieces)
    else:
        assert isinstance(found, Refuted)
        assert not satisfiable([clauses[position] for position in found.core])


def test_the_first_piece_is_preferred() -> None:
    left, right = (Difference(0, 0, 1, -1),), (Difference(0, 1, 0, -1),)
    for pieces in ((left, right), (right, left)):
        found = solve(2, [Clause(pieces)], in_time())
        assert isinstance(found, Solved)
        assert found.chosen == (0,)


@pytest.mark.parametrize("size", [4, 5])
def test_a_proof_by_exhaustion_of_more_things_than_places(size: int) -> None:
    """So many points in a row, a step apart in any order, do not fit where there is a step too little."""
    apart = [Clause(((Difference(0, i, j, -1),), (Difference(0, j, i, -1),))) for i in range(size) for j in range(i)]
    room = [Clause(((Difference(0, i, j, size - 2),),)) for i in range(size) for j in range(size) if i != j]
    assert isinstance(solve(size, apart + room, in_time()), Refuted)
    enough = [Clause(((Difference(0, i, j, size - 1),),)) for i in range(size) for j in range(size) if i != j]
    assert isinstance(solve(size, apart + enough, in_time()), Solved)


def test_a_search_ends_when_its_time_is_up() -> None:
    size = 11
    apart = [Clause(((Difference(0, i, j, -1),), (Difference(0, j, i, -1),))) for i in range(size) for j in range(i)]
    room = [Clause(((Difference(0, i, j, size - 2),),)) for i in range(size) for j in range(size) if i != j]
    started = time.monotonic()
    assert isinstance(solve(size, apart + room, started + 0.3), TimedOut)
    assert time.monotonic() - started < 2
