"""Probability that an object is absent, although a thing satisfies its facts by coincidence.

A map that leaves an object out gives its facts the weight of chance. That is too little where an object has many facts.
An absent object has a place too, which is not seen, and all of its facts are about that place. An undescribed thing
near the place satisfies most of them, and sums of independent log-likelihood ratios then exclude that the object is
absent. Two numbers tell such a coincidence from the object itself, given what the other objects are:

- the misfit s: the sum of the largest value that each fact could have at any place, minus the sum of their values at
  the thing. An object's own place satisfies nearly all of its facts, a place beside it only most of them;
- the alternatives t: the sum of exp(F(q) - F(p)) over all other things q, where F(q) is the sum of the object's facts
  at q, and p is its most probable thing. It counts the allowed places that satisfy the facts as well, whether or not
  another object is there.

The odds that the object is absent and p an undescribed thing, against the object being p, are

    a exp(-max(0, u)) (MISFIT_FACTOR exp(MISFIT_POWER s) + ALTERNATIVES_FACTOR t ** ALTERNATIVES_POWER)

where u is the evidence of the match without facts: a thing that is there by coincidence seldom has the object's kind or
label as well. The share a of absent objects is estimated from the same scene (empirical Bayes, Robbins 1956): it is the
mean probability of absence, with ``PRIOR_OBJECTS`` more objects of which ``PRIOR_ABSENT`` are absent. So a scene that
has all described objects loses almost no decided matches. Where absent objects had places in the model, the mean
probability of absence is near that share and is kept. ``benchmarks/fit_coincidences.py`` fits the four numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior
from deixis.reasoning.grounding.matching.problem import Problem

Array = NDArray[np.float64]

PRIOR_ABSENT, PRIOR_OBJECTS = 0.001, 20.0
"""Prior share of absent objects, and its weight as a number of objects."""

CERTAINLY_PRESENT = -20.0
"""Log-odds of absence up to which an object is certainly present."""

ITERATIONS, SETTLED = 20, 1e-6
"""Maximum number of alternating estimates of the share of absent objects and of their probabilities, and the change of
that share at which they end."""

MAX_LOG_ODDS = 50.0

FACTS_AT_ONCE = 256
"""Number of facts after which the time limit is checked."""

TIE_DIGITS = 6
"""Decimal digits of probabilities, so that rounding errors do not choose between equally probable things."""


class CoincidenceWeights(NamedTuple):
    """Weights of the misfit and of the alternatives; see the formula above."""

    misfit_factor: float
    misfit_power: float
    alternatives_factor: float
    alternatives_power: float


SHIPPED_WEIGHTS = CoincidenceWeights(0.028, 0.25, 1.2, 0.77)


@dataclass(frozen=True, eq=False)
class Coincidences:
    """Possible coincidences of n1 objects, each at its most probable thing.

    Attributes
    ----------
    probability
        Probability of the thing, shape (n1,).
    absent
        Probability of the object's absence, shape (n1,).
    misfit
        Sum over the object's facts of the largest possible value minus the value at the thing, in nats, shape (n1,).
    alternatives
        Sum over the other allowed things of the likelihood of the facts there, relative to the thing, shape (n1,).
    unary
        Evidence of the match without facts, in nats, shape (n1,).
    possible
        Whether the object has facts and can be absent, shape (n1,).
    """

    probability: Array
    absent: Array
    misfit: Array
    alternatives: Array
    unary: Array
    possible: NDArray[np.bool_]

    def remaining(self, weights: CoincidenceWeights = SHIPPED_WEIGHTS, iterations: int = ITERATIONS) -> Array:
        """Return the factor of each object's probabilities of being any thing.

        Parameters
        ----------
        weights
            Weights of the misfit and of the alternatives; by default, the shipped ones.
        iterations
            Maximum number of estimates of the share of absent objects; 1 keeps the mean probability of absence.

        Returns
        -------
        ndarray
            Share of the probability of matches that remains, shape (n1,), in (0, 1]; the rest is that of absence.
        """
        odds = weights.misfit_factor * np.exp(np.minimum(weights.misfit_power * self.misfit, MAX_LOG_ODDS))
        odds += weights.alternatives_factor * self.alternatives**weights.alternatives_power
        odds *= np.exp(-np.maximum(self.unary, 0.0)) * self.possible * self.probability
        n1 = len(odds)
        absent = self.absent.sum() + PRIOR_ABSENT * n1
        remaining = np.ones(n1)
        for _ in range(iterations):
            share = (absent + PRIOR_ABSENT * PRIOR_OBJECTS) / (n1 + PRIOR_OBJECTS)
            remaining = 1.0 / (1.0 + share * odds)
            before, absent = absent, (1.0 - (1.0 - self.absent) * remaining).sum()
            if abs(absent - before) < SETTLED * n1:
                break
        return remaining


def coincidences(problem: Problem, marginals: Array, deadline: Deadline = Deadline.never()) -> Coincidences:
    """Return the possible coincidences of a problem of n1 objects and n2 things.

    The values of facts are expected values over the things that the other object may be, and 0 where it is absent.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    marginals
        Posterior probability of each match, shape (n1, n2 + 1); the last column is that of absence.
    deadline
        Time limit.

    Returns
    -------
    Coincidences
        Evidence, misfit and alternatives of the likeliest match of each object.

    Raises
    ------
    OutOfTimeError
        If the time limit is reached.
    """
    n1, n2 = problem.unary.shape
    things, away = marginals[:, :n2].astype(np.float32), marginals[:, n2]
    values, largest = np.zeros((n1, n2)), np.zeros(n1)
    for kind, table in enumerate(problem.tables):
        subjects, objects = problem.ends[problem.kinds == kind].T
        if not len(subjects):
            continue
        likelihood = np.exp(table)
        for ends, others, at in ((subjects, objects, likelihood), (objects, subjects, likelihood.T)):
            most = at.max(axis=0)
            for first in range(0, len(ends), FACTS_AT_ONCE):
                if deadline.passed:
                    raise OutOfTimeError("time limit reached before coincidences were computed")
                part = slice(first, first + FACTS_AT_ONCE)
                there, missing = things[others[part]], away[others[part]]
                np.add.at(values, ends[part], np.log(there @ at.T + missing[:, None]))
                # no product by BLAS, whose kernel for vectors may flag an invalid value where there is none
                np.add.at(largest, ends[part], np.log((there * most).sum(axis=1) + missing))
    rows, chosen = np.arange(n1), np.round(marginals[:, :n2], TIE_DIGITS).argmax(axis=1)
    there = values[rows, chosen]
    relative = np.exp(np.minimum(values - there[:, None], MAX_LOG_ODDS))
    relative[~problem.allowed] = 0.0
    relative[rows, chosen] = 0.0
    described = np.bincount(problem.ends.ravel(), minlength=n1) > 0
    return Coincidences(
        probability=marginals[rows, chosen],
        absent=away,
        misfit=np.maximum(largest - there, 0.0),
        alternatives=relative.sum(axis=1),
        unary=problem.unary[rows, chosen],
        possible=described & (problem.absent > CERTAINLY_PRESENT),
    )


def discounted(problem: Problem, found: Posterior, deadline: Deadline = Deadline.never()) -> Posterior:
    """Return the posterior with the probability that matches are coincidences added to that of absence.

    Parameters
    ----------
    problem
        The problem.
    found
        Its posterior.
    deadline
        Time limit. Where it is reached, the probabilities count as unknown: their error is infinite.

    Returns
    -------
    Posterior
        Copy with new marginals; ``found`` itself where there are no facts, objects or things, or its probabilities are
        unknown.

    Examples
    --------
    >>> nearer = np.array([[[0.0, 3.0], [-3.0, 0.0]]], np.float32)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), nearer, np.zeros((2, 2)), np.full(2, -5.0))
    >>> sure = Posterior(np.array([[0.99, 0.0, 0.01], [0.0, 0.99, 0.01]]), True, 0.0)
    >>> discounted(problem, sure).marginals[:, 2].round(3).tolist()  # the probabilities of absence
    [0.01, 0.01]
    """
    if not problem.unary.size or not len(problem.ends) or found.is_unknown:
        return found
    # With few facts, each estimate of the share from the discounted probabilities would be larger.
    iterations = 1 if found.absent_counted else ITERATIONS
    try:
        remaining = coincidences(problem, found.marginals, deadline).remaining(iterations=iterations)
    except OutOfTimeError:
        return replace(found, error=math.inf, errors=np.full_like(found.errors, math.inf), is_propagated=False)
    marginals = found.marginals * remaining[:, None]
    marginals[:, -1] += 1.0 - remaining
    return replace(found, marginals=marginals)
