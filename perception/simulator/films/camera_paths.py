"""Paths of a camera that a person carries: the sway of the head, and a walk around a side of the table."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera


class CameraPath(Protocol):
    """Movement of a camera."""

    def moved(self, camera: Camera, at: float) -> Camera:
        """Return the camera as it is at a time.

        Parameters
        ----------
        camera
            Camera without the movement.
        at
            Time in seconds.

        Returns
        -------
        Camera
            The camera with another pose.
        """
        ...  # pragma: no cover


@dataclass(frozen=True)
class HeadMotion:
    """Slow movement of a camera on a person's head: sums of sines, whose phases and periods are random.

    Parameters
    ----------
    shift
        Largest movement along each axis, in metres.
    turn
        Largest turn about each axis, in radians.
    periods
        Shortest and longest period, in seconds.
    seed
        Seed of periods and phases.
    """

    shift: float = 0.05
    turn: float = np.deg2rad(4.0)
    periods: tuple[float, float] = (3.0, 9.0)
    seed: int = 0

    def moved(self, camera: Camera, at: float) -> Camera:
        """Return the camera as it is at a time.

        Parameters
        ----------
        camera
            Camera in its mean pose.
        at
            Time in seconds.

        Returns
        -------
        Camera
            The camera with another pose.
        """
        from scipy.spatial.transform import Rotation

        rng = np.random.default_rng(self.seed)
        periods, phases = rng.uniform(*self.periods, (6, 2)), rng.uniform(0, 2 * np.pi, (6, 2))
        waves = np.sin(2 * np.pi * at / periods + phases).mean(axis=1)
        offset = np.eye(4)
        offset[:3, :3] = Rotation.from_rotvec(self.turn * waves[:3]).as_matrix()
        offset[:3, 3] = self.shift * waves[3:]
        return replace(camera, pose=camera.pose @ offset)


@dataclass(frozen=True)
class Walk:
    """Walk of a person around a side of the table and back, again and again, who looks at one place on the table.

    Parameters
    ----------
    turn
        Angle in radians about that place from one end of the way to the other, counter-clockwise from above.
    seconds
        Time in seconds from one end to the other.
    sway
        Movement of the head in addition, or None.

    Examples
    --------
    >>> from deixis.perception.simulator.cameras.camera import looking_pose
    >>> camera = Camera(looking_pose((0.0, -0.6, 0.7), (0.0, 0.0, 0.0)))
    >>> (Walk(np.pi / 2, 10.0, sway=None).moved(camera, 10.0).eye.round(3) + 0.0).tolist()
    [0.6, 0.0, 0.7]
    """

    turn: float = np.deg2rad(60.0)
    seconds: float = 12.0
    sway: HeadMotion | None = field(default_factory=HeadMotion)

    def moved(self, camera: Camera, at: float) -> Camera:
        """Return the camera as it is at a time.

        Parameters
        ----------
        camera
            Camera at the beginning of the way.
        at
            Time in seconds.

        Returns
        -------
        Camera
            The camera with another pose.
        """
        ahead = camera.pose[:3, 2]
        middle = camera.eye - ahead * camera.eye[2] / min(ahead[2], -1e-3)
        angle = self.turn * (1 - np.cos(np.pi * at / self.seconds)) / 2
        cosine, sine = np.cos(angle), np.sin(angle)
        around = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        pose = camera.pose.copy()
        pose[:3, :3] = around @ camera.pose[:3, :3]
        pose[:3, 3] = around @ (camera.eye - middle) + middle
        walked = replace(camera, pose=pose)
        return walked if self.sway is None else self.sway.moved(walked, at)


CAMERA_PATHS = ("still", "sway", "walk")
"""Names of the paths that commands and benchmarks know."""


def camera_path(name: str, seed: int = 0) -> CameraPath | None:
    """Return the path of a name.

    Parameters
    ----------
    name
        ``still``, ``sway`` (a head that moves by 5 cm and 4 degrees) or ``walk`` (it also walks around a side of the
        table).
    seed
        Seed of the sway.

    Returns
    -------
    CameraPath or None
        None for a camera that stands still.

    Raises
    ------
    SimulationError
        If there is no such path.
    """
    if name not in CAMERA_PATHS:
        raise SimulationError(f"the path of the camera must be one of {', '.join(CAMERA_PATHS)}, got '{name}'")
    sway = HeadMotion(seed=seed)
    return None if name == "still" else sway if name == "sway" else Walk(sway=sway)
