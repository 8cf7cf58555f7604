"""Names in a picture from above: each at its thing, none over another.

Two libraries that place labels were tried on the pictures of `ground`, `check`, `imagine` and `perceive`. They give
worse pictures: they know anchor points, not areas, and write no name upright on a narrow thing. textalloc 1.2.4 puts
the dinner plate's name on the napkin that lies on it, and the names of cutlery on the plate, with lines that cross
other things; it takes 1.1 to 2.3 times as long (medians of 7: 0.29 and 0.41 s for 12 things, 0.43 and 1.00 s for 42 in
two views). adjustText 1.4.0 does not settle within 5 s, and its names cross the outlines of other things (5 or 6 of 12,
19 of 42; ours none of 12, and 1 of 42).
"""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.perception.scene import PerceivedObject
from deixis.plots.figure import FADED_INK, INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONT = 8.0
LONGEST = 48
"""Characters of a name that are written: with an id and a probability, too."""

RINGS = 40
"""How many line heights away from its thing a name may stand."""
COVERED = 600.0
"""What it costs, in pixels as it were, to cover other things with a whole name."""

MANY = 150
"""Things; where there are more, a name stands at its thing or nowhere."""

NEAR = 120.0
"""The most that a place may cost, in pixels as it were, where there are so many."""

HIDING = 3.0
"""How many times worse it is to cover an area around a point than one of a thing."""

POINT = 8.0
"""The side of the square, in pixels, that is kept clear around a point."""

LEADER = 10.0
"""Pixels between a name and its thing from which a line joins them."""


class Box(NamedTuple):
    """A rectangle in pixels."""

    left: float
    low: float
    right: float
    high: float

    @property
    def area(self) -> float:
        return (self.right - self.left) * (self.high - self.low)

    def shared(self, boxes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the areas (n,) in common with boxes (n, 4)."""
        width = np.minimum(self.right, boxes[:, 2]) - np.maximum(self.left, boxes[:, 0])
        height = np.minimum(self.high, boxes[:, 3]) - np.maximum(self.low, boxes[:, 1])
        common: NDArray[np.float64] = np.maximum(width, 0) * np.maximum(height, 0)
        return common


class NamePlace(NamedTuple):
    """Where a name may stand, at what rotation and cost, and whether that is on its thing."""

    box: Box
    rotation: int
    cost: float
    inside: bool


def write_names(
    figure: Figure,
    axes: Axes,
    things: Sequence[PerceivedObject],
    quiet: Collection[str] = (),
    clear: Sequence[tuple[float, float]] = (),
) -> None:
    """Write every thing's label where it covers no other name, and as little else as can be.

    A name that does not fit on its thing stands beside it, with a line to it; where things are very many, or there is
    no room, it is left out, and the axis says how many are. The names of the things with the ids ``quiet`` are grey;
    the points ``clear``, in the units of the axes, are kept clear where that can be. The figure's layout is settled by
    this.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)  # a letter that the font lacks
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        corners = np.array([[thing.minimum[:2], thing.maximum[:2]] for thing in things]).reshape(-1, 2)
        boxes = axes.transData.transform(corners).reshape(-1, 4)
        middles = axes.transData.transform(np.array(clear).reshape(-1, 2))
        points = np.hstack([middles - POINT / 2, middles + POINT / 2])
        outlines = [Box(*box) for box in boxes.tolist()]
        most = float("inf") if len(things) <= MANY else NEAR
        taken: list[Box] = []
        for index in sorted(range(len(things)), key=lambda index: outlines[index].area):
            outline, name = outlines[index], _shown(things[index].label or things[index].id)
            others, names = np.delete(boxes, index, axis=0), np.array(taken).reshape(-1, 4)
            frame = np.array([axes.bbox.extents])
            places = [
                place
                for place in _places(outline, *_measured(figure, name), most)
                if place.box.shared(frame)[0] >= 0.999 * place.box.area
            ]
            place = _cheapest(places, outline, others, names, points, most)
            if place is not None:
                taken.append(place.box)
                _write(axes, name, place, outline, things[index].id in quiet)
        left_out = len(things) - len(taken)
        if left_out:
            counted = f"{left_out} {'name' if left_out == 1 else 'names'}"
            axes.set_xlabel(f"{axes.get_xlabel()}; {counted} left out for lack of room")


