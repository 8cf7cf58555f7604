"""Attributes: words that are true of things by their colour, shape, size or surface, learned from examples.

A word may be about any of these, and the examples do not say which. Each possibility is a hypothesis: a logistic model
of the measures of one dimension, of one measure alone, a name of kinds (true of some labels, whatever the thing looks
like), or chance. The probability that a word is true of a thing is the mean of the hypotheses' predictions, weighted by
how well each explains the examples (Bayesian model averaging, with Laplace's approximation; MacKay 1992). A few
examples therefore suffice where one dimension explains them, unlike with one classifier over all measures. Matuszek and
others (2012) learn such classifiers for words that they know to be about colour or shape.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DIMENSIONS: dict[str, tuple[str, ...]] = {
    "colour": ("lightness", "redness", "yellowness"),
    "size": ("volume", "length", "height"),
    "shape": ("elongation", "flatness", "roundness"),
    "surface": ("gloss", "pattern"),
}
"""Measures of each dimension; each is scaled so that usual things lie between about -2 and 2."""

MEASURES = tuple(name for names in DIMENSIONS.values() for name in names)

KIND, CHANCE = "kind", "chance"
"""Hypotheses that a word names kinds of things, and that it is used at random."""

PRIOR_SPREAD = 2.0
"""Standard deviation of the weights of a logistic model before examples are seen."""

CURVED_SPREAD = 1.0
"""Standard deviation of the weights of squares and products of measures."""

LABEL_PRIOR = 0.2
"""Parameter of the Beta distribution of the share of the things of a label that a word is true of."""

LEAST = 0.01
"""Minimum probability that a word is true, or not true, of a thing: people misuse words."""


@dataclass(frozen=True, slots=True, eq=False)
class Example:
    """A thing that a word was used of, or was not used of.

    Parameters
    ----------
    measures
        Measures of the thing in the order of ``MEASURES``, shape (m,); NaN where one is unknown.
    label
        Label of the thing, or None.
    positive
        Whether the word was used of it.
    weight
        Weight of the example, at most 1.
    """

    measures: Array
    label: str | None
    positive: bool
    weight: float = 1.0


@dataclass(frozen=True, eq=False)
class Logistic:
    """Logistic model of some measures: columns, weights with their covariance, and its log evidence."""

    columns: tuple[int, ...]
    curved: bool
    weights: Array
    covariance: Array
    evidence: float

    def probabilities(self, measures: Array) -> Array:
        """Return the probabilities of n things with the uncertainty of the weights taken into account.

        Parameters
        ----------
        measures
            Measures, shape (n, m).

        Returns
        -------
        ndarray
            Probabilities, shape (n,); 0.5 where a measure is unknown.
        """
        known = np.isfinite(measures[:, self.columns]).all(axis=1)
        design = designed(np.nan_to_num(measures[:, self.columns]), self.curved)
        mean = design @ self.weights
        variance = np.einsum("ni,ij,nj->n", design, self.covariance, design)
        result: Array = np.where(known, sigmoid(mean / np.sqrt(1 + np.pi * variance / 8)), 0.5)
        return result


def sigmoid(x: Array) -> Array:
    """Return the logistic function.

    Parameters
    ----------
    x
        Log odds.

    Returns
    -------
    ndarray
        Probabilities of the same shape.
    """
    result: Array = 1 / (1 + np.exp(-np.clip(x, -50, 50)))
    return result


def designed(measures: Array, curved: bool) -> Array:
    """Return the terms of a logistic model: 1, the measures, and with ``curved`` their squares and products.

    Parameters
    ----------
    measures
        Measures, shape (n, d).
    curved
        Whether to add squares and products.

    Returns
    -------
    ndarray
        Terms, shape (n, k).
    """
    n, d = measures.shape
    parts = [np.ones((n, 1)), measures]
    if curved:
        first, second = np.triu_indices(d)
        parts.append(measures[:, first] * measures[:, second])
    return np.concatenate(parts, axis=1)


def fitted(columns: Sequence[int], curved: bool, examples: Sequence[Example]) -> Logistic:
    """Return the logistic model of some measures at its maximum a posteriori, with Laplace's evidence.

    Parameters
    ----------
    columns
        Positions of the measures.
    curved
        Whether squares and products count.
    examples
        The examples; those without these measures count as explained by chance.

    Returns
    -------
    Logistic
        The model.
    """
    chosen = list(columns)
    known = [one for one in examples if np.isfinite(one.measures[chosen]).all()]
    values = np.array([one.measures[chosen] for one in known]).reshape(-1, len(chosen))
    y = np.array([one.positive for one in known], dtype=np.float64)
    share = np.array([one.weight for one in known], dtype=np.float64)
    design = designed(values, curved)
    spread = np.full(design.shape[1], CURVED_SPREAD)
    spread[: 1 + len(chosen)] = PRIOR_SPREAD
    precision = 1 / spread**2
    weights: Array = np.zeros(design.shape[1])
    hessian: Array = np.diag(precision)
    for _ in range(30):
        p = sigmoid(design @ weights)
        hessian = (design * (share * p * (1 - p))[:, None]).T @ design + np.diag(precision)
        step = np.linalg.solve(hessian, design.T @ (share * (y - p)) - precision * weights)
        weights += step * min(1.0, 3.0 / max(float(np.abs(step).max()), 1e-12))
        if np.abs(step).max() < 1e-6:
            break
    p = np.clip(sigmoid(design @ weights), 1e-12, 1 - 1e-12)
    fit = float(share @ (y * np.log(p) + (1 - y) * np.log(1 - p)))
    prior = float(np.sum(np.log(precision)) / 2 - np.sum(precision * weights**2) / 2)
    unknown = sum(one.weight for one in examples) - float(share.sum())
    evidence = fit + prior - float(np.linalg.slogdet(hessian)[1]) / 2 - unknown * np.log(2)
    covariance = np.asarray(np.linalg.inv(hessian), dtype=np.float64)
    return Logistic(tuple(chosen), curved, weights, covariance, evidence)


@dataclass(frozen=True, eq=False)
class Attribute:
    """Meaning of a word, as far as examples show.

    Parameters
    ----------
    word
        The word.
    examples
        Things that it was used of, or not used of; their order does not matter.
    """

    word: str
    examples: tuple[Example, ...]

    @cached_property
    def models(self) -> dict[str, tuple[Logistic, ...]]:
        """Logistic models of each dimension: of all its measures, and of each alone."""
        found: dict[str, tuple[Logistic, ...]] = {}
        for dimension, names in DIMENSIONS.items():
            columns = [MEASURES.index(name) for name in names]
            alone = [fitted([column], False, self.examples) for column in columns]
            found[dimension] = (fitted(columns, True, self.examples), *alone)
        return found

    @cached_property
    def shares(self) -> dict[str, float]:
        """Probability that the word is about each dimension, names kinds, or is used at random; the sum is 1."""
        logs = {
            dimension: float(np.logaddexp.reduce([one.evidence for one in models]) - np.log(len(models)))
            for dimension, models in self.models.items()
        }
        logs[KIND], logs[CHANCE] = self._label_evidence(True), self._label_evidence(False)
        total = float(np.logaddexp.reduce(list(logs.values())))
        return {name: float(np.exp(log - total)) for name, log in logs.items()}

    @property
    def dimension(self) -> str:
        """Most probable dimension of the word, ``kind`` or ``chance``."""
        return max(self.shares, key=lambda name: self.shares[name])

    @property
    def names_kinds(self) -> bool:
        """True if the word is more probably a name of kinds than an attribute."""
        return self.dimension == KIND

    @cached_property
    def _counts(self) -> dict[str | None, Array]:
        """Weights of the negative and of the positive examples by label."""
        found: dict[str | None, Array] = {}
        for one in self.examples:
            found.setdefault(one.label, np.zeros(2))[int(one.positive)] += one.weight
        return found

    def _label_evidence(self, by_label: bool) -> float:
        from scipy.special import betaln

        groups = list(self._counts.values())
        if not by_label:
            no, yes = sum(groups, np.zeros(2))
            return float(betaln(yes + 1.0, no + 1.0))
        unlabelled = self._counts.get(None, np.zeros(2)).sum()
        known = [count for label, count in self._counts.items() if label is not None]
        return float(
            sum(betaln(yes + LABEL_PRIOR, no + LABEL_PRIOR) - betaln(LABEL_PRIOR, LABEL_PRIOR) for no, yes in known)
            - unlabelled * np.log(2)
        )

    def probabilities(self, measures: Array, labels: Sequence[str | None]) -> Array:
        """Return the probability that the word is true of each thing.

        Parameters
        ----------
        measures
            Measures of n things, shape (n, m).
        labels
            Label of each thing, or None.

        Returns
        -------
        ndarray
            Probabilities, shape (n,), in [``LEAST``, 1 - ``LEAST``].
        """
        total = np.zeros(len(measures))
        for dimension, models in self.models.items():
            logs = np.array([one.evidence for one in models])
            shares = np.exp(logs - np.logaddexp.reduce(logs))
            predicted = np.array([one.probabilities(measures) for one in models])
            total += self.shares[dimension] * (shares @ predicted)
        total += self.shares[KIND] * np.array([self._of_label(label) for label in labels])
        no, yes = sum(self._counts.values(), np.zeros(2))
        total += self.shares[CHANCE] * (yes + 1) / (yes + no + 2)
        return np.clip(total, LEAST, 1 - LEAST)

    def _of_label(self, label: str | None) -> float:
        if label is None:
            return 0.5
        no, yes = self._counts.get(label, np.zeros(2))
        return float((yes + LABEL_PRIOR) / (yes + no + 2 * LABEL_PRIOR))
