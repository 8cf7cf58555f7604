"""Meanings of words that examples show."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import minimize

from deixis.reasoning.attributes.attribute import LEAST, MEASURES, PRIOR_SPREAD, Attribute, Example, fitted

Array = NDArray[np.float64]
LABELS = ("cup", "plate", "fork", "box")


def examples(true: Callable[[Array, str], bool], count: int = 40, seed: int = 0) -> tuple[Example, ...]:
    """Return random things as examples of a word that is true of some of them."""
    random = np.random.default_rng(seed)
    measures, labels = random.normal(0, 1, (count, len(MEASURES))), random.choice(LABELS, count)
    return tuple(
        Example(row, str(label), bool(true(row, str(label)))) for row, label in zip(measures, labels, strict=True)
    )


@pytest.mark.parametrize(
    ("dimension", "true"),
    [
        ("colour", lambda row, _: np.linalg.norm(row[:3] - [0.5, -0.5, 0]) < 1.2),
        ("size", lambda row, _: row[MEASURES.index("volume")] > 0.5),
        ("shape", lambda row, _: row[MEASURES.index("elongation")] > 0.5),
        ("surface", lambda row, _: row[MEASURES.index("gloss")] > 0.5),
        ("kind", lambda _, label: label == "cup"),
    ],
)
def test_the_dimension_of_a_word_is_found(dimension: str, true: Callable[[Array, str], bool]) -> None:
    word, new = Attribute("blick", examples(true, 60)), examples(true, 200, seed=1)
    assert word.dimension == dimension
    assert word.names_kinds == (dimension == "kind")
    assert sum(word.shares.values()) == pytest.approx(1.0)
    p = word.probabilities(np.array([one.measures for one in new]), [one.label for one in new])
    assert np.mean((p > 0.5) == [one.positive for one in new]) > 0.85


def test_a_word_that_is_used_at_random_means_nothing() -> None:
    random = np.random.default_rng(3)
    assert Attribute("blick", examples(lambda *_: bool(random.random() < 0.5), 80)).dimension == "chance"


def test_without_examples_nothing_is_known() -> None:
    p = Attribute("blick", ()).probabilities(np.zeros((3, len(MEASURES))), [None, "cup", None])
    assert p == pytest.approx(np.full(3, 0.5))


def test_unknown_measures_leave_the_others_to_decide() -> None:
    taught = [
        Example(np.where(np.arange(len(MEASURES)) >= 9, np.nan, one.measures), None, one.positive)
        for one in examples(lambda row, _: row[3] > 0, 60)
    ]
    word = Attribute("blick", tuple(taught))
    things = np.full((2, len(MEASURES)), np.nan)
    things[:, 3:6] = [[2.0, 0, 0], [-2.0, 0, 0]]
    large, small = word.probabilities(things, [None, None])
    assert word.dimension == "size" and large > 0.7 > 0.3 > small


@settings(max_examples=10, deadline=None)
@given(st.permutations(range(12)))
def test_the_order_of_the_examples_does_not_matter(order: list[int]) -> None:
    told = examples(lambda row, _: row[0] > 0, 12)
    things = np.array([one.measures for one in told])
    before = Attribute("blick", told).probabilities(things, [one.label for one in told])
    after = Attribute("blick", tuple(told[i] for i in order)).probabilities(things, [one.label for one in told])
    assert after == pytest.approx(before, abs=1e-6)
    assert (before >= LEAST).all() and (before <= 1 - LEAST).all()


def test_the_fit_is_that_of_a_general_optimiser() -> None:
    told = examples(lambda row, _: row[0] + 0.5 * row[1] > 0, 40)
    x = np.column_stack([np.ones(40), [one.measures[:3] for one in told]])
    y = np.array([1.0 if one.positive else -1.0 for one in told])

    def loss(weights: Array) -> float:
        return float(np.logaddexp(0, -y * (x @ weights)).sum() + weights @ weights / (2 * PRIOR_SPREAD**2))

    peer = minimize(loss, np.zeros(4))
    assert fitted([0, 1, 2], False, told).weights == pytest.approx(peer.x, abs=1e-3)
