"""Time the guard on 1,000 changed and 10,000 new nodes of a memory, beside pyshacl over all nodes."""

from __future__ import annotations

import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import pyoxigraph as ox
from bench_memory import scenes
from records import command_line, ratio, recorded

from deixis.memory.errors import RejectedWriteError
from deixis.memory.semantic.rdf.change import Change
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory
from deixis.memory.semantic.validation.shacl import shapes_graph, violations
from deixis.memory.semantic.validation.validate import check_change
from deixis.ontology.rdf.triples import iri, text
from deixis.ontology.rdf.vocabulary import DX

NODES, CHANGED = 10_000, 1_000


def seconds(job: Callable[[], object], runs: int = 3) -> float:
    """Return the least seconds of a few runs."""
    taken = []
    for _ in range(runs):
        started = time.perf_counter()
        job()
        taken.append(time.perf_counter() - started)
    return min(taken)


def rejected(store: ox.Store, change: Change) -> None:
    try:
        check_change(store, change)
    except RejectedWriteError:
        return
    raise AssertionError("the broken nodes were accepted")


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        folder = Path(tempfile.mkdtemp())
        data = list(scenes(NODES * 8))
        shapes_graph()
        with SemanticMemory.open(folder / "memory", create=True) as memory:
            memory.load({GraphName.ASSERTED: data})
            nodes = [iri(f"urn:thing:{number}") for number in range(CHANGED)]
            labels = [ox.Triple(node, iri(DX.PERCEIVED_LABEL), text("fork")) for node in nodes]
            broken = [ox.Triple(node, iri(DX.IDENTIFIER), text("twice")) for node in nodes]
            good = Change(added={GraphName.ASSERTED: frozenset(labels)})
            bad = Change(added={GraphName.ASSERTED: frozenset(broken)})
            new = Change(added={GraphName.ASSERTED: frozenset(data)})
            everything = seconds(lambda: violations([*data, *labels]), runs=1)
            print(f"pyshacl over all {NODES:,} nodes:                     {everything:8.2f} s")
            jobs: dict[str, Callable[[], object]] = {
                f"deixis, {CHANGED:,} of them changed, all well formed": lambda: check_change(memory.store, good),
                f"deixis, {CHANGED:,} of them changed, all broken": lambda: rejected(memory.store, bad),
                f"deixis, all {NODES:,} of them new, all well formed": lambda: check_change(ox.Store(), new),
            }
            for name, job in jobs.items():
                ours = seconds(job)
                ratio(name.removeprefix("deixis, "), everything, ours, "pyshacl")
                print(f"{name}: {ours:.3f} s ({everything / ours:.0f} times as fast)")
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()
