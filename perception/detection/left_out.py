"""Write notes about points above a table that are not reported as objects, and about missing depth."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.outline import connected
from deixis.perception.detection.settings import DetectionSettings, NoteSettings
from deixis.perception.detection.table.heights import Raised
from deixis.perception.detection.table.table_top import TableTop
from deixis.perception.detection.table.viewpoint import View


class Fate(IntEnum):
    """Result of the detection for a piece of surface."""

    NOT_RAISED = 0
    REPORTED = 1
    BESIDE = 2
    """The piece is mostly beside the table."""
    DISCARDED = 3
    """The piece is too small or too low for an object."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of surface above a table: ``of`` (n,) is the piece of each point or -1, ``fates`` (p,) their results."""

    of: NDArray[np.int32]
    fates: NDArray[np.int8]

    @property
    def points(self) -> NDArray[np.int64]:
        """Number of points of each piece, shape (p,)."""
        return np.bincount(self.of[self.of >= 0], minlength=len(self.fates))

    @cached_property
    def things(self) -> NDArray[np.int32]:
        """Index of the object of each point, shape (n,); -1 for none."""
        reported = self.fates == Fate.REPORTED
        number = np.append(np.where(reported, np.cumsum(reported) - 1, -1), -1).astype(np.int32)
        result: NDArray[np.int32] = number[self.of]
        return result


@dataclass(frozen=True, eq=False)
class Above:
    """Points of a view (n, 3) in the frame of the table, and which of them are above it.

    ``least`` (n,) is the height in metres that an object has at least at their distances. ``counts`` (n,) are the
    numbers of points of the cloud for which they stand.
    """

    points: NDArray[np.float64]
    raised: Raised
    least: NDArray[np.float64]
    counts: NDArray[np.int64]

    def groups(self, chosen: NDArray[np.intp], settings: DetectionSettings) -> NDArray[np.intp]:
        """Return the connected group of each chosen point, if the group is as large and as high as objects are.

        Parameters
        ----------
        chosen
            Indices of the points that are grouped, shape (k,).
        settings
            Least number of points of an object, its least height, and the side of the cells that connect points.

        Returns
        -------
        ndarray
            Numbers of groups, from 0, of shape (k,); -1 for points of other groups.
        """
        points = self.points.take(chosen, axis=0)
        of = connected(points, settings.notes.group_cell)
        high = np.bincount(of, points[:, 2] > self.least[chosen]) / np.bincount(of)
        enough = np.bincount(of, self.counts[chosen]) >= settings.least_points
        result: NDArray[np.intp] = np.where(
            enough & (high > 1 - settings.heights.object_quantile), np.arange(len(high)), -1
        )[of]
        return result


def left_out(top: TableTop, above: Above, pieces: Pieces, settings: DetectionSettings) -> tuple[str, ...]:
    """Return notes on the points above the table that are not reported as objects.

    Every connected group of as many points as an object has at least, and as high, is counted in a note.

    Parameters
    ----------
    top
        Top of the table.
    above
        Points of the view, and which of them are above the table.
    pieces
        Connected pieces of points above the table.
    settings
        Sizes of objects, and the shares of points that are worth a note.

    Returns
    -------
    tuple of str
        One sentence for each kind of omission.
    """
    missed = np.flatnonzero((above.raised.above | above.raised.too_high) & (pieces.things < 0))
    beside = np.append(pieces.fates == Fate.BESIDE, False)[pieces.of[missed]]
    aside = (top.outside[missed] > settings.top.slack) | beside
    high = ~aside & above.raised.too_high[missed]
    small = ~aside & ~high
    groups, counts = above.groups(missed, settings), above.counts[missed]
    share = np.stack([np.bincount(groups[groups >= 0], which[groups >= 0]) for which in (aside, high, small)])
    kind = np.append(share.argmax(axis=0), -1)[groups]  # of the most points of each group
    group_aside, group_high, group_small = (kind == number for number in range(3))
    notes = []
    if group_high.any():
        notes.append(
            f"{counts[group_high].sum()} points are more than {100 * settings.reach:.0f} cm above the table,"
            " higher than objects are searched: a person, a lamp or a wall"
        )
    if group_aside.any():
        number = len(np.unique(groups[group_aside]))
        some, were = ("a piece", "was") if number == 1 else (f"{number} pieces", "were")
        notes.append(f"{some} beside the table, of {counts[group_aside].sum()} points, {were} left out")
    discarded = int(counts[group_small | (small & (kind < 0))].sum())
    total = discarded + int(above.counts[pieces.things >= 0].sum())
    many = discarded >= settings.least_points and discarded > settings.notes.min_discarded_share * total
    if many or group_small.any():
        notes.append(
            f"{discarded} of the {total} points above the table are in pieces too small or too low for objects"
        )
    if _reaches_over(top.outside, pieces, settings.notes):
        notes.append("something reaches over the edge of the table: a hand, an arm, or an object that hangs over it")
    return tuple(notes)


