"""Boxes that are turned about the vertical, and rotations about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.arguments import checks_arguments


@dataclass(frozen=True, slots=True)
class OrientedBox:
    """Box in the frame of its scene that is turned about the vertical.

    Parameters
    ----------
    centre
        x, y and z of its centre, in metres.
    yaw
        Angle from the x axis to its first horizontal side, in radians, counter-clockwise as seen from above.
    extents
        Lengths of the first and second horizontal side, and the height, in metres.

    Examples
    --------
    >>> knife = OrientedBox((0.3, 0.2, 0.005), np.pi / 2, (0.22, 0.02, 0.01))
    >>> knife.axes.round(3).tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    >>> knife.corners.min(axis=0).round(3).tolist(), knife.corners.max(axis=0).round(3).tolist()
    ([0.29, 0.09, 0.0], [0.31, 0.31, 0.01])
    >>> knife.rounded(1)
    OrientedBox(centre=(0.3, 0.2, 0.0), yaw=1.6, extents=(0.2, 0.0, 0.0))
    """

    centre: tuple[float, float, float]
    yaw: float
    extents: tuple[float, float, float]

    @checks_arguments
    def rounded(self, digits: int) -> OrientedBox:
        """Return the box with rounded coordinates and extents.

        Parameters
        ----------
        digits
            Number of decimals, in the unit of the scene.

        Returns
        -------
        OrientedBox
            The box with all of its numbers rounded.
        """
        x, y, z, length, width, height = (round(value, digits) for value in (*self.centre, *self.extents))
        return OrientedBox((x, y, z), round(self.yaw, digits), (length, width, height))

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors along the extents as rows, shape (3, 3), right-handed; the last one points up."""
        return turned_axes(self.yaw)

    @property
    def corners(self) -> NDArray[np.float64]:
        """Corners in the frame of the scene, shape (8, 3)."""
        signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        corners: NDArray[np.float64] = signs * self.extents @ self.axes + self.centre
        return corners

    def to_open3d(self) -> Any:
        """Return the box for Open3D.

        Returns
        -------
        open3d.geometry.OrientedBoundingBox
            The box with its centre, rotation and extents.

        Raises
        ------
        MissingExtraError
            If Open3D is not installed.

        Examples
        --------
        >>> OrientedBox((0.3, 0.2, 0.0), 0.5, (0.2, 0.1, 0.1)).to_open3d().extent.tolist()
        [0.2, 0.1, 0.1]
        """
        from deixis.perception.open3d import open3d

        return open3d().geometry.OrientedBoundingBox(np.array(self.centre), self.axes.T, np.array(self.extents))


def turned_axes(yaw: float) -> NDArray[np.float64]:
    """Return axes turned about the vertical.

    Parameters
    ----------
    yaw
        Angle in radians, counter-clockwise seen from above.

    Returns
    -------
    ndarray
        The axes as rows, shape (3, 3).
    """
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def yaw_of(turn: NDArray[np.float64]) -> float:
    """Return the angle about the vertical of a rotation, that of the nearest rotation about the vertical alone.

    Parameters
    ----------
    turn
        Rotation matrix of shape (3, 3).

    Returns
    -------
    float
        Angle in radians, counter-clockwise seen from above.

    Examples
    --------
    >>> round(yaw_of(turned_axes(0.5).T), 6)
    0.5
    """
    return float(np.arctan2(turn[1, 0] - turn[0, 1], turn[0, 0] + turn[1, 1]))
