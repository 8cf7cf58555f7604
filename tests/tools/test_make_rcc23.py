"""Compare RCC-23 with its published table, and with regions of whole cells and their exact hulls."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from make_rcc23 import ATOMS, compose, converse, write
from numpy.typing import NDArray

from deixis.grammar.formats.calculi import read_calculus
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve

ALL_APART = "IIE IPE IPD IOE IOD PIE PID PPE PPD POE POD OIE OID OPE OPD OOE OOD"
PUBLISHED = {  # Cohn, Bennett, Gooday and Gotts 1997; the entries are those of the file that GQR has
    "NTPP PO": f"NTPP TPP PO {ALL_APART}",
    "NTPP PIE": "IPD IOD PID PPD POD OID OPD OOD",
    "TPP IIE": "IIE IPE IPD IOE IOD",
    "TPP NTPPI": f"PO NTPPI TPPI {ALL_APART}",
    "PO OIE": "PO NTPPI TPPI PIE PID PPE PPD POE POD OIE OID OPE OPD OOE OOD",
    "PO IPD": "PO NTPPI TPPI IIE IPE IPD IOE IOD PIE PID PPE PPD POE POD",
    "NTPPI NTPP": "NTPP TPP PO EQ NTPPI TPPI",
    "NTPPI OID": "PO NTPPI TPPI PIE PID OIE OID",
    "TPPI TPP": "TPP PO EQ TPPI",
    "TPPI IOE": "PO NTPPI TPPI IIE IPE IOE PIE PPE POE",
    "IIE TPP": "NTPP TPP PO IIE IPE",
    "IIE IIE": "TPP PO EQ TPPI IIE",
    "IIE IPD": "PO IPE IPD",
    "IPE TPPI": ALL_APART,
    "IPE IIE": "TPP PO IPE IPD IOE IOD",
    "IPD OIE": "PO PIE PID PPE PPD POE POD OIE OID OPE OPD OOE OOD",
    "IOE TPP": "NTPP TPP PO IPE IOE",
    "IOD PID": "NTPP TPP PO IPE IPD IOE IOD PPE PPD POE POD OPE OPD OOE OOD",
    "PIE IPE": "TPP PO EQ TPPI IIE IPE IPD PIE PID PPE PPD",
    "PID IIE": "PO PIE PID",
    "PPE PPE": f"TPP PO EQ TPPI {ALL_APART}",
    "PPD IIE": "PO PPE PPD POE POD",
    "POE OPE": f"TPP PO EQ TPPI {ALL_APART}",
    "POD PPD": "NTPP TPP PO IPE IPD IOE IOD PPE PPD POE POD OPE OPD OOE OOD",
    "OIE IPE": "TPP PO IIE IPE IPD PIE PID PPE PPD OIE OID OPE OPD",
    "OID NTPPI": "OID",
    "OPE POD": f"PO NTPPI TPPI {ALL_APART}",
    "OPD PPE": f"NTPP TPP PO {ALL_APART}",
    "OOE PIE": "OPE OPD OOE OOD",
    "OOD OOD": f"NTPP TPP PO EQ NTPPI TPPI {ALL_APART}",
}
SIDE = 5
CORNERS = np.array(list(product(range(SIDE + 1), repeat=2)))
CELLS = np.array(list(product(range(SIDE), repeat=2)))


@pytest.mark.parametrize("pair", PUBLISHED)
def test_a_composition_is_the_published_one(pair: str) -> None:
    assert sorted(compose(*pair.split())) == sorted(PUBLISHED[pair].split())


def test_the_identity_is_neutral() -> None:
    assert all(compose("EQ", atom) == [atom] == compose(atom, "EQ") for atom in ATOMS)


def corners(cells: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the corners of the cells of a region, shape (n, 2)."""
    return np.unique((CELLS[cells][:, None] + [[0, 0], [0, 1], [1, 0], [1, 1]]).reshape(-1, 2), axis=0)


