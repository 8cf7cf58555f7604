"""Calibrate the threshold of the normalised distance (ND) and the probabilities of names from held-out views.

The threshold makes the fewest wrong decisions between known and unknown (Youden 1950, with a prior). The probability
that a thing is known at all is Platt's (1999), a sigmoid of the logarithm of the least ND: 1 / (1 + (ND / even)^doubt).
The probability of each category, given that the thing is known, is a conditional logit (McFadden 1974):
P(c) ~ ND(c)^-choice. Both are fitted by likelihood; a normal prior on the logarithms of the parameters keeps them near
the shipped ones while held-out views are few. Views of one thing are correlated, so that the likelihood of n views
counts as that of n / d independent ones, where d is their design effect. Otherwise, many views of few things make the
fit too certain.

Some things look like another category, however near the distances are: a share of ``slips`` is spread over all answers
as if nothing had been seen, so that no answer is more certain than the held-out answers justify.

If things are compared by several descriptors, ND is the weighted geometric mean of theirs: a logarithmic opinion pool
(Genest and Zidek 1986), since a probability is proportional to a power of ND. The weights are fitted in the same way.
The information in colours differs between households, so that their weight may move farther from the shipped one than
the weights of shape; and distances between colours have a floor, the noise of the camera.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.held_out import HeldOut

MIN_HELD_OUT_ANSWERS = 10
"""Minimum numbers of known and of unknown held-out answers to choose a threshold from."""

MIN_NORMALISED = 1e-6
"""Lower bound of a normalised distance, which the same view seen again would have."""

PRIOR_WIDTH = 1.0
"""Prior standard deviation of the logarithms of even, doubt and choice about the shipped ones."""

WEIGHTS_WIDTH = 0.3
"""Prior standard deviation of the logarithms of ratios of weights; small, since few things are seen in many views."""

COLOUR_WEIGHT = 0.02
"""Weight of colour, beside the descriptors of shape, until there are views to fit it to: nearly 0, since colour carries
no information on things that never have the same colour twice."""

COLOUR_WIDTH = 1.0
"""Prior standard deviation of the logarithm of colour's weight; large, since colour separates only some things."""

COLOUR_FLOOR = 0.25
"""Lower bound of the ND by colour: smaller ones are the camera's noise."""

SLIPS_WIDTH = 0.5
"""Prior standard deviation of the log-odds of slips."""

MIN_SLIPS = 1e-3
"""Minimum share of slips at the start of a fit."""

MAX_ROUNDS = 1_500
"""Maximum number of iterations of the search for the most probable parameters."""

WEIGHTS_ROUNDING = 1e-6
"""Tolerance for the sum of the weights, which must be 1."""


