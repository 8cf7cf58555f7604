"""Measure calibration: are matches right as often as the answer says? Reliability, error, and decided matches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.scoreboard.cases import Case, Group
from deixis.experiments.scoreboard.contestants import ContestantAnswer
from deixis.reasoning.grounding.matching.problem import UNMATCHED
from deixis.reasoning.grounding.options import is_decided

BINS = 10


@dataclass(frozen=True, eq=False)
class Forecasts:
    """The k matches of one answer: their probabilities, and which are right."""

    contestant: str
    group: Group
    probability: NDArray[np.float64]  # (k,)
    right: NDArray[np.bool_]  # (k,)
    error: float | NDArray[np.float64] = 0.0  # uncertainty of the probabilities, one number or (k,)

    @classmethod
    def of(cls, contestant: str, case: Case, answer: ContestantAnswer) -> Forecasts:
        """Return the matches of an answer with their probabilities.

        Parameters
        ----------
        contestant
            Name of the contestant.
        case
            Case with the correct assignment.
        answer
            Answer of the contestant to the case.

        Returns
        -------
        Forecasts
            One forecast for each matched object; objects left out have none.

        Raises
        ------
        ValueError
            If the answer has no probabilities.
        """
        if answer.marginals is None:
            raise ValueError(f"{contestant} gives no probabilities")
        matched = np.flatnonzero(answer.assignment != UNMATCHED)
        given = answer.assignment[matched]
        right = given == case.truth[matched]
        errors = np.broadcast_to(answer.error, len(answer.marginals))[matched]
        return cls(contestant, case.setting.group, answer.marginals[matched, given], right, errors)


@dataclass(frozen=True, slots=True)
class Bin:
    """Matches with a probability between two bounds; means are nan for an empty bin."""

    least: float
    greatest: float
    count: int
    probability: float  # mean
    right: float  # share


@dataclass(frozen=True, slots=True)
class Reliability:
    """The reliability of ``count`` matches.

    ``error`` is the expected calibration error: the mean distance between the share of right answers and the mean
    probability over the bins, weighted by their counts (Naeini, Cooper, Hauskrecht 2015).
    """

    bins: tuple[Bin, ...]
    count: int
    error: float
    decided: float  # share of the matches that are decided
    precision: float  # share of those that are right; nan if no match is decided


def calibration(forecasts: Sequence[Forecasts]) -> Reliability:
    """Compute the reliability of all matches together, in bins of equal width.

    Parameters
    ----------
    forecasts
        Forecasts of one or more cases.

    Returns
    -------
    Reliability
        Bins from 0 to 1, calibration error, share of decided matches and their precision; nan without matches.

    Examples
    --------
    >>> probabilities = np.array([0.65, 0.65, 1.0, 1.0])
    >>> found = calibration([Forecasts("exact", Group(2, 0.0), probabilities, np.array([True, False, True, True]))])
    >>> round(found.error, 3), found.decided, found.precision
    (0.075, 0.5, 1.0)
    """
    probabilities = np.concatenate([np.zeros(0), *(one.probability for one in forecasts)])
    right = np.concatenate([np.zeros(0, bool), *(one.right for one in forecasts)])
    number = np.clip((probabilities * BINS).astype(int), 0, BINS - 1)
    bins = []
    for b in range(BINS):
        held = number == b
        bins.append(Bin(b / BINS, (b + 1) / BINS, int(held.sum()), _mean(probabilities[held]), _mean(right[held])))
    off = sum(b.count * abs(b.right - b.probability) for b in bins if b.count)
    sure = np.concatenate([np.zeros(0, bool), *(is_decided(one.probability, one.error) for one in forecasts)])
    return Reliability(
        tuple(bins),
        len(probabilities),
        off / len(probabilities) if len(probabilities) else float("nan"),
        _mean(sure),
        _mean(right[sure]),
    )


def _mean(values: NDArray[np.float64] | NDArray[np.bool_]) -> float:
    return float(values.mean()) if len(values) else float("nan")
