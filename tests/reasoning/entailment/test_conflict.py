"""Contradictions: found exactly if there are any, minimal, and explained in words."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.entailment.conflict import Conflict, compatible, find_conflict
from deixis.reasoning.entailment.implications import Implications

MakeGraph = Callable[..., RelationGraph]
Triple = tuple[str, str, str]
R = default_ontology().relations
ORDERED = [r for r in R.values() if r.reading is not Reading.GRADED]  # words that order edges
NODES = "abcd"
LOWER = {"left": (-1, 0), "right": (1, 0), "top": (0, 1), "bottom": (0, -1)}
LOWER |= {"top_left": (-1, 1), "top_right": (1, 1), "bottom_left": (-1, -1), "bottom_right": (1, -1)}

directions = st.tuples(st.sampled_from(list(LOWER)), st.sampled_from(NODES), st.sampled_from(NODES))


def conflict_of(graph: RelationGraph) -> Conflict | None:
    return find_conflict(Implications(graph))


def among(stated: list[Fact]) -> Conflict | None:
    return conflict_of(RelationGraph.from_facts(R, list(NODES), stated))


def cyclic(stated: list[Triple]) -> bool:
    """Return whether the order of the facts on x or on y has a cycle, the only contradiction among directions."""
    for axis in (0, 1):
        before = {(s, o) if LOWER[r][axis] < 0 else (o, s) for r, s, o in stated if LOWER[r][axis]}
        new = True
        while new:
            new = {(a, d) for a, b in before for c, d in before if b == c} - before != set()
            before |= {(a, d) for a, b in before for c, d in before if b == c}
        if any(a == b for a, b in before):
            return True
    return False


@settings(max_examples=80, deadline=None)
@given(st.lists(directions, max_size=6))
def test_facts_conflict_exactly_if_an_order_is_cyclic(stated: list[Triple]) -> None:
    found = among([Fact(s, (R[r],), o) for r, s, o in stated])
    assert (found is not None) == cyclic(stated)


anything = st.builds(
    Fact,
    st.sampled_from(NODES),
    st.sets(st.sampled_from(ORDERED), min_size=1, max_size=2).map(lambda s: tuple(sorted(s, key=lambda r: r.index))),
    st.sampled_from(NODES),
    st.sampled_from([True, True, False]),
    st.sampled_from([False, False, False, True]),
    st.sampled_from([1.0, 1.0, 0.8]),
)


@settings(max_examples=80, deadline=None)
@given(st.lists(anything, min_size=2, max_size=8))
def test_a_conflict_is_minimal_and_made_of_firm_stated_facts(stated: list[Fact]) -> None:
    found = among(stated)
    if found is None:
        return
    assert all(fact in stated and not fact.optional and fact.weight == 1 for fact in found.facts)
    assert len(set(found.facts)) == len(found.facts)
    assert among(list(found.facts)) is not None
    for fact in found.facts:
        assert among([other for other in found.facts if other is not fact]) is None


@settings(max_examples=60, deadline=None)
@given(st.lists(anything, max_size=6), st.data())
def test_adding_facts_keeps_a_contradiction(stated: list[Fact], data: st.DataObject) -> None:
    if among(stated) is not None:
        more = data.draw(st.lists(anything, max_size=3))
        assert among([*more, *stated]) is not None


@pytest.mark.parametrize(
    ("sentences", "conflict", "reason"),
    [
        (
            ["left(a, b)", "left(b, a)", "on(c, b)"],
            ["left(a, b)", "left(b, a)"],
            "'a' cannot be both left of and right",
        ),
        (["left(a, b)", "left(b, c)", "left(c, a)"], ["left(a, b)", "left(b, c)", "left(c, a)"], "cannot be both"),
        (["top_left(a, b)", "left(b, a)"], ["top_left(a, b)", "left(b, a)"], "cannot be both"),
        (["left(a, b)", "on(a, b)"], ["left(a, b)", "on(a, b)"], "'a' cannot be both left of and on 'b'"),
        (["on(a, b)", "on(b, a)"], ["on(a, b)", "on(b, a)"], "cannot be both"),
        (["exactly_left(a, b)", "top(a, b)"], ["exactly_left(a, b)", "top(a, b)"], "cannot be both"),
        (["left(a, a)"], ["left(a, a)"], "no object can be related to itself, but 'a' is"),
        (["left or right(a, a)"], ["left or right(a, a)"], "no object can be related to itself"),
        (["left(a, b)", "not left(a, b)"], ["left(a, b)", "not left(a, b)"], "'a' is left of 'b', but that is denied"),
        (["right(b, a)", "not left(a, b)"], ["right(b, a)", "not left(a, b)"], "that is denied"),
        (["top_left(a, b)", "not left or on(a, b)"], ["top_left(a, b)", "not left or on(a, b)"], "that is denied"),
        (
            ["left(a, b)", "left(b, c)", "not right(c, a)"],
            ["left(a, b)", "left(b, c)", "not right(c, a)"],
            "'c' is right of 'a', but that is denied",
        ),
        (
            ["left or top_left(a, b)", "right(a, b)"],
            ["left or top_left(a, b)", "right(a, b)"],
            "neither left of nor top",
        ),
        (["left or top(a, b)", "not top(a, b)", "right(a, b)"], None, "neither left of nor above 'b'"),
        (["left or top(a, b)", "not left(a, b)", "not top(a, b)"], None, "neither left of nor above 'b'"),
        (["left or top(a, b)", "not right(b, a)", "not top(a, b)"], None, "neither left of nor above 'b'"),
        (["left or top(a, b)", "not left or top(a, b)"], None, "neither left of nor above 'b'"),
        (["right or top_left(a, b)", "not left(a, b)", "not right(a, b)"], None, "neither right of nor top left of"),
        (["inside(a, b)", "inside(b, a)"], None, "'a' cannot be both inside and containing 'b'"),
        (["inside(a, b)", "containing(c, b)", "inside(c, a)"], None, "'a' cannot be both inside and containing 'b'"),
        (["stacked(a, b)", "stacked(b, c)", "stacked(c, a)"], None, "cannot be both stacked on and stacked under"),
        (["bigger(a, b)", "smaller(c, b)", "bigger(c, a)"], None, "cannot be both bigger than and smaller than"),
        (["near(a, b)", "not near(b, a)"], None, "'b' is near 'a', but that is denied"),
        (["leaning(a, b)", "not touching(b, a)"], None, "'b' is touching 'a', but that is denied"),
        (["inside(a, b)", "inside(b, c)", "not inside or near(a, c)"], None, "'a' is inside 'c', but that is denied"),
    ],
)
def test_conflicts_worked_out_by_hand(
    sentences: list[str], conflict: list[str] | None, reason: str, graph_of: MakeGraph
) -> None:
    found = conflict_of(graph_of(*sentences))
    assert found is not None
    assert [str(fact) for fact in found.facts] == (sentences if conflict is None else conflict)
    assert reason in found.reason


@pytest.mark.parametrize(
    "sentences",
    [
        [],
        ["left(a, b)", "top(a, b)"],
        ["left(a, b)", "0.8 left(b, a)"],
        ["left(a, b)", "optional left(b, a)"],
        ["left(a, b)", "optional not left(a, b)"],
        ["left(a, b)", "0.5 not left(a, b)"],
        ["0.9 left(a, a)", "left(a, b)"],
        ["left or right(a, b)", "left(b, a)"],
        ["left or right(a, b)", "not left(a, b)"],
        ["left or right(a, b)", "not left(a, b)", "0.5 not right(a, b)"],
        ["not left(a, b)", "not right(a, b)", "not on(a, b)"],
        ["not left(a, a)"],
        ["left(a, b)", "not exactly_left(a, b)"],
        ["inside(a, b)", "on(b, a)"],  # a pot under its cosy
        ["inside(a, b)", "0.8 inside(b, a)"],
        ["inside(a, b)", "optional inside(b, a)"],
        ["inside or on(a, b)", "inside(b, a)"],
        ["near(a, b)", "near(b, c)", "not near(a, c)"],
        ["touching(a, b)", "not leaning(a, b)"],
        ["bigger(a, b)", "taller(b, a)"],
    ],
)
def test_compatible_facts_have_no_conflict(sentences: list[str], graph_of: MakeGraph) -> None:
    assert conflict_of(graph_of(*sentences, nodes="a b c")) is None


words = st.builds(
    lambda subject, word, obj, positive: Fact(subject, (R[word],), obj, positive),
    st.sampled_from(NODES),
    st.sampled_from(["inside", "containing", "near", "leaning", "touching", "bigger", "smaller"]),
    st.sampled_from(NODES),
    st.sampled_from([True, True, True, False]),
).filter(lambda fact: fact.subject != fact.object)


def follows(stated: list[Fact]) -> set[tuple[str, str, str]]:
    """Return the facts that follow by inverses, broader words and transitivity, by repeating these rules."""
    known: set[tuple[str, str, str]] = set()
    new = {(fact.relations[0].name, fact.subject, fact.object) for fact in stated if fact.positive}
    while new - known:
        known |= new
        new = {(R[word].inverse, o, s) for word, s, o in known}
        new |= {(broader, s, o) for word, s, o in known for broader in R[word].broader}
        new |= {(word, s, d) for word, s, o in known for other, c, d in known if (other, c) == (word, o)
                and R[word].transitive}  # fmt: skip
    return known


@settings(max_examples=150, deadline=None)
@given(st.lists(words, max_size=7))
def test_graded_words_conflict_exactly_if_their_rules_say_so(stated: list[Fact]) -> None:
    known = follows(stated)
    cycle = any(s == o and word in ("inside", "bigger") for word, s, o in known)
    denied = any((fact.relations[0].name, fact.subject, fact.object) in known for fact in stated if not fact.positive)
    found = among(stated)
    assert (found is not None) == (cycle or denied)
    facts = () if found is None else found.facts
    for fact in facts:
        assert among([other for other in facts if other is not fact]) is None


def test_the_conflict_with_the_fewest_facts_is_reported(graph_of: MakeGraph) -> None:
    found = conflict_of(graph_of("left(a, b)", "left(b, c)", "left(c, a)", "top(d, e)", "top(e, d)"))
    assert found is not None
    assert [str(fact) for fact in found.facts] == ["top(d, e)", "top(e, d)"]


def test_the_facts_of_a_conflict_are_in_the_order_of_their_lines(graph_of: MakeGraph) -> None:
    found = conflict_of(graph_of("not left(a, c)", "left(b, c)", "left(a, b)"))
    assert found is not None
    assert [fact.source.line for fact in found.facts if fact.source] == [1, 2, 3]


def test_a_repeated_fact_is_in_the_conflict_once(graph_of: MakeGraph) -> None:
    found = conflict_of(graph_of("left(a, b)", "left(a, b)", "left(b, a)"))
    assert found is not None
    assert len(found.facts) == 2


def test_compatibility_is_symmetric_and_reflexive() -> None:
    for a, b in combinations(ORDERED, 2):
        assert compatible(a, b) == compatible(b, a)
    assert all(compatible(a, a) for a in ORDERED)


def test_a_relation_is_compatible_with_its_consequences() -> None:
    for relation in ORDERED:
        assert all(compatible(relation, R[name]) for name in relation.broader)
        assert not compatible(relation, R[relation.inverse])
    assert not compatible(R["inside"], R["containing"]) and compatible(R["touching"], R["touching"])


def test_exact_relations_are_compatible_only_with_themselves() -> None:
    exact = [r for r in ORDERED if r.name.startswith("exactly")]
    assert not any(compatible(a, b) for a, b in combinations(exact, 2))
