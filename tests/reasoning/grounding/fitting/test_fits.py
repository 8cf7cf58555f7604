"""Powers by which facts and kinds weigh in whether a description is of a scene."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.fitting.fits import ACCUSED, fit_powers, likeliest_powers
from deixis.reasoning.grounding.hypotheses.hypotheses import ANOTHER_PRIOR, FitEvidence


def test_powers_come_back_from_pairs_drawn_by_them() -> None:
    rng, powers = np.random.default_rng(1), np.array([0.6, 0.3, 1.0])
    drawn = np.column_stack([rng.normal(14, 10, 4000), rng.uniform(5, 30, 4000), -rng.exponential(1.0, 4000)])
    pairs = [FitEvidence(*row) for row in drawn.tolist()]
    design = np.array([(one.facts, -one.chance, one.kinds) for one in pairs])
    right = rng.random(4000) < 1 / (1 + np.exp(-design @ powers))
    assert likeliest_powers(pairs, right, np.ones(4000)) == pytest.approx(powers, rel=0.15)


def test_pairs_of_one_sort_teach_nothing() -> None:
    with pytest.raises(SettingError, match="right and wrong"):
        likeliest_powers([FitEvidence(1.0, 2.0, 0.0)], np.array([True]))


def test_as_few_right_tables_are_accused_as_is_said() -> None:
    rng = np.random.default_rng(2)
    right = rng.random(3000) < 0.5
    facts = rng.normal(np.where(right, 16.0, 2.0), 5.0)
    tables = [FitEvidence(one, most, 0.0) for one, most in zip(facts, rng.uniform(12, 24, 3000), strict=True)]
    photographs = [FitEvidence(one / 3, 8.0, -gap) for one, gap in zip(facts, rng.exponential(2.0, 3000), strict=True)]
    power, chance, kinds = fit_powers(tables, right, photographs, right)
    assert power == pytest.approx(likeliest_powers(tables, right)[0])
    odds = np.array([power * one.facts - chance * one.chance for one in tables]) - np.log(
        ANOTHER_PRIOR / (1 - ANOTHER_PRIOR)
    )
    assert (odds[right] < 0).mean() == pytest.approx(ACCUSED, abs=2e-3)
    assert (odds[~right] < 0).mean() > 0.5
    assert kinds >= 0
