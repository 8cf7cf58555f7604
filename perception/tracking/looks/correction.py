"""Correct the things of an earlier look at the table by a detection of the whole table in which nothing moves.

The noise of the one frame of the first look cuts off the ends of thin things, cuts things into pieces, and hides what
lies on a plate. The mean of the frames since then has less noise.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import BACKGROUND, Detection, detect_above
from deixis.perception.detection.outline import oriented_box, upright_box
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.detection.table.plane import Plane
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.scene import Scene
from deixis.perception.tracking.completion.missing_parts import MIN_BEFORE
from deixis.perception.tracking.completion.pieces import join_piece, let_stand
from deixis.perception.tracking.frames.image import FrameImage, TableView, enlarged
from deixis.perception.tracking.looks.matching import matches, overlap
from deixis.perception.tracking.looks.whole import shown
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Table
from deixis.perception.tracking.table.reference import TABLE
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.model import Model, model_on_table
from deixis.perception.tracking.things.pipeline import Pipeline

SAME_MODEL = 0.8
"""Minimum intersection over union of pixels at which a tracked thing keeps its model at a look at the whole table."""

SAME_HUE = 2.0
"""Largest distance in RGB between the median colours of two parts of one thing, across the direction of its light."""


@dataclass(frozen=True, eq=False)
class Correction:
    """Result of a correction.

    ``came`` are the ids of things that were not known, ``merged`` the things that turned out to be parts of others, and
    ``ids`` the ids of the things by the numbers of the detected objects.
    """

    came: tuple[str, ...]
    merged: tuple[Pipeline, ...]
    ids: dict[int, str]


def look_closely(
    table: Table,
    things: Things,
    cloud: PointCloud,
    image: FrameImage,
    view: TableView,
    at: float,
    settings: TrackingSettings,
) -> Correction | None:
    """Correct the things of the first look by the mean of the frames since.

    Parameters
    ----------
    table
        The table.
    things
        All things.
    cloud
        The last frame with the means of what the last frames measured.
    image, view
        The last frame, and its view of the table.
    at
        Its time in seconds.
    settings
        Options of the tracker.

    Returns
    -------
    Correction or None
        None if no object is found.
    """
    plane = Plane(view.back[2, :3], -float(view.back[2, 3]))
    found = detect_above(cloud, plane, settings.detection)
    if found is None:
        return None
    found = reconciled(found, cloud, table, things, image, view, settings)
    result = correct(table, things, found, cloud, image, view, at, 1.0, settings)
    _free_table(shown(found.labels, cloud, settings.stride), result.ids.values(), table, things, view, settings)
    return result


def correct(
    table: Table,
    things: Things,
    whole: Detection,
    cloud: PointCloud,
    image: FrameImage,
    view: TableView,
    at: float,
    least_shared: float,
    settings: TrackingSettings,
) -> Correction:
    """Correct the things by a detection of the whole table.

    A tracked thing that is a part of a detected one ends, or becomes the whole. A detected thing that is not tracked is
    new. Things that are hidden or out of view stay.

    Parameters
    ----------
    table
        The table.
    things
        All things.
    whole
        The detection.
    cloud, image, view
        The frame in which it was made, at the pixels that are compared, and its view of the table.
    at
        Time of the frame in seconds.
    least_shared
        Intersection over union of its pixels and those of the detected thing from which a thing keeps its model.
    settings
        Options of the tracker.

    Returns
    -------
    Correction
        What came and what was merged.
    """
    reference, of = table.reference, shown(whole.labels, cloud, settings.stride)
    matched = matches(of, len(whole.boxes), image, view.back, reference, list(things))
    merged, parts = [], defaultdict[int, list[Pipeline]](list)
    for thing in things:
        if thing in matched.values():
            continue
        if thing.active:
            thing.lost()
            continue
        own = of[reference.owner == thing.slot]
        if len(own) and thing.state == "seen" and (own >= 0).mean() >= 0.5:
            merged.append(thing)
            parts[int(np.bincount(own[own >= 0]).argmax())].append(thing)
    things.leave(merged)
    for thing in merged:
        reference.take(thing.slot, None, set())
    came, modelled, ids = [], [], dict[int, str]()
    for k in range(len(whole.boxes)):
        pixels = np.flatnonzero(of == k)
        points = np.flatnonzero(whole.labels == k)
        if k in matched:
            thing = matched[k]
            if thing.active or overlap(reference.owner == thing.slot, of == k) < least_shared:
                model = model_on_table(whole, cloud, points, k, table, view.back, settings)
                thing = remodelled(thing, model, things, image, view, at, settings)
                modelled.append(thing)
            if parts[k]:
                thing.take_name(parts[k], at)
        elif table.outline.is_crossed_by(image.places(pixels, view.back)) or join_piece(
            pixels, things, table, image, view, settings
        ):
            continue
        else:
            thing = things.enter(model_on_table(whole, cloud, points, k, table, view.back, settings), at)
            thing.since = thing.at = float(np.median(reference.since.ravel()[pixels]))
            came.append(thing)
        ids[k] = thing.id
        reference.assign(pixels, thing.slot, image, settings.tolerance, table.deviation)
    let_stand([*came, *modelled], things, image, view)
    return Correction(tuple(thing.id for thing in came), tuple(merged), ids)


def remodelled(
    thing: Pipeline,
    model: Model,
    things: Things,
    image: FrameImage,
    view: TableView,
    at: float,
    settings: TrackingSettings,
) -> Pipeline:
    """Give a thing the model that a frame shows, with what that frame does not show of a thing at rest.

    A camera that moves may have seen it before.

    Parameters
    ----------
    thing
        The thing.
    model
        Its model in the frame.
    things
        All things.
    image, view
        The frame, and its view of the table.
    at
        Its time in seconds.
    settings
        Options of the tracker.

    Returns
    -------
    Pipeline
        The new pipeline of the thing.
    """
    new = things.remodel(thing, model, at)
    if not thing.active and thing.cloud.colours is not None:
        points = thing.placed_points
        hidden = view.hides(points, image.depth, MIN_BEFORE)
        if hidden.any():
            colours = thing.cloud.colours[hidden].astype(np.float32)
            new.extend(points[hidden], colours, settings.detection.outlines)
    return new


def reconciled(
    found: Detection,
    cloud: PointCloud,
    table: Table,
    things: Things,
    image: FrameImage,
    view: TableView,
    settings: TrackingSettings,
) -> Detection:
    """Return a detection in which things that were found before keep what has their colours, and nothing else.

    Whether a knife is cut off from a plate, or the foot of a glass from its bowl, depends on the noise. An object that
    is a piece of a thing and has its colours is joined to it; a thing of other colours than the object in which it is
    keeps its points.

    Parameters
    ----------
    found
        The detection.
    cloud
        Its cloud.
    table
        The table.
    things
        The things that were found before.
    image, view
        The last frame, and its view of the table.
    settings
        Options of the tracker.

    Returns
    -------
    Detection
        The detection itself for a cloud without colours.
    """
    if cloud.colours is None or cloud.organised is None:
        return found
    labels, owner = found.labels.copy(), table.reference.owner
    of = shown(labels, cloud, settings.stride)
    matched = matches(of, len(found.boxes), image, view.back, table.reference, list(things))
    tints = cloud.colours.astype(np.float64)
    for thing in things:
        own = owner == thing.slot
        if thing in matched.values() or not own.any():
            continue
        k = int(np.bincount(of[own] + 1).argmax()) - 1
        inside = enlarged(own, settings.stride, cloud.organised).ravel() & (labels == k)
        around = (labels == k) & ~inside
        if k >= 0 and around.any() and not _have_one_hue(tints[inside], tints[around]):
            labels[inside] = BACKGROUND
    joined = list(range(len(found.boxes)))
    for k in sorted(set(joined) - set(matched)):
        slots = owner[of == k]
        for whole, thing in matched.items():
            is_its_own = len(slots) > 0 and (slots == thing.slot).mean() > 0.5
            if is_its_own and _have_one_hue(tints[labels == k], tints[labels == whole]):
                joined[k] = whole
    return _rejoined(replace(found, labels=labels), joined, settings.detection.outlines)


def detection_of(scene: Scene) -> Detection:
    """Return the detection of a scene with its objects, some of which may have been joined, numbered from 0.

    Parameters
    ----------
    scene
        Scene that was perceived in a cloud.

    Returns
    -------
    Detection
        Its detection, with an object for each object of the scene.
    """
    found = scene.detection
    assert isinstance(found, Detection)
    number = {int(thing.id[1:]) - 1: place for place, thing in enumerate(scene.objects)}
    places = np.full(max([*number, int(found.labels.max(initial=0))], default=0) + 2, -1, np.int32)
    for old, new in number.items():
        places[old] = new
    oriented = tuple(thing.oriented for thing in scene.objects if thing.oriented is not None)
    return replace(found, labels=places[found.labels], boxes=scene.boxes, oriented=oriented)


def _free_table(
    of: NDArray[np.int32],
    ids: Collection[str],
    table: Table,
    things: Things,
    view: TableView,
    settings: TrackingSettings,
) -> None:
    """Give the pixels that things no longer have, and that are as low as the table, to the table."""
    reference, level = table.reference, view.level
    near = np.abs(reference.depth - level) < np.maximum(settings.tolerance, table.deviation * level**2)
    slots = [thing.slot for thing in things if thing.id in ids]
    reference.owner[(of == BACKGROUND) & np.isin(reference.owner, slots) & near] = TABLE


def _have_one_hue(tints: NDArray[np.float64], others: NDArray[np.float64]) -> bool:
    """Return True if colours (k, 3) and others (m, 3) are those of one thing, in any light."""
    one, other = np.median(tints, axis=0), np.median(others, axis=0)
    across = one - (one @ other) / max(float(other @ other), 1e-9) * other
    return bool(np.linalg.norm(across) < SAME_HUE)


def _rejoined(found: Detection, joined: list[int], outlines: OutlineSettings) -> Detection:
    """Return a detection in which object k is a part of object ``joined[k]``, numbered from 0 again."""
    left = sorted(set(joined))
    number = np.array([*(left.index(whole) for whole in joined), BACKGROUND], np.int32)
    labels, boxes, oriented = number[found.labels], found.boxes[left].copy(), [found.oriented[k] for k in left]
    for whole in {whole for k, whole in enumerate(joined) if k != whole}:
        k = left.index(whole)
        points = moved(found.cloud.points[labels == k].astype(np.float64), found.frame)
        boxes[k], oriented[k] = upright_box(points, outlines, None), oriented_box(points, outlines, None)
    return replace(found, labels=labels, boxes=boxes, oriented=tuple(oriented))
