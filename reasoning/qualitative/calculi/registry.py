"""Find the calculi by name; each is built on its first use and kept."""

from __future__ import annotations

from functools import cache
from typing import cast

from deixis.reasoning.errors import UnknownAtomError, UnknownCalculusError
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, TableCalculus, bits
from deixis.spelling import nearest

CALCULI: tuple[str, ...] = ("point", "allen", "ra", "ba", "rcc5", "rcc8", "cd", "ten", "distance", "direction-distance")
"""Names of all calculi."""


def calculus(name: str) -> Calculus:
    """Return a calculus by name.

    Parameters
    ----------
    name
        One of CALCULI.

    Returns
    -------
    The calculus; repeated calls return the same object.

    Raises
    ------
    UnknownCalculusError
        If there is no calculus of that name.

    Examples
    --------
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
        case "rcc5":
            from deixis.reasoning.qualitative.calculi.rcc8 import mereological_calculus

            return mereological_calculus(calculus("rcc8"))
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


def with_same_tables(brought: TableCalculus) -> Calculus | None:
    """Return the calculus with the same atoms and tables as another one, in any order; None if no calculus has them.

    Its atoms may have other signs there, but each must be a sign or an alias here.

    Parameters
    ----------
    brought
        A calculus, for example from a file of another program.

    Returns
    -------
    Calculus or None
        Calculus of the registry, or None.
    """
    for name in CALCULI:
        known = calculus(name)
        if len(known.atoms) != len(brought.atoms):
            continue
        try:
            codes = [known.code(atom) for atom in brought.atoms]
        except UnknownAtomError:
            continue
        if len(set(codes)) == len(codes) and _agree(brought, known, codes):
            return known
    return None


def _agree(brought: TableCalculus, known: Calculus, codes: list[int]) -> bool:
    if codes[brought.identity] != known.identity:
        return False
    for i, code in enumerate(codes):
        if known.converse(1 << code) != 1 << codes[brought.converses[i]]:
            return False
        for j, other in enumerate(codes):
            composed = sum(1 << codes[k] for k in bits(brought.compose(1 << i, 1 << j)))
            if known.compose(1 << code, 1 << other) != composed:
                return False
    return True
