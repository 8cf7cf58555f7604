"""Compare RCC-8's stated table with regions: it has exactly the compositions that regions of a line show."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.reasoning.qualitative.calculi.endpoints import composition_in, converses_in
from deixis.reasoning.qualitative.calculi.rcc8 import RCC8_ATOMS
from deixis.reasoning.qualitative.calculi.registry import calculus

DC, EC, PO, TPP, NTPP, TPPI, NTPPI, EQ = range(8)


def connections(
    common: NDArray[np.bool_], touch: NDArray[np.bool_], part: NDArray[np.bool_], deep: NDArray[np.bool_]
) -> NDArray[np.int64]:
    """Return the atoms of pairs that share inner points; share points; are first within second; within its interior."""
    conditions = [part & part.T, deep, part, deep.T, part.T, common, touch]
    return np.select(conditions, [EQ, NTPP, TPP, NTPPI, TPPI, PO, EC], default=DC)


@pytest.fixture(scope="module")
def on_a_line() -> NDArray[np.int64]:
    """All unions of seven of the nine unit steps of a line: a step touches its neighbours; the outer ones stay free."""
    regions = np.arange(1, 1 << 7) << 1
    wide = regions | regions << 1 | regions >> 1
    shared = regions[:, None] & regions[None, :]
    return connections(
        shared != 0,
        (wide[:, None] & regions[None, :]) != 0,
        (regions[:, None] & ~regions[None, :]) == 0,
        (wide[:, None] & ~regions[None, :]) == 0,
    )


def test_regions_of_a_line_show_exactly_the_compositions(on_a_line: NDArray[np.int64]) -> None:
    """Use regions of several pieces, which realise RCC-8 in any dimension (Renz 1998)."""
    rcc8 = calculus("rcc8")
    shown = composition_in(on_a_line, 8)
    assert shown.tolist() == [[rcc8.compose(1 << i, 1 << j) for j in range(8)] for i in range(8)]
    assert [1 << int(code) for code in converses_in(on_a_line, 8)] == [rcc8.converse(1 << i) for i in range(8)]


def test_discs_show_no_other_compositions() -> None:
    """Use whole centres and radii, so that contact is exact."""
    rcc8 = calculus("rcc8")
    discs = np.array([(x, y, r) for x, y in product(range(0, 9, 2), range(0, 9, 2)) for r in range(1, 6)])
    x, y, r = discs.T
    squared = (x[:, None] - x[None, :]) ** 2 + (y[:, None] - y[None, :]) ** 2
    apart, deeper = r[:, None] + r[None, :], r[None, :] - r[:, None]
    codes = connections(
        squared < apart**2,
        squared <= apart**2,
        (deeper >= 0) & (squared <= deeper**2),
        (deeper > 0) & (squared < deeper**2),
    )
    table = np.array([[rcc8.compose(1 << i, 1 << j) for j in range(8)] for i in range(8)], dtype=np.uint64)
    shown = composition_in(codes, 8)
    assert not (shown & ~table).any()
    assert np.bitwise_count(shown).sum() > 150  # of 193; the others need regions of other shapes


@pytest.mark.parametrize(
    "signs",
    [
        "DC EC PO TPP NTPP TPPI NTPPI EQ",  # GQR
        "dc ec po tpp ntpp tppi ntppi eq",  # SparQ, QSRlib
        "DC EC PO TPP NTPP TPPi NTPPi EQ",
        "rcc8dc rcc8ec rcc8po rcc8tpp rcc8ntpp rcc8tppi rcc8ntppi rcc8eq",  # GeoSPARQL
        "disjoint meet overlap coveredBy inside covers contains equal",  # Egenhofer
    ],
)
def test_atoms_have_the_names_of_other_reasoners(signs: str) -> None:
    assert [calculus("rcc8").code(sign) for sign in signs.split()] == list(range(8))
    assert calculus("rcc8").atoms == RCC8_ATOMS
