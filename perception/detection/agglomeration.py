"""Compiled agglomeration of regions: average linkage over a graph of regions that meet, in a heap of its edges."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def merge_regions(pairs, lengths, evidence, colours, weights, limit, colour_delay, full_difference):  # type: ignore[no-untyped-def]
    """Return for each of s regions the first of those that it was merged with, (s,).

    ``pairs`` (m, 2) are regions that meet, each pair once, the lesser first. The pair with the least delay is merged
    as long as its mean ``evidence``, weighted by ``lengths`` (m,), is below ``limit``. The delay is the evidence, and
    up to ``colour_delay`` more where the means of ``colours`` (s, 3), weighted by ``weights`` (s,), differ by up to
    ``full_difference``. Ties go to the pair with the smaller numbers.

    Notes
    -----
    The edges of a region are a doubly linked list. An edge e has two places in such lists, 2 e in that of its first
    end and 2 e + 1 in that of its second. A merge visits the edges of both regions once, and each costs O(log m) in
    the heap, which holds every edge at most once.
    """
    count, m = len(weights), len(pairs)
    ends, length, total = pairs.copy(), lengths.copy(), lengths * evidence
    weight = weights.copy()
    colour = np.empty((count, 3))  # times the weight
    for i in range(count):
        for axis in range(3):
            colour[i, axis] = colours[i, axis] * weights[i]
    first = np.full(count, -1, np.int64)
    after, before = np.full(2 * m, -1, np.int64), np.full(2 * m, -1, np.int64)
    keys, low, high = np.empty(m), np.empty(m, np.int64), np.empty(m, np.int64)
    heap, place, size = np.empty(m, np.int64), np.full(m, -1, np.int64), 0
    for e in range(m):
        for side in range(2):
            _link(2 * e + side, ends[e, side], first, after, before)
        _set_key(e, ends, length, total, colour, weight, colour_delay, full_difference, keys, low, high)
        size = _insert(e, heap, place, size, keys, low, high)
    root = np.arange(count)
    edge_to, marked = np.empty(count, np.int64), np.full(count, -1, np.int64)
    merges = 0
    while size and keys[heap[0]] < limit + colour_delay:
        e = heap[0]
        size = _remove(e, heap, place, size, keys, low, high)
        if total[e] / length[e] >= limit:
            continue  # comes back when one of the two changes
        a, b = low[e], high[e]
        root[b] = a
        merges += 1
        _unlink(2 * e, ends[e, 0], first, after, before)
        _unlink(2 * e + 1, ends[e, 1], first, after, before)
        at = first[a]
        while at >= 0:
            other = ends[at // 2, 1 - at % 2]
            edge_to[other], marked[other] = at // 2, merges
            at = after[at]
        at = first[b]
        while at >= 0:
            following, edge, other = after[at], at // 2, ends[at // 2, 1 - at % 2]
            if marked[other] == merges:  # both met it
                length[edge_to[other]] += length[edge]
                total[edge_to[other]] += total[edge]
                _unlink(4 * edge + 1 - at, other, first, after, before)
                if place[edge] >= 0:
                    size = _remove(edge, heap, place, size, keys, low, high)
            else:
                ends[edge, at % 2] = a
                _link(at, a, first, after, before)
            at = following
        first[b] = -1
        weight[a] += weight[b]
        for axis in range(3):
            colour[a, axis] += colour[b, axis]
        at = first[a]
        while at >= 0:
            edge = at // 2
            _set_key(edge, ends, length, total, colour, weight, colour_delay, full_difference, keys, low, high)
            if place[edge] < 0:
                size = _insert(edge, heap, place, size, keys, low, high)
            else:
                _rise(place[edge], heap, place, keys, low, high)
                _sink(place[edge], heap, place, size, keys, low, high)
            at = after[at]
    for i in range(count):  # a region was merged with a lesser one
        root[i] = root[root[i]]
    return root


@njit(cache=True, nogil=True)
def _link(at, region, first, after, before):  # type: ignore[no-untyped-def]
    """Put a place at the head of a region's list."""
    after[at], before[at] = first[region], -1
    if first[region] >= 0:
        before[first[region]] = at
    first[region] = at


@njit(cache=True, nogil=True)
def _unlink(at, region, first, after, before):  # type: ignore[no-untyped-def]
    """Take a place out of its region's list."""
    if before[at] >= 0:
        after[before[at]] = after[at]
    else:
        first[region] = after[at]
    if after[at] >= 0:
        before[after[at]] = before[at]


@njit(cache=True, nogil=True)
def _set_key(e, ends, length, total, colour, weight, colour_delay, full_difference, keys, low, high):  # type: ignore[no-untyped-def]
    """Compute the delay of an edge and the order of its ends."""
    a, b = min(ends[e, 0], ends[e, 1]), max(ends[e, 0], ends[e, 1])
    tint = 0.0
    for axis in range(3):
        apart = colour[a, axis] / weight[a] - colour[b, axis] / weight[b]
        tint += apart * apart
    share = min(np.sqrt(tint) / full_difference, 1.0)
    keys[e], low[e], high[e] = total[e] / length[e] + colour_delay * share, a, b


@njit(cache=True, nogil=True)
def _precedes(e, f, keys, low, high):  # type: ignore[no-untyped-def]
    """Return whether an edge is merged before another."""
    if keys[e] != keys[f]:
        return keys[e] < keys[f]
    return low[e] < low[f] or (low[e] == low[f] and high[e] < high[f])


@njit(cache=True, nogil=True)
def _rise(i, heap, place, keys, low, high):  # type: ignore[no-untyped-def]
    e = heap[i]
    while i and _precedes(e, heap[(i - 1) // 2], keys, low, high):
        heap[i] = heap[(i - 1) // 2]
        place[heap[i]] = i
        i = (i - 1) // 2
    heap[i], place[e] = e, i


@njit(cache=True, nogil=True)
def _sink(i, heap, place, size, keys, low, high):  # type: ignore[no-untyped-def]
    e = heap[i]
    while 2 * i + 1 < size:
        child = 2 * i + 1
        if child + 1 < size and _precedes(heap[child + 1], heap[child], keys, low, high):
            child += 1
        if not _precedes(heap[child], e, keys, low, high):
            break
        heap[i] = heap[child]
        place[heap[i]] = i
        i = child
    heap[i], place[e] = e, i


@njit(cache=True, nogil=True)
def _insert(e, heap, place, size, keys, low, high):  # type: ignore[no-untyped-def]
    """Put an edge into the heap; return the new size."""
    heap[size], place[e] = e, size
    _rise(size, heap, place, keys, low, high)
    return size + 1


@njit(cache=True, nogil=True)
def _remove(e, heap, place, size, keys, low, high):  # type: ignore[no-untyped-def]
    """Take an edge out of the heap; return the new size."""
    i, last = place[e], heap[size - 1]
    place[e] = -1
    if last != e:
        heap[i], place[last] = last, i
        _rise(i, heap, place, keys, low, high)
        _sink(place[last], heap, place, size - 1, keys, low, high)
    return size - 1
