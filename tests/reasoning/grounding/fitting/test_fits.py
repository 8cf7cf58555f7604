"""Powers by which facts and kinds weigh in whether a description is of a scene."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.fitting.fits import fit_powers
from deixis.reasoning.grounding.hypotheses import FitEvidence


def test_powers_come_back_from_pairs_drawn_by_them() -> None:
    rng, powers = np.random.default_rng(1), np.array([0.6, 0.3, 1.0])
    design = np.column_stack([rng.normal(8, 8, 4000), -rng.uniform(5, 30, 4000), -rng.exponential(1.0, 4000)])
    right = rng.random(4000) < 1 / (1 + np.exp(-design @ powers))
    pairs = [FitEvidence(facts, -most, kinds) for facts, most, kinds in design.tolist()]
    assert fit_powers(pairs, right, np.ones(4000)) == pytest.approx(powers, rel=0.15)


def test_pairs_of_one_sort_teach_nothing() -> None:
    with pytest.raises(SettingError, match="right and wrong"):
        fit_powers([FitEvidence(1.0, 2.0, 0.0)], np.array([True]))
