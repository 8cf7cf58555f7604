"""Build forks, knives and spoons: thick sheets along y, a few millimetres high, with the handle towards the viewer.

Their widths, heights and thicknesses are given at stations along their length, from 0 at the handle's end to 1 at the
tip.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.simulator.meshes.size import Size
from deixis.perception.simulator.meshes.solids import smooth_curve, thick_sheet

Array = NDArray[np.float64]
Builder = Callable[[Size, np.random.Generator], Mesh]


@dataclass(frozen=True, eq=False)
class _Bar:
    """A bar of rows along its length: half its width, the height of its centre, and its thickness, all (rows,)."""

    along: Array
    half: Array
    middle: Array
    thickness: Array

    def sheet(
        self,
        across: Array,
        sunk: Array | float = 0.0,
        shifted: Array | float = 0.0,
        cells: NDArray[np.bool_] | None = None,
        flat: bool = False,
    ) -> Mesh:
        """Return the solid, which is thinner at its sides; ``across`` from -1 to 1, (columns,) or (rows, columns).

        ``sunk`` and ``shifted`` move its points down and along x, (rows, columns). Unless it is ``flat`` it is tilted
        so that it rests on its handle and on its head.
        """
        side = np.broadcast_to(across, (len(self.along), np.shape(across)[-1]))
        lens = np.sqrt(1 - 0.7 * side**2) * self.thickness[:, None] / 2
        x = side * self.half[:, None] + shifted
        y = np.broadcast_to(self.along[:, None], side.shape)
        middle = self.middle[:, None] - sunk
        bottom = np.zeros_like(x) if flat else middle - lens
        top = 2 * lens if flat else middle + lens
        if not flat:
            # the line (rows, 1) through the lowest points of the two halves
            lowest = bottom.min(axis=1)
            half = self.along <= self.along[-1] / 2
            a, b = int(np.argmin(np.where(half, lowest, np.inf))), int(np.argmin(np.where(half, np.inf, lowest)))
            slope = (lowest[b] - lowest[a]) / (self.along[b] - self.along[a])
            tilt = (lowest[a] + slope * (self.along - self.along[a]))[:, None]
            bottom, top = bottom - tilt, top - tilt
        return thick_sheet(x, y, bottom, top, cells)


def _stations(rows: int = 90) -> Array:
    """Return places that are denser towards both ends, which are round."""
    even = np.linspace(0.0, 1.0, rows)
    return 0.75 * even + 0.25 * (1 - np.cos(np.pi * even)) / 2


def _round_end(stations: Array, size: Size, half: float) -> Array:
    """Return the factor on the width near the handle's end, which is about a half circle."""
    share = np.clip(stations * size.length / half, 0.03, 1.0)
    left: Array = np.sqrt(1 - (1 - share) ** 2)
    return left


def spoon(roundness: float = 0.0) -> Builder:
    """Return a builder of spoons.

    Parameters
    ----------
    roundness
        Shape of the bowl: 1 makes it as long as wide, 0 the usual egg.

    Returns
    -------
    Builder
        Function that makes a mesh from a size in metres and a random generator.
    """

    def build(size: Size, rng: np.random.Generator) -> Mesh:
        wide, deep = size.width / 2, size.width * rng.uniform(0.14, 0.2)
        egg = rng.uniform(0.3, 0.34)
        bowl = max(egg + (size.width / size.length - egg) * roundness, 0.2)
        neck, grip = rng.uniform(0.1, 0.14) * size.width, rng.uniform(0.2, 0.28) * size.width
        t = _stations()
        v = (t - (1 - bowl / 2)) / (bowl / 2)
        oval = wide * np.sqrt(np.clip(1 - v**2, 0.0, 1.0)) * (1 - 0.1 * v * (1 - roundness))
        handle = smooth_curve(t, {0.0: grip, 0.15: 0.9 * grip, 0.9 - bowl: neck, 1.0: neck})
        half = np.where(v > 0, oval, np.maximum(oval, handle)) * _round_end(t, size, grip)
        rise = size.height * rng.uniform(0.8, 1.0)
        curve = {0.0: 0.0, 0.3: 0.5 * rise, 0.84 - bowl: rise, 1 - bowl: 1.2 * deep, 1 - bowl / 2: deep, 1.0: deep}
        middle = smooth_curve(t, curve)
        thickness = smooth_curve(t, {0.0: 0.0025, 1 - bowl: 0.003, 1 - 0.7 * bowl: 0.0016, 1.0: 0.0012})
        across = np.linspace(-1, 1, 13)
        sunk = deep * np.clip(1 - v**2, 0, 1)[:, None] * (1 - across**2)[None] * (v > -1)[:, None]
        return _Bar(t * size.length, np.maximum(half, 0.0004), middle, thickness).sheet(across, sunk)

    return build


