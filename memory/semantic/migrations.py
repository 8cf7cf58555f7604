"""Migrations of semantic memory from older formats, one version at a time."""

from __future__ import annotations

from collections.abc import Iterator

import pyoxigraph as ox

from deixis.memory.folder import Migration
from deixis.memory.semantic.queries.union import merge_if_overlapping
from deixis.memory.semantic.rdf.graphs import GRAPHS, MERGED

_GRAPHS_0 = "urn:deixis:graph:"


def _from_0(old: ox.Store, new: ox.Store) -> None:
    """Rename the graphs of version 0: ``urn:deixis:graph:learned``, and ``urn:deixis:graph:lesson:set-1:learned``."""

    def renamed() -> Iterator[ox.Quad]:
        for quad in old:
            graph = quad.graph_name
            if isinstance(graph, ox.NamedNode) and graph.value.startswith(_GRAPHS_0):
                graph = ox.NamedNode(GRAPHS + graph.value.removeprefix(_GRAPHS_0).replace(":", "/"))
            yield ox.Quad(quad.subject, quad.predicate, quad.object, graph)

    new.bulk_extend(renamed())
    merge_if_overlapping(new)


def _from_1(old: ox.Store, new: ox.Store) -> None:
    """Copy version 1, which had no statistics; the next lesson learned or forgotten computes them."""
    new.bulk_extend(old)


def _from_2(old: ox.Store, new: ox.Store) -> None:
    """Copy version 2, in whose union the ontology was missing, and make the union again."""
    new.bulk_extend(quad for quad in old if quad.graph_name != MERGED)
    merge_if_overlapping(new)


MIGRATIONS: dict[int, Migration] = {0: _from_0, 1: _from_1, 2: _from_2}
"""Migration to the next version, by version."""
