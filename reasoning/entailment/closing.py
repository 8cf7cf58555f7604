"""Close the demands of facts: orders by bit sets, and in groups with choices, the orders common to all pictures.

A disjunction such as *left or above*, or the denial of *top left*, is not a conjunction of bounds but a choice between
several, which :mod:`deixis.reasoning.constraints.disjunctive` decides. The common orders are found by refutation: a
bound holds in all pictures if its denial has no picture. Every picture found on the way excludes the bounds that fail
in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import ORDERS, STRICT, ZERO, Difference, DifferenceNetwork
from deixis.reasoning.constraints.disjunctive import Clauses, Search, SearchOutcome, solution
from deixis.reasoning.entailment.bounds import AXES, bounds_of, order_differences
from deixis.reasoning.entailment.closed import AxisRows, Groups, Orders, groups_of, order_graph, orders_of
from deixis.reasoning.entailment.demands import Choice, Demands
from deixis.reasoning.entailment.word_conflicts import conflicting_edges
from deixis.reasoning.errors import OutOfTimeError


@dataclass(frozen=True, eq=False)
class Closed:
    """The implications of demands.

    ``orders`` is None if the demands are inconsistent, or the facts of graded words. ``complete`` is True if ``orders``
    has everything that all pictures share, ``decided`` if it is known whether a picture exists; both are True unless
    time ran out.
    """

    groups: Groups
    orders: Orders | None
    complete: bool = True
    decided: bool = True
    contradictory: int = -1  # the group whose choices have no picture, or -1


def close(demands: Demands, deadline: Deadline) -> Closed:
    """Return all implications of some demands.

    Parameters
    ----------
    demands
        The demands.
    deadline
        Time limit of the searches.

    Returns
    -------
    Closed
        The orders that hold in every picture, and whether these are all.
    """
    graph, firm = demands.graph, demands.firm
    groups = groups_of(graph.subjects[firm], graph.objects[firm], len(graph.nodes))
    orders = orders_of(demands.bounds, groups)
    if orders is not None and conflicting_edges(graph, firm) is not None:
        orders = None
    if orders is None or not demands.choices:
        return Closed(groups, orders)
    by_group: dict[int, list[Choice]] = {}
    for choice in demands.choices:
        by_group.setdefault(int(groups.label[choice.subject]), []).append(choice)
    complete = decided = True
    axes = tuple(rows or _empty_rows(axis, groups) for axis, rows in enumerate(orders.axes))
    for group, choices in by_group.items():
        problem = local_problem(demands, groups.members(group), choices)
        try:
            known, whole = problem.shared(deadline)
        except OutOfTimeError:
            complete = decided = False
            continue
        if known is None:
            return Closed(groups, None, contradictory=group)
        complete &= whole
        _write(known, axes, groups, group)
    return Closed(groups, Orders(groups, axes), complete, decided)


Codes = NDArray[np.int8]
"""Closed orders of the points of n objects, shape (3, 2 n, 2 n).

STRICT if the column's point is before the row's, ZERO if it is not after it.
"""


@dataclass(frozen=True, eq=False)
class LocalProblem:
    """The demands among n objects, which are numbered by their positions in ``nodes``."""

    nodes: NDArray[np.int64]
    differences: NDArray[np.int64]  # (k, 4)
    clauses: Clauses

    def network(self) -> DifferenceNetwork | None:
        """Return the network of the demands without choices, or None if they are inconsistent.

        Returns
        -------
        DifferenceNetwork or None
            The network, or None if the demands are inconsistent.
        """
        n = len(self.nodes)
        network = DifferenceNetwork(2 * n, AXES, ORDERS)
        axis, low = np.divmod(np.arange(AXES * n), max(n, 1))
        own = np.stack([axis, low + n, low, np.full_like(low, STRICT)], axis=1)
        return network if network.add_all(np.concatenate([own, self.differences])) else None

    def picture(self, deadline: Deadline) -> Codes | None:
        """Return the orders of one picture.

        Parameters
        ----------
        deadline
            Time limit.

        Returns
        -------
        Codes or None
            The orders, or None if there is no picture.

        Raises
        ------
        OutOfTimeError
            If the deadline passes first.
        """
        network = self.network()
        return None if network is None else solution(network, self.clauses, self._nothing_taken(), deadline)

    def _nothing_taken(self) -> NDArray[np.int64]:
        return np.full(len(self.clauses), -1, np.int64)

    def shared(self, deadline: Deadline) -> tuple[Codes | None, bool]:
        """Return the orders common to all pictures.

        Parameters
        ----------
        deadline
            Time limit. Orders that were proved before it are returned.

        Returns
        -------
        tuple
            The orders, or None if there is no picture, and True if they are complete.

        Raises
        ------
        OutOfTimeError
            If not even one picture was found.
        """
        known, last = self.network(), self._nothing_taken()
        common = None if known is None else solution(known, self.clauses, last, deadline)
        if known is None or common is None:
            return None, True
        if Search(known, self.clauses, deadline).propagate() is not SearchOutcome.SOLVED:
            return known.distances, False
        try:
            while (shared := _candidate(known.distances, common)) is not None:
                length = len(known)
                other = solution(known, self.clauses, last, deadline) if known.add(shared.denied()) else None
                known.back(length)
                if other is None:
                    known.add(shared)
                else:
                    common = np.maximum(common, other)
        except OutOfTimeError:
            known.back(length)
            return known.distances, False
        return known.distances, True


def _candidate(known: Codes, common: Codes) -> Difference | None:
    """Return a bound that holds in all pictures found and is not known to follow; the stricter first."""
    for code in (STRICT, ZERO):
        seen = ((common <= code) & (known > code)).transpose(0, 2, 1)
        place = int(seen.argmax())
        if seen.size and seen.flat[place]:
            axis, head, tail = np.unravel_index(place, seen.shape)
            return Difference(int(axis), int(tail), int(head), code)
    return None


def local_problem(demands: Demands, nodes: NDArray[np.int64], choices: Sequence[Choice]) -> LocalProblem:
    """Return the demands among the objects of a connected group.

    Parameters
    ----------
    demands
        All demands.
    nodes
        Positions of the objects of the group.
    choices
        The choices among these objects.

    Returns
    -------
    LocalProblem
        The problem of the group.
    """
    n, m = len(demands.graph.nodes), len(nodes)
    place = np.full(n, -1)
    place[nodes] = np.arange(m)
    bounds = demands.bounds
    inside = place[bounds.tail % n] >= 0
    tails = bounds.tail[inside] // n * m + place[bounds.tail[inside] % n]
    heads = bounds.head[inside] // n * m + place[bounds.head[inside] % n]
    local = (replace(c, subject=int(place[c.subject]), object=int(place[c.object])) for c in choices)
    differences = order_differences(tails, heads, bounds.strict[inside], m)
    return LocalProblem(nodes, differences, Clauses(choice.clause(m) for choice in local))


def _empty_rows(axis: int, groups: Groups) -> AxisRows:
    """Return the rows of an axis without bounds: every object's low edge is before its high edge."""
    n = len(groups.label)
    low = 2 * axis * n + np.arange(n)
    own = orders_of(bounds_of([(int(p), int(p) + n, True, -1) for p in low]), groups)
    assert own is not None
    rows = own.axes[axis]
    assert rows is not None
    return rows


