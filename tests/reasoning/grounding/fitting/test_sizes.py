"""Sizes learned from few views stay near what is known; from many, near what was seen."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from numpy.typing import NDArray

from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.fitting.sizes import (
    PRIOR_SPREAD,
    VIEWS_OF_PRIOR,
    SizePrior,
    learn_size,
    pooled_prior,
    usual_prior,
)

PRIOR = SizePrior(np.array([-1.5, -0.5]), np.array([0.6, 0.6]), np.array([0.2, 0.1]))
LOGS = arrays.arrays(float, st.tuples(st.integers(1, 12), st.just(2)), elements=st.floats(-3, 0))


def test_one_view_by_hand() -> None:
    found = learn_size(np.array([[-0.9, -0.5]]), PRIOR)
    variance = 5 * 0.2**2 / 6  # one view has no deviation; the prior counts as five
    precision = 1 / variance + 1 / 0.6**2
    assert VIEWS_OF_PRIOR == 5
    assert found.length[0] == pytest.approx((-0.9 / variance - 1.5 / 0.36) / precision)
    assert found.length[1] == pytest.approx((variance + 1 / precision) ** 0.5)
    assert (found.views, found.relative) == (1, False)


def test_many_views_outweigh_the_prior() -> None:
    views = np.random.default_rng(0).normal([0.0, -1.0], [0.4, 0.3], (2000, 2))
    found = learn_size(views, PRIOR)
    assert (found.length[0], found.aspect[0]) == pytest.approx((0.0, -1.0), abs=0.05)
    assert (found.length[1], found.aspect[1]) == pytest.approx((0.4, 0.3), abs=0.03)


def test_a_view_that_is_wrong_hardly_moves_what_three_others_say() -> None:
    views = np.log([[0.24, 0.5], [0.25, 0.5], [0.26, 0.5], [20.0, 0.5]])
    assert np.exp(learn_size(views, PRIOR).length[0]) == pytest.approx(0.25, rel=0.05)


@given(LOGS, st.randoms(use_true_random=False))
def test_typical_size_lies_between_prior_and_views(views: NDArray[np.float64], random: Random) -> None:
    found, mixed = learn_size(views, PRIOR), learn_size(np.array(random.sample(views.tolist(), len(views))), PRIOR)
    assert found.length == pytest.approx(mixed.length) and found.aspect == pytest.approx(mixed.aspect)
    least, greatest = sorted((PRIOR.centre[0], np.median(views[:, 0])))
    assert least - 1e-9 <= found.length[0] <= greatest + 1e-9
    assert found.aspect[0] <= 0


def test_kinds_that_differ_much_within_make_a_new_kind_wide() -> None:
    narrow, wide = (
        pooled_prior([np.full((4, 2), -1.0) + np.linspace(-by, by, 4)[:, None] for _ in range(5)]) for by in (0.01, 1.0)
    )
    assert wide.within[0] > 3 * narrow.within[0]
    one = np.full((1, 2), -1.0)
    assert learn_size(one, wide).length[1] > 3 * learn_size(one, narrow).length[1]


def test_single_view_has_the_prior_spread() -> None:
    prior = pooled_prior([np.zeros((0, 2)), np.array([[-1.0, -0.3]])])
    assert prior.centre.tolist() == [-1.0, -0.3]
    assert prior.within == pytest.approx([PRIOR_SPREAD] * 2) and prior.between == pytest.approx([PRIOR_SPREAD] * 2)


def test_a_usual_size_is_off_by_as_much_as_its_things_differ() -> None:
    prior = usual_prior(SizeModel((-1.5, 0.1), (-0.2, 0.05)))
    assert prior.between.tolist() == prior.within.tolist() == [0.1, 0.05]


def test_nothing_seen_teaches_nothing() -> None:
    with pytest.raises(SettingError, match="one view"):
        learn_size(np.zeros((0, 2)), PRIOR)
    with pytest.raises(SettingError, match="one view"):
        pooled_prior([])
