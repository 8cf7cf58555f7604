"""Check the laws that a converse and a composition must obey, for tables read from elsewhere.

The relations between three things can be read in six ways, starting from either end of each side of the triangle. In a
calculus all six readings allow the same triangles: the converse of a composition is the composition of the converses in
reverse order, and the cycle law holds (Ligozat and Renz 2004). Where tables contradict themselves, a triangle is
possible only if all six readings allow it: if every entry contains everything that is possible, nothing possible is
lost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.errors import CalculusError
from deixis.reasoning.qualitative.calculi.words import atoms_within, words_with


@dataclass(frozen=True)
class Violation:
    """A law that the tables break: how many entries break it, and the first of them as two atoms."""

    law: str
    entries: int
    first: tuple[int, int]


def lawful(
    converses: NDArray[np.int64], composition: NDArray[np.uint64], identity: int
) -> tuple[NDArray[np.uint64], tuple[Violation, ...]]:
    """Return the part of a composition table that obeys the laws, and the laws that the whole table breaks.

    Parameters
    ----------
    converses : ndarray, (k,)
        The code of each atom's converse.
    composition : ndarray, (k, k) or (k, k, words)
        Bit masks of atoms, or words of 64 atoms; row: a to b, column: b to c.
    identity : int
        The code of the atom between everything and itself.

    Returns
    -------
    composition : ndarray
        The atoms that all six readings of a triangle allow, in the shape given.
    violations : tuple of Violation
        The laws that the given table breaks. An identity that is not neutral is reported and not repaired.

    Raises
    ------
    CalculusError
        If the converse of a converse is another atom: such tables have no meaning.

    Examples
    --------
    >>> order = np.array([[0b001, 0b001, 0b111], [0b001, 0b010, 0b100], [0b111, 0b100, 0b101]], dtype=np.uint64)
    >>> table, violations = lawful(np.array([2, 1, 0]), order, 1)
    >>> bin(table[2, 2]), [(each.law, each.entries, each.first) for each in violations]
    ('0b100', [('converse of composition', 2, (0, 0)), ('cycle law', 2, (0, 0))])
    """
    size = len(converses)
    turned = converses[converses]
    if (turned != np.arange(size)).any():
        wrong = int(np.flatnonzero(turned != np.arange(size))[0])
        raise CalculusError("the converse of a converse must be the atom itself", wrong)
    possible = atoms_within(composition.reshape(size, size, -1), size)  # (a to b, b to c, a to c)
    violations = []
    neutral = np.eye(size, dtype=np.bool_)
    unlike = np.zeros((size, size), dtype=np.bool_)
    unlike[identity] = (possible[identity] != neutral).any(axis=1)
    unlike[:, identity] |= (possible[:, identity] != neutral).any(axis=1)
    laws = (
        ("identity", unlike),
        ("converse of composition", (possible != _from_the_other_end(possible, converses)).any(axis=2)),
        ("cycle law", (possible != _by_another_side(possible, converses)).any(axis=2)),
    )
    for law, wrong_entries in laws:
        if wrong_entries.any():
            first = np.argwhere(wrong_entries)[0]
            violations.append(Violation(law, int(wrong_entries.sum()), (int(first[0]), int(first[1]))))
    before = -1
    while before != possible.sum():
        before = int(possible.sum())
        possible = possible & _from_the_other_end(possible, converses)
        possible = possible & _by_another_side(possible, converses)
    return words_with(possible).reshape(composition.shape), tuple(violations)


def _from_the_other_end(possible: NDArray[np.bool_], converses: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return the table read from the other end: entry (a, b, x) is the given entry of b's, a's and x's converse."""
    return possible.transpose(1, 0, 2)[np.ix_(converses, converses, converses)]


def _by_another_side(possible: NDArray[np.bool_], converses: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return the table read by another side: entry (a, b, x) is the given entry of x, b's converse and a."""
    return possible.transpose(2, 1, 0)[:, converses, :]
