"""Detection, from a cloud to the things on its table: the steps in their order."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.boundaries import agglomerated, boundaries
from deixis.perception.detection.heights import Raised, raised
from deixis.perception.detection.joining import whole_things
from deixis.perception.detection.left_out import Fate, Pieces, holes, left_out, missing_lines, odd_sizes
from deixis.perception.detection.neighbours import NEIGHBOURS, has_enough, neighbour_table
from deixis.perception.detection.outline import hull_of, occupied_cells, oriented_box, rim_of, upright_box
from deixis.perception.detection.parts import Parts
from deixis.perception.detection.plane import Plane
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.shown import Shows, is_large, is_one_object, is_small
from deixis.perception.detection.supervoxels import supervoxels
from deixis.perception.detection.surface import Surface, surface_of
from deixis.perception.detection.tables import FoundTable, tables
from deixis.perception.detection.viewpoint import View, believed, in_frame, likely, moved, outlook_of, table_frame
from deixis.perception.errors import CloudError
from deixis.perception.scene import OrientedBox, PerceivedObject, Scene

BACKGROUND = -1
"""The label of a point that belongs to no thing."""


@dataclass(frozen=True, eq=False)
class Detection:
    """What is on a table of ``cloud``. ``frame`` takes points of the cloud's frame to the table's: z up from its plane,
    x to the viewer's right, y away from the viewer.

    ``labels`` (n,) has for each point of the cloud, in its order, the number k of its thing, -1 for none. Thing k has
    ``boxes[k]``, least and greatest corner in the table's frame, shape (2, 3), ``oriented[k]``, and the id
    ``o{k + 1}``; things are numbered from left to right, and from near to far where they are equally far left.
    ``table`` is None where no table was found, ``shows`` says what the cloud shows, and ``notes`` what was not as one
    would expect. ``upright`` is false of one object alone, unless it was told which way is up: no table shows it.
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

    def scene(self, viewpoint: str = "chair", file: str = "<cloud>") -> Scene:
        """Return the things as a scene, each with its points in the table's frame; ``file`` is what errors name."""
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


