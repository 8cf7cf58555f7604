"""Turn a cloud into a scene with the points of each thing, and write scenes with their clouds."""

from __future__ import annotations

import contextlib
import hashlib
import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from deixis.arguments import checks_arguments
from deixis.errors import DeixisError
from deixis.memory.owner import rename
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import read_cloud, write_cloud
from deixis.perception.detection.detect import DETECTION_STAGES, detect
from deixis.perception.detection.settings import DetectionSettings
from deixis.perception.errors import CloudError, SceneError
from deixis.perception.features.orientation import with_headings
from deixis.perception.formats.scene_json import scene_text
from deixis.perception.scene import DEFAULT_VIEWPOINT, Scene
from deixis.text_files import is_folder, is_present

READING = "reading the cloud"

STAGES = (READING, *DETECTION_STAGES)
"""Stages of perceiving a cloud, in order."""

_NUMBERED = re.compile(r"o\d+")
_CLOUD = re.compile(r"o\d+(-[0-9a-f]{8}|\.new)\.pcd")


@checks_arguments
def perceive(
    cloud: PointCloud | str | Path,
    intrinsics: str | Path | None = None,
    viewpoint: str = DEFAULT_VIEWPOINT,
    settings: DetectionSettings | None = None,
    stage: Callable[[str], None] | None = None,
) -> Scene:
    """Find the table in a point cloud, and the objects on it.

    Each object of the scene has its points, so that it can be taught, learned and recognised at once, and its
    ``heading``, if its points show a head or a handle; :func:`write_scene` keeps it. ``scene.detection`` has the cloud,
    the object of each of its points, and notes on what is unusual.

    Parameters
    ----------
    cloud
        A cloud in metres, or a file of one, or a depth image.
    intrinsics
        File of the camera's intrinsics, for a depth image.
    viewpoint
        Name of the side from which the camera looks.
    settings
        Which table to choose, and what is known about the camera's frame.
    stage
        Called with the name of each of ``STAGES`` that begins.

    Returns
    -------
    Scene
        The objects in the frame of the table, in metres.

    Raises
    ------
    CloudError
        If the file is not a cloud, or has no point.
    SceneError
        If ``viewpoint`` is not a word.

    Examples
    --------
    >>> import deixis
    >>> cloud = deixis.simulate(deixis.read_script(text="cup left of plate"), seed=1).cloud
    >>> scene = deixis.perceive(cloud)
    >>> scene
    <Scene <cloud>: 2 objects, 3-D boxes in m, seen from the chair>
    >>> scene.objects[0].cloud is not None
    True
    """
    if not viewpoint.strip() or not viewpoint.isprintable():
        raise SceneError(f"`viewpoint` must be a word such as 'chair', got {viewpoint!r}")
    if isinstance(cloud, PointCloud):
        return with_headings(detect(cloud, settings, stage).scene(viewpoint))
    if stage is not None:
        stage(READING)
    seen = read_cloud(cloud, intrinsics)
    try:
        return with_headings(detect(seen, settings, stage).scene(viewpoint, str(cloud)))
    except CloudError as error:
        raise CloudError(f"{cloud}: {error}") from error


@checks_arguments
def write_scene(scene: Scene, file: str | Path) -> Scene:
    """Write a scene to a ``.scene.json``, and clouds that are in memory into a folder beside it.

    A cloud in a file stays where it is, and is named as seen from the scene. The clouds of a scene that is written over
    stay until the new scene is in its place, in one step, and then go: the name of each cloud depends on its content,
    so at any moment there is a whole scene, old or new.

    Parameters
    ----------
    scene
        The scene.
    file
        Name of the file, ending in ``.scene.json``.

    Returns
    -------
    Scene
        The scene as written, with the files of its clouds.

    Raises
    ------
    DeixisError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> import deixis
    >>> scene = deixis.read_scene({"objects": [{"id": "o1", "min": [0, 0], "max": [0.03, 0.2]}]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = deixis.write_scene(scene, f"{folder}/table.scene.json")
    ...     deixis.read_scene(f"{folder}/table.scene.json").ids
    ('o1',)
    """
    file = Path(file)
    if not file.name or is_folder(file):
        raise DeixisError(f"{file}: this is a folder; name a file")
    if is_present(file) and not file.is_file():
        raise DeixisError(f"{file}: this is a device or a pipe, which the scene would replace; name a file")
    folder, base = clouds_folder(file), Path(scene.file).parent
    perceived = scene.detection is not None or any(isinstance(thing.cloud, PointCloud) for thing in scene.objects)
    before: set[str] = set()
    new = file.with_name(file.name + ".new")
    try:
        if perceived:
            folder.mkdir(parents=True, exist_ok=True)
            before = {path.name for path in folder.iterdir()}
        things = []
        for number, thing in enumerate(scene.objects, start=1):
            if isinstance(thing.cloud, PointCloud):
                name = thing.id if _NUMBERED.fullmatch(thing.id) else f"o{number}"
                unnamed = folder / f"{name}.new.pcd"
                write_cloud(unnamed, thing.cloud)
                cloud = folder / f"{name}-{hashlib.sha256(unnamed.read_bytes()).hexdigest()[:8]}.pcd"
                rename(unnamed, cloud)
                thing = replace(thing, cloud=os.fspath(cloud.relative_to(file.parent)))
            elif thing.cloud is not None and base != file.parent:
                thing = replace(thing, cloud=os.path.relpath(base / thing.cloud, file.parent))
            things.append(thing)
        written = replace(scene, objects=tuple(things), file=str(file))
        new.write_text(scene_text(written), encoding="utf-8")
        rename(new, file)
    except BaseException as error:
        if perceived:
            _remove_others(folder, before)
        if isinstance(error, OSError):
            raise DeixisError(f"{file}: the scene cannot be written: {error.strerror}") from error
        raise
    finally:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)
    if perceived:
        _remove_others(folder, {Path(str(thing.cloud)).name for thing in things})
    return written


def clouds_folder(scene: Path) -> Path:
    """Return the folder of the clouds of a scene: ``table.clouds`` beside ``table.scene.json``.

    Parameters
    ----------
    scene
        File of the scene.

    Returns
    -------
    Path
        The folder, which need not exist.
    """
    return scene.with_name(f"{scene.name.removesuffix('.json').removesuffix('.scene')}.clouds")


def _remove_others(folder: Path, kept: set[str]) -> None:
    """Remove what other scenes, whole or not, left in the folder; what cannot be removed does no harm."""
    with contextlib.suppress(OSError):
        for path in list(folder.iterdir()):
            if path.name not in kept and _CLOUD.fullmatch(path.name):
                with contextlib.suppress(OSError):
                    path.unlink()
