"""Colour descriptor: a histogram of chromaticities, which shade and exposure hardly change.

A brighter lamp, a shadow or a tilted surface multiplies red, green and blue by the same factor, and keeps their ratios.
A point therefore counts by the logarithms of red and of blue over green (the log-chromaticity of Finlayson and Hordley:
Color constancy at a pixel, Journal of the Optical Society of America A 18(2), 2001). Each point is shared among the
four nearest cells, so that a small change of the lamp's colour changes the histogram only a little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud

DARK = 16.0
"""Offset added to red, green and blue (0 to 255) before their ratio: that of dark points is mostly noise."""

LARGEST_RATIO = 0.8
"""Logarithm of the ratio at the centre of the outermost cells, which also hold all larger ratios."""


@dataclass(frozen=True)
class ColourDescriber:
    """Colour descriptor: square roots of the shares of a view's points in ``cells`` by ``cells`` chromaticities.

    The Euclidean distance between two such vectors is the Hellinger distance. A cloud without colours has no
    descriptor.
    """

    cells: int = 8

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "colour"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return self.cells * self.cells

    @property
    def local(self) -> bool:
        """False: there is one descriptor for the view."""
        return False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute the colour histogram of a cloud, rows by red over green.

        Parameters
        ----------
        cloud
            The points of one object, with colours.

        Returns
        -------
        ndarray
            Descriptor of shape (1, size); (0, size) for a cloud without colours or points.

        Examples
        --------
        >>> red = np.full((9, 3), (200, 20, 20), np.uint8)
        >>> bright, dim = (PointCloud(np.zeros((9, 3), np.float32), each) for each in (red, red // 2))
        >>> between = ColourDescriber().describe(bright) - ColourDescriber().describe(dim)
        >>> float(np.linalg.norm(between)) < 0.2
        True
        """
        if cloud.colours is None or not cloud.finite.any():
            return np.empty((0, self.size), np.float32)
        seen = np.log(cloud.colours[cloud.finite] + DARK)
        ratios = seen[:, [0, 2]] - seen[:, [1]]
        place = (np.clip(ratios / LARGEST_RATIO, -1, 1) + 1) / 2 * (self.cells - 1)
        low = np.minimum(place.astype(np.int64), self.cells - 2)
        beyond = place - low
        counts = np.zeros(self.size)
        for row in (0, 1):
            for column in (0, 1):
                share = np.abs(1 - row - beyond[:, 0]) * np.abs(1 - column - beyond[:, 1])
                counts += np.bincount((low[:, 0] + row) * self.cells + low[:, 1] + column, share, minlength=self.size)
        return np.sqrt(counts / len(seen))[None].astype(np.float32)
