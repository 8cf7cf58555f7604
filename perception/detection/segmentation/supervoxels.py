"""Supervoxels: small patches of surface that respect edges of shape and colour.

As in Papon et al. (Voxel cloud connectivity segmentation, CVPR 2013), patches grow along the surface from seeds that
are spread evenly in space. Here a point belongs to the seed with the cheapest path to it. The cost of a path includes
turning normals, steps and changes of colour, so that patches end where these change.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.quantiles import median
from deixis.perception.detection.segmentation.surface import Surface
from deixis.perception.detection.settings import SupervoxelSettings


@dataclass(frozen=True, eq=False)
class Supervoxels:
    """Patches of a surface: ``of`` (n,) is the patch of each point, 0 to s - 1; other fields are means and sums."""

    of: NDArray[np.int32]
    sizes: NDArray[np.float64]  # (s,): points
    middles: NDArray[np.float64]  # (s, 3)
    normals: NDArray[np.float64]  # (s, 3)
    # Colours are weighted by height, because points at the border of a low object mix with those of the table.
    colours: NDArray[np.float64]  # (s, 3)
    areas: NDArray[np.float64]  # (s,): square metres
    settings: SupervoxelSettings

    def __len__(self) -> int:
        return len(self.sizes)

    @cached_property
    def tints(self) -> NDArray[np.float64]:
        """Colours with their lightness scaled down, shape (s, 3)."""
        tints: NDArray[np.float64] = self.colours * (self.settings.lightness_weight, 1.0, 1.0)
        return tints

    @cached_property
    def weights(self) -> NDArray[np.float64]:
        """Weights of the patches in a mean of colours, shape (s,): higher patches count more, as higher points do."""
        weights: NDArray[np.float64] = self.sizes * self.middles[:, 2].clip(self.settings.min_colour_height)
        return weights


def supervoxels(surface: Surface, settings: SupervoxelSettings) -> Supervoxels:
    """Return the patches of a surface with at least one point.

    Parameters
    ----------
    surface
        Surface of n points.
    settings
        Distance of the seeds, and the costs of turns, steps and colours.

    Returns
    -------
    Supervoxels
        The patch of each point, and the middle, normal and colour of each patch.
    """
    from deixis.perception.detection.kernels import grow

    noisy = np.clip(settings.spacing_noise_ratio * median(surface.sigma), settings.min_spacing, settings.max_spacing)
    spacing = float(max(noisy, settings.spacing_neighbour_ratio * median(surface.spacing)))
    seeds = _seeds(surface.smooth, spacing)
    shape = (surface.points, surface.smooth, surface.normals, surface.colours)
    costs = (settings.turn_cost, settings.step_cost, settings.colour_cost, settings.colour_noise)
    found = grow(seeds, spacing, costs, *shape, surface.neighbours, surface.jump)
    of = (np.cumsum(np.bincount(found) > 0) - 1)[found].astype(np.int32)
    middles, normals = means(of, surface.smooth), means(of, surface.normals)
    colours = means(of, surface.colours, surface.points[:, 2].clip(settings.min_colour_height))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return Supervoxels(of, sums(of), middles, normals, colours, sums(of, surface.areas), settings)


def means(
    of: NDArray[np.integer], values: NDArray[np.float64], weights: NDArray[np.float64] | None = None
) -> NDArray[np.float64]:
    """Return the means of values by group.

    Parameters
    ----------
    of
        Group of each value, shape (n,), from 0; each of the m groups has a value.
    values
        Values of shape (n, d).
    weights
        Weight of each value, shape (n,); 1 by default.

    Returns
    -------
    ndarray
        Means of shape (m, d).
    """
    weights = np.ones(len(of)) if weights is None else weights
    total = np.stack([sums(of, values[:, axis] * weights) for axis in range(values.shape[1])], axis=1)
    return total / sums(of, weights)[:, None]


def sums(of: NDArray[np.integer], values: NDArray[np.float64] | None = None, count: int = 0) -> NDArray[np.float64]:
    """Return the sums of values by group, or the sizes of the groups.

    Parameters
    ----------
    of
        Group of each value, shape (n,), from 0.
    values
        Values of shape (n,); 1 by default.
    count
        Least number of groups.

    Returns
    -------
    ndarray
        Sums of shape (m,), with m at least ``count``; 0 for a group without values.
    """
    return np.bincount(of, values, minlength=count).astype(np.float64)


def _seeds(points: NDArray[np.float64], spacing: float) -> NDArray[np.int64]:
    """Return the point nearest to the mean of each occupied grid cell."""
    from deixis.perception.detection.kernels import corners_of_box, nearest_to_means

    low, most = np.floor(corners_of_box(points) / spacing).astype(np.int64)
    cells = np.floor(points / spacing).astype(np.int64) - low
    across, deep, high = (most - low + 1).tolist()
    codes = (cells[:, 0] * deep + cells[:, 1]) * high + cells[:, 2]
    if across * deep * high < 50 * len(points) + 1_000_000:
        there = np.zeros(across * deep * high, dtype=np.bool_)
        there[codes] = True
        found = np.flatnonzero(there)
        number = np.empty(len(there), np.int32)
        number[found] = np.arange(len(found))
        of = number[codes]
    elif across * deep * high < 2**62:
        found, of = np.unique(codes, return_inverse=True)
    else:
        found, of = np.unique(cells, axis=0, return_inverse=True)
    seeds: NDArray[np.int64] = nearest_to_means(points, of.ravel(), len(found))
    return seeds
