"""SPARQL queries: answers, refusals, and places of errors."""

from __future__ import annotations

import csv
import io
import json
import socket
from collections.abc import Callable, Iterator

import pyoxigraph as ox
import pytest
import rdflib
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deixis.memory.errors import MemoryFormatError, QueryError
from deixis.memory.semantic.queries.results import QueryKind
from deixis.memory.semantic.queries.sparql import check_query
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

Read = Callable[[str], list[ox.Triple]]

U = "<http://127.0.0.1:1/>"


def test_answers_are_iterated_counted_and_true_if_not_empty(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read("<urn:a> <urn:p> 1, 2 .")}, [])
    rows = memory.query("SELECT ?o { <urn:a> <urn:p> ?o }")
    assert (len(rows), list(rows), bool(rows)) == (2, list(rows.rows), True)
    triples = memory.query("CONSTRUCT { ?s <urn:q> ?o } WHERE { ?s <urn:p> ?o }")
    assert (len(triples), list(triples)) == (2, list(triples.triples))
    assert not memory.query("SELECT ?o { <urn:b> <urn:p> ?o }")
    assert memory.query("ASK { <urn:a> ?p ?o }")
    assert not memory.query("ASK { <urn:b> ?p ?o }")


def test_the_default_graph_is_the_union_of_three(memory: SemanticMemory, read: Read) -> None:
    graphs = {
        GraphName.ASSERTED: read("<urn:a> <urn:p> 1 ."),
        GraphName.LEARNED: read("<urn:a> <urn:p> 2 ."),
        GraphName.EPISODES: read("<urn:a> <urn:p> 3 ."),
    }
    memory.learn("one", graphs, read("<urn:a> <urn:p> 4 ."))
    answer = memory.query("SELECT ?o { <urn:a> <urn:p> ?o }")
    assert [row[0].value for row in answer.printed() if isinstance(row[0], ox.Literal)] == ["1", "2", "4"]
    by_graph = memory.query("SELECT ?g { GRAPH ?g { <urn:a> <urn:p> ?o } }")
    assert len(by_graph.rows) == 4
    assert memory.query("ASK { GRAPH dxg:episodes { ?s ?p 3 } }").boolean is True


def test_the_copies_of_lessons_are_out_of_reach(taught: SemanticMemory) -> None:
    graphs = taught.query("SELECT DISTINCT ?g { GRAPH ?g { ?s ?p ?o } }")
    assert len(graphs.rows) == 6
    copy = "<https://w3id.org/deixis/graph/lesson/dinner-1/learned>"
    for query in (f"ASK {{ GRAPH {copy} {{ ?s ?p ?o }} }}", f"ASK FROM {copy} {{ ?s ?p ?o }}"):
        with pytest.raises(QueryError, match="does not have this graph"):
            taught.query(query)


def test_graphs_may_be_chosen_with_from(taught: SemanticMemory) -> None:
    assert taught.query("ASK FROM dxg:episodes { ?s a dx:Lesson }").boolean is True
    assert taught.query("ASK FROM dxg:learned { ?s a dx:Lesson }").boolean is False
    assert taught.query("ASK FROM NAMED dxg:episodes { GRAPH ?g { ?s a dx:Lesson } }").boolean is True
    assert taught.query("ASK FROM dxg:learned { GRAPH ?g { ?s ?p ?o } }").boolean is False


def test_declared_prefixes_win(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read("<urn:x:a> <urn:x:p> 1 .")}, [])
    assert memory.query("PREFIX dx: <urn:x:> ASK { dx:a dx:p 1 }").boolean is True
    assert memory.query("ASK { dx:left dx:phrase 1 }").boolean is False


def test_rows_are_printed_sorted_unless_ordered(taught: SemanticMemory) -> None:
    rows = [str(row[0]) for row in taught.query("SELECT ?r { ?r a dx:Role }").printed()]
    assert rows == sorted(rows)
    ordered = taught.query("SELECT ?p { ?r a dx:Role ; dx:position ?p } ORDER BY DESC(?p)").printed()
    assert [row[0].value for row in ordered if isinstance(row[0], ox.Literal)] == list("44332211")


