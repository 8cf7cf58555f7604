"""Close several calculi over the same things together: each narrows the others (Wölfl and Westphal 2009).

Each network is closed in its own calculus; bridges carry the relations over to the other calculi, both ways; this
repeats until nothing changes. A contradiction of the whole is a proof, even if each network alone has none. Finding no
contradiction proves nothing, unless only one calculus has constraints: a realisation of these also realises the others.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.errors import NetworkError
from deixis.reasoning.qualitative.calculi.bridges import Link, links_between
from deixis.reasoning.qualitative.networks.closure.state import NetworkState, Progress
from deixis.reasoning.qualitative.networks.network import Constraint, Network, compacted
from deixis.reasoning.qualitative.networks.realisation.boxes import find_boxes, rectangles, unrelated
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve


@dataclass(frozen=True)
class Contribution:
    """The pairs narrowed and atoms removed (i < j) by one calculus (its name) or one bridge (``a -> b``)."""

    name: str
    pairs: int
    atoms: int


@dataclass(frozen=True, eq=False)
class JointClosure:
    """Networks over the same things, closed together as far as ``complete`` says.

    ``emptied`` is the calculus and the pair whose relation became empty.
    """

    networks: tuple[Network, ...]
    states: tuple[NetworkState, ...]
    emptied: tuple[str, int, int] | None
    complete: bool
    contributions: tuple[Contribution, ...]
    seconds: float

    @property
    def consistent(self) -> bool:
        """True if no contradiction was found."""
        return self.emptied is None

    def relation(self, calculus: str, first: int, second: int) -> int:
        """Return the relation of two things in one calculus.

        Parameters
        ----------
        calculus
            Name of the calculus.
        first, second
            Numbers of two things.

        Returns
        -------
        int
            Relation of ``first`` to ``second``, as a bit mask.

        Raises
        ------
        NetworkError
            No network is in this calculus.
        """
        for network, state in zip(self.networks, self.states, strict=True):
            if network.calculus.name == calculus:
                return state.relation(first, second)
        raise NetworkError(f"no network here is in {calculus}; there are {_names(self.networks)}")


def close_jointly(
    networks: Sequence[Network],
    bridges: Sequence[Link],
    deadline: Deadline = Deadline.never(),
    progress: Progress | None = None,
) -> JointClosure:
    """Return the joint fixpoint of closing each network and crossing each bridge.

    Parameters
    ----------
    networks
        Networks over the same things, each in its own calculus.
    bridges
        Bridges between these calculi.
    deadline
        When to stop; ``complete`` of the result is False if it came first.
    progress
        Called while networks are closed.

    Returns
    -------
    The closed networks, with the contribution of each calculus and bridge.

    Raises
    ------
    NetworkError
        If the networks are not over the same things, or if two share a calculus.
    """
    started = time.perf_counter()
    if len({network.size for network in networks}) > 1:
        raise NetworkError("networks closed together must be over the same things")
    if len({network.calculus.name for network in networks}) < len(networks):
        raise NetworkError(f"networks closed together must each have a calculus of their own, got {_names(networks)}")
    states = tuple(NetworkState(network.calculus, network.size) for network in networks)
    place = {network.calculus.name: k for k, network in enumerate(networks)}
    done = _Ledger()
    for network, state in zip(networks, states, strict=True):
        state.add(network)
    steps: list[tuple[str, NetworkState, Propagator]] = [
        (network.calculus.name, state, state.close) for network, state in zip(networks, states, strict=True)
    ]
    for bridge in bridges:
        if {bridge.source.name, bridge.target.name} <= set(place):
            source, target = states[place[bridge.source.name]], states[place[bridge.target.name]]
            there = f"{bridge.source.name} -> {bridge.target.name}"
            back = f"{bridge.target.name} -> {bridge.source.name}"
            steps.append((there, target, _crossing(source, target, bridge.forward)))
            steps.append((back, source, _crossing(target, source, bridge.backward)))
    complete, changed = True, True
    while changed and complete:
        changed = False
        for name, state, step in steps:
            if any(each.emptied is not None for each in states):
                break
            before = state.relations()
            complete = step(deadline, progress) and complete
            changed = done.note(name, before, state.relations()) or changed
            if not complete:
                break
    emptied = next(
        ((n.calculus.name, *s.emptied) for n, s in zip(networks, states, strict=True) if s.emptied is not None), None
    )
    seconds = time.perf_counter() - started
    return JointClosure(
        tuple(networks), states, emptied, complete or emptied is not None, done.contributions(), seconds
    )


Propagator = Callable[[Deadline, Progress | None], bool]
"""Function that narrows one state until a deadline, and returns True if it finished in time."""


def _crossing(source: NetworkState, target: NetworkState, translate: Callable[[int], int]) -> Propagator:
    known: dict[int, int] = {}

    def cross(deadline: Deadline, progress: Progress | None) -> bool:
        relations, ids = source.distinct()
        for relation in relations:
            known.setdefault(relation, translate(relation))
        masks = tuple(known[relation] for relation in relations)
        telling = np.array([mask != target.calculus.universal for mask in masks])
        firsts, seconds = np.nonzero(np.triu(telling[ids], 1))
        target.restrict(firsts, seconds, ids[firsts, seconds], masks)
        return not deadline.passed

    return cross


class _Ledger:
    """A record of the pairs and atoms that each calculus and bridge narrowed."""

    def __init__(self) -> None:
        self._sums: dict[str, tuple[int, int]] = {}

    def note(self, name: str, before: NDArray[np.uint64], after: NDArray[np.uint64]) -> bool:
        gone = before & ~after
        atoms = int(np.bitwise_count(gone).sum()) // 2
        pairs = int(gone.any(axis=2).sum()) // 2
        old = self._sums.get(name, (0, 0))
        self._sums[name] = old[0] + pairs, old[1] + atoms
        return bool(gone.any())

    def contributions(self) -> tuple[Contribution, ...]:
        return tuple(Contribution(name, pairs, atoms) for name, (pairs, atoms) in self._sums.items())


@dataclass(frozen=True, eq=False)
class JointSolution:
    """The verdict on several networks together, with the closure that it rests on.

    ``boxes`` satisfy all networks, shape (n, 2, 2), minimum and maximum corner, if the search ran and found them;
    distances are in units of the reference length. ``reason`` says why the verdict is undecided, or why there are no
    boxes although they were requested.
    """

    verdict: Verdict
    closure: JointClosure
    reason: str = ""
    boxes: NDArray[np.float64] | None = None


def solve_jointly(
    networks: Sequence[Network],
    bridges: Sequence[Link],
    deadline: Deadline = Deadline.never(),
    progress: Progress | None = None,
    scenario: bool = False,
) -> JointSolution:
    """Decide several networks together, or one that closure does not decide.

    Closure refutes, and so does solving the implied constraints on boxes; boxes that satisfy everything prove
    consistency.

    Parameters
    ----------
    networks
        Networks over the same things, each in its own calculus.
    bridges
        What joins the calculi.
    deadline
        When to stop.
    progress
        Called while networks are closed.
    scenario
        Whether to look for boxes also where the verdict does not need them.

    Returns
    -------
    JointSolution
        The verdict, with the closure, and boxes or the reason why there are none.

    Raises
    ------
    NetworkError
        The networks are over different things, or two are in one calculus.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.bridges import links_between
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> cd, distance = calculus("cd"), calculus("distance")
    >>> north = Network(cd, 2, (Constraint(0, 1, cd.relation(["N"])),))
    >>> far = Network(distance, 2, (Constraint(0, 1, distance.relation(["far"])),))
    >>> solution = solve_jointly([north, far], links_between([cd, distance]))
    >>> str(solution.verdict), bool((solution.boxes[0] - solution.boxes[1])[:, 1].mean() > 3)
    ('consistent', True)
    """
    closure = close_jointly(networks, bridges, deadline, progress)
    if closure.emptied is not None:
        return JointSolution(Verdict.INCONSISTENT, closure)
    if not closure.complete:
        return JointSolution(Verdict.UNDECIDED, closure, "the time limit was reached")
    speaking = [network for network in networks if network.constraints]
    consistent = not speaking
    for network in speaking:
        solution = solve(network, deadline, progress)
        if solution.verdict is Verdict.INCONSISTENT:
            return JointSolution(solution.verdict, closure)
        consistent = len(speaking) == 1 and solution.verdict is Verdict.CONSISTENT
    if consistent and not scenario:
        return JointSolution(Verdict.CONSISTENT, closure)
    found = find_boxes(networks, closure.relation, deadline)
    if consistent or found.boxes is not None:
        return JointSolution(Verdict.CONSISTENT, closure, found.reason, found.boxes)
    if found.impossible and _boxes_refute(closure, bridges, deadline):
        return JointSolution(Verdict.INCONSISTENT, closure)
    others = "; regions of other shapes may" if found.impossible else ""
    reason = f"no contradiction was found in {_names(networks)}, which proves nothing: {found.reason}{others}"
    return JointSolution(Verdict.UNDECIDED, closure, reason)


def _boxes_refute(closure: JointClosure, bridges: Sequence[Link], deadline: Deadline) -> bool:
    """Return True if no boxes satisfy a closure, even with regions of any shape inside them.

    The closed relations of the rectangle algebra include what the regions imply about their bounding boxes. The test
    does not apply where the bridges keep apart calculi that boxes would connect.
    """
    calculi = [network.calculus for network in closure.networks]
    joined = {(bridge.source.name, bridge.target.name) for bridge in bridges}
    if unrelated(closure.networks) or {(b.source.name, b.target.name) for b in links_between(calculi)} - joined:
        return False
    left = rectangles(closure.networks, closure.relation, without="rcc8")
    return solve(left, deadline).verdict is Verdict.INCONSISTENT


@dataclass(frozen=True)
class JointConflict:
    """Constraints, each with the name of its calculus, that cannot all hold.

    ``minimal`` says that leaving out any one of them removes every contradiction that can be found.
    """

    constraints: tuple[tuple[str, Constraint], ...]
    minimal: bool


def joint_conflict(
    networks: Sequence[Network], bridges: Sequence[Link], deadline: Deadline = Deadline.never()
) -> JointConflict | None:
    """Return a deletion-minimal set of constraints that joint closure refutes; None if it refutes none in time.

    If closure refutes nothing, return a set that solving shows no boxes to satisfy.

    Parameters
    ----------
    networks
        Networks over the same things, each in its own calculus.
    bridges
        What joins the calculi.
    deadline
        End of the time limit.

    Returns
    -------
    JointConflict or None
        The constraints, and whether the set is known to be minimal; None where no contradiction was found.

    Raises
    ------
    NetworkError
        The networks are over different things, or two are in one calculus.
    """
    stated = [(n.calculus.name, c) for n in networks for c in n.constraints]

    def refuted(kept: list[tuple[str, Constraint]], solving: bool) -> list[tuple[str, Constraint]] | None:
        if not kept:
            return None
        chosen, _ = compacted([n.only(c for name, c in kept if name == n.calculus.name) for n in networks])
        closure = close_jointly(chosen, bridges, deadline)
        if closure.emptied is None and not (solving and _boxes_refute(closure, bridges, deadline)):
            return None
        return kept

    for solving in (False, True):
        if refuted(stated, solving) is not None:
            found = minimal_subset(stated, partial(refuted, solving=solving), deadline, keep_last=True)
            return JointConflict(found.items, found.proved)
    return None


def _names(networks: Sequence[Network]) -> str:
    return ", ".join(network.calculus.name for network in networks)
