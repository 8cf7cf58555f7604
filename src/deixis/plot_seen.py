"""Pictures of what was perceived and recognised: things from above, each in its colour, with box and name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.perception.detection.detect import ON_TABLE
from deixis.plot import INK, QUIET, dress_table, new_figure, save
from deixis.plot_names import write_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from deixis.perceiving import Perceived
    from deixis.perception.scene import Scene
    from deixis.recognising import Recognised

MOST_POINTS = 40_000
"""Points that are drawn of a cloud."""

MARGIN = 0.05
"""Metres around the table that are drawn."""

FEW = 0.005
"""The share of the table's points, on each side, that may be some other level surface of its height."""


def plot_perceived(found: Perceived, path: str | Path) -> None:
    """The points from above, grey where they belong to no thing; beside it the image, where the cloud is one."""
    from deixis.perceiving import in_frame

    organised = found.cloud.organised
    figure, axes = new_figure(14.0 if organised else 8.0, 6.5, ncols=2 if organised else 1, squeeze=False)
    points = in_frame(found.cloud, found.detection.frame).points
    shown = _worth_showing(points, found)
    _points(axes[0][0], points[shown], found.detection.labels[shown])
    _boxes(axes[0][0], found.scene)
    axes[0][0].set_aspect("equal")
    axes[0][0].set_anchor("N")
    dress_table(axes[0][0], found.scene, "From above, in the table's frame")
    if organised:
        _image(axes[0][1], found.detection.labels.reshape(organised), shown.reshape(organised))
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
        named.append(replace(thing, label=f"{thing.id} {said or 'unknown'}"))
    _boxes(axes, found.scene)
    axes.set_aspect("equal")
    dress_table(axes, found.scene, "What was recognised")
    write_names(figure, axes, named)
    save(figure, path)


def _worth_showing(points: NDArray[np.float32], found: Perceived) -> NDArray[np.bool_]:
    """Which points (n, 3) of the table's frame lie above or below the table and its things, or near: (n,).

    All of them where no table was found.
    """
    if found.detection.table is None:
        return np.ones(len(points), dtype=np.bool_)
    on_things = found.detection.labels >= 0
    of_interest = on_things | (np.abs(points[:, 2]) < ON_TABLE)
    low, high = np.quantile(points[of_interest, :2], [FEW, 1.0 - FEW], axis=0)
    if on_things.any():
        things = points[on_things, :2]
        low, high = np.minimum(low, things.min(axis=0)), np.maximum(high, things.max(axis=0))
    shown: NDArray[np.bool_] = ((points[:, :2] > low - MARGIN) & (points[:, :2] < high + MARGIN)).all(axis=1)
    return shown


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


def _image(axes: Axes, labels: NDArray[np.integer], shown: NDArray[np.bool_]) -> None:
    """The things' labels as an image (height, width), as far as there is something that is shown."""
    picture = np.full((*labels.shape, 3), 0.93)
    picture[labels >= 0] = _colour(labels[labels >= 0])
    axes.imshow(picture)
    rows, columns = np.nonzero(shown)
    if len(rows):
        axes.set_xlim(columns.min() - 0.5, columns.max() + 0.5)
        axes.set_ylim(rows.max() + 0.5, rows.min() - 0.5)
    axes.set_anchor("N")
    axes.set_title("As the camera sees it", color=INK, fontsize=12, loc="left")
    axes.set_axis_off()


def _colour(numbers: NDArray[np.integer]) -> NDArray[np.float64]:
    """A colour for each number, neighbours far apart on the circle of hues, shape (n, 3)."""
    from matplotlib.colors import hsv_to_rgb

    hue = (np.asarray(numbers) * 0.61803398875) % 1.0
    value = 0.55 + 0.3 * ((np.asarray(numbers) * 0.7548776662) % 1.0)
    colours: NDArray[np.float64] = hsv_to_rgb(np.stack([hue, np.full(len(hue), 0.65), value], axis=1))
    return colours
