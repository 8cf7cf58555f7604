"""Test that a layout without a name is noticed when it comes again, and learned when a person names it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from deixis.perception.scene import OrientedBox, PerceivedObject, Scene
from deixis.robot.robot import Robot

SIZES = ((0.2, 0.2, 0.02), (0.03, 0.2, 0.02), (0.08, 0.08, 0.1), (0.12, 0.05, 0.04))
ROW = ((0.0, 0.0), (-0.2, 0.0), (0.1, 0.3), (0.3, 0.0))
HEAP = ((0.3, 0.3), (0.0, 0.0), (0.0, 0.3), (-0.3, -0.2))


def table(number: int, places: tuple[tuple[float, float], ...] = ROW) -> Scene:
    """Return four unknown things near some places, in another order of ids on each table."""
    random = np.random.default_rng(number)
    things = []
    for id, thing in enumerate(random.permutation(len(places))):
        size = np.array(SIZES[thing])
        centre = np.array((*places[thing], size[2] / 2)) + np.append(random.normal(0, 0.012, 2), 0.0)
        box = OrientedBox(tuple(centre.tolist()), 0.0, tuple(size.tolist()))
        low, high = (tuple((centre + sign * size / 2).tolist()) for sign in (-1, 1))
        things.append(PerceivedObject(f"o{id}", low, high, oriented=box))
    return Scene(tuple(things), file=f"<table {number}>")


def test_layout_that_comes_again_is_asked_for_and_learned(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    for number in range(3):
        assert robot.layout_question is None
        robot.sees(table(number))
    question = robot.layout_question
    assert question is not None
    assert question.text == "I have seen 3 tables like this; what is it called?"
    lessons = robot.name_layout(question, "work place", by="Ada")
    assert [lesson.layout for lesson in lessons] == ["work_place"] * 3
    assert robot.layouts["work_place"].experience.tables == 3
    assert (robot.layout(), robot.layout_question, robot.unnamed) == ("work_place", None, [])
    robot.close()
    again = Robot(tmp_path)
    again.sees(table(7))
    assert again.layout() == "work_place"
    assert again.check() == ()
    again.close()


def test_frames_while_a_table_is_laid_count_once(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    for kept in (2, 3, 4, 4, 3, 1, 0):
        whole = table(1)
        robot.sees(replace(whole, objects=whole.objects[:kept]))
    robot.sees(table(2, HEAP))
    robot.sees(table(3))
    assert robot.layout_question is None
    assert [len(kind.tables) for kind in robot.unnamed] == [1, 1]
    robot.close()


def test_person_who_gives_no_name_is_not_asked_again(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    for number in range(3):
        robot.sees(table(number))
    question = robot.layout_question
    assert question is not None
    assert robot.name_layout(question, None) == ()
    assert robot.layout_question is None
    robot.sees(table(5))
    assert robot.layout_question is None
    robot.close()
