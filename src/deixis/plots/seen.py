"""Pictures of perceived and recognised things from above, each in its colour, with its box and name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError
from deixis.perception.detection.settings import PlaneSettings
from deixis.perception.tracking.situation import scene_of
from deixis.plots.arrows import arrow_path, directions, draw_directions
from deixis.plots.camera import MARGIN, CameraPicture, camera_of, colours_of, draw_camera
from deixis.plots.figure import INK, canvas, dress_table, new_figure, save
from deixis.plots.grounding import opacity, scene_figure
from deixis.plots.names import write_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from deixis.learning.views.views import Recognised
    from deixis.perception.recognition.recogniser import Recognition
    from deixis.perception.scene import Detected, PerceivedObject, Scene
    from deixis.workflows.scenes.simulate import Simulation
    from deixis.workflows.scenes.track import Tracking

MAX_POINTS = 60_000
"""Maximum number of points to draw of the things, and of the table."""

OUTLIER_SHARE = 0.005
"""Share of the table's points to ignore on each side; they may belong to another surface of its height."""

DOT_WIDTH = 0.003
"""Width of a drawn point in metres, about the distance between a depth camera's points on a table."""

TABLE = "#dedbd1"
MAX_DOT_WIDTH = 0.02
"""Maximum width of a drawn point of the table in metres, where the points are far apart."""

MIN_DOT_POINTS = 1.0
"""Minimum width of a drawn point in typographic points, at any scale."""

HEIGHT, MAX_WIDTH = 5.4, 12.5
"""Height of a panel and maximum width of all panels, in inches."""

MAX_NAME_LENGTH = 32
"""Maximum number of characters of a name."""

LEGEND = (
    "The number is the probability of the name; '?' marks a name that is not certain enough.\n"
    "For 'unknown', it is the probability that none of the known names is right."
)

Window = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Minimum and maximum x and y of the picture, in metres."""


def plot_perceived(scene: Scene, path: str | Path) -> None:
    """Draw the points from above, grey where they belong to no thing; beside them the image of an organised cloud.

    Parameters
    ----------
    scene
        A scene that was just perceived.
    path
        File of the picture; its ending says which format.

    Raises
    ------
    SceneError
        If the scene has no cloud, such as one read from a file.
    """
    save(perceived_figure(scene), path)


def seen_figure(scene: Scene, axes: Axes | None = None) -> Figure:
    """Draw a scene: with its points if it was just found in a cloud, else its boxes.

    Parameters
    ----------
    scene
        The scene.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    if scene.detection is None or axes is not None:
        return scene_figure(scene, axes)
    return perceived_figure(scene)


