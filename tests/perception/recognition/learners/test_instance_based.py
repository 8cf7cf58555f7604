"""The paper's learner against its equations, computed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.recognition.errors import RecognitionError
from deixis.perception.recognition.learners.instance_based import InstanceBased, shrunk
from deixis.perception.recognition.learners.view_features import ViewFeatures


def view(*rows: float) -> ViewFeatures:
    return ViewFeatures({"spin_images": np.array(rows, np.float32)[:, None]})


def learnt(**settings: object) -> InstanceBased:
    learner = InstanceBased(root=False, **settings)  # type: ignore[arg-type]
    for place in (0.0, 2.0):
        learner.learn("tight", view(place))  # ICD 2
    for place in (10.0, 18.0):
        learner.learn("loose", view(place))  # ICD 8
    return learner


def test_scores_are_equation_4() -> None:
    found = learnt(shrinkage=0.0).predict(view(5.0))  # D_C 3 and 5
    assert dict(found.ranked) == pytest.approx({"tight": -3 / 2, "loose": -5 / 8})
    assert found.best == "loose" and found.unknown == pytest.approx(5 / 8)


def test_names_by_distance_leave_the_unknown_to_equation_4() -> None:
    found = learnt(shrinkage=0.0, by_distance=True).predict(view(5.0))
    assert found.best == "tight" and dict(found.ranked) == pytest.approx({"tight": -3.0, "loose": -5.0})
    assert found.unknown == pytest.approx(5 / 8)


def test_shrinkage_draws_the_divisors_together() -> None:
    found = learnt(shrinkage=2.0).predict(view(5.0))  # median ICD 5, so (2 * 2 + 2 * 5) / 4 and (2 * 8 + 2 * 5) / 4
    assert dict(found.ranked) == pytest.approx({"tight": -3 / 3.5, "loose": -5 / 6.5})


def test_shrinkage_matters_less_the_more_views_there_are() -> None:
    few, many = (shrunk([1.0, 3.0, 5.0], [count] * 3, 15.0) for count in (3, 300))
    assert few[0] == pytest.approx((3 * 1 + 15 * 3) / 18) and abs(many[0] - 1.0) < 0.1 < abs(few[0] - 1.0)


def test_square_roots_make_it_hellingers_distance() -> None:
    learner = InstanceBased(by_distance=True)
    learner.learn("cup", view(4.0))
    assert dict(learner.predict(view(9.0)).ranked) == pytest.approx({"cup": -1.0})


def test_a_negative_shrinkage_is_refused() -> None:
    with pytest.raises(RecognitionError, match="0 views or more"):
        InstanceBased(shrinkage=-1.0)
