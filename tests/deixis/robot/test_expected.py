"""Test objects that are expected because a person said that they are there, until they are seen or found missing."""

from __future__ import annotations

import time
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import finish_recording, start_recording
from deixis.memory.episodes.fluents.changes import Add, Update
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.episodes.predicates import CONTRADICTED, EXPECTED, SAME_AS
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.expected import MIN_PRESENT_PROBABILITY, ExpectedObject, Sighting, Standing, introduced
from deixis.robot.modules import ModuleSpec
from deixis.robot.places import places_of
from deixis.robot.robot import Robot, Told
from deixis.robot.runtime import Runtime
from deixis.workflows.knowledge.episodes import Memory, memory_lines
from deixis.workflows.knowledge.recall import recall
from deixis.workflows.knowledge.unlearn import Selection
from deixis.workflows.layouts.read import read_script
from deixis.workflows.scenes.perceive import write_scene

RED, WHITE = (200, 30, 30), (240, 240, 240)
BALL = "There is a red ball on the left."


def thing(
    name: str, x: float, y: float, size: tuple[float, float, float], label: str | None, colour: tuple[int, int, int]
) -> PerceivedObject:
    low, high = (x - size[0] / 2, y - size[1] / 2, 0.0), (x + size[0] / 2, y + size[1] / 2, size[2])
    return PerceivedObject(name, low, high, label, colour=colour)


PLATE = thing("o1", 0.3, 0.0, (0.25, 0.25, 0.02), "plate", WHITE)
FORK = thing("o2", 0.1, 0.0, (0.03, 0.2, 0.01), "fork", WHITE)
CUP = thing("o3", 0.5, 0.2, (0.09, 0.09, 0.09), "cup", WHITE)
LEFT_BALL = thing("o4", -0.1, 0.0, (0.07, 0.07, 0.07), None, RED)
RIGHT_BALL = thing("o4", 0.6, 0.0, (0.07, 0.07, 0.07), None, RED)
TABLE = Scene((PLATE, FORK, CUP))


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    robot = Robot(tmp_path)
    robot.sees(TABLE, at=10.0)
    yield robot
    robot.close()


def origins(robot: Robot) -> dict[tuple[str, str], Origin]:
    return {(each.statement.subject, each.statement.predicate): each.source.origin for each in held(robot)}


def held(robot: Robot):  # type: ignore[no-untyped-def]
    return robot.diary.board.holding()


def answer(robot: Robot, question: str, at: float) -> str:
    board = Blackboard.open(robot.session.path)
    try:
        return recall(question, board, at=at).answer.split(" at ")[0]
    finally:
        board.close()


def test_words_make_an_object_with_place_and_properties(robot: Robot) -> None:
    (ball,) = robot.told(BALL, by="anna", at=11.0)  # type: ignore[misc]
    assert isinstance(ball, ExpectedObject)
    assert (ball.standing, ball.name, ball.by) == (Standing.EXPECTED, "ball", "anna")
    said = [each for each in held(robot) if each.statement.subject == ball.id]
    assert {(each.statement.predicate, each.statement.object) for each in said} == {
        (EXPECTED, BALL), ("isA", "ball"), ("colour", "red"), ("part", "left"),
    }  # fmt: skip
    assert {(each.source.origin, each.source.by) for each in said} == {(Origin.SAID, "anna")}


def test_object_is_merged_with_a_thing_that_fits(robot: Robot) -> None:
    (ball,) = robot.told(BALL, by="anna", at=11.0)  # type: ignore[misc]
    robot.sees(Scene((PLATE, FORK, CUP, LEFT_BALL)), at=13.0)
    (seen,) = robot.expected
    assert (seen.standing, seen.thing) == (Standing.SEEN, robot.diary.id_of("o4"))
    assert 0.9 < seen.probability < 1.0
    assert seen.thing is not None
    known = origins(robot)
    assert known[ball.id, EXPECTED] is Origin.SAID
    assert known[ball.id, SAME_AS] is known[seen.thing, "isA"] is Origin.INFERRED
    assert known[seen.thing, "at"] is Origin.SEEN
    assert robot.diary.board.now(Pattern(ball.id, EXPECTED)) == ()
    assert answer(robot, "is there a red ball?", 14.0).startswith("Yes: the ball has been left of the fork since")


def test_thing_elsewhere_is_not_the_object(robot: Robot) -> None:
    robot.told(BALL, by="anna", at=11.0)
    robot.sees(Scene((PLATE, FORK, CUP, RIGHT_BALL)), at=13.0)
    assert robot.expected[0].standing is Standing.EXPECTED


