"""Compiled agglomeration of regions: average linkage over a graph of adjacent regions, with a heap of its edges.

Average linkage is due to R. R. Sokal and C. D. Michener, "A statistical method for evaluating systematic
relationships", University of Kansas Science Bulletin 38, 1958. Here only adjacent regions are merged.
"""

from __future__ import annotations

import numpy as np
from numba import njit

_ARITY = 4
"""Number of children of a node of the heap: four keys share a cache line."""


@njit(cache=True, nogil=True)
def merge_regions(pairs, lengths, evidence, colours, weights, limit, colour_delay, full_difference):  # type: ignore[no-untyped-def]
    """Merge adjacent regions, and return the lowest region of each region's group, shape (s,).

    The pair with the smallest delay is merged as long as its mean evidence is below ``limit``. The delay is the
    evidence, plus up to ``colour_delay`` for a difference of the mean colours; ``full_difference`` makes it whole. Ties
    go to the pair with the lower numbers. If the colours differ by ``full_difference``, the mean evidence between the
    region of less weight and all its neighbours of the other's colour must be below ``limit`` too.

    Parameters
    ----------
    pairs
        Adjacent regions, shape (m, 2), each pair once, the lower number first.
    lengths, evidence
        Length of the boundary of each pair, and mean evidence for two objects along it, shape (m,).
    colours, weights
        Mean colour of each region, shape (s, 3), and its weight in a mean, shape (s,).
    limit, colour_delay, full_difference
        Thresholds of :class:`~deixis.perception.detection.settings.BoundarySettings`.

    Notes
    -----
    The edges of a region form a doubly linked list. An edge e has two nodes in such lists, 2 e for its first end and
    2 e + 1 for its second. A merge visits the edges of both regions once, and each costs O(log m) in the heap. The heap
    holds each edge with evidence below the limit once, with its key.
    """
    count, m = len(weights), len(pairs)
    ends, length, total = pairs.copy(), lengths.copy(), lengths * evidence
    weight, tints = weights.copy(), colours * weights.reshape(-1, 1)
    means = tints / weights.reshape(-1, 1)
    first = np.full(count, -1, np.int64)
    after, before = np.full(2 * m, -1, np.int64), np.full(2 * m, -1, np.int64)
    keys, heap, place, size = np.empty(m), np.empty(m, np.int64), np.full(m, -1, np.int64), 0
    ties = np.empty(m, np.int64)
    for e in range(m):
        for side in range(2):
            _link(2 * e + side, ends[e, side], first, after, before)
        if total[e] < limit * length[e]:
            key = total[e] / length[e] + colour_delay * _unlike(means, ends[e, 0], ends[e, 1], full_difference)
            heap[size], keys[size], ties[e] = e, key, _tie(e, ends, count)
            size += 1
            _rise(size - 1, heap, keys, place, ties)
    root = np.arange(count)
    edge_to, marked = np.empty(count, np.int64), np.full(count, -1, np.int64)
    merges = 0
    while size:
        e = heap[0]
        size = _remove(e, heap, keys, place, size, ties)
        a, b = min(ends[e, 0], ends[e, 1]), max(ends[e, 0], ends[e, 1])
        small, large = (a, b) if weight[a] < weight[b] else (b, a)
        if _unlike(means, a, b, full_difference) == 1.0 and _is_on(
            small, large, limit, full_difference, means, ends, length, total, first, after
        ):
            continue
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
            if marked[other] == merges:  # adjacent to both
                length[edge_to[other]] += length[edge]
                total[edge_to[other]] += total[edge]
                _unlink(4 * edge + 1 - at, other, first, after, before)
                if place[edge] >= 0:
                    size = _remove(edge, heap, keys, place, size, ties)
            else:
                ends[edge, at % 2] = a
                _link(at, a, first, after, before)
            at = following
        first[b] = -1
        weight[a] += weight[b]
        for axis in range(3):
            tints[a, axis] += tints[b, axis]
            means[a, axis] = tints[a, axis] / weight[a]
        at = first[a]
        while at >= 0:
            edge = at // 2
            if total[edge] < limit * length[edge]:
                shade = _unlike(means, ends[edge, 0], ends[edge, 1], full_difference)
                key, i = total[edge] / length[edge] + colour_delay * shade, place[edge]
                tie = _tie(edge, ends, count)
                if i < 0:
                    i = size
                    size += 1
                    heap[i], keys[i], ties[edge] = edge, key, tie
                    _rise(i, heap, keys, place, ties)
                elif key != keys[i] or tie != ties[edge]:
                    keys[i], ties[edge] = key, tie
                    _rise(i, heap, keys, place, ties)
                    _sink(place[edge], heap, keys, place, size, ties)
            elif place[edge] >= 0:
                size = _remove(edge, heap, keys, place, size, ties)
            at = after[at]
    for i in range(count):  # a region was merged into one with a lower number
        root[i] = root[root[i]]
    return root


