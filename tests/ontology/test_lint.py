"""The TBox passes the checks of ROBOT's report command without ERROR or WARN, and its header is complete.

The checks are in ``lint.toml``: names and levels from ROBOT's documentation, and for each whether it is adapted or
only about OBO's own terms. ROBOT itself is not run.
"""

from __future__ import annotations

import io
import tomllib
from pathlib import Path
from typing import Any

import owlready2
import pyoxigraph as ox
import pytest
from rdflib import OWL, RDF, Graph, Literal, Namespace, URIRef

from deixis.ontology.rdf.vocabulary import BASE, ONTOLOGY_IRI
from deixis.ontology.tbox import TBOX_FILES, tbox_turtle

CHECKS: dict[str, dict[str, Any]] = {
    check["name"]: check
    for check in tomllib.loads(Path(__file__).with_name("lint.toml").read_text(encoding="utf-8"))["check"]
}
ALIGNMENTS = sorted((TBOX_FILES[0].parent / "alignments").glob("*.ttl"))
PREFIXES = {
    "dc": "http://purl.org/dc/elements/1.1/",
    "dcterms": "http://purl.org/dc/terms/",
    "ex": "urn:example:",
    "obo": "http://purl.obolibrary.org/obo/",
    "oboInOwl": "http://www.geneontology.org/formats/oboInOwl#",
    "owl": "http://www.w3.org/2002/07/owl#",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "skos": "http://www.w3.org/2004/02/skos/core#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}
SOUND = """
<urn:example:> a owl:Ontology ; dcterms:title "Sound" ; dcterms:description "Sound." ; dcterms:license ex:licence .
skos:altLabel a owl:AnnotationProperty .
ex:top a owl:Class ; rdfs:label "top" ; skos:definition "Everything." ; rdfs:subClassOf owl:Thing .
ex:a a owl:Class ; rdfs:label "first" ; skos:definition "The first thing." ; rdfs:subClassOf ex:top .
ex:b a owl:Class ; rdfs:label "second" ; skos:definition "The second thing." ; rdfs:subClassOf ex:top .
"""
DCTERMS = Namespace("http://purl.org/dc/terms/")
VANN = Namespace("http://purl.org/vocab/vann/")


def store(*turtle: str) -> ox.Store:
    prefixes = "".join(f"@prefix {name}: <{iri}> .\n" for name, iri in PREFIXES.items())
    loaded = ox.Store()
    for text in turtle:
        loaded.load(input=prefixes + text, format=ox.RdfFormat.TURTLE)
    return loaded


def findings(name: str, graph: ox.Store) -> list[str]:
    """Return the findings of a check, one line each with the entity and the value."""
    rows = graph.query(CHECKS[name]["query"], prefixes=PREFIXES)
    assert isinstance(rows, ox.QuerySolutions)
    return sorted({f"{row['entity']} {row['value']}" for row in rows})


@pytest.fixture(scope="module")
def tbox() -> ox.Store:
    return store(tbox_turtle())


@pytest.fixture(scope="module")
def aligned() -> ox.Store:
    return store(*(path.read_text(encoding="utf-8") for path in (*TBOX_FILES, *ALIGNMENTS)))


def test_the_checks_are_those_of_robots_default_profile() -> None:
    levels = [check["level"] for check in CHECKS.values()]
    assert {level: levels.count(level) for level in ("ERROR", "WARN", "INFO")} == {"ERROR": 17, "WARN": 13, "INFO": 2}


SERIOUS = [name for name, check in CHECKS.items() if check["level"] != "INFO"]


@pytest.mark.parametrize("name", SERIOUS)
def test_the_tbox_passes(name: str, tbox: ox.Store) -> None:
    assert findings(name, tbox) == []


@pytest.mark.parametrize("name", SERIOUS)
def test_the_tbox_with_every_alignment_passes(name: str, aligned: ox.Store) -> None:
    assert findings(name, aligned) == []


@pytest.mark.parametrize("name", CHECKS)
def test_a_check_finds_errors_and_none_in_a_sound_ontology(name: str) -> None:
    assert findings(name, store(SOUND)) == []
    assert findings(name, store(SOUND, CHECKS[name]["bad"])) != []


def test_the_findings_of_level_info_are_known(tbox: ox.Store) -> None:
    """Definitions may begin with the name of an interval, and some classes have no superclass."""
    assert all(' "a ' in finding for finding in findings("lowercase_definition", tbox))
    tops = {finding.split(">", 1)[0].rsplit("#", 1)[-1] for finding in findings("missing_superclass", tbox)}
    assert {"SpatialEntity", "Scene", "AllenRelation"} <= tops
    assert not tops & {"Thing", "Fork", "Layout", "PerceivedObject", "Lesson"}


def test_the_header_is_complete() -> None:
    graph = Graph().parse(data=tbox_turtle(), format="turtle")
    header = URIRef(ONTOLOGY_IRI)
    assert list(graph.subjects(RDF.type, OWL.Ontology)) == [header]
    version = str(graph.value(header, OWL.versionInfo))
    assert graph.value(header, OWL.versionIRI) == URIRef(f"{ONTOLOGY_IRI}/{version}")
    for term in (DCTERMS.title, DCTERMS.description):
        text = graph.value(header, term)
        assert isinstance(text, Literal)
        assert text.language == "en"
    assert graph.value(header, DCTERMS.license) == URIRef("https://www.apache.org/licenses/LICENSE-2.0")
    assert graph.value(header, DCTERMS.creator) is not None
    assert str(graph.value(header, VANN.preferredNamespacePrefix)) == "dx"
    assert str(graph.value(header, VANN.preferredNamespaceUri)) == BASE
    assert list(graph.triples((None, OWL.imports, None))) == []


def test_rdflib_oxigraph_and_owlready_read_the_same_terms(tbox: ox.Store) -> None:
    graph = Graph().parse(data=tbox_turtle(), format="turtle")
    assert len(graph) == len(tbox)
    classes = {str(c) for c in graph.subjects(RDF.type, OWL.Class) if isinstance(c, URIRef)}
    ntriples = tbox.dump(format=ox.RdfFormat.N_TRIPLES, from_graph=ox.DefaultGraph())
    assert ntriples is not None
    world = owlready2.World()
    loaded = world.get_ontology(ONTOLOGY_IRI).load(fileobj=io.BytesIO(ntriples), format="ntriples")
    assert {c.iri for c in world.classes()} == classes
    assert {p.iri for p in world.object_properties()} >= {f"{BASE}left", f"{BASE}exactlyLeft"}
    assert loaded.imported_ontologies == []
    world.close()
