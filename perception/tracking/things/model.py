"""Make the model of a thing, its points and its boxes, from an object of a detection."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import Detection
from deixis.perception.detection.outline import Circle, oriented_box, upright_box
from deixis.perception.detection.settings import OutlineSettings
from deixis.perception.detection.table.viewpoint import moved
from deixis.perception.oriented_box import OrientedBox, yaw_of
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.observation import Table
from deixis.perception.tracking.things.rectangle import is_rectangular
from deixis.perception.tracking.things.revolution import circle_around

MIN_TURN = np.deg2rad(3.0)
"""Minimum angle in radians between two frames of a table at which a box is enlarged to hold the turned box."""


MIN_ELONGATION = 2.0
"""Minimum ratio of the sides of an object whose boxes hold just its own points; those of others may have a hidden part
that completes a circle."""

MAX_TABLE_SHARE = 0.6
"""Largest share of the points of a detected object that may be the table's."""


@dataclass(frozen=True, eq=False)
class Model:
    """Points and boxes of a thing in its own frame, whose origin is the middle of the box.

    ``half`` (3,) is half of the sides of the box, ``oriented`` is the box that is turned about the vertical, and
    ``pose`` (4, 4) takes the thing's frame to the tracker's.
    """

    cloud: PointCloud
    half: NDArray[np.float64]
    oriented: OrientedBox
    pose: NDArray[np.float64]


def model_on_table(
    found: Detection,
    cloud: PointCloud,
    points: NDArray[np.intp],
    k: int,
    table: Table,
    back: NDArray[np.float64],
    settings: TrackingSettings,
) -> Model:
    """Return the model of one object of a detection, without the points of the table beside it.

    Parameters
    ----------
    found
        The detection.
    cloud
        Cloud of the frame.
    points
        Indices (n,) of the points of the object.
    k
        Number of the object.
    table
        The table, with its colours.
    back
        Transform (4, 4) from the frame of the cloud to the tracker's.
    settings
        Options of the tracker.

    Returns
    -------
    Model
        Points, boxes and pose.
    """
    own = without_table(cloud, points, table, back, settings.tolerance)
    change = back @ np.linalg.inv(found.frame)  # from the detection's frame to that of the first frame
    return model_of(found, cloud, own, k, change, settings.detection.outlines)


def without_table(
    cloud: PointCloud, points: NDArray[np.intp], table: Table, back: NDArray[np.float64], tolerance: float
) -> NDArray[np.intp]:
    """Return the points of a detected object that do not show the table beside it, as between the tines of a fork.

    These are as low as the table and have its colours; an object of which little else is left keeps all.

    Parameters
    ----------
    cloud
        Cloud of the frame.
    points
        Indices (n,) of the points of the object.
    table
        The table, with its colours.
    back
        Transform (4, 4) from the frame of the cloud to the tracker's.
    tolerance
        Height in metres up to which a point may be the table's.

    Returns
    -------
    ndarray
        Indices of shape (m,) of the points that are left.
    """
    if cloud.colours is None:
        return points
    heights = cloud.points[points] @ back[2, :3] + back[2, 3]
    low = (heights < tolerance) & table.colours.include(cloud.colours[points].astype(np.float32))
    return points[~low] if low.mean() < MAX_TABLE_SHARE else points


def model_of(
    found: Detection,
    cloud: PointCloud,
    points: NDArray[np.intp],
    k: int,
    change: NDArray[np.float64],
    outlines: OutlineSettings,
) -> Model:
    """Return the model of one object of a detection, with the hidden back or corners of a round or rectangular thing.

    The detection's own boxes may hold more than the points of the object, those of the table beside it or a hidden part
    of a circle. For an elongated object, only its points count.

    Parameters
    ----------
    found
        The detection.
    cloud
        Cloud of the frame.
    points
        Indices (n,) of the points of the object.
    k
        Number of the object.
    change
        Transform (4, 4) from the frame of the detection to the tracker's.
    outlines
        Share of outermost points that are noise.

    Returns
    -------
    Model
        Points, boxes and pose.
    """
    own = moved(moved(cloud.points[points].astype(np.float64), found.frame), change)
    turn = float(np.arctan2(change[1, 0], change[0, 0]))
    box = found.oriented[k]
    centre = moved(np.array([box.centre]), change)[0]
    middle = moved(found.boxes[k].mean(axis=0)[None], change)[0]
    half = (found.boxes[k][1] - found.boxes[k][0]) / 2
    if abs(turn) > MIN_TURN:
        cosine, sine = abs(np.cos(turn)), abs(np.sin(turn))
        half = np.array([cosine * half[0] + sine * half[1], sine * half[0] + cosine * half[1], half[2]])
    around = OrientedBox(tuple(centre.tolist()), box.yaw + turn, box.extents)
    circle = circle_around(own)
    if box.extents[0] > MIN_ELONGATION * box.extents[1]:  # points beside it that are not its own enlarge its boxes
        corners = upright_box(own, outlines)
        middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
        around = oriented_box(own, outlines)
    elif circle is not None:  # its back is hidden
        corners = circle.enclosed_by(np.stack([middle - half, middle + half]))
        middle, half = corners.mean(axis=0), np.ptp(corners, axis=0) / 2
        around = oriented_box(own, outlines, circle)
    elif is_rectangular(own, around):  # a corner may be hidden
        middle, half = np.array(around.centre), np.ptp(around.corners, axis=0) / 2
    pose = np.eye(4)
    pose[:3, 3] = middle
    oriented = OrientedBox(tuple((np.array(around.centre) - middle).tolist()), around.yaw, around.extents)
    colours = None if cloud.colours is None else cloud.colours[points]
    return Model(PointCloud((own - middle).astype(np.float32), colours), half, oriented, pose)


