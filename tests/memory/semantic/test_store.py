"""Learn and forget lessons, and check what is left."""

from __future__ import annotations

import gc
from collections.abc import Callable
from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.memory import owner as disk
from deixis.memory.errors import (
    MemoryBusyError,
    MemoryFormatError,
    MemoryWriteError,
    RejectedWriteError,
    UnknownLessonError,
)
from deixis.memory.folder import NEW, VERSION
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.graphs import ORDER, GraphName, lesson_graph
from deixis.memory.semantic.store import SemanticMemory

Learn = Callable[..., None]
Read = Callable[[str], list[ox.Triple]]
MakeLesson = Callable[..., dict[GraphName, list[ox.Triple]]]


def test_a_lesson_is_in_its_graphs_and_outlives_the_process(tmp_path: Path, learn: Learn) -> None:
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        learn(memory, "dinner-1")
        before = export_memory(memory)
    with SemanticMemory.open(tmp_path / "m") as memory:
        assert memory.lessons() == ("dinner-1",)
        assert export_memory(memory) == before


def test_lessons_come_in_the_order_learned_not_that_of_the_clock(memory: SemanticMemory, learn: Learn) -> None:
    learn(memory, "z-1", day=1)
    learn(memory, "a-1", day=3)
    learn(memory, "b-1", day=2)
    assert memory.lessons() == ("z-1", "a-1", "b-1")
    memory.forget("b-1", [])
    learn(memory, "y-1", day=1)
    assert memory.lessons() == ("z-1", "a-1", "y-1")


def test_lessons_without_a_number_come_first_by_the_clock(memory: SemanticMemory, learn: Learn) -> None:
    learn(memory, "z-1", day=3)
    learn(memory, "a-1", day=2)
    memory.store.remove_graph(ORDER)  # as an older version left it
    learn(memory, "b-1", day=1)
    assert memory.lessons() == ("a-1", "z-1", "b-1")


def test_forgetting_a_lesson_equals_never_learning_it(memory: SemanticMemory, learn: Learn) -> None:
    learn(memory, "dinner-1")
    before, inferred = export_memory(memory), list(memory.triples(GraphName.INFERRED))
    graphs = {name: set(memory.triples(name)) for name in GraphName if name is not GraphName.INFERRED}
    learn(memory, "dinner-2", day=2)
    memory.forget("dinner-2", inferred)
    assert export_memory(memory) == before
    assert {name: set(memory.triples(name)) for name in graphs} == graphs


def test_forgetting_the_first_lesson_keeps_shared_triples(
    memory: SemanticMemory, learn: Learn, make_lesson: MakeLesson
) -> None:
    learn(memory, "dinner-1")
    learn(memory, "dinner-2", day=2)
    memory.forget("dinner-1", [])
    said = make_lesson("dinner-2", day=2)
    assert len(list(memory.triples(GraphName.ASSERTED))) == len(set(said[GraphName.ASSERTED]))
    assert not list(memory.triples(GraphName.INFERRED))
    assert memory.lessons() == ("dinner-2",)


def test_forgetting_everything_leaves_an_empty_memory(memory: SemanticMemory, learn: Learn) -> None:
    before = export_memory(memory)
    learn(memory, "dinner-1")
    memory.forget("dinner-1", [])
    assert export_memory(memory) == before
    assert {graph.value for graph in memory.store.named_graphs() if isinstance(graph, ox.NamedNode)}.isdisjoint(
        {lesson_graph("dinner-1", name).value for name in GraphName}
    )


def test_loaded_triples_stay_when_a_lesson_with_them_goes(memory: SemanticMemory, read: Read) -> None:
    loaded = read('<urn:a> <urn:p> "x" . <urn:b> <urn:p> 1 .')
    memory.load({GraphName.ASSERTED: loaded})
    memory.learn("one", {GraphName.ASSERTED: loaded[:1]}, [])
    memory.forget("one", [])
    assert set(memory.triples(GraphName.ASSERTED)) == set(loaded)


def test_triples_loaded_after_a_lesson_with_them_stay(memory: SemanticMemory, read: Read) -> None:
    triples = read('<urn:a> <urn:p> "x" .')
    memory.learn("one", {GraphName.ASSERTED: triples}, [])
    memory.load({GraphName.ASSERTED: triples})
    memory.forget("one", [])
    assert list(memory.triples(GraphName.ASSERTED)) == triples


def test_the_packaged_ontology_survives_a_lesson_that_repeats_it(memory: SemanticMemory) -> None:
    tbox = set(memory.triples(GraphName.ONTOLOGY))
    memory.learn("copycat", {GraphName.ONTOLOGY: sorted(tbox, key=str)[:50]}, [])
    memory.forget("copycat", [])
    assert set(memory.triples(GraphName.ONTOLOGY)) == tbox


def test_the_inferred_graph_is_replaced_as_a_whole(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read("<urn:a> <urn:p> 1 .")}, read("<urn:a> <urn:q> 1, 2 ."))
    memory.learn("two", {GraphName.ASSERTED: read("<urn:b> <urn:p> 1 .")}, read("<urn:a> <urn:q> 2, 3 ."))
    assert set(memory.triples(GraphName.INFERRED)) == set(read("<urn:a> <urn:q> 2, 3 ."))