def _shown(name: str) -> str:
    """Return a name as it is read, a very long one shortened; one of nothing but lines stays as it is written.

    >>> _shown("wine_glass_2"), _shown("_")
    ('wine glass 2', '_')
    """
    shown = name.replace("_", " ") if name.strip("_ ") else name
    return shown if len(shown) <= LONGEST else f"{shown[: LONGEST - 1]}…"


def _measured(figure: Figure, text: str) -> tuple[float, float]:
    """Return width and height of a text in pixels, with a little air."""
    drawn = figure.text(0, 0, text, fontsize=FONT, parse_math=False)
    extent = drawn.get_window_extent()
    drawn.remove()
    return extent.width + 5, extent.height + 4


def _places(outline: Box, width: float, height: float, most: float) -> Iterator[NamePlace]:
    """Yield places for a name: on its thing, at several heights, level or upright; then around it, ever farther."""

    def around(x: float, y: float, width: float, height: float) -> Box:
        return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)

    centre_x, centre_y = (outline.left + outline.right) / 2, (outline.low + outline.high) / 2
    for rotation, w, h in ((0, width, height), (90, height, width)):
        room_x, room_y = outline.right - outline.left - w, outline.high - outline.low - h
        if room_x >= -3 and room_y >= -3:
            for share in (0.5, 0.85, 0.15, 0.97, 0.03):
                y = outline.low + h / 2 + share * max(room_y, 0)
                yield NamePlace(around(centre_x, y, w, h), rotation, 20.0 * rotation / 90 + abs(share - 0.5), True)
    for ring in range(RINGS):
        cost = 60.0 + 25.0 * ring
        if cost >= most:
            return
        away = 3 + ring * height / 2
        for dx, dy in ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1)):
            x = centre_x + dx * ((outline.right - outline.left + width) / 2 + away)
            y = centre_y + dy * ((outline.high - outline.low + height) / 2 + away)
            yield NamePlace(around(x, y, width, height), 0, cost + 10.0 * abs(dx * dy), False)


def _cheapest(
    places: Sequence[NamePlace],
    outline: Box,
    others: NDArray[np.float64],
    names: NDArray[np.float64],
    points: NDArray[np.float64],
    most: float,
) -> NamePlace | None:
    """Return the cheapest place that covers no name; what it covers of other things and points costs too.

    ``outline`` is that of the thing itself; other things, names and points are boxes in pixels of shape (n, 4).
    """
    bears = outline.shared(others) >= 0.98 * outline.area
    best, least = None, most
    for place in sorted(places, key=lambda place: place.cost):
        if place.cost >= least:
            break
        if not place.box.shared(names).any():
            # A name on its thing may cover what that lies on, and one beside it should cover nothing.
            beneath = others[~bears] if place.inside else others
            covered = place.box.shared(beneath).sum() + HIDING * place.box.shared(points).sum()
            total = place.cost + COVERED * float(covered) / place.box.area
            if total < least:
                best, least = place, total
    return best


def _write(axes: Axes, name: str, place: NamePlace, outline: Box, quiet: bool) -> None:
    from matplotlib import patheffects

    box, inverse = place.box, axes.transData.inverted()
    across = max(outline.left - box.right, box.left - outline.right, 0.0)
    along = max(outline.low - box.high, box.low - outline.high, 0.0)
    if max(across, along) > LEADER:
        # From the name's nearest point to the nearest one that lies well inside the outline.
        inset_x, inset_y = 0.15 * (outline.right - outline.left), 0.15 * (outline.high - outline.low)
        x0 = min(max((outline.left + outline.right) / 2, box.left), box.right)
        y0 = min(max((outline.low + outline.high) / 2, box.low), box.high)
        x1 = min(max(x0, outline.left + inset_x), outline.right - inset_x)
        y1 = min(max(y0, outline.low + inset_y), outline.high - inset_y)
        (x0, y0), (x1, y1) = inverse.transform([(x0, y0), (x1, y1)]).tolist()
        axes.plot([x0, x1], [y0, y1], color=INK, linewidth=0.6, zorder=900, scalex=False, scaley=False)
    x, y = inverse.transform(((box.left + box.right) / 2, (box.low + box.high) / 2)).tolist()
    axes.text(
        x,
        y,
        name,
        ha="center",
        va="center",
        rotation=place.rotation,
        fontsize=FONT,
        color=FADED_INK if quiet else INK,
        style="italic" if quiet else "normal",
        zorder=1000,
        parse_math=False,
        path_effects=[patheffects.withStroke(linewidth=2.2, foreground=PAPER)],
    )
