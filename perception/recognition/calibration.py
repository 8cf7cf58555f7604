"""The threshold of ND and the probabilities of names, from how views that were held out came out.

The threshold makes the fewest wrong decisions between known and unknown (Youden 1950, with a prior). That a thing is
known at all has Platt's probability (1999), a sigmoid of the least ND's logarithm: 1 / (1 + (ND / even)^doubt). Which
category it then is, is a conditional logit (McFadden 1974): P(c) ~ ND(c)^-choice. Both are fitted by likelihood; a
normal prior on their logarithms holds them near the shipped ones while held-out views are few.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.held_out import HeldOut

MIN_HELD_OUT_ANSWERS = 10
"""Known and unknown answers held out, each, from which on a threshold is chosen by them."""

MIN_NORMALISED = 1e-6
"""A normalised distance below this is taken for this: the same view again."""

PRIOR_WIDTH = 1.0
"""Standard deviation of the logarithms of even, doubt and choice about the shipped ones."""


@dataclass(frozen=True)
class Calibration:
    """``threshold``: an ND above it is unknown. ``even``: the least ND at which known and unknown are equally probable;
    ``doubt``: how fast that changes. ``choice``: how much a nearer category is preferred. ``known`` and ``unknown``
    count the held-out answers behind these.

    With none the numbers are constants, measured once on simulated tableware (docs/recognition.md).
    """

    threshold: float
    even: float
    doubt: float
    choice: float
    known: int = 0
    unknown: int = 0

    def __post_init__(self) -> None:
        for name in ("threshold", "even", "doubt", "choice"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise RecognitionError(f"a calibration's {name} is a number above 0, not {getattr(self, name)}")

    @property
    def calibrated(self) -> bool:
        """Whether the threshold comes from the categories' own views."""
        return min(self.known, self.unknown) >= MIN_HELD_OUT_ANSWERS

    def probabilities(self, normalised: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return probabilities (..., c + 1) of c categories and, last, of none of them, from their ND (..., c).

        >>> even = Calibration(threshold=1.0, even=1.0, doubt=2.0, choice=4.0)
        >>> even.probabilities(np.array([1.0, np.inf, 1.0])).tolist()
        [0.25, 0.0, 0.25, 0.5]
        """
        result: NDArray[np.float64] = np.exp(_log_shares(normalised, np.log([self.even, self.doubt, self.choice])))
        return result


SHIPPED = Calibration(threshold=0.73, even=0.74, doubt=7.3, choice=10.5)
"""What holds until there are views to calibrate with (benchmarks/bench_recognition.py --constants)."""


def calibrate(held: HeldOut, prior_unknown: float = 0.5, start: Calibration = SHIPPED) -> Calibration:
    """Return threshold and probabilities from held-out views, if ``prior_unknown`` of all things seen are of no
    category.

    With fewer than ``MIN_HELD_OUT_ANSWERS`` known or unknown answers everything stays as in ``start``: of a few answers
    likelihood makes certainties, beside a threshold that does not move. Raises RecognitionError where the prior is not
    between 0 and 1.
    """
    if not 0 < prior_unknown < 1:
        raise RecognitionError(f"the share of unknown things lies between 0 and 1, not at {prior_unknown}")
    known, truth = held.as_known
    unknown = held.as_unknown
    if min(len(known), len(unknown)) < MIN_HELD_OUT_ANSWERS:
        return start
    even, doubt, choice = _fitted(known, truth, unknown, prior_unknown, start)
    threshold = best_threshold(known.min(axis=1), unknown.min(axis=1), prior_unknown)
    return Calibration(threshold, even, doubt, choice, len(known), len(unknown))


def best_threshold(known: NDArray[np.float64], unknown: NDArray[np.float64], prior_unknown: float = 0.5) -> float:
    """Return the ND that makes the least expected share of errors: known things above it, unknown ones at or below.

    ``known`` (k,) and ``unknown`` (u,) are the least ND of each held-out view. Cuts lie halfway between neighbouring
    values; of equally good ones the middle one is taken. With an even prior this maximises Youden's J.

    >>> best_threshold(np.array([0.4, 0.6]), np.array([1.0, 2.0]))
    0.8
    """
    scores = np.unique(np.concatenate([known, unknown]))
    scores = scores[np.isfinite(scores) & (scores > 0)]
    if not len(scores):
        return SHIPPED.threshold
    halfway = (scores[1:] + scores[:-1]) / 2
    halfway = np.where(halfway < scores[1:], halfway, scores[:-1])  # between neighbours there is no number
    cuts = np.concatenate([scores[:1] / 2, halfway, scores[-1:] * 2])
    missed = 1 - np.searchsorted(np.sort(known), cuts, side="right") / len(known)
    taken = np.searchsorted(np.sort(unknown), cuts, side="right") / len(unknown)
    errors = (1 - prior_unknown) * missed + prior_unknown * taken
    best = np.flatnonzero(errors <= errors.min() + 1e-12)
    return float(cuts[best[(len(best) - 1) // 2]])


def expected_calibration_error(confidence: NDArray[np.float64], right: NDArray[np.bool_], bins: int = 10) -> float:
    """Return mean over answers of how far the confidence in their bin is from the share that is right (Naeini et al.
    2015).

    >>> expected_calibration_error(np.array([0.75, 0.75, 0.75, 0.75]), np.array([True, True, True, False]))
    0.0
    """
    place = np.minimum((confidence * bins).astype(int), bins - 1)
    apart = np.bincount(place, confidence - right, minlength=bins)
    return float(np.abs(apart).sum() / len(confidence))


def auroc(known: NDArray[np.floating], unknown: NDArray[np.floating]) -> float:
    """Return the probability that something unknown has a higher score than something known; equal ones count half.

    nan where there is none of either.

    >>> auroc(np.array([1.0, 2.0]), np.array([2.0, 3.0]))
    0.875
    """
    if not len(known) or not len(unknown):
        return float("nan")
    order = np.sort(known)
    below, upto = np.searchsorted(order, unknown, "left"), np.searchsorted(order, unknown, "right")
    return float((below + upto).mean() / (2 * len(known)))


def _log_shares(normalised: NDArray[np.float64], logs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return logarithms of the probabilities (..., c + 1); ``logs`` (3,) are those of even, doubt and choice."""
    log_even, (doubt, choice) = logs[0], np.exp(logs[1:])
    apart = np.log(np.maximum(normalised, MIN_NORMALISED))
    nearest = apart.min(axis=-1, keepdims=True)
    excess = doubt * (nearest - log_even)
    known, unknown = -np.logaddexp(0.0, excess), -np.logaddexp(0.0, -excess)
    with np.errstate(invalid="ignore"):
        weights = np.where(np.isfinite(apart), -choice * (apart - nearest), -np.inf)
    total = np.logaddexp.reduce(weights, axis=-1, keepdims=True)
    shares = np.where(np.isfinite(nearest), weights - np.where(np.isfinite(total), total, 0.0) + known, -np.inf)
    return np.concatenate([shares, unknown], axis=-1)


def _fitted(
    known: NDArray[np.float64],
    truth: NDArray[np.int64],
    unknown: NDArray[np.float64],
    prior_unknown: float,
    start: Calibration,
) -> tuple[float, float, float]:
    """Return the most probable even distance, doubt and choice."""
    from scipy.optimize import minimize

    first = np.log([start.even, start.doubt, start.choice])
    count = len(known) + len(unknown)

    def loss(logs: NDArray[np.float64]) -> float:
        named = _log_shares(known, logs)[np.arange(len(known)), truth]
        none = _log_shares(unknown, logs)[:, -1]
        likelihood = (1 - prior_unknown) * np.maximum(named, -50.0).mean() + prior_unknown * none.mean()
        return float(-count * likelihood + 0.5 * np.square((logs - first) / PRIOR_WIDTH).sum())

    even, doubt, choice = np.exp(minimize(loss, first, method="Nelder-Mead").x).tolist()
    return even, doubt, choice
