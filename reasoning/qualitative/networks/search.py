"""Consistency: closure where it decides, else backtracking with the tractable subclass as split set.

A relation is split into the fewest relations of a tractable subclass, for which a closed network is consistent
(:meth:`Calculus.pieces`); the pair with fewest pieces is tried first, and after each choice the network is closed
again, which is the forward checking (Ladkin and Reinefeld 1992; Nebel 1997). Where even closed networks of atoms may
be inconsistent (``decided_by_closure`` is False) a contradiction is still a proof, and everything else undecided.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.bridges import Link
from deixis.reasoning.qualitative.calculi.calculus import Calculus
from deixis.reasoning.qualitative.networks.choices import FewestPiecesFirst, FirstOpenPair, PairSelector
from deixis.reasoning.qualitative.networks.closure import closed_states, whole_relation
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.state import NetworkState, Progress


class Verdict(StrEnum):
    """Whether all constraints of a network can hold at once."""

    CONSISTENT = "consistent"
    INCONSISTENT = "inconsistent"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class Solution:
    """The verdict on a network, and how it came about.

    ``scenario`` is, where it was asked for and found, the network with one atom for each pair i < j; where the verdict
    is undecided for the sake of the calculus it is closed, and nothing more. ``refuted`` says that closure alone found
    the contradiction. ``reason`` tells in words why the verdict is undecided.
    """

    verdict: Verdict
    choices: int
    dead_ends: int
    seconds: float
    scenario: Network | None = None
    refuted: bool = False
    reason: str = ""


class _OutOfTime(Exception):
    """The deadline came first."""


@dataclass(frozen=True)
class _Choice:
    """A pair i < j that is chosen for, what is still to be tried, and where the trail was before."""

    first: int
    second: int
    pieces: Iterator[int]
    mark: int


@dataclass
class _Tally:
    deadline: Deadline
    progress: Progress | None
    choices: int = 0
    dead_ends: int = 0

    def check_clock(self) -> None:
        if self.deadline.passed:
            raise _OutOfTime


def solve(
    network: Network, deadline: Deadline = Deadline.never(), progress: Progress | None = None, scenario: bool = False
) -> Solution:
    """Decide whether a network is consistent, until ``deadline``; ``scenario`` asks for one as well.

    Raises LimitError where the network would not fit in memory.

    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> point = calculus("point")
    >>> before = point.relation(["<"])
    >>> circle = tuple(Constraint(i, (i + 1) % 3, before) for i in range(3))
    >>> str(solve(Network(point, 3, circle)).verdict), str(solve(Network(point, 3, circle[:2])).verdict)
    ('inconsistent', 'consistent')
    """
    bridge = decider(network.calculus)
    if bridge is not None:
        solution = solve(translated(network, bridge), deadline, progress, scenario)
        if solution.scenario is None:
            return solution
        atoms = (replace(c, relation=bridge.backward(c.relation)) for c in solution.scenario.constraints)
        return replace(solution, scenario=network.only(atoms))
    started = time.perf_counter()
    tally = _Tally(deadline, progress)
    verdict, reason, found, refuted = _decide(network, tally, scenario)
    return Solution(verdict, tally.choices, tally.dead_ends, time.perf_counter() - started, found, refuted, reason)


def decider(calculus: Calculus) -> Link | None:
    """The bridge to a calculus that decides networks of this one: the ten names are sets of rectangle-algebra atoms."""
    if calculus.name != "ten":
        return None
    from deixis.reasoning.qualitative.calculi.bridges import names_to_boxes

    return names_to_boxes()


def translated(network: Network, bridge: Link) -> Network:
    """Return the same constraints in the calculus across the bridge."""
    constraints = (replace(c, relation=bridge.forward(c.relation)) for c in network.constraints)
    return Network(bridge.target, network.size, tuple(constraints), network.names)


def scenario(network: Network, deadline: Deadline = Deadline.never()) -> Network | None:
    """A consistent network with one atom for each pair, all of them as stated; None where none was found in time."""
    solution = solve(network, deadline, scenario=True)
    return solution.scenario if solution.verdict is Verdict.CONSISTENT else None


def _decide(network: Network, tally: _Tally, scenario: bool) -> tuple[Verdict, str, Network | None, bool]:
    try:
        states, complete = closed_states(network, tally.deadline, tally.progress, traced=True)
        if any(state.emptied is not None for state in states):
            return Verdict.INCONSISTENT, "", None, True
        if not complete:
            raise _OutOfTime
        for state in states:
            if not _refine(state, FewestPiecesFirst(state, tally.check_clock), tally):
                return Verdict.INCONSISTENT, "", None, False
        if scenario:
            for state in states:
                _refine(state, FirstOpenPair(state), tally)
        found = atomic_network(network, states, tally) if scenario else None
    except _OutOfTime:
        return Verdict.UNDECIDED, "the time limit was reached", None, False
    if not network.calculus.decided_by_closure:
        name = network.calculus.name
        return Verdict.UNDECIDED, f"closure found no contradiction, and in {name} that proves nothing", found, False
    return Verdict.CONSISTENT, "", found, False


def _refine(state: NetworkState, choices: PairSelector, tally: _Tally) -> bool:
    """Choose until nothing is left to pick; False where every way leads to a contradiction."""
    stack: list[_Choice] = []
    while True:
        tally.check_clock()
        found = choices.pick()
        if found is None:
            return True
        stack.append(_Choice(found[0], found[1], iter(found[2]), state.mark))
        if not _next_choice(state, choices, stack, tally):
            return False
        choices.note(state.changed(stack[-1].mark))


def _next_choice(state: NetworkState, choices: PairSelector, stack: list[_Choice], tally: _Tally) -> bool:
    """Make the next choice that closure lets stand, going back where none is left; False where none is at all."""
    while stack:
        last = stack[-1]
        for piece in last.pieces:
            tally.check_clock()
            tally.choices += 1
            state.assign(last.first, last.second, piece)
            if not state.close(tally.deadline, tally.progress):
                raise _OutOfTime
            if state.emptied is None:
                return True
            tally.dead_ends += 1
            state.undo(last.mark)
        stack.pop()
        if stack:
            given_back = state.changed(stack[-1].mark)
            state.undo(stack[-1].mark)
            choices.note(np.append(given_back, last.first * state.size + last.second))
    return False


def atomic_network(network: Network, states: tuple[NetworkState, ...], tally: _Tally) -> Network:
    """Return the network of what the states of its axes say of every pair i < j."""
    atoms = []
    for i in range(network.size):
        tally.check_clock()
        for j in range(i + 1, network.size):
            atoms.append(Constraint(i, j, whole_relation(network.calculus, states, i, j)))
    return network.only(atoms)
