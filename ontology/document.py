"""The ontology as a page to read: every term with its definition and words, made from the TBox alone.

``python -m deixis.ontology.document > docs/ontology.md`` writes the page anew; a test fails where it is out of step.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deixis.errors import OntologyError
from deixis.ontology.allen import SYMBOLS
from deixis.ontology.document_terms import DCTERMS, OWL, RDFS, Term, Terms, read_terms, union
from deixis.ontology.vocabulary import BASE, DX, ONTOLOGY_IRI, W3C

_PREFIXES = {
    BASE: "dx:",
    OWL: "owl:",
    "http://www.w3.org/ns/prov#": "prov:",
    "http://www.w3.org/2001/XMLSchema#": "xsd:",
    "http://www.w3.org/2004/02/skos/core#": "skos:",
    DCTERMS: "dcterms:",
    "http://purl.org/vocab/vann/": "vann:",
    "http://qudt.org/schema/qudt/": "qudt:",
    "http://qudt.org/vocab/unit/": "unit:",
}
_PROPERTIES = {
    "Object properties": OWL + "ObjectProperty",
    "Datatype properties": OWL + "DatatypeProperty",
    "Annotation properties": OWL + "AnnotationProperty",
}
_CHARACTERISTICS = ("Functional", "InverseFunctional", "Transitive", "Symmetric", "Asymmetric", "Irreflexive")

_INTRODUCTION = """\
<!-- Made from ontology/deixis.ttl and everyday.ttl by: python -m deixis.ontology.document > docs/ontology.md -->

# The ontology

{title}, version {version}: {description}

Its IRI is <{iri}>, its prefix `dx:` stands for <{base}>, its licence is <{license}>. Alignments to SOMA and DUL, SOSA
and SSN, GeoSPARQL and IEEE 1872 are files of their own in `ontology/alignments/`; the ontology imports nothing.

Add a word that scripts may use for a relation, a hedge, a kind of thing or a colour: add a `skos:altLabel` to its
term."""

_WIDE = """\
## Relations, the wide reading

What a word means in a script, and what inference and checking use: it constrains the axis that it names and leaves the
rest open. *x* points to the viewer's right, *y* away from the viewer, *z* up. Of a pair in a relation, the projections
on an axis bear one of the Allen relations that stand there."""

_EXACT = """\
## Relations, the exact reading

The name of a pair of boxes: of these ten every ordered pair bears exactly one. None is transitive, and each implies the
wide relation that it stands under."""

_SIZES = """\
## Usual sizes

How large things usually are, in centimetres: least, typical, greatest. The length is the longer side of the outline,
seen from above, the width the shorter one; of a circle both are the diameter. Handles are not counted: the reach is how
far they stand out, in hundredths of the length. A kind of which nothing stands here is as
large as the nearest broader one that does."""

_COLOURS = """\
## Colours

