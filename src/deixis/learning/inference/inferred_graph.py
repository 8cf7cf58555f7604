"""Content of the inferred graph: what follows from learned and asserted triples without being stated.

These are the broader classes of each class, the broader classes of each thing, the wide relations of pairs that follow
from exact ones, and what each layout implies (:mod:`deixis.learning.inference.implied_statements`). After a change only
some triples are looked at again: those about the classes in the change and the classes above and below them, about the
things whose kinds change, about the pairs that the change relates, and about the layouts in it. Nothing else can
change. Lessons use a part of OWL in which subsumption needs no reasoner
(:mod:`deixis.reasoning.description_logic.subsumption`). In a memory with other axioms HermiT classifies everything, as
``deixis reason`` does on demand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

import pyoxigraph as ox

from deixis.learning.inference.implied_statements import changed_layouts, of_all_layouts
from deixis.memory.semantic.rdf.after import After, Node
from deixis.memory.semantic.rdf.change import Change, reconcluding
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.ontology.rdf.triples import GENID, iri, learned_iri, text, with_blank_nodes
from deixis.ontology.rdf.vocabulary import PROV, W3C
from deixis.ontology.relations.relation import Reading, Relations
from deixis.reasoning.description_logic.reasoners import Classification, classify
from deixis.reasoning.description_logic.subsumption import (
    BEYOND,
    BeyondLessonsError,
    ClassAxioms,
    PropertyEnds,
    Subsumption,
)
from deixis.reasoning.errors import InconsistencyError

ENGINES = {
    "Deixis": "broader classes, kinds of things, wide relations of pairs from exact ones, and implications of layouts"
}
"""Engines that compute the inferred graph, and what each infers."""

OWL, RDFS = "http://www.w3.org/2002/07/owl#", "http://www.w3.org/2000/01/rdf-schema#"
RDF = "http://www.w3.org/1999/02/22-rdf-syntax-ns#"

TYPE, SUB_CLASS_OF = iri(W3C.RDF_TYPE), iri(W3C.RDFS_SUB_CLASS_OF)
SUB_PROPERTY_OF, DOMAIN, RANGE = (iri(RDFS + name) for name in ("subPropertyOf", "domain", "range"))
INVERSE_OF, MEMBERS, DISJOINT_WITH = (iri(OWL + name) for name in ("inverseOf", "members", "disjointWith"))
ON_PROPERTY, SOME_VALUES_FROM = iri(OWL + "onProperty"), iri(OWL + "someValuesFrom")

CLASSES = (GraphName.ONTOLOGY, GraphName.LEARNED)
"""Graphs that hold class axioms."""

STATED = (GraphName.LEARNED, GraphName.ASSERTED)
"""Graphs whose triples are stated, so that they are not inferred again."""


def following(after: After, relations: Relations) -> Change:
    """Return the change of the inferred graph that a change of the other graphs requires.

    Parameters
    ----------
    after
        The store after the change; its inferred graph fits its content before the change.
    relations
        Relations of the ontology.

    Returns
    -------
    Change
        Triples to add and to remove.

    Raises
    ------
    InconsistencyError
        If a class becomes unsatisfiable.
    BeyondLessonsError
        If the class axioms are not of the form that lessons write.
    """
    statements = _Said(after, relations)
    statements.require_lessons_only(after.change.added)
    gone: set[ox.Triple] = set()
    come: set[ox.Triple] = set()

    def replace(old: Iterable[ox.Triple], new: set[ox.Triple]) -> None:
        was = set(old)
        gone.update(was - new)
        come.update(new - was)

    changed = [
        triple
        for side in (after.change.added, after.change.removed)
        for name in STATED
        for triple in side.get(name, ())
    ]
    classes = {
        _value(t.subject) for t in changed if t.predicate == SUB_CLASS_OF and not _value(t.subject).startswith(GENID)
    }
    module = statements.module(classes)
    statements.require_satisfiable(module)
    for name in module:
        replace(after.triples(GraphName.INFERRED, iri(name), SUB_CLASS_OF), statements.class_triples(name))
    things = {t.subject for t in changed if t.predicate == TYPE}
    reclassified = {*map(iri, classes), *(t.subject for t in (*gone, *come))}
    things |= {t.subject for kind in reclassified for t in after.triples(GraphName.ASSERTED, None, TYPE, kind)}
    for thing in things:
        replace(after.triples(GraphName.INFERRED, thing, TYPE), statements.types(thing))
    for subject, object in {(t.subject, t.object) for t in changed if t.predicate in statements.wider}:
        old = after.triples(GraphName.INFERRED, subject, None, object)
        replace((t for t in old if t.predicate not in (TYPE, SUB_CLASS_OF)), statements.wide(subject, object))
    replace(*changed_layouts(after, relations))
    for name in STATED:
        gone |= {t for t in after.change.added.get(name, ()) if after.holds(GraphName.INFERRED, t)}
    return reconcluding(gone - come, come - gone)


def everything_that_follows(after: After, relations: Relations) -> set[ox.Triple]:
    """Return the inferred graph of a store, computed from scratch.

    Parameters
    ----------
    after
        The store after the change.
    relations
        Relations of the ontology.

    Returns
    -------
    set of ox.Triple
        Triples of the inferred graph.

    Raises
    ------
    InconsistencyError
        If a class is unsatisfiable.
    BeyondLessonsError
        If the class axioms are not of the form that lessons write.
    """
    statements = _Said(after, relations)
    statements.require_lessons_only({name: after.triples(name) for name in CLASSES})
    names = {_value(t.subject) for name in CLASSES for t in after.triples(name, None, SUB_CLASS_OF)}
    statements.require_satisfiable(names)
    found = {triple for name in names for triple in statements.class_triples(name)}
    return found | statements.of_things() | of_all_layouts(after, relations) | set(origin())


def everything_by_hermit(after: After, relations: Relations) -> set[ox.Triple]:
    """Return the inferred graph of a store with any class axioms, classified by HermiT.

    Parameters
    ----------
    after
        The store after the change.
    relations
        Relations of the ontology.

    Returns
    -------
    set of ox.Triple
        Triples of the inferred graph.

    Raises
    ------
    InconsistencyError
        If a class is unsatisfiable.
    """
    learned = list(after.triples(GraphName.LEARNED))
    axioms = with_blank_nodes([*after.triples(GraphName.ONTOLOGY), *class_axioms(learned)])
    text = (ox.serialize(axioms, format=ox.RdfFormat.N_TRIPLES) or b"").decode("utf-8")
    classified = _classified("".join(sorted(text.splitlines(keepends=True))))
    if classified.unsatisfiable:
        raise impossible(classified.unsatisfiable)
    quads = ox.parse(classified.inferred, format=ox.RdfFormat.N_TRIPLES)
    statements = _Said(after, relations, {quad.triple for quad in quads})
    found = {triple for triple in statements.classified or () if not statements.stated(triple)}
    return (
        found
        | statements.of_things()
        | of_all_layouts(after, relations)
        | set(origin({**ENGINES, "HermiT": "broader classes"}))
    )


def impossible(classes: Iterable[str]) -> InconsistencyError:
    """Return the error for classes that cannot have instances.

    Parameters
    ----------
    classes
        IRIs of the classes.

    Returns
    -------
    InconsistencyError
        The error, which is not raised.
    """
    listed = ", ".join(name.rsplit("/", 1)[-1] for name in sorted(classes))
    return InconsistencyError(
        f"no instance of '{listed}' is possible: an earlier lesson declares it to be of another kind; "
        "forget that lesson, or declare the same kind in both scripts"
    )


def class_axioms(learned: list[ox.Triple]) -> list[ox.Triple]:
    """Return the class axioms among learned triples, without roles, statements and matches.

    Parameters
    ----------
    learned
        Triples of the learned graph.

    Returns
    -------
    list of ox.Triple
        The class axioms.
    """
    classes = {t.subject for t in learned if t.predicate == TYPE and _value(t.object) == W3C.OWL_CLASS}
    return [t for t in learned if t.subject in classes or _value(t.subject).startswith(GENID)]


@lru_cache(maxsize=4)
def _classified(axioms: str) -> Classification:
    """Classify class axioms with HermiT, which takes a second."""
    return classify(axioms)


class _Said:
    """The stated triples after a change, as the rules read them; ``classified`` are HermiT's triples, if it was run."""

    def __init__(self, after: After, relations: Relations, classified: set[ox.Triple] | None = None) -> None:
        self._after, self.classified = after, classified
        self.wider = {
            iri(relation.iri): [iri(relations[broader].iri) for broader in relation.broader]
            for relation in relations.of_reading(Reading.EXACT)
        }
        self._subsumption = Subsumption(_Told(after), *_schema(after))
        self._by_hermit: dict[str, set[str]] = {}
        for triple in classified or ():
            if triple.predicate == SUB_CLASS_OF:
                self._by_hermit.setdefault(_value(triple.subject), set()).add(_value(triple.object))

    def stated(self, triple: ox.Triple) -> bool:
        return any(self._after.holds(name, triple) for name in STATED)

    def require_lessons_only(self, triples: Mapping[GraphName, Iterable[ox.Triple]]) -> None:
        """Raise BeyondLessonsError where class axioms are not of the form that lessons write; ``triples`` are new."""
        for predicate in map(iri, BEYOND):
            for name in CLASSES:
                if any(True for _ in self._after.triples(name, None, predicate)):
                    raise BeyondLessonsError(f"the {name} graph uses <{predicate.value}>")
        for name in CLASSES:
            for triple in triples.get(name, ()):
                if triple.predicate == SUB_CLASS_OF and _value(triple.subject).startswith(GENID):
                    raise BeyondLessonsError(f"the {name} graph has a super-class of <{_value(triple.subject)}>")

    def module(self, classes: set[str]) -> set[str]:
        """Return some classes with all above and below them: the classes whose super-classes can have changed."""
        module = classes.union(*(self._broader(name) for name in classes))
        todo = list(classes)
        while todo:
            name = iri(todo.pop())
            for graph in CLASSES:
                below = {_value(t.subject) for t in self._after.triples(graph, None, SUB_CLASS_OF, name)}
                new = {name for name in below if not name.startswith(GENID)} - module
                module |= new
                todo += new
        return module

    def require_satisfiable(self, names: Iterable[str]) -> None:
        wrong = [name for name in names if not self._subsumption.satisfiable(name)]
        if wrong:
            raise impossible(wrong)

    def class_triples(self, name: str) -> set[ox.Triple]:
        """Return the triples that follow about a class and are not stated."""
        found = (ox.Triple(iri(name), SUB_CLASS_OF, iri(other)) for other in self._broader(name))
        return {t for t in found if not self.stated(t) and not self._after.holds(GraphName.ONTOLOGY, t)}

    def types(self, thing: ox.NamedNode | ox.BlankNode | ox.Triple) -> set[ox.Triple]:
        """Return the broader classes of the stated classes of a thing, as triples."""
        kinds = {_value(t.object) for t in self._after.triples(GraphName.ASSERTED, thing, TYPE)}
        broader = set[str]().union(*map(self._broader_of_kind, kinds)) - kinds
        found = (ox.Triple(thing, TYPE, iri(kind)) for kind in broader)
        return {triple for triple in found if not self.stated(triple)}

    def wide(self, subject: ox.NamedNode | ox.BlankNode | ox.Triple, object: Node) -> set[ox.Triple]:
        """Return the wide relations of a pair that follow from its exact ones."""
        exact = (t.predicate for t in self._after.triples(GraphName.ASSERTED, subject, None, object))
        found = {ox.Triple(subject, wide, object) for name in exact for wide in self.wider.get(name, ())}
        return {triple for triple in found if not self.stated(triple)}

    def of_things(self) -> set[ox.Triple]:
        """Return the triples that follow about all things and pairs."""
        asserted = list(self._after.triples(GraphName.ASSERTED))
        things = {triple.subject for triple in asserted if triple.predicate == TYPE}
        pairs = {(t.subject, t.object) for t in asserted if t.predicate in self.wider}
        return {t for thing in things for t in self.types(thing)} | {t for pair in pairs for t in self.wide(*pair)}

    def _broader(self, name: str) -> frozenset[str]:
        return self._subsumption.broader(name)

    def _broader_of_kind(self, kind: str) -> set[str]:
        """Return the classes above a kind, without those that follow from the ontology only."""
        found = set(self._broader(kind)) if self.classified is None else self._by_hermit.get(kind, set())
        broader = {
            name: {_value(t.object) for t in self._after.triples(name, iri(kind), SUB_CLASS_OF)} for name in CLASSES
        }
        learned = {value for value in broader[GraphName.LEARNED] if not value.startswith(GENID)}
        return (found - broader[GraphName.ONTOLOGY]) | learned


