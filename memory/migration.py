"""Older memories, brought up to date one version at a time.

To change how a memory is kept: raise :data:`VERSION`, and add the step from the version before to :data:`MIGRATIONS`.
A step reads the old store and fills a new one; it is run on a copy that replaces the old one only when it is whole.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pyoxigraph as ox

from deixis.memory.graphs import GRAPHS
from deixis.memory.merged import merge_if_overlapping

VERSION = 1

_GRAPHS_0 = "urn:deixis:graph:"


def _from_0(old: ox.Store, new: ox.Store) -> None:
    """Version 0 named its graphs ``urn:deixis:graph:learned``, a lesson's ``urn:deixis:graph:lesson:set-1:learned``."""

    def renamed() -> Iterator[ox.Quad]:
        for quad in old:
            graph = quad.graph_name
            if isinstance(graph, ox.NamedNode) and graph.value.startswith(_GRAPHS_0):
                graph = ox.NamedNode(GRAPHS + graph.value.removeprefix(_GRAPHS_0).replace(":", "/"))
            yield ox.Quad(quad.subject, quad.predicate, quad.object, graph)

    new.bulk_extend(renamed())
    merge_if_overlapping(new)


MIGRATIONS: dict[int, Callable[[ox.Store, ox.Store], None]] = {0: _from_0}
"""From a version to the step that leads to the next."""
