"""A box that is turned about the vertical, as narrow around a thing as it can be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class OrientedBox:
    """A box in the frame of its scene, metres. ``yaw`` is the angle from the x axis to the first of its level sides, in
    radians, counter-clockwise as seen from above; ``extents`` are that side, the other level one, and the height.

    >>> knife = OrientedBox((0.3, 0.2, 0.005), np.pi / 2, (0.22, 0.02, 0.01))
    >>> knife.axes.round(3).tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """

    centre: tuple[float, float, float]
    yaw: float
    extents: tuple[float, float, float]

    def rounded(self, digits: int) -> OrientedBox:
        """The same to so many digits after the point."""
        x, y, z, length, width, height = (round(value, digits) for value in (*self.centre, *self.extents))
        return OrientedBox((x, y, z), round(self.yaw, digits), (length, width, height))

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors (3, 3) along the extents, in rows, right-handed, the last one up."""
        return turned_axes(self.yaw)


def turned_axes(yaw: float) -> NDArray[np.float64]:
    """The axes (3, 3), in rows, turned about the vertical."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
