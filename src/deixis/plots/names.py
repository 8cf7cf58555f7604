"""Names in a picture from above, each at its thing and without overlaps.

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
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.perception.scene import PerceivedObject
from deixis.plots.arrows import Arrow, points_along
from deixis.plots.figure import FADED_INK, INK, PAPER, WRONG

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONT = 8.0
LONGEST = 48
"""Maximum number of characters of a name, with its id and probability."""

RINGS = 40
"""Maximum distance of a name from its thing, in line heights."""

AROUND = [
    *((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1)),
    *((x, y) for y in (1, -1) for x in (0.3, -0.3, 0.6, -0.6)),
]
"""Directions from a thing to its name, in shares of the sizes of both."""

COVERED = 600.0
"""Cost, in pixels, of covering other things with a whole name."""

MANY = 150
"""Number of things above which a name is written at its thing or not at all."""

NEAR = 120.0
"""Maximum cost of a place, in pixels, with more than :data:`MANY` things."""

HIDING = 3.0
"""Cost of covering an area around a point, relative to an area of a thing."""

IN_THE_WAY = 40.0
"""Cost, in pixels, for each other thing whose own name would have to stand where this one does."""

NEARER_TO_ANOTHER = 90.0
"""Cost, in pixels, of a name without a line whose middle is nearer to another thing than to its own."""

POINT = 8.0
"""Side of the square around a point that names avoid, in pixels."""

LEADER = 10.0
"""Minimum number of pixels between a name and its thing at which a line joins them."""


class Box(NamedTuple):
    """A rectangle in pixels."""

    left: float
    low: float
    right: float
    high: float

    @property
    def area(self) -> float:
        """Area in square pixels."""
        return (self.right - self.left) * (self.high - self.low)

    def shared(self, boxes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the areas (n,) in common with boxes (n, 4).

        Parameters
        ----------
        boxes
            Least x and y, greatest x and y, shape (n, 4).

        Returns
        -------
        ndarray
            Areas of shape (n,).
        """
        width = np.minimum(self.right, boxes[:, 2]) - np.maximum(self.left, boxes[:, 0])
        height = np.minimum(self.high, boxes[:, 3]) - np.maximum(self.low, boxes[:, 1])
        common: NDArray[np.float64] = np.maximum(width, 0) * np.maximum(height, 0)
        return common

    def in_the_way_of(self, boxes: NDArray[np.float64]) -> int:
        """Return how many boxes (n, 4) have their middle column behind this one, close above or below.

        Parameters
        ----------
        boxes
            Least x and y, greatest x and y, shape (n, 4).

        Returns
        -------
        int
            The number of boxes.
        """
        middle = (boxes[:, 0] + boxes[:, 2]) / 2
        reach = 3 * min(self.high - self.low, self.right - self.left)
        apart = np.maximum(self.low - boxes[:, 3], boxes[:, 1] - self.high)
        return int(np.count_nonzero((self.left < middle) & (middle < self.right) & (apart >= 0) & (apart < reach)))


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
    words: Sequence[tuple[str, Arrow]] = (),
) -> None:
    """Write every thing's label where it covers no other name, and as little else as possible.

    A name that does not fit on its thing stands beside it. A line joins the two where they are apart; it crosses no
    other thing and no name. Where things are very many, or there is no room, names are left out, and the axis gives
    their number. This fixes the layout of the figure.

    Parameters
    ----------
    figure
        The figure, whose layout is fixed by this.
    axes
        Axes with the drawn things.
    things
        What to name: the label is written, or the id of a thing without one. A line break in it starts a new line.
    quiet
        Ids of the things whose names are grey.
    clear
        Points in the units of the axes that names should not cover.
    words
        Words with the arrows that they belong to; each is written at the middle of its arrow where there is room.
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
        leaders: list[Segment] = []
        for index in sorted(range(len(things)), key=lambda index: outlines[index].area):
            outline, name = outlines[index], _shown(things[index].label or things[index].id)
            others, names = np.delete(boxes, index, axis=0), np.array(taken).reshape(-1, 4)
            frame = np.array([axes.bbox.extents])
            places = [
                place
                for place in _places(outline, *_measured(figure, name), most)
                if place.box.shared(frame)[0] >= 0.999 * place.box.area
            ]
            place = _cheapest(places, outline, others, names, points, leaders, most)
            if place is not None:
                taken.append(place.box)
                leader = _leader(place, outline)
                if leader is not None:
                    leaders.append(leader)
                _write(axes, name, place, leader, things[index].id in quiet)
        left_out = len(things) - len(taken)
        for word, arrow in words:
            _write_word(figure, axes, word, arrow, taken)
        if left_out:
            axes.set_xlabel(f"{axes.get_xlabel()}; {count(left_out, 'name')} left out for lack of room")


def _shown(name: str) -> str:
    """Return a name as it is read, each line shortened if it is very long; one made of underscores stays as it is.

    >>> _shown("wine_glass_2"), _shown("_")
    ('wine glass 2', '_')
    """
    shown = name.replace("_", " ") if name.strip("_ ") else name
    return "\n".join(line if len(line) <= LONGEST else f"{line[: LONGEST - 1]}…" for line in shown.split("\n"))


def _measured(figure: Figure, text: str) -> tuple[float, float]:
    """Return width and height of a text in pixels, with a little air."""
    drawn = figure.text(0, 0, text, fontsize=FONT, parse_math=False)
    extent = drawn.get_window_extent()
    drawn.remove()
    return extent.width + 5, extent.height + 4


def _places(outline: Box, width: float, height: float, most: float) -> Iterator[NamePlace]:
    """Yield places for a name: on its thing, at several heights, level or upright; then around it, nearest first."""

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
        for rotation, w, h in ((0, width, height), (90, height, width)):
            for dx, dy in AROUND if rotation == 0 else AROUND[:2]:
                x = centre_x + dx * ((outline.right - outline.left + w) / 2 + away)
                y = centre_y + dy * ((outline.high - outline.low + h) / 2 + away)
                upright = 40.0 * rotation / 90
                yield NamePlace(around(x, y, w, h), rotation, cost + upright + 10.0 * abs(dx * dy), False)


def _cheapest(
    places: Sequence[NamePlace],
    outline: Box,
    others: NDArray[np.float64],
    names: NDArray[np.float64],
    points: NDArray[np.float64],
    leaders: Sequence[Segment],
    most: float,
) -> NamePlace | None:
    """Return the cheapest place that covers no name and no leader, and whose own leader crosses no thing and no name.

    Covering other things or points costs too. ``outline`` is that of the thing itself; other things, names
    and points are boxes in pixels of shape (n, 4).
    """
    bears = outline.shared(others) >= 0.98 * outline.area
    foreign = np.vstack([others[~bears], names])
    best, least = None, most
    for place in sorted(places, key=lambda place: place.cost):
        if place.cost >= least:
            break
        if not place.box.shared(names).any():
            # A name on its thing may cover what that lies on, and one beside it should cover nothing.
            beneath = others[~bears] if place.inside else others
            covered = place.box.shared(beneath).sum() + HIDING * place.box.shared(points).sum()
            total = place.cost + COVERED * float(covered) / place.box.area
            if not place.inside:
                total += IN_THE_WAY * place.box.in_the_way_of(others)
                if _leader(place, outline) is None and _seems_another(place.box, outline, others[~bears]):
                    total += NEARER_TO_ANOTHER
            if total < least and not _crossing(place, outline, foreign, leaders):
                best, least = place, total
    return best


def _seems_another(name: Box, own: Box, others: NDArray[np.float64]) -> bool:
    """Return True if the middle of a name is nearer to one of the boxes (n, 4) than to that of its own thing."""
    middle = np.array([(name.left + name.right) / 2, (name.low + name.high) / 2])
    boxes = np.vstack([np.array([own]), others])
    outside = np.maximum(np.maximum(boxes[:, :2] - middle, middle - boxes[:, 2:]), 0.0)
    distances = np.hypot(*outside.T)
    return bool(distances[1:].min(initial=np.inf) < distances[0])


def _crossing(place: NamePlace, outline: Box, foreign: NDArray[np.float64], leaders: Sequence[Segment]) -> bool:
    """Return True if a name's leader enters one of the boxes (n, 4), or if another leader enters the name."""
    if any(crosses(leader, np.array([place.box]))[0] for leader in leaders):
        return True
    leader = _leader(place, outline)
    return leader is not None and bool(crosses(leader, foreign).any())


