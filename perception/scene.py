"""Scenes: objects that were seen at one time from one place, as boxes in a known frame."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments, require_fields
from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Relations
from deixis.ontology.things.colours import Rgb
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import CloudError, SceneError
from deixis.perception.oriented_box import OrientedBox

if TYPE_CHECKING:
    from deixis.reasoning.geometry.poses import Poses
    from deixis.reasoning.geometry.rectangle import SceneRelations
    from deixis.reasoning.grounding.reference.features.room import Room

UNITS_OF_LENGTH = {"m": 1.0, "cm": 0.01, "mm": 0.001}
"""Units of length, in metres."""

UNITS = {**UNITS_OF_LENGTH, "px": 1.0}
"""Accepted units of a scene with their lengths in metres; pixels stay pixels."""

UNNAMED = "<scene>"
"""Name in messages of a scene without a file."""


CANDIDATE_ROUNDING = 1e-3
"""Tolerance by which the sum of rounded probabilities may exceed 1."""

MAX_COORDINATE = 1e9
"""Maximum absolute value of a coordinate, in metres or pixels."""

DEFAULT_VIEWPOINT = "chair"
"""Viewpoint of a scene that states none."""

UNKNOWN_VIEWPOINT = "unknown"
"""Viewpoint of a scene whose x axis does not point to the right of any viewer."""

PLACED_VIEWER = "viewer"
"""Viewpoint of a scene that says where its viewer stands."""


@dataclass(frozen=True, slots=True)
class Heading:
    """Direction in which a part of a thing points, as measured in its cloud.

    Parameters
    ----------
    part
        ``head`` for the end of a long thing away from its handle (tines, bowl, blade), or ``handle`` for the handle of
        a round thing.
    direction
        Horizontal direction (x, y), of any length except 0.
    probability
        Probability that the direction is right, rather than the opposite one or none.
    """

    part: str
    direction: tuple[float, float]
    probability: float = 1.0


HEADING_PARTS = ("head", "handle")
"""Parts that a heading may be measured by."""

MIN_FRONT_PROBABILITY = 0.95
"""Minimum probability at which a measured heading counts: a handle as the front of its thing, a head as what points."""


@dataclass(frozen=True, slots=True)
class PerceivedObject:
    """Object of a scene: an axis-aligned box with an optional label, colour and point cloud.

    Parameters
    ----------
    id
        Name of the object, unique in its scene.
    minimum, maximum
        Lower and upper corner in the frame of the scene, 2 or 3 coordinates: x to the viewer's right, y away from the
        viewer, z up; in metres, unless the scene is in pixels.
    label
        Category of the object, or None.
    confidence
        Probability that the label is right.
    cloud
        Points of the object in the frame of the scene, or the path of their file relative to the file of the scene;
        :meth:`Scene.cloud_of` returns the points either way.
    colour
        Perceived colour in sRGB, or None.
    oriented
        Smallest box around the object that is turned about the vertical, if the scene has heights.
    candidates
        Categories with their probabilities; the rest to 1 is the probability of any other category.
    front
        Horizontal direction (x, y) in which the front of the object points, such as from the back of a chair over its
        seat, of any length except 0; None if the object has no front or it is unknown.
    heading
        Direction of its head or handle, as measured in its cloud; None if it has neither or it is unknown. A handle is
        the front of a thing without another one.

    Examples
    --------
    >>> import deixis
    >>> scene = deixis.read_scene({"objects": [{"id": "o1", "label": "fork", "min": [0, 0], "max": [0.03, 0.2]}]})
    >>> scene.objects[0].id, scene.objects[0].label
    ('o1', 'fork')
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
    front: tuple[float, float] | None = None
    heading: Heading | None = None

    def to_open3d(self) -> Any:
        """Return the axis-aligned box for Open3D.

        Returns
        -------
        open3d.geometry.AxisAlignedBoundingBox
            The box; one without heights lies at z = 0.

        Raises
        ------
        MissingExtraError
            If Open3D is not installed.

        Examples
        --------
        >>> PerceivedObject("o1", (0.0, 0.0, 0.0), (0.2, 0.1, 0.1)).to_open3d().get_extent().tolist()
        [0.2, 0.1, 0.1]
        """
        from deixis.perception.open3d import open3d

        low, high = (np.array([*corner, 0.0][:3]) for corner in (self.minimum, self.maximum))
        return open3d().geometry.AxisAlignedBoundingBox(low, high)


