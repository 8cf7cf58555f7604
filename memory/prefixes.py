"""The prefixes that queries may use undeclared, and that output is written with."""

from __future__ import annotations

import re

from deixis.memory.graphs import GRAPHS
from deixis.ontology.iris import LEARNED
from deixis.ontology.vocabulary import BASE

PREFIXES = {
    "dcterms": "http://purl.org/dc/terms/",
    "dx": BASE,
    "dxg": GRAPHS,
    "lx": LEARNED,
    "owl": "http://www.w3.org/2002/07/owl#",
    "prov": "http://www.w3.org/ns/prov#",
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "sh": "http://www.w3.org/ns/shacl#",
    "skos": "http://www.w3.org/2004/02/skos/core#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}

_SAFE_LOCAL = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")


def short(iri: str) -> str:
    """An IRI for people to read: by prefix where there is one, else in angle brackets.

    >>> short("https://w3id.org/deixis/learned/layout/dinner-1")
    'lx:layout/dinner-1'
    """
    for prefix, base in PREFIXES.items():
        if iri.startswith(base):
            return f"{prefix}:{iri.removeprefix(base)}"
    return f"<{iri}>"


def turtle_name(iri: str) -> str:
    """An IRI in Turtle: by prefix where what follows is plain, else in angle brackets.

    >>> turtle_name("https://w3id.org/deixis/learned/layout/dinner-1")
    '<https://w3id.org/deixis/learned/layout/dinner-1>'
    """
    for prefix, base in PREFIXES.items():
        if iri.startswith(base) and _SAFE_LOCAL.fullmatch(iri, len(base)):
            return f"{prefix}:{iri.removeprefix(base)}"
    return f"<{iri}>"
