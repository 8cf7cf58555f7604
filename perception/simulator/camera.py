"""A pinhole camera and where it stands.

Its frame is that of a lens (REP-103): x to the right in the image, y down, z forward. The table's frame has x to the
right and y away from whoever sits there, z up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.laying import LaidTable

HEIGHT = 0.7
"""Metres of the usual camera above the table."""

MAX_CAMERA_DISTANCE = 20.0

KINECT = Intrinsics(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)
"""The usual intrinsics of a first Kinect."""


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera with the pose (4, 4) that takes points of its frame to the table's.

    A pixel in column u and row v sees along ((u - cx) / fx, (v - cy) / fy, 1).
    """

    pose: NDArray[np.float64]
    lens: Intrinsics = KINECT

    @property
    def eye(self) -> NDArray[np.float64]:
        """Where it stands, in the table's frame (3,)."""
        position: NDArray[np.float64] = self.pose[:3, 3]
        return position

    def directions(self) -> NDArray[np.float64]:
        """Return where the pixels look, row by row, in the camera's frame (rows * columns, 3), with z = 1."""
        lens = self.lens
        v, u = np.mgrid[: lens.height, : lens.width]
        rays = [(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, np.ones(u.shape)]
        return np.stack(rays, axis=-1).reshape(-1, 3)

    def pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return where points (n, 3) of the table's frame are in the image, (n, 2); NaN for those behind the camera."""
        seen, lens = self.to_camera(points), self.lens
        z = np.where(seen[:, 2] > 0, seen[:, 2], np.nan)
        return np.stack([lens.fx * seen[:, 0] / z + lens.cx, lens.fy * seen[:, 1] / z + lens.cy], axis=1)

    def to_table(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return points (n, 3) of the camera's frame in the table's."""
        moved: NDArray[np.float64] = points @ self.pose[:3, :3].T + self.pose[:3, 3]
        return moved

    def to_camera(self, points: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return points (n, 3) of the table's frame in the camera's."""
        moved: NDArray[np.float64] = (points - self.pose[:3, 3]) @ self.pose[:3, :3]
        return moved

    def sees(self, points: NDArray[np.float64]) -> bool:
        """Return whether all points (n, 3) of the table's frame are within the image."""
        at = self.pixels(points)
        within = (at >= -0.5) & (at <= (self.lens.width - 0.5, self.lens.height - 0.5))  # NaN is not
        return bool(within.all())

    def windowed(self, points: NDArray[np.float64]) -> Camera:
        """Return the part of the image that shows the points (n, 3) of the table's frame, with a pixel to spare.

        Raises SimulationError where the image shows none of it.
        """
        at = self.pixels(points)
        low = np.clip(np.floor(at.min(axis=0)) - 1, 0, None)
        high = np.minimum(np.ceil(at.max(axis=0)) + 2, (self.lens.width, self.lens.height))
        if not (low < high).all():
            raise SimulationError("the camera does not see the thing")
        (width, height), (left, above) = (high - low).astype(int).tolist(), low.tolist()
        lens = replace(self.lens, width=width, height=height, cx=self.lens.cx - left, cy=self.lens.cy - above)
        return replace(self, lens=lens)


def looking_pose(eye: ArrayLike, target: ArrayLike) -> NDArray[np.float64]:
    """Return the pose (4, 4) of a camera at ``eye`` that looks at ``target``, upright; from above, away from the viewer
    is up.

    >>> looking_pose((0, 0, 1), (0, 0, 0))[:3, :3].tolist()
    [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
    """
    at = np.asarray(eye, dtype=np.float64)
    forward = np.asarray(target, dtype=np.float64) - at
    if not np.isfinite(forward).all() or not np.linalg.norm(forward) > 1e-9:
        raise SimulationError(f"a camera at {eye!r} cannot look at {target!r}")
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
    """Raise SimulationError for a place where no camera can be; lengths in metres, the azimuth in radians."""
    if not 0 < height < MAX_CAMERA_DISTANCE:
        raise SimulationError(f"a camera stands above the table, below {MAX_CAMERA_DISTANCE:g} m, not at {height:g} m")
    if not abs(back) < MAX_CAMERA_DISTANCE:
        raise SimulationError(
            f"a camera stands within {MAX_CAMERA_DISTANCE:g} m of the table's edge, not {back:g} m back"
        )
    if not np.isfinite(azimuth):
        raise SimulationError(f"a camera's azimuth is a number, not {azimuth:g}")


def chair_camera(
    table: LaidTable, height: float = HEIGHT, back: float = 0.0, azimuth: float = 0.0, lens: Intrinsics = KINECT
) -> Camera:
    """Return the camera of whoever sits at the table: above its near edge, looking at the middle of what lies there.

    ``height`` above the table and ``back`` from its edge are in metres; ``azimuth`` (radians) takes the camera around
    the table, counter-clockwise from above. Where not everything is in view it stands farther away along the same
    line. Raises SimulationError for a camera that is not above the table.
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
    raise SimulationError("the table is too large for one image; give the camera more height")


def _corners(box: NDArray[np.float64]) -> NDArray[np.float64]:
    choose = (np.arange(8)[:, None] >> np.arange(3)) & 1
    return np.take_along_axis(box, choose, axis=0)