@njit(cache=True, nogil=True)
def _link(at, region, first, after, before):  # type: ignore[no-untyped-def]
    """Insert a node at the head of the list of a region."""
    after[at], before[at] = first[region], -1
    if first[region] >= 0:
        before[first[region]] = at
    first[region] = at


@njit(cache=True, nogil=True)
def _unlink(at, region, first, after, before):  # type: ignore[no-untyped-def]
    """Remove a node from the list of its region."""
    if before[at] >= 0:
        after[before[at]] = after[at]
    else:
        first[region] = after[at]
    if after[at] >= 0:
        before[after[at]] = before[at]


@njit(cache=True, nogil=True)
def _unlike(means, a, b, full_difference):  # type: ignore[no-untyped-def]
    """Return the difference in colour of two regions as a fraction of a full difference, at most 1."""
    x, y, z = means[a, 0] - means[b, 0], means[a, 1] - means[b, 1], means[a, 2] - means[b, 2]
    tint = x * x + y * y + z * z
    return 1.0 if tint >= full_difference * full_difference else np.sqrt(tint) / full_difference


@njit(cache=True, nogil=True)
def _is_on(a, b, limit, full_difference, means, ends, length, total, first, after):  # type: ignore[no-untyped-def]
    """Return True if the evidence between ``a`` and all neighbours with the colour of ``b`` reaches the limit.

    A neighbour has the colour of ``b`` if the two differ by less than half of ``full_difference``.
    """
    met, against, at = 0.0, 0.0, first[a]
    while at >= 0:
        edge, other = at // 2, ends[at // 2, 1 - at % 2]
        if _unlike(means, b, other, full_difference) < 0.5:
            met += length[edge]
            against += total[edge]
        at = after[at]
    return against >= limit * met


@njit(cache=True, nogil=True)
def _tie(e, ends, count):  # type: ignore[no-untyped-def]
    """Return a number that orders edges by their lower end, then by their higher end."""
    return min(ends[e, 0], ends[e, 1]) * count + max(ends[e, 0], ends[e, 1])


@njit(cache=True, nogil=True)
def _precedes(key, e, other_key, f, ties):  # type: ignore[no-untyped-def]
    """Return True if edge ``e`` is merged before edge ``f``."""
    return key < other_key or (key == other_key and ties[e] < ties[f])


@njit(cache=True, nogil=True)
def _rise(i, heap, keys, place, ties):  # type: ignore[no-untyped-def]
    e, key = heap[i], keys[i]
    while i:
        above = (i - 1) // _ARITY
        if not _precedes(key, e, keys[above], heap[above], ties):
            break
        heap[i], keys[i] = heap[above], keys[above]
        place[heap[i]] = i
        i = above
    heap[i], keys[i], place[e] = e, key, i


@njit(cache=True, nogil=True)
def _sink(i, heap, keys, place, size, ties):  # type: ignore[no-untyped-def]
    e, key = heap[i], keys[i]
    while _ARITY * i + 1 < size:
        child = _ARITY * i + 1
        for other in range(child + 1, min(child + _ARITY, size)):
            if _precedes(keys[other], heap[other], keys[child], heap[child], ties):
                child = other
        if not _precedes(keys[child], heap[child], key, e, ties):
            break
        heap[i], keys[i] = heap[child], keys[child]
        place[heap[i]] = i
        i = child
    heap[i], keys[i], place[e] = e, key, i


@njit(cache=True, nogil=True)
def _remove(e, heap, keys, place, size, ties):  # type: ignore[no-untyped-def]
    """Remove an edge from the heap, and return the new size."""
    i, last, key = place[e], heap[size - 1], keys[size - 1]
    place[e] = -1
    if last != e:
        heap[i], keys[i], place[last] = last, key, i
        _rise(i, heap, keys, place, ties)
        _sink(place[last], heap, keys, place, size - 1, ties)
    return size - 1
