"""The search for a choice of pieces, compared with trying all choices."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from difference_constraints import AXES, DIFFERENCE, POINTS, floyd_warshall
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import Difference, DifferenceNetwork
from deixis.reasoning.constraints.disjunctive import Clause, Clauses, Search, SearchOutcome, solution, solve


def in_time() -> Deadline:
    return Deadline.after(20.0)


PIECE = st.lists(DIFFERENCE, max_size=3).map(tuple)
CLAUSE = st.lists(PIECE, max_size=3).map(lambda pieces: Clause(tuple(pieces)))


def at_most(tail: int, head: int, bound: int) -> Difference:
    return Difference(0, tail, head, 2 * bound + 1)


def satisfiable(clauses: list[Clause]) -> bool:
    """Return whether some choice of pieces has a solution, by trying all."""
    choices: list[list[Difference]] = [[]]
    for clause in clauses:
        choices = [[*taken, *piece] for taken in choices for piece in clause.pieces]
        choices = [taken for taken in choices if floyd_warshall(taken) is not None]
    return bool(choices)


@settings(max_examples=80, deadline=None)
@given(st.lists(CLAUSE, max_size=6))
def test_the_search_succeeds_exactly_if_a_choice_exists(clauses: list[Clause]) -> None:
    found = solve(POINTS, AXES, clauses, in_time())
    if satisfiable(clauses):
        assert found.outcome is SearchOutcome.SOLVED
        assert all(holds(clause, found.network) for clause in clauses)
        for clause, number in zip(clauses, found.taken.tolist(), strict=True):
            assert number < 0 or holds(Clause((clause.pieces[number],)), found.network)
    else:
        assert found.outcome is SearchOutcome.REFUTED
        assert not satisfiable([clauses[position] for position in found.core])


def holds(clause: Clause, network: DifferenceNetwork) -> bool:
    return any(all(network.distances[d[:3]] <= d.code for d in piece) for piece in clause.pieces)


@settings(max_examples=100, deadline=None)
@given(st.lists(DIFFERENCE, max_size=4), st.lists(CLAUSE, max_size=5))
def test_every_solution_is_visited_and_the_network_restored(base: list[Difference], clauses: list[Clause]) -> None:
    network = DifferenceNetwork(POINTS, AXES)
    stated = [difference for difference in base if network.add(difference)]
    before = network.distances.copy()
    search, visited = Search(network, Clauses(clauses), in_time()), list[NDArray[np.int64]]()
    while search.advance() is SearchOutcome.SOLVED:
        assert all(holds(clause, network) for clause in clauses)
        visited.append(network.distances.copy())
    assert search.outcome is SearchOutcome.REFUTED
    network.back(search.base)
    assert (network.distances == before).all()
    choices = product(*(clause.pieces for clause in clauses))
    solved = [floyd_warshall([*stated, *(d for piece in pieces for d in piece)]) for pieces in choices]
    for distances in solved:
        if distances is not None:
            assert any((distances <= other).all() for other in visited)
    assert bool(visited) == any(distances is not None for distances in solved)
    last = np.full(len(clauses), -1)
    for _ in range(2):
        found = solution(network, Clauses(clauses), last, in_time())
        assert (found is not None) == bool(visited)
        assert found is None or any((found == other).all() for other in visited)
        assert (network.distances == before).all()


@settings(max_examples=60, deadline=None)
@given(st.lists(CLAUSE.filter(lambda clause: len(clause.pieces) > 0), max_size=5))
def test_forced_pieces_hold_in_every_solution(clauses: list[Clause]) -> None:
    network = DifferenceNetwork(POINTS, AXES)
    search = Search(network, Clauses(clauses), in_time())
    outcome, forced, left = search.propagate(), network.distances.copy(), search.open()
    assert outcome is SearchOutcome.REFUTED or all(not holds(clauses[position], network) for position in left)
    other = DifferenceNetwork(POINTS, AXES)
    going = Search(other, Clauses(clauses), in_time())
    while going.advance() is SearchOutcome.SOLVED:
        assert outcome is SearchOutcome.SOLVED
        assert (other.distances <= forced).all()


def test_the_first_piece_is_preferred() -> None:
    left, right = (at_most(0, 1, -1),), (at_most(1, 0, -1),)
    for pieces in ((left, right), (right, left)):
        found = solve(2, 1, [Clause(pieces)], in_time())
        assert (found.outcome, found.taken.tolist()) == (SearchOutcome.SOLVED, [0])


@pytest.mark.parametrize("size", [4, 5])
def test_the_pigeonhole_problem_is_refuted(size: int) -> None:
    """Refute that points at least one step apart, in any order, fit in a range that is one step too short."""
    apart = [Clause(((at_most(i, j, -1),), (at_most(j, i, -1),))) for i in range(size) for j in range(i)]
    room = [Clause(((at_most(i, j, size - 2),),)) for i in range(size) for j in range(size) if i != j]
    assert solve(size, 1, apart + room, in_time()).outcome is SearchOutcome.REFUTED
    enough = [Clause(((at_most(i, j, size - 1),),)) for i in range(size) for j in range(size) if i != j]
    assert solve(size, 1, apart + enough, in_time()).outcome is SearchOutcome.SOLVED


def test_a_search_ends_at_its_deadline() -> None:
    size = 11
    apart = [Clause(((at_most(i, j, -1),), (at_most(j, i, -1),))) for i in range(size) for j in range(i)]
    room = [Clause(((at_most(i, j, size - 2),),)) for i in range(size) for j in range(size) if i != j]
    with processor_time_below(2):
        assert solve(size, 1, apart + room, Deadline.after(0.3)).outcome is SearchOutcome.TIMED_OUT
