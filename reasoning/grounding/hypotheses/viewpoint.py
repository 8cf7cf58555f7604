"""Recover the viewpoint of a description: the side from which it is spoken, together with the matches.

A *viewpoint* is the angle by which the scene must be turned, and whether it must be mirrored, so that left is what the
speaker calls left. The matching problem is built again for each viewpoint; its log evidence is the logarithm of the sum
over all maps of the exponential of their values, as far as maps can be listed. The posterior is the evidence, raised to
the power of facts (:mod:`deixis.reasoning.grounding.hypotheses.hypotheses`), times a prior: uniform over the circle,
and mirrored with probability ``MIRROR_PRIOR``, because speakers seldom stand behind a mirror.

Quarter turns are exact. For any other angle, centres are turned exactly. The extents are estimated on the assumption
that things lie parallel to the speaker's axes: the enclosing box of a w by h rectangle that is turned by t has
W + H = (w + h)(|cos t| + |sin t|) and W - H = (w - h)(|cos t| - |sin t|). Approximately square boxes are taken for
round things, whose box does not change. At an eighth of a turn the box of a long thing is square, too, and cannot be
distinguished from that of a round one.

The probability of a match is a sum over sides (:mod:`deixis.reasoning.grounding.hypotheses.hypotheses`): a match that
depends on a side is at most as probable as the side.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.geometry.rectangle import require_boxes
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.hypotheses.hypotheses import FACTS_POWER
from deixis.reasoning.grounding.matching.problem import Problem

Array = NDArray[np.float64]

MIRROR_PRIOR = 0.05
COARSE_ANGLES = 24  # angles of the first grid: every 15 degrees
FINE_PER_COARSE = 5  # angles of the fine grid per angle of the coarse grid
REFINEMENT_MARGIN = 6.0  # nats below the best angle within which an angle is refined
VIEWPOINT_MARGIN = 12.0  # nats below the best map; a viewpoint whose best map is lower lists no other maps
MAP_MARGIN = 4.0  # nats below the best map within which maps are listed
MAX_LISTED_MAPS = 300
TIE_TOLERANCE = 1e-6  # nats within which two viewpoints are tied


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A viewpoint with its posterior probability and its best map.

    Attributes
    ----------
    angle
        Radians in [0, 2 pi) by which the scene is turned, counter-clockwise.
    mirrored
        Whether left and right are exchanged before the turn.
    probability
        Posterior probability.
    log_evidence
        Log evidence in nats.
    assignment
        Best map as seen from the viewpoint, shape (n1,).
    concentration
        Mean resultant length of the angles that the viewpoint combines (Mardia and Jupp 2000, 2.3): 1 for a single
        angle, 0 where they cover the whole circle, so that their mean has no meaning.
    prior
        Prior probability of these angles.
    """

    angle: float
    mirrored: bool
    probability: float
    log_evidence: float
    assignment: NDArray[np.int64]
    concentration: float = 1.0
    prior: float = 1.0


@dataclass(frozen=True, eq=False)
class Viewpoints:
    """Posterior over viewpoints.

    Attributes
    ----------
    viewpoints
        Distinct viewpoints, most probable first.
    exact
        Whether every log evidence counts all maps within the margin; if not, it is a lower bound.
    everywhere
        Whether the time sufficed to search every side.
    """

    viewpoints: tuple[Viewpoint, ...]
    exact: bool
    everywhere: bool = True

    @property
    def best(self) -> Viewpoint:
        """Most probable viewpoint."""
        return self.viewpoints[0]

    @property
    def ties(self) -> tuple[Viewpoint, ...]:
        """Viewpoints with the same evidence as the best one, which is among them; only the prior chooses."""
        best = self.best.log_evidence
        return tuple(view for view in self.viewpoints if abs(view.log_evidence - best) <= TIE_TOLERANCE)


