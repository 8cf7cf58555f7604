"""Posterior over the hypotheses of a description: this scene, from the stated or another side, or another scene.

Sides, scenes and maps have one common posterior. The weight of a side is its prior times a power of the likelihood of
the facts as seen from there, Z / U: Z is the sum of the exponentials of the values of all maps, U the same sum without
the facts. *Another scene* explains kinds and labels as well as this one, or by chance where they speak against this
one. It explains the facts as well as scenes do that the facts do not describe. How well that is depends on M, the
information that the facts could give beyond telling the things apart: the sum of the largest entry of each fact's
table, less the entropy of the maps without facts, and at least 0.

    C                        = M + CHANCE_EXCESS sqrt(M)
    log weight of a side     = log prior + FACTS_POWER (log Z - log U + L) - KINDS_POWER L
    log weight of another    = log prior + CHANCE_SHARE C - KINDS_POWER min(0, log U - log U0 + KINDS_SLACK n1)

C has a root because Z is dominated by the best of many maps, whose excess over the mean grows as the standard deviation
of a sum of facts does. It matters for short descriptions, which the best map in another scene satisfies more easily.

U0 is U with the costs of leaving objects out alone; n1 is the number of objects. L is the loss of kinds: the evidence
of sizes, colours and absence that the maps lose because of the facts, as the difference of its means over all maps, and
at least 0. Z contains this loss. It is taken out of the likelihood of the facts and counts with the power of kinds,
because sizes are independent evidence and facts are not: if things are at shuffled places, many facts hold of things of
other kinds than the described ones. Where the user pointed out an object, or a label without error names it, the
description is of this scene.

The power of the facts is below 1 because they are treated as independent and are not: a place that satisfies one fact
often satisfies others. :mod:`deixis.reasoning.grounding.fitting.fits` fits the powers to right and wrong pairs of
descriptions and scenes, and ``benchmarks/bench_fits.py`` prints the fit with its interval. The shipped powers of facts
and chance are near the fitted ones. That of kinds is larger, so that two things of quite other sizes than the described
kinds are enough for another scene.

A side, or a reading of the labels, is not searched where an upper bound of the sum of its maps shows that its share of
all hypotheses is below ``NEGLIGIBLE``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.grounding.evidence.evidence import Evidence, Whole, without_facts
from deixis.reasoning.grounding.matching.posterior.coincidences import discounted
from deixis.reasoning.grounding.matching.posterior.permanents import (
    entropy_without_facts,
    log_prior,
    log_sum_without_facts,
    mean_without_facts,
)
from deixis.reasoning.grounding.matching.posterior.posterior import BOUND_CELLS, Posterior, log_sum_bound, posterior
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.matching.search.scalable import scalable

FACTS_POWER, CHANCE_SHARE, KINDS_POWER = 0.75, 0.31, 1.4
"""Fitted powers of the evidence; see the formulas above."""

CHANCE_EXCESS = 1.0
"""Excess of the best map in another scene, in roots of nats; see the formulas above."""

KINDS_SLACK = 0.7
"""Nats per object by which kinds may fit worse than chance before that is evidence for another scene: in images, the
sizes of correctly described things often fit worse than chance."""

ANOTHER_PRIOR = 0.01
"""Prior probability that a description is of another scene: one in a hundred."""


@dataclass(frozen=True, slots=True)
class Side:
    """A side from which a description may be spoken."""

    angle: float  # radians by which the scene is turned, counter-clockwise
    mirrored: bool  # whether left and right are exchanged before the turn
    prior: float  # prior probability among all sides


@dataclass(frozen=True, slots=True)
class FitEvidence:
    """Evidence that a description is of a scene, in nats.

    Attributes
    ----------
    facts
        Log-likelihood ratio of the facts given kinds and labels, log Z - log U + L.
    most
        Upper bound M of that ratio.
    kinds
        Log-likelihood ratio of kinds and labels against chance, plus a slack, at most 0.
    loss
        Loss L of kinds in the maps that satisfy the facts, at least 0.
    """

    facts: float
    most: float
    kinds: float
    loss: float = 0.0

    @property
    def chance(self) -> float:
        """Measure C, in nats, of how well the facts fit a scene that they do not describe."""
        return self.most + CHANCE_EXCESS * math.sqrt(self.most)

    @property
    def here(self) -> float:
        """Log-likelihood of this scene, with the fitted powers."""
        return FACTS_POWER * self.facts - KINDS_POWER * self.loss

    @property
    def beside(self) -> float:
        """Log-likelihood of another scene, with the same powers."""
        return CHANCE_SHARE * self.chance - KINDS_POWER * self.kinds

    @property
    def log_odds(self) -> float:
        """Contribution of the evidence to the log-odds that the description is of this scene."""
        return self.here - self.beside

    @property
    def terms(self) -> tuple[float, float, float]:
        """Factors of the three powers in the log-odds: of facts, of chance, and of kinds."""
        return self.facts, -self.chance, self.kinds - self.loss


OPPOSITE_PRIOR, BESIDE_PRIOR, MIRROR_PRIOR = 0.001, 0.0002, 0.001
"""Prior probabilities that a stated viewpoint is wrong: the speaker is opposite; the speaker is at a given end; left
and right are exchanged. Each of the other mirror images has the prior of an end."""

STATED_SIDES = (
    Side(0.0, False, 1 - OPPOSITE_PRIOR - MIRROR_PRIOR - 5 * BESIDE_PRIOR),
    Side(math.pi, False, OPPOSITE_PRIOR),
    Side(0.0, True, MIRROR_PRIOR),
    Side(math.pi / 2, False, BESIDE_PRIOR),
    Side(3 * math.pi / 2, False, BESIDE_PRIOR),
    Side(math.pi / 2, True, BESIDE_PRIOR),
    Side(math.pi, True, BESIDE_PRIOR),
    Side(3 * math.pi / 2, True, BESIDE_PRIOR),
)
"""Sides of a scene with a stated viewpoint, which is strong but not certain evidence."""

AS_IT_STANDS = (Side(0.0, False, 1.0),)
"""Only side of a scene whose viewpoint is certain."""

MAX_THINGS = 150
"""Maximum number of things of a scene whose other sides are searched; in larger scenes, the other sides are as likely
as another scene."""

NEGLIGIBLE = 1e-5
"""Share of all hypotheses below which a side, or a reading of the labels, is left out, where a bound shows that."""

NOT_LISTED = 1e-3
"""Share of the likeliest side's weight, estimated by a search, below which the maps of a side are not listed."""

