"""The hard and soft demands on a picture, as clauses over the edges of boxes in millimetres.

The box of object *i* has the points ``2 i`` (left or near edge) and ``2 i + 1`` (right or far edge) on each axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.allen import Allen
from deixis.ontology.relations.relation import Reading
from deixis.reasoning.constraints.difference import Difference
from deixis.reasoning.constraints.disjunctive import Clause
from deixis.reasoning.entailment.realisation.pieces import Piece, choice, region
from deixis.reasoning.entailment.realisation.things import Things

MARGIN = 1
"""Difference in millimetres that a strict inequality requires, and the least side of a box.

With free sizes, every margin is equivalent: inequalities of differences with 0 or one margin on the right still hold
when everything is enlarged, so that a proof that there is no picture does not depend on the margin. With given sizes,
the margin is a part of what is proved.
"""


class About(StrEnum):
    """The subject of a demand."""

    FACT = "fact"  # key: the edge of the graph
    NAME = "name"  # key: the edge of a denial, which the exact relation of the pair must not contradict
    SIZE = "size"  # key: the object
    APART = "apart"  # key: the two objects


@dataclass(frozen=True, slots=True)
class Demand:
    """Clauses that hold together, their subject, and their weight if they are soft."""

    about: About
    key: tuple[int, ...]
    clauses: tuple[Clause, ...]
    weight: float = 1.0


def low(thing: int) -> int:
    """Return the point of the left or near edge of an object.

    Parameters
    ----------
    thing
        Number of the object.

    Returns
    -------
    int
        Number of the point.
    """
    return 2 * thing


def high(thing: int) -> int:
    """Return the point of the right or far edge of an object.

    Parameters
    ----------
    thing
        Number of the object.

    Returns
    -------
    int
        Number of the point.
    """
    return 2 * thing + 1


def at_most(axis: int, tail: int, head: int, bound: int) -> Difference:
    """Return the constraint ``x[head] - x[tail] <= bound`` on an axis, in whole millimetres.

    Parameters
    ----------
    axis
        0 for x, 1 for y.
    tail
        The point that is subtracted.
    head
        The other point.
    bound
        Greatest difference, in millimetres.

    Returns
    -------
    Difference
        The constraint.
    """
    return Difference(axis, tail, head, 2 * bound + 1)


def proper_boxes(things: int) -> tuple[Clause, ...]:
    """Return the clauses that give every box sides of at least a millimetre.

    Parameters
    ----------
    things
        Number of objects.

    Returns
    -------
    tuple of Clause
        Two clauses for each object, one for each axis.
    """
    return tuple(Clause(((at_most(axis, high(i), low(i), -MARGIN),),)) for i in range(things) for axis in (0, 1))


def fact_demands(graph: RelationGraph) -> tuple[Demand, ...]:
    """Return one demand per edge of the graph, in their order.

    Parameters
    ----------
    graph
        The stated facts as a graph.

    Returns
    -------
    tuple of Demand
        The demands.
    """
    facts = [graph.fact(edge) for edge in range(len(graph))]
    return tuple(
        Demand(About.FACT, (edge,), _clauses(graph, edge, region(fact)), fact.weight) for edge, fact in enumerate(facts)
    )


def name_demands(graph: RelationGraph, edges: Sequence[int]) -> tuple[Demand, ...]:
    """Return for every denial among the edges the demand that the pair's atom determines its exact relation.

    Boxes that overlap in part have the exact relation of the offset of their centres. This may be a relation that is
    denied, although its atoms are not those of the pair.

    Parameters
    ----------
    graph
        The stated facts as a graph.
    edges
        Numbers of edges; those that are not denials are skipped.

    Returns
    -------
    tuple of Demand
        A demand for each denial.
    """
    # the atoms (13, 13) that exactly one exact relation admits
    exact = [relation.admits() for relation in graph.vocabulary.of_reading(Reading.EXACT)]
    settled: NDArray[np.bool_] = np.sum(exact, axis=0) == 1
    denials = [(edge, graph.fact(edge)) for edge in edges if not graph.positive[edge]]
    return tuple(
        Demand(About.NAME, (edge,), _clauses(graph, edge, region(fact) & settled), fact.weight)
        for edge, fact in denials
    )


def _clauses(graph: RelationGraph, edge: int, wanted: NDArray[np.bool_]) -> tuple[Clause, ...]:
    subject, thing = int(graph.subjects[edge]), int(graph.objects[edge])
    if subject == thing:
        return (Clause(((),)) if wanted[Allen.EQUALS, Allen.EQUALS] else Clause(()),)
    found = choice(wanted)
    always = Clause((_differences(found.always, subject, thing),))
    return always, Clause(tuple(_differences(piece, subject, thing) for piece in found.pieces))


def _differences(piece: Piece, subject: int, thing: int) -> tuple[Difference, ...]:
    points = (low(subject), high(subject), low(thing), high(thing))
    return tuple(at_most(i.axis, points[i.greater], points[i.lesser], -MARGIN if i.strict else 0) for i in piece)


def size_demands(things: Things) -> tuple[Demand, ...]:
    """Return one demand per object for usual sides, in either orientation, the preferred one first.

    Parameters
    ----------
    things
        The objects with their sizes.

    Returns
    -------
    tuple of Demand
        The demands.
    """
    return tuple(Demand(About.SIZE, (i,), _size_clauses(things, i)) for i in range(len(things)))


def _size_clauses(things: Things, thing: int) -> tuple[Clause, ...]:
    least, greatest = things.least[thing], things.greatest[thing]
    ways = things.ways(thing)
    pieces = tuple(_sides(thing, least[list(way)], greatest[list(way)]) for way in ways)
    always = _sides(thing, np.full(2, least.min()), np.full(2, greatest.max()))
    return Clause((always,)), Clause(pieces)


def _sides(thing: int, least: NDArray[np.int64], greatest: NDArray[np.int64]) -> tuple[Difference, ...]:
    """Return the bounds of the sides along x and y."""
    return tuple(
        difference
        for axis in (0, 1)
        for difference in (
            at_most(axis, low(thing), high(thing), int(greatest[axis])),
            at_most(axis, high(thing), low(thing), -int(least[axis])),
        )
    )


def apart_demand(a: int, b: int, edges: NDArray[np.int64], noise: NDArray[np.float64]) -> Demand:
    """Return the demand that two boxes do not overlap; the direction of the smallest move comes first.

    Parameters
    ----------
    a
        Number of one object.
    b
        Number of the other object.
    edges
        Current positions in millimetres, shape (2, points).
    noise
        Added to the four moves, in millimetres, shape (4,).

    Returns
    -------
    Demand
        One of the four moves apart.
    """
    ways = [(axis, first, second) for axis in (0, 1) for first, second in ((a, b), (b, a))]
    moved = [int(edges[axis, high(first)] - edges[axis, low(second)]) for axis, first, second in ways]
    order = np.argsort(np.array(moved) + noise, kind="stable")
    pieces = tuple((at_most(ways[k][0], low(ways[k][2]), high(ways[k][1]), 0),) for k in order.tolist())
    return Demand(About.APART, (a, b), (Clause(pieces),), 0.0)


def is_firm(fact: Fact) -> bool:
    """Return whether a fact is neither optional nor hedged, so that it must hold.

    Parameters
    ----------
    fact
        The fact.

    Returns
    -------
    bool
        True if it must hold.
    """
    return not fact.optional and fact.weight >= 1
