"""Why a network is inconsistent: constraints that cannot all hold, none of them dispensable.

What a failed closure rests on is read off its trail; then constraints are left out as long as the rest is inconsistent.
Closure does this fast, and where it does not decide, search goes on with what it left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.errors import LimitError
from deixis.reasoning.qualitative.networks.closure import close, closed_states
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search import Verdict, decider, solve
from deixis.reasoning.qualitative.networks.state import NetworkState

Core = tuple[Constraint, ...]


@dataclass(frozen=True)
class NetworkConflict:
    """Constraints that cannot all hold.

    ``minimal`` says that after leaving out any one of them no contradiction is left; it is False where time ran out
    before that was seen. Where the calculus does not decide (``decided_by_closure`` is False), none is left to find.
    """

    constraints: Core
    minimal: bool


def minimal_conflict(
    network: Network, deadline: Deadline = Deadline.never(), inconsistent: bool = False
) -> NetworkConflict | None:
    """A deletion-minimal set of inconsistent constraints; None where none was found in time.

    ``inconsistent`` says that the whole is known to be so: there is a conflict then, however little time there is.

    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> point = calculus("point")
    >>> before = point.relation(["<"])
    >>> stated = [(0, 1), (1, 2), (3, 2), (2, 0)]
    >>> found = minimal_conflict(Network(point, 4, tuple(Constraint(i, j, before) for i, j in stated)))
    >>> [(c.first, c.second) for c in found.constraints], found.minimal
    ([(0, 1), (1, 2), (2, 0)], True)
    """

    def by_closure(stated: Sequence[Constraint]) -> Core | None:
        return refuting(network.only(stated), deadline)

    def by_search(stated: Sequence[Constraint]) -> Core | None:
        return _searched(network.only(stated), deadline)

    core = by_closure(network.constraints)
    if core is not None:
        found = minimal_subset(core, by_closure, deadline, keep_last=True)
        core = found.items
        if closure_decides(network.only(core)):
            return NetworkConflict(core, found.proved)
    else:
        core = network.constraints if inconsistent else by_search(network.constraints)
    if core is None:
        return None
    try:
        found = minimal_subset(core, by_search, deadline, keep_last=True)
        return NetworkConflict(found.items, found.proved)
    except LimitError:  # too long a search
        return NetworkConflict(core, False)


def closure_decides(network: Network) -> bool:
    """Whether closure alone tells if these constraints, and any part of them, are consistent."""
    chosen = network.calculus
    if decider(chosen) is not None or not chosen.decided_by_closure:
        return False
    if any(axis.tractable is None for axis in chosen.factors):  # only networks of atoms, and these say all of all pairs
        return False
    return all(len(chosen.pieces(relation)) <= 1 for relation in network.arrays.relations)


def refuting(network: Network, deadline: Deadline) -> Core | None:
    """The constraints on which a failed closure rests, in their order; None where closure does not fail in time."""
    network = network.only(without_leaves(network))
    if not network.constraints:
        return None
    small, _ = network.compact()
    try:
        states, _ = closed_states(small, deadline, traced=True)
    except LimitError:  # too long a trail: no support, and all are suspected
        return network.constraints if close(small, deadline).emptied is not None else None
    for state in states:
        if state.emptied is not None:
            return resting(network, small, state, *state.emptied)
    return None


def without_leaves(network: Network) -> Core:
    """The constraints without those that lead to dead ends, as those of a tree all do.

    A thing that a single, satisfiable constraint is about can be placed whatever the others do.
    """
    about: dict[int, set[int]] = {}
    for position, c in enumerate(network.constraints):
        for thing in (c.first, c.second):
            about.setdefault(thing, set()).add(position)
    loose = [thing for thing, positions in about.items() if len(positions) == 1]
    gone: set[int] = set()
    while loose:
        for position in tuple(about[loose.pop()]):
            c = network.constraints[position]
            if c.relation and c.first != c.second:
                gone.add(position)
                for thing in (c.first, c.second):
                    about[thing].discard(position)
                    if len(about[thing]) == 1:
                        loose.append(thing)
    return tuple(c for position, c in enumerate(network.constraints) if position not in gone)


def resting(network: Network, small: Network, state: NetworkState, first: int, second: int) -> Core:
    """The constraints of ``network`` (``small`` is its compact form) on which a pair's relation in a state rests."""
    needed = state.support(first, second)
    firsts, seconds = small.arrays.firsts, small.arrays.seconds
    chosen = needed[np.minimum(firsts, seconds), np.maximum(firsts, seconds)]
    return tuple(network.constraints[k] for k in np.flatnonzero(chosen))


def _searched(network: Network, deadline: Deadline) -> Core | None:
    if not network.constraints or deadline.passed:
        return None
    small, _ = network.compact()
    return network.constraints if solve(small, deadline).verdict is Verdict.INCONSISTENT else None
