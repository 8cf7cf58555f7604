"""Limits of queries: time, memory, length and nesting; and the end of their process with its owner."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest
import rdflib.plugins.sparql
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from timing import BUSY_SECONDS, processor_time_below, until

import deixis
from deixis.memory.errors import QueryError, QueryMemoryError, QueryTimeoutError
from deixis.memory.semantic.queries.limits import MAX_DEPTH
from deixis.memory.semantic.queries.sparql import check_query
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

Read = Callable[[str], list[ox.Triple]]

COUNT_PRODUCT = "SELECT (COUNT(*) AS ?n) { ?a ?b ?c . ?d ?e ?f . ?g ?h ?i . ?j ?k ?l }"
SMALL = "SELECT ?s { ?s <urn:p> 7 }"
MIB = 2**20


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SemanticMemory]:
    """Memory of 1,000 triples, enough for a practically endless cross product."""
    p = ox.NamedNode("urn:p")
    numbers = [ox.Literal(i) for i in range(1000)]
    with SemanticMemory.open(tmp_path_factory.mktemp("filled") / "memory", create=True) as memory:
        memory.load({GraphName.ASSERTED: [ox.Triple(ox.NamedNode(f"urn:{n.value}"), p, n) for n in numbers]})
        yield memory


def nested_replace(levels: int) -> str:
    text = "STR(?o)"
    for _ in range(levels):
        text = f'REPLACE({text}, "7", "77777777")'
    return f"SELECT (STRLEN({text}) AS ?length) {{ <urn:7> <urn:p> ?o }}"


ENDLESS = {
    "select": COUNT_PRODUCT,
    "ask": f"ASK {{ {{ {COUNT_PRODUCT} }} FILTER(?n < 0) }}",
    "construct": f"CONSTRUCT {{ <urn:n> <urn:p> ?n }} WHERE {{ {COUNT_PRODUCT} }}",
    "describe": f"DESCRIBE ?n WHERE {{ {COUNT_PRODUCT} }}",
    "path": "SELECT * { ?a (<urn:p>|!<urn:p>)* ?b . ?c (<urn:p>|!<urn:q>)* ?d . ?e ^(<urn:p>*) ?f FILTER(?a = ?z) }",
}


@pytest.mark.parametrize("query", ENDLESS.values(), ids=ENDLESS)
def test_the_time_limit_ends_a_query(filled: SemanticMemory, query: str) -> None:
    start = time.monotonic()
    with pytest.raises(QueryTimeoutError, match=r"within the time limit of 0\.2 s"):
        filled.query(query, time_limit=0.2)
    assert time.monotonic() - start < BUSY_SECONDS
    assert len(filled.query(SMALL).rows) == 1


def test_time_for_opening_the_store_counts_too(tmp_path: Path) -> None:
    with SemanticMemory.open(tmp_path / "memory", create=True) as memory:
        with pytest.raises(QueryTimeoutError, match=r"within the time limit of 1e-06 s"):
            memory.query(SMALL, time_limit=1e-6)
        assert len(memory.query("SELECT * {}").rows) == 1


def test_the_memory_limit_ends_a_query(filled: SemanticMemory) -> None:
    assert filled.query(nested_replace(3)).rows[0][0] == ox.Literal(512)
    with pytest.raises(QueryMemoryError, match="more than the memory limit of 64 MiB"):
        filled.query(nested_replace(12), memory_limit=64 * MIB)
    with pytest.raises(QueryMemoryError):
        filled.query("SELECT * { ?a ?b ?c . ?d ?e ?f } ORDER BY ?c ?f", memory_limit=64 * MIB)
    assert len(filled.query(SMALL).rows) == 1


def test_an_answer_that_is_too_large_is_refused_whole(filled: SemanticMemory) -> None:
    with pytest.raises(QueryMemoryError, match=r"the answer is larger than 1 MiB.*LIMIT"):
        filled.query("SELECT * { ?a ?b ?c . ?d ?e ?f }", memory_limit=16 * MIB)
    assert len(filled.query("SELECT * { ?a ?b ?c . ?d ?e ?f } LIMIT 5", memory_limit=16 * MIB).rows) == 5


def test_rows_without_values_count_for_the_size_of_an_answer(filled: SemanticMemory) -> None:
    """Use rows that are ``{}`` as text, but have a place for each variable when they are read."""
    unbound = " ".join(f"?v{k}" for k in range(400))
    query = f"SELECT {unbound} {{ ?a <urn:p> ?b }}"
    assert len(filled.query(query + " LIMIT 300", memory_limit=16 * MIB).rows) == 300
    with pytest.raises(QueryMemoryError, match="the answer is larger than 1 MiB"):
        filled.query(query, memory_limit=16 * MIB)
    with pytest.raises(QueryMemoryError, match="the answer is larger than"):
        filled.dataset().query(f"SELECT {unbound} {{ ?a <urn:p> ?b . ?c <urn:p> ?d . FILTER(?b < 60) }}")


def test_a_wide_cell_does_not_widen_every_line(filled: SemanticMemory) -> None:
    tens = 'REPLACE(REPLACE("1111111111", "1", "1111111111"), "1", "1111111111")'
    query = f'SELECT ?s (IF(?o = 7, {tens}, "short") AS ?text) ?o {{ ?s <urn:p> ?o }}'
    lines = filled.query(query).to_table()
    assert len(lines) == 1002 and max(map(len, lines)) > 1000
    assert sum(map(len, lines)) < 120 * len(lines)


@pytest.mark.parametrize(("time_limit", "memory_limit"), [(-1.0, 1), (float("nan"), 1), (1.0, 0)])
def test_an_invalid_limit_is_refused(filled: SemanticMemory, time_limit: float, memory_limit: int) -> None:
    with pytest.raises(QueryError, match="limit of a query must be at least"):
        filled.query(SMALL, time_limit, memory_limit)


NESTED = {
    "groups": lambda n: "SELECT * " + "{" * n + "?s ?p ?o" + "}" * n,
    "brackets": lambda n: f"ASK {{ FILTER({'(' * (n - 2)}true{')' * (n - 2)}) }}",
    "denials": lambda n: f"ASK {{ FILTER({'!' * (n - 2)}true) }}",
    "denied brackets": lambda n: f"ASK {{ FILTER({'!(' * (n // 2 - 1)}true{')' * (n // 2 - 1)}) }}",
    "paths": lambda n: f"ASK {{ ?s {'(' * (n - 1)}<urn:p>{')' * (n - 1)} ?o }}",
    "inverse paths": lambda n: f"ASK {{ ?s {'^(' * (n // 2)}<urn:p>{')' * (n // 2)} ?o }}",
    "calls": lambda n: f"ASK {{ FILTER({'STR(' * (n - 2)}1{')' * (n - 2)} = 1) }}",
    "tests": lambda n: "ASK " + "{ FILTER EXISTS " * (n - 1) + "{}" + " }" * (n - 1),
    "hidden in an IRI": lambda n: f"ASK {{ FILTER(1<{'(' * (n - 2)}2>1{')' * (n - 2)}) }}",
    "beside strings": lambda n: f"ASK {{ FILTER({'(STR(' * (n // 2 - 1)}')'{'))' * (n // 2 - 1)} = '(') }}",
}


@pytest.mark.parametrize("nested", NESTED.values(), ids=NESTED)
def test_nesting_is_limited_before_the_parser_sees_it(filled: SemanticMemory, nested: Callable[[int], str]) -> None:
    filled.query(nested(MAX_DEPTH - 2))
    for levels in (MAX_DEPTH + 4, 4000, 20_000):
        with pytest.raises(QueryError, match=r"query:\d+:\d+: (nested too deeply|the query must have at most)"):
            check_query(nested(levels))


LONG = {
    "lists": lambda n: "ASK { ?s ?p " + "(" * n + ")" * n + " }",
    "nodes": lambda n: "ASK { ?s ?p " + "[ ?p " * n + "1" + "]" * n + " }",
    "quoted": lambda n: "ASK { ?s ?p " + "<<( ?s ?p " * n + "1" + ")>>" * n + " }",
    "signs": lambda n: "ASK { FILTER(" + "!" * n + "true) }",
    "words": lambda n: "a." * n,
    "strings": lambda n: "'''" + "\"'" * n,
    "iris": lambda n: "ASK { FILTER(" + "1<(" * n,
    "froms": lambda n: "ASK " + "FROM dxg:learned " * n + "{}",
    "prefixes": lambda n: "".join(f"PREFIX p{i}: <urn:{i}> " for i in range(n)) + "ASK {}",
    "escapes": lambda n: "ASK { " + "\\u0061" * n,
}


@pytest.mark.parametrize("hostile", LONG.values(), ids=LONG)
def test_long_queries_are_looked_at_in_linear_time(hostile: Callable[[int], str]) -> None:
    with processor_time_below(5):
        for length in (4000, 100_000):
            with contextlib.suppress(QueryError):
                check_query(hostile(length))


def test_a_query_may_hold_many_values(filled: SemanticMemory) -> None:
    values = " ".join(f"<urn:a(b)/{i}>" for i in range(10_000))
    assert filled.query(f"SELECT ?s ?o {{ VALUES ?s {{ {values} <urn:7> }} ?s <urn:p> ?o }}").rows == (
        (ox.NamedNode("urn:7"), ox.Literal(7)),
    )


CHAINS = {
    "sums": lambda n: f"ASK {{ FILTER(1{'+1' * n} > 0) }}",
    "unions": lambda n: f"ASK {{ {{}} {'UNION {} ' * n} }}",
    "alternatives": lambda n: f"ASK {{ ?s <urn:p>{'|<urn:p>' * n} ?o }}",
    "filters": lambda n: f"ASK {{ {'FILTER(true) ' * n} }}",
    "options": lambda n: f"ASK {{ {'OPTIONAL {?s ?p 1} ' * n} }}",
}


@pytest.mark.slow
@pytest.mark.parametrize("chain", CHAINS.values(), ids=CHAINS)
def test_long_chains_of_operators_end_no_process(filled: SemanticMemory, chain: Callable[[int], str]) -> None:
    for length in (300, 5000):
        try:
            filled.query(chain(length), time_limit=1)
        except QueryTimeoutError:
            return  # Oxigraph's planner takes time quadratic in the length of some


PIECES = [
    "{", "}", "(", ")", "[", "]", "<<", ">>", "!", "-", "^", "<", ">", "<urn:p>", "<a(b>", "?x", "1", "'", '"', "'''",
    "#", "\n", " ", ".", ";", ",", "/", "|", "*", "FILTER", "OPTIONAL", "UNION", "BIND", "AS", "SELECT", "EXISTS",
    "\\(",
]  # fmt: skip


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(pieces=st.lists(st.tuples(st.sampled_from(PIECES), st.integers(1, 150)), max_size=12))
def test_whatever_is_asked_is_answered_or_refused(filled: SemanticMemory, pieces: list[tuple[str, int]]) -> None:
    told, start = "", time.monotonic()
    try:
        with processor_time_below(6):
            filled.query("ASK { " + "".join(piece * times for piece, times in pieces) + " }", 0.3, 256 * MIB)
    except QueryError as error:
        told = str(error)
    assert "the process that ran it" not in told and "too deeply, or too long" not in told
    assert time.monotonic() - start < BUSY_SECONDS


iris = st.sampled_from(["urn:a", "urn:ü", "https://w3id.org/deixis/onto#Fork"]).map(ox.NamedNode)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
literals = st.one_of(
    texts.map(ox.Literal),
    st.builds(lambda text: ox.Literal(text, language="en-GB"), texts),
    st.builds(lambda text: ox.Literal(text, language="ar", direction=ox.BaseDirection.RTL), texts),
    st.builds(lambda text, kind: ox.Literal(text, datatype=kind), texts, iris),
    st.integers().map(ox.Literal),
    st.floats().map(ox.Literal),
)


@settings(max_examples=4, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.tuples(iris, iris, iris | literals), min_size=1, max_size=40))
def test_the_answers_are_those_of_the_store_itself(
    tmp_path_factory: pytest.TempPathFactory, told: list[tuple[ox.NamedNode, ox.NamedNode, ox.NamedNode | ox.Literal]]
) -> None:
    """Terms of every sort are the same after a transfer between two processes."""
    with SemanticMemory.open(tmp_path_factory.mktemp("any") / "memory", create=True) as memory:
        memory.load({GraphName.ASSERTED: [ox.Triple(*terms) for terms in told]})
        graph = ox.NamedNode("https://w3id.org/deixis/graph/asserted")
        select = "SELECT ?s ?p ?o ?none (TRIPLE(?s, ?p, ?o) AS ?t) {{ {} }}"
        rows = memory.store.query(select.format("?s ?p ?o"), default_graph=graph)
        assert isinstance(rows, ox.QuerySolutions)
        answered = memory.query(select.format("GRAPH dxg:asserted { ?s ?p ?o }")).rows
        assert sorted(map(tuple, answered), key=str) == sorted(map(tuple, rows), key=str)
        triples = memory.store.query("CONSTRUCT WHERE { ?s ?p ?o }", default_graph=graph)
        assert isinstance(triples, ox.QueryTriples)
        asserted = "CONSTRUCT { ?s ?p ?o } WHERE { GRAPH dxg:asserted { ?s ?p ?o } }"
        assert set(memory.query(asserted).triples) == set(triples)
        s, p, _ = told[0]
        bound = {"s": rdflib.URIRef(s.value), "p": rdflib.URIRef(p.value)}
        assert memory.dataset().query("ASK { ?s ?p ?o }", initBindings=bound).askAnswer is True


def test_a_change_is_seen_by_the_next_query(memory: SemanticMemory, read: Read) -> None:
    view = memory.dataset()
    for number in range(3):
        memory.learn(f"lesson{number}", {GraphName.ASSERTED: read(f"<urn:a> <urn:p> {number} .")}, [])
        assert len(memory.query("SELECT ?o { <urn:a> <urn:p> ?o }").rows) == number + 1
        assert len(list(view.query("SELECT ?o { <urn:a> <urn:p> ?o }"))) == number + 1
    memory.forget("lesson0", [])
    assert len(memory.query("SELECT ?o { <urn:a> <urn:p> ?o }").rows) == 2
    memory.load({GraphName.ASSERTED: read("<urn:a> <urn:p> 5 .")})
    assert len(memory.query("SELECT ?o { <urn:a> <urn:p> ?o }").rows) == 3


def test_nothing_is_left_behind(memory: SemanticMemory) -> None:
    memory.query("ASK {}")
    folder = memory.path
    assert (folder / "semantic.snapshot").is_dir()
    memory.close()
    assert not (folder / "semantic.snapshot").exists()
    (folder / "semantic.snapshot").mkdir()  # as a crash leaves it
    SemanticMemory.open(folder).close()
    assert not (folder / "semantic.snapshot").exists()


def test_prepared_queries_are_refused(filled: SemanticMemory) -> None:
    """rdflib would evaluate them in this process, without any limit."""
    with pytest.raises(QueryError, match="must be a string, got a prepared query"):
        filled.dataset().query(rdflib.plugins.sparql.prepareQuery("ASK { ?s ?p ?o }"))


def test_threads_ask_in_turn(filled: SemanticMemory) -> None:
    found: list[int] = []
    threads = [threading.Thread(target=lambda: found.append(len(filled.query(SMALL).rows))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [1] * 8


def test_waiting_for_another_query_counts(filled: SemanticMemory) -> None:
    def ask_endlessly() -> None:
        with pytest.raises(QueryTimeoutError):
            filled.query(COUNT_PRODUCT, 1.0)

    slow = threading.Thread(target=ask_endlessly)
    filled.query(SMALL)
    assert filled._queries is not None
    slow.start()
    assert until(filled._queries._turn.locked)
    with pytest.raises(QueryTimeoutError):
        filled.query(SMALL, time_limit=0.1)
    slow.join()


OWNER = """
import signal, sys
from pathlib import Path
from deixis.memory.semantic.store import SemanticMemory
signal.signal(signal.SIGINT, signal.default_int_handler)
memory = SemanticMemory.open(Path(sys.argv[1]), create=True)
memory.query("ASK {}")
print(memory._queries._process._process.pid, flush=True)
values = "{ VALUES ?x { " + "1 " * 9000 + "} VALUES ?y { " + "1 " * 9000 + "} VALUES ?z { " + "1 " * 9000 + "} }"
memory.query("SELECT (COUNT(*) AS ?n) " + values)
"""


def gone(process: int) -> bool:
    for _ in range(100):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        if Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z":
            return True
        time.sleep(0.05)
    return False


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_the_process_ends_with_its_owner(tmp_path: Path, number: signal.Signals) -> None:
    command = [sys.executable, "-c", OWNER, str(tmp_path / "memory")]
    env = {**os.environ, "PYTHONPATH": str(Path(deixis.__file__).parents[1])}
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=env) as owner:
        assert owner.stdout is not None
        process = int(owner.stdout.readline())
        time.sleep(0.3)  # in the middle of the query
        assert Path(f"/proc/{process}").exists()
        owner.send_signal(number)
        owner.wait(timeout=BUSY_SECONDS)
    assert gone(process)


def test_a_killed_process_is_started_again(filled: SemanticMemory) -> None:
    filled.query(SMALL)
    assert filled._queries is not None and filled._queries._process is not None
    filled._queries._process._process.kill()
    filled._queries._process._process.wait()
    assert len(filled.query(SMALL).rows) == 1
