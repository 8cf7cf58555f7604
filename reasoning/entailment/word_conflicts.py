"""Contradictions between facts of graded words: things that are inside each other, and denials of what follows.

A transitive word that is not symmetric, such as *inside*, *bigger* or *higher*, orders things strictly: facts that lead
from a thing back to itself cannot all hold. A denied word contradicts facts from which it follows by the rules of
:mod:`deixis.reasoning.entailment.graded_words`.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading, Relation
from deixis.reasoning.constraints.paths import OrderGraph, ShortestPaths


def conflicting_edges(graph: RelationGraph, firm: NDArray[np.int64]) -> tuple[int, ...] | None:
    """Return the facts of the smallest contradiction between facts of graded words.

    Parameters
    ----------
    graph
        The facts.
    firm
        Edges of the facts that must hold, shape (k,).

    Returns
    -------
    tuple of int or None
        Edges of the facts; None if the words do not contradict each other.

    Examples
    --------
    >>> from deixis.ontology.graph.graph import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["inside"],), "b"), Fact("b", (r["near"],), "c"), Fact("a", (r["containing"],), "b")]
    >>> conflicting_edges(RelationGraph.from_facts(r, ["a", "b", "c"], facts), np.arange(3))
    (0, 2)
    """
    words = graph.vocabulary.of_reading(Reading.GRADED)
    graded = firm[(graph.relation_sets[firm] & sum(word.bit for word in words)) != 0]
    if not len(graded):
        return None
    positive = graph.positive[graded]
    stated = graded[positive & (np.bitwise_count(graph.relation_sets[graded]) == 1)]
    denied = graded[~positive]
    found = [*_cycles(graph, words, stated), *_denials(graph, words, stated, denied)]
    smallest = min(found, key=len, default=None)
    return None if smallest is None else tuple(sorted(smallest))


def _cycles(graph: RelationGraph, words: tuple[Relation, ...], stated: NDArray[np.int64]) -> Iterator[tuple[int, ...]]:
    """Yield the smallest set of facts that lead from a thing back to itself, for each word that orders things."""
    used = np.bitwise_or.reduce(graph.relation_sets[stated], initial=0)
    for word in words:
        inverse = graph.vocabulary[word.inverse]
        if word.is_strict_order and word.index < inverse.index and used & (_bits(graph, word) | _bits(graph, inverse)):
            cycle = _order(graph, word, stated).shortest_cycle()
            if cycle is not None:
                yield cycle


def _denials(
    graph: RelationGraph, words: tuple[Relation, ...], stated: NDArray[np.int64], denied: NDArray[np.int64]
) -> Iterator[tuple[int, ...]]:
    """Yield the smallest set of facts from which each denied fact follows, with the denial."""
    for word in words:
        edges = denied[(graph.relation_sets[denied] & word.bit) != 0].tolist()
        if not edges:
            continue
        order = _order(graph, word, stated)
        paths = ShortestPaths(order)
        for edge in edges:
            subject, obj = int(graph.subjects[edge]), int(graph.objects[edge])
            if word.transitive:
                needed = paths.path(subject, obj, strict=True)
            else:
                row = slice(int(order.first[subject]), int(order.first[subject + 1]))
                needed = tuple(order.premise[row][order.heads[row] == obj][:1].tolist()) or None
            if needed is not None:
                yield (*needed, edge)


def _order(graph: RelationGraph, word: Relation, stated: NDArray[np.int64]) -> OrderGraph:
    """Return the pairs of things of which facts state a word, its inverse, or words that imply one of them."""
    subjects, objects = graph.subjects[stated].astype(np.int64), graph.objects[stated].astype(np.int64)
    inverse = graph.vocabulary[word.inverse]
    ends: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]] = []
    for wanted, tails, heads in ((word, subjects, objects), (inverse, objects, subjects)):
        chosen = (graph.relation_sets[stated] & _bits(graph, wanted)) != 0
        ends.append((tails[chosen], heads[chosen], stated[chosen]))
    tails, heads, edges = (np.concatenate([part[k] for part in ends]) for k in range(3))
    return OrderGraph.of(len(graph.nodes), tails, heads, np.ones(len(edges), np.bool_), edges)


def _bits(graph: RelationGraph, word: Relation) -> int:
    """Return the bits of a word and of the words that imply it."""
    return sum(each.bit for each in graph.vocabulary.values() if each is word or word.name in each.broader)
