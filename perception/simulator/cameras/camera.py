"""A pinhole camera and its pose.

The camera's frame is the optical frame of REP-103: x to the right in the image, y down, z forward. The table's frame
has x to the right of a person at the table, y away from that person, and z up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.laying import LaidTable

HEIGHT = 0.7
"""Default height of the camera above the table, in metres."""

MAX_CAMERA_DISTANCE = 20.0

KINECT = Intrinsics(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)
"""Usual intrinsics of a first-generation Kinect."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera with the pose (4, 4) that takes points of its frame to the table's.

    A pixel in column u and row v sees along ((u - cx) / fx, (v - cy) / fy, 1).
    """

    pose: NDArray[np.float64]
    lens: Intrinsics = KINECT

    @property
    def eye(self) -> NDArray[np.float64]:
        """Position in the table's frame (3,)."""
        position: NDArray[np.float64] = self.pose[:3, 3]
        return position

    def directions(self) -> NDArray[np.float64]:
        """Return the directions of the pixels in the camera's frame, row by row.

        Returns
        -------
        ndarray
            Directions of shape (rows * columns, 3), with z = 1.
        """
        lens = self.lens
        v, u = np.mgrid[: lens.height, : lens.width]
        rays = [(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, np.ones(u.shape)]
        return np.stack(rays, axis=-1).reshape(-1, 3)

    def pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the pixels at which points are seen.

        Parameters
        ----------
        points
            Points of shape (n, 3) in the table's frame, in metres.

        Returns
        -------
        ndarray
            Column and row of each point, shape (n, 2), also outside the image; NaN for points behind the camera.
        """
        seen, lens = self.to_camera(points), self.lens
        z = np.where(seen[:, 2] > 0, seen[:, 2], np.nan)
        return np.stack([lens.fx * seen[:, 0] / z + lens.cx, lens.fy * seen[:, 1] / z + lens.cy], axis=1)

    def to_table(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Transform points from the camera's frame to the table's.

        Parameters
        ----------
        points
            Points of shape (n, 3), in metres.

        Returns
        -------
        ndarray
            Points of shape (n, 3), in metres.
        """
        moved: NDArray[np.float64] = points @ self.pose[:3, :3].T + self.pose[:3, 3]
        return moved

    def to_camera(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Transform points from the table's frame to the camera's.

        Parameters
        ----------
        points
            Points of shape (n, 3), in metres.

        Returns
        -------
        ndarray
            Points of shape (n, 3), in metres; z is their depth.
        """
        moved: NDArray[np.float64] = (points - self.pose[:3, 3]) @ self.pose[:3, :3]
        return moved

    def sees(self, points: NDArray[np.float64]) -> bool:
        """Return True if all points are within the image.

        Parameters
        ----------
        points
            Points of shape (n, 3) in the table's frame, in metres.

        Returns
        -------
        bool
            False if one of them is behind the camera. Occlusion is ignored.
        """
        at = self.pixels(points)
        within = (at >= -0.5) & (at <= (self.lens.width - 0.5, self.lens.height - 0.5))  # NaN is not
        return bool(within.all())

    def windowed(self, points: NDArray[np.float64]) -> Camera:
        """Return the camera of the part of the image around points, with a margin of 1 pixel.

        Parameters
        ----------
        points
            Points of shape (n, 3) in the table's frame, in metres.

        Returns
        -------
        Camera
            Camera with an equal pose and a smaller image.

        Raises
        ------
        SimulationError
            If the image shows none of the points.
        """
        at = self.pixels(points)
        low = np.clip(np.floor(at.min(axis=0)) - 1, 0, None)
        high = np.minimum(np.ceil(at.max(axis=0)) + 2, (self.lens.width, self.lens.height))
        if not (low < high).all():
            raise SimulationError("the thing must be in the image of the camera; move it, or turn the camera")
        (width, height), (left, above) = (high - low).astype(int).tolist(), low.tolist()
        lens = replace(self.lens, width=width, height=height, cx=self.lens.cx - left, cy=self.lens.cy - above)
        return replace(self, lens=lens)


def looking_pose(eye: ArrayLike, target: ArrayLike) -> NDArray[np.float64]:
    """Return the pose of an upright camera that looks at a target.

    In a view from straight above, the y axis of the table points up in the image.

    Parameters
    ----------
    eye
        Position of the camera, shape (3,), in metres.
    target
        Point in the middle of the image, shape (3,), in metres.

    Returns
    -------
    ndarray
        Transform of shape (4, 4) from the camera's frame to the table's.

    Raises
    ------
    SimulationError
        If the points are equal or not finite.

    Examples
    --------
    >>> looking_pose((0, 0, 1), (0, 0, 0))[:3, :3].tolist()
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
    """
    at = np.asarray(eye, dtype=np.float64)
    forward = np.asarray(target, dtype=np.float64) - at
    if not np.isfinite(forward).all() or not np.linalg.norm(forward) > 1e-9:
        raise SimulationError(f"`eye` and `target` must be finite and different, got {eye!r} and {target!r}")
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    if np.linalg.norm(right) < 1e-9:
        right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1) + 0.0
    pose[:3, 3] = at
    return pose


def check_place(height: float, back: float, azimuth: float) -> None:
    """Raise SimulationError for an impossible place of a camera.

    Parameters
    ----------
    height
        Height above the table in metres.
    back
        Distance from the table's edge in metres.
    azimuth
        Direction in radians.

    Raises
    ------
    SimulationError
        If the height is not above 0, a length is not less than ``MAX_CAMERA_DISTANCE``, or the azimuth is not finite.
    """
    if not 0 < height < MAX_CAMERA_DISTANCE:
        raise SimulationError(
            f"a camera must be above the table and below {MAX_CAMERA_DISTANCE:g} m, got a height of {height:g} m"
        )
    if not abs(back) < MAX_CAMERA_DISTANCE:
        raise SimulationError(f"a camera must be within {MAX_CAMERA_DISTANCE:g} m of the table's edge, got {back:g} m")
    if not np.isfinite(azimuth):
        raise SimulationError(f"a camera's azimuth must be finite, got {azimuth:g}")


def chair_camera(
    table: LaidTable, height: float = HEIGHT, back: float = 0.0, azimuth: float = 0.0, lens: Intrinsics = KINECT
) -> Camera:
    """Return the camera of a person at the table: above its near edge, looking at the centre of the things on it.

    Parameters
    ----------
    table
        A laid table.
    height
        Height above the table in metres.
    back
        Distance from the table's near edge in metres.
    azimuth
        Angle in radians by which the camera is moved around the table, counter-clockwise from above.
    lens
        Intrinsics of the camera.

    Returns
    -------
    The camera. If it would not see all things, it is farther away along the same line.

    Raises
    ------
    SimulationError
        If the camera is not above the table, or cannot see all things.
    """
    check_place(height, back, azimuth)
    corners = np.concatenate([_corners(thing.box) for thing in table.things] or [np.zeros((1, 3))])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    target = np.array([middle[0], middle[1], 0.0])
    away = np.array([0.0, table.top.low[1] - back - middle[1], height])
    cosine, sine = np.cos(azimuth), np.sin(azimuth)
    away = np.array([-sine * away[1], cosine * away[1], height])
    for farther in 1.05 ** np.arange(120):
        camera = Camera(looking_pose(target + farther * away, target), lens)
        if camera.sees(corners):
            return camera
    raise SimulationError("the table is too large for one image; increase the height of the camera")


def _corners(box: NDArray[np.float64]) -> NDArray[np.float64]:
    choose = (np.arange(8)[:, None] >> np.arange(3)) & 1
    return np.take_along_axis(box, choose, axis=0)
