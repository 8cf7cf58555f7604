"""The calculi by name. Each is built when first asked for, and kept."""

from __future__ import annotations

from functools import cache
from typing import cast

from deixis.ontology.relation import nearest
from deixis.reasoning.errors import UnknownCalculusError
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, TableCalculus

CALCULI: tuple[str, ...] = ("point", "allen", "ra", "ba", "rcc8", "cd", "ten", "distance", "direction-distance")
"""The names of all calculi."""


def calculus(name: str) -> Calculus:
    """Return the calculus of that name; raises UnknownCalculusError with the nearest name.

    >>> len(calculus("ra").atoms)
    169
    >>> calculus("rcc9")
    Traceback (most recent call last):
        ...
    deixis.reasoning.errors.UnknownCalculusError: there is no calculus 'rcc9'; did you mean 'rcc8'?
    """
    if name not in CALCULI:
        hint = nearest(name, CALCULI)
        raise UnknownCalculusError(
            f"there is no calculus '{name}'; "
            + (f"did you mean '{hint}'?" if hint else f"there are {', '.join(CALCULI)}")
        )
    return _build(name)


@cache
def _build(name: str) -> Calculus:
    match name:
        case "point" | "allen" | "ra" | "ba" | "cd":
            from deixis.reasoning.qualitative.calculi.endpoints import (
                block_algebra,
                cardinal_directions,
                interval_algebra,
                point_algebra,
                rectangle_algebra,
            )

            if name == "point":
                return point_algebra()
            if name == "allen":
                return interval_algebra()
            if name == "cd":
                return cardinal_directions(cast(TableCalculus, calculus("point")))
            algebra = rectangle_algebra if name == "ra" else block_algebra
            return algebra(cast(TableCalculus, calculus("allen")))
        case "rcc8":
            from deixis.reasoning.qualitative.calculi.rcc8 import region_connection_calculus

            return region_connection_calculus()
        case "ten":
            from deixis.ontology.tbox import default_ontology
            from deixis.reasoning.qualitative.calculi.ten import ten_names

            return ten_names(default_ontology().relations, cast(ProductCalculus, calculus("ra")))
        case "distance":
            from deixis.reasoning.qualitative.calculi.distance import distance_calculus

            return distance_calculus()
        case _:
            from deixis.reasoning.qualitative.calculi.distance import direction_distance_calculus

            return direction_distance_calculus()
