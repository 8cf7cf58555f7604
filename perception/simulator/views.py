"""Views of single things, for learning to recognise them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.camera import Camera, looking_pose
from deixis.perception.simulator.depth import DepthSensor, look
from deixis.perception.simulator.laying import stood
from deixis.perception.simulator.rays import RayCaster

CAMERA_DISTANCES = (0.7, 1.0)
"""Metres from the camera to the middle of the thing."""

CAMERA_ELEVATIONS = (np.deg2rad(15.0), np.deg2rad(80.0))
"""Angles between the line of sight and the table's plane."""

MAX_THING_SIZE = 1.0
"""Metres that a thing may measure, so that all of it is before the camera."""


def views_of(mesh: Mesh, count: int, seed: int, noise: float = 1.0, upright: bool = False) -> list[PointCloud]:
    """Return so many views of a thing by itself, as a depth camera at other places sees it: only its points, without a
    table.

    The mesh is in metres, z up, wherever it stands. Cameras are spread evenly over the part of the upper hemisphere
    that ``CAMERA_ELEVATIONS`` leaves, at ``CAMERA_DISTANCES`` from the middle of the thing, and look there. Each cloud
    is in its camera's frame, with the camera as origin; with ``upright`` it is in the table's, z up, with the camera
    where it stood. ``noise`` multiplies that of :class:`DepthSensor`, and 0 takes away all that is wrong with the
    sensor. The same seed gives the same views, and more views begin with fewer's. Raises SimulationError for a mesh
    without faces or larger than ``MAX_THING_SIZE``.

    >>> from deixis.perception.simulator.tableware import make
    >>> views = views_of(make("mug", seed=1).mesh, count=2, seed=3)
    >>> [bool(view.finite.all()) for view in views], min(map(len, views)) > 1000
    ([True, True], True)
    """
    standing = stood(mesh)
    low, high = standing.vertices.min(axis=0), standing.vertices.max(axis=0)
    if (high - low).max() > MAX_THING_SIZE:
        raise SimulationError(f"the mesh measures {(high - low).max():g} m; is its unit the metre?")
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
    height = rng.uniform(*np.sin(CAMERA_ELEVATIONS))  # even on the sphere, by Archimedes
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
