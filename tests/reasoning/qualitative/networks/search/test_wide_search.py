"""Compare calculi whose relations take several words with the same calculus in a small table."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from random_networks import random_network

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, TableCalculus, bits
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.calculi.words import words_of
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.conflict import minimal_conflict
from deixis.reasoning.qualitative.networks.derivation import explain
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search import wide_search
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve
from deixis.reasoning.qualitative.networks.search.wide_search import WideSearch

ALLEN, RCC8 = calculus("allen"), calculus("rcc8")


@pytest.fixture(scope="module")
def wide() -> TableCalculus:
    """Intervals with a region beside, in one table of 104 atoms: 8 i + r is atom i of Allen with atom r of RCC-8."""
    both = ProductCalculus("both", (*ALLEN.factors, *RCC8.factors))
    size = len(both.atoms)
    rows = [words_of([both.compose(1 << i, 1 << j) for j in range(size)], size) for i in range(size)]
    converses = [both.converse(1 << i).bit_length() - 1 for i in range(size)]
    return TableCalculus("wide", both.atoms, np.array(converses), np.array(rows), both.identity)


def widened(network: Network, wide: TableCalculus) -> Network:
    """Return the same network of intervals, with any regions beside."""
    stated = tuple(replace(c, relation=with_regions(c.relation)) for c in network.constraints)
    return Network(wide, network.size, stated)


def with_regions(relation: int) -> int:
    """Return a relation of intervals with any relation of regions."""
    return sum(0xFF << 8 * code for code in bits(relation))


@pytest.mark.parametrize("seed", range(6))
def test_closure_of_a_wide_calculus_agrees_with_its_part(wide: TableCalculus, seed: int) -> None:
    network = random_network(ALLEN, 70, 6.0, 6.5, seed)  # more than 64 things, so that these take two words too
    small, large = close(network), close(widened(network, wide))
    assert small.consistent == large.consistent
    if small.consistent:
        for i, j in combinations(range(0, 70, 3), 2):
            assert large.relation(i, j) == with_regions(small.relation(i, j))


@pytest.mark.parametrize("seed", range(8))
def test_a_wide_search_agrees_with_the_small_one(wide: TableCalculus, seed: int) -> None:
    network = random_network(ALLEN, 14, 9.0, 5.5, seed)
    large = widened(network, wide)
    solution = solve(large, scenario=True)
    assert solution.verdict is solve(network).verdict
    if solution.scenario is not None:
        again = close(solution.scenario)
        assert again.consistent and again.narrowed == 0 and len(solution.scenario.constraints) == 91
        assert all(solution.scenario.stated(c.first, c.second) & c.relation for c in large.constraints)


@pytest.mark.parametrize("seed", range(10))
def test_search_by_planes_agrees_with_the_search_by_nogoods(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wide_search, "FIRST_RESTART", 2)
    network = random_network(calculus("direction-distance"), 9, 6.5, 6.0, seed)
    refuted = solve(network).verdict is Verdict.INCONSISTENT
    assert WideSearch(network).run() is not refuted


def test_a_wide_conflict_is_found_and_explained(wide: TableCalculus) -> None:
    before = wide.relation(["<,DC", "m,DC"])
    circle = Network(wide, 4, tuple(Constraint(k, (k + 1) % 4, before) for k in range(4)))
    conflict = minimal_conflict(circle)
    assert conflict is not None and conflict.minimal and len(conflict.constraints) == 4
    step = explain(circle.only(circle.constraints[:3]), 0, 3)
    assert step is not None and not step.claim.relation & ~with_regions(ALLEN.relation(["<"]))


def test_a_wide_search_stops_at_the_deadline(wide: TableCalculus) -> None:
    solution = solve(widened(random_network(ALLEN, 30, 9.5, 6.5, 1), wide), Deadline.after(0.0))
    assert solution.verdict is Verdict.UNDECIDED and "time limit" in solution.reason


def test_a_product_with_a_wide_axis_is_refused(wide: TableCalculus) -> None:
    product = ProductCalculus("too wide", (wide, *calculus("point").factors))
    network = Network(product, 2, (Constraint(0, 1, 1),))
    with pytest.raises(LimitError, match="up to 3 axes of up to 64"):
        close(network, joint=True)
    with pytest.raises(LimitError, match="up to 64 atoms an axis"):
        solve(network)
