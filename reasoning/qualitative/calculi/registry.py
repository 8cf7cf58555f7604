"""The calculi by name. Each is built when first asked for, and kept."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import cast

from deixis.ontology.relation import nearest
from deixis.reasoning.errors import UnknownCalculusError
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, TableCalculus


def calculus(name: str) -> Calculus:
    """The calculus of that name; raises UnknownCalculusError with the nearest name.

    >>> len(calculus("ra").atoms)
    169
    >>> calculus("rcc9")
    Traceback (most recent call last):
        ...
    deixis.reasoning.errors.UnknownCalculusError: there is no calculus 'rcc9'; did you mean 'rcc8'?
    """
    if name not in _BUILDERS:
        hint = nearest(name, _BUILDERS)
        raise UnknownCalculusError(
            f"there is no calculus '{name}'; "
            + (f"did you mean '{hint}'?" if hint else f"there are {', '.join(CALCULI)}")
        )
    return _built(name)


@cache
def _built(name: str) -> Calculus:
    return _BUILDERS[name]()


def _point() -> Calculus:
    from deixis.reasoning.qualitative.calculi.endpoints import point_algebra

    return point_algebra()


def _allen() -> Calculus:
    from deixis.reasoning.qualitative.calculi.endpoints import interval_algebra

    return interval_algebra()


def _ra() -> Calculus:
    from deixis.reasoning.qualitative.calculi.endpoints import rectangle_algebra

    return rectangle_algebra(cast(TableCalculus, calculus("allen")))


def _ba() -> Calculus:
    from deixis.reasoning.qualitative.calculi.endpoints import block_algebra

    return block_algebra(cast(TableCalculus, calculus("allen")))


def _cd() -> Calculus:
    from deixis.reasoning.qualitative.calculi.endpoints import cardinal_directions

    return cardinal_directions(cast(TableCalculus, calculus("point")))


def _rcc8() -> Calculus:
    from deixis.reasoning.qualitative.calculi.rcc8 import region_connection_calculus

    return region_connection_calculus()


def _ten() -> Calculus:
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.qualitative.calculi.ten import ten_names

    return ten_names(default_ontology().relations, cast(ProductCalculus, calculus("ra")))


def _distance() -> Calculus:
    from deixis.reasoning.qualitative.calculi.distance import distance_calculus

    return distance_calculus()


def _direction_distance() -> Calculus:
    from deixis.reasoning.qualitative.calculi.distance import direction_distance_calculus

    return direction_distance_calculus()


_BUILDERS: dict[str, Callable[[], Calculus]] = {
    "point": _point,
    "allen": _allen,
    "ra": _ra,
    "ba": _ba,
    "rcc8": _rcc8,
    "cd": _cd,
    "ten": _ten,
    "distance": _distance,
    "direction-distance": _direction_distance,
}

CALCULI: tuple[str, ...] = tuple(_BUILDERS)
"""The names of all calculi."""