def test_empty_place_in_view_contradicts_after_some_looks(robot: Robot) -> None:
    robot.told("There is a spoon behind the plate.", by="bob", at=11.0)
    assert answer(robot, "is there a spoon?", 11.5).startswith("Probably: bob said")
    for second in range(12, 20):
        robot.sees(TABLE, at=float(second))
    (spoon,) = robot.expected
    assert spoon.standing is Standing.CONTRADICTED
    (fluent,) = robot.diary.board.now(Pattern(spoon.id, CONTRADICTED))
    assert 13.0 < fluent.start.lower < 18.0
    assert fluent.statement.object == spoon.reason
    assert "in view and empty in 5 looks within" in str(spoon.reason)
    assert answer(robot, "is there a spoon behind the plate?", 21.0) == "No: the spoon was not there"
    assert answer(robot, "what did Bob tell you that was not there?", 21.0) == "The spoon was not there"


def test_looks_in_one_moment_do_not_contradict(robot: Robot) -> None:
    robot.told(BALL, at=11.0)
    for number in range(20):
        robot.sees(TABLE, at=11.0 + number / 100)
    assert robot.expected[0].standing is Standing.EXPECTED
    robot.watches(20.0)
    assert [one.standing for one in robot.expected] == [Standing.CONTRADICTED]


def test_hidden_place_contradicts_nothing(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    wall = thing("o5", 0.3, 0.2, (0.9, 0.02, 0.4), "box", WHITE)
    points = np.random.default_rng(0).uniform(wall.minimum, wall.maximum, (50, 3)).astype(np.float32)
    box = PerceivedObject("o5", wall.minimum, wall.maximum, "box", cloud=PointCloud(points, origin=(0.3, -1.0, 0.3)))
    robot.sees(Scene((PLATE, FORK, box)), at=0.0)
    robot.told("There is a cup behind the box.", at=1.0)
    robot.watches(60.0)
    assert robot.expected[0].standing is Standing.EXPECTED
    robot.close()


def test_two_objects_of_one_sentence_are_two_things(robot: Robot) -> None:
    first, second = robot.told("There are two forks on the table.", at=11.0)  # type: ignore[misc]
    assert (first.thing, second.standing) == (robot.diary.id_of("o2"), Standing.EXPECTED)


def test_denial_ends_an_expectation(robot: Robot) -> None:
    robot.told(BALL, by="anna", at=11.0)
    robot.told("There is no ball on the left.", by="bob", at=12.0)
    assert robot.expected[0].reason == "bob said that it is not there"


def test_expectations_survive_a_restart_and_are_taken_back(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    robot.told(BALL, by="anna", at=1.0)
    robot.told("There is a spoon behind the plate.", by="bob", at=2.0)
    robot.close()
    again = Robot(tmp_path)
    assert [(one.name, one.by) for one in again.expected] == [("ball", "anna"), ("spoon", "bob")]
    again.unlearn(Selection(sentence=BALL))
    assert [one.name for one in again.expected] == ["spoon"]
    assert not [each for each in held(again) if each.source.by == "anna"]
    again.sees(TABLE, at=5.0)
    again.close()


def test_description_of_a_layout_expects_nothing(robot: Robot) -> None:
    told = robot.told("The fork is left of the plate. The cup is behind the plate.", at=11.0)
    assert isinstance(told, Told)
    assert robot.expected == []
    assert introduced(read_script(text="fork left of plate")) == ()
    assert introduced(read_script(text="A fork and two cups are left of the plate.", english=True)) == (
        "fork", "cup_1", "cup_2",
    )  # fmt: skip


def test_robot_writes_what_it_heard_saw_and_concluded(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    cloud = PointCloud(np.random.default_rng(0).uniform(0, 0.1, (200, 3)).astype(np.float32))
    cup = PerceivedObject("o1", (0.0, 0.0, 0.0), (0.1, 0.1, 0.1), cloud=cloud)
    scene = Scene((cup, PerceivedObject("o2", (0.2, 0.0, 0.0), (0.4, 0.2, 0.02), "plate")))
    robot.sees(scene, at=1.0)
    robot.shown("cup", "o1", by="ada", at=2.0)
    robot.told("layout pair; cup left of plate", by="ada", at=3.0)
    robot.sees(scene, at=4.0)
    assert robot.layout() == "pair"
    now = {(each.statement.predicate, each.statement.object): each for each in robot.diary.board.now()}
    assert now["isA", "cup"].statement.subject == robot.diary.id_of("o1")
    assert now["layout", "pair"].source.origin is Origin.INFERRED
    assert answer(robot, "which one did I show you first?", 5.0) == "Ada showed the cup"
    assert answer(robot, "what did Ada say?", 5.0) == "Ada said"
    robot.sees(Scene((scene.objects[1],)), at=6.0)
    assert answer(robot, "what was taken away?", 7.0) == "The cup went"
    robot.close()


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.floats(0, 1), st.floats(0.0, 3.0)), max_size=20))
def test_probability_never_rises_by_looking(looks: list[tuple[float, float]]) -> None:
    script = read_script(text=BALL, english=True)
    one = ExpectedObject("e1", "ball", script, BALL, "anna", "s1", 0.0)
    at = 0.0
    for in_view, pause in looks:
        at += pause
        new = one.after(Sighting(None, 0.0, False, in_view), at)
        assert new.probability <= one.probability + 1e-9
        assert (new.standing is Standing.CONTRADICTED) == (new.probability < MIN_PRESENT_PROBABILITY)
        if new.standing is Standing.CONTRADICTED:
            break
        one = new


