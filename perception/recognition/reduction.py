"""A few numbers in place of a descriptor, from which its distance to another can only come out too small.

A turn of the axes keeps all distances. Of the turned vectors the coordinates along the first axes are kept, and the
length of the rest: for x = (a, r) and y = (b, s), |x - y|^2 >= |a - b|^2 + (|r| - |s|)^2. Axes are the principal ones
of a sample, so that the bound is near the distance where descriptors vary in few directions, as spin images do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.views import PackedViews, squared_lengths

SAMPLE = 20_000
"""Descriptors that principal axes are computed from, at most."""

BLOCK = 65_536
"""Descriptors reduced at a time, which bounds memory where views are mapped from a file."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """The origin (d,) and p orthonormal axes (d, p) of reduced descriptors, p < ``kernels.AXES``.

    ``count`` is how many descriptors there were when they were chosen: bounds are right whatever they are, and looser
    where later descriptors vary in other directions. ``share`` of their variance lies along the axes.
    """

    origin: NDArray[np.float64]
    axes: NDArray[np.float64]
    count: int
    share: float

    @classmethod
    def of(cls, packs: list[PackedViews]) -> Reduction:
        """The principal axes of what the packs hold, from an even sample of it; at least one pack is not empty."""
        from deixis.perception.recognition.kernels import AXES

        count = sum(len(pack.descriptors) for pack in packs)
        step = -(-count // SAMPLE)
        sample = np.concatenate([pack.descriptors[::step] for pack in packs if len(pack)]).astype(np.float64)
        origin = sample.mean(axis=0)
        sample -= origin
        variances, vectors = np.linalg.eigh(sample.T @ sample)
        total = variances.sum()
        share = float(variances[1 - AXES :].sum() / total) if total > 0 else 1.0
        return cls(origin, np.ascontiguousarray(vectors[:, ::-1][:, : AXES - 1]), count, share)

    def __call__(self, descriptors: NDArray[np.float32]) -> NDArray[np.float32]:
        """Reduced descriptors (n, AXES + 1) of descriptors (n, d), the last column their squared lengths."""
        from deixis.perception.recognition.kernels import AXES

        out = np.zeros((len(descriptors), AXES + 1), np.float32)
        for low in range(0, len(descriptors), BLOCK):
            moved = descriptors[low : low + BLOCK] - self.origin
            along = moved @ self.axes
            rest = np.sqrt(np.maximum(np.square(moved).sum(axis=1) - np.square(along).sum(axis=1), 0.0))
            part = out[low : low + BLOCK]
            part[:, : along.shape[1]] = along
            part[:, AXES - 1] = rest
            part[:, AXES] = squared_lengths(part[:, :AXES])
        return out


def longest(reduced: NDArray[np.float32]) -> float:
    """The greatest length of reduced descriptors (n, AXES + 1)."""
    from deixis.perception.recognition.kernels import AXES

    return float(np.sqrt(reduced[:, AXES].max(initial=0.0)))


def slack(one: float, other: float) -> float:
    """By how much rounding can make a squared distance too large, of reduced descriptors of these lengths at most."""
    from deixis.perception.recognition.kernels import AXES, EPSILON

    return 4.0 * (AXES + 8) * EPSILON * (one + other) ** 2
