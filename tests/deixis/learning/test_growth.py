"""The effect of a lesson does not depend on the order of lessons, nor on forgotten ones."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path

import pyoxigraph as ox
import pytest
from commands import deixis
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deixis.learning import update as keeping
from deixis.learning.inference.inferred_graph import everything_by_hermit, everything_that_follows
from deixis.learning.models.sizes import Counts, SizeStatistics, SizeView
from deixis.memory import owner as disk
from deixis.memory.errors import RejectedWriteError
from deixis.memory.folder import size
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.after import After
from deixis.memory.semantic.rdf.graphs import COUNTED, STATISTICS, GraphName, ModelSet
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.verify import verify
from deixis.ontology.lessons.types import Lesson
from deixis.ontology.tbox import default_ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.description_logic import reasoners as description_logic
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

ONTOLOGY = default_ontology()
PLATE = ONTOLOGY.kinds.of_word("dinner plate")
NAMES = ("fork", "dinner_plate", "gizmo", "widget_1", "napkin")
SCRIPT = "layout {name}; fork left of dinner_plate; gizmo right of dinner_plate; widget_1 right of gizmo"


def table(shift: float, unit: str = "m") -> Scene:
    """Return a scene of five labelled things in a row, each of another size."""
    objects = [
        {"id": f"p{place}", "min": [place, 0], "max": [place + 0.1 * (place + 1) + shift, 0.3 + shift], "label": name}
        for place, name in enumerate(NAMES)
    ]
    return read_scene({"objects": objects, "unit": unit})


@pytest.fixture(scope="module")
def lessons(tmp_path_factory: pytest.TempPathFactory) -> list[Lesson]:
    """Six lessons that were never stored; two share a scene, one is in pixels, one gives the gizmo another kind."""
    shifts = [(0.0, "m"), (0.01, "m"), (0.01, "m"), (0.05, "px"), (0.02, "m"), (0.3, "m")]
    found = []
    with Session(tmp_path_factory.mktemp("made") / "memory") as session:
        for number, (shift, unit) in enumerate(shifts):
            text = SCRIPT.format(name=f"t{number}") + ("; gizmo is a Fork" if number == 4 else "")
            learned = session.learn(read_script(text=text), table(shift, unit))
            session.forget(learned.lesson.id)
            found.append(learned.lesson)
    return found


def kept(memory: SemanticMemory) -> tuple[str, set[ox.Quad]]:
    """Return the content of a memory: its export and its counts."""
    own = {q for q in memory.store if str(getattr(q.graph_name, "value", "")).startswith(STATISTICS)}
    return export_memory(memory), {quad for quad in own if quad.subject != COUNTED}


def keep(memory: SemanticMemory, lessons: Sequence[Lesson]) -> None:
    keeping.keeping(memory, ONTOLOGY, lessons)(None)


def forget(memory: SemanticMemory, lesson: str) -> None:
    keeping.forgetting(memory, ONTOLOGY, lesson)(None)


def right(memory: SemanticMemory) -> bool:
    """Return whether the inferences equal those computed from scratch."""
    return memory.kept_up() == keeping.kept_up_rules(ONTOLOGY) and not list(keeping.stale(memory.store, ONTOLOGY))


NUMBERS = count()


@pytest.mark.slow
@settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.integers(0, 5), min_size=2, max_size=7))
def test_any_order_of_learning_and_forgetting_is_equivalent(
    lessons: list[Lesson], tmp_path: Path, turns: list[int]
) -> None:
    """Forget a lesson that is stored when its turn comes; otherwise learn it."""
    folder = tmp_path / str(next(NUMBERS))
    known: set[int] = set()
    with SemanticMemory.open(folder / "turns", create=True) as memory:
        for turn in turns:
            if turn in known:
                forget(memory, lessons[turn].id)
            else:
                keep(memory, [lessons[turn]])
            known ^= {turn}
        assert right(memory)
        found = kept(memory)
    with SemanticMemory.open(folder / "scratch", create=True) as memory:
        keeping.keeping(memory, ONTOLOGY, [lessons[number] for number in sorted(known, reverse=True)] or [lessons[0]])(
            None
        )
        if not known:
            forget(memory, lessons[0].id)
        assert kept(memory) == found


@pytest.mark.slow
def test_the_inferred_graph_is_what_hermit_makes_of_the_lessons(lessons: list[Lesson], tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        for lesson in lessons:
            keep(memory, [lesson])
        forget(memory, lessons[1].id)
        after = After(memory.store)
        ours, theirs = (
            everything_that_follows(after, ONTOLOGY.relations),
            everything_by_hermit(after, ONTOLOGY.relations),
        )
        assert {t for t in theirs - ours if "HermiT" not in str(t)} == set()
        assert ours == set(memory.triples(GraphName.INFERRED)) and ours <= theirs


def test_a_lesson_starts_no_java(lessons: list[Lesson], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError("a reasoner was started")

    monkeypatch.setattr(description_logic, "_run", refuse)
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        keep(memory, lessons[:2])
        forget(memory, lessons[0].id)
        assert right(memory)


VIEWS = st.builds(
    SizeView,
    kind=st.sampled_from([PLATE.iri if PLATE else "", "urn:gizmo", "urn:widget"]),
    box=st.sampled_from("abcdefgh"),
    scene=st.sampled_from(["urn:s1", "urn:s2"]),
    metric=st.booleans(),
    plain=st.tuples(st.integers(-(2**25), 0), st.integers(-(2**24), 0)),
    relative=st.tuples(st.integers(-(2**25), 2**24), st.integers(-(2**24), 2**24)),
)


def counted(views: Sequence[SizeView]) -> Counts:
    counts = Counts()
    statistics = SizeStatistics(counts, ONTOLOGY.sizes)
    for view in views:
        statistics.add(view)
    statistics.settle()
    return counts


@given(st.lists(VIEWS, max_size=12), st.lists(VIEWS, max_size=6), st.randoms(use_true_random=False))
def test_sizes_forget_what_was_added(stay: list[SizeView], go: list[SizeView], rng: object) -> None:
    expected = counted(stay).difference()
    mixed = [*stay, *go]
    rng.shuffle(mixed)  # type: ignore[attr-defined]
    before = {(row, key): value for row, key, value in counted(mixed).difference()[1]}

    def row(name: str) -> dict[str, str]:
        return {key: value for (other, key), value in before.items() if other == name}

    counts = Counts(lambda name, key: before.get((name, key)), row)
    statistics, left = SizeStatistics(counts, ONTOLOGY.sizes), list(mixed)
    for view in go:
        left.remove(view)
        statistics.remove(view, [other for other in left if other.place == view.place])
    statistics.settle()
    gone, come = counts.difference()
    for name, key, _ in gone:
        del before[name, key]
    before.update({(name, key): value for name, key, value in come})
    assert sorted((name, key, value) for (name, key), value in before.items()) == sorted(expected[1])


def as_version_1(folder: Path) -> None:
    """Convert a memory to the version before statistics."""
    store = ox.Store(folder / "semantic")
    for graph in list(store.named_graphs()):
        if str(getattr(graph, "value", "")).startswith(STATISTICS):
            store.remove_graph(graph)
    store.flush()
    del store
    mark = json.loads((folder / "memory.json").read_text())
    (folder / "memory.json").write_text(json.dumps({**mark, "version": 1}))


def test_the_next_lesson_counts_a_memory_without_statistics(lessons: list[Lesson], tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        keep(memory, lessons[:3])
    with SemanticMemory.open(tmp_path / "other", create=True) as memory:
        keep(memory, lessons[:2])
        expected = kept(memory)
    as_version_1(tmp_path / "memory")
    with SemanticMemory.open(tmp_path / "memory") as memory:
        assert memory.kept_up() is None
        forget(memory, lessons[2].id)
        assert kept(memory) == expected and right(memory)


def test_verify_finds_what_does_not_follow_from_the_lessons(lessons: list[Lesson], tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        keep(memory, lessons[:3])
    check = (tmp_path / "memory", None, lambda store: keeping.stale(store, ONTOLOGY))
    assert verify(*check).findings == ()
    store = ox.Store(tmp_path / "memory" / "semantic")
    quad = next(quad for quad in store.quads_for_pattern(None, None, None, COUNTED) if quad.subject != COUNTED)
    store.remove(quad)
    store.flush()
    del store
    (finding,) = verify(*check).findings
    assert "counts differ from what the lessons lead to: 0 too many, 1 missing" in finding.what


def test_a_memory_changed_by_hand_is_recomputed(lessons: list[Lesson], tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        keep(memory, lessons[:3])
        expected = kept(memory)
        memory.keep_models({ModelSet.SIZES: []})
        assert memory.kept_up() is None
        keep(memory, [lessons[3]])
        forget(memory, lessons[3].id)
        assert kept(memory) == expected and right(memory)


# ---- many at once


def pair(folder: Path, name: str, shift: float) -> None:
    (folder / f"{name}.layout").write_text(SCRIPT.format(name=name).replace("; ", "\n"), encoding="utf-8")
    objects = [
        {"id": seen.id, "min": list(seen.minimum), "max": list(seen.maximum), "label": seen.label}
        for seen in table(shift).objects
    ]
    (folder / f"{name}.scene.json").write_text(json.dumps({"objects": objects}), encoding="utf-8")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "pairs").mkdir()
    for name, shift in (("tea", 0.0), ("lunch", 0.02)):
        pair(tmp_path / "pairs", name, shift)
    return tmp_path / "pairs"


def test_a_folder_of_pairs_is_learned_in_one_call(folder: Path, tmp_path: Path) -> None:
    pair(tmp_path, "tea", 0.04)
    more = [tmp_path / "tea.layout", tmp_path / "tea.scene.json"]
    code, out, _ = deixis("learn", folder, *more, "--memory", tmp_path / "memory", "--json")
    assert (code, [told["lesson"] for told in json.loads(out)]) == (0, ["lunch-1", "tea-1", "tea-2"])
    with Session(tmp_path / "memory") as session:
        assert sorted(session.memory().lessons()) == ["lunch-1", "tea-1", "tea-2"]
        assert right(session.memory())


def test_of_a_batch_all_lessons_are_kept_or_none(tmp_path: Path) -> None:
    good = (read_script(text=SCRIPT.format(name="tea")), table(0.0))
    nothing = (read_script(text="layout x; a left of b"), read_scene({"objects": []}))
    with Session(tmp_path / "memory") as session:
        with pytest.raises(LookupError, match="no object of the script"):
            session.learn_all([good, nothing])
        assert session.memory(create=True).lessons() == ()
        assert session.learn_all([]) == ()


def test_many_lessons_in_parts_give_the_same_memory(
    lessons: list[Lesson], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with SemanticMemory.open(tmp_path / "single", create=True) as memory:
        keep(memory, [lessons[0]])
        keep(memory, lessons[1:])
        expected = kept(memory)
    monkeypatch.setattr(keeping, "AT_ONCE", 2)
    with SemanticMemory.open(tmp_path / "many", create=True) as memory:
        keep(memory, [lessons[0]])
        keep(memory, lessons[1:])
        assert kept(memory) == expected and right(memory)
        forget(memory, lessons[1].id)
        assert right(memory)


def test_of_many_lessons_all_are_kept_or_none(
    lessons: list[Lesson], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keeping, "AT_ONCE", 2)
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        keep(memory, [lessons[0]])
        before = kept(memory)
        with pytest.raises(RejectedWriteError, match="there is already a lesson"):
            keep(memory, [*lessons[1:5], lessons[0]])
        assert kept(memory) == before and right(memory)
        assert not (tmp_path / "memory" / "semantic.new").exists()
    with SemanticMemory.open(tmp_path / "memory") as memory:
        assert kept(memory) == before


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["pairs/tea.layout"], "give its scene after it"),
        (["empty"], "there is no NAME.layout"),
        (["alone"], "there is no tea.scene.json beside it"),
    ],
)
def test_an_invalid_pair_is_reported(folder: Path, tmp_path: Path, given: list[str], said: str) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "alone").mkdir()
    shutil.copy(folder / "tea.layout", tmp_path / "alone")
    code, out, err = deixis("learn", *(tmp_path / name for name in given), "--memory", tmp_path / "memory")
    assert (code, out) == (2, "")
    assert said in err


# ---- the disk


@pytest.fixture
def half_forgotten(lessons: list[Lesson], tmp_path: Path) -> tuple[Path, str]:
    """Make a memory that is rewritten at its next closing, as many lessons were forgotten; also return its export."""
    many = [replace(lessons[0], layout=replace(lessons[0].layout, lesson=f"many-{n}")) for n in range(11)]
    memory = SemanticMemory.open(tmp_path / "memory", create=True)
    keep(memory, [*many, lessons[1]])
    for lesson in many:
        forget(memory, lesson.id)
    text = export_memory(memory)
    memory._forgets = 0
    memory.close()
    return tmp_path / "memory", text


def close_after_forgetting(folder: Path) -> None:
    memory = SemanticMemory.open(folder)
    memory._forgets = 11
    memory.close()


def exported(folder: Path) -> str:
    with SemanticMemory.open(folder) as memory:
        assert right(memory)
        return export_memory(memory)


def test_the_disk_is_given_back_after_forgetting(half_forgotten: tuple[Path, str]) -> None:
    folder, text = half_forgotten
    before = size(folder)
    close_after_forgetting(folder)
    assert size(folder) < before / 2
    assert exported(folder) == text


@pytest.mark.parametrize("steps", range(4))
def test_a_crash_while_giving_back_loses_nothing(
    half_forgotten: tuple[Path, str], steps: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, text = half_forgotten
    left = [steps]

    def crashing(old: Path, new: Path, real: object = disk.rename) -> None:
        if left[0] == 0:
            raise KeyboardInterrupt
        left[0] -= 1
        real(old, new)  # type: ignore[operator]

    with monkeypatch.context() as patched:
        patched.setattr(disk, "rename", crashing)
        if steps < 3:
            with pytest.raises(KeyboardInterrupt):
                close_after_forgetting(folder)
        else:
            close_after_forgetting(folder)
    assert exported(folder) == text
