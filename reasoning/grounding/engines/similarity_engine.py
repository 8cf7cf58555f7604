"""The paper's engine: equations 5 to 9, the Hungarian method, and a choice among sub-graphs.

Where one side has more objects than the other, the engine tries all of its sub-graphs that are as large as the other
side. Where these are too many, a heuristic chooses one, and a note of the answer says so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import combinations, islice

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import PaperGraph, RelationGraph
from deixis.reasoning.grounding.engines.engine import Alignment
from deixis.reasoning.grounding.engines.similarity import (
    ITERATIONS,
    SimilarityMatrices,
    assign,
    graph_similarity,
    node_similarity,
    with_same_word,
)
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import Select

MAX_SUBGRAPHS = 5000
"""Maximum number of sub-graphs that are all tried; where there are more, a heuristic chooses one."""

CUT_SHORT = "time limit reached before the similarity converged"

_SUBGRAPHS_PER_BLOCK = 500
_MAX_MULTIPLICATIONS = 2e10
"""Maximum number of multiplications of the similarity; where one step would need more, only equation 5 is computed."""

MAX_DESCRIBED = 20_000
"""Maximum number of stated and implied facts of the similarity; where there are more, it uses only the stated ones."""


def described(description: RelationGraph, consistent: bool | None = None) -> PaperGraph:
    """Return a description as the paper's graph, with inverse facts and those that transitivity of a word implies.

    Parameters
    ----------
    description
        The relation graph of the description.
    consistent
        Whether the firm facts can hold together; None if that is unknown.

    Returns
    -------
    PaperGraph
        The labelled graph.
    """
    return with_same_word(description, MAX_DESCRIBED, consistent).paper_view()


def paper_similarity(
    evidence: Evidence, members: NDArray[np.bool_] | None = None, deadline: Deadline = Deadline.never()
) -> SimilarityMatrices:
    """Compute equations 5 to 9: certain labels forbid pairs, and uncertain labels multiply equation 5.

    Parameters
    ----------
    evidence
        The evidence, whose certain labels forbid pairs.
    members
        Objects of each sub-graph, shape (b, n1); default: one sub-graph of all objects.
    deadline
        Time at which the iteration stops.

    Returns
    -------
    SimilarityMatrices
        Matrices of shape (b, n1, n2).
    """
    first, second = described(evidence.description, evidence.consistent), evidence.scene.paper_view()
    n2 = len(second.vertices)
    work = 2 * len(first.labels) * len(first.vertices) * n2 * n2 + 2000 * len(first.edges)
    affordable = _MAX_MULTIPLICATIONS / max(work, 1)
    iterations = 0 if affordable < 1 else int(np.clip(affordable, 5, ITERATIONS))
    return node_similarity(first, second, members, _prior(evidence), iterations=iterations, deadline=deadline)


def _prior(evidence: Evidence) -> NDArray[np.float64]:
    """Return the factors (n1, n2) of labels for the similarity: 1 for the best-named object, 0 where ruled out."""
    named = evidence.allowed | ~evidence.identified
    best = evidence.labels.max(axis=0, where=named, initial=-np.inf)
    prior: NDArray[np.float64] = np.exp(evidence.labels - np.where(np.isneginf(best), 0.0, best))
    return prior * named


@dataclass(frozen=True)
class SimilarityEngine:
    """Engine of the paper: node similarity and the Hungarian method, over sub-graphs of the larger side."""

    select: Select = Select.FACTS

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        """Return the assignment with the largest similarity, over the sub-graphs of the larger side.

        Parameters
        ----------
        evidence
            The evidence of n1 objects and n2 things.
        deadline
            Time limit.

        Returns
        -------
        Alignment
            The alignment, without a posterior.
        """
        n1, n2 = evidence.allowed.shape
        if n1 == n2 or not n1 or not n2:
            found = paper_similarity(evidence, deadline=deadline)
            return _in_time(self._alignment(evidence, found, assign(found.matrices[0], evidence.allowed)), deadline)
        larger, smaller = max(n1, n2), min(n1, n2)
        count = math.comb(larger, smaller)
        if count > MAX_SUBGRAPHS:
            found = paper_similarity(evidence, deadline=deadline)
            assignment = assign(found.matrices[0], evidence.allowed)
            note = (
                f"{count} sub-graphs are too many to try all: the assignment on the whole graphs chose one (heuristic)"
            )
            if len(evidence.description.nodes) > len(evidence.scene.nodes):
                kept = assignment != UNMATCHED
                found = paper_similarity(evidence, kept[None, :], deadline)
                assignment = assign(found.matrices[0], evidence.allowed & kept[:, None])
            return _in_time(self._alignment(evidence, found, assignment, (note,)), deadline)
        return self._all_subgraphs(evidence, larger, smaller, deadline)

    def _all_subgraphs(self, evidence: Evidence, larger: int, smaller: int, deadline: Deadline) -> Alignment:
        """Return the best alignment over all sub-graphs of the larger side that have as many nodes as the smaller."""
        flipped = len(evidence.description.nodes) == smaller
        prior = _prior(evidence)
        first, second = described(evidence.description, evidence.consistent), evidence.scene.paper_view()
        best: tuple[tuple[float, ...], Alignment] | None = None
        chosen = combinations(range(larger), smaller)
        while rows := list(islice(chosen, _SUBGRAPHS_PER_BLOCK)):
            if best is not None and deadline.passed:
                return _cut_short(best[1])
            members = np.zeros((len(rows), larger), dtype=bool)
            members[np.arange(len(rows))[:, None], np.array(rows, dtype=np.int64).reshape(len(rows), smaller)] = True
            if flipped:
                found = node_similarity(second, first, members, prior.T, deadline=deadline).transposed()
            else:
                found = node_similarity(first, second, members, prior, deadline=deadline)
            for number, kept in enumerate(members):
                inside = kept[None, :] if flipped else kept[:, None]
                assignment = assign(found.matrices[number], evidence.allowed & inside)
                key = self._key(evidence, found.matrices[number], assignment)
                if best is None or key > best[0]:
                    best = key, self._alignment(evidence, found, assignment, number=number)
        assert best is not None
        return _in_time(best[1], deadline)

    def _key(
        self, evidence: Evidence, matrix: NDArray[np.float64], assignment: NDArray[np.int64]
    ) -> tuple[float, float]:
        similarity = round(graph_similarity(matrix, assignment), 9)
        return (
            (similarity, 0.0)
            if self.select is Select.SIMILARITY
            else (
                round(evidence.total(assignment), 9),
                similarity,
            )
        )

    def _alignment(
        self,
        evidence: Evidence,
        found: SimilarityMatrices,
        assignment: NDArray[np.int64],
        notes: tuple[str, ...] = (),
        number: int = 0,
    ) -> Alignment:
        matrix, converged = found.matrices[number], bool(found.converged[number])
        margins, runners_up = _similarity_margins(matrix, assignment, evidence.allowed)
        return Alignment(
            "similarity", assignment, matrix, converged, False, notes, margins=margins, runners_up=runners_up
        )


def _in_time(aligned: Alignment, deadline: Deadline) -> Alignment:
    """Return the alignment, marked as cut short where the iteration had not converged at the deadline."""
    return aligned if aligned.converged or not deadline.passed else _cut_short(aligned)


def _cut_short(aligned: Alignment) -> Alignment:
    return replace(aligned, notes=(*aligned.notes, CUT_SHORT), finished=False)


def _similarity_margins(
    matrix: NDArray[np.float64], assignment: NDArray[np.int64], allowed: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the lead (n1,) of each match's similarity over the next best entry of its row, and that entry (n1,)."""
    margins = np.full(len(assignment), np.nan)
    runners_up = np.full(len(assignment), UNMATCHED, dtype=np.int64)
    for i in np.flatnonzero(assignment != UNMATCHED):
        others = np.where(allowed[i], matrix[i], -np.inf)
        others[assignment[i]] = -np.inf
        if np.isfinite(others).any():
            runners_up[i] = int(others.argmax())
            margins[i] = matrix[i, assignment[i]] - others.max()
    return margins, runners_up
