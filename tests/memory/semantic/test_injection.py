"""No injection: names of lessons stay names, and no connection is opened."""

from __future__ import annotations

import shutil
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import pyoxigraph as ox
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deixis.errors import DeixisError
from deixis.memory.errors import QueryError
from deixis.memory.semantic.exchange import export_memory, import_dump
from deixis.memory.semantic.rdf.graphs import CANONICAL, ORDER, GraphName, graph_iri, lesson_graph, package_graph
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import learned_iri

Learn = Callable[..., None]

NASTY = st.one_of(
    st.text(st.characters(exclude_categories=["Cs"]), max_size=12),
    st.text(alphabet="\"'\\{}<>|^` .;#%\n\r\t\0\u2028é🍴uU0041", max_size=16),
    st.sampled_from(
        [
            "x> } } ; DROP ALL #", '" . } INSERT DATA { <urn:a> <urn:b> "', "%3E%20%7D", "\\u003E } ; CLEAR ALL", "'''",
            '"""', "a\nb", "../../lesson/other", "http://x/ y", "@prefix : <urn:> .", "]]>", "&lt;",
        ]
    ),
)  # fmt: skip


def quads(memory: SemanticMemory) -> set[ox.Quad]:
    """Return the content of a memory without the order of the lessons."""
    return {quad for quad in memory.store if quad.graph_name != ORDER}


@settings(max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(name=NASTY, lesson=NASTY)
def test_no_name_changes_the_number_of_triples_or_graphs(memory: SemanticMemory, name: str, lesson: str) -> None:
    thing, text = ox.NamedNode(learned_iri("category", name)), ox.Literal(name)
    triples = [ox.Triple(thing, ox.NamedNode("urn:p"), text), ox.Triple(thing, ox.NamedNode("urn:q"), thing)]
    inferred = [ox.Triple(thing, ox.NamedNode("urn:r"), text)]
    lesson = f"l{lesson}"
    for known in memory.lessons():  # of an example that failed
        memory.forget(known, [])
    before = quads(memory)
    memory.learn(lesson, {GraphName.ASSERTED: triples}, inferred)
    graphs = {quad.graph_name for quad in quads(memory)}
    assert len(quads(memory)) == len(before) + 5
    assert graphs == {
        *map(graph_iri, (GraphName.ASSERTED, GraphName.INFERRED, GraphName.ONTOLOGY, GraphName.SHAPES)),
        *map(package_graph, (GraphName.ONTOLOGY, GraphName.SHAPES)),
        lesson_graph(lesson, GraphName.ASSERTED),
    }
    assert set(memory.triples(GraphName.ASSERTED)) == set(triples)
    assert memory.lessons() == (lesson,)
    assert len(set(ox.parse(export_memory(memory), format=ox.RdfFormat.TRIG))) == len(before) + 5
    table = memory.query(f"SELECT ?o {{ {thing} <urn:p> ?o }}")
    assert [row[0] for row in table.rows] == [text]
    assert len(table.to_table()) == 3
    memory.forget(lesson, [])
    assert quads(memory) == before


def test_an_iri_that_could_break_out_cannot_be_made() -> None:
    for bad in ("urn:x> } ; DROP ALL", "urn:a b", "urn:{", "urn:\n", "urn:\\u003E"):
        with pytest.raises(ValueError, match="Invalid IRI"):
            ox.NamedNode(bad)


def test_nothing_opens_a_connection(tmp_path: Path, learn: Learn, monkeypatch: pytest.MonkeyPatch) -> None:
    """Close the sockets of Python, and check with a listening socket that Oxigraph opens no connection either."""

    def refuse(*_: object, **__: object) -> NoReturn:
        raise AssertionError("a connection was tried")

    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"http://127.0.0.1:{server.getsockname()[1]}/x"
        server.setblocking(False)
        monkeypatch.setattr(socket.socket, "connect", refuse)
        monkeypatch.setattr(socket, "getaddrinfo", refuse)
        (tmp_path / "k.ttl").write_text(f"<> <http://www.w3.org/2002/07/owl#imports> <{url}> ; a <{url}> .")
        xml = f'<!DOCTYPE r SYSTEM "{url}"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"/>'
        (tmp_path / "k.rdf").write_text(xml)
        import_dump(tmp_path / "k.ttl", tmp_path / "m")
        with pytest.raises(DeixisError, match="a DTD"):
            import_dump(tmp_path / "k.rdf", tmp_path / "m")
        with SemanticMemory.open(tmp_path / "m") as memory:
            learn(memory, "dinner-1")
            for query in (f"ASK {{ SERVICE <{url}> {{ ?s ?p ?o }} }}", f"LOAD <{url}>", f"ASK FROM <{url}> {{}}"):
                with pytest.raises(QueryError):
                    memory.query(query)
            assert memory.query(f"ASK {{ ?s a <{url}> }}").boolean is True
            list(memory.dataset().query(f"SELECT ?s WHERE {{ ?s a <{url}> }}"))
            export_memory(memory)
        with pytest.raises(BlockingIOError):
            server.accept()


OFFLINE = """
import sys
from pathlib import Path
from deixis.memory.semantic.exchange import import_dump
from deixis.memory.semantic.store import SemanticMemory
import_dump(sys.argv[1], sys.argv[2])
with SemanticMemory.open(sys.argv[2]) as memory:
    print(memory.query("ASK { <urn:a> ?p ?o }").boolean)
"""


@pytest.mark.skipif(shutil.which("unshare") is None, reason="there is no unshare to take the network away with")
def test_everything_works_without_a_network(tmp_path: Path) -> None:
    (tmp_path / "k.ttl").write_text("<urn:a> <http://www.w3.org/2002/07/owl#imports> <http://example.org/o> .")
    if subprocess.run(["unshare", "-rn", "true"], capture_output=True).returncode:
        pytest.skip("taking the network away is not allowed here")
    done = subprocess.run(
        ["unshare", "-rn", sys.executable, "-c", OFFLINE, str(tmp_path / "k.ttl"), str(tmp_path / "m")],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stdout == "True\n", done.stderr


def test_queries_reach_canonical_graphs_for_any_lesson_name(memory: SemanticMemory) -> None:
    triple = ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("x"))
    for lesson in ("../asserted", "a/learned", "", " ", "lesson/x"):
        if lesson.strip():
            memory.learn(lesson, {GraphName.EPISODES: [triple]}, [])
    names = memory.query("SELECT DISTINCT ?g { GRAPH ?g { <urn:a> ?p ?o } }")
    assert [row[0] for row in names.rows] == [graph for graph, name in CANONICAL.items() if name is GraphName.EPISODES]
    assert len(memory.lessons()) == 3
