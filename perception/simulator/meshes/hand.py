"""Build the solid of a forearm with its hand, which grips from above."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.meshes.solids import joined, tube
from deixis.perception.simulator.meshes.tableware import Colour

SKIN: Colour = (206, 160, 132)

ARM_RISE = np.deg2rad(15.0)
"""Angle in radians of the forearm above the table's plane."""

ARM_LENGTH = 1.2
"""Length of the arm with the hand, in metres."""


def hand() -> Mesh:
    """Return a right hand with its forearm: the fingers point down, and the forearm goes back along -y and upwards.

    The origin is the grip, between the tips of the fingers and the thumb.

    Returns
    -------
    Mesh
        Mesh in metres, with z up.

    Examples
    --------
    >>> grip = hand().vertices
    >>> bool(grip[:, 2].min() > -0.02), bool(grip[:, 1].min() < -0.35)
    (True, True)
    """
    back, up = -np.cos(ARM_RISE), np.sin(ARM_RISE)
    wrist = np.array([0.0, -0.07, 0.105])
    reach = np.array([0.0, 0.25, 0.6, 1.0])[:, None] * (ARM_LENGTH - 0.16)
    forearm = wrist + reach * np.array([0.0, back, up])
    fingers = _path((0.0, 0.012, -0.005), (0.0, 0.016, 0.045), (0.0, -0.015, 0.085), wrist)
    thumb = _path((0.0, -0.014, -0.003), (0.0, -0.032, 0.035), (0.0, -0.05, 0.08))
    return joined(
        tube(np.concatenate([fingers, forearm[1:]]), [0.055, 0.075, 0.085, 0.06, 0.065, 0.085, 0.09], _DEPTHS),
        tube(thumb, [0.018, 0.022, 0.028], [0.016, 0.02, 0.026]),
    )


_DEPTHS = [0.014, 0.02, 0.03, 0.042, 0.05, 0.07, 0.075]


def _path(*points: tuple[float, float, float] | NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array([np.asarray(point, dtype=np.float64) for point in points])
