"""Compare colours of one thing in the light of any of its sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SHADE_SPREAD, COLOUR_SPREAD = 38.0, 15.0
"""Standard deviations of the colours of one place of a thing, as distances in RGB from 0 to 255: of the length of the
colour, which changes with the light on a turned surface, and across that direction.
"""


def likeness(
    tints: NDArray[np.float64], colours: NDArray[np.float64], shade: float = SHADE_SPREAD
) -> NDArray[np.float64]:
    """Return how well colours agree with the nearest of some others, in the light of any side of a thing.

    Parameters
    ----------
    tints
        Colours of shape (k, 3), from 0 to 255.
    colours
        Colours of shape (m, 3) that they may be.
    shade
        Standard deviation of the lengths of the colours, which change with the light.

    Returns
    -------
    ndarray
        Likeness in [0, 1], shape (k,).
    """
    least = np.full(len(tints), np.inf)
    other = (tints**2).sum(axis=1)
    for colour in colours:
        own = float(colour @ colour)
        across = other - (tints @ colour) ** 2 / max(own, 1.0)
        along = (np.sqrt(other) - np.sqrt(own)) ** 2
        least = np.minimum(least, along / shade**2 + across / COLOUR_SPREAD**2)
    found: NDArray[np.float64] = np.exp(-0.5 * least)
    return found
