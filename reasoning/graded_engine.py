"""The graded engine: the map that the words make most likely, proved the best as far as the time allows.

Every fact says by how much likelier it makes a pair than chance does (:mod:`deixis.reasoning.graded.facts`), and the
map with the largest sum is searched for (:mod:`deixis.reasoning.matching.exact`). Leaving an object out is part of it.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.engines import Alignment, paper_similarity
from deixis.reasoning.errors import SettingError
from deixis.reasoning.evidence import UNMATCHED, Evidence
from deixis.reasoning.graded.facts import fact_tables
from deixis.reasoning.matching.exact import exact
from deixis.reasoning.matching.problem import Problem

ABSENT = math.log(0.05 / 0.95)
"""What leaving an object out costs: one in twenty that are named is taken not to be there."""

DECISIVE = math.log(19)
"""By how much the next best map must be less likely for a match to count as decided: nineteen times."""


@dataclass(frozen=True)
class GradedEngine:
    """Graded meaning with the exact search; a match's margin is the log-likelihood that the next best choice loses."""

    def align(self, evidence: Evidence, deadline: float) -> Alignment:
        """Raises SettingError where the scene has no boxes."""
        until = time.monotonic() + max(0.0, deadline - time.perf_counter())
        problem = problem_of(evidence)
        found = exact(problem, time.monotonic() + 0.7 * (until - time.monotonic()))
        notes = [] if found.proved else ["the time limit struck before the alignment was proved the best"]
        margins, runners_up = _margins(problem, found.assignment, found.proved, until)
        if np.isnan(margins[found.assignment != UNMATCHED]).any():
            notes.append("the time limit struck before the margin of every match was known")
        similarity = paper_similarity(evidence)
        return Alignment(
            engine="graded",
            assignment=found.assignment,
            matrix=similarity.matrices[0],
            converged=bool(similarity.converged[0]),
            proved_best=found.proved,
            notes=tuple(notes),
            margins=margins,
            runners_up=runners_up,
            decisive=DECISIVE,
        )


def problem_of(evidence: Evidence) -> Problem:
    """The matching problem of graded facts; raises SettingError where the scene has no boxes."""
    boxes = evidence.scene.boxes
    if boxes is None:
        raise SettingError("graded meaning is about boxes, and this scene has none; use the engine 'exact'")
    facts = fact_tables(evidence.description, boxes)
    return Problem(
        ends=facts.ends,
        kinds=facts.kinds,
        tables=facts.tables,
        unary=np.where(evidence.allowed, evidence.bonus, -np.inf),
        absent=np.full(len(evidence.description.nodes), ABSENT),
    )


def _margins(
    problem: Problem, assignment: NDArray[np.int64], proved: bool, until: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """What each match's next best choice would lose, and what it is; nan where the time was up."""
    margins = np.full(len(assignment), np.nan)
    runners_up = np.full(len(assignment), UNMATCHED, dtype=np.int64)
    best = problem.value(assignment)
    for i in np.flatnonzero(assignment != UNMATCHED) if proved else ():
        unary = problem.unary.copy()
        unary[i, assignment[i]] = -np.inf
        other = exact(replace(problem, unary=unary), until)
        if not other.proved:
            break
        margins[i] = max(0.0, best - other.value)
        runners_up[i] = other.assignment[i]
    return margins, runners_up