SEARCH_EFFORT = 0.05
"""Effort of the search that estimates the weight of a side."""

POSTERIOR_SHARE = 0.9
"""Share of the time for a side's posterior; the rest is for its coincidences."""

ENTROPY_SHARE = 0.27
"""Excess of the logarithm of the sum over the best value, per nat of the sum of the objects' entropies: a least-squares
fit to 100 generated tables on which both are exact."""


@dataclass(frozen=True, eq=False)
class SeenSide:
    """A side, its posterior probability, and the evidence as seen from that side."""

    side: Side
    probability: float
    evidence: Evidence


@dataclass(frozen=True, eq=False)
class Verdict:
    """Posterior over all hypotheses.

    Attributes
    ----------
    posterior
        Posterior of the matches, summed over all hypotheses.
    fits
        Probability that the description is of this scene, from any side.
    evidence
        Evidence for ``fits`` as seen from the first side.
    sides
        Sides in the order in which they were given.
    by_labels
        Best map by labels alone, shape (n1,): the answer where the description is of another scene.
    labelled
        Posterior of the matches by labels alone.
    """

    posterior: Posterior
    fits: float
    evidence: FitEvidence
    sides: tuple[SeenSide, ...]
    by_labels: NDArray[np.int64]
    labelled: Posterior

    @property
    def best(self) -> SeenSide:
        """Likeliest side; the first one of equally likely sides."""
        return max(self.sides, key=lambda one: round(one.probability, 9))


