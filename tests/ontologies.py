"""Small ontologies for tests, written in Turtle and read as N-Triples."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox

from deixis.reasoning.description_logic.terms import Triple, read_ntriples

CORE = Path(__file__).parent.parent / "ontology" / "deixis.ttl"

PREFIXES = """
@prefix : <urn:t#> .
@prefix dx: <https://w3id.org/deixis/onto#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
"""

CUTLERY = """
:Cutlery a owl:Class ; rdfs:label "cutlery"@en . :Fork a owl:Class ; rdfs:label "fork"@en .
:Spoon a owl:Class ; rdfs:label "spoon"@en . :DessertFork a owl:Class .
:Fork rdfs:subClassOf :Cutlery . :Spoon rdfs:subClassOf :Cutlery . :DessertFork rdfs:subClassOf :Fork .
:Fork owl:disjointWith :Spoon .
"""


def ntriples(turtle: str) -> str:
    """Convert a Turtle text, with the prefixes added, to N-Triples."""
    triples = [quad.triple for quad in ox.parse((PREFIXES + turtle).encode(), format=ox.RdfFormat.TURTLE)]
    return (ox.serialize(triples, format=ox.RdfFormat.N_TRIPLES) or b"").decode()


def triples(turtle: str) -> list[Triple]:
    """Read the triples of a Turtle text, with the prefixes added."""
    return read_ntriples(ntriples(turtle))


def triple(text: str) -> Triple:
    """Read one statement, in Turtle without its full stop."""
    (found,) = triples(f"{text} .")
    return found


def core() -> str:
    """Return the ontology that Deixis comes with, as N-Triples."""
    found = [quad.triple for quad in ox.parse(path=CORE)]
    return (ox.serialize(found, format=ox.RdfFormat.N_TRIPLES) or b"").decode()
