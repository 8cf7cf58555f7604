"""Find the things that are pieces of other ones, and those whose foot something hides.

A piece is a handle or a stem that the first look took for a thing of its own, or what is seen of a new thing later.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from deixis.perception.tracking.completion.missing_parts import (
    BEYOND,
    FLAT,
    MIN_BEFORE,
    STRIP_MARGIN,
    FlatThing,
    joint_length,
)
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Table
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.pipeline import Pipeline

MIN_LIFTED, SUPPORT = 0.025, 0.03
"""Minimum height in metres of a thing that seems to float, and the depth below it in which its support has its top."""

AXIS, AXIS_STEP = 0.008, 0.005
"""Radius of the hidden stem below a thing, and the distance of the heights at which it is looked for, in metres."""

MIN_HIDDEN = 0.8
"""Minimum share of the places of the stem that something hides, for the thing to stand on it."""

MAX_HANDLE, MIN_HANDLE_LIKENESS, CONTACT = 0.25, 0.8, 0.006
"""Largest number of points of a handle as a share of those of its thing, the least likeness of their colours in any
light, and the largest distance in metres between them."""

LOWEST_SHARE, MIN_FLOATING = 0.05, 0.01
"""Share of the lowest points of a handle, which may be noise, and the least height in metres of all others."""

TOGETHER, TOUCHING, ALIKE = 2.0, 0.012, 0.5
"""Largest time in seconds between the coming of a thing and of a piece of it, their distance in metres, and the least
mean likeness of their colours in any light."""

MOSTLY_WITHIN = 0.9
"""Minimum share of the points of a piece within the box of its thing, at which it need not touch the thing."""


def fits_another(
    piece: Pipeline, thing: Pipeline, others: Iterable[Pipeline], flat: Callable[[Pipeline], FlatThing]
) -> bool:
    """Return True if a piece of a thing completes another thing as well, to a shorter one.

    Of the two ends of a fork whose middle a glass hides, one may lie in the line of a spoon behind the glass.

    Parameters
    ----------
    piece, thing
        A piece, and the thing that it seems to complete.
    others
        Things at rest that it may complete instead.
    flat
        Function that returns a thing with what is around it.

    Returns
    -------
    bool
        True if the piece and one of the others, which is nearer to it, are the ends of one thing.
    """
    length = joint_length(piece, thing)
    for other in others:
        if other is not piece and other is not thing and joint_length(piece, other) < length:
            shorter, longer = sorted((piece, other), key=lambda each: each.oriented.extents[0])
            if flat(longer).pieces([shorter]):
                return True
    return False


def floating_parts(thing: Pipeline, others: Iterable[Pipeline]) -> list[Pipeline]:
    """Return the things that are parts of a high one, such as the handle of a mug that the first look took for a thing.

    Parameters
    ----------
    thing
        Thing at rest.
    others
        Other things at rest.

    Returns
    -------
    list of Pipeline
        Smaller things of its colour that came with it, touch it, and do not reach down to the table.
    """
    if not thing.first_rest or thing.oriented.extents[2] < FLAT:
        return []
    found, top = [], float(thing.placed_corners[:, 2].max())
    for other in others:
        smaller = len(other.cloud) <= MAX_HANDLE * len(thing.cloud) and other.placed_corners[:, 2].max() < top + BEYOND
        if not (other.first_rest and other.at == thing.at and smaller):
            continue
        points = other.placed_points
        floats = np.quantile(points[:, 2], LOWEST_SHARE) > MIN_FLOATING
        if floats and _is_alike(thing, other) and thing.distances(points).min() < CONTACT:
            found.append(other)
    return found


def supporting_parts(thing: Pipeline, others: Iterable[Pipeline]) -> list[Pipeline]:
    """Return the things that are the stem and the foot of one that seems to float, such as the bowl of a wine glass.

    Parameters
    ----------
    thing
        Thing at rest.
    others
        Other things at rest.

    Returns
    -------
    list of Pipeline
        Things of its colour that came with it, below it and about its vertical axis; none if one of them has another
        colour.
    """
    corners = thing.placed_corners
    middle, bottom = corners.mean(axis=0), float(corners[:, 2].min())
    if not thing.first_rest or bottom < MIN_LIFTED:
        return []
    radius = thing.oriented.extents[0] / 2 + STRIP_MARGIN
    found = []
    for other in others:
        aside = float(np.quantile(np.linalg.norm(other.placed_points[:, :2] - middle[:2], axis=1), MOSTLY_WITHIN))
        below = other.placed_corners[:, 2].max() < bottom + BEYOND
        if not (other.first_rest and other.at == thing.at and aside < radius and below):
            continue
        if not _is_alike(thing, other):
            return []
        found.append(other)
    return found


def join_piece(
    pixels: NDArray[np.intp],
    things: Iterable[Pipeline],
    table: Table,
    image: FrameImage,
    view: TableView,
    settings: TrackingSettings,
) -> bool:
    """Add pixels to the thing of which they show a piece: it came when they did, touches them and has their hue.

    Parameters
    ----------
    pixels
        Flat indices of shape (k,).
    things
        All things.
    table
        The table.
    image, view
        The frame, and its view of the table.
    settings
        Options of the tracker.

    Returns
    -------
    bool
        False if they show a piece of none of the things that came after the look at the whole table.
    """
    from scipy.spatial import cKDTree

    reference = table.reference
    points, tints = image.places(pixels, view.back), image.colour.reshape(-1, 3)[pixels].astype(np.float64)
    since = float(np.median(reference.since.ravel()[pixels]))
    for thing in things:
        came = thing.first_rest and not thing.active and thing.since > table.laid_at
        if not came or abs(thing.since - since) > TOGETHER or thing.likeness(tints, np.inf).mean() < ALIKE:
            continue
        away = cKDTree(thing.placed_points).query(points)[0]
        if thing.contains(points, settings.margin).mean() > MOSTLY_WITHIN or away.min() < TOUCHING:
            reference.give(pixels, thing.slot, image)
            thing.extend(points, tints.astype(np.float32), settings.detection.outlines)
            return True
    return False


def let_stand(new: Collection[Pipeline], things: Things, image: FrameImage, view: TableView) -> None:
    """Extend new things down to the table whose feet are hidden, or lie within the noise of the table.

    Parameters
    ----------
    new
        The things.
    things
        All things, which may hide the feet.
    image, view
        The frame, and its view of the table.
    """
    resting = things.resting
    for thing in resting:
        if thing in new and (stands_on_table(thing, resting) or stands_behind(thing, resting, image, view)):
            thing.stand()


def stands_on_table(thing: Pipeline, others: Iterable[Pipeline]) -> bool:
    """Return True if a high thing ends a little above the table, whose noise hides its lowest points.

    Parameters
    ----------
    thing
        Thing at rest.
    others
        The other things at rest.

    Returns
    -------
    bool
        False for a flat thing, whose height may be that of the noise, and for one that lies on another thing.
    """
    bottom = float(thing.placed_corners[:, 2].min())
    is_high = thing.oriented.extents[2] > FLAT
    return is_high and 0.0 < bottom < MIN_LIFTED and not _lies_on_another(thing, others)


def stands_behind(thing: Pipeline, others: Iterable[Pipeline], image: FrameImage, view: TableView) -> bool:
    """Return True if a thing that seems to float stands on the table, with its foot behind something.

    Parameters
    ----------
    thing
        Thing at rest.
    others
        The other things at rest.
    image, view
        The frame, and its view of the table.

    Returns
    -------
    bool
        False for a thing that reaches down to the table or lies on another one, and where the frame shows what is
        below it.
    """
    corners = thing.placed_corners
    middle, bottom = corners.mean(axis=0), float(corners[:, 2].min())
    if bottom < MIN_LIFTED or _lies_on_another(thing, others):
        return False
    aside = AXIS * np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])
    stem = np.array([(*middle[:2], z) for z in np.arange(0.0, bottom, AXIS_STEP)])
    pixels, away = view.pixels((stem[:, None] + aside).reshape(-1, 3))
    depth = image.depth.ravel()[pixels]
    hidden = (depth > 0) & (depth < away - MIN_BEFORE)
    return len(pixels) > 0 and bool(hidden.mean() >= MIN_HIDDEN)


def _lies_on_another(thing: Pipeline, others: Iterable[Pipeline]) -> bool:
    """Return True if the box of another thing reaches below the middle of a thing."""
    corners = thing.placed_corners
    middle, bottom = corners.mean(axis=0), float(corners[:, 2].min())
    below = np.array([(*middle[:2], z) for z in np.arange(bottom, bottom - SUPPORT, -AXIS_STEP)])
    return any(other is not thing and other.contains(below, 0.0).any() for other in others)


def _is_alike(thing: Pipeline, other: Pipeline) -> bool:
    """Return True if another thing has the colours of a thing, in any light."""
    tints = other.cloud.colours
    return tints is not None and bool(thing.likeness(tints.astype(np.float64), np.inf).mean() > MIN_HANDLE_LIKENESS)
