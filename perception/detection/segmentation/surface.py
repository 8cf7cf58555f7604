"""Surface around each point: a plane through its neighbourhood, and the colour."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.quantiles import median
from deixis.perception.detection.settings import SurfaceSettings
from deixis.reasoning.geometry.coordinates import norms
from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb


@dataclass(frozen=True, eq=False)
class Surface:
    """Points with normals, colours and noise; all lengths in metres, in the frame of the table."""

    points: NDArray[np.float64]  # (n, 3)
    smooth: NDArray[np.float64]  # (n, 3): moved onto the planes
    normals: NDArray[np.float64]  # (n, 3): unit vectors towards the sensor
    colours: NDArray[np.float64]  # (n, 3): CIE L*a*b*, averaged over neighbours; 0 without colours
    neighbours: NDArray[np.int32]  # (n, k)
    sigma: NDArray[np.float64]  # (n,): the standard deviation of a measured depth
    jump: NDArray[np.float64]  # (n,): neighbours farther away are on another surface
    spacing: NDArray[np.float64]  # (n,): the usual distance between neighbours at this distance from the sensor

    @property
    def areas(self) -> NDArray[np.float64]:
        """Area of the surface for each point, in square metres, shape (n,)."""
        return self.spacing**2

    def __len__(self) -> int:
        return len(self.points)


def surface_of(
    points: NDArray[np.float64],
    colours: NDArray[np.uint8] | None,
    neighbours: NDArray[np.int32],
    sigma: NDArray[np.float64],
    eye: NDArray[np.float64],
    settings: SurfaceSettings,
    pixels: tuple[NDArray[np.integer], NDArray[np.integer]] | None = None,
) -> Surface:
    """Return the surface through points, with its normals, noise and depth jumps.

    Parameters
    ----------
    points
        Points of shape (n, 3), in metres.
    colours
        Colours of shape (n, 3), from 0 to 255; None if there are none.
    neighbours
        Indices of the neighbours of each point, shape (n, 8); -1 for missing ones.
    sigma
        Standard deviation of the noise at each point, shape (n,), in metres.
    eye
        Viewpoint, shape (3,).
    settings
        Radii of neighbourhoods, and the distances that are depth jumps.
    pixels
        Row and column of each point in an image, shape (n,) each, in the order of the rows; None without an image.

    Returns
    -------
    Surface
        Smoothed points with their normals, spacing and areas, in metres and square metres.
    """
    from deixis.perception.detection.kernels import gaps, mixed, planes, planes_in_image

    distance = norms(points - eye)
    apart = gaps(points, neighbours)
    known = (apart / np.maximum(distance, 1e-6))[apart >= 0]
    # the mean distance of eight neighbours is 1.2 sides of a pixel; it grows with the distance from the sensor
    spacing = distance * (median(known) if len(known) else 0.0) / 1.2
    jump = np.maximum(
        np.maximum(settings.min_jump, settings.jump_noise_ratio * sigma), settings.jump_spacing_ratio * spacing
    )
    noisy = np.clip(settings.radius_noise_ratio * sigma, settings.min_radius, settings.max_radius)
    radius = np.maximum(noisy, settings.radius_spacing_ratio * spacing)
    if pixels is None or not len(points):
        normals, smooth = planes(points, neighbours, radius, jump, eye, settings.max_plane_points)
    else:
        reach = settings.max_pixels_per_spacing * radius / np.maximum(spacing, 1e-9)
        normals, smooth = planes_in_image(points, *pixels, radius, reach, eye, _nearest(settings.max_plane_points))
    lab = np.zeros((len(points), 3))
    if colours is not None:
        lab = mixed(lab_of_srgb(colours), neighbours)
    return Surface(points, smooth, normals, lab, neighbours, sigma, jump, spacing)


def _nearest(count: int) -> NDArray[np.int64]:
    """Return the steps from a pixel to the nearest ``count`` pixels, rows and columns, shape (count, 2)."""
    side = np.arange(-int(count**0.5), int(count**0.5) + 1)
    steps = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    return steps[np.argsort((steps**2).sum(axis=1), kind="stable")[:count]]
