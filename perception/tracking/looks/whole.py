"""Look at the whole table, and begin to know it: its pixels, its outline, and the things on it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.errors import CloudError
from deixis.perception.tracking.completion.pieces import let_stand
from deixis.perception.tracking.frames.image import FrameImage, TableView
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.colours import TableColours
from deixis.perception.tracking.table.observation import Table
from deixis.perception.tracking.table.outline import Outline
from deixis.perception.tracking.table.reference import TABLE, UNKNOWN_OWNER, Reference
from deixis.perception.tracking.things.collection import Things
from deixis.perception.tracking.things.model import model_on_table
from deixis.perception.tracking.things.pipeline import Pipeline

ON_PLANE = 0.01
"""Distance in metres from the plane of the table within which points are the table's, before its noise is known."""

MIN_NOISE = 0.0003
"""Lower bound in metres of the standard deviation of the depths of one frame at one metre."""


def detected_table(cloud: PointCloud, settings: DetectionSettings) -> Detection | str:
    """Detect the table and the objects on it in one frame.

    Parameters
    ----------
    cloud
        Organised cloud in the camera's frame, in metres.
    settings
        Options of the detection.

    Returns
    -------
    Detection or str
        What is found, or why no table is found.
    """
    try:
        found = detect(cloud, settings)
    except CloudError as error:
        return str(error)
    return found if found.table is not None else "; ".join(found.notes) or "no table was found"


def bare_table(image: FrameImage, view: TableView, at: float, settings: TrackingSettings) -> Table:
    """Begin to know a table by its plane: the outline, and the noise of the depths.

    Parameters
    ----------
    image, view
        The first frame, and its view of the table.
    at
        Time of the frame in seconds.
    settings
        Options of the tracker.

    Returns
    -------
    Table
        Table without known pixels and colours, which :func:`lay_out` adds.
    """
    heights = image.points.reshape(-1, 3) @ view.back[2, :3] + view.back[2, 3]
    on = np.abs(heights) < ON_PLANE
    outline = Outline()
    outline.extend(image.places(np.flatnonzero(on), view.back)[:, :2])
    noise = _noise(image.depth.ravel()[on], view.level.ravel()[on])
    return Table(_unknown(image, at), outline, TableColours(), noise, settings.noise_ratio * noise, at)


def lay_out(
    table: Table,
    things: Things,
    found: Detection,
    cloud: PointCloud,
    image: FrameImage,
    view: TableView,
    at: float,
    kept: Mapping[int, Pipeline],
    settings: TrackingSettings,
) -> tuple[Table, tuple[str, ...]]:
    """Make a frame the reference, in which the objects of a detection are new things or those that are kept.

    Parameters
    ----------
    table
        The table, whose pixels are forgotten.
    things
        The things that are kept; the new ones are added.
    found
        Detection of the whole table in the frame.
    cloud, image, view
        The frame, at the pixels that are compared, and its view of the table.
    at
        Its time in seconds.
    kept
        Things by the numbers of the objects that show them.
    settings
        Options of the tracker.

    Returns
    -------
    tuple
        The table with its new reference, and the ids of the new things.
    """
    table = replace(table, reference=_unknown(image, at), laid_at=at)
    reference, of = table.reference, shown(found.labels, cloud, settings.stride)
    near = np.abs(image.depth - view.level) < np.maximum(settings.tolerance, table.deviation * image.depth**2)
    plan = moved(image.points.reshape(-1, 3), view.back)
    beyond = table.outline.beyond(plan[:, :2]).reshape(of.shape) & (image.depth > 0)
    table.colours.extend(image.colour[(of < 0) & near & (image.depth > 0)])
    reference.give(np.flatnonzero((of < 0) & (near | beyond)), TABLE, image)
    came = []
    for k in range(len(found.boxes)):
        own = np.flatnonzero(of == k)
        if k in kept:
            reference.give(own, kept[k].slot, image)
        elif not table.outline.is_crossed_by(image.places(own, view.back)):
            points = np.flatnonzero(found.labels == k)
            came.append(things.enter(model_on_table(found, cloud, points, k, table, view.back, settings), at))
            reference.give(own, came[-1].slot, image)
    let_stand(came, things, image, view)
    return table, tuple(thing.id for thing in came)


def shown(labels: NDArray[np.int32], cloud: PointCloud, stride: int) -> NDArray[np.int32]:
    """Return the labels of a cloud at the pixels that are compared.

    Parameters
    ----------
    labels
        Label of each point, shape (n,).
    cloud
        Organised cloud of n points.
    stride
        Every how many rows and columns are compared.

    Returns
    -------
    ndarray
        Labels (r, c) of every ``stride``-th row and column.
    """
    assert cloud.organised is not None
    return labels.reshape(cloud.organised)[stride // 2 :: stride, stride // 2 :: stride]


def _unknown(image: FrameImage, at: float) -> Reference:
    """Return a reference in which no pixel is known."""
    return Reference(image, np.full(image.depth.shape, UNKNOWN_OWNER, np.int16), at)


def _noise(depth: NDArray[np.float32], level: NDArray[np.float32]) -> float:
    """Return the standard deviation of depths at one metre, from those of the table."""
    off = (depth - level) / np.maximum(depth, 0.3) ** 2
    off = off[np.isfinite(off)]
    return max(float(1.4826 * np.median(np.abs(off - np.median(off)))) if len(off) else 0.0, MIN_NOISE)
