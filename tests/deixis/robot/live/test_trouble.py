"""Trouble of the live robot: events that cannot be used, words at the wrong time, and a full disk."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from timing import BUSY_SECONDS, until

from deixis.grammar.utterances import Utterance
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add, Change, Finish
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.episodes.predicates import SAID, SAYS
from deixis.memory.errors import MemoryWriteError
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.clouds.cloud_file import write_cloud
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.tracking.frames.frame import Frame
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.diary import UNNAMED
from deixis.robot.live.learner import DONE, NOT_FOUND, NOT_SEEN, Learner
from deixis.robot.live.outbox import Outbox
from deixis.robot.live.run import live_robot
from deixis.robot.live.senses import DROPPED, ENDED, NOTICED, TABLE, Senses
from deixis.robot.live.story import PEOPLE, WORDS, Event, Story, StorySettings
from deixis.robot.modules import Module, ModuleBoard, run_until_stopped
from deixis.robot.robot import Robot

EMPTY = PointCloud(np.zeros((0, 3), np.float32))
SEEN = Source(Origin.SEEN, "test")


class FullDisk(ModuleBoard):
    """Board whose first writes fail."""

    def __init__(self, board: Blackboard, module: Module, failures: int) -> None:
        super().__init__(board, module)
        self.failures = failures

    def write(self, *changes: Change) -> int:
        self.failures -= 1
        if self.failures >= 0:
            raise MemoryWriteError("no space left on device")
        return super().write(*changes)


class StoryOf(Senses):
    """Senses that take in given events."""

    def __init__(self, folder: Path, *events: Event) -> None:
        super().__init__({"source": "given"}, str(folder))
        self.given = events

    def story(self) -> Story:
        return Story(self.frames())

    def frames(self) -> Iterator[Frame]:
        yield from self.given  # type: ignore[misc]  # a story is any sequence of events


def noted(board: Blackboard, predicate: str) -> list[str | None]:
    """Return the objects of all statements with a predicate."""
    return [each.statement.object for each in board.holding(Pattern(predicate=predicate))]


def take_in(senses: Senses, board: Blackboard, own: FullDisk | None = None, failures: int = 0) -> list[str]:
    """Run the senses until the story has ended, and return what the runtime reports."""
    stopped, lines = threading.Event(), list[str]()
    arguments = (senses, own or FullDisk(board, senses, failures), stopped, lines.append)
    thread = threading.Thread(target=run_until_stopped, args=arguments)
    thread.start()
    ended = until(lambda: bool(board.now(Pattern(predicate=ENDED))))
    stopped.set()
    thread.join(BUSY_SECONDS)
    assert ended and not thread.is_alive()
    return lines


def test_the_robot_goes_on_after_events_that_cannot_be_used(tmp_path: Path) -> None:
    senses = StoryOf(
        tmp_path,
        Frame(EMPTY, 0.0, 0, "a.pcd: damaged"),
        Frame(EMPTY, 0.1, 1),
        Utterance("one", -5e9),
        Utterance("two\n\u202e\x1b[2J", 0.3, speaker="ada\nbob"),
        Skeleton(1e300, {}),
        Utterance("three", 0.4),
        Frame(EMPTY, float("nan"), 2),
    )
    with Blackboard.transient() as board:
        assert take_in(senses, board) == []
        assert noted(board, SAID) == ["two \N{REPLACEMENT CHARACTER}\N{REPLACEMENT CHARACTER}[2J", "three"]
        notes = noted(board, NOTICED)
    assert "a.pcd: damaged; the frame is left out" in notes
    assert any("could not be used: a time of" in str(note) for note in notes)
    assert len(notes) == len(set(notes)) < 8


def test_invalid_lines_of_a_story_are_noted_and_left_out(tmp_path: Path) -> None:
    write_cloud(tmp_path / "0.pcd", PointCloud(np.zeros((4, 3), np.float32)))
    words = b'{"text": "one", "at": 0}\n{"text": "two", "at"\n{"text": "\xff", "at": 1}\n{"text": "three", "at": 2}\n'
    (tmp_path / WORDS).write_bytes(words)
    (tmp_path / PEOPLE).write_text('{"at": 0, "joints": {}}\n{"at": 1}\n', encoding="utf-8")
    senses = Senses({"source": str(tmp_path)}, str(tmp_path))
    with Blackboard.transient() as board:
        assert take_in(senses, board, failures=2)[0].count("no space left on device") == 1
        assert noted(board, SAID) == ["one", "three"]
        notes = [str(note) for note in noted(board, NOTICED) if str(note).startswith(str(tmp_path))]
    places = [note.removeprefix(f"{tmp_path}/").split(": ")[0] for note in notes if "the line is left out" in note]
    assert places == [f"{WORDS}:2:21", f"{WORDS}:3:11", f"{PEOPLE}:2"]
    assert not any("\n" in note for note in notes)


def test_a_full_disk_is_reported_once_and_nothing_is_lost(tmp_path: Path) -> None:
    words = [Utterance(f"word {number}", 3.0 * number) for number in range(4)]
    with Blackboard.transient() as board:
        (line,) = take_in(StoryOf(tmp_path, *words), board, failures=3)
        assert noted(board, SAID) == [word.text for word in words]
        assert len(board.holding(Pattern(predicate=ENDED))) == 1
    assert "no space left on device" in line


class NoIds(FullDisk):
    """Board that gives every second id of a thing or a scene only when it is asked again."""

    refused = False

    def new_id(self, prefix: str) -> str:
        self.refused = prefix in {"t", "table"} and not self.refused
        if self.refused:
            raise MemoryWriteError("no space left on device")
        return super().new_id(prefix)


def test_a_full_disk_during_a_look_loses_no_thing_and_no_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deixis.robot.modules.RESTART_PAUSE", 0.001)
    script = tmp_path / "pair.layout"
    script.write_text("layout pair\nfork left of plate\n", encoding="utf-8")
    seen = []
    for full in (False, True):
        folder = tmp_path / str(full)
        folder.mkdir()
        senses = Senses({"source": "simulator", "layout": str(script), "seed": 2, "rate": 0.5}, str(folder))
        with Blackboard.transient() as board:
            own = (NoIds if full else FullDisk)(board, senses, 0)
            take_in(senses, board, own)
            statements = [each.statement for each in board.holding()]
        seen.append([each for each in statements if each.predicate != TABLE])
        tables = [each for each in statements if each.predicate == TABLE]
        assert len(tables) == len(list(folder.glob("*.scene.json"))) >= 2
    assert seen[0] == seen[1]


def test_a_scene_that_a_full_disk_refuses_is_written_later(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from deixis.workflows.scenes import perceive

    monkeypatch.setattr("deixis.robot.modules.RESTART_PAUSE", 0.001)
    script, write, failures = tmp_path / "pair.layout", perceive.write_scene, iter([True, True, True])
    script.write_text("layout pair\nfork left of plate\n", encoding="utf-8")

    def full(*arguments: object) -> object:
        if next(failures, False):
            raise OSError(28, "No space left on device")
        return write(*arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(perceive, "write_scene", full)
    senses = Senses({"source": "simulator", "layout": str(script), "seed": 2, "rate": 0.5}, str(tmp_path))
    with Blackboard.transient() as board:
        lines = take_in(senses, board)
        assert len(noted(board, TABLE)) == len(list(tmp_path.glob("*.scene.json"))) >= 2
        assert not any("could not be used" in str(note) for note in noted(board, NOTICED))
    assert len(lines) == 1 and "No space left on device" in lines[0]


def told(board: Blackboard, learner: Learner, *statements: tuple[str, str, str], failures: int = 0) -> list[str | None]:
    """Give statements to a learner as the runtime does, and return what it says."""
    own = FullDisk(board, learner, failures)
    for number, statement in enumerate(statements):
        board.write(Add(episodic(f"f{number}", statement, start=float(number), source=SEEN)), by="test")
    for change in list(board.changes()):
        for _ in range(failures + 3):  # as often as it raises
            try:
                learner.changed(change, own)
                break
            except MemoryWriteError:
                continue
    return noted(board, SAYS)


def test_what_is_said_before_a_table_is_seen_gets_an_answer(tmp_path: Path) -> None:
    with Blackboard.transient() as board:
        words = ("ada", SAID, "what is wrong?"), ("ada", SAID, "fork left of plate")
        assert told(board, Learner(str(tmp_path / "memory")), *words) == [NOT_SEEN, NOT_SEEN]


def test_a_table_that_cannot_be_read_blocks_nothing(tmp_path: Path) -> None:
    scene = tmp_path / "a.scene.json"
    scene.write_text('{"objects": [\n1]}', encoding="utf-8")
    with Blackboard.transient() as board:
        said = told(
            board, Learner(str(tmp_path / "memory")), ("table", TABLE, str(scene)), ("ada", SAID, "what is wrong?")
        )
    assert said[1:] == [NOT_SEEN]
    assert str(said[0]).startswith("I could not use lookedLike(table, ")


@pytest.mark.parametrize("failures", [1, 4])
def test_a_full_disk_makes_the_learner_say_things_once(tmp_path: Path, failures: int) -> None:
    with Blackboard.transient() as board:
        said = told(board, Learner(str(tmp_path / "m")), ("ada", SAID, "what is wrong?"), failures=failures)
    assert said == [NOT_SEEN]


def test_a_name_that_was_learned_is_acknowledged_once(tmp_path: Path) -> None:
    """Fill the disk after the name was learned, when the robot looks at the table again."""
    learner, looks, named = Learner(str(tmp_path / "m")), iter([True, True, False]), list[str]()

    def look() -> None:
        if next(looks, False):
            raise MemoryWriteError("no space left on device")

    def name_layout(question: object, name: str, by: str, event: str | None) -> tuple[int, ...]:
        named.append(name)
        return 1, 2, 3

    scene = SimpleNamespace(objects=(1,))
    learner._robot = SimpleNamespace(look=look, name_layout=name_layout, scene=scene, expected=())  # type: ignore[assignment]
    learner._named = object()  # type: ignore[assignment]
    with Blackboard.transient() as board:
        said = told(board, learner, ("ada", SAID, "It is called breakfast."), failures=2)
    assert (named, said) == (["breakfast"], ["Thank you: I know 'breakfast' from 3 tables."])


def test_a_name_before_any_table_gets_an_answer(tmp_path: Path) -> None:
    with Blackboard.transient() as board:
        take_in(StoryOf(tmp_path, Utterance("t1 is a fork", 0.0), Utterance("this is a cup", 3.0)), board)
        notes = noted(board, NOTICED)
    assert notes == [f"'{name}' was not learned: no table was seen yet." for name in ("fork", "cup")]


class Writer(Module):
    """Module that writes what it likes."""

    name = "writer"
    writes = (Pattern(),)


@given(st.lists(st.sampled_from(["add", "refused", "flush", "full"]), max_size=20))
def test_an_outbox_writes_each_change_once_in_order(steps: list[str]) -> None:
    outbox, added, refused = Outbox(), list[str](), 0
    with Blackboard.transient() as board:
        own = FullDisk(board, Writer(), 0)
        for step in (*steps, "flush"):
            if step == "add":
                added.append(outbox.new_id(own))
                outbox.add(Add(episodic(added[-1], ("t", "on", "table"), start=1.0, source=SEEN)))
            elif step == "refused":
                outbox.add(Finish("nothing", 2.0))
                refused += 1
            else:
                own.failures = int(step == "full")
                try:
                    refused -= len(outbox.flush(own))
                except MemoryWriteError:
                    assert step == "full"
                own.failures = 0
        assert [change.id for change in board.changes()] == added
    assert refused == 0


@pytest.mark.parametrize("error", [SystemExit(5), KeyboardInterrupt(), ValueError("no camera")], ids=repr)
def test_whatever_a_camera_raises_ends_the_story_with_it(tmp_path: Path, error: BaseException) -> None:
    class Broken(StoryOf):
        def frames(self) -> Iterator[Frame]:
            raise error

    with Blackboard.transient() as board:
        take_in(Broken(tmp_path), board)
        (reason,) = noted(board, ENDED)
    assert str(reason).startswith(type(error).__name__)


def test_the_story_is_done_also_where_the_memory_does_not_open(tmp_path: Path) -> None:
    (tmp_path / "memory").write_text("not a memory")
    learner = Learner(str(tmp_path / "memory"))
    with Blackboard.transient() as board:
        board.write(Add(episodic("f1", ("story", ENDED), start=1.0, source=SEEN)), by="test")
        for change in list(board.changes()):
            learner.changed(change, ModuleBoard(board, learner))
        assert noted(board, DONE) == ["story"]


@pytest.mark.parametrize("start", [Bounds(), Bounds(upper=1e9), Bounds(3.0)], ids=str)
def test_a_run_begins_after_states_with_unknown_times(tmp_path: Path, start: Bounds) -> None:
    left = episodic("f1", ("senses", DROPPED, "many"), start=start, source=SEEN)
    with Blackboard.open(tmp_path / "memory", create=True) as board:
        board.write(Add(left), by="test")
    (tmp_path / "clouds").mkdir()
    with live_robot(tmp_path / "memory", StorySettings(str(tmp_path / "clouds")), print) as robot:
        assert robot.wait(BUSY_SECONDS) and robot.dropped == 0


@pytest.mark.parametrize(
    "text", [None, "{bad", "[]", "{}", "5", '{"objects": [{"id": "a", "min": [0, 0], "max": [1, 1]}]}']
)
def test_a_table_that_others_wrote_is_left_out(tmp_path: Path, text: str | None) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        statement = ("table1", UNNAMED) if text is None else ("table1", UNNAMED, text)
        board.write(Add(episodic("f1", statement, start=1.0, source=SEEN)), by="test")
        learner = Learner(str(tmp_path))
        robot = Robot(tmp_path, ModuleBoard(board, learner))
        assert robot.unnamed == []
        robot.close()


def test_a_description_of_absent_things_gets_an_answer(tmp_path: Path) -> None:
    scene = tmp_path / "a.scene.json"
    scene.write_text('{"objects": []}', encoding="utf-8")
    with Blackboard.transient() as board:
        words = ("table", TABLE, str(scene)), ("ada", SAID, "fork left of plate")
        assert told(board, Learner(str(tmp_path / "memory")), *words) == [NOT_FOUND]
