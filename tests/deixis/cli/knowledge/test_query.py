"""``deixis query`` with an empty answer: standard error says so, and the output stays machine-readable."""

from __future__ import annotations

import json
from pathlib import Path

import pyoxigraph as ox
import pytest
from commands import deixis

from deixis.memory.semantic.queries.results import EMPTY_ANSWER
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.memory.semantic.store import SemanticMemory

SELECT = "SELECT ?s { ?s <urn:p> 8 }"
CONSTRUCT = "CONSTRUCT WHERE { ?s <urn:p> 8 }"
DESCRIBE = "DESCRIBE ?s { ?s <urn:p> 8 }"


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A memory with one triple that the queries do not match."""
    folder = tmp_path_factory.mktemp("asked") / "memory"
    with SemanticMemory.open(folder, create=True) as memory:
        triple = ox.Triple(ox.NamedNode("urn:s"), ox.NamedNode("urn:p"), ox.Literal(7))
        memory.load({GraphName.ASSERTED: [triple]})
    return folder


@pytest.mark.parametrize(
    ("query", "format", "printed"),
    [
        (SELECT, "table", "s\n-\n"),
        (SELECT, "csv", "s\n"),
        (CONSTRUCT, "table", ""),
        (CONSTRUCT, "turtle", ""),
        (DESCRIBE, "table", ""),
    ],
)
def test_an_empty_answer_says_so(query: str, format: str, printed: str, memory: Path) -> None:
    code, out, err = deixis("query", query, "--format", format, "--memory", memory)
    assert (code, out.replace("\r", ""), err) == (0, printed, f"deixis: {EMPTY_ANSWER}\n")


@pytest.mark.parametrize(
    ("query", "expected"),
    [(SELECT, {"head": {"vars": ["s"]}, "results": {"bindings": []}}), (CONSTRUCT, {"triples": []})],
)
def test_an_empty_answer_is_valid_json(query: str, expected: object, memory: Path) -> None:
    code, out, err = deixis("query", query, "--json", "--memory", memory)
    assert (code, json.loads(out), err) == (0, expected, f"deixis: {EMPTY_ANSWER}\n")


@pytest.mark.parametrize("query", ["ASK { ?s <urn:p> 8 }", "SELECT ?s { ?s <urn:p> 7 }"])
def test_other_answers_have_no_such_note(query: str, memory: Path) -> None:
    assert deixis("query", query, "--memory", memory)[2] == ""
