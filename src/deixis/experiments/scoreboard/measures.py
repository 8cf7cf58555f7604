"""What is measured of one answer to one case."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.symmetry import interchangeable

Map = NDArray[np.int64]


def right(assignment: Map, truth: Map) -> NDArray[np.bool_]:
    """Which objects (n1,) are given their own thing, or left out where they are missing."""
    same: NDArray[np.bool_] = assignment == truth
    return same


def groups(description: RelationGraph) -> list[NDArray[np.int64]]:
    """The objects that the description (and their kinds) provably cannot tell apart, each group as node indices."""
    kinds = description.kinds or (None,) * len(description.nodes)
    found = interchangeable(description, kinds)
    return [np.array([description.index(name) for name in group], dtype=np.int64) for group in found]


def right_up_to_interchangeability(assignment: Map, truth: Map, groups: Sequence[NDArray[np.int64]]) -> float:
    """The share of objects that are right where the things of a group's objects may be exchanged among them.

    Each thing counts once, and so does each missing object of a group for one that is left out.

    >>> truth, swapped = np.array([0, 1, 2]), np.array([1, 0, UNMATCHED])
    >>> round(right_up_to_interchangeability(swapped, truth, [np.array([0, 1])]), 2)
    0.67
    """
    if len(truth) == 0:
        return 1.0
    count = int(right(assignment, truth).sum())
    for group in groups:
        given, own = assignment[group], truth[group]
        shared = len(np.intersect1d(given[given != UNMATCHED], own[own != UNMATCHED]))
        absent = min(int((given == UNMATCHED).sum()), int((own == UNMATCHED).sum()))
        count += shared + absent - int(right(given, own).sum())
    return count / len(truth)


def satisfied(evidence: Evidence, assignment: Map) -> int:
    """How many stated facts hold of the things that their objects are given, at least in the wide reading."""
    return int((evidence.degrees(assignment) > 0).sum())


def relative(figures: Sequence[float]) -> list[float]:
    """Each figure over the greatest of them; nan where that is not above 0 (a share of nothing)."""
    best = max(figures, default=0.0)
    return [figure / best if best > 0 else float("nan") for figure in figures]
