"""A scene: what was seen at one time from one place, as boxes in a stated frame."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.colours import Rgb
from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Relations
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError, SceneError

if TYPE_CHECKING:
    from deixis.reasoning.geometry.rectangle import SceneRelations


@dataclass(frozen=True, slots=True)
class OrientedBox:
    """A box in the frame of its scene, metres. ``yaw`` is the angle from the x axis to the first of its level sides, in
    radians, counter-clockwise as seen from above; ``extents`` are that side, the other level one, and the height.

    >>> knife = OrientedBox((0.3, 0.2, 0.005), np.pi / 2, (0.22, 0.02, 0.01))
    >>> knife.axes.round(3).tolist()
    [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
    """

    centre: tuple[float, float, float]
    yaw: float
    extents: tuple[float, float, float]

    def rounded(self, digits: int) -> OrientedBox:
        """Return the same to so many digits after the point."""
        x, y, z, length, width, height = (round(value, digits) for value in (*self.centre, *self.extents))
        return OrientedBox((x, y, z), round(self.yaw, digits), (length, width, height))

    @property
    def axes(self) -> NDArray[np.float64]:
        """Unit vectors (3, 3) along the extents, in rows, right-handed, the last one up."""
        return turned_axes(self.yaw)

    def to_open3d(self) -> Any:
        """Return the box as an ``open3d.geometry.OrientedBoundingBox``."""
        from deixis.perception.open3d import open3d

        return open3d().geometry.OrientedBoundingBox(np.array(self.centre), self.axes.T, np.array(self.extents))


def turned_axes(yaw: float) -> NDArray[np.float64]:
    """Return the axes (3, 3), in rows, turned about the vertical."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


CANDIDATE_ROUNDING = 1e-3
"""By how much probabilities that were rounded may add up to more than 1."""

MAX_COORDINATE = 1e9
"""Coordinates reach so far at the most, in metres or pixels."""


@dataclass(frozen=True, slots=True)
class PerceivedObject:
    """One thing that perception has singled out: an axis-aligned box, and what else is known of it.

    ``minimum`` and ``maximum`` are its least and greatest corner in the scene's frame, 2 or 3 coordinates: x to the
    viewer's right, y away from the viewer, z up; metres, unless the scene is in pixels. ``label`` is a name for it,
    right with probability ``confidence``. ``cloud`` holds its points in the scene's frame, or names their file, as seen
    from the scene's file; :meth:`Scene.cloud_of` gives the points either way. ``colour`` is the one that it is seen in,
    in sRGB. ``oriented`` is the narrowest box about it that is turned about the vertical, where there are heights.
    ``candidates`` are names with the probability of each; what is missing to 1 is the probability of any other name.
    """

    id: str
    minimum: tuple[float, ...]
    maximum: tuple[float, ...]
    label: str | None = None
    confidence: float = 1.0
    cloud: PointCloud | str | None = None
    colour: Rgb | None = None
    oriented: OrientedBox | None = None
    candidates: tuple[tuple[str, float], ...] = ()

    def to_open3d(self) -> Any:
        """Return the box as an ``open3d.geometry.AxisAlignedBoundingBox``; one without heights lies at z = 0."""
        from deixis.perception.open3d import open3d

        low, high = (np.array([*corner, 0.0][:3]) for corner in (self.minimum, self.maximum))
        return open3d().geometry.AxisAlignedBoundingBox(low, high)


class Detected(Protocol):
    """How the objects of a scene were found in a cloud: what perception's ``Detection`` says of it."""

    @property
    def cloud(self) -> PointCloud: ...
    @property
    def table(self) -> object | None: ...
    @property
    def frame(self) -> NDArray[np.float64]: ...
    @property
    def labels(self) -> NDArray[np.int32]: ...
    @property
    def notes(self) -> tuple[str, ...]: ...
    @property
    def shows(self) -> str: ...


@dataclass(frozen=True)
class Scene:
    """Perceived objects in one frame, seen from one viewpoint.

    ``unit`` is ``m``, or ``px`` for what was measured in an image; relations do not depend on it. ``detection`` says
    how the objects were found, where they were found in a cloud; neither it nor ``file`` counts in comparisons. Raises
    SceneError where two objects share an id, a corner is not finite, a box is inside out, a colour is none, or some
    boxes are flat (2-D) and others are not.
    """

    objects: tuple[PerceivedObject, ...]
    frame: str = "table"
    viewpoint: str = "chair"
    unit: str = "m"
    file: str = field(default="<scene>", compare=False)
    detection: Detected | None = field(default=None, compare=False, repr=False)
    _relations: dict[tuple[int, float], SceneRelations] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        seen: set[str] = set()
        for thing in self.objects:
            if thing.id in seen:
                raise SceneError(f"{self.file}: the id '{thing.id}' is used twice; give every object an id of its own")
            seen.add(thing.id)
            _require_box(thing, self.file)
        if len({len(thing.minimum) for thing in self.objects}) > 1:
            raise SceneError(f"{self.file}: some boxes have heights and some have none; give all of them 2 or 3 axes")

    @property
    def ids(self) -> tuple[str, ...]:
        return tuple(thing.id for thing in self.objects)

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """Shape (n, 2, d): least and greatest corner; d is 2 for an empty scene."""
        if not self.objects:
            return np.zeros((0, 2, 2))
        return np.array([(thing.minimum, thing.maximum) for thing in self.objects], dtype=np.float64)

    @cached_property
    def colours(self) -> NDArray[np.float64]:
        """Shape (n, 3): red, green and blue in sRGB, 0 to 255; NaN where an object's colour is not known."""
        unknown = (np.nan, np.nan, np.nan)
        seen = [unknown if thing.colour is None else thing.colour for thing in self.objects]
        return np.array(seen, dtype=np.float64).reshape(-1, 3)

    def __getitem__(self, name: str) -> PerceivedObject:
        return next(thing for thing in self.objects if thing.id == name)

    def cloud_of(self, id: str) -> PointCloud:
        """Return the points of an object, in the scene's frame; those in a file are read anew each time.

        Raises SceneError where the scene has no such object, knows no points of it, or names a file that is no cloud.
        """
        if id not in self.ids:
            raise SceneError(f"{self.file}: there is no object '{id}'; there are: {', '.join(self.ids) or 'none'}")
        cloud = self[id].cloud
        if isinstance(cloud, PointCloud):
            return cloud
        if cloud is None:
            raise SceneError(
                f"{self.file}: the object '{id}' has no cloud, so that what it looks like is not known; "
                "deixis perceive -o writes scenes with clouds"
            )
        from deixis.perception.clouds.cloud_file import read_cloud

        try:
            return read_cloud(Path(self.file).parent / cloud)
        except CloudError as error:
            raise SceneError(f"{self.file}: the cloud of '{id}': {error}") from error

    def to_open3d(self) -> list[Any]:
        """Return what ``open3d.visualization.draw_geometries`` draws: the points of each object, and a box about it.

        The box is the oriented one where the object has one, else the axis-aligned one, and bears the object's colour,
        where that is known. Raises SceneError as :meth:`cloud_of` does for a named file that cannot be read.
        """
        shapes: list[Any] = []
        for thing in self.objects:
            if thing.cloud is not None:
                shapes.append(self.cloud_of(thing.id).to_open3d())
            box = (thing if thing.oriented is None else thing.oriented).to_open3d()
            box.color = np.zeros(3) if thing.colour is None else np.array(thing.colour) / 255
            shapes.append(box)
        return shapes

    def relations(
        self, vocabulary: Relations, tolerance: float = 0.0, deadline: Deadline = Deadline.never()
    ) -> SceneRelations:
        """Return the exact relation of every ordered pair
        (:class:`deixis.reasoning.geometry.rectangle.SceneRelations`).

        It is computed by the first call for each vocabulary and tolerance (in the scene's unit), and kept. Raises
        OutOfTimeError at the ``deadline``.
        """
        key = (id(vocabulary), tolerance)
        if key not in self._relations:
            from deixis.reasoning.geometry.rectangle import scene_relations

            self._relations[key] = scene_relations(
                self.ids, self.boxes, vocabulary, tolerance=tolerance, deadline=deadline
            )
        return self._relations[key]

    def graph(self, vocabulary: Relations, tolerance: float = 0.0) -> RelationGraph:
        """Return :meth:`relations` as a complete relation graph, for export."""
        return self.relations(vocabulary, tolerance).graph()

    def without_labels(self) -> Scene:
        """Return the same scene with nothing named."""
        bare = (replace(thing, label=None, confidence=1.0, candidates=()) for thing in self.objects)
        return replace(self, objects=tuple(bare))

    def reordered(self, order: Sequence[int]) -> Scene:
        """Return the same scene with its objects listed in another order."""
        return replace(self, objects=tuple(self.objects[i] for i in order), detection=None)


def _require_box(thing: PerceivedObject, file: str) -> None:
    if any(unicodedata.category(character) == "Cc" for character in thing.id + (thing.label or "")):
        raise SceneError(f"{file}: object {thing.id!a}: its id or its label has a control character in it")
    where = f"{file}: object '{thing.id}'"
    if len(thing.minimum) != len(thing.maximum) or len(thing.minimum) not in (2, 3):
        raise SceneError(f"{where}: 'min' and 'max' must both have 2 coordinates, or both 3")
    if not np.isfinite([*thing.minimum, *thing.maximum]).all():
        raise SceneError(f"{where}: a coordinate is not finite")
    if max(map(abs, (*thing.minimum, *thing.maximum))) > MAX_COORDINATE:
        raise SceneError(f"{where}: a coordinate is beyond {MAX_COORDINATE:g}; is the unit right?")
    for axis, low, high in zip("xyz", thing.minimum, thing.maximum, strict=False):
        if low > high:
            raise SceneError(f"{where}: on {axis} its min {low:g} is above its max {high:g}; swap them")
    if thing.oriented is not None:
        numbers = (*thing.oriented.centre, thing.oriented.yaw, *thing.oriented.extents)
        if len(thing.minimum) != 3:
            raise SceneError(
                f"{where}: an oriented box has heights, and 'min' and 'max' have none; give them 3 coordinates"
            )
        if len(thing.oriented.centre) != 3 or len(thing.oriented.extents) != 3 or not np.isfinite(numbers).all():
            raise SceneError(
                f"{where}: an oriented box has a centre and extents of 3 finite numbers each, and a finite yaw"
            )
        if max(map(abs, numbers)) > MAX_COORDINATE or min(thing.oriented.extents) < 0:
            raise SceneError(
                f"{where}: an oriented box's extents are 0 or more, and nothing of it beyond {MAX_COORDINATE:g}"
            )
    if not 0 <= thing.confidence <= 1:
        raise SceneError(f"{where}: a confidence lies between 0 and 1, not at {thing.confidence:g}")
    shares = [share for _, share in thing.candidates]
    if not all(share >= 0 for share in shares) or not sum(shares) <= 1 + CANDIDATE_ROUNDING:
        raise SceneError(f"{where}: the probabilities of 'candidates' are 0 or more, and 1 together at most")
    if len({name for name, _ in thing.candidates}) < len(thing.candidates):
        raise SceneError(f"{where}: 'candidates' has a name twice")
    if thing.colour is not None and (len(thing.colour) != 3 or not all(0 <= part <= 255 for part in thing.colour)):
        raise SceneError(f"{where}: a colour is red, green and blue, each from 0 to 255, not {thing.colour}")
