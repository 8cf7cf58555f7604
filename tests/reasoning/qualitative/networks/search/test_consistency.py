"""Test search: verdicts against all arrangements, networks that closure misses, scenarios, and undecided cases."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, atoms_of, bits
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, scenario, solve

ALLEN, RCC8, RA = calculus("allen"), calculus("rcc8"), calculus("ra")
PAIRS = list(combinations(range(4), 2))
MANY = settings(max_examples=80, deadline=None)


def four(relations: tuple[int, ...]) -> Network:
    return Network(ALLEN, 4, tuple(Constraint(i, j, r) for (i, j), r in zip(PAIRS, relations, strict=True)))


def stated(network: Network, *lines: str) -> Network:
    parts = (line.split(maxsplit=2) for line in lines)
    constraints = (Constraint(int(i), int(j), network.calculus.relation(signs.split())) for i, j, signs in parts)
    return network.only(constraints)


# Four intervals, path-consistent and still inconsistent, from Allen's (1983) Figure 5
FIGURE_5 = stated(Network(ALLEN, 4, ()), "3 0 m s", "3 1 o", "3 2 m s", "0 1 d di", "1 2 d di", "0 2 f fi")


def test_an_inconsistent_closed_network_is_refuted(four_intervals: NDArray[np.uint64]) -> None:
    closed = close(FIGURE_5)
    assert closed.consistent and closed.narrowed == 0
    relations = np.array([closed.relation(i, j) for i, j in PAIRS], dtype=np.uint64)
    assert not ((four_intervals & relations) > 0).all(axis=1).any()  # no four intervals satisfy it
    solution = solve(FIGURE_5)
    assert solution.verdict is Verdict.INCONSISTENT and not solution.refuted and solution.dead_ends > 0


HARD = st.sampled_from(
    [ALLEN.relation(["d", "di"]), ALLEN.relation(["f", "fi"]), ALLEN.relation(["<", ">"]), ALLEN.relation(["o", "oi"])]
)
ANY = st.integers(1, ALLEN.universal)


@MANY
@given(relations=st.tuples(*[HARD | ANY] * 6))
def test_verdicts_on_four_intervals_agree_with_trying_all(
    four_intervals: NDArray[np.uint64], relations: tuple[int, ...]
) -> None:
    ways = ((four_intervals & np.array(relations, dtype=np.uint64)) > 0).all(axis=1)
    solution = solve(four(relations), scenario=True)
    assert solution.verdict is (Verdict.CONSISTENT if ways.any() else Verdict.INCONSISTENT)
    if solution.scenario is not None:
        found = np.array([c.relation for c in solution.scenario.constraints], dtype=np.uint64)
        assert (four_intervals[ways] == found).all(axis=1).any()


@MANY
@given(st.lists(st.sets(st.integers(0, 7), min_size=1, max_size=3), min_size=6, max_size=6))
def test_verdicts_on_four_regions_agree_with_closed_scenarios(choices: list[set[int]]) -> None:
    """Try all closed scenarios, since closed networks of RCC-8 atoms are consistent (Nebel 1995)."""
    relations = [sum(1 << code for code in codes) for codes in choices]
    network = Network(RCC8, 4, tuple(Constraint(i, j, r) for (i, j), r in zip(PAIRS, relations, strict=True)))
    some = any(_closed_atoms(dict(zip(PAIRS, atoms, strict=True))) for atoms in product(*map(atoms_of, relations)))
    assert solve(network).verdict is (Verdict.CONSISTENT if some else Verdict.INCONSISTENT)


def _closed_atoms(atoms: dict[tuple[int, int], int]) -> bool:
    whole = atoms | {(j, i): RCC8.converse(r) for (i, j), r in atoms.items()}
    return all(
        whole[i, j] & RCC8.compose(whole[i, k], whole[k, j]) for i, j in whole for k in range(4) if k not in (i, j)
    )


@settings(MANY, max_examples=25)
@given(st.data())
def test_choices_between_axes_are_searched(data: st.DataObject) -> None:
    assert isinstance(RA, ProductCalculus)
    codes = st.sets(st.integers(0, 168), min_size=1, max_size=3)
    triangle = [(0, 1), (1, 2), (0, 2)]
    relations = [sum(1 << code for code in data.draw(codes)) for _ in triangle]
    network = Network(RA, 3, tuple(Constraint(i, j, r) for (i, j), r in zip(triangle, relations, strict=True)))
    # the atoms of three things are consistent where the third is in the composition of the others
    some = any(c & RA.compose(a, b) for a, b, c in product(*map(atoms_of, relations)))
    assert solve(network).verdict is (Verdict.CONSISTENT if some else Verdict.INCONSISTENT)


@pytest.mark.parametrize("name", ["point", "allen", "ra", "ba", "rcc8", "cd"])
def test_a_scenario_has_one_stated_atom_per_pair(name: str) -> None:
    chosen, rng = calculus(name), np.random.default_rng(3)
    identity = 1 << chosen.identity
    codes = [(int(i), int(j), int(rng.integers(len(chosen.atoms)))) for i, j in rng.integers(0, 7, (9, 2)) if i != j]
    network = Network(chosen, 7, tuple(Constraint(i, j, identity | 1 << code) for i, j, code in codes))
    found = scenario(network)
    assert found is not None
    assert all(len(list(bits(c.relation))) == 1 for c in found.constraints)
    assert all(found.stated(c.first, c.second) & c.relation for c in network.constraints)
    assert len(found.constraints) == 21
    assert solve(found).verdict is Verdict.CONSISTENT


def test_an_inconsistent_network_has_no_scenario() -> None:
    assert scenario(FIGURE_5) is None


def test_the_verdict_is_undecided_where_closure_proves_nothing() -> None:
    distance = calculus("distance")
    solution = solve(Network(distance, 3, (Constraint(0, 1, 2), Constraint(1, 2, 2))), scenario=True)
    assert solution.verdict is Verdict.UNDECIDED
    assert "proves nothing" in solution.reason
    assert scenario(Network(distance, 3, (Constraint(0, 1, 2),))) is None


def test_the_ten_names_are_decided_in_the_rectangle_algebra() -> None:
    ten = calculus("ten")
    left, right = ten.relation(["left"]), ten.relation(["right"])
    circle = (Constraint(0, 1, left), Constraint(1, 2, left), Constraint(2, 0, left))
    assert solve(Network(ten, 3, circle)).verdict is Verdict.INCONSISTENT
    found = scenario(Network(ten, 3, (*circle[:2], Constraint(2, 0, left | right))))
    assert found is not None
    assert [ten.members(found.stated(2, 0))] == [("right",)]


@pytest.mark.parametrize("scenario", [False, True])
def test_a_large_network_keeps_to_its_time_limit(scenario: bool) -> None:
    """Use a sparse network with half of all relations outside the tractable class, so that there are many choices."""
    rng = np.random.default_rng(3)
    pairs = [(int(i), int(j)) for i, j in rng.integers(0, 1500, (4000, 2)) if i != j]
    stated = tuple(Constraint(i, j, int(rng.integers(1, ALLEN.universal)) | 0x111) for i, j in pairs)
    solve(FIGURE_5)  # compile
    with processor_time_below(3.0):
        solve(Network(ALLEN, 1500, stated), deadline=Deadline.after(1.0), scenario=scenario)


def test_a_time_limit_of_zero_leaves_it_undecided() -> None:
    solution = solve(FIGURE_5, deadline=Deadline.after(0.0))
    assert solution.verdict is Verdict.UNDECIDED and "time" in solution.reason