def detect(cloud: PointCloud, settings: DetectionSettings | None = None) -> Detection:
    """Return a table of a cloud and the things on it; labels that a cloud bears are not looked at.

    Raises CloudError for a cloud without one finite point, or so wide or narrow that it is not in metres. A cloud
    without a table, and a table with nothing on it, give an answer that says so; so does one with another table.

    >>> x, y = (axis.ravel() for axis in np.mgrid[-0.5:0.5:0.01, 0.5:1.5:0.01])
    >>> table = np.stack([x, y, np.full(x.shape, -0.7)], axis=1)
    >>> found = detect(PointCloud(table.astype(np.float32)))
    >>> abs(found.table.normal).round(3).tolist(), found.boxes.shape, found.notes
    ([0.0, 0.0, 1.0], (0, 2, 3), ('nothing is on the table',))
    """
    settings = settings or DetectionSettings()
    kept = np.flatnonzero(cloud.finite)
    if not len(kept):
        raise CloudError("a cloud without one finite point shows nothing; is its depth image empty?")
    points = cloud.points[kept].astype(np.float64)
    few = points[:: max(1, len(points) // 10_000)]
    spread = float(np.median(np.linalg.norm(few - np.median(few, axis=0), axis=1)))
    if spread > settings.scale.max_median_radius:
        raise CloudError(
            f"half of the points are more than {spread:.0f} m from the middle, too far for a table;"
            " coordinates are metres: divide millimetres by 1000, centimetres by 100; a depth image has a depth_scale"
        )
    if len(few) > 100 and spread < settings.scale.min_median_radius:
        raise CloudError(
            f"half of the points are within {1000 * spread:.2g} mm of the middle, too near for a table;"
            " coordinates are metres: is the unit, or the depth_scale of the intrinsics, another?"
        )
    view = View(points, kept, cloud.organised, outlook_of(cloud, settings))
    if len(points) >= settings.least_points and is_small(points, settings):
        return _alone(cloud, view, settings)
    seen = list(islice(tables(view, settings), settings.table + 1))
    if len(seen) < settings.table and settings.table > 1:
        nothing = _nothing(cloud, view, settings, _no_table(settings, len(seen)))
        return replace(nothing, shows=Shows.TABLE) if len(seen) == 1 else nothing
    found = _on_table(cloud, seen[settings.table - 1], settings) if seen else None
    alone = settings.table == 1 and len(points) >= settings.least_points
    if alone and not _bears_a_thing(found, seen, settings) and is_one_object(points, settings, len(seen)):
        return _alone(cloud, view, settings)
    if found is None:
        return _nothing(cloud, view, settings, _no_table(settings, 0))
    if len(seen) > settings.table:
        return replace(found, shows=Shows.TABLES, notes=(*found.notes, _more(settings.table)))
    return found if settings.table == 1 else replace(found, shows=Shows.TABLES)


def _bears_a_thing(found: Detection | None, seen: list[FoundTable], settings: DetectionSettings) -> bool:
    """Return whether something stands on a table. A face of an object is shorter than a table; what only adjoins its
    outline may be another side of the object, and what is all around it, the object's rim."""
    if found is None:
        return False
    table = seen[0]
    top = table.top.on[:: max(1, len(table.top.on) // 2000)]
    plan = table.view.points @ table.plane.across.T
    if not len(top) or np.ptp(plan[top], axis=0).max() < settings.scale.min_table_length:
        return False
    labels = found.labels[table.view.places]
    inset = labels[table.top.outside < -settings.scale.min_inset]
    counts = np.bincount(labels[labels >= 0], minlength=len(found.boxes))
    within = np.bincount(inset[inset >= 0], minlength=len(found.boxes))
    outline = hull_of(plan[top])
    for number in np.flatnonzero(within > settings.scale.min_inset_share * counts).tolist():
        hull = hull_of(plan[labels == number])
        if hull is None or outline is None or hull.volume < settings.scale.min_rim_share * outline.volume:
            return True
    return False


def _no_table(settings: DetectionSettings, found: int) -> str:
    if found:
        return f"there is no table {settings.table}: {'one table was' if found == 1 else f'{found} tables were'} found"
    if settings.up is not None:
        return "no table was found: no large surface in view is level, within 45 degrees of what was told to be up"
    return "no table was found: no large level surface is in view"


def _more(number: int) -> str:
    return f"another table is in view, on which something stands: perceive --table {number + 1} looks at that one"


def _on_table(cloud: PointCloud, table: FoundTable, settings: DetectionSettings) -> Detection | None:
    """Return the things on one table, among the points that are of no table before it; None if it is no table."""
    from deixis.perception.detection.kernels import in_frame as in_table_frame

    table, neighbours = _neighbours(table, settings)
    points, kept, top = table.view.points, table.view.places, table.top.on
    outlook = table.view.outlook
    few = top[:: max(1, len(top) // settings.plane.refinement_size)]
    frame = table_frame(table.plane, points[few] if len(top) else points, outlook, settings.viewer)
    viewer = moved(outlook.eye[None], frame)[0]
    at, heights, distance = in_table_frame(points, frame, viewer)
    view = _TableView(frame, at, heights, distance, viewer, top)
    rising = raised(view.heights, view.distance, neighbours, settings)
    pieces = _pieces(view, table, rising, neighbours, cloud.colours, settings)
    found = pieces.things
    large = _too_large(view, settings)
    seen_so = missing_lines(table.view)
    if not seen_so:  # lines without depth are no holes
        on = pieces.of >= 0
        on[top] = True
        seen_so = holes(table.view, on, settings.notes)
    missed = (*left_out(table.top, view.heights, pieces, settings), *seen_so)
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    if not found.max(initial=BACKGROUND) >= 0:
        if not large and max(_sides(view)) < settings.scale.min_bare_table_length:
            return None
        wall = _a_wall(view, settings)
        why = ("nothing is on the table", *(large or _too_small(view, settings)), *(wall or missed))
        shows = Shows.ROOM if large or wall or _is_floor(view, settings) else Shows.TABLE
        return Detection(cloud, table.plane, view.frame, labels, np.zeros((0, 2, 3)), (), why, shows)
    there = np.flatnonzero(found >= 0)
    there = there[np.argsort(found[there], kind="stable")]
    members = np.split(view.points[there], np.cumsum(np.bincount(found[there]))[:-1])
    bare = view.top[found[view.top] == BACKGROUND]
    table_seen = occupied_cells(view.points[bare, :2], settings.outlines.bare_cell)
    rims = [rim_of(thing[:, :2], table_seen, settings.outlines) for thing in members]
    boxes = np.stack([upright_box(thing, settings.outlines, rim) for thing, rim in zip(members, rims, strict=True)])
    low = boxes[:, 0, :2]
    order = np.lexsort((low[:, 1], low[:, 0].round(2)))
    labels[kept] = np.append(np.argsort(order), BACKGROUND)[found]
    oriented = tuple(oriented_box(members[k], settings.outlines, rims[k]) for k in order)
    sizes = odd_sizes((boxes[:, 1] - boxes[:, 0]).max(axis=1), settings.notes)
    little = _too_little(view, found, settings)
    notes = (*(large or little or _too_small(view, settings)), *sizes, *missed)
    shows = Shows.ROOM if large or little or _is_floor(view, settings) else Shows.TABLE
    return Detection(cloud, table.plane, view.frame, labels, boxes[order], oriented, notes, shows)


def _neighbours(table: FoundTable, settings: DetectionSettings) -> tuple[FoundTable, NDArray[np.int32]]:
    """Return the neighbours of all points around a table (n, 8), and the table, as seen from where it can be seen."""
    view = table.view
    if view.organised is not None:
        return table, neighbour_table(view.points, view.places, view.organised, settings.surface)
    around = np.flatnonzero(table.top.outside <= settings.top.margin)
    points, places = view.points[around], view.places[around]
    near = neighbour_table(points, places, None, settings.surface, view.outlook.eye if view.outlook.known else None)
    if view.outlook.known and not has_enough(near, settings.surface):
        outlook = likely(replace(view.outlook, known=False), points, table.plane, settings)
        table = replace(table, view=replace(view, outlook=outlook))
        near = neighbour_table(points, places, None, settings.surface)
    neighbours = np.full((len(view.points), NEIGHBOURS), -1, np.int32)
    neighbours[around] = np.where(near < 0, -1, around[near])
    return table, neighbours


def _alone(cloud: PointCloud, view: View, settings: DetectionSettings) -> Detection:
    """Return one thing, all that is seen: upright as told, else as the image, else as the cloud.

    Only what was told is relied on: else which way up it stands is not known.
    """
    points, outlook = view.points, believed(view.outlook, view.points, settings)
    ups = (outlook.upwards, outlook.up, np.array([0.0, 0.0, 1.0]))
    up = next(direction for direction in ups if direction is not None)
    below = Plane(up, float(np.percentile(points @ up, settings.scale.outlier_percent)))
    outlook = likely(outlook, points, below, settings)
    frame = table_frame(below, points, outlook, settings.viewer)
    thing = moved(points, frame)
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    labels[view.places] = 0
    box = upright_box(thing, settings.outlines)
    sides = " by ".join(f"{100 * side:.0f}" for side in (box[1] - box[0]).tolist())
    notes = [f"no table was found: all there is, {sides} cm, was taken for one thing seen alone"]
    told = outlook.upwards is not None
    if not told:
        notes.append("which way up it stands is not known: --up tells it")
    oriented = (oriented_box(thing, settings.outlines),)
    return Detection(cloud, None, frame, labels, box[None], oriented, tuple(notes), Shows.OBJECT, told)


@dataclass(frozen=True, eq=False)
class _TableView:
    """The finite points in the table's frame, how far from the sensor they are and where it stands, and the table's."""

    frame: NDArray[np.float64]  # (4, 4)
    points: NDArray[np.float64]  # (n, 3)
    heights: NDArray[np.float64]  # (n,)
    distance: NDArray[np.float64]  # (n,)
    eye: NDArray[np.float64]  # (3,)
    top: NDArray[np.intp]  # (m,) the points of the connected piece that is the table


def _too_small(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note where the table is too small for one."""
    across, deep = _sides(view)
    if max(across, deep) >= settings.scale.min_table_length:
        return ()
    size = f"{100 * across:.0f} by {100 * deep:.0f} cm"
    return (f"what was taken for the table is only {size}: it may be a part of a thing seen alone",)


def _too_large(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note where no table is so large: what is level with it is looked at, as points far apart are no one
    piece."""
    level = np.flatnonzero(np.abs(view.heights) < settings.plane.table_band)
    level = level[:: max(1, len(level) // 10_000)]
    if not len(level):
        return ()
    across, deep = np.subtract(*np.percentile(view.points[level, :2], (95, 5), axis=0)).tolist()
    if max(across, deep) <= settings.scale.max_table_length:
        return ()
    return (
        f"what was taken for the table is {across:.0f} by {deep:.0f} m: coordinates are metres; is the unit another?",
    )


def _sides(view: _TableView) -> tuple[float, float]:
    """Return how far the table reaches across and away, in metres."""
    few = view.top[:: max(1, len(view.top) // 10_000)]
    across, deep = np.ptp(view.points[few, :2], axis=0).tolist() if len(few) else (0.0, 0.0)
    return across, deep


def _a_wall(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note where more is far above the table than on it."""
    above = (view.heights > settings.reach).sum()
    if above <= (np.abs(view.heights) < settings.plane.table_band).sum():
        return ()
    rise = f"{100 * settings.reach:.0f} cm"
    return (f"most of what is seen is more than {rise} above what was taken for the table: it may be a wall",)


def _too_little(view: _TableView, found: NDArray[np.int32], settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note where hardly anything of what is seen is on the table, or of a thing (n,) that stands there."""
    share = (len(view.top) + (found >= 0).sum()) / len(found)
    if share >= settings.scale.min_table_share:
        return ()
    return (
        f"only {share:.0%} of what is seen is on what was taken for the table or stands there: it may be a part of a"
        " wall, a floor or a person",
    )


def _is_floor(view: _TableView, settings: DetectionSettings) -> bool:
    """Return whether what was taken for the table lies so far below the sensor, and is so long, as floors are."""
    limits = settings.scale
    return bool(view.eye[2] > limits.min_floor_drop and max(_sides(view)) > limits.min_floor_length)


def _pieces(
    view: _TableView,
    table: FoundTable,
    rising: Raised,
    neighbours: NDArray[np.int32],
    colours: NDArray[np.uint8] | None,
    settings: DetectionSettings,
) -> Pieces:
    """Return the pieces of surface above the table, and which of them are things; ``colours`` are those of the whole
    cloud."""
    from deixis.perception.detection.kernels import renumbered

    of = np.full(len(view.points), BACKGROUND, np.int32)
    chosen = np.flatnonzero(rising.above)
    if not len(chosen):
        return Pieces(of, np.zeros(0, np.int8))
    number = np.full(len(view.points), BACKGROUND, np.int32)
    number[chosen] = np.arange(len(chosen))
    sigma = rising.noise * view.distance[chosen] ** 2
    painted = None if colours is None else colours[table.view.places[chosen]]
    near = renumbered(neighbours, chosen, number)
    surface = surface_of(view.points[chosen], painted, near, sigma, view.eye, settings.surface)
    found = segments(surface, settings)
    counts = np.bincount(found)
    within = np.bincount(found, table.top.is_below[chosen]) / counts
    least = np.maximum(settings.height, settings.heights.object_noise_ratio * rising.upper(view.distance[chosen]))
    fates = np.full(len(counts), Fate.DISCARDED, np.int8)
    fates[(counts >= settings.least_points) & (within < settings.heights.min_share_above_table)] = Fate.BESIDE
    for piece in np.flatnonzero((counts >= settings.least_points) & (fates == Fate.DISCARDED)).tolist():
        points = surface.points[found == piece]
        rise = np.quantile(points[:, 2] / least[found == piece], settings.heights.object_quantile)
        if rise > 1.0 and np.ptp(points, axis=0).max() >= settings.least_length:
            fates[piece] = Fate.REPORTED
    of[chosen] = found
    return Pieces(of, fates)


def segments(surface: Surface, settings: DetectionSettings) -> NDArray[np.int32]:
    """Return the number of its thing for each point of the surface (n,), from 0: supervoxels, merged, then joined."""
    patches = supervoxels(surface, settings.supervoxels)
    meeting = boundaries(surface, patches, settings)
    regions = agglomerated(meeting, patches.tints, patches.weights, settings.boundaries)
    return whole_things(Parts(regions, patches, meeting, settings.joining)).of[patches.of]


def _nothing(cloud: PointCloud, view: View, settings: DetectionSettings, why: str) -> Detection:
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    shows = Shows.ROOM if len(view.points) > 3 and is_large(view.points, settings) else Shows.NOTHING
    return Detection(cloud, None, np.eye(4), labels, np.zeros((0, 2, 3)), (), (why,), shows)
