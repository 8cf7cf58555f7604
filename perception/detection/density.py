"""Thin bare points that are far denser on some surfaces than on others, as in clouds made of several scans.

The steps of the detection compare each point with its neighbours, and count points. Where an object is sampled ten
times as closely as the table, the object's faces have nearly all points: they would be the largest planes, and the
points of the table would have no neighbours at the usual distance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import cell_codes
from deixis.perception.detection.settings import DensitySettings, DetectionSettings
from deixis.perception.detection.table.viewpoint import View


def evenly_dense(view: View, settings: DetectionSettings) -> View:
    """Return a view whose points are thinned where they are far denser than on most of the visible surface.

    Parameters
    ----------
    view
        Points with a depth, and their viewpoint. Images, and bare points that are evenly spaced or evenly distributed
        over the directions from the viewpoint, stay as they are.
    settings
        Ratios of spacings, and the seed of the sample.

    Returns
    -------
    View
        One point for each occupied cell of a grid. ``same`` gives the point in whose cell each left-out point lies.

    Examples
    --------
    >>> from deixis.perception.detection.table.plane import CameraPose
    >>> x, y = (axis.ravel() for axis in np.mgrid[0:1:0.01, 0:1:0.01])
    >>> u, v = (axis.ravel() for axis in np.mgrid[0:0.05:0.0005, 0:0.05:0.0005])
    >>> coarse, fine = np.stack([x, y, 0 * x], axis=1), np.stack([u, v, 0 * u + 0.05], axis=1)
    >>> points, eye = np.concatenate([coarse, fine]), CameraPose(np.array([0.5, 0.5, 1.0]))
    >>> thinned = evenly_dense(View(points, np.arange(len(points)), None, eye), DetectionSettings())
    >>> np.bincount(thinned.places < len(coarse)).tolist()
    [420, 10000]
    """
    limits = settings.density
    if view.organised is not None or len(view.points) <= limits.neighbours:
        return view
    rng = np.random.default_rng(settings.seed)
    size = min(limits.sample_size, len(view.points))
    few = rng.choice(len(view.points), size, replace=False)
    spacing = _spacing(view.points, few, limits)
    away = np.linalg.norm(view.points[few] - view.pose.eye, axis=1)
    usual = _usual(spacing, spacing, limits)
    angle = spacing / np.maximum(away, 1e-6)
    ratios = [
        usual / max(_dense(spacing, limits), 1e-9),
        _usual(angle, spacing, limits) / max(_dense(angle, limits), 1e-9),
    ]
    if min(ratios) < limits.min_ratio:
        return view
    side = min(usual / limits.thinned_ratio, limits.max_cell)
    codes = cell_codes(view.points, side)
    _, first, of = np.unique(codes, return_index=True, return_inverse=True)
    kept = np.sort(first)
    left_out = np.ones(len(codes), dtype=np.bool_)
    left_out[kept] = False
    same = np.stack([view.places[left_out], view.places[first[of[left_out]]]])
    return replace(view.take(kept), same=same)


def _spacing(points: NDArray[np.float64], few: NDArray[np.intp], settings: DensitySettings) -> NDArray[np.float64]:
    """Return the distances between points (n, 3) around the points ``few`` (k,), shape (k,).

    The distance is the median over the neighbours of a point, so that a stray point near a dense surface counts as a
    point of the surface.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(points, balanced_tree=False, compact_nodes=False)
    last = settings.neighbours + 1
    near = tree.query(points[few], k=last)[1][:, 1:]
    around, of = np.unique(near, return_inverse=True)
    distance = tree.query(points[around], k=[last])[0][:, 0]
    result: NDArray[np.float64] = np.median(distance[of.reshape(near.shape)], axis=1)
    return result


def _usual(values: NDArray[np.float64], spacing: NDArray[np.float64], settings: DensitySettings) -> float:
    """Return the median of values (k,) over the area of the surface; a point counts by the square of its spacing."""
    on = spacing <= settings.max_spacing
    if not on.any():
        return 0.0
    order = np.argsort(values[on])
    area = np.cumsum(np.square(spacing[on])[order])
    return float(values[on][order][min(int(np.searchsorted(area, area[-1] / 2)), len(order) - 1)])


def _dense(values: NDArray[np.float64], settings: DensitySettings) -> float:
    """Return the spacing, as values (k,), at which the densest points begin."""
    return float(np.quantile(values, settings.dense_share))
