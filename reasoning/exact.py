"""The exact engine: branch and bound for the largest sum of degrees, and how firmly each match stands."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.assignment import assign
from deixis.reasoning.branch_and_bound import SLACK, Optimum, Search
from deixis.reasoning.engines import Alignment, paper_similarity
from deixis.reasoning.evidence import UNMATCHED, Evidence


@dataclass(frozen=True)
class ExactEngine:
    """Proves the alignment with the largest total, as far as the time allows; the similarity breaks ties.

    For each match it then looks for the best alignment without it: what that one loses is the match's margin. A
    margin of 0 says that something else explains the description as well.
    """

    def align(self, evidence: Evidence, deadline: float) -> Alignment:
        found = paper_similarity(evidence)
        matrix = found.matrices[0]
        search = Search(evidence, matrix)
        started = time.perf_counter()
        best = search.solve(search.improve(assign(matrix, evidence.allowed)), started + 0.7 * (deadline - started))
        notes = [] if best.proved else ["the time limit struck before the alignment was proved the best"]
        margins, runners_up = _margins(search, best, evidence, deadline)
        if np.isnan(margins[best.assignment != UNMATCHED]).any():
            notes.append("the time limit struck before the margin of every match was known")
        return Alignment(
            engine="exact",
            assignment=best.assignment,
            matrix=matrix,
            converged=bool(found.converged[0]),
            proved_best=best.proved,
            notes=tuple(notes),
            margins=margins,
            runners_up=runners_up,
        )


def _margins(
    search: Search, best: Optimum, evidence: Evidence, deadline: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    margins = np.full(len(best.assignment), np.nan)
    runners_up = np.full(len(best.assignment), UNMATCHED, dtype=np.int64)
    total = evidence.total(best.assignment)
    if not best.proved:
        return margins, runners_up
    for i in np.flatnonzero(best.assignment != UNMATCHED):
        pair = int(i), int(best.assignment[i])
        other = search.solve(_without(pair, best.assignment, evidence, search), deadline, forbidden=pair)
        if not other.proved:
            break
        lost = total - evidence.total(other.assignment)
        margins[i] = 0.0 if abs(lost) < SLACK else lost
        runners_up[i] = other.assignment[i]
    return margins, runners_up


def _without(
    pair: tuple[int, int], assignment: NDArray[np.int64], evidence: Evidence, search: Search
) -> NDArray[np.int64]:
    """The best alignment that differs from this one by giving an object something else, by a move or a swap."""
    i, p = pair
    best = assignment.copy()
    best[i] = UNMATCHED
    value = search.value(best)
    holder = {int(q): j for j, q in enumerate(assignment) if q != UNMATCHED}
    for q in np.flatnonzero(evidence.allowed[i]):
        j = holder.get(int(q))
        if q == p or (j is not None and not evidence.allowed[j, p]):
            continue
        other = assignment.copy()
        other[i] = q
        if j is not None:
            other[j] = p
        if search.value(other) > value:
            best, value = other, search.value(other)
    return best
