"""Pictures of what was perceived and recognised: things from above, each in its colour, with box and name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.plot import INK, QUIET, dress_table, new_figure, save
from deixis.plot_names import write_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from deixis.perceiving import Perceived
    from deixis.perception.scene import Scene
    from deixis.recognising import Recognised

MOST_POINTS = 40_000
"""Points that are drawn of a cloud."""


def plot_perceived(found: Perceived, path: str | Path) -> None:
    """The points from above, grey where they belong to no thing; beside it the image, where the cloud is one."""
    from deixis.perceiving import in_frame

    organised = found.cloud.organised
    figure, axes = new_figure(14.0 if organised else 8.0, 6.5, ncols=2 if organised else 1, squeeze=False)
    points = in_frame(found.cloud, found.detection.frame).points
    _points(axes[0][0], points, found.detection.labels)
    _boxes(axes[0][0], found.scene)
    axes[0][0].set_aspect("equal")
    dress_table(axes[0][0], found.scene, "From above, in the table's frame")
    if organised:
        _image(axes[0][1], found.detection.labels.reshape(organised))
    things = tuple(replace(thing, label=thing.label or thing.id) for thing in found.scene.objects)
    write_names(figure, axes[0][0], things)
    save(figure, path)


def plot_recognised(found: Recognised, path: str | Path) -> None:
    """The things from above, each with its name and how probable that is; what is unknown says so."""
    from deixis.perceiving import cloud_of

    figure, axes = new_figure(9.0, 7.5)
    named = []
    for number, thing in enumerate(found.scene.objects):
        if thing.cloud is not None:
            points = cloud_of(found.scene, thing).points
            _points(axes, points, np.full(len(points), number))
        answer = found.answers.get(thing.id)
        said = thing.label if answer is None else f"{answer.label or 'unknown'} {answer.probability:.2f}"
        named.append(replace(thing, label=said or "unknown"))
    _boxes(axes, found.scene)
    axes.set_aspect("equal")
    dress_table(axes, found.scene, "What was recognised")
    write_names(figure, axes, named)
    save(figure, path)


def _points(axes: Axes, points: NDArray[np.float32], labels: NDArray[np.integer]) -> None:
    shown = np.flatnonzero(np.isfinite(points).all(axis=1))
    shown = shown[:: max(1, len(shown) // MOST_POINTS)]
    on_things = labels[shown] >= 0
    x, y = 1.0 * points[shown, 0], 1.0 * points[shown, 1]
    axes.scatter(x[~on_things], y[~on_things], s=0.3, color=QUIET, alpha=0.25, rasterized=True, linewidths=0)
    colours = _colour(labels[shown][on_things])
    axes.scatter(x[on_things], y[on_things], s=1.2, color=colours, rasterized=True, linewidths=0)


def _boxes(axes: Axes, scene: Scene) -> None:
    from matplotlib.patches import Rectangle

    for thing in scene.objects:
        (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
        axes.add_patch(Rectangle((x, y), right - x, top - y, fill=False, edgecolor=INK, linewidth=1.0))


def _image(axes: Axes, labels: NDArray[np.integer]) -> None:
    picture = np.full((*labels.shape, 3), 0.93)
    picture[labels >= 0] = _colour(labels[labels >= 0])
    axes.imshow(picture)
    axes.set_title("As the camera sees it", color=INK, fontsize=12, loc="left")
    axes.set_axis_off()


def _colour(numbers: NDArray[np.integer]) -> NDArray[np.float64]:
    """A colour for each number, neighbours far apart on the circle of hues, shape (n, 3)."""
    from matplotlib.colors import hsv_to_rgb

    hue = (np.asarray(numbers) * 0.61803398875) % 1.0
    value = 0.55 + 0.3 * ((np.asarray(numbers) * 0.7548776662) % 1.0)
    colours: NDArray[np.float64] = hsv_to_rgb(np.stack([hue, np.full(len(hue), 0.65), value], axis=1))
    return colours
