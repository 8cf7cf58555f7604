"""Detect the objects on a table in a point cloud: the steps in their order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.density import evenly_dense
from deixis.perception.detection.left_out import (
    Above,
    Fate,
    Pieces,
    far_note,
    holes,
    left_out,
    missing_lines,
    odd_sizes,
)
from deixis.perception.detection.outline import corners_of, hull_of, occupied_cells, oriented_box, rim_of, upright_box
from deixis.perception.detection.quantiles import median, medians, percentiles
from deixis.perception.detection.segmentation.boundaries import agglomerated, boundaries
from deixis.perception.detection.segmentation.joining import whole_things
from deixis.perception.detection.segmentation.lying import with_lying_things
from deixis.perception.detection.segmentation.parts import Parts
from deixis.perception.detection.segmentation.supervoxels import supervoxels
from deixis.perception.detection.segmentation.surface import Surface, surface_of
from deixis.perception.detection.settings import DetectionSettings, ScaleSettings
from deixis.perception.detection.shown import Shows, is_bare_table, is_large, is_one_object, is_small
from deixis.perception.detection.table.heights import Raised, raised
from deixis.perception.detection.table.neighbours import (
    NEIGHBOURS,
    ListedNeighbours,
    Neighbours,
    has_enough,
    neighbour_table,
    neighbours_in_image,
)
from deixis.perception.detection.table.plane import Plane
from deixis.perception.detection.table.table_top import table_top
from deixis.perception.detection.table.tables import FoundTable, tables
from deixis.perception.detection.table.viewpoint import (
    View,
    camera_pose_of,
    finite_places,
    in_frame,
    likeliest_pose,
    moved,
    table_frame,
    verified_pose,
)
from deixis.perception.errors import CloudError
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import DEFAULT_VIEWPOINT, PerceivedObject, Scene
from deixis.reasoning.geometry.coordinates import coordinates, norms

BACKGROUND = -1
"""Label of a point that does not belong to an object."""


@dataclass(frozen=True, eq=False)
class Detection:
    """Objects on a table in a cloud of n points.

    Object k has the id ``o{k + 1}``; objects are numbered from left to right, and from near to far for equal left ends.

    Parameters
    ----------
    cloud
        The cloud in which the objects were detected.
    table
        Plane of the table, or None if none was found.
    frame
        Transform (4, 4) from the frame of the cloud to that of the table: z up from its plane, x to the viewer's right,
        y away from the viewer.
    labels
        Index k of the object of each point, shape (n,); -1 for none.
    boxes
        Lower and upper corner of each object in the frame of the table, in metres, shape (k, 2, 3).
    oriented
        Smallest box around each object that is turned about the vertical.
    notes
        Warnings: what was left out, and what is unusual.
    shows
        Kind of the cloud.
    upright
        True if the vertical is known: from a table, or given in the settings.
    """

    cloud: PointCloud
    table: Plane | None
    frame: NDArray[np.float64]  # (4, 4)
    labels: NDArray[np.int32]  # (n,)
    boxes: NDArray[np.float64]  # (k, 2, 3)
    oriented: tuple[OrientedBox, ...]
    notes: tuple[str, ...] = ()
    shows: Shows = Shows.TABLE
    upright: bool = True

    def scene(self, viewpoint: str = DEFAULT_VIEWPOINT, file: str = "<cloud>") -> Scene:
        """Return the objects as a scene, with their points in the frame of the table.

        Parameters
        ----------
        viewpoint
            Name of the side from which the camera looks.
        file
            Name of the source, which errors mention.

        Returns
        -------
        Scene
            Objects ``o1``, ``o2`` and so on in the order of the labels, with boxes in metres.
        """
        boxes = zip(self.boxes.round(6).tolist(), self.oriented, strict=True)
        things = [
            PerceivedObject(
                f"o{number + 1}",
                tuple(low),
                tuple(high),
                cloud=in_frame(self.cloud.take(self.labels == number), self.frame),
                oriented=oriented.rounded(6),
            )
            for number, ((low, high), oriented) in enumerate(boxes)
        ]
        frame = "table" if self.upright else "object"
        return Scene(tuple(things), frame=frame, viewpoint=viewpoint, file=file, detection=self)


FINDING_TABLE, SEPARATING = DETECTION_STAGES = ("looking for the table", "separating the objects")
"""Stages of a detection, in order."""


def detect(
    cloud: PointCloud, settings: DetectionSettings | None = None, stage: Callable[[str], None] | None = None
) -> Detection:
    """Detect a table in a cloud and the objects on it.

    A cloud without a table, an empty table, and further tables are reported in the notes of the detection.

    Parameters
    ----------
    cloud
        Points in metres; its labels are ignored.
    settings
        Options and thresholds; the default ones if None.
    stage
        Called with the name of each of ``DETECTION_STAGES`` that begins.

    Returns
    -------
    Detection
        Frame of the table, a label for each point, and a box for each object, in metres.

    Raises
    ------
    CloudError
        If the cloud has no finite point, or is so large or small that it cannot be in metres.

    Examples
    --------
    >>> x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.01, 0.5:1.5:0.01])
    >>> table = np.stack([x, y, np.full(x.shape, -0.7)], axis=1)
    >>> found = detect(PointCloud(table.astype(np.float32)))
    >>> abs(found.table.normal).round(3).tolist(), found.boxes.shape, found.notes
    ([0.0, 0.0, 1.0], (0, 2, 3), ('nothing is on the table',))
    """
    settings = settings or _default_settings()
    seen = _seen(cloud, settings)
    if seen is None:
        raise CloudError("a cloud without one finite point cannot be used; check the depth image")
    view, notes = seen
    found = _detected(cloud, view, settings, stage or (lambda name: None))
    return replace(found, notes=(*found.notes, *notes))


def _seen(cloud: PointCloud, settings: DetectionSettings, is_whole: bool = True) -> tuple[View, tuple[str, ...]] | None:
    """Return the points of a cloud that are used, and notes on others that have a depth; None without any point.

    A part of a cloud is not checked for its unit, as it may be small.
    """
    from deixis.perception.detection.kernels import gathered

    kept = finite_places(cloud)
    if not len(kept):
        return None
    points, box = gathered(cloud.points, kept)
    few = points[:: max(1, len(points) // 10_000)]
    middle, limits = medians(few), settings.scale
    if is_whole:
        _require_metres(few, middle, limits)
    notes: tuple[str, ...] = ()
    if np.abs(box - middle).max() > limits.max_radius:
        near = np.flatnonzero((np.abs(points - middle) <= limits.max_radius).all(axis=1))
        notes = (far_note(len(points) - len(near), limits.max_radius),)
        points, kept = points.take(near, axis=0), kept[near]
    view = View(points, kept, cloud.organised, camera_pose_of(cloud, settings))
    return evenly_dense(view, settings), notes


def _require_metres(points: NDArray[np.float64], middle: NDArray[np.float64], limits: ScaleSettings) -> None:
    """Raise CloudError for points (n, 3) around a ``middle`` (3,) whose unit cannot be metres."""
    spread = median(norms(points - middle))
    if spread > limits.max_median_radius:
        raise CloudError(
            f"half of the points are more than {spread:.0f} m from the middle, too far for a table;"
            " coordinates must be metres: divide millimetres by 1000, or set the depth_scale of a depth image"
        )
    if len(points) > 100 and spread < limits.min_median_radius:
        raise CloudError(
            f"half of the points are within {1000 * spread:.2g} mm of the middle, too near for a table;"
            " coordinates must be metres: check the unit, or the depth_scale of the intrinsics"
        )


def _detected(cloud: PointCloud, view: View, settings: DetectionSettings, begin: Callable[[str], None]) -> Detection:
    """Return the objects on a table in a view of a cloud, or what else it shows."""
    points = view.points
    if len(points) >= settings.least_points and is_small(points, settings):
        return _alone(cloud, view, settings)
    begin(FINDING_TABLE)
    seen = list(islice(tables(view, settings), settings.table + 1))
    if len(seen) < settings.table and settings.table > 1:
        nothing = _nothing(cloud, view, settings, _no_table(settings, len(seen)))
        return replace(nothing, shows=Shows.TABLE) if len(seen) == 1 else nothing
    begin(SEPARATING)
    found = _on_table(cloud, seen[settings.table - 1], settings) if seen else None
    alone = settings.table == 1 and len(points) >= settings.least_points
    if alone and not _has_objects(found, seen, settings):
        bare = bool(seen) and is_bare_table(seen[0], settings)
        if is_one_object(points, settings, len(seen), bare):
            return _alone(cloud, view, settings)
    if found is None:
        return _nothing(cloud, view, settings, _no_table(settings, 0))
    if len(seen) > settings.table:
        return replace(found, shows=Shows.TABLES, notes=(*found.notes, _more(settings.table)))
    return found if settings.table == 1 else replace(found, shows=Shows.TABLES)


@cache
def _default_settings() -> DetectionSettings:
    return DetectionSettings()


def detect_above(cloud: PointCloud, plane: Plane, settings: DetectionSettings | None = None) -> Detection | None:
    """Detect the objects on a table whose plane is known.

    Parameters
    ----------
    cloud
        Points in metres; its labels are ignored.
    plane
        Plane of the table, in the frame of the cloud.
    settings
        Options and thresholds; the default ones if None.

    Returns
    -------
    Detection or None
        Objects above the plane, with the frame of the part of the table that is in view; None if no point of the cloud
        is finite, or the plane does not show a table.
    """
    settings = settings or _default_settings()
    seen = _seen(cloud, settings, is_whole=False)
    if seen is None:
        return None
    view, notes = seen
    found = _on_table(cloud, FoundTable(plane, table_top(view, plane, settings), view), settings)
    return found and replace(found, notes=(*found.notes, *notes))


def _has_objects(found: Detection | None, seen: list[FoundTable], settings: DetectionSettings) -> bool:
    """Return True if an object stands on the found table, so that it is not a face of a single object.

    A face of an object is shorter than a table. Points near the outline of a face may be another side of the object,
    and points all around it the rim of the object.
    """
    if found is None:
        return False
    table = seen[0]
    top = table.top.on[:: max(1, len(table.top.on) // 2000)]
    points, across = table.view.points, table.plane.across
    plan = coordinates(points[top], across)
    if not len(top) or np.ptp(plan, axis=0).max() < settings.scale.min_table_length:
        return False
    labels = found.labels[table.view.places]
    inset = labels[table.top.outside < -settings.scale.min_inset]
    counts = np.bincount(labels[labels >= 0], minlength=len(found.boxes))
    within = np.bincount(inset[inset >= 0], minlength=len(found.boxes))
    outline = hull_of(plan)
    for number in np.flatnonzero(within > settings.scale.min_inset_share * counts).tolist():
        hull = hull_of(coordinates(points[labels == number], across))
        if hull is None or outline is None or hull.volume < settings.scale.min_rim_share * outline.volume:
            return True
    return False


def _no_table(settings: DetectionSettings, found: int) -> str:
    if found:
        return f"there is no table {settings.table}: {'one table was' if found == 1 else f'{found} tables were'} found"
    if settings.up is not None:
        return "no table was found: no large surface in view is level, within 45 degrees of the given up direction"
    return "no table was found: no large level surface is in view"


def _more(number: int) -> str:
    return f"another table with objects is in view; use perceive --table {number + 1} to detect them"


def _on_table(cloud: PointCloud, table: FoundTable, settings: DetectionSettings) -> Detection | None:
    """Return the objects on one table, or None if the plane is not a table."""
    from deixis.perception.detection.kernels import in_frame as in_table_frame

    table, neighbours = _neighbours(table, settings)
    points, top = table.view.points, table.top.on
    pose = table.view.pose
    few = top[:: max(1, len(top) // settings.plane.refinement_size)]
    frame = table_frame(table.plane, points[few] if len(top) else points, pose, settings)
    viewer = moved(pose.eye[None], frame)[0]
    at, heights, distance = in_table_frame(points, frame, viewer)
    view = _TableView(frame, at, heights, distance, viewer, top)
    rising = raised(view.heights, view.distance, neighbours, settings)
    least = np.maximum(settings.height, settings.heights.object_noise_ratio * rising.upper(view.distance))
    pieces = _pieces(view, table, rising, least, neighbours, cloud.colours, settings)
    found = pieces.things
    large = _large_note(view, settings)
    seen_so = missing_lines(table.view)
    if not seen_so:  # lines without depth are not holes
        on = pieces.of >= 0
        on[top] = True
        seen_so = holes(table.view, on, settings.notes)
    above = Above(view.points, rising, least, table.view.counts)
    missed = (*left_out(table.top, above, pieces, settings), *seen_so)
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    if not found.max(initial=BACKGROUND) >= 0:
        if not large and max(view.sides) < settings.scale.min_bare_table_length:
            return None
        wall = _wall_note(view, settings)
        why = ("nothing is on the table", *(large or _small_note(view, settings)), *wall, *missed)
        shows = Shows.ROOM if large or wall or _is_floor(view, settings) else Shows.TABLE
        return Detection(cloud, table.plane, view.frame, labels, np.zeros((0, 2, 3)), (), why, shows)
    there = np.flatnonzero(found >= 0)
    there = there[np.argsort(found[there], kind="stable")]
    members = np.split(view.points.take(there, axis=0), np.cumsum(np.bincount(found[there]))[:-1])
    bare = view.top[found[view.top] == BACKGROUND]
    table_seen = occupied_cells(view.points.take(bare, axis=0)[:, :2], settings.outlines.bare_cell)
    hulls = [corners_of(thing[:, :2]) for thing in members]
    rims = [
        rim_of(thing[:, :2], hull, table_seen, settings.outlines) for thing, hull in zip(members, hulls, strict=True)
    ]
    boxes = np.stack([upright_box(thing, settings.outlines, rim) for thing, rim in zip(members, rims, strict=True)])
    low = boxes[:, 0, :2]
    order = np.lexsort((low[:, 1], low[:, 0].round(2)))
    labels[table.view.places] = np.append(np.argsort(order), BACKGROUND)[found]
    oriented = tuple(oriented_box(members[k], settings.outlines, rims[k], hulls[k]) for k in order)
    sizes = odd_sizes((boxes[:, 1] - boxes[:, 0]).max(axis=1), settings.notes)
    little = _sparse_note(view, found, settings)
    notes = (*(large or little or _small_note(view, settings)), *sizes, *missed)
    shows = Shows.ROOM if large or little or _is_floor(view, settings) else Shows.TABLE
    labels = table.view.labelled(labels)
    return Detection(cloud, table.plane, view.frame, labels, boxes[order], oriented, notes, shows)


def _neighbours(table: FoundTable, settings: DetectionSettings) -> tuple[FoundTable, Neighbours]:
    """Return the table with a plausible viewpoint, and the neighbours of all points around it."""
    view = table.view
    if view.organised is not None:
        return table, neighbours_in_image(view, settings.surface)
    around = np.flatnonzero(table.top.outside <= settings.top.margin)
    points, places = view.points[around], view.places[around]
    near = neighbour_table(points, places, None, settings.surface, view.pose.eye if view.pose.known else None)
    if view.pose.known and not has_enough(near, settings.surface):
        pose = likeliest_pose(replace(view.pose, known=False), points, table.plane, settings)
        table = replace(table, view=replace(view, pose=pose))
        near = neighbour_table(points, places, None, settings.surface)
    neighbours = np.full((len(view.points), NEIGHBOURS), -1, np.int32)
    neighbours[around] = np.where(near < 0, -1, around[near])
    return table, ListedNeighbours(neighbours)


def _alone(cloud: PointCloud, view: View, settings: DetectionSettings) -> Detection:
    """Return the whole cloud as one object.

    Its up direction is the given one, else that of the image, else the z axis of the cloud; only a given one counts as
    known.
    """
    points, pose = view.points, verified_pose(view.pose, view.points, settings)
    ups = (pose.upwards, pose.up, np.array([0.0, 0.0, 1.0]))
    up = next(direction for direction in ups if direction is not None)
    below = Plane(up, float(np.percentile(points @ up, settings.scale.outlier_percent)))
    pose = likeliest_pose(pose, points, below, settings)
    frame = table_frame(below, points, pose, settings)
    thing = moved(points, frame)
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    labels[view.places] = 0
    labels = view.labelled(labels)
    box = upright_box(thing, settings.outlines)
    sides = " by ".join(f"{100 * side:.0f}" for side in (box[1] - box[0]).tolist())
    notes = [f"no table was found: the whole cloud, {sides} cm, was taken for a single object"]
    is_upright_known = pose.upwards is not None
    if not is_upright_known:
        notes.append("its upright direction is unknown; give it with --up")
    oriented = (oriented_box(thing, settings.outlines),)
    return Detection(cloud, None, frame, labels, box[None], oriented, tuple(notes), Shows.OBJECT, is_upright_known)


@dataclass(frozen=True, eq=False)
class _TableView:
    """Finite points in the frame of the table, with their heights and distances from the sensor at ``eye``."""

    frame: NDArray[np.float64]  # (4, 4)
    points: NDArray[np.float64]  # (n, 3)
    heights: NDArray[np.float64]  # (n,)
    distance: NDArray[np.float64]  # (n,)
    eye: NDArray[np.float64]  # (3,)
    top: NDArray[np.intp]  # (m,) points of the connected part that is the table

    @cached_property
    def sides(self) -> tuple[float, float]:
        """Width and depth of the table as the viewer sees it, in metres."""
        few = self.top[:: max(1, len(self.top) // 10_000)]
        across, deep = np.ptp(self.points.take(few, axis=0), axis=0)[:2].tolist() if len(few) else (0.0, 0.0)
        return across, deep


def _small_note(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note if the table is implausibly small."""
    across, deep = view.sides
    if max(across, deep) >= settings.scale.min_table_length:
        return ()
    size = f"{100 * across:.0f} by {100 * deep:.0f} cm"
    return (f"the detected table is only {size}; it may be a part of a single object",)


