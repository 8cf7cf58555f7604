"""Derive the relation of a pair: a tree of steps down to the stated constraints.

The constraints on which the pair rests are thinned out until each is needed; these few are then closed in rounds, so
that each relation is derived by as few nested compositions as possible.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.errors import NetworkError
from deixis.reasoning.qualitative.networks.closure.algebraic import close, traced_closure, whole_relation
from deixis.reasoning.qualitative.networks.closure.rounds import PairRelation, Rounds, Step
from deixis.reasoning.qualitative.networks.conflict import Core, refuting, resting
from deixis.reasoning.qualitative.networks.network import Constraint, Network

FEW = 40  # maximum number of things for which the shortest derivation is searched first


def explain(network: Network, first: int, second: int, deadline: Deadline = Deadline.never()) -> Step | None:
    """Return the derivation of a pair's closed relation; None if that is universal, or time ran out.

    Parameters
    ----------
    network
        The stated constraints.
    first, second
        The numbers of the two things.
    deadline
        When to stop.

    Returns
    -------
    The last step of the derivation, with its premises. None also if the network is inconsistent: see
    :func:`contradiction`.

    Raises
    ------
    NetworkError
        If one of the two things is not in the network.
    """
    require_pair(network, first, second)
    small, things = network.compact()
    if first not in things or second not in things:
        return None
    i, j = (int(np.searchsorted(things, thing)) for thing in (first, second))
    closure = close(small, deadline)
    if not closure.complete or not closure.consistent:
        return None
    step = derive(small, i, j, closure.relation(i, j), deadline)
    return None if step is None else _renumbered(step, things.tolist())


def derive(network: Network, first: int, second: int, goal: int, deadline: Deadline = Deadline.never()) -> Step | None:
    r"""Return the shortest derivation found of a relation within ``goal``; None if closure does not give one.

    Parameters
    ----------
    network
        The stated constraints.
    first, second
        The numbers of the two things.
    goal
        A relation as a set of atoms; the derived one must be within it.
    deadline
        When to stop.

    Returns
    -------
    The last step of the derivation, with its premises; None also if time ran out.

    Raises
    ------
    NetworkError
        If one of the two things is not in the network.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> from deixis.reasoning.qualitative.networks.network import Constraint
    >>> from deixis.reasoning.qualitative.networks.closure.rounds import step_lines
    >>> point = calculus("point")
    >>> before = point.relation(["<"])
    >>> network = Network(point, 3, (Constraint(0, 1, before), Constraint(1, 2, before)), ("a", "b", "c"))
    >>> print("\n".join(step_lines(derive(network, 0, 2, before), network)))
    a ( < ) c   composed
        a ( < ) b   stated
        b ( < ) c   stated
    """
    require_pair(network, first, second)
    if first == second or not network.calculus.universal & ~goal:
        return None

    def narrow(stated: Sequence[Constraint]) -> Core | None:
        return _supporting(network.only(stated), first, second, goal, deadline)

    core = narrow(network.constraints)
    if core is None:
        return None
    nearest = _in_rounds(network, first, second, goal, deadline) if network.size <= FEW else None
    if nearest is not None:
        pairs = {frozenset((claim.first, claim.second)) for claim in nearest.stated()}
        core = tuple(c for c in network.constraints if frozenset((c.first, c.second)) in pairs)
    needed = minimal_subset(core, narrow, deadline, keep_last=True).items
    return _in_rounds(network.only(needed), first, second, goal, deadline)


def _in_rounds(network: Network, first: int, second: int, goal: int, deadline: Deadline) -> Step | None:
    """Return the derivation found by closing breadth first; of any pair's empty relation if ``first`` is -1."""
    small, things = network.compact()
    place = {int(thing): k for k, thing in enumerate(things)} | {-1: -1}
    found = Rounds(small).derive(place[first], place[second], goal, deadline)
    return None if found is None else _renumbered(found, things.tolist())


def contradiction(network: Network, deadline: Deadline = Deadline.never()) -> Step | None:
    """Return the derivation of the empty relation from constraints that closure refutes; best given a minimal conflict.

    Parameters
    ----------
    network
        The network; only small ones are practical.
    deadline
        End of the time limit.

    Returns
    -------
    Step or None
        The last step with its premises; None if closure finds no contradiction, or not in time.
    """
    if refuting(network, deadline) is None:
        return None
    return _in_rounds(network, -1, -1, 0, deadline)


def require_pair(network: Network, first: int, second: int) -> None:
    """Raise NetworkError if one of two things is not in the network.

    Parameters
    ----------
    network
        The network.
    first, second
        Numbers of two things.

    Raises
    ------
    NetworkError
        A number is below 0, or not below the size of the network.
    """
    for thing in (first, second):
        if not 0 <= thing < network.size:
            raise NetworkError(f"there is no object {thing}; the objects of the network are 0 to {network.size - 1}")


def _supporting(network: Network, first: int, second: int, goal: int, deadline: Deadline) -> Core | None:
    """Return constraints whose closure is within ``goal`` for a pair, read off its trail; None if it is not."""
    small, things = network.compact() if network.constraints else (network, np.zeros(0, dtype=np.int64))
    if first not in things or second not in things:
        return None
    i, j = (int(np.searchsorted(things, thing)) for thing in (first, second))
    states, complete = traced_closure(small, deadline)
    emptied = next((state for state in states if state.emptied is not None), None)
    if emptied is not None and emptied.emptied is not None:
        reached = set(emptied.emptied) == {i, j}
        return resting(network, small, emptied, i, j) if reached else None
    if not complete or whole_relation(network.calculus, states, i, j) & ~goal:
        return None
    rests = {id(c) for state in states for c in resting(network, small, state, i, j)}
    return tuple(c for c in network.constraints if id(c) in rests)


def _renumbered(step: Step, things: list[int]) -> Step:
    claim = PairRelation(things[step.claim.first], things[step.claim.second], step.claim.relation)
    return replace(step, claim=claim, premises=tuple(_renumbered(premise, things) for premise in step.premises))