def fork(tines: int = 4) -> Builder:
    """Return a builder of forks.

    Parameters
    ----------
    tines
        Number of tines.

    Returns
    -------
    Builder
        Function that makes a mesh from a size in metres and a random generator.
    """

    def build(size: Size, rng: np.random.Generator) -> Mesh:
        wide, root = size.width / 2, rng.uniform(0.72, 0.77)
        grip, neck = rng.uniform(0.32, 0.44) * size.width, rng.uniform(0.11, 0.15) * size.width
        t = _stations()
        start = root - 0.1
        outline = {0.0: grip, 0.15: 0.9 * grip, start - 0.1: neck, start - 0.03: 1.2 * neck, start + 0.04: 0.85 * wide}
        half = smooth_curve(t, {**outline, root: wide, 1.0: rng.uniform(0.92, 1.0) * wide}) * _round_end(t, size, grip)
        rise, tip = 0.9 * size.height, rng.uniform(0.45, 0.8) * size.height
        middle = smooth_curve(t, {0.0: 0.0, 0.3: 0.4 * rise, start - 0.04: rise, root + 0.08: 0.1 * rise, 1.0: tip})
        thickness = smooth_curve(t, {0.0: 0.0025, start: 0.003, root: 0.002, 1.0: 0.0015})
        ratio = rng.uniform(1.1, 1.5)
        gap = 2 / (tines * ratio + tines - 1)
        centres = -1 + ratio * gap / 2 + np.arange(tines) * gap * (1 + ratio)
        pointed = np.clip((1 - t) / 0.06, 0.3, 1.0)[:, None, None]
        offsets = np.array([-0.5, 0.0, 0.5]) * ratio * gap
        span = (centres[None, :, None] + pointed * offsets).reshape(len(t), -1)
        squares = np.ones((len(t) - 1, 3 * tines - 1), dtype=np.bool_)
        squares[t[:-1] >= root, 2::3] = False
        return _Bar(t * size.length, half, middle, thickness).sheet(span, cells=squares)

    return build


def knife(blade: float = 0.55, grip: float = 0.75, pointed: bool = False) -> Builder:
    """Return a builder of knives, which lie on their side, the edge to the left.

    Parameters
    ----------
    blade
        Length of the blade, as a share of the knife's length.
    grip
        Width of the handle, as a share of the width of the blade.
    pointed
        If True, the tip is a point instead of round.

    Returns
    -------
    Builder
        Function that makes a mesh from a size in metres and a random generator.
    """

    def build(size: Size, rng: np.random.Generator) -> Mesh:
        t = _stations()
        wide, hold = size.width / 2, size.width / 2 * grip * rng.uniform(0.9, 1.0)
        heel = 1 - blade * rng.uniform(0.95, 1.05)
        outline = {0.0: hold, heel / 2: 0.8 * hold, heel - 0.02: 0.65 * hold, heel + 0.04: wide, 0.88: 0.95 * wide}
        reach = np.clip((1 - t) / (0.22 if pointed else 0.1), 0.0, 1.0)
        end = reach**0.8 if pointed else np.sqrt(1 - (1 - reach) ** 2)
        whole = smooth_curve(t, {**outline, 1.0: 0.9 * wide}) * _round_end(t, size, hold)
        half = np.maximum(whole * end, 0.0004)
        thick, thin = size.height, min(rng.uniform(0.0016, 0.0024), 0.6 * size.height)
        handle = {0.0: 0.9 * thick, heel / 2: thick, heel - 0.03: 0.8 * thick}
        thickness = smooth_curve(t, {**handle, heel + 0.04: thin, 1.0: 0.7 * thin})
        spine = np.where(t > heel, whole - half, 0.0)[:, None] * (0.0 if pointed else 0.9)
        return _Bar(t * size.length, half, 0 * t, thickness).sheet(np.linspace(-1, 1, 9), shifted=spine, flat=True)

    return build
