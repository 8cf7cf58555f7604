"""Relations as choices between conjunctions of end-point inequalities.

A set of Allen relations is *convex* where it is what some comparisons between the end points of two intervals admit
(Nökel 1989; van Beek and Cohen 1990); there are 82. A set of rectangle-algebra atoms is covered by products of two
convex sets, and each product is one *piece*: inequalities all of which hold. So every fact is a choice of pieces.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.allen import Allen
from deixis.ontology.graph import Fact
from deixis.ontology.relation import Relation

LOW_A, HIGH_A, LOW_B, HIGH_B = range(4)
X, Y = 0, 1


class Inequality(NamedTuple):
    """``greater`` is at least ``lesser``, and above it where ``strict``: end points of two boxes on one axis."""

    axis: int
    lesser: int
    greater: int
    strict: bool


Piece = tuple[Inequality, ...]

_COMPARED = ((LOW_A, LOW_B), (HIGH_A, HIGH_B), (HIGH_A, LOW_B), (LOW_A, HIGH_B))
_SIGN_SETS: tuple[frozenset[int], ...] = tuple(
    frozenset(signs) for signs in ((-1, 0, 1), (-1, 0), (0, 1), (-1,), (1,), (0,))
)


@dataclass(frozen=True, slots=True)
class ConvexSet:
    """A convex set of Allen relations: a 13-bit mask, and which signs each of four differences of end points has."""

    mask: int
    signs: tuple[frozenset[int], ...]

    def inequalities(self, axis: int) -> Piece:
        """The comparisons between the end points of a and b that admit just these relations."""
        found: list[Inequality] = []
        for (a, b), signs in zip(_COMPARED, self.signs, strict=True):
            if 1 not in signs:
                found.append(Inequality(axis, a, b, 0 not in signs))
            if -1 not in signs:
                found.append(Inequality(axis, b, a, 0 not in signs))
        return tuple(found)


@lru_cache(maxsize=1)
def convex_sets() -> tuple[ConvexSet, ...]:
    """All 82 convex sets, each with as few comparisons as do.

    >>> len(convex_sets())
    82
    """
    found: dict[int, ConvexSet] = {}
    signatures = [_signature(relation) for relation in Allen]
    for signs in sorted(product(_SIGN_SETS, repeat=4), key=lambda signs: sum(len(s) < 3 for s in signs)):
        mask = 0
        for code, signature in enumerate(signatures):
            if all(sign in admitted for sign, admitted in zip(signature, signs, strict=True)):
                mask |= 1 << code
        if mask:
            found.setdefault(mask, ConvexSet(mask, signs))
    return tuple(found.values())


_EXAMPLES = ((0, 1), (0, 2), (0, 3), (0, 4), (0, 5), (2, 3), (2, 4), (2, 5), (3, 3.5), (3, 4), (3, 5), (4, 5), (5, 6))
"""An interval in each relation, by code, to the interval from 2 to 4."""


def _signature(relation: Allen) -> tuple[int, ...]:
    """The signs of the four compared differences of two proper intervals in a relation."""
    points = (*_EXAMPLES[relation], 2, 4)
    return tuple((points[a] > points[b]) - (points[a] < points[b]) for a, b in _COMPARED)


def region(fact: Fact) -> NDArray[np.bool_]:
    """The atoms that a fact admits, shape (13, 13), axes x and y, by Allen code.

    Where a relation and its inverse share an atom, heights tell them apart: of two boxes that are alike one lies on
    the other, and a plan does not say which. No fact is pictured by such an atom. Nothing is lost by that: where a
    chain of *on* does not come back to where it began, its boxes can be made to shrink along it.
    """
    admitted = np.zeros((13, 13), dtype=np.bool_)
    shared = np.zeros((13, 13), dtype=np.bool_)
    for relation in fact.relations:
        own = relation.admits()
        admitted |= own
        if relation.inverse != relation.name:
            shared |= own & _converse(relation)
    return (admitted if fact.positive else ~admitted) & ~shared


def _converse(relation: Relation) -> NDArray[np.bool_]:
    """The atoms that the inverse of a relation admits: the code of a converse is 12 minus the code."""
    return relation.admits()[::-1, ::-1]


@dataclass(frozen=True, slots=True)
class Choice:
    """What holds in any case, and pieces of which one holds besides: none where nothing is admitted."""

    always: Piece
    pieces: tuple[Piece, ...]


def choice(wanted: NDArray[np.bool_]) -> Choice:
    """Inequalities that admit just the wanted atoms (13, 13): those of the convex hull, and a choice of pieces.

    Pieces may overlap, and the largest come first: the cover is greedy, each piece admits as many atoms that are not
    yet covered as any can. What the hull says already is left out of them.

    >>> from deixis.ontology.tbox import default_ontology
    >>> choice(default_ontology().relations["left"].admits())
    Choice(always=(Inequality(axis=0, lesser=1, greater=2, strict=False),), pieces=((),))
    """
    return _choice(np.ascontiguousarray(wanted, dtype=np.bool_).tobytes())


@lru_cache(maxsize=4096)
def _choice(key: bytes) -> Choice:
    wanted = np.frombuffer(key, dtype=np.bool_).reshape(13, 13)
    if not wanted.any():
        return Choice((), ())
    used_x, used_y = np.flatnonzero(wanted.any(axis=1)), np.flatnonzero(wanted.any(axis=0))
    always = _hull(used_x).inequalities(X) + _hull(used_y).inequalities(Y)
    pieces = tuple(tuple(i for i in piece if i not in always) for piece in _cover(wanted))
    return Choice(always, ((),) if () in pieces else pieces)


def _hull(codes: NDArray[np.int64]) -> ConvexSet:
    """The least convex set that has all these Allen relations; convex sets meet in convex sets."""
    mask = sum(1 << code for code in codes.tolist())
    return min((s for s in convex_sets() if s.mask & mask == mask), key=lambda s: s.mask.bit_count())


def _cover(wanted: NDArray[np.bool_]) -> Iterator[Piece]:
    sets = convex_sets()
    member = (np.array([s.mask for s in sets])[:, None] >> np.arange(13) & 1).astype(np.int64)
    outside = member @ (~wanted).astype(np.int64) @ member.T
    left = wanted.copy()
    while left.any():
        gain = np.where(outside == 0, member @ left.astype(np.int64) @ member.T, 0)
        best = np.argwhere(gain == gain.max())
        x, y = max(best.tolist(), key=lambda pair: (_size(sets[pair[0]], sets[pair[1]]), -pair[0], -pair[1]))
        yield sets[x].inequalities(X) + sets[y].inequalities(Y)
        left &= ~(member[x][:, None] & member[y][None, :]).astype(np.bool_)


def _size(x: ConvexSet, y: ConvexSet) -> int:
    return x.mask.bit_count() * y.mask.bit_count()


def admitted_by(piece: Piece) -> NDArray[np.bool_]:
    """The atoms that inequalities admit together, shape (13, 13): the inverse of :func:`choice`."""
    axes = [np.array([_holds(piece, axis, relation) for relation in Allen]) for axis in (X, Y)]
    found: NDArray[np.bool_] = axes[X][:, None] & axes[Y][None, :]
    return found


def _holds(piece: Piece, axis: int, relation: Allen) -> bool:
    points = (*_EXAMPLES[relation], 2, 4)
    return all(_satisfied(points, inequality) for inequality in _on(piece, axis))


def _on(piece: Piece, axis: int) -> Iterator[Inequality]:
    return (inequality for inequality in piece if inequality.axis == axis)


def _satisfied(points: tuple[float, ...], inequality: Inequality) -> bool:
    lesser, greater = points[inequality.lesser], points[inequality.greater]
    return lesser < greater if inequality.strict else lesser <= greater
