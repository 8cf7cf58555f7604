"""GOOD, the global orthographic object descriptor: three projections of an object along its principal axes.

S. H. Kasaei, A. M. Tomé, L. Seabra Lopes, M. Oliveira: GOOD: a global orthographic object descriptor for 3D object
recognition and manipulation, Pattern Recognition Letters 83, 2016.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points

PLANES = ((1, 2), (0, 2), (0, 1))
"""Pairs of axes that span the planes YoZ, XoZ and XoY."""


@dataclass(frozen=True)
class GoodDescriber:
    """Global descriptor: three histograms of ``bins`` x ``bins``, which sum to 1 each; needs three distinct points.

    The frame has its origin in the centroid and follows the principal axes, the longest first. Each histogram covers a
    square about the centroid whose side is the object's longest extent, so that scale does not matter; points outside
    are ignored. The projection with the largest entropy comes first; the other two follow by increasing variance. An
    axis points to the side with more points farther than ``threshold`` metres from the centre. The paper multiplies the
    signs of two axes and applies the product to both, so that the result depends on the signs that a solver returns;
    here each axis has its own sign, which follows the sum of cubes if the counts are equal.
    """

    bins: int = 15
    threshold: float = 0.0015

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "good"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return 3 * self.bins * self.bins

    @property
    def local(self) -> bool:
        """False: there is one descriptor for the view."""
        return False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute the global orthographic object descriptor of a cloud.

        Parameters
        ----------
        cloud
            The points of one object, in metres.

        Returns
        -------
        ndarray
            Descriptor of shape (1, size); (0, size) for a cloud without points.
        """
        points = finite_points(cloud)
        if len(points) < 3 or not np.ptp(points, axis=0).any():
            return np.empty((0, self.size), np.float32)
        centred = points - points.mean(axis=0)
        axes = np.linalg.eigh(centred.T @ centred)[1][:, ::-1]
        x = axes[:, 0] * self._sign(centred @ axes[:, 0])
        y = axes[:, 1] * self._sign(centred @ axes[:, 1])
        placed: NDArray[np.float64] = centred @ np.stack([x, y, np.cross(x, y)], axis=1)
        side = float(np.ptp(placed, axis=0).max())
        views = [self._projection(placed[:, list(plane)], side) for plane in PLANES]
        first = views.pop(int(np.argmax([_entropy(view) for view in views])))
        return np.concatenate([first, *sorted(views, key=_variance)])[None].astype(np.float32)

    def _sign(self, along: NDArray[np.float64]) -> float:
        more = int((along > self.threshold).sum()) - int((along < -self.threshold).sum())
        return -1.0 if more < 0 or (more == 0 and (along**3).sum() < 0) else 1.0

    def _projection(self, flat: NDArray[np.float64], side: float) -> NDArray[np.float64]:
        cells = np.floor((flat / side + 0.5) * self.bins).astype(np.int64)
        cells = cells[((cells >= 0) & (cells < self.bins)).all(axis=1)]
        counts = np.bincount(cells[:, 0] * self.bins + cells[:, 1], minlength=self.bins * self.bins)
        return counts / max(int(counts.sum()), 1)


def _entropy(view: NDArray[np.float64]) -> float:
    some = view[view > 0]
    return -float((some * np.log2(some)).sum())


def _variance(view: NDArray[np.float64]) -> float:
    """Return the variance of the bin number; bins are numbered row by row."""
    numbers = np.arange(1, len(view) + 1)
    mean = float(numbers @ view)
    return float((numbers - mean) ** 2 @ view)
