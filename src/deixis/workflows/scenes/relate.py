"""Relate the things of a scene in a calculus."""

from __future__ import annotations

from pathlib import Path

from deixis.arguments import checks_arguments
from deixis.perception.scene import Scene
from deixis.reasoning.qualitative.relate import Related
from deixis.reasoning.qualitative.relate import relate as codes_of
from deixis.workflows.layouts.read import as_scene


@checks_arguments
def relate(
    scene: Scene | str | Path,
    calculus: str = "ra",
    *,
    axis: str = "x",
    tolerance: float = 0.0,
    reference: float | None = None,
) -> Related:
    """Return the relation of every ordered pair of things in a scene.

    Parameters
    ----------
    scene
        The scene, or its file.
    calculus
        Name of a calculus that relates boxes: point, allen, ra, ba, cd, cardir, rcc8, ten, distance, or
        direction-distance.
    axis
        Axis (x, y or z) of ``point`` and ``allen``.
    tolerance
        Greatest difference of coordinates that count as equal, in metres (pixels for annotations).
    reference
        Unit of distance, as a length: near is up to 1, medium up to 3. Calculi with distances need it.

    Returns
    -------
    Related
        The relations of all pairs.

    Raises
    ------
    SceneError
        If the file is not a scene.
    UnknownCalculusError
        If boxes cannot be related in a calculus of that name.
    SettingError
        If ``axis``, ``tolerance`` or ``reference`` is out of range.

    Examples
    --------
    >>> import deixis
    >>> scene = deixis.Scene.from_boxes(centre=[[0.1, 0.1], [0.4, 0.1]], size=[[0.2, 0.2], [0.02, 0.2]])
    >>> found = deixis.relate(scene, "cd")
    >>> found
    <Related 2 things in cd>
    >>> list(found.pairs())[0]
    ('o1', 'W', 'o2')
    """
    seen = as_scene(scene)
    codes = codes_of(seen.boxes, calculus, axis=axis, tolerance=tolerance, reference=reference)
    return Related(calculus, seen.ids, codes)
