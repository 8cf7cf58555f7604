"""The closure of a relation graph: base edges by inverse and sub-property, then shortest paths part by part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.reasoning.errors import LimitError

MAX_CONNECTED = 4000
"""Objects that facts connect to one another, at the most: memory grows with the square of this."""

FAR = np.iinfo(np.int32).max // 4
"""A distance that says: there is no way."""

Edges = dict[int, dict[tuple[int, int], int]]
"""By relation index, then by pair of nodes: the stated edge that gives it most directly."""


def firm_edges(graph: RelationGraph) -> NDArray[np.int64]:
    """The edges that inference may rest on: affirmed, not optional, of full weight, one relation."""
    single = np.bitwise_count(graph.relation_sets) == 1
    return np.flatnonzero(graph.positive & ~graph.optional & (graph.weights >= 1.0) & single)


def base_edges(graph: RelationGraph, sub_properties: bool) -> Edges:
    base: Edges = {relation.index: {} for relation in graph.vocabulary.values()}
    passes = _passes(graph.vocabulary, sub_properties)
    firm = firm_edges(graph)
    rows = list(
        zip(
            firm.tolist(),
            graph.subjects[firm].tolist(),
            graph.objects[firm].tolist(),
            (int(mask).bit_length() - 1 for mask in graph.relation_sets[firm]),
            strict=True,
        )
    )
    for give in passes:
        for edge, s, o, index in rows:
            for target, reverse in give[index]:
                base[target].setdefault((o, s) if reverse else (s, o), edge)
    return base


def _passes(vocabulary: Relations, sub_properties: bool) -> list[dict[int, list[tuple[int, bool]]]]:
    """What a stated relation gives, the more direct way first: itself; its inverse; what either implies."""
    relations = list(vocabulary.values())
    passes: list[dict[int, list[tuple[int, bool]]]] = [
        {r.index: [(r.index, False)] for r in relations},
        {r.index: [(vocabulary[r.inverse].index, True)] for r in relations},
    ]
    if sub_properties:
        passes.append({r.index: [(vocabulary[b].index, False) for b in sorted(r.broader)] for r in relations})
        passes.append(
            {r.index: [(vocabulary[b].index, True) for b in sorted(vocabulary[r.inverse].broader)] for r in relations}
        )
    return passes


class Component:
    """k objects that facts connect: per relation the steps from each to each, and the last stop before."""

    def __init__(self, nodes: NDArray[np.int64], vocabulary: Relations) -> None:
        self.nodes = nodes
        self._vocabulary = vocabulary
        self._edges: dict[int, list[tuple[int, int]]] = {}
        self._closed: dict[int, tuple[NDArray[np.int32], NDArray[np.int32]]] = {}

    def add(self, relation: int, subject: int, object: int) -> None:
        self._edges.setdefault(relation, []).append((subject, object))

    def has(self, relation: Relation) -> bool:
        """Whether any fact of the relation is stated or implied here."""
        return relation.index in self._edges

    def distance(self, relation: Relation) -> NDArray[np.int32]:
        """Steps from row to column, shape (k, k), ``FAR`` where there is no way."""
        return self._close(relation)[0]

    def path(self, relation: Relation, start: int, end: int) -> list[int]:
        before = self._close(relation)[1]
        path = [end]
        while path[-1] != start:
            path.append(int(before[start, path[-1]]))
        return path[::-1]

    def _close(self, relation: Relation) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        if relation.index not in self._closed:
            self._closed[relation.index] = self._compute(relation)
        return self._closed[relation.index]

    def _compute(self, relation: Relation) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import shortest_path

        k = len(self.nodes)
        edges = np.array(self._edges.get(relation.index, ()), dtype=np.int64).reshape(-1, 2)
        if relation.transitive and len(edges):
            ones = np.ones(len(edges))
            matrix = csr_array((ones, (edges[:, 0], edges[:, 1])), shape=(k, k))
            steps, before = shortest_path(matrix, method="D", unweighted=True, return_predecessors=True)
            return np.where(np.isfinite(steps), steps, FAR).astype(np.int32), before
        distance = np.full((k, k), FAR, dtype=np.int32)
        before = np.full((k, k), -1, dtype=np.int32)
        distance[edges[:, 0], edges[:, 1]] = 1
        before[edges[:, 0], edges[:, 1]] = edges[:, 0]
        return distance, before


def components(graph: RelationGraph, base: Edges) -> tuple[NDArray[np.int64], list[Component]]:
    """The connected parts, and where each node is: shape (n, 2), component and position in it."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import connected_components

    n = len(graph.nodes)
    if n == 0:
        return np.zeros((0, 2), dtype=np.int64), []
    links = (np.ones(len(graph)), (graph.subjects, graph.objects))
    count, labels = connected_components(csr_array(links, shape=(n, n)), directed=False)
    place = np.zeros((n, 2), dtype=np.int64)
    order = np.argsort(labels, kind="stable")
    parts = []
    for label, nodes in enumerate(np.split(order, np.cumsum(np.bincount(labels, minlength=count))[:-1])):
        if len(nodes) > MAX_CONNECTED:
            raise LimitError(
                f"the facts connect {len(nodes)} objects to one another; what follows is worked out for up to "
                f"{MAX_CONNECTED}: describe the table in parts"
            )
        place[nodes, 0] = label
        place[nodes, 1] = np.arange(len(nodes))
        parts.append(Component(nodes, graph.vocabulary))
    for relation, pairs in base.items():
        for s, o in pairs:
            parts[place[s, 0]].add(relation, int(place[s, 1]), int(place[o, 1]))
    return place, parts
