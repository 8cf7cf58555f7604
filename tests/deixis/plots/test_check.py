"""Marks in the picture of a checked table."""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.check import marks_of
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

PLATE = PerceivedObject("p", (0.15, 0.0), (0.4, 0.25), label="plate")


@pytest.mark.parametrize(
    ("x", "wrong"), [pytest.param(0.0, set(), id="in place"), pytest.param(0.6, {"n", "p"}, id="misplaced")]
)
def test_a_wrong_colour_is_marked_separately_from_a_wrong_place(x: float, wrong: set[str]) -> None:
    red = PerceivedObject("n", (x, 0.1), (x + 0.1, 0.2), label="napkin", colour=(192, 32, 32))
    script = read_script(text="napkin is white; napkin left of plate")
    marks = marks_of(Session(Path("unused")).check(script, Scene((red, PLATE), unit="m")))
    assert set(marks.miscoloured) == {"n"}
    assert set(marks.wrong) <= wrong and ("n" in marks.wrong) == bool(wrong)
