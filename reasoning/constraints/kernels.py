"""Compiled loops of the search of this folder, on plain arrays.

``distances`` has shape (m, m), of which the first ``count`` rows and columns are in use. It holds the tightest bound on
*column point minus row point* as a code of :mod:`deixis.reasoning.constraints.difference`; a code of ``free`` or more
means no bound.
"""

from __future__ import annotations

import numpy as np

from deixis.reasoning.kernel import kernel

# ---- distances


@kernel()
def added(a, b, free):  # type: ignore[no-untyped-def]
    """Return the sum of two codes."""
    if a >= free or b >= free:
        return np.int64(free)
    return ((np.int64(a) & ~1) + (np.int64(b) & ~1)) | (np.int64(a) & np.int64(b) & 1)


@kernel(lambda distances, count, *rest: count**2)
def tighten(distances, count, tail, head, code, free):  # type: ignore[no-untyped-def]
    """Add one constraint that closes no negative cycle, in O(count ** 2), in place.

    Only rows that reach the head better through it, and columns that the tail reaches better, can change. Returns the
    cells that changed, as flat indices, and their old codes.
    """
    rows, reach = np.empty(count, np.int64), np.empty(count, np.int64)
    columns, onward = np.empty(count, np.int64), np.empty(count, np.int64)
    n_rows = n_columns = 0
    for i in range(count):
        through = added(distances[i, tail], code, free)
        if through < distances[i, head]:
            rows[n_rows], reach[n_rows] = i, through
            n_rows += 1
        if added(code, distances[head, i], free) < distances[tail, i]:
            columns[n_columns], onward[n_columns] = i, distances[head, i]
            n_columns += 1
    cells, before = np.empty(n_rows * n_columns, np.int64), np.empty(n_rows * n_columns, distances.dtype)
    changed = 0
    for r in range(n_rows):
        i = rows[r]
        for c in range(n_columns):
            j = columns[c]
            through = added(reach[r], onward[c], free)
            if through < distances[i, j]:
                cells[changed], before[changed] = i * distances.shape[1] + j, distances[i, j]
                changed += 1
                distances[i, j] = through
    return cells[:changed].copy(), before[:changed].copy()


@kernel()
def insert(distances, count, tail, head, code, free):  # type: ignore[no-untyped-def]
    """Add one constraint that closes no negative cycle, in place, without recording the old codes."""
    columns, onward = np.empty(count, np.int64), np.empty(count, np.int64)
    n_columns = 0
    for j in range(count):
        through = added(code, distances[head, j], free)
        if through < distances[tail, j]:
            columns[n_columns], onward[n_columns] = j, through
            n_columns += 1
    for i in range(count):
        start = distances[i, tail]
        if start < free and added(start, code, free) < distances[i, head]:
            for c in range(n_columns):
                through = added(start, onward[c], free)
                if through < distances[i, columns[c]]:
                    distances[i, columns[c]] = through


