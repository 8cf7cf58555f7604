"""Where the arrows of a picture begin and end."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import PerceivedObject
from deixis.plots.arrows import DIRECTIONS, Ends, Point, arrow_path, directions, draw_arrows
from deixis.plots.grounding import scene_figure

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
def test_an_arrow_is_visible_and_connects_boxes_in_any_position(other: PerceivedObject) -> None:
    for subject, object in ((PLATE, other), (other, PLATE)):
        subject, object = replace(subject, id="subject"), replace(object, id="object")
        start, end = Ends([subject, object]).arrow("subject", "object")
        assert math.dist(start, end) > 0.5
        assert all(subject.minimum[k] <= start[k] <= subject.maximum[k] for k in (0, 1))
        assert all(object.minimum[k] <= end[k] <= object.maximum[k] for k in (0, 1))


def held(point: Point, thing: PerceivedObject) -> bool:
    return all(thing.minimum[k] < point[k] < thing.maximum[k] for k in (0, 1))


def test_an_arrow_avoids_objects_that_lie_on_its_end_points() -> None:
    book, pen = replace(box(0, 0, 20, 30), id="book"), replace(box(3, 14, 20, 16), id="pen")
    keyboard = replace(box(40, 5, 80, 25), id="keyboard")
    ends = Ends([book, pen, keyboard])
    start, end = ends.arrow("book", "keyboard")
    assert held(start, book) and not held(start, pen) and held(end, keyboard)
    start, end = ends.arrow("pen", "book")
    assert held(start, pen) and held(end, book) and not held(end, pen)


def test_an_arrow_ends_beside_other_things_on_its_object() -> None:
    saucer, spoon = replace(box(0, 0, 15, 15), id="saucer"), replace(box(0.5, 1, 3, 14), id="spoon")
    cup = replace(box(4, 4, 12, 12), id="cup")
    start, end = Ends([spoon, cup, saucer]).arrow("cup", "saucer")
    assert held(start, cup) and held(end, saucer) and not held(end, spoon) and not held(end, cup)


def test_a_thing_that_cannot_be_seen_has_its_arrow_nevertheless() -> None:
    under, over = replace(box(0, 0, 10, 10), id="under"), replace(box(0, 0, 10, 10), id="over")
    start, _ = Ends([under, over]).arrow("under", "over")
    assert held(start, under)


def test_the_path_of_an_arrow_lies_where_it_is_drawn() -> None:
    axes = Figure(figsize=(4.0, 4.0)).add_subplot()
    axes.set(xlim=(0, 1), ylim=(0, 1), aspect="equal")
    arrow = ((0.1, 0.2), (0.8, 0.5))
    draw_arrows(axes, [arrow], "black", 1.0, 1)
    (drawn,) = axes.patches
    start, control, _ = np.asarray(drawn.get_path().vertices)[:3]
    points = arrow_path(arrow)
    assert start == pytest.approx(arrow[0]) and points[[0, -1]] == pytest.approx(np.array(arrow))
    middle = (np.array(arrow[0]) + 2 * control + np.array(arrow[1])) / 4  # of a quadratic Bezier curve
    assert np.linalg.norm(points - middle, axis=1).min() < 0.01


def test_the_direction_of_a_thing_is_drawn_and_explained() -> None:
    knife = {"id": "o1", "label": "knife", "min": [0.0, 0.0], "max": [0.03, 0.2]}
    known = knife | {"heading": {"part": "head", "direction": [0, 1], "probability": 0.98}}
    ((start, end),) = directions(read_scene({"objects": [known]}))
    assert start == pytest.approx((0.015, 0.135)) and end == pytest.approx((0.015, 0.195))
    for thing, is_explained in ((known, True), (knife, False)):
        (axes,) = scene_figure(read_scene({"objects": [thing]})).axes
        assert (DIRECTIONS in axes.get_xlabel()) is is_explained
