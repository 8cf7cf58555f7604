"""Closing what facts demand: orders by bit sets, and in the groups where there are choices, what all pictures share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.entailment.bounds import AXES, bounds_of
from deixis.reasoning.entailment.choices import Choice, OutOfTimeError, Row, Search, State, base_state, shared
from deixis.reasoning.entailment.closed import AxisRows, Groups, Orders, groups_of, orders_of
from deixis.reasoning.entailment.demands import Demands


@dataclass(frozen=True, eq=False)
class Closed:
    """What demands imply.

    ``orders`` is None where they contradict each other. ``complete`` says that everything that all pictures share is in
    ``orders``, ``decided`` that it is known whether there is a picture; both are so unless the time limit struck.
    """

    groups: Groups
    orders: Orders | None
    complete: bool = True
    decided: bool = True
    contradictory: int = -1  # the group whose choices leave nothing, or -1


def close(demands: Demands, deadline: float) -> Closed:
    """Everything that the demands imply; searches end at ``deadline`` (``time.monotonic``)."""
    graph, firm = demands.graph, demands.firm
    groups = groups_of(graph.subjects[firm], graph.objects[firm], len(graph.nodes))
    orders = orders_of(demands.bounds, groups)
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
            state, whole = problem.shared(deadline)
        except OutOfTimeError:
            complete = decided = False
            continue
        if state is None:
            return Closed(groups, None, contradictory=group)
        complete &= whole
        _write(state, axes, groups, group)
    return Closed(groups, Orders(groups, axes), complete, decided)


@dataclass(frozen=True, eq=False)
class LocalProblem:
    """The demands among some objects, which are numbered by their place in ``nodes``."""

    nodes: NDArray[np.int64]
    rows: tuple[Row, ...]
    choices: tuple[Choice, ...]

    def shared(self, deadline: float) -> tuple[State | None, bool]:
        """What all pictures share, and whether that is all; None where there is none. Raises OutOfTimeError."""
        n = len(self.nodes)
        base = base_state(self.rows, n)
        return (None, True) if base is None else shared(Search(self.choices, n, deadline), base)

    def consistent(self, deadline: float, further: Sequence[Row] = ()) -> bool:
        """Whether there is a picture, with these bounds too. Raises OutOfTimeError."""
        n = len(self.nodes)
        base = base_state([*self.rows, *further], n)
        return base is not None and Search(self.choices, n, deadline).picture(base) is not None


def local_problem(demands: Demands, nodes: NDArray[np.int64], choices: Sequence[Choice]) -> LocalProblem:
    """What is demanded among the objects of a connected group."""
    n, m = len(demands.graph.nodes), len(nodes)
    place = np.full(n, -1)
    place[nodes] = np.arange(m)
    bounds = demands.bounds
    inside = place[bounds.tail % n] >= 0
    tails = bounds.tail[inside] // n * m + place[bounds.tail[inside] % n]
    heads = bounds.head[inside] // n * m + place[bounds.head[inside] % n]
    rows = tuple(zip(tails.tolist(), heads.tolist(), bounds.strict[inside].tolist(), strict=True))
    local = tuple(Choice(c.alternatives, int(place[c.subject]), int(place[c.object]), c.premise) for c in choices)
    return LocalProblem(nodes, rows, local)


def _empty_rows(axis: int, groups: Groups) -> AxisRows:
    """The rows of an axis of which nothing is said: every object's low edge is before its high edge."""
    n = len(groups.label)
    low = 2 * axis * n + np.arange(n)
    own = orders_of(bounds_of([(int(p), int(p) + n, True, -1) for p in low]), groups)
    assert own is not None
    rows = own.axes[axis]
    assert rows is not None
    return rows


def _write(state: State, axes: Sequence[AxisRows], groups: Groups, group: int) -> None:
    """Puts a group's closed bounds into the rows of every axis."""
    size, words = int(groups.sizes[group]), int(groups.words[group])
    for axis in range(AXES):
        rows = axes[axis]
        begin, end = int(rows.start[group]), int(rows.start[group + 1])
        for bits, flat in ((state.weak, rows.weak), (state.strong, rows.strong)):
            points = np.unpackbits(bits.view(np.uint8), axis=1, bitorder="little")
            block = points[2 * axis * size : 2 * (axis + 1) * size, 2 * axis * size : 2 * (axis + 1) * size]
            padded = np.zeros((2 * size, 2, 64 * words), np.uint8)
            padded[:, :, :size] = block.reshape(2 * size, 2, size)
            packed = np.packbits(padded.reshape(2 * size, -1), axis=1, bitorder="little")
            flat[begin:end] = np.ascontiguousarray(packed).view(np.uint64).ravel()


def consistent(demands: Demands, deadline: float) -> bool:
    """Whether there is a picture of what is demanded. Raises OutOfTimeError."""
    from deixis.reasoning.entailment.closed import contradictory, point_graph

    n = len(demands.graph.nodes)
    if contradictory(point_graph(demands.bounds, n)):
        return False
    if not demands.choices:
        return True
    return local_problem(demands, np.arange(n), demands.choices).consistent(deadline)
