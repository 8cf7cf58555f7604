"""What the paper's matcher adds to a description: inverses, and what follows from facts of one word by transitivity.

The whole calculus (:mod:`deixis.reasoning.implications`) says more, but in the wide reading, which names no exact
relation: with it, equations 5 to 9 were seen to find fewer objects.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Relation
from deixis.reasoning.implications import Implications


def with_same_word(graph: RelationGraph, most: int) -> RelationGraph:
    """The graph with the firm facts that inverses and transitivity of single words add, after the stated ones.

    Facts that contradict each other imply everything, so that then nothing is added; nor is it where there would be
    more than ``most`` facts.

    >>> from deixis.ontology.graph import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["left"],), "b"), Fact("b", (r["top_left"],), "c")]
    >>> [str(fact) for fact in with_same_word(RelationGraph.from_facts(r, "abc", facts), 100).facts()]
    ['left(a, b)', 'top_left(b, c)', 'bottom_right(c, b)', 'right(b, a)']
    """
    if not Implications(graph, time_limit=1.0).consistent:
        return graph
    added = list(_added(graph))
    count = sum(len(pairs) for _, pairs in added)
    if not count or len(graph) + count > most:
        return graph
    pairs = np.concatenate([pairs for _, pairs in added]).astype(np.int32)
    bits = np.concatenate([np.full(len(pairs), relation.bit, np.int64) for relation, pairs in added])
    return RelationGraph(
        vocabulary=graph.vocabulary,
        nodes=graph.nodes,
        subjects=np.concatenate([graph.subjects, pairs[:, 0]]),
        objects=np.concatenate([graph.objects, pairs[:, 1]]),
        relation_sets=np.concatenate([graph.relation_sets, bits]),
        positive=np.concatenate([graph.positive, np.ones(count, np.bool_)]),
        optional=np.concatenate([graph.optional, np.zeros(count, np.bool_)]),
        weights=np.concatenate([graph.weights, np.ones(count)]),
        sources=(*graph.sources, *[None] * count) if graph.sources else (),
        kinds=graph.kinds,
        boxes=graph.boxes,
    )


def _added(graph: RelationGraph) -> Iterator[tuple[Relation, NDArray[np.int64]]]:
    """By relation the pairs that its facts and those of its inverse add."""
    firm = graph.positive & ~graph.optional & (graph.weights >= 1.0)
    for relation in graph.vocabulary.values():
        inverse = graph.vocabulary[relation.inverse]
        same = np.flatnonzero(firm & np.isin(graph.relation_sets, (relation.bit, inverse.bit)))
        if len(same):
            yield relation, _implied(graph, same, relation)


def _implied(graph: RelationGraph, edges: NDArray[np.int64], relation: Relation) -> NDArray[np.int64]:
    """The pairs of which the relation follows from these facts alone, without those of which it is stated."""
    stated = graph.relation_sets[edges] == relation.bit
    ends = np.stack([graph.subjects[edges], graph.objects[edges]], axis=1).astype(np.int64)
    n = len(graph.nodes)
    if relation.transitive:
        few = RelationGraph(
            vocabulary=graph.vocabulary,
            nodes=graph.nodes,
            subjects=graph.subjects[edges],
            objects=graph.objects[edges],
            relation_sets=graph.relation_sets[edges],
            positive=graph.positive[edges],
            optional=graph.optional[edges],
            weights=graph.weights[edges],
        )
        pairs = Implications(few).pairs(relation)
    else:
        pairs = np.unique(ends[~stated][:, ::-1], axis=0)
    known = ends[stated, 0] * n + ends[stated, 1]
    return pairs[~np.isin(pairs[:, 0] * n + pairs[:, 1], known)]