def test_an_unknown_lesson_suggests_the_nearest(taught: SemanticMemory) -> None:
    with pytest.raises(UnknownLessonError, match=r"no lesson 'diner-1'.*did you mean 'dinner-1'"):
        taught.forget("diner-1", [])


def test_a_lesson_is_learned_once(taught: SemanticMemory, learn: Learn) -> None:
    before = export_memory(taught)
    with pytest.raises(RejectedWriteError, match="there is already a lesson 'dinner-1': forget it first"):
        learn(taught, "dinner-1")
    assert export_memory(taught) == before


@pytest.mark.parametrize("said", [{}, {GraphName.LEARNED: []}])
def test_a_lesson_without_triples_is_refused(memory: SemanticMemory, said: dict[GraphName, list[ox.Triple]]) -> None:
    with pytest.raises(RejectedWriteError, match="has no triples"):
        memory.learn("empty", said, [])


def test_blank_nodes_become_names(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read("[] <urn:p> [ <urn:q> 1 ] .")}, read("[] <urn:p> 2 ."))
    for name in (GraphName.ASSERTED, GraphName.INFERRED):
        assert all(isinstance(triple.subject, ox.NamedNode) for triple in memory.triples(name))


def test_a_triple_in_a_triple_is_refused(memory: SemanticMemory) -> None:
    inner = ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("x"))
    with pytest.raises(RejectedWriteError, match="a triple inside a triple"):
        memory.learn("one", {GraphName.ASSERTED: [ox.Triple(inner.subject, inner.predicate, inner)]}, [])


def test_a_closed_memory_says_so(tmp_path: Path) -> None:
    memory = SemanticMemory.open(tmp_path / "m", create=True)
    memory.close()
    memory.close()
    with pytest.raises(MemoryFormatError, match="closed"):
        memory.lessons()


def test_stats_count_what_is_kept(taught: SemanticMemory) -> None:
    stats = taught.stats()
    assert (stats.lessons, stats.layouts, stats.categories, stats.scenes, stats.version) == (2, 2, 2, 2, VERSION)
    assert stats.triples[GraphName.LEARNED] == len(list(taught.triples(GraphName.LEARNED)))
    assert stats.bytes > 1000


def test_the_rdflib_view_is_live_and_gone_with_the_memory(tmp_path: Path, learn: Learn) -> None:
    memory = SemanticMemory.open(tmp_path / "m", create=True)
    view = memory.dataset()
    learn(memory, "dinner-1")
    rows = view.query("SELECT ?s WHERE { ?s a <https://w3id.org/deixis/onto#Lesson> }")
    assert len(list(rows)) == 1
    memory.close()
    with SemanticMemory.open(tmp_path / "m") as again:
        assert again.lessons() == ("dinner-1",)
    assert len(view) == 0


def test_loading_keeps_a_view_from_reading_stale_data(taught: SemanticMemory, read: Read) -> None:
    taught.load({GraphName.ASSERTED: read("<urn:a> <urn:p> 1 .")})
    assert taught.lessons() == ("dinner-1", "dinner-2")
    assert taught.query("ASK { <urn:a> ?p 1 }").boolean is True


def learn_in_bulk(memory: SemanticMemory, make_lesson: MakeLesson) -> None:
    made = make_lesson("dinner-2", day=2)
    lesson = {"dinner-2": {graph: made[graph] for graph in made.keys() - {GraphName.INFERRED}}}
    memory.commit_in_bulk(lambda copy: copy.commit(copy.arrival(lesson)))


def test_a_bulk_commit_while_an_iterator_reads_changes_nothing(
    memory: SemanticMemory, learn: Learn, make_lesson: MakeLesson
) -> None:
    learn(memory, "dinner-1")
    reading = iter(memory.store.quads_for_pattern(None, None, None, None))
    with pytest.raises(MemoryBusyError, match="release the iterators over it"):
        learn_in_bulk(memory, make_lesson)
    with pytest.raises(MemoryBusyError, match="release the iterators over it"):
        memory.lessons()
    del reading
    assert memory.lessons() == ("dinner-1",)
    assert not (memory.path / NEW).exists()


def test_an_answered_query_of_rdflib_does_not_block_bulk_commits(
    memory: SemanticMemory, learn: Learn, make_lesson: MakeLesson
) -> None:
    learn(memory, "dinner-1")
    gc.disable()
    try:
        assert len(memory.dataset().query("SELECT ?s WHERE { ?s a ?type }")) > 0
        learn_in_bulk(memory, make_lesson)
    finally:
        gc.enable()
    assert memory.lessons() == ("dinner-1", "dinner-2")


def test_an_interrupted_replacement_is_undone_at_next_opening(
    tmp_path: Path, learn: Learn, make_lesson: MakeLesson, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_space(old: Path, new: Path) -> None:
        if old.name == NEW:
            raise OSError(28, "No space left on device")
        rename(old, new)

    rename = disk.rename
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        learn(memory, "dinner-1")
        with monkeypatch.context() as patched:
            patched.setattr(disk, "rename", no_space)
            with pytest.raises(MemoryWriteError, match="No space left"):
                learn_in_bulk(memory, make_lesson)
        with pytest.raises(MemoryWriteError, match="open the memory again"):
            memory.lessons()
    with SemanticMemory.open(tmp_path / "m") as memory:
        assert memory.lessons() == ("dinner-1",)