class Detected(Protocol):
    """Result of detecting the objects of a scene in a cloud; the ``Detection`` of perception implements it."""

    @property
    def cloud(self) -> PointCloud:
        """Cloud in which the objects were detected."""
        ...

    @property
    def table(self) -> object | None:
        """Plane of the table, or None."""
        ...

    @property
    def frame(self) -> NDArray[np.float64]:
        """Transform from the frame of the cloud to that of the table, shape (4, 4)."""
        ...

    @property
    def labels(self) -> NDArray[np.int32]:
        """Index of the object of each point, shape (n,); -1 for none."""
        ...

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings about the detection."""
        ...

    @property
    def shows(self) -> str:
        """Kind of the cloud, such as ``table`` or ``object``."""
        ...


@dataclass(frozen=True, repr=False)
class Scene(Answer):
    """Perceived objects in one frame, seen from one viewpoint.

    Parameters
    ----------
    objects
        Objects with unique ids, all with 2-D boxes or all with 3-D boxes.
    frame
        Name of the frame of the coordinates.
    viewpoint
        Name of the side from which left and right are seen; ``unknown`` (:data:`UNKNOWN_VIEWPOINT`) if the axes of the
        scene do not follow a viewer, as in a room that was scanned from many sides.
    unit
        ``m``, or ``px`` for boxes in an image; relations do not depend on it.
    file
        Name of the file for error messages; it does not count in comparisons.
    detection
        Result of the detection, if the objects were detected in a cloud; it does not count in comparisons.
    speaker, addressee
        Places (x, y) of those who talk about the scene, *me* and *you*; None if they are unknown.
    viewer
        Place (x, y) of the viewer, who looks at the middle of the scene; None if y points away from the viewer. The
        viewpoint is then called :data:`PLACED_VIEWER`.

    Raises
    ------
    SceneError
        If the unit is another one, the viewer stands in the middle of the scene, two objects share an id, a corner is
        not finite, a lower corner is above the upper one, a colour or a confidence is out of range, a front has no
        direction, or 2-D and 3-D boxes are mixed.

    Examples
    --------
    >>> import deixis
    >>> scene = deixis.read_scene({"objects": [{"id": "o1", "label": "fork", "min": [0, 0], "max": [0.03, 0.2]}]})
    >>> scene.ids, scene.unit, scene.viewpoint
    (('o1',), 'm', 'chair')
    >>> scene.boxes.tolist(), scene.summary()
    ([[[0.0, 0.0], [0.03, 0.2]]], '1 object, 1 labelled, 2-D boxes in m, seen from the chair')
    >>> scene.without_labels()["o1"].label is None
    True

    Properties of all objects are arrays, with NaN for what is unknown:

    >>> lying = OrientedBox((0.1, 0.1, 0.05), 0.5, (0.2, 0.1, 0.1))
    >>> chair = PerceivedObject("o1", (0, 0, 0), (0.2, 0.2, 0.1), colour=(255, 0, 0), front=(0, -2), oriented=lying)
    >>> spoon = PerceivedObject("o2", (0.5, 0.0, 0.0), (0.7, 0.1, 0.1), heading=Heading("head", (3.0, 0.0)))
    >>> scene = Scene((chair, spoon))
    >>> scene.colours.tolist(), scene.fronts.tolist(), scene.heads.tolist()
    ([[255.0, 0.0, 0.0], [nan, nan, nan]], [[0.0, -1.0], [nan, nan]], [[nan, nan], [1.0, 0.0]])
    >>> scene.poses.axes.shape, scene.room.ids
    ((2, 2), ('o1', 'o2'))
    """

    objects: tuple[PerceivedObject, ...]
    frame: str = "table"
    viewpoint: str = DEFAULT_VIEWPOINT
    unit: str = "m"
    file: str = field(default=UNNAMED, compare=False)
    detection: Detected | None = field(default=None, compare=False, repr=False)
    speaker: tuple[float, float] | None = None
    addressee: tuple[float, float] | None = None
    viewer: tuple[float, float] | None = None
    _relations: dict[tuple[int, float], SceneRelations] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        require_fields(self, unless=("objects", "_relations"))
        if not isinstance(self.objects, tuple | list) or not all(
            isinstance(one, PerceivedObject) for one in self.objects
        ):
            require_fields(self)
        seen: set[str] = set()
        for thing in self.objects:
            if thing.id in seen:
                raise SceneError(f"{self.file}: the id '{thing.id}' is used twice; give each object its own id")
            seen.add(thing.id)
            try:
                _require_box(thing, self.file)
            except (TypeError, ValueError, AttributeError, OverflowError) as error:
                if not isinstance(error, SceneError):  # find out which field has another type
                    require_fields(thing)
                    if thing.oriented is not None:
                        require_fields(thing.oriented)
                raise
        if self.unit not in ("m", "px"):
            raise SceneError(
                f"{self.file}: `unit` of a Scene must be 'm' or 'px', got '{self.unit}'; convert the boxes"
            )
        if self.viewer is not None and self.objects and not any(self._sight):
            raise SceneError(
                f"{self.file}: 'viewpoint': the viewer must stand beside the middle of the scene, got"
                f' [{self.viewer[0]:g}, {self.viewer[1]:g}]; move the viewer or write "unknown"'
            )
        if len({len(thing.minimum) for thing in self.objects}) > 1:
            raise SceneError(f"{self.file}: some boxes have heights and others do not; give all of them 2 or 3 axes")

    @classmethod
    @checks_arguments
    def from_boxes(
        cls,
        min: ArrayLike | None = None,
        max: ArrayLike | None = None,
        *,
        centre: ArrayLike | None = None,
        size: ArrayLike | None = None,
        yaw: ArrayLike | float | None = None,
        ids: Sequence[str | int] | None = None,
        labels: Sequence[str | None] | None = None,
        confidences: Sequence[float] | None = None,
        frame: str = "table",
        viewpoint: str = DEFAULT_VIEWPOINT,
        unit: str = "m",
    ) -> Scene:
        """Return a scene of boxes in arrays.

        Parameters
        ----------
        min, max
            Lower and upper corners, arrays of shape (n, 2) or (n, 3): x to the viewer's right, y away, z up.
        centre, size, yaw
            Instead of corners: centres and side lengths, arrays of shape (n, 2) or (n, 3), and optionally an angle for
            each box (or one for all), in radians, counter-clockwise from the x axis to its first side. With ``yaw`` the
            scene has the axis-aligned boxes around the turned ones, and keeps the turned ones if there are heights.
        ids
            Names of the objects, strings or integers; ``o1``, ``o2``, … without them.
        labels, confidences
            Label of each object or None, and the probability that the label is right.
        frame
            Name of the frame of the coordinates.
        viewpoint
            Name of the side from which x points right and y away; ``unknown`` if the axes have no such meaning.
        unit
            Unit of the lengths: ``m``, ``cm`` or ``mm``, which are converted to metres, or ``px`` (boxes in an image).

        Returns
        -------
        Scene
            A scene of n objects.

        Raises
        ------
        SceneError
            If shapes do not agree, a corner is not finite, two objects share an id, or the unit is unknown.

        Examples
        --------
        >>> import numpy as np
        >>> scene = Scene.from_boxes(min=np.zeros((2, 3)), max=np.full((2, 3), 0.1), ids=[4, 7])
        >>> scene.ids
        ('4', '7')
        >>> turned = Scene.from_boxes(centre=[[0, 0, 0.05]], size=[[0.2, 0.1, 0.1]], yaw=np.pi / 2)
        >>> turned.boxes[0].round(6).tolist()
        [[-0.05, -0.1, 0.0], [0.05, 0.1, 0.1]]
        """
        if unit not in UNITS:
            raise SceneError(f"`unit` must be one of {', '.join(UNITS)}, got '{unit}'")
        low, high, oriented = _corners(min, max, centre, size, yaw, UNITS[unit])
        n = len(low)
        names = [f"o{i + 1}" for i in range(n)] if ids is None else [str(name) for name in ids]
        given = {"ids": names, "labels": labels, "confidences": confidences}
        for what, values in given.items():
            if values is not None and len(values) != n:
                raise SceneError(f"`{what}` must have one entry for each of the {n} boxes, got {len(values)}")
        things = [
            PerceivedObject(
                id=names[i],
                minimum=tuple(low[i].tolist()),
                maximum=tuple(high[i].tolist()),
                label=None if labels is None else labels[i],
                confidence=1.0 if confidences is None else float(confidences[i]),
                oriented=oriented[i] if oriented else None,
            )
            for i in range(n)
        ]
        return cls(tuple(things), frame=frame, viewpoint=viewpoint, unit="px" if unit == "px" else "m")

    @classmethod
    @checks_arguments
    def from_open3d(
        cls,
        boxes: Iterable[Any],
        *,
        ids: Sequence[str | int] | None = None,
        labels: Sequence[str | None] | None = None,
        viewpoint: str = DEFAULT_VIEWPOINT,
    ) -> Scene:
        """Return a scene of Open3D bounding boxes, point clouds or meshes.

        Each object has the axis-aligned box around its shape, and the points if the shape is a point cloud.

        Parameters
        ----------
        boxes
            Geometries of Open3D.
        ids, labels
            Name of each object, and its label or None, as in :meth:`from_boxes`.
        viewpoint
            Name of the side from which x points right and y away.

        Returns
        -------
        Scene
            An object for each geometry, in metres.

        Raises
        ------
        SceneError
            If a geometry is empty, or the numbers of ids or labels do not agree.

        Examples
        --------
        >>> scene = Scene((PerceivedObject("o1", (0.0, 0.0, 0.0), (0.2, 0.1, 0.1)),))
        >>> shapes = scene.to_open3d()
        >>> Scene.from_open3d(shapes, labels=["cup"])["o1"].maximum
        (0.2, 0.1, 0.1)
        """
        from deixis.perception.open3d import open3d

        shapes, clouds = list(boxes), open3d().geometry.PointCloud
        low = np.array([np.asarray(shape.get_min_bound()) for shape in shapes]).reshape(-1, 3)
        high = np.array([np.asarray(shape.get_max_bound()) for shape in shapes]).reshape(-1, 3)
        scene = cls.from_boxes(low, high, ids=ids, labels=labels, viewpoint=viewpoint)
        things = (
            replace(thing, cloud=PointCloud.from_open3d(shape)) if isinstance(shape, clouds) else thing
            for thing, shape in zip(scene.objects, shapes, strict=True)
        )
        return replace(scene, objects=tuple(things))

    @classmethod
    @checks_arguments
    def from_coco(cls, source: str | Path | Mapping[str, Any], image: str | int | None = None) -> Scene:
        """Return the scene of one image in COCO instance annotations.

        Parameters
        ----------
        source
            File of annotations, or parsed JSON of one.
        image
            File name or id of the image, if there are several.

        Returns
        -------
        Scene
            The annotated boxes, in pixels, with y upward.

        Raises
        ------
        SceneError
            If the annotations are invalid, or the image is not among them.

        Examples
        --------
        >>> annotations = {
        ...     "images": [{"id": 1, "file_name": "table.jpg", "width": 640, "height": 480}],
        ...     "categories": [{"id": 1, "name": "cup"}],
        ...     "annotations": [{"id": 7, "image_id": 1, "category_id": 1, "bbox": [10, 20, 30, 40]}]}
        >>> Scene.from_coco(annotations)["o1"].minimum
        (10.0, 420.0)
        """
        read: Callable[..., Scene] = _format("scene_json").read_scene
        return read(source, image)

    @checks_arguments
    def to_coco(self, size: tuple[int, int] | None = None, file_name: str | None = None) -> dict[str, Any]:
        """Return the scene as COCO instance annotations of one image.

        Parameters
        ----------
        size
            Width and height of the image in pixels; None for the smallest image that holds all boxes.
        file_name
            File name of the image.

        Returns
        -------
        dict
            The annotations, with y downward; :meth:`from_coco` reads them.

        Raises
        ------
        SceneError
            If the scene is not in pixels.

        Examples
        --------
        >>> scene = Scene.from_boxes(min=[[10.0, 420.0]], max=[[40.0, 460.0]], labels=["cup"], unit="px")
        >>> scene.to_coco(size=(640, 480))["annotations"][0]["bbox"]
        [10.0, 20.0, 30.0, 40.0]
        >>> Scene.from_coco(scene.to_coco(size=(640, 480)))["o1"].minimum
        (10.0, 420.0)
        """
        write: Callable[..., dict[str, Any]] = _format("coco").scene_to_coco
        return write(self, size, file_name)

    @classmethod
    @checks_arguments
    def from_detections3d(cls, message: Any, *, viewpoint: str = DEFAULT_VIEWPOINT) -> Scene:
        """Return the scene of a ``vision_msgs/Detection3DArray``.

        Parameters
        ----------
        message
            The message, or its fields as dictionaries and lists;
            :func:`deixis.perception.formats.detections3d.scene_from_detections3d` lists the fields.
        viewpoint
            Name of the side from which x points right and y away.

        Returns
        -------
        Scene
            An object for each detection, in metres, with the probabilities of its labels.

        Raises
        ------
        SceneError
            If a field is missing or has another type.

        Examples
        --------
        >>> scene = Scene.from_boxes(min=np.zeros((1, 3)), max=np.full((1, 3), 0.1), labels=["cup"])
        >>> message = scene.to_detections3d()
        >>> sorted(message), Scene.from_detections3d(message)["o1"].label
        (['detections', 'header'], 'cup')
        """
        read: Callable[..., Scene] = _format("detections3d").scene_from_detections3d
        return read(message, viewpoint=viewpoint)

    def to_detections3d(self) -> dict[str, Any]:
        """Return the fields of a ``vision_msgs/Detection3DArray``.

        Returns
        -------
        dict
            The fields as dictionaries and lists, in metres.

        Examples
        --------
        >>> scene = Scene.from_boxes(min=np.zeros((1, 3)), max=np.full((1, 3), 0.1), labels=["cup"])
        >>> detection, = scene.to_detections3d()["detections"]
        >>> detection["bbox"]["size"]
        {'x': 0.1, 'y': 0.1, 'z': 0.1}
        """
        write: Callable[[Scene], dict[str, Any]] = _format("detections3d").scene_to_detections3d
        return write(self)

    def summary(self) -> str:
        """Return one line with the file, if there is one, the number of objects and the viewpoint.

        Examples
        --------
        >>> Scene.from_boxes(np.zeros((2, 3)), np.ones((2, 3)), labels=["cup", None]).summary()
        '2 objects, 1 labelled, 3-D boxes in m, seen from the chair'
        """
        labelled = sum(thing.label is not None for thing in self.objects)
        axes = f", {len(self.objects[0].minimum)}-D boxes in {self.unit}" if self.objects else ""
        labels = f", {labelled} labelled" if labelled else ""
        side = "from an unknown side" if self.viewpoint == UNKNOWN_VIEWPOINT else f"from the {self.viewpoint}"
        if self.viewer is not None:
            side = f"from ({self.viewer[0]:g}, {self.viewer[1]:g})"
        name = "" if self.file == UNNAMED else f"{self.file}: "
        return f"{name}{count(len(self.objects), 'object')}{labels}{axes}, seen {side}"

    @property
    def ids(self) -> tuple[str, ...]:
        """Ids of the objects, in the order of the scene.

        Examples
        --------
        >>> Scene.from_boxes(np.zeros((2, 3)), np.ones((2, 3)), ids=[4, 7]).ids
        ('4', '7')
        """
        return tuple(thing.id for thing in self.objects)

    @cached_property
    def boxes(self) -> NDArray[np.float64]:
        """Lower and upper corners of the objects, shape (n, 2, d); d is 2 for an empty scene.

        Examples
        --------
        >>> Scene.from_boxes(np.zeros((2, 3)), np.ones((2, 3))).boxes.shape
        (2, 2, 3)
        """
        if not self.objects:
            return np.zeros((0, 2, 2))
        return np.array([(thing.minimum, thing.maximum) for thing in self.objects], dtype=np.float64)

    @cached_property
    def colours(self) -> NDArray[np.float64]:
        """Red, green and blue of the objects in sRGB, 0 to 255, shape (n, 3); NaN if the colour is unknown."""
        unknown = (np.nan, np.nan, np.nan)
        seen = [unknown if thing.colour is None else thing.colour for thing in self.objects]
        return np.array(seen, dtype=np.float64).reshape(-1, 3)

    @cached_property
    def fronts(self) -> NDArray[np.float64]:
        """Unit vectors in the plane in which the fronts of the objects point, shape (n, 2); NaN where unknown.

        A handle that was measured is the front of a thing without another one.
        """
        return _unit_vectors([thing.front or _measured(thing, "handle") for thing in self.objects])

    @cached_property
    def heads(self) -> NDArray[np.float64]:
        """Unit vectors in the plane from the handles of long things to their heads, shape (n, 2); NaN where unknown."""
        return _unit_vectors([_measured(thing, "head") for thing in self.objects])

    @cached_property
    def poses(self) -> Poses | None:
        """Fronts and long axes of the objects; None if there are neither fronts nor turned boxes."""
        from deixis.reasoning.geometry.poses import Poses

        turned = [(i, thing.oriented) for i, thing in enumerate(self.objects) if thing.oriented is not None]
        if not turned and all(thing.front is None and thing.heading is None for thing in self.objects):
            return None
        places, boxes = [i for i, _ in turned], [box for _, box in turned]
        known = replace(Poses.of_boxes(self.boxes, self.fronts), heads=self.heads)
        return known.with_oriented(
            places, [box.yaw for box in boxes], [(box.extents[0], box.extents[1]) for box in boxes]
        )

    @cached_property
    def room(self) -> Room:
        """The geometry that descriptions of one object are compared with (:func:`deixis.refer`)."""
        from deixis.reasoning.grounding.reference.features.room import Room
        from deixis.reasoning.grounding.reference.query import Person

        if self.viewer is not None:
            return self.from_viewer().room
        known = {Person.SPEAKER: self.speaker, Person.ADDRESSEE: self.addressee}
        places = {person: np.array(place) for person, place in known.items() if place is not None}
        labels = [thing.label for thing in self.objects]
        viewer = self.viewpoint != UNKNOWN_VIEWPOINT
        named = [dict(thing.candidates) for thing in self.objects]
        sure = np.array([thing.confidence for thing in self.objects])
        return Room.of(self.ids, self.boxes, labels, self.colours, self.fronts, viewer, places, named, sure)

    @property
    def _sight(self) -> tuple[float, float]:
        """Direction from the viewer to the middle of the scene, not normalised."""
        low = np.min([thing.minimum[:2] for thing in self.objects], axis=0)
        high = np.max([thing.maximum[:2] for thing in self.objects], axis=0)
        x, y = (low + high) / 2 - np.array(self.viewer)
        return float(x), float(y)

    def from_viewer(self) -> Scene:
        """Return the scene turned so that y points away from a viewer whose place is known.

        Returns
        -------
        Scene
            The turned scene without a place of the viewer, or the scene itself if no place is known. Boxes are turned
            as in :func:`deixis.reasoning.geometry.turning.turned`; oriented boxes are left out.

        Examples
        --------
        >>> cup, jug = PerceivedObject("cup", (0, 0), (1, 1)), PerceivedObject("jug", (4, 0), (5, 1))
        >>> Scene((cup, jug), viewer=(9.0, 0.5)).from_viewer()["cup"].minimum
        (0.0, -1.0)
        """
        if self.viewer is None or not self.objects:
            return self
        x, y = self._sight
        angle = math.pi / 2 - math.atan2(y, x)
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        people = {
            name: None if place is None else tuple((np.array(place) @ turn).tolist())
            for name, place in (("speaker", self.speaker), ("addressee", self.addressee))
        }
        return replace(self.turned(angle), viewer=None, **people)  # type: ignore[arg-type]

    @checks_arguments
    def turned(self, angle: float, mirrored: bool = False) -> Scene:
        """Return the scene with its boxes and fronts turned about the origin.

        Parameters
        ----------
        angle
            Angle in radians, counterclockwise seen from above.
        mirrored
            Mirror the scene left to right before turning it.

        Returns
        -------
        Scene
            The scene without oriented boxes; the places of people stay.

        Examples
        --------
        >>> scene = Scene((PerceivedObject("o1", (0.0, 0.0), (2.0, 1.0)),))
        >>> scene.turned(math.pi / 2)["o1"].maximum
        (0.0, 2.0)
        """
        from deixis.reasoning.geometry.turning import turned

        if not math.isfinite(angle):
            raise SceneError(f"`angle` must be a finite number of radians, got {angle}")
        boxes = turned(self.boxes, angle, mirrored)
        cosine, sine = math.cos(angle), math.sin(angle)

        def along(way: tuple[float, float]) -> tuple[float, float]:
            x, y = -way[0] if mirrored else way[0], way[1]
            return cosine * x - sine * y, sine * x + cosine * y

        things = [
            replace(
                thing, minimum=tuple(box[0].tolist()), maximum=tuple(box[1].tolist()), oriented=None,
                front=None if thing.front is None else along(thing.front),
                heading=None if thing.heading is None else replace(
                    thing.heading, direction=along(thing.heading.direction)
                ),
            )
            for thing, box in zip(self.objects, boxes, strict=True)
        ]  # fmt: skip
        return replace(self, objects=tuple(things))

    def __getitem__(self, name: str) -> PerceivedObject:
        found = next((thing for thing in self.objects if thing.id == name), None)
        if found is None:
            raise SceneError(f"{self.file}: there is no object {name!r}; there are: {', '.join(self.ids) or 'none'}")
        return found

    @checks_arguments
    def cloud_of(self, id: str) -> PointCloud:
        """Return the points of an object in the frame of the scene; a file is read again on each call.

        Parameters
        ----------
        id
            Id of the object.

        Returns
        -------
        PointCloud
            The points of the object, in metres.

        Raises
        ------
        SceneError
            If the scene has no such object, the object has no points, or its file cannot be read.

        Examples
        --------
        >>> cup = PerceivedObject("o1", (0, 0, 0), (1, 1, 1), cloud=PointCloud(np.eye(3, dtype=np.float32)))
        >>> len(Scene((cup,)).cloud_of("o1"))
        3
        """
        cloud = self[id].cloud
        if isinstance(cloud, PointCloud):
            return cloud
        if cloud is None:
            raise SceneError(
                f"{self.file}: the object '{id}' has no cloud, so its shape is unknown; "
                "deixis perceive -o writes scenes with clouds"
            )
        from deixis.perception.clouds.cloud_file import read_cloud

        try:
            return read_cloud(Path(self.file).parent / cloud)
        except CloudError as error:
            raise SceneError(f"{self.file}: the cloud of '{id}': {error}") from error

    def to_open3d(self) -> list[Any]:
        """Return the geometries for ``open3d.visualization.draw_geometries``: each object's points and box.

        The box is the oriented one if the object has one, else the axis-aligned one, in the colour of the object (black
        if it is unknown).

        Returns
        -------
        list of open3d.geometry.Geometry3D
            Clouds and boxes, in the order of the objects.

        Raises
        ------
        SceneError
            If a cloud file cannot be read.

        Examples
        --------
        >>> scene = Scene.from_boxes(np.zeros((2, 3)), np.ones((2, 3)))
        >>> [shape.get_max_bound().tolist() for shape in scene.to_open3d()]
        [[1.0, 1.0, 1.0], [1.0, 1.0, 1.0]]
        """
        shapes: list[Any] = []
        for thing in self.objects:
            if thing.cloud is not None:
                shapes.append(self.cloud_of(thing.id).to_open3d())
            box = (thing if thing.oriented is None else thing.oriented).to_open3d()
            box.color = np.zeros(3) if thing.colour is None else np.array(thing.colour) / 255
            shapes.append(box)
        return shapes

    @checks_arguments
    def relations(
        self, vocabulary: Relations, tolerance: float = 0.0, deadline: Deadline = Deadline.never()
    ) -> SceneRelations:
        """Return the exact relation of each ordered pair of objects.

        The first call for each vocabulary and tolerance computes it; later calls return the stored result.

        Parameters
        ----------
        vocabulary
            Relations of the ontology.
        tolerance
            Overlap up to which two intervals count as touching, in the unit of the scene.
        deadline
            Time limit.

        Returns
        -------
        SceneRelations
            The exact relations as matrices of shape (n, n).

        Raises
        ------
        OutOfTimeError
            If the deadline passes.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> scene = Scene((PerceivedObject("o1", (0, 0), (1, 1)), PerceivedObject("o2", (2, 0), (3, 1))))
        >>> words = default_ontology().relations
        >>> scene.relations(words).relation(0, 1)
        <Relation exactly_left (exact)>
        >>> [str(fact) for fact in scene.graph(words).facts()]
        ['exactly_left(o1, o2)', 'exactly_right(o2, o1)']
        """
        key = (id(vocabulary), tolerance)
        if key not in self._relations:
            from deixis.reasoning.geometry.rectangle import scene_relations

            known = scene_relations(self.ids, self.boxes, vocabulary, tolerance=tolerance, deadline=deadline)
            self._relations[key] = replace(known, poses=self.poses)
        return self._relations[key]

    @checks_arguments
    def graph(self, vocabulary: Relations, tolerance: float = 0.0) -> RelationGraph:
        """Return the relations of all pairs as a complete relation graph, for export.

        Parameters
        ----------
        vocabulary
            Relations of the ontology.
        tolerance
            Overlap up to which two intervals count as touching, in the unit of the scene.

        Returns
        -------
        RelationGraph
            A graph with a node for each object and an edge for each ordered pair.

        Examples
        --------
        >>> from deixis.ontology.tbox import default_ontology
        >>> scene = Scene.from_boxes(min=[[0, 0], [2, 0]], max=[[1, 1], [3, 1]], ids=["cup", "jug"])
        >>> [str(fact) for fact in scene.graph(default_ontology().relations).facts()]
        ['exactly_left(cup, jug)', 'exactly_right(jug, cup)']
        """
        return self.relations(vocabulary, tolerance).graph()

    def without_labels(self) -> Scene:
        """Return the scene without labels and candidates.

        Returns
        -------
        Scene
            The scene; boxes, clouds and colours are kept.

        Examples
        --------
        >>> scene = Scene.from_boxes(np.zeros((1, 3)), np.ones((1, 3)), labels=["cup"])
        >>> scene.without_labels()["o1"].label is None
        True
        """
        bare = (replace(thing, label=None, confidence=1.0, candidates=()) for thing in self.objects)
        return replace(self, objects=tuple(bare))

    @checks_arguments
    def reordered(self, order: Sequence[int]) -> Scene:
        """Return the scene with its objects in another order, and without the detection.

        Parameters
        ----------
        order
            Present positions of the n objects, in their new order.

        Returns
        -------
        Scene
            The scene.

        Examples
        --------
        >>> scene = Scene((PerceivedObject("o1", (0, 0), (1, 1)), PerceivedObject("o2", (2, 0), (3, 1))))
        >>> scene.reordered([1, 0]).ids
        ('o2', 'o1')
        """
        try:
            objects = tuple(self.objects[i] for i in order)
        except IndexError as error:
            raise SceneError(f"`order` must have positions of the {len(self.objects)} objects, got {order}") from error
        return replace(self, objects=objects, detection=None)


def _format(name: str) -> Any:
    """Import a module of ``perception.formats`` by name, late, because each of them imports this module."""
    return import_module(f"deixis.perception.formats.{name}")


def _corners(
    lower: ArrayLike | None,
    upper: ArrayLike | None,
    centre: ArrayLike | None,
    size: ArrayLike | None,
    yaw: ArrayLike | float | None,
    scale: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], list[OrientedBox]]:
    """Return lower and upper corners, shape (n, 2) or (n, 3), and the oriented boxes if 3-D boxes have angles.

    All lengths are multiplied by ``scale``.
    """
    if lower is not None and upper is not None and centre is None and size is None and yaw is None:
        low, high = scale * _rows(lower, "min"), scale * _rows(upper, "max")
        if low.shape != high.shape:
            raise SceneError(f"`min` and `max` must have the same shape, got {low.shape} and {high.shape}")
        return low, high, []
    if centre is None or size is None or lower is not None or upper is not None:
        raise SceneError(
            "boxes must be given by `min` and `max`, or by `centre` and `size`, with `yaw` if they are turned"
        )
    middle, sides = scale * _rows(centre, "centre"), scale * _rows(size, "size")
    if middle.shape != sides.shape:
        raise SceneError(f"`centre` and `size` must have the same shape, got {middle.shape} and {sides.shape}")
    if (sides < 0).any():
        raise SceneError(f"`size` must be at least 0 on each axis, got {sides.min():g}")
    if yaw is None:
        return middle - sides / 2, middle + sides / 2, []
    try:
        angles = np.broadcast_to(np.asarray(yaw, dtype=np.float64), len(middle))
    except (ValueError, TypeError, OverflowError) as error:
        raise SceneError(
            f"`yaw` must be one angle, or {len(middle)}, one for each box, in radians, got {yaw!r:.40}"
        ) from error
    cosine, sine = np.abs(np.cos(angles)), np.abs(np.sin(angles))
    half = sides / 2
    half[:, 0], half[:, 1] = cosine * half[:, 0] + sine * half[:, 1], sine * half[:, 0] + cosine * half[:, 1]
    oriented = []
    if middle.shape[1] == 3:
        rows = zip(middle.tolist(), angles.tolist(), sides.tolist(), strict=True)
        oriented = [OrientedBox(tuple(c), angle, tuple(extents)) for c, angle, extents in rows]
    return middle - half, middle + half, oriented


def _rows(values: ArrayLike, what: str) -> NDArray[np.float64]:
    try:
        rows = np.array(values, dtype=np.float64)
    except (ValueError, TypeError, OverflowError) as error:
        raise SceneError(
            f"`{what}` must be an array of numbers of shape (n, 2) or (n, 3), got {values!r:.40}"
        ) from error
    if rows.size == 0:
        return rows.reshape(0, 2)
    if rows.ndim != 2 or rows.shape[1] not in (2, 3):
        raise SceneError(f"`{what}` must have shape (n, 2) or (n, 3), got {rows.shape}")
    return rows


def _measured(thing: PerceivedObject, part: str) -> tuple[float, float] | None:
    """Return the direction of a part of a thing, None unless it was measured and is probably right."""
    found = thing.heading
    known = found is not None and found.part == part and found.probability >= MIN_FRONT_PROBABILITY
    return found.direction if found is not None and known else None


def _unit_vectors(given: Sequence[tuple[float, float] | None]) -> NDArray[np.float64]:
    """Return directions as unit vectors, shape (n, 2); NaN for None."""
    directions = np.array([(np.nan, np.nan) if way is None else way for way in given], dtype=np.float64).reshape(-1, 2)
    return directions / np.hypot(directions[:, 0], directions[:, 1])[:, None]


def _require_box(thing: PerceivedObject, file: str) -> None:
    if any(unicodedata.category(character) == "Cc" for character in thing.id + (thing.label or "")):
        raise SceneError(f"{file}: object {thing.id!a}: the id or the label contains a control character; remove it")
    where = f"{file}: object '{thing.id}'"
    if len(thing.minimum) != len(thing.maximum) or len(thing.minimum) not in (2, 3):
        raise SceneError(
            f"{where}: 'min' and 'max' must both have 2 coordinates, or both 3, "
            f"got {len(thing.minimum)} and {len(thing.maximum)}"
        )
    if not np.isfinite([*thing.minimum, *thing.maximum]).all():
        raise SceneError(f"{where}: the coordinates must be finite, got {thing.minimum} and {thing.maximum}")
    if max(map(abs, (*thing.minimum, *thing.maximum))) > MAX_COORDINATE:
        raise SceneError(f"{where}: a coordinate is beyond {MAX_COORDINATE:g}; check the unit")
    for axis, low, high in zip("xyz", thing.minimum, thing.maximum, strict=False):
        if low > high:
            raise SceneError(f"{where}: on {axis} its min {low:g} is above its max {high:g}; swap them")
    if thing.oriented is not None:
        numbers = (*thing.oriented.centre, thing.oriented.yaw, *thing.oriented.extents)
        if len(thing.minimum) != 3:
            raise SceneError(f"{where}: an oriented box needs heights; give 'min' and 'max' 3 coordinates")
        if len(thing.oriented.centre) != 3 or len(thing.oriented.extents) != 3 or not np.isfinite(numbers).all():
            raise SceneError(
                f"{where}: an oriented box must have a centre and extents of 3 finite numbers each, and a finite yaw"
            )
        if max(map(abs, numbers)) > MAX_COORDINATE or min(thing.oriented.extents) < 0:
            raise SceneError(
                f"{where}: an oriented box's extents must be at least 0, and no number beyond {MAX_COORDINATE:g}"
            )
    if not 0 <= thing.confidence <= 1:
        raise SceneError(f"{where}: the confidence must be from 0 to 1, got {thing.confidence:g}")
    shares = [share for _, share in thing.candidates]
    if not all(share >= 0 for share in shares) or not sum(shares) <= 1 + CANDIDATE_ROUNDING:
        raise SceneError(
            f"{where}: the probabilities of 'candidates' must be at least 0, and their sum at most 1, got {shares}"
        )
    if len({name for name, _ in thing.candidates}) < len(thing.candidates):
        raise SceneError(
            f"{where}: 'candidates' must name each category once, got {[name for name, _ in thing.candidates]}"
        )
    if thing.colour is not None and (len(thing.colour) != 3 or not all(0 <= part <= 255 for part in thing.colour)):
        raise SceneError(f"{where}: a colour must be red, green and blue, each from 0 to 255, got {thing.colour}")
    measured = None if thing.heading is None else thing.heading.direction
    for name, way in (("front", thing.front), ("heading", measured)):
        known = way is None or (len(way) == 2 and bool(np.isfinite(way).all()))
        if not known or (way is not None and not 0 < max(map(abs, way)) <= MAX_COORDINATE):
            raise SceneError(
                f"{where}: '{name}' must be a direction of 2 finite numbers that are not both 0, got {way}"
            )
    if thing.heading is not None and thing.heading.part not in HEADING_PARTS:
        parts = " or ".join(HEADING_PARTS)
        raise SceneError(f"{where}: the part of a heading must be {parts}, got {thing.heading.part!r}")
    if thing.heading is not None and not 0 <= thing.heading.probability <= 1:
        raise SceneError(
            f"{where}: the probability of a heading must be from 0 to 1, got {thing.heading.probability:g}"
        )
