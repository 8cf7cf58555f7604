"""Find the best positions of box edges that the chosen constraints allow, by a linear program.

The preferences are usual sizes, round objects as long as wide, gaps between separate objects, related objects close and
aligned, objects in the middle of their supports, and a small table. All preferences are soft; the constraints are hard.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import ZERO, DifferenceNetwork
from deixis.reasoning.entailment.realisation.demands import at_most, high, low
from deixis.reasoning.entailment.realisation.things import Things

SIZE, ROUND, GAP, NEAR, MIDDLE, INSIDE, IN_LINE, TABLE = 8.0, 30.0, 20.0, 1.0, 3.0, 5.0, 0.7, 0.8
"""Cost of each millimetre by which a preference is missed."""

MAX_PULLS = 4.0
"""Number of facts about one object whose pulls count in full.

More facts count together as this many. Otherwise many related objects would compress the objects between them, against
:data:`SIZE`.
"""

MIN_RIM = 5
"""Preferred distance in millimetres between the edge of an object and the objects on it."""


@dataclass(frozen=True, eq=False)
class Wishes:
    """The preferences for a picture."""

    things: Things
    lengthwise: NDArray[np.bool_]  # (n,): whether the length is the side along y
    related: tuple[tuple[int, int], ...]  # pairs of objects that a fact relates
    apart: tuple[tuple[int, int], ...]  # pairs of objects that should not touch
    gap: float  # preferred millimetres between them


@dataclass(slots=True)
class _Program:
    """A linear program under construction: rows ``coefficients · x <= bound``, and the cost of each variable."""

    costs: list[float]
    rows: list[tuple[dict[int, float], float]] = field(default_factory=list)

    def at_least(self, terms: dict[int, float], bound: float, cost: float) -> None:
        """Prefer a sum of terms of at least ``bound``, at a cost per missing unit."""
        slack = self._variable(cost)
        self.rows.append(({**{v: -c for v, c in terms.items()}, slack: -1.0}, -bound))

    def equal(self, terms: dict[int, float], value: float, cost: float) -> None:
        """Prefer a sum of terms equal to ``value``, at a cost per unit of difference."""
        slack = self._variable(cost)
        self.rows.append(({**terms, slack: -1.0}, value))
        self.rows.append(({**{v: -c for v, c in terms.items()}, slack: -1.0}, -value))

    def _variable(self, cost: float) -> int:
        self.costs.append(cost)
        return len(self.costs) - 1

    def solution(self, deadline: Deadline) -> NDArray[np.float64] | None:
        from scipy.optimize import linprog
        from scipy.sparse import csr_array

        entries = [(i, v, c) for i, (terms, _) in enumerate(self.rows) for v, c in terms.items()]
        rows, columns, values = (np.array(part) for part in zip(*entries, strict=True))
        matrix = csr_array((values, (rows, columns)), shape=(len(self.rows), len(self.costs)))
        bounds = np.array([bound for _, bound in self.rows])
        seconds = max(deadline.left, 0.01)
        found = linprog(self.costs, matrix, bounds, method="highs", options={"time_limit": seconds})
        return None if found.x is None else np.asarray(found.x, dtype=np.float64)


def compose(network: DifferenceNetwork, wishes: Wishes, deadline: Deadline) -> NDArray[np.int64]:
    """Return positions of all edges in millimetres, shape (2, 2 n), which satisfy every constraint exactly.

    The solution of the program is rounded, and then moved to the nearest solution of the constraints, so that its
    numerical errors do not matter. Without a solution before the deadline, the objects stand at any valid positions.
    Round objects are made as long as wide if possible; ``network`` keeps these constraints.

    Parameters
    ----------
    network
        The constraints that hold of all edges; those of round objects are added to it.
    wishes
        The preferences: sizes, the side of each length, gaps.
    deadline
        Time limit.

    Returns
    -------
    NDArray of int64
        Positions in millimetres.
    """
    points = 2 * len(wishes.things)
    if not points:
        return np.zeros((2, 0), dtype=np.int64)
    found = _program(network, wishes, points).solution(deadline) if not deadline.passed else None
    if found is None:
        return network.nearest(np.zeros((2, points), dtype=np.int64))
    edges = found[: 2 * points].reshape(2, points)
    # whole millimetres, so that sides are rounded rather than both their ends
    whole = np.rint(edges)
    whole[:, 1::2] = whole[:, 0::2] + np.rint(edges[:, 1::2] - edges[:, 0::2])
    wanted = whole.astype(np.int64)
    for thing in np.flatnonzero(wishes.things.round).tolist():
        side = int(np.min(wanted[:, high(thing)] - wanted[:, low(thing)]))
        length = len(network)
        fixed = [
            at_most(axis, tail, head, bound)
            for axis in (0, 1)
            for tail, head, bound in ((low(thing), high(thing), side), (high(thing), low(thing), -side))
        ]
        if not all(network.add(difference) for difference in fixed):
            network.back(length)
        else:
            wanted[:, high(thing)] = wanted[:, low(thing)] + side
    return network.nearest(wanted)


def _program(network: DifferenceNetwork, wishes: Wishes, points: int) -> _Program:
    program = _Program([0.0] * (2 * points) + [TABLE, TABLE])
    for axis, tail, head, code in network.constraints.tolist():
        program.rows.append(({axis * points + head: 1.0, axis * points + tail: -1.0}, code >> 1))
    for axis in (0, 1):
        for thing in range(points // 2):
            program.rows.append(({axis * points + high(thing): 1.0, 2 * points + axis: -1.0}, 0.0))
    things = wishes.things
    for each in range(len(things)):
        sides = [{k * points + high(each): 1.0, k * points + low(each): -1.0} for k in (0, 1)]
        along = (1, 0) if wishes.lengthwise[each] else (0, 1)
        for k in (0, 1):
            program.equal(sides[k], float(things.wanted[each, along[k]]), SIZE)
        if things.round[each]:
            program.equal({**sides[0], **{v: -c for v, c in sides[1].items()}}, 0.0, ROUND)
    for a, b in wishes.apart:
        _wish_gap(program, network, a, b, wishes.gap)
    partners = np.bincount(np.array(wishes.related, dtype=np.int64).reshape(-1), minlength=points // 2)
    pulls = np.minimum(1.0, MAX_PULLS / np.maximum(partners, 1))
    for axis in (0, 1):
        # pairs (n, n) of objects with a third one between them, which is near to both, so that they need not be near
        before = network.distances[axis, 0::2, 1::2].T <= ZERO  # [first, second]: see _before
        chains = before.astype(np.float32) @ before.astype(np.float32)
        apart: NDArray[np.bool_] = (chains > 0) | (chains.T > 0)
        for a, b in wishes.related:
            if not apart[a, b]:
                _wish_near(program, network, wishes, axis, a, b, float(min(pulls[a], pulls[b])))
    return program


def _before(network: DifferenceNetwork, axis: int, first: int, second: int) -> bool:
    """Return whether ``first`` ends where ``second`` begins, or before."""
    return bool(network.distances[axis, low(second), high(first)] <= ZERO)


def _wish_gap(program: _Program, network: DifferenceNetwork, a: int, b: int, gap: float) -> None:
    points = network.points
    for axis in (0, 1):
        for first, second in ((a, b), (b, a)):
            if _before(network, axis, first, second):
                program.at_least({axis * points + low(second): 1.0, axis * points + high(first): -1.0}, gap, GAP)
                return


def _wish_near(
    program: _Program, network: DifferenceNetwork, wishes: Wishes, axis: int, a: int, b: int, pull: float
) -> None:
    """Prefer two related objects close if they are apart, else aligned, or one in the middle of the other."""
    points = network.points
    start = axis * points
    for first, second in ((a, b), (b, a)):
        if _before(network, axis, first, second):
            between = {start + low(second): 1.0, start + high(first): -1.0}
            program.at_least(between, wishes.gap, GAP)
            program.equal(between, wishes.gap, NEAR * pull)
            return
    centres = {start + low(a): 0.5, start + high(a): 0.5, start + low(b): -0.5, start + high(b): -0.5}
    for inner, outer in ((a, b), (b, a)):
        if within(network, axis, inner, outer):
            program.equal(centres, 0.0, MIDDLE * pull)
            program.at_least({start + low(inner): 1.0, start + low(outer): -1.0}, MIN_RIM, INSIDE)
            program.at_least({start + high(outer): 1.0, start + high(inner): -1.0}, MIN_RIM, INSIDE)
            return
    oblong = ~wishes.things.round[[a, b]] & wishes.lengthwise[[a, b]]
    if axis == 1 and oblong.all():
        program.equal({start + low(a): 1.0, start + low(b): -1.0}, 0.0, IN_LINE * pull)
    else:
        program.equal(centres, 0.0, IN_LINE * pull)


def within(network: DifferenceNetwork, axis: int, inner: int, outer: int) -> bool:
    """Return whether the constraints imply that one projection lies within another.

    Parameters
    ----------
    network
        The constraints.
    axis
        0 for x, 1 for y.
    inner
        The object whose projection is inside.
    outer
        The object around it.

    Returns
    -------
    bool
        True if this holds in every solution.
    """
    begins = network.distances[axis, low(inner), low(outer)] <= ZERO
    return bool(begins and network.distances[axis, high(outer), high(inner)] <= ZERO)


def in_line(pairs: Iterable[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    """Return the unordered pairs, each once.

    Parameters
    ----------
    pairs
        Ordered pairs, in any order.

    Returns
    -------
    tuple
        The pairs with the lesser number first.
    """
    return tuple(dict.fromkeys((min(pair), max(pair)) for pair in pairs if pair[0] != pair[1]))
