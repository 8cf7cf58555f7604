"""What a graph implies, against all pictures of it and the TBox's own triples; derivations step by step."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from itertools import permutations, product

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pictures import bears, satisfying
from rdflib import OWL, RDF, RDFS, Graph, URIRef

import deixis.reasoning.orders.closed as module
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.ontology.tbox import default_ontology, tbox_turtle
from deixis.reasoning.calculi.calculus import ProductCalculus
from deixis.reasoning.calculi.registry import calculus
from deixis.reasoning.conflict import find_conflict
from deixis.reasoning.convex import EndOrder, admitted
from deixis.reasoning.derivation import Derivation, Impossible, Rule
from deixis.reasoning.errors import LimitError
from deixis.reasoning.implications import Implications
from deixis.reasoning.orders.bounds import Order, meaning
from deixis.reasoning.rectangle import box_relations

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
    tbox = Graph().parse(data=tbox_turtle(), format="turtle")
    by_iri = {relation.iri: relation.name for relation in R.values()}

    def name(node: object) -> str:
        return by_iri[str(node)]

    relations = [URIRef(iri) for iri in by_iri]
    broader = {name(p): {name(q) for q in tbox.objects(p, RDFS.subPropertyOf) if str(q) in by_iri} for p in relations}
    inverse = {name(p): name(q) for p, q in tbox.subject_objects(OWL.inverseOf) if str(p) in by_iri}
    transitive = {name(p) for p in tbox.subjects(RDF.type, OWL.TransitiveProperty)}
    return broader, inverse, transitive


def forward_chained(stated: set[Triple]) -> set[Triple]:
    """Inverses, sub-properties and transitivity until nothing is new."""
    broader, inverse, transitive = axioms()
    known: set[Triple] = set()
    new = set(stated)
    while new:
        known |= new
        derived = {(inverse[r], o, s) for r, s, o in known}
        derived |= {(q, s, o) for r, s, o in known for q in broader[r]}
        derived |= {(r, s, o) for r, s, m in known if r in transitive for q, n, o in known if q == r and n == m}
        new = derived - known
    return known


def proper(triples: set[Triple]) -> set[Triple]:
    return {(r, s, o) for r, s, o in triples if s != o}


def implications(stated: list[Triple]) -> Implications:
    listed = [Fact(s, (R[r],), o) for r, s, o in stated]
    return Implications(RelationGraph.from_facts(R, list(NODES), listed))


def named(implied: Implications) -> set[Triple]:
    return {(relation.name, s, o) for relation, s, o in implied.triples()}


@settings(max_examples=80, deadline=None)
@given(stated=facts)
def test_all_that_forward_chaining_over_the_tbox_finds_is_implied(stated: list[Triple]) -> None:
    implied = implications(stated)
    if implied.consistent:
        assert named(implied) >= proper(forward_chained(set(stated)))


FLAT = [r for r in R.values() if not r.z_atoms]


def some_facts(names: str, words: list[Relation]) -> st.SearchStrategy[list[Fact]]:
    """Facts of every kind: plain, with a choice, denied, hedged."""
    pairs = st.tuples(st.sampled_from(names), st.sampled_from(names)).filter(lambda p: p[0] != p[1])
    relations = st.lists(st.sampled_from(words), min_size=1, max_size=3, unique=True).map(tuple)
    fact = st.builds(
        lambda ends, relations, positive, weight: Fact(ends[0], relations, ends[1], positive=positive, weight=weight),
        pairs,
        relations,
        st.sampled_from([True, True, True, False]),
        st.sampled_from([1.0, 1.0, 1.0, 0.8]),
    )
    return st.lists(fact, max_size=6)


@pytest.mark.parametrize(("names", "words", "axes"), [("abc", FLAT, 2), ("ab", list(R.values()), 3)])
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_exactly_what_all_pictures_share_is_implied(
    names: str, words: list[Relation], axes: int, data: st.DataObject
) -> None:
    stated = data.draw(some_facts(names, words))
    implied = Implications(RelationGraph.from_facts(R, list(names), stated))
    pictures = satisfying(stated, names, axes)
    assert implied.complete and implied.decided
    assert implied.consistent == pictures.any()
    assert (find_conflict(implied) is None) == implied.consistent
    if not implied.consistent:
        assert named(implied) == set()
        return
    for relation in words:
        for s, o in product(range(len(names)), repeat=2):
            if s != o:
                everywhere = bool(bears(relation, s, o, len(names), axes)[pictures].all())
                assert implied.holds(relation, names[s], names[o]) == everywhere, (stated, relation.name, s, o)


BA = calculus("ba")
assert isinstance(BA, ProductCalculus)


def atoms(relation: Relation) -> int:
    """A relation as a set of atoms of the block algebra."""
    assert isinstance(BA, ProductCalculus)
    return BA.of_axes([relation.x_atoms, relation.y_atoms, relation.z_atoms or (1 << 13) - 1])


def claimed(claim: Fact | Order | Impossible) -> int:
    """The atoms that a claim admits."""
    assert not isinstance(claim, Impossible)
    if isinstance(claim, Fact):
        wanted = 0
        for relation in claim.relations:
            wanted |= atoms(relation)
        return wanted if claim.positive else BA.universal & ~wanted
    bound = claim.bound
    mask = admitted((EndOrder(2 * bound.tail + bound.tail_side, 2 * bound.head + bound.head_side, bound.strict),))
    assert isinstance(BA, ProductCalculus)
    return BA.of_axes([mask if axis == bound.axis else (1 << 13) - 1 for axis in range(3)])


def check(derivation: Derivation, stated: list[Fact], assumed: tuple[object, ...] = ()) -> None:
    """Re-checks a derivation rule by rule, down to stated facts, with the block algebra for what is composed."""
    _, inverse, transitive = axioms()
    claim, rule = derivation.fact, derivation.rule
    premises = [premise.fact for premise in derivation.premises]
    if rule is Rule.STATED:
        assert claim in stated
    elif rule is Rule.ASSUMED:
        assert claim in assumed
    elif rule is Rule.INVERSE:
        (premise,) = premises
        assert isinstance(claim, Fact) and isinstance(premise, Fact)
        assert (premise.subject, premise.object, premise.positive) == (claim.object, claim.subject, claim.positive)
        assert [inverse[r.name] for r in premise.relations] == [r.name for r in claim.relations]
    elif rule is Rule.SUB_PROPERTY:
        (premise,) = premises
        assert isinstance(claim, Fact) and isinstance(premise, Fact)
        assert (premise.subject, premise.object) == (claim.subject, claim.object)
        assert claim.relations[0].name in premise.relations[0].broader
    elif rule is Rule.CASES:
        choice = derivation.premises[0]
        assert choice.rule is Rule.STATED and len(derivation.premises) > 2
        check(choice, stated)
        for case in derivation.premises[1:]:
            check(case, stated, (*assumed, *_assumed(case)))
        return
    elif rule is Rule.CONTRADICTION:
        assert find_conflict(
            Implications(RelationGraph.from_facts(R, list(NODES), [p for p in premises if isinstance(p, Fact)]))
        ) or any(isinstance(p, Order) for p in premises)
    elif rule is Rule.CONJUNCTION:
        together = BA.universal
        for premise in premises:
            assert not isinstance(premise, Impossible) and not isinstance(claim, Impossible)
            assert (premise.subject, premise.object) == (claim.subject, claim.object)
            together &= claimed(premise)
        assert together & ~claimed(claim) == 0
    else:
        assert rule in (Rule.MEANING, Rule.TRANSITIVITY, Rule.COMPOSITION)
        assert (len(premises) == 1) == (rule is Rule.MEANING)
        assert not isinstance(claim, Impossible)
        here, composed = claim.subject, 1 << BA.identity
        for premise in premises:
            assert not isinstance(premise, Impossible)
            assert premise.subject == here
            here, composed = premise.object, BA.compose(composed, claimed(premise))
        assert here == claim.object
        assert composed & ~claimed(claim) == 0
        if rule is Rule.TRANSITIVITY:
            assert isinstance(claim, Fact) and claim.relations[0].name in transitive
            assert all(isinstance(p, Fact) and p.relations == claim.relations for p in premises)
    for premise_derivation in derivation.premises:
        check(premise_derivation, stated, assumed)


def _assumed(derivation: Derivation) -> list[object]:
    here = [derivation.fact] if derivation.rule is Rule.ASSUMED else []
    return [*here, *(claim for premise in derivation.premises for claim in _assumed(premise))]


@settings(max_examples=60, deadline=None)
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
@given(stated=some_facts("abc", FLAT))
def test_derivations_by_cases_are_right_and_need_every_fact_that_they_rest_on(stated: list[Fact]) -> None:
    implied = Implications(RelationGraph.from_facts(R, list(NODES), stated))
    stated = list(implied.graph.facts())
    for relation, s, o in list(implied.triples())[:12]:
        derivation = implied.derive(relation, s, o)
        assert derivation is not None
        check(derivation, stated)
        rest = list(derivation.stated())
        assert Implications(RelationGraph.from_facts(R, list(NODES), rest)).holds(relation, s, o)
        if derivation.rule is Rule.CASES:
            for fact in rest:
                fewer = [other for other in rest if other is not fact]
                assert not Implications(RelationGraph.from_facts(R, list(NODES), fewer)).holds(relation, s, o)


@settings(max_examples=60, deadline=None)
@given(stated=facts)
def test_a_derivation_of_one_order_of_edges_takes_as_few_facts_as_there_can_be(stated: list[Triple]) -> None:
    """Edges of things are points, facts are ways between them; networkx finds the shortest."""
    implied = implications(stated)
    if not implied.consistent:
        return
    ways: nx.DiGraph[tuple[int, int, str]] = nx.DiGraph()
    for axis, name in product(range(3), NODES):
        ways.add_edge((axis, 0, name), (axis, 1, name), weight=0)
    for r, s, o in stated:
        for bound in meaning(R[r])[0]:
            ends = (s, o)
            tail, head = (
                (bound.axis, bound.tail_side, ends[bound.tail]),
                (bound.axis, bound.head_side, ends[bound.head]),
            )
            ways.add_edge(tail, head, weight=1)
    for word in ("left", "right", "top", "bottom"):
        (bound,) = meaning(R[word])[0]
        for s, o in permutations(NODES, 2):
            derivation = implied.derive(R[word], s, o)
            if derivation is not None:
                ends = (s, o)
                start = (bound.axis, bound.tail_side, ends[bound.tail])
                goal = (bound.axis, bound.head_side, ends[bound.head])
                assert len(derivation.stated()) == nx.dijkstra_path_length(ways, start, goal)


@settings(max_examples=40, deadline=None)
@given(stated=facts)
def test_the_bit_sets_and_the_block_algebra_give_the_same_answer(stated: list[Triple]) -> None:
    """The same facts through the constraint network of another module: what its closure leaves is what is implied."""
    from deixis.reasoning.networks.closure import close
    from deixis.reasoning.networks.network import Constraint, Network

    implied = implications(stated)
    constraints = tuple(Constraint(NODES.index(s), NODES.index(o), atoms(R[r]), None) for r, s, o in stated)
    closed = close(Network(BA, len(NODES), constraints))
    assert closed.consistent == implied.consistent
    if closed.consistent:
        for relation in R.values():
            for s, o in permutations(range(len(NODES)), 2):
                left = closed.relation(s, o)
                assert implied.holds(relation, NODES[s], NODES[o]) == (left & ~atoms(relation) == 0)


def test_what_lies_on_something_stands_where_that_stands(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("on(napkin, plate)", "left(fork, plate)"))
    derivation = implied.derive(R["left"], "fork", "napkin")
    assert derivation is not None
    assert list(derivation.lines()) == [
        "left(fork, napkin)   by composition",
        "    left(fork, plate)   by stated   [test.layout:2:1]",
        "    under(plate, napkin)   by inverse",
        "        on(napkin, plate)   by stated   [test.layout:1:1]",
    ]


def test_different_words_compose_and_exact_ones_follow_where_they_are_forced(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "top_left(b, c)", "top(a, b)"))
    assert implied.holds(R["left"], "a", "c")
    assert implied.holds(R["exactly_top_left"], "a", "b")
    assert implied.holds(R["exactly_top_left"], "a", "c")
    derivation = implied.derive(R["top_left"], "a", "b")
    assert derivation is not None
    assert derivation.rule is Rule.CONJUNCTION


def test_a_choice_of_which_one_case_is_left_is_taken(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left or top(a, b)", "not left(a, b)"))
    derivation = implied.derive(R["top"], "a", "b")
    assert derivation is not None
    assert [line.strip() for line in derivation.lines()] == [
        "top(a, b)   by cases",
        "left or top(a, b)   by stated   [test.layout:1:1]",
        "impossible: left(a, b)   by contradiction",
        "not left(a, b)   by stated   [test.layout:2:1]",
        "left(a, b)   by assumed",
        "top(a, b)   by assumed",
    ]


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
    implied = Implications(graph_of("exactly_left(a, b)"))
    derivation = implied.derive(implied.vocabulary["right"], "b", "a")
    assert derivation is not None
    assert [line.strip().split("   ")[0] for line in derivation.lines()] == [
        "right(b, a)",
        "exactly_right(b, a)",
        "exactly_left(a, b)",
    ]


def test_what_is_exactly_left_need_not_be_so_of_the_next(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("exactly_left(a, b)", "exactly_left(b, c)"))
    assert implied.holds(implied.vocabulary["left"], "a", "c")
    assert not implied.holds(implied.vocabulary["exactly_left"], "a", "c")


def test_what_is_inferred_is_implied_and_not_stated(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(b, c)"))
    inferred = sorted(str(derivation.fact) for derivation in implied.inferred())
    assert inferred == ["left(a, c)", "right(b, a)", "right(c, a)", "right(c, b)"]


@pytest.mark.parametrize("sentence", ["0.8 left(a, b)", "optional left(a, b)", "not left(a, b)", "left or top(a, b)"])
def test_what_is_not_firm_or_leaves_all_open_concludes_nothing(sentence: str, graph_of: MakeGraph) -> None:
    implied = Implications(graph_of(sentence, "left(b, c)"))
    assert named(implied) == {("left", "b", "c"), ("right", "c", "b")}


def test_an_empty_graph_and_one_without_facts_imply_nothing(graph_of: MakeGraph) -> None:
    assert named(Implications(graph_of())) == set()
    assert named(Implications(graph_of(nodes="a b c"))) == set()
    assert not Implications(graph_of(nodes="a b")).holds(R["left"], "a", "b")


def test_nothing_is_implied_between_parts_that_no_fact_connects(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(c, d)"))
    assert implied.derive(R["left"], "a", "d") is None


def test_more_connected_objects_than_the_limit_are_an_error(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph
) -> None:
    monkeypatch.setattr(module, "MAX_CONNECTED", 3)
    Implications(graph_of("left(a, b)", "left(b, c)", "left(d, e)"))
    with pytest.raises(LimitError, match=r"connect 4 objects .* up to 3") as caught:
        Implications(graph_of("left(a, b)", "left(b, c)", "left(c, d)"))
    assert isinstance(caught.value, OverflowError)


def test_what_all_alternatives_of_a_choice_say_follows_without_a_search(graph_of: MakeGraph) -> None:
    sentences = [f"left or top_left(a{k}, a{k + 1})" for k in range(30)]
    implied = Implications(graph_of(*sentences), time_limit=0.0)
    assert implied.holds(R["left"], "a0", "a30")
    derivation = implied.derive(R["left"], "a0", "a30")
    assert derivation is not None
    assert (derivation.rule, len(derivation.stated())) == (Rule.COMPOSITION, 30)


def test_where_the_time_limit_strikes_what_follows_without_choices_is_known(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left or top(a, b)", "not top(a, b)", "left(b, c)"), time_limit=0.0)
    assert not implied.complete and not implied.decided
    assert named(implied) == {("left", "b", "c"), ("right", "c", "b")}
    assert find_conflict(implied) is None


@settings(max_examples=30, deadline=None)
@given(stated=some_facts("abcd", list(R.values())), order=st.permutations("abcd"))
def test_what_is_implied_does_not_depend_on_the_order_of_nodes(stated: list[Fact], order: list[str]) -> None:
    one = Implications(RelationGraph.from_facts(R, list("abcd"), stated))
    other = Implications(RelationGraph.from_facts(R, order, stated[::-1]))
    assert one.consistent == other.consistent
    assert named(one) == named(other)


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
    names = box_relations(boxes, relations).names
    for relation, s, o in implied.triples():
        i, j = ids.index(s), ids.index(o)
        assert relation.name in geometry(boxes[i], boxes[j]) or relation.index == names[i, j]


@settings(deadline=None, max_examples=40)
@given(stated=facts)
def test_what_is_listed_with_steps_is_what_is_derived(stated: list[Triple]) -> None:
    implied = implications(stated)
    graph = implied.graph
    listed = list(implied.implied_with_steps())
    derived = list(implied.inferred())
    assert [str(fact) for fact, _ in listed] == [str(derivation.fact) for derivation in derived]
    for (fact, steps), derivation in zip(listed, derived, strict=True):
        support = implied.support(fact)
        assert support.rule == derivation.rule
        assert {graph.fact(edge) for edge in support.edges} == set(derivation.stated())
        assert steps >= 1
    assert implied.count() == len(list(implied.triples()))
