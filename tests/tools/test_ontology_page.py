"""Check that the page of the ontology is up to date, with every term, its definition and its words."""

from __future__ import annotations

import re

import pytest
from ontology_page import PAGE, page
from rdflib import RDF, RDFS, SKOS, Graph, URIRef

from deixis.ontology.rdf.vocabulary import BASE, DX
from deixis.ontology.tbox import default_ontology, tbox_turtle

TEXT = PAGE.read_text(encoding="utf-8")
GRAPH = Graph().parse(data=tbox_turtle(), format="turtle")
TERMS = sorted({s for s in GRAPH.subjects(RDF.type) if isinstance(s, URIRef) and s.startswith(BASE)})


def block(term: URIRef) -> str:
    """Return the part of the page on a term: its line, or the section of a relation."""
    code = f"`dx:{term.removeprefix(BASE)}`"
    section = re.search(rf"^### [^\n]*\({re.escape(code)}\)\n(.*?)(?=^##|\Z)", TEXT, re.MULTILINE | re.DOTALL)
    if section:
        return section[0]
    lines = [
        line
        for line in TEXT.splitlines()
        if f"({code}):" in line or re.search(rf"^\|[^`]*(`[^`]*` \| )?[^`]*{code} \|", line)
    ]
    return "\n".join(lines)


def test_the_page_in_the_docs_is_up_to_date() -> None:
    assert page() == TEXT, "write it again: python tools/ontology_page.py"


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.removeprefix(BASE))
def test_a_term_is_listed_with_its_definition_and_every_word(term: URIRef) -> None:
    said = block(term)
    wanted = [*GRAPH.objects(term, SKOS.definition), *GRAPH.objects(term, RDFS.label)]
    wanted += [*GRAPH.objects(term, SKOS.altLabel), *GRAPH.objects(term, URIRef(DX.PHRASE))]
    assert [str(text) for text in wanted if str(text) not in said] == []


def test_a_relation_has_its_inverse_transitivity_and_atoms() -> None:
    for relation in default_ontology().relations.values():
        said = block(URIRef(relation.iri))
        inverse = default_ontology().relations[relation.inverse]
        assert ("- symmetric; " if relation.symmetric else f"inverse `dx:{inverse.iri.removeprefix(BASE)}`") in said
        assert ("; transitive;" in said) == relation.transitive
        assert "on x " in said
        assert "; on y " in said
        assert ("on z, with known heights and overlap on x and y," in said) == bool(relation.z_atoms)


def test_a_relation_is_listed_once_under_its_reading() -> None:
    wide, rest = TEXT.split("## Relations, the exact reading")
    exact, graded = rest.split("## Relations, the graded reading")
    assert len(re.findall("^### ", wide, re.MULTILINE)) == 10
    assert len(re.findall("^### ", exact, re.MULTILINE)) == 10
    assert len(re.findall("^### ", graded, re.MULTILINE)) == 36
    assert "### left (`dx:left`)" in wide
    assert "- on x `<` `m`; on y any\n" in wide
    assert "### exactly left (`dx:exactlyLeft`)" in exact


def test_kinds_are_indented_under_their_parents() -> None:
    assert "\n    - **cutlery** (`dx:Cutlery`)" in TEXT
    assert "\n      - **fork** (`dx:Fork`)" in TEXT
    assert "\n        - **cake" not in TEXT
    assert TEXT.count("(`dx:Fork`)") == 1


def test_a_property_has_its_domain_and_range() -> None:
    assert "| in scene | `dx:inScene` | `dx:PerceivedObject` | `dx:Scene` | functional, inverse of `dx:shows` |" in TEXT
    assert "| 0.8 | usually, normally, typically, generally, mostly | `dx:usually` |" in TEXT
