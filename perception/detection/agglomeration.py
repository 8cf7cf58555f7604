"""Regions that are merged, the most alike first, until every boundary that is left speaks for two things."""

from __future__ import annotations

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.boundaries import Boundaries

TINT, FULL = 0.3, 6.0
"""By so much of evidence regions of other colours are merged later, and the difference of colour that makes it whole.
"""


def agglomerated(
    meeting: Boundaries, limit: float, colours: NDArray[np.float64], weights: NDArray[np.float64]
) -> NDArray[np.int32]:
    """The region (s,) that each of s patches ends in, numbered from 0 in the order of their first patches.

    The evidence between two regions is the mean over their common boundary (average linkage). Those with the least are
    merged, as long as that is below ``limit``; ties go to the pair with the smaller numbers. ``colours`` (s, 3), with
    what each counts for in a mean, ``weights`` (s,), only decide what is merged first: where a knife ends on the rim
    of a plate nothing but colour tells the two apart, and once the rim is whole, all else where the knife crosses it
    does. What is of several colours is merged all the same, as what is printed on a box is.

    >>> chain = Boundaries(np.array([[0, 1], [1, 2]]), np.ones(2), np.array([0.1, 0.9]), np.zeros(2))
    >>> agglomerated(chain, 0.5, np.zeros((3, 3)), np.ones(3)).tolist()
    [0, 0, 1]
    """
    regions = _Regions(meeting, colours, weights)
    heap = [(regions.delay(a, b), a, b) for a, others in enumerate(regions.around) for b in others if a < b]
    heapq.heapify(heap)
    parent = list(range(len(weights)))
    while heap and heap[0][0] < limit + TINT:
        delay, a, b = heapq.heappop(heap)
        if b in regions.around[a] and regions.delay(a, b) == delay and regions.evidence(a, b) < limit:
            parent[b] = a
            regions.merge(a, b)
            for c in regions.around[a]:
                first, second = min(a, c), max(a, c)
                heapq.heappush(heap, (regions.delay(first, second), first, second))
    return numbered(parent)


class _Regions:
    """``around`` leads from a region to those that it meets, with how long, and the evidence times that."""

    def __init__(self, meeting: Boundaries, colours: NDArray[np.float64], weights: NDArray[np.float64]) -> None:
        self.around: list[dict[int, tuple[float, float]]] = [{} for _ in weights]
        rows = zip(meeting.pairs.tolist(), meeting.lengths.tolist(), meeting.evidence.tolist(), strict=True)
        for (a, b), length, evidence in rows:
            self.around[a][b] = self.around[b][a] = (length, length * evidence)
        self._weights: list[float] = weights.tolist()
        self._colours: list[list[float]] = (colours * weights[:, None]).tolist()  # times the weights

    def evidence(self, a: int, b: int) -> float:
        """What speaks for two things."""
        length, total = self.around[a][b]
        return total / length

    def delay(self, a: int, b: int) -> float:
        """The same, and more where their colours differ."""
        tint = 0.0
        for one, other in zip(self._colours[a], self._colours[b], strict=True):
            tint += (one / self._weights[a] - other / self._weights[b]) ** 2
        return self.evidence(a, b) + TINT * min(math.sqrt(tint) / FULL, 1.0)

    def merge(self, a: int, b: int) -> None:
        """Region b becomes part of region a."""
        del self.around[a][b], self.around[b][a]
        for c, (length, total) in self.around[b].items():
            del self.around[c][b]
            before = self.around[a].get(c, (0.0, 0.0))
            self.around[a][c] = self.around[c][a] = (before[0] + length, before[1] + total)
        self.around[b] = {}
        self._weights[a] += self._weights[b]
        self._colours[a] = [one + other for one, other in zip(self._colours[a], self._colours[b], strict=True)]


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
