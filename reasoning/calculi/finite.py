"""Tables read off a finite model: the relation of every pair of enough things tells every composition.

A model is *enough* where every way for three things to lie to each other occurs in it. Then the composition that it
shows is the composition over everything, and not just a part of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def converses_in(codes: NDArray[np.integer], atoms: int) -> NDArray[np.int64]:
    """The code of each atom's converse, shape (atoms,), from the atom of every ordered pair, ``codes`` (m, m).

    >>> converses_in(np.array([[1, 0], [2, 1]]), 3).tolist()
    [2, 1, 0]
    """
    found = np.full(atoms, -1, dtype=np.int64)
    found[codes] = codes.T
    return found


def composition_in(codes: NDArray[np.integer], atoms: int) -> NDArray[np.uint64]:
    """The composition table, shape (atoms, atoms), bit masks, from the atom of every ordered pair, ``codes`` (m, m).

    An entry holds the atom of (i, k) for every j that bears the row's atom to i's side and the column's to k's.

    >>> order = np.array([[1, 0], [2, 1]])  # of two numbers: 0 for less, 1 for equal, 2 for greater
    >>> bin(composition_in(order, 3)[0, 1])
    '0b1'
    """
    holds = np.array([codes == atom for atom in range(atoms)], dtype=np.float32)
    table = np.zeros((atoms, atoms), dtype=np.uint64)
    for first in range(atoms):
        for second in range(atoms):
            reached = holds[first] @ holds[second] > 0
            table[first, second] = sum(1 << int(code) for code in np.unique(codes[reached]))
    return table
