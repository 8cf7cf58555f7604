"""Qualitative distance between two points, in ordered ranges (Clementini, Di Felice and Hernández 1997)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import inf, isfinite

import numpy as np

from deixis.reasoning.calculi.calculus import TableCalculus
from deixis.reasoning.calculi.coarse import atoms_of
from deixis.reasoning.errors import SettingError

Bound = Fraction | float  # exact, or infinite
SAME = "same"


@dataclass(frozen=True)
class Ranges:
    """Ordered ranges of distance, in units of a reference length: range *i* reaches from bound *i* to bound *i + 1*.

    The first bound is 0 and the last, infinity, is not given. A range holds its upper bound and not its lower one;
    distance 0 is ``same`` and in no range. Raises SettingError where bounds do not rise or do not fit the names.

    >>> Ranges(("near", "far"), (2.0,)).intervals
    ((Fraction(0, 1), Fraction(2, 1)), (Fraction(2, 1), inf))
    """

    names: tuple[str, ...]
    bounds: tuple[float, ...]

    def __post_init__(self) -> None:
        if not 0 < len(self.names) < 64:
            raise SettingError(f"there are 1 to 63 ranges of distance, not {len(self.names)}")
        if len(self.bounds) != len(self.names) - 1:
            raise SettingError(f"{len(self.names)} ranges of distance need {len(self.names) - 1} bounds between them")
        if SAME in self.names or len(set(self.names)) != len(self.names):
            raise SettingError(f"ranges of distance need names of their own, and none may be '{SAME}'")
        if any(not isfinite(bound) for bound in self.bounds) or list(self.bounds) != sorted({0.0, *self.bounds})[1:]:
            raise SettingError(f"bounds of distance must rise from above 0, not {', '.join(map(str, self.bounds))}")

    @property
    def intervals(self) -> tuple[tuple[Bound, Bound], ...]:
        """The lower and the upper bound of each range."""
        ends: list[Bound] = [Fraction(0), *map(Fraction, self.bounds), inf]
        return tuple(pairwise(ends))


DEFAULT_RANGES = Ranges(("near", "medium", "far"), (1.0, 3.0))
"""Each range is longer than all before it together, as Clementini and others ask of a frame of reference."""


def distance_calculus(ranges: Ranges = DEFAULT_RANGES) -> TableCalculus:
    """Ranges of distance as a calculus; composed by the triangle inequality, each entry realised in the plane.

    Closure does not decide it: distances that obey the triangle inequality three by three need not fit in the plane.

    >>> distance = distance_calculus()
    >>> distance.members(distance.compose(distance.relation(["near"]), distance.relation(["near"])))
    ('same', 'near', 'medium')
    """
    atoms = (SAME, *ranges.names)
    spans = (None, *ranges.intervals)
    table = [[_composed(spans, i, j) for j in range(len(atoms))] for i in range(len(atoms))]
    return TableCalculus(
        name="distance",
        atoms=atoms,
        converses=np.arange(len(atoms)),
        composition=np.array(table, dtype=np.uint64),
        identity=0,
        split=atoms_of,
        decided_by_closure=False,
        source="Clementini, Di Felice and Hernández 1997",
    )


def _composed(spans: Sequence[tuple[Bound, Bound] | None], i: int, j: int) -> int:
    first, second = spans[i], spans[j]
    if first is None or second is None:
        return 1 << max(i, j)
    mask = 1 if i == j else 0  # back where it began
    for k, third in enumerate(spans):
        if third is not None and _closes(first, second, third):
            mask |= 1 << k
    return mask


def _closes(first: tuple[Bound, Bound], second: tuple[Bound, Bound], third: tuple[Bound, Bound]) -> bool:
    """Whether a triangle, flat ones included, has one side in each range; open below and closed above.

    The third side takes every length between the least difference of the others, which is not reached, and their
    greatest sum, which is.
    """
    least = max(0, first[0] - second[1], second[0] - first[1])
    return least < third[1] and third[0] < first[1] + second[1]
