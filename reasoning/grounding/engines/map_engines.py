"""Engines that search for the likeliest map: exact and scalable, and two similarities from the literature.

All of them solve the same problem (:attr:`deixis.reasoning.grounding.evidence.evidence.Evidence.problem`): every fact,
label and size gives a log-likelihood ratio of a match against chance, and leaving an object out has a cost.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.engines.baselines import NodeSimilarity
from deixis.reasoning.grounding.engines.engine import Alignment
from deixis.reasoning.grounding.engines.similarity import assign
from deixis.reasoning.grounding.engines.similarity_engine import CUT_SHORT, paper_similarity
from deixis.reasoning.grounding.evidence.evidence import Evidence, Whole
from deixis.reasoning.grounding.hypotheses.hypotheses import STATED_SIDES, Side, side_text, weigh
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search.coarse_to_fine import is_large
from deixis.reasoning.grounding.matching.search.exact import exact
from deixis.reasoning.grounding.matching.search.scalable import scalable

PROOF_SHARE, SEARCH_SHARE, LARGE_SEARCH_SHARE = 0.5, 0.8, 0.4
"""Shares of the time for a search with a proof, for a search without one, and for that in a large scene, where the
probabilities need more; the rest is for the probabilities."""

SIMILARITY_SHARE = 0.3
"""Share of the remaining time that the paper's similarity may take."""

SIMILARITY_CELLS_PER_SECOND, MAX_LATENESS = 2e7, 0.1
"""Speed of preparing the paper's similarity, in pairs of things times relations per second, and its maximum overrun of
the deadline, in seconds."""

APART, MAX_NAMED = 0.05, 10
"""Minimum error of a marginal of an object that the note on disagreeing chains names, and the maximum number of
names."""

UNRELATED_NOTE = "the description{} fits this scene so poorly that it is probably of another scene"

OTHER_SIDE_NOTE = (
    "the description fits the scene {} better than from the stated viewpoint: the probability of that view is {:.2f}"
)


@dataclass(frozen=True)
class ExactEngine:
    """Branch and bound: the likeliest map, proved as far as the time allows.

    Attributes
    ----------
    sides
        Sides from which the description may be spoken, that of the evidence first.
    seen
        Evidence as seen from each side, in the order of ``sides``; None to turn the scene instead.
    """

    sides: tuple[Side, ...] = STATED_SIDES
    seen: tuple[Evidence | None, ...] = ()

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        """Find the likeliest map, with a proof if there is time, and the posterior of its matches.

        Parameters
        ----------
        evidence
            Log-likelihood ratios of n1 objects and n2 things, and of pairs.
        deadline
            Time limit.

        Returns
        -------
        Alignment
            The alignment.
        """
        found = exact(evidence.problem, deadline.share(PROOF_SHARE))
        notes = () if found.proved else ("time limit reached before the alignment was proved the best",)
        gap = 0.0 if found.proved else found.gap
        return _answer("exact", self, evidence, found.assignment, deadline, notes, gap=gap, finished=found.proved)


@dataclass(frozen=True)
class ScalableEngine:
    """Annealing and belief propagation: the likeliest map that they find, without a proof.

    Attributes
    ----------
    sides
        Sides from which the description may be spoken, that of the evidence first.
    seen
        Evidence as seen from each side, in the order of ``sides``; None to turn the scene instead.
    """

    sides: tuple[Side, ...] = STATED_SIDES
    seen: tuple[Evidence | None, ...] = ()

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        """Search for the likeliest map, and estimate the posterior of its matches.

        Parameters
        ----------
        evidence
            Log-likelihood ratios of n1 objects and n2 things, and of pairs.
        deadline
            Time limit.

        Returns
        -------
        Alignment
            The alignment, which is not proved to be the best.
        """
        share = LARGE_SEARCH_SHARE if is_large(evidence.problem.compiled) else SEARCH_SHARE
        found = scalable(evidence.problem, deadline.share(share))
        notes = () if found.finished else ("time limit reached before the search ended",)
        return _answer("scalable", self, evidence, found.assignment, deadline, notes, finished=found.finished)


