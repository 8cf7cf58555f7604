"""The demands of the firm facts of a relation graph: bounds between edges, and choices between several.

A fact is firm if it is neither hedged (of weight below 1) nor optional; only firm facts are premises of inference.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.constraints.disjunctive import Clause
from deixis.reasoning.entailment.bounds import Alternatives, EndpointBounds, bounds_of, claims, common, meaning


@dataclass(frozen=True)
class Choice:
    """A choice between alternatives for two objects, one of which must hold; ``premise`` is the fact that demands it.

    Each alternative is a product of convex relations, the tractable pieces into which a rectangle-algebra relation is
    split (Balbiani, Condotta and Fariñas del Cerro 1999), so consistent alternatives have a picture.
    """

    alternatives: Alternatives
    subject: int
    object: int
    premise: int

    def clause(self, n: int) -> Clause:
        """Return the alternatives as difference constraints between the points of n objects.

        Parameters
        ----------
        n
            Number of objects.

        Returns
        -------
        Clause
            One piece for each alternative.
        """
        return Clause(
            tuple(
                tuple(bound.difference(self.subject, self.object, n) for bound in conjunction)
                for conjunction in self.alternatives
            )
        )


@dataclass(frozen=True, eq=False)
class Demands:
    """The demands of a graph's firm facts; premises are numbered as the edges of the graph.

    The bounds include those common to all alternatives of a choice, so that much follows without a search.
    """

    graph: RelationGraph
    firm: NDArray[np.int64]  # the edges of firm facts
    bounds: EndpointBounds
    choices: tuple[Choice, ...]

    def restricted(self, edges: Iterable[int]) -> Demands:
        """Return the demands of some of the facts.

        Parameters
        ----------
        edges
            Edges of the facts in the graph.

        Returns
        -------
        Demands
            The demands.
        """
        chosen = np.zeros(len(self.graph), np.bool_)
        chosen[list(edges)] = True
        return Demands(
            self.graph,
            self.firm[chosen[self.firm]],
            self.bounds.of_premises(chosen),
            tuple(choice for choice in self.choices if chosen[choice.premise]),
        )


class EdgeFacts(Sequence[Fact]):
    """A graph's edges as facts, each made on first use and cached."""

    def __init__(self, graph: RelationGraph) -> None:
        self._graph = graph
        self._made: dict[int, Fact] = {}

    def __len__(self) -> int:
        return len(self._graph)

    @overload
    def __getitem__(self, edge: int) -> Fact: ...
    @overload
    def __getitem__(self, edge: slice) -> list[Fact]: ...
    def __getitem__(self, edge: int | slice) -> Fact | list[Fact]:
        if isinstance(edge, slice):
            return [self[k] for k in range(*edge.indices(len(self)))]
        if edge not in self._made:
            if not -len(self) <= edge < len(self):
                raise IndexError(edge)
            self._made[edge] = self._graph.fact(edge)
        return self._made[edge]


def demands_of(graph: RelationGraph) -> Demands:
    """Return the demands of the firm facts of a graph.

    Parameters
    ----------
    graph
        The graph.

    Returns
    -------
    Demands
        Bounds that must hold, and choices.
    """
    firm = np.flatnonzero(~graph.optional & (graph.weights >= 1.0) & (graph.relation_sets != 0))
    single = graph.positive[firm] & (np.bitwise_count(graph.relation_sets[firm]) == 1)
    bounds = _plain_bounds(graph, firm[single])
    choices: list[Choice] = []
    rows: list[tuple[int, int, bool, int]] = []
    n = len(graph.nodes)
    for edge in [*firm[~single].tolist(), *_of_several_parts(graph, firm[single])]:
        s, o = int(graph.subjects[edge]), int(graph.objects[edge])
        for alternatives in claims(graph.fact(edge)):
            if len(alternatives) == 1:
                rows += [(*bound.points(s, o, n), bound.strict, edge) for bound in alternatives[0]]
            else:
                choices.append(Choice(alternatives, s, o, edge))
                rows += [(*bound.points(s, o, n), bound.strict, edge) for bound in common(alternatives)]
    return Demands(graph, firm, bounds.joined(bounds_of(rows)) if rows else bounds, tuple(choices))


def demands_of_facts(vocabulary: Relations, facts: Sequence[Fact]) -> Demands:
    """Return the demands of a list of facts among the objects that they name.

    Parameters
    ----------
    vocabulary
        Relations of the ontology.
    facts
        The facts.

    Returns
    -------
    Demands
        Bounds that must hold, and choices.
    """
    names = tuple(dict.fromkeys(name for fact in facts for name in (fact.subject, fact.object)))
    return demands_of(RelationGraph.from_facts(vocabulary, names, facts))


def _relations(graph: RelationGraph, edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the index of each edge's single relation."""
    return np.round(np.log2(graph.relation_sets[edges])).astype(np.int64)


def _of_several_parts(graph: RelationGraph, edges: NDArray[np.int64]) -> list[int]:
    several = np.array([len(meaning(relation)) != 1 for relation in graph.vocabulary.values()], np.bool_)
    return [int(edge) for edge in edges[several[_relations(graph, edges)]]] if several.any() else []


def _plain_bounds(graph: RelationGraph, edges: NDArray[np.int64]) -> EndpointBounds:
    """Return the bounds of facts that affirm one relation with a single conjunction, in the order of the edges."""
    n = len(graph.nodes)
    relations = _relations(graph, edges)
    subjects, objects = graph.subjects[edges].astype(np.int64), graph.objects[edges].astype(np.int64)
    parts: list[tuple[NDArray[np.int64], NDArray[np.int64], bool, NDArray[np.int64]]] = []
    for relation in graph.vocabulary.values():
        chosen = np.flatnonzero(relations == relation.index)
        alternatives = meaning(relation)
        if not len(chosen) or len(alternatives) != 1:
            continue
        ends = (subjects[chosen], objects[chosen])
        for bound in alternatives[0]:
            tail = (2 * bound.axis + bound.tail_side) * n + ends[bound.tail]
            head = (2 * bound.axis + bound.head_side) * n + ends[bound.head]
            parts.append((tail, head, bound.strict, edges[chosen]))
    if not parts:
        return bounds_of([])
    tail, head, premise = (np.concatenate([part[k] for part in parts]) for k in (0, 1, 3))
    strict = np.repeat([part[2] for part in parts], [len(part[0]) for part in parts])
    order = np.argsort(premise, kind="stable")
    return EndpointBounds(tail[order], head[order], strict[order], premise[order])
