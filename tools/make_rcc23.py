"""Write RCC-23 as a calculus that ``deixis solve`` reads: ``python tools/make_rcc23.py FOLDER``.

RCC-23 (Cohn, Bennett, Gooday and Gotts 1997) tells regions apart by their convex hulls too. Regions that overlap have
one of the six atoms EQ, PO, TPP, NTPP and the converses of the last two. Two regions that do not overlap have an atom
of three letters: the first region is inside the convex hull of the second one (I), overlaps it in part (P) or is
outside it (O); the same for the second region and the hull of the first; the regions touch (E) or do not (D).

The table is computed, not typed in. Three regions and their hulls are six regions in RCC-8, where

- a region is a tangential part of its hull or equal to it,
- a region is a part of a convex region exactly if its hull is, and a non-tangential part exactly if its hull is,
- regions with the same hull share the extreme points of that hull, so that they are not disconnected.

An atom is in a composition if the network of RCC-8 that these laws give has a solution.
"""

from __future__ import annotations

import sys
from functools import cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

from calculus_files import write_calculus

from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve

RCC8 = calculus("rcc8")
_APART = [f"{first}{second}{touch}" for first in "IPO" for second in "IPO" for touch in "ED"]
ATOMS = ("EQ", "PO", "TPP", "NTPP", "TPPI", "NTPPI", *(atom for atom in _APART if atom != "IID"))
"""IID is impossible: two regions that are inside each other's hulls have the same hull."""
_CONVERSE = {"EQ": "EQ", "PO": "PO", "TPP": "TPPI", "NTPP": "NTPPI", "TPPI": "TPP", "NTPPI": "NTPP"}
_EQ, _PO, _DC, _EC, _TPP, _NTPP = (RCC8.relation([atom]) for atom in ("EQ", "PO", "DC", "EC", "TPP", "NTPP"))
_ANY = RCC8.universal
_NO_PART = _ANY & ~(_EQ | _TPP | _NTPP)


class Case(NamedTuple):
    """The relations in RCC-8 of two regions and their hulls, in one of the cases of an atom."""

    regions: int
    first_to_hull: int
    """Relation of the first region to the hull of the second."""
    hull_to_second: int
    hulls: int

    def converse(self) -> Case:
        """Return the case with both regions exchanged."""
        regions, first, second, hulls = (RCC8.converse(relation) for relation in self)
        return Case(regions, second, first, hulls)


def converse(atom: str) -> str:
    """Return the atom of the second region to the first."""
    return _CONVERSE.get(atom) or atom[1] + atom[0] + atom[2]


@cache
def cases(atom: str) -> tuple[Case, ...]:
    """Return the cases of an atom: whether a part of a hull touches its border decides the relation of the hulls."""
    parts = [(_NTPP, _NTPP), (_TPP | _EQ, _TPP | _EQ)]  # of a region to a hull, and of its own hull to that hull
    if atom == "EQ":
        return (Case(_EQ, _ANY, _ANY, _EQ),)
    if atom == "NTPP":
        return (Case(_NTPP, _NTPP, _ANY, _NTPP),)
    if atom == "TPP":
        return tuple(Case(_TPP, part, _ANY, hulls) for part, hulls in parts)
    if atom in ("TPPI", "NTPPI"):
        return tuple(case.converse() for case in cases(converse(atom)))
    if atom == "PO":
        sides = [*parts, (_NO_PART, _NO_PART)]
        choices = [(_PO, first, second) for first, second in product(sides, sides)]
    else:
        options = {"I": parts, "P": [(_NO_PART & ~(_DC | _EC), _NO_PART)], "O": [(_DC | _EC, _NO_PART)]}
        regions = _EC if atom[2] == "E" else _DC
        choices = [(regions, first, second) for first, second in product(options[atom[0]], options[atom[1]])]
    found = []
    for regions, (first, hulls), (second, hulls_back) in choices:
        together = hulls & RCC8.converse(hulls_back)
        if regions == _DC:
            together &= ~_EQ
        if together:
            found.append(Case(regions, first, RCC8.converse(second), together))
    return tuple(found)


def possible(ab: str, bc: str, ac: str) -> bool:
    """Return True if three regions can have these atoms: a to b, b to c, a to c."""
    own_hulls = tuple(Constraint(region, region + 3, _TPP | _EQ) for region in range(3))
    for chosen in product(cases(ab), cases(bc), cases(ac)):
        pairs = zip(((0, 1), (1, 2), (0, 2)), chosen, strict=True)
        stated = [
            Constraint(a + of_a, b + of_b, relation)
            for (a, b), case in pairs
            for (of_a, of_b), relation in zip(((0, 0), (0, 3), (3, 0), (3, 3)), case, strict=True)
        ]
        if solve(Network(RCC8, 6, (*own_hulls, *stated))).verdict is Verdict.CONSISTENT:
            return True
    return False


def compose(first: str, second: str) -> list[str]:
    """Return the atoms that the first and the third of three regions can have."""
    return [third for third in ATOMS if possible(first, second, third)]


def write(folder: Path) -> Path:
    """Write the files of RCC-23; return the path of the specification."""
    return write_calculus(folder, "rcc23", ATOMS, "EQ", converse, compose)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python tools/make_rcc23.py FOLDER")
    print(write(Path(sys.argv[1])))
