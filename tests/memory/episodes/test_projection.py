"""Fluents in SPARQL: the copy in the semantic store follows the log."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox
from episodic_fluents import SEEN, on, some_fluents
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.memory.episodes import projection
from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.changes import Add
from deixis.memory.episodes.fluents.episode import EpisodicFluent, episodic
from deixis.memory.episodes.projection import follow, is_current
from deixis.memory.episodes.rdf.observations import fluent_triples, statement_triple
from deixis.memory.semantic.rdf.graphs import FLUENTS, NOW
from deixis.session import Session


@settings(max_examples=6, deadline=None)
@given(some_fluents(6), st.data())
def test_copy_has_the_fluents_and_what_holds_now(fluents: list[EpisodicFluent], data: st.DataObject) -> None:
    store, page = ox.Store(), projection._PAGE
    projection._PAGE = data.draw(st.sampled_from([1, 2, 100]))
    try:
        with Blackboard.transient() as board:
            for each in fluents:
                board.add(each, by="test")
                if data.draw(st.booleans()):
                    follow(board, store)
                if each.is_open and data.draw(st.booleans()):
                    board.finish(each.id, 50.0, by="test")
                elif data.draw(st.booleans()):
                    board.delete(each.id, by="test")
            follow(board, store)
            assert is_current(board, store)
            spelt = ox.Store()  # spells numbers as the store does
            spelt.extend(ox.Quad(*triple) for each in board.holding() for triple in fluent_triples(each))
            wanted = {quad.triple for quad in spelt}
            found = {quad.triple for quad in store.quads_for_pattern(None, None, None, FLUENTS)}
            assert {triple for triple in found if "timeOrigin" not in str(triple)} == wanted
            now = {quad.triple for quad in store.quads_for_pattern(None, None, None, NOW)}
            assert now == {statement_triple(each.statement) for each in board.now()}
    finally:
        projection._PAGE = page


def test_copy_of_another_blackboard_is_replaced() -> None:
    store = ox.Store()
    for number in range(2):
        with Blackboard.transient() as board:
            board.add(on(f"f{number}"), by="test")
            follow(board, store)
    ids = {str(quad.subject) for quad in store.quads_for_pattern(None, None, None, FLUENTS)}
    assert any(id.endswith("/f1>") for id in ids)
    assert not any(id.endswith("/f0>") for id in ids)


def test_query_reads_fluents_and_the_situation_now(tmp_path: Path) -> None:
    with Blackboard.open(tmp_path, create=True) as board:
        fork = episodic("f2", ("t1", "isA", "fork"), start=2.0, certainty=0.9, source=SEEN)
        board.write(Add(on("f1", 1.0, 5.0)), Add(fork), by="test")
    with Session(tmp_path) as session:
        times = session.query(
            "SELECT ?start ?finish { GRAPH dxg:fluents { ?f ep:identifier 'f1' ; sosa:hasFeatureOfInterest ?cup ; "
            "ep:earliestStart ?start ; ep:latestFinish ?finish ; prov:wasAttributedTo ?who } }"
        )
        assert [[str(value).split("^")[0] for value in row] for row in times.rows] == [['"1"', '"5"']]
        kinds = session.query("SELECT ?x ?kind { GRAPH dxg:now { ?x a ?kind } }")
        assert len(kinds.rows) == 1
        with Blackboard.open(tmp_path) as board:
            board.finish("f2", 9.0, by="test")
        assert not session.query("SELECT ?x { GRAPH dxg:now { ?x a ?kind } }").rows
