"""A memory as a live, read-only rdflib dataset of the six canonical graphs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NoReturn, cast

import pyoxigraph as ox

from deixis.memory.errors import MemoryFormatError, QueryError
from deixis.memory.semantic.queries.limits import QueryLimits
from deixis.memory.semantic.queries.results import Term, rows_within
from deixis.memory.semantic.queries.sparql import Answering, answer, check_query
from deixis.memory.semantic.queries.union import default_graph
from deixis.memory.semantic.rdf.graphs import CANONICAL, UNION

if TYPE_CHECKING:
    import rdflib


def dataset_view(store: ox.Store, answering: Answering) -> rdflib.Dataset:
    """Return a view of a store's canonical graphs, without the copies that record contributions.

    ``answering`` answers its queries, within the default limits.

    Parameters
    ----------
    store
        Store of the memory, read at each access.
    answering
        Function that answers queries, within the default limits.

    Returns
    -------
    rdflib.Dataset
        A read-only dataset.
    """
    import rdflib
    from oxrdflib import OxigraphStore
    from oxrdflib._converter import from_ox, to_ox, to_ox_quad_pattern
    from rdflib import Variable
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
            if not isinstance(query, str):  # rdflib would evaluate it in this process, where it cannot be stopped
                raise QueryError("query: the query of a memory must be a string, got a prepared query")
            if kwargs:
                raise QueryError(f"query: unknown parameter '{next(iter(kwargs))}'")
            prefixes = {prefix: str(base) for prefix, base in {**self._namespace_for_prefix, **initNs}.items()}
            if queryGraph == "__UNION__":
                default = [
                    *default_graph(self._inner),
                    *(graph for graph, name in CANONICAL.items() if name not in UNION),
                ]
            else:
                default = [ox.NamedNode(str(queryGraph))]
            checked = check_query(query, prefixes)
            found = answer(
                answering,
                query,
                checked,
                prefixes,
                None if checked.names_graphs else [graph.value for graph in default],
                None if checked.names_graphs else [graph.value for graph in CANONICAL],
                {name: cast(Term, to_ox(value)) for name, value in initBindings.items()},
                QueryLimits(),
            )
            result = Result(checked.kind.upper())
            if isinstance(found, ox.QueryBoolean):
                result.askAnswer = bool(found)
            elif isinstance(found, ox.QuerySolutions):
                result.vars = [Variable(variable.value) for variable in found.variables]
                rows = [zip(result.vars, row, strict=True) for row in rows_within(found, QueryLimits())]
                result.bindings = [
                    {name: cast(Any, from_ox(term)) for name, term in row if term is not None} for row in rows
                ]
            else:
                result.graph = rdflib.Graph()
                result.graph += [cast(Any, tuple(map(from_ox, triple))) for triple in found]
            return result

        def add_graph(self, graph: Any) -> None:
            pass  # rdflib calls this when a graph is asked for

        def _refuse(self, *_: Any, **__: Any) -> NoReturn:
            raise MemoryFormatError("this view is read-only: write with the memory's learn and forget")

        add = addN = remove = update = remove_graph = _refuse

    return rdflib.Dataset(store=CanonicalGraphs(store=store), default_union=True)
