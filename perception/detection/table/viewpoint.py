"""Estimate the viewpoint of a cloud, and compute the frame of a table as its viewer sees it.

A file may lack the viewpoint, or hold a cloud that was moved to another frame or combines several views. Seen from the
right viewpoint, points in nearly the same direction are near each other, except at the edges of objects; seen from a
wrong one, they are not.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.quantiles import percentiles
from deixis.perception.detection.settings import DetectionSettings, ViewpointSettings
from deixis.perception.detection.table.plane import CameraPose, Plane
from deixis.reasoning.geometry.coordinates import coordinates

_Kind = TypeVar("_Kind", bound=np.generic)


@dataclass(frozen=True, eq=False)
class View:
    """Points of a cloud that have a depth, and their viewpoint.

    ``points`` (n, 3) are in the frame of the cloud, and ``places`` (n,) are their indices in it. ``organised`` gives
    the rows and columns if the cloud is an image, or None.
    """

    points: NDArray[np.float64]
    places: NDArray[np.intp]
    organised: tuple[int, int] | None
    pose: CameraPose
    same: NDArray[np.intp] | None = None  # (2, m): left-out points of a thinned cloud, and the points that replace them

    @cached_property
    def pixels(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Rows and columns of the points of an image, each of shape (n,)."""
        assert self.organised is not None, "only an organised cloud has pixels"
        rows, columns = np.divmod(self.places.astype(np.int32), np.int32(self.organised[1]))
        return rows, columns

    def take(self, chosen: NDArray[np.intp]) -> View:
        """Return a view of the chosen points.

        Parameters
        ----------
        chosen
            Indices of the chosen points, shape (k,).

        Returns
        -------
        View
            View of the chosen points from an equal viewpoint.
        """
        return replace(self, points=self.points.take(chosen, axis=0), places=self.places[chosen])

    def labelled(self, labels: NDArray[np.int32]) -> NDArray[np.int32]:
        """Return labels in which each left-out point has the label of the point that replaces it.

        Parameters
        ----------
        labels
            Labels of all points of the cloud.

        Returns
        -------
        ndarray
            Labels of the shape of the given ones.
        """
        if self.same is None:
            return labels
        result = labels.copy()
        result[self.same[0]] = labels[self.same[1]]
        return result

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of points of the cloud for which each point stands, shape (n,): 1, or more in a thinned cloud."""
        ones = np.ones(len(self.places), np.int64)
        if self.same is None:
            return ones
        size = int(max(self.places.max(initial=0), self.same.max(initial=0))) + 1
        result: NDArray[np.int64] = ones + np.bincount(self.same[1], minlength=size)[self.places]
        return result


def finite_places(cloud: PointCloud) -> NDArray[np.intp]:
    """Return the indices of the points of a cloud that have a depth.

    Parameters
    ----------
    cloud
        Cloud, which is an image if it is organised.

    Returns
    -------
    ndarray
        Indices of shape (n,): in the order of the pixels of an image, otherwise with points near each other in space
        next to each other, which halves the time of all later steps.

    Examples
    --------
    >>> beside = PointCloud(np.array([[0.0, 0, 0], [5, 0, 0], [np.nan, 0, 0], [0.1, 0, 0], [5.1, 0, 0]] * 10))
    >>> places = finite_places(beside)
    >>> len(places), int((np.abs(np.diff(beside.points[places, 0])) > 1).sum())
    (40, 1)
    """
    from scipy.spatial import cKDTree

    places = np.flatnonzero(cloud.finite)
    if cloud.organised is not None or not len(places):
        return places
    order: NDArray[np.intp] = places[cKDTree(cloud.points[places]).indices]
    return order


def camera_pose_of(cloud: PointCloud, settings: DetectionSettings) -> CameraPose:
    """Return the viewpoint of a cloud, with the up and right directions of its image as seen from its origin.

    Parameters
    ----------
    cloud
        Cloud, which is an image if it is organised.
    settings
        Upward direction if it is known, and tolerances of the rays.

    Returns
    -------
    CameraPose
        Pose; ``known`` is False if the rays of the image do not meet at the origin of the cloud.
    """
    eye = np.asarray(cloud.origin, dtype=np.float64)
    upwards = None
    if settings.up is not None:
        upwards = np.asarray(settings.up, dtype=np.float64)
        upwards = upwards / np.linalg.norm(upwards)
    if cloud.organised is None or min(cloud.organised) < 2:
        return CameraPose(eye, upwards=upwards)
    image, limits = _without_empty_lines(cloud.points.reshape(*cloud.organised, 3)), settings.viewpoint
    if min(image.shape[:2]) < 2:
        return CameraPose(eye, upwards=upwards)
    uneven = max(_uneven(_rays(pixels, eye, limits)) for pixels in (image, image.swapaxes(0, 1)))
    camera = _best_camera(image, eye, limits)
    if camera is None:
        return CameraPose(eye, upwards=upwards)
    # From a wrong place the misfit is smooth; noise across the rays changes the steps far more than the misfit.
    noisy = camera.misfit < min(limits.max_pinhole_misfit, limits.max_smooth_misfit * uneven)
    if uneven > limits.max_direction_change and not noisy:
        return CameraPose(eye, upwards=upwards, known=False)
    return CameraPose(eye, -camera.down, camera.right, upwards)


def _without_empty_lines(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return an image (r, c, 3) without rows and columns that have no depth; some cameras leave lines out."""
    there = np.isfinite(image[..., 2])
    rows, columns = there.any(axis=1), there.any(axis=0)
    for axis, lines in enumerate((rows, columns)):
        if not lines.all():
            image = image.take(np.flatnonzero(lines), axis)
    return image


