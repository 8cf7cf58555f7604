"""What a graph implies, against forward chaining over the TBox's own triples; derivations step by step."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from rdflib import OWL, RDF, RDFS, Graph, URIRef

import deixis.reasoning.closure as module
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.ontology.tbox import TBOX_FILE, default_ontology
from deixis.reasoning.conflict import find_conflict
from deixis.reasoning.errors import LimitError
from deixis.reasoning.implications import Derivation, Implications, Rule

MakeGraph = Callable[..., RelationGraph]
Triple = tuple[str, str, str]
NODES = "abcde"
R = default_ontology().relations

facts = st.lists(
    st.tuples(st.sampled_from(list(R)), st.sampled_from(NODES), st.sampled_from(NODES)).filter(lambda t: t[1] != t[2]),
    max_size=7,
)


@cache
def axioms() -> tuple[dict[str, set[str]], dict[str, str], set[str]]:
    """Direct super-properties, inverses and transitive properties, by relation name, read with rdflib."""
    tbox = Graph().parse(TBOX_FILE, format="turtle")
    by_iri = {relation.iri: relation.name for relation in R.values()}

    def name(node: object) -> str:
        return by_iri[str(node)]

    relations = [URIRef(iri) for iri in by_iri]
    broader = {name(p): {name(q) for q in tbox.objects(p, RDFS.subPropertyOf) if str(q) in by_iri} for p in relations}
    inverse = {name(p): name(q) for p, q in tbox.subject_objects(OWL.inverseOf) if str(p) in by_iri}
    transitive = {name(p) for p in tbox.subjects(RDF.type, OWL.TransitiveProperty)}
    return broader, inverse, transitive


def closure(stated: set[Triple], sub_properties: bool = True) -> set[Triple]:
    """Forward chaining until nothing is new."""
    broader, inverse, transitive = axioms()
    known: set[Triple] = set()
    new = set(stated)
    while new:
        known |= new
        derived = {(inverse[r], o, s) for r, s, o in known}
        if sub_properties:
            derived |= {(q, s, o) for r, s, o in known for q in broader[r]}
        derived |= {(r, s, o) for r, s, m in known if r in transitive for q, n, o in known if q == r and n == m}
        new = derived - known
    return known


def proper(triples: set[Triple]) -> set[Triple]:
    return {(r, s, o) for r, s, o in triples if s != o}


def implications(stated: list[Triple], sub_properties: bool = True) -> Implications:
    listed = [Fact(s, (R[r],), o) for r, s, o in stated]
    return Implications(RelationGraph.from_facts(R, list(NODES), listed), sub_properties)


def named(implied: Implications) -> set[Triple]:
    return {(relation.name, s, o) for relation, s, o in implied.triples()}


@pytest.mark.parametrize("sub_properties", [True, False])
@settings(max_examples=80, deadline=None)
@given(stated=facts)
def test_what_is_implied_is_the_fixpoint_of_forward_chaining(stated: list[Triple], sub_properties: bool) -> None:
    implied = implications(stated, sub_properties)
    assert named(implied) == proper(closure(set(stated), sub_properties))


@settings(max_examples=40, deadline=None)
@given(stated=facts)
def test_holds_and_derive_agree_with_what_is_implied(stated: list[Triple]) -> None:
    implied = implications(stated)
    known = named(implied)
    for relation in R.values():
        for s in NODES:
            for o in NODES:
                expected = (relation.name, s, o) in known
                assert implied.holds(relation, s, o) == expected
                assert (implied.derive(relation, s, o) is not None) == expected


@settings(max_examples=40, deadline=None)
@given(st.sets(st.tuples(st.sampled_from(NODES), st.sampled_from(NODES)).filter(lambda p: p[0] != p[1]), max_size=8))
def test_one_transitive_relation_is_closed_as_networkx_closes_it(pairs: set[tuple[str, str]]) -> None:
    implied = implications([("left", s, o) for s, o in sorted(pairs)])
    expected = nx.transitive_closure(nx.DiGraph(sorted(pairs)), reflexive=False)
    assert {(s, o) for r, s, o in named(implied) if r == "left"} == {(s, o) for s, o in expected.edges if s != o}


def check(derivation: Derivation, stated: list[Fact]) -> None:
    """Re-checks one derivation, rule by rule, down to stated facts."""
    broader, inverse, transitive = axioms()
    fact = derivation.fact
    (name,) = (relation.name for relation in fact.relations)
    premises = [premise.fact for premise in derivation.premises]
    if derivation.rule is Rule.STATED:
        assert premises == []
        assert fact in stated
    elif derivation.rule is Rule.INVERSE:
        (premise,) = premises
        assert (premise.subject, premise.object) == (fact.object, fact.subject)
        assert inverse[premise.relations[0].name] == name
    elif derivation.rule is Rule.SUB_PROPERTY:
        (premise,) = premises
        assert (premise.subject, premise.object) == (fact.subject, fact.object)
        ancestors: set[str] = set()
        todo = [premise.relations[0].name]
        while todo:
            todo += (above := broader[todo.pop()] - ancestors)
            ancestors |= above
        assert name in ancestors
    else:
        assert name in transitive
        assert len(premises) >= 2
        assert all(premise.relations == fact.relations for premise in premises)
        stops = [premises[0].subject, *(premise.object for premise in premises)]
        assert [premise.subject for premise in premises] == stops[:-1]
        assert (stops[0], stops[-1]) == (fact.subject, fact.object)
    for premise_derivation in derivation.premises:
        check(premise_derivation, stated)


@settings(max_examples=80, deadline=None)
@given(stated=facts)
def test_every_derivation_is_right_rule_by_rule_and_rests_on_stated_facts(stated: list[Triple]) -> None:
    implied = implications(stated)
    listed = list(implied.graph.facts())
    for relation, s, o in implied.triples():
        derivation = implied.derive(relation, s, o)
        assert derivation is not None
        assert str(derivation.fact) == f"{relation.name}({s}, {o})"
        check(derivation, listed)
        assert set(derivation.stated()) <= set(listed)
        assert len(set(derivation.stated())) == len(derivation.stated())


@settings(max_examples=60, deadline=None)
@given(stated=facts)
def test_every_derivation_has_as_few_steps_as_there_can_be(stated: list[Triple]) -> None:
    """One step is a stated fact, its inverse or what either is a sub-property of; networkx finds the shortest ways."""
    broader, inverse, _ = axioms()
    steps: dict[str, nx.DiGraph[str]] = {name: nx.DiGraph() for name in R}
    for r, s, o in stated:
        for name, start, end in ((r, s, o), (inverse[r], o, s)):
            todo = [name]
            while todo:
                current = todo.pop()
                steps[current].add_edge(start, end)
                todo += broader[current]
    implied = implications(stated)
    for relation, s, o in implied.triples():
        derivation = implied.derive(relation, s, o)
        assert derivation is not None
        length = len(derivation.premises) if derivation.rule is Rule.TRANSITIVITY else 1
        assert length == nx.shortest_path_length(steps[relation.name], s, o)
        if (relation.name, s, o) in stated:
            assert derivation.rule is Rule.STATED


def test_a_stated_fact_is_its_own_derivation_even_where_it_follows_too(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("right(b, a)", "left(a, b)", "left(b, c)", "left(a, c)"))
    for subject, object in (("a", "b"), ("a", "c")):
        derivation = implied.derive(implied.vocabulary["left"], subject, object)
        assert derivation is not None
        assert derivation.rule is Rule.STATED


def test_a_derivation_reads_as_text_with_places(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("top_left(a, b)", "right(c, b)"))
    derivation = implied.derive(implied.vocabulary["left"], "a", "c")
    assert derivation is not None
    assert list(derivation.lines()) == [
        "left(a, c)   by transitivity",
        "    left(a, b)   by sub-property",
        "        top_left(a, b)   by stated   [test.layout:1:1]",
        "    left(b, c)   by inverse",
        "        right(c, b)   by stated   [test.layout:2:1]",
    ]


def test_the_inverse_of_a_sub_property_goes_by_both_rules(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("exactly_top_left(a, b)"))
    derivation = implied.derive(implied.vocabulary["right"], "b", "a")
    assert derivation is not None
    assert [line.strip().split("   ")[0] for line in derivation.lines()] == [
        "right(b, a)",
        "exactly_bottom_right(b, a)",
        "exactly_top_left(a, b)",
    ]


def test_the_exact_reading_is_never_transitive_and_the_wide_one_below_it_is(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("exactly_left(a, b)", "exactly_left(b, c)"))
    assert implied.holds(implied.vocabulary["left"], "a", "c")
    assert not implied.holds(implied.vocabulary["exactly_left"], "a", "c")


def test_what_is_inferred_is_implied_and_not_stated(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(b, c)"))
    inferred = sorted(str(derivation.fact) for derivation in implied.inferred())
    assert inferred == ["left(a, c)", "right(b, a)", "right(c, a)", "right(c, b)"]


def test_the_completed_graph_has_the_stated_facts_first(graph_of: MakeGraph) -> None:
    graph = graph_of("left(a, b)", "not on(a, b)", "0.5 top(b, a)")
    completed = list(Implications(graph).completed().facts())
    assert completed[:3] == list(graph.facts())
    assert [str(fact) for fact in completed[3:]] == ["right(b, a)"]


@pytest.mark.parametrize("sentence", ["0.8 left(a, b)", "optional left(a, b)", "not left(a, b)", "left or top(a, b)"])
def test_what_is_not_firm_concludes_nothing(sentence: str, graph_of: MakeGraph) -> None:
    implied = Implications(graph_of(sentence, "left(b, c)"))
    assert named(implied) == {("left", "b", "c"), ("right", "c", "b")}


def test_an_empty_graph_and_one_without_facts_imply_nothing(graph_of: MakeGraph) -> None:
    assert named(Implications(graph_of())) == set()
    assert named(Implications(graph_of(nodes="a b c"))) == set()
    assert not Implications(graph_of(nodes="a b")).holds(R["left"], "a", "b")


def test_nothing_is_implied_between_parts_that_no_fact_connects(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(c, d)"))
    assert implied.derive(R["left"], "a", "d") is None
    assert [len(part.nodes) for part in implied.parts()] == [2, 2]


def test_more_connected_objects_than_the_limit_are_an_error(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph
) -> None:
    monkeypatch.setattr(module, "MAX_CONNECTED", 3)
    Implications(graph_of("left(a, b)", "left(b, c)", "left(d, e)"))
    with pytest.raises(LimitError, match=r"connect 4 objects .* up to 3") as caught:
        Implications(graph_of("left(a, b)", "left(b, c)", "left(c, d)"))
    assert isinstance(caught.value, OverflowError)


def geometry(a: NDArray[np.float64], b: NDArray[np.float64]) -> set[str]:
    """The wide relations that hold of two different boxes, from their corners."""
    found = {"left": a[1, 0] <= b[0, 0], "right": b[1, 0] <= a[0, 0], "bottom": a[1, 1] <= b[0, 1]}
    found |= {"top": b[1, 1] <= a[0, 1]}
    corners = {f"{y}_{x}": found[y] and found[x] for y in ("top", "bottom") for x in ("left", "right")}
    within, around = (a[0] >= b[0]).all() and (a[1] <= b[1]).all(), (b[0] >= a[0]).all() and (b[1] <= a[1]).all()
    held = found | corners | {"on": within, "under": around}
    return {word for word, holds in held.items() if holds}


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_whatever_follows_from_facts_that_hold_of_boxes_holds_of_them_and_contradicts_nothing(
    data: st.DataObject, random_boxes: Callable[..., NDArray[np.float64]], relations: Relations
) -> None:
    boxes = np.unique(random_boxes(data, most=6, shortest=1), axis=0)
    ids = [f"o{i}" for i in range(len(boxes))]
    true = [
        (relations[word], i, j)
        for i in range(len(boxes))
        for j in range(len(boxes))
        if i != j
        for word in sorted(geometry(boxes[i], boxes[j]))
    ]
    chosen: list[tuple[Relation, int, int]] = data.draw(st.lists(st.sampled_from(true), max_size=8)) if true else []
    stated = [Fact(ids[i], (relation,), ids[j]) for relation, i, j in chosen]
    implied = Implications(RelationGraph.from_facts(relations, ids, stated))
    assert find_conflict(implied) is None
    for relation, s, o in implied.triples():
        assert relation.name in geometry(boxes[ids.index(s)], boxes[ids.index(o)])


@settings(deadline=None, max_examples=40)
@given(stated=facts)
def test_what_is_implied_without_derivations_is_what_is_derived(stated: list[Triple]) -> None:
    implied = implications(stated)
    graph = implied.graph
    listed = list(implied.implied())
    derived = list(implied.inferred())
    assert [str(fact) for fact in listed] == [str(derivation.fact) for derivation in derived]
    for fact, derivation in zip(listed, derived, strict=True):
        rule, edges = implied.support(fact)
        assert rule == derivation.rule
        assert {graph.fact(edge) for edge in edges} == set(derivation.stated())
        assert implied.steps(fact) >= len(edges)
    assert implied.count() == len(list(implied.triples()))
