"""GOOD, the global orthographic object descriptor: three projections of an object along its own axes.

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
"""The axes that span the planes YoZ, XoZ and XoY."""


@dataclass(frozen=True)
class GoodDescriber:
    """Three histograms of ``bins`` x ``bins``, each summing to 1; needs three points that do not lie in one place.

    The frame is that of the principal axes at the centroid, the first where the object is longest; each histogram
    covers a square with the side of the object's longest extent about the centroid, so that scale does not count;
    what lies outside is left out. The projection of largest entropy comes first, the other two follow by increasing
    variance. An axis points to where more points lie farther than ``threshold`` metres off the centre. The paper
    multiplies the signs of two axes and turns both by the product, which leaves the result to the signs that a solver
    returns; here each is turned by its own, and where counts are equal by the sum of cubes.
    """

    bins: int = 15
    threshold: float = 0.0015

    @property
    def name(self) -> str:
        return "good"

    @property
    def size(self) -> int:
        return 3 * self.bins * self.bins

    @property
    def local(self) -> bool:
        return False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Return the descriptor (1, size)."""
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
    """Return the variance of the number of the bin, counted row by row."""
    numbers = np.arange(1, len(view) + 1)
    mean = float(numbers @ view)
    return float((numbers - mean) ** 2 @ view)