def recover_viewpoint(
    boxes: Array,
    problem_of: Callable[[Array], Problem],
    *,
    any_angle: bool = False,
    mirror: bool = True,
    deadline: Deadline = Deadline.never(),
) -> Viewpoints:
    """Return the posterior over viewpoints.

    Parameters
    ----------
    boxes
        Boxes of the scene, shape (n2, 2, d).
    problem_of
        Function that builds the matching problem from boxes (n2, 2, d) as seen from a viewpoint. The values must be
        log-likelihood ratios that are comparable between viewpoints.
    any_angle
        Whether to search all angles instead of quarter turns.
    mirror
        Whether to search mirrored viewpoints, too.
    deadline
        End of the time limit. The scene is searched as it stands in any case, then quarter turned, then from the other
        sides. Sides that were not searched have the evidence of the best one that was.

    Returns
    -------
    Viewpoints
        The viewpoints with their probabilities.

    Raises
    ------
    GraphError
        ``boxes`` are not valid boxes.
    """
    require_boxes(boxes)
    sides = (False, True) if mirror else (False,)
    count = COARSE_ANGLES if any_angle else 4
    tried = [_Angle(step * 2 * math.pi / count, side, 1 / count) for side in sides for step in range(count)]
    tried.sort(key=lambda one: one.angle % (math.pi / 2) > 1e-9)
    look = _AngleSearch(boxes, problem_of, deadline)
    looked = look.at(tried)
    not_looked = tried[len(looked) :]
    everywhere = not not_looked
    if any_angle:
        looked, closely = look.closer(looked)
        everywhere = everywhere and closely
    modes = _modes(looked) if any_angle else [[one] for one in looked]
    found = [_viewpoint(mode, mirror) for mode in modes]
    unseen = [math.log(_prior(one.mirrored, mirror) * one.share) for one in not_looked]
    best = max(view.log_evidence for view, _ in found)
    total = _log_sum([score for _, score in found] + [FACTS_POWER * best + prior for prior in unseen])
    views = [replace(view, probability=math.exp(score - total)) for view, score in found]
    views.sort(key=lambda view: (-round(view.probability, 9), view.mirrored, view.angle))
    return Viewpoints(tuple(views), everywhere and all(one.complete for one in looked), everywhere)


@dataclass(frozen=True)
class _Angle:
    """Angle that represents a share of the circle."""

    angle: float
    mirrored: bool
    share: float


@dataclass(frozen=True, eq=False)
class _AngleEvidence:
    tried: _Angle
    log_evidence: float
    assignment: NDArray[np.int64]
    complete: bool


@dataclass(frozen=True, eq=False)
class _AngleSearch:
    boxes: Array
    problem_of: Callable[[Array], Problem]
    deadline: Deadline

    def at(self, tried: Sequence[_Angle]) -> list[_AngleEvidence]:
        """Search the angles until the deadline: the best map of each, and the evidence of all maps where that is near.

        Each search gets its share of the time left, so that the first one does not use all of it. The first angle is
        searched in any case.
        """
        found: list[tuple[_AngleEvidence, Problem]] = []
        for one in tried:
            if found and self.deadline.passed:
                break
            problem = self.problem_of(turned(self.boxes, one.angle, one.mirrored))
            found.append((self._best(one, problem, self.deadline.share(1 / (len(tried) - len(found)))), problem))
        most = max(one.log_evidence for one, _ in found)
        return [
            self._listed(one, problem) if one.log_evidence >= most - VIEWPOINT_MARGIN else one for one, problem in found
        ]

    def _best(self, one: _Angle, problem: Problem, deadline: Deadline) -> _AngleEvidence:
        from deixis.reasoning.grounding.matching.search.exact import exact

        best = exact(problem, deadline)
        return _AngleEvidence(one, best.value, best.assignment, best.proved)

    def _listed(self, one: _AngleEvidence, problem: Problem) -> _AngleEvidence:
        from deixis.reasoning.grounding.matching.search.exact import maps_within

        if self.deadline.passed:
            return replace(one, complete=False)
        maps = maps_within(problem, MAP_MARGIN, self.deadline, limit=MAX_LISTED_MAPS)
        return _AngleEvidence(one.tried, _log_sum(maps.values.tolist()), maps.assignments[0], maps.complete)

    def closer(self, looked: Sequence[_AngleEvidence]) -> tuple[list[_AngleEvidence], bool]:
        """Replace the best angles by finer ones over the same arc; also return whether the time sufficed for all."""
        best = max(one.log_evidence for one in looked)
        refined = [one.tried for one in looked if one.log_evidence >= best - REFINEMENT_MARGIN]
        if self.deadline.passed:
            return list(looked), False
        fine = [finer for one in refined for finer in _finer(one)]
        seen = self.at(fine)
        done = len(seen) // FINE_PER_COARSE  # an arc that was not searched completely keeps its coarse angle
        replaced = {id(one) for one in refined[:done]}
        kept = [one for one in looked if id(one.tried) not in replaced]
        return kept + seen[: done * FINE_PER_COARSE], len(seen) == len(fine)


