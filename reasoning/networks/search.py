"""Consistency: closure where it decides, else backtracking with the tractable subclass as split set.

A relation is split into the fewest relations of a tractable subclass, for which a closed network is consistent
(:meth:`Calculus.pieces`); the pair with fewest pieces is tried first, and after each choice the network is closed
again, which is the forward checking (Ladkin and Reinefeld 1992; Nebel 1997). Where even closed networks of atoms may
be inconsistent (``decided_by_closure`` is False) a contradiction is still a proof, and everything else undecided.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from deixis.reasoning.calculi.calculus import Calculus, bits
from deixis.reasoning.networks.closure import closed_states, whole_relation
from deixis.reasoning.networks.link import Link
from deixis.reasoning.networks.network import Constraint, Network
from deixis.reasoning.networks.state import Progress, State


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


Open = tuple[int, int, tuple[int, ...]]
"""A pair, and the relations to try for it."""
Pick = Callable[[State], Open | None]


@dataclass
class _Tally:
    deadline: float | None
    progress: Progress | None
    choices: int = 0
    dead_ends: int = 0


def solve(
    network: Network, time_limit: float | None = None, progress: Progress | None = None, scenario: bool = False
) -> Solution:
    """Decides whether a network is consistent, within ``time_limit`` seconds; ``scenario`` asks for one as well.

    Raises LimitError where the network would not fit in memory.

    >>> from deixis.reasoning.calculi.registry import calculus
    >>> point = calculus("point")
    >>> before = point.relation(["<"])
    >>> circle = tuple(Constraint(i, (i + 1) % 3, before) for i in range(3))
    >>> str(solve(Network(point, 3, circle)).verdict), str(solve(Network(point, 3, circle[:2])).verdict)
    ('inconsistent', 'consistent')
    """
    bridge = decider(network.calculus)
    if bridge is not None:
        solution = solve(translated(network, bridge), time_limit, progress, scenario)
        found = None if solution.scenario is None else _back(network, solution.scenario, bridge)
        return replace(solution, scenario=found)
    started = time.perf_counter()
    tally = _Tally(None if time_limit is None else time.monotonic() + time_limit, progress)
    verdict, reason, found, refuted = _decided(network, tally, scenario)
    return Solution(verdict, tally.choices, tally.dead_ends, time.perf_counter() - started, found, refuted, reason)


def decider(calculus: Calculus) -> Link | None:
    """The bridge to a calculus that decides networks of this one: the ten names are sets of rectangle-algebra atoms."""
    if calculus.name != "ten":
        return None
    from deixis.reasoning.calculi.bridges import names_to_boxes

    return names_to_boxes()


def translated(network: Network, bridge: Link) -> Network:
    """The same constraints in the calculus across the bridge."""
    constraints = (replace(c, relation=bridge.forward(c.relation)) for c in network.constraints)
    return Network(bridge.target, network.size, tuple(constraints), network.names)


def _back(network: Network, scenario: Network, bridge: Link) -> Network:
    return network.only(replace(c, relation=bridge.backward(c.relation)) for c in scenario.constraints)


def scenario(network: Network, time_limit: float | None = None) -> Network | None:
    """A consistent network with one atom for each pair, all of them as stated; None where none was found in time."""
    solution = solve(network, time_limit, scenario=True)
    return solution.scenario if solution.verdict is Verdict.CONSISTENT else None


def _decided(network: Network, tally: _Tally, scenario: bool) -> tuple[Verdict, str, Network | None, bool]:
    try:
        states, complete = closed_states(network, tally.deadline, tally.progress, traced=True)
        if any(state.emptied is not None for state in states):
            return Verdict.INCONSISTENT, "", None, True
        if not complete:
            raise _OutOfTime
        for state in states:
            if not _refine(state, _fewest_pieces(state.calculus), tally):
                return Verdict.INCONSISTENT, "", None, False
        if scenario:
            for state in states:
                _refine(state, _next_atoms, tally)
        found = atomic_network(network, states) if scenario else None
    except _OutOfTime:
        return Verdict.UNDECIDED, "the time limit was reached", None, False
    if not network.calculus.decided_by_closure:
        name = network.calculus.name
        return Verdict.UNDECIDED, f"closure found no contradiction, and in {name} that proves nothing", found, False
    return Verdict.CONSISTENT, "", found, False


def _refine(state: State, pick: Pick, tally: _Tally) -> bool:
    """Chooses until nothing is left to pick; False where every way leads to a contradiction."""
    stack: list[tuple[int, int, Iterator[int], int]] = []
    while True:
        found = pick(state)
        if found is None:
            return True
        stack.append((found[0], found[1], iter(found[2]), state.mark))
        if not _next_choice(state, stack, tally):
            return False


def _next_choice(state: State, stack: list[tuple[int, int, Iterator[int], int]], tally: _Tally) -> bool:
    """Makes the next choice that closure lets stand, going back where none is left; False where none is at all."""
    while stack:
        first, second, pieces, mark = stack[-1]
        for piece in pieces:
            tally.choices += 1
            state.assign(first, second, piece)
            if not state.close(tally.deadline, tally.progress):
                raise _OutOfTime
            if state.emptied is None:
                return True
            tally.dead_ends += 1
            state.undo(mark)
            _check_clock(tally)
        stack.pop()
        if stack:
            state.undo(stack[-1][3])
    return False


def _check_clock(tally: _Tally) -> None:
    if tally.deadline is not None and time.monotonic() > tally.deadline:
        raise _OutOfTime


def _fewest_pieces(calculus: Calculus) -> Pick:
    """Picks the pair with the fewest tractable pieces among those with several; atoms where no subclass decides."""
    known: dict[int, tuple[int, ...]] = {}

    def pieces(relation: int) -> tuple[int, ...]:
        if relation not in known:
            known[relation] = calculus.pieces(relation) if calculus.decided_by_closure else atoms_of(relation)
        return known[relation]

    def pick(state: State) -> Open | None:
        relations, ids = state.distinct()
        counts = np.array([len(pieces(relation)) for relation in relations])
        choices = np.triu(counts[ids], 1)
        several = choices > 1
        if not several.any():
            return None
        position = int(np.where(several, choices, np.iinfo(np.int64).max).argmin())
        first, second = divmod(position, state.size)
        return first, second, pieces(relations[ids[first, second]])

    return pick


def _next_atoms(state: State) -> Open | None:
    position = state.next_open(0)
    if position == state.size**2:
        return None
    first, second = divmod(position, state.size)
    return first, second, atoms_of(state.relation(first, second))


def atoms_of(relation: int) -> tuple[int, ...]:
    """The atoms of a relation, each as a relation.

    >>> atoms_of(0b101)
    (1, 4)
    """
    return tuple(1 << code for code in bits(relation))


def atomic_network(network: Network, states: tuple[State, ...]) -> Network:
    """The network of what the states of its axes say of every pair i < j."""
    pairs = ((i, j) for i in range(network.size) for j in range(i + 1, network.size))
    return network.only(Constraint(i, j, whole_relation(network.calculus, states, i, j)) for i, j in pairs)
