"""Places for the names and words of a picture, as geometry of boxes in pixels.

What a reader needs decides:

- A name on a box, without a line, is the name of that box. So a thing has its name on it where there is room, or close
  beside it on free ground.
- A line joins a name to its thing where the two are apart, or where another thing (a tray, a plate) carries its own.
- A line enters no other thing, no name and no line. The one exception is what carries its own thing: where there is no
  room on it, the line has to leave it over its edge.
- A name touches an arrow only where all places that touch none are far away.
- A word stands close to its arrow, nearer to this one than to another, and covers no name and no line. It covers the
  edge of a box or an arrow only where every other place is worse.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

RINGS = 40
"""Maximum distance of a name from its thing, in line heights."""

AROUND = [
    *((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1)),
    *((x, y) for y in (1, -1) for x in (0.3, -0.3, 0.6, -0.6)),
]
"""Directions from a thing to its name, in shares of the sizes of both."""

COVERED = 600.0
"""Cost, in pixels, of covering other things with a whole name."""

COVERED_EDGE = 1.0
"""Cost, in pixels, of a pixel of the edge of another thing that a name covers."""

MANY = 150
"""Number of things above which a name is written at its thing or not at all."""

NEAR = 120.0
"""Maximum cost of a place, in pixels, with more than :data:`MANY` things."""

ON_ARROW = 500.0
"""Cost, in pixels, of a name that touches an arrow."""

ARROW_LENGTH = 2.0
"""Cost, in pixels, of a pixel of an arrow that a name or a word touches."""

ACROSS_ARROW = 5.0
"""Cost, in pixels, of half a pixel of a line that lies on an arrow."""

ON_THING = [(x, y) for y in (0.5, 0.85, 0.15, 0.97, 0.03) for x in (0.5, 0.8, 0.2, 0.97, 0.03)]
"""Places of a name on its thing, as shares of the free width and height."""

OFF_CENTRE = 2.0
"""Cost, in pixels, of a name at the left or right end of its thing instead of its middle."""

IN_THE_WAY = 40.0
"""Cost, in pixels, for each other thing whose own name would have to stand where this one does."""

NEARER_TO_ANOTHER = 90.0
"""Cost, in pixels, of a name without a line whose middle is nearer to another thing than to its own."""

ON_ANOTHER = 50.0
"""Cost, in pixels, of a name on what carries its thing."""

OVER_AN_EDGE = 250.0
"""Cost, in pixels, for each thing whose edge a line crosses, because it carries the thing of the name."""

ARROW_MARGIN = 3.0
"""Minimum distance of a name from the middle of an arrow's line, in pixels: half of an arrow head."""

LEADER = 10.0
"""Minimum number of pixels between a name and its thing at which a line joins them."""

WITHIN = 0.85
"""Minimum share of a thing that lies on another one if that carries it; in the view of a camera, a cup sticks out."""

LARGER = 1.2
"""Minimum area of what carries a thing, relative to the thing; things of one size only lie in one place."""

SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)
"""Places along an arrow at which its word may stand, as shares of its length."""

AWAY = (1.0, 6.0, 12.0, 20.0)
"""Distances of a word from its arrow, in pixels."""

EDGE = 8.0
"""Cost of a pixel of the edge of a box, in pixels of distance, that a word covers."""

WORD_ON_ARROW = 60.0
"""Cost of a word that touches an arrow, in pixels of distance."""

OFF_MIDDLE = 60.0
"""Cost of a word at the end of its arrow instead of its middle, in pixels of distance."""

AT_ANOTHER = 80.0
"""Cost of a word that is nearer to another arrow than to its own, in pixels of distance."""

Segment = tuple[tuple[float, float], tuple[float, float]]
"""A line between two points, in pixels."""


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

    @property
    def middle(self) -> tuple[float, float]:
        """Middle, in pixels."""
        return (self.left + self.right) / 2, (self.low + self.high) / 2

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
        common: NDArray[np.float64] = _shared(np.array([self]), boxes)[0]
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
    """Place of a name: its box, its rotation in degrees, and the line that joins it to its thing, if any."""

    box: Box
    rotation: int
    leader: Segment | None


class _Candidate(NamedTuple):
    """Box and rotation of a possible place, its cost before what it covers, and whether it is on its own thing."""

    box: Box
    rotation: int
    cost: float
    inside: bool


