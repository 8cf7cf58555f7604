"""Inferences are removed with their premises, as judged by an engine that did not infer them."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox
import pytest

from deixis.examples_data import example
from deixis.learning.inference.inferred_graph import ENGINES
from deixis.memory.semantic.rdf.change import concluding
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.store import SemanticMemory
from deixis.ontology.rdf.triples import with_blank_nodes
from deixis.ontology.rdf.vocabulary import PROV
from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
from deixis.reasoning.description_logic.terms import Triple, read_ntriples
from deixis.session import Session

pytestmark = pytest.mark.slow

FULL, SCRIPT1, SCENE = (example(n) for n in ("formal_dinner.layout", "script1.layout", "place_setting.scene.json"))
TABLE2 = example("second_table.scene.json")


def said(memory: SemanticMemory, *names: GraphName) -> set[Triple]:
    found = [triple for name in names for triple in memory.triples(name)]
    text = ox.serialize(with_blank_nodes(found), format=ox.RdfFormat.N_TRIPLES) or b""
    return set(read_ntriples(text.decode("utf-8")))


def stale(memory: SemanticMemory) -> set[Triple]:
    """Return the inferred triples about the world that the rules of OWL 2 RL do not derive from the stated ones."""
    stated = said(memory, GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED)
    known = Materialisation(stated)
    inferred = said(memory, GraphName.INFERRED)
    return {t for t in inferred if t not in known and not is_origin(t) and not is_of_layout(t)}


def is_of_layout(triple: Triple) -> bool:
    """Return whether a triple is about a layout's implications, which OWL 2 RL does not know."""
    return triple.subject.startswith("<https://w3id.org/deixis/learned/layout/")


def is_origin(triple: Triple) -> bool:
    """Return whether a triple is about the inferred graph itself, or its engines."""
    return triple.subject.startswith(
        (f"<{graph_iri(GraphName.INFERRED).value}", "<https://w3id.org/deixis/learned/inference")
    ) or triple.subject in {f"<https://w3id.org/deixis/learned/agent/{name}>" for name in ENGINES}


def test_no_inference_outlives_its_premises(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(FULL, SCENE)
        session.learn(SCRIPT1, TABLE2)
        memory = session.memory()
        assert stale(memory) == set()
        both = said(memory, GraphName.INFERRED)
        session.forget("formal_dinner-1")
        assert stale(memory) == set()
        left = said(memory, GraphName.INFERRED)
        gone = both - left
        assert gone and not any("formal_dinner-1" in part for triple in left for part in triple)
        session.forget("script1-1")
        rest = [triple for triple in said(memory, GraphName.INFERRED) if not is_origin(triple)]
        assert not any("/learned/" in triple.subject for triple in rest)


def test_the_next_lesson_removes_an_unfounded_triple(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(FULL, SCENE)
        memory = session.memory()
        fork = ox.NamedNode("https://w3id.org/deixis/onto#Fork")
        false = ox.Triple(fork, ox.NamedNode("http://www.w3.org/2000/01/rdf-schema#subClassOf"), ox.NamedNode("urn:x"))
        memory.commit(concluding(memory.store, [*memory.triples(GraphName.INFERRED), false]))
        assert [t.object for t in stale(memory)] == ["<urn:x>"]
        session.learn(SCRIPT1, SCENE)
        assert stale(memory) == set()


def test_the_inferred_graph_has_its_provenance(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(FULL, SCENE)
        path = f"<{PROV.WAS_GENERATED_BY}>/<{PROV.WAS_ASSOCIATED_WITH}>/rdfs:label"
        rows = session.query(f"SELECT ?engine {{ dxg:inferred {path} ?engine }} ORDER BY ?engine").rows
        assert [str(row[0]).split(":")[0].strip('"') for row in rows] == sorted(ENGINES)
        asked = f"SELECT ?g {{ dxg:inferred <{PROV.WAS_DERIVED_FROM}> ?g }} ORDER BY ?g"
        assert [str(row[0]) for row in session.query(asked).rows] == [
            f"<https://w3id.org/deixis/graph/{name}>" for name in ("asserted", "learned", "ontology")
        ]