@dataclass(frozen=True)
class _Told:
    """Lookup of what the ontology and the lessons state about a class.

    It does not refer to its user, so that no reference cycle keeps a store open.
    """

    after: After

    def __call__(self, name: str) -> ClassAxioms:
        broader: set[str] = set()
        shows: set[tuple[str, str]] = set()
        for graph in CLASSES:
            for triple in self.after.triples(graph, iri(name), SUB_CLASS_OF):
                value = _value(triple.object)
                if value.startswith(GENID):
                    shows.add(self._restriction(triple.object))
                else:
                    broader.add(value)
        return ClassAxioms(frozenset(broader), frozenset(shows))

    def _restriction(self, node: Node) -> tuple[str, str]:
        ends = [
            {_value(t.object) for name in CLASSES for t in self.after.triples(name, node, predicate)}
            for predicate in (ON_PROPERTY, SOME_VALUES_FROM)
        ]
        if [len(end) for end in ends] != [1, 1] or any(value.startswith(GENID) for end in ends for value in end):
            raise BeyondLessonsError(f"<{_value(node)}> is not a restriction owl:someValuesFrom of one property")
        return ends[0].pop(), ends[1].pop()


def _schema(after: After) -> tuple[Callable[[str], PropertyEnds], list[frozenset[str]]]:
    """Return the lookup of domains and ranges of properties, and the groups of disjoint classes."""

    def pairs(predicate: ox.NamedNode) -> list[tuple[str, str]]:
        found = (t for name in CLASSES for t in after.triples(name, None, predicate))
        return [(_value(triple.subject), _value(triple.object)) for triple in found]

    groups = [frozenset(pair) for pair in pairs(DISJOINT_WITH)]
    for name in CLASSES:
        for triple in after.triples(name, None, TYPE, iri(OWL + "AllDisjointClasses")):
            heads = [t.object for t in after.triples(name, triple.subject, MEMBERS)]
            groups += [frozenset(_list(after, name, head)) for head in heads]
    inverses, broader = pairs(INVERSE_OF), pairs(SUB_PROPERTY_OF)
    inverses += [(other, one) for one, other in inverses]
    domains, ranges = pairs(DOMAIN), pairs(RANGE)

    def ends(name: str) -> PropertyEnds:
        forwards, backwards, size = {name}, set[str](), 0
        while size < len(forwards) + len(backwards):  # super-properties, and inverses as often as there are any
            size = len(forwards) + len(backwards)
            forwards |= {high for low, high in broader if low in forwards} | {o for p, o in inverses if p in backwards}
            backwards |= {high for low, high in broader if low in backwards} | {o for p, o in inverses if p in forwards}
        here = [*(kind for p, kind in domains if p in forwards), *(kind for p, kind in ranges if p in backwards)]
        there = [*(kind for p, kind in ranges if p in forwards), *(kind for p, kind in domains if p in backwards)]
        functional = any(_is_functional(after, each) for each in forwards)
        return PropertyEnds(frozenset(here), frozenset(there), functional)

    return ends, groups


