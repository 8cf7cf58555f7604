"""Derivations of implied facts: every step by its rule, from the fewest stated facts."""

from __future__ import annotations

from itertools import permutations, product

import networkx as nx
from hypothesis import given, settings
from stated_facts import BA, FLAT, NODES, MakeGraph, R, Triple, atoms, axioms, facts, implications, some_facts

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.bounds import Order, meaning
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.derivations import Derivation, ImpossibleCase
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.geometry.allen import EndOrder, admitted
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus


def claimed(claim: Fact | Order | ImpossibleCase) -> int:
    """Return the atoms that a claim admits."""
    assert not isinstance(claim, ImpossibleCase)
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
    """Check a derivation rule by rule, down to stated facts, with the block algebra for compositions."""
    _, inverse, transitive = axioms()
    claim, rule = derivation.claim, derivation.rule
    premises = [premise.claim for premise in derivation.premises]
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
            assert not isinstance(premise, ImpossibleCase) and not isinstance(claim, ImpossibleCase)
            assert (premise.subject, premise.object) == (claim.subject, claim.object)
            together &= claimed(premise)
        assert together & ~claimed(claim) == 0
    else:
        assert rule in (Rule.MEANING, Rule.TRANSITIVITY, Rule.COMPOSITION)
        assert (len(premises) == 1) == (rule is Rule.MEANING)
        assert not isinstance(claim, ImpossibleCase)
        here, composed = claim.subject, 1 << BA.identity
        for premise in premises:
            assert not isinstance(premise, ImpossibleCase)
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
    here = [derivation.claim] if derivation.rule is Rule.ASSUMED else []
    return [*here, *(claim for premise in derivation.premises for claim in _assumed(premise))]


@settings(max_examples=60, deadline=None)
@given(stated=facts)
def test_every_derivation_is_correct_and_rests_on_stated_facts(stated: list[Triple]) -> None:
    implied = implications(stated)
    listed = list(implied.graph.facts())
    for relation, s, o in implied.triples():
        derivation = implied.derive(relation, s, o)
        assert derivation is not None
        assert str(derivation.claim) == f"{relation.name}({s}, {o})"
        check(derivation, listed)
        assert set(derivation.stated()) <= set(listed)
        assert len(set(derivation.stated())) == len(derivation.stated())


@settings(max_examples=60, deadline=None)
@given(stated=some_facts("abc", FLAT))
def test_derivations_by_cases_are_correct_and_minimal(stated: list[Fact]) -> None:
    implied = Implications(RelationGraph.from_facts(R, list(NODES), stated))
    stated = list(implied.graph.facts())
    for relation, s, o in list(implied.triples())[:12]:
        derivation = implied.derive(relation, s, o)
        assert derivation is not None
        check(derivation, stated)
        rest = [fact for fact in derivation.stated() if isinstance(fact, Fact)]
        assert Implications(RelationGraph.from_facts(R, list(NODES), rest)).holds(relation, s, o)
        if derivation.rule is Rule.CASES:
            for fact in rest:
                fewer = [other for other in rest if other is not fact]
                assert not Implications(RelationGraph.from_facts(R, list(NODES), fewer)).holds(relation, s, o)


@settings(max_examples=60, deadline=None)
@given(stated=facts)
def test_the_derivation_of_an_order_takes_the_fewest_facts(stated: list[Triple]) -> None:
    """Compare with shortest paths of networkx, where edges of boxes are nodes and facts are arcs."""
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


def test_a_stated_fact_is_its_own_derivation(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("right(b, a)", "left(a, b)", "left(b, c)", "left(a, c)"))
    for subject, object in (("a", "b"), ("a", "c")):
        derivation = implied.derive(implied.vocabulary["left"], subject, object)
        assert derivation is not None
        assert derivation.rule is Rule.STATED


def test_a_derivation_prints_with_source_locations(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("top_left(a, b)", "right(c, b)"))
    derivation = implied.derive(implied.vocabulary["left"], "a", "c")
    assert derivation is not None
    assert list(derivation.lines()) == [
        "left(a, c)   by transitivity",
        "    left(a, b)   by sub-property",
        "        top_left(a, b)   stated   [test.layout:1:1]",
        "    left(b, c)   by inverse",
        "        right(c, b)   stated   [test.layout:2:1]",
    ]


def test_the_inverse_of_a_sub_property_takes_both_rules(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("exactly_left(a, b)"))
    derivation = implied.derive(implied.vocabulary["right"], "b", "a")
    assert derivation is not None
    assert [line.strip().split("   ")[0] for line in derivation.lines()] == [
        "right(b, a)",
        "exactly_right(b, a)",
        "exactly_left(a, b)",
    ]
