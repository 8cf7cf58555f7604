"""Names in a picture from above: each at its thing, none over another."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from deixis.perception.scene import PerceivedObject
from deixis.plot import INK, PAPER

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONT = 8.0
RINGS = 40
"""How many line heights away from its thing a name may stand."""
COVERED = 600.0
"""What it costs, in pixels as it were, to cover other things with a whole name."""

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


def write_names(figure: Figure, axes: Axes, things: Sequence[PerceivedObject]) -> None:
    """Writes every thing's label where it covers no other name, and as little else as can be.

    A name that does not fit on its thing stands beside it, with a line to it. The figure's layout is settled by this.
    """
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph", category=UserWarning)  # a letter that the font lacks
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        _write_all(figure, axes, things)


def _write_all(figure: Figure, axes: Axes, things: Sequence[PerceivedObject]) -> None:
    frame = Box(*map(float, axes.bbox.extents))
    outlines = [_outline(axes, thing) for thing in things]
    taken: list[Box] = []
    for index in sorted(range(len(things)), key=lambda i: _area(outlines[i])):
        thing, outline = things[index], outlines[index]
        name = _shown(thing.label or thing.id)
        width, height = _measured(figure, name)
        others = [other for other in outlines if other is not outline]
        place = _best(list(_places(outline, width, height)), taken, others, outline, frame)
        taken.append(place.box)
        _write(axes, name, place, outline)


def _shown(name: str) -> str:
    """A name as it is read; one of nothing but lines stays as it is written.

    >>> _shown("wine_glass_2"), _shown("_")
    ('wine glass 2', '_')
    """
    return name.replace("_", " ") if name.strip("_ ") else name


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


def _places(outline: Box, width: float, height: float) -> Iterator[_Place]:
    """Where a name may stand: on its thing, at several heights, level or upright; then around it, ever farther."""
    centre_x, centre_y = (outline.left + outline.right) / 2, (outline.low + outline.high) / 2
    for rotation, w, h in ((0, width, height), (90, height, width)):
        room_x, room_y = outline.right - outline.left - w, outline.high - outline.low - h
        if room_x >= -3 and room_y >= -3:
            for share in (0.5, 0.85, 0.15, 0.97, 0.03):
                y = outline.low + h / 2 + share * max(room_y, 0)
                yield _Place(_around(centre_x, y, w, h), rotation, 20.0 * rotation / 90 + abs(share - 0.5), True)
    for ring in range(RINGS):
        away = 3 + ring * height / 2
        for dx, dy in ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1)):
            x = centre_x + dx * ((outline.right - outline.left + width) / 2 + away)
            y = centre_y + dy * ((outline.high - outline.low + height) / 2 + away)
            yield _Place(_around(x, y, width, height), 0, 60.0 + 25.0 * ring + 10.0 * abs(dx * dy), False)


def _around(x: float, y: float, width: float, height: float) -> Box:
    return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)


def _best(places: list[_Place], taken: list[Box], others: list[Box], outline: Box, frame: Box) -> _Place:
    """The cheapest place of those in the frame that cover no name; what it covers of smaller things costs too."""
    within = [place for place in places if place.box.shared(frame) >= 0.999 * _area(place.box)]
    best, least = (within or places)[-1], float("inf")
    for place in sorted(within or places, key=lambda place: place.cost):
        if place.cost >= least:
            break
        if not any(place.box.shared(name) for name in taken):
            total = place.cost + _covered(place, others, outline)
            if total < least:
                best, least = place, total
    return best


def _covered(place: _Place, others: list[Box], outline: Box) -> float:
    """A name on its thing may cover what that lies on, and one beside it should cover nothing."""
    total = 0.0
    for other in others:
        under = place.inside and outline.shared(other) >= 0.98 * _area(outline)
        total += 0.0 if under else place.box.shared(other)
    return COVERED * total / _area(place.box)


def _write(axes: Axes, name: str, place: _Place, outline: Box) -> None:
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
        color=INK,
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
