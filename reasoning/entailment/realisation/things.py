"""The objects of a picture: their possible and preferred sizes and orientations, in millimetres."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.things.sizes import Outline, SizeRange

UPRIGHT, LYING = (1, 0), (0, 1)
"""Sides along x and along y in both orientations, as 0 for length and 1 for width."""


@dataclass(frozen=True, eq=False)
class Things:
    """Sizes of n objects in millimetres; column 0: length, column 1: width."""

    least: NDArray[np.int64]  # (n, 2)
    wanted: NDArray[np.int64]  # (n, 2)
    greatest: NDArray[np.int64]  # (n, 2)
    round: NDArray[np.bool_]  # (n,): circles, as long as wide
    lying: NDArray[np.bool_]  # (n,): preferably lies along x

    def __len__(self) -> int:
        return len(self.least)

    def ways(self, thing: int) -> tuple[tuple[int, int], ...]:
        """Return the possible orientations, the preferred one first; only one if it makes no difference.

        Parameters
        ----------
        thing
            Number of the object.

        Returns
        -------
        tuple
            Sides on x and y in millimetres, for each orientation.
        """
        if (self.least[thing, 0], self.greatest[thing, 0]) == (self.least[thing, 1], self.greatest[thing, 1]):
            return (UPRIGHT,)
        return (LYING, UPRIGHT) if self.lying[thing] else (UPRIGHT, LYING)


def things_of(ranges: Sequence[SizeRange], lying: Sequence[bool], rng: np.random.Generator | None = None) -> Things:
    """Return objects with sizes in these ranges: typical ones, or with ``rng`` random ones.

    Parameters
    ----------
    ranges
        Usual sizes of the objects.
    lying
        Whether each object preferably lies along x.
    rng
        Generator of sizes; None for typical ones.

    Returns
    -------
    Things
        The objects.
    """
    extents = [(size.length, size.width) for size in ranges]
    metres = np.array([[(e.least, e.typical, e.greatest) for e in pair] for pair in extents]).reshape(-1, 2, 3)
    least, wanted, greatest = np.moveaxis(np.rint(1000 * metres).astype(np.int64), 2, 0)
    turn = np.array([size.outline is Outline.CIRCLE for size in ranges], dtype=np.bool_)
    if rng is not None:
        # from the middle of each range, mostly near the typical size: the ends of wide ranges are unusual sizes
        left, right = (wanted + least) / 2, np.minimum((wanted + greatest) / 2, 1.3 * wanted)
        wanted = np.rint(
            rng.triangular(left, wanted, np.maximum(right, left + 1e-6)) if len(least) else wanted.astype(np.float64)
        ).astype(np.int64)
        wanted[turn, 1] = wanted[turn, 0]
    return Things(np.maximum(least, 1), wanted, greatest, turn, np.array(lying, dtype=np.bool_))
