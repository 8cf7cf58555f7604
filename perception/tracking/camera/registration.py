"""Register a frame with an earlier one: the pose of the camera that explains depths and brightness best.

The points of the earlier frame are projected into the new one. Each point gives the distance of the measured point from
its tangent plane (point-to-plane, Chen and Medioni 1992, with projective data association), and the difference of
brightness at its pixel (direct image alignment, as Steinbruecker, Sturm and Cremers 2011). The tangent planes fix
height and tilt; brightness fixes the motion along a plane, which they leave open. Both are solved together by
Gauss-Newton with Tukey's weights, so that what moved by itself counts little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage, Optics

ITERATIONS = (6, 5, 4)
"""Largest number of steps at a quarter and at half of the resolution, and at the whole one."""

BRIGHTNESS_NOISE = 4.0
"""Standard deviation of the brightness (0 to 255) of one place from frame to frame."""

TUKEY = 4.0
"""Minimum residual in standard deviations at which a point has no weight."""

OCCLUSION = 0.03
"""Minimum difference of depths in metres at which a point counts as hidden, or as gone."""

PRIOR_SHIFT, PRIOR_TURN = 0.02, np.deg2rad(2.0)
"""Standard deviations of the error of the predicted pose, in metres and radians."""

MIN_STEP = 2e-5
"""Step in metres and radians below which the solution is taken."""


@njit(cache=True, nogil=True)
def brightness_of(colour):  # type: ignore[no-untyped-def]
    """Return the mean (r, c) of the colours; black pixels with four or more others around them get their mean."""
    rows, columns = colour.shape[:2]
    found = np.empty((rows, columns), np.float32)
    for i in range(rows):
        for j in range(columns):
            found[i, j] = (colour[i, j, 0] + colour[i, j, 1] + colour[i, j, 2]) / 3
    filled = found.copy()
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            if found[i, j] > 0:
                continue
            total, count = 0.0, 0
            for m in range(i - 1, i + 2):
                for n in range(j - 1, j + 2):
                    if found[m, n] > 0:
                        total += found[m, n]
                        count += 1
            if count >= 4:
                filled[i, j] = total / count
    return filled


@njit(cache=True, nogil=True)
def _accumulate(hessian, vector, line, n0, n1, n2, q0, q1, q2, off, scale):  # type: ignore[no-untyped-def]
    """Add a residual ``off`` and its row ``line`` (6,) to the upper triangle of the normal equations.

    The residual has the gradient ``n`` by the place, whose lever from the centre of the rotation is ``q``. ``scale`` is
    the square root of its weight.
    """
    weight = scale * scale
    line[0], line[1], line[2] = n0, n1, n2
    line[3], line[4], line[5] = q1 * n2 - q2 * n1, q2 * n0 - q0 * n2, q0 * n1 - q1 * n0
    for r in range(6):
        vector[r] += weight * line[r] * off
        for s in range(r, 6):
            hessian[r, s] += weight * line[r] * line[s]


@njit(cache=True, nogil=True)
def normal_equations(  # type: ignore[no-untyped-def]
    places, normals, tints, turn, shift, matrix, eye, rays, depth, brightness, sigma_depth, noise, sigma_tint, middle
):
    """Return the matrix (6, 6), the vector (6,), and the counts (4,) of one Gauss-Newton step.

    The unknowns are a shift and a rotation vector of the frame, in the table's frame and about ``middle``. The counts
    are those of the points with a depth and with a small distance, and those with a brightness and a small difference.
    NaN in ``normals`` or ``tints`` leaves out that part of a point.

    Parameters
    ----------
    places, normals, tints
        Points (n, 3) and normals (n, 3) in the table's frame, and their brightness (n,).
    turn, shift
        Pose of the frame: rotation (3, 3) and translation (3,) to the table's frame.
    matrix, eye, rays
        Camera as in :class:`~deixis.perception.tracking.frames.image.Optics`, and the inverse of its matrix.
    depth, brightness
        Images (r, c) of the new frame.
    sigma_depth, noise, sigma_tint
        Standard deviations: of the distances, at least the first, and the second times the squared depth; and of the
        brightness.
    middle
        Centre of the rotation, shape (3,).
    """
    rows, columns = depth.shape
    hessian, vector, counts = np.zeros((6, 6)), np.zeros(6), np.zeros(4)
    line, seen = np.empty(6), np.empty(3)
    for k in range(len(places)):
        a, b, c = places[k, 0] - shift[0], places[k, 1] - shift[1], places[k, 2] - shift[2]
        for axis in range(3):
            seen[axis] = turn[0, axis] * a + turn[1, axis] * b + turn[2, axis] * c - eye[axis]
        d = matrix[2, 0] * seen[0] + matrix[2, 1] * seen[1] + matrix[2, 2] * seen[2]
        if d <= 0.05:
            continue
        u = (matrix[0, 0] * seen[0] + matrix[0, 1] * seen[1] + matrix[0, 2] * seen[2]) / d
        v = (matrix[1, 0] * seen[0] + matrix[1, 1] * seen[1] + matrix[1, 2] * seen[2]) / d
        if not (1 <= u < columns - 2 and 1 <= v < rows - 2):
            continue
        j, i = int(u), int(v)
        m, n = int(v + 0.5), int(u + 0.5)
        z = depth[m, n]
        if z > 0 and abs(z - d) > OCCLUSION:
            continue
        if z > 0 and normals[k, 0] == normals[k, 0]:
            x0 = rays[0, 0] * n + rays[0, 1] * m + rays[0, 2]
            x1 = rays[1, 0] * n + rays[1, 1] * m + rays[1, 2]
            x2 = rays[2, 0] * n + rays[2, 1] * m + rays[2, 2]
            x0, x1, x2 = eye[0] + z * x0, eye[1] + z * x1, eye[2] + z * x2
            q0 = turn[0, 0] * x0 + turn[0, 1] * x1 + turn[0, 2] * x2 + shift[0]
            q1 = turn[1, 0] * x0 + turn[1, 1] * x1 + turn[1, 2] * x2 + shift[1]
            q2 = turn[2, 0] * x0 + turn[2, 1] * x1 + turn[2, 2] * x2 + shift[2]
            n0, n1, n2 = normals[k]
            off = n0 * (q0 - places[k, 0]) + n1 * (q1 - places[k, 1]) + n2 * (q2 - places[k, 2])
            sigma = max(sigma_depth, noise * z * z)
            counts[0] += 1
            scaled = off / (sigma * TUKEY)
            if abs(scaled) < 1:
                counts[1] += 1
                q0, q1, q2 = q0 - middle[0], q1 - middle[1], q2 - middle[2]
                _accumulate(hessian, vector, line, n0, n1, n2, q0, q1, q2, off, (1 - scaled * scaled) / sigma)
        if tints[k] == tints[k]:
            p, q = u - j, v - i
            i00, i01 = brightness[i, j], brightness[i, j + 1]
            i10, i11 = brightness[i + 1, j], brightness[i + 1, j + 1]
            off = (1 - q) * ((1 - p) * i00 + p * i01) + q * ((1 - p) * i10 + p * i11) - tints[k]
            counts[2] += 1
            scaled = off / (sigma_tint * TUKEY)
            if abs(scaled) < 1:
                counts[3] += 1
                gu = ((1 - q) * (i01 - i00) + q * (i11 - i10)) / d
                gv = ((1 - p) * (i10 - i00) + p * (i11 - i01)) / d
                # of the brightness by the point in the cloud's frame, then in the table's
                c0 = gu * (matrix[0, 0] - u * matrix[2, 0]) + gv * (matrix[1, 0] - v * matrix[2, 0])
                c1 = gu * (matrix[0, 1] - u * matrix[2, 1]) + gv * (matrix[1, 1] - v * matrix[2, 1])
                c2 = gu * (matrix[0, 2] - u * matrix[2, 2]) + gv * (matrix[1, 2] - v * matrix[2, 2])
                t0 = -(turn[0, 0] * c0 + turn[0, 1] * c1 + turn[0, 2] * c2)
                t1 = -(turn[1, 0] * c0 + turn[1, 1] * c1 + turn[1, 2] * c2)
                t2 = -(turn[2, 0] * c0 + turn[2, 1] * c1 + turn[2, 2] * c2)
                q0, q1, q2 = places[k, 0] - middle[0], places[k, 1] - middle[1], places[k, 2] - middle[2]
                _accumulate(hessian, vector, line, t0, t1, t2, q0, q1, q2, off, (1 - scaled * scaled) / sigma_tint)
    for r in range(6):
        for s in range(r):
            hessian[r, s] = hessian[s, r]
    return hessian, vector, counts


@dataclass(frozen=True, eq=False)
class Level:
    """Image of a frame for registration: its camera, depths (r, c) and smoothed brightness (r, c)."""

    optics: Optics
    depth: NDArray[np.float32]
    brightness: NDArray[np.float32]


Levels = tuple[Level, ...]
"""Images of one frame, from the smallest to the whole one."""


def levels_of(image: FrameImage) -> Levels:
    """Return the images by which a frame is registered: a quarter and half of the resolution, and the whole one.

    Parameters
    ----------
    image
        The frame.

    Returns
    -------
    tuple of Level
        The smaller image first.
    """
    from scipy.ndimage import gaussian_filter

    levels = [Level(image.optics, image.depth, gaussian_filter(brightness_of(image.colour), 1.0))]
    for _ in ITERATIONS[1:]:
        last = levels[0]
        small = np.ascontiguousarray(gaussian_filter(last.brightness, 1.5)[1::2, 1::2])
        levels.insert(0, Level(last.optics.every(2), np.ascontiguousarray(last.depth[1::2, 1::2]), small))
    return tuple(levels)


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Points of an earlier frame: places and normals (n, 3) in the table's frame, brightness (n,) at each level.

    A normal or a brightness is NaN where it is not used.
    """

    places: NDArray[np.float64]
    normals: NDArray[np.float64]
    tints: tuple[NDArray[np.float64], ...]


