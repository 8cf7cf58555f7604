"""Take back what was taught: it is gone from all stores, and nothing else is."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import count
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

import deixis
from deixis.learning.update import stale
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin, Source, episodic
from deixis.memory.errors import MemoryWriteError, UnknownLessonError
from deixis.memory.journal import MARKS
from deixis.memory.perceptual.database.handle import Handle
from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.graphs import ORDER, GraphName, graph_iri
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.verify import verify
from deixis.ontology.lessons.types import Lesson
from deixis.ontology.tbox import default_ontology
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.errors import SettingError
from deixis.session import Session
from deixis.view_store import views_of_matches
from deixis.workflows.descriptions.remembered_attributes import remember_sentence, remembered_attributes
from deixis.workflows.knowledge.unlearn import Selection, span_of_day
from deixis.workflows.scenes.views_of_lessons import keep_lessons

NAMES = ("gizmo", "widget", "doodad")
TIMES = re.compile(r'"[^"]*"\^\^xsd:dateTime')


def table(number: int) -> Scene:
    """Return three things in a row, each with a cloud of its own."""
    shift = 0.01 * number
    boxes = [
        {
            "id": f"o{place}",
            "min": [place / 4, 0, 0],
            "max": [place / 4 + 0.1 + shift, 0.1 + 0.04 * place, 0.04],
            "label": name,
        }
        for place, name in enumerate(NAMES)
    ]
    scene = read_scene({"objects": boxes})
    random = np.random.default_rng(number)
    things = []
    for thing in scene.objects:
        low, high = np.array(thing.minimum), np.array(thing.maximum)
        things.append(replace(thing, cloud=PointCloud(random.uniform(low, high, (300, 3)).astype(np.float32))))
    return replace(scene, objects=tuple(things), file=f"<table {number}>")


def renamed(scene: Scene, names: Sequence[str]) -> Scene:
    things = zip(scene.objects, names, strict=True)
    return replace(scene, objects=tuple(replace(thing, label=name) for thing, name in things))


TABLES = [table(number) for number in range(2)]


@pytest.fixture(scope="module")
def lessons(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Lesson, Any]]:
    """Four lessons with their views, of two tables; each matches the fork and the knife with other things."""
    found = []
    with Session(tmp_path_factory.mktemp("made") / "memory") as session:
        for number in range(4):
            first, middle, last = NAMES if number < 2 else NAMES[::-1]
            text = f"layout t{number}; {first} left of {middle}; {last} right of {middle}"
            scene = renamed(TABLES[number % 2], (first, middle, last))
            learned = session.learn(deixis.read_script(text=text), scene, teacher=f"L{number}")
            session.forget(learned.lesson.id)
            found.append((learned.lesson, views_of_matches(scene, learned.lesson.matches)))
    return found


class Teaching(NamedTuple):
    """A person says what a thing of a table is."""

    table: int
    thing: int
    name: str


events = st.one_of(st.integers(0, 3), st.builds(Teaching, st.integers(0, 1), st.integers(0, 2), st.sampled_from(NAMES)))


def do(session: Session, event: int | Teaching, teacher: str, lessons: list[tuple[Lesson, Any]]) -> None:
    if isinstance(event, Teaching):
        session.teach(TABLES[event.table], f"o{event.thing}", event.name, teacher)
    else:
        lesson, views = lessons[event]
        known = {lesson.id: session.view_store.except_taught(views)[0]}
        keep_lessons([lesson], known, session.knowledge_store, session.view_store, {lesson.id: views})


def content(session: Session) -> tuple[Any, ...]:
    """Return everything in a memory but times and the ontology."""
    memory, store = session.views(create=True), session.memory().store
    quads = {
        TIMES.sub("time", str(quad))
        for graph in store.named_graphs()
        if graph not in (ORDER, MARKS, graph_iri(GraphName.ONTOLOGY))
        for quad in store.quads_for_pattern(None, None, None, graph)
    }
    views = [(view.id, view.category, dict(view.metadata)) for view in memory.views()]
    records = {}
    for name in memory.categories():
        record = memory.category(name)
        state = {key: array.tobytes() for key, array in record.state.items()}
        records[name] = (state, dict(record.metadata))
    turns = {id: [{**turn, "time": None} for turn in turns] for id, turns in memory.teachings().items()}
    return quads, views, records, memory.lessons_of_views(), turns


def sound(folder: Path) -> bool:
    return verify(folder, None, lambda store: stale(store, default_ontology())).findings == ()


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory, lessons: list[tuple[Lesson, Any]]) -> Path:
    """A memory that was taught one lesson, which was taken back."""
    folder = tmp_path_factory.mktemp("empty") / "memory"
    with Session(folder) as session:
        do(session, 0, "", lessons)
        session.unlearn(Selection(lesson=lessons[0][0].id))
        assert content(session)[1:] == ([], {}, {}, {})
    return folder


NUMBERS = count()


@settings(max_examples=3, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@example([(0, True), (Teaching(0, 0, "widget"), False), (2, False), (Teaching(0, 0, "doodad"), True)], Random(1))
@given(st.lists(st.tuples(events, st.booleans()), min_size=2, max_size=6), st.randoms(use_true_random=False))
def test_without_what_was_taken_back_it_is_as_if_never_taught(
    lessons: list[tuple[Lesson, Any]],
    empty: Path,
    tmp_path: Path,
    told: list[tuple[int | Teaching, bool]],
    random: Random,
) -> None:
    """Teach everything, and take some of it back in any order; or teach only the rest."""
    told = [each for place, each in enumerate(told) if each[0] not in [event for event, _ in told[:place]]]
    folder = tmp_path / str(next(NUMBERS))
    with Session(shutil.copytree(empty, folder / "all")) as session:
        for number, (event, _) in enumerate(told):
            do(session, event, f"T{number}", lessons)
        back = [(number, event) for number, (event, kept) in enumerate(told) if not kept]
        random.shuffle(back)
        for number, event in back:
            assert session.unlearn(Selection(teacher=f"T{number}" if isinstance(event, Teaching) else f"L{event}"))
        found = content(session)
    with Session(shutil.copytree(empty, folder / "rest")) as session:
        for number, (event, kept) in enumerate(told):
            if kept:
                do(session, event, f"T{number}", lessons)
        assert content(session) == found


def taught(session: Session, lessons: Sequence[tuple[Lesson, Any]]) -> None:
    do(session, 0, "", list(lessons))
    do(session, Teaching(0, 0, "widget"), "Ada", list(lessons))
    do(session, 3, "", list(lessons))


def test_each_part_of_a_selection_must_hold(lessons: list[tuple[Lesson, Any]], empty: Path, tmp_path: Path) -> None:
    with Session(shutil.copytree(empty, tmp_path / "memory")) as session:
        taught(session, lessons)
        first, day = lessons[0][0].id, timedelta(1)
        now = datetime.now(UTC)

        def back(**parts: Any) -> tuple[tuple[str, ...], list[tuple[str, str | None]]]:
            found = session.unlearn(Selection(**parts), dry_run=True)
            return found.lessons, [(change.before, change.category) for change in found.views if change.sources]

        assert back(label="gizmo") == ((), [])
        assert back(label="widget", teacher="Bob") == ((), [])
        assert back(label="widget") == back(teacher="Ada") == ((), [("widget", "gizmo")])
        assert back(lesson=first)[0] == back(teacher="L0")[0] == (first,)
        assert back(sentence="Layout t0") == ((), [])
        part = session.unlearn(Selection(sentence="gizmo left of widget"), dry_run=True)
        assert part.lessons == () and first in part.revised
        assert set(back(table=TABLES[0])[0]) == set(back(table="<table 0>")[0]) == {first}
        assert back(since=now + day) == back(until=now - day) == ((), [])
        assert len(back(since=now - day, until=now + day)[0]) == 2
        with pytest.raises(UnknownLessonError, match="no lesson 'nothing'"):
            back(lesson="nothing")


def test_taking_back_several_lessons_counts_them(
    lessons: list[tuple[Lesson, Any]], empty: Path, tmp_path: Path
) -> None:
    with Session(shutil.copytree(empty, tmp_path / "memory")) as session:
        taught(session, lessons)
        now, steps = datetime.now(UTC), []
        since = Selection(since=now - timedelta(1))
        found = session.unlearn(since, progress=lambda *step: steps.append(step))
        assert len(found.lessons) == 2 and steps == [(0, 2), (1, 2)]


def test_a_selection_names_something() -> None:
    with pytest.raises(SettingError, match="name what to take back"):
        Selection()
    with pytest.raises(SettingError, match="must be a date"):
        span_of_day("23rd")


def test_a_refused_write_takes_nothing_back(
    lessons: list[tuple[Lesson, Any]], empty: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError("No space left on device")

    with Session(shutil.copytree(empty, tmp_path / "memory")) as session:
        taught(session, lessons)
        before = content(session)
        with monkeypatch.context() as patched:
            patched.setattr(ledger, "update", full)
            with pytest.raises(MemoryWriteError):
                session.unlearn(Selection(lesson=lessons[0][0].id))
        assert content(session) == before


def test_a_write_cut_short_is_finished_at_the_next_opening(
    lessons: list[tuple[Lesson, Any]], empty: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise MemoryWriteError("the disk is full")

    with Session(shutil.copytree(empty, tmp_path / "memory")) as session:
        taught(session, lessons)
        with monkeypatch.context() as patched:
            patched.setattr(Handle, "write", full)
            with pytest.raises(MemoryWriteError):
                session.unlearn(Selection(table=TABLES[0]))
    assert sound(tmp_path / "memory")
    with Session(tmp_path / "memory") as session:
        assert session.memory().lessons() == (lessons[3][0].id,)
        assert not session.unlearn(Selection(table=TABLES[0]))


def told_episodes(board: Blackboard) -> None:
    """Ada says a sentence and shows a thing, Bob shows another, and the tracker sees them."""
    said, seen = Source(Origin.SAID, "Ada", "sentence 1"), Source(Origin.SEEN, "tracker")
    for id, statement, source in (
        ("f1", ("Ada", "said", "The fork is left of the plate."), said),
        ("f2", ("t1", "left", "t2"), replace(said, origin=Origin.INFERRED)),
        ("f3", ("t1", "isA", "fork"), Source(Origin.SHOWN, "Ada", "gesture 1")),
        ("f4", ("t2", "isA", "plate"), Source(Origin.SHOWN, "Bob")),
        ("f5", ("t1", "on", "table"), seen),
    ):
        board.add(episodic(id, statement, start=1.0, source=source), by="test")


@pytest.mark.parametrize(
    ("selection", "gone"),
    [
        (Selection(sentence="the fork is left of the plate"), {"f1", "f2"}),
        (Selection(teacher="Ada"), {"f1", "f2", "f3"}),
        (Selection(label="plate"), {"f4"}),
        (Selection(since=datetime(2026, 1, 1, tzinfo=UTC)), {"f1", "f2", "f3", "f4"}),
        (Selection(until=datetime(2026, 1, 1, tzinfo=UTC)), set()),
    ],
)
def test_what_persons_said_and_showed_is_taken_back(selection: Selection, gone: set[str], tmp_path: Path) -> None:
    with Blackboard.open(tmp_path / "memory", create=True, origin=datetime(2026, 5, 1, tzinfo=UTC)) as board:
        told_episodes(board)
        with Session(tmp_path / "memory") as session:
            assert set(session.unlearn(selection, dry_run=True).fluents) == gone
            assert set(session.unlearn(selection).fluents) == gone
        assert {each.id for each in board.holding()} == {"f1", "f2", "f3", "f4", "f5"} - gone


def test_episodes_stay_where_the_lessons_cannot_be_removed(
    lessons: list[tuple[Lesson, Any]], empty: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError("No space left on device")

    folder = shutil.copytree(empty, tmp_path / "memory")
    with Session(folder) as session, Blackboard.open(folder, create=True) as board:
        taught(session, lessons)
        told_episodes(board)
        with monkeypatch.context() as patched:
            patched.setattr(ledger, "update", full)
            with pytest.raises(MemoryWriteError):
                session.unlearn(Selection(teacher="Ada"))
        assert len(board.holding()) == 5


def test_sentence_that_taught_an_adjective_is_taken_back(tmp_path: Path) -> None:
    boxes = [[0.0, 0.0, 0.0], [0.4, 0.0, 0.0]]
    scene = Scene.from_boxes(centre=boxes, size=[[0.1] * 3, [0.2] * 3], labels=["cup", "cup"])
    with Session(tmp_path) as session:
        with Blackboard.open(tmp_path, create=True) as board:
            remember_sentence(board, "the blick one", scene, "o1", by="ada")
            before = remembered_attributes(board)
            remember_sentence(board, "the tove cup", scene, "o2", by="bob")
            assert set(remembered_attributes(board)) == {"blick", "tove"}
        assert len(session.unlearn(Selection(sentence="The tove cup.")).fluents) == 2
        with Blackboard.open(tmp_path) as board:
            left = remembered_attributes(board)
    assert left.keys() == before.keys() == {"blick"}
    assert [one.positive for one in left["blick"].examples] == [one.positive for one in before["blick"].examples]


def killing(*_: object, **__: object) -> None:
    raise KeyboardInterrupt


@pytest.mark.kills
@pytest.mark.parametrize("killed", ["before", "after"])
@pytest.mark.parametrize("seen", [False, True], ids=["lesson", "lesson and views"])
def test_kill_at_the_commit_leaves_all_memories_in_step(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, killed: str, seen: bool
) -> None:
    cloud = PointCloud(np.random.default_rng(0).uniform(0, 0.1, (200, 3)).astype(np.float32))
    boxes = [[0.05, 0.05, 0.05], [0.4, 0.05, 0.05]]
    scene = Scene.from_boxes(centre=boxes, size=[[0.1] * 3] * 2, labels=["cup", "plate"])
    if seen:
        scene = replace(scene, objects=(replace(scene.objects[0], cloud=cloud), scene.objects[1]))
    with Session(tmp_path) as session:
        script = deixis.read_script(text="layout pair; cup left of plate")
        lesson = session.learn(script, scene, teacher="Ada").lesson.id
        with Blackboard.open(tmp_path, create=True) as board:
            source = Source(Origin.SAID, "Ada", lesson)
            board.add(episodic("f1", ("Ada", "said", "cup left of plate"), start=0.0, source=source), by="test")
        if killed == "before":
            monkeypatch.setattr(SemanticMemory, "commit", killing)
        for end in ("complete", "settle"):
            monkeypatch.setattr(Blackboard, end, killing)
        with pytest.raises(KeyboardInterrupt):
            session.unlearn(Selection(teacher="Ada"))
        monkeypatch.undo()
    with Session(tmp_path) as session, Blackboard.open(tmp_path) as board:
        session.recall("what did Ada say?")
        left = {each.id for each in board.now()}
        assert (lesson in session.memory().lessons()) == (killed == "before")
        assert (left, bool(session.view_store.exists() and session.categories())) == (
            ({"f1"}, seen) if killed == "before" else (set(), False)
        )
    assert verify(tmp_path).findings == ()


@pytest.mark.parametrize("day", ["0001-01-01", "9999-12-31", "2026-99-99", "nan"])
def test_a_day_beyond_the_calendar_is_an_error(day: str) -> None:
    with pytest.raises(SettingError, match="a day must be a date"):
        span_of_day(day)