@kernel(lambda matrices, count, constraints, free: len(constraints) * count**2 // 4)
def tighten_all(matrices, count, constraints, free):  # type: ignore[no-untyped-def]
    """Add constraints (rows of axis, tail, head, code); return False if they close a negative cycle."""
    for k in range(len(constraints)):
        axis, tail, head, code = constraints[k, 0], constraints[k, 1], constraints[k, 2], constraints[k, 3]
        if added(matrices[axis, head, tail], code, free) < 1:
            return False
        if code < matrices[axis, tail, head]:
            insert(matrices[axis], count, tail, head, code, free)
    return True


# ---- clauses


@kernel(lambda distances, bounds, begin, end, free: 4 * (end - begin) ** 2)
def standing(distances, bounds, begin, end, free):  # type: ignore[no-untyped-def]
    """Return whether the constraints ``begin:end`` are implied (1), cannot all be added (-1), or neither (0).

    ``distances`` has shape (axes, m, m), ``bounds`` rows of axis, tail, head and code. Only the few points of these
    constraints are examined, since the distances between them hold all that the other constraints imply of them.
    """
    left = 0
    for b in range(begin, end):
        axis, tail, head, code = bounds[b, 0], bounds[b, 1], bounds[b, 2], bounds[b, 3]
        if distances[axis, tail, head] <= code:
            continue
        if added(distances[axis, head, tail], code, free) < 1:
            return -1
        left += 1
    if left == 0:
        return 1
    if left == 1:
        return 0
    points = np.empty((2 * left, 2), np.int64)
    ends = np.empty((left, 2), np.int64)
    codes = np.empty(left, np.int64)
    size, n = 0, 0
    for b in range(begin, end):
        axis, tail, head, code = bounds[b, 0], bounds[b, 1], bounds[b, 2], bounds[b, 3]
        if distances[axis, tail, head] <= code:
            continue
        for side in range(2):
            point = head if side else tail
            place = 0
            while place < size and (points[place, 0] != axis or points[place, 1] != point):
                place += 1
            if place == size:
                points[size, 0], points[size, 1] = axis, point
                size += 1
            ends[n, side] = place
        codes[n] = code
        n += 1
    local = np.full((size, size), free, np.int64)
    for i in range(size):
        for j in range(size):
            if points[i, 0] == points[j, 0]:
                local[i, j] = distances[points[i, 0], points[i, 1], points[j, 1]]
    for k in range(n):
        tail, head = ends[k]
        if codes[k] >= local[tail, head]:
            continue
        if added(local[head, tail], codes[k], free) < 1:
            return -1
        for i in range(size):
            start = added(local[i, tail], codes[k], free)
            if start < local[i, head]:
                for j in range(size):
                    through = added(start, local[head, j], free)
                    if through < local[i, j]:
                        local[i, j] = through
    return 0


@kernel(lambda distances, first_piece, first_bound, bounds, *rest: 4 * len(bounds))
def next_clause(distances, first_piece, first_bound, bounds, taken, free):  # type: ignore[no-untyped-def]
    """Return the clause with the fewest pieces that can be added, and their number; -1 if all clauses hold.

    The pieces of clause c are ``first_piece[c]:first_piece[c + 1]``, the constraints of piece p
    ``first_bound[p]:first_bound[p + 1]``. Clauses that are decided or implied are skipped.
    """
    best, fewest_left = -1, 1 << 40
    for c in range(len(taken)):
        if taken[c] >= 0:
            continue
        left = 0
        for p in range(first_piece[c], first_piece[c + 1]):
            holds = standing(distances, bounds, first_bound[p], first_bound[p + 1], free)
            if holds == 1:
                left = -1
                break
            if holds == 0:
                left += 1
        if 0 <= left < fewest_left:
            best, fewest_left = c, left
            if left == 0:
                break
    return best, fewest_left


@kernel(lambda distances, first_piece, first_bound, bounds, last, free: 4 * len(last) * len(bounds))
def dive(distances, first_piece, first_bound, bounds, last, free):  # type: ignore[no-untyped-def]
    """Decide all clauses without backtracking: each takes the piece that it took last, or else the first possible one.

    The loop takes forced pieces first, then decides the clause with the fewest possible pieces. It returns 1 if all
    clauses hold in the end, -1 if the forced pieces are inconsistent, and 0 if a decision led to an inconsistency, so
    that other decisions may succeed. It writes ``distances`` and ``last`` (clauses,), -1 for no piece.
    """
    alive = np.ones(len(first_bound) - 1, np.bool_)
    pending = np.ones(len(last), np.bool_)
    count, dead_end = distances.shape[1], -1
    while True:
        changed, best, fewest_left, chosen = False, -1, 1 << 30, -1
        for c in range(len(last)):
            if not pending[c]:
                continue
            left, only = 0, -1
            for p in range(first_piece[c], first_piece[c + 1]):
                if not alive[p]:
                    continue
                holds = standing(distances, bounds, first_bound[p], first_bound[p + 1], free)
                if holds == 1:
                    pending[c] = False
                    break
                if holds == -1:
                    alive[p] = False
                    continue
                left += 1
                only = p
            if not pending[c]:
                continue
            if left == 0:
                return dead_end
            if left == 1:
                for b in range(first_bound[only], first_bound[only + 1]):
                    axis, tail, head, code = bounds[b, 0], bounds[b, 1], bounds[b, 2], bounds[b, 3]
                    if code < distances[axis, tail, head]:
                        insert(distances[axis], count, tail, head, code, free)
                pending[c] = False
                changed = True
            elif left < fewest_left:
                best, fewest_left = c, left
        if changed:
            continue
        if best < 0:
            return 1
        dead_end = 0
        chosen = last[best]
        if chosen < 0 or not alive[chosen]:
            chosen = first_piece[best]
            while not alive[chosen]:
                chosen += 1
        for b in range(first_bound[chosen], first_bound[chosen + 1]):
            axis, tail, head, code = bounds[b, 0], bounds[b, 1], bounds[b, 2], bounds[b, 3]
            if code < distances[axis, tail, head]:
                insert(distances[axis], count, tail, head, code, free)
        last[best] = chosen
        pending[best] = False
