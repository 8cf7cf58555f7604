"""Write OPRA of any granularity as a calculus that ``deixis solve`` reads: ``python tools/make_opra.py 2 FOLDER``.

OPRA (Moratz 2006) relates oriented points by the direction in which each sees the other. With granularity m, a point
distinguishes 4 m directions around itself, numbered anticlockwise from straight ahead: the even ones are rays, the odd
ones the open sectors between them. The atom ``i_j`` says that the second point is in direction i of the first, and the
first in direction j of the second; ``s_i``, that both are at the same place, and the second looks in direction i of the
first.

The composition of two atoms follows from the angles of a triangle (Mossakowski and Moratz 2012). A full circle is 4 m
here: direction i is the angle i if it is a ray, otherwise the open interval from i - 1 to i + 1.
"""

from __future__ import annotations

import sys
from functools import cache
from itertools import product
from pathlib import Path

from calculus_files import write_calculus

Atom = tuple[int | None, int]
"""Directions i and j; None and a direction for two points at the same place."""

Angles = tuple[int, int]
"""An open interval of angles; a single angle if both ends are equal."""


class Opra:
    """OPRA with granularity ``m``."""

    def __init__(self, m: int) -> None:
        self.full = 4 * m
        directions = range(self.full)
        self.atoms: list[Atom] = [(None, i) for i in directions]
        self.atoms += product(directions, directions)

    def converse(self, atom: Atom) -> Atom:
        """Return the atom of the second point to the first."""
        i, j = atom
        return (None, -j % self.full) if i is None else (j, i)

    def possible(self, ab: Atom, bc: Atom, ac: Atom) -> bool:
        """Return True if three points can have these atoms: a to b, b to c, a to c."""
        (i, j), (k, back), (s, t) = ab, bc, ac
        if i is None and k is None:
            return s is None and self._agree(self._sum(j, back), t)
        if i is None or k is None or s is None:
            if i is None:  # b is at a
                return s is not None and k is not None and t == back and self._agree(self._sum(j, k), s)
            if k is None:  # c is at b
                return s == i and self._agree(self._difference(j, back), t)
            return j == k and self._agree(self._difference(i, back), t)  # c is at a
        return _triangle(self._difference(i, s), self._difference(k, j), self._difference(t, back), self.full)

    def _agree(self, angles: Angles, direction: int) -> bool:
        return _meet(angles, _angles(direction), self.full)

    def _sum(self, first: int, second: int) -> Angles:
        (low, high), (other_low, other_high) = _angles(first), _angles(second)
        return _turned((low + other_low, high + other_high), self.full)

    def _difference(self, first: int, second: int) -> Angles:
        (low, high), (other_low, other_high) = _angles(first), _angles(second)
        return _turned((low - other_high, high - other_low), self.full)


def _angles(direction: int) -> Angles:
    return direction - direction % 2, direction + direction % 2


def _turned(angles: Angles, full: int) -> Angles:
    """Return the angles turned by full circles so that they begin within the first one."""
    return angles[0] % full, angles[0] % full + angles[1] - angles[0]


@cache
def _triangle(a: Angles, b: Angles, c: Angles, full: int) -> bool:
    """Return True if three points at different places can have these angles, all counted in the same direction.

    The angles of a triangle are between 0 and a half circle, and add up to one; they are counted anticlockwise or
    clockwise. Of three points on a line, the middle one has a half circle, the others 0.
    """
    half = full // 2
    for middle in range(3):
        wanted = [(half, half) if corner == middle else (0, 0) for corner in range(3)]
        if all(_meet(angles, other, full) for angles, other in zip((a, b, c), wanted, strict=True)):
            return True
    for sense in (0, -half):
        inner = [_parts(angles, (sense, sense + half), full) for angles in (a, b, c)]
        total = 2 * sense + half
        for parts in product(*inner):
            if _overlap((sum(low for low, _ in parts), sum(high for _, high in parts)), (total, total)):
                return True
    return False


@cache
def _meet(some: Angles, others: Angles, full: int) -> bool:
    """Return True if two sets of angles have one in common, up to full circles."""
    return any(_overlap((some[0] + turn, some[1] + turn), others) for turn in range(-2 * full, 2 * full + 1, full))


def _overlap(some: Angles, others: Angles) -> bool:
    if some[0] == some[1]:
        return others[0] < some[0] < others[1] or some == others
    if others[0] == others[1]:
        return some[0] < others[0] < some[1]
    return max(some[0], others[0]) < min(some[1], others[1])


def _parts(angles: Angles, between: Angles, full: int) -> list[Angles]:
    """Return the parts of the angles, up to full circles, that lie within an open interval."""
    found = []
    for turn in range(-2 * full, 2 * full + 1, full):
        low, high = angles[0] + turn, angles[1] + turn
        if low < high:
            low, high = max(low, between[0]), min(high, between[1])
            if low < high:
                found.append((low, high))
        elif between[0] < low < between[1]:
            found.append((low, low))
    return found


def write(m: int, folder: Path) -> Path:
    """Write the specification, the converses and the compositions; return the path of the specification."""
    opra = Opra(m)
    sign = {atom: f"{'s' if atom[0] is None else atom[0]}_{atom[1]}" for atom in opra.atoms}
    atom_of = {text: atom for atom, text in sign.items()}

    def compose(first: str, second: str) -> list[str]:
        ab, bc = atom_of[first], atom_of[second]
        return [sign[third] for third in opra.atoms if opra.possible(ab, bc, third)]

    def converse(text: str) -> str:
        return sign[opra.converse(atom_of[text])]

    return write_calculus(folder, f"opra{m}", tuple(atom_of), "s_0", converse, compose)


if __name__ == "__main__":
    if len(sys.argv) != 3 or not sys.argv[1].isdecimal() or int(sys.argv[1]) < 1:
        sys.exit("usage: python tools/make_opra.py GRANULARITY FOLDER")
    print(write(int(sys.argv[1]), Path(sys.argv[2])))