def weigh(
    evidence: Evidence,
    assignment: NDArray[np.int64],
    deadline: Deadline = Deadline.never(),
    sides: Sequence[Side] = STATED_SIDES,
    seen: Sequence[Evidence | None] = (),
    another: float = ANOTHER_PRIOR,
) -> Verdict | None:
    """Return the posterior over maps, sides and scenes; None where the time did not suffice for the first side.

    Parameters
    ----------
    evidence
        Evidence for each match as seen from the first side.
    assignment
        Best known map as seen from the first side, shape (n1,).
    deadline
        End of the time limit. Sides that were not searched by then are as likely as another scene and give no matches.
    sides
        Sides and their priors.
    seen
        Evidence as seen from each side, with objects and things in the order of ``evidence``; where it is None, the
        scene is turned.
    another
        Prior probability of another scene.

    Returns
    -------
    Verdict
        Posterior of the matches, the sides, and the probability that the description is of this scene.

    Examples
    --------
    >>> from deixis.ontology.graph.graph import Fact, RelationGraph
    >>> from deixis.ontology.tbox import default_ontology
    >>> from deixis.reasoning.geometry.rectangle import scene_relations
    >>> from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
    >>> relations = default_ontology().relations
    >>> said = RelationGraph.from_facts(relations, ["cup", "mug"], [Fact("cup", (relations["left"],), "mug")])
    >>> boxes = np.array([[[0.0, 0.0], [0.1, 0.1]], [[0.2, 0.0], [0.3, 0.1]]])
    >>> known = no_unary_evidence(said, scene_relations(["p", "q"], boxes, relations))
    >>> found = weigh(known, np.array([0, 1]))
    >>> round(found.fits, 2), [round(one.probability, 3) for one in found.sides[:3]]
    (0.99, [0.991, 0.001, 0.001])
    """
    first = _maps_of(evidence, assignment, deadline.share(0.6))
    if first.found is None or first.found.is_unknown:
        return None
    problem, readings = evidence.problem, evidence.label_readings
    alone = _log_sum([weight + log_sum_without_facts(known.without_facts) for weight, known in readings])
    most = float(problem.tables.max(axis=(1, 2), initial=0.0)[problem.kinds].sum()) if len(problem.ends) else 0.0
    most = max(0.0, most - entropy_without_facts(evidence.without_facts))
    usual = _kinds_without_facts(evidence)
    loss = max(0.0, usual - first.kinds)
    fit = FitEvidence(
        first.log_total - alone + loss,
        most,
        min(0.0, alone - log_prior(evidence.without_facts) + KINDS_SLACK * len(problem.absent)),
        loss,
    )
    elsewhere = math.log(another / (1 - another)) + fit.beside
    if evidence.present.any():  # an object that was pointed out is of this scene
        elsewhere = -math.inf
    maps = [first]
    weights = [math.log(sides[0].prior) + fit.here]
    rest = list(zip(sides[1:], seen[1:] if seen else (None,) * len(sides[1:]), strict=True))
    for number, (side, known) in enumerate(rest):
        there = None
        if not (deadline.passed or evidence.scene.boxes is None or len(evidence.things) > MAX_THINGS):
            turned = evidence.seen_from(side.angle, side.mirrored) if known is None else known
            left = deadline.share(1 / (len(rest) - number))
            known_so_far = _log_sum([*weights, elsewhere])
            levels = [
                (weight + math.log(share) - math.log(side.prior)) / FACTS_POWER + alone
                for weight, share in ((known_so_far, NEGLIGIBLE), (max(weights), NOT_LISTED))
            ]
            with suppress(OutOfTimeError):
                there = _maps_of(turned, None, left, first.log_total - first.log_best, *levels)
        maps.append(replace(first, found=None) if there is None else there)
        likelihood = CHANCE_SHARE * fit.chance
        if there is not None:
            loss = max(0.0, usual - there.kinds)
            likelihood = replace(fit, facts=there.log_total - alone + loss, loss=loss).here
        weights.append(math.log(side.prior) + likelihood)
    weights.append(elsewhere)
    shares = np.exp(np.array(weights) - _log_sum(weights)).tolist()
    by_labels, labelled = _by_labels(evidence)
    parts = [(share, one.found) for share, one in zip(shares[:-1], maps, strict=True) if one.found is not None]
    listed = tuple(SeenSide(side, share, one.evidence) for side, share, one in zip(sides, shares, maps, strict=False))
    return Verdict(_mixed([*parts, (shares[-1], labelled)]), 1 - shares[-1], fit, listed, by_labels, labelled)