Segment = tuple[tuple[float, float], tuple[float, float]]
"""A line between two points, in pixels."""


def _leader(place: NamePlace, outline: Box) -> Segment | None:
    """Return the line from a name's nearest point to one well inside its thing; None if they are close."""
    box = place.box
    across = max(outline.left - box.right, box.left - outline.right, 0.0)
    along = max(outline.low - box.high, box.low - outline.high, 0.0)
    if max(across, along) <= LEADER:
        return None
    inset_x, inset_y = 0.15 * (outline.right - outline.left), 0.15 * (outline.high - outline.low)
    x0 = min(max((outline.left + outline.right) / 2, box.left), box.right)
    y0 = min(max((outline.low + outline.high) / 2, box.low), box.high)
    x1 = min(max(x0, outline.left + inset_x), outline.right - inset_x)
    y1 = min(max(y0, outline.low + inset_y), outline.high - inset_y)
    return (x0, y0), (x1, y1)


def crosses(segment: Segment, boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Say which boxes a segment enters, by clipping it to each (Liang and Barsky); touching is not entering.

    Parameters
    ----------
    segment
        Its two ends.
    boxes
        Least x and y, greatest x and y, shape (n, 4).

    Returns
    -------
    ndarray
        True for the boxes that it enters, shape (n,).

    Examples
    --------
    >>> crosses(((0.0, 0.0), (4.0, 0.0)), np.array([[1.0, -1.0, 2.0, 1.0], [1.0, 1.0, 2.0, 2.0]]))
    array([ True, False])
    """
    start, step = np.array(segment[0]), np.array(segment[1]) - np.array(segment[0])
    low, high = boxes[:, :2], boxes[:, 2:]
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - start) / step, (high - start) / step
    inside = (start > low) & (start < high)
    flat = step == 0
    enter = np.where(flat, np.where(inside, -np.inf, np.inf), np.minimum(first, second)).max(axis=1)
    leave = np.where(flat, np.where(inside, np.inf, -np.inf), np.maximum(first, second)).min(axis=1)
    entered: NDArray[np.bool_] = np.maximum(enter, 0.0) < np.minimum(leave, 1.0)
    return entered


def _write_word(figure: Figure, axes: Axes, word: str, arrow: Arrow, taken: list[Box]) -> None:
    """Write a word beside the middle of its arrow, or a little before or after it, where it covers no name.

    Where possible, it covers neither end of the arrow.
    """
    from matplotlib import patheffects

    width, height = _measured(figure, word)
    points = axes.transData.transform(np.array(points_along([arrow])))
    ends = np.hstack([points[[0, -1]] - POINT / 2, points[[0, -1]] + POINT / 2])
    places = []
    for share, side in product((0.5, 0.35, 0.65), (0.7, -0.7, 1.4, -1.4, 0.0)):
        x, y = points[round(share * (len(points) - 1))].tolist()
        y += side * height
        places.append(Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2))
    free = [box for box in places if not box.shared(np.array(taken).reshape(-1, 4)).any()]
    if not free:
        return
    box = next((box for box in free if not box.shared(ends).any()), free[0])
    taken.append(box)
    middle = ((box.left + box.right) / 2, (box.low + box.high) / 2)
    x, y = axes.transData.inverted().transform(middle).tolist()
    look: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": FONT - 0.5, "color": WRONG}
    stroke = [patheffects.withStroke(linewidth=2.2, foreground=PAPER)]
    axes.text(x, y, word, zorder=950, path_effects=stroke, **look)


def _write(axes: Axes, name: str, place: NamePlace, leader: Segment | None, quiet: bool) -> None:
    from matplotlib import patheffects

    box, inverse = place.box, axes.transData.inverted()
    if leader is not None:
        (x0, y0), (x1, y1) = inverse.transform(leader).tolist()
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
