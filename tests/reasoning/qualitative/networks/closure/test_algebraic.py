"""Test algebraic closure: its laws, a slow independent closure, sampled geometry, and its limits."""

from __future__ import annotations

import tracemalloc
from functools import cache
from itertools import product

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError, NetworkError
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, bits
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.closure.state import NetworkState
from deixis.reasoning.qualitative.networks.network import Constraint, Network, on_axes

ALLEN, POINT, RA = calculus("allen"), calculus("point"), calculus("ra")
assert isinstance(RA, ProductCalculus)
SMALL = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])


@st.composite
def networks(
    draw: st.DrawFn, names: tuple[str, ...] = ("allen", "point", "rcc8", "cd", "ten"), most: int = 5
) -> Network:
    chosen = calculus(draw(st.sampled_from(names)))
    size = draw(st.integers(2, most))
    pair = st.tuples(st.integers(0, size - 1), st.integers(0, size - 1)).filter(lambda p: p[0] != p[1])
    relation = st.sets(st.integers(0, len(chosen.atoms) - 1), min_size=1, max_size=len(chosen.atoms) // 2 + 1)
    stated = draw(st.lists(st.tuples(pair, relation.map(lambda codes: sum(1 << code for code in codes))), max_size=9))
    return Network(chosen, size, tuple(Constraint(i, j, r) for (i, j), r in stated))


@cache
def atom_table(chosen: Calculus) -> list[list[int]]:
    atoms = range(len(chosen.atoms))
    return [[chosen.compose(1 << a, 1 << b) for b in atoms] for a in atoms]


def slow_closure(network: Network) -> dict[tuple[int, int], int] | None:
    """Compute path consistency as in textbooks, atom by atom; return None if a pair is emptied."""
    chosen, things = network.calculus, range(network.size)
    table = atom_table(chosen)
    relation = {(i, j): network.stated(i, j) for i, j in product(things, repeat=2)}
    changed = True
    while changed:
        if not all(relation.values()):
            return None
        changed = False
        for i, j, k in product(things, repeat=3):
            through = 0
            for a, b in product(bits(relation[i, k]), bits(relation[k, j])):
                through |= table[a][b]
            if relation[i, j] & ~through:
                relation[i, j] &= through
                changed = True
    return relation


@SMALL
@given(networks())
def test_closure_agrees_with_a_slow_closure(network: Network) -> None:
    closed, slow = close(network), slow_closure(network)
    assert closed.complete
    assert closed.consistent == (slow is not None)
    if slow is not None:
        assert {pair: closed.relation(*pair) for pair in slow} == slow


@settings(SMALL, max_examples=10)
@given(networks(("ra",), most=3))
def test_relations_that_are_not_products_agree_with_slow_closure(network: Network) -> None:
    closed, slow = close(network), slow_closure(network)
    assert closed.consistent == (slow is not None)
    if slow is not None:
        assert {pair: closed.relation(*pair) for pair in slow} == slow


@st.composite
def products(draw: st.DrawFn, name: str) -> Network:
    chosen = calculus(name)
    assert isinstance(chosen, ProductCalculus)
    parts = [draw(networks((axis.name,), most=4)) for axis in chosen.axes]
    size = max(part.size for part in parts)
    constraints = []
    for k, part in enumerate(parts):
        for c in part.constraints:
            whole = [axis.universal for axis in chosen.axes]
            whole[k] = c.relation
            constraints.append(Constraint(c.first, c.second, chosen.of_axes(whole)))
    return Network(chosen, size, tuple(constraints))


@settings(SMALL, max_examples=25)
@given(st.sampled_from(["ra", "cd", "ba"]).flatmap(products))
def test_closing_by_axis_agrees_with_closing_the_whole_product(network: Network) -> None:
    apart, joint = close(network), close(network, joint=True)
    assert len(apart.parts) > len(joint.parts) == 1
    assert apart.consistent == joint.consistent
    if apart.consistent:
        pairs = list(product(range(network.size), repeat=2))
        assert [apart.relation(i, j) for i, j in pairs] == [joint.relation(i, j) for i, j in pairs]


@SMALL
@given(networks(), st.randoms(use_true_random=False))
def test_closure_does_not_depend_on_the_order_of_things(network: Network, random: object) -> None:
    order = list(range(network.size))
    random.shuffle(order)  # type: ignore[attr-defined]
    renamed = network.only(Constraint(order[c.first], order[c.second], c.relation) for c in network.constraints)
    one, other = close(network), close(renamed)
    assert one.consistent == other.consistent
    if one.consistent:
        for i, j in product(range(network.size), repeat=2):
            assert one.relation(i, j) == other.relation(order[i], order[j])


@SMALL
@given(networks())
def test_closing_a_closed_network_changes_nothing(network: Network) -> None:
    closed = close(network)
    if closed.consistent:
        pairs = list(product(range(network.size), repeat=2))
        again = close(network.only(Constraint(i, j, closed.relation(i, j)) for i, j in pairs))
        assert again.narrowed == 0
        assert all(again.relation(i, j) == closed.relation(i, j) for i, j in pairs)


@pytest.mark.parametrize("name", ["point", "allen", "ra", "rcc8", "cd"])
def test_an_empty_network_stays_universal(name: str) -> None:
    closed = close(Network(calculus(name), 5, ()))
    assert closed.narrowed == 0
    assert closed.relation(0, 4) == calculus(name).universal
    assert closed.relation(2, 2) == 1 << calculus(name).identity


@pytest.mark.parametrize("size", [0, 1, 63, 64, 65, 128])
def test_a_chain_closes_at_every_size_of_a_word(size: int) -> None:
    before = ALLEN.relation(["<"])
    closed = close(Network(ALLEN, size, tuple(Constraint(i, i + 1, before) for i in range(size - 1))))
    assert closed.consistent
    assert all(closed.relation(i, j) == before for i in range(size) for j in range(i + 1, size))
    assert closed.narrowed == sum(range(size - 1))


@pytest.mark.parametrize("seed", range(5))
def test_relations_of_sampled_intervals_are_never_excluded(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low = rng.integers(0, 9, 40).astype(np.float64)
    high = low + rng.integers(1, 5, 40).astype(np.float64)
    codes = allen_relations(low[:, None], high[:, None], low[None], high[None])
    stated = [(int(i), int(j), int(m)) for i, j, m in rng.integers(0, [40, 40, 1 << 13], (150, 3))]
    closed = close(Network(ALLEN, 40, tuple(Constraint(i, j, m | 1 << int(codes[i, j])) for i, j, m in stated)))
    relations = closed.parts[0][:, :, 0]
    assert closed.narrowed > 0
    assert (relations >> codes.astype(np.uint64) & np.uint64(1)).all()


def test_a_thing_must_be_identical_to_itself() -> None:
    assert close(Network(POINT, 1, (Constraint(0, 0, POINT.relation(["=", "<"])),))).consistent
    closed = close(Network(POINT, 2, (Constraint(1, 1, POINT.relation(["<"])),)))
    assert closed.emptied == (1, 1)


def test_constraints_on_one_pair_are_intersected_both_ways() -> None:
    stated = (Constraint(0, 1, POINT.relation(["<", "="])), Constraint(1, 0, POINT.relation(["=", "<"])))
    assert POINT.members(close(Network(POINT, 2, stated)).relation(0, 1)) == ("=",)


def test_the_emptied_pair_is_reported() -> None:
    before = POINT.relation(["<"])
    assert close(Network(POINT, 2, (Constraint(0, 1, before), Constraint(1, 0, before)))).emptied == (1, 0)


def test_closure_stops_in_time_and_reports_progress() -> None:
    before = ALLEN.relation(["<", "m", "o"])
    network = Network(ALLEN, 700, tuple(Constraint(i, i + 1, before) for i in range(699)))
    told: list[tuple[int, int]] = []
    closed = close(network, Deadline.after(-1.0), lambda done, total: told.append((done, total)))
    assert not closed.complete
    assert told and all(0 < done <= total for done, total in told)


def test_an_interruption_from_progress_gets_through() -> None:
    def interrupt(done: int, total: int) -> None:
        raise KeyboardInterrupt

    network = Network(ALLEN, 700, tuple(Constraint(i, i + 1, ALLEN.relation(["<", "m"])) for i in range(699)))
    with pytest.raises(KeyboardInterrupt):
        close(network, progress=interrupt)


def test_a_network_too_large_for_memory_is_refused() -> None:
    with pytest.raises(LimitError, match=r"up to 10,922 things"):
        close(Network(ALLEN, 10**9, ()))


@pytest.mark.parametrize(("name", "bits"), [("allen", 16), ("ra", 169)])
def test_memory_grows_only_with_the_square(name: str, bits: int) -> None:
    tracemalloc.start()
    kept = NetworkState(calculus(name), 1024)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert kept.size == 1024
    assert peak < 1.2 * 1024 * 1024 * (bits + 1) / 8


def test_constraints_on_unknown_things_are_refused() -> None:
    with pytest.raises(NetworkError, match="0 to 1"):
        Network(POINT, 2, (Constraint(0, 2, 1),))
    with pytest.raises(NetworkError, match="3 atoms"):
        Network(POINT, 2, (Constraint(0, 1, 8),))


def test_a_choice_between_axes_is_not_a_product() -> None:
    assert isinstance(RA, ProductCalculus)
    x, y = (axis.relation(["<"]) for axis in RA.axes)
    left, below = RA.of_axes([x, RA.axes[1].universal]), RA.of_axes([RA.axes[0].universal, y])
    assert on_axes(Network(RA, 2, (Constraint(0, 1, left | below),))) is None
    assert on_axes(Network(RA, 2, (Constraint(0, 1, left & below),))) is not None
