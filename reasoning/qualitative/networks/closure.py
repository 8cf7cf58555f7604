"""Algebraic closure (path consistency): every relation is narrowed to what every third thing admits (Allen 1983).

    R(i, j) := R(i, j) and R(i, k) composed with R(k, j), for all i, j, k until nothing changes

A closed network with an empty relation is inconsistent. The converse needs a tractable subclass: what closure decides
is in :mod:`deixis.reasoning.qualitative.networks.search`.
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
from deixis.reasoning.qualitative.networks.network import Network, on_axes
from deixis.reasoning.qualitative.networks.state import NetworkState, Progress


@dataclass(frozen=True, eq=False)
class Closure:
    """A network, closed as far as ``complete`` says.

    ``parts`` are the relations as arrays (n, n, words of 64 atoms), row to column: one for the whole calculus, or one
    for each axis of a product calculus where every relation is a product. ``emptied`` is the pair of which nothing is
    left, and then the other relations are as they were at that moment.
    """

    network: Network
    parts: tuple[NDArray[np.uint64], ...]
    emptied: tuple[int, int] | None
    complete: bool
    narrowed: int  # pairs i < j of which closure took an atom that was stated as possible
    passes: int  # changes of pairs that were passed on
    seconds: float

    @property
    def consistent(self) -> bool:
        """Whether no contradiction was found; that none exists, only a tractable subclass or a search can tell."""
        return self.emptied is None

    def known_pairs(self) -> NDArray[np.int64]:
        """Return the pairs i < j, (m, 2), of which something is known."""
        calculus = self.network.calculus
        axes = calculus.axes if isinstance(calculus, ProductCalculus) and len(self.parts) > 1 else (calculus,)
        everything = [words_of((axis.universal,), len(axis.atoms))[0] for axis in axes]
        known = [(part != full).any(axis=2) for part, full in zip(self.parts, everything, strict=True)]
        return np.argwhere(np.triu(np.logical_or.reduce(known), 1))

    def relation(self, first: int, second: int) -> int:
        """Return the relation of two things as a set of atoms."""
        relations = [relation_of(part[first, second]) for part in self.parts]
        return relations[0] if len(relations) == 1 else of_axes(self.network.calculus, relations)


def close(
    network: Network, deadline: Deadline = Deadline.never(), progress: Progress | None = None, joint: bool = False
) -> Closure:
    """Return the algebraic closure of a network, until ``deadline``.

    Products close axis by axis; ``joint`` closes the whole calculus at once all the same. Raises LimitError where the
    network would not fit in memory.

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
    """The states of a network's axes, or of the whole, with what is stated and before anything follows from it."""
    axes = None if joint else on_axes(network)
    parts = (network,) if axes is None else axes
    states = tuple(NetworkState(part.calculus, part.size, traced) for part in parts)
    for part, state in zip(parts, states, strict=True):
        state.add(part)
    return states


def closed_states(
    network: Network, deadline: Deadline = Deadline.never(), progress: Progress | None = None, traced: bool = False
) -> tuple[tuple[NetworkState, ...], bool]:
    """The states of a network's axes, or of the whole, closed up to the first contradiction; and whether in time."""
    states = opened_states(network, traced=traced)
    return states, close_states(states, deadline, progress)


def close_states(states: Sequence[NetworkState], deadline: Deadline, progress: Progress | None) -> bool:
    """Close states one after the other, up to the first contradiction; False where ``deadline`` came first."""
    for state in states:
        if any(each.emptied is not None for each in states):
            return True
        if not state.close(deadline, progress):
            return False
    return True


def whole_relation(calculus: Calculus, states: Sequence[NetworkState], first: int, second: int) -> int:
    """Return the relation of two things from the states of the axes, or of the whole."""
    relations = [state.relation(first, second) for state in states]
    return relations[0] if len(relations) == 1 else of_axes(calculus, relations)


def of_axes(calculus: Calculus, relations: Sequence[int]) -> int:
    """Return the product of the relations on the axes; the relation itself where there is one axis."""
    return calculus.of_axes(relations) if isinstance(calculus, ProductCalculus) else relations[0]
