"""Scores and their derivatives, compared with numerical differentiation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.reference.model.likelihood import (
    Score,
    add_gradients,
    constant,
    log_complement,
    log_mixture,
    log_shares,
    log_sum,
    weighted,
)

Array = NDArray[np.float64]
RANDOM = np.random.default_rng(5)
UNARY, PAIRS = RANDOM.normal(size=(4, 3)), RANDOM.normal(size=(2, 4, 5, 3))


def score(values: Array) -> Score:
    weights = {"noun": values[:3], "near": values[3:6], "near/beside": values[6:]}
    nouns = weighted(UNARY, "noun", weights)[None]
    pairs = weighted(PAIRS, "near/beside", weights) + constant(RANDOM_OFFSET)
    related = log_sum(pairs + log_shares(pairs, 0), 2)
    denied = log_complement(log_shares(related, 1), 0.95)
    first, second = (log_shares(log_sum(one, 0), 0) for one in (nouns + related + denied, nouns + related))
    return log_mixture([first, second], log_shares(weighted(READINGS, "noun", weights), 0))[2]


RANDOM_OFFSET = RANDOM.normal(size=(1, 4, 5))
READINGS = RANDOM.normal(size=(2, 3))


def test_gradients_are_those_of_finite_differences() -> None:
    values, step = RANDOM.normal(size=9), 1e-6
    found = {"noun": np.zeros(3), "near": np.zeros(3), "near/beside": np.zeros(3)}
    add_gradients(score(values), found)
    numerical = [
        float(score(values + step * unit).value - score(values - step * unit).value) / (2 * step) for unit in np.eye(9)
    ]
    np.testing.assert_allclose(np.concatenate(list(found.values())), numerical, atol=1e-6)


def test_log_shares_are_probabilities() -> None:
    shares = np.exp(log_shares(constant(RANDOM_OFFSET), 2).value)
    np.testing.assert_allclose(shares.sum(axis=2), 1.0)


def test_a_word_without_weights_has_those_of_its_family() -> None:
    weights = {"near": np.array([1.0, 2.0])}
    assert weighted(np.array([3.0, 4.0]), "near/abutting", weights).value == 11.0