What people call by a word: the middle of it in sRGB, and the covariance around that in CIELAB (LL, La, Lb, aa, ab, bb;
white point D65)."""


def term_document(turtle: str) -> str:
    """The page, in Markdown, of an ontology in Turtle that is built as the shipped TBox is.

    >>> from deixis.ontology.tbox import tbox_turtle
    >>> page = term_document(tbox_turtle())
    >>> "**fork** (`dx:Fork`): Cutlery with tines." in page
    True

    Raises OntologyError where the text is no Turtle, or has no header.
    """
    terms = read_terms(turtle)
    if ONTOLOGY_IRI not in terms:
        raise OntologyError(f"the ontology has no header: nothing is said of <{ONTOLOGY_IRI}>")
    own = [term for iri, term in terms.items() if iri.startswith(BASE)]
    parts = [
        _introduction(terms[ONTOLOGY_IRI]),
        _WIDE,
        *(_relation(term, terms) for term in own if DX.WIDE in term.values(DX.READING)),
        _EXACT,
        *(_relation(term, terms) for term in own if DX.EXACT in term.values(DX.READING)),
        _allen_relations(own),
        "## Kinds of things",
        "\n".join(_tree(DX.THING, own)),
        _SIZES,
        _sizes(own),
        _hedges(own),
        _colours(own),
        _other_classes(own),
        *(_properties(title, kind, own, terms) for title, kind in _PROPERTIES.items()),
        _individuals(own),
        _of_others(terms),
    ]
    return "\n\n".join(parts) + "\n"


def _introduction(header: Term) -> str:
    return _INTRODUCTION.format(
        title=header.value(W3C.DCTERMS_TITLE),
        version=header.value(OWL + "versionInfo"),
        description=header.value(DCTERMS + "description"),
        license=header.value(DCTERMS + "license"),
        iri=header.iri,
        base=BASE,
    )


def _relation(term: Term, terms: Terms) -> str:
    facts = [f"inverse {', '.join(map(_code, _inverses(term, terms)))}"]
    if term.is_a(OWL + "TransitiveProperty"):
        facts.append("transitive")
    facts.append(f"under {', '.join(map(_code, term.values(W3C.RDFS_SUB_PROPERTY_OF)))}")
    axes = [("x", DX.ADMITS_ON_X), ("y", DX.ADMITS_ON_Y), ("z, where heights are known", DX.DECIDED_ON_Z)]
    atoms = [f"on {axis} {_atoms(term.values(prop), terms)}" for axis, prop in axes if term.values(prop)]
    return "\n".join(
        [
            f"### {term.value(W3C.RDFS_LABEL)} ({_code(term.iri)})\n",
            f"{term.value(W3C.SKOS_DEFINITION)}\n",
            f"- {'; '.join(facts)}",
            f"- {'; '.join(atoms)}",
            f"- words: {', '.join(term.words)}",
        ]
    )


def _inverses(term: Term, terms: Terms) -> list[str]:
    """OWL states an inverse from either side."""
    backwards = [other.iri for other in terms.values() if term.iri in other.values(W3C.OWL_INVERSE_OF)]
    return list(dict.fromkeys([*term.values(W3C.OWL_INVERSE_OF), *backwards]))


def _atoms(relations: Iterable[str], terms: Terms) -> str:
    symbols = [terms[iri].value(DX.ALLEN_SYMBOL) for iri in relations]
    return "any" if len(symbols) == len(SYMBOLS) else " ".join(f"`{symbol}`" for symbol in symbols)


def _allen_relations(own: Iterable[Term]) -> str:
    rows = [
        (f"`{term.value(DX.ALLEN_SYMBOL)}`", term.value(W3C.RDFS_LABEL), _code(term.iri), term.definition)
        for term in own
        if term.is_a(DX.ALLEN_RELATION)
    ]
    return "## Allen's relations\n\n" + _table(("sign", "relation of interval a to b", "term", "definition"), rows)


def _tree(iri: str, own: list[Term], above: tuple[str, ...] = ()) -> Iterator[str]:
    """A class and all below it, indented; a class with two parents stands under both."""
    for term in own:
        if term.iri == iri:
            yield f"{'  ' * len(above)}- {_entry(term)}"
    for term in own:
        below = iri in term.values(W3C.RDFS_SUB_CLASS_OF) and term.is_a(W3C.OWL_CLASS)
        if below and term.iri not in (iri, *above):
            yield from _tree(term.iri, own, (*above, iri))


def _entry(term: Term) -> str:
    label, *others = term.words or (_code(term.iri),)
    also = f" Also: {', '.join(others)}." if others else ""
    return f"**{label}** ({_code(term.iri)}): {term.definition}{also}"


def _sizes(own: Iterable[Term]) -> str:
    ends = ("length", "width", "height", "reach")
    rows = [
        (term.value(W3C.RDFS_LABEL), term.value(DX.OUTLINE), *(_extent(term, end) for end in ends), _source(term))
        for term in own
        if term.values(DX.OUTLINE)
    ]
    return _table(("kind", "outline", *ends, "source"), rows)


def _extent(term: Term, end: str) -> str:
    """The three numbers of a length, a width or a height in centimetres; empty where none are stated."""
    metres = (term.value(f"{BASE}{which}{end.capitalize()}") for which in ("least", "typical", "greatest"))
    return ", ".join(f"{100 * float(text):g}" for text in metres if text)


def _source(term: Term) -> str:
    return term.value(W3C.DCTERMS_SOURCE)


def _hedges(own: Iterable[Term]) -> str:
    rows = [
        (term.value(DX.HEDGE_WEIGHT), ", ".join(term.words), _code(term.iri), term.definition)
        for term in own
        if term.is_a(DX.HEDGE)
    ]
    return "## Hedges\n\n" + _table(("weight", "words", "term", "definition"), rows)


def _colours(own: Iterable[Term]) -> str:
    rows = [
        (
            *(", ".join(term.words), _code(term.iri), term.definition),
            *(term.value(DX.PROTOTYPE), term.value(DX.SPREAD), _source(term)),
        )
        for term in own
        if term.is_a(DX.COLOUR)
    ]
    return f"{_COLOURS}\n\n" + _table(("words", "term", "definition", "prototype", "spread", "source"), rows)


def _other_classes(own: list[Term]) -> str:
    """The classes that are no kind of thing."""
    shown = "\n".join(_tree(DX.THING, own))
    rows = []
    for term in own:
        if term.is_a(W3C.OWL_CLASS) and f"({_code(term.iri)})" not in shown:
            broader = ", ".join(_code(value) for value in term.values(W3C.RDFS_SUB_CLASS_OF) if _is_iri(value))
            rows.append((term.value(W3C.RDFS_LABEL), _code(term.iri), broader, term.definition))
    return "## Other classes\n\n" + _table(("class", "term", "under", "definition"), rows)


def _properties(title: str, kind: str, own: Iterable[Term], terms: Terms) -> str:
    rows = []
    for term in own:
        if term.is_a(kind) and not term.values(DX.READING):
            notes = [name.lower() for name in _CHARACTERISTICS if term.is_a(f"{OWL}{name}Property")]
            notes += [f"inverse of {_code(other)}" for other in _inverses(term, terms)]
            notes += [f"under {_code(other)}" for other in term.values(W3C.RDFS_SUB_PROPERTY_OF)]
            domain, range_ = (_classes(term.values(RDFS + end), terms) for end in ("domain", "range"))
            rows.append((", ".join(term.words), _code(term.iri), domain, range_, ", ".join(notes), term.definition))
    return f"## {title}\n\n" + _table(("property", "term", "domain", "range", "", "definition"), rows)


def _classes(values: Iterable[str], terms: Terms) -> str:
    return ", ".join(" or ".join(map(_code, union(value, terms))) for value in values)


def _individuals(own: Iterable[Term]) -> str:
    rows, shown_above = [], (DX.ALLEN_RELATION, DX.HEDGE, DX.COLOUR)
    for term in own:
        if term.is_a(OWL + "NamedIndividual") and not any(map(term.is_a, shown_above)):
            kinds = [kind for kind in term.values(W3C.RDF_TYPE) if kind.startswith(BASE)]
            rows.append((", ".join(term.words), _code(term.iri), ", ".join(map(_code, kinds)), term.definition))
    return "## Other individuals\n\n" + _table(("individual", "term", "of class", "definition"), rows)


def _of_others(terms: Terms) -> str:
    named = [iri for iri in terms if iri.startswith(tuple(_PREFIXES)) and not iri.startswith(BASE)]
    return "## Terms of others\n\nUsed as they are defined elsewhere: " + ", ".join(map(_code, sorted(named))) + "."


def _is_iri(value: str) -> bool:
    """Blank nodes have names without a colon."""
    return ":" in value


def _code(iri: str) -> str:
    """An IRI as ``prefix:name`` where the prefix is known."""
    for base, prefix in _PREFIXES.items():
        if iri.startswith(base):
            return f"`{prefix}{iri.removeprefix(base)}`"
    return f"`{iri}`"


def _table(heads: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """A table without the columns in which every cell is empty."""
    body = list(rows)
    kept = [column for column in range(len(heads)) if any(row[column] for row in body)]
    lines = [heads, ("---",) * len(heads), *body]
    return "\n".join("| " + " | ".join(line[c].replace("|", "\\|") for c in kept) + " |" for line in lines)


if __name__ == "__main__":
    import sys

    from deixis.ontology.tbox import tbox_turtle

    sys.stdout.buffer.write(term_document(tbox_turtle()).encode("utf-8"))
