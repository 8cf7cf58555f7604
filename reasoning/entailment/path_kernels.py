"""The compiled searches under :mod:`deixis.reasoning.entailment.paths`: fewest facts from point to point, and in a
circle.

A state is twice a point, plus 1 where a strict edge has been passed. Edges of premise -1, an object's own, cost
nothing, all others one fact. Graphs of points are in rows, as in :mod:`deixis.reasoning.entailment.kernels`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

FAR = np.int64(1 << 40)


@njit(cache=True)
def search(first, heads, strict, premise, root, target, limit, cost, before, by, queue):  # type: ignore[no-untyped-def]
    """Costs from a point to all states within ``limit`` facts, or until the strict state of ``target`` is reached.

    ``cost`` holds ``FAR`` throughout and gets the costs, ``before`` and ``by`` the state and edge that a state was
    reached from; ``queue`` has room for four entries a state, and two more. Returns how many states were reached; they
    are the first ones in ``queue``, maybe several times.
    """
    begin, end = 0, 1
    queue[0] = 2 * root
    cost[2 * root] = 0
    before[2 * root] = -1
    level = 0
    half = len(queue) // 2
    waiting = 0
    while end > begin:
        while begin < end:
            state = queue[begin]
            begin += 1
            if cost[state] != level:
                continue
            if state == 2 * target + 1:
                return end
            u, passed = state >> 1, state & 1
            for edge in range(first[u], first[u + 1]):
                other = 2 * heads[edge] + (1 if passed or strict[edge] else 0)
                step = 0 if premise[edge] < 0 else 1
                if level + step <= limit and cost[other] > level + step:
                    cost[other] = level + step
                    before[other] = state
                    by[other] = edge
                    if step == 0:
                        queue[end] = other
                        end += 1
                    else:
                        queue[half + waiting] = other
                        waiting += 1
        level += 1
        for k in range(waiting):
            queue[end + k] = queue[half + k]
        end += waiting
        waiting = 0
    return end


@njit(cache=True)
def shortest_circle(first, heads, strict, premise, part):  # type: ignore[no-untyped-def]
    """The fewest facts round a circle with a strict edge: its length in edges, and the edges, in order."""
    points = len(first) - 1
    cost = np.full(2 * points, FAR)
    before = np.empty(2 * points, np.int64)
    by = np.empty(2 * points, np.int64)
    queue = np.empty(2 * (4 * points + 2), np.int64)
    best = FAR
    circle = np.empty(2 * points + 1, np.int64)
    length = 0
    for u in range(points):
        for edge in range(first[u], first[u + 1]):
            v = heads[edge]
            if not strict[edge] or part[u] != part[v]:
                continue
            own = 0 if premise[edge] < 0 else 1
            reached = search(first, heads, strict, premise, v, u, best - 1 - own, cost, before, by, queue)
            state = 2 * u if cost[2 * u] <= cost[2 * u + 1] else 2 * u + 1
            if cost[state] + own < best:
                best = cost[state] + own
                length = 1
                circle[0] = edge
                while before[state] >= 0:
                    circle[length] = by[state]
                    length += 1
                    state = before[state]
            for k in range(reached):
                cost[queue[k]] = FAR
    return circle[:length]