def _write(known: Codes, axes: Sequence[AxisRows], groups: Groups, group: int) -> None:
    """Write a group's closed orders into the rows of every axis."""
    size, words = int(groups.sizes[group]), int(groups.words[group])
    for axis in range(AXES):
        rows = axes[axis]
        begin, end = int(rows.start[group]), int(rows.start[group + 1])
        for code, flat in ((ZERO, rows.weak), (STRICT, rows.strong)):
            padded = np.zeros((2 * size, 2, 64 * words), np.bool_)
            padded[:, :, :size] = (code >= known[axis].T).reshape(2 * size, 2, size)
            packed = np.packbits(padded.reshape(2 * size, -1), axis=1, bitorder="little")
            flat[begin:end] = np.ascontiguousarray(packed).view(np.uint64).ravel()


def consistent(demands: Demands, deadline: Deadline) -> bool:
    """Return whether some demands have a picture, and the facts of graded words agree with each other.

    Parameters
    ----------
    demands
        The demands.
    deadline
        Time limit.

    Returns
    -------
    bool
        True if they do.

    Raises
    ------
    OutOfTimeError
        If the deadline passes first.
    """
    n = len(demands.graph.nodes)
    if order_graph(demands.bounds, n).contradictory or conflicting_edges(demands.graph, demands.firm) is not None:
        return False
    return not demands.choices or local_problem(demands, np.arange(n), demands.choices).picture(deadline) is not None


# ---- pictures of consistent orders: boxes of small integers that satisfy every bound; their sizes mean nothing


def picture_of(known: Codes) -> NDArray[np.float64]:
    """Return boxes that satisfy closed, consistent orders.

    Parameters
    ----------
    known
        The orders of n objects.

    Returns
    -------
    ndarray
        Minimum and maximum corners, shape (n, 2, 3), without a unit.
    """
    after = (known == STRICT).sum(axis=1)
    return _boxes(after.reshape(AXES, 2, -1))


def picture_of_group(orders: Orders, group: int) -> NDArray[np.float64]:
    """Return a picture of the objects of a connected group, in its order, by closed orders without open choices.

    The boxes have shape (n, 2, 3): minimum and maximum corner.

    Parameters
    ----------
    orders
        Closed orders without open choices.
    group
        Number of the group.

    Returns
    -------
    ndarray
        Minimum and maximum corners of its n objects, shape (n, 2, 3), without a unit.
    """
    n, words = int(orders.groups.sizes[group]), int(orders.groups.words[group])
    after = np.tile(np.array([[1], [0]], np.int64), (AXES, 1, n))
    for axis, rows in enumerate(orders.axes):
        if rows is not None:
            strong = rows.strong[rows.start[group] : rows.start[group + 1]].reshape(2 * n, 2 * words)
            after[axis] = np.bitwise_count(strong).sum(axis=1, dtype=np.int64).reshape(2, n)
    return _boxes(after)


def _boxes(after: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return boxes from the number of edges that must be after each edge, shape (axes, 2, n).

    The position of every edge is minus that number, with levels counted from 0. If u must not be after v, all edges
    after v are after u, so u is not farther; and if u must be before v, v itself counts as one more.
    """
    levels = [np.unique(-part, return_inverse=True)[1].reshape(part.shape) for part in after]
    return np.stack(levels).transpose(2, 1, 0).astype(np.float64)