def _rays(image: NDArray[np.float32], eye: NDArray[np.float64], settings: ViewpointSettings) -> NDArray[np.float64]:
    """Return unit vectors (t, 3, c, 3) from the eye to t triples of successive rows of an image, in c columns."""
    rows, columns = image.shape[:2]
    first = np.arange(0, max(rows - 2, 1), max(1, rows // settings.image_steps))
    triples = image[np.minimum(first[:, None] + np.arange(3), rows - 1), :: max(1, columns // settings.image_lines)]
    rays = triples - eye
    with np.errstate(invalid="ignore", divide="ignore"):
        unit: NDArray[np.float64] = rays / np.linalg.norm(rays, axis=3, keepdims=True)
    return unit


def _uneven(rays: NDArray[np.float64]) -> float:
    """Return the 90 % quantile of the relative change between successive steps from ray to ray, of rays (t, 3, c, 3).

    The change of a pinhole camera, up to twice the angle of a step within 45 degrees, is subtracted. The quantile
    excludes the edges of objects.
    """
    first, second = rays[:, 1] - rays[:, 0], rays[:, 2] - rays[:, 1]
    angles = np.linalg.norm(second, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.linalg.norm(second - first, axis=2) / angles - 2 * angles
    return float(np.quantile(change[np.isfinite(change)], 0.9)) if np.isfinite(change).any() else 0.0


@dataclass(frozen=True, eq=False)
class _Pinhole:
    """Pinhole camera fitted to an image: unit vectors (3,) along its columns and rows, and its misfit in pixels."""

    down: NDArray[np.float64]
    right: NDArray[np.float64]
    misfit: float


def _best_camera(image: NDArray[np.float32], eye: NDArray[np.float64], settings: ViewpointSettings) -> _Pinhole | None:
    """Return the camera at the eye that projects the points of an image (r, c, 3) nearest to their pixels.

    The result is None for too few points. The camera is fitted by the direct linear transformation (Abdel-Aziz and
    Karara, Direct linear transformation from comparator coordinates, 1971).
    """
    seen = np.flatnonzero(np.isfinite(image[..., 2]))
    row, column = np.divmod(seen[:: max(1, len(seen) // settings.pinhole_sample_size)], image.shape[1])
    if len(row) < 10 or not np.ptp(row) or not np.ptp(column):
        return None
    size = float(max(image.shape[:2]))
    at = np.stack([column - column.mean(), row - row.mean()], axis=1) / size
    rays = directions(image[row, column].astype(np.float64), eye)
    zero = np.zeros_like(rays)
    terms = np.concatenate([np.hstack([rays, zero, -at[:, :1] * rays]), np.hstack([zero, rays, -at[:, 1:] * rays])])
    camera = np.linalg.eigh(terms.T @ terms)[1][:, 0].reshape(3, 3)
    depth = rays @ camera[2]
    camera *= np.sign(np.median(depth)) or 1.0
    with np.errstate(invalid="ignore", divide="ignore"):
        off = size * np.linalg.norm(rays @ camera[:2].T / (rays @ camera[2])[:, None] - at, axis=1)
    ways = []
    for along, other in ((1, 0), (0, 1)):  # a column is the direction in which its own coordinate stays constant
        way = np.cross(camera[other], camera[2])
        length = float(np.linalg.norm(way))
        if not length > 0:
            return None
        ways.append(way / length * (np.sign(camera[along] @ way) or 1.0))
    return _Pinhole(ways[0], ways[1], float(np.quantile(np.nan_to_num(off, nan=np.inf), settings.pinhole_quantile)))


def verified_pose(pose: CameraPose, points: NDArray[np.float64], settings: DetectionSettings) -> CameraPose:
    """Return the viewpoint if points are consistent with it, else an assumed one above them.

    Parameters
    ----------
    pose
        Viewpoint of the points.
    points
        Points of shape (n, 3), in metres.
    settings
        Share of inconsistent neighbours that is tolerated.

    Returns
    -------
    CameraPose
        The given pose, or one with ``known`` False.
    """
    if pose.up is not None:  # the viewpoint of an image has been checked before
        return pose
    limits = settings.viewpoint
    few = sampled(points, settings)
    if pose.known and apart(few, pose.eye, limits) < limits.max_far_share:
        return pose
    above = np.median(few, axis=0) + np.array([0.0, 0.0, limits.assumed_distance])
    return CameraPose(above, upwards=pose.upwards, known=False)


def is_sure(pose: CameraPose, plane: Plane, settings: DetectionSettings) -> bool:
    """Return True if the viewpoint is that of an image, which was checked, and above the table.

    Parameters
    ----------
    pose
        Viewpoint of the points.
    plane
        Plane of the table.
    settings
        Minimum height of the viewpoint above the table.

    Returns
    -------
    bool
        False if the points around the table must tell whether the viewpoint is plausible.
    """
    above = plane.heights(pose.eye[None])[0] > settings.viewpoint.min_eye_height
    return bool(pose.known and pose.up is not None and above)


def likeliest_pose(
    pose: CameraPose, points: NDArray[np.float64], plane: Plane, settings: DetectionSettings
) -> CameraPose:
    """Return the viewpoint if it is known and above the table, else the most plausible one.

    A doubtful viewpoint is replaced if another one has at most half of its share of inconsistent neighbours.

    Parameters
    ----------
    pose
        Viewpoint of the points.
    points
        Points of the table and around it, shape (n, 3), in metres.
    plane
        Plane of the table.
    settings
        Shares of inconsistent neighbours, and places of assumed viewpoints.

    Returns
    -------
    CameraPose
        The given pose, or an assumed one above the table.
    """
    if is_sure(pose, plane, settings):
        return pose
    limits = settings.viewpoint
    few, far_share = sampled(points, settings), float(np.inf)
    if pose.known and plane.heights(pose.eye[None])[0] > limits.min_eye_height:
        far_share = apart(few, pose.eye, limits)
        if far_share < limits.doubtful_far_share:
            return pose
    on = few[np.abs(plane.heights(few)) < settings.plane.table_band]
    middle = (on if len(on) else few).mean(axis=0)
    turns = np.arange(limits.assumed_azimuths) * 2 * np.pi / limits.assumed_azimuths
    level = np.column_stack([np.cos(turns), np.sin(turns)]) @ plane.across
    aslant = np.cos(limits.assumed_elevation) * level + np.sin(limits.assumed_elevation) * plane.normal
    places = [middle + limits.assumed_distance * direction for direction in (plane.normal, *aslant)]
    reach = neighbour_reach(few, limits)
    shares = [apart(few, place, limits, reach) for place in places]
    eye = places[int(np.argmin(shares))]
    if far_share < limits.max_far_share and min(shares) > far_share / 2:
        return pose
    return replace(pose, eye=eye, up=None, right=None, known=False)


def sampled(points: NDArray[_Kind], settings: DetectionSettings) -> NDArray[_Kind]:
    """Return points or indices, or a random sample of them.

    Parameters
    ----------
    points
        Points or indices, shape (n, …).
    settings
        Largest size of the sample, and the seed.

    Returns
    -------
    ndarray
        All of them if there are few, else rows without repetition.
    """
    size = settings.viewpoint.sample_size
    if len(points) <= size:
        return points
    return points[np.random.default_rng(settings.seed).choice(len(points), size, replace=False)]


def neighbour_reach(points: NDArray[np.float64], settings: ViewpointSettings) -> NDArray[np.float64]:
    """Return the distance of each point from the last of its neighbours in space.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    settings
        Number of neighbours.

    Returns
    -------
    ndarray
        Distances of shape (n,), in metres; infinite for too few points.
    """
    from scipy.spatial import cKDTree

    count = settings.neighbours + 1
    reach: NDArray[np.float64] = cKDTree(points).query(points, k=[count])[0][:, 0]
    return reach


def apart(
    points: NDArray[np.float64],
    eye: NDArray[np.float64],
    settings: ViewpointSettings,
    reach: NDArray[np.float64] | None = None,
) -> float:
    """Return the fraction of points' neighbours in direction that are far apart in space.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    eye
        Supposed viewpoint, shape (3,).
    settings
        Number of neighbours, and the ratio from which they are far apart.
    reach
        Result of :func:`neighbour_reach` for these points, if it is known.

    Returns
    -------
    float
        Fraction in [0, 1]; 0 for few points. It is large for a wrong viewpoint.

    Examples
    --------
    >>> x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.02, -0.5:0.5:0.02])
    >>> bowl = np.stack([x, y, x**2 + y**2], axis=1)
    >>> above, aside = np.array([0.0, 0.0, 2.0]), np.array([0.0, -3.0, 0.01])
    >>> apart(bowl, above, ViewpointSettings()), apart(bowl, aside, ViewpointSettings()) > 0.1
    (0.0, True)
    """
    from scipy.spatial import cKDTree

    count = settings.neighbours
    if len(points) <= count:
        return 0.0
    rays = directions(points, eye)
    near = cKDTree(rays).query(rays, k=count + 1)[1][:, 1:]
    if reach is None:
        reach = neighbour_reach(points, settings)
    away = np.linalg.norm(points[near] - points[:, None], axis=2)
    return float((away > settings.far_ratio * reach[:, None]).mean())


def directions(points: NDArray[np.float64], eye: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the directions of points as seen from an eye.

    Parameters
    ----------
    points
        Points of shape (n, 3).
    eye
        Viewpoint, shape (3,).

    Returns
    -------
    ndarray
        Unit vectors of shape (n, 3); 0 for a point at the eye.
    """
    rays = points - eye
    result: NDArray[np.float64] = rays / np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-9)
    return result


def table_frame(
    plane: Plane, on: NDArray[np.float64], pose: CameraPose, settings: DetectionSettings
) -> NDArray[np.float64]:
    """Return the transform from the frame of the cloud to that of the table.

    z is the height above the plane. y points away from the viewer, and x to the right. The origin is on the table, in
    the middle of the rectangle around its points. Where a frame is known, x and the origin are its own, moved onto the
    plane.

    Parameters
    ----------
    plane
        Plane of the table.
    on
        Points on the table, shape (n, 3), in metres.
    pose
        Viewpoint of the points.
    settings
        ``frame``, the known frame, or None; ``viewer``, the place of the viewer: y points from there to the middle of
        the table. If both are None, y points upwards in the image, or else from the sensor to the middle.

    Returns
    -------
    ndarray
        Transform of shape (4, 4).
    """
    up = plane.normal
    known = None if settings.frame is None else np.array(settings.frame)
    directions = _away(plane, on.mean(axis=0), pose, settings.viewer) if known is None else [known[1, :3]]
    away = _across(up, directions)
    turn = np.stack([np.cross(away, up), away, up])
    if known is None:
        middle = percentiles(coordinates(on, turn[:2]), (0.5, 99.5)).mean(axis=0)
    else:
        middle = turn[:2] @ (-known[:3, :3].T @ known[:3, 3])
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = turn, -np.append(middle, plane.offset)
    return frame


def _away(
    plane: Plane, middle: NDArray[np.float64], pose: CameraPose, viewer: tuple[float, float, float] | None
) -> list[NDArray[np.float64]]:
    """Return directions away from the viewer, the best first; some may be vertical."""
    if viewer is not None:
        return [middle - np.asarray(viewer, dtype=np.float64)]
    if not pose.known:
        return []
    if pose.right is not None:
        return [np.cross(plane.normal, pose.right)]
    return [middle - pose.eye]


def _across(up: NDArray[np.float64], wanted: list[NDArray[np.float64]]) -> NDArray[np.float64]:
    """Return the first direction that is not along ``up``, projected to the plane; else y or x of the cloud."""
    for direction in (*wanted, np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])):
        level = direction - (direction @ up) * up
        length = float(np.linalg.norm(level))
        if length > 0.02:
            return level / length
    raise AssertionError("one of two axes is not along a third direction")


def moved(points: NDArray[np.floating], frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points moved by a transform.

    Parameters
    ----------
    points
        Points of shape (n, 3).
    frame
        Transform of shape (4, 4).

    Returns
    -------
    ndarray
        Points of shape (n, 3); coordinates that are not finite stay so.
    """
    with np.errstate(invalid="ignore"):  # infinity times 0
        result = coordinates(points, frame[:3, :3]) + frame[:3, 3]
    return result


def in_frame(cloud: PointCloud, frame: NDArray[np.float64]) -> PointCloud:
    """Return a cloud moved by a transform, without labels.

    Parameters
    ----------
    cloud
        Cloud to move.
    frame
        Transform of shape (4, 4), without scaling.

    Returns
    -------
    PointCloud
        Cloud whose points, normals and origin are moved.
    """
    origin = moved(np.array([cloud.origin]), frame)[0]
    normals = None if cloud.normals is None else (cloud.normals @ frame[:3, :3].T).astype(np.float32)
    points = moved(cloud.points, frame).astype(np.float32)
    x, y, z = origin.tolist()
    return PointCloud(points, cloud.colours, None, normals, origin=(x, y, z))
