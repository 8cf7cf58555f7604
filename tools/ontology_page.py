"""Write docs/reference/ontology.md, a readable page of the ontology, from the TBox: ``python tools/ontology_page.py``.

Generators such as pyLODE and Widoco write HTML, and show neither the Allen relations that a word admits, nor usual
sizes, nor colours; pyLODE 3.4.1 from its wheel cannot be imported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from rdflib import DCTERMS, OWL, RDF, RDFS, SKOS, Graph, Namespace, URIRef
from rdflib.term import Node

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference" / "ontology.md"
DX = Namespace("https://w3id.org/deixis/onto#")
CHARACTERISTICS = ("Functional", "InverseFunctional", "Transitive", "Symmetric", "Asymmetric", "Irreflexive")
AXES = {DX.admitsOnX: "x", DX.admitsOnY: "y", DX.decidedOnZ: "z, with known heights and overlap on x and y,"}

TEXT = """\
<!-- Made from ontology/deixis.ttl and everyday.ttl by: python tools/ontology_page.py -->

# The ontology

{title}, version {version}: {description}

Its IRI is <{iri}>, its prefix `dx:` stands for <{base}>, its licence is <{license}>. Alignments to SOMA and DUL, SOSA
and SSN, GeoSPARQL and IEEE 1872 are files of their own in `ontology/alignments/`; the ontology imports nothing.

To add a word that scripts may use for a relation, a hedge, a kind of thing or a colour, add a `skos:altLabel` to its
term.

## Relations, the wide reading

The meaning of a word in a script, which inference and checking use: it constrains the axis that it names and leaves the
other open. *x* points to the viewer's right, *y* away from the viewer, *z* up. The projections of a related pair on an
axis have one of the Allen relations listed for that axis.

{wide}

## Relations, the exact reading

The relation of a pair of boxes: every ordered pair has exactly one of these ten. None of them is transitive, and each
implies the wide relation of the same word.

{exact}

## Relations, the graded reading

Further words. A graded model says how well each fits a pair of boxes
(`reasoning/grounding/evidence/words/meaning.py`). The Allen relations are necessary for a word, not sufficient:
inference uses them, and the inverses, symmetry, transitivity and broader words.

{graded}

## Allen's relations

{allen}

## Kinds of things

{kinds}

## Usual sizes

Usual sizes in centimetres: least, typical, greatest. The length is the longer side of the outline seen from above, the
width the shorter one; for a circle, both are the diameter. Handles are not included: the reach is the distance by which
they stick out, as a percentage of the length. A kind that is not listed has the size of its nearest broader kind.

{sizes}

## Hedges

{hedges}

## Colours

The colours that people call by a word: their mean in sRGB, and their covariance in CIELAB (LL, La, Lb, aa, ab, bb;
white point D65).

{colours}

## Other classes

{classes}

## Object properties

{object_properties}

## Datatype properties

{datatype_properties}

## Annotation properties

{annotation_properties}

## Other individuals

{individuals}

## Terms of other vocabularies

