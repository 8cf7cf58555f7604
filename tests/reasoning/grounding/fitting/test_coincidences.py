"""Weights of coincidences, fitted to tables with known truth."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.fitting.coincidences import JudgedTable, fit_coincidences
from deixis.reasoning.grounding.matching.posterior.coincidences import SHIPPED_WEIGHTS, Coincidences


def drawn(rng: np.random.Generator, power: float, count: int = 400) -> JudgedTable:
    """Return matches that are coincidences with odds that grow with the misfit by ``power``."""
    misfit = rng.exponential(6.0, count)
    wrong = rng.random(count) < 1 / (1 + np.exp(6.0 - power * misfit))
    nothing = np.zeros(count)
    found = Coincidences(nothing + 0.999, nothing + 0.001, misfit, nothing, nothing, np.ones(count, dtype=bool))
    return JudgedTable(found, ~wrong, wrong, np.where(wrong, 0.0, 0.999), nothing)


def test_fitted_weights_score_better_on_other_tables() -> None:
    rng = np.random.default_rng(3)
    learned, other = ([drawn(rng, 0.5) for _ in range(5)] for _ in range(2))
    weights = fit_coincidences([learned], iterations=80)
    assert np.mean([table.score(weights) for table in other]) > np.mean(
        [table.score(SHIPPED_WEIGHTS) for table in other]
    )


def test_nothing_to_fit_to_is_an_error() -> None:
    with pytest.raises(SettingError, match="at least one table"):
        fit_coincidences([[]])
