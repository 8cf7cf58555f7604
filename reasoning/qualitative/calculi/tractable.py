"""Define tractable subclasses: sets of relations whose consistency algebraic closure decides.

A search splits any other relation into these, so that it branches over few large pieces and not over many atoms. Each
subclass is computed from its definition, and closed under converse, intersection and weak composition.
"""

from __future__ import annotations

from functools import cache
from itertools import product

from deixis.reasoning.geometry.allen import convex_hull
from deixis.reasoning.qualitative.calculi.calculus import Subclass, bits

_PLACES = ((0, 0), (0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (1, 3), (1, 4), (2, 2), (2, 3), (2, 4), (3, 4), (4, 4))
"""Places of a's begin and a's end, by Allen code: 0 before b, 1 at its begin, 2 within, 3 at its end, 4 after it."""


def _dimension(relation: int) -> int:
    """Return the greatest number of a's end points that are free to move; -1 for the empty relation (Ligozat 1996)."""
    return max((2 - sum(place % 2 for place in _PLACES[code]) for code in bits(relation)), default=-1)


def convex_closure(relation: int) -> int:
    """Return the least convex Allen relation above another one: an interval in the lattice of places (Ligozat 1996).

    Parameters
    ----------
    relation
        Allen relation as a bit mask.

    Returns
    -------
    int
        Convex relation as a bit mask; 0 for the empty relation.

    Examples
    --------
    >>> bin(convex_closure(0b101))
    '0b111'
    """
    return convex_hull(relation).mask if relation else 0


def _is_preconvex(relation: int) -> bool:
    return not relation or _dimension(convex_closure(relation) & ~relation) < _dimension(relation)


@cache
def _pointizable() -> frozenset[int]:
    """Return the conjunctions of point relations between end points: one of eight for each of the four pairs."""
    signs = [[(place > end) - (place < end) + 1 for end in (1, 3)] for place in range(5)]
    found = set()
    for wanted in product(range(8), repeat=4):
        found.add(
            sum(
                1 << code
                for code, (begin, end) in enumerate(_PLACES)
                if all(want >> sign & 1 for want, sign in zip(wanted, signs[begin] + signs[end], strict=True))
            )
        )
    return frozenset(found)


EVERY_ORDER = Subclass("every relation", 3, lambda relation: True, "van Beek 1992")
"""All relations of the point algebra."""

ORD_HORN = Subclass("ORD-Horn", 13, _is_preconvex, "Nebel and Bürckert 1995; as pre-convex relations Ligozat 1996")
"""The only maximal tractable subclass of Allen's algebra that has all atoms."""

CONVEX = Subclass("convex", 13, lambda relation: convex_closure(relation) == relation, "Nökel 1989; Ligozat 1996")
"""Relations for which closure is also minimal: each atom left occurs in a solution (van Beek and Cohen 1990)."""

POINTIZABLE = Subclass("pointizable", 13, lambda relation: relation in _pointizable(), "Vilain and Kautz 1986")
"""Relations that the point algebra can state about end points."""

_DC, _EC, _PO, _TPP, _NTPP, _TPPI, _NTPPI, _EQ = (1 << code for code in range(8))
_PARTS, _WHOLES = _TPP | _NTPP, _TPPI | _NTPPI


def _both_ways(relation: int) -> bool:
    """Return True if either of the two may be part of the other, but they may not overlap partially."""
    return not relation & _PO and bool(relation & _PARTS) and bool(relation & _WHOLES)


def _in_h8(relation: int) -> bool:
    skips = (relation & (_EQ | _NTPP | _TPP) == _EQ | _NTPP) or (relation & (_EQ | _NTPPI | _TPPI) == _EQ | _NTPPI)
    return not _both_ways(relation) and not skips


def _in_c8(relation: int) -> bool:
    within = relation & (_PARTS | _WHOLES | _EQ)
    return not _both_ways(relation) and not (relation & _EC and not relation & _PO and within)


def _in_q8(relation: int) -> bool:
    within = relation & (_PARTS | _WHOLES)
    return not _both_ways(relation) and not (relation & _EQ and not relation & _PO and within)


RCC8_HORN = Subclass("Ĥ8", 8, _in_h8, "Renz and Nebel 1999")
"""The largest set of RCC-8 relations that a Horn formula states; it has all atoms."""

RCC8_C8 = Subclass("C8", 8, _in_c8, "Renz 1999")
RCC8_Q8 = Subclass("Q8", 8, _in_q8, "Renz 1999")
"""The only other maximal tractable subclasses that have all atoms, together with Ĥ8 (Renz 1999): C8 and Q8."""

_RCC8_OF_RCC5 = (_DC | _EC, _PO, _PARTS, _WHOLES, _EQ)


def rcc8_of_rcc5(relation: int) -> int:
    """Return the RCC-8 relation equivalent to a relation of RCC-5, which ignores boundaries.

    Parameters
    ----------
    relation
        Relation of RCC-5 as a bit mask.

    Returns
    -------
    int
        Relation of RCC-8 as a bit mask.

    Examples
    --------
    >>> bin(rcc8_of_rcc5(0b00001))
    '0b11'
    """
    return sum(_RCC8_OF_RCC5[code] for code in bits(relation))


RCC5_HORN = Subclass("Ĥ5", 5, lambda relation: _in_h8(rcc8_of_rcc5(relation)), "Renz and Nebel 1999")
"""RCC-5 relations that are in Ĥ8: the only maximal tractable subclass that has all atoms."""
