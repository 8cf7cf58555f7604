"""Simulate a depth camera: the true depth, with noise that grows with its square, and with missing points.

The noise is that of a first-generation Kinect: a standard deviation of 1.425e-3 z^2, and steps of depth of 2.85e-3 z^2,
for z in metres (K. Khoshelham and S. O. Elberink, Accuracy and Resolution of Kinect Depth Data for Indoor Mapping
Applications, Sensors 12, 2012, equations 10 and 11, with their calibration of 2.85e-5 per centimetre and half a pixel
of disparity). The noise of each pixel is independent. The model omits the correlation of neighbouring pixels, the
shadow of the projector, and the effect of glass on infrared light.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.depth import Intrinsics, back_projected
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera
from deixis.perception.simulator.laying import LaidTable
from deixis.perception.simulator.meshes.rays import Hits, RayCaster
from deixis.perception.simulator.meshes.tableware import Colour

NOISE = 1.425e-3
"""Standard deviation in metres of the depth at 1 m; it grows with the square of the depth."""

DISPARITY_STEP = 2.85e-3
"""Distance in metres between two measurable depths at 1 m; it grows with the square of the depth."""

NOTHING, TABLE, FIRST_THING = -1, 0, 1
"""Labels of points: no measurement, the table, and the first thing on it; the other things follow in order."""


@dataclass(frozen=True, slots=True)
class DepthSensor:
    """Errors of a depth sensor; ``DepthSensor.ideal()`` has none.

    Parameters
    ----------
    noise
        Factor on the noise of a Kinect.
    missing
        Share of all points without a depth.
    grazing
        Angles in radians between the ray and the surface's normal: from the first to the second the share of points
        without a depth rises to 1.
    quantised
        Round depths as a Kinect does.
    colour_noise
        Standard deviation of the colours, whose range is 0 to 255.
    """

    noise: float = 1.0
    missing: float = 0.005
    grazing: tuple[float, float] = (np.deg2rad(72.0), np.deg2rad(88.0))
    quantised: bool = False
    colour_noise: float = 2.5

    def __post_init__(self) -> None:
        for name, value, most in (
            ("noise", self.noise, 1000),
            ("missing", self.missing, 1),
            ("colour_noise", self.colour_noise, 256),
        ):
            if not 0 <= value <= most:
                raise SimulationError(f"`{name}` must be from 0 to {most}, got {value:g}")
        if not 0 <= self.grazing[0] < self.grazing[1]:
            raise SimulationError(f"the `grazing` angles must be at least 0 and increase, got {self.grazing}")

    @classmethod
    def ideal(cls) -> DepthSensor:
        """Return a sensor without noise or missing points.

        Returns
        -------
        DepthSensor
            Sensor whose depths and colours are exact.
        """
        return cls(noise=0.0, missing=0.0, grazing=(np.pi, 2 * np.pi), colour_noise=0.0)

    def measured(self, depth: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
        """Return the measured depths for true ones.

        The standard deviation of the noise grows with the square of the depth.

        Parameters
        ----------
        depth
            True depths of shape (n,), in metres.
        rng
            Source of the noise.

        Returns
        -------
        ndarray
            Depths of shape (n,), in metres.
        """
        noisy = depth + rng.standard_normal(len(depth)) * self.noise * NOISE * depth**2
        return _quantised(noisy) if self.quantised else noisy

    def without_depth(self, cosine: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.bool_]:
        """Return True for each point that has no depth.

        Parameters
        ----------
        cosine
            Cosine of the angle between the ray and the surface's normal at each point, shape (n,).
        rng
            Source of the random losses.

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
        start, end = self.grazing
        share = np.maximum(np.clip((angle - start) / (end - start), 0.0, 1.0), self.missing)
        lost: NDArray[np.bool_] = rng.random(len(cosine)) < share
        return lost