@dataclass(frozen=True, eq=False)
class _Maps:
    """Maps of a description in a scene as seen from one side, over both readings of the labels.

    ``evidence`` is that of the likelier reading, ``log_best`` the value of its best map. ``found`` is the posterior,
    None where the maps are not listed. ``kinds`` is the mean evidence of sizes, colours and absence, infinite where it
    is not known.
    """

    evidence: Evidence
    log_best: float
    log_total: float
    found: Posterior | None
    kinds: float = math.inf


def _maps_of(
    evidence: Evidence,
    assignment: NDArray[np.int64] | None,
    deadline: Deadline,
    spread: float = 0.0,
    negligible: float = -math.inf,
    not_listed: float = -math.inf,
) -> _Maps:
    """Return the maps of both readings of the labels.

    ``assignment`` is the best map of the first reading, where it is known. The maps are not searched where a bound
    shows that the logarithm of their sum is at most ``negligible``. They are not listed where a search estimates that
    logarithm below ``not_listed``; the estimate is the value of the best map plus ``spread``.
    """
    readings, parted = evidence.label_readings, math.log(len(evidence.label_readings))
    if negligible > -math.inf:
        bounds = [weight + _bound(one, negligible - parted - weight) for weight, one in readings]
        if _log_sum(bounds) <= negligible:
            return _Maps(replace(evidence), -math.inf, -math.inf, None)  # a copy without the cached tables
    seen: list[tuple[float, float, Evidence, Posterior | None, float]] = []
    for weight, known in readings:
        if seen:
            enough = _log_sum([total for _, total, *_ in seen]) + math.log(NEGLIGIBLE) - weight
            if _bound(known, enough) <= enough:
                continue
        problem = known.problem
        best = assignment if assignment is not None and not seen else None
        if best is None:
            best = scalable(problem, deadline.share(0.5), effort=SEARCH_EFFORT).assignment
        value = problem.value(best)
        found, total, kinds = None, value + spread, math.inf
        enough = max([not_listed, *(one[1] + math.log(NOT_LISTED) for one in seen)])
        if weight + total >= enough and (not seen or not deadline.passed):
            found = posterior(problem, deadline.share(POSTERIOR_SHARE), start=best, chains=not known.memory_limited)
            total, kinds = log_total(found, value), _kinds_with_facts(known, found)
            found = discounted(problem, found, deadline)
            if known.whole is not None:
                found, total = _of_shortlist(found, known.whole), total + _log_outside(known)
        seen.append((weight + value, weight + total, known, found, kinds))
    together = _log_sum([total for _, total, *_ in seen])
    listed = [(math.exp(total - together), found, kinds) for _, total, _, found, kinds in seen if found is not None]
    log_best, _, known, *_ = max(seen, key=lambda one: one[0])
    if not listed:
        return _Maps(known, log_best, together, None)
    kinds = sum(share * of_maps for share, _, of_maps in listed) / sum(share for share, *_ in listed)
    return _Maps(known, log_best, together, _mixed([(share, found) for share, found, _ in listed]), kinds)


def _kinds_with_facts(evidence: Evidence, found: Posterior) -> float:
    """Return the mean evidence of sizes, colours and absence over the maps; infinite for a shortlist."""
    if evidence.whole is not None:
        return math.inf
    values = np.column_stack([np.where(evidence.allowed, evidence.of_kinds, 0.0), evidence.absent])
    return float((found.marginals * values).sum())


def _kinds_without_facts(evidence: Evidence) -> float:
    """Return the mean evidence of sizes, colours and absence over the maps without facts."""
    if evidence.whole is not None or not evidence.of_kinds.any():
        return -math.inf
    return mean_without_facts(evidence.without_facts, evidence.of_kinds)


