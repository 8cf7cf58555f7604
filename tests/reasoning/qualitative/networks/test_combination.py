"""Test calculi closed together: contradictions that neither finds alone, contributions, and undecided cases."""

from __future__ import annotations

import pytest

from deixis.deadline import Deadline
from deixis.reasoning.errors import NetworkError
from deixis.reasoning.qualitative.calculi.bridges import links_between
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.closure.algebraic import close
from deixis.reasoning.qualitative.networks.combination import close_jointly, joint_conflict, solve_jointly
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve

RA, RCC8, CD, DISTANCE = (calculus(name) for name in ("ra", "rcc8", "cd", "distance"))


def network(name: str, size: int, *lines: tuple[int, int, str]) -> Network:
    chosen = calculus(name)
    return Network(chosen, size, tuple(Constraint(i, j, chosen.relation(signs.split())) for i, j, signs in lines))


# a lies left of b as boxes; as regions a is part of c, and c part of b: each is consistent, both together are not
BOXES = network("ra", 3, (0, 1, "<,="))
REGIONS = network("rcc8", 3, (0, 2, "NTPP"), (2, 1, "NTPP"))


def test_a_contradiction_that_no_single_network_has() -> None:
    assert solve(BOXES).verdict is solve(REGIONS).verdict is Verdict.CONSISTENT
    links = links_between([RA, RCC8])
    solution = solve_jointly([BOXES, REGIONS], links)
    assert solution.verdict is Verdict.INCONSISTENT
    conflict = joint_conflict([BOXES, REGIONS], links)
    assert conflict is not None and conflict.minimal
    assert [(name, c.first, c.second) for name, c in conflict.constraints] == [
        ("ra", 0, 1),
        ("rcc8", 0, 2),
        ("rcc8", 2, 1),
    ]


def test_what_each_contributes_is_reported() -> None:
    boxes = network("ra", 3, (0, 1, "d,d"), (1, 2, "<,="))
    closed = close_jointly([boxes, network("rcc8", 3)], links_between([RA, RCC8]))
    said = {each.name: (each.pairs, each.atoms) for each in closed.contributions}
    assert closed.consistent and closed.complete
    assert said["ra"] == (1, 168)  # 0 lies left of 2, within its height
    assert said["ra -> rcc8"][0] == 3
    assert said["rcc8"] == said["rcc8 -> ra"] == (0, 0)
    assert RCC8.members(closed.relation("rcc8", 0, 2)) == ("DC",)


def test_without_bridges_each_calculus_closes_by_itself() -> None:
    boxes = network("ra", 3, (0, 1, "<,m"), (1, 2, "<,s"))
    closed = close_jointly([boxes, REGIONS], [])
    assert all(closed.relation("ra", i, j) == close(boxes).relation(i, j) for i in range(3) for j in range(3))
    assert all(closed.relation("rcc8", i, j) == close(REGIONS).relation(i, j) for i in range(3) for j in range(3))


def test_boxes_prove_consistency_in_several_calculi() -> None:
    links = links_between([RA, RCC8])
    fine = network("rcc8", 3, (0, 1, "DC"))
    solution = solve_jointly([BOXES, fine], links)
    assert solution.verdict is Verdict.CONSISTENT
    assert solution.boxes is not None and solution.boxes[0, 1, 0] < solution.boxes[1, 0, 0]
    assert solve_jointly([BOXES, network("rcc8", 3)], links).verdict is Verdict.CONSISTENT
    assert solve_jointly([network("ra", 3), network("rcc8", 3)], links).verdict is Verdict.CONSISTENT


def test_bridges_propagate_along_a_chain() -> None:
    """Give equal boxes, which have one centre (cd), so that their distance is 0."""
    networks = [network("ra", 2, (0, 1, "=,=")), network("cd", 2), network("distance", 2)]
    closed = close_jointly(networks, links_between([RA, CD, DISTANCE]))
    assert CD.members(closed.relation("cd", 0, 1)) == ("EQ",)
    assert DISTANCE.members(closed.relation("distance", 0, 1)) == ("same",)


def test_networks_over_different_things_are_refused() -> None:
    with pytest.raises(NetworkError, match="same things"):
        close_jointly([BOXES, network("rcc8", 4)], [])
    with pytest.raises(NetworkError, match="a calculus of their own"):
        close_jointly([BOXES, BOXES], [])
    with pytest.raises(NetworkError, match="no network here is in cd"):
        close_jointly([BOXES], []).relation("cd", 0, 1)


def test_joint_closure_reports_that_time_ran_out() -> None:
    solution = solve_jointly(
        [BOXES, network("rcc8", 3, (0, 1, "DC"))], links_between([RA, RCC8]), deadline=Deadline.after(-1.0)
    )
    assert solution.verdict is Verdict.UNDECIDED
