"""Verify facts on boxes by their atoms, independently of the search."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import RelationGraph
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.geometry.overlap import overlapping
from deixis.reasoning.geometry.rectangle import box_relations


def facts_that_hold(graph: RelationGraph, boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which edges of a graph hold of the boxes of its nodes (n, 2, 2), by the atoms that each relation admits.

    Of a word that only a model decides, such as *near*, only the admitted atoms are verified.

    Between two equal boxes, no relation holds that says which lies on the other.

    Parameters
    ----------
    graph
        The stated facts as a graph.
    boxes
        Minimum and maximum corners, shape (n, 2, 2).

    Returns
    -------
    NDArray of bool
        True for each edge that holds, shape (edges,).
    """
    a, b = boxes[graph.subjects], boxes[graph.objects]
    codes = [allen_relations(a[:, 0, axis], a[:, 1, axis], b[:, 0, axis], b[:, 1, axis]) for axis in (0, 1)]
    x, y = codes[0], codes[1]
    held = np.zeros(len(graph), dtype=np.bool_)
    for edge in range(len(graph)):
        atom = (x[edge], y[edge])
        relations = graph.vocabulary.members(int(graph.relation_sets[edge]))
        if any(relation.by_model for relation in relations):  # atoms are necessary for such a word, and deny nothing
            held[edge] = not graph.positive[edge] or any(relation.admits()[atom] for relation in relations)
            continue
        admitted = [relation for relation in relations if relation.admits()[atom]]
        undecided = any(graph.vocabulary[r.inverse].admits()[atom] for r in admitted if r.inverse != r.name)
        held[edge] = not undecided and bool(admitted) == bool(graph.positive[edge])
    return held


def facts_that_are_named(graph: RelationGraph, boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which edges hold by the one exact relation of each pair, as in grounding and checking.

    The result differs from :func:`facts_that_hold` only for boxes that overlap in part or are equal.

    Parameters
    ----------
    graph
        The stated facts as a graph.
    boxes
        Minimum and maximum corners, shape (n, 2, 2).

    Returns
    -------
    NDArray of bool
        True for each edge that holds, shape (edges,).
    """
    vocabulary = graph.vocabulary
    order = np.argsort(np.argsort(np.array(graph.nodes, dtype=np.str_)))
    names = box_relations(boxes, vocabulary, ranks=order).names if len(graph.nodes) else np.zeros((0, 0), np.int8)
    degrees = vocabulary.degrees
    held = np.zeros(len(graph), dtype=np.bool_)
    for edge in np.flatnonzero(graph.subjects != graph.objects):
        name = names[graph.subjects[edge], graph.objects[edge]]
        relations = vocabulary.members(int(graph.relation_sets[edge]))
        if any(relation.by_model for relation in relations):
            held[edge] = True
            continue
        members = [relation.index for relation in relations]
        held[edge] = bool((degrees[members, name] > 0).any()) == bool(graph.positive[edge])
    to_itself = np.flatnonzero(graph.subjects == graph.objects)
    held[to_itself] = ~graph.positive[to_itself]
    return held


def partly_overlapping(boxes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which ordered pairs of boxes (n, 2, 2) overlap in part, neither within the other, shape (n, n).

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, 2).

    Returns
    -------
    NDArray of bool
        True for each such pair, shape (n, n).
    """
    low, high = boxes[:, 0], boxes[:, 1]
    inside = ((low[:, None] >= low[None]) & (high[:, None] <= high[None])).all(axis=2)
    found: NDArray[np.bool_] = np.logical_and(overlapping(boxes), ~(inside | inside.T))
    return found
