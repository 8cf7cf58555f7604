"""The page about the ontology: in step with the TBox, and every term on it with its definition and words."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from rdflib import RDF, RDFS, SKOS, Graph, URIRef

from deixis.errors import OntologyError
from deixis.ontology.document import term_document
from deixis.ontology.tbox import default_ontology, tbox_turtle
from deixis.ontology.vocabulary import BASE, DX

PAGE = Path(__file__).parents[2] / "docs" / "ontology.md"
TURTLE = tbox_turtle()
GRAPH = Graph().parse(data=tbox_turtle(), format="turtle")
TERMS = sorted({s for s in GRAPH.subjects(RDF.type) if isinstance(s, URIRef) and s.startswith(BASE)})

PREFIXES = """
@prefix dx: <https://w3id.org/deixis/onto#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""


@pytest.fixture(scope="module")
def page() -> str:
    return term_document(TURTLE)


def block(page: str, term: URIRef) -> str:
    """What the page says of a term: its line, or of a relation its section."""
    code = f"`dx:{term.removeprefix(BASE)}`"
    section = re.search(rf"^### [^\n]*\({re.escape(code)}\)\n(.*?)(?=^##|\Z)", page, re.MULTILINE | re.DOTALL)
    if section:
        return section[0]
    lines = [
        line
        for line in page.splitlines()
        if f"({code}):" in line or re.search(rf"^\|[^`]*(`[^`]*` \| )?[^`]*{code} \|", line)
    ]
    return "\n".join(lines)


def test_the_page_in_the_docs_is_in_step(page: str) -> None:
    again = "write it anew: python -m deixis.ontology.document > docs/ontology.md"
    assert PAGE.read_text(encoding="utf-8") == page, again


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.removeprefix(BASE))
def test_a_term_is_listed_with_its_definition_and_every_word(term: URIRef, page: str) -> None:
    said = block(page, term)
    wanted = [*GRAPH.objects(term, SKOS.definition), *GRAPH.objects(term, RDFS.label)]
    wanted += [*GRAPH.objects(term, SKOS.altLabel), *GRAPH.objects(term, URIRef(DX.PHRASE))]
    assert [str(text) for text in wanted if str(text) not in said] == []


def test_a_relation_is_given_with_inverse_transitivity_and_atoms(page: str) -> None:
    for relation in default_ontology().relations.values():
        said = block(page, URIRef(relation.iri))
        inverse = default_ontology().relations[relation.inverse]
        assert f"inverse `dx:{inverse.iri.removeprefix(BASE)}`" in said
        assert ("; transitive;" in said) == relation.transitive
        assert "on x " in said
        assert "; on y " in said
        assert ("on z, where heights are known" in said) == bool(relation.z_atoms)


def test_a_relation_stands_once_and_under_its_reading(page: str) -> None:
    wide, exact = page.split("## Relations, the exact reading")
    assert len(re.findall("^### ", wide, re.MULTILINE)) == 10
    assert len(re.findall("^### ", exact, re.MULTILINE)) == 10
    assert "### left (`dx:left`)" in wide
    assert "- on x `<` `m`; on y any\n" in wide
    assert "### exactly left (`dx:exactlyLeft`)" in exact


def test_kinds_are_indented_under_what_they_are(page: str) -> None:
    assert "\n    - **cutlery** (`dx:Cutlery`)" in page
    assert "\n      - **fork** (`dx:Fork`)" in page
    assert "\n        - **cake" not in page
    assert page.count("(`dx:Fork`)") == 1


def test_a_property_is_given_with_domain_and_range(page: str) -> None:
    assert "| in scene | `dx:inScene` | `dx:PerceivedObject` | `dx:Scene` | functional, inverse of `dx:shows` |" in page
    assert "| 0.8 | usually, normally, typically, generally, mostly | `dx:usually` |" in page


def test_a_domain_may_be_a_union_and_a_cycle_does_no_harm() -> None:
    more = """
    dx:odd a owl:ObjectProperty ; rdfs:label "odd|even" ;
        rdfs:domain [ a owl:Class ; owl:unionOf ( dx:Role dx:Scene ) ] .
    dx:Thing rdfs:subClassOf dx:Fork . dx:Role rdfs:subClassOf [ a owl:Class ; owl:complementOf dx:Scene ] .
    """
    page = term_document(TURTLE + PREFIXES + more)
    assert "| odd\\|even | `dx:odd` | `dx:Role` or `dx:Scene` |" in page
    assert page.count("(`dx:Fork`)") == 1
    assert "| role | `dx:role` |" not in page


def test_the_page_says_the_same_for_the_same_text(page: str) -> None:
    assert term_document(TURTLE) == page
    assert page.endswith(".\n")


@pytest.mark.parametrize(("text", "message"), [("dx:a", "no valid Turtle"), (PREFIXES, "has no header")])
def test_a_text_that_is_no_such_ontology_is_refused(text: str, message: str) -> None:
    with pytest.raises(OntologyError, match=message):
        term_document(text)


def test_the_module_writes_the_page(page: str) -> None:
    run = subprocess.run([sys.executable, "-m", "deixis.ontology.document"], capture_output=True, check=True)
    assert run.stdout.decode("utf-8") == page
