"""Recognition by several descriptors jointly: the weighted geometric mean, and errors."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import SHIPPED, Calibration
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.joint import JointRecogniser
from deixis.perception.recognition.recogniser import Recogniser
from deixis.perception.recognition.settings import RecognitionSettings

UNIT = RecognitionSettings(prior_spread=1.0)
CALIBRATION = Calibration(threshold=1, even=1.5, doubt=3, choice=4, weights=(0.75, 0.25))


def at(*values: float) -> NDArray[np.float32]:
    return np.array(values, np.float32)[:, None]


def recogniser(**places: float) -> Recogniser:
    """Return a recogniser with one view per category, each with one descriptor of one number."""
    return Recogniser.of([InstanceCategory.of(name, [(name, at(place))]) for name, place in places.items()], UNIT)


def test_nd_is_the_weighted_geometric_mean() -> None:
    known = JointRecogniser((recogniser(cup=0, fork=5), recogniser(cup=3, fork=9)), CALIBRATION)
    found = {one.category: one for one in known.recognise([at(1), at(7)]).candidates}
    assert found["cup"].normalised == pytest.approx(1**0.75 * 4**0.25)
    assert found["fork"].normalised == pytest.approx(4**0.75 * 2**0.25)
    assert (found["cup"].distance, found["cup"].nearest) == (1, "cup")  # by the first descriptor
    assert sum(one.probability for one in found.values()) + known.recognise([at(1), at(7)]).unknown == pytest.approx(1)


def test_one_descriptor_decides_what_another_leaves_open() -> None:
    known = JointRecogniser((recogniser(cup=0, fork=2), recogniser(cup=0, fork=9)), CALIBRATION)
    assert [known.recognise([at(1), at(view)]).candidates[0].category for view in (1, 8)] == ["cup", "fork"]


def test_a_single_part_is_its_recogniser() -> None:
    alone = recogniser(cup=0, fork=5)
    assert JointRecogniser((alone,), SHIPPED).recognise([at(1)]).candidates == alone.recognise(at(1)).candidates


def test_a_view_that_lacks_a_descriptor_is_unknown() -> None:
    known = JointRecogniser((recogniser(cup=0), recogniser(cup=3)), CALIBRATION)
    found = known.recognise([at(1), np.empty((0, 1), np.float32)])
    assert (found.label, found.candidates, found.unknown) == (None, (), 1.0)


def test_parts_with_different_views_are_an_error() -> None:
    with pytest.raises(RecognitionError, match="the same views"):
        JointRecogniser((recogniser(cup=0), recogniser(mug=3)), CALIBRATION)
    with pytest.raises(RecognitionError, match="1 weights for 2 descriptors"):
        JointRecogniser((recogniser(cup=0), recogniser(cup=3)), SHIPPED)
