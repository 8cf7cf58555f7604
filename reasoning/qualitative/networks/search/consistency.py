"""Decide consistency: by closure where it decides, otherwise by a conflict-driven search over tractable relations.

A closed network of a tractable subclass is consistent. Where other relations are stated, the search of
:mod:`deixis.reasoning.qualitative.networks.search.conflict_search` chooses tractable relations within them (Ladkin and
Reinefeld 1992; Nebel 1997). Where no such subclass is known, every pair is narrowed to an atom. Where even closed
networks of atoms may be inconsistent (``decided_by_closure`` is False), a contradiction is still a proof, and
everything else undecided.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.bridges import Link
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, TableCalculus
from deixis.reasoning.qualitative.calculi.words import atoms_within
from deixis.reasoning.qualitative.networks.closure.algebraic import close_states, opened_states
from deixis.reasoning.qualitative.networks.closure.state import Progress
from deixis.reasoning.qualitative.networks.closure.tables import is_wide
from deixis.reasoning.qualitative.networks.network import Constraint, Network, on_axes
from deixis.reasoning.qualitative.networks.search.conflict_search import ConflictSearch, Premise, require_room
from deixis.reasoning.qualitative.networks.search.wide_search import WideSearch

Masks = NDArray[np.unsignedinteger[Any]]


class Verdict(StrEnum):
    """The answer to whether all constraints of a network can hold at once."""

    CONSISTENT = "consistent"
    INCONSISTENT = "inconsistent"
    UNDECIDED = "undecided"


@dataclass(frozen=True, eq=False)
class Solution:
    """The verdict on a network, and how it was reached.

    ``scenario`` is the network with one atom for each pair i < j, if it was requested and found; if the calculus leaves
    the verdict undecided, it is closed, and not proved consistent. ``refuted`` says that closure alone found the
    contradiction. ``reason`` says why the verdict is undecided, or why there is no scenario.
    """

    verdict: Verdict
    choices: int
    dead_ends: int
    seconds: float
    scenario: Network | None = None
    refuted: bool = False
    reason: str = ""


OUT_OF_TIME = "the time limit was reached"


def solve(
    network: Network, deadline: Deadline = Deadline.never(), progress: Progress | None = None, scenario: bool = False
) -> Solution:
    """Decide whether a network is consistent, until ``deadline``; also return a scenario if ``scenario`` is True.

    Parameters
    ----------
    network
        The network to decide.
    deadline
        When to stop; the verdict is undecided if it comes first.
    progress
        Called while the network is closed.
    scenario
        True to search for a scenario too: one atom for each pair.

    Returns
    -------
    The verdict, with the scenario if it was requested and found.

    Raises
    ------
    LimitError
        If the network would not fit in memory.

    Examples
    --------
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
    solution = _decided(network, deadline, progress, scenario)
    return replace(solution, seconds=time.perf_counter() - started)


def decider(calculus: Calculus) -> Link | None:
    """Return the bridge to a calculus that decides this one: the ten names are sets of rectangle-algebra atoms.

    Parameters
    ----------
    calculus
        A calculus.

    Returns
    -------
    Link or None
        The bridge; None for every calculus except ``ten``.
    """
    if calculus.name != "ten":
        return None
    from deixis.reasoning.qualitative.calculi.bridges import names_to_boxes

    bridge = names_to_boxes()
    return bridge if bridge.source is calculus else None


def translated(network: Network, bridge: Link) -> Network:
    """Return the same constraints in the calculus across the bridge.

    Parameters
    ----------
    network
        A network in the source calculus of the bridge.
    bridge
        Bridge to another calculus.

    Returns
    -------
    Network
        Network in the target calculus, over the same things.
    """
    constraints = (replace(c, relation=bridge.forward(c.relation)) for c in network.constraints)
    return Network(bridge.target, network.size, tuple(constraints), network.names)


def scenario(network: Network, deadline: Deadline = Deadline.never()) -> Network | None:
    """Return a consistent network of one atom per pair, within the stated relations; None if not found in time.

    Parameters
    ----------
    network
        The network.
    deadline
        End of the time limit.

    Returns
    -------
    Network or None
        The atomic network; None also where the network is inconsistent.
    """
    solution = solve(network, deadline, scenario=True)
    return solution.scenario if solution.verdict is Verdict.CONSISTENT else None