def meeting(cells: NDArray[np.bool_], points: NDArray[np.int64]) -> str:
    """Return whether a region is inside (I), partly in (P) or outside (O) the hull of points.

    The hull is bounded by the lines through two of the points that have all points on one side. A cell overlaps the
    hull unless a side of either separates them. All numbers are whole, so that nothing is rounded.
    """
    ways = (points[None] - points[:, None]).reshape(-1, 2)
    starts = np.repeat(points, len(points), axis=0)
    across = ways[:, :1] * (points[:, 1] - starts[:, 1:]) - ways[:, 1:] * (points[:, 0] - starts[:, :1])
    sides = (across >= 0).all(axis=1) & (across > 0).any(axis=1)
    ways, starts = ways[sides], starts[sides]
    own = CELLS[cells][:, None] + [[0, 0], [0, 1], [1, 0], [1, 1]]  # shape (cells, 4, 2)
    height = ways[:, 0] * (own[..., 1:] - starts[:, 1]) - ways[:, 1] * (own[..., :1] - starts[:, 0])
    if (height >= 0).all():
        return "I"
    beyond = np.any(np.all(height <= 0, axis=1), axis=1)
    for axis in (0, 1):
        beyond |= (own[..., axis].max(axis=1) <= points[:, axis].min()) | (
            own[..., axis].min(axis=1) >= points[:, axis].max()
        )
    return "O" if beyond.all() else "P"


def atom(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> str:
    """Return the atom of two regions of cells."""
    if (first == second).all():
        return "EQ"
    own, other = corners(first), corners(second)
    if (first & second).any():
        for inner, outer, name in ((first, second, "TPP"), (second, first, "TPPI")):
            if not (inner & ~outer).any():
                around = np.abs(CELLS[:, None] - CELLS[inner]).max(axis=2).min(axis=1) <= 1
                edge = ((CELLS[inner] == 0) | (CELLS[inner] == SIDE - 1)).any()
                return name if edge or (around & ~outer).any() else "N" + name
        return "PO"
    touch = (own[:, None] == other[None]).all(axis=2).any()
    return meeting(first, other) + meeting(second, own) + ("E" if touch else "D")


def test_regions_of_cells_stay_within_the_table() -> None:
    rng = np.random.default_rng(23)
    seen: dict[tuple[str, str], set[str]] = {}
    atoms: set[str] = set()
    for _ in range(3000):
        chance = rng.choice((0.05, 0.12, 0.4), 3)
        regions = rng.random((3, SIDE * SIDE)) < chance[:, None]
        if not regions.any(axis=1).all():
            continue
        ab, bc, ac = (atom(regions[a], regions[b]) for a, b in ((0, 1), (1, 2), (0, 2)))
        seen.setdefault((ab, bc), set()).add(ac)
        atoms |= {ab, bc, ac}
    assert atoms >= set(ATOMS) - {"NTPP", "NTPPI", "IIE", "IPD", "PID"}  # which need larger regions
    for (ab, bc), found in seen.items():
        assert found <= set(compose(ab, bc)), (ab, bc)


def test_the_written_files_are_read_and_refute(tmp_path: Path) -> None:
    text = read_calculus(write(tmp_path))
    rcc23 = text.calculus
    assert not text.notes and len(rcc23.atoms) == 23
    assert all(rcc23.converse(rcc23.relation([name])) == rcc23.relation([converse(name)]) for name in ATOMS)
    inside, hull_free = rcc23.relation(["NTPP"]), rcc23.relation(["IIE"])
    stated = (Constraint(0, 1, inside), Constraint(1, 2, hull_free), Constraint(0, 2, rcc23.relation(["IIE", "POD"])))
    assert solve(Network(rcc23, 3, stated)).verdict is Verdict.INCONSISTENT
    assert solve(Network(rcc23, 3, stated[:2])).verdict is Verdict.UNDECIDED
