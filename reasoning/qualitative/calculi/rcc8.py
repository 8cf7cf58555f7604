"""Build RCC-8, how two regions connect (Randell, Cui and Cohn 1992), and RCC-5, which ignores boundaries.

The composition of RCC-8 is stated as a table, because it does not follow from an order.

Regions are non-empty regular closed sets of a topological space, in one piece or several.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from deixis.reasoning.qualitative.calculi.calculus import Calculus, TableCalculus, coarsening
from deixis.reasoning.qualitative.calculi.tractable import RCC5_HORN, RCC8_HORN, rcc8_of_rcc5

RCC8_ATOMS = ("DC", "EC", "PO", "TPP", "NTPP", "TPPI", "NTPPI", "EQ")
_CONVERSES = (0, 1, 2, 5, 6, 3, 4, 7)

_ALIASES = {
    "disjoint": "DC",
    "meet": "EC",
    "overlap": "PO",
    "coveredBy": "TPP",
    "inside": "NTPP",
    "covers": "TPPI",
    "contains": "NTPPI",
    "equal": "EQ",
    "=": "EQ",
} | {f"rcc8{atom.lower()}": atom for atom in RCC8_ATOMS}

# After Cohn, Bennett, Gooday and Gotts 1997. One letter an atom, in the order of RCC8_ATOMS: d e p t n T N =
_TABLE = """
detpnTN=  detpn     detpn     detpn     detpn     d         d         d
depTN     deptT=    deptn     eptn      ptn       de        d         e
depTN     depTN     detpnTN=  ptn       ptn       depTN     depTN     p
d         de        deptn     tn        n         deptT=    depTN     t
d         d         deptn     n         n         deptn     detpnTN=  n
depTN     epTN      pTN       ptT=      ptn       TN        N         T
depTN     pTN       pTN       pTN       ptnTN=    N         N         N
d         e         p         t         n         T         N         =
"""


def region_connection_calculus() -> TableCalculus:
    """Return RCC-8 with its composition table.

    Returns
    -------
    TableCalculus
        The calculus, with its tractable subclass.

    Examples
    --------
    >>> rcc8 = region_connection_calculus()
    >>> rcc8.members(rcc8.compose(rcc8.relation(["EC"]), rcc8.relation(["NTPP"])))
    ('PO', 'TPP', 'NTPP')
    >>> rcc8.members(rcc8.converse(rcc8.relation(["tpp", "ntppi"])))
    ('NTPP', 'TPPI')
    """
    letters = "deptnTN="
    rows = [line.split() for line in _TABLE.strip().splitlines()]
    table = [[sum(1 << letters.index(letter) for letter in entry) for entry in row] for row in rows]
    return TableCalculus(
        name="rcc8",
        atoms=RCC8_ATOMS,
        converses=np.array(_CONVERSES, dtype=np.int64),
        composition=np.array(table, dtype=np.uint64),
        identity=RCC8_ATOMS.index("EQ"),
        aliases=_ALIASES,
        any_case=True,
        tractable=RCC8_HORN,
        source="Randell, Cui and Cohn 1992; Cohn, Bennett, Gooday and Gotts 1997; Renz and Nebel 1999",
    )


RCC5_ATOMS = ("DR", "PO", "PP", "PPI", "EQ")
_RCC5_ALIASES = {"DC": "DR", "PPC": "PPI", "disjoint": "DR", "overlap": "PO", "equal": "EQ", "=": "EQ"}


def mereological_calculus(rcc8: Calculus) -> TableCalculus:
    """Return RCC-5: discrete, partial overlap, proper part and its converse, equal (Bennett 1994); coarser than RCC-8.

    The composition of RCC-5 atoms in RCC-8 is a union of RCC-5 atoms, so that closure decides RCC-5 where it decides
    RCC-8.

    Parameters
    ----------
    rcc8
        RCC-8, from whose table that of RCC-5 is derived.

    Returns
    -------
    TableCalculus
        RCC-5, with its tractable subclass.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> rcc5 = calculus("rcc5")
    >>> rcc5.members(rcc5.compose(rcc5.relation(["DR"]), rcc5.relation(["PP"])))
    ('DR', 'PO', 'PP')
    """
    parts = [rcc8_of_rcc5(1 << code) for code in range(len(RCC5_ATOMS))]
    source = "Bennett 1994; Renz and Nebel 1999"
    coarse = coarsening("rcc5", RCC5_ATOMS, parts, rcc8, source)
    return replace(coarse, aliases=_RCC5_ALIASES, any_case=True, tractable=RCC5_HORN, decided_by_closure=True)
