"""One-class learning: its equivalence to SVDD, and its properties."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize

from deixis.extras import MissingExtraError
from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.one_class import SupportVectorDescription
from deixis.perception.recognition.learners.view_features import ViewFeatures


def view(*numbers: float) -> ViewFeatures:
    return ViewFeatures({"good": np.square(np.array([numbers], np.float32))})  # pooling takes roots


def smallest_ball(points: NDArray[np.float64], reach: float, outliers: float) -> tuple[NDArray[np.float64], float]:
    """Solve the dual of SVDD (Tax and Duin 2004) by a general solver; return weights (n,) and f on the boundary."""
    kernel = np.exp(-((points[:, None] - points[None]) ** 2).sum(axis=2) / reach**2)
    n, most = len(points), 1.0 / (outliers * len(points))
    found = minimize(
        lambda weights: weights @ kernel @ weights - np.diag(kernel) @ weights,
        np.full(n, 1.0 / n),
        jac=lambda weights: 2 * kernel @ weights - np.diag(kernel),
        bounds=[(0.0, most)] * n,
        constraints={"type": "eq", "fun": lambda weights: weights.sum() - 1.0},
        options={"ftol": 1e-14, "maxiter": 500},
    ).x
    free = (found > 1e-4) & (found < most - 1e-4)
    return found, float((kernel @ found)[free].mean())


def test_scores_are_those_of_support_vector_data_description() -> None:
    points = np.random.default_rng(3).uniform(0.2, 1.0, (6, 2))
    learner = SupportVectorDescription(["good"], outliers=0.4, reach=0.7)
    for point in points:
        learner.learn("cup", view(*point))
    weights, boundary = smallest_ball(points, 0.7, 0.4)
    for place in ([0.5, 0.5], [0.9, 0.2], [1.4, 1.4]):
        similar = np.exp(-((points - place) ** 2).sum(axis=1) / 0.49)
        found = learner.predict(view(*place))
        assert found.ranked[0][1] == pytest.approx(float(similar @ weights) / boundary, abs=2e-3)


def test_a_category_depends_on_its_own_views_only() -> None:
    learner = SupportVectorDescription(["good"])
    learner.learn("cup", view(0.5, 0.5))
    before = dict(learner.predict(view(0.6, 0.5)).ranked)["cup"]
    learner.learn("fork", view(0.9, 0.1))
    assert dict(learner.predict(view(0.6, 0.5)).ranked)["cup"] == before


def test_a_view_far_from_every_category_is_unknown() -> None:
    learner = SupportVectorDescription(["good"])
    learner.learn("cup", view(0.5, 0.5))
    assert learner.predict(view(0.5, 0.5)).unknown == pytest.approx(0.0)
    assert learner.predict(view(5.0, 5.0)).unknown == pytest.approx(1.0)


def test_a_missing_scikit_learn_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    with pytest.raises(MissingExtraError, match=r"scikit-learn; install it: pip install 'deixis\[experiments\]'"):
        SupportVectorDescription()


@pytest.mark.parametrize("wrong", [{"outliers": 0.0}, {"outliers": 1.0}, {"reach": 0.0}])
def test_settings_out_of_range_are_an_error(wrong: dict[str, float]) -> None:
    with pytest.raises(RecognitionError, match="`outliers` must be"):
        SupportVectorDescription(**wrong)  # type: ignore[arg-type]
