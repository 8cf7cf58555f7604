"""Parts: pieces of surface of which things consist, and how they meet.

What speaks for or against one thing is read off the patches: how long two parts meet, which of them is above the other
there, whether their colours are alike.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.boundaries import Boundaries
from deixis.perception.detection.supervoxels import Supervoxels, means, sums

Measure = Callable[["Parts", NDArray[np.intp], NDArray[np.intp]], float]


@dataclass(frozen=True, eq=False)
class Parts:
    """``of`` (s,) is the part, 0 to p - 1, that each patch belongs to. Heights are those above the table."""

    of: NDArray[np.int32]
    patches: Supervoxels
    meeting: Boundaries
    known: dict[tuple[object, ...], float] = field(default_factory=dict, repr=False)

    def __len__(self) -> int:
        return int(self.of.max()) + 1 if len(self.of) else 0

    def members(self, part: int) -> NDArray[np.intp]:
        """Its patches."""
        return np.flatnonzero(self.of == part)

    def once(self, measure: Measure, a: int, b: int) -> float:
        """What a function of the patches of two parts gives, worked out once: joining others does not change it."""
        key = (measure, *self._marks[a], *self._marks[b])
        if key not in self.known:
            self.known[key] = measure(self, self.members(a), self.members(b))
        return self.known[key]

    @cached_property
    def _marks(self) -> list[tuple[int, int]]:
        """The first patch of each part and how many it has: parts only grow, so that these tell one from all others."""
        _, first, count = np.unique(self.of, return_index=True, return_counts=True)
        return list(zip(first.tolist(), count.tolist(), strict=True))

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Square metres of surface that are seen, (p,)."""
        return sums(self.of, self.patches.areas)

    @cached_property
    def tops(self) -> NDArray[np.float64]:
        """The height of the highest patch, (p,)."""
        result = np.full(len(self), -np.inf)
        np.maximum.at(result, self.of, self.patches.middles[:, 2])
        return result

    @cached_property
    def bottoms(self) -> NDArray[np.float64]:
        """The height of the lowest patch, (p,)."""
        result = np.full(len(self), np.inf)
        np.minimum.at(result, self.of, self.patches.middles[:, 2])
        return result

    @cached_property
    def middles(self) -> NDArray[np.float64]:
        """The mean height, (p,)."""
        return means(self.of, self.patches.middles, self.patches.sizes)[:, 2]

    @cached_property
    def plans(self) -> NDArray[np.float64]:
        """The least and the greatest corner of the box around a part as seen from above, (2, p, 2)."""
        low, high = np.full((len(self), 2), np.inf), np.full((len(self), 2), -np.inf)
        np.minimum.at(low, self.of, self.patches.middles[:, :2])
        np.maximum.at(high, self.of, self.patches.middles[:, :2])
        return np.stack([low, high])

    @cached_property
    def centres(self) -> NDArray[np.float64]:
        """The middle of that box, (p, 2)."""
        result: NDArray[np.float64] = self.plans.mean(axis=0)
        return result

    @cached_property
    def widths(self) -> NDArray[np.float64]:
        """The longer side of that box, (p,)."""
        result: NDArray[np.float64] = (self.plans[1] - self.plans[0]).max(axis=1)
        return result

    @cached_property
    def gaps(self) -> NDArray[np.float64]:
        """How far those boxes are apart, (p, p): no patches of two parts are nearer, as seen from above."""
        low, high = self.plans
        apart = np.maximum(low[:, None] - high[None], low[None] - high[:, None]).clip(0.0)
        result: NDArray[np.float64] = np.linalg.norm(apart, axis=2)
        return result

    @cached_property
    def colours(self) -> NDArray[np.float64]:
        """The mean colour, lightness scaled down, (p, 3)."""
        return means(self.of, self.patches.tints, self.patches.weights)

    @cached_property
    def motley(self) -> NDArray[np.float64]:
        """How much the colours of its patches vary, a standard deviation, (p,)."""
        off, weights = ((self.patches.tints - self.colours[self.of]) ** 2).sum(axis=1), self.patches.weights
        return np.sqrt(sums(self.of, off * weights) / sums(self.of, weights))

    @cached_property
    def bulge(self) -> NDArray[np.float64]:
        """How convex a part is, (p,): 1 a sphere from outside, 0 a plane, -1 a sphere from inside."""
        out = self.patches.middles - means(self.of, self.patches.middles, self.patches.sizes)[self.of]
        along = sums(self.of, (out * self.patches.normals).sum(axis=1) * self.patches.sizes)
        return along / np.maximum(sums(self.of, np.linalg.norm(out, axis=1) * self.patches.sizes), 1e-9)

    @cached_property
    def lengths(self) -> NDArray[np.float64]:
        """How long two parts meet, in pairs of neighbours, (p, p)."""
        return self._between(np.ones(len(self.meeting.pairs)))

    @cached_property
    def smooth(self) -> NDArray[np.float64]:
        """How long they meet without a jump of depth, (p, p)."""
        return self._between(1 - self.meeting.jumped)

    @cached_property
    def evidence(self) -> NDArray[np.float64]:
        """What speaks for two things, a mean over where they meet, (p, p); infinite where they do not."""
        total = self._between(self.meeting.evidence)
        return np.divide(total, self.lengths, out=np.full_like(total, np.inf), where=self.lengths > 0)

    @cached_property
    def rise(self) -> NDArray[np.float64]:
        """How far the first part is above the second where they meet, a mean, (p, p); 0 where they do not."""
        i, j = self.meeting.pairs.T
        height = self.patches.middles[:, 2]
        total = self._between(height[i] - height[j], sign=-1.0)
        return np.divide(total, self.lengths, out=np.zeros_like(total), where=self.lengths > 0)

    def unlike(self) -> NDArray[np.float64]:
        """The difference between the colours of parts, (p, p)."""
        result: NDArray[np.float64] = np.linalg.norm(self.colours[:, None] - self.colours[None], axis=2)
        return result

    def joined(self, pairs: NDArray[np.intp]) -> Parts:
        """The same with the parts of each pair (k, 2) made one."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        count = len(self)
        links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
        of = connected_components(links, directed=False)[1][self.of].astype(np.int32)
        return replace(self, of=of)

    def _between(self, values: NDArray[np.float64], sign: float = 1.0) -> NDArray[np.float64]:
        """Sums over where parts meet, weighted by length; the other way round with another ``sign``."""
        a, b = self.of[self.meeting.pairs].T.astype(np.int64)
        apart = a != b
        count, weighted = len(self), values * self.meeting.lengths
        total = sums(a[apart] * count + b[apart], weighted[apart], count * count).reshape(count, count)
        result: NDArray[np.float64] = total + sign * total.T
        return result
