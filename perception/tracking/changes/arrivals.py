"""Find what is new on the table: segment what changed and stays, as new things or as the places of lost ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect_above
from deixis.perception.detection.table.plane import Plane
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.tracking.changes.following import FLAT
from deixis.perception.tracking.changes.hands import Hands
from deixis.perception.tracking.changes.ownership import things_around
from deixis.perception.tracking.completion.pieces import join_piece, let_stand
from deixis.perception.tracking.frames.image import enlarged
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Observation, Table
from deixis.perception.tracking.table.reference import TABLE, UNKNOWN_OWNER
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.fitting import Fit, fits
from deixis.perception.tracking.things.model import model_on_table
from deixis.perception.tracking.things.pipeline import Pipeline

DETECTION_PAUSE = 0.25
"""Minimum time in seconds between two segmentations."""

RETRY_AFTER = 1.0
"""Time in seconds after which changed pixels that gave no thing are by themselves a reason to segment again."""

MAX_TRIES = 2
"""Number of segmentations that find no thing in pixels as high as the table, after which they are the table's."""

ON_ITS_OWNER = -2
"""Mark of a pixel that may show something on the thing that has it in the reference."""

MIN_CHANGED = 0.5
"""Minimum share of the points of a detected object that have changed."""

REVEALED = 0.5
"""Minimum share of the pixels of a new thing at which nothing was known, for it to have come into view by itself."""

SET_DOWN = 1.0
"""Time in seconds before a new thing is steady in which the hand that sets it down is near."""

FILLED = 0.5
"""Minimum ratio of the sides of two boxes of one thing."""

AGAIN_VISIBLE, AGAIN_EXPLAINED = 0.3, 0.7
"""Minimum share of the points of a lost thing that agree where it is found again, and of the pixels in its box."""


class Arrivals:
    """Segmentation of what changed and stays, from frame to frame.

    Parameters
    ----------
    settings
        Options of the tracker.
    """

    def __init__(self, settings: TrackingSettings) -> None:
        self._settings = settings
        self._segmented_at = -np.inf

    def look(
        self, things: Things, table: Table, seen: Observation, hands: Hands, mean: Callable[[], PointCloud]
    ) -> tuple[str, ...]:
        """Give steady changed pixels to the table and to known things, and segment the others now and then.

        Parameters
        ----------
        things
            All things; new ones are added.
        table
            The table.
        seen
            The frame.
        hands
            The hands, which may have set new things down.
        mean
            Function that returns the cloud of the frame with the means of what the last frames measured.

        Returns
        -------
        tuple of str
            Ids of the new things.
        """
        from deixis.perception.tracking.kernels import FARTHER

        reference, settings, at, image = table.reference, self._settings, seen.at, seen.image
        steady = at - reference.since >= settings.steady
        free = np.flatnonzero(~seen.changes.same & (image.depth > 0) & steady & ~seen.hand)
        if not len(free):
            return ()
        points = image.places(free, seen.view.back)
        level = np.abs(points[:, 2]) < FLAT
        nothing = table.colours.include(image.colour.reshape(-1, 3)[free]) | (
            reference.tries.ravel()[free] >= MAX_TRIES
        )
        flat = (level & nothing) | table.outline.beyond(points[:, :2])
        reference.give(free[flat], TABLE, image)
        free, points = free[~flat], points[~flat]
        edge = _edges(free, table, seen)
        is_unknown = edge | (seen.changes.state.ravel()[free] == FARTHER)
        owner = np.where(is_unknown, UNKNOWN_OWNER, reference.owner.ravel()[free])
        for thing in things.resting:  # what is nearer than a thing, or of another colour, may lie on it
            owner[(owner == thing.slot) & thing.contains(points, settings.margin)] = ON_ITS_OWNER
        around, of = things_around(image, free, points, at, things, settings)
        left = np.ones(len(free), np.bool_)
        for number, thing in enumerate(around):
            own = of == number
            if not thing.active:
                own &= owner != ON_ITS_OWNER
                reference.give(free[own], thing.slot, image)
            left &= ~own
        free = free[left & ~edge]
        untried = int((reference.retry_at.ravel()[free] <= at).sum())
        if untried < settings.least_pixels or at - self._segmented_at < DETECTION_PAUSE:
            return ()
        self._segmented_at = at
        return segment(free, things, table, seen, hands, mean(), settings)


def segment(
    free: NDArray[np.intp],
    things: Things,
    table: Table,
    seen: Observation,
    hands: Hands,
    cloud: PointCloud,
    settings: TrackingSettings,
) -> tuple[str, ...]:
    """Detect objects among changed pixels, which known things, lost things and new ones then have.

    Parameters
    ----------
    free
        Pixels that show neither the table nor a known thing, as flat indices of shape (k,).
    things
        All things; new ones are added.
    table
        The table.
    seen
        The frame.
    hands
        The hands, which may have set new things down.
    cloud
        Cloud of the frame with the means of what the last frames measured.
    settings
        Options of the tracker.

    Returns
    -------
    tuple of str
        Ids of the new things.
    """
    reference, image = table.reference, seen.image
    found, candidates = _objects(free, table, seen, cloud, settings)
    came: list[Pipeline] = []
    taken = np.zeros(len(free), np.bool_)
    if found is not None:
        assert cloud.organised is not None
        first, stride = settings.stride // 2, settings.stride
        of = found.labels.reshape(cloud.organised)[first::stride, first::stride].ravel()[free]
        sizes = np.bincount(of[of >= 0], minlength=len(found.boxes))
        for k in np.argsort(-sizes, kind="stable").tolist():  # a thing before its pieces
            own = np.flatnonzero(found.labels == k)
            pixels = free[of == k]
            enough = len(pixels) >= settings.least_pixels and candidates[own].mean() > MIN_CHANGED
            if not enough or table.outline.is_crossed_by(image.places(pixels, seen.view.back)):
                continue
            taken |= of == k
            there = _filled(found, k, things, seen.view.back, settings)
            if there is not None:
                reference.give(pixels, there.slot, image)
            elif join_piece(pixels, things, table, image, seen.view, settings):
                continue
            elif not _is_found_again(pixels, things, table, seen, settings):
                model = model_on_table(found, cloud, own, k, table, seen.view.back, settings)
                thing = things.enter(model, seen.at)
                thing.since = thing.at = float(np.median(reference.since.ravel()[pixels]))
                thing.revealed = is_revealed(thing, pixels, table, hands)
                thing.beneath = reference.give(pixels, thing.slot, image)
                came.append(thing)
    let_stand(came, things, image, seen.view)
    reference.retry_at.ravel()[free[~taken]] = seen.at + RETRY_AFTER
    if seen.hand_at < seen.at:  # else a thing that is set down may not be whole yet
        reference.tries.ravel()[free[~taken]] = np.minimum(reference.tries.ravel()[free[~taken]] + 1, MAX_TRIES)
    return tuple(thing.id for thing in came)


