"""Find minimal conflicts: constraints that cannot all hold, each of them needed for the contradiction.

The trail of a failed closure shows the constraints that it rests on; then constraints are left out as long as the rest
is inconsistent. Closure does this fast; where it does not decide, the search continues from its result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.errors import LimitError
from deixis.reasoning.qualitative.networks.closure.algebraic import close, traced_closure
from deixis.reasoning.qualitative.networks.closure.state import NetworkState
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, decider, solve

Core = tuple[Constraint, ...]


@dataclass(frozen=True)
class NetworkConflict:
    """Constraints that cannot all hold.

    ``minimal`` says that leaving out any one of them removes the contradiction; it is False if time ran out before that
    was shown. In a calculus that closure does not decide (``decided_by_closure`` is False), it means that no
    contradiction is found without it.
    """

    constraints: Core
    minimal: bool


def minimal_conflict(
    network: Network, deadline: Deadline = Deadline.never(), inconsistent: bool = False
) -> NetworkConflict | None:
    """Return a deletion-minimal set of inconsistent constraints; None if none was found in time.

    Parameters
    ----------
    network
        The network with the conflict.
    deadline
        When to stop; the conflict found so far is then returned with ``minimal`` False.
    inconsistent
        True if the whole network is known to be inconsistent: the result is then a conflict, however short the time.

    Returns
    -------
    The conflict, or None.

    Examples
    --------
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
    except LimitError:  # the search takes too long
        return NetworkConflict(core, False)


def closure_decides(network: Network) -> bool:
    """Return True if closure alone decides the consistency of these constraints and of every subset of them.

    Parameters
    ----------
    network
        The network.

    Returns
    -------
    bool
        False where closure may miss a contradiction.
    """
    chosen = network.calculus
    if decider(chosen) is not None or not chosen.decided_by_closure:
        return False
    if any(axis.tractable is None for axis in chosen.factors):  # only networks that state an atom for every pair
        return False
    return all(len(chosen.pieces(relation)) <= 1 for relation in network.arrays.relations)


def refuting(network: Network, deadline: Deadline) -> Core | None:
    """Return the constraints on which a failed closure rests, in their order; None if closure does not fail in time.

    Parameters
    ----------
    network
        The network.
    deadline
        End of the time limit.

    Returns
    -------
    tuple of Constraint or None
        The constraints, not always a minimal set, or None.
    """
    network = network.only(without_leaves(network))
    if not network.constraints:
        return None
    small, _ = network.compact()
    try:
        states, _ = traced_closure(small, deadline)
    except LimitError:  # the trail is too long to keep: no support is known, so suspect all constraints
        return network.constraints if close(small, deadline).emptied is not None else None
    for state in states:
        if state.emptied is not None:
            return resting(network, small, state, *state.emptied)
    return None


def without_leaves(network: Network) -> Core:
    """Return the constraints that remain when constraints to dead ends are removed, such as all constraints of a tree.

    A thing with a single, satisfiable constraint can be placed wherever the others are.

    Parameters
    ----------
    network
        The network.

    Returns
    -------
    tuple of Constraint
        Constraints that may contradict each other; none for a satisfiable tree.
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
    """Return the constraints that a pair's relation rests on.

    Parameters
    ----------
    network
        The network.
    small
        Its compact form, of the things that constraints relate.
    state
        Traced state of ``small`` or of one of its axes.
    first, second
        Numbers of two things in ``small``.

    Returns
    -------
    tuple of Constraint
        Constraints of ``network``, in their order.
    """
    needed = state.support(first, second)
    firsts, seconds = small.arrays.firsts, small.arrays.seconds
    chosen = needed[np.minimum(firsts, seconds), np.maximum(firsts, seconds)]
    return tuple(network.constraints[k] for k in np.flatnonzero(chosen))


def _searched(network: Network, deadline: Deadline) -> Core | None:
    if not network.constraints or deadline.passed:
        return None
    small, _ = network.compact()
    return network.constraints if solve(small, deadline).verdict is Verdict.INCONSISTENT else None
