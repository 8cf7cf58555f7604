"""What a picture must, or should, be like, as clauses over the edges of boxes in millimetres.

The box of object *i* has the points ``2 i`` (left or near edge) and ``2 i + 1`` (right or far edge) on each axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import Allen
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Reading
from deixis.reasoning.constraints.difference import Difference
from deixis.reasoning.constraints.disjunctive import Clause
from deixis.reasoning.entailment.realisation.pieces import Piece, choice, region
from deixis.reasoning.entailment.realisation.things import Things

MARGIN = 1
"""Millimetres by which what is strictly less is less, and the least side of a box.

Where sizes are free any margin is as good as another: inequalities of differences with 0 or with one margin on the
right go on to hold when all is enlarged, so that a proof that there is no picture rests on no margin. Where sizes are
given the margin is part of what is proved.
"""


class About(StrEnum):
    """What a demand is about."""

    FACT = "fact"  # key: the edge of the graph
    NAME = "name"  # key: the edge of a denial, which the name of the pair must not contradict
    SIZE = "size"  # key: the object
    APART = "apart"  # key: the two objects


@dataclass(frozen=True, slots=True)
class Demand:
    """Clauses that hold together, what they are about, and how much that counts where it need not hold."""

    about: About
    key: tuple[int, ...]
    clauses: tuple[Clause, ...]
    weight: float = 1.0


def low(thing: int) -> int:
    return 2 * thing


def high(thing: int) -> int:
    return 2 * thing + 1


def at_most(axis: int, tail: int, head: int, bound: int) -> Difference:
    """Return ``x[head] - x[tail] <= bound`` on an axis, in whole millimetres."""
    return Difference(axis, tail, head, 2 * bound + 1)


def proper_boxes(things: int) -> tuple[Clause, ...]:
    """Return every box has sides of a millimetre at least."""
    return tuple(Clause(((at_most(axis, high(i), low(i), -MARGIN),),)) for i in range(things) for axis in (0, 1))


def fact_demands(graph: RelationGraph) -> tuple[Demand, ...]:
    """Return one demand for every edge of the graph, in their order."""
    facts = [graph.fact(edge) for edge in range(len(graph))]
    return tuple(
        Demand(About.FACT, (edge,), _clauses(graph, edge, region(fact)), fact.weight) for edge, fact in enumerate(facts)
    )


def name_demands(graph: RelationGraph, edges: Sequence[int]) -> tuple[Demand, ...]:
    """Return for every denial among the edges: the pair's atom settles its exact name.

    Boxes that overlap in part are named by the offset of their centres. That name may be one that is denied, though
    the atom is not.
    """
    # the atoms (13, 13) that just one exact relation admits
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
    """Return one demand for every thing: that its sides are usual, one way round or the other, the preferred way
    first."""
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
    """Return the constraint that two boxes do not overlap: the side to which the least is to be moved comes first.

    ``edges`` (2, points) is where the boxes are now; ``noise`` (4,) is added to the four ways, in millimetres.
    """
    ways = [(axis, first, second) for axis in (0, 1) for first, second in ((a, b), (b, a))]
    moved = [int(edges[axis, high(first)] - edges[axis, low(second)]) for axis, first, second in ways]
    order = np.argsort(np.array(moved) + noise, kind="stable")
    pieces = tuple((at_most(ways[k][0], low(ways[k][2]), high(ways[k][1]), 0),) for k in order.tolist())
    return Demand(About.APART, (a, b), (Clause(pieces),), 0.0)


def is_firm(fact: Fact) -> bool:
    """Return whether a fact must hold: neither optional nor hedged."""
    return not fact.optional and fact.weight >= 1
