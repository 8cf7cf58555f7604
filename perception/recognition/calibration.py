"""The threshold of ND and the probabilities of names, from how views that were held out came out.

The threshold makes the fewest wrong decisions between known and unknown (Youden 1950, with a prior). That a thing is
known at all has Platt's probability (1999), a sigmoid of the least ND's logarithm: 1 / (1 + (ND / even)^doubt). Which
category it then is, is a conditional logit (McFadden 1974): P(c) ~ ND(c)^-choice. Both are fitted by likelihood; a
normal prior on their logarithms holds them near the shipped ones while held-out views are few.

Some things look like what they are not, however near the distances are: a share of ``slips`` is spread over all answers
as if nothing had been seen, so that no answer is surer than held-out ones deserve.

Where things are compared by several descriptors, ND is the weighted geometric mean of theirs: a logarithmic opinion
pool (Genest and Zidek 1986), since a power of ND is what a probability is proportional to. The weights are fitted in
the same way. What a colour says differs from one household to the next, so that its weight may move farther from the
shipped one than those of descriptors of shape; and no two colours are nearer than noise lets them be told apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

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

WEIGHTS_WIDTH = 0.3
"""The same of the ratios of weights: views of the same few things say less of these than their number suggests."""

COLOUR_WEIGHT = 0.02
"""Weight of colour beside the descriptors of shape until there are views to fit it to: next to nothing, since of things
that are never twice of one colour it says nothing."""

COLOUR_WIDTH = 1.0
"""The same for colour, which tells some things apart at once and others not at all."""

COLOUR_FLOOR = 0.25
"""Least ND by colour: nearer ones are apart by the camera's noise."""

SLIPS_WIDTH = 0.5
"""The same of the log-odds of slips."""

MIN_SLIPS = 1e-3
"""Share of slips that a fit begins with at least."""

MAX_ROUNDS = 1_500
"""Rounds of the search for the most probable parameters, at most."""

WEIGHTS_ROUNDING = 1e-6
"""By how much the sum of weights may differ from 1."""


