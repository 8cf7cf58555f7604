"""Build plates, bowls, cups, mugs, jugs, pots, glasses and bottles: solids of revolution, some with a handle along y.

Every builder takes the size (metres) and a generator that varies the shape; the caller scales the result to the exact
size. Glass is opaque to the camera, as if it were frosted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.meshes.size import Size
from deixis.perception.simulator.meshes.solids import joined, revolved, smooth_curve, tube

Profile = list[tuple[float, float]]


def plate(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a plate with a flat well and a rim, which is mostly a flange beyond a step, or else one curve.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter.
    rng
        Source of the random thickness, well and rim.

    Returns
    -------
    Mesh
        Mesh of the plate, which stands on z = 0 and is centred on the z axis.
    """
    radius, height = size.width / 2, size.height
    thickness = min(rng.uniform(0.003, 0.0045), 0.3 * height)
    well = radius * rng.uniform(0.58, 0.70)
    share = np.linspace(0.0, 1.0, 24)
    if rng.random() < 0.75:
        step, at = rng.uniform(0.4, 0.6), rng.uniform(0.22, 0.32)
        smooth_share = (1 - np.cos(np.pi * np.clip(share / at, 0, 1))) / 2
        rise = np.where(share < at, step * smooth_share, step + (1 - step) * (share - at) / (1 - at))
    else:
        rise = share ** rng.uniform(1.6, 2.4)
    across, above = well + (radius - well) * share, thickness + (height - thickness) * rise
    under = [(r, z - thickness) for r, z in zip(across, above, strict=True)]
    over = [(r, z) for r, z in zip(across[::-1], above[::-1], strict=True)]
    return revolved([(0.0, 0.0), *under, *over, (0.0, thickness)])


