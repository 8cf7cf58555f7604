"""Write notes about points above a table that are not reported as objects, and about missing depth."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.settings import DetectionSettings, NoteSettings
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

    @property
    def things(self) -> NDArray[np.int32]:
        """Index of the object of each point, shape (n,); -1 for none."""
        reported = self.fates == Fate.REPORTED
        number = np.append(np.where(reported, np.cumsum(reported) - 1, -1), -1).astype(np.int32)
        result: NDArray[np.int32] = number[self.of]
        return result


def left_out(
    top: TableTop, heights: NDArray[np.float64], pieces: Pieces, settings: DetectionSettings
) -> tuple[str, ...]:
    """Return notes on the points above the table that are not reported as objects.

    Parameters
    ----------
    top
        Top of the table.
    heights
        Heights of the n points of the view above the plane, shape (n,), in metres.
    pieces
        Connected pieces of points above the table.
    settings
        Sizes of objects, and the shares of points that are worth a note.

    Returns
    -------
    tuple of str
        One sentence for each kind of omission.
    """
    limits = settings.notes
    beyond = top.outside
    high = (heights > settings.reach) & (beyond < 0)
    notes = []
    if high.sum() > limits.min_high_share * max(len(top.on), 1):
        notes.append(
            f"something is more than {100 * settings.reach:.0f} cm above the table, higher than objects are searched:"
            " a person, a lamp or a wall"
        )
    counts = pieces.points
    beside = (pieces.fates == Fate.BESIDE) & (counts >= limits.min_piece_points)
    if beside.any():
        some = "a piece" if beside.sum() == 1 else f"{beside.sum()} pieces"
        notes.append(f"{some} beside the table, of {counts[beside].sum()} points, {_was(beside)} left out")
    discarded = counts[pieces.fates == Fate.DISCARDED].sum()
    if discarded > limits.min_discarded_share * counts.sum() and discarded >= limits.min_piece_points:
        notes.append(
            f"{discarded} of the {counts.sum()} points above the table are in pieces too small or too low for objects"
        )
    if _reaches_over(beyond, pieces, limits):
        notes.append("something reaches over the edge of the table: a hand, an arm, or an object that hangs over it")
    return tuple(notes)


def _was(which: NDArray[np.bool_]) -> str:
    return "was" if which.sum() == 1 else "were"


def _reaches_over(beyond: NDArray[np.float64], pieces: Pieces, settings: NoteSettings) -> bool:
    """Return True if a piece above the table extends far beyond its outline."""
    chosen = np.flatnonzero(pieces.of >= 0)
    of, count = pieces.of[chosen], len(pieces.fates)
    total = np.bincount(of, minlength=count)
    outside = np.bincount(of[beyond[chosen] > settings.overhang], minlength=count)
    inside = np.bincount(of[beyond[chosen] < 0], minlength=count)
    both = (outside > settings.min_overhang_share * total) & (inside > settings.min_overhang_share * total)
    return bool((both & (outside >= settings.min_piece_points)).any())


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
    notes = []
    for name, lines in zip(("rows", "columns"), view.pixels, strict=True):
        seen = np.bincount(lines) > 0
        seen = seen[seen.argmax() :]
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
        Side of a cell in pixels, and the share of empty cells that is worth a note.

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
