"""Queries of fluents that held at a time, compared with all choices of times and with the definitions."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.ontology.relations.allen import Allen, allen_mask
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.chronology import TemporalOrder, Window
from deixis.reasoning.temporal.errors import UnknownFluentError
from deixis.reasoning.temporal.fluent import AllenStatement, EndDifference, Fluent, Pattern, Statement
from deixis.reasoning.temporal.timeline import Timeline

CUP = Statement("cup", "on", "table")
LAST = 4


def some_bounds() -> st.SearchStrategy[Bounds]:
    return st.tuples(st.integers(0, LAST), st.integers(0, LAST)).map(lambda ends: Bounds(min(ends), max(ends)))


@settings(max_examples=60, deadline=None)
@given(
    st.tuples(some_bounds(), some_bounds()).filter(lambda ends: ends[0].lower < ends[1].upper),
    st.integers(1, LAST),
    st.integers(0, 2 * LAST),
    st.integers(1, LAST),
)
def test_answers_match_the_enumeration_of_all_times(
    ends: tuple[Bounds, Bounds], longest: int, begin: int, length: int
) -> None:
    """Enumerate times in quarters, which suffice for integer bounds and questions in halves."""
    start, finish = ends
    choices = [
        (s / 4, f / 4)
        for s in range(int(4 * start.lower), int(4 * start.upper) + 1)
        for f in range(int(4 * finish.lower), int(4 * finish.upper) + 1)
        if 0 < f - s <= 4 * longest
    ]
    timeline = Timeline([Fluent("f", CUP, start, finish)])
    if not choices:
        return
    timeline.add(EndDifference("f.start", "f.finish", Bounds(0, longest)))
    chronology = timeline.chronology()
    t, window = begin / 2, Window(begin / 2, (begin + length) / 2)
    at = [s <= t < f for s, f in choices]
    within = [s < window.end and window.begin < f for s, f in choices]
    throughout = [s <= window.begin and window.end <= f for s, f in choices]
    assert bool(chronology.held_at(t)) == all(at)
    assert bool(chronology.may_have_held(t)) == any(at)
    assert bool(chronology.held_within(window)) == all(within)
    assert bool(chronology.may_have_held_within(window)) == any(within)
    assert bool(chronology.held_throughout(window)) == all(throughout)
    assert bool(chronology.may_have_held_throughout(window)) == any(throughout)


def test_of_two_meeting_fluents_one_holds_at_the_instant_between() -> None:
    timeline = Timeline([Fluent("a", CUP, Bounds(0, 0), Bounds(5, 5)), Fluent("b", CUP)])
    timeline.add(AllenStatement("a", 1 << Allen.MEETS, "b"))
    assert [f.id for f in timeline.chronology().held_at(5)] == ["b"]
    assert [f.id for f in timeline.chronology().may_have_held(5)] == ["b"]


def test_a_possibility_needs_a_single_scenario() -> None:
    """Let b last 2 s within [0, 4) or within [10, 14): it may hold at 1 and at 11, but never from 3 to 11."""
    a = Fluent("a", CUP, Bounds(4, 4), Bounds(10, 10))
    b = Fluent("b", CUP, Bounds(0), Bounds(upper=14))
    timeline = Timeline([a, b], [EndDifference("b.start", "b.finish", Bounds(2, 4))])
    timeline.add(AllenStatement("a", allen_mask([Allen.BEFORE, Allen.MEETS, Allen.MET_BY, Allen.AFTER]), "b"))
    chronology = timeline.chronology()
    assert chronology.exact
    assert [f.id for f in chronology.may_have_held(3)] == ["b"]
    assert [f.id for f in chronology.may_have_held(11)] == ["b"]
    assert [f.id for f in chronology.may_have_held(7)] == ["a"]
    assert chronology.may_have_held_throughout(Window(3, 11)) == ()


def test_patterns_select_statements() -> None:
    fluents = [
        Fluent("a", CUP, Bounds(0, 0), Bounds(9, 9)),
        Fluent("b", Statement("cup", "full"), Bounds(0, 0), Bounds(9, 9)),
        Fluent("c", Statement("fork", "on", "table"), Bounds(0, 0), Bounds(9, 9)),
    ]
    chronology = Timeline(fluents).chronology()
    assert [f.id for f in chronology.held_at(1, Pattern(predicate="on"))] == ["a", "c"]
    assert [f.id for f in chronology.held_at(1, Pattern("cup"))] == ["a", "b"]
    assert chronology.held_at(1, Pattern("cup", "on", "tray")) == ()


def test_an_order_is_certain_if_all_possible_relations_agree() -> None:
    a = Fluent("a", CUP, Bounds(0, 1), Bounds(2, 3))
    b = Fluent("b", CUP, Bounds(3, 4), Bounds(8, 9))
    c = Fluent("c", CUP, Bounds(5, 7), Bounds(10))
    d = Fluent("d", CUP, Bounds(0, 20), Bounds(0, 30))
    chronology = Timeline([b, a, c, d]).chronology()
    assert chronology.certain_order("a", "b") is TemporalOrder.PRECEDES
    assert chronology.certain_order("b", "a") is TemporalOrder.FOLLOWS
    assert chronology.certain_order("b", "c") is TemporalOrder.CONCURRENT
    assert chronology.certain_order("b", "d") is None
    orders = [(first.id, order, second.id) for first, order, second in chronology.certain_orders()]
    assert orders == [
        ("a", TemporalOrder.PRECEDES, "b"),
        ("b", TemporalOrder.CONCURRENT, "c"),
        ("a", TemporalOrder.PRECEDES, "c"),
    ]
    early = [(first.id, second.id) for first, _, second in chronology.certain_orders(Window(0, 5))]
    assert early == [("a", "b")]


def test_invalid_windows_and_unknown_fluents_are_refused() -> None:
    chronology = Timeline().chronology()
    with pytest.raises(SettingError, match="must begin before it ends"):
        Window(2, 2)
    with pytest.raises(SettingError, match="finite"):
        Window(0, float("inf"))
    with pytest.raises(SettingError, match="finite"):
        chronology.held_at(float("nan"))
    with pytest.raises(UnknownFluentError, match="no fluent 'x'"):
        chronology.start("x")