class ArrowPixels:
    """Pixels of all arrows of a picture, as sums over rectangles from its corner.

    Parameters
    ----------
    arrows
        Points along each arrow, in pixels, each of shape (k, 2).
    frame
        Area of the picture.
    """

    def __init__(self, arrows: Sequence[NDArray[np.float64]], frame: Box) -> None:
        self._corner = np.array([frame.left, frame.low])
        self._sides = np.ceil([frame.right - frame.left, frame.high - frame.low]).astype(int) + 1
        pixels = np.zeros(self._sides, dtype=np.int64)
        for arrow in arrows:
            x, y = np.clip(np.round(_dense(arrow) - self._corner).astype(int), 0, self._sides - 1).T
            pixels[x, y] = 1
        self._sums = np.pad(pixels, ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)

    def touched(self, boxes: NDArray[np.float64]) -> NDArray[np.float64]:
        """Count the pixels of arrows in each of some boxes and within :data:`ARROW_MARGIN` of it.

        Parameters
        ----------
        boxes
            Least x and y, greatest x and y, shape (n, 4).

        Returns
        -------
        ndarray
            The numbers, shape (n,).
        """
        low = np.ceil(boxes[:, :2] - ARROW_MARGIN - self._corner).astype(int)
        high = np.floor(boxes[:, 2:] + ARROW_MARGIN - self._corner).astype(int) + 1
        (x0, y0), (x1, y1) = np.clip(low, 0, self._sides).T, np.clip(high, 0, self._sides).T
        counts = self._sums[x1, y1] - self._sums[x0, y1] - self._sums[x1, y0] + self._sums[x0, y0]
        numbers: NDArray[np.float64] = counts.astype(np.float64)
        return numbers

    def along(self, line: Segment) -> int:
        """Count the half pixels of a line that lie on arrows.

        Parameters
        ----------
        line
            The line.

        Returns
        -------
        int
            The number of half pixels.
        """
        x, y = np.clip(np.round(_dense(np.array(line)) - self._corner).astype(int), 0, self._sides - 1).T
        return int((self._sums[x + 1, y + 1] - self._sums[x, y + 1] - self._sums[x + 1, y] + self._sums[x, y]).sum())