def _bound(evidence: Evidence, enough: float) -> float:
    """Return an upper bound (:func:`log_sum_bound`) of the log sum over all maps, infinite where that takes long."""
    if 2 * len(evidence.facts) * (len(evidence.scene.nodes) + 1) ** 2 > BOUND_CELLS:
        return math.inf  # without building the tables
    outside = _log_outside(evidence)
    return log_sum_bound(evidence.upper_problem, enough - outside) + outside


def _of_shortlist(found: Posterior, whole: Whole) -> Posterior:
    """Return a shortlist's posterior for the whole scene, scaled and with the probability of other things as error."""
    inside = 1.0 - whole.outside
    errors = found.errors + whole.outside
    return replace(
        found, marginals=found.marginals * inside[:, None], exact=False, error=float(errors.max()), errors=errors
    )


def _log_outside(evidence: Evidence) -> float:
    """Estimate how much maps to things that are not on the shortlist add to the log sum; 0 without a shortlist."""
    if evidence.whole is None:
        return 0.0
    return -math.log1p(-min(float(evidence.whole.outside.max(initial=0.0)), 1.0 - 1e-9))


def _mixed(parts: Sequence[tuple[float, Posterior]]) -> Posterior:
    """Return the mixture of posteriors with these shares; a share without a posterior gives no match a probability.

    Its likeliest map is that of the largest share.
    """
    parts = [(share, one) for share, one in parts if share > 0]
    return Posterior(
        np.sum([share * one.marginals for share, one in parts], axis=0),
        all(one.exact for _, one in parts),
        sum(share * one.error for share, one in parts),
        np.sum([share * one.errors for share, one in parts], axis=0),
        any(one.is_propagated for _, one in parts),
        likeliest=max(parts, key=lambda part: part[0])[1].likeliest,
    )


def _log_sum(values: Sequence[float]) -> float:
    return float(np.logaddexp.reduce(np.array(values)))


def log_total(found: Posterior, value: float) -> float:
    """Return the logarithm of the sum over all maps.

    Parameters
    ----------
    found
        Posterior of the matches.
    value
        Logarithm of the best map's weight.

    Returns
    -------
    float
        The logarithm: exact, or estimated from the best value and the objects' entropies.
    """
    return found.log_total if math.isfinite(found.log_total) else value + ENTROPY_SHARE * float(found.entropy.sum())


def _by_labels(evidence: Evidence) -> tuple[NDArray[np.int64], Posterior]:
    """Return the best map (n1,) by labels alone, and its posterior; objects that no label supports have no match.

    The prior odds that an object of another scene is absent here are 1.
    """
    from deixis.reasoning.grounding.matching.search.exact import exact

    is_labelled = evidence.allowed & (evidence.labels > 0)
    rows, unmatched = np.flatnonzero(is_labelled.any(axis=1)), np.full(len(is_labelled), UNMATCHED)
    marginals = np.zeros((len(is_labelled), is_labelled.shape[1] + 1))
    marginals[:, -1] = 1.0
    if not len(rows):
        return unmatched, Posterior(marginals, True, 0.0)
    labelled = without_facts(np.where(is_labelled, evidence.labels, 0.0)[rows], np.zeros(len(rows)), is_labelled[rows])
    found = posterior(labelled)
    marginals[rows] = found.marginals
    if evidence.whole is not None:
        marginals *= evidence.whole.labelled_inside[:, None]
    unmatched[rows] = exact(labelled).assignment
    return unmatched, Posterior(marginals, found.exact, found.error, is_propagated=found.is_propagated)


def side_text(angle: float, mirrored: bool) -> str:
    """Describe in words how the scene is turned or mirrored for a side.

    Parameters
    ----------
    angle
        Angle in radians, counter-clockwise.
    mirrored
        True if the scene is mirrored.

    Returns
    -------
    str
        A phrase.

    Examples
    --------
    >>> side_text(math.pi, False), side_text(0.0, True)
    ('turned by 180 degrees counter-clockwise', 'mirrored and as it stands')
    """
    degrees = round(math.degrees(angle)) % 360
    turn = "as it stands" if degrees == 0 else f"turned by {degrees} degrees counter-clockwise"
    return f"mirrored and {turn}" if mirrored else turn
