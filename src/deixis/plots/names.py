"""Names in a picture from above: each at its thing, none over another."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterable, Iterator, Sequence
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

    def shared(self, other: Box) -> float:
        """The area in common with another."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.high, other.high) - max(self.low, other.low)
        return max(width, 0.0) * max(height, 0.0)


class _Place(NamedTuple):
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
    """Writes every thing's label where it covers no other name, and as little else as can be.

    A name that does not fit on its thing stands beside it, with a line to it; where things are very many, or there is
    no room, it is left out, and the axis says how many are. The names of the things with the ids ``quiet`` are grey;
    the points ``clear``, in the units of the axes, are kept clear where that can be. The figure's layout is settled by
    this.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)  # a letter that the font lacks
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        written = _write_all(figure, axes, things, quiet, clear)
        if written < len(things):
            axes.set_xlabel(f"{axes.get_xlabel()}; {_left_out(len(things) - written)}")


def _left_out(number: int) -> str:
    return f"{number} {'name' if number == 1 else 'names'} left out for lack of room"


def _write_all(
    figure: Figure,
    axes: Axes,
    things: Sequence[PerceivedObject],
    quiet: Collection[str],
    clear: Sequence[tuple[float, float]],
) -> int:
    """How many names there was room for."""
    frame = Box(*map(float, axes.bbox.extents))
    outlines = [_outline(axes, thing) for thing in things]
    boxes, points = np.array(outlines).reshape(-1, 4), _points(axes, clear)
    most = float("inf") if len(things) <= MANY else NEAR
    taken: list[Box] = []
    for index in sorted(range(len(things)), key=lambda i: _area(outlines[i])):
        thing, outline = things[index], outlines[index]
        name = _shown(thing.label or thing.id)
        around = _Around(np.array(taken).reshape(-1, 4), np.delete(boxes, index, axis=0), points, outline, frame)
        place = around.best(_places(outline, *_measured(figure, name), most), most)
        if place is not None:
            taken.append(place.box)
            _write(axes, name, place, outline, thing.id in quiet)
    return len(taken)


def _points(axes: Axes, clear: Sequence[tuple[float, float]]) -> NDArray[np.float64]:
    """Points in the units of the axes as little boxes in pixels, shape (n, 4)."""
    middles = axes.transData.transform(np.array(clear).reshape(-1, 2))
    return np.hstack([middles - POINT / 2, middles + POINT / 2])


def _shown(name: str) -> str:
    """A name as it is read, a very long one shortened; one of nothing but lines stays as it is written.

    >>> _shown("wine_glass_2"), _shown("_")
    ('wine glass 2', '_')
    """
    shown = name.replace("_", " ") if name.strip("_ ") else name
    return shown if len(shown) <= LONGEST else f"{shown[: LONGEST - 1]}…"


def _outline(axes: Axes, thing: PerceivedObject) -> Box:
    corners = axes.transData.transform([thing.minimum[:2], thing.maximum[:2]])
    return Box(*corners.ravel().tolist())


def _area(box: Box) -> float:
    return (box.right - box.left) * (box.high - box.low)


def _measured(figure: Figure, text: str) -> tuple[float, float]:
    """Width and height of a text in pixels, with a little air."""
    drawn = figure.text(0, 0, text, fontsize=FONT, parse_math=False)
    extent = drawn.get_window_extent()
    drawn.remove()
    return extent.width + 5, extent.height + 4


def _places(outline: Box, width: float, height: float, most: float) -> Iterator[_Place]:
    """Where a name may stand: on its thing, at several heights, level or upright; then around it, ever farther."""
    centre_x, centre_y = (outline.left + outline.right) / 2, (outline.low + outline.high) / 2
    for rotation, w, h in ((0, width, height), (90, height, width)):
        room_x, room_y = outline.right - outline.left - w, outline.high - outline.low - h
        if room_x >= -3 and room_y >= -3:
            for share in (0.5, 0.85, 0.15, 0.97, 0.03):
                y = outline.low + h / 2 + share * max(room_y, 0)
                yield _Place(_around(centre_x, y, w, h), rotation, 20.0 * rotation / 90 + abs(share - 0.5), True)
    for ring in range(RINGS):
        cost = 60.0 + 25.0 * ring
        if cost >= most:
            return
        away = 3 + ring * height / 2
        for dx, dy in ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1)):
            x = centre_x + dx * ((outline.right - outline.left + width) / 2 + away)
            y = centre_y + dy * ((outline.high - outline.low + height) / 2 + away)
            yield _Place(_around(x, y, width, height), 0, cost + 10.0 * abs(dx * dy), False)


def _around(x: float, y: float, width: float, height: float) -> Box:
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


class _Around(NamedTuple):
    """What is around a name that is to be placed, in pixels: boxes of shape (n, 4), its own thing's, and the frame."""

    taken: NDArray[np.float64]
    others: NDArray[np.float64]
    points: NDArray[np.float64]
    outline: Box
    frame: Box

    def best(self, places: Iterable[_Place], most: float) -> _Place | None:
        """The cheapest place in the frame that covers no name; what it covers of smaller things costs too."""
        within = [place for place in places if place.box.shared(self.frame) >= 0.999 * _area(place.box)]
        bears = _shared(self.outline, self.others) >= 0.98 * _area(self.outline)
        best, least = None, most
        for place in sorted(within, key=lambda place: place.cost):
            if place.cost >= least:
                break
            if not _shared(place.box, self.taken).any():
                # A name on its thing may cover what that lies on, and one beside it should cover nothing.
                others = self.others[~bears] if place.inside else self.others
                covered = _shared(place.box, others).sum() + HIDING * _shared(place.box, self.points).sum()
                total = place.cost + COVERED * float(covered) / _area(place.box)
                if total < least:
                    best, least = place, total
        return best


