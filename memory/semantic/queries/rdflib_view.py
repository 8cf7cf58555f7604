"""A memory as an rdflib dataset: live, to be read only, of the six canonical graphs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NoReturn

import pyoxigraph as ox

from deixis.memory.errors import MemoryFormatError
from deixis.memory.semantic.queries.sparql import check_query
from deixis.memory.semantic.queries.union import default_graph
from deixis.memory.semantic.rdf.graphs import CANONICAL, UNION

if TYPE_CHECKING:
    import rdflib


def dataset_view(store: ox.Store) -> rdflib.Dataset:
    """Return a view of a store's canonical graphs; the copies that say who contributed what are hidden."""
    import rdflib
    from oxrdflib import OxigraphStore
    from oxrdflib._converter import from_ox, to_ox_quad_pattern
    from rdflib.query import Result

    class CanonicalGraphs(OxigraphStore):
        def triples(self, triple_pattern: Any, context: Any = None) -> Iterator[Any]:
            if context is not None and str(getattr(context, "identifier", context)) != "urn:x-rdflib:default":
                return super().triples(triple_pattern, context)
            return self._union(triple_pattern)

        def _union(self, triple_pattern: Any) -> Iterator[Any]:
            seen: set[ox.Triple] = set()
            for quad in self._inner.quads_for_pattern(*to_ox_quad_pattern(triple_pattern, None)):
                if quad.graph_name in CANONICAL and quad.triple not in seen:
                    seen.add(quad.triple)
                    yield tuple(from_ox(term) for term in quad.triple), iter((None,))

        def contexts(self, triple: Any = None) -> Iterator[Any]:  # type: ignore[override]
            own = {str(graph.value) for graph in CANONICAL}
            return (graph for graph in super().contexts(triple) if str(graph.identifier) in own)

        def __len__(self, context: Any = None) -> int:
            return sum(1 for _ in self.triples((None, None, None), context))

        def query(
            self, query: Any, initNs: Mapping[str, Any], initBindings: Mapping[str, Any], queryGraph: Any, **kwargs: Any
        ) -> Result:
            if isinstance(query, str):
                check_query(query, {**self._namespace_for_prefix, **initNs})
            if queryGraph != "__UNION__":
                return super().query(query, initNs, initBindings, queryGraph, **kwargs)
            inner, self._store = self._inner, _Canonical(self._inner)  # type: ignore[assignment]
            try:
                return super().query(query, initNs, initBindings, queryGraph, **kwargs)
            finally:
                self._store = inner

        def add_graph(self, graph: Any) -> None:
            pass  # rdflib calls this when a graph is asked for

        def _refuse(self, *_: Any, **__: Any) -> NoReturn:
            raise MemoryFormatError("this view is to be read only: write through the memory's learn and forget")

        add = addN = remove = update = remove_graph = _refuse

    return rdflib.Dataset(store=CanonicalGraphs(store=store), default_union=True)


class _Canonical:
    """A store whose queries look at the canonical graphs alone."""

    def __init__(self, store: ox.Store) -> None:
        self._store = store

    def query(self, query: str, **kwargs: Any) -> Any:
        graphs = [*default_graph(self._store), *(graph for graph, name in CANONICAL.items() if name not in UNION)]
        kwargs |= {"use_default_graph_as_union": False, "default_graph": graphs, "named_graphs": [*CANONICAL]}
        return self._store.query(query, **kwargs)