def test_a_table(taught: SemanticMemory) -> None:
    lines = taught.query("SELECT ?layout ?name { ?layout rdfs:subClassOf dx:Layout ; rdfs:label ?name }").to_table()
    assert lines == [
        "layout              name",
        "------------------  -------------",
        "lx:layout/dinner-1  formal_dinner",
        "lx:layout/dinner-2  formal_dinner",
    ]
    assert taught.query("ASK { ?s a dx:Role }").to_table() == ["yes"]
    assert taught.query("CONSTRUCT { ?s a ?o } { ?s a ?o FILTER(?o = dx:Viewpoint) }").to_table() == [
        "lx:viewpoint/chair rdf:type dx:Viewpoint ."
    ]


def test_a_table_keeps_control_characters_off_the_terminal(memory: SemanticMemory) -> None:
    triple = ox.Triple(ox.NamedNode("urn:a"), ox.NamedNode("urn:p"), ox.Literal("a\n\x1b[2Jb"))
    memory.learn("one", {GraphName.ASSERTED: [triple]}, [])
    assert memory.query("SELECT ?o { ?s <urn:p> ?o }").to_table()[-1] == "a\\n\\u001b[2Jb"


def test_json_csv_and_turtle(memory: SemanticMemory, read: Read) -> None:
    memory.learn("one", {GraphName.ASSERTED: read('<urn:a> <urn:p> "x,\\"y", 1, "z"@en, <urn:b> .')}, [])
    answer = memory.query("SELECT ?o ?none { <urn:a> <urn:p> ?o }")
    data = json.loads(answer.to_json())
    assert answer.to_json() == json.dumps(data, indent=2, ensure_ascii=False)
    assert data["head"] == {"vars": ["o", "none"]}
    assert {"o": {"type": "uri", "value": "urn:b"}} in data["results"]["bindings"]
    assert {"o": {"type": "literal", "value": "z", "xml:lang": "en"}} in data["results"]["bindings"]
    parsed = ox.parse_query_results(answer.to_json(), format=ox.QueryResultsFormat.JSON)
    assert isinstance(parsed, ox.QuerySolutions)
    assert [tuple(row) for row in parsed] == list(answer.printed())
    rows = list(csv.reader(io.StringIO(answer.to_csv(), newline="")))
    assert rows[0] == ["o", "none"]
    assert ['x,"y', ""] in rows
    graph = memory.query("CONSTRUCT WHERE { ?s <urn:p> ?o }")
    assert len(rdflib.Graph().parse(data=graph.to_turtle(), format="turtle")) == 4
    data = json.loads(graph.to_json())
    assert len(data["triples"]) == 4 and graph.to_json() == json.dumps(data, indent=2, ensure_ascii=False)
    nothing = memory.query("SELECT ?s { ?s <urn:nothing> ?o }")
    assert nothing.to_json() == json.dumps(json.loads(nothing.to_json()), indent=2)
    assert json.loads(memory.query("ASK {}").to_json()) == {"head": {}, "boolean": True}
    with pytest.raises(QueryError, match="SELECT has no triples"):
        answer.to_turtle()
    with pytest.raises(QueryError, match="CONSTRUCT has no rows"):
        graph.to_csv()


def test_describe(taught: SemanticMemory) -> None:
    answer = taught.query("DESCRIBE <https://w3id.org/deixis/learned/category/fish_knife>")
    assert answer.kind is QueryKind.DESCRIBE
    assert "fish knife" in answer.to_turtle()


def test_blank_nodes_come_back_in_turtle(taught: SemanticMemory) -> None:
    text = taught.query("CONSTRUCT WHERE { ?s a owl:Restriction }").to_turtle()
    assert "genid" not in text
    assert "_:dinner-1.r1" in text


