"""The engine of difference constraints, compared with Floyd-Warshall on codes."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from difference_constraints import AXES, DIFFERENCE, ORDER, POINTS, floyd_warshall
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.reasoning.constraints.difference import ORDERS, Difference, DifferenceNetwork


@pytest.mark.parametrize(
    ("one", "dtype"), [(DIFFERENCE, np.dtype(np.int64)), (ORDER, ORDERS)], ids=["bounds", "orders"]
)
@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_distances_are_shortest_paths_refusals_negative_cycles(
    one: st.SearchStrategy[Difference], dtype: np.dtype[np.int64], data: st.DataObject
) -> None:
    network, taken = DifferenceNetwork(POINTS, AXES, dtype), list[Difference]()
    for difference in data.draw(st.lists(one, max_size=25)):
        admitted = network.admits(difference)
        assert network.add(difference) == admitted
        if admitted:
            taken.append(difference)
        else:
            cycle = [taken[number] for number in network.cycle(difference)]
            assert floyd_warshall([*cycle, difference]) is None
            for few in combinations(cycle, len(cycle) - 1):
                assert floyd_warshall([*few, difference]) is not None
        expected = floyd_warshall(taken)
        assert expected is not None
        assert (
            np.where(network.distances >= network.free, 1 << 62, network.distances.astype(np.int64)) == expected
        ).all()
    assert network.constraints.tolist() == [list(difference) for difference in taken]


@settings(max_examples=80, deadline=None)
@given(st.lists(DIFFERENCE, max_size=15), st.lists(DIFFERENCE, max_size=15))
def test_taking_back_constraints_restores_the_distances(first: list[Difference], more: list[Difference]) -> None:
    network, once = DifferenceNetwork(POINTS, AXES), DifferenceNetwork(POINTS, AXES)
    for difference in first:
        network.add(difference)
        once.add(difference)
    length = len(network)
    for difference in more:
        network.add(difference)
    network.back(length)
    assert (network.distances == once.distances).all()
    for difference in more:
        assert network.add(difference) == once.add(difference)
        if not network.admits(difference):
            assert network.cycle(difference) == once.cycle(difference)


@settings(max_examples=80, deadline=None)
@given(st.lists(DIFFERENCE, max_size=20))
def test_adding_all_at_once_equals_adding_one_by_one(constraints: list[Difference]) -> None:
    network, taken = DifferenceNetwork(POINTS, AXES), list[Difference]()
    for difference in constraints:
        if network.add(difference):
            taken.append(difference)
    added, replaced = DifferenceNetwork(POINTS, AXES), DifferenceNetwork(POINTS, AXES)
    assert added.add_all(np.array(taken, np.int64).reshape(-1, 4))
    replaced.replace(taken)
    grown = DifferenceNetwork(0, AXES)
    for _ in range(POINTS):
        grown.add_point()
    assert all(grown.add(difference) for difference in taken)
    for other in (added, replaced, grown, network.copy()):
        assert (other.distances == network.distances).all()
        assert np.array_equal(other.constraints, network.constraints)
    whole = np.array(constraints, np.int64).reshape(-1, 4)
    assert DifferenceNetwork(POINTS, AXES).add_all(whole) == (floyd_warshall(constraints) is not None)


@settings(max_examples=80, deadline=None)
@given(st.lists(DIFFERENCE, max_size=20), st.lists(st.integers(-20, 20), min_size=10, max_size=10))
def test_the_nearest_solution_is_a_solution_and_a_fixed_point(constraints: list[Difference], wanted: list[int]) -> None:
    network = DifferenceNetwork(POINTS, AXES)
    for difference in constraints:
        network.add(difference._replace(code=difference.code | 1))
    found = network.nearest(np.array(wanted).reshape(AXES, POINTS))
    for axis, tail, head, code in network.constraints.tolist():
        assert found[axis, head] - found[axis, tail] <= code >> 1
    assert (network.nearest(found) == found).all()


@given(DIFFERENCE)
def test_a_difference_and_its_denial_are_inconsistent(difference: Difference) -> None:
    assert difference.denied().denied() == difference
    network = DifferenceNetwork(POINTS, AXES)
    assert network.add(difference)
    assert not network.add(difference.denied())
    assert network.add(difference.denied()._replace(code=difference.denied().code + 1))