def _reaches_over(beyond: NDArray[np.float64], pieces: Pieces, settings: NoteSettings) -> bool:
    """Return True if a piece above the table extends far beyond its outline."""
    chosen = np.flatnonzero(pieces.of >= 0)
    of, count = pieces.of[chosen], len(pieces.fates)
    total = np.bincount(of, minlength=count)
    outside = np.bincount(of[beyond[chosen] > settings.overhang], minlength=count)
    inside = np.bincount(of[beyond[chosen] < 0], minlength=count)
    both = (outside > settings.min_overhang_share * total) & (inside > settings.min_overhang_share * total)
    return bool((both & (outside >= settings.min_overhang_points)).any())


def far_note(count: int, radius: float) -> str:
    """Return a note on points that are too far from the others to be measured.

    Parameters
    ----------
    count
        Number of these points.
    radius
        Distance in metres from the middle of the cloud beyond which points are left out.

    Returns
    -------
    str
        One sentence.
    """
    some, were = ("one point", "was") if count == 1 else (f"{count} points", "were")
    return f"{some} more than {radius:.0f} m from the middle of the cloud {were} left out; check their depth"


def missing_lines(view: View) -> tuple[str, ...]:
    """Return a note if many rows or columns of an image have no depth between others that have it.

    Parameters
    ----------
    view
        Points with a depth, and their pixels.

    Returns
    -------
    tuple of str
        One sentence each for rows and columns; empty for a cloud that is not an image.
    """
    if view.organised is None or not len(view.places):
        return ()
    image = np.zeros(view.organised, np.bool_)
    image.reshape(-1)[view.places] = True
    notes = []
    for name, axis in (("rows", 1), ("columns", 0)):
        seen = np.asarray(image.any(axis=axis))
        seen = seen[seen.argmax() : len(seen) - seen[::-1].argmax()]
        if (~seen).sum() > 0.1 * len(seen):
            notes.append(f"{(~seen).sum()} of {len(seen)} {name} of the image have no depth")
    return tuple(notes)


def holes(view: View, on: NDArray[np.bool_], settings: NoteSettings) -> tuple[str, ...]:
    """Return a note if much of the table has no depth.

    Parameters
    ----------
    view
        Points with a depth, and their pixels.
    on
        Mask of the n points on the table or its objects, shape (n,).
    settings
        Side of a cell in pixels, and the shares of empty cells and of empty pixels that are worth a note.

    Returns
    -------
    tuple of str
        At most one sentence; empty for a cloud that is not an image.
    """
    if view.organised is None or not on.any():
        return ()
    from scipy.ndimage import binary_closing, binary_fill_holes

    rows, columns = view.pixels
    shape = tuple(-(-side // settings.hole_cell) for side in view.organised)
    cell = rows // settings.hole_cell * shape[1] + columns // settings.hole_cell
    total = np.bincount(cell, minlength=shape[0] * shape[1]).reshape(shape)
    table = np.bincount(cell[on], minlength=shape[0] * shape[1]).reshape(shape) > 0
    whole = binary_fill_holes(binary_closing(table, np.ones((3, 3)), iterations=3))
    # A cell is a hole if it has far fewer points than usual.
    usual = float(np.median(total[table]))
    empty = whole & (total < 0.2 * usual)
    share = empty.sum() / max(int(whole.sum()), 1)  # an image of a few cells may have no whole one
    unfilled = 1 - usual / settings.hole_cell**2
    if unfilled > settings.max_unfilled_share:
        return (f"{unfilled:.0%} of the pixels on the table have no depth",)
    if share <= settings.max_hole_share:
        return ()
    return (f"{share:.0%} of the visible table has no depth: shiny, dark or transparent objects there are missing",)


def odd_sizes(lengths: NDArray[np.float64], settings: NoteSettings) -> tuple[str, ...]:
    """Return a note if the objects have unusual lengths for tableware.

    Parameters
    ----------
    lengths
        Longest side of each of k objects, shape (k,), in metres.
    settings
        Range of usual lengths.

    Returns
    -------
    tuple of str
        At most one sentence; empty for fewer than two objects.
    """
    if len(lengths) < 2:
        return ()
    usual = float(np.median(lengths))
    if settings.min_usual_length <= usual <= settings.max_usual_length:
        return ()
    return (f"half of the objects are {'over' if usual > 0.1 else 'under'} {100 * usual:.0f} cm long; check the unit",)
