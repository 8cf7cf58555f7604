"""A table is checked until no role is given to what is plainly something else.

The likeliest map may give a role the one thing that is left, whatever that is, since sizes rule nothing out. Where no
sure label says so, what is plainly too high is no fork; and what is plainly not as large, and stands in none of the
role's places either, is no misplaced fork: the fork is missing, and it is extra.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.colours import Colours
from deixis.ontology.kinds import Kinds
from deixis.ontology.sizes import Sizes
from deixis.reasoning.checking import SURE, TableCheck, Verdict, check_table, sure_roles
from deixis.reasoning.engines import Engine
from deixis.reasoning.evidence import PRESENT, Evidence
from deixis.reasoning.graded.unary import OUTLIERS, too_high
from deixis.reasoning.grounding import DEFAULT_TIME_LIMIT, ground
from deixis.reasoning.labels import Label, classes

IMPOSTOR = float(np.log(OUTLIERS / SURE))
"""Sizes that say less than this for a match say with probability ``SURE`` that the thing's size is not its kind's."""

RULED_OUT = 2 * PRESENT
"""What such a match counts as then: no facts about it outweigh that."""


def checked_table(
    evidence: Evidence,
    labels: Mapping[str, Label | None],
    kinds: Kinds,
    sizes: Sizes | None,
    engine: Engine,
    time_limit: float = DEFAULT_TIME_LIMIT,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
) -> TableCheck:
    """Grounds a layout and reads the grounding as :func:`check_table` does, as often as an impostor is found.

    ``sizes`` are the usual ones, None where boxes are not in metres; for the rest see :func:`check_table`.
    """
    deadline = time.perf_counter() + time_limit
    sure = sure_roles(evidence.description, labels, kinds)
    if sizes is not None:
        evidence = _without_too_high(evidence, sure, sizes)
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
        if check.perceived is not None and check.role not in sure[check.perceived]:
            role, thing = evidence.description.index(check.role), evidence.scene.index(check.perceived)
            if said[role, thing] < IMPOSTOR:
                said[role, thing] = RULED_OUT
    return None if np.array_equal(said, evidence.sizes) else replace(evidence, sizes=said)


def _without_too_high(evidence: Evidence, sure: Mapping[str, frozenset[str]], sizes: Sizes) -> Evidence:
    """The evidence with those ruled out that no label surely calls so, and that are plainly too high."""
    boxes, things = evidence.scene.boxes, evidence.scene.nodes
    if boxes is None:
        return evidence
    high = too_high(classes(evidence.description), boxes, sizes)
    called = [[role in sure[thing] for thing in things] for role in evidence.description.nodes]
    return replace(evidence, sizes=np.where(high & ~np.array(called, bool), RULED_OUT, evidence.sizes))
