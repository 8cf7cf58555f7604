"""Implications of learned layouts as triples: relations between roles, and why they hold.

A layout's firm facts, and what follows from them, relate its roles directly (``role dx:left role``), so that a query
needs no rules. Each relation that is not stated is also a ``dx:ImpliedStatement`` with the last rule of its shortest
derivation (``dx:rule``) and the stated facts that it rests on (``prov:wasDerivedFrom``). These triples are part of the
inferred graph. They depend on one layout only, so the cost of a lesson does not depend on the other lessons. A layout
that implies much is left out when it is learned; the first query about implications adds what it implies
(:func:`completion`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import pyoxigraph as ox

from deixis.deadline import Deadline
from deixis.errors import DeixisError
from deixis.memory.semantic.rdf.after import After
from deixis.memory.semantic.rdf.change import Change, reconcluding
from deixis.memory.semantic.rdf.graphs import GraphName
from deixis.ontology.lessons.read import layouts
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.lessons.write import fact_iri, layout_iri, role_iri
from deixis.ontology.rdf.triples import iri, learned_iri, typed
from deixis.ontology.rdf.vocabulary import BASE, DX, PROV, W3C
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.implications import Implications

MAX_IMPLIED = 1000
"""Maximum number of implied statements of a layout that are stored when it is learned; a layout with more stores
none."""

MAX_ON_DEMAND = 250_000
"""Maximum number of triples about one layout that a query adds."""

RULES = {
    Rule.INVERSE: iri(BASE + "inversion"),
    Rule.SUB_PROPERTY: iri(BASE + "subPropertyRule"),
    Rule.TRANSITIVITY: iri(BASE + "transitivity"),
    Rule.COMPOSITION: iri(BASE + "composition"),
    Rule.CONJUNCTION: iri(BASE + "conjunction"),
    Rule.MEANING: iri(BASE + "entailmentOfMeaning"),
}
"""Terms of the ontology for the rules of derivations without cases."""

TYPE, IN_LAYOUT, SUB_CLASS_OF = iri(W3C.RDF_TYPE), iri(DX.IN_LAYOUT), iri(W3C.RDFS_SUB_CLASS_OF)
LAYOUT, IMPLIED = iri(DX.LAYOUT), iri(DX.IMPLIED_STATEMENT)
SUBJECT, RELATION, OBJECT, RULE = iri(DX.SUBJECT), iri(DX.RELATION), iri(DX.OBJECT), iri(DX.RULE)
DERIVED, STORED = iri(PROV.WAS_DERIVED_FROM), iri(DX.IMPLICATIONS_STORED)


def implied_triples(layout: LayoutConcept, relations: Relations, most: float | None = None) -> Iterator[ox.Triple]:
    """Yield the relations between the roles of a layout that it states or implies, and the implied statements.

    What follows only by cases, from facts with alternatives or from denials, takes a search, and is left out.

    Parameters
    ----------
    layout
        The layout.
    relations
        Relations of the ontology.
    most
        Number of implied statements above which none is yielded; default: :data:`MAX_IMPLIED`.

    Yields
    ------
    ox.Triple
        A triple of the inferred graph.
    """
    try:
        implications = Implications(layout.graph(relations), cases=False)
    except DeixisError:  # an imported layout whose facts are not about its roles
        return
    few = implications.unstated() <= (MAX_IMPLIED if most is None else most)
    yield ox.Triple(iri(layout_iri(layout.lesson)), STORED, typed(few and not implications.demands.choices))
    if not few:
        return
    roles = {role.name: iri(role_iri(layout.lesson, role.name)) for role in layout.roles}
    for relation, subject, other in implications.triples():
        yield ox.Triple(roles[subject], iri(relation.iri), roles[other])
    about_layout = iri(layout_iri(layout.lesson))
    for number, fact in enumerate(implications.implied(), 1):
        support = implications.support(fact)
        statement = iri(learned_iri("layout", layout.lesson, "implied", number))
        yield ox.Triple(statement, TYPE, IMPLIED)
        yield ox.Triple(statement, IN_LAYOUT, about_layout)
        yield ox.Triple(statement, SUBJECT, roles[fact.subject])
        yield ox.Triple(statement, RELATION, iri(fact.relations[0].iri))
        yield ox.Triple(statement, OBJECT, roles[fact.object])
        yield ox.Triple(statement, RULE, RULES[support.rule])
        for edge in support.edges:
            yield ox.Triple(statement, DERIVED, iri(fact_iri(layout.lesson, edge + 1)))


def of_layouts(after: After, nodes: Iterable[object], relations: Relations) -> set[ox.Triple]:
    """Return the implications of some layouts, as they are after a change.

    Parameters
    ----------
    after
        The store after the change.
    nodes
        IRIs of the layouts.
    relations
        Relations of the ontology.

    Returns
    -------
    set of ox.Triple
        Triples of the inferred graph.
    """
    found: set[ox.Triple] = set()
    for node in nodes:
        assert isinstance(node, ox.NamedNode)
        whole = any(after.triples(GraphName.INFERRED, node, STORED, typed(True)))  # a query may have completed it
        for layout in _learned_layouts(after, node, relations):
            found.update(implied_triples(layout, relations, math.inf if whole else None))
    return found


def _learned_layouts(
    after: After, node: ox.NamedNode | ox.BlankNode | ox.Triple, relations: Relations
) -> tuple[LayoutConcept, ...]:
    """Return the layout of a node, from the learned triples about the node and its parts."""
    parts = [t.subject for t in after.triples(GraphName.LEARNED, None, IN_LAYOUT, node)]
    return layouts([t for part in (node, *parts) for t in after.triples(GraphName.LEARNED, part)], relations)


def completion(after: After, relations: Relations, deadline: Deadline) -> Change:
    """Return the change that adds the implications of the layouts that were left out when they were learned.

    Layouts with more than :data:`MAX_ON_DEMAND` triples, those with alternatives or denials, and those for which no
    time is left stay as they are.

    Parameters
    ----------
    after
        The store.
    relations
        Relations of the ontology.
    deadline
        Time limit.

    Returns
    -------
    Change
        Change of the inferred graph; empty if there is nothing to add.
    """
    gone: set[ox.Triple] = set()
    come: set[ox.Triple] = set()
    for marked in list(after.triples(GraphName.INFERRED, None, STORED, typed(False))):
        node = marked.subject
        for layout in _learned_layouts(after, node, relations):
            added: list[ox.Triple] = []
            for triple in implied_triples(layout, relations, math.inf):
                added.append(triple)
                if triple.predicate == STORED and triple == marked:  # alternatives or denials
                    break
                if len(added) > MAX_ON_DEMAND or deadline.passed:
                    break
            else:
                gone.add(marked)
                come.update(added)
    return reconcluding(gone, come)


def of_all_layouts(after: After, relations: Relations) -> set[ox.Triple]:
    """Return the implications of all layouts after a change.

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
    """
    return of_layouts(
        after, {t.subject for t in after.triples(GraphName.LEARNED, None, SUB_CLASS_OF, LAYOUT)}, relations
    )


def changed_layouts(after: After, relations: Relations) -> tuple[set[ox.Triple], set[ox.Triple]]:
    """Return the inferred triples about the layouts that a change touches: as they are stored, and as they become.

    Parameters
    ----------
    after
        The store after the change.
    relations
        Relations of the ontology.

    Returns
    -------
    tuple
        Triples before and after the change.
    """
    sides = (after.change.added, after.change.removed)
    changed = [t for side in sides for t in side.get(GraphName.LEARNED, ())]
    parts = {t.subject for t in changed if t.predicate == IN_LAYOUT}
    touched = {t.object for t in changed if t.predicate == IN_LAYOUT}
    touched |= {t.subject for t in changed if t.predicate == SUB_CLASS_OF and t.object == LAYOUT}
    old: set[ox.Triple] = set()
    for node in touched:
        old.update(after.triples(GraphName.INFERRED, node, STORED))
        parts |= {t.subject for t in after.triples(GraphName.LEARNED, None, IN_LAYOUT, node)}
        parts |= {t.subject for t in after.triples(GraphName.INFERRED, None, IN_LAYOUT, node)}
    for part in parts:
        old.update(after.triples(GraphName.INFERRED, part))
    return old, of_layouts(after, touched, relations)
