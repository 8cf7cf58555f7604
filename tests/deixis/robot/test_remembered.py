"""Test that a robot's layouts are read again from its memory, with the counts of all tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from deixis.grammar.layout.parser import parse_script
from deixis.learning.layouts.experience import Experience, Moments, Tally
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.robot import Robot
from deixis.workflows.knowledge.unlearn import Selection

PLACE = "layout place; fork left of plate; knife right of plate"
TWINS = "layout twins; fork_1 beside plate; fork_2 beside plate"


def thing(name: str, x: float, size: tuple[float, float, float], label: str | None, number: int) -> PerceivedObject:
    low, high = np.array((x, 0.0, 0.0)), np.array((x, 0.0, 0.0)) + size
    points = np.random.default_rng(number).uniform(low, high, (200, 3)).astype(np.float32)
    box = OrientedBox(tuple((low + high) / 2), 0.0, size)
    return PerceivedObject(name, tuple(low), tuple(high), label, oriented=box, cloud=PointCloud(points))


def table(number: int, labels: Sequence[str | None] = ("fork", "plate", "knife")) -> Scene:
    """Return a fork, a plate and a knife in a row, at other distances on each table."""
    places = (0.0, 0.06 + 0.01 * number, 0.33 + 0.02 * number)
    sizes = ((0.025, 0.2, 0.01), (0.25, 0.25, 0.02), (0.025, 0.22, 0.01))
    found = [
        thing(f"o{i}", x, size, label, 10 * number + i)
        for i, (x, size, label) in enumerate(zip(places, sizes, labels, strict=True))
    ]
    return Scene(tuple(found), file=f"<table {number}>")


def counts(seen: Experience) -> Mapping[str, object]:
    """Return counts as values, rounded to 9 decimals."""
    found: dict[str, object] = {"tables": seen.tables}
    for name in ("filled", "held", "apart", "axes", "sizes"):
        for key, value in getattr(seen, name).items():
            listed = (value.held, value.of) if isinstance(value, Tally) else (value.count, *value.total, *value.squares)
            assert isinstance(value, Tally | Moments)
            found[f"{name} {key}"] = tuple(np.round(listed, 9) + 0.0)
    return found


def known(folder: Path) -> dict[str, Mapping[str, object]]:
    robot = Robot(folder)
    found = {name: counts(layout.experience) for name, layout in robot.layouts.items()}
    robot.close()
    return found


def test_layouts_are_read_again_in_any_order_of_lessons(tmp_path: Path) -> None:
    found = []
    for number, order in enumerate(((0, 1, 2), (2, 0, 1))):
        robot = Robot(tmp_path / str(number))
        for each in order:
            robot.sees(table(each))
            robot.told(parse_script(PLACE))
        live = counts(robot.layouts["place"].experience)
        robot.close()
        found += [live, known(tmp_path / str(number))["place"]]
    assert found[0]["tables"] == 3
    assert all(other == found[0] for other in found[1:])


def test_taking_back_a_lesson_subtracts_its_table(tmp_path: Path) -> None:
    robot = Robot(tmp_path / "one")
    for number in range(2):
        robot.sees(table(number))
        last = robot.told(parse_script(PLACE))
    first_only = Robot(tmp_path / "two")
    first_only.sees(table(0))
    first_only.told(parse_script(PLACE))
    robot.unlearn(Selection(lesson=last.lesson.id))
    left = counts(robot.layouts["place"].experience)
    assert left == counts(first_only.layouts["place"].experience)
    assert robot.lessons[1].settled == {}
    robot.unlearn(Selection(lesson=robot.lessons[0].id))
    assert robot.layouts == {}
    first_only.session.forget(first_only.lessons[0].id)
    first_only.remember()
    assert first_only.layouts == {}
    robot.close()
    first_only.close()


def twins(folder: Path) -> tuple[Robot, str]:
    """Return a robot that knows two forks by words and asked which one is the first, and the id of the lesson."""
    robot = Robot(folder)
    scene = table(0, ("fork", "plate", "fork"))
    robot.sees(replace(scene, file="<twins>"))
    told = robot.told(parse_script(TWINS))
    assert {"fork_1", "fork_2"} <= set(told.waiting)
    question = next(each for each in robot.questions if each.role == "fork_1")
    robot.answers(question, "o0", by="Ada")
    return robot, told.lesson.id


def test_answers_count_after_a_restart_until_taken_back(tmp_path: Path) -> None:
    robot, _ = twins(tmp_path)
    live = counts(robot.layouts["twins"].experience)
    assert ("left", "fork_1", "plate") in robot.layouts["twins"].experience.held
    robot.close()
    assert known(tmp_path)["twins"] == live
    robot = Robot(tmp_path)
    robot.unlearn(Selection(teacher="Ada"))
    assert ("left", "fork_1", "plate") not in robot.layouts["twins"].experience.held
    assert robot.layouts["twins"].experience.filled["fork_1"] == Tally(1.0, 1.0)
    robot.close()


def test_answer_about_a_lesson_does_not_pass_to_another(tmp_path: Path) -> None:
    robot, lesson = twins(tmp_path)
    robot.session.forget(lesson)
    robot.sees(table(5, ("fork", "plate", "fork")))
    again = robot.told(parse_script(TWINS))
    assert again.lesson.id == lesson
    robot.remember()
    assert ("left", "fork_1", "plate") not in robot.layouts["twins"].experience.held
    robot.close()


def test_fuller_description_stays_in_any_order(tmp_path: Path) -> None:
    texts = (PLACE, "layout place; fork left of plate")
    for folder, order in (("one", texts), ("two", texts[::-1])):
        robot = Robot(tmp_path / folder)
        for number, text in enumerate(order):
            robot.sees(table(number))
            robot.told(parse_script(text))
        assert robot.layouts["place"].roles == ("fork", "plate", "knife")
        assert robot.layouts["place"].experience.filled["knife"] == Tally(1.0, 1.0)
        robot.close()


def test_a_spoken_name_is_taken_back_with_its_sentence(tmp_path: Path) -> None:
    with Robot(tmp_path) as robot:
        robot.sees(table(0, (None, None, None)), at=1.0)
        for number, (name, spoken) in enumerate((("fork", "This is a fork."), ("knife", "This is a knife."))):
            source = Source(Origin.SAID, "Ada", f"words {number}")
            said = episodic(f"w{number}", ("Ada", "said", spoken), start=2.0, finish=2.5, source=source)
            robot.diary.board.write(Add(said))
            robot.shown(name, f"o{2 * number}", by="Ada", at=3.0, event=f"words {number}")
        assert robot.session.categories() == {"fork": 1, "knife": 1}
        robot.unlearn(Selection(sentence="This is a fork."))
        assert robot.session.categories() == {"knife": 1}
        assert {each.source.event for each in robot.diary.board.now(Pattern(predicate="isA"))} == {"words 1"}
