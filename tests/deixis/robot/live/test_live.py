"""Test the robot that runs, on a simulated story of two things."""

from __future__ import annotations

from pathlib import Path

import pytest
from timing import BUSY_SECONDS

from deixis.grammar.parser import parse_script
from deixis.grammar.utterances import Utterance
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.tracking.frame import Frame
from deixis.robot.live.run import LiveSettings, live_robot
from deixis.robot.live.story import recorded_story, simulated_story
from deixis.session import Session

PAIR = "layout pair\nfork left of plate\n"


@pytest.fixture(scope="module")
def heard(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str], str | None, list[str | None]]:
    folder = tmp_path_factory.mktemp("live")
    (folder / "pair.layout").write_text(PAIR, encoding="utf-8")
    lines: list[str] = []
    settings = LiveSettings("simulator", str(folder / "pair.layout"), seed=2, rate=2.0)
    with live_robot(folder / "memory", settings, lines.append) as robot:
        assert robot.wait(10 * BUSY_SECONDS)
        return folder / "memory", lines, robot.layout(), [thing.name for thing in robot.things()]


def test_robot_learns_what_it_is_told(heard: tuple[Path, list[str], str | None, list[str | None]]) -> None:
    memory, lines, _, _ = heard
    assert any("I learned how 'pair' is laid" in line for line in lines)
    with Session(memory) as session:
        assert [layout.name for layout in session.layouts()] == ["pair"]
        assert set(session.categories()) == {"fork", "plate"}


def test_robot_answers_what_is_wrong(heard: tuple[Path, list[str], str | None, list[str | None]]) -> None:
    _, lines, _, _ = heard
    asked = next(k for k, line in enumerate(lines) if "What is wrong?" in line)
    assert any("robot:" in line for line in lines[asked:])


def test_what_happened_can_be_recalled(heard: tuple[Path, list[str], str | None, list[str | None]]) -> None:
    memory, _, _, _ = heard
    with Session(memory) as session:
        assert session.recall("what did the teacher say?").known


def test_story_has_its_events_in_order() -> None:
    story = simulated_story(parse_script(PAIR), seed=2, rate=0.5)
    events = list(story.events())
    assert [event.at for event in events] == sorted(event.at for event in events)
    assert {Skeleton, Utterance} < {type(event) for event in events}
    assert isinstance(events[0], Frame)


def test_folder_without_clouds_ends_the_story(tmp_path: Path) -> None:
    (tmp_path / "clouds").mkdir()
    lines: list[str] = []
    with live_robot(tmp_path / "memory", LiveSettings(str(tmp_path / "clouds")), lines.append) as robot:
        assert robot.wait(BUSY_SECONDS)
    assert any("no clouds in this folder" in line for line in lines)
    with pytest.raises(Exception, match="no such folder"):
        recorded_story(tmp_path / "nothing")
