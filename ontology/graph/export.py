"""Export a relation graph as JSON, Turtle and DOT."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from deixis.ontology.graph.claims import PLACES, Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.rdf.vocabulary import BASE, DX

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from deixis.ontology.graph.graph import RelationGraph
    from deixis.ontology.relations.relation import Relation


def fact_to_dict(fact: Fact) -> dict[str, Any]:
    """Return a fact as it appears in the JSON output of the commands.

    Parameters
    ----------
    fact
        The fact.

    Returns
    -------
    dict
        Relations, names, sign, weight, and its place if it has one.
    """
    entry: dict[str, Any] = {
        "relation": " or ".join(relation.word for relation in fact.relations),
        "subject": fact.subject,
        "object": fact.object,
        "reading": fact.relations[0].reading.value,
        "relations": [relation.name for relation in fact.relations],
        "positive": fact.positive,
        "optional": fact.optional,
        "weight": fact.weight,
    }
    if fact.source is not None:
        entry |= {"file": fact.source.file, "line": fact.source.line, "column": fact.source.column}
    return entry


ON_SURFACE = frozenset({*PLACES, "on"})
"""Claims that are about the surface if they have no arguments."""


def claim_to_dict(claim: Claim, surface: str | None = None) -> dict[str, Any]:
    """Return a claim as it appears in the JSON output of the commands.

    Parameters
    ----------
    claim
        Claim to export.
    surface
        Name of the surface, which becomes the argument of a claim about a place on it.

    Returns
    -------
    dict
        Relation, subjects, arguments, value and weight, with the file, line and column of a claim that has a source.
    """
    nothing = claim.relation.startswith("none_")
    relation = claim.relation.removeprefix("none_")
    subject, arguments = ("*", claim.subjects) if nothing else (claim.subjects[0], claim.arguments)
    if not nothing and len(claim.subjects) > 1:
        arguments = (*claim.subjects[1:], *claim.arguments)
    binary = len(arguments) == 1 and claim.value is None and (nothing or len(claim.subjects) == 1)
    over_surface = not arguments and relation in ON_SURFACE and surface is not None
    entry: dict[str, Any] = {
        "relation": relation,
        "subject": subject,
        "object": arguments[0] if binary else None,
        "arguments": [surface] if over_surface else list(arguments),
        "value": claim.value,
        "metres": claim.metres,
        "reading": "wide",
        "relations": [relation],
        "positive": claim.positive and not nothing,
        "optional": claim.optional,
        "weight": claim.weight,
        "subjects": list(claim.subjects),
    }
    if claim.source is not None:
        entry |= {"file": claim.source.file, "line": claim.source.line, "column": claim.source.column}
    return entry


def graph_to_dict(graph: RelationGraph) -> dict[str, Any]:
    """Return the graph as plain data, ready for ``json.dumps``.

    Parameters
    ----------
    graph
        The graph.

    Returns
    -------
    dict
        Nodes with their kinds and colours, and edges.
    """
    nodes: list[dict[str, Any]] = []
    for i, name in enumerate(graph.nodes):
        node: dict[str, Any] = {"id": name}
        if graph.kinds and graph.kinds[i] is not None:
            node["kind"] = graph.kinds[i]
        if graph.colours and graph.colours[i] is not None:
            node["colour"] = graph.colours[i]
        if graph.boxes is not None:
            node |= {"min": graph.boxes[i, 0].tolist(), "max": graph.boxes[i, 1].tolist()}
        nodes.append(node)
    facts = []
    for fact in graph.facts():
        entry = fact_to_dict(fact)
        if fact.source is not None:
            entry |= {"end_line": fact.source.end_line, "end_column": fact.source.end_column}
        facts.append(entry)
    return {"nodes": nodes, "facts": facts}


PREFIXES = {
    "dx": BASE,
    "rdfs": "http://www.w3.org/2000/01/rdf-schema#",
    "xsd": "http://www.w3.org/2001/XMLSchema#",
}

GRAPH_BASE = "urn:deixis:graph:"
"""Base of the IRIs of the objects of a graph that belongs to no layout."""

IRI_SIGNS = ":/?#[]@!$&'()*+,;=%"
"""Characters besides letters, digits and ``-._~`` that may stand unescaped in an IRI."""


def graph_to_turtle(graph: RelationGraph, base: str = GRAPH_BASE) -> str:
    """Return the graph as Turtle.

    Names become percent-encoded IRIs without slashes, and escaped literals, so that no name can add a statement or be
    mistaken for one.

    Parameters
    ----------
    graph
        The graph to export.
    base
        Prefix of the IRIs: each object is ``base`` + its name, and each edge is a ``dx:RelationStatement`` named
        ``base`` + ``fact/`` + its number.

    Returns
    -------
    str
        The text.
    """
    lines = [f"@prefix {prefix}: <{iri}> ." for prefix, iri in PREFIXES.items()]
    lines.append("")
    for i, name in enumerate(graph.nodes):
        kind = (graph.kinds[i] if graph.kinds else None) or DX.THING
        colour = graph.colours[i] if graph.colours else None
        coloured = f" ; {_dx(DX.OF_COLOUR)} <{quote(colour, safe=IRI_SIGNS)}>" if colour else ""
        lines.append(f"{_iri(base, name)} a <{quote(kind, safe=IRI_SIGNS)}> ; rdfs:label {_literal(name)}{coloured} .")
    for number, fact in enumerate(graph.facts()):
        lines.append("")
        lines.append(f"<{base}fact/{number + 1}> a {_dx(DX.RELATION_STATEMENT)} ;")
        lines.append(f"    {_dx(DX.SUBJECT)} {_iri(base, fact.subject)} ;")
        lines.append(f"    {_dx(DX.OBJECT)} {_iri(base, fact.object)} ;")
        lines.append(f"    {_dx(DX.RELATION)} {', '.join(_relation(r) for r in fact.relations)} ;")
        if fact.source is not None:
            lines.append(f"    {_dx(DX.STATED_AT)} {_literal(str(fact.source))} ;")
        lines.append(f"    {_dx(DX.OPTIONAL)} {str(fact.optional).lower()} ;")
        lines.append(f"    {_dx(DX.POSITIVE)} {str(fact.positive).lower()} ;")
        lines.append(f"    {_dx(DX.WEIGHT)} {fact.weight:.6f} .")
    return "\n".join(lines) + "\n"


def pairs_to_ntriples(relation: Relation, pairs: NDArray[np.int64], iris: Sequence[str]) -> str:
    """Return one N-Triples line per pair, sorted by subject.

    Parameters
    ----------
    relation
        The predicate of all lines.
    pairs
        Node indices of subject and object, shape (k, 2).
    iris
        The IRIs of the nodes in angle brackets, as of :func:`node_iris`.

    Returns
    -------
    str
        The lines; empty without a pair.
    """
    import numpy as np

    chunks: list[str] = []
    if not len(pairs):
        return ""
    subjects, begins = np.unique(pairs[:, 0], return_index=True)
    for subject, objects in zip(subjects.tolist(), np.split(pairs[:, 1], begins[1:]), strict=True):
        head = f"{iris[subject]} <{relation.iri}> "
        others: list[int] = objects.tolist()
        chunks.append(head + f" .\n{head}".join([iris[other] for other in others]) + " .\n")
    return "".join(chunks)


def node_iris(graph: RelationGraph) -> list[str]:
    """Return the IRIs of the nodes in angle brackets, as :func:`graph_to_turtle` writes them.

    Parameters
    ----------
    graph
        The graph.

    Returns
    -------
    list of str
        One IRI for each node.
    """
    return [_iri(GRAPH_BASE, name) for name in graph.nodes]


def _dx(term: DX) -> str:
    return "dx:" + term.removeprefix(BASE)


def _relation(relation: Relation) -> str:
    return "dx:" + relation.iri.removeprefix(BASE) if relation.iri.startswith(BASE) else f"<{relation.iri}>"


def _iri(base: str, name: str) -> str:
    return f"<{base}{quote(name, safe='')}>"


def _literal(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def graph_to_dot(graph: RelationGraph) -> str:
    """Return the graph in Graphviz's DOT language: denied facts dashed, optional ones dotted, hedged ones thinner.

    Parameters
    ----------
    graph
        The graph.

    Returns
    -------
    str
        The text.
    """
    lines = ["digraph layout {", "    node [shape=box, style=rounded, fontname=Helvetica];"]
    lines += [f"    {_literal(name)};" for name in graph.nodes]
    for fact in graph.facts():
        label = " or ".join(relation.phrase for relation in fact.relations)
        style = "dotted" if fact.optional else "solid" if fact.positive else "dashed"
        shown = _literal(label if fact.positive else f"not {label}")
        lines.append(
            f"    {_literal(fact.subject)} -> {_literal(fact.object)} "
            f"[label={shown}, style={style}, penwidth={max(0.3, fact.weight):.2f}];"
        )
    return "\n".join([*lines, "}"]) + "\n"
