"""Compute the algebraic closure (path consistency): narrow each relation by every third thing (Allen 1983).

R(i, j) := R(i, j) and R(i, k) composed with R(k, j), for all i, j, k until nothing changes
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus
from deixis.reasoning.qualitative.calculi.words import relation_of, words_of
from deixis.reasoning.qualitative.networks.closure.state import NetworkState, Progress
from deixis.reasoning.qualitative.networks.network import Network, on_axes


@dataclass(frozen=True, eq=False)
class Closure:
    """The closure of a network, as far as ``complete`` says.

    ``parts`` are the relations as arrays (n, n, words of 64 atoms), row to column: one for the whole calculus, or one
    for each axis of a product calculus where every relation is a product. ``emptied`` is the pair whose relation became
    empty; the other relations are then as they were at that moment.
    """

    network: Network
    parts: tuple[NDArray[np.uint64], ...]
    emptied: tuple[int, int] | None
    complete: bool
    narrowed: int  # pairs i < j from which closure removed a stated atom
    passes: int  # changes of pairs that were propagated
    seconds: float

    @property
    def consistent(self) -> bool:
        """True if no contradiction was found; only a tractable subclass or a search can prove that none exists."""
        return self.emptied is None

    def known_pairs(self) -> NDArray[np.int64]:
        """Return the pairs i < j whose relation is not universal.

        Returns
        -------
        ndarray
            Numbers of the things, shape (m, 2).
        """
        calculus = self.network.calculus
        axes = calculus.axes if isinstance(calculus, ProductCalculus) and len(self.parts) > 1 else (calculus,)
        everything = [words_of((axis.universal,), len(axis.atoms))[0] for axis in axes]
        known = [(part != full).any(axis=2) for part, full in zip(self.parts, everything, strict=True)]
        return np.argwhere(np.triu(np.logical_or.reduce(known), 1))

    def relation(self, first: int, second: int) -> int:
        """Return the relation of two things after closure.

        Parameters
        ----------
        first, second
            Numbers of two things.

        Returns
        -------
        int
            Relation of ``first`` to ``second``, as a bit mask.
        """
        relations = [relation_of(part[first, second]) for part in self.parts]
        return relations[0] if len(relations) == 1 else of_axes(self.network.calculus, relations)


def close(
    network: Network, deadline: Deadline = Deadline.never(), progress: Progress | None = None, joint: bool = False
) -> Closure:
    """Return the algebraic closure of a network, computed until ``deadline``.

    Parameters
    ----------
    network
        The network to close.
    deadline
        When to stop; ``complete`` of the result is False if it came first.
    progress
        Called now and then with the pairs propagated, and the pairs due so far.
    joint
        True to close a product calculus as a whole instead of axis by axis.

    Returns
    -------
    The closed network. An empty relation ends closure and proves the network inconsistent.

    Raises
    ------
    LimitError
        If the network would not fit in memory.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> from deixis.reasoning.qualitative.networks.network import Constraint
    >>> point = calculus("point")
    >>> before = point.relation(["<"])
    >>> closed = close(Network(point, 3, (Constraint(0, 1, before), Constraint(1, 2, before))))
    >>> closed.consistent, point.members(closed.relation(2, 0))
    (True, ('>',))
    """
    started = time.perf_counter()
    states = opened_states(network, joint)
    before = [state.relations() for state in states]
    complete = close_states(states, deadline, progress)
    parts = tuple(state.relations() for state in states)
    changed = [(old != new).any(axis=2) for old, new in zip(before, parts, strict=True)]
    return Closure(
        network,
        parts,
        next((state.emptied for state in states if state.emptied is not None), None),
        complete,
        int(np.triu(np.logical_or.reduce(changed), 1).sum()),
        sum(state.passes for state in states),
        time.perf_counter() - started,
    )


def opened_states(network: Network, joint: bool = False, traced: bool = False) -> tuple[NetworkState, ...]:
    """Return the states of a network's axes, or of the whole, with the stated constraints, not yet propagated.

    Parameters
    ----------
    network
        The network.
    joint
        Whether to keep a product calculus whole, also where its axes are independent.
    traced
        Whether to record the changes, for explanations.

    Returns
    -------
    tuple of NetworkState
        One state for each axis, or one for the whole.
    """
    axes = None if joint else on_axes(network)
    parts = (network,) if axes is None else axes
    states = tuple(NetworkState(part.calculus, part.size, traced) for part in parts)
    for part, state in zip(parts, states, strict=True):
        state.add(part)
    return states


def traced_closure(network: Network, deadline: Deadline) -> tuple[tuple[NetworkState, ...], bool]:
    """Return the states of the axes, or of the whole, closed with a record of the changes; False if out of time.

    Closing ends at the first contradiction. The record is needed for explanations.

    Parameters
    ----------
    network
        The network.
    deadline
        End of the time limit.

    Returns
    -------
    tuple
        The states, and whether closing was completed.
    """
    states = opened_states(network, traced=True)
    return states, close_states(states, deadline, progress=None)


def close_states(states: Sequence[NetworkState], deadline: Deadline, progress: Progress | None) -> bool:
    """Close states in turn, up to the first contradiction; return False if the deadline came first.

    Parameters
    ----------
    states
        States of the axes, which are changed in place.
    deadline
        End of the time limit.
    progress
        Function that is called with the number of propagated changes and the number with the waiting ones.

    Returns
    -------
    bool
        False if out of time.
    """
    for state in states:
        if any(each.emptied is not None for each in states):
            return True
        if not state.close(deadline, progress):
            return False
    return True


def whole_relation(calculus: Calculus, states: Sequence[NetworkState], first: int, second: int) -> int:
    """Return the relation of two things from the states of the axes, or of the whole.

    Parameters
    ----------
    calculus
        Calculus of the network.
    states
        States of its axes, or one of the whole.
    first, second
        Numbers of two things.

    Returns
    -------
    int
        Relation in ``calculus``, as a bit mask.
    """
    relations = [state.relation(first, second) for state in states]
    return relations[0] if len(relations) == 1 else of_axes(calculus, relations)


def of_axes(calculus: Calculus, relations: Sequence[int]) -> int:
    """Return the product of the relations on the axes; the relation itself if there is one axis.

    Parameters
    ----------
    calculus
        A calculus.
    relations
        Relation on each axis, as bit masks.

    Returns
    -------
    int
        Relation in ``calculus``, as a bit mask.
    """
    return calculus.of_axes(relations) if isinstance(calculus, ProductCalculus) else relations[0]
