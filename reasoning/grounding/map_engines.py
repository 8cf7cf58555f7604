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
from deixis.reasoning.grounding.evidence.evidence import Evidence, Whole
from deixis.reasoning.grounding.hypotheses import STATED_SIDES, Side, side_text, weigh
from deixis.reasoning.grounding.matching.baselines import NodeSimilarity
from deixis.reasoning.grounding.matching.exact import exact
from deixis.reasoning.grounding.matching.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.scalable import scalable
from deixis.reasoning.grounding.similarity import assign
from deixis.reasoning.grounding.similarity_engine import CUT_SHORT, paper_similarity

PROOF_SHARE, SEARCH_SHARE = 0.5, 0.8
"""Shares of the time that a proof, and a search without one, may take; the rest is for the probabilities."""

SIMILARITY_SHARE = 0.3
"""Share of that rest that the similarity may take."""

SIMILARITY_CELLS_PER_SECOND, MAX_LATENESS = 2e7, 0.1
"""Pairs of things by relation that the similarity looks at in a second before its first step; it may be so late."""

APART, MAX_NAMED = 0.05, 10
"""Error of a marginal from which chains are said to disagree on an object, and the most objects to be named."""

UNRELATED_NOTE = "the description{} fits so little that it is probably of another scene"

OTHER_SIDE_NOTE = (
    "the description fits the scene {} better than as its viewpoint is stated: with probability {:.2f} it is so seen"
)


@dataclass(frozen=True)
class ExactEngine:
    """The likeliest map, proved so as far as the time allows.

    ``sides`` are those from which the description may speak, that of the evidence first; ``seen`` is what is seen from
    each, where that is more than the scene turned.
    """

    sides: tuple[Side, ...] = STATED_SIDES
    seen: tuple[Evidence | None, ...] = ()

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        found = exact(evidence.problem, deadline.share(PROOF_SHARE))
        notes = () if found.proved else ("the time limit struck before the alignment was proved the best",)
        gap = 0.0 if found.proved else found.gap
        return _answer("exact", self, evidence, found.assignment, deadline, notes, gap=gap, finished=found.proved)


@dataclass(frozen=True)
class ScalableEngine:
    """The likeliest map that annealing and belief propagation find; it proves nothing. The rest as for the other."""

    sides: tuple[Side, ...] = STATED_SIDES
    seen: tuple[Evidence | None, ...] = ()

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        found = scalable(evidence.problem, deadline.share(SEARCH_SHARE))
        notes = () if found.finished else ("the time limit struck before the search came to its end",)
        return _answer("scalable", self, evidence, found.assignment, deadline, notes, finished=found.finished)


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
    """Return the likeliest map of the likeliest side with its probability over all hypotheses, where the time sufficed
    for one, and the paper's similarity for comparison."""
    if evidence.whole is not None:  # other things are not looked at, so that nothing is proved
        gap = math.inf
        notes += _shortlist_notes(evidence, evidence.whole)
    matrix, converged, unknown = _similarity(evidence, deadline.share(SIMILARITY_SHARE))
    seen = tuple(None if other is None else other.in_order_of(evidence) for other in engine.seen)
    found = weigh(evidence, assignment, deadline, engine.sides, seen)
    notes += unknown
    if found is None:
        late = "there was no time to find out how probable the matches are"
        return Alignment(name, assignment, matrix, converged, gap == 0, (*notes, late), finished, gap)
    best = found.best
    from_elsewhere = best.evidence is not evidence
    if found.fits < 0.5:
        assignment = found.by_labels
        colours = evidence.colours is not None and evidence.colours.any()
        used = ["how large such things usually are"] * bool(evidence.sizes.any()) + ["their colours"] * bool(colours)
        notes += (UNRELATED_NOTE.format(f", with {' and '.join(used)}," if used else ""),)
    elif from_elsewhere:
        again = exact(best.evidence.problem, deadline)
        assignment, gap, finished = again.assignment, 0.0 if again.proved else again.gap, finished and again.proved
        if engine.sides is STATED_SIDES and best is not found.sides[0]:
            side = side_text(best.side.angle, best.side.mirrored)
            notes += (OTHER_SIDE_NOTE.format(side, best.probability / found.fits),)
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
    """Return what is to be said of an answer that rests on a shortlist of things."""
    apart = [name for name, share in zip(evidence.description.nodes, whole.outside, strict=True) if share > APART]
    shown = ", ".join(apart[:MAX_NAMED]) + (", …" if len(apart) > MAX_NAMED else "")
    found = f"{len(evidence.scene.nodes)} of {len(whole.nodes)} things were looked at closely"
    return (f"{found}: others are as likely to be {shown}" if apart else f"{found}: no other is likely to be meant",)


def _posterior_notes(evidence: Evidence, probable: Posterior) -> tuple[str, ...]:
    """Return what is to be said of probabilities that are not known, or on which independent chains disagree."""
    if probable.believed:
        lacking = "memory" if evidence.frugal else "time"
        return (f"no {lacking} was left to sample how probable matches are: these are beliefs, and nothing is decided",)
    if not math.isfinite(probable.error):
        return ("there was no time to find out how probable the matches are",)
    apart = [name for name, error in zip(evidence.description.nodes, probable.errors, strict=True) if error > APART]
    if probable.exact or not apart:
        return ()
    shown = ", ".join(apart[:MAX_NAMED]) + (", …" if len(apart) > MAX_NAMED else "")
    return (f"independent chains disagree on {len(apart)} of {len(probable.errors)} objects: {shown}",)


def _similarity(evidence: Evidence, deadline: Deadline) -> tuple[NDArray[np.float64], bool, tuple[str, ...]]:
    """Return the paper's similarity (n1, n2) and whether it converged; zeros and a note where there is no time to
    begin."""
    cells = len(evidence.description.vocabulary) * len(evidence.scene.nodes) ** 2
    if cells / SIMILARITY_CELLS_PER_SECOND > deadline.left + MAX_LATENESS:
        return np.zeros(evidence.allowed.shape), False, ("there was no time for the paper's similarity: it says 0",)
    found = paper_similarity(evidence, deadline=deadline)
    return found.matrices[0], bool(found.converged[0]), ()
