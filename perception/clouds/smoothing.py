"""Smooth the depths of an organised cloud, guided by its colours, so that thin things stand out from the noise.

Each distance from the sensor is replaced by that of a plane fitted to the pixels around it. A pixel counts less the
more its colour and its distance differ from those of the middle, by the noise of both, which is estimated from the
cloud. Edges of colour or depth are therefore kept (a joint bilateral filter of first order: C. Tomasi and R. Manduchi,
Bilateral Filtering for Gray and Color Images, ICCV 1998; G. Petschnigg and others, Digital Photography with Flash and
No-Flash Image Pairs, SIGGRAPH 2004).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.reasoning.kernel import kernel

Image = NDArray[np.float64]

REACH = 2
"""Number of pixels on each side of the middle that are used."""

COLOUR_SPREAD, MIN_COLOUR_NOISE = 2.0, 1.5
"""Difference of two colours, in standard deviations of the noise of a channel, at which a pixel counts exp(-1/2); and
the least such noise, as the colours are whole numbers."""

DEPTH_SPREAD = 3.0
"""Difference of two distances, in standard deviations of the noise, at which a pixel counts exp(-1/2)."""

MIN_WEIGHT = 3.0
"""Minimum sum of weights, as a number of pixels, to which a plane is fitted."""

SLOPE_PRIOR = 0.1
"""Weight of level planes in the fit, as a number of pixels, which keeps it stable where few pixels count."""


def smoothed(cloud: PointCloud) -> PointCloud:
    """Return an organised cloud with less noise along its rays.

    Parameters
    ----------
    cloud
        The cloud, in metres, with the position of the sensor as its origin.

    Returns
    -------
    PointCloud
        Cloud with the same pixels, colours and labels; the cloud itself if it is not organised or has no noise.

    Examples
    --------
    >>> x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(-0.3, 0.3, 60), np.linspace(-0.3, 0.3, 60)))
    >>> rng = np.random.default_rng(1)
    >>> plane = np.stack([x, y, np.ones(3600)], axis=1) * (1 + 0.003 * rng.standard_normal((3600, 1)))
    >>> found = smoothed(PointCloud(plane.astype(np.float32), organised=(60, 60)))
    >>> bool(found.points[:, 2].std() < 0.4 * plane[:, 2].std())
    True
    """
    if cloud.organised is None:
        return cloud
    rays = cloud.points.astype(np.float64) - np.asarray(cloud.origin, dtype=np.float64)
    distance = np.linalg.norm(rays, axis=1)
    distance[~cloud.finite] = np.nan
    image = distance.reshape(cloud.organised)
    noise = _noise(image, image**2)
    if not noise > 0:
        return cloud
    if cloud.colours is None:
        colours, spread = np.zeros((*cloud.organised, 3)), 1.0
    else:
        colours = cloud.colours.reshape(*cloud.organised, 3).astype(np.float64)
        channels = [_noise(np.where(np.isnan(image), np.nan, colours[..., k]), np.ones_like(image)) for k in range(3)]
        spread = COLOUR_SPREAD * max(float(np.median(channels)), MIN_COLOUR_NOISE)
    found = _fitted(image, colours, noise * DEPTH_SPREAD, spread).ravel()
    with np.errstate(invalid="ignore"):
        points = np.asarray(cloud.origin) + rays * (found / distance)[:, None]
    return replace(cloud, points=np.where(cloud.finite[:, None], points, cloud.points).astype(np.float32), normals=None)


def _noise(image: Image, scale: Image) -> float:
    """Return the standard deviation of the noise of an image relative to a scale, by the second differences of rows."""
    bend = (image[:, :-2] - 2 * image[:, 1:-1] + image[:, 2:]) / scale[:, 1:-1]
    bend = np.abs(bend[np.isfinite(bend)])
    return float(np.median(bend) / 0.6745 / np.sqrt(6.0)) if len(bend) else 0.0


@kernel()
def _fitted(image: Image, colours: Image, depth_spread: float, colour_spread: float) -> Image:
    """Return the distance of a weighted plane through the pixels around each pixel, shape (rows, columns)."""
    rows, columns = image.shape
    result = image.copy()
    for r in range(rows):
        for c in range(columns):
            middle = image[r, c]
            if not np.isfinite(middle):
                continue
            near = 1.0 / (2 * (depth_spread * middle * middle) ** 2)
            like = 1.0 / (2 * colour_spread**2)
            w0 = wx = wy = wxx = wxy = wyy = wd = wxd = wyd = 0.0
            for v in range(max(r - REACH, 0), min(r + REACH + 1, rows)):
                for u in range(max(c - REACH, 0), min(c + REACH + 1, columns)):
                    d = image[v, u] - middle
                    if not np.isfinite(d):
                        continue
                    change = 0.0
                    for k in range(3):
                        change += (colours[v, u, k] - colours[r, c, k]) ** 2
                    weight = np.exp(-d * d * near - change * like)
                    x, y = u - c, v - r
                    w0 += weight
                    wx += weight * x
                    wy += weight * y
                    wxx += weight * x * x
                    wxy += weight * x * y
                    wyy += weight * y * y
                    wd += weight * d
                    wxd += weight * x * d
                    wyd += weight * y * d
            if w0 < MIN_WEIGHT:
                continue
            # Weighted least squares: eliminate the level, then solve for the two slopes.
            xx = wxx - wx * wx / w0 + SLOPE_PRIOR
            yy = wyy - wy * wy / w0 + SLOPE_PRIOR
            xy = wxy - wx * wy / w0
            xd = wxd - wx * wd / w0
            yd = wyd - wy * wd / w0
            determinant = xx * yy - xy * xy
            slope_x = (xd * yy - yd * xy) / determinant
            slope_y = (yd * xx - xd * xy) / determinant
            result[r, c] = middle + (wd - slope_x * wx - slope_y * wy) / w0
    return result