def _quantised(depth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round depths to those with whole disparities k, 1 / (step * k)."""
    result: NDArray[np.float64] = 1 / (DISPARITY_STEP * np.maximum(np.round(1 / (DISPARITY_STEP * depth)), 1))
    return result


@dataclass(frozen=True, eq=False)
class Look:
    """Image of meshes, row by row; ``points`` are in the camera's frame, NaN without a depth.

    ``mesh`` is the number of the mesh seen (-1 for no mesh or no measurement), and ``shade`` the share of light that
    its surface reflects to the camera, from 0 to 1.
    """

    points: NDArray[np.float32]  # (n, 3)
    mesh: NDArray[np.int32]  # (n,)
    shade: NDArray[np.float64]  # (n,)


def look(caster: RayCaster, camera: Camera, sensor: DepthSensor, rng: np.random.Generator) -> Look:
    """Return an image of meshes.

    Parameters
    ----------
    caster
        Ray caster for the meshes in the table's frame.
    camera
        Camera that looks at them.
    sensor
        Errors of the depths.
    rng
        Source of these errors.

    Returns
    -------
    Look
        Points in the camera's frame, with the mesh and the shade of each pixel.
    """
    turned = camera.directions() @ camera.pose[:3, :3].T
    return measured_look(caster.cast(camera.eye, turned), turned, camera.lens, sensor, rng)


def measured_look(
    hits: Hits, rays: NDArray[np.float64], lens: Intrinsics, sensor: DepthSensor, rng: np.random.Generator
) -> Look:
    """Return the image that a sensor measures, from the first hits of the rays of all pixels.

    Parameters
    ----------
    hits
        First hits of r rays, one for each pixel, row by row.
    rays
        Directions of the rays in the table's frame, shape (r, 3), of length 1 along the optical axis.
    lens
        Intrinsics of the camera.
    sensor
        Errors of the depths.
    rng
        Source of these errors.

    Returns
    -------
    Look
        Points in the camera's frame, with the mesh and the shade of each pixel.
    """
    seen = np.flatnonzero(hits.mesh >= 0)
    length = np.linalg.norm(rays[seen], axis=1)
    cosine = -np.einsum("ij,ij->i", rays[seen], hits.normals[seen]) / length
    depth = sensor.measured(hits.distance[seen].astype(np.float64), rng)
    kept = ~sensor.without_depth(cosine, rng) & (depth > 0)
    image = np.full(len(rays), np.nan)
    image[seen[kept]] = depth[kept]
    points = back_projected(image.reshape(lens.height, lens.width), lens)
    mesh = np.full(len(rays), NOTHING, dtype=np.int32)
    mesh[seen[kept]] = hits.mesh[seen[kept]]
    shade = np.zeros(len(rays))
    # Lambert's law, for a lamp and for light from all around; normals are turned towards the camera
    lit = np.clip((hits.normals[seen[kept]] @ LIGHT) * np.sign(cosine[kept]), 0.0, 1.0)
    shade[seen[kept]] = 0.45 + 0.55 * lit
    return Look(points, mesh, shade)


LIGHT = np.array([-0.36, -0.25, 0.9])
"""Direction of the main light, a vector in the table's frame."""


def see(table: LaidTable, camera: Camera, sensor: DepthSensor | None = None, seed: int = 0) -> PointCloud:
    """Return an organised cloud of the table in the camera's frame, with colours and true labels.

    Parameters
    ----------
    table
        Table with its things.
    camera
        Camera that looks at it.
    sensor
        Errors of depths and colours; those of a Kinect by default.
    seed
        Seed of these errors; equal seeds give equal clouds.

    Returns
    -------
    PointCloud
        Cloud in metres. Labels are -1 without a measurement, 0 for the table, and from 1 for the things in the order of
        the table.
    """
    rng = np.random.default_rng(seed)
    sensor = sensor or DepthSensor()
    found = look(RayCaster([table.top.mesh, *(thing.mesh for thing in table.things)]), camera, sensor, rng)
    return coloured(found, [table.top.colour, *(thing.colour for thing in table.things)], camera.lens, sensor, rng)


def coloured(
    found: Look, palette: Sequence[Colour], lens: Intrinsics, sensor: DepthSensor, rng: np.random.Generator
) -> PointCloud:
    """Return an image of meshes as an organised cloud with colours, whose labels are the numbers of the meshes.

    Parameters
    ----------
    found
        Image of meshes.
    palette
        Colour of each mesh.
    lens
        Intrinsics of the camera.
    sensor
        Errors of the colours.
    rng
        Source of these errors.

    Returns
    -------
    PointCloud
        Cloud in the camera's frame, in metres.
    """
    colours = np.array([*palette, (0, 0, 0)], dtype=np.float64)[found.mesh] * found.shade[:, None]
    colours += rng.normal(0, sensor.colour_noise, found.points.shape)
    colours[found.mesh < 0] = 0.0
    return PointCloud(
        found.points,
        colours=np.clip(colours, 0, 255).astype(np.uint8),
        labels=found.mesh,
        organised=(lens.height, lens.width),
    )


def in_table_frame(cloud: PointCloud, camera: Camera) -> PointCloud:
    """Transform a cloud from the camera's frame to the table's.

    Parameters
    ----------
    cloud
        Cloud in the camera's frame, in metres.
    camera
        Camera that saw it.

    Returns
    -------
    PointCloud
        Cloud in the table's frame, whose origin is the camera's position.
    """
    x, y, z = camera.eye.tolist()
    points = camera.to_table(cloud.points.astype(np.float64)).astype(np.float32)
    normals = None if cloud.normals is None else (cloud.normals @ camera.pose[:3, :3].T).astype(np.float32)
    return PointCloud(points, cloud.colours, cloud.labels, normals, cloud.organised, (x, y, z))
