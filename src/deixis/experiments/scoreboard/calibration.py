"""Are matches as often right as the answer says? Reliability, calibration error, and what is decided."""

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
    """The k matches of one answer: how probable it calls each, and whether it is right."""

    contestant: str
    group: Group
    probability: NDArray[np.float64]  # (k,)
    right: NDArray[np.bool_]  # (k,)
    error: float | NDArray[np.float64] = 0.0  # by how much the probabilities may be off, or (k,): each of them

    @classmethod
    def of(cls, contestant: str, case: Case, answer: ContestantAnswer) -> Forecasts:
        """Raise ValueError where the answer gives no probabilities."""
        if answer.marginals is None:
            raise ValueError(f"{contestant} gives no probabilities")
        matched = np.flatnonzero(answer.assignment != UNMATCHED)
        given = answer.assignment[matched]
        right = given == case.truth[matched]
        errors = np.broadcast_to(answer.error, len(answer.marginals))[matched]
        return cls(contestant, case.setting.group, answer.marginals[matched, given], right, errors)


@dataclass(frozen=True, slots=True)
class Bin:
    """Matches whose probability lies between two bounds; means are nan where there is none."""

    least: float
    greatest: float
    count: int
    probability: float  # mean
    right: float  # share


@dataclass(frozen=True, slots=True)
class Reliability:
    """The reliability of ``count`` matches. ``error`` is the expected calibration error: the mean distance of the
    share right from the mean probability over the bins, by how many they hold (Naeini, Cooper, Hauskrecht 2015).
    """

    bins: tuple[Bin, ...]
    count: int
    error: float
    decided: float  # share of the matches that are called decided
    precision: float  # share of those that are right; nan where there is none


def calibration(forecasts: Sequence[Forecasts]) -> Reliability:
    """Compute the reliability of all matches together, in bins of equal width.

    >>> said = np.array([0.65, 0.65, 1.0, 1.0])
    >>> found = calibration([Forecasts("exact", Group(2, 0.0), said, np.array([True, False, True, True]))])
    >>> round(found.error, 3), found.decided, found.precision
    (0.075, 0.5, 1.0)
    """
    said = np.concatenate([np.zeros(0), *(one.probability for one in forecasts)])
    right = np.concatenate([np.zeros(0, bool), *(one.right for one in forecasts)])
    number = np.clip((said * BINS).astype(int), 0, BINS - 1)
    bins = []
    for b in range(BINS):
        held = number == b
        bins.append(Bin(b / BINS, (b + 1) / BINS, int(held.sum()), _mean(said[held]), _mean(right[held])))
    off = sum(b.count * abs(b.right - b.probability) for b in bins if b.count)
    sure = np.concatenate([np.zeros(0, bool), *(is_decided(one.probability, one.error) for one in forecasts)])
    return Reliability(
        tuple(bins),
        len(said),
        off / len(said) if len(said) else float("nan"),
        _mean(sure),
        _mean(right[sure]),
    )


def _mean(values: NDArray[np.float64] | NDArray[np.bool_]) -> float:
    return float(values.mean()) if len(values) else float("nan")