REFUSED = [
    f"SELECT * {{ SERVICE {U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ sErViCe SILENT {U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ SERVICE{U}{{ ?s ?p ?o }} }}",
    f"SELECT * {{ SERVICE # well\n {U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ SERV\\u0049CE {U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ \\U00000053ERVICE {U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ OPTIONAL {{ {{ SELECT * {{ SERVICE {U} {{ ?s ?p ?o }} }} }} }} }}",
    f"SELECT * {{ ?a ?b trueSERVICE{U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ ?a ?b 1SERVICE{U} {{ ?s ?p ?o }} }}",
    f"SELECT * {{ FILTER EXISTS {{ SERVICE {U} {{ ?s ?p ?o }} }} }}",
    f"SELECT (EXISTS {{ SERVICE {U} {{ ?s ?p ?o }} }} AS ?x) {{}}",
    "SELECT * { VALUES ?x { <http://127.0.0.1:1/> } SERVICE ?x { ?s ?p ?o } }",
    "PREFIX : <http://127.0.0.1:1/> SELECT * { SERVICE:x { ?s ?p ?o } }",
    "PREFIX : <http://127.0.0.1:1/> PREFIX service: <urn:x:> SELECT * { service:x { ?s ?p ?o } }",
    f"SELECT * {{ FILTER(1<2#>'''\n) SERVICE {U} {{ ?s ?p ?o }} #'''\n }}",
    "SELECT * { VALUES ?x { <http://127.0.0.1:1/> } FILTER(1<2)SERVICE?x#>\n{ ?s ?p ?o } }",
    f"PREFIX ex: <urn:x:> SELECT * {{ FILTER(ex:a<ex:b#>'''\n) SERVICE {U} {{ ?s ?p ?o }} #'''\n }}",
    "PREFIX ex: <urn:x:> SELECT * { VALUES ?x { <http://127.0.0.1:1/> } FILTER(1<ex:b)SERVICE?x#>\n{ ?s ?p ?o } }",
    f"SELECT * {{ FILTER(?a<?b&&'>'='#>'''\n) SERVICE {U} {{ ?s ?p ?o }} #''') }}",
    "INSERT DATA { <urn:a> <urn:p> 1 }",
    "insert data { <urn:a> <urn:p> 1 }",
    "DELETE WHERE { ?s ?p ?o }",
    "PREFIX ex: <urn:x:> DROP ALL",
    f"LOAD {U}",
    f"LO\\u0041D SILENT {U}",
    "# SELECT\nCLEAR ALL",
    "SELECT * {} ; INSERT DATA { <urn:a> <urn:p> 1 }",
    "ASK {} ; DROP ALL",
    f"SELECT * FROM {U} {{ ?s ?p ?o }}",
    f"SELECT * FROM NAMED {U} {{ GRAPH ?g {{ ?s ?p ?o }} }}",
    "PREFIX x: <http://127.0.0.1:1/> SELECT * FROM x:y { ?s ?p ?o }",
    "",
    "# nothing",
    "\\u0000",
]


@pytest.mark.parametrize("query", REFUSED)
def test_what_changes_or_leaves_the_memory_is_refused(memory: SemanticMemory, query: str) -> None:
    before = len(memory.store)
    with pytest.raises(QueryError, match=r"^query:\d+:\d+: "):
        memory.query(query)
    assert len(memory.store) == before


LET_IN = [
    "PREFIX ex: <urn:x:> SELECT * { ?s ex:service ?o }",
    "PREFIX ex: <urn:x:> ASK { GRAPH ex:service { ?s ?p ?o } }",
    "PREFIX service: <urn:x:> ASK { ?s service:insert ?o }",
    "PREFIX service: <urn:x:> ASK { GRAPH service:x { ?s ?p ?o } }",
    "SELECT ?service { ?service ?insert $load }",
    "ASK { ?s <http://example.org/service#SERVICE> ?o }",
    "ASK { ?s <http://example.org/LOAD> 'SERVICE <http://x> { INSERT' }",
    'ASK { ?s ?p """a "SERVICE" \\" <http://x/> { } LOAD""" }',
    "ASK { ?s ?p '\\u0027 SERVICE <http://x> {' }",
    "ASK { ?s ?p 'x'@service }",
    "ASK { ?s ?p ?o # SERVICE <http://x> {}\n }",
    "ASK { FILTER(1<2 && 3>2) }",
    "ASK { VALUES (?a ?b) { (1 2) } FILTER(?a<?b) }",
    "SEL\\u0045CT * {}",
    "ask { ?s a dx:Role . FILTER regex('drop all', 'x') }",
    "BASE <http://example.org/> SELECT (COUNT(*) AS ?n) { ?s <p> ?o }",
    "ASK { _:service ?p ?o }",
    "PREFIX ex: <urn:x:> ASK { ?s ex:a\\'b ?o ; ex:c\\,d ?x }",
]


@pytest.mark.parametrize("query", LET_IN)
def test_words_that_only_look_dangerous_are_let_in(memory: SemanticMemory, query: str) -> None:
    memory.query(query)


