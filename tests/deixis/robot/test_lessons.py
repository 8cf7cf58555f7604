"""Test what waits in a lesson, and the questions about it."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.scene import PerceivedObject, Scene
from deixis.robot.lessons import Settled, SettledBy, TableLesson
from deixis.robot.robot import Robot, RobotError

SCENE = Scene(tuple(PerceivedObject(f"o{i}", (i, 0.0, 0.0), (i + 0.5, 0.5, 0.1)) for i in range(3)))


def lesson() -> TableLesson:
    waiting: dict[str, dict[str | None, float]] = {"fork": {"o0": 0.5, "o1": 0.5}, "spoon": {"o2": 0.98, None: 0.02}}
    return TableLesson(0, "tea", SCENE, {}, waiting)


def test_question_with_most_information_comes_first() -> None:
    first, second = lesson().questions()
    assert first.role == "fork"
    assert first.gain == pytest.approx(np.log(2))
    assert second.gain < 0.2
    assert "o0 (0.50)" in first.why


def test_settled_thing_leaves_the_other_roles() -> None:
    known = lesson().with_settled("spoon", Settled("o1", SettledBy.ANSWER, 1.0))
    assert "spoon" not in known.waiting
    (question,) = known.questions()
    assert dict(question.among) == {"o0": 0.5, None: 0.5}


def test_absent_thing_waits_no_more() -> None:
    known = lesson().with_settled("fork", None)
    assert "fork" not in known.waiting
    assert "fork" not in known.settled


def test_robot_must_see_a_table_first(tmp_path) -> None:  # type: ignore[no-untyped-def]
    robot = Robot(tmp_path)
    with pytest.raises(RobotError, match="must see a table first"):
        robot.names()
    with pytest.raises(RobotError, match="boxes with heights"):
        robot.sees(Scene((PerceivedObject("o1", (0.0, 0.0), (1.0, 1.0)),)))
    robot.close()