def _finer(one: _Angle) -> list[_Angle]:
    """Return the angles of a finer grid over the same arc."""
    share = one.share / FINE_PER_COARSE
    angles = [one.angle + (k - (FINE_PER_COARSE - 1) / 2) * 2 * math.pi * share for k in range(FINE_PER_COARSE)]
    return [_Angle(angle % (2 * math.pi), one.mirrored, share) for angle in angles]


def _modes(looked: Sequence[_AngleEvidence]) -> list[list[_AngleEvidence]]:
    """Group neighbouring angles into viewpoints: those on the slopes of one peak, or with the same best map."""
    modes: list[list[_AngleEvidence]] = []
    for side in (False, True):
        ring = sorted((one for one in looked if one.tried.mirrored is side), key=lambda one: one.tried.angle)
        groups: dict[int, list[_AngleEvidence]] = {}
        for home, one in zip(_homes(ring), ring, strict=True):
            groups.setdefault(home, []).append(one)
        modes += groups.values()
    return modes


def _homes(ring: list[_AngleEvidence]) -> list[int]:
    """Return the group number of each angle of a circle."""
    n = len(ring)
    homes = list(range(n))
    for i in range(n):
        after, before = (i + 1) % n, (i - 1) % n
        higher = max((before, after), key=lambda j: round(ring[j].log_evidence, 9))
        joined = [after] if np.array_equal(ring[i].assignment, ring[after].assignment) else []
        joined += [higher] if ring[higher].log_evidence >= ring[i].log_evidence - TIE_TOLERANCE else []
        for j in joined:
            old, new = homes[j], homes[i]
            homes = [new if home == old else home for home in homes]
    return homes


def _viewpoint(mode: list[_AngleEvidence], mirror: bool) -> tuple[Viewpoint, float]:
    """Return a group of angles as a viewpoint at its mean angle, and its log score: prior times evidence."""
    prior = _prior(mode[0].tried.mirrored, mirror)
    peak = max(mode, key=lambda one: (round(one.log_evidence, 9), -one.tried.angle))
    shares = [FACTS_POWER * one.log_evidence + math.log(one.tried.share) for one in mode]
    score = _log_sum(shares) + math.log(prior)
    angle, concentration = _mean_angle(mode)
    share = prior * sum(one.tried.share for one in mode)
    view = Viewpoint(angle, peak.tried.mirrored, 0.0, peak.log_evidence, peak.assignment, concentration, share)
    return view, score


def _prior(mirrored: bool, mirror: bool) -> float:
    """Return the prior of being mirrored or not; 1 where mirrored viewpoints are not searched."""
    return (MIRROR_PRIOR if mirrored else 1 - MIRROR_PRIOR) if mirror else 1.0


def _mean_angle(mode: list[_AngleEvidence]) -> tuple[float, float]:
    """Return the circular mean weighted by evidence, and the mean resultant length (1 for a single angle)."""
    if len(mode) == 1:
        return mode[0].tried.angle, 1.0
    most = max(one.log_evidence for one in mode)
    weights = np.array([one.tried.share * math.exp(FACTS_POWER * (one.log_evidence - most)) for one in mode])
    angles = np.array([one.tried.angle for one in mode])
    x, y = float(weights @ np.cos(angles)), float(weights @ np.sin(angles))
    return round(math.atan2(y, x), 12) % (2 * math.pi), math.hypot(x, y) / float(weights.sum())


def _log_sum(values: Sequence[float]) -> float:
    most = max(values, default=-math.inf)
    return most + math.log(sum(math.exp(value - most) for value in values)) if most > -math.inf else most
