"""Searches of fluents find the same on the blackboard and by SPARQL."""

from __future__ import annotations

import math

import pyoxigraph as ox
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent, Origin, Source, episodic
from deixis.memory.episodes.projection import follow
from deixis.memory.episodes.search import Edge, Event, FluentSearch, Pick
from deixis.reasoning.temporal.bounds import Bounds

THINGS, PREDICATES, PERSONS = ("t1", "t2", "t 3"), ("left", "on", "near"), ("Ada", "Bob")


@st.composite
def fluents(draw: st.DrawFn) -> list[EpisodicFluent]:
    found = []
    for number in range(draw(st.integers(1, 8))):
        start, length = draw(st.integers(0, 9)), draw(st.integers(1, 6))
        slack = draw(st.sampled_from([0, 0, 1, 3]))
        begin = None if draw(st.integers(0, 9)) == 0 else Bounds(start - slack, start)
        end = None if draw(st.booleans()) else Bounds(start + length, start + length + slack)
        said = (draw(st.sampled_from(THINGS)), draw(st.sampled_from(PREDICATES)), draw(st.sampled_from(THINGS[:2])))
        source = Source(draw(st.sampled_from(list(Origin))), draw(st.sampled_from(PERSONS)))
        found.append(episodic(f"f{number}", said, start=begin, finish=end, source=source))
    return found


def some(values: tuple[str, ...]) -> st.SearchStrategy[frozenset[str] | None]:
    return st.none() | st.frozensets(st.sampled_from(values), min_size=1)


@st.composite
def searches(draw: st.DrawFn) -> FluentSearch:
    edge, event = draw(st.sampled_from(list(Edge))), draw(st.none() | st.sampled_from(list(Event)))
    if event is not None:
        edge = Edge.FINISHES if event is Event.GOES else Edge.STARTS
    start = draw(st.sampled_from([-math.inf, 0.0, 3.0, 5.5]))
    end = draw(st.sampled_from([math.inf, start + 2.0]).filter(lambda end: end > start))
    return FluentSearch(
        draw(some(THINGS)),
        draw(some(PREDICATES)),
        draw(some(THINGS[:2])) if draw(st.booleans()) else None,
        draw(st.none() | st.frozensets(st.sampled_from(list(Origin)), min_size=1)),
        draw(some(PERSONS)),
        edge,
        start,
        end,
        draw(st.sampled_from(list(Pick))),
        event,
        frozenset(draw(st.sampled_from([("near",), ("left", "on")]))),
    )


@settings(max_examples=20, deadline=None)
@given(fluents(), st.lists(searches(), min_size=1, max_size=4))
def test_sparql_finds_the_same_fluents(known: list[EpisodicFluent], asked: list[FluentSearch]) -> None:
    store = ox.Store()
    with Blackboard.transient() as board:
        board.write(*map(Add, known), by="test")
        follow(board, store)
        for search in asked:
            answers = store.query(search.sparql())
            assert isinstance(answers, ox.QuerySolutions)
            assert {solution["id"].value for solution in answers} == {each.id for each in search.run(board)}