def _dense(path: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return points (n, 2) along a path (k, 2), less than half a pixel apart."""
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    along = np.concatenate([[0.0], steps.cumsum()])
    at = np.linspace(0.0, along[-1], int(2 * along[-1]) + 2)
    return np.stack([np.interp(at, along, path[:, axis]) for axis in (0, 1)], axis=1)


def name_places(
    outlines: NDArray[np.float64],
    sizes: Sequence[tuple[float, float]],
    frame: Box,
    arrows: ArrowPixels,
) -> list[NamePlace | None]:
    """Find places for the names of things, those of the smallest things first.

    Parameters
    ----------
    outlines
        Boxes of the things, in pixels: least x and y, greatest x and y, shape (n, 4).
    sizes
        Width and height of each name, in pixels.
    frame
        Area within which names must stand.
    arrows
        The arrows, which names should not touch.

    Returns
    -------
    list of NamePlace or None
        The place of each name; None for one without room.
    """
    most = float("inf") if len(outlines) <= MANY else NEAR
    found: dict[int, NamePlace] = {}
    boxes = [Box(*outline) for outline in outlines.tolist()]
    for index in sorted(range(len(boxes)), key=lambda index: boxes[index].area):
        surroundings = _Surroundings(boxes[index], np.delete(outlines, index, axis=0), list(found.values()), arrows)
        candidates = surroundings.free(list(_candidates(boxes[index], *sizes[index], most)), frame)
        place = surroundings.cheapest(candidates, most)
        if place is None:
            surroundings.is_carried = False  # a name without its line is better than none
            place = surroundings.cheapest(candidates, most)
        if place is not None:
            found[index] = place
    return [found.get(index) for index in range(len(boxes))]


def _candidates(outline: Box, width: float, height: float, most: float) -> Iterator[_Candidate]:
    """Yield places for a name: on its thing, at several heights, level or upright; then around it, nearest first."""

    def around(x: float, y: float, width: float, height: float) -> Box:
        return Box(x - width / 2, y - height / 2, x + width / 2, y + height / 2)

    centre_x, centre_y = (outline.left + outline.right) / 2, (outline.low + outline.high) / 2
    for rotation, w, h in ((0, width, height), (90, height, width)):
        room_x, room_y = outline.right - outline.left - w, outline.high - outline.low - h
        if room_x >= -3 and room_y >= -3:
            for share_x, share_y in ON_THING:
                x = outline.left + w / 2 + share_x * room_x if room_x > 0 else centre_x
                y = outline.low + h / 2 + share_y * max(room_y, 0)
                cost = 20.0 * rotation / 90 + abs(share_y - 0.5) + 2 * OFF_CENTRE * abs(share_x - 0.5)
                yield _Candidate(around(x, y, w, h), rotation, cost, True)
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
                yield _Candidate(around(x, y, w, h), rotation, cost + upright + 10.0 * abs(dx * dy), False)


class _Surroundings:
    """Surroundings of one thing: what its name must or should not cover."""

    def __init__(self, own: Box, others: NDArray[np.float64], placed: Sequence[NamePlace], arrows: ArrowPixels) -> None:
        self._own, self._all, self._arrows = own, others, arrows
        carries = own.shared(others) >= WITHIN * own.area
        self._carriers, self._foreign = others[carries], others[~carries]
        sides = self._carriers[:, 2:] - self._carriers[:, :2]
        self.is_carried = bool((sides.prod(axis=1) > LARGER * own.area).any())
        self._names = np.array([place.box for place in placed]).reshape(-1, 4)
        self._leaders = [place.leader for place in placed if place.leader is not None]

    def free(self, candidates: Sequence[_Candidate], frame: Box) -> list[_Candidate]:
        """Return the places within the frame that cover no name and no line, the cheapest first."""
        boxes = np.array([candidate.box for candidate in candidates]).reshape(-1, 4)
        areas = (boxes[:, 2:] - boxes[:, :2]).prod(axis=1)
        is_free = _shared(boxes, np.array([frame]))[:, 0] >= 0.999 * areas
        is_free &= ~_shared(boxes, self._names).any(axis=1)
        for leader in self._leaders:
            is_free &= ~crosses(leader, boxes)
        return sorted((candidates[k] for k in np.flatnonzero(is_free).tolist()), key=lambda candidate: candidate.cost)

    def cheapest(self, candidates: Sequence[_Candidate], most: float) -> NamePlace | None:
        """Return the cheapest of some places, in order of cost, that costs less than ``most``, if there is one."""
        best, least = None, most
        for candidate in candidates:
            if candidate.cost >= least:
                break
            box = candidate.box
            on_carrier = box.shared(self._carriers) >= 0.999 * box.area
            leader = None if candidate.inside else _leader(box, self._own, is_needed=self.is_carried)
            total = candidate.cost + self._cost(candidate, on_carrier, leader)
            if total < least and (leader is None or self._is_clear(leader)):
                best, least = NamePlace(box, candidate.rotation, leader), total
        return best

    def _cost(self, candidate: _Candidate, on_carrier: NDArray[np.bool_], leader: Segment | None) -> float:
        """Return the cost of what a place covers and of what its line leaves."""
        box = candidate.box
        # A name on its thing may cover what that lies on, and one beside it only what it lies on wholly.
        beneath = self._foreign if candidate.inside else np.vstack([self._foreign, self._carriers[~on_carrier]])
        total = COVERED * float(box.shared(beneath).sum()) / box.area
        touched = float(self._arrows.touched(np.array([box]))[0])
        total += ON_ARROW * bool(touched) + ARROW_LENGTH * touched
        total += COVERED_EDGE * float(_covered_edges(np.array([box]), self._all)[0])
        if candidate.inside:
            return total
        total += IN_THE_WAY * box.in_the_way_of(self._all)
        if leader is not None:
            total += ACROSS_ARROW * self._arrows.along(leader)
            total += ON_ANOTHER * bool(on_carrier.any())
            return total + OVER_AN_EDGE * int(crosses(leader, self._carriers[~on_carrier]).sum())
        return total + NEARER_TO_ANOTHER * _seems_another(box, self._own, self._foreign)

    def _is_clear(self, leader: Segment) -> bool:
        """Return True if a line enters no foreign thing and no name, and meets no other line."""
        obstacles = np.vstack([self._foreign, self._names])
        return not crosses(leader, obstacles).any() and not any(_meet(leader, other) for other in self._leaders)


def _seems_another(name: Box, own: Box, others: NDArray[np.float64]) -> bool:
    """Return True if the middle of a name is nearer to one of the boxes (n, 4) than to that of its own thing."""
    middle = np.array(name.middle)
    boxes = np.vstack([np.array([own]), others])
    outside = np.maximum(np.maximum(boxes[:, :2] - middle, middle - boxes[:, 2:]), 0.0)
    distances = np.hypot(*outside.T)
    return bool(distances[1:].min(initial=np.inf) < distances[0])


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


def _leader(box: Box, outline: Box, is_needed: bool) -> Segment | None:
    """Return the line from a name's nearest point to one well inside its thing; None if they are close."""
    across = max(outline.left - box.right, box.left - outline.right, 0.0)
    along = max(outline.low - box.high, box.low - outline.high, 0.0)
    if max(across, along) <= LEADER and not is_needed:
        return None
    inset_x, inset_y = 0.15 * (outline.right - outline.left), 0.15 * (outline.high - outline.low)
    x0 = min(max((outline.left + outline.right) / 2, box.left), box.right)
    y0 = min(max((outline.low + outline.high) / 2, box.low), box.high)
    x1 = min(max(x0, outline.left + inset_x), outline.right - inset_x)
    y1 = min(max(y0, outline.low + inset_y), outline.high - inset_y)
    return (x0, y0), (x1, y1)


def _meet(first: Segment, second: Segment) -> bool:
    """Return True if two segments cross."""

    def side(line: Segment, point: tuple[float, float]) -> float:
        (x0, y0), (x1, y1) = line
        return (x1 - x0) * (point[1] - y0) - (y1 - y0) * (point[0] - x0)

    return side(first, second[0]) * side(first, second[1]) < 0 and side(second, first[0]) * side(second, first[1]) < 0


def word_places(
    arrows: Sequence[NDArray[np.float64]],
    sizes: Sequence[tuple[float, float]],
    outlines: NDArray[np.float64],
    names: Sequence[NamePlace],
    frame: Box,
    pixels: ArrowPixels,
) -> list[Box | None]:
    """Find places for the words of arrows, after the names have theirs.

    Parameters
    ----------
    arrows
        Points along each arrow, in pixels, each of shape (k, 2).
    sizes
        Width and height of each word, in pixels.
    outlines
        Boxes of the things, in pixels, shape (n, 4).
    names
        Places of the names.
    frame
        Area within which words must stand.
    pixels
        Pixels of these and all other arrows, which words should not touch.

    Returns
    -------
    list of Box or None
        The place of each word; None for one that would cover a name or a line everywhere.
    """
    taken = [place.box for place in names]
    leaders = [place.leader for place in names if place.leader is not None]
    found: list[Box | None] = []
    for index, (path, size) in enumerate(zip(arrows, sizes, strict=True)):
        boxes, cost = _beside(path, *size)
        touched = pixels.touched(boxes)
        cost = cost + EDGE * _covered_edges(boxes, outlines) + WORD_ON_ARROW * (touched > 0) + ARROW_LENGTH * touched
        others = [other for number, other in enumerate(arrows) if number != index]
        if others:
            own, another = _distances(boxes, path), _distances(boxes, np.vstack(others))
            cost += AT_ANOTHER * (another < own)
        outside = _shared(boxes, np.array([frame]))[:, 0] < 0.999 * size[0] * size[1]
        blocked = outside | _shared(boxes, np.array(taken).reshape(-1, 4)).any(axis=1)
        for leader in leaders:
            blocked |= crosses(leader, boxes)
        cost[blocked] = np.inf
        best = int(cost.argmin())
        found.append(None if np.isinf(cost[best]) else Box(*boxes[best].tolist()))
        taken += [box for box in found[-1:] if box is not None]
    return found


def _beside(path: NDArray[np.float64], width: float, height: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return boxes (m, 4) for a word beside its arrow and on it, and their costs (m,) by how far off they are."""
    half = np.array([width, height]) / 2
    boxes, cost = [], []
    for share in SHARES:
        point = path[round(share * (len(path) - 1))]
        for (dx, dy), away in [((0.0, 0.0), 0.0), *product(AROUND, AWAY)]:
            middle = point + np.array([dx, dy]) * (half + away)
            boxes.append(np.hstack([middle - half, middle + half]))
            cost.append(2 * OFF_MIDDLE * abs(share - 0.5) + away)
    return np.array(boxes), np.array(cost)


def _shared(boxes: NDArray[np.float64], others: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the areas (m, n) in common between boxes (m, 4) and others (n, 4)."""
    low = np.maximum(boxes[:, None, :2], others[:, :2])
    high = np.minimum(boxes[:, None, 2:], others[:, 2:])
    areas: NDArray[np.float64] = np.maximum(high - low, 0.0).prod(axis=2)
    return areas


def _covered_edges(boxes: NDArray[np.float64], outlines: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the length of the edges of outlines (n, 4) within each of some boxes (m, 4), shape (m,)."""
    low = np.maximum(boxes[:, None, :2], outlines[:, :2])
    high = np.minimum(boxes[:, None, 2:], outlines[:, 2:])
    common = np.maximum(high - low, 0.0)
    length = np.zeros(len(boxes))
    for axis, side in product((0, 1), (0, 2)):
        edge = outlines[:, axis + side]
        within = (boxes[:, None, axis] < edge) & (edge < boxes[:, None, axis + 2])
        length += np.where(within, common[:, :, 1 - axis], 0.0).sum(axis=1)
    return length


def _distances(boxes: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the distance from the middle of each box (m, 4) to the nearest of some points (k, 2), shape (m,)."""
    middles = (boxes[:, :2] + boxes[:, 2:]) / 2
    distances: NDArray[np.float64] = np.linalg.norm(middles[:, None] - points, axis=2).min(axis=1)
    return distances
