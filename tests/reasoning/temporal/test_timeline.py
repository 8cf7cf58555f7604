"""Timelines: implications of fluents with disjunctive relations, contradictions, and explanations."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.relations.allen import ALL_ALLEN, Allen, allen_mask
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.chronology import Status
from deixis.reasoning.temporal.claims import claims_of
from deixis.reasoning.temporal.errors import FluentError, TemporalConflictError, UnknownFluentError
from deixis.reasoning.temporal.fluent import AllenStatement, EndDifference, Fluent, Statement, TemporalRelation
from deixis.reasoning.temporal.search import refuted
from deixis.reasoning.temporal.timeline import MAX_SCENARIOS, Timeline

IDS = ("a", "b", "c")
NEVER_TOGETHER = allen_mask([Allen.BEFORE, Allen.AFTER])
FOREVER = float("inf")


def fluent(id: str, start: Bounds = Bounds(), finish: Bounds = Bounds()) -> Fluent:  # noqa: B008
    return Fluent(id, Statement("cup", "on", id), start, finish, f"t.json: {id}")


@cache
def arrangements() -> NDArray[np.float64]:
    """Return all orders of the ends of three proper intervals, shape (m, 3, 2)."""
    ends = np.stack(np.meshgrid(*[np.arange(6.0)] * 6, indexing="ij"), axis=-1).reshape(-1, 3, 2)
    return ends[(ends[:, :, 0] < ends[:, :, 1]).all(axis=1)]


def relation(ends: NDArray[np.float64], a: str, b: str) -> NDArray[np.int64]:
    i, j = IDS.index(a), IDS.index(b)
    return allen_relations(ends[:, i, 0], ends[:, i, 1], ends[:, j, 0], ends[:, j, 1]).astype(np.int64)


RELATIONS = st.lists(
    st.builds(
        AllenStatement,
        st.sampled_from("ab"),
        st.integers(1, ALL_ALLEN) | st.sampled_from([NEVER_TOGETHER, 1 | 1 << 6, 1 << 2 | 1 << 10]),
        st.just("c"),
    )
    | st.builds(AllenStatement, st.just("b"), st.integers(1, ALL_ALLEN), st.just("a")),
    max_size=5,
)


@settings(max_examples=80, deadline=None)
@given(RELATIONS)
def test_orders_match_the_enumeration(relations: list[AllenStatement]) -> None:
    """Compare disjunctive networks of three fluents without times: consistency, and the relations of every pair."""
    ends = arrangements()
    for stated in relations:
        ends = ends[(stated.relations >> relation(ends, stated.a, stated.b)) & 1 == 1]
    try:
        chronology = Timeline(map(fluent, IDS), relations).chronology(FOREVER)
    except TemporalConflictError:
        assert not len(ends)
        return
    assert chronology.exact
    for a in IDS:
        for b in IDS:
            found = np.unique(relation(ends, a, b)).tolist()
            assert [int(code) for code in chronology.relations(a, b)] == found


@settings(max_examples=60, deadline=None)
@given(RELATIONS, st.lists(st.tuples(st.sampled_from(IDS), st.integers(0, 5), st.integers(0, 5)), max_size=3))
def test_a_conflict_is_a_minimal_contradiction(
    relations: list[AllenStatement], times: list[tuple[str, int, int]]
) -> None:
    differences = [EndDifference("origin", f"{id}.start", Bounds(low, low + more)) for id, low, more in times] + [
        EndDifference(f"{id}.start", f"{id}.finish", Bounds(0, more)) for id, _, more in times if more
    ]
    items: list[TemporalRelation] = [*differences, *relations]
    conflict = conflict_of(items)
    if conflict is None:
        return
    assert conflict.minimal
    claims = {claim.why: claim for item in items for claim in claims_of(item)}
    core = [claims[stated] for stated in conflict.statements]
    assert refuted(core, Deadline.never()) is not None
    for left_out in core:
        assert refuted([claim for claim in core if claim is not left_out], Deadline.never()) is None


def test_a_conflict_names_each_statement_once() -> None:
    """Let the two finishes exclude both alternatives, so that no start is in the conflict."""
    finish = Bounds(14, 14)
    fluents = [fluent("a", Bounds(0, 7), finish), fluent("b", Bounds(7, 7), finish)]
    relations = [AllenStatement("a", 1 << Allen.BEFORE | 1 << Allen.CONTAINS, "b")]
    with pytest.raises(TemporalConflictError) as caught:
        Timeline(fluents, relations).chronology(FOREVER)
    texts = {stated.claim for stated in caught.value.statements}
    assert texts == {"a.finish in [14, 14]", "b.finish in [14, 14]", "before or contains(a, b)"}
    assert len(caught.value.statements) == 3
    for left_out in "ab":
        rest = [fluent(f.id, f.start, Bounds() if f.id == left_out else f.finish) for f in fluents]
        Timeline(rest, relations).chronology(FOREVER)
    Timeline(fluents).chronology(FOREVER)


def conflict_of(items: list[TemporalRelation]) -> TemporalConflictError | None:
    try:
        Timeline(map(fluent, IDS), items).chronology(FOREVER)
    except TemporalConflictError as conflict:
        return conflict
    return None


@settings(max_examples=40, deadline=None)
@given(st.lists(st.integers(0, 12), min_size=6, max_size=6), st.data())
def test_a_true_course_of_events_is_never_excluded(numbers: list[int], data: st.DataObject) -> None:
    """Make true statements about a course of events, which must stay possible, with its times within bounds."""
    ends = [sorted((numbers[2 * k], numbers[2 * k + 1] + (numbers[2 * k] == numbers[2 * k + 1]))) for k in range(3)]
    blur = st.integers(0, 3)
    fluents = [
        fluent(id, Bounds(s - data.draw(blur), s + data.draw(blur)), Bounds(f - data.draw(blur), f + data.draw(blur)))
        for id, (s, f) in zip(IDS, ends, strict=True)
    ]
    truth = np.array([ends], dtype=np.float64)
    codes = {(a, b): int(relation(truth, a, b)[0]) for a, b in (("a", "b"), ("b", "c"), ("a", "c"))}
    relations = [
        AllenStatement(a, 1 << code | data.draw(st.integers(0, ALL_ALLEN)), b) for (a, b), code in codes.items()
    ]
    chronology = Timeline(fluents, relations).chronology(FOREVER)
    for (a, b), code in codes.items():
        assert Allen(code) in chronology.relations(a, b)
    for id, (s, f) in zip(IDS, ends, strict=True):
        for bounds, time in ((chronology.start(id), s), (chronology.finish(id), f), (chronology.duration(id), f - s)):
            assert bounds.lower <= time <= bounds.upper
        assert id in {f.id for f in chronology.may_have_held(s)}


def test_the_only_possible_choice_is_taken_and_explained() -> None:
    timeline = Timeline([fluent("a", Bounds(0, 1), Bounds(5, 6)), fluent("b", Bounds(2))])
    timeline.add(AllenStatement("a", NEVER_TOGETHER, "b", "t.json: r"))
    assert timeline.chronology().start("b") == Bounds(5, lower_open=True)
    why = timeline.explain_bound("b.start", "origin")
    assert why is not None
    assert "\n".join(why.lines()) == (
        "b.start > 5   by shortest path\n"
        "    a.finish < b.start   by definition\n"
        "        before(a, b)   by elimination\n"
        "            before or after(a, b)   stated   [t.json: r]\n"
        "            a.start < a.start - 1   by negative cycle\n"
        "                b.finish < a.start   by definition\n"
        "                    after(a, b)   by case\n"
        "                b.start < b.finish   by proper interval\n"
        "                b.start >= 2   stated   [t.json: b.start]\n"
        "                a.start <= 1   stated   [t.json: a.start]\n"
        "    a.finish >= 5   stated   [t.json: a.finish]"
    )


def test_a_consequence_of_every_choice_is_explained_by_cases() -> None:
    """Let b be before or after a, and c much later than both."""
    timeline = Timeline([fluent("a", Bounds(10, 10), Bounds(20, 20)), fluent("b"), fluent("c")])
    timeline.add(EndDifference("b.start", "b.finish", Bounds(1, 2)))
    timeline.add(AllenStatement("a", NEVER_TOGETHER, "b"))
    timeline.add(EndDifference("a.finish", "c.start", Bounds(-15)))
    timeline.add(AllenStatement("b", allen_mask([Allen.STARTS, Allen.FINISHES]), "c"))
    chronology = timeline.chronology()
    assert chronology.exact
    assert Allen.CONTAINS not in chronology.relations("a", "b")
    why = timeline.explain_relation("a", "b")
    assert why is not None and why.rule is Rule.CASES
    assert {premise.claim for premise in why.premises} >= {"before(a, b)", "after(a, b)"}


def test_inconsistent_disjunctions_are_refuted_by_cases() -> None:
    """Refute that three fluents of 10 s, no two of which may overlap, fit into 25 s."""
    timeline = Timeline([fluent(id, Bounds(0), Bounds(upper=25)) for id in IDS])
    for id in IDS:
        timeline.add(EndDifference(f"{id}.start", f"{id}.finish", Bounds(10)))
    for a, b in ("ab", "bc", "ac"):
        timeline.add(AllenStatement(a, NEVER_TOGETHER, b))
    with pytest.raises(TemporalConflictError) as caught:
        timeline.chronology()
    assert caught.value.minimal
    assert caught.value.explanation.rule is Rule.CASES
    texts = {stated.claim for stated in caught.value.statements}
    assert {f"before or after({a}, {b})" for a, b in ("ab", "bc", "ac")} <= texts
    assert {f"{id}.start <= {id}.finish - 10" for id in IDS} <= texts


def test_a_refused_statement_leaves_the_timeline_unchanged() -> None:
    timeline = Timeline([fluent("a", Bounds(0, 1), Bounds(5, 6)), fluent("b", Bounds(0, 2))])
    before = timeline.network.distances.copy()
    with pytest.raises(TemporalConflictError, match=r"before\(a, b\).*b\.start in \[0, 2\]") as caught:
        timeline.add(AllenStatement("a", 1, "b"))
    assert {stated.source for stated in caught.value.statements} == {None, "t.json: a.finish", "t.json: b.start"}
    assert np.array_equal(timeline.network.distances, before)
    timeline.add(AllenStatement("b", 1 << Allen.OVERLAPPED_BY, "a"))


def test_a_long_chain_of_contradictions_is_reported_in_time() -> None:
    fluents = [fluent(f"f{k}") for k in range(100)]
    chain = [AllenStatement(f"f{k}", 1, f"f{k + 1}") for k in range(99)]
    with pytest.raises(TemporalConflictError) as caught:
        Timeline(fluents, chain).add(AllenStatement("f99", 1, "f0"), time_limit=0.0)
    assert len(caught.value.statements) == 100
    assert not caught.value.minimal


def test_without_time_the_answer_is_undecided_and_sound() -> None:
    timeline = Timeline([fluent("a", Bounds(0, 1), Bounds(5, 6)), fluent("b")])
    timeline.add(AllenStatement("a", NEVER_TOGETHER, "b"))
    chronology = timeline.chronology(time_limit=0.0)
    assert chronology.status is Status.UNDECIDED
    assert not chronology.exact
    assert chronology.relations("a", "b") == (Allen.BEFORE, Allen.AFTER)
    assert chronology.relations("b", "a") == (Allen.BEFORE, Allen.AFTER)
    assert chronology.start("a") == Bounds(0, 1)


def test_too_many_scenarios_make_the_answer_inexact() -> None:
    fluents = [fluent(f"f{k}") for k in range(14)]
    choices = [AllenStatement(f"f{k}", NEVER_TOGETHER, f"f{k + 1}") for k in range(0, 14, 2)]
    assert 2 ** len(choices) > MAX_SCENARIOS
    chronology = Timeline(fluents, choices).chronology()
    assert (chronology.status, chronology.exact) == (Status.CONSISTENT, False)


@pytest.mark.parametrize("mask", [1, NEVER_TOGETHER], ids=["convex", "disjunction"])
def test_a_retracted_relation_is_gone(mask: int) -> None:
    timeline = Timeline([fluent("a", Bounds(0, 1), Bounds(5, 6)), fluent("b", Bounds(3))])
    stated = AllenStatement("a", mask, "b")
    timeline.add(stated)
    assert timeline.chronology().start("b").lower == 5
    timeline.retract(stated)
    assert timeline.chronology().start("b").lower == 3
    with pytest.raises(UnknownFluentError):
        timeline.retract(stated)


def test_a_fluent_can_only_be_retracted_after_its_relations() -> None:
    a, b, stated = fluent("a", Bounds(0, 1)), fluent("b"), AllenStatement("a", 1, "b")
    timeline = Timeline([a, b], [stated])
    with pytest.raises(FluentError, match=r"retract 'before\(a, b\)' first"):
        timeline.retract(b)
    timeline.retract(stated)
    timeline.retract(b)
    assert [f.id for f in timeline.chronology().fluents] == ["a"]
    timeline.add(fluent("b", Bounds(7)))
    assert timeline.chronology().start("b") == Bounds(7)


def test_an_empty_timeline_has_an_empty_chronology() -> None:
    chronology = Timeline().chronology()
    assert chronology.masks.shape == (0, 0)
    assert chronology.held_at(0) == ()


def test_an_impossible_fluent_is_named() -> None:
    with pytest.raises(
        FluentError, match=r"json: late: the fluent 'late' must start before it finishes, got a start in \[5, 6\] and"
    ):
        fluent("late", Bounds(5, 6), Bounds(1, 5))
    with pytest.raises(FluentError, match="stated twice"):
        Timeline([fluent("a"), fluent("a", Bounds(1))])
    with pytest.raises(UnknownFluentError, match="there is no fluent 'b'"):
        Timeline([fluent("a")], [AllenStatement("a", 1, "b")])
    with pytest.raises(FluentError, match="related to itself"):
        AllenStatement("a", 1, "a")
    with pytest.raises(FluentError, match="at least one"):
        AllenStatement("a", 0, "b")
    with pytest.raises(FluentError, match="always 0"):
        EndDifference("a.start", "a.start", Bounds())