@dataclass(frozen=True)
class BaselineEngine:
    """Node similarity from the literature, with the Hungarian method to choose the matches.

    Notes
    -----
    The assignment is that of H. W. Kuhn, "The Hungarian method for the assignment problem", Naval Research Logistics
    Quarterly 2, 1955, as scipy solves it.
    """

    name: str
    similarity: Callable[[Problem, Deadline], NodeSimilarity]

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        """Return the assignment with the largest sum of similarities.

        Parameters
        ----------
        evidence
            Log-likelihood ratios of n1 objects and n2 things, and of pairs.
        deadline
            Time limit.

        Returns
        -------
        Alignment
            The alignment, without a posterior.
        """
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
    name: str,
    engine: ExactEngine | ScalableEngine,
    evidence: Evidence,
    assignment: NDArray[np.int64],
    deadline: Deadline,
    notes: tuple[str, ...],
    *,
    finished: bool,
    gap: float = math.inf,
) -> Alignment:
    """Return the likeliest map of the likeliest side, its posterior, and the paper's similarity for comparison.

    In a large scene, the map by the marginals replaces one that was searched, if it is likelier with the places of
    absent objects. The posterior is left out where the time did not suffice.
    """
    if evidence.whole is not None:  # things that are not on the shortlist were not searched, so nothing is proved
        gap = math.inf
        notes += _shortlist_notes(evidence, evidence.whole)
    matrix, converged, unknown = _similarity(evidence, deadline.share(SIMILARITY_SHARE))
    seen = tuple(None if other is None else other.in_order_of(evidence) for other in engine.seen)
    found = weigh(evidence, assignment, deadline, engine.sides, seen)
    notes += unknown
    # a sum that is estimated from a map that may be far from the best is not evidence against the scene
    cut_short = found is not None and found.posterior.is_propagated and found.fits < 0.5 and gap > 0
    if found is None or cut_short:
        late = "time limit reached before the probabilities of the matches were computed"
        return Alignment(name, assignment, matrix, converged, gap == 0, (*notes, late), finished, gap)
    best = found.best
    from_elsewhere = best.evidence is not evidence
    if found.fits < 0.5:
        assignment = found.by_labels
        colours = evidence.colours is not None and evidence.colours.any()
        used = ["the usual sizes"] * bool(evidence.sizes.any()) + ["the colours"] * bool(colours)
        notes += (UNRELATED_NOTE.format(f", with {' and '.join(used)}," if used else ""),)
    elif from_elsewhere:
        again = exact(best.evidence.problem, deadline)
        assignment, gap, finished = again.assignment, 0.0 if again.proved else again.gap, finished and again.proved
        if engine.sides is STATED_SIDES and best is not found.sides[0]:
            side = side_text(best.side.angle, best.side.mirrored)
            notes += (OTHER_SIDE_NOTE.format(side, best.probability / found.fits),)
    elif found.posterior.likeliest is not None and gap > 0:
        likeliest, problem = found.posterior.likeliest, evidence.problem
        gap += max(0.0, problem.value(assignment) - problem.value(likeliest))
        assignment = likeliest
    notes += _posterior_notes(best.evidence, found.posterior)
    return Alignment(
        engine=name,
        assignment=assignment,
        matrix=matrix,
        converged=converged,
        proved_best=gap == 0,
        notes=notes,
        finished=finished,
        gap=gap,
        verdict=found,
        seen=best.evidence if from_elsewhere and found.fits >= 0.5 else None,
    )


def _shortlist_notes(evidence: Evidence, whole: Whole) -> tuple[str, ...]:
    """Return the note for an answer that rests on a shortlist of things."""
    apart = [name for name, share in zip(evidence.description.nodes, whole.outside, strict=True) if share > APART]
    shown = ", ".join(apart[:MAX_NAMED]) + (", …" if len(apart) > MAX_NAMED else "")
    found = f"{len(evidence.scene.nodes)} of {len(whole.nodes)} things were compared in detail"
    return (f"{found}: others are as likely to be {shown}" if apart else f"{found}: no other is likely to be meant",)


def _posterior_notes(evidence: Evidence, probable: Posterior) -> tuple[str, ...]:
    """Return the note for probabilities that are unknown, or on which independent chains disagree."""
    if probable.is_propagated:
        lacking = "memory" if evidence.memory_limited else "time"
        return (
            f"not enough {lacking} to sample the probabilities of matches: belief propagation estimated them, and no "
            "match is decided",
        )
    if probable.is_unknown:
        return ("time limit reached before the probabilities of the matches were computed",)
    apart = [name for name, error in zip(evidence.description.nodes, probable.errors, strict=True) if error > APART]
    if probable.exact or not apart:
        return ()
    shown = ", ".join(apart[:MAX_NAMED]) + (", …" if len(apart) > MAX_NAMED else "")
    return (f"independent chains disagree on {len(apart)} of {len(probable.errors)} objects: {shown}",)


def _similarity(evidence: Evidence, deadline: Deadline) -> tuple[NDArray[np.float64], bool, tuple[str, ...]]:
    """Return the paper's similarity (n1, n2), whether it converged, and notes; zeros where there is no time."""
    cells = len(evidence.description.vocabulary) * len(evidence.scene.nodes) ** 2
    if deadline.slowness * cells / SIMILARITY_CELLS_PER_SECOND > deadline.left + MAX_LATENESS:
        late = "time limit reached before the paper's similarity was computed: it is given as 0"
        return np.zeros(evidence.allowed.shape), False, (late,)
    found = paper_similarity(evidence, deadline=deadline)
    return found.matrices[0], bool(found.converged[0]), ()