Used as defined there: {others}.
"""

Columns = dict[str, Callable[[Any], str]]
"""Functions that return the cell of a term, by the heading of the column."""

graph = Graph("SimpleMemory")  # keeps the order of the files
for file in ("deixis.ttl", "everyday.ttl"):
    graph.parse(ROOT / "ontology" / file)
header = URIRef("https://w3id.org/deixis/onto")
own = [term for term in dict.fromkeys(graph.subjects()) if isinstance(term, URIRef) and term.startswith(DX)]


def page() -> str:
    """Return the page, in Markdown."""
    terms = {term for term in graph.subjects() if isinstance(term, URIRef)}
    things = set(graph.transitive_subjects(RDFS.subClassOf, DX.Thing))
    listed = {term for kind in (DX.AllenRelation, DX.Hedge, DX.Colour) for term in of_type(kind)}
    term, meaning, source = {"term": code}, {"definition": text(SKOS.definition)}, {"source": text(DCTERMS.source)}
    extents = {end: extent(end) for end in ("length", "width", "height", "reach")}
    return TEXT.format(
        title=value(header, DCTERMS.title),
        version=value(header, OWL.versionInfo),
        description=value(header, DCTERMS.description),
        iri=header,
        base=DX,
        license=value(header, DCTERMS.license),
        wide="\n\n".join(relation(term) for term in own if DX.wide in graph[term : DX.reading]),
        exact="\n\n".join(relation(term) for term in own if DX.exact in graph[term : DX.reading]),
        graded="\n\n".join(relation(term) for term in own if DX.graded in graph[term : DX.reading]),
        allen=table({"sign": sign, "relation of interval a to b": label} | term | meaning, of_type(DX.AllenRelation)),
        kinds="\n".join(tree(DX.Thing, 0)),
        sizes=table({"kind": label, "outline": text(DX.outline)} | extents | source, having(DX.outline)),
        hedges=table({"weight": text(DX.hedgeWeight), "words": words} | term | meaning, of_type(DX.Hedge)),
        colours=table(
            {"words": words} | term | meaning | {"prototype": text(DX.prototype), "spread": text(DX.spread)} | source,
            of_type(DX.Colour),
        ),
        classes=table(
            {"class": label} | term | {"subclass of": linked(RDFS.subClassOf)} | meaning,
            [kind for kind in of_type(OWL.Class) if kind not in things],
        ),
        object_properties=properties(OWL.ObjectProperty),
        datatype_properties=properties(OWL.DatatypeProperty),
        annotation_properties=properties(OWL.AnnotationProperty),
        individuals=table(
            {"individual": words} | term | {"of class": linked(RDF.type)} | meaning,
            [individual for individual in of_type(OWL.NamedIndividual) if individual not in listed],
        ),
        others=", ".join(map(code, sorted(terms - {*own, header}))),
    )


def relation(term: URIRef) -> str:
    """Return the section of a relation: its definition, its parents, the Allen relations admitted, and its words."""
    symmetric = OWL.SymmetricProperty in graph[term : RDF.type]
    inverse = "symmetric" if symmetric else f"inverse {codes(inverses(term))}"
    facts = [inverse, f"sub-property of {linked(RDFS.subPropertyOf)(term)}"]
    if OWL.TransitiveProperty in graph[term : RDF.type]:
        facts.insert(1, "transitive")
    atoms = [f"on {axis} {admitted(list(graph[term:admits]))}" for admits, axis in AXES.items() if value(term, admits)]
    return (
        f"### {label(term)} ({code(term)})\n\n{value(term, SKOS.definition)}\n\n"
        f"- {'; '.join(facts)}\n- {'; '.join(atoms)}\n- words: {words(term)}"
    )


def admitted(relations: list[Node]) -> str:
    """Return the signs of Allen relations, or "any" for all thirteen."""
    return "any" if len(relations) == 13 else " ".join(map(sign, relations))


def tree(kind: Node, depth: int) -> Iterator[str]:
    """Yield a line for a kind and for each kind below it; a kind with two parents is listed under both."""
    name, *others = words(kind).split(", ")
    also = f" Also: {', '.join(others)}." if others else ""
    yield f"{'  ' * depth}- **{name}** ({code(kind)}): {value(kind, SKOS.definition)}{also}"
    for below in graph[: RDFS.subClassOf : kind]:
        yield from tree(below, depth + 1)


def properties(kind: URIRef) -> str:
    """Return the table of the properties of a kind that are not spatial relations."""

    def notes(term: URIRef) -> str:
        found = [name.lower() for name in CHARACTERISTICS if OWL[f"{name}Property"] in graph[term : RDF.type]]
        found += [f"inverse of {code(other)}" for other in inverses(term)]
        return ", ".join(found + [f"sub-property of {code(other)}" for other in graph[term : RDFS.subPropertyOf]])

    ends: Columns = {"domain": linked(RDFS.domain), "range": linked(RDFS.range)}
    columns = {"property": words, "term": code} | ends | {"": notes, "definition": text(SKOS.definition)}
    return table(columns, [term for term in of_type(kind) if not value(term, DX.reading)])


def table(columns: Columns, terms: Iterable[URIRef]) -> str:
    """Return a row for each term, without the columns in which every cell is empty."""
    cells = {head: [cell(term).replace("|", "\\|") for term in terms] for head, cell in columns.items()}
    kept = {head: column for head, column in cells.items() if any(column)}
    lines = [tuple(kept), ("---",) * len(kept), *zip(*kept.values(), strict=True)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def of_type(kind: URIRef) -> list[URIRef]:
    """Return our terms of a type."""
    return [term for term in own if kind in graph[term : RDF.type]]


def having(predicate: URIRef) -> list[URIRef]:
    """Return our terms that have a value of a predicate."""
    return [term for term in own if value(term, predicate)]


def inverses(term: URIRef) -> list[Node]:
    """Return the inverses of a property; OWL states one from either side."""
    return list(dict.fromkeys([*graph[term : OWL.inverseOf], *graph[: OWL.inverseOf : term]]))


def value(term: Node, predicate: URIRef) -> str:
    """Return the value of a predicate of a term as text; empty if the term has no value."""
    return str(graph.value(term, predicate) or "")


def text(predicate: URIRef) -> Callable[[Node], str]:
    """Return a function that gives the value of a predicate of a term as text."""
    return lambda term: value(term, predicate)


label = text(RDFS.label)


def linked(predicate: URIRef) -> Callable[[Node], str]:
    """Return a function that lists the terms under a predicate."""
    return lambda term: codes(other for other in graph[term:predicate] if other != OWL.NamedIndividual)


def extent(name: str) -> Callable[[Node], str]:
    """Return a function that gives the least, typical and greatest length, width, height or reach in centimetres."""
    bounds = [DX[f"{end}{name.capitalize()}"] for end in ("least", "typical", "greatest")]
    return lambda term: ", ".join(f"{100 * float(value(term, bound)):g}" for bound in bounds if value(term, bound))


def sign(term: Node) -> str:
    """Return the sign of an Allen relation as code."""
    return f"`{value(term, DX.allenSymbol)}`"


def words(term: Node) -> str:
    """Return the label, the phrase and the synonyms of a term, each once."""
    given = [label(term), value(term, DX.phrase), *map(str, graph[term : SKOS.altLabel])]
    return ", ".join(word for word in dict.fromkeys(given) if word)


def code(term: Node) -> str:
    """Return the prefixed name of a term as code."""
    return f"`{graph.namespace_manager.normalizeUri(str(term))}`"


def codes(terms: Iterable[Node]) -> str:
    """Return the prefixed names of the terms that have an IRI."""
    return ", ".join(code(term) for term in terms if isinstance(term, URIRef))


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
