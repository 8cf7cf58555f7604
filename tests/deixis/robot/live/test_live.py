"""Test the robot that runs, on a simulated story of two things: its modules as threads, and as processes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from deixis.grammar.layout.parser import parse_script
from deixis.grammar.utterances import Utterance
from deixis.memory.episodes.predicates import AT
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.tracking.frames.frame import Frame
from deixis.plots.live_story import write_story
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.moments import key_moments
from deixis.robot.live.run import SeenThing, live_robot
from deixis.robot.live.story import AtOwnSpeed, StorySettings, simulated_story
from deixis.session import Session

PAIR = "layout pair\nfork left of plate\n"

SAID_BEFORE = '{"text": "The fork is behind the plate.", "at": 0.5, "confidence": 0.2}\n'


@dataclass(frozen=True)
class Ran:
    """Results of a run."""

    memory: Path
    pictures: Path
    lines: list[str]
    things: tuple[SeenThing, ...]
    moments: int


@pytest.fixture(
    scope="module", params=[False, pytest.param(True, marks=pytest.mark.kills)], ids=["threads", "processes"]
)
def ran(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Ran:
    folder = tmp_path_factory.mktemp("live")
    (folder / "pair.layout").write_text(PAIR, encoding="utf-8")
    (folder / "before.said.jsonl").write_text(SAID_BEFORE, encoding="utf-8")
    lines: list[str] = []
    words = str(folder / "before.said.jsonl")
    story = StorySettings("simulator", str(folder / "pair.layout"), seed=2, rate=0.5, words=words)
    with live_robot(folder / "memory", story, lines.append, processes=request.param) as robot:
        assert robot.wait(120.0)
        robot.says("Hello there!")
        robot.says("OK.")
        robot.says("what did the teacher say?")
        robot.says("which one did the teacher show you first")
        robot.says("Eve moved the plate.")
        robot.says("who moved the plate?")
        robot.says("layout cups; cup inside mug; mug inside cup")
        robot.says("t99 is left of the plate.")
        robot.says("What was wrong in the last hour?")
        robot.says("Was the fork ever missing?")
        robot.says("t3 is a bowl.")
        robot.says("t3 is a cup.")
        robot.says("t99 is a bowl.")
        robot.says("Thank you very much.")
        assert robot.answered(60.0)
        steps: list[tuple[int, int]] = []
        write_story(robot, folder / "pictures", lambda *step: steps.append(step))
        moments = len(key_moments(robot.board, robot.began))
        assert steps == [(number, moments + 1) for number in range(moments)]
        things = robot.things()
        robot.says("forget what Zoe said")
        robot.says("Please forget everything that I told you.")
        assert robot.answered(60.0)
        return Ran(folder / "memory", folder / "pictures", lines, things, moments)


def heard(ran: Ran, *words: str) -> bool:
    """Return whether a line of the conversation has all these words."""
    return any(all(word in line for word in words) for line in ran.lines)


def test_robot_learns_from_a_description(ran: Ran) -> None:
    assert heard(ran, "I learned how 'pair' is laid")
    with Session(ran.memory) as session:
        assert [layout.name for layout in session.layouts()] == ["pair"]
        assert {"fork", "plate"} <= set(session.categories())
        assert session.recall("what did the teacher say?").known


def test_robot_finds_the_forgotten_thing(ran: Ran) -> None:
    assert heard(ran, "teacher: What is wrong?")
    assert heard(ran, "robot: This is 'pair'", "the plate is missing")


def test_what_a_person_taught_is_forgotten_on_request(ran: Ran) -> None:
    assert heard(ran, "robot: I know nothing that Zoe said or showed.")
    if heard(ran, "robot: I cannot forget what user said: my modules run as processes"):
        return
    assert heard(ran, "robot: I have forgotten what user said and showed:")
    with Session(ran.memory) as session:
        assert "This is a fork" in session.recall("what did the teacher say?").answer
        assert not session.recall("what did user say?").known


def test_descriptions_that_cannot_be_teach_nothing(ran: Ran) -> None:
    assert heard(ran, "robot: I learned nothing: 'cup' cannot be both inside and containing 'mug'.")
    assert heard(ran, "robot: I learned nothing: no thing 't99' is in view")


def test_past_mistakes_are_recalled(ran: Ran) -> None:
    assert heard(ran, "robot: The plate is missing, ", "(inferred")
    assert heard(ran, "robot: Yes: the fork went at ")


def test_greetings_and_thanks_get_a_reply(ran: Ran) -> None:
    assert heard(ran, "robot: Hello.") and heard(ran, "robot: You are welcome.")
    assert not any("I did not understand" in line for line in ran.lines)


def test_told_acts_are_noted_and_recalled(ran: Ran) -> None:
    assert heard(ran, "robot: I have noted that Eve moved the plate.")
    assert heard(ran, "robot: Eve moved the plate", "(said by user)")


def test_a_name_that_the_layout_contradicts_is_in_doubt(ran: Ran) -> None:
    assert heard(ran, "robot: I see: t3 is a bowl.")  # the layout has a fork there
    (thing,) = ran.things
    assert thing.id == "t3" and thing.probability < 0.9  # of a name that nothing contradicts: above 0.99


def test_typed_words_and_ids_are_heard(ran: Ran) -> None:
    assert heard(ran, "user: what did the teacher say?")
    assert heard(ran, "robot: Teacher said", "This is a fork")
    assert heard(ran, "robot: I see: t3 is a bowl.")
    assert heard(ran, "there is no t99 on the table")


def test_a_name_that_contradicts_an_earlier_one_is_refused(ran: Ran) -> None:
    assert heard(ran, "note: 'cup' was not learned: contradicts 'bowl' of", "Is t3 bowl or cup?")


def test_lines_of_the_conversation_are_in_order_of_time(ran: Ran) -> None:
    times = [float(line.partition(" s  ")[0]) for line in ran.lines if " s  " in line]
    assert len(times) > 10 and times == sorted(times)


def test_recognised_questions_need_no_question_mark(ran: Ran) -> None:
    assert heard(ran, "robot: Teacher showed the fork at")


def test_words_that_were_hardly_recognised_are_asked_for_again(ran: Ran) -> None:
    assert heard(ran, "The fork is behind the plate.", "say it again")


def test_story_has_a_picture_of_each_moment(ran: Ran) -> None:
    page = (ran.pictures / "index.html").read_text(encoding="utf-8")
    pictures = sorted(file.name for file in ran.pictures.glob("moment*.png"))
    assert ran.moments == len(pictures) == page.count("<section>") >= 6
    assert "I learned how &#x27;pair&#x27; is laid" in page
    assert 5_000 < (ran.pictures / "story.png").stat().st_size < 200_000


def test_next_run_begins_with_an_empty_table(ran: Ran, tmp_path: Path) -> None:
    with live_robot(ran.memory, StorySettings(str(tmp_path / "nothing")), lambda line: None) as robot:
        assert robot.wait(30.0)
        assert robot.board.now(Pattern(predicate=AT)) == ()
        assert "no such folder" in (robot.problem or "")


def test_story_has_its_events_in_order() -> None:
    story = simulated_story(parse_script(PAIR), seed=2, rate=0.5)
    assert story.truth is not None and story.truth.forgotten in {"fork", "plate"}
    story = type(story)((Frame(PointCloud(np.zeros((1, 3), np.float32)), 0.0, 0),), story.words, story.skeletons)
    events = list(story.events())
    assert [event.at for event in events] == sorted(event.at for event in events)
    assert {Skeleton, Utterance} < {type(event) for event in events}
    assert isinstance(events[0], Frame)


class Camera:
    """Camera driver with twenty frames at once."""

    def frames(self) -> Iterator[Frame]:
        """Yield the frames."""
        for number in range(20):
            yield Frame(PointCloud(np.zeros((1, 3), np.float32)), number / 1000, number)


def test_late_frames_of_a_driver_are_dropped_and_counted() -> None:
    story = StorySettings(f"{__name__}:Camera").story()
    seen = []
    for frame in story.frames:
        time.sleep(0.05)
        seen.append(frame.number)
    assert story.dropped > 0 and len(seen) + story.dropped == 20
    assert seen == sorted(seen)


def test_live_story_keeps_its_own_speed() -> None:
    empty = PointCloud(np.zeros((1, 3), np.float32))
    began = time.monotonic()
    assert len(list(AtOwnSpeed([Frame(empty, 3.0, 0), Frame(empty, 3.2, 1)]).frames())) == 2
    assert time.monotonic() - began >= 0.19


def test_folder_without_clouds_ends_the_story(tmp_path: Path) -> None:
    (tmp_path / "clouds").mkdir()
    with live_robot(tmp_path / "memory", StorySettings(str(tmp_path / "clouds")), lambda line: None) as robot:
        assert robot.wait(30.0)
        assert "no clouds in this folder" in (robot.problem or "")
