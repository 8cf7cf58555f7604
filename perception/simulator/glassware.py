"""Glasses and bottles: solids of revolution. To the camera they are opaque, as if frosted."""

from __future__ import annotations

import numpy as np

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.crockery import vessel
from deixis.perception.simulator.size import Size
from deixis.perception.simulator.solids import revolved

SLENDER = 1.7
"""Water glasses that are so many times as high as wide have a stem."""


def tumbler(size: Size, rng: np.random.Generator) -> Mesh:
    share = np.linspace(0.0, 1.0, 12)
    outer = size.width / 2 * (1 - rng.uniform(0.05, 0.3) * (1 - share))
    return revolved(vessel(outer, size.height * share, wall=0.002, floor=rng.uniform(0.006, 0.012)))


def water_glass(size: Size, rng: np.random.Generator) -> Mesh:
    """A goblet where it is slender, else a tumbler."""
    if size.height < SLENDER * size.width:
        return tumbler(size, rng)
    return stemmed(size, rng, stem=rng.uniform(0.3, 0.38), belly=rng.uniform(0.5, 0.75), rim=rng.uniform(0.88, 0.97))


def wine_glass(size: Size, rng: np.random.Generator) -> Mesh:
    return stemmed(size, rng, stem=rng.uniform(0.42, 0.5), belly=rng.uniform(0.35, 0.5), rim=rng.uniform(0.7, 0.86))


def champagne_glass(size: Size, rng: np.random.Generator) -> Mesh:
    """A flute where it is slender, else a saucer on a stem."""
    if size.height < 2.0 * size.width:
        return stemmed(size, rng, stem=rng.uniform(0.6, 0.68), belly=0.9, rim=0.99)
    return stemmed(size, rng, stem=rng.uniform(0.3, 0.38), belly=rng.uniform(0.55, 0.7), rim=rng.uniform(0.82, 0.92))


def stemmed(size: Size, rng: np.random.Generator, stem: float, belly: float, rim: float) -> Mesh:
    """A foot, a stem up to a share of the height, and a bowl.

    ``belly`` is the share of the bowl's height at which it is widest, ``rim`` the share of that width at the rim.
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
    """A closed bottle."""
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
