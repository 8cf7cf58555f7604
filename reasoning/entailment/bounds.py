"""The meaning of relations as bounds between end points of boxes.

On each axis a box has a low and a high edge, the low one before the high one. A *bound* states that one edge lies
before another, or not after it. A convex set of Allen relations (:mod:`deixis.reasoning.geometry.allen`) is a
conjunction of bounds; any other set is a disjunction of such conjunctions, its *alternatives*. A relation word is one
product of Allen relations, so it is a conjunction of bounds over two or three axes: an object *on* another lies within
its outline and reaches higher. The denial of a conjunction is the disjunction of the denials of its bounds.

A *point* is a number: ``(2 * axis + side) * n + object`` for n objects, with side 0 for low and 1 for high.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact
from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.ontology.relations.relation import Reading, Relation
from deixis.reasoning.constraints.difference import STRICT, ZERO, Difference
from deixis.reasoning.geometry.allen import EndOrder, admitted, convex_hull, convex_pieces

AXES = 3
"""Number of axes: x to the viewer's right, y away from the viewer, z up."""

EDGES = (("left edge", "right edge"), ("near edge", "far edge"), ("underside", "top side"))
"""Names of the low and the high edge of a box on each axis."""


@dataclass(frozen=True, slots=True, order=True)
class Bound:
    """The order of two edges: one is before the other (``strict``) or not after it; 0 is the subject, 1 the object."""

    axis: int
    tail: int  # the owner of the first edge
    tail_side: int
    head: int
    head_side: int
    strict: bool

    def denied(self) -> Bound:
        """Return the negation of the bound.

        Returns
        -------
        Bound
            The opposite bound: strict if this one is not, and not strict if this one is.
        """
        return Bound(self.axis, self.head, self.head_side, self.tail, self.tail_side, not self.strict)

    def reversed(self) -> Bound:
        """Return the bound with subject and object exchanged.

        Returns
        -------
        Bound
            The bound.
        """
        return Bound(self.axis, 1 - self.tail, self.tail_side, 1 - self.head, self.head_side, self.strict)

    def points(self, subject: int, obj: int, n: int) -> tuple[int, int]:
        """Return the two points of the bound.

        Parameters
        ----------
        subject, obj
            Positions of the two objects.
        n
            Number of objects.

        Returns
        -------
        tuple
            Tail and head, among the points of all axes.
        """
        ends = (subject, obj)
        return (
            (2 * self.axis + self.tail_side) * n + ends[self.tail],
            (2 * self.axis + self.head_side) * n + ends[self.head],
        )

    def difference(self, subject: int, obj: int, n: int) -> Difference:
        """Return the difference constraint of the bound.

        On each axis, object k of n has the points k (low) and n + k (high).

        Parameters
        ----------
        subject, obj
            Positions of the two objects.
        n
            Number of objects.

        Returns
        -------
        Difference
            The constraint.
        """
        ends = (subject, obj)
        code = STRICT if self.strict else ZERO
        return Difference(self.axis, self.head_side * n + ends[self.head], self.tail_side * n + ends[self.tail], code)


Conjunction = tuple[Bound, ...]
Alternatives = tuple[Conjunction, ...]
"""A disjunction of conjunctions of bounds; empty if it cannot hold."""


@dataclass(frozen=True, slots=True)
class Order:
    """A bound between the edges of two named objects, as a claim that can be derived."""

    subject: str
    object: str
    bound: Bound

    def __str__(self) -> str:
        ends = (self.subject, self.object)
        names = EDGES[self.bound.axis]
        tail = f"{names[self.bound.tail_side]} of {ends[self.bound.tail]}"
        head = f"{names[self.bound.head_side]} of {ends[self.bound.head]}"
        return f"{tail} {'<' if self.bound.strict else '<='} {head}"


@dataclass(frozen=True, eq=False)
class EndpointBounds:
    """k bounds between points: ``tail`` is before ``head``, or not after it if not ``strict``.

    ``premise`` is the premise that each bound comes from, as a position in a list of the caller.
    """

    tail: NDArray[np.int64]  # (k,)
    head: NDArray[np.int64]  # (k,)
    strict: NDArray[np.bool_]  # (k,)
    premise: NDArray[np.int64]  # (k,)

    def __len__(self) -> int:
        return len(self.tail)

    def of_premises(self, chosen: NDArray[np.bool_]) -> EndpointBounds:
        """Return the bounds of some premises.

        Parameters
        ----------
        chosen
            Mask over the premises.

        Returns
        -------
        EndpointBounds
            The bounds.
        """
        keep = chosen[self.premise]
        return EndpointBounds(self.tail[keep], self.head[keep], self.strict[keep], self.premise[keep])

    def joined(self, other: EndpointBounds) -> EndpointBounds:
        """Return these bounds and others.

        Parameters
        ----------
        other
            The others.

        Returns
        -------
        EndpointBounds
            The bounds, these first.
        """
        return EndpointBounds(
            np.concatenate([self.tail, other.tail]),
            np.concatenate([self.head, other.head]),
            np.concatenate([self.strict, other.strict]),
            np.concatenate([self.premise, other.premise]),
        )