@dataclass(frozen=True)
class Calibration:
    """Parameters that turn normalised distances (ND) into a decision and probabilities.

    Parameters
    ----------
    threshold
        ND above which a thing is unknown.
    even
        Least ND at which known and unknown are equally probable.
    doubt
        Steepness of the change from known to unknown.
    choice
        Strength of the preference for nearer categories.
    known, unknown
        Numbers of the held-out answers from which the parameters were fitted. If both are 0, the parameters are
        constants, measured on simulated tableware (docs/explanation/recognition.md).
    weights
        Weights of the descriptors in the mean, which sum to 1.
    slips
        Share of things whose distances carry no information.
    weights_widths
        Prior standard deviations of the logarithms of the weights' ratios to the first weight, for a fit that starts
        here; the first one is not used. Empty for ``WEIGHTS_WIDTH``.
    floors
        Lower bounds of the ND by each descriptor. Empty for ``MIN_NORMALISED``.
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
                raise RecognitionError(f"a calibration's {name} must be above 0, one for each weight, got {values}")
        if not (min(self.weights, default=-1.0) >= 0 and abs(sum(self.weights) - 1) < WEIGHTS_ROUNDING):
            raise RecognitionError(f"a calibration's weights must be at least 0 and sum to 1, got {self.weights}")
        if not 0 <= self.slips < 1:
            raise RecognitionError(f"a calibration's slips must be at least 0 and below 1, got {self.slips}")
        for name in ("threshold", "even", "doubt", "choice"):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > 0):
                raise RecognitionError(f"a calibration's {name} must be a number above 0, got {getattr(self, name)}")

    @property
    def calibrated(self) -> bool:
        """True if the threshold was chosen from the categories' own views."""
        return min(self.known, self.unknown) >= MIN_HELD_OUT_ANSWERS

    def mean(self, normalised: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the weighted geometric mean of the normalised distances by each descriptor.

        Parameters
        ----------
        normalised
            ND by each descriptor, in the order of the weights, each of shape (..., c).

        Returns
        -------
        ndarray
            ND of shape (..., c); inf if one of them is.

        Examples
        --------
        >>> Calibration(1, 1, 1, 1, weights=(0.5, 0.5)).mean([np.array([1.0, 4.0]), np.array([4.0, np.inf])]).tolist()
        [2.0, inf]
        """
        return np.exp(_mean_logs(self.logs(normalised), np.array(self.weights)))

    def logs(self, normalised: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
        """Return the logarithms of the normalised distances by each of b descriptors, raised to their floors.

        Parameters
        ----------
        normalised
            ND by each descriptor, each of shape (..., c).

        Returns
        -------
        ndarray
            Logarithms of shape (b, ..., c).
        """
        floors = self.floors or (MIN_NORMALISED,) * len(normalised)
        result: NDArray[np.float64] = np.log(
            np.stack([np.maximum(each, floor) for each, floor in zip(normalised, floors, strict=True)])
        )
        return result

    def probabilities(self, normalised: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return probabilities of c categories, and of unknown, from their normalised distances.

        Parameters
        ----------
        normalised
            ND of shape (..., c).

        Returns
        -------
        ndarray
            Probabilities of shape (..., c + 1), with sum 1; the last is that of unknown.

        Examples
        --------
        >>> even = Calibration(threshold=1.0, even=1.0, doubt=2.0, choice=4.0)
        >>> even.probabilities(np.array([1.0, np.inf, 1.0])).tolist()
        [0.25, 0.0, 0.25, 0.5]
        """
        shares = np.exp(_log_shares(normalised, np.log([self.even, self.doubt, self.choice])))
        result: NDArray[np.float64] = (1 - self.slips) * shares + self.slips * _blind(normalised)
        return result


SHIPPED = Calibration(threshold=0.756, even=0.745, doubt=6.6, choice=12.8, slips=0.1)
"""Calibration until there are views to fit it to (benchmarks/bench_recognition.py --constants)."""


SHIPPED_JOINT = Calibration(threshold=0.76, even=0.736, doubt=6.9, choice=15.4, weights=(0.65, 0.35), slips=0.1)
"""Calibration of the two descriptors by which views of a table are compared, until there are views to fit it to."""


def beside_colour(calibration: Calibration) -> Calibration:
    """Return a calibration with colour as an additional, last descriptor.

    Parameters
    ----------
    calibration
        Calibration of the other descriptors.

    Returns
    -------
    Calibration
        Calibration whose weights have the sum 1; that of colour is ``COLOUR_WEIGHT``.
    """
    count = len(calibration.weights)
    return replace(
        calibration,
        weights=(*(weight * (1 - COLOUR_WEIGHT) for weight in calibration.weights), COLOUR_WEIGHT),
        weights_widths=(*(WEIGHTS_WIDTH,) * count, COLOUR_WIDTH),
        floors=(*(MIN_NORMALISED,) * count, COLOUR_FLOOR),
    )


def calibrate(held: HeldOut, prior_unknown: float = 0.5, start: Calibration = SHIPPED) -> Calibration:
    """Fit threshold and probabilities to held-out views of one descriptor.

    Parameters
    ----------
    held
        Normalised distances of held-out views.
    prior_unknown
        Share of all things seen that belong to no category, between 0 and 1.
    start
        Start of the fit, and centre of its prior.

    Returns
    -------
    The fitted calibration, or ``start`` if there are fewer than ``MIN_HELD_OUT_ANSWERS`` known or unknown answers: a
    likelihood of few answers gives near certainty.

    Raises
    ------
    RecognitionError
        If ``prior_unknown`` is not between 0 and 1.
    """
    if not 0 < prior_unknown < 1:
        raise RecognitionError(f"`prior_unknown` must be between 0 and 1, got {prior_unknown}")
    known, truth = held.as_known
    unknown = held.as_unknown
    if min(len(known), len(unknown)) < MIN_HELD_OUT_ANSWERS:
        return start
    threshold = best_threshold(known.min(axis=1), unknown.min(axis=1), prior_unknown)
    fitted = _fitted(known, truth, unknown, prior_unknown, start, 1 / held.design_effect)
    return replace(fitted, threshold=threshold, known=len(known), unknown=len(unknown))


def calibrate_jointly(
    held: Sequence[HeldOut], prior_unknown: float = 0.5, start: Calibration = SHIPPED_JOINT
) -> Calibration:
    """Fit weights, threshold and probabilities to held-out views, given their normalised distances by each descriptor.

    Parameters
    ----------
    held
        ND of held-out views by each descriptor. Views and categories are in one order in all of them.
    prior_unknown
        Prior probability that a thing is of no known category.
    start
        Calibration to start from. Logarithms of the weights' ratios have a normal prior about its weights, with its
        ``weights_widths`` as standard deviations.

    Returns
    -------
    Calibration
        Fitted calibration; ``start`` if there are too few answers, as for :func:`calibrate`.
    """
    known, truth = held[0].as_known
    if min(len(known), len(held[0].as_unknown)) < MIN_HELD_OUT_ANSWERS:
        return start
    weights = _fitted_weights(start.logs([each.as_known[0] for each in held]), truth, start, 1 / held[0].design_effect)
    started = replace(start, weights=weights)
    joint = replace(held[0], normalised=started.mean([each.normalised for each in held]))
    return calibrate(joint, prior_unknown, started)


def best_threshold(known: NDArray[np.float64], unknown: NDArray[np.float64], prior_unknown: float = 0.5) -> float:
    """Return the threshold of the normalised distance with the least expected share of errors.

    Errors are known things above the threshold, and unknown things at or below it. Candidate thresholds are halfway
    between neighbouring values; of equally good ones the middle one is taken. With an even prior this maximises
    Youden's J.

    Parameters
    ----------
    known
        Least ND of each held-out view of a known category, shape (k,).
    unknown
        Least ND of each held-out view of an unknown one, shape (u,).
    prior_unknown
        Prior probability that a thing is unknown.

    Returns
    -------
    float
        Threshold of ND; the shipped one without finite values above 0.

    Examples
    --------
    >>> best_threshold(np.array([0.4, 0.6]), np.array([1.0, 2.0]))
    0.8
    """
    scores = np.unique(np.concatenate([known, unknown]))
    scores = scores[np.isfinite(scores) & (scores > 0)]
    if not len(scores):
        return SHIPPED.threshold
    halfway = (scores[1:] + scores[:-1]) / 2
    halfway = np.where(halfway < scores[1:], halfway, scores[:-1])  # if there is no number between neighbours
    cuts = np.concatenate([scores[:1] / 2, halfway, scores[-1:] * 2])
    missed = 1 - np.searchsorted(np.sort(known), cuts, side="right") / len(known)
    taken = np.searchsorted(np.sort(unknown), cuts, side="right") / len(unknown)
    errors = (1 - prior_unknown) * missed + prior_unknown * taken
    best = np.flatnonzero(errors <= errors.min() + 1e-12)
    return float(cuts[best[(len(best) - 1) // 2]])


def expected_calibration_error(confidence: NDArray[np.float64], right: NDArray[np.bool_], bins: int = 10) -> float:
    """Return the expected calibration error of answers.

    It is the mean over answers of the difference between the mean confidence in their bin and the share of right
    answers there.

    Parameters
    ----------
    confidence
        Probability of each answer, shape (n,), in [0, 1].
    right
        Mask of the right answers, shape (n,).
    bins
        Number of bins of equal width.

    Returns
    -------
    float
        Error in [0, 1]; 0 for a perfect calibration.

    Notes
    -----
    The measure is that of Naeini et al. (2015).

    Examples
    --------
    >>> expected_calibration_error(np.array([0.75, 0.75, 0.75, 0.75]), np.array([True, True, True, False]))
    0.0
    """
    place = np.minimum((confidence * bins).astype(int), bins - 1)
    apart = np.bincount(place, confidence - right, minlength=bins)
    return float(np.abs(apart).sum() / len(confidence))


def auroc(known: NDArray[np.floating], unknown: NDArray[np.floating]) -> float:
    """Return the area under the ROC curve: the probability that an unknown thing scores higher than a known one.

    Equal scores count half.

    Parameters
    ----------
    known
        Scores of known things, shape (k,).
    unknown
        Scores of unknown things, shape (u,).

    Returns
    -------
    float
        Area in [0, 1]; nan if there are no known or no unknown things.

    Examples
    --------
    >>> auroc(np.array([1.0, 2.0]), np.array([2.0, 3.0]))
    0.875
    """
    if not len(known) or not len(unknown):
        return float("nan")
    order = np.sort(known)
    below, upto = np.searchsorted(order, unknown, "left"), np.searchsorted(order, unknown, "right")
    return float((below + upto).mean() / (2 * len(known)))


def _log_shares(normalised: NDArray[np.float64], logs: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return log-probabilities (..., c + 1); ``logs`` (3,) are the logarithms of even, doubt and choice."""
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
    """Return the weighted mean (..., c) of logarithms (b, ..., c); infinite if one of them is."""
    finite = np.isfinite(logs)
    mean = np.tensordot(weights, np.where(finite, logs, 0.0), axes=1)
    result: NDArray[np.float64] = np.where(finite.all(axis=0), mean, np.inf)
    return result


def _fitted_weights(
    logs: NDArray[np.float64], truth: NDArray[np.int64], start: Calibration, worth: float
) -> tuple[float, ...]:
    """Return the most probable weights of b descriptors, given the logarithms (b, k, c) of the ND of known views.

    ``worth`` is the number of independent views that each view counts as.
    """
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
        return float(-worth * np.maximum(named, -50.0).sum() + 0.5 * np.square(apart / widths).sum())

    found = minimize(loss, np.concatenate([[np.log(start.choice)], ratios]), method="Nelder-Mead").x
    return tuple(weights_of(found[1:]).tolist())


def _blind(normalised: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return probabilities (..., c + 1) without any observation: half for unknown, the rest even over categories."""
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
    worth: float,
) -> Calibration:
    """Return ``start`` with the most probable even, doubt, choice and slips.

    ``worth`` is the number of independent views that each view counts as.
    """
    from scipy.optimize import minimize

    first = np.log([start.even, start.doubt, start.choice, max(start.slips, MIN_SLIPS) / (1 - start.slips)])
    widths = np.array([PRIOR_WIDTH, PRIOR_WIDTH, PRIOR_WIDTH, SLIPS_WIDTH])
    count, rows = worth * (len(known) + len(unknown)), np.arange(len(known))
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