def _large_note(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note if the points level with the table reach implausibly far; they need not be connected."""
    level = np.flatnonzero(np.abs(view.heights) < settings.plane.table_band)
    level = level[:: max(1, len(level) // 10_000)]
    if not len(level):
        return ()
    across, deep = np.subtract(*percentiles(view.points.take(level, axis=0)[:, :2], (95, 5))).tolist()
    if max(across, deep) <= settings.scale.max_table_length:
        return ()
    return (f"the detected table is {across:.0f} by {deep:.0f} m; coordinates must be metres: check the unit",)


def _wall_note(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note if more points are far above the table than on it."""
    above = (view.heights > settings.reach).sum()
    if above <= (np.abs(view.heights) < settings.plane.table_band).sum():
        return ()
    rise = f"{100 * settings.reach:.0f} cm"
    return (f"most points are more than {rise} above the detected table; it may be a wall",)


def _sparse_note(view: _TableView, found: NDArray[np.int32], settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note if few points are on the table or on its objects (n,)."""
    share = (len(view.top) + (found >= 0).sum()) / len(found)
    if share >= settings.scale.min_table_share:
        return ()
    return (
        f"only {share:.0%} of the points are on the detected table or its objects; it may be a part of a wall, a floor"
        " or a person",
    )


def _is_floor(view: _TableView, settings: DetectionSettings) -> bool:
    """Return True if the detected table is as far below the sensor and as long as a floor."""
    limits = settings.scale
    return bool(view.eye[2] > limits.min_floor_drop and max(view.sides) > limits.min_floor_length)


def _pieces(
    view: _TableView,
    table: FoundTable,
    rising: Raised,
    least: NDArray[np.float64],
    neighbours: Neighbours,
    colours: NDArray[np.uint8] | None,
    settings: DetectionSettings,
) -> Pieces:
    """Return the pieces of surface above the table with their fates.

    ``least`` (n,) are the least heights of objects, and ``colours`` those of the whole cloud.
    """
    from deixis.perception.detection.kernels import corners_of_box

    of = np.full(len(view.points), BACKGROUND, np.int32)
    chosen = np.flatnonzero(rising.above)
    if not len(chosen):
        return Pieces(of, np.zeros(0, np.int8))
    sigma = rising.noise * view.distance[chosen] ** 2
    painted = None if colours is None else colours.take(table.view.places[chosen], axis=0)
    near = neighbours.among(chosen)
    image = None if table.view.organised is None else table.view.pixels
    pixels = None if image is None else (image[0][chosen], image[1][chosen])
    surface = surface_of(view.points.take(chosen, axis=0), painted, near, sigma, view.eye, settings.surface, pixels)
    found = segments(surface, settings)
    counts = np.bincount(found)
    within = np.bincount(found, table.top.is_below[chosen]) / counts
    fates = np.full(len(counts), Fate.DISCARDED, np.int8)
    fates[(counts >= settings.least_points) & (within < settings.heights.min_share_above_table)] = Fate.BESIDE
    members = np.split(np.argsort(found, kind="stable"), np.cumsum(counts)[:-1])
    for piece in np.flatnonzero((counts >= settings.least_points) & (fates == Fate.DISCARDED)).tolist():
        points = surface.points.take(members[piece], axis=0)
        rise = np.quantile(points[:, 2] / least[chosen[members[piece]]], settings.heights.object_quantile)
        if rise > 1.0 and np.ptp(corners_of_box(points), axis=0).max() >= settings.least_length:
            fates[piece] = Fate.REPORTED
    of[chosen] = found
    return Pieces(of, fates)


def segments(surface: Surface, settings: DetectionSettings) -> NDArray[np.int32]:
    """Return the object of each point of a surface, shape (n,), from 0: supervoxels are merged, then joined.

    Thin things that have another colour than the thing on which they lie are separated from it afterwards.

    Parameters
    ----------
    surface
        Surface of n points above the table.
    settings
        Thresholds of supervoxels, boundaries and joining.

    Returns
    -------
    ndarray
        Object numbers of shape (n,).
    """
    patches = supervoxels(surface, settings.supervoxels)
    meeting = boundaries(surface, patches, settings)
    regions = agglomerated(meeting, patches.tints, patches.weights, settings.boundaries)
    things = whole_things(Parts(regions, patches, meeting, settings.joining)).of[patches.of]
    return with_lying_things(surface, things, settings)


def _nothing(cloud: PointCloud, view: View, settings: DetectionSettings, why: str) -> Detection:
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    shows = Shows.ROOM if len(view.points) > 3 and is_large(view.points, settings) else Shows.NOTHING
    return Detection(cloud, None, np.eye(4), labels, np.zeros((0, 2, 3)), (), (why,), shows)
