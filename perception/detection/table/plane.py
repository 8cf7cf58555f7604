"""Find the plane of the table by random samples (RANSAC, Fischler and Bolles 1981), refined by least squares.

Several planes are extracted one after another. The largest may be the floor or a wall. The table is the plane that
could be level for an upright camera and has the most points on it and standing on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import in_largest_piece
from deixis.perception.detection.quantiles import percentiles
from deixis.perception.detection.settings import DetectionSettings, PlaneSettings
from deixis.reasoning.geometry.coordinates import coordinates


@dataclass(frozen=True, eq=False)
class Plane:
    """Plane of the points p with normal · p = offset; the unit normal (3,) points to the side of the objects."""

    normal: NDArray[np.float64]
    offset: float

    def heights(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the heights of points (n, 3) above the plane in metres, shape (n,).

        Parameters
        ----------
        points
            Points of shape (n, 3), in metres.

        Returns
        -------
        ndarray
            Heights of shape (n,), negative below the plane.
        """
        return coordinates(points, self.normal) - self.offset

    @property
    def across(self) -> NDArray[np.float64]:
        """Two orthogonal unit vectors along the plane, shape (2, 3)."""
        along: NDArray[np.float64] = np.linalg.svd(self.normal[None])[2][1:]
        return along

    def is_along(self, other: Plane, settings: PlaneSettings) -> bool:
        """Return True if both planes are nearly parallel and their normals point to the same side.

        Parameters
        ----------
        other
            Plane to compare with.
        settings
            Least cosine of the angle between the normals.

        Returns
        -------
        bool
            False for planes whose normals are opposite.
        """
        return bool(self.normal @ other.normal > settings.min_normal_cosine)

    def turned(self) -> Plane:
        """Return the plane with its normal reversed.

        Returns
        -------
        Plane
            The plane seen from its other side.
        """
        return Plane(-self.normal, -self.offset)


@dataclass(frozen=True, eq=False)
class CameraPose:
    """Pose of the camera that saw a cloud.

    ``up`` and ``right`` (3,) are the directions of the image, or None. ``known`` is False if the position ``eye`` of
    the sensor is only assumed.
    """

    eye: NDArray[np.float64]
    up: NDArray[np.float64] | None = None
    right: NDArray[np.float64] | None = None
    upwards: NDArray[np.float64] | None = None  # against gravity, if it was given
    known: bool = True

    def could_be_table(self, normal: NDArray[np.float64]) -> bool:
        """Return True if a plane with this normal, towards the eye, could be level for an upright camera.

        Parameters
        ----------
        normal
            Unit normal of the plane, shape (3,).

        Returns
        -------
        bool
            True for every plane if nothing is known about the camera's upright direction.
        """
        if self.upwards is not None:
            return bool(normal @ self.upwards > 0.7)
        if self.up is None or self.right is None:
            return True
        return bool(normal @ self.up > -0.1 and abs(normal @ self.right) < 0.7)


