"""The order of lessons in the ledger."""

from __future__ import annotations

import pyoxigraph as ox

from deixis.memory.semantic.rdf import ledger
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri, lesson_graph
from deixis.ontology.rdf.triples import learned_iri
from deixis.ontology.rdf.vocabulary import PROV


def test_lessons_are_ordered_by_time_despite_dropped_zeros() -> None:
    store = ox.Store()
    kind = ox.NamedNode("http://www.w3.org/2001/XMLSchema#dateTime")
    for id, second in (("a", "00.120000"), ("b", "00.100000"), ("c", "01")):
        time = ox.Literal(f"2026-01-01T00:00:{second}+00:00", datatype=kind)
        node, started = ox.NamedNode(learned_iri("lesson", id)), ox.NamedNode(PROV.STARTED_AT_TIME)
        store.add(ox.Quad(node, started, time, graph_iri(GraphName.EPISODES)))
        store.add_graph(lesson_graph(id, GraphName.EPISODES))
    store.add_graph(lesson_graph("without_a_time", GraphName.EPISODES))
    assert ledger.lessons(store) == ("without_a_time", "b", "a", "c")
