"""Derive the calculi of ordered numbers from finite models: points, intervals, rectangles, blocks, cardinal directions.

A model is *enough* if every possible arrangement of three things occurs in it. Then the composition in the model is the
composition over all things, and not just a part of it.

No composition is typed in. Three numbers have at most three different values, and three intervals at most six different
end points: the model of all numbers below three, or of all intervals between six of them, is enough.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.allen import SYMBOLS, Allen
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.calculus import ProductCalculus, TableCalculus
from deixis.reasoning.qualitative.calculi.tractable import EVERY_ORDER, ORD_HORN


def converses_in(codes: NDArray[np.integer], atoms: int) -> NDArray[np.int64]:
    """Return the code of each atom's converse, from the atom of every ordered pair of some things.

    Parameters
    ----------
    codes
        Code of the atom of each ordered pair of m things, shape (m, m).
    atoms
        Number of atoms of the calculus.

    Returns
    -------
    ndarray
        Code of each converse, shape (atoms,); -1 for an atom that no pair has.

    Examples
    --------
    >>> converses_in(np.array([[1, 0], [2, 1]]), 3).tolist()
    [2, 1, 0]
    """
    found = np.full(atoms, -1, dtype=np.int64)
    found[codes] = codes.T
    return found


def composition_in(codes: NDArray[np.integer], atoms: int) -> NDArray[np.uint64]:
    """Return the composition table, from the atom of every ordered pair of some things.

    An entry holds the atoms of all pairs i, k for which some j has the row's atom from i and the column's to k.

    Parameters
    ----------
    codes
        Code of the atom of each ordered pair of m things, shape (m, m).
    atoms
        Number of atoms of the calculus, at most 64.

    Returns
    -------
    ndarray
        Bit masks of the atoms, shape (atoms, atoms).

    Examples
    --------
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


POINT_ATOMS = ("<", "=", ">")
_POINT_ALIASES = {"lt": "<", "eq": "=", "==": "=", "gt": ">", "before": "<", "equals": "=", "after": ">"}

_ALLEN_ALIASES = {
    "b": "<",
    "p": "<",
    "bi": ">",
    "a": ">",
    "pi": ">",
    "eq": "=",
    "e": "=",
    "==": "=",
    "precedes": "<",
    "preceded_by": ">",
} | {relation.name.lower(): relation.symbol for relation in Allen}

_TILES = ("SW", "W", "NW", "S", "EQ", "N", "SE", "E", "NE")
_TILE_ALIASES = {
    "north": "N",
    "northeast": "NE",
    "east": "E",
    "southeast": "SE",
    "south": "S",
    "southwest": "SW",
    "west": "W",
    "northwest": "NW",
    "=": "EQ",
    "same": "EQ",
}


def point_algebra() -> TableCalculus:
    """Return the point algebra: ``<``, ``=``, ``>`` (Vilain and Kautz 1986). Every relation is tractable.

    Returns
    -------
    TableCalculus
        The calculus, with the atoms in this order.

    Examples
    --------
    >>> point = point_algebra()
    >>> point.members(point.compose(point.relation(["<", "="]), point.relation(["<"])))
    ('<',)
    """
    points = np.arange(3)
    codes = 1 + np.sign(points[:, None] - points[None, :])
    return TableCalculus(
        name="point",
        atoms=POINT_ATOMS,
        converses=converses_in(codes, 3),
        composition=composition_in(codes, 3),
        identity=POINT_ATOMS.index("="),
        aliases=_POINT_ALIASES,
        tractable=EVERY_ORDER,
        source="Vilain and Kautz 1986; van Beek 1992",
    )


def interval_algebra() -> TableCalculus:
    """Return the interval algebra: thirteen relations of proper intervals (Allen 1983), codes as in relations.allen.

    Returns
    -------
    TableCalculus
        The calculus; Ord-Horn is its tractable subclass.

    Examples
    --------
    >>> allen = interval_algebra()
    >>> allen.members(allen.compose(allen.relation(["m"]), allen.relation(["mi"])))
    ('fi', '=', 'f')
    """
    ends = np.array(list(combinations(range(6), 2)), dtype=np.float64)
    low, high = ends[:, 0], ends[:, 1]
    codes = allen_relations(low[:, None], high[:, None], low[None, :], high[None, :])
    return TableCalculus(
        name="allen",
        atoms=SYMBOLS,
        converses=converses_in(codes, len(SYMBOLS)),
        composition=composition_in(codes, len(SYMBOLS)),
        identity=Allen.EQUALS,
        aliases=_ALLEN_ALIASES,
        tractable=ORD_HORN,
        source="Allen 1983; Nebel and Bürckert 1995; Ligozat 1996",
    )


def rectangle_algebra(allen: TableCalculus) -> ProductCalculus:
    """Return the algebra of rectangles, sides along x and y: an Allen relation per axis (Balbiani et al. 1998).

    Parameters
    ----------
    allen
        The interval algebra.

    Returns
    -------
    ProductCalculus
        The product of two axes, with 169 atoms.
    """
    return ProductCalculus("ra", (allen, allen), source="Balbiani, Condotta and Fariñas del Cerro 1998, 1999")


def block_algebra(allen: TableCalculus) -> ProductCalculus:
    """Return the algebra of blocks, edges along x, y and z: an Allen relation per axis (Balbiani and others 2002).

    Parameters
    ----------
    allen
        The interval algebra.

    Returns
    -------
    ProductCalculus
        The product of three axes, with 2197 atoms.
    """
    return ProductCalculus("ba", (allen, allen, allen), source="Balbiani, Condotta and Fariñas del Cerro 1999, 2002")


def cardinal_directions(point: TableCalculus) -> ProductCalculus:
    """Return the calculus of points in nine tiles of the plane: order on x and on y (Frank 1991; Ligozat 1998).

    Parameters
    ----------
    point
        The point algebra.

    Returns
    -------
    ProductCalculus
        The product of two axes, with nine atoms such as ``NW``.

    Examples
    --------
    >>> cd = cardinal_directions(point_algebra())
    >>> cd.members(cd.compose(cd.relation(["N"]), cd.relation(["SE"])))
    ('SE', 'E', 'NE')
    """
    return ProductCalculus(
        "cd", (point, point), signs=_TILES, aliases=_TILE_ALIASES, any_case=True, source="Frank 1991; Ligozat 1998"
    )
