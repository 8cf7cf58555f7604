"""Form descriptor: one vector for the directions of a view's surfaces, its hollows, widths and gaps.

The use of a thing shows in its form: a vessel has walls that face its own axis, a bottle narrows upward, a blade is
flat and long, a handle leaves a gap between itself and the body, a spoon is wide at one end. Each part of the vector
(:data:`PARTS`) describes one such aspect, in numbers that depend little on the size of the thing. The axis of a thing
is the place in plan where the normals of its sides meet: for a thing that is round about the vertical, this is its axis
of revolution, even if only its front is seen.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.describer import finite_points
from deixis.perception.features.descriptors.upright import (
    FOOT_PERCENTILE,
    MIN_HEIGHT,
    SPACING,
    TOP_PERCENTILE,
    in_smallest_rectangle,
)
from deixis.perception.features.points.keypoints import voxel_keypoints
from deixis.perception.features.points.normals import estimate_normals, neighbourhoods

MIN_POINTS = 3
"""Minimum number of points with a normal."""

NORMAL_RADIUS = 0.015
"""Radius in metres of the neighbourhood by which a normal is estimated."""

AXIS_TOLERANCE = 0.006
"""Distance in metres between the axis and the line of a normal at which the normal has half its weight."""

AXIS_ROUNDS = 4
"""Rounds of reweighted least squares for the axis."""

AXIS_PRIOR = 0.002
"""Weight per point of the centre in plan as a prior for the axis; it decides where normals carry no information."""

BENDING_RADII = (0.012, 0.025, 0.05)
"""Radii in metres of the neighbourhoods in which the curvature of the surface is measured."""

BENDING_SPACING = 0.01
"""Distance in metres between the places at which curvature is measured."""

STATIONS = 10
"""Number of stations along the length of a thing at which its width and height are measured."""

LEVELS = 8
"""Number of levels of the height at which the radius is measured."""

MIN_LENGTH = 0.02
"""Minimum length in metres by which widths and heights are divided, so that the noise of tiny things does not count."""

CELL_SHARE, MIN_CELL = 1 / 40, 0.006
"""Edge of the cells in which an area is counted: a share of the longest side, and a minimum in metres."""


@dataclass(frozen=True)
class Part:
    """A part of the vector: its length, its scale (the usual distance between unlike things), and its meaning."""

    size: int
    scale: float
    what: str


PARTS: Mapping[str, Part] = MappingProxyType(
    {
        "facing_by_radius": Part(60, 1.135, "root shares of points by slope, facing in or out, and radius"),
        "facing_by_height": Part(48, 1.129, "root shares of points by height, slope, and facing in or out"),
        "profile": Part(36, 1.139, "root shares of points by height and distance from the axis"),
        "radii": Part(2 * LEVELS, 0.661, "inner and outer radius at each level of the height"),
        "widths": Part(STATIONS, 1.013, "widths along the longest side in plan, the wider half first"),
        "heights": Part(STATIONS, 2.569, "heights along it, in the same order"),
        "filling": Part(
            4, 0.478, "shares of its hull and of its rectangle that a thing fills, in plan and as seen by the camera"
        ),
        "bending": Part(
            20 * len(BENDING_RADII), 1.593, "root shares of places by flatness and roundness, at each radius"
        ),
    }
)
"""Parts in the order of the vector. The scales are medians over views of unlike simulated tableware
(``benchmarks/bench_recognition.py --constants``), so that all parts have equal weight in a Euclidean distance."""


@dataclass(frozen=True, eq=False)
class Surface:
    """Surface of a view: points (n, 3), normals (n, 3), and heights (n,) as shares of the total ``height`` in metres.

    ``axis`` (2,) is the place of the thing's axis in plan, ``radii`` (n,) are the distances from it in metres, and
    ``outward`` (n,) the components of the normals that point away from it.
    """

    points: NDArray[np.float64]
    normals: NDArray[np.float64]
    heights: NDArray[np.float64]
    height: float
    axis: NDArray[np.float64]
    radii: NDArray[np.float64]
    outward: NDArray[np.float64]


def form_parts(cloud: PointCloud) -> dict[str, NDArray[np.float64]] | None:
    """Compute the parts of the form of a view, by the names of :data:`PARTS`, before the division by their scales.

    Parameters
    ----------
    cloud
        The points of one thing, in metres in the table's frame, z up; its origin is the position of the camera.

    Returns
    -------
    The parts; None for a view with fewer than ``MIN_POINTS`` points that have a normal.
    """
    points = finite_points(cloud)
    points = points[voxel_keypoints(points, SPACING)]
    if len(points) < MIN_POINTS:
        return None
    normals = estimate_normals(points, radius=NORMAL_RADIUS, origin=cloud.origin).astype(np.float64)
    sided = np.isfinite(normals).all(axis=1)
    if sided.sum() < MIN_POINTS:
        return None
    surface = _surface(points[sided], normals[sided])
    turned = in_smallest_rectangle(points[:, :2])
    aside = turned if np.ptp(turned[:, 0]) >= np.ptp(turned[:, 1]) else turned[:, ::-1]
    widths, heights = _stations(aside, points[:, 2] - min(float(np.percentile(points[:, 2], FOOT_PERCENTILE)), 0.0))
    return {
        "facing_by_radius": _shares(
            (surface.normals[:, 2], surface.outward, surface.radii / max(float(surface.radii.max()), MIN_HEIGHT)),
            (5, 4, 3),
            ((-1, 1), (-1, 1), (0, 1)),
        ),
        "facing_by_height": _shares(
            (surface.heights, surface.normals[:, 2], surface.outward), (4, 4, 3), ((0, 1), (-1, 1), (-1, 1))
        ),
        "profile": _shares(
            (surface.heights, surface.radii / max(float(np.percentile(surface.radii, 98)), MIN_HEIGHT)),
            (6, 6),
            ((0, 1), (0, 1)),
        ),
        "radii": _radii(surface),
        "widths": widths,
        "heights": heights,
        "filling": np.concatenate([_filling(aside), _filling(_silhouette(points, np.array(cloud.origin)))]),
        "bending": _bending(points),
    }


def _surface(points: NDArray[np.float64], normals: NDArray[np.float64]) -> Surface:
    lowest, top = np.percentile(points[:, 2], (FOOT_PERCENTILE, TOP_PERCENTILE))
    foot = min(float(lowest), 0.0)
    height = max(float(top) - foot, MIN_HEIGHT)
    axis = _axis(points[:, :2], normals[:, :2])
    away = points[:, :2] - axis
    radii = np.hypot(*away.T)
    outward = (normals[:, :2] * away).sum(axis=1) / np.maximum(radii, 1e-4)
    return Surface(points, normals, np.clip((points[:, 2] - foot) / height, 0, 1), height, axis, radii, outward)


def _axis(plan: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the place in plan (2,) nearest to the lines of the normals (n, 2), by robust least squares.

    A level surface has no line in plan and no weight. If the normals carry little information, it is the centre in
    plan.
    """
    middle: NDArray[np.float64] = (plan.min(axis=0) + plan.max(axis=0)) / 2
    across = np.column_stack([-normals[:, 1], normals[:, 0]])
    found, weights, prior = middle, np.ones(len(plan)), AXIS_PRIOR * len(plan)
    for _ in range(AXIS_ROUNDS):
        weighted = across * weights[:, None]
        pull = weighted.T @ (across * plan).sum(axis=1) + prior * middle
        found = np.linalg.solve(weighted.T @ across + prior * np.eye(2), pull)
        weights = 1 / (1 + np.square((across * (plan - found)).sum(axis=1) / AXIS_TOLERANCE))
    return found if np.linalg.norm(found - middle) <= np.ptp(plan, axis=0).max() else middle