@dataclass(frozen=True)
class Calibration:
    """``threshold``: an ND above it is unknown. ``even``: the least ND at which known and unknown are equally probable;
    ``doubt``: how fast that changes. ``choice``: how much a nearer category is preferred. ``slips`` is the share of
    things of which distances say nothing. ``weights`` are those of the descriptors in the mean, and sum to 1.
    ``weights_widths`` are the standard deviations of the logarithms of their ratios to the first one where a fit begins
    here (none: ``WEIGHTS_WIDTH``); that of the first says nothing. ``floors`` are the least ND that each descriptor can
    tell, and one below counts as this (none: ``MIN_NORMALISED``).
    ``known`` and ``unknown`` count the held-out answers behind these.

    With none the numbers are constants, measured once on simulated tableware (docs/explanation/recognition.md).
    """

    threshold: float
    even: float
    doubt: float
    choice: float
    known: int = 0
    unknown: int = 0
    weights: tuple[float, ...] = (1.0,)
    slips: float = 0.0
    weights_widths: tuple[float, ...] = ()
    floors: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        for name in ("weights", "weights_widths", "floors"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        for name in ("weights_widths", "floors"):
            values = getattr(self, name)
            if values and not (len(values) == len(self.weights) and min(values) > 0):
                raise RecognitionError(f"a calibration's {name} are above 0, one for each weight, not {values}")
        if not (min(self.weights, default=-1.0) >= 0 and abs(sum(self.weights) - 1) < WEIGHTS_ROUNDING):
            raise RecognitionError(f"a calibration's weights are 0 or more and sum to 1, not {self.weights}")
        if not 0 <= self.slips < 1:
            raise RecognitionError(f"a calibration's share of slips is 0 or more and below 1, not {self.slips}")
        for name in ("threshold", "even", "doubt", "choice"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise RecognitionError(f"a calibration's {name} is a number above 0, not {getattr(self, name)}")

    @property
    def calibrated(self) -> bool:
        """Whether the threshold comes from the categories' own views."""
        return min(self.known, self.unknown) >= MIN_HELD_OUT_ANSWERS

    def mean(self, normalised: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the weighted geometric mean (..., c) of the ND (..., c) by each descriptor.

        >>> Calibration(1, 1, 1, 1, weights=(0.5, 0.5)).mean([np.array([1.0, 4.0]), np.array([4.0, np.inf])]).tolist()
        [2.0, inf]
        """
        return np.exp(_mean_logs(self.logs(normalised), np.array(self.weights)))

    def logs(self, normalised: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the logarithms (b, ..., c) of ND by each of b descriptors, none below that of its floor."""
        floors = self.floors or (MIN_NORMALISED,) * len(normalised)
        result: NDArray[np.float64] = np.log(
            np.stack([np.maximum(each, floor) for each, floor in zip(normalised, floors, strict=True)])
        )
        return result

    def probabilities(self, normalised: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return probabilities (..., c + 1) of c categories and, last, of none of them, from their ND (..., c).

        >>> even = Calibration(threshold=1.0, even=1.0, doubt=2.0, choice=4.0)
        >>> even.probabilities(np.array([1.0, np.inf, 1.0])).tolist()
        [0.25, 0.0, 0.25, 0.5]
        """
        shares = np.exp(_log_shares(normalised, np.log([self.even, self.doubt, self.choice])))
        result: NDArray[np.float64] = (1 - self.slips) * shares + self.slips * _blind(normalised)
        return result


SHIPPED = Calibration(threshold=0.756, even=0.745, doubt=6.6, choice=12.8, slips=0.1)
"""What holds until there are views to calibrate with (benchmarks/bench_recognition.py --constants)."""


SHIPPED_JOINT = Calibration(threshold=0.76, even=0.736, doubt=6.9, choice=15.4, weights=(0.65, 0.35), slips=0.1)
"""The same for the descriptors that views of a table are compared by."""


def beside_colour(calibration: Calibration) -> Calibration:
    """Return what holds where views are compared by their colour, too, as the last descriptor."""
    count = len(calibration.weights)
    return replace(
        calibration,
        weights=(*(weight * (1 - COLOUR_WEIGHT) for weight in calibration.weights), COLOUR_WEIGHT),
        weights_widths=(*(WEIGHTS_WIDTH,) * count, COLOUR_WIDTH),
        floors=(*(MIN_NORMALISED,) * count, COLOUR_FLOOR),
    )


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
    threshold = best_threshold(known.min(axis=1), unknown.min(axis=1), prior_unknown)
    fitted = _fitted(known, truth, unknown, prior_unknown, start)
    return replace(fitted, threshold=threshold, known=len(known), unknown=len(unknown))


def calibrate_jointly(
    held: Sequence[HeldOut], prior_unknown: float = 0.5, start: Calibration = SHIPPED_JOINT
) -> Calibration:
    """Return weights, threshold and probabilities from what the same views, held out, came to by each descriptor.

    Logarithms of the weights' ratios have a normal prior about those of ``start``, of its ``weights_widths``. With few
    answers everything stays as in ``start``, as in :func:`calibrate`.
    """
    known, truth = held[0].as_known
    if min(len(known), len(held[0].as_unknown)) < MIN_HELD_OUT_ANSWERS:
        return start
    weights = _fitted_weights(start.logs([each.as_known[0] for each in held]), truth, start)
    started = replace(start, weights=weights)
    return calibrate(HeldOut(started.mean([each.normalised for each in held]), held[0].truth), prior_unknown, started)


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


def _mean_logs(logs: NDArray[np.float64], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the weighted mean (..., c) of logarithms (b, ..., c); infinite where one is."""
    finite = np.isfinite(logs)
    mean = np.tensordot(weights, np.where(finite, logs, 0.0), axes=1)
    result: NDArray[np.float64] = np.where(finite.all(axis=0), mean, np.inf)
    return result


def _fitted_weights(logs: NDArray[np.float64], truth: NDArray[np.int64], start: Calibration) -> tuple[float, ...]:
    """Return the most probable weights of b descriptors, from the logarithms (b, k, c) of ND of known views."""
    from scipy.optimize import minimize

    ratios = np.log(np.array(start.weights) / start.weights[0])[1:]
    _, *free = start.weights_widths or (WEIGHTS_WIDTH,) * len(start.weights)
    rows, widths = np.arange(len(truth)), np.array([PRIOR_WIDTH, *free])

    def weights_of(logits: NDArray[np.float64]) -> NDArray[np.float64]:
        shares = np.exp(np.concatenate([[0.0], logits]))
        return np.asarray(shares / shares.sum(), np.float64)

    def loss(values: NDArray[np.float64]) -> float:
        utilities = -np.exp(values[0]) * _mean_logs(logs, weights_of(values[1:]))
        named = utilities[rows, truth] - np.logaddexp.reduce(utilities, axis=1)
        apart = np.concatenate([[values[0] - np.log(start.choice)], values[1:] - ratios])
        return float(-np.maximum(named, -50.0).sum() + 0.5 * np.square(apart / widths).sum())

    found = minimize(loss, np.concatenate([[np.log(start.choice)], ratios]), method="Nelder-Mead").x
    return tuple(weights_of(found[1:]).tolist())


def _blind(normalised: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the probabilities (..., c + 1) of whoever has not looked: half for none, the rest even over categories."""
    there = np.isfinite(normalised)
    count = there.sum(axis=-1, keepdims=True)
    none = np.where(count > 0, 0.5, 1.0)
    return np.concatenate([there * 0.5 / np.maximum(count, 1), none], axis=-1)


def _fitted(
    known: NDArray[np.float64],
    truth: NDArray[np.int64],
    unknown: NDArray[np.float64],
    prior_unknown: float,
    start: Calibration,
) -> Calibration:
    """Return ``start`` with the most probable even distance, doubt, choice and share of slips."""
    from scipy.optimize import minimize

    first = np.log([start.even, start.doubt, start.choice, max(start.slips, MIN_SLIPS) / (1 - start.slips)])
    widths = np.array([PRIOR_WIDTH, PRIOR_WIDTH, PRIOR_WIDTH, SLIPS_WIDTH])
    count, rows = len(known) + len(unknown), np.arange(len(known))
    blind_named, blind_none = _blind(known)[rows, truth], _blind(unknown)[:, -1]

    def slips_of(logit: float) -> float:
        return float(1 / (1 + np.exp(-logit)))

    def loss(values: NDArray[np.float64]) -> float:
        slips = slips_of(values[3])
        named = np.logaddexp(
            np.log1p(-slips) + _log_shares(known, values[:3])[rows, truth], np.log(slips * blind_named)
        )
        none = np.logaddexp(np.log1p(-slips) + _log_shares(unknown, values[:3])[:, -1], np.log(slips * blind_none))
        likelihood = (1 - prior_unknown) * named.mean() + prior_unknown * none.mean()
        return float(-count * likelihood + 0.5 * np.square((values - first) / widths).sum())

    found = minimize(loss, first, method="Nelder-Mead", options={"maxiter": MAX_ROUNDS}).x
    even, doubt, choice = np.exp(found[:3]).tolist()
    return replace(start, even=even, doubt=doubt, choice=choice, slips=slips_of(found[3]))
