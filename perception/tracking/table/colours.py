"""Know the colours of a table, which a flat thing on it does not have."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

BINS = 16
"""Number of bins of each of red, green and blue."""

MIN_SHARE = 0.01
"""Minimum share of the pixels of a table in a bin that is a colour of the table."""

SHADES = (1.0, 0.85, 0.7, 0.55)
"""Factors on the colours of a table in the shadows of other things."""


class TableColours:
    """Colours of a table, in its light and in shadows.

    Examples
    --------
    >>> colours = TableColours()
    >>> colours.extend(np.full((100, 3), (140.0, 105.0, 75.0), np.float32))
    >>> colours.include(np.array([[140, 105, 75], [100, 75, 53], [190, 190, 195]], np.float32)).tolist()
    [True, True, False]
    """

    def __init__(self) -> None:
        self.bins = np.zeros((BINS,) * 3, np.bool_)
        """True for each bin of red, green and blue that has a colour of the table, or that is next to one."""

    def extend(self, colours: NDArray[np.float32]) -> None:
        """Add the colours of pixels that show the table.

        Parameters
        ----------
        colours
            Colours of shape (n, 3), from 0 to 255.
        """
        from scipy.ndimage import binary_dilation

        if not len(colours):
            return
        count = np.zeros(self.bins.shape, np.int64)
        np.add.at(count, tuple(_bins(colours).T), 1)
        usual = np.argwhere(count >= MIN_SHARE * len(colours))
        middles = (usual + 0.5) * 256 / BINS
        found = np.zeros(self.bins.shape, np.bool_)
        for shade in SHADES:
            found[tuple(_bins(shade * middles).T)] = True
        self.bins |= binary_dilation(found, np.ones((3, 3, 3)))

    def include(self, colours: NDArray[np.float32]) -> NDArray[np.bool_]:
        """Return True for each colour that the table may have.

        Parameters
        ----------
        colours
            Colours of shape (n, 3), from 0 to 255.

        Returns
        -------
        ndarray
            Mask of shape (n,).
        """
        return np.asarray(self.bins[tuple(_bins(colours).T)])


def _bins(colours: NDArray[np.floating]) -> NDArray[np.int64]:
    found: NDArray[np.int64] = np.clip(colours * (BINS / 256), 0, BINS - 1).astype(np.int64)
    return found