def _is_functional(after: After, name: str) -> bool:
    kind = ox.Triple(iri(name), TYPE, iri(OWL + "FunctionalProperty"))
    return any(after.holds(graph, kind) for graph in CLASSES)


def _list(after: After, name: GraphName, head: Node) -> Iterator[str]:
    while first := next(after.triples(name, head, iri(RDF + "first")), None):
        yield _value(first.object)
        rest = next(after.triples(name, head, iri(RDF + "rest")), None)
        if rest is None:
            return
        head = rest.object


def origin(engines: Mapping[str, str] = ENGINES) -> Iterator[ox.Triple]:
    """Yield the provenance of the inferred graph: its sources and its engines.

    It holds no times, so that the same facts always give the same graph.

    Parameters
    ----------
    engines
        Description by the name of each engine.

    Yields
    ------
    ox.Triple
        A triple.
    """
    graph, inference = graph_iri(GraphName.INFERRED), iri(learned_iri("inference"))
    sources = [graph_iri(name) for name in (GraphName.ONTOLOGY, GraphName.LEARNED, GraphName.ASSERTED)]
    yield ox.Triple(graph, TYPE, iri(PROV.ENTITY))
    yield ox.Triple(graph, iri(PROV.WAS_GENERATED_BY), inference)
    yield ox.Triple(inference, TYPE, iri(PROV.ACTIVITY))
    for source in sources:
        yield ox.Triple(graph, iri(PROV.WAS_DERIVED_FROM), source)
        yield ox.Triple(inference, iri(PROV.USED), source)
    for name, does in engines.items():
        agent = iri(learned_iri("agent", name))
        yield ox.Triple(inference, iri(PROV.WAS_ASSOCIATED_WITH), agent)
        yield ox.Triple(agent, TYPE, iri(PROV.SOFTWARE_AGENT))
        yield ox.Triple(agent, iri(W3C.RDFS_LABEL), text(f"{name}: {does}"))


def _value(term: object) -> str:
    return str(getattr(term, "value", ""))