PLACES = [
    ("SELECT * {?s foo:a ?o}", 1, 14, "unknown prefix 'foo:'"),
    ("SELECT *\n{ ?s skoz:altLabel ?o }", 2, 6, "did you mean 'skos:'"),
    ("SELECT * {?s ?p ?o} LIMIT x", 1, 27, "syntax error"),
    ("SELECT * {\n  ?s ?p ?o\n", 1, 10, "the query ends before this '{' is closed"),
    ("SELECT * {?s ?p ?o FILTER(?o > 1 ", 1, 26, "the query ends before this"),
    ("SELECT ?o { lx:lesson/tea-1 ?p ?o }", 1, 22, r"write '/' in a prefixed name as '\/': lx:lesson\/tea-1"),
    ("S\\u0045LECT * { ?s SERVICE ?o }", 1, 20, "SERVICE is refused"),
    ("\tASK { ?s foo:a ?o }", 1, 11, "foo"),
]


@pytest.mark.parametrize(("query", "line", "column", "message"), PLACES)
def test_an_error_points_at_the_place(memory: SemanticMemory, query: str, line: int, column: int, message: str) -> None:
    with pytest.raises(QueryError) as caught:
        memory.query(query)
    assert message in str(caught.value)
    head, shown, caret = str(caught.value).split("\n")
    assert head.startswith(f"query:{line}:{column}: ")
    assert shown.strip() == query.split("\n")[line - 1].strip()
    assert caret.expandtabs().index("^") == len(shown[: column + 1].expandtabs())


@pytest.mark.parametrize(
    ("query", "note"),
    [
        (
            "ASK { lx:lesson\\/dinner-3 ?p ?o }",
            "the memory has no 'lx:lesson\\/dinner-3'; did you mean 'lx:lesson\\/dinner-",
        ),
        ("ASK { ?s ?p <https://w3id.org/deixis/learned/zz> }", "the memory has no 'lx:zz'"),
    ],
)
def test_a_learned_thing_that_is_unknown_is_noted(taught: SemanticMemory, query: str, note: str) -> None:
    answer = taught.query(query)
    assert answer.boolean is False
    assert len(answer.notes) == 1 and answer.notes[0].startswith(note)


@pytest.mark.parametrize("named", ["lx:lesson\\/dinner-1", "lx:lesson\\/", "lx:"])
def test_known_things_and_beginnings_of_iris_have_no_note(taught: SemanticMemory, named: str) -> None:
    query = f"SELECT ?s {{ GRAPH dxg:episodes {{ ?s a dx:Lesson FILTER(STRSTARTS(STR(?s), STR({named}))) }} }}"
    answer = taught.query(query)
    assert answer.rows and answer.notes == ()


@pytest.mark.parametrize(
    ("term", "hint"),
    [
        ("dxg:lerned", "dxg:learned"),
        ("dxg:nows", "dxg:now"),
        ("prov:wasDerivdFrom", "prov:wasDerivedFrom"),
        ("dcterms:titel", "dcterms:title"),
    ],
)
def test_a_misspelt_graph_or_standard_term_is_an_error(memory: SemanticMemory, term: str, hint: str) -> None:
    with pytest.raises(QueryError, match=f"'{term}'; did you mean '{hint}'"):
        memory.query(f"SELECT ?s {{ GRAPH ?g {{ ?s ?p {term} }} }}")


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        yield server


