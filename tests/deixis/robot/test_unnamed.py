"""Test that a layout without a name is noticed when it comes again, and learned when a person names it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import finish_recording, start_recording
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.modules import ModuleSpec
from deixis.robot.robot import Robot
from deixis.robot.runtime import Runtime
from deixis.workflows.scenes.perceive import write_scene

SIZES = ((0.2, 0.2, 0.02), (0.03, 0.2, 0.02), (0.08, 0.08, 0.1), (0.12, 0.05, 0.04))
LABELS = dict(zip(SIZES, ("plate", "fork", "cup", "napkin"), strict=True))
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


def test_tables_without_a_name_survive_a_restart(tmp_path: Path) -> None:
    for number in range(2):
        robot = Robot(tmp_path)
        robot.sees(table(number))
        robot.close()
    robot = Robot(tmp_path)
    assert [len(kind.tables) for kind in robot.unnamed] == [2]
    robot.sees(table(1))  # it lies there still
    assert robot.layout_question is None
    robot.sees(table(2))
    question = robot.layout_question
    assert question is not None
    robot.name_layout(question, "work place", by="Ada")
    assert robot.layouts["work_place"].experience.tables == 3
    robot.close()
    again = Robot(tmp_path)
    assert (again.unnamed, again.layouts["work_place"].experience.tables) == ([], 3)
    again.close()


def test_refused_name_is_not_asked_for_after_a_restart(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    for number in range(3):
        robot.sees(table(number))
    question = robot.layout_question
    assert question is not None
    robot.name_layout(question, None)
    robot.close()
    again = Robot(tmp_path)
    again.sees(table(5))
    assert again.layout_question is None
    again.close()


def record(robot: Robot, name: str, number: int, said: str | None, at: float) -> None:
    """Record an experience of a table, and what a person said in it."""
    with Blackboard.open(robot.session.path, create=True) as board:

        def add(subject: str, predicate: str, value: str, source: Source, finish: float) -> None:
            fluent = episodic(
                board.new_id("x"), (subject, predicate, value), start=at + 1, finish=finish, source=source
            )
            board.add(fluent, by="test")

        start_recording(board, name, at, by="test")
        seen = Source(Origin.SEEN, "camera")
        for thing in table(number).objects:
            assert thing.oriented is not None
            add(f"{name} {thing.id}", "at", json.dumps([*thing.minimum, *thing.maximum]), seen, at + 3)
            if said is not None:
                add(f"{name} {thing.id}", "isA", LABELS[thing.oriented.extents], seen, at + 3)
        if said is not None:
            add("Ada", "said", said, Source(Origin.SAID, "Ada"), at + 1.1)
        finish_recording(board, name, at + 2, by="test")


def test_experiences_add_to_the_counts_of_one_layout(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    words = "This is how a work place is laid. The fork is left of the plate."
    for number, name in enumerate(("monday", "tuesday")):
        record(robot, name, number, words, 10.0 * number)
    assert robot.consolidate().lessons == {"monday": "work_place-1", "tuesday": "work_place-2"}
    assert robot.consolidate().lessons == {}
    layout = robot.layouts["work_place"]
    assert (layout.experience.tables, layout.experience.held["left", "fork", "plate"].held) == (2, 2)
    robot.remember()
    assert robot.layouts["work_place"].experience.held == layout.experience.held
    robot.close()


def test_lesson_that_was_taught_is_not_learned_again(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    with Blackboard.open(tmp_path, create=True) as board:
        start_recording(board, "first table", 0.0, by="test")
        robot.sees(table(0), at=1.0)
        told = robot.told("layout row; plate right of fork", at=2.0)
        finish_recording(board, "first table", 3.0, by="test")
    assert robot.consolidate().lessons == {"first table": told.lesson.id}  # type: ignore[union-attr]
    assert robot.layouts["row"].experience.tables == 1
    robot.close()


def test_undescribed_experiences_are_tables_without_a_name(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    for number, name in enumerate(("monday", "tuesday")):
        record(robot, name, number, None, 10.0 * number)
    assert set(robot.consolidate().left_out) == {"monday", "tuesday"}
    robot.consolidate()
    assert [len(kind.tables) for kind in robot.unnamed] == [2]
    robot.sees(table(2))
    assert robot.layout_question is not None
    robot.close()


def test_live_robot_asks_for_the_name(tmp_path: Path) -> None:
    lines: list[str] = []
    with Blackboard.open(tmp_path / "memory", create=True) as board:
        spec = ModuleSpec("deixis.robot.live.learner:Learner", {"memory": str(tmp_path / "memory")})

        def write(subject: str, predicate: str, value: str, at: float) -> None:
            source, id = Source(Origin.SEEN, subject), board.new_id("x")
            board.add(episodic(id, (subject, predicate, value), start=at, finish=at + 0.1, source=source), by=subject)

        with Runtime(board, [spec], report=lines.append) as runtime:
            for number in range(3):
                file = tmp_path / f"{number}.scene.json"
                write_scene(table(number), file)
                write("table", "lookedLike", str(file), float(number))
            write("Ada", "said", "It is called a work place.", 4.0)
            assert runtime.wait(board.sequence, 60)
        told = [str(each.statement.object) for each in board.holding(Pattern("learner", "says"))]
    assert [line for line in lines if " is slow," not in line] == []
    assert told[0].startswith("I have seen 3 tables like this; what is it called?")
    assert told[1] == "Thank you: I know 'work place' from 3 tables."
