"""Regions that are merged, the most alike first, until every boundary that is left speaks for two things."""

from __future__ import annotations

import heapq

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.boundaries import Boundaries


def agglomerated(count: int, meeting: Boundaries, limit: float) -> NDArray[np.int32]:
    """The region (count,) that each patch ends in, numbered from 0 in the order of their first patches.

    The evidence between two regions is the mean over their common boundary (average linkage). Those with the least are
    merged, as long as that is below ``limit``; ties go to the pair with the smaller numbers.

    >>> chain = Boundaries(np.array([[0, 1], [1, 2]]), np.ones(2), np.array([0.1, 0.9]), np.zeros(2))
    >>> agglomerated(3, chain, limit=0.5).tolist()
    [0, 0, 1]
    """
    around: list[dict[int, tuple[float, float]]] = [{} for _ in range(count)]
    rows = zip(meeting.pairs.tolist(), meeting.lengths.tolist(), meeting.evidence.tolist(), strict=True)
    for (a, b), length, evidence in rows:
        around[a][b] = around[b][a] = (length, length * evidence)
    heap = [(total / length, a, b) for a in range(count) for b, (length, total) in around[a].items() if a < b]
    heapq.heapify(heap)
    parent = list(range(count))
    while heap:
        evidence, a, b = heapq.heappop(heap)
        if evidence >= limit:
            break
        if b in around[a] and around[a][b][1] / around[a][b][0] == evidence:
            parent[b] = a
            _merge(around, heap, a, b)
    return numbered(parent)


def _merge(around: list[dict[int, tuple[float, float]]], heap: list[tuple[float, int, int]], a: int, b: int) -> None:
    """Region b becomes part of region a."""
    del around[a][b], around[b][a]
    for c, (length, total) in around[b].items():
        del around[c][b]
        before = around[a].get(c, (0.0, 0.0))
        merged = (before[0] + length, before[1] + total)
        around[a][c] = around[c][a] = merged
        heapq.heappush(heap, (merged[1] / merged[0], min(a, c), max(a, c)))
    around[b] = {}


def numbered(parent: list[int]) -> NDArray[np.int32]:
    """The trees that parents make, each root its own parent, numbered from 0 in the order of their first members."""
    roots = []
    for start in range(len(parent)):
        at = start
        while parent[at] != at:
            parent[at] = at = parent[parent[at]]
        roots.append(at)
    _, first, place = np.unique(roots, return_index=True, return_inverse=True)
    rank = np.empty(len(first), np.int32)
    rank[np.argsort(first)] = np.arange(len(first))
    result: NDArray[np.int32] = rank[place]
    return result
