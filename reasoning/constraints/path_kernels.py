"""Compiled loops of :mod:`deixis.reasoning.constraints.paths`: graphs of orders, and their shortest explanations.

A graph is in rows: the edges out of point u are ``first[u]:first[u + 1]`` of ``heads``, ``strict`` and ``premise``.
``distances`` are those of :mod:`deixis.reasoning.constraints.kernels`.
"""

from __future__ import annotations

import numpy as np

from deixis.reasoning.kernel import kernel

FAR = np.int64(1 << 40)


@kernel()
def rows_of(tails, n):  # type: ignore[no-untyped-def]
    """Return the first edge of each point, shape (n + 1,), and the edges sorted by their tails."""
    first = np.zeros(n + 1, np.int64)
    for u in tails:
        first[u + 1] += 1
    for u in range(n):
        first[u + 1] += first[u]
    place = first[:-1].copy()
    order = np.empty(len(tails), np.int64)
    for edge in range(len(tails)):
        u = tails[edge]
        order[place[u]] = edge
        place[u] += 1
    return first, order


@kernel()
def strong_parts(first, heads):  # type: ignore[no-untyped-def]
    """Find the strongly connected components (Tarjan 1972), numbered so that edges lead to lower numbers.

    Returns the component of each point, and the points in the order of their components.
    """
    n = len(first) - 1
    index = np.full(n, -1, np.int64)
    low = np.zeros(n, np.int64)
    part = np.full(n, -1, np.int64)
    members = np.empty(n, np.int64)
    stack = np.empty(n, np.int64)
    calls = np.empty(n, np.int64)
    place = first[:-1].copy()
    height, listed, parts, counter = 0, 0, 0, 0
    for root in range(n):
        if index[root] >= 0:
            continue
        depth = 0
        calls[0] = root
        index[root] = low[root] = counter
        counter += 1
        stack[height] = root
        height += 1
        while depth >= 0:
            u = calls[depth]
            if place[u] < first[u + 1]:
                v = heads[place[u]]
                place[u] += 1
                if index[v] < 0:
                    index[v] = low[v] = counter
                    counter += 1
                    stack[height] = v
                    height += 1
                    depth += 1
                    calls[depth] = v
                elif part[v] < 0 and index[v] < low[u]:
                    low[u] = index[v]
                continue
            if low[u] == index[u]:
                while True:
                    height -= 1
                    v = stack[height]
                    part[v] = parts
                    members[listed] = v
                    listed += 1
                    if v == u:
                        break
                parts += 1
            depth -= 1
            if depth >= 0 and low[u] < low[calls[depth]]:
                low[calls[depth]] = low[u]
    return part, members


@kernel()
def strict_within(first, heads, strict, part):  # type: ignore[no-untyped-def]
    """Return the tail of a strict edge within a strongly connected component, or -1 if there is no such edge."""
    for u in range(len(first) - 1):
        for edge in range(first[u], first[u + 1]):
            if strict[edge] and part[heads[edge]] == part[u]:
                return u
    return -1


@kernel()
def fewest(first, heads, strict, premise, root, goal, limit, cost, before, by, queue):  # type: ignore[no-untyped-def]
    """Find the smallest number of premises from a point to all states within ``limit``, or to the state ``goal``.

    A state is twice a point, plus 1 if the path has passed a strict edge. Edges of premise -1 cost nothing, others one.
    ``cost`` must be ``FAR`` throughout, and receives the costs; ``before`` and ``by`` receive the state and the edge
    that each state was reached from; ``queue`` needs room for four entries per state, and two more. Returns the number
    of states reached, which are the first ones in ``queue``, possibly repeated.
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
            if state == goal:
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


@kernel()
def shortest_strict_cycle(first, heads, strict, premise, part):  # type: ignore[no-untyped-def]
    """Return the edges of a cycle with a strict edge and the fewest premises, in order."""
    points = len(first) - 1
    cost = np.full(2 * points, FAR)
    before = np.empty(2 * points, np.int64)
    by = np.empty(2 * points, np.int64)
    queue = np.empty(2 * (4 * points + 2), np.int64)
    best = FAR
    cycle = np.empty(2 * points + 1, np.int64)
    length = 0
    for u in range(points):
        for edge in range(first[u], first[u + 1]):
            v = heads[edge]
            if not strict[edge] or part[u] != part[v]:
                continue
            own = 0 if premise[edge] < 0 else 1
            reached = fewest(first, heads, strict, premise, v, 2 * u + 1, best - 1 - own, cost, before, by, queue)
            state = 2 * u if cost[2 * u] <= cost[2 * u + 1] else 2 * u + 1
            if cost[state] + own < best:
                best = cost[state] + own
                length = 1
                cycle[0] = edge
                while before[state] >= 0:
                    cycle[length] = by[state]
                    length += 1
                    state = before[state]
            for k in range(reached):
                cost[queue[k]] = FAR
    return cycle[:length]


@kernel()
def tight_path(distances, count, constraints, axis, start, end):  # type: ignore[no-untyped-def]
    """Return the fewest constraints (rows of axis, tail, head, code) that add up to the distance between two points.

    The search is breadth first over the constraints on shortest paths. It distinguishes paths with and without a strict
    constraint so far, since a strict distance needs one.
    """
    if start == end:
        return np.empty(0, np.int64)
    wanted = np.int64(distances[start, end])
    tight = np.empty(len(constraints), np.int64)
    found = 0
    for k in range(len(constraints)):
        if constraints[k, 0] == axis:
            before, after = distances[start, constraints[k, 1]], distances[constraints[k, 2], end]
            if (np.int64(before) >> 1) + (constraints[k, 3] >> 1) + (np.int64(after) >> 1) == wanted >> 1:
                tight[found] = k
                found += 1
    tight = tight[:found]
    first, order = rows_of(constraints[tight, 1], count)
    tight = tight[order]
    heads, strict = constraints[tight, 2], constraints[tight, 3] & 1 == 0
    states = 2 * count
    cost, came, by = np.full(states, FAR), np.empty(states, np.int64), np.empty(states, np.int64)
    state = 2 * end + (1 - (wanted & 1))
    queue = np.empty(2 * (2 * states + 2), np.int64)
    fewest(first, heads, strict, tight, start, state, FAR, cost, came, by, queue)
    length = cost[state]
    path = np.empty(length, np.int64)
    for k in range(length):
        path[length - 1 - k] = tight[by[state]]
        state = came[state]
    return path
