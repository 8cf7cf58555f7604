"""What every descriptor looks like from outside."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud


class Describer(Protocol):
    """Turns an object's view into numbers; two of the same settings describe the same view in the same way.

    ``size`` is the length of a descriptor; ``local`` says whether there is one for each keypoint, or one for the view.
    """

    @property
    def name(self) -> str: ...

    @property
    def size(self) -> int: ...

    @property
    def local(self) -> bool: ...

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Descriptors (k, size) of a single object's cloud: one for each keypoint, or k = 1.

        Points without depth are ignored. A view with nothing to describe (no finite point, or none with what the
        descriptor needs) gives (0, size).
        """
        ...


def finite_points(cloud: PointCloud) -> NDArray[np.float64]:
    """The points that have a depth, (m, 3)."""
    return cloud.points[cloud.finite].astype(np.float64)