def bowl(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a bowl on a foot.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter.
    rng
        Source of the random foot, curve and wall.

    Returns
    -------
    Mesh
        Mesh of the bowl, which stands on z = 0 and is centred on the z axis.
    """
    radius, height = size.width / 2, size.height
    foot = radius * rng.uniform(0.38, 0.55)
    share = np.linspace(0.0, 1.0, 28) ** 1.5
    outer = foot + (radius - foot) * share ** rng.uniform(0.4, 0.6)
    return revolved(vessel(outer, height * share, wall=rng.uniform(0.003, 0.005)))


def cup(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a cup that widens upwards, with a handle.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter of the rim; the length includes the handle.
    rng
        Source of the random foot, curve, wall and handle.

    Returns
    -------
    Mesh
        Mesh that stands on z = 0. The z axis is that of the vessel without its handle.
    """
    radius, height = size.width / 2, size.height
    foot = radius * rng.uniform(0.5, 0.65)
    share = np.linspace(0.0, 1.0, 28) ** 1.5
    outer = foot + (radius - foot) * share ** rng.uniform(0.45, 0.7)
    return _with_handle(outer, height * share, rng.uniform(0.0025, 0.0035), size, (0.86, rng.uniform(0.3, 0.42)))


def mug(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a nearly straight mug with a handle.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter of the rim; the length includes the handle.
    rng
        Source of the random taper, wall and handle.

    Returns
    -------
    Mesh
        Mesh that stands on z = 0. The z axis is that of the vessel without its handle.
    """
    radius, height = size.width / 2, size.height
    taper = rng.uniform(0.86, 1.0)
    share = np.concatenate([[0.0, 0.02, 0.05], np.linspace(0.1, 1.0, 10)])
    outer = radius * (taper + (1 - taper) * share) * np.minimum(1.0, 0.93 + 1.4 * share)
    return _with_handle(outer, height * share, rng.uniform(0.0035, 0.005), size, (0.84, rng.uniform(0.16, 0.26)))


def vessel(outer: NDArray[np.float64], z: NDArray[np.float64], wall: float, floor: float | None = None) -> Profile:
    """Return the profile of an open vessel.

    Parameters
    ----------
    outer
        Outer radius at each of n heights, shape (n,), in metres.
    z
        Heights from the table (z[0] = 0) to the rim, shape (n,), in metres, ascending.
    wall
        Thickness of the wall in metres.
    floor
        Height of the inner floor in metres; by default 1.5 times the wall, and at least 4 mm.

    Returns
    -------
    Profile
        Pairs of radius and height, for :func:`revolved`.
    """
    floor = max(1.5 * wall, 0.004) if floor is None else floor
    inside = z > floor
    inner = [(r - wall, h) for r, h in zip(outer[inside][::-1], z[inside][::-1], strict=True)]
    base = float(np.interp(floor, z, outer)) - wall
    outside = [(float(r), float(h)) for r, h in zip(outer, z, strict=True)]
    return [(0.0, float(z[0])), *outside, *inner, (base, floor), (0.0, floor)]


def _with_handle(
    outer: NDArray[np.float64], z: NDArray[np.float64], wall: float, size: Size, ends: tuple[float, float]
) -> Mesh:
    """Return a vessel with a handle whose ``ends`` are shares of the height."""
    heights = ends[0] * size.height, ends[1] * size.height
    return joined(
        revolved(vessel(outer, z, wall)), _handle(outer, z, heights, size.length - size.width / 2, 0.5 * wall)
    )


def _handle(
    outer: NDArray[np.float64],
    z: NDArray[np.float64],
    heights: tuple[float, float],
    reach: float,
    sunk: float = 0.0015,
) -> Mesh:
    """Return a handle that is ``sunk`` into a wall at two heights and extends to ``reach`` from the axis, in metres."""
    above, below = heights
    start, end = (float(np.interp(at, z, outer)) - sunk for at in (above, below))
    depth = min(0.009, 0.25 * (above - below))
    turn = np.linspace(0.0, np.pi, 24)
    base = start + (end - start) * (1 - np.cos(turn)) / 2
    bulge = np.sin(turn) ** 0.6
    path = np.stack(
        [
            np.zeros(24),
            base + (reach - depth / 2 - base) * bulge,
            (above + below) / 2 + (above - below) / 2 * np.cos(turn),
        ],
        axis=1,
    )
    return tube(path, width=0.011, depth=depth)


def jug(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a jug with a belly, a lip to pour from and, on the opposite side, a handle.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter; the length includes lip and handle.
    rng
        Source of the random belly, neck, lip, wall and handle.

    Returns
    -------
    Mesh
        Mesh of the jug, which stands on z = 0; the handle points along y.
    """
    radius, height = size.width / 2, size.height
    belly, neck = rng.uniform(0.3, 0.42), rng.uniform(0.66, 0.8)
    share = np.linspace(0.0, 1.0, 36)
    nodes = {0.0: rng.uniform(0.68, 0.8), belly: 1.0, 0.76: neck, 1.0: neck + rng.uniform(0.04, 0.14)}
    outer = radius * smooth_curve(share, nodes)
    body = revolved(vessel(outer, height * share, wall=rng.uniform(0.003, 0.004)))
    points = body.vertices.copy()
    rise = np.clip((points[:, 2] / height - 0.78) / 0.22, 0.0, 1.0)
    front = np.clip(-points[:, 1] / np.maximum(np.hypot(points[:, 0], points[:, 1]), 1e-9), 0.0, 1.0) ** 6
    lip = rng.uniform(0.2, 0.32) * radius
    points[:, 1] -= lip * front * rise**2 * (points[:, 2] > 0.5 * height)
    handle = _handle(outer, height * share, (rng.uniform(0.84, 0.9) * height, 0.3 * height), size.length - radius)
    return joined(Mesh(points, body.faces), handle)


def teapot(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a round pot with a lid and its knob, a handle and, on the opposite side, a spout.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is that of the body; the length includes spout and handle.
    rng
        Source of the random body, lid, spout and handle.

    Returns
    -------
    Mesh
        Mesh of the pot, which stands on z = 0; the handle points along y.
    """
    radius, height = size.width / 2, size.height
    shoulder = rng.uniform(0.74, 0.82) * height
    outer, z = _belly(radius, shoulder, rng)
    beyond = max(size.length - size.width, 0.25 * size.width)
    tip = radius + rng.uniform(0.45, 0.55) * beyond
    reach = np.linspace(0.0, 1.0, 20)
    low, high = 0.3 * shoulder, rng.uniform(0.95, 1.08) * shoulder
    root = float(np.interp(low, z, outer)) - 0.1 * radius
    spout = np.stack([np.zeros(20), -(root + (tip - root) * reach), low + (high - low) * reach**1.6], axis=1)
    thick = (0.34 - 0.2 * reach) * radius
    handle = _handle(outer, z, (0.85 * shoulder, 0.28 * shoulder), size.length - tip)
    return joined(_lidded(outer, z, height), tube(spout, width=thick, depth=thick), handle)


def lidded_bowl(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a round bowl with a lid and its knob, such as a sugar bowl.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random body and lid.

    Returns
    -------
    Mesh
        Mesh of the bowl, which stands on z = 0 and is centred on the z axis.
    """
    outer, z = _belly(size.width / 2, rng.uniform(0.64, 0.74) * size.height, rng)
    return _lidded(outer, z, size.height)


def _belly(radius: float, height: float, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return outer radii and heights of a round body from its foot to its mouth, both of shape (30,), in metres."""
    share = np.linspace(0.0, 1.0, 30)
    nodes = {0.0: rng.uniform(0.55, 0.7), rng.uniform(0.42, 0.55): 1.0, 1.0: rng.uniform(0.5, 0.68)}
    return radius * smooth_curve(share, nodes), height * share


def _lidded(outer: NDArray[np.float64], z: NDArray[np.float64], height: float) -> Mesh:
    """Return a solid body with a domed lid on its mouth, and a knob on the lid that ends at ``height``."""
    mouth, top = float(outer[-1]), float(z[-1])
    knob = 0.3 * (height - top)
    turn = np.linspace(0.0, np.pi / 2, 10)[1:-1]
    neck = 0.14 * mouth
    dome = [(neck + (1.04 * mouth - neck) * np.cos(a), top + (height - top - 2 * knob) * np.sin(a)) for a in turn]
    ball = [(max(neck, 0.24 * mouth * np.sin(a)), height - knob * (1 + np.cos(a))) for a in np.linspace(0.2, 2.9, 10)]
    body = [(float(r), float(h)) for r, h in zip(outer, z, strict=True)]
    return revolved([(0.0, 0.0), *body, (1.04 * mouth, top), *dome, *ball, (0.0, height)])


STEMMED_SLENDERNESS = 1.7
"""Minimum ratio of height to width at which a water glass has a stem."""


def tumbler(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a tumbler that widens upwards.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the diameter of the rim.
    rng
        Source of the random taper and floor.

    Returns
    -------
    Mesh
        Mesh of the tumbler, which stands on z = 0 and is centred on the z axis.
    """
    share = np.linspace(0.0, 1.0, 12)
    outer = size.width / 2 * (1 - rng.uniform(0.05, 0.3) * (1 - share))
    return revolved(vessel(outer, size.height * share, wall=0.002, floor=rng.uniform(0.006, 0.012)))


def water_glass(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a goblet if the glass is slender, or else a tumbler.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random stem and bowl.

    Returns
    -------
    Mesh
        Mesh of the glass, which stands on z = 0 and is centred on the z axis.
    """
    if size.height < STEMMED_SLENDERNESS * size.width:
        return tumbler(size, rng)
    return stemmed(size, rng, stem=rng.uniform(0.3, 0.38), belly=rng.uniform(0.5, 0.75), rim=rng.uniform(0.88, 0.97))


def wine_glass(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a wine glass, whose bowl narrows towards the rim.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random stem and bowl.

    Returns
    -------
    Mesh
        Mesh of the glass, which stands on z = 0 and is centred on the z axis.
    """
    return stemmed(size, rng, stem=rng.uniform(0.42, 0.5), belly=rng.uniform(0.35, 0.5), rim=rng.uniform(0.7, 0.86))


def champagne_glass(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a flute if the glass is slender, or else a saucer on a stem.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random stem and bowl.

    Returns
    -------
    Mesh
        Mesh of the glass, which stands on z = 0 and is centred on the z axis.
    """
    if size.height < 2.0 * size.width:
        return stemmed(size, rng, stem=rng.uniform(0.6, 0.68), belly=0.9, rim=0.99)
    return stemmed(size, rng, stem=rng.uniform(0.3, 0.38), belly=rng.uniform(0.55, 0.7), rim=rng.uniform(0.82, 0.92))


def stemmed(size: Size, rng: np.random.Generator, stem: float, belly: float, rim: float) -> Mesh:
    """Return a glass with a foot, a stem and a bowl.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random foot and thickness of the stem.
    stem
        Height of the top of the stem, as a share of the height.
    belly
        Share of the bowl's height at which it is widest.
    rim
        Diameter of the rim, as a share of the greatest diameter.

    Returns
    -------
    Mesh
        Mesh of the glass, which stands on z = 0 and is centred on the z axis.
    """
    radius, height = size.width / 2, size.height
    foot = radius * min(0.95, rng.uniform(0.8, 0.95) if size.height < 3 * size.width else 0.95)
    thin = rng.uniform(0.0035, 0.005)
    low = stem * height
    share = np.linspace(0.02, 1.0, 24)
    below = np.sqrt(np.clip(1 - (1 - np.minimum(share, belly) / belly) ** 2, 0, 1))
    above = np.clip((share - belly) / max(1 - belly, 1e-9), 0, 1)
    outer = np.maximum(radius * below * (1 - (1 - rim) * above**2), thin)
    z = low + (height - low) * share
    wall = 0.0018
    bowl = vessel(outer, z, wall, floor=low + 0.1 * (height - low))
    base = [(0.0, 0.0), (foot, 0.0), (foot, 0.0025), (0.35 * foot, 0.007), (1.3 * thin, 0.016), (thin, 0.03)]
    return revolved([*base, (thin, low), *bowl[1:]])


def bottle(size: Size, rng: np.random.Generator) -> Mesh:
    """Return a closed bottle.

    Parameters
    ----------
    size
        Width, length and height in metres. The width is the greatest diameter.
    rng
        Source of the random neck, shoulder and throat.

    Returns
    -------
    Mesh
        Mesh of the bottle, which stands on z = 0 and is centred on the z axis.
    """
    radius, height = size.width / 2, size.height
    neck = min(radius * 0.6, rng.uniform(0.013, 0.016))
    shoulder, throat = rng.uniform(0.55, 0.64), rng.uniform(0.70, 0.78)
    turn = np.linspace(0.0, np.pi, 14)
    curve = [
        (neck + (radius - neck) * (1 + np.cos(a)) / 2, height * (shoulder + (throat - shoulder) * a / np.pi))
        for a in turn
    ]
    lip = [(neck, 0.95 * height), (1.12 * neck, 0.955 * height), (1.12 * neck, 0.98 * height), (neck, height)]
    return revolved([(0.0, 0.0), (0.94 * radius, 0.0), (radius, 0.004), *curve, *lip, (0.0, height)])
