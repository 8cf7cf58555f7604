"""Test the story of a person with a camera on her head who lays a table and says what she does."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from deixis.grammar.layout.parser import parse_script
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.errors import EpisodeError
from deixis.reasoning.activities.activity import box_of
from deixis.robot.live.run import SeenThing, live_robot
from deixis.robot.live.story import StorySettings, laying_story
from deixis.workflows.reasoning.activities import learn, predict, sequences_of_experiences

PAIR = "layout pair\ndinner plate left of water glass\n"


@dataclass(frozen=True)
class Ran:
    """Results of a run."""

    memory: Path
    lines: list[str]
    things: tuple[SeenThing, ...]


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Ran:
    folder = tmp_path_factory.mktemp("laying")
    (folder / "pair.layout").write_text(PAIR, encoding="utf-8")
    (folder / "more.said.jsonl").write_text('{"text": "Now the candle.", "at": 60.0}\n', encoding="utf-8")
    lines: list[str] = []
    words = str(folder / "more.said.jsonl")
    story = StorySettings("laying", str(folder / "pair.layout"), seed=3, rate=1.0, words=words, camera="still")
    with live_robot(folder / "memory", story, lines.append) as robot:
        robot.record("first table")
        with pytest.raises(EpisodeError, match="there is an experience 'first table' already"):
            robot.record("first table")
        assert robot.wait(120.0)
        robot.finish_recording("first table")
        return Ran(folder / "memory", lines, robot.things())


def test_announced_things_are_named_as_they_come(ran: Ran) -> None:
    assert {thing.name for thing in ran.things} == {"dinner_plate", "water_glass"}
    assert any("robot: I see" in line and "is a dinner plate" in line for line in ran.lines)


def test_announcement_without_a_thing_teaches_nothing(ran: Ran) -> None:
    assert any("'candle' was not learned: nothing came to the table" in line for line in ran.lines)


def test_laying_is_learned_from_an_experience(ran: Ran, tmp_path: Path) -> None:
    order = [name.replace("_", " ") for name in laying_story(parse_script(PAIR), 3).truth.laid]  # type: ignore[union-attr]
    with Blackboard.open(ran.memory) as board:
        (sequence,) = sequences_of_experiences(board)
    assert [step.thing.replace("_", " ") for step in sequence.steps] == order
    assert all(box_of(fluent.statement) is not None for fluent in sequence.fluents)
    activity = learn("pair", [sequence], tmp_path / "known.json")
    begun = type(sequence).of(sequence.fluents[:1])
    (following, *_) = predict(begun, tmp_path / "known.json").things
    assert activity.examples == 1 and following.kind.replace("_", " ") == order[1]
    assert following.place is not None
