"""What the picture of a grounded scene shows: arrows, legend, axes."""

from __future__ import annotations

import math

import pytest
from matplotlib.figure import Figure

from deixis.grammar.parser import parse_script
from deixis.perception.scene import PerceivedObject, Scene
from deixis.plot import _arrow, grounding_figure
from deixis.session import ground

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
        start, end = _arrow(subject, object)
        assert math.dist(start, end) > 0.5
        assert all(subject.minimum[k] <= start[k] <= subject.maximum[k] for k in (0, 1))
        assert all(object.minimum[k] <= end[k] <= object.maximum[k] for k in (0, 1))


def picture(script: str, unit: str = "m", viewpoint: str = "chair", frame: str = "table") -> Figure:
    things = PerceivedObject("a", (0, 0), (4, 6), label="cup"), PerceivedObject("b", (5, 0), (20, 8), label="plate")
    scene = Scene(things, frame=frame, viewpoint=viewpoint, unit=unit)
    return grounding_figure(ground(parse_script(script), scene), scene)


def legend(figure: Figure) -> list[str]:
    shown = figure.axes[0].get_legend()
    return [] if shown is None else [text.get_text() for text in shown.get_texts()]


def test_the_legend_says_what_there_is() -> None:
    assert legend(picture("cup left of plate")) == ["1 fact satisfied"]
    assert legend(picture("cup right of plate")) == ["1 violated"]


@pytest.mark.parametrize(
    ("unit", "viewpoint", "frame", "across", "along"),
    [
        ("m", "chair", "table", "metres, to the right as seen from the chair", "metres, away from the chair"),
        ("px", "chair", "table", "pixels, to the right as seen from the chair", "pixels, away from the chair"),
        ("px", "camera", "table", "pixels, to the right", "pixels, up"),
        ("px", "chair", "image", "pixels, to the right", "pixels, up"),
    ],
)
def test_what_the_axes_mean_is_that_of_the_scene(
    unit: str, viewpoint: str, frame: str, across: str, along: str
) -> None:
    axes = picture("cup left of plate", unit, viewpoint, frame).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == (across, along)
