"""Convert 3-D detections with the fields of the ROS message `vision_msgs/Detection3DArray` to scenes, and back.

The fields: https://docs.ros.org/en/api/vision_msgs/html/msg/Detection3DArray.html (names of ROS 2). Fields are read by
attribute or by key, from a ROS message, its JSON or a dictionary; ROS need not be installed. A rotated box becomes the
axis-aligned box around it; the object also keeps the rotated box if it is rotated about the vertical only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import SceneError
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import DEFAULT_VIEWPOINT, PerceivedObject, Scene

UPRIGHT_TOLERANCE = 1e-3
"""Maximum difference from 1 of the cosine between the third axis of an upright box and the vertical."""


def scene_from_detections3d(message: Any, *, viewpoint: str = DEFAULT_VIEWPOINT, file: str = "<detections>") -> Scene:
    """Return the scene of a ``Detection3DArray``.

    Parameters
    ----------
    message
        ROS message, or dictionaries and lists with its fields: ``header.frame_id`` and ``detections``, each with
        ``id``, ``bbox.center.position``, ``bbox.center.orientation`` (a quaternion), ``bbox.size`` in metres, and
        ``results`` of ``hypothesis.class_id`` and ``hypothesis.score``. A detection without an id is named after its
        position: ``d1``.
    viewpoint
        The side from which left and right are seen: x to its right, y away from it.
    file
        Name of the message in errors.

    Returns
    -------
    Scene
        One object for each detection. Its label is the hypothesis with the highest score; several hypotheses all become
        candidates, unless their scores add up to more than 1.

    Raises
    ------
    SceneError
        If a field is missing or is not a number; the message names the detection.

    Examples
    --------
    >>> message = {"header": {"frame_id": "table"}, "detections": [{"id": "7", "bbox": {
    ...     "center": {"position": {"x": 0.5, "y": 0.2, "z": 0.05}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}},
    ...     "size": {"x": 0.1, "y": 0.1, "z": 0.1}}, "results": [{"hypothesis": {"class_id": "mug", "score": 0.9}}]}]}
    >>> scene = scene_from_detections3d(message)
    >>> scene["7"].label, scene["7"].confidence, scene["7"].maximum
    ('mug', 0.9, (0.55, 0.25, 0.1))
    """
    detections = _field(message, "detections", file)
    if isinstance(detections, str | Mapping) or not hasattr(detections, "__iter__"):
        raise SceneError(f"{file}: 'detections' must be a list, got {type(detections).__name__}")
    objects = [
        _object(detection, f"d{number}", f"{file}: detections[{number - 1}]")
        for number, detection in enumerate(detections, start=1)
    ]
    header = _get(message, "header")
    frame = _get(header, "frame_id") if header is not None else None
    return Scene(tuple(objects), frame=str(frame or "table"), viewpoint=viewpoint, file=file)


def _object(detection: Any, default_id: str, where: str) -> PerceivedObject:
    box = _field(detection, "bbox", where)
    center = _field(box, "center", f"{where}.bbox")
    centre = _vector(_field(center, "position", f"{where}.bbox.center"), "xyz", f"{where}.bbox.center.position")
    size = _vector(_field(box, "size", f"{where}.bbox"), "xyz", f"{where}.bbox.size")
    if (size < 0).any():
        raise SceneError(f"{where}.bbox.size must be 0 or more on each axis, got {size.tolist()}")
    rotation = _rotation(_get(center, "orientation"), f"{where}.bbox.center.orientation")
    half = np.abs(rotation) @ size / 2
    oriented = None
    if abs(rotation[2, 2] - 1.0) < UPRIGHT_TOLERANCE:
        yaw = float(np.arctan2(rotation[1, 0], rotation[0, 0]))
        oriented = OrientedBox(_triple(centre), yaw, _triple(size))
    scores = _hypotheses(_get(detection, "results") or (), where)
    label = max(scores, key=lambda name: scores[name]) if scores else None
    total = sum(scores.values())
    return PerceivedObject(
        id=str(_get(detection, "id") or default_id),
        minimum=_triple(centre - half),
        maximum=_triple(centre + half),
        label=label,
        confidence=1.0 if label is None else scores[label],
        oriented=oriented,
        candidates=tuple(scores.items()) if len(scores) > 1 and total <= 1.0 else (),
    )


def _hypotheses(results: Any, where: str) -> dict[str, float]:
    scores: dict[str, float] = {}
    for number, result in enumerate(results):
        place = f"{where}.results[{number}]"
        hypothesis = _get(result, "hypothesis") or result
        name = str(_field(hypothesis, "class_id", place))
        score = _number(_field(hypothesis, "score", place), f"{place}.score")
        if not 0.0 <= score <= 1.0:
            raise SceneError(f"{place}.score must be from 0 to 1, got {score:g}")
        scores[name] = max(score, scores.get(name, 0.0))
    return scores


def _rotation(quaternion: Any, where: str) -> NDArray[np.float64]:
    """Return the rotation matrix (3, 3) of a quaternion; the identity if it is missing or all zeros."""
    if quaternion is None:
        return np.eye(3)
    values = _vector(quaternion, "xyzw", where)
    if np.linalg.norm(values) == 0.0:  # the orientation of the message was never set
        return np.eye(3)
    from scipy.spatial.transform import Rotation

    matrix: NDArray[np.float64] = Rotation.from_quat(values).as_matrix()
    return matrix


def _get(message: Any, name: str) -> Any:
    return message.get(name) if isinstance(message, Mapping) else getattr(message, name, None)


def _field(message: Any, name: str, where: str) -> Any:
    found = _get(message, name)
    if found is None:
        raise SceneError(f"{where}: the field '{name}' is missing")
    return found


def _vector(message: Any, axes: str, where: str) -> NDArray[np.float64]:
    return np.array([_number(_field(message, axis, where), f"{where}.{axis}") for axis in axes])


def _number(value: Any, where: str) -> float:
    if isinstance(value, str | bool) or not np.isscalar(value):
        raise SceneError(f"{where} must be a number, got {value!r:.40}")
    number = float(value)  # type: ignore[arg-type]
    if not np.isfinite(number):
        raise SceneError(f"{where} must be finite, got {number}")
    return number


def _triple(values: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = (round(float(value), 9) for value in values)
    return x, y, z


def scene_to_detections3d(scene: Scene) -> dict[str, Any]:
    """Return the fields of a ``Detection3DArray`` for a scene, as dictionaries and lists.

    Boxes without heights have height 0 at z = 0. The header has no time stamp, because a scene has no time.

    Parameters
    ----------
    scene
        A scene in metres.

    Returns
    -------
    dict
        The fields.

    Raises
    ------
    SceneError
        If the scene is measured in pixels.
    """
    if scene.unit == "px":
        raise SceneError(f"{scene.file}: 3-D detections must be in metres, and this scene is in pixels")
    return {"header": {"frame_id": scene.frame}, "detections": [_detection(thing) for thing in scene.objects]}


def _detection(thing: PerceivedObject) -> dict[str, Any]:
    low, high = (np.array([*corner, 0.0][:3]) for corner in (thing.minimum, thing.maximum))
    centre, size, yaw = (low + high) / 2, high - low, 0.0
    if thing.oriented is not None:
        centre, size = np.array(thing.oriented.centre), np.array(thing.oriented.extents)
        yaw = thing.oriented.yaw
    names: Sequence[tuple[str, float]] = thing.candidates
    if not names and thing.label is not None:
        names = ((thing.label, thing.confidence),)
    return {
        "id": thing.id,
        "bbox": {
            "center": {
                "position": dict(zip("xyz", _triple(centre), strict=True)),
                "orientation": {"x": 0.0, "y": 0.0, "z": float(np.sin(yaw / 2)), "w": float(np.cos(yaw / 2))},
            },
            "size": dict(zip("xyz", _triple(size), strict=True)),
        },
        "results": [{"hypothesis": {"class_id": name, "score": share}} for name, share in names],
    }
