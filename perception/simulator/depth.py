"""What a depth camera measures: the true depth, with noise that grows with its square, and with points missing.

The noise is that of a first Kinect: a standard deviation of 1.425e-3 z^2, and steps of depth of 2.85e-3 z^2, z in
metres (K. Khoshelham and S. O. Elberink, Accuracy and Resolution of Kinect Depth Data for Indoor Mapping Applications,
Sensors 12, 2012, equations 10 and 11, with their calibration of 2.85e-5 per centimetre and half a pixel of disparity).
It is drawn for every pixel by itself; a real one's is alike in neighbouring pixels, which this leaves out, as it
leaves out the shadow of the projector and what glass does to infrared light.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.depth import back_projected
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.camera import Camera
from deixis.perception.simulator.laying import LaidTable
from deixis.perception.simulator.rays import RayCaster

NOISE = 1.425e-3
"""Standard deviation of the depth at one metre, in metres; it grows with the square of the depth."""

DISPARITY_STEP = 2.85e-3
"""Metres between two measurable depths at one metre; it grows with the square of the depth."""

NOTHING, TABLE, FIRST_THING = -1, 0, 1
"""Labels of points: nothing measured, the table, and the first thing of the table; the others follow in order."""


@dataclass(frozen=True, slots=True)
class DepthSensor:
    """How a camera measures. All that is wrong with it can be switched off: ``DepthSensor.ideal()``.

    ``noise`` multiplies that of a Kinect. Of all points the share ``missing`` has no depth, and of those that are seen
    at a grazing angle more: from none at ``grazing[0]`` to all at ``grazing[1]``, radians between the ray and the
    surface's normal. ``quantised`` rounds depths as a Kinect does. ``colour_noise`` is a standard deviation, of 255.
    """

    noise: float = 1.0
    missing: float = 0.005
    grazing: tuple[float, float] = (np.deg2rad(72.0), np.deg2rad(88.0))
    quantised: bool = False
    colour_noise: float = 2.5

    def __post_init__(self) -> None:
        if not (0 <= self.noise < 1000 and 0 <= self.missing <= 1 and 0 <= self.colour_noise < 256):
            raise SimulationError(
                f"noise is 0 or more, not {self.noise:g}, and the share of missing points 0 to 1, not {self.missing:g}"
            )
        if not 0 <= self.grazing[0] < self.grazing[1]:
            raise SimulationError("points begin to be missing at a smaller grazing angle than that where all are")

    @classmethod
    def ideal(cls) -> DepthSensor:
        """Return no noise, nothing missing."""
        return cls(noise=0.0, missing=0.0, grazing=(np.pi, 2 * np.pi), colour_noise=0.0)

    def measured(self, depth: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
        """Return depths (n,) in metres as they are measured."""
        noisy = depth + rng.standard_normal(len(depth)) * self.noise * NOISE * depth**2
        return _quantised(noisy) if self.quantised else noisy

    def lost(self, cosine: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.bool_]:
        """Return which points (n,) have no depth, by the cosine of the angle between the ray and the surface's
        normal."""
        angle = np.arccos(np.clip(np.abs(cosine), 0.0, 1.0))
        start, end = self.grazing
        share = np.maximum(np.clip((angle - start) / (end - start), 0.0, 1.0), self.missing)
        lost: NDArray[np.bool_] = rng.random(len(cosine)) < share
        return lost


def _quantised(depth: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return depths of which the disparity is whole: 1 / (step * k)."""
    result: NDArray[np.float64] = 1 / (DISPARITY_STEP * np.maximum(np.round(1 / (DISPARITY_STEP * depth)), 1))
    return result


@dataclass(frozen=True, eq=False)
class Look:
    """What the pixels of one look show, row by row; ``points`` are in the camera's frame, NaN where there is no depth.

    ``mesh`` is the number of the mesh seen (-1 for none, or where nothing was measured), ``shade`` how much of the
    light its surface sends to the camera, between 0 and 1.
    """

    points: NDArray[np.float32]  # (n, 3)
    mesh: NDArray[np.int32]  # (n,)
    shade: NDArray[np.float64]  # (n,)


def look(caster: RayCaster, camera: Camera, sensor: DepthSensor, rng: np.random.Generator) -> Look:
    """Return one look at meshes in the table's frame."""
    rays = camera.directions()
    turned = rays @ camera.pose[:3, :3].T
    hits = caster.cast(camera.eye, turned)
    seen = np.flatnonzero(hits.mesh >= 0)
    length = np.linalg.norm(turned[seen], axis=1)
    cosine = -np.einsum("ij,ij->i", turned[seen], hits.normals[seen]) / length
    depth = sensor.measured(hits.distance[seen].astype(np.float64), rng)
    kept = ~sensor.lost(cosine, rng) & (depth > 0)
    image = np.full(len(rays), np.nan)
    image[seen[kept]] = depth[kept]
    points = back_projected(image.reshape(camera.lens.height, camera.lens.width), camera.lens)
    mesh = np.full(len(rays), NOTHING, dtype=np.int32)
    mesh[seen[kept]] = hits.mesh[seen[kept]]
    shade = np.zeros(len(rays))
    # Lambert's law, for a lamp and for light from all around; normals are turned towards the camera
    lit = np.clip((hits.normals[seen[kept]] @ LIGHT) * np.sign(cosine[kept]), 0.0, 1.0)
    shade[seen[kept]] = 0.45 + 0.55 * lit
    return Look(points, mesh, shade)


LIGHT = np.array([-0.36, -0.25, 0.9])
"""Where most light comes from, a unit vector in the table's frame."""


def see(table: LaidTable, camera: Camera, sensor: DepthSensor | None = None, seed: int = 0) -> PointCloud:
    """Return the table as an organised cloud in the camera's frame, the camera at its origin, with colours and the
    truth.

    Labels are -1 where nothing was measured, 0 for the table, and 1 and up for the things in the order of the table.
    The same seed gives the same cloud.
    """
    rng = np.random.default_rng(seed)
    sensor = sensor or DepthSensor()
    found = look(RayCaster([table.top.mesh, *(thing.mesh for thing in table.things)]), camera, sensor, rng)
    palette = np.array([table.top.colour, *(thing.colour for thing in table.things), (0, 0, 0)], dtype=np.float64)
    colours = palette[found.mesh] * found.shade[:, None] + rng.normal(0, sensor.colour_noise, found.points.shape)
    colours[found.mesh < 0] = 0.0
    return PointCloud(
        found.points,
        colours=np.clip(colours, 0, 255).astype(np.uint8),
        labels=found.mesh,
        organised=(camera.lens.height, camera.lens.width),
    )


def in_table_frame(cloud: PointCloud, camera: Camera) -> PointCloud:
    """Return a cloud of the camera's frame in the table's, with the camera as its origin."""
    x, y, z = camera.eye.tolist()
    points = camera.to_table(cloud.points.astype(np.float64)).astype(np.float32)
    normals = None if cloud.normals is None else (cloud.normals @ camera.pose[:3, :3].T).astype(np.float32)
    return PointCloud(points, cloud.colours, cloud.labels, normals, cloud.organised, (x, y, z))
