"""D2 descriptor: a histogram of distances between points, with length, width and thickness.

D2 is the histogram of distances between random pairs of points of R. Osada, T. Funkhouser, B. Chazelle, D. Dobkin:
Shape distributions, ACM Transactions on Graphics 21(4), 2002. It is the baseline for the other descriptors.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.points.keypoints import voxel_keypoints


@dataclass(frozen=True)
class D2ExtentsDescriber:
    """Global descriptor: a histogram of distances that sums to 1, and three extents; needs two distinct points.

    The distances are those of ``pairs`` pairs, drawn with ``seed`` from one point per voxel of ``voxel`` metres, so
    that neither the density nor the order of points matters. Bins go from 0 to the longest distance drawn. The extents
    are those along the principal axes, longest first, in metres times ``weight``: size matters, pose does not.
    """

    bins: int = 32
    pairs: int = 20_000
    voxel: float = 0.005
    weight: float = 1.0
    seed: int = 0

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "d2_extents"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return self.bins + 3

    @property
    def local(self) -> bool:
        """False: there is one descriptor for the view."""
        return False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute the histogram of distances of pairs of points, with the extents.

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
        points = points[voxel_keypoints(points, self.voxel)]
        if len(points) < 2:
            return np.empty((0, self.size), np.float32)
        rng = np.random.default_rng(self.seed)
        one = rng.integers(len(points), size=self.pairs)
        other = (one + rng.integers(1, len(points), size=self.pairs)) % len(points)
        distances = np.linalg.norm(points[one] - points[other], axis=1)
        counts, _ = np.histogram(distances, self.bins, (0.0, float(distances.max())))
        centred = points - points.mean(axis=0)
        axes = np.linalg.eigh(centred.T @ centred)[1]
        return np.concatenate([counts / self.pairs, self.weight * np.sort(np.ptp(centred @ axes, axis=0))[::-1]])[
            None
        ].astype(np.float32)