def bounds_of(rows: list[tuple[int, int, bool, int]]) -> EndpointBounds:
    """Return bounds from rows of tail, head, strict and premise.

    Parameters
    ----------
    rows
        The rows; an empty list gives no bounds.

    Returns
    -------
    EndpointBounds
        The bounds.
    """
    tail, head, strict, premise = zip(*rows, strict=True) if rows else ((), (), (), ())
    return EndpointBounds(
        np.array(tail, np.int64), np.array(head, np.int64), np.array(strict, np.bool_), np.array(premise, np.int64)
    )


def order_differences(
    tail: NDArray[np.int64], head: NDArray[np.int64], strict: NDArray[np.bool_], n: int
) -> NDArray[np.int64]:
    """Return bounds between points of objects as difference constraints; see :meth:`Bound.difference`.

    Parameters
    ----------
    tail, head
        Points of each bound, shape (k,).
    strict
        True for strict bounds, shape (k,).
    n
        Number of objects.

    Returns
    -------
    ndarray
        The constraints, shape (k, 4).
    """
    codes = np.where(strict, STRICT, ZERO)
    return np.stack([tail // (2 * n), head % (2 * n), tail % (2 * n), codes], axis=1).astype(np.int64)


@lru_cache(maxsize=256)
def meaning(relation: Relation) -> Alternatives:
    """Return the meaning of a relation: one conjunction of bounds if it is convex on every axis.

    The conjunction is empty for a word that says nothing about the order of edges, such as *near*.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> [str(Order("a", "b", bound)) for bound in meaning(r["top_left"])[0]]
    ['right edge of a <= left edge of b', 'far edge of b <= near edge of a']
    """
    masks = (relation.x_atoms, relation.y_atoms, relation.z_atoms or ALL_ALLEN)
    axes = [convex_parts(axis, mask) for axis, mask in enumerate(masks)]
    return tuple(tuple(bound for part in parts for bound in part) for parts in product(*axes))


@lru_cache(maxsize=256)
def denial(relation: Relation) -> Alternatives:
    """Return the meaning of the denial of a relation: one bound of every alternative fails."""
    parts = product(*([bound.denied() for bound in conjunction] for conjunction in meaning(relation)))
    return tuple(tuple(dict.fromkeys(part)) for part in parts)


@lru_cache(maxsize=1024)
def common(alternatives: Alternatives) -> Conjunction:
    """Return the bounds that hold in all alternatives: the convex hull on every axis.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> [str(Order("a", "b", bound)) for bound in common((*meaning(r["left"]), *meaning(r["top_left"])))]
    ['right edge of a <= left edge of b']
    """
    shared: list[Bound] = []
    for axis in range(AXES):
        mask = 0
        for part in alternatives:
            mask |= admitted(tuple(_end_order(bound) for bound in part if bound.axis == axis))
        shared += [_bound(axis, order) for order in convex_hull(mask).orders] if mask else []
    return tuple(shared)


def claims(fact: Fact) -> tuple[Alternatives, ...]:
    """Return the demands of a fact, all of which must hold: one demand, or one for every relation that it denies.

    The denial of a graded word demands nothing, because its bounds are necessary for it, not sufficient.

    Parameters
    ----------
    fact
        The fact.

    Returns
    -------
    tuple of Alternatives
        The demands, each a list of alternatives.
    """
    if not fact.positive:
        return tuple(denial(relation) for relation in fact.relations if relation.reading is not Reading.GRADED)
    if any(meaning(relation) == ((),) for relation in fact.relations):
        return ()
    return (tuple(dict.fromkeys(part for relation in fact.relations for part in meaning(relation))),)


@lru_cache(maxsize=1024)
def convex_parts(axis: int, mask: int) -> Alternatives:
    """Return a set of Allen relations on an axis as a disjunction of conjunctions of bounds, largest parts first."""
    return tuple(tuple(_bound(axis, order) for order in piece.orders) for piece in convex_pieces(mask))


def _end_order(bound: Bound) -> EndOrder:
    """Return a bound as an order of two of the four end points."""
    return EndOrder(2 * bound.tail + bound.tail_side, 2 * bound.head + bound.head_side, bound.strict)


def _bound(axis: int, order: EndOrder) -> Bound:
    """Return the bound of an order of two of four end points: the subject's, then the object's, each low one first."""
    return Bound(axis, *divmod(order.lesser, 2), *divmod(order.greater, 2), order.strict)
