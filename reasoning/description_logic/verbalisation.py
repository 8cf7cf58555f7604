"""Put axioms and statements into plain English, with the labels of an ontology.

>>> from deixis.reasoning.description_logic.terms import Triple
>>> from deixis.reasoning.description_logic.terms import SUB_CLASS_OF
>>> Words({"<urn:Fork>": "fork"}).triple(Triple("<urn:Fork>", SUB_CLASS_OF, "<urn:t#Cutlery>"))
'every fork is a Cutlery'
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from urllib.parse import unquote

from deixis.ontology.things.kinds import with_article
from deixis.reasoning.description_logic.axioms import Axiom
from deixis.reasoning.description_logic.terms import (
    DISTINCT_MEMBERS,
    FIRST,
    LABEL,
    MEMBERS,
    NEGATIVE_PROPERTY_ASSERTION,
    NIL,
    NOTHING,
    REST,
    SUB_CLASS_OF,
    THING,
    TYPE,
    Triple,
    is_blank,
    is_literal,
    term,
)

_STATEMENTS = {
    SUB_CLASS_OF: "every {0} is {a1}",
    term("owl:equivalentClass"): "{0} and {1} are the same",
    term("owl:disjointWith"): "{0} and {1} have nothing in common",
    term("owl:complementOf"): "whatever is not {a1} is {a0}",
    term("rdfs:subPropertyOf"): "whatever is related by '{0}' is related by '{1}'",
    term("owl:equivalentProperty"): "'{0}' and '{1}' are equivalent",
    term("owl:propertyDisjointWith"): "nothing is related by both '{0}' and '{1}'",
    term("owl:inverseOf"): "'{0}' is the inverse of '{1}'",
    term("rdfs:domain"): "whatever is '{0}' of something is {a1}",
    term("rdfs:range"): "whatever something is '{0}' of is {a1}",
    term("owl:sameAs"): "{0} and {1} are one thing",
    term("owl:differentFrom"): "{0} and {1} are two things",
    term("owl:propertyChainAxiom"): "a chain of {1} makes '{0}'",
    term("owl:hasKey"): "things that are {0} and agree in {1} are one thing",
    term("owl:unionOf"): "{0} is whatever is one of {1}",
    term("owl:intersectionOf"): "{0} is whatever is all of {1}",
    term("owl:oneOf"): "{0} is one of {1}",
}
_CHARACTERISTICS = {
    term("owl:TransitiveProperty"): "'{0}' is transitive",
    term("owl:SymmetricProperty"): "'{0}' holds both ways or not at all",
    term("owl:AsymmetricProperty"): "'{0}' never holds both ways",
    term("owl:ReflexiveProperty"): "everything is related to itself by '{0}'",
    term("owl:IrreflexiveProperty"): "nothing is related to itself by '{0}'",
    term("owl:FunctionalProperty"): "nothing is related by '{0}' to more than one thing",
    term("owl:InverseFunctionalProperty"): "no two things are related by '{0}' to the same thing",
}
_MEMBERS = {
    term("owl:AllDisjointClasses"): "nothing is more than one of {0}",
    term("owl:AllDisjointProperties"): "nothing is related by more than one of {0}",
    term("owl:AllDifferent"): "all of these are different: {0}",
}
_RESTRICTIONS = {
    term("owl:someValuesFrom"): "something that is '{p}' of some {v}",
    term("owl:allValuesFrom"): "something that is '{p}' only of {v}",
    term("owl:hasValue"): "something that is '{p}' of {v}",
    term("owl:minCardinality"): "something that is '{p}' of at least {v} things",
    term("owl:maxCardinality"): "something that is '{p}' of at most {v} things",
    term("owl:cardinality"): "something that is '{p}' of exactly {v} things",
    term("owl:minQualifiedCardinality"): "something that is '{p}' of at least {v} {c}",
    term("owl:maxQualifiedCardinality"): "something that is '{p}' of at most {v} {c}",
    term("owl:qualifiedCardinality"): "something that is '{p}' of exactly {v} {c}",
    term("owl:hasSelf"): "something that is '{p}' of itself",
}
_JOINED = {term("owl:unionOf"): " or ", term("owl:intersectionOf"): " and ", term("owl:oneOf"): " or "}


def labels_of(triples: Iterable[Triple]) -> dict[str, str]:
    """Return the label of each labelled term, preferably in English or without a language.

    Parameters
    ----------
    triples
        Triples of an ontology.

    Returns
    -------
    dict
        Label by term.
    """
    found: dict[str, tuple[bool, str]] = {}
    for subject, predicate, obj in triples:
        if predicate == LABEL and is_literal(obj):
            text, _, language = obj[1:].rpartition('"')
            other = language.startswith("@") and not language.startswith("@en")
            found[subject] = min(found.get(subject, (True, "\U0010ffff")), (other, text))
    return {subject: text for subject, (_, text) in found.items()}


class Words:
    """A verbaliser of axioms and statements, which uses the labels of terms."""

    def __init__(self, labels: Mapping[str, str]) -> None:
        self._labels = labels

    def axiom(self, axiom: Axiom) -> str:
        """Return an axiom in one sentence.

        Parameters
        ----------
        axiom
            Axiom with the triples of its blank nodes.

        Returns
        -------
        str
            Sentence without a full stop.
        """
        return _Sentence(self, axiom.triples).of(axiom.root)

    def triple(self, triple: Triple) -> str:
        """Return a statement in one sentence.

        Parameters
        ----------
        triple
            Statement about named resources.

        Returns
        -------
        str
            Sentence without a full stop.
        """
        return _Sentence(self, (triple,)).of(triple)

    def name(self, name: str) -> str:
        """Return the name of a term: its label, or else the last part of its IRI, or the text of a literal.

        Parameters
        ----------
        name
            Term in the syntax of N-Triples.

        Returns
        -------
        str
            The name as text.
        """
        if name in self._labels:
            return self._labels[name]
        if is_literal(name):
            return name[1:].rpartition('"')[0]
        if is_blank(name):
            return "something"
        iri = name[1:-1]
        return unquote(iri.rpartition("#" if "#" in iri else "/" if "/" in iri else ":")[2]) or iri


class _Sentence:
    """The triples of one axiom, put into words."""

    def __init__(self, words: Words, triples: Iterable[Triple]) -> None:
        self._words = words
        self._said: dict[str, dict[str, str]] = defaultdict(dict)
        for subject, predicate, obj in triples:
            self._said[subject].setdefault(predicate, obj)

    def of(self, root: Triple) -> str:
        subject, predicate, obj = root
        if is_blank(subject) and predicate == TYPE:
            objects = self._said[subject]
            if obj in _MEMBERS:
                return _MEMBERS[obj].format(
                    self._listed(objects.get(MEMBERS, objects.get(DISTINCT_MEMBERS, NIL)), ", ")
                )
            if obj == NEGATIVE_PROPERTY_ASSERTION:
                parts = (objects.get(term(f"owl:{name}"), "") for name in ("sourceIndividual", "targetIndividual"))
                source, target = (self._expression(part or objects.get(term("owl:targetValue"), NIL)) for part in parts)
                return (
                    f"not {self._words.name(objects.get(term('owl:assertionProperty'), subject))}({source}, {target})"
                )
            for predicate in _STATEMENTS:
                if predicate in objects:
                    return self._statement(subject, predicate, objects[predicate])
            return f"something is {_a(self._expression(obj))}"
        if predicate == TYPE:
            characteristic = _CHARACTERISTICS.get(obj)
            if characteristic:
                return characteristic.format(self._expression(subject))
            return f"{self._expression(subject)} is {_a(self._expression(obj))}"
        if predicate == SUB_CLASS_OF and obj == NOTHING:
            return f"nothing can be {_a(self._expression(subject))}"
        if predicate in _STATEMENTS:
            return self._statement(subject, predicate, obj)
        return f"{self._words.name(predicate)}({self._expression(subject)}, {self._expression(obj)})"

    def _statement(self, subject: str, predicate: str, obj: str) -> str:
        first, second = self._expression(subject), self._expression(obj)
        return _STATEMENTS[predicate].format(first, second, a0=_a(first), a1=_a(second))

    def _expression(self, node: str) -> str:
        """Return a class expression, a list, or a name."""
        objects = self._said.get(node, {}) if is_blank(node) else {}
        if FIRST in objects:
            return self._listed(node, ", ")
        if term("owl:onProperty") in objects:
            prop = self._expression(objects[term("owl:onProperty")])
            kind = self._expression(objects.get(term("owl:onClass"), objects.get(term("owl:onDataRange"), THING)))
            for predicate, form in _RESTRICTIONS.items():
                if predicate in objects:
                    return form.format(p=prop, v=self._expression(objects[predicate]), c=kind)
            return f"something with '{prop}'"
        if term("owl:complementOf") in objects:
            return f"something that is not {_a(self._expression(objects[term('owl:complementOf')]))}"
        if term("owl:inverseOf") in objects:
            return f"the inverse of {self._expression(objects[term('owl:inverseOf')])}"
        for predicate, between in _JOINED.items():
            if predicate in objects:
                return f"({self._listed(objects[predicate], between)})"
        return {THING: "thing", NOTHING: "nothing"}.get(node) or self._words.name(node)

    def _listed(self, head: str, between: str) -> str:
        members, seen = [], set()
        while head in self._said and head not in seen:
            seen.add(head)
            members.append(self._expression(self._said[head].get(FIRST, NIL)))
            head = self._said[head].get(REST, NIL)
        return between.join(members)


def _a(name: str) -> str:
    """Return the name of a class with its article; other expressions as they are."""
    return name if name.startswith(("something", "nothing", "(")) else with_article(name)
