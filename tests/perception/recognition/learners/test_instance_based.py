"""The paper's learner against its equations, computed by hand."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.recognition.learners.instance_based import InstanceBased
from deixis.perception.recognition.learners.view_features import ViewFeatures
from deixis.perception.recognition.settings import PAPER, RecognitionSettings


def view(*rows: float, thing: str | None = None) -> ViewFeatures:
    return ViewFeatures({"spin_images": np.array(rows, np.float32)[:, None]}, thing)


def learned(**settings: object) -> InstanceBased:
    learner = InstanceBased(root=False, **settings)  # type: ignore[arg-type]
    for place in (0.0, 2.0):
        learner.learn("tight", view(place))  # ICD 2
    for place in (10.0, 18.0):
        learner.learn("loose", view(place))  # ICD 8
    return learner


def test_scores_are_equation_4() -> None:
    found = learned(settings=PAPER).predict(view(5.0))  # D_C 3 and 5
    assert dict(found.ranked) == pytest.approx({"tight": -3 / 2, "loose": -5 / 8})
    assert found.best == "loose" and found.unknown == pytest.approx(5 / 8)


def test_by_distance_uses_equation_4_only_for_unknown() -> None:
    found = learned(settings=PAPER, by_distance=True).predict(view(5.0))
    assert found.best == "tight" and dict(found.ranked) == pytest.approx({"tight": -3.0, "loose": -5.0})
    assert found.unknown == pytest.approx(5 / 8)


def test_shrinkage_draws_the_divisors_together() -> None:
    found = learned(settings=RecognitionSettings(shrinkage=2.0)).predict(
        view(5.0)
    )  # median ICD 5, so (2 * 2 + 2 * 5) / 4 and (2 * 8 + 2 * 5) / 4
    assert dict(found.ranked) == pytest.approx({"tight": -3 / 3.5, "loose": -5 / 6.5})


def test_views_of_one_thing_do_not_enter_the_icd() -> None:
    learner = InstanceBased(root=False, settings=RecognitionSettings(shrinkage=0.0))
    for place, thing in ((0.0, "a"), (1.0, "a"), (4.0, "b")):  # over things: a mean of 4 and 3, to and fro
        learner.learn("cup", view(place, thing=thing))
    wanted = pytest.approx(-2 / 3.5)
    assert dict(learner.predict(view(6.0)).ranked)["cup"] == wanted
    learner.rename("cup", "mug")
    assert dict(learner.predict(view(6.0)).ranked)["mug"] == wanted


def test_square_roots_give_the_hellinger_distance() -> None:
    learner = InstanceBased(by_distance=True)
    learner.learn("cup", view(4.0))
    assert dict(learner.predict(view(9.0)).ranked) == pytest.approx({"cup": -1.0})