def is_revealed(thing: Pipeline, pixels: NDArray[np.intp], table: Table, hands: Hands) -> bool:
    """Return True if a new thing was there before: nothing was known at its pixels, or no hand has been near.

    Parameters
    ----------
    thing
        The thing.
    pixels
        Its pixels, as flat indices of shape (k,).
    table
        The table before the thing has the pixels.
    hands
        The hands.

    Returns
    -------
    bool
        False if a hand may have set it down.
    """
    unknown = float((table.reference.owner.ravel()[pixels] == UNKNOWN_OWNER).mean())
    return unknown > REVEALED or not hands.were_near(thing.pose[:3, 3], thing.reach, thing.at - SET_DOWN)


def _edges(pixels: NDArray[np.intp], table: Table, seen: Observation) -> NDArray[np.bool_]:
    """Return a mask of the pixels in strips of one or two pixels beside things, which their edges leave there.

    Edges leave such strips under a camera that moves.
    """
    from scipy.ndimage import binary_dilation, binary_opening

    if not seen.is_camera_moving:
        return np.zeros(len(pixels), np.bool_)
    mask = np.zeros(table.reference.owner.shape, np.bool_)
    mask.ravel()[pixels] = True
    opened: NDArray[np.bool_] = binary_opening(mask, np.ones((3, 3)))
    beside = binary_dilation(table.reference.owner > TABLE, np.ones((3, 3)), iterations=2)
    found: NDArray[np.bool_] = (~opened & beside).ravel()[pixels]
    return found


def _objects(
    free: NDArray[np.intp], table: Table, seen: Observation, cloud: PointCloud, settings: TrackingSettings
) -> tuple[Detection | None, NDArray[np.bool_]]:
    """Return the objects among changed pixels and the table around them, and a mask (n,) of the changed points."""
    from scipy.ndimage import binary_dilation

    assert cloud.organised is not None
    mask = np.zeros(seen.image.depth.shape, np.bool_)
    mask.ravel()[free] = True
    shown = mask | ((table.reference.owner == TABLE) & seen.changes.same)
    everywhere = enlarged(binary_dilation(shown), settings.stride, cloud.organised).ravel()
    candidates = enlarged(mask, settings.stride, cloud.organised).ravel()
    points = np.where(everywhere[:, None], cloud.points, np.float32(np.nan))
    plane = Plane(seen.view.back[2, :3], -float(seen.view.back[2, 3]))
    return detect_above(replace(cloud, points=points), plane, settings.detection), candidates


def _filled(
    found: Detection, k: int, things: Things, back: NDArray[np.float64], settings: TrackingSettings
) -> Pipeline | None:
    """Return the thing at rest whose box object ``k`` of a detection fills: it is the thing, which was hidden."""
    box = found.oriented[k]
    corners = moved(box.corners, back @ np.linalg.inv(found.frame))
    least = FILLED * np.sort(box.extents)[::-1]
    for thing in things.resting:
        sides = np.sort(thing.oriented.extents)[::-1]
        fills = (FILLED * sides <= np.sort(box.extents)[::-1]).all() and (least <= sides).all()
        if fills and thing.contains(corners, settings.turned_margin).all():
            return thing
    return None


def _is_found_again(
    pixels: NDArray[np.intp], things: Things, table: Table, seen: Observation, settings: TrackingSettings
) -> bool:
    """Let the lost thing that pixels show rest there; return False if they show a new thing."""
    lost = [thing for thing in things if thing.active]
    if not lost:
        return False
    taken = np.ones(seen.image.depth.shape, np.bool_)
    taken.ravel()[pixels] = False
    taken &= seen.changes.same
    best: tuple[Fit, Pipeline] | None = None
    for thing in lost:
        elsewhere = thing.agreement * thing.visible if thing.found else 0.0
        for fit in fits(thing, seen.image, seen.view, pixels, taken, table.noise):
            is_seen = fit.agreement > settings.fit and fit.visible > AGAIN_VISIBLE and fit.explained > AGAIN_EXPLAINED
            if is_seen and fit.score * fit.visible > elsewhere and (best is None or fit.score > best[0].score):
                best = fit, thing
    if best is None:
        return False
    fit, thing = best
    thing.put(fit.pose)
    thing.moved_to(fit.pose, seen.at, fit.score)
    things.settle(thing)
    thing.beneath = table.reference.give(pixels, thing.slot, seen.image)
    return True