def simulation_figure(found: Simulation, axes: Axes | None = None) -> Figure:
    """Draw the true scene of a simulation from above.

    Parameters
    ----------
    found
        Answer of ``deixis simulate``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    return scene_figure(found.truth, axes)


def tracking_figure(found: Tracking, axes: Axes | None = None) -> Figure:
    """Draw the things that are there at the end of a stream of clouds, from above.

    Parameters
    ----------
    found
        Answer of ``deixis track``.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    DeixisError
        If no thing is there.
    """
    if not found.things:
        raise DeixisError("there is no tracked thing to draw; to_text() says what was seen")
    scene = scene_of(found.things, found.seconds)
    named = replace(scene, objects=tuple(replace(thing, label=thing.label or thing.id) for thing in scene.objects))
    return scene_figure(named, axes, found.summary())


def perceived_figure(scene: Scene) -> Figure:
    """Return the picture of :func:`plot_perceived` as a new figure.

    Parameters
    ----------
    scene
        A scene that was just perceived.

    Returns
    -------
    Figure
        The figure.

    Raises
    ------
    SceneError
        If the scene was not perceived from a cloud.
    """
    from deixis.perception.detection.table.viewpoint import in_frame
    from deixis.perception.errors import SceneError

    if scene.detection is None:
        raise SceneError(f"{scene.file}: the scene must be as 'perceive' gives it, got one without its cloud")
    cloud, labels = scene.detection.cloud, scene.detection.labels
    points = in_frame(cloud, scene.detection.frame).points
    window = window_of(points, scene, scene.detection)
    camera = camera_of(cloud, labels, scene) if cloud.organised else None
    figure, axes, scale = _panels(window, camera)
    _points(axes[0], points, labels, window, scale)
    level = scene.detection.table is not None or bool(scene.objects)
    if scene.detection.table is not None:
        title = "From above, in the table's frame"
    else:
        title = "One thing alone, from above" if scene.objects else "All points, as they stand"
    _dress(axes[0], scene, window, title)
    if not scene.objects:
        _say(axes[0], "; ".join(scene.detection.notes) or "nothing was found")
    if not level:
        axes[0].set_xlabel("metres, x of the cloud")
        axes[0].set_ylabel("metres, y of the cloud")
    heads = directions(scene)
    draw_directions(axes[0], heads, INK)
    named = [replace(thing, label=thing.label or thing.id) for thing in scene.objects]
    write_names(figure, axes[0], named, arrows=[arrow_path(head, bend=0.0) for head in heads])
    if camera is not None:
        draw_camera(axes[1], camera)
        write_names(figure, axes[1], camera.things)
    return figure


def plot_recognised(found: Recognised, path: str | Path) -> None:
    """Draw recognised things from above, each with its name and its probability, or `unknown`.

    Parameters
    ----------
    found
        The recognised things.
    path
        File of the picture; its ending says which format.
    """
    save(recognised_figure(found), path)


def recognised_figure(found: Recognised, axes: Axes | None = None) -> Figure:
    """Draw recognised things into axes or into a new figure; the outlines of doubtful ones are faded.

    Parameters
    ----------
    found
        The recognised things.
    axes
        Axes to draw into, or None for a new figure.

    Returns
    -------
    Figure
        The figure.
    """
    clouds = [
        (number, found.scene.cloud_of(thing.id).points)
        for number, thing in enumerate(found.scene.objects)
        if thing.cloud is not None
    ]
    points = np.concatenate([np.empty((0, 3), np.float32), *(cloud for _, cloud in clouds)])
    labels = np.concatenate([np.empty(0, np.int32), *(np.full(len(cloud), number) for number, cloud in clouds)])
    window = _around_boxes(found.scene)
    if axes is None:
        figure, (axes,), scale = _panels(window, None)
    else:
        figure, axes = canvas(axes, 0.0, 0.0)
        scale = axes.get_window_extent().height / figure.dpi / float(window[1][1] - window[0][1])
    _points(axes, points, labels.astype(np.int32), window, scale)
    named = {thing.id: _name(thing, found) for thing in found.scene.objects}
    sureness = {id: probability for id, (_, probability) in named.items() if probability is not None}
    _dress(axes, found.scene, window, "What was recognised", sureness)
    if not found.scene.objects:
        _say(axes, "there is nothing in this scene")
    if found.answers:
        axes.set_xlabel(f"{axes.get_xlabel()}\n\n{LEGEND}", fontsize=8, color=INK)
    shown = {
        id: f"{id} {name}" if probability is None else f"{id} {name} {probability:.2f}"
        for id, (name, probability) in named.items()
    }
    write_names(figure, axes, [replace(thing, label=shown[thing.id]) for thing in found.scene.objects])
    return figure


def _name(thing: PerceivedObject, found: Recognised) -> tuple[str, float | None]:
    """Return the name of a thing, and the probability of the name where it was recognised.

    Without a sure name, return the most likely one with '?' where it is more likely than ``unknown``.
    """
    answer: Recognition | None = found.answers.get(thing.id)
    name = (thing.label if answer is None else answer.label) or "unknown"
    probability = None if answer is None else answer.probability
    if answer is not None and answer.label is None and answer.candidates:
        likeliest = max(answer.candidates, key=lambda one: one.probability)
        if likeliest.probability > answer.unknown:
            name, probability = f"{likeliest.category}?", likeliest.probability
    return (name if len(name) <= MAX_NAME_LENGTH else f"{name[: MAX_NAME_LENGTH - 1]}…"), probability


def window_of(points: NDArray[np.float32], scene: Scene, found: Detected) -> Window:
    """Return the window of the picture: the things and a margin of the table.

    It is the whole table where nothing is on it, and all points where no table was found.

    Parameters
    ----------
    points
        Points in the table's frame, shape (n, 3), in metres.
    scene
        The scene.
    found
        Table and points of the detection.

    Returns
    -------
    Window
        Limits of x and of y.
    """
    if scene.objects:
        return _around_boxes(scene)
    flat = points[np.isfinite(points).all(axis=1)]
    if found.table is not None:
        flat = flat[np.abs(flat[:, 2]) < PlaneSettings().table_band]
    low, high = np.quantile(flat[:, :2].astype(np.float64), [OUTLIER_SHARE, 1.0 - OUTLIER_SHARE], axis=0)
    return _widened(low, high)


def _around_boxes(scene: Scene) -> Window:
    if not scene.objects:
        return _widened(np.zeros(2), np.ones(2))
    return _widened(scene.boxes[:, 0, :2].min(axis=0), scene.boxes[:, 1, :2].max(axis=0))


def _widened(low: NDArray[np.float64], high: NDArray[np.float64]) -> Window:
    """Return a window with a margin, and no side shorter than half of the other."""
    middle, half = (low + high) / 2, (high - low) / 2
    half = np.maximum(half + 2 * MARGIN * half.max(), max(half.max() / 2, DOT_WIDTH))
    return middle - half, middle + half


def _panels(window: Window, camera: CameraPicture | None) -> tuple[Figure, list[Axes], float]:
    """Return a figure with panels of equal height, one for each view, and the inches per metre of the first."""
    width, depth = (window[1] - window[0]).tolist()
    shapes = [width / depth] if camera is None else [width / depth, camera.shape]
    height = min(HEIGHT, MAX_WIDTH / sum(shapes))
    figure, axes = new_figure(
        height * sum(shapes) + 0.4 + 0.6 * len(shapes),
        height + 1.2,
        ncols=len(shapes),
        squeeze=False,
        width_ratios=shapes,
    )
    return figure, list(axes[0]), height / depth


def _points(axes: Axes, points: NDArray[np.float32], labels: NDArray[np.int32], window: Window, scale: float) -> None:
    """Draw the points in the window, higher ones over lower ones; points of the table are wide enough to close up."""
    inside = np.isfinite(points).all(axis=1) & ((points[:, :2] > window[0]) & (points[:, :2] < window[1])).all(axis=1)
    style: dict[str, Any] = {"linewidths": 0, "rasterized": True}
    for of_things in (False, True):
        shown = np.flatnonzero(inside & ((labels >= 0) == of_things))
        shown = shown[:: len(shown) // MAX_POINTS + 1]
        shown = shown[np.argsort(points[shown, 2], kind="stable")]
        apart = float(np.sqrt(np.prod(window[1] - window[0]) / max(len(shown), 1)))
        width = DOT_WIDTH if of_things else min(1.5 * max(apart, DOT_WIDTH), MAX_DOT_WIDTH)
        colours = colours_of(labels[shown]) if of_things else TABLE
        size = max(72 * scale * width, MIN_DOT_POINTS) ** 2
        axes.scatter(1.0 * points[shown, 0], 1.0 * points[shown, 1], s=size, c=colours, **style)


def _dress(axes: Axes, scene: Scene, window: Window, title: str, sureness: Mapping[str, float] | None = None) -> None:
    """Draw the boxes, each in a darker tone of its thing's colour and faded by doubt, and the frame around them."""
    from matplotlib.patches import Rectangle

    edges = 0.6 * colours_of(np.arange(len(scene.objects)))
    for thing, edge in zip(scene.objects, edges, strict=True):
        (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
        alpha = opacity((sureness or {}).get(thing.id, 1.0))
        look: dict[str, Any] = {"edgecolor": tuple(edge), "linewidth": 1.1, "alpha": alpha}
        axes.add_patch(Rectangle((x, y), right - x, top - y, fill=False, **look))
    axes.set_xlim(window[0][0], window[1][0])
    axes.set_ylim(window[0][1], window[1][1])
    axes.set_aspect("equal")
    dress_table(axes, scene, title)


def _say(axes: Axes, what: str) -> None:
    """Write a line in the middle of a panel without things."""
    axes.text(0.5, 0.5, what, transform=axes.transAxes, ha="center", va="center", fontsize=11, color=INK, wrap=True)
