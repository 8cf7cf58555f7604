"""From a cloud file to a scene on disk: what ``deixis perceive`` does."""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
from collections.abc import Set
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.memory.owner import rename
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.detection.detect import Detection, detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.detection.viewpoint import moved
from deixis.perception.errors import CloudError, SceneError
from deixis.perception.formats.scene_json import write_scene
from deixis.perception.scene import PerceivedObject, Scene

_CLOUD = re.compile(r"o\d+(-[0-9a-f]{8}|\.new)\.pcd")


@dataclass(frozen=True, eq=False)
class Perceived:
    """A cloud, what was detected in it, and the scene that this makes."""

    cloud: PointCloud
    detection: Detection
    scene: Scene

    def cloud_of(self, number: int) -> PointCloud:
        """The points of one thing, counted from 0, in the table's frame, with where the sensor stood."""
        return in_frame(self.cloud.take(self.detection.labels == number), self.detection.frame)

    def write(self, file: str | Path) -> Scene:
        """Writes the scene with its clouds, as :func:`write_perceived` does: what it gives can be taught from."""
        return write_perceived(self, Path(file))


def perceive(
    cloud: PointCloud | str | Path,
    intrinsics: str | Path | None = None,
    viewpoint: str = "chair",
    settings: DetectionSettings | None = None,
) -> Perceived:
    """Finds the table and the things on it; ``settings`` tell which table, and what is known of the cloud's frame.

    Raises CloudError for a file that is no cloud, or one without a point; SceneError for a viewpoint that is no word.
    """
    if not viewpoint.strip() or not viewpoint.isprintable():
        raise SceneError(f"a viewpoint is a word such as 'chair', not {viewpoint!r}")
    seen = cloud if isinstance(cloud, PointCloud) else read_cloud(cloud, intrinsics)
    try:
        found = detect(seen, settings)
    except CloudError as error:
        raise error if isinstance(cloud, PointCloud) else CloudError(f"{cloud}: {error}") from error
    return Perceived(seen, found, found.scene(viewpoint))


def in_frame(cloud: PointCloud, frame: NDArray[np.float64]) -> PointCloud:
    """The same points in another frame; ``frame`` (4, 4) takes the cloud's frame to it."""
    origin = moved(np.array([cloud.origin]), frame)[0]
    normals = None if cloud.normals is None else (cloud.normals @ frame[:3, :3].T).astype(np.float32)
    points = moved(cloud.points, frame).astype(np.float32)
    x, y, z = origin.tolist()
    return PointCloud(points, cloud.colours, None, normals, origin=(x, y, z))


def write_perceived(perceived: Perceived, file: Path) -> Scene:
    """Writes the scene, and each thing's points into a folder beside it, which the scene names.

    The clouds of a scene that is written over stay until the new scene is in its place, in one step, and then go: each
    cloud bears a name of its content, so that at any moment there is a whole scene, the old one or the new. Raises
    DeixisError where the place cannot be written.
    """
    folder = clouds_folder(file)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        before = set(os.listdir(folder))
    except OSError as error:
        raise DeixisError(f"{file}: the scene cannot be written: {error.strerror}") from error
    try:
        things = []
        for number, thing in enumerate(perceived.scene.objects):
            cloud = _write_named(folder, thing.id, perceived.cloud_of(number))
            things.append(replace(thing, cloud=os.fspath(cloud.relative_to(file.parent))))
        scene = replace(perceived.scene, objects=tuple(things), file=str(file))
        replace_scene(scene, file)
    except BaseException:
        _remove_others(folder, before)
        raise
    _remove_others(folder, {Path(thing.cloud or "").name for thing in things})
    return scene


def replace_scene(scene: Scene, file: Path) -> None:
    """Writes a scene, in one step where one is there already. Raises DeixisError where that cannot be."""
    new = file.with_name(file.name + ".new")
    try:
        write_scene(scene, new)
        rename(new, file)
    except OSError as error:
        raise DeixisError(f"{file}: the scene cannot be written: {error.strerror}") from error
    finally:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)


def _write_named(folder: Path, id: str, cloud: PointCloud) -> Path:
    """Writes a cloud under a name that says its content: ``o3-9f86d081.pcd``."""
    new = folder / f"{id}.new.pcd"
    write_cloud(new, cloud)
    named = folder / f"{id}-{hashlib.sha256(new.read_bytes()).hexdigest()[:8]}.pcd"
    rename(new, named)
    return named


def _remove_others(folder: Path, kept: Set[str]) -> None:
    """Removes what other scenes, whole or not, left in the folder; what cannot be removed does no harm."""
    for name in set(os.listdir(folder)) - kept:
        if _CLOUD.fullmatch(name):
            with contextlib.suppress(OSError):
                (folder / name).unlink()


def clouds_folder(scene: Path) -> Path:
    """Where the clouds of a scene's things are: ``table.clouds`` beside ``table.scene.json``."""
    return scene.with_name(f"{scene.name.removesuffix('.json').removesuffix('.scene')}.clouds")


def cloud_of(scene: Scene, thing: PerceivedObject) -> PointCloud:
    """The points of a thing of a scene; raises SceneError where the scene names no cloud of it, or one that is none."""
    if thing.cloud is None:
        raise SceneError(
            f"{scene.file}: the object '{thing.id}' has no cloud, so that what it looks like is not known; "
            "deixis perceive -o writes scenes with clouds"
        )
    try:
        return read_cloud(Path(scene.file).parent / thing.cloud)
    except CloudError as error:
        raise SceneError(f"{scene.file}: the cloud of '{thing.id}': {error}") from error
