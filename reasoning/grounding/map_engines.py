"""The engines that look for the likeliest map: exact, scalable, and two similarities from the literature beside them.

All of them get the same problem (:attr:`deixis.reasoning.grounding.evidence.evidence.Evidence.problem`): every fact,
label and size says by how much likelier it makes a match than chance does, and leaving an object out has its price.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.engine import Alignment
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.matching.baselines import NodeSimilarity
from deixis.reasoning.grounding.matching.exact import exact
from deixis.reasoning.grounding.matching.posterior import log_marginal_likelihood, posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.matching.scalable import scalable
from deixis.reasoning.grounding.similarity import assign
from deixis.reasoning.grounding.similarity_engine import CUT_SHORT, paper_similarity

PROOF_SHARE, SEARCH_SHARE = 0.5, 0.8
"""Shares of the time that a proof, and a search without one, may take; the rest is for the probabilities."""

SIMILARITY_SHARE = 0.3
"""Share of that rest that the similarity may take."""

SIMILARITY_CELLS_PER_SECOND, MAX_LATENESS = 2e7, 0.1
"""Pairs of things by relation that the similarity looks at in a second before its first step; it may be so late."""

UNRELATED_PRIOR = 0.02
"""Prior probability that a description is of another scene."""

UNRELATED_NOTE = "the description{} fits so little that it is probably of another scene"


@dataclass(frozen=True)
class ExactEngine:
    """The likeliest map, proved so as far as the time allows."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        found = exact(evidence.problem, deadline.share(PROOF_SHARE))
        notes = () if found.proved else ("the time limit struck before the alignment was proved the best",)
        gap = 0.0 if found.proved else found.gap
        return _answer("exact", evidence, found.assignment, deadline, notes, gap=gap, finished=found.proved)


@dataclass(frozen=True)
class ScalableEngine:
    """The likeliest map that annealing and belief propagation find; it proves nothing."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        found = scalable(evidence.problem, deadline.share(SEARCH_SHARE))
        notes = () if found.finished else ("the time limit struck before the search came to its end",)
        return _answer("scalable", evidence, found.assignment, deadline, notes, finished=found.finished)


@dataclass(frozen=True)
class BaselineEngine:
    """A node similarity from the literature, made a map by the Hungarian method."""

    name: str
    similarity: Callable[[Problem, Deadline], NodeSimilarity]

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        found = self.similarity(evidence.problem, deadline)
        return Alignment(
            self.name,
            assign(found.matrix, evidence.allowed),
            found.matrix,
            converged=True,
            proved_best=False,
            notes=() if found.finished else (CUT_SHORT,),
            finished=found.finished,
        )


def _answer(
    engine: str,
    evidence: Evidence,
    assignment: NDArray[np.int64],
    deadline: Deadline,
    notes: tuple[str, ...],
    *,
    finished: bool,
    gap: float = math.inf,
) -> Alignment:
    """Return the map with its probability, where the time sufficed for one, and the paper's similarity for
    comparison."""
    matrix, converged, unknown = _similarity(evidence, deadline.share(SIMILARITY_SHARE))
    unrelated = _of_another_scene(evidence, assignment, deadline)
    probable = posterior(evidence.problem, deadline, start=assignment)
    known = math.isfinite(probable.error)
    notes += unknown
    if unrelated > 0.5:
        assignment, probable = np.full_like(assignment, UNMATCHED), probable.mixed_with_absence(unrelated)
        colours = evidence.colours is not None and evidence.colours.any()
        used = ["how large such things usually are"] * bool(evidence.sizes.any()) + ["their colours"] * bool(colours)
        notes += (UNRELATED_NOTE.format(f", with {' and '.join(used)}," if used else ""),)
    notes += () if known else ("there was no time to find out how probable the matches are",)
    return Alignment(
        engine=engine,
        assignment=assignment,
        matrix=matrix,
        converged=converged,
        proved_best=gap == 0,
        notes=notes,
        finished=finished,
        gap=gap,
        posterior=probable if known else None,
        of_another=unrelated > 0.5,
    )


def _of_another_scene(evidence: Evidence, assignment: NDArray[np.int64], deadline: Deadline) -> float:
    """Return how probable it is that the description has nothing to do with the scene; 0 where that is not known.

    Labels say themselves what is there, whatever is wrong on the table; and where nothing was found, nothing is to say.
    """
    if evidence.labels.any() or (assignment == UNMATCHED).all() or deadline.passed:
        return 0.0
    return UNRELATED_PRIOR / (UNRELATED_PRIOR + math.exp(min(log_marginal_likelihood(evidence.problem), 100.0)))


def _similarity(evidence: Evidence, deadline: Deadline) -> tuple[NDArray[np.float64], bool, tuple[str, ...]]:
    """Return the paper's similarity (n1, n2) and whether it converged; zeros and a note where there is no time to
    begin."""
    cells = len(evidence.description.vocabulary) * len(evidence.scene.nodes) ** 2
    if cells / SIMILARITY_CELLS_PER_SECOND > deadline.left + MAX_LATENESS:
        return np.zeros(evidence.allowed.shape), False, ("there was no time for the paper's similarity: it says 0",)
    found = paper_similarity(evidence, deadline=deadline)
    return found.matrices[0], bool(found.converged[0]), ()
