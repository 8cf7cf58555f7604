"""Find the points above the table, by heights averaged over neighbours and two thresholds that follow the noise.

The tines of a fork are a few millimetres high. The noise of a depth camera at one metre is half of that for one pixel,
and far less for a mean over neighbours. As in edge detection (Canny 1986), points above the upper threshold count, and
so do connected points above the lower one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.quantiles import median
from deixis.perception.detection.settings import DetectionSettings, HeightSettings
from deixis.perception.detection.table.neighbours import Neighbours


@dataclass(frozen=True, eq=False)
class Raised:
    """Points above the table, and the noise of their heights.

    ``above`` (n,) marks the points that may be objects, ``too_high`` (n,) those above the reach. ``noise`` is the
    standard deviation of one height, ``averaged`` that of a mean over neighbours, both in metres at one metre from the
    sensor.
    """

    above: NDArray[np.bool_]
    too_high: NDArray[np.bool_]
    noise: float
    averaged: float
    settings: HeightSettings

    def upper(self, distance: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height in metres that exceeds the noise, shape (n,), at distances (n,) from the sensor.

        Parameters
        ----------
        distance
            Distances of n points from the sensor, shape (n,), in metres.

        Returns
        -------
        ndarray
            Heights of shape (n,), in metres.
        """
        nearest = self.settings.min_noise_distance
        return self.settings.upper_threshold * self.averaged * np.maximum(distance, nearest) ** 2


def raised(
    heights: NDArray[np.float64],
    distance: NDArray[np.float64],
    neighbours: Neighbours,
    settings: DetectionSettings,
) -> Raised:
    """Return the points above the table, from their heights.

    The noise of a depth sensor grows with the square of the distance; its size is measured on the table.

    Parameters
    ----------
    heights
        Heights of n points above the plane of the table, shape (n,), in metres.
    distance
        Distances of the points from the sensor, shape (n,), in metres.
    neighbours
        Neighbours of the points.
    settings
        Thresholds, in metres and in units of the noise.

    Returns
    -------
    Raised
        Mask of the points above the table, shape (n,), and the noise of heights before and after smoothing.

    Notes
    -----
    The growth of the noise is that of Khoshelham and Elberink (2012).
    """
    limits = settings.heights
    growth = np.maximum(distance, limits.min_noise_distance) ** 2
    noise = _noise(heights, growth, limits)
    mean = neighbours.averaged(heights, np.maximum(6 * noise * growth, settings.height), limits.smoothing_rounds)
    left = _noise(mean, growth, limits)
    upper = np.maximum(settings.height, limits.upper_threshold * left * growth)
    lower = np.maximum(settings.height / 4, limits.lower_threshold * left * growth)
    highest = settings.reach
    above = neighbours.grown((mean > upper) & (mean < highest), (mean > lower) & (mean < highest))
    return Raised(above, (mean >= highest) | (heights >= highest), noise, left, limits)


def _noise(heights: NDArray[np.float64], growth: NDArray[np.float64], limits: HeightSettings) -> float:
    """Return the standard deviation of the heights of the table at one metre, by the median.

    It uses only the points below the plane, because objects are among those above.
    """
    from deixis.perception.detection.kernels import depths_below

    below = depths_below(heights, growth, limits.noise_band)
    return max(1.4826 * median(below), limits.min_noise) if len(below) else limits.min_noise
