"""No acknowledged write is lost: processes killed at random moments, full disks, read-only folders."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from killing import forks_of
from read_only import make_read_only

from deixis.memory.errors import MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.graphs import MERGED, UNION, GraphName, ModelSet, graph_iri
from deixis.memory.semantic.store import SemanticMemory

Learn = Callable[..., None]

KILLS = 50

LEARNER = """
import os, random
import pyoxigraph as ox
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

p = ox.NamedNode("urn:p")

def triples(lesson, number):
    return [ox.Triple(ox.NamedNode(f"urn:{lesson}:{i}"), p, ox.Literal(str(i))) for i in range(number)]

def say(verb, lesson):
    os.write(1, f"{verb} {lesson}\\n".encode())

def work(folder, seed):
    rng, shared = random.Random(int(seed)), triples("shared", 5)
    memory = SemanticMemory.open(folder, create=True)
    for turn in range(10_000):
        known = memory.lessons()
        if known and rng.random() < 0.4:
            lesson = rng.choice(known)
            say("forgetting", lesson)
            memory.forget(lesson, triples("inferred", turn % 7))
            say("forgot", lesson)
        else:
            lesson = f"l{seed}-{turn}"
            said = {GraphName.ASSERTED: triples(lesson, 20) + shared, GraphName.LEARNED: triples(lesson, 30)}
            say("learning", lesson)
            memory.learn(lesson, said, triples("inferred", turn % 7))
            say("learned", lesson)
"""


def check_whole(memory: SemanticMemory) -> None:
    """Check that the canonical graphs have just the triples of the lessons' copies, and that the union is right."""
    store = memory.store
    for name in (GraphName.ASSERTED, GraphName.LEARNED):
        held = {t for lesson in memory.lessons() for t in memory.contributions(lesson).get(name, ())}
        assert set(memory.triples(name)) == held
    for lesson in memory.lessons():
        sizes = {name: len(triples) for name, triples in memory.contributions(lesson).items()}
        assert sizes == {GraphName.ASSERTED: 25, GraphName.LEARNED: 30}, lesson
    if store.contains_named_graph(MERGED):
        merged = {quad.triple for quad in store.quads_for_pattern(None, None, None, MERGED)}
        assert merged == {triple for name in UNION for triple in memory.triples(name)}


@pytest.mark.slow
def test_kills_lose_no_acknowledged_lesson_and_leave_no_half_one(tmp_path: Path) -> None:
    """Check the memory after every fifth kill; the children in between start where one was killed."""
    rng, folder = random.Random(3), tmp_path / "m"
    certain: set[str] = set()
    doubtful: set[str] = set()
    moments: Counter[str] = Counter()
    with forks_of(LEARNER) as learners:
        for seed in range(KILLS):
            lines = learners.kill_after(folder, seed, rng.randrange(4), rng.uniform(0.0, 0.02))
            moments[lines[-1].split()[0] if lines else "opening"] += 1
            hear(lines, certain, doubtful)
            if seed % 5 == 4:
                with SemanticMemory.open(folder, create=True) as memory:
                    kept = set(memory.lessons())
                    assert certain <= kept, f"lost: {certain - kept}"
                    assert kept - certain <= doubtful, f"came back: {kept - certain - doubtful}"
                    check_whole(memory)
                    certain, doubtful = kept, set()
    assert moments["learning"] + moments["forgetting"] >= 5, moments


def hear(lines: list[str], certain: set[str], doubtful: set[str]) -> None:
    """Update the lessons that must be stored, and those that may be, from the output of a learner before its kill."""
    for line in lines:
        verb, lesson = line.split()
        if verb == "learned":
            certain |= {lesson}
        if verb in ("learning", "forgetting"):
            certain -= {lesson}
            doubtful |= {lesson}
        else:
            doubtful -= {lesson}


