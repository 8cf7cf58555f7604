"""Build cloth, and the rounded blocks and cylinders for kinds without a shape of their own."""

from __future__ import annotations

import numpy as np

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.meshes.size import Size
from deixis.perception.simulator.meshes.solids import revolved, ringed, thick_sheet

CLOTH_CELL = 0.004
"""Maximum edge in metres of the cells of cloth, so that it can drape."""


def napkin(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a folded napkin: flat below, slightly uneven above, thinner at its edges.

    Parameters
    ----------
    size
        Width, length and height in metres. The height is that of the folded cloth.
    rng
        Source of the random waves of the upper side.

    Returns
    -------
    Mesh
        Mesh of the cloth, which stands on z = 0 and is centred on the z axis.
    """
    columns, rows = (max(int(np.ceil(side / CLOTH_CELL)), 4) + 1 for side in (size.width, size.length))
    x, y = np.meshgrid(np.linspace(-1, 1, columns), np.linspace(-1, 1, rows))
    waves = rng.uniform(1.0, 3.0, (3, 2)), rng.uniform(0, 2 * np.pi, 3)
    uneven = sum(np.sin(kx * x + ky * y + phase) for (kx, ky), phase in zip(*waves, strict=True)) / 3
    edge = np.minimum((1 - np.abs(x)) * size.width / 2, (1 - np.abs(y)) * size.length / 2)
    rounded = 0.55 + 0.45 * np.sqrt(1 - (1 - np.clip(edge / 0.008, 0, 1)) ** 2)
    top = size.height * rounded * (0.93 + 0.07 * uneven)
    return thick_sheet(x * size.width / 2, y * size.length / 2, np.zeros_like(top), top)


def block(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a block with round corners and a bevelled top.

    Parameters
    ----------
    size
        Width, length and height in metres.
    rng
        Source of the random corners.

    Returns
    -------
    Mesh
        Mesh of the block, which stands on z = 0 and is centred on the z axis.
    """
    corner = rng.uniform(0.15, 0.3) * min(size.width, size.length)
    bevel = min(0.15 * size.height, 0.5 * corner)
    insets = [(0.0, 0.0), (0.0, size.height - bevel), (0.3 * bevel, size.height - 0.3 * bevel), (bevel, size.height)]
    turn = (np.pi / 2 * np.arange(4)[:, None] + np.linspace(0, np.pi / 2, 6)).ravel()
    x = np.repeat([1, -1, -1, 1], 6) * (size.width / 2 - corner)
    y = np.repeat([1, 1, -1, -1], 6) * (size.length / 2 - corner)
    rings = [
        np.stack([x + (corner - inset) * np.cos(turn), y + (corner - inset) * np.sin(turn), np.full(24, z)], axis=1)
        for inset, z in insets
    ]
    return ringed(np.array(rings))


def cylinder(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a cylinder with a bevelled top.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter.
    rng
        Source of the random bevel.

    Returns
    -------
    Mesh
        Mesh of the cylinder, which stands on z = 0 and is centred on the z axis.
    """
    radius = size.width / 2
    bevel = min(0.1 * size.height, rng.uniform(0.1, 0.25) * radius)
    outline = [(radius, 0.0), (radius, size.height - bevel), (radius - bevel, size.height)]
    return revolved([(0.0, 0.0), *outline, (0.0, size.height)])
