"""Where the arrows of a picture begin and end."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from deixis.perception.scene import PerceivedObject
from deixis.plot_arrows import Ends, Point

PLATE = PerceivedObject("plate", (0.0, 0.0), (10.0, 10.0))


def box(x: float, y: float, right: float, top: float) -> PerceivedObject:
    return PerceivedObject("o", (x, y), (right, top))


@pytest.mark.parametrize(
    "other",
    [
        pytest.param(box(12, 2, 14, 8), id="apart"),
        pytest.param(box(10, 2, 14, 8), id="touching"),
        pytest.param(box(10, 10, 14, 14), id="touching at a corner"),
        pytest.param(box(8, 2, 14, 8), id="overlapping"),
        pytest.param(box(8, 8, 14, 14), id="overlapping at a corner"),
        pytest.param(box(2, 2, 8, 8), id="within"),
        pytest.param(box(-2, -2, 12, 12), id="around"),
        pytest.param(box(-2, 2, 12, 8), id="across"),
    ],
)
def test_an_arrow_can_be_seen_however_two_boxes_lie_and_leads_from_one_to_the_other(other: PerceivedObject) -> None:
    for subject, object in ((PLATE, other), (other, PLATE)):
        subject, object = replace(subject, id="subject"), replace(object, id="object")
        start, end = Ends([subject, object]).arrow("subject", "object")
        assert math.dist(start, end) > 0.5
        assert all(subject.minimum[k] <= start[k] <= subject.maximum[k] for k in (0, 1))
        assert all(object.minimum[k] <= end[k] <= object.maximum[k] for k in (0, 1))


def held(point: Point, thing: PerceivedObject) -> bool:
    return all(thing.minimum[k] < point[k] < thing.maximum[k] for k in (0, 1))


def test_an_arrow_does_not_begin_or_end_where_something_lies_on_its_thing() -> None:
    book, pen = replace(box(0, 0, 20, 30), id="book"), replace(box(3, 14, 20, 16), id="pen")
    keyboard = replace(box(40, 5, 80, 25), id="keyboard")
    ends = Ends([book, pen, keyboard])
    start, end = ends.arrow("book", "keyboard")
    assert held(start, book) and not held(start, pen) and held(end, keyboard)
    start, end = ends.arrow("pen", "book")
    assert held(start, pen) and held(end, book) and not held(end, pen)


def test_an_arrow_ends_beside_what_shares_the_place_of_its_object() -> None:
    saucer, spoon = replace(box(0, 0, 15, 15), id="saucer"), replace(box(0.5, 1, 3, 14), id="spoon")
    cup = replace(box(4, 4, 12, 12), id="cup")
    start, end = Ends([spoon, cup, saucer]).arrow("cup", "saucer")
    assert held(start, cup) and held(end, saucer) and not held(end, spoon) and not held(end, cup)


def test_a_thing_that_cannot_be_seen_has_its_arrow_nevertheless() -> None:
    under, over = replace(box(0, 0, 10, 10), id="under"), replace(box(0, 0, 10, 10), id="over")
    start, _ = Ends([under, over]).arrow("under", "over")
    assert held(start, under)
