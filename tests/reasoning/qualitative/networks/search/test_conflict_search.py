"""Test the conflict-driven search: verdicts against orders of end points, its proofs, and its reach."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from numpy.typing import NDArray
from random_networks import random_network
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, TableCalculus, bits
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search import conflict_search
from deixis.reasoning.qualitative.networks.search.conflict_search import ConflictSearch
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve

ALLEN, RA = calculus("allen"), calculus("ra")


def placeable(network: Network) -> bool:
    """Return True if n intervals satisfy the network; end points among 2n numbers are enough for that."""
    ends = np.array(list(combinations(range(2 * network.size), 2)), dtype=np.float64)
    low, high = ends.T
    atoms = 1 << allen_relations(low[:, None], high[:, None], low, high).astype(np.int64)

    def place(thing: int, left: list[NDArray[np.int64]]) -> bool:
        """Try each remaining place of a thing, and keep the compatible places of the later things."""
        if thing == network.size:
            return True
        for spot in left[thing]:
            rest = [left[k][(atoms[spot, left[k]] & network.stated(thing, k)) > 0] for k in range(network.size)]
            if all(len(rest[k]) for k in range(thing + 1, network.size)) and place(thing + 1, rest):
                return True
        return False

    return place(0, [np.arange(len(ends))] * network.size)


@pytest.mark.parametrize("seed", range(8))
def test_verdicts_agree_with_placing_intervals(seed: int) -> None:
    network = random_network(ALLEN, 6, 5.0, 4.5, seed)
    assert solve(network).verdict is (Verdict.CONSISTENT if placeable(network) else Verdict.INCONSISTENT)


def backtracking(network: Network) -> bool:
    """Return True if some choice of atoms is closed, by trying them pair after pair."""
    chosen, size = network.calculus, network.size
    table: NDArray[np.object_] = np.array([[network.stated(i, j) for j in range(size)] for i in range(size)], object)

    def closed(net: NDArray[np.object_]) -> bool:
        changed = True
        while changed:
            changed = False
            for i, j, k in product(range(size), repeat=3):
                left = net[i, j] & chosen.compose(net[i, k], net[k, j])
                if left != net[i, j]:
                    net[i, j], net[j, i], changed = left, chosen.converse(left), True
                if not left:
                    return False
        return True

    def search(net: NDArray[np.object_]) -> bool:
        if not closed(net):
            return False
        several = [(i, j) for i, j in combinations(range(size), 2) if net[i, j] & (net[i, j] - 1)]
        if not several:
            return True
        i, j = several[0]
        for code in range(len(chosen.atoms)):
            if net[i, j] >> code & 1:
                tried = net.copy()
                tried[i, j], tried[j, i] = 1 << code, chosen.converse(1 << code)
                if search(tried):
                    return True
        return False

    return search(table)


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize(("name", "degree", "atoms"), [("rcc8", 5.0, 2.5), ("direction-distance", 5.0, 7.0)])
def test_closed_networks_are_found_where_backtracking_finds_one(
    name: str, degree: float, atoms: float, seed: int
) -> None:
    """Check that the search agrees: closed atoms decide rcc8; in the other calculus they make a verdict undecided."""
    network = random_network(calculus(name), 6, degree, atoms, seed)
    assert (solve(network).verdict is Verdict.INCONSISTENT) != backtracking(network)


@pytest.fixture(scope="module")
def wide() -> TableCalculus:
    """Intervals with an order of points beside, as one table of 39 atoms without a known tractable subclass."""
    both = ProductCalculus("both", (*ALLEN.factors, *calculus("point").factors))
    atoms = range(len(both.atoms))
    table = [[both.compose(1 << i, 1 << j) for j in atoms] for i in atoms]
    converses = [both.converse(1 << i).bit_length() - 1 for i in atoms]
    return TableCalculus("wide", both.atoms, np.array(converses), np.array(table, dtype=np.uint64), both.identity)


@pytest.mark.parametrize("seed", range(6))
def test_a_wide_table_gives_the_verdict_of_its_intervals(wide: TableCalculus, seed: int) -> None:
    network = random_network(ALLEN, 11, 8.0, 5.5, seed)
    widened = (
        Constraint(c.first, c.second, sum(0b111 << 3 * code for code in bits(c.relation))) for c in network.constraints
    )
    solution = solve(Network(wide, 11, tuple(widened)), scenario=True)
    assert solution.verdict is solve(network).verdict
    if solution.scenario is not None:
        assert close(solution.scenario).consistent and len(solution.scenario.constraints) == 55


@pytest.mark.parametrize("seed", range(8))
def test_rectangle_alternatives_agree_with_their_closure(seed: int) -> None:
    """Check closed atoms of rectangles, which are consistent, so that a scenario proves it and none refutes it."""
    assert isinstance(RA, ProductCalculus)
    network = random_network(RA, 5, 4.0, 6.0, seed)
    solution = solve(network, scenario=True)
    if solution.verdict is Verdict.CONSISTENT:
        assert solution.scenario is not None
        assert close(solution.scenario, joint=True).consistent
        assert all(solution.scenario.stated(c.first, c.second) & c.relation for c in network.constraints)
    else:
        assert solution.verdict is Verdict.INCONSISTENT
        assert not backtracking(network)


@pytest.mark.parametrize(("name", "degree", "atoms"), [("allen", 9.5, 6.5), ("rcc8", 9.0, 4.0)])
def test_hard_networks_leave_a_scenario_that_closure_confirms(name: str, degree: float, atoms: float) -> None:
    verdicts = set()
    for seed in range(6):
        network = random_network(calculus(name), 30, degree, atoms, seed)
        solution = solve(network, scenario=True)
        verdicts.add(solution.verdict)
        if solution.scenario is not None:
            assert close(solution.scenario).consistent
            assert all(solution.scenario.stated(c.first, c.second) & c.relation for c in network.constraints)
    assert Verdict.UNDECIDED not in verdicts


def test_remaining_relations_are_within_a_tractable_relation() -> None:
    assert ALLEN.factors[0].tractable is not None
    network = random_network(ALLEN, 40, 8.0, 6.5, 3)
    closed = close(network).parts[0][None, :, :, 0]
    edges = np.array(sorted({min(c.first, c.second) * 40 + max(c.first, c.second) for c in network.constraints}))
    search = ConflictSearch(ALLEN.factors, closed, edges)
    assert search.run() is True
    for edge in edges.tolist():
        i, j = divmod(edge, 40)
        hull = int(search.tractable()[0, i, j])
        assert ALLEN.factors[0].tractable.contains(hull)
        assert not hull & ~int(closed[0, i, j]) and int(search.masks[0, i, j])


def test_eight_networks_at_the_phase_transition_are_fast() -> None:
    networks = [random_network(ALLEN, 60, 9.5, 6.5, seed) for seed in range(8)]
    solve(networks[0])  # compile
    with processor_time_below(3.0):
        verdicts = {solve(network, Deadline.after(30.0)).verdict for network in networks}
        assert verdicts == {Verdict.CONSISTENT, Verdict.INCONSISTENT}


def test_verdicts_do_not_depend_on_room_and_forgetting(monkeypatch: pytest.MonkeyPatch) -> None:
    networks = [random_network(ALLEN, 45, 9.5, 6.5, seed) for seed in range(12)]
    verdicts = [solve(network).verdict for network in networks]
    monkeypatch.setattr(conflict_search, "FIRST_NOGOODS", 2)
    monkeypatch.setattr(conflict_search, "FIRST_PREMISES", 2)
    monkeypatch.setattr(conflict_search, "FIRST_ROOM", 8)
    monkeypatch.setattr(conflict_search, "NOGOODS_KEPT", 4)
    again = [solve(network) for network in networks]
    assert [solution.verdict for solution in again] == verdicts
    assert max(solution.dead_ends for solution in again) > 64  # so the search restarted
