"""Arrows between things in a picture from above, between places where the two things are visible."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.figure import INK, QUIET

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GRID = 12
"""Number of places on each axis of a thing where an arrow may begin or end."""

END_DEPTH, MIN_LENGTH = 0.015, 0.05
"""Preferred depth of an end inside its thing, and minimum length of an arrow: shares of the picture's extent."""

BEND = 0.12
"""Distance of an arrow's control point from its straight line, as a share of its length."""

STEPS = 40
"""Number of points of the path of an arrow that names avoid."""

Point = tuple[float, float]
Arrow = tuple[Point, Point]


def drawing_order(things: Iterable[PerceivedObject]) -> list[PerceivedObject]:
    """Return things in drawing order: larger things first, so that smaller ones lie over them.

    Parameters
    ----------
    things
        The things.

    Returns
    -------
    list of PerceivedObject
        The things, sorted.
    """
    return sorted(things, key=lambda thing: -float(np.prod(_plan(thing)[1] - _plan(thing)[0])))


class Ends:
    """Places where arrows between the things of a picture begin and end."""

    def __init__(self, things: Sequence[PerceivedObject]) -> None:
        ordered = drawing_order(things)
        self._boxes = np.array([_plan(thing) for thing in ordered])
        self._level = {thing.id: level for level, thing in enumerate(ordered)}
        self._seen: dict[str, tuple[NDArray[np.float64], NDArray[np.float64]]] = {}
        self._extent = float(np.ptp(self._boxes, axis=(0, 1)).max()) if ordered else 1.0

    def arrow(self, subject: str, other: str) -> Arrow:
        """Return a short arrow from a subject to another thing, with both ends where the things are visible.

        Parameters
        ----------
        subject, other
            Ids of the things.

        Returns
        -------
        Arrow
            Its ends, in the unit of the scene.
        """
        (starts, start_room), (ends, end_room) = self._where_seen(subject), self._where_seen(other)
        length = np.linalg.norm(starts[:, None] - ends, axis=2)
        deep, least = END_DEPTH * self._extent, MIN_LENGTH * self._extent
        cost = length + 3 * np.maximum(least - length, 0)
        cost -= 4 * (np.minimum(start_room, deep)[:, None] + np.minimum(end_room, deep))
        cost += 0.05 * (_off_centre(starts)[:, None] + _off_centre(ends))
        start, end = np.unravel_index(int(cost.argmin()), cost.shape)
        return _point(starts[start]), _point(ends[end])

    def _where_seen(self, name: str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the visible places of a thing, shape (n, 2), and their distances from an edge, shape (n,).

        Where the whole thing is covered, return all its places.
        """
        if name not in self._seen:
            level = self._level[name]
            low, high = self._boxes[level]
            share = (np.arange(GRID) + 0.5) / GRID
            x, y = np.meshgrid(*(low + share[:, None] * (high - low)).T)
            places = np.stack([x.ravel(), y.ravel()], axis=1)
            room = -_outside(places, low, high)
            above = self._boxes[level + 1 :]
            above = above[(above[:, 0] < high).all(axis=1) & (above[:, 1] > low).all(axis=1)]
            clear = _outside(places[:, None], above[:, 0], above[:, 1]).min(axis=1, initial=np.inf)
            seen = clear > 0
            self._seen[name] = (places[seen], np.minimum(room, clear)[seen]) if seen.any() else (places, room)
        return self._seen[name]


def draw_arrows(axes: Axes, arrows: Sequence[Arrow], colour: str, width: float, order: int) -> None:
    """Draw arrows with a dot at the start, slightly bent, so that arrows in both directions are seen as two.

    Parameters
    ----------
    axes
        Axes to draw into.
    arrows
        The arrows, in the unit of the axes.
    colour
        Their colour.
    width
        Width of the lines in points.
    order
        Drawing order; larger is above.
    """
    from matplotlib.patches import FancyArrowPatch

    alpha = 0.75 if colour == QUIET else 1.0
    for start, end in arrows:
        arrow = FancyArrowPatch(
            start,
            end,
            arrowstyle="-|>",
            mutation_scale=9,
            connectionstyle=f"arc3,rad={BEND}",
            shrinkA=0,
            shrinkB=0,
            color=colour,
            linewidth=width,
            alpha=alpha,
            zorder=order,
        )
        arrow.set_in_layout(False)
        axes.add_patch(arrow)
    x, y = ([start[axis] for start, _ in arrows] for axis in (0, 1))
    axes.plot(x, y, "o", color=colour, markersize=3.5, alpha=alpha, zorder=order, scalex=False, scaley=False)


def arrow_path(arrow: Arrow, bend: float = BEND) -> NDArray[np.float64]:
    """Return points along an arrow as :func:`draw_arrows` bends it, for axes of equal scale.

    Parameters
    ----------
    arrow
        The arrow, in the unit of the axes.
    bend
        Distance of an arrow's control point from its straight line, as a share of its length.

    Returns
    -------
    ndarray
        Points from its start to its end, shape (:data:`STEPS`, 2).
    """
    share = np.linspace(0.0, 1.0, STEPS)[:, None]
    start, end = np.array(arrow)
    middle = (start + end) / 2 + bend * (end - start)[::-1] * [1.0, -1.0]
    path: NDArray[np.float64] = (1 - share) ** 2 * start + 2 * share * (1 - share) * middle + share**2 * end
    return path


def _plan(thing: PerceivedObject) -> NDArray[np.float64]:
    """Return the box from above: its least corner and its greatest, shape (2, 2)."""
    return np.array([thing.minimum[:2], thing.maximum[:2]], dtype=np.float64)


def _outside(places: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how far places are outside boxes, along the axis on which they are farther; negative within."""
    distance: NDArray[np.float64] = np.maximum(low - places, places - high).max(axis=-1)
    return distance


def _off_centre(places: NDArray[np.float64]) -> NDArray[np.float64]:
    distance: NDArray[np.float64] = np.linalg.norm(places - places.mean(axis=0), axis=1)
    return distance


def _point(place: NDArray[np.float64]) -> Point:
    return float(place[0]), float(place[1])


DIRECTIONS = "arrow on a thing: its front, or the head of a long thing"
"""Explanation of the arrows of :func:`directions`."""


def directions(scene: Scene) -> list[Arrow]:
    """Return a short arrow on each thing whose front or head is known, from above.

    Parameters
    ----------
    scene
        The scene.

    Returns
    -------
    list of Arrow
        The arrows, in the unit of the scene.
    """
    poses = scene.poses
    arrows: list[Arrow] = []
    for box, way in [] if poses is None else zip(scene.boxes[:, :, :2], poses.pointing, strict=True):
        if not np.isnan(way).any():
            sides, middle = (box[1] - box[0]) / 2, box.mean(axis=0)
            reach = min(side / abs(part) for side, part in zip(sides, way, strict=True) if abs(part) > 1e-9)
            arrows.append((_point(middle + 0.35 * reach * way), _point(middle + 0.95 * reach * way)))
    return arrows


def draw_directions(axes: Axes, arrows: Sequence[Arrow], colour: str) -> None:
    """Draw the arrows of :func:`directions`, and explain them below the axis, whose label is set before.

    Parameters
    ----------
    axes
        Axes of a scene seen from above.
    arrows
        The arrows.
    colour
        Colour of the arrows.
    """
    from matplotlib.patches import FancyArrowPatch

    for ends in arrows:
        arrow = FancyArrowPatch(
            *ends, arrowstyle="-|>", mutation_scale=8, color=colour, linewidth=1.0, shrinkA=0, shrinkB=0, zorder=4
        )
        arrow.set_in_layout(False)
        axes.add_patch(arrow)
    if arrows:
        axes.set_xlabel(f"{axes.get_xlabel()}\n{DIRECTIONS}", color=INK)
