"""Follow the pose of a camera that moves, in the frame of the table.

Some frames are kept as keyframes: points of the table and of what stands still on it. Each further frame is registered
with the keyframe whose pose is nearest. The pose therefore drifts only where a new part of the way begins; a camera
that comes back finds its old keyframes, and its pose is again what it was. The plane of the table, which never moves,
corrects height and tilt of each new keyframe.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.camera.registration import Landmarks, Levels, Registration, levels_of, register
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.table.reference import TABLE

KEYFRAME_SHIFT, KEYFRAME_TURN = 0.12, np.deg2rad(10.0)
"""Distance in metres and angle in radians from all keyframes at which a new one is made."""

MAX_KEYFRAMES = 40

MIN_CLOSE, MIN_ALIKE = 0.5, 0.4
"""Minimum shares of the points in view whose distance and brightness agree, for a pose to be taken."""

SURE = 0.6
"""Minimum agreement at which no other start is tried."""

LOST_AFTER, ASIDE = 0.25, 0.03
"""Time in seconds without a pose after which poses beside the last one are tried, and their distance in metres."""

MIN_POINTS = 150
"""Minimum number of points in view that are compared."""

STANDING = 0.35
"""Distance in pixels by which no part of the image may have moved, for the camera to stand still."""

MIN_CONTRAST = 4.0
"""Minimum gradient of the brightness at a point whose brightness is compared, in units (0 to 255) for each pixel."""

CELL, PER_CELL = 8, 6
"""Side in pixels of the cells from each of which the points of the largest gradients are taken, and their number."""

TABLE_STEP, THING_STEP = 6, 2
"""Strides, in rows and columns, of the points of the table and of those of a thing whose distances are compared."""

EDGE = 0.012
"""Difference of depths in metres at which a pixel shows what lies behind an edge."""

PLANE = 0.008
"""Distance in metres from the plane within which points of the table correct it."""


@dataclass(frozen=True, eq=False)
class Keyframe:
    """Frame with a known pose (4, 4), its landmarks, and the owner of each landmark by a key, shape (n,).

    ``keys`` are the numbers of owners: 0 for the table, and for a thing the number of its rest, which is never used
    again.
    """

    pose: NDArray[np.float64]
    landmarks: Landmarks
    keys: NDArray[np.int64]

    def standing(self, rests: Mapping[int, int]) -> Landmarks:
        """Return the landmarks of the table and of things that have not moved since.

        Parameters
        ----------
        rests
            Number of the rest of each thing that stands still, by its slot.

        Returns
        -------
        Landmarks
            Landmarks whose keys are 0 or one of these numbers.
        """
        still = np.isin(self.keys, [TABLE, *rests.values()])
        if still.all():
            return self.landmarks
        of = self.landmarks
        return Landmarks(of.places[still], of.normals[still], tuple(tint[still] for tint in of.tints))


class CameraMotion:
    """Pose of the camera from frame to frame.

    Parameters
    ----------
    pose
        Pose (4, 4) of the first frame: from the frame of the cloud to that of the table.
    at
        Its time in seconds.
    """

    def __init__(self, pose: NDArray[np.float64], at: float) -> None:
        self.pose = pose
        """Pose (4, 4) of the last frame."""
        self._at = at
        self._velocity = np.zeros(6)
        self._keyframes: list[Keyframe] = []

    def follow(
        self, image: FrameImage, at: float, rests: Mapping[int, int], noise: float
    ) -> tuple[Registration | None, Levels]:
        """Find the pose of a frame.

        Parameters
        ----------
        image
            The frame.
        at
            Its time in seconds.
        rests
            Number of the rest of each thing that stands still, by its slot.
        noise
            Standard deviation of depths at one metre.

        Returns
        -------
        tuple
            The registration, or None if the frame agrees with no keyframe; and the images that were registered.
        """
        levels = levels_of(image)
        seconds = at - self._at
        ahead = _displaced(self.pose, self._velocity * seconds)
        found: Registration | None = None
        nearest = min(self._keyframes, key=lambda key: _way(key.pose, ahead), default=None)
        landmarks = None if nearest is None else nearest.standing(rests)
        lost = seconds > LOST_AFTER
        for start in (ahead, self.pose, *(self._aside() if lost else ())):
            if landmarks is None or (found is not None and found.agreement > SURE):
                break
            tried = register(landmarks, levels, start, noise, max(seconds / LOST_AFTER, 1.0))
            good = tried.points >= MIN_POINTS and tried.close >= MIN_CLOSE and tried.alike >= MIN_ALIKE
            if good and (found is None or tried.agreement > found.agreement):
                found = tried
        if found is not None:
            if seconds > 0:
                self._velocity = _displacement(self.pose, found.pose) / seconds
            self.pose, self._at = found.pose, at
        return found, levels

    def _aside(self) -> Iterator[NDArray[np.float64]]:
        """Yield poses beside the last one, in the directions of the rows and columns of the image."""
        for across, down in itertools.product((-ASIDE, 0.0, ASIDE), repeat=2):
            if across or down:
                pose = self.pose.copy()
                pose[:3, 3] += pose[:3, :3] @ np.array([across, down, 0.0])
                yield pose

    def needs_keyframe(self) -> bool:
        """Return True if the pose is far from those of all keyframes.

        Returns
        -------
        bool
            True also if there is no keyframe.
        """
        return all(_way(key.pose, self.pose) > 1 for key in self._keyframes)

    def add_keyframe(
        self,
        image: FrameImage,
        levels: Levels,
        owner: NDArray[np.int16],
        view: TableView,
        rests: Mapping[int, int],
    ) -> None:
        """Keep the last frame as a keyframe.

        Parameters
        ----------
        image, levels
            The frame, and the images by which it was registered.
        owner
            Owner of each pixel (r, c) that shows what stands still, -1 for others.
        view
            View of the table in this pose.
        rests
            Number of the rest of each thing that stands still, by its slot.
        """
        keys = np.full(int(owner.max(initial=0)) + 2, -1)
        keys[TABLE] = TABLE
        for slot, rest in rests.items():
            if slot < len(keys) - 1:
                keys[slot] = rest
        of = keys[owner]  # the last one is for -1
        landmarks, pixels = _landmarks(image, levels, of, view)
        self._keyframes.append(Keyframe(self.pose, landmarks, of.ravel()[pixels]))
        del self._keyframes[: len(self._keyframes) - MAX_KEYFRAMES]

    def level(self, points: NDArray[np.float64]) -> None:
        """Correct height and tilt by points that lie on the table.

        Parameters
        ----------
        points
            Points (n, 3) of the table in its frame, by the present pose; those farther from the plane than ``PLANE``
            do not count.
        """
        from scipy.spatial.transform import Rotation

        points = points[np.abs(points[:, 2]) < PLANE]
        if len(points) < 3 * MIN_POINTS or min(np.ptp(points[:, :2], axis=0)) < 0.1:
            return
        for _ in range(3):
            columns = np.column_stack([np.ones(len(points)), points[:, :2]])
            fit = np.linalg.lstsq(columns, points[:, 2], rcond=None)[0]
            off = points[:, 2] - columns @ fit
            points = points[np.abs(off) < 3 * max(float(np.std(off)), 1e-4)]
        level = np.eye(4)
        level[:3, :3] = Rotation.from_rotvec([-fit[2], fit[1], 0.0]).as_matrix()
        level[2, 3] = -fit[0]
        self.pose = level @ self.pose


def moved_by(one: TableView, other: TableView) -> float:
    """Return the largest distance in pixels by which points of the table move between two views.

    Parameters
    ----------
    one, other
        Views by the same camera.

    Returns
    -------
    float
        Largest distance over a grid of 4 by 4 pixels.
    """
    rows, columns = one.level.shape
    grid = np.array([(u, v, 1.0) for u in np.linspace(0, columns - 1, 4) for v in np.linspace(0, rows - 1, 4)])
    level = one.level[grid[:, 1].astype(np.int64), grid[:, 0].astype(np.int64)].astype(np.float64)
    usual = float(np.median(level[np.isfinite(level)])) if np.isfinite(level).any() else 1.0
    depth = np.where(np.isfinite(level), np.minimum(level, 3 * usual), usual)
    seen = (grid * depth[:, None] - one.offset) @ np.linalg.inv(one.matrix).T
    again = seen @ other.matrix.T + other.offset
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.linalg.norm(again[:, :2] / again[:, 2:] - grid[:, :2], axis=1)
    return float(np.where(again[:, 2] > 0, away, np.inf).max())


def _landmarks(
    image: FrameImage, levels: Levels, keys: NDArray[np.int64], view: TableView
) -> tuple[Landmarks, NDArray[np.intp]]:
    """Return the landmarks of a frame, and their pixels as flat indices."""
    from scipy.ndimage import map_coordinates, minimum_filter

    rows, columns = image.depth.shape
    usable = (keys >= 0) & (image.depth > 0)
    nearest = minimum_filter(np.where(image.depth > 0, image.depth, np.inf), 5, mode="nearest")
    usable &= image.depth - nearest < EDGE + 0.02 * image.depth
    usable[:3], usable[-3:], usable[:, :3], usable[:, -3:] = False, False, False, False
    down, across = np.gradient(levels[-1].brightness)
    contrast = np.where(usable, np.hypot(down, across), 0.0)
    strong = _strongest(contrast)
    grid = np.zeros((rows, columns), np.bool_)
    grid[::TABLE_STEP, ::TABLE_STEP] = True
    dense = np.zeros((rows, columns), np.bool_)
    dense[::THING_STEP, ::THING_STEP] = True
    points = image.points.astype(np.float64) @ view.back[:3, :3].T + view.back[:3, 3]
    solid = usable & np.where(keys == TABLE, grid & (np.abs(points[..., 2]) < PLANE), dense)
    pixels = np.flatnonzero(strong | solid)
    normals = np.full((len(pixels), 3), np.nan)
    flat = keys.ravel()[pixels] == TABLE
    on = solid.ravel()[pixels]
    normals[on & flat] = 0.0, 0.0, 1.0
    normals[on & ~flat] = _normals(points, image.depth, pixels[on & ~flat])
    bright = strong.ravel()[pixels]
    row, column = np.divmod(pixels, columns)
    at, tints = np.stack([row, column]).astype(np.float64), list[NDArray[np.float64]]()
    for level in reversed(levels):  # the first pixel of a smaller image is the second one of the larger image
        tint = map_coordinates(level.brightness, at, order=1, mode="nearest")
        tints.insert(0, np.where(bright, tint, np.nan).astype(np.float64))
        at = (at - 1) / 2
    places = points.reshape(-1, 3)[pixels].copy()
    places[flat & (np.abs(places[:, 2]) < PLANE), 2] = 0.0
    return Landmarks(places, normals, tuple(tints)), pixels


def _strongest(contrast: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return a mask of the pixels with the largest gradients of each cell."""
    rows, columns = (size // CELL * CELL for size in contrast.shape)
    blocks = contrast[:rows, :columns].reshape(rows // CELL, CELL, columns // CELL, CELL).transpose(0, 2, 1, 3)
    cells = blocks.reshape(-1, CELL * CELL)
    least = np.sort(cells, axis=1)[:, -PER_CELL, None]
    chosen = (cells >= least) & (cells > MIN_CONTRAST)
    found = np.zeros(contrast.shape, np.bool_)
    taken = chosen.reshape(rows // CELL, columns // CELL, CELL, CELL).transpose(0, 2, 1, 3)
    found[:rows, :columns] = taken.reshape(rows, columns)
    return found


def _normals(
    points: NDArray[np.float64], depth: NDArray[np.float32], pixels: NDArray[np.intp], reach: int = 2
) -> NDArray[np.float64]:
    """Return the normals (k, 3) of pixels by the plane of the points around; NaN where these are not on one surface."""
    rows, columns = depth.shape
    row, column = np.divmod(pixels, columns)
    steps = np.arange(-reach, reach + 1)
    r = np.clip(row[:, None] + np.repeat(steps, len(steps)), 0, rows - 1)
    c = np.clip(column[:, None] + np.tile(steps, len(steps)), 0, columns - 1)
    near = points[r, c]
    fits = (depth[r, c] > 0) & (np.abs(depth[r, c] - depth[row, column][:, None]) < EDGE)
    count = fits.sum(axis=1)
    near = np.where(fits[..., None], near, 0.0)
    mean = near.sum(axis=1) / np.maximum(count, 1)[:, None]
    off = np.where(fits[..., None], near - mean[:, None], 0.0)
    values, vectors = np.linalg.eigh(np.einsum("kni,knj->kij", off, off))
    flat = (count >= 12) & (values[:, 0] < 0.25 * values[:, 1])
    return np.where(flat[:, None], vectors[:, :, 0], np.nan)


def _way(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """Return how far two poses are apart; 1 is where a new keyframe is made."""
    step = _displacement(one, other)
    shift = np.linalg.norm(one[:3, 3] - other[:3, 3])
    return float(shift / KEYFRAME_SHIFT + np.linalg.norm(step[3:]) / KEYFRAME_TURN)


def _displacement(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the shift and the rotation vector (6,) from one pose to another, about the camera."""
    from scipy.spatial.transform import Rotation

    turn = Rotation.from_matrix(other[:3, :3] @ one[:3, :3].T).as_rotvec()
    return np.concatenate([other[:3, 3] - one[:3, 3], turn])


def _displaced(pose: NDArray[np.float64], step: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return a pose after a shift and a rotation about the camera."""
    from scipy.spatial.transform import Rotation

    found = pose.copy()
    found[:3, :3] = Rotation.from_rotvec(step[3:]).as_matrix() @ pose[:3, :3]
    found[:3, 3] += step[:3]
    return found