FILLER = """
import resource, sys
import pyoxigraph as ox
from deixis.memory.errors import MemoryWriteError, ReadOnlyMemoryError
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

limit = int(sys.argv[2])
how = sys.argv[3]
p = ox.NamedNode("urn:p")
triples = [ox.Triple(ox.NamedNode(f"urn:x{i}"), p, ox.Literal("x" * 50 + str(i))) for i in range(10000)]
memory = SemanticMemory.open(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
try:
    if how == "learn":
        memory.learn("big", {GraphName.ASSERTED: triples}, [])
    else:
        memory.load({GraphName.ASSERTED: triples})
    print("done")
except MemoryWriteError as error:
    print(error)
"""


@pytest.mark.parametrize("how", ["learn", "load"])
@pytest.mark.parametrize("limit", [2_000, 100_000, 500_000])
def test_a_full_disk_is_a_one_line_error_and_loses_nothing(tmp_path: Path, learn: Learn, limit: int, how: str) -> None:
    folder = tmp_path / "m"
    with SemanticMemory.open(folder, create=True) as memory:
        learn(memory, "dinner-1")
        before = export_memory(memory)
    done = subprocess.run(
        [sys.executable, "-c", FILLER, str(folder), str(limit), how], capture_output=True, text=True, timeout=60
    )
    assert not done.stderr, done.stderr
    assert len(done.stdout.splitlines()) == 1
    assert "could not be written" in done.stdout
    assert "check that the disk has room" in done.stdout
    with SemanticMemory.open(folder) as memory:
        assert memory.lessons()[-1:] == ("dinner-1",)
        assert export_memory(memory) == before


def test_creating_on_a_full_disk_leaves_nothing_behind(tmp_path: Path) -> None:
    code = (
        "import resource, sys; from deixis.memory.semantic.store import SemanticMemory\n"
        "from deixis.memory.errors import MemoryWriteError\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "try: SemanticMemory.open(sys.argv[1], create=True)\n"
        "except MemoryWriteError as error: print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path / "m")], capture_output=True, text=True, timeout=60)
    assert "could not be written" in done.stdout, done.stderr
    assert not (tmp_path / "m").exists()


def test_a_read_only_folder_is_read_and_refuses_writes(
    tmp_path: Path, learn: Learn, monkeypatch: pytest.MonkeyPatch
) -> None:
    with SemanticMemory.open(tmp_path / "m", create=True) as memory:
        learn(memory, "dinner-1")
        before = export_memory(memory)
    with monkeypatch.context() as patched:
        make_read_only(tmp_path, patched)
        with SemanticMemory.open(tmp_path / "m") as memory, SemanticMemory.open(tmp_path / "m") as second:
            assert export_memory(memory) == export_memory(second) == before
            with pytest.raises(ReadOnlyMemoryError, match="cannot be opened for writing: Read-only file system"):
                learn(memory, "dinner-2")
        (tmp_path / "new").mkdir()
        with pytest.raises(MemoryWriteError, match="cannot be opened for writing"):
            SemanticMemory.open(tmp_path / "new", create=True)
    with SemanticMemory.open(tmp_path / "m") as memory:
        assert export_memory(memory) == before
        learn(memory, "dinner-2")


@pytest.mark.skipif(os.geteuid() == 0, reason="permissions do not bind root")
def test_a_folder_without_permission_is_only_read(tmp_path: Path) -> None:
    SemanticMemory.open(tmp_path / "m", create=True).close()
    (tmp_path / "m" / "owner.lock").chmod(0o400)
    with SemanticMemory.open(tmp_path / "m") as memory, pytest.raises(ReadOnlyMemoryError, match="make the folder"):
        memory.keep_models({ModelSet.WORDS: []})


def test_a_place_where_no_folder_can_be_made(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    with pytest.raises(MemoryWriteError, match="cannot be created"):
        SemanticMemory.open(tmp_path / "link" / "m", create=True)


def test_a_rejected_update_rolls_everything_back(memory: SemanticMemory) -> None:
    """Check that one update is one transaction, which makes learning and forgetting atomic."""
    size = len(memory.store)
    update = f"INSERT DATA {{ GRAPH {graph_iri(GraphName.ASSERTED)} {{ <urn:a> <urn:p> 1 }} }} ; CREATE GRAPH "
    with pytest.raises((OSError, RuntimeError, ValueError)):
        memory.store.update(update + str(graph_iri(GraphName.ONTOLOGY)))
    assert len(memory.store) == size
