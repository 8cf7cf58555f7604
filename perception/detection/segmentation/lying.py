"""Separate flat things from the thing that they lie on by their colour and their height: a knife on a plate.

The edges of a thin thing are lost in the noise of single points, so that its patches are merged with those of the plate
around it. All its points together are clearly higher than the surface around them, and their colour shows which points
these are. A print has another colour too, but is not higher.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.quantiles import medians
from deixis.perception.detection.segmentation.surface import Surface
from deixis.perception.detection.settings import DetectionSettings, LyingSettings
from deixis.reasoning.geometry.coordinates import coordinates


def with_lying_things(surface: Surface, of: NDArray[np.int32], settings: DetectionSettings) -> NDArray[np.int32]:
    """Return the object of each point after raised pieces of another colour are made objects of their own.

    Parameters
    ----------
    surface
        Surface of n points.
    of
        Object of each point, shape (n,), from 0.
    settings
        Options and thresholds.

    Returns
    -------
    ndarray
        Object numbers of shape (n,); the new ones follow the given ones.
    """
    if not len(of) or not surface.colours.any():
        return of
    from deixis.perception.detection.kernels import renumbered

    result, count = of.copy(), int(of.max()) + 1
    tints = surface.colours * (settings.supervoxels.lightness_weight, 1.0, 1.0)
    number = np.full(len(of), -1, np.int32)
    level, order = surface.normals[:, 2] > settings.lying.min_level_normal, np.argsort(of, kind="stable")
    for members in np.split(order, np.cumsum(np.bincount(of))[:-1]):
        if len(members) < 2 * settings.least_points or level[members].mean() < settings.lying.min_level_share:
            continue
        shades = tints.take(members, axis=0)
        shades -= medians(shades)
        unlike = np.sqrt(np.einsum("ij,ij->i", shades, shades))
        if (unlike > settings.joining.min_other_colour).sum() < settings.lying.min_core_points:
            continue
        number[members] = np.arange(len(members))
        near = renumbered(surface.neighbours, members, number)
        number[members] = -1
        bare = unlike < settings.joining.min_other_colour / 2
        for piece in _pieces(shades, unlike, near, settings):
            bare[piece] = False
            if _is_raised(surface, members[piece], members[bare], settings):
                result[members[piece]] = count
                count += 1
    return result


def _pieces(
    shades: NDArray[np.float64],
    unlike: NDArray[np.float64],
    neighbours: NDArray[np.int32],
    settings: DetectionSettings,
) -> Iterator[NDArray[np.intp]]:
    """Yield the points of each connected plain piece of an object that has another colour than its ground.

    ``shades`` (m, 3) are the colours of the points relative to the ground, and ``unlike`` (m,) their lengths. The core
    of a piece has clearly another colour; its edge is nearer in colour to the core than to the ground.
    """
    from deixis.perception.detection.kernels import grown

    taken = np.zeros(len(shades), np.bool_)
    for middle in _connected(unlike > settings.joining.min_other_colour, neighbours, settings.lying):
        if taken[middle].any():
            continue
        seeds, away = np.zeros(len(shades), np.bool_), shades[middle].mean(axis=0)
        seeds[middle] = True
        piece = np.flatnonzero(grown(seeds, shades @ away > away @ away / 2, neighbours))
        taken[piece] = True
        if settings.least_points <= len(piece) < len(shades) / 2 and _is_plain(shades[piece], settings):
            yield piece


def _is_plain(shades: NDArray[np.float64], settings: DetectionSettings) -> bool:
    return bool(np.linalg.norm(shades.std(axis=0)) < settings.joining.max_plain_variation)


def _connected(
    chosen: NDArray[np.bool_], neighbours: NDArray[np.int32], limits: LyingSettings
) -> list[NDArray[np.intp]]:
    """Return the largest connected groups of the chosen points, the largest first."""
    from deixis.perception.detection.kernels import groups

    of = groups(chosen, neighbours)
    sizes = np.bincount(of[chosen], minlength=1)
    largest = np.argsort(-sizes, kind="stable")[: limits.max_pieces]
    return [np.flatnonzero(of == k) for k in largest.tolist() if sizes[k] >= limits.min_core_points]


def _is_raised(surface: Surface, piece: NDArray[np.intp], below: NDArray[np.intp], settings: DetectionSettings) -> bool:
    """Return True if a piece lies on a level surface that is seen around it, and is a little higher than it."""
    from scipy.spatial import ConvexHull, QhullError, cKDTree

    limits, places, plan = settings.lying, surface.points.take(piece, axis=0), surface.points.take(below, axis=0)[:, :2]
    low, high = places.min(axis=0), places.max(axis=0)
    if (high - low).max() < settings.least_length:
        return False
    inside = ((plan > low[:2] - limits.reach) & (plan < high[:2] + limits.reach)).all(axis=1)
    below, plan = below[inside], plan[inside]
    if len(below) < limits.min_ring_points or surface.normals[below, 2].mean() < limits.min_level_normal:
        return False
    tree = cKDTree(places[:, :2], balanced_tree=False, compact_nodes=False)
    away = tree.query(plan, distance_upper_bound=limits.reach)[0]
    ring = below[(away > limits.edge) & (away < limits.reach)]
    if len(ring) < limits.min_ring_points or surface.normals[ring, 2].mean() < limits.min_level_normal:
        return False
    around = surface.points[ring]
    try:
        sides = ConvexHull(around[:, :2]).equations
    except QhullError:
        return False
    within = (coordinates(places[:, :2], sides[:, :2]) + sides[:, 2]).max(axis=1) < 0.0
    if within.mean() < limits.min_inside_share:
        return False
    origin, scale = places.mean(axis=0), np.ptp(around[:, :2])
    terms = _quadratic((around[:, :2] - origin[:2]) / scale)
    # the normal equations are well conditioned at this scale; least squares of thousands of rows start threads of BLAS
    known = np.einsum("ij,ik->jk", terms, terms), np.einsum("ij,i->j", terms, around[:, 2])
    shape = np.linalg.lstsq(*known, rcond=None)[0]
    rough = float((around[:, 2] - terms @ shape).std())
    rise = places[:, 2] - _quadratic((places[:, :2] - origin[:2]) / scale) @ shape
    least = max(limits.min_rise, limits.rise_noise_ratio * rough / np.sqrt(len(piece) / limits.correlated_points))
    return bool(least < rise.mean() < limits.max_rise)


def _quadratic(plan: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the terms of a quadratic function of places (n, 2), shape (n, 6)."""
    x, y = plan.T
    return np.column_stack([np.ones(len(plan)), x, y, x * x, x * y, y * y])