@dataclass(frozen=True, eq=False)
class Registration:
    """Pose (4, 4) of a frame, and the shares of its points in view whose distance and brightness agree."""

    pose: NDArray[np.float64]
    close: float
    alike: float
    points: int

    @property
    def agreement(self) -> float:
        """Product of both shares."""
        return self.close * self.alike


def register(
    landmarks: Landmarks, levels: Levels, start: NDArray[np.float64], noise: float, doubt: float = 1.0
) -> Registration:
    """Return the pose of a frame in which points of an earlier frame agree best with it.

    Parameters
    ----------
    landmarks
        Points of the earlier frame.
    levels
        Images of the new frame.
    start
        Predicted pose (4, 4), from the frame of the cloud to the table's.
    noise
        Standard deviation of depths at one metre.
    doubt
        Factor on the standard deviations of the error of the predicted pose.

    Returns
    -------
    Registration
        Pose with the shares of the points that agree.
    """
    from scipy.spatial.transform import Rotation

    middle = landmarks.places.mean(axis=0) if len(landmarks.places) else np.zeros(3)
    pose = start.copy()
    drawn, counts = np.zeros(6), np.zeros(4)
    trust = np.repeat([PRIOR_SHIFT**-2, PRIOR_TURN**-2], 3) / doubt**2
    for level, tints, steps in zip(levels, landmarks.tints, ITERATIONS, strict=True):
        rays = np.linalg.inv(level.optics.matrix)
        for _ in range(steps):
            hessian, vector, counts = normal_equations(
                landmarks.places, landmarks.normals, tints, pose[:3, :3].copy(), pose[:3, 3].copy(),
                level.optics.matrix, level.optics.eye, rays, level.depth, level.brightness, 0.001, noise,
                BRIGHTNESS_NOISE, middle,
            )  # fmt: skip
            step = np.linalg.solve(hessian + np.diag(trust), -vector - trust * drawn)
            drawn += step
            change = np.eye(4)
            change[:3, :3] = Rotation.from_rotvec(step[3:]).as_matrix()
            change[:3, 3] = step[:3] + middle - change[:3, :3] @ middle
            pose = change @ pose
            if np.abs(step).max() < MIN_STEP:
                break
    close, alike = counts[1] / max(counts[0], 1), counts[3] / max(counts[2], 1)
    return Registration(pose, float(close), float(alike), int(counts[0]))
