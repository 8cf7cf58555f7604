"""The implications of a graph, compared with all its pictures and with the triples of the TBox."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pictures import bears, satisfying
from stated_facts import BA, FLAT, NODES, ORDERED, MakeGraph, R, Triple, atoms, axioms, facts, implications, some_facts

import deixis.reasoning.entailment.closed as module
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Relation, Relations
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.errors import LimitError
from deixis.reasoning.geometry.rectangle import box_relations


def forward_chained(stated: set[Triple]) -> set[Triple]:
    """Apply inverses, sub-properties and transitivity until nothing is new."""
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


def named(implied: Implications) -> set[Triple]:
    return {(relation.name, s, o) for relation, s, o in implied.triples()}


@settings(max_examples=80, deadline=None)
@given(stated=facts)
def test_all_consequences_of_the_tbox_rules_are_implied(stated: list[Triple]) -> None:
    implied = implications(stated)
    if implied.consistent:
        assert named(implied) >= proper(forward_chained(set(stated)))


@pytest.mark.parametrize(("names", "words", "axes"), [("abc", FLAT, 2), ("ab", ORDERED, 3)])
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_fact_is_implied_exactly_if_all_pictures_share_it(
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


@settings(max_examples=40, deadline=None)
@given(stated=facts)
def test_bit_sets_and_block_algebra_agree(stated: list[Triple]) -> None:
    """Compare with the closure of the constraint network of another module."""
    from deixis.reasoning.qualitative.networks.closure.algebraic import close
    from deixis.reasoning.qualitative.networks.network import Constraint, Network

    implied = implications(stated)
    constraints = tuple(Constraint(NODES.index(s), NODES.index(o), atoms(R[r]), None) for r, s, o in stated)
    closed = close(Network(BA, len(NODES), constraints))
    assert closed.consistent == implied.consistent
    if closed.consistent:
        for relation in ORDERED:
            for s, o in permutations(range(len(NODES)), 2):
                left = closed.relation(s, o)
                assert implied.holds(relation, NODES[s], NODES[o]) == (left & ~atoms(relation) == 0)


def test_an_object_shares_the_relations_of_its_support(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("on(napkin, plate)", "left(fork, plate)"))
    derivation = implied.derive(R["left"], "fork", "napkin")
    assert derivation is not None
    assert list(derivation.lines()) == [
        "left(fork, napkin)   by composition",
        "    left(fork, plate)   stated   [test.layout:2:1]",
        "    under(plate, napkin)   by inverse",
        "        on(napkin, plate)   stated   [test.layout:1:1]",
    ]


def test_different_words_compose(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "top_left(b, c)", "top(a, b)"))
    assert implied.holds(R["left"], "a", "c")
    assert implied.holds(R["exactly_top_left"], "a", "b")
    assert implied.holds(R["exactly_top_left"], "a", "c")
    derivation = implied.derive(R["top_left"], "a", "b")
    assert derivation is not None
    assert derivation.rule is Rule.CONJUNCTION


def test_a_choice_with_one_possible_case_is_decided(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left or top(a, b)", "not left(a, b)"))
    derivation = implied.derive(R["top"], "a", "b")
    assert derivation is not None
    assert [line.strip() for line in derivation.lines()] == [
        "top(a, b)   by cases",
        "left or top(a, b)   stated   [test.layout:1:1]",
        "impossible: left(a, b)   by contradiction",
        "not left(a, b)   stated   [test.layout:2:1]",
        "left(a, b)   by assumed",
        "top(a, b)   by assumed",
    ]


def test_exactly_left_is_not_transitive(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("exactly_left(a, b)", "exactly_left(b, c)"))
    assert implied.holds(implied.vocabulary["left"], "a", "c")
    assert not implied.holds(implied.vocabulary["exactly_left"], "a", "c")


def test_inferred_facts_are_implied_and_not_stated(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(b, c)"))
    inferred = sorted(str(derivation.claim) for derivation in implied.inferred())
    assert inferred == ["left(a, c)", "right(b, a)", "right(c, a)", "right(c, b)"]


@pytest.mark.parametrize("sentence", ["0.8 left(a, b)", "optional left(a, b)", "not left(a, b)", "left or top(a, b)"])
def test_facts_that_are_not_firm_imply_nothing(sentence: str, graph_of: MakeGraph) -> None:
    implied = Implications(graph_of(sentence, "left(b, c)"))
    assert named(implied) == {("left", "b", "c"), ("right", "c", "b")}


def test_an_empty_graph_and_one_without_facts_imply_nothing(graph_of: MakeGraph) -> None:
    assert named(Implications(graph_of())) == set()
    assert named(Implications(graph_of(nodes="a b c"))) == set()
    assert not Implications(graph_of(nodes="a b")).holds(R["left"], "a", "b")


def test_nothing_is_implied_between_unconnected_objects(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left(a, b)", "left(c, d)"))
    assert implied.derive(R["left"], "a", "d") is None


def test_more_connected_objects_than_the_limit_are_an_error(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph
) -> None:
    monkeypatch.setattr(module, "MAX_CONNECTED", 3)
    Implications(graph_of("left(a, b)", "left(b, c)", "left(d, e)"))
    with pytest.raises(LimitError, match=r"connect 4 objects .* at most 3") as caught:
        Implications(graph_of("left(a, b)", "left(b, c)", "left(c, d)"))
    assert isinstance(caught.value, OverflowError)


def test_consequences_of_all_alternatives_need_no_search(graph_of: MakeGraph) -> None:
    sentences = [f"left or top_left(a{k}, a{k + 1})" for k in range(30)]
    implied = Implications(graph_of(*sentences), time_limit=0.0)
    assert implied.holds(R["left"], "a0", "a30")
    derivation = implied.derive(R["left"], "a0", "a30")
    assert derivation is not None
    assert (derivation.rule, len(derivation.stated())) == (Rule.COMPOSITION, 30)


def test_at_the_limit_consequences_without_choices_are_known(graph_of: MakeGraph) -> None:
    implied = Implications(graph_of("left or top(a, b)", "not top(a, b)", "left(b, c)"), time_limit=0.0)
    assert not implied.complete and not implied.decided
    assert named(implied) == {("left", "b", "c"), ("right", "c", "b")}
    assert find_conflict(implied) is None


@settings(max_examples=30, deadline=None)
@given(stated=some_facts("abcd", ORDERED), order=st.permutations("abcd"))
def test_implications_do_not_depend_on_the_order_of_nodes(stated: list[Fact], order: list[str]) -> None:
    one = Implications(RelationGraph.from_facts(R, list("abcd"), stated))
    other = Implications(RelationGraph.from_facts(R, order, stated[::-1]))
    assert one.consistent == other.consistent
    assert named(one) == named(other)


def geometry(a: NDArray[np.float64], b: NDArray[np.float64]) -> set[str]:
    """Return the wide relations of two different boxes, from their corners."""
    found = {"left": a[1, 0] <= b[0, 0], "right": b[1, 0] <= a[0, 0], "bottom": a[1, 1] <= b[0, 1]}
    found |= {"top": b[1, 1] <= a[0, 1]}
    corners = {f"{y}_{x}": found[y] and found[x] for y in ("top", "bottom") for x in ("left", "right")}
    within, around = (a[0] >= b[0]).all() and (a[1] <= b[1]).all(), (b[0] >= a[0]).all() and (b[1] <= a[1]).all()
    held = found | corners | {"on": within, "under": around}
    return {word for word, holds in held.items() if holds}


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_consequences_of_true_facts_hold_of_the_boxes(
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
def test_facts_listed_with_steps_are_the_derived_ones(stated: list[Triple]) -> None:
    implied = implications(stated)
    graph = implied.graph
    listed = list(implied.implied_with_steps())
    derived = list(implied.inferred())
    assert [str(fact) for fact, _ in listed] == [str(derivation.claim) for derivation in derived]
    for (fact, steps), derivation in zip(listed, derived, strict=True):
        support = implied.support(fact)
        assert support.rule == derivation.rule
        assert {graph.fact(edge) for edge in support.edges} == set(derivation.stated())
        assert steps >= 1
    assert implied.count() == len(list(implied.triples()))
