"""Name the things of a scene by the taught categories."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.perception.scene import Scene
from deixis.view_store import ViewStore
from deixis.workflows.layouts.read import as_scene

if TYPE_CHECKING:
    from deixis.learning.views.views import Recognised
    from deixis.memory.perceptual.protocol import Progress


def recognise(
    scene: Scene | str | Path | Mapping[str, Any],
    store: ViewStore,
    progress: Progress | None = None,
    left_out: Callable[[str], None] | None = None,
) -> Recognised:
    """Name the things of a scene that have points by the taught categories; without any, all are unknown.

    Parameters
    ----------
    scene
        A scene, the name of its file, or parsed JSON.
    store
        The perceptual store.
    progress
        Called while the taught views are read and calibrated, which takes seconds for many views, then for each thing.
    left_out
        Called with a line for each damaged view.

    Returns
    -------
    Recognised
        The scene with the names, and the recogniser's answer for each thing.

    Raises
    ------
    SceneError
        If a file is not a cloud.
    """
    from deixis.learning.views.views import recognise as recognise_clouds

    scene = as_scene(scene)
    clouds = [scene.cloud_of(thing.id) if thing.cloud is not None else None for thing in scene.objects]
    return recognise_clouds(store.known(scene.frame, progress, left_out), scene, clouds, progress)