@dataclass(eq=False)
class _Part:
    """Axes of a network that must be decided together: as stated, and as closed so far, (axes, n, n)."""

    axes: tuple[TableCalculus, ...]
    stated: Masks
    closed: Masks
    nogoods: Sequence[Sequence[Premise]] = ()
    is_closed: bool = True
    search: ConflictSearch | None = None

    @property
    def atomic(self) -> bool:
        """True if no tractable relations except atoms are known."""
        return any(axis.tractable is None or not axis.decided_by_closure for axis in self.axes)

    def edges(self, masks: Masks | None = None) -> NDArray[np.int64]:
        """Return the pairs i < k, all of them or those that ``masks`` restricts."""
        upper = np.triu(np.ones(self.stated.shape[1:], dtype=np.bool_), 1)
        if masks is None:
            return np.flatnonzero(np.broadcast_to(upper, self.stated.shape))
        everything = np.array([axis.universal for axis in self.axes], dtype=np.uint64)
        return np.flatnonzero((masks != everything[:, None, None]) & upper)

    def is_decided_by_closure(self) -> bool:
        """Return True if closure has already decided: the remaining relation of every stated pair is tractable."""
        if self.nogoods or not self.is_closed:
            return False
        values = np.unique(self.closed.ravel()[self.edges(None if self.atomic else self.stated)])
        if self.atomic:
            return bool((np.bitwise_count(values) == 1).all())
        return all(len(self.axes[0].pieces(value)) == 1 for value in values.tolist())

    def decide(self, deadline: Deadline) -> bool | None:
        """Decide whether the axes are consistent, as far as their calculi allow; return None if time ran out."""
        if self.is_decided_by_closure():
            return True
        edges = self.edges(None if self.atomic else self.stated)
        self.search = ConflictSearch(
            self.axes, self.closed, edges, self.stated, self.nogoods, atomic=self.atomic, closed=self.is_closed
        )
        return self.search.run(deadline)

    def atoms(self, deadline: Deadline) -> Masks | None:
        """Return one atom for every pair of a consistent part; None if time ran out."""
        found = self.closed if self.search is None else self.search.masks
        if self.atomic:
            return found
        if self.search is not None:
            stated = self.edges(self.stated)
            everything = np.array([axis.universal for axis in self.axes], dtype=found.dtype)
            tractable = self.search.tractable()
            found = np.broadcast_to(everything[:, None, None], found.shape).copy()
            keep = np.zeros(found.size, dtype=np.bool_)
            keep[stated] = True
            both = keep.reshape(found.shape) | keep.reshape(found.shape).transpose(0, 2, 1)
            both |= np.eye(found.shape[1], dtype=np.bool_)
            found[both] = tractable[both]
        last = ConflictSearch(self.axes, found, self.edges(), atomic=True, closed=self.search is None)
        return last.masks if last.run(deadline) else None


def _decided(network: Network, deadline: Deadline, progress: Progress | None, wanted: bool) -> Solution:
    """Return the solution without its time."""
    if is_wide(network.calculus):
        return _wide(network, deadline, wanted)
    axes = on_axes(network)
    if axes is None:
        parts = [_joined(network)]
    else:
        states = opened_states(network)
        stated = [state.masks() for state in states]
        complete = close_states(states, deadline, progress)
        if any(state.emptied is not None for state in states):
            return Solution(Verdict.INCONSISTENT, 0, 0, 0.0, refuted=True)
        if not complete:
            return Solution(Verdict.UNDECIDED, 0, 0, 0.0, reason=OUT_OF_TIME)
        parts = [
            _Part(state.calculus.factors, before[None], state.masks()[None])
            for state, before in zip(states, stated, strict=True)
        ]
    if any(not part.stated.all() for part in parts):
        return Solution(Verdict.INCONSISTENT, 0, 0, 0.0, refuted=True)
    answers = []
    for part in parts:
        answers.append(part.decide(deadline))
        if not answers[-1]:
            break
    searches = [part.search for part in parts if part.search is not None]
    effort = sum(search.decisions for search in searches), sum(search.conflicts for search in searches)
    if answers[-1] is None:
        return Solution(Verdict.UNDECIDED, *effort, 0.0, reason=OUT_OF_TIME)
    if not answers[-1]:
        return Solution(Verdict.INCONSISTENT, *effort, 0.0, refuted=not any(effort))
    reason, found = "", None
    if wanted:
        atoms = [part.atoms(deadline) for part in parts]
        known = [each for each in atoms if each is not None]
        if len(known) == len(atoms):
            found = atomic_network(network, np.concatenate(known))
        else:
            reason = f"{OUT_OF_TIME} before a scenario was found"
    return _unrefuted(network.calculus, effort, found, reason)


