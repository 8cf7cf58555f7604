"""The alignments to other ontologies: about existing terms, consistent with the core, and with few axioms."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph
import pytest
from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, SOSA, SSN, Graph, URIRef
from rdflib.namespace import GEO

from deixis.ontology.rdf.vocabulary import BASE, ONTOLOGY_IRI
from deixis.ontology.tbox import TBOX_FILES, tbox_turtle
from deixis.reasoning.description_logic.reasoners import classify

FOLDER = TBOX_FILES[0].parent / "alignments"
FILES = {path.stem: path for path in sorted(FOLDER.glob("*.ttl"))}

DUL = "http://www.ontologydesignpatterns.org/ont/dul/DUL.owl#"
SOMA = "http://www.ease-crc.org/ont/SOMA.owl#"
SUMO = "http://purl.org/ieee1872-owl/sumo-cora#"
POS = "http://purl.org/ieee1872-owl/pos#"
LOOKED_UP = {
    DUL: "PhysicalObject DesignedArtifact Situation Event Role Place hasRole hasSetting isSettingFor hasLocation",
    SOMA: "Tableware Crockery Cutlery Plate Bowl Bottle Fork Knife Spoon Cup Glass WineGlass Table DesignedFurniture "
    "Surface isOntopOf isDepositOf isSupportedBy supports isInsideOf before after contains during starts startedBy "
    "finishes finishedBy",
    SUMO: "Object Artifact Process",
    POS: "relPosition PositionCoordinateSystem PositionMeasure",
}
"""Terms seen in the other ontologies (SOMA's vessels: in programs that use them); rdflib knows the rest."""

CLAIMS = {RDFS.subClassOf: OWL.Class, RDFS.subPropertyOf: OWL.ObjectProperty}
MAPPINGS = {SKOS.closeMatch, SKOS.relatedMatch}

THEIRS = f"""
@prefix dul: <{DUL}> .
@prefix soma: <{SOMA}> .
@prefix sumo: <{SUMO}> .
@prefix geo: <{GEO}> .
@prefix owl: <{OWL}> .
@prefix rdfs: <{RDFS}> .
dul:Object owl:disjointWith dul:Event, dul:Abstract, dul:Quality .
dul:Event owl:disjointWith dul:Abstract, dul:Quality .
dul:PhysicalObject rdfs:subClassOf dul:Object ; owl:disjointWith dul:SocialObject .
dul:SocialObject rdfs:subClassOf dul:Object .
dul:Role rdfs:subClassOf dul:Concept .
dul:Concept rdfs:subClassOf dul:SocialObject .
dul:DesignedArtifact rdfs:subClassOf dul:PhysicalObject .
dul:hasRole rdfs:domain dul:Object ; rdfs:range dul:Role .
dul:hasSetting a owl:ObjectProperty ; owl:inverseOf dul:isSettingFor ; rdfs:range dul:Situation .
soma:Plate rdfs:subClassOf soma:Crockery .
soma:Bowl rdfs:subClassOf soma:Crockery .
soma:Crockery rdfs:subClassOf soma:Tableware .
soma:Fork rdfs:subClassOf soma:Tableware .
soma:Tableware rdfs:subClassOf dul:DesignedArtifact .
soma:DesignedFurniture rdfs:subClassOf dul:DesignedArtifact .
geo:Feature owl:disjointWith geo:Geometry .
sumo:Object owl:disjointWith sumo:Process, sumo:Abstract .
"""
"""Axioms of the other ontologies about the superclasses of our terms, as far as they could contradict ours."""


@pytest.fixture(scope="module")
def core() -> Graph:
    return Graph().parse(data=tbox_turtle(), format="turtle")


def namespace(term: URIRef) -> str:
    return str(term)[: max(str(term).rfind("#"), str(term).rfind("/")) + 1]


def theirs(graph: Graph) -> set[URIRef]:
    """Return the foreign terms in an alignment, without the vocabulary of its header and mappings."""
    words = (BASE, str(OWL), str(RDF), str(RDFS), str(SKOS), str(DCTERMS), ONTOLOGY_IRI)
    terms = {s for s in graph.subjects(RDF.type) if s != header(graph)}
    terms |= {value for claim in (*CLAIMS, *MAPPINGS) for value in graph.objects(None, claim)}
    return {term for term in terms if isinstance(term, URIRef) and not str(term).startswith(words)}


def header(graph: Graph) -> URIRef:
    found = graph.value(None, RDF.type, OWL.Ontology)
    assert isinstance(found, URIRef)
    return found


def is_known(term: URIRef) -> bool:
    for closed in (SOSA, SSN, GEO):
        if term.startswith(str(closed)):
            return term in closed
    space = namespace(term)
    return str(term).removeprefix(space) in LOOKED_UP.get(space, "").split()


def test_there_are_four_alignments() -> None:
    assert list(FILES) == ["geosparql", "ieee-1872", "soma-dul", "sosa-ssn"]


@pytest.mark.parametrize("path", FILES.values(), ids=FILES)
class TestAlignment:
    def test_an_alignment_has_its_own_header_and_imports_nothing(self, path: Path) -> None:
        graph = Graph().parse(path, format="turtle")
        assert header(graph) == URIRef(f"{ONTOLOGY_IRI}/alignments/{path.stem}")
        wanted = (DCTERMS.title, DCTERMS.description, DCTERMS.license, DCTERMS.creator, OWL.versionIRI)
        assert [term for term in wanted if graph.value(header(graph), term) is None] == []
        assert list(graph.subject_objects(OWL.imports)) == []

    def test_an_alignment_mentions_only_declared_terms_of_ours(self, path: Path, core: Graph) -> None:
        graph = Graph().parse(path, format="turtle")
        own = {node for triple in graph for node in triple if isinstance(node, URIRef) and node.startswith(BASE)}
        assert own
        assert {term for term in own if (term, RDF.type, None) not in core} == set()
        assert [term for term in own if (term, RDF.type, None) in graph] == []

    def test_foreign_terms_are_known_and_never_subjects(self, path: Path) -> None:
        graph = Graph().parse(path, format="turtle")
        assert {term for term in theirs(graph) if not is_known(term)} == set()
        assert {p for term in theirs(graph) for p in graph.predicates(term)} <= {RDF.type}

    def test_axioms_are_about_declared_terms_and_the_rest_annotates(self, path: Path, core: Graph) -> None:
        graph = Graph().parse(path, format="turtle")
        own = [(s, p, o) for s, p, o in graph if str(s).startswith(BASE)]
        assert {p for _, p, _ in own} <= {*CLAIMS, *MAPPINGS}
        for ours, claim, other in own:
            if isinstance(claim, URIRef) and claim in CLAIMS:
                assert (ours, RDF.type, CLAIMS[claim]) in core
                assert (other, RDF.type, CLAIMS[claim]) in graph
        assert all((mapping, RDF.type, OWL.AnnotationProperty) in graph for mapping in MAPPINGS)


def unsatisfiable(*turtle: str) -> list[str]:
    """Return the classes that HermiT finds unsatisfiable; raise if the ontology is inconsistent."""
    quads = [quad.triple for text in turtle for quad in pyoxigraph.parse(text, format=pyoxigraph.RdfFormat.TURTLE)]
    ntriples = pyoxigraph.serialize(quads, format=pyoxigraph.RdfFormat.N_TRIPLES) or b""
    return sorted(classify(ntriples.decode("utf-8")).unsatisfiable)


def texts() -> list[str]:
    return [path.read_text(encoding="utf-8") for path in (*TBOX_FILES, *FILES.values())]


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES.values(), ids=FILES)
def test_the_core_with_an_alignment_stays_consistent(path: Path) -> None:
    assert unsatisfiable(TBOX_FILES[0].read_text(encoding="utf-8"), path.read_text(encoding="utf-8"), THEIRS) == []


@pytest.mark.slow
def test_the_core_with_all_alignments_and_a_table_is_consistent() -> None:
    table = f"""
    @prefix dx: <{BASE}> .
    <urn:t> a dx:Scene . <urn:r> a dx:Role .
    <urn:f> a dx:DinnerFork, dx:PerceivedObject ; dx:inScene <urn:t> ; dx:fills <urn:r> ; dx:exactlyLeft <urn:p> .
    <urn:p> a dx:DinnerPlate, dx:PerceivedObject ; dx:inScene <urn:t> .
    """
    assert unsatisfiable(*texts(), THEIRS, table) == []


@pytest.mark.slow
def test_a_wrong_alignment_is_detected() -> None:
    wrong = f"<{BASE}Lesson> <{RDFS.subClassOf}> <{DUL}PhysicalObject> ."
    assert unsatisfiable(*texts(), THEIRS, wrong) == [f"{BASE}Lesson", f"{BASE}WordLesson"]
