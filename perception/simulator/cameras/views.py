"""Simulate views of single things, for learning to recognise them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera, looking_pose
from deixis.perception.simulator.cameras.depth import DepthSensor, look
from deixis.perception.simulator.laying import stood
from deixis.perception.simulator.meshes.rays import RayCaster

CAMERA_DISTANCES = (0.7, 1.0)
"""Range of distances in metres from the camera to the centre of the thing."""

CAMERA_ELEVATIONS = (np.deg2rad(15.0), np.deg2rad(80.0))
"""Range of angles in radians between the line of sight and the table's plane."""

MAX_THING_SIZE = 1.0
"""Maximum extent of a thing in metres, so that all of it is in front of the camera."""


def views_of(mesh: Mesh, count: int, seed: int, noise: float = 1.0, upright: bool = False) -> list[PointCloud]:
    """Simulate views of a single thing by depth cameras around it: only its points, without a table.

    Parameters
    ----------
    mesh
        The thing, in metres, z up; its position does not matter.
    count
        Number of views.
    seed
        Seed of cameras and noise. Equal seeds give equal views, and a larger ``count`` only adds views.
    noise
        Factor on the noise of :class:`DepthSensor`; 0 for an ideal sensor.
    upright
        Return clouds in the table's frame, z up, with the camera's position as origin, instead of the camera's frame.

    Returns
    -------
    A cloud for each view.

    Raises
    ------
    SimulationError
        If the mesh has no faces, or is larger than ``MAX_THING_SIZE``.

    Notes
    -----
    The cameras are uniformly distributed over the part of the upper hemisphere within ``CAMERA_ELEVATIONS``, at
    ``CAMERA_DISTANCES`` from the centre of the thing, and look at it.

    Examples
    --------
    >>> from deixis.perception.simulator.meshes.tableware import make
    >>> views = views_of(make("mug", seed=1).mesh, count=2, seed=3)
    >>> [bool(view.finite.all()) for view in views], min(map(len, views)) > 1000
    ([True, True], True)
    """
    standing = stood(mesh)
    low, high = standing.vertices.min(axis=0), standing.vertices.max(axis=0)
    if (high - low).max() > MAX_THING_SIZE:
        size = (high - low).max()
        raise SimulationError(
            f"a mesh must be at most {MAX_THING_SIZE:g} m long, got {size:g} m; is its unit the metre?"
        )
    caster, sensor = RayCaster([standing]), DepthSensor(noise=noise) if noise > 0 else DepthSensor.ideal()
    middle = (low + high) / 2
    return [
        _view(standing, middle, caster, sensor, np.random.default_rng([seed, number]), upright)
        for number in range(count)
    ]


def _view(
    mesh: Mesh,
    middle: NDArray[np.float64],
    caster: RayCaster,
    sensor: DepthSensor,
    rng: np.random.Generator,
    upright: bool,
) -> PointCloud:
    height = rng.uniform(*np.sin(CAMERA_ELEVATIONS))  # uniform on the sphere (Archimedes)
    azimuth, distance = rng.uniform(0, 2 * np.pi), rng.uniform(*CAMERA_DISTANCES)
    aside = np.sqrt(1 - height**2)
    eye = middle + distance * np.array([aside * np.cos(azimuth), aside * np.sin(azimuth), height])
    camera = Camera(looking_pose(eye, middle)).windowed(mesh.vertices)
    found = look(caster, camera, sensor, rng)
    points = found.points[found.mesh >= 0]
    if not upright:
        return PointCloud(points)
    x, y, z = eye.tolist()
    return PointCloud(camera.to_table(points).astype(np.float32), origin=(x, y, z))