def _unrefuted(calculus: Calculus, effort: tuple[int, int], found: Network | None, reason: str) -> Solution:
    """Return the solution for a closed network of tractable relations, or of atoms."""
    if calculus.decided_by_closure:
        return Solution(Verdict.CONSISTENT, *effort, 0.0, found, reason=reason)
    reason = f"a closed network of atoms was found, which proves nothing in {calculus.name}"
    return Solution(Verdict.UNDECIDED, *effort, 0.0, found, reason=reason)


def _wide(network: Network, deadline: Deadline, wanted: bool) -> Solution:
    """Solve in a calculus whose relations take several words; the solution has no time yet."""
    search = WideSearch(network)
    answer = search.run(deadline)
    effort = search.decisions, search.conflicts
    if answer is None:
        return Solution(Verdict.UNDECIDED, *effort, 0.0, reason=OUT_OF_TIME)
    if not answer:
        return Solution(Verdict.INCONSISTENT, *effort, 0.0, refuted=not search.decisions)
    codes = atoms_within(search.relations(), len(network.calculus.atoms)).argmax(axis=2)
    return _unrefuted(network.calculus, effort, _with_atoms(network, codes) if wanted else None, "")


def _joined(network: Network) -> _Part:
    """Return the axes of a product calculus; a relation that is not a product excludes products, as nogoods."""
    calculus, size = network.calculus, network.size
    assert isinstance(calculus, ProductCalculus)
    axes = calculus.axes
    require_room(len(axes), size)
    masks = np.empty((len(axes), size, size), dtype=np.uint64)
    for axis, mask in zip(axes, masks, strict=True):
        mask[:] = axis.universal
        np.fill_diagonal(mask, 1 << axis.identity)
    nogoods: list[list[Premise]] = []
    for c in network.constraints:
        i, k, relation = c.first, c.second, c.relation
        if i > k:
            i, k, relation = k, i, calculus.converse(relation)
        if i == k:
            if not relation >> calculus.identity & 1:
                masks[:, i, i] = 0
            continue
        boxes = calculus.boxes(relation)
        for position, axis in enumerate(axes):
            allowed = 0
            for box in boxes:
                allowed |= box[position]
            masks[position, i, k] &= np.uint64(allowed)
            masks[position, k, i] &= np.uint64(axis.converse(allowed))
        for box in calculus.boxes(calculus.universal & ~relation):
            premises = [
                ((position * size + i) * size + k, part)
                for position, (part, axis) in enumerate(zip(box, axes, strict=True))
                if part != axis.universal
            ]
            nogoods.append(premises)
    return _Part(axes, masks, masks, nogoods, is_closed=False)


def atomic_network(network: Network, atoms: Masks) -> Network:
    """Return the network of one atom for every pair i < j, from the atoms on the axes.

    Parameters
    ----------
    network
        The network, for its calculus, things and names.
    atoms
        Bit mask with one atom for each pair on each axis, shape (axes, n, n).

    Returns
    -------
    Network
        Network with n (n - 1) / 2 constraints.
    """
    calculus = network.calculus
    codes = np.zeros(atoms.shape[1:], dtype=np.int64)
    for axis, mask in zip(calculus.factors, atoms, strict=True):
        codes = codes * len(axis.atoms) + np.bitwise_count(mask - np.ones((), dtype=mask.dtype))
    return _with_atoms(network, codes)


def _with_atoms(network: Network, codes: NDArray[np.int64]) -> Network:
    """Return the network of one atom for every pair i < j, by their codes (n, n)."""
    pairs = zip(*np.triu_indices(network.size, 1), strict=True)
    return network.only(Constraint(int(i), int(j), 1 << int(codes[i, j])) for i, j in pairs)