def _shared(box: Box, boxes: NDArray[np.float64]) -> NDArray[np.float64]:
    """The areas (n,) that a box has in common with boxes (n, 4)."""
    width = np.minimum(box.right, boxes[:, 2]) - np.maximum(box.left, boxes[:, 0])
    height = np.minimum(box.high, boxes[:, 3]) - np.maximum(box.low, boxes[:, 1])
    shared: NDArray[np.float64] = np.maximum(width, 0) * np.maximum(height, 0)
    return shared


def _write(axes: Axes, name: str, place: _Place, outline: Box, quiet: bool) -> None:
    from matplotlib import patheffects

    inverse = axes.transData.inverted()
    middle = (place.box.left + place.box.right) / 2, (place.box.low + place.box.high) / 2
    x, y = inverse.transform(middle).tolist()
    if _gap(place.box, outline) > LEADER:
        (x0, y0), (x1, y1) = inverse.transform(_nearest(place.box, outline)).tolist()
        axes.plot([x0, x1], [y0, y1], color=INK, linewidth=0.6, zorder=900, scalex=False, scaley=False)
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


def _gap(name: Box, outline: Box) -> float:
    """How far a name stands from its thing, in pixels; 0 where it is on it."""
    across = max(outline.left - name.right, name.left - outline.right, 0.0)
    along = max(outline.low - name.high, name.low - outline.high, 0.0)
    return max(across, along)


def _nearest(name: Box, outline: Box) -> list[tuple[float, float]]:
    """A point of the name's rectangle and one just inside the outline's, where the two are nearest."""
    x = [_clamped((outline.left + outline.right) / 2, name.left, name.right)]
    y = [_clamped((outline.low + outline.high) / 2, name.low, name.high)]
    inset_x, inset_y = 0.15 * (outline.right - outline.left), 0.15 * (outline.high - outline.low)
    x.append(_clamped(x[0], outline.left + inset_x, outline.right - inset_x))
    y.append(_clamped(y[0], outline.low + inset_y, outline.high - inset_y))
    return list(zip(x, y, strict=True))


def _clamped(value: float, least: float, greatest: float) -> float:
    return max(least, min(value, greatest))