@pytest.mark.parametrize(
    ("text", "inside", "outside"),
    [
        (BALL, (-0.1, 0.0), (0.6, 0.0)),
        ("There is a ball behind the plate.", (0.3, 0.3), (0.3, -0.2)),
        ("There is a ball on the plate.", (0.3, 0.0), (-0.1, 0.0)),
    ],
)
def test_places_follow_the_words(text: str, inside: tuple[float, float], outside: tuple[float, float]) -> None:
    places = places_of(read_script(text=text, english=True), "ball", TABLE, SHIPPED)
    assert places is not None
    small = [thing("p", *spot, (0.04, 0.04, 0.04), None, RED) for spot in (inside, outside)]
    assert [places.may_be_at(each) for each in small] == [True, False]
    assert places.share_in_view == pytest.approx(1.0)


def test_live_robot_expects_sees_and_gives_up(tmp_path: Path) -> None:
    files = []
    for number, scene in enumerate((TABLE, Scene((PLATE, FORK, CUP, LEFT_BALL)))):
        files.append(tmp_path / f"{number}.scene.json")
        write_scene(scene, files[-1])
    lines: list[str] = []
    earlier = datetime.now(UTC) - timedelta(seconds=100)
    with Blackboard.open(tmp_path / "memory", create=True, origin=earlier) as board:
        spec = ModuleSpec("deixis.robot.live.learner:Learner", {"memory": str(tmp_path / "memory")})

        def write(subject: str, predicate: str, value: str | None, at: float, origin: Origin) -> str:
            source, id = Source(origin, subject, f"event {at}"), board.new_id("x")
            board.write(
                Add(episodic(id, (subject, predicate, value), start=at, finish=at + 0.1, source=source)), by=subject
            )
            return id

        with Runtime(board, [spec], report=lines.append) as runtime:
            write("table", "lookedLike", str(files[0]), 1.0, Origin.SEEN)
            write("anna", "said", BALL, 2.0, Origin.SAID)
            write("anna", "said", "There is a spoon behind the plate.", 3.0, Origin.SAID)
            write("anna", "said", "What did I tell you that you have not seen?", 3.5, Origin.SAID)
            write("table", "lookedLike", str(files[1]), 4.0, Origin.SEEN)
            watched = write("table", "watched", None, 4.5, Origin.SEEN)
            board.write(Update(watched, finish=14.0), by="table")
            end = time.monotonic() + 60
            while len(board.holding(Pattern("learner", "says"))) < 5 and time.monotonic() < end:
                time.sleep(0.02)
            assert runtime.wait(board.sequence, 10)
        told = [str(each.statement.object) for each in board.holding(Pattern("learner", "says"))]
    assert [line for line in lines if "failed" in line] == []
    assert told[:2] == ["I do not see it yet; I expect: ball.", "I do not see it yet; I expect: spoon."]
    assert "There is a red ball on the left; the ball has not been seen yet" in told[2]
    assert told[3].startswith("I see the ball that anna spoke of: it is o4, probability 0.9")
    assert told[4].startswith("I do not see the spoon that anna spoke of: its place was in view and empty")


def test_each_of_the_five_memories_is_asked_by_its_name(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    cloud = PointCloud(np.random.default_rng(0).uniform(0, 0.1, (200, 3)).astype(np.float32))
    cup = PerceivedObject("o1", (0.0, 0.0, 0.0), (0.1, 0.1, 0.1), cloud=cloud)
    robot.sees(Scene((cup, PerceivedObject("o2", (0.2, 0.0, 0.0), (0.4, 0.2, 0.02), "plate"))), at=1.0)
    with Blackboard.open(tmp_path) as board:
        start_recording(board, "breakfast", 1.0, by="test")
        robot.shown("cup", "o1", by="ada", at=2.0)
        robot.told("layout pair; cup left of plate", by="ada", at=3.0)
        finish_recording(board, "breakfast", 4.0, by="test")
        lines = {which: list(memory_lines(which, board, robot.session)) for which in Memory}
    assert len(lines[Memory.WORKING]) == len(robot.diary.board.now())
    assert lines[Memory.EPISODIC] == ["breakfast: from 1 to 4 s"]
    assert lines[Memory.SEMANTIC] == ["layout pair"]
    assert "category cup: 1 views" in lines[Memory.PERCEPTUAL]
    assert lines[Memory.PROCEDURAL] == []  # it comes with a robot that acts
    robot.close()
