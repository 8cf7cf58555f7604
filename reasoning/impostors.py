"""A table is checked until no role is given to what is plainly something else.

The likeliest map may give a role the one thing that is left, whatever that is, since sizes rule nothing out. Where no
label says so, and it stands in none of the role's places, what is plainly higher, larger or smaller than a fork is no
misplaced fork: the fork is missing, and it is extra.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.colours import Colours
from deixis.ontology.kinds import Kinds
from deixis.reasoning.checking import SURE, TableCheck, Verdict, check_table, sure_roles
from deixis.reasoning.engines import Engine
from deixis.reasoning.evidence import PRESENT, Evidence
from deixis.reasoning.graded.unary import OUTLIERS
from deixis.reasoning.grounding import DEFAULT_TIME_LIMIT, ground
from deixis.reasoning.labels import Label

IMPOSTOR = float(np.log(OUTLIERS / SURE))
"""Sizes that say less than this for a match say with probability ``SURE`` that the thing's size is not its kind's; of
what is too high they say less."""

RULED_OUT = 2 * PRESENT
"""What such a match counts as then: no facts about it outweigh that."""


def checked_table(
    evidence: Evidence,
    labels: Mapping[str, Label | None],
    kinds: Kinds,
    engine: Engine,
    time_limit: float = DEFAULT_TIME_LIMIT,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
) -> TableCheck:
    """Grounds a layout and reads the grounding as :func:`check_table` does, as often as an impostor is found."""
    deadline = time.perf_counter() + time_limit
    sure = sure_roles(evidence.description, labels, kinds)
    while True:
        found = ground(evidence, engine, max(0.0, deadline - time.perf_counter()))
        table = check_table(evidence, labels, kinds, found, seen, colours)
        rest = _without_impostors(evidence, sure, table)
        if rest is None or time.perf_counter() > deadline:
            return table
        evidence = rest


def _without_impostors(evidence: Evidence, sure: Mapping[str, frozenset[str]], table: TableCheck) -> Evidence | None:
    """The evidence with the table's impostors ruled out, one match at least; None where there is none."""
    said = evidence.sizes.copy()
    for check in table.of(Verdict.MISPLACED):
        if check.perceived is None or check.role in sure[check.perceived]:
            continue
        place = evidence.description.index(check.role), evidence.scene.index(check.perceived)
        if evidence.labels[place] <= 0 and evidence.sizes[place] < IMPOSTOR:
            said[place] = RULED_OUT
    return None if np.array_equal(said, evidence.sizes) else replace(evidence, sizes=said)
