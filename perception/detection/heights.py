"""What rises above the table: heights averaged over neighbours, and two thresholds that follow the sensor's noise.

A fork's tines are a few millimetres high, a depth camera's noise at one metre is half of that for one pixel, and far
less for the mean of its neighbours. As in edge detection (Canny 1986), points above the upper threshold are things,
and so is whatever above the lower one is connected with them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings, HeightSettings


@dataclass(frozen=True, eq=False)
class Raised:
    """``above`` (n,): which points are things; ``noise`` the standard deviation of one height, ``averaged`` that of a
    mean over neighbours, both in metres at one metre from the sensor."""

    above: NDArray[np.bool_]
    noise: float
    averaged: float
    settings: HeightSettings

    def upper(self, distance: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height (n,) that is surely no noise, at distances (n,) from the sensor."""
        nearest = self.settings.min_noise_distance
        return self.settings.upper_threshold * self.averaged * np.maximum(distance, nearest) ** 2


def raised(
    heights: NDArray[np.float64],
    distance: NDArray[np.float64],
    neighbours: NDArray[np.int32],
    settings: DetectionSettings,
) -> Raised:
    """Return which of the points are above the table, by their heights (n,) and their distances (n,) from the sensor.

    A sensor's noise grows with the square of the distance (Khoshelham and Elberink 2012); how large it is, is measured
    on the table itself.
    """
    from deixis.perception.detection.kernels import averaged, grown

    limits = settings.heights
    growth = np.maximum(distance, limits.min_noise_distance) ** 2
    noise = _noise(heights, growth, limits)
    mean = averaged(heights, neighbours, np.maximum(6 * noise * growth, settings.height), limits.smoothing_rounds)
    left = _noise(mean, growth, limits)
    upper = np.maximum(settings.height, limits.upper_threshold * left * growth)
    lower = np.maximum(settings.height / 4, limits.lower_threshold * left * growth)
    highest = settings.reach
    above = grown((mean > upper) & (mean < highest), (mean > lower) & (mean < highest), neighbours)
    return Raised(above, noise, left, limits)


def _noise(heights: NDArray[np.float64], growth: NDArray[np.float64], limits: HeightSettings) -> float:
    """Return the standard deviation of the table's heights at one metre, by the median, from the points below the
    plane.

    Those above are no use: what lies on the table is among them.
    """
    scaled = heights / growth
    below = -scaled[(scaled < 0) & (scaled > -limits.noise_band)]
    return max(float(1.4826 * np.median(below)), limits.min_noise) if len(below) else limits.min_noise
