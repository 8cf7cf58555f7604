"""Generate place settings: a formal dinner for one, with things of varying size, set down more or less carefully.

They replace a camera: boxes in the table's frame, x to the right, y away from the chair, in metres. Sizes are those of
ordinary tableware, measured across: plates 25 to 29 cm, forks and knives 17 to 24 cm, glasses 7 to 9 cm.
"""

from __future__ import annotations

import numpy as np

from deixis.perception.scene import PerceivedObject, Scene

_Box = tuple[float, float, float, float]
"""The ends x0, x1, y0, y1 of a box, in metres."""


def formal_setting(seed: int | None = None, displacement: float = 0.0) -> Scene:
    """Return a formal place setting of 12 objects, each labelled with its name.

    Parameters
    ----------
    seed
        The seed by which sizes and gaps vary by up to a tenth; None for the standard setting.
    displacement
        The greatest displacement of a thing on each axis, in metres; things on a plate move with it.

    Returns
    -------
    The scene, in metres, with x to the right and y away from the chair.

    Examples
    --------
    >>> formal_setting()["dinner_plate"].minimum
    (-0.135, 0.03)
    """
    rng = None if seed is None else np.random.default_rng(seed)
    boxes = _boxes(_Sizes(rng))
    moved: dict[str, _Box] = {}
    for name, (x0, x1, y0, y1) in boxes.items():
        if name not in _BORNE:
            dx, dy = (0.0, 0.0) if rng is None or not displacement else rng.uniform(-displacement, displacement, 2)
            moved[name] = (x0 + dx, x1 + dx, y0 + dy, y1 + dy)
    for name, bearer in _BORNE.items():
        dx, dy = moved[bearer][0] - boxes[bearer][0], moved[bearer][2] - boxes[bearer][2]
        x0, x1, y0, y1 = boxes[name]
        moved[name] = (x0 + dx, x1 + dx, y0 + dy, y1 + dy)
    things = []
    for name in boxes:
        x0, x1, y0, y1 = (round(float(value), 4) for value in moved[name])
        things.append(PerceivedObject(name, (x0, y0), (x1, y1), label=name))
    return Scene(tuple(things), file="<formal setting>")


_BORNE = {"napkin": "dinner_plate", "butter_knife": "bread_plate"}


class _Sizes:
    """Lengths that vary by up to a tenth, or are constant without a generator."""

    def __init__(self, rng: np.random.Generator | None) -> None:
        self._rng = rng

    def __call__(self, length: float) -> float:
        return length if self._rng is None else length * float(self._rng.uniform(0.9, 1.1))


def _boxes(size: _Sizes) -> dict[str, _Box]:
    plate = size(0.27)
    near = 0.03
    boxes: dict[str, _Box] = {"dinner_plate": (-plate / 2, plate / 2, near, near + plate)}
    boxes["napkin"] = _centred(boxes["dinner_plate"], size(0.1), size(0.18))
    forks = [("dinner_fork", 0.025, 0.205), ("salad_fork", 0.022, 0.18)]
    knives = [("dinner_knife", 0.022, 0.235), ("fish_knife", 0.022, 0.21), ("soup_spoon", 0.04, 0.2)]
    _row(boxes, forks, -plate / 2, -1, near + 0.01, size)
    _row(boxes, knives, plate / 2, 1, near + 0.01, size)
    far = near + plate
    for name, width in (("dessert_fork", 0.022), ("dessert_spoon", 0.038)):
        far += size(0.022)
        length, across = size(0.18), size(width)
        boxes[name] = (-length / 2, length / 2, far, far + across)
        far += across
    bread = size(0.16)
    right, bottom = -plate / 2 - size(0.035), near + plate + size(0.03)
    boxes["bread_plate"] = (right - bread, right, bottom, bottom + bread)
    boxes["butter_knife"] = _centred(boxes["bread_plate"], min(size(0.14), bread), size(0.02))
    glass = size(0.08)
    tip, left = boxes["dinner_knife"][3], boxes["dinner_knife"][0]
    bottom = max(tip + 0.008, near + plate - glass / 2)
    boxes["water_glass"] = (left, left + glass, bottom, bottom + glass)
    return boxes


def _row(
    boxes: dict[str, _Box], things: list[tuple[str, float, float]], edge: float, side: int, near: float, size: _Sizes
) -> None:
    """Set cutlery side by side, from the plate's edge outwards."""
    for name, width, length in things:
        start = edge + side * size(0.016)
        edge = start + side * size(width)
        boxes[name] = (min(start, edge), max(start, edge), near, near + size(length))


def _centred(bearer: _Box, width: float, depth: float) -> _Box:
    x, y = (bearer[0] + bearer[1]) / 2, (bearer[2] + bearer[3]) / 2
    return (x - width / 2, x + width / 2, y - depth / 2, y + depth / 2)
