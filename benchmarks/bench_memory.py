"""Time bulk load, queries and their limits at 100,000 and 1,000,000 triples, beside bare pyoxigraph in the same run.

There are two kinds of data: background knowledge without any shape, and scenes, in which every object is checked.
"""

from __future__ import annotations

import contextlib
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

import pyoxigraph as ox
from common import medians
from records import command_line, figure, peer_version, recorded

from deixis.memory.errors import QueryError, QueryTimeoutError
from deixis.memory.semantic.rdf.files import PREFIXES
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import iri, text, typed
from deixis.ontology.rdf.vocabulary import DX, W3C

ASSERTED = graph_iri(GraphName.ASSERTED)

QUERIES = {
    "join of three patterns": "SELECT ?a ?c { ?a <urn:p1> ?b . ?b <urn:p2> ?c . ?c <urn:p3> ?d } LIMIT 1000",
    "look-up of one subject": "SELECT ?p ?o { <urn:node:77> ?p ?o }",
    "count": "SELECT (COUNT(*) AS ?n) { ?s <urn:p1> ?o }",
}


def background(triples: int) -> Iterator[ox.Triple]:
    """Yield nodes of ten statements each, about other nodes."""
    predicates = [ox.NamedNode(f"urn:p{number}") for number in range(10)]
    nodes = triples // 10
    for number in range(nodes):
        subject = ox.NamedNode(f"urn:node:{number}")
        for step, predicate in enumerate(predicates):
            yield ox.Triple(subject, predicate, ox.NamedNode(f"urn:node:{(number * 7 + step * 31) % nodes}"))


def scenes(triples: int) -> Iterator[ox.Triple]:
    """Yield scenes of fifty objects of eight statements each."""
    chair, inside = iri("urn:chair"), iri(DX.IN_SCENE)
    yield ox.Triple(chair, iri(W3C.RDF_TYPE), iri(DX.VIEWPOINT))
    yield ox.Triple(chair, iri(W3C.RDFS_LABEL), text("chair"))
    for number in range(triples // 8):
        if number % 50 == 0:
            scene = iri(f"urn:scene:{number}")
            yield ox.Triple(scene, iri(W3C.RDF_TYPE), iri(DX.SCENE))
            yield ox.Triple(scene, iri(DX.FRAME), text("table"))
            yield ox.Triple(scene, iri(DX.UNIT), text("m"))
            yield ox.Triple(scene, iri(DX.SEEN_FROM), chair)
        thing = iri(f"urn:thing:{number}")
        yield ox.Triple(thing, iri(W3C.RDF_TYPE), iri(DX.PERCEIVED_OBJECT))
        yield ox.Triple(thing, inside, scene)
        yield ox.Triple(thing, iri(DX.IDENTIFIER), text(f"o{number}"))
        for low, high in ((DX.MIN_X, DX.MAX_X), (DX.MIN_Y, DX.MAX_Y)):
            yield ox.Triple(thing, iri(low), typed(number / 10))
            yield ox.Triple(thing, iri(high), typed(number / 10 + 1.0))


def seconds(job: Callable[[], object]) -> float:
    started = time.perf_counter()
    job()
    return time.perf_counter() - started


def load(kind: str, data: list[ox.Triple], folder: Path) -> tuple[SemanticMemory, ox.Store]:
    """Load the same triples in both, and print the time of each."""
    bare = ox.Store(folder / "bare")

    def fill() -> None:
        bare.bulk_extend(ox.Quad(t.subject, t.predicate, t.object, ASSERTED) for t in data)
        bare.flush()

    memory = SemanticMemory.open(folder / "memory", create=True)
    theirs = seconds(fill)
    ours = seconds(lambda: memory.load({GraphName.ASSERTED: data}))
    figure(
        f"load of {len(data):,} triples of {kind}",
        ours / theirs,
        "times the time of the peer",
        peer=peer_version("pyoxigraph"),
    )
    times = f"deixis {ours:.2f} s, bare {theirs:.2f} s, {ours / theirs:.2f} times"
    print(f"load, {len(data):>9,} triples of {kind}: {times}")
    return memory, bare


def ask(memory: SemanticMemory, bare: ox.Store) -> None:
    """Run the queries in both, and print the time of each."""
    for name, query in QUERIES.items():

        def direct(query: str = query) -> object:
            found = bare.query(query, default_graph=ASSERTED, prefixes=PREFIXES)
            assert isinstance(found, ox.QuerySolutions)
            return [tuple(solution) for solution in found]

        ours, theirs = medians(lambda query=query: memory.query(query), direct, runs=15)  # type: ignore[misc]
        figure(
            f"{name} in {len(bare):,} triples",
            ours / theirs,
            "times the time of the peer",
            peer=peer_version("pyoxigraph"),
        )
        print(f"    {name}: deixis {ours * 1e3:.3f} ms, bare {theirs * 1e3:.3f} ms, {ours / theirs:.2f} times")


def bounds(memory: SemanticMemory) -> None:
    """Print the cost of a query that needs a process or a snapshot, and the time until an endless one ends."""
    one = QUERIES["look-up of one subject"]
    started, changed = [], []
    for number in range(9):
        triple = ox.Triple(ox.NamedNode(f"urn:change:{number}"), ox.NamedNode("urn:p1"), ox.Literal(number))
        memory.learn(f"change-{number}", {GraphName.ASSERTED: [triple]}, [])
        changed.append(seconds(lambda: memory.query(one)))
        with contextlib.suppress(QueryTimeoutError):
            memory.query(one, time_limit=0.0)  # end the process
        started.append(seconds(lambda: memory.query(one)))
    print(
        f"    look-up after a change: {median(changed) * 1e3:.1f} ms; in a new process: {median(started) * 1e3:.1f} ms"
    )
    endless = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i }"
    grows = "SELECT * { ?a ?b ?c . ?d ?e ?f } ORDER BY ?c ?f"
    for what, query in (("cross product", endless), ("sorted cross product", grows)):
        begin = time.perf_counter()
        try:
            memory.query(query, time_limit=2.0, memory_limit=2**28)
        except QueryError as error:
            print(f"    {what}, 2 s and 256 MiB: {type(error).__name__} after {time.perf_counter() - begin:.2f} s")


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("sizes", type=int, nargs="*", help="numbers of triples (100000 1000000)")
    with recorded(parser) as options:
        sizes = options.sizes or [100_000, 1_000_000]
        for size in sizes:
            for kind, make in (("background knowledge", background), ("scenes", scenes)):
                folder = Path(tempfile.mkdtemp())
                memory, bare = load(kind, list(make(size)), folder)
                if make is background:
                    ask(memory, bare)
                    bounds(memory)
                memory.close()
                del bare
                shutil.rmtree(folder)


if __name__ == "__main__":
    main()