def extended(
    model: Model, points: NDArray[np.float64], colours: NDArray[np.float32], settings: OutlineSettings
) -> Model:
    """Return the model of a thing with more points, and with the boxes around all of them.

    The box of an upright round thing keeps its hidden back, such as that of a mug whose handle comes into view, that of
    a flat rectangular thing its hidden corners, and a thing that stands on the table keeps its foot. The sides of the
    upright box lie along the axes of the thing, which may have turned since it was first seen.

    Parameters
    ----------
    model
        Points, boxes and pose so far.
    points
        Points of shape (n, 3) in the table's frame, in metres.
    colours
        Their colours, shape (n, 3).
    settings
        Share of outermost points that are noise.

    Returns
    -------
    Model
        Model whose origin is the middle of the new box.
    """
    turn, start = model.pose[:3, :3], model.pose[:3, 3]
    own = model.cloud.points.astype(np.float64) @ turn.T + start
    everything = np.concatenate([own, points])
    circle = circle_around(everything) or circle_around(own)
    around = oriented_box(everything, settings, circle)
    outline = around.corners if circle is None and is_rectangular(everything, around) else everything[:0]
    bottom = max(float(start[2] - model.half[2]), 0.0)
    around = _down_to(bottom, around)

    def along_own_axes(places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return places relative to the origin in plan, along the sides of the box, which may be turned."""
        return np.asarray((places - start) @ turn + np.array([0.0, 0.0, start[2]]))

    rim = None if circle is None else Circle(circle.centre - start[:2], circle.radius).turned(turn[:2, :2].T)
    local = along_own_axes(everything)
    box = upright_box(local, settings, rim)
    for corner in along_own_axes(outline)[:, :2]:
        box[0, :2], box[1, :2] = np.minimum(box[0, :2], corner), np.maximum(box[1, :2], corner)
    box[0, 2] = min(box[0, 2], bottom)
    middle = box.mean(axis=0)
    pose = model.pose.copy()
    pose[:3, 3] = start + turn @ (middle - (0.0, 0.0, start[2]))
    tints = None
    if model.cloud.colours is not None:
        tints = np.concatenate([model.cloud.colours, np.clip(colours, 0, 255).astype(np.uint8)])
    yaw = yaw_of(turn)
    centre = tuple(((np.array(around.centre) - pose[:3, 3]) @ turn).tolist())
    oriented = OrientedBox(centre, around.yaw - yaw, around.extents)
    return Model(PointCloud((local - middle).astype(np.float32), tints), (box[1] - box[0]) / 2, oriented, pose)


def standing(model: Model) -> Model:
    """Return the model of a thing with its boxes extended down to the table, on which it stands with a hidden foot.

    Parameters
    ----------
    model
        Points, boxes and pose of what is seen.

    Returns
    -------
    Model
        Model with the same points.
    """
    top = float(model.pose[2, 3] + model.oriented.centre[2] + model.oriented.extents[2] / 2)
    x, y, _ = model.oriented.centre
    points, pose = model.cloud.points.copy(), model.pose.copy()
    points[:, 2] += np.float32(model.pose[2, 3] - top / 2)
    pose[2, 3] = top / 2
    oriented = OrientedBox((x, y, 0.0), model.oriented.yaw, (*model.oriented.extents[:2], top))
    return Model(PointCloud(points, model.cloud.colours), np.array([*model.half[:2], top / 2]), oriented, pose)


def _down_to(bottom: float, box: OrientedBox) -> OrientedBox:
    """Return a box that reaches down to a height at least."""
    (x, y, z), (length, width, height) = box.centre, box.extents
    top, low = z + height / 2, min(z - height / 2, bottom)
    return OrientedBox((x, y, (low + top) / 2), box.yaw, (length, width, top - low))
