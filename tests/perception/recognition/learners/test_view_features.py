"""Features of a view: its descriptors by name, and the vector pooled from them."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import RecognitionError
from deixis.perception.features.descriptors.d2_extents import D2ExtentsDescriber
from deixis.perception.features.descriptors.good import GoodDescriber
from deixis.perception.recognition.learners.view_features import ViewFeatures, features_of, pooled


def test_a_view_has_what_every_describer_says() -> None:
    cloud = PointCloud(np.random.default_rng(2).uniform(0, 0.1, (200, 3)).astype(np.float32))
    view = features_of(cloud, [GoodDescriber(), D2ExtentsDescriber()])
    assert view["good"].shape == (1, 675) and view["d2_extents"].shape == (1, 35)


def test_an_unknown_descriptor_names_the_known_ones() -> None:
    with pytest.raises(RecognitionError, match="no descriptor 'fpfh'; it has good"):
        ViewFeatures({"good": np.ones((1, 2), np.float32)})["fpfh"]


def test_descriptors_are_rows() -> None:
    with pytest.raises(RecognitionError, match="'good'"):
        ViewFeatures({"good": np.ones(3, np.float32)})


def test_a_view_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        ViewFeatures({}).descriptors["good"] = np.ones((1, 2), np.float32)  # type: ignore[index]


def test_nothing_is_pooled_from_a_view_that_lacks_a_descriptor() -> None:
    assert pooled(ViewFeatures({"good": np.empty((0, 2), np.float32)}), ["good"]) is None
