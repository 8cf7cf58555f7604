"""Places of names and words, on generated tables of boxes in pixels."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.plots.arrows import arrow_path
from deixis.plots.placement import (
    ARROW_MARGIN,
    WITHIN,
    ArrowPixels,
    Box,
    NamePlace,
    _covered_edges,
    _meet,
    _seems_another,
    crosses,
    name_places,
    word_places,
)

FRAME = Box(0.0, 0.0, 800.0, 500.0)
NO_ARROWS = ArrowPixels([], FRAME)
Name = tuple[float, float]

names = st.tuples(st.integers(15, 130).map(float), st.integers(12, 26).map(float))
shares = st.integers(0, 100).map(lambda percent: percent / 100)


@st.composite
def boxes_within(draw: st.DrawFn, outer: Box, least: float) -> Box:
    """Draw a box within another one, with sides of a minimum length."""
    width = least + draw(shares) * max(outer.right - outer.left - least, 0.0) * 0.5
    height = least + draw(shares) * max(outer.high - outer.low - least, 0.0) * 0.5
    left = outer.left + draw(shares) * max(outer.right - outer.left - width, 0.0)
    low = outer.low + draw(shares) * max(outer.high - outer.low - height, 0.0)
    return Box(left, low, left + width, low + height)


@st.composite
def tables(draw: st.DrawFn) -> NDArray[np.float64]:
    """Draw boxes of shape (n, 4), of which some lie on others and some overlap."""
    boxes: list[Box] = []
    for _ in range(draw(st.integers(1, 6))):
        outer = draw(st.sampled_from([FRAME, *boxes]))
        boxes.append(draw(boxes_within(outer, 8.0)))
    return np.array(boxes)


def placed(table: NDArray[np.float64], sizes: list[Name], arrows: ArrowPixels = NO_ARROWS) -> list[NamePlace]:
    places = name_places(table, sizes, FRAME, arrows)
    assert len(places) == len(table)
    return [place for place in places if place is not None]


@given(tables(), st.lists(names, min_size=6, max_size=6))
def test_no_two_names_share_a_place(table: NDArray[np.float64], sizes: list[Name]) -> None:
    boxes = [place.box for place in placed(table, sizes[: len(table)])]
    for box, other in combinations(boxes, 2):
        assert box.shared(np.array([other]))[0] == 0
    for box in boxes:
        assert box.shared(np.array([FRAME]))[0] >= 0.99 * box.area


@given(tables(), st.lists(names, min_size=6, max_size=6))
def test_lines_enter_nothing_foreign(table: NDArray[np.float64], sizes: list[Name]) -> None:
    places = name_places(table, sizes[: len(table)], FRAME, NO_ARROWS)
    lines = [place.leader for place in places if place is not None and place.leader is not None]
    for number, place in enumerate(places):
        if place is None or place.leader is None:
            continue
        own = Box(*table[number])
        is_foreign = own.shared(table) < WITHIN * own.area
        assert not crosses(place.leader, table[is_foreign]).any()
        others = [other.box for other in places if other is not None and other is not place]
        assert not crosses(place.leader, np.array(others).reshape(-1, 4)).any()
    assert not any(_meet(line, other) for line, other in combinations(lines, 2))


@given(boxes_within(Box(60.0, 60.0, 740.0, 440.0), 10.0), names)
def test_a_thing_on_a_tray_has_its_name_on_the_tray(thing: Box, size: Name) -> None:
    tray = Box(5.0, 5.0, 795.0, 495.0)
    named, _ = name_places(np.array([thing, tray]), [size, (60.0, 14.0)], FRAME, NO_ARROWS)
    assert named is not None
    assert named.box.shared(np.array([tray]))[0] >= 0.999 * named.box.area
    is_on_thing = bool(named.box.shared(np.array([thing]))[0] > 0)
    assert (named.leader is None) is is_on_thing


def test_a_line_leaves_a_tray_that_has_no_room() -> None:
    tray, cup = Box(300.0, 200.0, 340.0, 240.0), Box(310.0, 210.0, 330.0, 230.0)
    named, _ = name_places(np.array([cup, tray]), [(100.0, 14.0), (100.0, 14.0)], FRAME, NO_ARROWS)
    assert named is not None and named.leader is not None
    assert not named.box.shared(np.array([tray])).any()


def arrow_between(table: NDArray[np.float64], first: int, second: int) -> NDArray[np.float64]:
    middles = (table[:, :2] + table[:, 2:]) / 2
    return np.asarray(np.linspace(middles[first], middles[second], 40))


def is_free(box: Box, table: NDArray[np.float64], names: list[NamePlace], arrow: NDArray[np.float64]) -> bool:
    """Return True if a word covers nothing there: no edge, name, line or end of its arrow, with a margin."""
    wide = np.array([[box.left - 4, box.low - 4, box.right + 4, box.high + 4]])
    lines = [place.leader for place in names if place.leader is not None]
    ends = np.hstack([arrow[[0, -1]] - 8, arrow[[0, -1]] + 8])
    is_inside = box.shared(np.array([FRAME]))[0] >= 0.999 * box.area
    covers_names = Box(*wide[0]).shared(np.array([place.box for place in names]).reshape(-1, 4)).any()
    covers_lines = any(crosses(line, wide)[0] for line in lines)
    covers_edges = _covered_edges(wide, table)[0] > 0
    return bool(is_inside and not (covers_names or covers_lines or covers_edges or box.shared(ends).any()))


def is_touched(box: Box, arrows: list[NDArray[np.float64]], margin: float) -> bool:
    """Say if an arrow comes nearer to a box than a margin, by places along it that are a twentieth of a piece apart."""
    share = np.linspace(0.0, 1.0, 20)[:, None, None]
    for arrow in arrows:
        x, y = ((1 - share) * arrow[:-1] + share * arrow[1:]).reshape(-1, 2).T
        inside = (box.left - margin < x) & (x < box.right + margin) & (box.low - margin < y) & (y < box.high + margin)
        if inside.any():
            return True
    return False


@st.composite
def tables_with_arrows(draw: st.DrawFn) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]:
    """Draw boxes, and bent arrows between some of them."""
    table = draw(tables())
    middles = (table[:, :2] + table[:, 2:]) / 2
    pairs = draw(st.lists(st.permutations(range(len(table))), max_size=6)) if len(table) > 1 else []
    ends = [(tuple(middles[pair[0]].tolist()), tuple(middles[pair[1]].tolist())) for pair in pairs]
    return table, [arrow_path((start, end)) for start, end in ends if math.dist(start, end) > 10]


@given(tables_with_arrows(), st.lists(names, min_size=6, max_size=6))
def test_a_name_on_its_thing_touches_an_arrow_only_if_it_must(
    scene: tuple[NDArray[np.float64], list[NDArray[np.float64]]], sizes: list[Name]
) -> None:
    table, arrows = scene
    places = name_places(table, sizes[: len(table)], FRAME, ArrowPixels(arrows, FRAME))
    taken = [place.box for place in places if place is not None]
    lines = [place.leader for place in places if place is not None and place.leader is not None]
    for thing, (width, height), place in zip(table.tolist(), sizes, places, strict=False):
        if place is None or not is_touched(place.box, arrows, ARROW_MARGIN - 1.0):
            continue
        left, low, right, high = thing
        if right - left < width or high - low < height:
            continue
        for x in (left, (left + right - width) / 2, right - width):
            for y in (low, (low + high - height) / 2, high - height):
                wide = np.array([[x - 1, y - 1, x + width + 1, y + height + 1]])
                free = Box(x, y, x + width, y + height)
                others = np.array([box for box in taken if box is not place.box]).reshape(-1, 4)
                assert (
                    is_touched(free, arrows, ARROW_MARGIN + 1.0)
                    or Box(*wide[0]).shared(others).any()
                    or any(crosses(line, wide)[0] for line in lines)
                    or free.shared(table[(table != thing).any(axis=1)]).any()
                )


@given(tables_with_arrows(), st.integers(0, 700), st.integers(0, 450), names)
def test_counted_pixels_agree_with_the_geometry_of_arrows(
    scene: tuple[NDArray[np.float64], list[NDArray[np.float64]]], x: int, y: int, size: Name
) -> None:
    _, arrows = scene
    box = Box(x, y, x + size[0], y + size[1])
    touched = bool(ArrowPixels(arrows, FRAME).touched(np.array([box]))[0])
    if is_touched(box, arrows, ARROW_MARGIN - 1.0):
        assert touched
    if not is_touched(box, arrows, ARROW_MARGIN + 1.0):
        assert not touched


def test_a_name_moves_aside_for_an_arrow_across_its_thing() -> None:
    thing, arrow = Box(300.0, 200.0, 460.0, 220.0), np.array([[380.0, 100.0], [380.0, 400.0]])
    (named,) = placed(np.array([thing]), [(60.0, 14.0)], ArrowPixels([arrow], FRAME))
    assert thing.left <= named.box.left and named.box.right <= thing.right
    assert named.box.right < 377 or named.box.left > 383


@given(tables(), st.lists(names, min_size=6, max_size=6), names)
def test_a_word_covers_an_edge_only_if_it_must(table: NDArray[np.float64], sizes: list[Name], word: Name) -> None:
    arrow = arrow_between(table, 0, len(table) - 1)
    pixels = ArrowPixels([arrow], FRAME)
    named = placed(table, sizes[: len(table)], pixels)
    (box,) = word_places([arrow], [word], table, named, FRAME, pixels)
    width, height = word
    beside = [
        Box(x + dx - width / 2, y + dy - height / 2, x + dx + width / 2, y + dy + height / 2)
        for x, y in arrow[[12, 16, 20, 24, 28]].tolist()
        for dx, dy in ((0, height / 2 + 8), (0, -height / 2 - 8), (width / 2 + 8, 0), (-width / 2 - 8, 0))
    ]
    if any(is_free(place, table, named, arrow) for place in beside):
        assert box is not None and _covered_edges(np.array([box]), table)[0] == 0
    if box is not None:
        assert not box.shared(np.array([place.box for place in named]).reshape(-1, 4)).any()
        assert not any(crosses(place.leader, np.array([box]))[0] for place in named if place.leader is not None)


@given(tables(), names, names)
def test_words_of_two_arrows_share_no_place(table: NDArray[np.float64], first: Name, second: Name) -> None:
    arrows = [arrow_between(table, 0, len(table) - 1), arrow_between(table, len(table) - 1, 0)]
    boxes = word_places(arrows, [first, second], table, [], FRAME, ArrowPixels(arrows, FRAME))
    if boxes[0] is not None and boxes[1] is not None:
        assert boxes[0].shared(np.array([boxes[1]]))[0] == 0


def test_a_word_stands_at_its_own_arrow() -> None:
    paths = [np.linspace((100.0, y), (600.0, y), 40) for y in (200.0, 224.0)]
    boxes = word_places(paths, [(40.0, 14.0)] * 2, np.empty((0, 4)), [], FRAME, ArrowPixels(paths, FRAME))
    lower, upper = (box.middle[1] for box in boxes if box is not None)
    assert abs(lower - 200.0) < abs(lower - 224.0) and abs(upper - 224.0) < abs(upper - 200.0)


def test_a_name_beside_another_thing_has_a_line_to_its_own() -> None:
    own, other = Box(0, 0, 10, 100), np.array([[30.0, 0.0, 90.0, 40.0]])
    assert _seems_another(Box(20, 45, 80, 55), own, other)
    assert not _seems_another(Box(12, 60, 40, 70), own, other)
