"""The simple temporal network, compared with scipy's Floyd-Warshall, where strict bounds are slightly tighter."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import NegativeCycleError, floyd_warshall

from deixis.reasoning.constraints.difference import UNBOUNDED, add
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.errors import LimitError
from deixis.reasoning.temporal.bounds import Bounds, bound_text, encode
from deixis.reasoning.temporal.errors import TemporalConflictError, UnknownFluentError
from deixis.reasoning.temporal.network import DifferenceConstraint, SimpleTemporalNetwork, difference

N = 6
LITTLE = 2.0**-20  # far less than a second divided by the number of points
POINTS = ("origin", *"abcde")


def constraint(tail: int, head: int, seconds: int, strict: bool) -> DifferenceConstraint:
    code = encode(seconds, strict)
    text = bound_text(POINTS[tail], POINTS[head], code, "origin")
    return DifferenceConstraint(POINTS[tail], POINTS[head], code, Proof(text, Rule.STATED))


CONSTRAINTS = st.lists(
    st.builds(constraint, st.integers(0, N - 1), st.integers(0, N - 1), st.integers(-4, 9), st.booleans()).filter(
        lambda c: c.tail != c.head
    ),
    max_size=25,
)


def by_scipy(constraints: list[DifferenceConstraint]) -> NDArray[np.int64] | None:
    """Return the codes of all minimal distances, or None for a contradiction."""
    weights = np.full((N, N), np.inf)
    for c in constraints:
        cell = POINTS.index(c.tail), POINTS.index(c.head)
        weights[cell] = min(weights[cell], (c.code >> 1) / 1e6 - (0 if c.code & 1 else LITTLE))
    known = np.isfinite(weights)
    try:
        # scipy distinguishes a weight of 0 from no edge
        distances = floyd_warshall(csr_array((weights[known], np.nonzero(known)), shape=(N, N)))
    except NegativeCycleError:
        return None
    codes = np.full((N, N), UNBOUNDED, dtype=np.int64)
    known = np.isfinite(distances)
    whole = np.ceil(distances[known])
    codes[known] = 2_000_000 * whole.astype(np.int64) + (distances[known] == whole)
    return codes


def taken_in(constraints: list[DifferenceConstraint]) -> tuple[SimpleTemporalNetwork, list[DifferenceConstraint]]:
    """Return a network, and the constraints that it did not refuse."""
    network = SimpleTemporalNetwork(POINTS[1:])
    return network, [c for c in constraints if network.try_add([c])]


@settings(deadline=None)
@given(CONSTRAINTS)
def test_adding_one_by_one_matches_the_batch_computation(constraints: list[DifferenceConstraint]) -> None:
    network = SimpleTemporalNetwork(POINTS[1:])
    kept: list[DifferenceConstraint] = []
    for c in constraints:
        before = network.distances.copy()
        expected = by_scipy([*kept, c])
        if expected is None:
            with pytest.raises(TemporalConflictError):
                network.add([c])
            assert np.array_equal(network.distances, before)
            assert network.constraints == tuple(kept)
        else:
            network.add([c])
            kept.append(c)
            assert np.array_equal(network.distances, expected)


@settings(deadline=None)
@given(CONSTRAINTS)
def test_a_refusal_names_a_simple_negative_cycle(constraints: list[DifferenceConstraint]) -> None:
    network = SimpleTemporalNetwork(POINTS[1:])
    kept: list[DifferenceConstraint] = []
    for c in constraints:
        if not network.try_add([c]):
            named = [premise.claim for premise in network.refutation([c]).premises]
            cycle = [next(other for other in [*kept, c] if other.why.claim == text) for text in named]
            heads = [other.head for other in cycle]
            assert [other.tail for other in cycle] == [heads[-1], *heads[:-1]]
            assert len(set(heads)) == len(heads)
            assert by_scipy(cycle) is None
            for left_out in cycle:
                assert by_scipy([other for other in cycle if other is not left_out]) is not None
        else:
            kept.append(c)


@settings(deadline=None)
@given(CONSTRAINTS)
def test_every_bound_is_the_sum_of_its_explanation(constraints: list[DifferenceConstraint]) -> None:
    network, kept = taken_in(constraints)
    codes = {c.why.claim: c.code for c in kept}
    for tail in POINTS:
        for head in POINTS:
            why = network.explain(tail, head)
            if tail == head or network.code(tail, head) == UNBOUNDED:
                assert why is None
                continue
            assert why is not None
            steps = why.premises or (why,)
            total = encode(0)
            for step in steps:
                total = add(total, codes[step.claim])
            assert total == network.code(tail, head)
            assert why.claim == bound_text(tail, head, total, "origin")


@settings(deadline=None)
@given(CONSTRAINTS, st.data())
def test_taking_back_constraints_restores_the_network(
    constraints: list[DifferenceConstraint], data: st.DataObject
) -> None:
    network, kept = taken_in(constraints)
    before = network.distances.copy()
    if network.try_add([constraint(0, 1, 0, True)]):
        network.back(len(kept))
    assert np.array_equal(network.distances, before)
    gone = data.draw(st.lists(st.sampled_from(kept), unique_by=id)) if kept else []
    network.retract(gone)
    rest = list(kept)
    for c in gone:
        rest.remove(c)
    expected = by_scipy(rest)
    assert expected is not None and np.array_equal(network.distances, expected)


def test_an_explanation_has_the_fewest_constraints() -> None:
    network = SimpleTemporalNetwork("abc")
    for tail, head, seconds in (("a", "b", 1), ("b", "c", 1), ("a", "c", 2)):
        network.add(difference(tail, head, Bounds(upper=seconds)))
    why = network.explain("a", "c")
    assert why == Proof("c <= a + 2", Rule.STATED)


def test_points_may_be_added_at_any_time() -> None:
    network = SimpleTemporalNetwork()
    for k in range(40):
        network.add_point(f"p{k}")
        network.add(difference("origin" if k == 0 else f"p{k - 1}", f"p{k}", Bounds(0.1, 0.1)))
    assert network.bounds("origin", "p39") == Bounds(4, 4)


def test_constraints_are_added_all_or_none() -> None:
    network = SimpleTemporalNetwork("ab")
    with pytest.raises(TemporalConflictError, match=r"b <= a \+ 1; b >= 5; a <= 2"):
        network.add(
            difference("origin", "b", Bounds(5))
            + difference("origin", "a", Bounds(0, 2))
            + difference("a", "b", Bounds(0, 1))
        )
    assert network.constraints == ()
    assert (network.distances[~np.eye(3, dtype=bool)] == UNBOUNDED).all()


def test_unknown_points_are_refused() -> None:
    network = SimpleTemporalNetwork(["cup.start"])
    with pytest.raises(UnknownFluentError, match=r"no time point 'cup\.strat'; did you mean 'cup\.start'\?"):
        network.add(difference("origin", "cup.strat", Bounds(0)))


def test_sums_that_are_not_exact_are_refused() -> None:
    points = [f"p{k}" for k in range(200)]
    network = SimpleTemporalNetwork(points)
    years = [c for tail, head in pairwise(points) for c in difference(tail, head, Bounds(4e9))]
    with pytest.raises(LimitError, match="too long to be added up"):
        network.add(years)
    assert network.constraints == ()
