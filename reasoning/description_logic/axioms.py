"""Split the triples of an ontology into axioms: groups of triples that have a meaning only together.

Source: OWL 2 Web Ontology Language Mapping to RDF Graphs (second edition). Class expressions, lists and negative
assertions are written with blank nodes, whose triples belong to the axiom that refers to them. Declarations and
annotations imply nothing, and are kept separately.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from deixis.reasoning.description_logic.terms import (
    ANNOTATION_PROPERTY,
    CLASS,
    DATATYPE_PROPERTY,
    DIFFERENT_FROM,
    FIRST,
    IMPORTS,
    NAMED_INDIVIDUAL,
    NOTHING,
    OBJECT_PROPERTY,
    ONTOLOGY,
    PREFIXES,
    REST,
    SAME_AS,
    THING,
    TYPE,
    Triple,
    is_blank,
    is_literal,
    term,
)

_BUILT_IN = tuple(f"<{base}" for base in PREFIXES.values())
_ANNOTATIONS = {term(f"rdfs:{name}") for name in ("label", "comment", "seeAlso", "isDefinedBy")} | {
    term(f"owl:{name}")
    for name in (
        "versionInfo", "versionIRI", "priorVersion", "backwardCompatibleWith", "incompatibleWith", "deprecated",
        "annotatedSource", "annotatedProperty", "annotatedTarget",
    )
}  # fmt: skip
_CLASSES = {CLASS, term("rdfs:Class"), term("rdfs:Datatype")}
_OBJECT_PROPERTIES = {OBJECT_PROPERTY} | {
    term(f"owl:{name}Property")
    for name in ("Transitive", "Symmetric", "Asymmetric", "Reflexive", "Irreflexive", "InverseFunctional")
}
_TERMS = {*_CLASSES, *_OBJECT_PROPERTIES, DATATYPE_PROPERTY}
_SYNTAX = (f"<{PREFIXES['owl']}", f"<{PREFIXES['rdfs']}sub")
_OF_INDIVIDUALS = (THING, NOTHING, NAMED_INDIVIDUAL)
_DECLARING = {
    *_CLASSES, OBJECT_PROPERTY, DATATYPE_PROPERTY, ANNOTATION_PROPERTY, NAMED_INDIVIDUAL, term("rdf:Property"),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Axiom:
    """The triples of one axiom: its first triple, then those of the blank nodes that it refers to."""

    triples: tuple[Triple, ...]

    @property
    def root(self) -> Triple:
        """First triple of the axiom."""
        return self.triples[0]

    @property
    def signature(self) -> frozenset[str]:
        """Names in the axiom, except those of RDF, RDFS and OWL."""
        parts = {part for triple in self.triples for part in triple}
        return frozenset(part for part in parts if not is_literal(part) and not part.startswith(_BUILT_IN))


@dataclass(frozen=True, slots=True)
class Axioms:
    """The parts of an ontology: axioms, declarations of names, and annotations."""

    axioms: tuple[Axiom, ...]
    declarations: tuple[Triple, ...]
    annotations: tuple[Triple, ...]


def split_axioms(triples: Iterable[Triple]) -> Axioms:
    """Return the axioms of some triples, in their order.

    ``owl:imports`` is dropped, so that no import is followed. A property that relates individuals without a declaration
    is declared, since a description-logic reasoner would treat it as an annotation property.

    Parameters
    ----------
    triples
        Triples of an ontology.

    Returns
    -------
    Axioms
        The axioms, the declarations, and the annotations.
    """
    triples = list(dict.fromkeys(triples))
    about: dict[str, list[Triple]] = defaultdict(list)
    for triple in triples:
        about[triple.subject].append(triple)
    kinds = _NameKinds(triples)
    # blank nodes that are part of the syntax of an axiom, not individuals
    structural = {
        node
        for node, triples_of_node in about.items()
        if is_blank(node)
        and any(
            triple.predicate in (FIRST, REST)
            or (triple.predicate.startswith(_SYNTAX) and triple.predicate not in (SAME_AS, DIFFERENT_FROM))
            or (
                triple.predicate == TYPE
                and triple.object.startswith(_BUILT_IN)
                and triple.object not in _OF_INDIVIDUALS
            )
            for triple in triples_of_node
        )
    }
    led_to = {triple.object for triple in triples if triple.object in structural}
    axioms, declarations, annotations = [], [], []
    for triple in triples:
        if kinds.is_declaration(triple):
            if triple.subject not in structural:
                declarations.append(triple)
        elif kinds.is_annotation(triple):
            annotations.append(triple)
        elif triple.subject not in structural and triple.predicate != IMPORTS:
            axioms.append(Axiom((triple, *_expression(triple.object, about, structural))))
    for node in about:
        if node in structural and node not in led_to and _stands_alone(about[node]):
            found = _expression(node, about, structural)
            root = found[0].subject
            typed_first = sorted(found, key=lambda triple: (triple.subject != root, triple.predicate != TYPE))
            axioms.append(Axiom(tuple(typed_first)))
    return Axioms(tuple(axioms), (*declarations, *kinds.implied()), tuple(annotations))


class _NameKinds:
    """The kinds of the names in an ontology."""

    def __init__(self, triples: list[Triple]) -> None:
        typed: dict[str, set[str]] = defaultdict(set)
        for triple in triples:
            if triple.predicate == TYPE:
                typed[triple.subject].add(triple.object)
        self._typed = typed
        self._triples = triples

    def _any(self, name: str, kinds: set[str]) -> bool:
        return not kinds.isdisjoint(self._typed.get(name, ()))

    def is_declaration(self, triple: Triple) -> bool:
        return triple.predicate == TYPE and triple.object in _DECLARING

    def is_annotation(self, triple: Triple) -> bool:
        subject, predicate, obj = triple
        return (
            predicate in _ANNOTATIONS
            or self._any(predicate, {ANNOTATION_PROPERTY})
            or self._any(subject, {ONTOLOGY, ANNOTATION_PROPERTY, term("owl:Axiom"), term("owl:Annotation")})
            or (predicate == TYPE and obj == ONTOLOGY)
            or (self._undeclared(predicate) and self._any(subject, _TERMS))
        )

    def _undeclared(self, predicate: str) -> bool:
        return not predicate.startswith(_BUILT_IN) and not self._any(
            predicate, {*_OBJECT_PROPERTIES, DATATYPE_PROPERTY, ANNOTATION_PROPERTY}
        )

    def implied(self) -> list[Triple]:
        """Return declarations of the properties that are used but not declared."""
        used = {
            (triple.predicate, DATATYPE_PROPERTY if is_literal(triple.object) else OBJECT_PROPERTY): None
            for triple in self._triples
            if self._undeclared(triple.predicate) and not self.is_annotation(triple)
        }
        return [Triple(predicate, TYPE, kind) for predicate, kind in used]


def _stands_alone(triples_of_node: list[Triple]) -> bool:
    """Return whether an unreferenced blank node is an axiom: a member set, a negative assertion or a general axiom."""
    predicates = {triple.predicate for triple in triples_of_node}
    alone = {term(f"owl:{name}") for name in ("members", "distinctMembers", "sourceIndividual", "disjointWith")}
    return not predicates.isdisjoint({*alone, term("rdfs:subClassOf"), term("owl:equivalentClass")})


def _expression(node: str, about: dict[str, list[Triple]], structural: set[str]) -> list[Triple]:
    """Return the triples of a blank node and of the blank nodes that it refers to."""
    found: list[Triple] = []
    todo, seen = [node], {node}
    while todo:
        node = todo.pop()
        if node not in structural:
            continue
        found += about[node]
        for triple in reversed(about[node]):
            if triple.object not in seen:
                seen.add(triple.object)
                todo.append(triple.object)
    return found
