"""Relations as choices between conjunctions of inequalities of end points.

A set of rectangle-algebra atoms is covered by products of two convex sets. Each product is one *piece*: a conjunction
of inequalities. So every fact is a choice between pieces.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact
from deixis.reasoning.geometry.allen import ConvexSet, convex_hull, convex_sets

X, Y = 0, 1


class Inequality(NamedTuple):
    """``greater`` is at least ``lesser``, or above it if ``strict``: end points of two boxes on one axis."""

    axis: int
    lesser: int
    greater: int
    strict: bool


Piece = tuple[Inequality, ...]


def region(fact: Fact) -> NDArray[np.bool_]:
    """Return the atoms that a fact admits, shape (13, 13), axes x and y, by Allen code.

    It leaves out atoms that a relation shares with its inverse, for which only heights can decide: of two equal boxes,
    one lies on the other, but a plan does not show which. This loses no pictures: unless a chain of *on* is a cycle,
    its boxes can be made smaller along it. The atoms of a graded word are necessary for it, and its denial denies none.

    Parameters
    ----------
    fact
        A fact of a graph.

    Returns
    -------
    NDArray of bool
        True for each admitted atom.
    """
    if any(relation.by_model for relation in fact.relations):
        necessary: NDArray[np.bool_] = np.logical_or.reduce([relation.admits() for relation in fact.relations])
        return necessary if fact.positive else np.ones((13, 13), dtype=np.bool_)
    admitted = np.zeros((13, 13), dtype=np.bool_)
    shared = np.zeros((13, 13), dtype=np.bool_)
    for relation in fact.relations:
        own = relation.admits()
        admitted |= own
        if relation.inverse != relation.name:
            # the inverse admits the converse atoms: the code of a converse is 12 minus the code
            shared |= own & relation.admits()[::-1, ::-1]
    return (admitted if fact.positive else ~admitted) & ~shared


@dataclass(frozen=True, slots=True)
class PieceChoice:
    """The inequalities that always hold, and the pieces of which one must hold; no pieces if no atom is admitted."""

    always: Piece
    pieces: tuple[Piece, ...]


def choice(wanted: NDArray[np.bool_]) -> PieceChoice:
    """Return inequalities that admit exactly the wanted atoms (13, 13): the convex hull, and a choice of pieces.

    The cover is greedy: each piece admits as many uncovered atoms as possible, so that the largest come first. Pieces
    may overlap. They leave out the inequalities of the hull.

    Parameters
    ----------
    wanted
        Atoms to admit, shape (13, 13), axes x and y, by Allen code.

    Returns
    -------
    PieceChoice
        The inequalities that always hold, and the pieces of which one must hold.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> choice(default_ontology().relations["left"].admits())
    PieceChoice(always=(Inequality(axis=0, lesser=1, greater=2, strict=False),), pieces=((),))
    """
    return _choice(np.ascontiguousarray(wanted, dtype=np.bool_).tobytes())


@lru_cache(maxsize=4096)
def _choice(key: bytes) -> PieceChoice:
    wanted = np.frombuffer(key, dtype=np.bool_).reshape(13, 13)
    if not wanted.any():
        return PieceChoice((), ())
    used_x, used_y = np.flatnonzero(wanted.any(axis=1)), np.flatnonzero(wanted.any(axis=0))
    always = _inequalities(X, convex_hull(_mask(used_x))) + _inequalities(Y, convex_hull(_mask(used_y)))
    pieces = tuple(tuple(i for i in piece if i not in always) for piece in _cover(wanted))
    return PieceChoice(always, ((),) if () in pieces else pieces)


def _mask(codes: NDArray[np.int64]) -> int:
    return sum(1 << code for code in codes.tolist())


def _inequalities(axis: int, convex: ConvexSet) -> Piece:
    return tuple(Inequality(axis, *order) for order in convex.orders)


def _cover(wanted: NDArray[np.bool_]) -> Iterator[Piece]:
    sets = convex_sets()
    member = (np.array([s.mask for s in sets])[:, None] >> np.arange(13) & 1).astype(np.int64)
    outside = member @ (~wanted).astype(np.int64) @ member.T
    left = wanted.copy()
    while left.any():
        gain = np.where(outside == 0, member @ left.astype(np.int64) @ member.T, 0)
        best = np.argwhere(gain == gain.max())
        x, y = max(
            best.tolist(),
            key=lambda pair: (sets[pair[0]].mask.bit_count() * sets[pair[1]].mask.bit_count(), -pair[0], -pair[1]),
        )
        yield _inequalities(X, sets[x]) + _inequalities(Y, sets[y])
        left &= ~(member[x][:, None] & member[y][None, :]).astype(np.bool_)
