"""Parse the output of HermiT and Pellet into triples, and close the hierarchies.

Both print only the direct super-classes of each class. HermiT writes some properties as inverses of others; these are
marked by a ``^`` in front.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator

from deixis.reasoning.description_logic.terms import NOTHING, SUB_CLASS_OF, SUB_PROPERTY_OF, THING, TYPE, Triple

_HERMIT_LINE = re.compile(r"^(\w+)\( ((?:(?:ObjectInverseOf\( <[^>]+> \)|<[^>]+>)\s*)+) \)$", re.MULTILINE)
_HERMIT_NAME = re.compile(r"(ObjectInverseOf\( )?(<[^>]+>)")
_HERMIT_VALUES = re.compile(r"^(<[^>]+>) \(known instances:\s*(.*?)\s*\|", re.MULTILINE)
_HERMIT_PAIR = re.compile(r"\((<[^>]+>), (<[^>]+>)\)")
_PREDICATES = {"SubClassOf": SUB_CLASS_OF, "SubObjectPropertyOf": SUB_PROPERTY_OF, "SubDataPropertyOf": SUB_PROPERTY_OF}
_EQUIVALENTS = {
    "EquivalentClasses": SUB_CLASS_OF,
    "EquivalentObjectProperties": SUB_PROPERTY_OF,
    "EquivalentDataProperties": SUB_PROPERTY_OF,
}
_BUILT_IN_PROPERTY = re.compile(r"\^?<http://www\.w3\.org/2002/07/owl#(top|bottom)(Object|Data)Property>")


def hermit_facts(text: str) -> Iterator[Triple]:
    """Yield direct super-classes and types, equivalences as super-classes of each other, and property values.

    Parameters
    ----------
    text
        Output of HermiT in functional syntax.

    Yields
    ------
    Triple
        A fact as HermiT states it, before transitive closure.

    Examples
    --------
    >>> [str(fact) for fact in hermit_facts("Type( <urn:f> <urn:Fork> )")]
    ['<urn:f> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <urn:Fork> .']
    """
    for word, listed in _HERMIT_LINE.findall(text):
        names = [f"^{name}" if inverse else name for inverse, name in _HERMIT_NAME.findall(listed)]
        if word == "Type":
            yield Triple(names[0], TYPE, names[1])
        elif word in _PREDICATES:
            yield Triple(names[0], _PREDICATES[word], names[1])
        elif word in _EQUIVALENTS:
            yield from _equivalent(names, _EQUIVALENTS[word])
    for predicate, pairs in _HERMIT_VALUES.findall(text):
        for subject, obj in _HERMIT_PAIR.findall(pairs):
            yield Triple(subject, predicate, obj)


def _equivalent(names: list[str], predicate: str) -> Iterator[Triple]:
    """Yield a cycle in which each name is below the next, so that each is below all."""
    for one, other in zip(names, [*names[1:], names[0]], strict=True):
        if one != other:
            yield Triple(one, predicate, other)


def pellet_facts(text: str) -> Iterator[Triple]:
    """Yield the facts in Pellet's tree, whose lines are ``class = class - (individual, …)``, indented by depth.

    Parameters
    ----------
    text
        Output of Pellet: its tree of classes.

    Yields
    ------
    Triple
        A direct super-class, the class of an individual, or a relation between individuals.
    """
    above: list[tuple[int, str]] = []
    for line in text.splitlines():
        if line.startswith("PROPINST: "):
            subject, predicate, obj = (f"<{word}>" for word in line.split()[1:4])
            yield Triple(subject, predicate, obj)
            continue
        classes, _, individuals = line.strip().partition(" - (")
        names = [f"<{name}>" for name in classes.split(" = ") if name]
        if not names:
            continue
        depth = len(line) - len(line.lstrip())
        while above and above[-1][0] >= depth:
            above.pop()
        yield from _equivalent(names, SUB_CLASS_OF)
        if above:
            yield Triple(names[0], SUB_CLASS_OF, above[-1][1])
        above.append((depth, names[0]))
        for individual in individuals[:-1].split(", ") if individuals else ():
            if not individual.endswith(("Anonymous Individual", "Anonymous Individuals")):
                yield Triple(f"<{individual}>", TYPE, names[0])


class Hierarchy:
    """Direct facts, and their closure along super-classes and super-properties."""

    def __init__(self, facts: Iterable[Triple]) -> None:
        self._classes: dict[str, set[str]] = defaultdict(set)
        self._properties: dict[str, set[str]] = defaultdict(set)
        self._types: set[tuple[str, str]] = set()
        self._values: set[Triple] = set()
        for fact in facts:
            if fact.predicate == SUB_CLASS_OF:
                self._classes[fact.subject].add(fact.object)
            elif fact.predicate == SUB_PROPERTY_OF:
                self._properties[fact.subject].add(fact.object)
                self._properties[_inverse(fact.subject)].add(_inverse(fact.object))
            elif fact.predicate == TYPE:
                self._types.add((fact.subject, fact.object))
            else:
                self._values.add(fact)

    @property
    def unsatisfiable(self) -> tuple[str, ...]:
        """IRIs of the unsatisfiable classes, sorted."""
        found = (name for name in self._classes if name != NOTHING and NOTHING in _above(name, self._classes))
        return tuple(sorted(name[1:-1] for name in found))

    def of_classes(self) -> Iterator[Triple]:
        """Yield every broader class of each class and individual; only the direct ones of an unsatisfiable class.

        Yields
        ------
        Triple
            Triple with ``rdfs:subClassOf`` or ``rdf:type``.
        """
        impossible = {f"<{iri}>" for iri in self.unsatisfiable}
        for name in set(self._classes) - {THING, NOTHING}:
            # an unsatisfiable class is a subclass of all classes, which is not informative
            above = self._classes[name] - impossible if name in impossible else _above(name, self._classes)
            yield from (Triple(name, SUB_CLASS_OF, other) for other in above - {name, THING, NOTHING})
        for individual, kind in self._types:
            above = {kind, *_above(kind, self._classes)}
            yield from (Triple(individual, TYPE, other) for other in above - {THING, NOTHING})

    def of_properties(self) -> Iterator[Triple]:
        """Yield every broader property of each property, and the relations between individuals.

        Yields
        ------
        Triple
            Triple with ``rdfs:subPropertyOf`` or a property of the ontology.
        """
        broader = {name: _named(_above(name, self._properties)) for name in list(self._properties)}
        for name in _named(broader):
            yield from (Triple(name, SUB_PROPERTY_OF, other) for other in broader[name] - {name})
        for subject, predicate, obj in self._values:
            # HermiT lists the values of a property only for the property of the assertion
            yield from (Triple(subject, name, obj) for name in _named({predicate, *broader.get(predicate, ())}))
            yield from (Triple(obj, name, subject) for name in _named(broader.get(_inverse(predicate), ())))


def _inverse(name: str) -> str:
    return name[1:] if name.startswith("^") else f"^{name}"


def _named(names: Iterable[str]) -> set[str]:
    return {name for name in names if not name.startswith("^") and not _BUILT_IN_PROPERTY.fullmatch(name)}


def _above(name: str, broader: dict[str, set[str]]) -> set[str]:
    seen: set[str] = set()
    todo = [name]
    while todo:
        new = broader.get(todo.pop(), set()) - seen
        seen |= new
        todo += new
    return seen