def table_plane(points: NDArray[np.float64], pose: CameraPose, settings: DetectionSettings) -> Plane | None:
    """Return the plane of the table in finite points (n, 3), or None if no plane could be a table.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    pose
        Viewpoint of the points.
    settings
        Tolerances, the size of the sample and the seed.

    Returns
    -------
    Plane or None
        Plane whose normal points to the side of the objects.
    """
    rng, limits = np.random.default_rng(settings.seed), settings.plane
    size = limits.sample_size
    sample = points if len(points) <= size else points[np.sort(rng.choice(len(points), size, replace=False))]
    tolerance = tolerance_at(sample, pose, limits)
    found = _planes(sample, tolerance, pose, rng, limits)
    planes = [plane for plane in found if pose.could_be_table(plane.normal)]
    if not planes:
        return None
    free = np.ones(len(sample), dtype=np.bool_)
    for plane in found:  # a wall does not stand on the floor as an object
        free &= np.abs(plane.heights(sample)) > tolerance
    levels = [level_of(plane, sample, tolerance, sample[free], limits) for plane in planes]
    total = len(sample)
    tables = [height for height in levels if height.has_objects(total, limits)]
    levels = [height for height in levels if not any(height.is_floor_below(table, limits) for table in tables)]
    # Objects on a table show its upper side, even if the sensor seems to be below: the origin may be a default.
    turned = [level.plane.turned() for level in levels]
    levels += [
        level_of(plane, sample, tolerance, sample[free], limits)
        for plane in turned
        if pose.could_be_table(plane.normal)
    ]
    best = max(levels, key=lambda level: level.score).plane
    chosen = points[:: max(1, len(points) // limits.refinement_size)]
    return refined(best, chosen, tolerance_at(chosen, pose, limits))


@dataclass(frozen=True, eq=False)
class LevelPlane:
    """Plane, the points on it (k, 3), and the numbers of points that stand on it and that are below it."""

    plane: Plane
    points: NDArray[np.float64]
    standing: int
    below: int

    @property
    def score(self) -> int:
        """Score of the plane as a table: its points, ten times those that stand on it, less three times those below.

        Standing points count up to the number of the plane's own, so that the side of a box among many objects does not
        exceed the table. The sides of objects have points on both sides of their planes, a table has none below it.
        """
        return len(self.points) + 10 * min(self.standing, len(self.points)) - 3 * self.below

    def has_objects(self, total: int, settings: PlaneSettings) -> bool:
        """Return True if enough of ``total`` points stand on the plane to be objects.

        Parameters
        ----------
        total
            Number of points of the sample.
        settings
            Least fraction of points that must stand on the plane.

        Returns
        -------
        bool
            False for a bare plane.
        """
        return self.standing >= settings.min_standing_share * total

    def is_floor_below(self, other: LevelPlane, settings: PlaneSettings) -> bool:
        """Return True if the plane is parallel to another one and below it by the height of a table.

        Parameters
        ----------
        other
            Plane that may be a table.
        settings
            Least height of a table above the floor, and the tolerated angle.

        Returns
        -------
        bool
            True if this plane could be the floor under the table.
        """
        drop = np.median(self.plane.heights(other.points))
        return self.plane.is_along(other.plane, settings) and bool(drop > settings.floor_drop)


def level_of(
    plane: Plane,
    sample: NDArray[np.float64],
    tolerance: NDArray[np.float64],
    free: NDArray[np.float64],
    settings: PlaneSettings,
) -> LevelPlane:
    """Return the points of a sample on a plane, and count the free ones above it.

    Parameters
    ----------
    plane
        Plane to examine.
    sample
        Points of shape (n, 3), in metres.
    tolerance
        Largest distance of each point from the plane, shape (n,), in metres.
    free
        Points of shape (m, 3) that are on none of the planes found.
    settings
        Heights at which points stand on a plane.

    Returns
    -------
    LevelPlane
        Plane with its points and the number of points that stand on it.
    """
    on = sample[np.abs(plane.heights(sample)) <= tolerance]
    lower = sample[plane.heights(sample) < -settings.below_ratio * tolerance]
    piece = _largest_piece(plane, on)
    standing, below = _standing(plane, piece, (free, lower), settings)
    return LevelPlane(plane, on, standing, below)


def tolerance_at(points: NDArray[np.float64], pose: CameraPose, settings: PlaneSettings) -> NDArray[np.float64]:
    """Return the distance in metres within which points count as on a plane.

    It grows with the square of the distance from the sensor.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    pose
        Viewpoint of the points.
    settings
        Tolerance at 1 m, and the largest distance up to which it grows.

    Returns
    -------
    ndarray
        Tolerances of shape (n,), in metres.
    """
    squared = ((points - pose.eye) ** 2).sum(axis=1)
    near: NDArray[np.float64] = settings.tolerance * np.clip(squared, 0.25, settings.max_noise_distance**2)
    return near


def _planes(
    sample: NDArray[np.float64],
    tolerance: NDArray[np.float64],
    pose: CameraPose,
    rng: np.random.Generator,
    settings: PlaneSettings,
) -> list[Plane]:
    """Return the large planes of a sample in the order in which they are extracted."""
    found = []
    left = np.ones(len(sample), dtype=np.bool_)
    least = max(3, settings.min_inlier_share * len(sample))
    for _ in range(settings.max_planes):
        if left.sum() < least:
            break
        plane = _largest(sample[left], tolerance[left], rng, settings.ransac_trials)
        if plane is None:
            break
        candidate = refined(plane, sample[left], tolerance[left])
        side = float(candidate.normal @ pose.eye - candidate.offset)
        if pose.upwards is not None:
            side = float(candidate.normal @ pose.upwards)
        elif abs(side) < 0.05:
            heights = candidate.heights(sample)
            side = float(
                (heights > settings.min_standing_height).sum() - (heights < -settings.min_standing_height).sum()
            )
        plane = candidate if side >= 0 else candidate.turned()
        on = np.abs(plane.heights(sample)) <= 1.5 * tolerance
        if (on & left).sum() < least:
            break
        found.append(plane)
        left &= ~on
    return found


def _largest(
    points: NDArray[np.float64], tolerance: NDArray[np.float64], rng: np.random.Generator, trials: int
) -> Plane | None:
    """Return the plane through three points that has the most support.

    A point counts by its tolerance, which grows with the area that it covers.
    """
    from deixis.perception.detection.kernels import support

    triples = points[rng.integers(len(points), size=(trials, 3))]
    normals = np.cross(triples[:, 1] - triples[:, 0], triples[:, 2] - triples[:, 0])
    length = np.linalg.norm(normals, axis=1)
    good = length > 1e-9
    if not good.any():
        return None
    normals = normals[good] / length[good, None]
    offsets = (normals * triples[good, 0]).sum(axis=1)
    x, y, z = points.T.astype(np.float32)
    tried = np.column_stack([normals, offsets]).astype(np.float32)
    best = int(np.argmax(support(x, y, z, tolerance.astype(np.float32), tried)))
    return Plane(normals[best], float(offsets[best]))


def refined(plane: Plane, points: NDArray[np.float64], tolerance: NDArray[np.float64], rounds: int = 6) -> Plane:
    """Return the least-squares plane of the points near a plane, refitted with decreasing tolerances.

    Objects on the plane do not affect it.

    Parameters
    ----------
    plane
        Plane to start from.
    points
        Points of shape (n, 3), in metres.
    tolerance
        Largest distance of each point from the plane in the first round, shape (n,), in metres. Points are weighted by
        the inverse of its square, as by the inverse variance of their noise.
    rounds
        Number of fits.

    Returns
    -------
    Plane
        Plane whose normal is on the side of the given one.
    """
    from deixis.perception.detection.kernels import refine

    shares = np.maximum(0.3, 0.75 ** np.arange(rounds))
    normal, offset = refine(points, tolerance, plane.normal, plane.offset, shares)
    return Plane(normal, float(offset))


def _largest_piece(plane: Plane, on: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the points (k, 3) of the largest connected piece ``on`` a plane (n, 3), without strips of walls."""
    if len(on) < 3:
        return on
    plan = coordinates(on, plane.across)
    extents = np.subtract(*percentiles(plan, (99, 1)))
    return on[in_largest_piece(plan, 3 * float(np.sqrt(extents.prod() / len(on))))]


def _standing(
    plane: Plane,
    on: NDArray[np.float64],
    sides: tuple[NDArray[np.float64], NDArray[np.float64]],
    settings: PlaneSettings,
) -> tuple[int, int]:
    """Return the numbers of points that are within the outline of the points ``on`` the plane, above and below it.

    ``sides`` holds the points that count above the plane, and those that count below. The outline is a polygon with
    sides in fixed directions, a little inside, because the edge of a table is often seen.
    """
    if len(on) < 3:
        return 0, 0
    turns = np.arange(settings.outline_sides) * np.pi / settings.outline_sides
    across = np.column_stack([np.cos(turns), np.sin(turns)]) @ plane.across
    low, high = percentiles(coordinates(on, across), (1, 99))
    found = []
    for points, heights in zip(sides, (plane.heights(sides[0]), -plane.heights(sides[1])), strict=True):
        standing = (heights > settings.min_standing_height) & (heights < settings.max_standing_height)
        plan = coordinates(points[standing], across)
        inside = (plan >= low + settings.outline_inset) & (plan <= high - settings.outline_inset)
        found.append(int(inside.all(axis=1).sum()))
    return found[0], found[1]
