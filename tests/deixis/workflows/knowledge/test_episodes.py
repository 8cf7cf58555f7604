"""Services over the blackboard: consistency, classes, files, memories by name, and consolidation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from types import SimpleNamespace
from typing import Any

import pytest
from episodic_fluents import SEEN, on
from timing import BUSY_SECONDS

from deixis.grammar.formats.fluents import parse_fluents
from deixis.grammar.script import Script
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.experiences import finish_recording, start_recording
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import episodic
from deixis.memory.journal import write_together
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import Scene
from deixis.reasoning.temporal.bounds import Bounds
from deixis.workflows.knowledge.episodes import (
    Consistency,
    Consolidation,
    Memory,
    check_consistency,
    consolidate,
    consolidate_in_background,
    fluents_of_text,
    known_classes,
    memory_lines,
    scene_of,
    text_of_fluents,
)


@pytest.fixture
def board() -> Iterator[Blackboard]:
    """Empty blackboard in memory."""
    with Blackboard.transient() as made:
        yield made


def test_exported_fluents_are_those_of_the_window(board: Blackboard) -> None:
    board.write(Add(on("f1", 0.0, 1.0)), Add(on("f2", 2.0)), by="test")
    text = text_of_fluents(board, start=1.5)
    assert [fluent.id for fluent in parse_fluents(text).fluents] == ["f2"]
    assert fluents_of_text(text, "x", SEEN) == (on("f2", 2.0),)


def test_opposite_relations_contradict_only_at_one_time() -> None:
    ontology = default_ontology()
    one = episodic("f1", ("a", "left", "b"), start=0.0, finish=5.0, source=SEEN)
    later = episodic("f2", ("b", "left", "a"), start=5.0, source=SEEN)
    together = episodic("f3", ("b", "left", "a"), start=4.0, source=SEEN)
    assert check_consistency((one, later), ontology, logical=False).consistent
    found = check_consistency((one, together), ontology, logical=False)
    assert found.spatial == ("at 4 s: 'a' cannot be both left of and right of 'b' (left(a, b), left(b, a))",)


def test_thing_cannot_be_at_two_places_at_once() -> None:
    first = episodic("f1", ("t1", "at", "[0]"), start=0.0, finish=5.0, source=SEEN)
    moved = episodic("f2", ("t1", "at", "[1]"), start=4.0, source=SEEN)
    found = check_consistency((first, moved), default_ontology(), logical=False)
    assert found.temporal == ("'t1' is at two places at 4 s: 'f1' and 'f2'",)


def test_kinds_that_exclude_each_other_contradict() -> None:
    kinds = [episodic(f"f{n}", ("t1", "isA", kind), start=0.0, source=SEEN) for n, kind in enumerate(("fork", "plate"))]
    assert check_consistency(kinds[:1], default_ontology()).consistent
    found = check_consistency(kinds, default_ontology())
    assert found.logical == ("at 0 s: the kinds and relations contradict the ontology: isA(t1, fork); isA(t1, plate)",)


def test_kinds_contradict_only_at_one_time_and_are_named() -> None:
    names = (("t1", "fork", 0.0, 5.0), ("t1", "plate", 5.0, None), ("t2", "cup", 1.0, None), ("t3", "spoon", 1.0, None))
    kinds = [
        episodic(f"f{n}", (thing, "isA", kind), start=start, finish=finish, source=SEEN)
        for n, (thing, kind, start, finish) in enumerate(names)
    ]
    assert check_consistency(kinds, default_ontology()).consistent
    always = Bounds(-math.inf, math.inf)
    plain = [
        episodic(f"p{n}", ("t3", "isA", kind), start=always, source=SEEN) for n, kind in enumerate(("fork", "bowl"))
    ]
    found = check_consistency((*kinds[:2], *plain), default_ontology())
    assert found.logical[0].endswith("contradict the ontology: isA(t3, bowl); isA(t3, fork)")


def test_thing_is_listed_once_in_each_class(board: Blackboard) -> None:
    for number, kind in enumerate(("fork", "fork")):
        board.add(episodic(f"f{number}", ("t1", "isA", kind), start=0.0, source=SEEN), by="test")
    found = {each.name: each.individuals for each in known_classes(board, default_ontology(), "fork")}
    assert found["Fork"] == ("t1",)


def test_classes_have_their_individuals_of_now(board: Blackboard) -> None:
    board.write(
        Add(episodic("f1", ("t1", "isA", "salad fork"), start=0.0, source=SEEN)),
        Add(episodic("f2", ("t2", "isA", "fork"), start=0.0, finish=1.0, source=SEEN)),
        by="test",
    )
    found = {each.name: each for each in known_classes(board, default_ontology(), "fork")}
    assert found["SaladFork"].individuals == ("t1",)
    assert "Cutlery" in found["Fork"].broader
    assert not found["Fork"].individuals


class Pupil:
    """Session that keeps what it is taught and learns nothing."""

    ontology = default_ontology()

    def __init__(self) -> None:
        self.taught: list[tuple[Script, Scene]] = []

    def learn(self, script: Script, scene: Scene, *, events: Sequence[str] = (), episodes: Any = None) -> Any:
        """Keep a script and a scene."""
        self.taught.append((script, scene))
        lesson = SimpleNamespace(id=f"lesson-{len(self.taught)}")
        write_together(lambda _: None, [episodes([lesson])])
        return SimpleNamespace(lesson=lesson)

    def lessons_of_events(self) -> dict[str, str]:
        """Return nothing."""
        return {}

    def remembers(self) -> bool:
        """Return True if something was taught."""
        return bool(self.taught)

    def layouts(self) -> Any:
        """Return the layouts that were taught."""
        return tuple(
            SimpleNamespace(name=script.name, lesson=f"lesson-{number}")
            for number, (script, _) in enumerate(self.taught, 1)
        )

    def has_views(self) -> bool:
        """Return False."""
        return False

    def categories(self) -> dict[str, int]:
        """Return nothing."""
        return {}


def test_described_experience_becomes_a_layout_once(board: Blackboard) -> None:
    pupil = Pupil()
    start_recording(board, "First supper", 0.0, by="test")
    board.write(
        Add(episodic("p1", ("t1", "at", "[0, 0, 0, 0.2, 0.2, 0.1]"), start=1.0, source=SEEN)),
        Add(episodic("p2", ("t2", "at", "[0.3, 0, 0, 0.4, 0.2, 0.1]"), start=1.0, source=SEEN)),
        Add(episodic("k2", ("t2", "isA", "fork"), start=1.0, certainty=0.9, source=SEEN)),
        Add(episodic("s1", ("anna", "said", "fork right of plate"), start=2.0, source=SEEN)),
        by="test",
    )
    assert consolidate(board, pupil).lessons == {}
    finish_recording(board, "First supper", 3.0, by="test")
    start_recording(board, "silent", 4.0, by="test")
    finish_recording(board, "silent", 5.0, by="test")
    steps: list[tuple[int, int]] = []
    done = consolidate(board, pupil, progress=lambda *step: steps.append(step))
    assert steps == [(0, 2), (1, 2)]
    assert (done.lessons, done.left_out) == ({"First supper": "lesson-1"}, {"silent": "nothing was said in it"})
    ((script, scene),) = pupil.taught
    assert (script.name, [str(fact) for fact in script.facts]) == ("First_supper", ["right(fork, plate)"])
    assert [(each.id, each.label, each.confidence) for each in scene.objects] == [("t1", None, 1), ("t2", "fork", 0.9)]
    assert consolidate(board, pupil).lessons == {}
    assert list(memory_lines(Memory.SEMANTIC, board, pupil)) == ["layout First_supper"]
    assert len(list(memory_lines(Memory.EPISODIC, board, pupil))) == 2
    assert len(list(memory_lines(Memory.WORKING, board, pupil))) == len(board.now())
    assert list(memory_lines(Memory.PROCEDURAL, board, pupil)) == []


def test_finished_experience_is_consolidated_in_the_background(board: Blackboard) -> None:
    results: list[Consolidation] = []
    task = consolidate_in_background(board, Pupil(), results.append)
    start_recording(board, "lunch", 0.0, by="test")
    board.add(episodic("p1", ("t1", "at", "[0, 0, 0, 0.2, 0.2, 0.1]"), start=1.0, source=SEEN), by="test")
    board.add(episodic("s1", ("anna", "said", "fork right of plate"), start=2.0, source=SEEN), by="test")
    finish_recording(board, "lunch", 3.0, by="test")
    assert task.wait(board.sequence, BUSY_SECONDS)
    assert [result.lessons for result in results] == [{"lunch": "lesson-1"}]


@pytest.mark.parametrize(
    ("text", "corners"),
    [
        ("[0, 0, 0, 0.2, 0.3, 0.1]", ((0, 0, 0), (0.2, 0.3, 0.1))),
        ("[[0, 0, 0], [0.2, 0.3, 0.1]]", ((0, 0, 0), (0.2, 0.3, 0.1))),
        ("[[0, 0], [0.2, 0.3]]", ((0, 0), (0.2, 0.3))),
        *(
            (text, None)
            for text in ("no box", "3", "{}", "[]", "[[0], [1]]", "[0, 0, 0, 1, 1, NaN]", "[0, 0, 0, 1, 1, 1e999]")
        ),
        *((text, None) for text in ("[0, 0, 0, -1, 1, 1]", "[[0, 0], [1]]", '["a", 0, 0, 1, 1, 1]', "[" * 100_000)),
    ],
    ids=lambda value: str(value)[:30],
)
def test_a_place_without_a_box_is_not_a_thing_of_a_scene(
    text: str, corners: tuple[tuple[float, ...], ...] | None
) -> None:
    scene = scene_of([episodic("p", ("t1", "at", text), start=0.0, source=SEEN)], 1.0)
    assert (None if scene is None else (scene.objects[0].minimum, scene.objects[0].maximum)) == corners


def test_check_without_time_left_decides_nothing() -> None:
    things = [episodic(f"f{n}", (f"t{n}", "left", "t0"), start=0.0, source=SEEN) for n in range(1, 4)]
    found = check_consistency(things, default_ontology(), time_limit=0.0)
    assert found.consistent and len(found.undecided) == 3
    assert all(line.startswith("time limit reached before") for line in found.undecided)


def test_more_fluents_than_one_network_has_are_checked() -> None:
    many = [episodic(f"f{n}", (f"t{n}", "shines"), start=0.0, source=SEEN) for n in range(5000)]
    assert check_consistency(many, default_ontology(), BUSY_SECONDS, logical=False) == Consistency()
