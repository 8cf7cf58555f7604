"""The things of a scene are named by what was taught."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deixis.perception.scene import Scene
from deixis.view_store import ViewStore
from deixis.workflows.read import as_scene

if TYPE_CHECKING:
    from deixis.learning.views import Recognised
    from deixis.memory.perceptual.protocol import Progress


def recognise(
    scene: Scene | str | Path | Mapping[str, Any],
    store: ViewStore,
    progress: Progress | None = None,
    left_out: Callable[[str], None] | None = None,
) -> Recognised:
    """Names what is known among the things of a scene that have points; where nothing was taught, nothing is.

    ``progress`` is told of reading what was taught, and of the calibration, which take seconds after many views;
    ``left_out``, in one line, of views that are damaged and teach nothing. Raises SceneError for a cloud that is none.
    """
    from deixis.learning.views import recognise as recognise_clouds

    scene = as_scene(scene)
    clouds = [scene.cloud_of(thing.id) if thing.cloud is not None else None for thing in scene.objects]
    return recognise_clouds(store.known(scene.frame, progress, left_out), scene, clouds)