PIECES = [
    "SERVICE", "service:", ":x", "ex:b", "<URL>", "?x", "{", "}", "(", ")", "'", '"', "'''", '"""', "#", "\n", " ", "<",
    ">", "\\u0027", "\\'", "FILTER(1<2", "FILTER(?x<ex:b", "true", "1", ".", "?s ?p ?o", "{?s ?p ?o}", "SILENT",
    "ex:a\\'",
    "SERV\\u0049CE", "@en", "^^", "OPTIONAL", "UNION", "_:b", "GRAPH", "&&", "=",
]  # fmt: skip


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(pieces=st.lists(st.sampled_from(PIECES), max_size=14), silent=st.booleans())
@example(pieces=["FILTER(?x<ex:b", "FILTER(1<2", ")", ")"], silent=False)
def test_no_accepted_query_opens_a_connection(listener: socket.socket, pieces: list[str], silent: bool) -> None:
    """Confusing text: no accepted query opens a connection, as a listening socket shows."""
    url = f"http://127.0.0.1:{listener.getsockname()[1]}/"
    head = f"PREFIX ex: <{url}> PREFIX : <{url}> PREFIX service: <{url}> ASK {{ VALUES ?x {{ <{url}> }} "
    query = (
        head + "".join(pieces).replace("URL", url) + (f" SERVICE SILENT <{url}> {{?a ?b ?c}} " if silent else "") + " }"
    )
    try:
        checked = check_query(query)
    except QueryError:
        return
    complaint = ""
    try:
        ox.Store().query(checked.text)
    except (SyntaxError, OSError, RuntimeError, ValueError) as error:
        named = str(error).replace(url, "")  # a function that does not exist is named by its IRI
        complaint = "" if isinstance(error, SyntaxError) else named.lower()
    assert not any(word in complaint for word in ("http", "service", "connect")), query
    with pytest.raises(BlockingIOError):
        listener.accept()


@pytest.mark.filterwarnings("ignore:Dataset.default_context:DeprecationWarning")
def test_the_rdflib_view_has_canonical_graphs_and_no_network(taught: SemanticMemory) -> None:
    view = taught.dataset()
    rows = list(view.query("SELECT ?s WHERE { ?s a <https://w3id.org/deixis/onto#Lesson> }"))
    assert len(rows) == 2
    assert len(view) == len({triple for name in GraphName for triple in taught.triples(name)})
    label = rdflib.RDFS.label
    lesson = rdflib.URIRef("https://w3id.org/deixis/learned/lesson/dinner-1")
    assert [str(value) for value in view.objects(lesson, label)] == ["dinner-1"]
    assert {str(graph.identifier).rsplit("/", 1)[-1] for graph in view.graphs()} >= {"learned", "asserted"}
    assert not any("/lesson/" in str(graph.identifier) for graph in view.graphs())
    episodes = view.graph(rdflib.URIRef("https://w3id.org/deixis/graph/episodes"))
    assert len(episodes) == len(list(taught.triples(GraphName.EPISODES)))
    with pytest.raises(QueryError, match="SERVICE is refused"):
        view.query(f"SELECT * {{ SERVICE {U} {{ ?s ?p ?o }} }}")
    with pytest.raises(MemoryFormatError, match="read-only"):
        view.add((lesson, label, rdflib.Literal("x")))


def test_a_triple_in_two_graphs_is_found_once(memory: SemanticMemory, read: Read) -> None:
    one, two = read("<urn:a> <urn:p> 1 ."), read("<urn:a> <urn:p> 2 .")
    memory.learn("x", {GraphName.ASSERTED: [*one, *two]}, [])
    assert len(memory.query("SELECT * { <urn:a> ?p ?o }").rows) == 2
    memory.learn("y", {GraphName.LEARNED: one}, two)
    assert len(memory.query("SELECT * { <urn:a> ?p ?o }").rows) == 2
    assert len(memory.query("SELECT * { GRAPH ?g { <urn:a> ?p ?o } }").rows) == 4
    assert len(list(memory.dataset().query("SELECT * WHERE { <urn:a> ?p ?o }"))) == 2
    memory.forget("x", two)
    assert len(memory.query("SELECT * { <urn:a> ?p ?o }").rows) == 2
    memory.forget("y", [])
    assert not memory.query("SELECT * { <urn:a> ?p ?o }").rows


def test_what_is_loaded_is_found_once_too(taught: SemanticMemory, memory: SemanticMemory, read: Read) -> None:
    memory.load({GraphName.LEARNED: read("<urn:a> <urn:p> 1 ."), GraphName.ASSERTED: read("<urn:a> <urn:p> 1, 2 .")})
    assert len(memory.query("SELECT * { <urn:a> ?p ?o }").rows) == 2


@pytest.mark.parametrize(
    "prologue", ["PREFIX : <#>", "BASE <http://example.org/> PREFIX : <#>", "PREFIX a: <#x'> PREFIX : <#> # <\n"]
)
def test_relative_iris_may_be_declared_as_prefixes(memory: SemanticMemory, prologue: str) -> None:
    assert memory.query(f"{prologue} ASK {{ :a ?p ?o }}").boolean is False
