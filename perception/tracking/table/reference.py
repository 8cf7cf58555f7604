"""The table as it was last seen at rest: depth, colour and owner of every pixel, and since when it is at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.table.colours import TableColours

TABLE, UNKNOWN_OWNER = 0, -1
"""Owners of pixels: the table and all beyond it, and nothing that is known. Things have their slots, from 1."""

GAP = 0.025
"""Difference of depths in metres at which neighbouring pixels belong to different surfaces."""

LEARNING_RATE = 0.1
"""Share of a new measurement in the reference of an unchanged pixel."""


@dataclass(frozen=True, eq=False)
class Beneath:
    """Content of the reference at pixels before a thing covered them: flat indices (k,), depths, colours and labels."""

    pixels: NDArray[np.intp]
    depth: NDArray[np.float32]
    colour: NDArray[np.float32]
    label: NDArray[np.int16]


@dataclass(frozen=True, eq=False)
class Changes:
    """Comparison of a frame with the reference.

    ``state`` (r, c) is that of each pixel, ``counts`` (labels, states) how many pixels of each owner are in each state.
    """

    state: NDArray[np.uint8]
    counts: NDArray[np.int64]

    @property
    def same(self) -> NDArray[np.bool_]:
        """Mask (r, c) of the pixels that are as in the reference."""
        from deixis.perception.tracking.kernels import SAME

        return np.asarray(self.state == SAME)


class Reference:
    """Depth (r, c), colour (r, c, 3) and owner (r, c) of every pixel of a table at rest.

    Parameters
    ----------
    image
        First frame.
    owner
        Owner of each pixel, shape (r, c).
    at
        Time of the frame in seconds.
    """

    def __init__(self, image: FrameImage, owner: NDArray[np.int16], at: float) -> None:
        self.depth = np.where(owner == UNKNOWN_OWNER, 0, image.depth).astype(np.float32)
        self.colour = image.colour.copy()
        self.owner = owner
        self.since = np.full(owner.shape, at)
        """Time in seconds since which each depth is steady."""
        self.retry_at = np.full(owner.shape, -np.inf)
        """Time in seconds from which each pixel is a reason to segment what changed."""
        self.tries = np.zeros(owner.shape, np.uint8)
        """Number of times that each pixel was segmented and showed no thing, since its depth was last given."""
        self._offset = np.zeros((*owner.shape, 2), np.float32)
        self._last = image.depth.copy()
        self._aside = np.zeros((*owner.shape, 2), np.float32)

    def carry(self, before: TableView, now: TableView, gap: float) -> None:
        """Carry all points to the view of a camera that has moved.

        A point keeps its place in the table's frame: it lies beside the middle of its new pixel. Points that are no
        longer in view, or are behind others, are forgotten.

        Parameters
        ----------
        before, now
            Views before and after the movement.
        gap
            Difference of depths of two surfaces, in metres.
        """
        from deixis.perception.tracking.kernels import carried

        turn = now.matrix @ np.linalg.inv(before.matrix)
        shift = now.offset - turn @ before.offset
        source, self.depth, self._offset = carried(self.depth, self._offset, self.owner, turn, shift, gap)
        known = source >= 0
        self.colour = np.where(known[..., None], self.colour.reshape(-1, 3)[source], np.float32(0))
        self.owner = np.where(known, self.owner.ravel()[source], np.int16(UNKNOWN_OWNER))
        flat = (self.owner == TABLE) & (np.abs(self.depth - now.level) < 0.5 * gap)
        self.depth[flat] = now.level[flat]
        self._offset[flat] = 0
        source, self._last, self._aside = carried(self._last, self._aside, np.zeros_like(self.owner), turn, shift, gap)
        self.since = np.where(source >= 0, self.since.ravel()[source], np.inf)
        self.retry_at = np.where(source >= 0, self.retry_at.ravel()[source], -np.inf)
        self.tries = np.where(source >= 0, self.tries.ravel()[source], np.uint8(0))

    def compared(
        self,
        image: FrameImage,
        level: NDArray[np.float32],
        labels: int,
        tolerance: float,
        noise: float,
        colour: float,
        reach: int,
        table: TableColours,
    ) -> Changes:
        """Compare a frame with the reference.

        Parameters
        ----------
        image
            The frame.
        level
            Depth of the plane of the table at each pixel, shape (r, c).
        labels
            Largest owner.
        tolerance, noise
            Least difference of two depths: the first, or the second times the squared depth, whichever is larger.
        colour
            Least difference of two colours.
        reach
            Distance in pixels within which an equal depth of the reference is looked for.
        table
            Colours that a pixel without a reference must have to be the table's.

        Returns
        -------
        Changes
            State of each pixel, and the counts by owner.
        """
        from deixis.perception.tracking.kernels import compared

        state, counts = compared(
            image.depth, image.colour, self.depth, self.colour, self.owner, level, labels, tolerance, noise, colour,
            reach, table.bins,
        )  # fmt: skip
        return Changes(state, counts)

    def remember(
        self, image: FrameImage, changes: Changes, at: float, tolerance: float, noise: float, colour: float
    ) -> None:
        """Move the reference of unchanged pixels towards a frame, and note which depths are not steady.

        Parameters
        ----------
        image, changes
            The frame, and its comparison with the reference.
        at
            Its time in seconds.
        tolerance, noise, colour
            As in :meth:`compared`.
        """
        from deixis.perception.tracking.kernels import remembered

        remembered(
            changes.state, image.depth, image.colour, self.depth, self.colour, self._offset, self._last, self._aside,
            self.since, at, tolerance, noise, colour, np.float32(LEARNING_RATE),
        )  # fmt: skip

    def points(self, pixels: NDArray[np.intp], view: TableView) -> NDArray[np.float64]:
        """Return the points that pixels show.

        Parameters
        ----------
        pixels
            Flat indices of shape (k,).
        view
            View of the table in which the reference is.

        Returns
        -------
        ndarray
            Points of shape (k, 3) in the table's frame, in metres.
        """
        row, column = np.divmod(pixels, self.owner.shape[1])
        middles = np.stack([column, row], axis=1) + self._offset.reshape(-1, 2)[pixels]
        rays = np.column_stack([middles, np.ones(len(pixels))]) * self.depth.ravel()[pixels, None]
        places: NDArray[np.float64] = (rays - view.offset) @ np.linalg.inv(view.matrix).T
        return places

    def give(self, pixels: NDArray[np.intp], owner: int, image: FrameImage) -> Beneath:
        """Assign pixels to an owner, with the measurements of a frame, and return what was there before.

        Parameters
        ----------
        pixels
            Flat indices of shape (k,).
        owner
            New owner.
        image
            The frame.

        Returns
        -------
        Beneath
            What the reference had at these pixels.
        """
        before = Beneath(
            pixels,
            self.depth.ravel()[pixels],
            self.colour.reshape(-1, 3)[pixels],
            self.owner.ravel()[pixels],
        )
        self.depth.ravel()[pixels] = image.depth.ravel()[pixels]
        self.colour.reshape(-1, 3)[pixels] = image.colour.reshape(-1, 3)[pixels]
        self.owner.ravel()[pixels] = owner
        self._offset.reshape(-1, 2)[pixels] = 0
        self.tries.ravel()[pixels] = 0
        return before

    def assign(self, pixels: NDArray[np.intp], owner: int, image: FrameImage, tolerance: float, noise: float) -> None:
        """Give pixels to an owner that a frame shows, and keep the means of many frames where it agrees with them.

        Parameters
        ----------
        pixels
            Flat indices of shape (k,).
        owner
            New owner.
        image
            The frame.
        tolerance, noise
            As in :meth:`compared`.
        """
        depth, known = image.depth.ravel()[pixels], self.depth.ravel()[pixels]
        differs = np.abs(depth - known) > np.maximum(tolerance, noise * depth**2)
        self.give(pixels[differs & (depth > 0)], owner, image)
        self.owner.ravel()[pixels] = owner

    def take(self, owner: int, beneath: Beneath | None, owners: set[int]) -> None:
        """Take all pixels from an owner: what was beneath comes back, the rest is unknown.

        Parameters
        ----------
        owner
            Owner whose pixels are taken.
        beneath
            What was there before it came, or None.
        owners
            Owners that are still there.
        """
        own = self.owner.ravel() == owner
        self.depth.ravel()[own] = 0
        self.owner.ravel()[own] = UNKNOWN_OWNER
        if beneath is None:
            return
        back = own[beneath.pixels] & np.isin(beneath.label, [TABLE, *owners])
        self.depth.ravel()[beneath.pixels[back]] = beneath.depth[back]
        self.colour.reshape(-1, 3)[beneath.pixels[back]] = beneath.colour[back]
        self.owner.ravel()[beneath.pixels[back]] = beneath.label[back]