def _shares(
    values: tuple[NDArray[np.float64], ...], bins: tuple[int, ...], ranges: tuple[tuple[float, float], ...]
) -> NDArray[np.float64]:
    """Return square roots of the shares of points in the bins of a histogram; outermost bins hold all values beyond."""
    within = np.stack([np.clip(each, *limits) for each, limits in zip(values, ranges, strict=True)], axis=1)
    counts, _ = np.histogramdd(within, bins=bins, range=ranges)
    return np.sqrt(counts.ravel() / len(within))


def _radii(surface: Surface) -> NDArray[np.float64]:
    """Return inner and outer radius (2 LEVELS,) at each level, relative to the size; empty levels are interpolated."""
    size = max(surface.height, 2 * float(np.percentile(surface.radii, 98)))
    level = np.minimum((surface.heights * LEVELS).astype(int), LEVELS - 1)
    found = np.full((LEVELS, 2), np.nan)
    for number in range(LEVELS):
        within = surface.radii[level == number]
        if len(within):
            found[number] = np.percentile(within, (10, 90)) / size
    known = np.flatnonzero(np.isfinite(found[:, 0]))
    return np.stack([np.interp(np.arange(LEVELS), known, column[known]) for column in found.T], axis=1).ravel()


def _stations(
    aside: NDArray[np.float64], heights: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return widths and heights (STATIONS,) along the first coordinate of ``aside`` (n, 2), relative to the length."""
    along, across = aside.T
    length = float(np.ptp(along))
    station = np.minimum(((along - along.min()) / max(length, 1e-3) * STATIONS).astype(int), STATIONS - 1)
    unit = max(length, MIN_LENGTH)
    widths, tops = np.zeros(STATIONS), np.zeros(STATIONS)
    for number in range(STATIONS):
        here = station == number
        if here.sum() >= 2:
            widths[number] = np.ptp(np.percentile(across[here], (3, 97))) / unit
            tops[number] = np.percentile(heights[here], 95) / unit
    half = STATIONS // 2
    turn = widths[:half].sum() < widths[half:].sum()
    return (widths[::-1], tops[::-1]) if turn else (widths, tops)


def _silhouette(points: NDArray[np.float64], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the points (n, 2) in the plane of the image, to the right and upward, in metres."""
    toward = eye - points.mean(axis=0)
    toward /= max(float(np.linalg.norm(toward)), 1e-9)
    right = np.cross((0.0, 0.0, 1.0), toward)
    if np.linalg.norm(right) < 1e-6:
        right = np.array([1.0, 0.0, 0.0])
    right /= np.linalg.norm(right)
    return np.column_stack([points @ right, points @ np.cross(toward, right)])


def _filling(plane: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the shares (2,) of their convex hull and of their rectangle that points of a plane (n, 2) fill."""
    from scipy.spatial import ConvexHull, QhullError

    sides = np.ptp(plane, axis=0)
    cell = max(MIN_CELL, CELL_SHARE * float(sides.max()))
    filled = len(np.unique(np.floor(plane / cell), axis=0)) * cell**2
    border = cell * float(sides.sum())  # cells at the border reach beyond the points
    try:
        hull = float(ConvexHull(plane).volume)
    except QhullError:  # all points in a line
        hull = 0.0
    return filled / (np.array([hull, float(sides.prod())]) + border + cell**2)


def _bending(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return square roots of the shares of places by the flatness and roundness of their surroundings, 20 per radius.

    With eigenvalues a >= b >= c of the covariance, flatness is sqrt(c / (a + b + c)) and roundness sqrt(b / a).
    """
    places = points[voxel_keypoints(points, BENDING_SPACING)]
    found = []
    for radius in BENDING_RADII:
        counts, covariances = neighbourhoods(points, places, radius, None, None)
        spread = np.linalg.eigvalsh(covariances[counts >= 6])
        if not len(spread):
            found.append(np.zeros(20))
            continue
        least, second, first = np.maximum(spread, 0.0).T
        flat = np.sqrt(least / np.maximum(least + second + first, 1e-18))
        round_ = np.sqrt(second / np.maximum(first, 1e-18))
        found.append(_shares((flat, round_), (5, 4), ((0, 0.5), (0, 1))))
    return np.concatenate(found)


@dataclass(frozen=True)
class FormDescriber:
    """Global descriptor of a view in the table's frame: the parts of its form, each divided by its scale.

    The Euclidean distance between the vectors of unlike things is about the square root of the number of parts, and
    all parts have equal weight in it. The position of a thing and its turn about the vertical do not matter, and its
    size only through details that are too small to be measured.
    """

    @property
    def name(self) -> str:
        """Name of the descriptor."""
        return "form"

    @property
    def size(self) -> int:
        """Length of a descriptor."""
        return sum(part.size for part in PARTS.values())

    @property
    def local(self) -> bool:
        """False: there is one descriptor for the view."""
        return False

    def describe(self, cloud: PointCloud) -> NDArray[np.float32]:
        """Compute the overall form of a cloud.

        Parameters
        ----------
        cloud
            The points of one object in the table's frame, in metres.

        Returns
        -------
        ndarray
            Descriptor of shape (1, size), in the order of :data:`PARTS`; (0, size) for a cloud without points.
        """
        found = form_parts(cloud)
        if found is None:
            return np.empty((0, self.size), np.float32)
        return np.concatenate([found[name] / part.scale for name, part in PARTS.items()])[None].astype(np.float32)
