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
from deixis.perception.detection.neighbours import neighbour_table
from deixis.perception.detection.outline import above_outline, in_largest_piece, oriented_box, rim_of, upright_box
from deixis.perception.detection.parts import Parts
from deixis.perception.detection.plane import Outlook, Plane
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.supervoxels import supervoxels
from deixis.perception.detection.surface import Surface, surface_of
from deixis.perception.detection.tables import FoundTable, tables
from deixis.perception.detection.viewpoint import believed, in_frame, likely, moved, outlook_of, table_frame
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
    ``table`` is None where no table was found, and ``notes`` say what was not as one would expect.
    """

    cloud: PointCloud
    table: Plane | None
    frame: NDArray[np.float64]  # (4, 4)
    labels: NDArray[np.int32]  # (n,)
    boxes: NDArray[np.float64]  # (k, 2, 3)
    oriented: tuple[OrientedBox, ...]
    notes: tuple[str, ...] = ()

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
        return Scene(tuple(things), viewpoint=viewpoint, file=file, detection=self)


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
    outlook = believed(outlook_of(cloud, settings), points, settings)
    if len(points) >= settings.least_points and _is_alone(points, settings):
        return _alone(cloud, kept, points, outlook, settings)
    seen = list(islice(tables(points, outlook, settings), settings.table + 1))
    if len(seen) < settings.table:
        return _nothing(cloud, None, np.eye(4), _no_table(settings, len(seen)))
    table = seen[settings.table - 1]
    found = _on_table(cloud, kept[table.points], points[table.points], table, settings)
    return found if len(seen) == settings.table else replace(found, notes=(*found.notes, _more(settings.table)))


def _no_table(settings: DetectionSettings, found: int) -> str:
    if found:
        return f"there is no table {settings.table}: {'one table was' if found == 1 else f'{found} tables were'} found"
    if settings.up is not None:
        return "no table was found: no large surface in view is level, within 45 degrees of what was told to be up"
    return "no table was found: no large level surface is in view"


def _more(number: int) -> str:
    return f"another table is in view, on which something stands: perceive --table {number + 1} looks at that one"


def _on_table(
    cloud: PointCloud,
    kept: NDArray[np.intp],
    points: NDArray[np.float64],
    table: FoundTable,
    settings: DetectionSettings,
) -> Detection:
    """Return the things on one table, among the points (n, 3) of those numbers in the cloud."""
    level = np.flatnonzero(np.abs(table.plane.heights(points)) < settings.plane.table_band)
    top = level[in_largest_piece(points[level] @ table.plane.across.T, settings.outlines.table_cell)]
    frame = table_frame(table.plane, points[top] if len(top) else points, table.outlook, settings.viewer)
    viewer = moved(table.outlook.eye[None], frame)[0]
    at = np.ascontiguousarray(moved(points, frame))
    view = _TableView(frame, at, np.linalg.norm(at - viewer, axis=1), viewer, top)
    eye = table.outlook.eye if table.outlook.known else None
    neighbours = neighbour_table(points, kept, cloud.organised, settings.surface, eye)
    rising = raised(view.heights, view.distance, neighbours, settings)
    colours = None if cloud.colours is None else cloud.colours[kept]
    found = _things(view, rising, neighbours, colours, settings)
    large = _too_large(view, settings)
    if not found.max(initial=BACKGROUND) >= 0:
        if not large and max(_sides(view)) < settings.scale.min_bare_table_length:
            return _nothing(cloud, None, np.eye(4), _no_table(settings, 0))
        why = ("nothing is on the table", *(large or _too_small(view, settings)), *_a_wall(view, settings))
        return _nothing(cloud, table.plane, view.frame, *why)
    members = [view.points[found == k] for k in range(int(found.max()) + 1)]
    table_seen = view.points[(np.abs(view.heights) < settings.plane.table_band) & (found == BACKGROUND), :2]
    rims = [rim_of(thing[:, :2], table_seen, settings.outlines) for thing in members]
    boxes = np.stack([upright_box(thing, settings.outlines, rim) for thing, rim in zip(members, rims, strict=True)])
    low = boxes[:, 0, :2]
    order = np.lexsort((low[:, 1], low[:, 0].round(2)))
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    labels[kept] = np.append(np.argsort(order), BACKGROUND)[found]
    oriented = tuple(oriented_box(members[k], settings.outlines, rims[k]) for k in order)
    notes = large or _too_small(view, settings)
    return Detection(cloud, table.plane, view.frame, labels, boxes[order], oriented, notes)


def _is_alone(points: NDArray[np.float64], settings: DetectionSettings) -> bool:
    """Return whether all there is, but for a few points, is as small as a thing."""
    axes = np.linalg.svd(np.cov(points.T))[0]
    limits = settings.scale
    outliers = (limits.outlier_percent, 100 - limits.outlier_percent)
    low, high = np.percentile(points @ axes, outliers, axis=0)
    _, middle, longest = np.sort(high - low).tolist()
    return bool(settings.least_length <= longest < limits.max_single_object_length and middle < limits.min_table_length)


def _alone(
    cloud: PointCloud,
    kept: NDArray[np.intp],
    points: NDArray[np.float64],
    outlook: Outlook,
    settings: DetectionSettings,
) -> Detection:
    """Return one thing, all that is seen, as if it stood on a table: upright as told, else as the image, else as the
    cloud."""
    ups = (outlook.upwards, outlook.up, np.array([0.0, 0.0, 1.0]))
    up = next(direction for direction in ups if direction is not None)
    below = Plane(up, float(np.percentile(points @ up, settings.scale.outlier_percent)))
    outlook = likely(outlook, points, below, settings)
    frame = table_frame(below, points, outlook, settings.viewer)
    thing = moved(points, frame)
    labels = np.full(len(cloud), BACKGROUND, np.int32)
    labels[kept] = 0
    box = upright_box(thing, settings.outlines)
    sides = " by ".join(f"{100 * side:.0f}" for side in (box[1] - box[0]).tolist())
    note = f"no table was found: all there is, {sides} cm, was taken for one thing seen alone"
    return Detection(cloud, None, frame, labels, box[None], (oriented_box(thing, settings.outlines),), (note,))


@dataclass(frozen=True, eq=False)
class _TableView:
    """The finite points in the table's frame, how far from the sensor they are and where it stands, and the table's."""

    frame: NDArray[np.float64]  # (4, 4)
    points: NDArray[np.float64]  # (n, 3)
    distance: NDArray[np.float64]  # (n,)
    eye: NDArray[np.float64]  # (3,)
    top: NDArray[np.intp]  # (m,) the points of the connected piece that is the table

    @property
    def heights(self) -> NDArray[np.float64]:
        return np.ascontiguousarray(self.points[:, 2])


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
    level = view.points[np.abs(view.heights) < settings.plane.table_band, :2]
    level = level[:: max(1, len(level) // 10_000)]
    if not len(level):
        return ()
    across, deep = np.subtract(*np.percentile(level, (95, 5), axis=0)).tolist()
    if max(across, deep) <= settings.scale.max_table_length:
        return ()
    return (
        f"what was taken for the table is {across:.0f} by {deep:.0f} m: coordinates are metres; is the unit another?",
    )


def _sides(view: _TableView) -> tuple[float, float]:
    """Return how far the table reaches across and away, in metres."""
    across, deep = np.ptp(view.points[view.top, :2], axis=0).tolist() if len(view.top) else (0.0, 0.0)
    return across, deep


def _a_wall(view: _TableView, settings: DetectionSettings) -> tuple[str, ...]:
    """Return a note where more is far above the table than on it."""
    above = (view.heights > settings.reach).sum()
    if above <= (np.abs(view.heights) < settings.plane.table_band).sum():
        return ()
    rise = f"{100 * settings.reach:.0f} cm"
    return (f"most of what is seen is more than {rise} above what was taken for the table: it may be a wall",)


def _things(
    view: _TableView,
    rising: Raised,
    neighbours: NDArray[np.int32],
    colours: NDArray[np.uint8] | None,
    settings: DetectionSettings,
) -> NDArray[np.int32]:
    """Return the number of its thing for each point (n,), in no particular order, -1 for none."""
    found = np.full(len(view.points), BACKGROUND, np.int32)
    chosen = np.flatnonzero(rising.above)
    if not len(chosen):
        return found
    number = np.full(len(view.points) + 1, BACKGROUND, np.int32)
    number[chosen] = np.arange(len(chosen))
    sigma = rising.noise * view.distance[chosen] ** 2
    painted = None if colours is None else colours[chosen]
    surface = surface_of(view.points[chosen], painted, number[neighbours[chosen]], sigma, view.eye, settings.surface)
    pieces = segments(surface, settings)
    table = view.points[np.abs(view.heights) < settings.plane.table_band]
    within = above_outline(table, surface.points, settings.outlines)
    least = np.maximum(settings.height, settings.heights.object_noise_ratio * rising.upper(view.distance[chosen]))
    result = np.full(len(pieces), BACKGROUND, np.int32)
    n = 0
    for piece in range(int(pieces.max()) + 1):
        of = pieces == piece
        if of.sum() < settings.least_points or within[of].mean() < settings.heights.min_share_above_table:
            continue
        rise = np.quantile(surface.points[of, 2] / least[of], settings.heights.object_quantile)
        if rise > 1.0 and np.ptp(surface.points[of], axis=0).max() >= settings.least_length:
            result[of] = n
            n += 1
    found[chosen] = result
    return found


def segments(surface: Surface, settings: DetectionSettings) -> NDArray[np.int32]:
    """Return the number of its thing for each point of the surface (n,), from 0: supervoxels, merged, then joined."""
    patches = supervoxels(surface, settings.supervoxels)
    meeting = boundaries(surface, patches, settings)
    regions = agglomerated(meeting, patches.tints, patches.weights, settings.boundaries)
    return whole_things(Parts(regions, patches, meeting, settings.joining)).of[patches.of]


def _nothing(cloud: PointCloud, plane: Plane | None, frame: NDArray[np.float64], *why: str) -> Detection:
    return Detection(cloud, plane, frame, np.full(len(cloud), BACKGROUND, np.int32), np.zeros((0, 2, 3)), (), why)
