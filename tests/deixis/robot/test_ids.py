"""Check descriptions that call things by their ids."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

import deixis
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.ids import IdError, with_names
from deixis.robot.robot import Told
from deixis.workflows.knowledge.unlearn import Selection

LOW: list[list[float]] = [[0, 0, 0], [0.1, 0, 0], [0.4, 0, 0], [0.5, 0, 0]]
HIGH: list[list[float]] = [[0.03, 0.2, 0.02], [0.35, 0.25, 0.02], [0.43, 0.2, 0.02], [0.53, 0.2, 0.02]]
SUPPER = "This is how 'supper' is laid. The fork is left of the plate and the knife is right of the plate."


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[deixis.Robot]:
    """Robot that knows a fork (o1), a plate (o2) and a knife (o3), but not the thing on the right (o4)."""
    with deixis.Robot(tmp_path / "memory") as robot:
        robot.sees(deixis.Scene.from_boxes(LOW, HIGH, labels=["fork", "plate", "knife", None]), at=0.0)
        robot.told(SUPPER, at=1.0)
        yield robot


def test_an_id_stands_for_the_name_of_its_thing(robot: deixis.Robot) -> None:
    for text in ("o1 is left of o2.", "layout place; o1 left of o2", "The o1 is left of the plate"):
        told = robot.told(text, at=2.0)
        assert isinstance(told, Told)
        assert {role: known.thing for role, known in told.lesson.settled.items()} == {"fork": "o1", "plate": "o2"}


def test_an_id_settles_which_of_like_things_is_meant(robot: deixis.Robot) -> None:
    robot.sees(deixis.Scene.from_boxes(LOW, HIGH, labels=["fork", "plate", "knife", "fork"]), at=2.0)
    told = robot.told("layout place; o4 right of plate; knife right of plate", at=3.0)
    assert isinstance(told, Told)
    assert told.lesson.settled["fork"].thing == "o4"


def test_an_id_may_be_a_landmark_of_an_expected_object(robot: deixis.Robot) -> None:
    expected = robot.told("There is a cup behind o2", at=2.0)
    assert isinstance(expected, tuple)
    assert [(each.name, each.text) for each in expected] == [("cup", "There is a cup behind the plate")]


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("o4 is right of o2", "o4 has no name yet; say what it is first"),
        ("o9 is right of o2", "no thing 'o9' is in view; there are: o1, o2, o3, o4"),
    ],
)
def test_an_id_without_a_name_or_a_thing_is_refused(robot: deixis.Robot, text: str, reason: str) -> None:
    with pytest.raises(IdError, match=reason):
        robot.told(text, at=2.0)
    assert list(robot.layouts) == ["supper"]
    assert len(robot.diary.board.holding(Pattern(predicate="said"))) == 1


def test_two_things_of_one_name_are_not_told_apart() -> None:
    with pytest.raises(IdError, match="t2 and t5 are both called 'fork'"):
        with_names("t2 is left of T5", ["t2", "t5"], default_ontology(), lambda _: "fork")


def test_other_words_with_digits_are_not_ids() -> None:
    for text in ("fork2 is left of plate1", "It is 3cm from the A4 sheet", "t20x is left of the plate"):
        assert with_names(text, ["t2", "fork2"], default_ontology(), lambda _: "cup").text == text


def test_a_lesson_is_taken_back_by_the_words_as_they_were_said(robot: deixis.Robot) -> None:
    robot.told("layout place; o1 left of o2", at=2.0)
    assert robot.unlearn(Selection(sentence="layout place; o1 left of o2")).lessons == ("place-1",)
    assert robot.unlearn(Selection(sentence=SUPPER)).lessons == ("supper-1",)
    assert not robot.layouts
