"""Classes of objects before a noun is heard, and the fit of nouns to them."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.reference.features.nouns import NAMED, Nouns, class_shares
from deixis.reasoning.grounding.reference.features.room import Room


def room(
    labels: tuple[str | None, ...],
    candidates: tuple[dict[str, float], ...] | None = None,
    sides: tuple[float, ...] | None = None,
) -> Room:
    """Return a row of cubes, of 10 cm unless their sides are given."""
    low = np.arange(len(labels))[:, None] * [0.2, 0.0, 0.0]
    boxes = np.stack([low, low + np.array(sides or (0.1,) * len(labels))[:, None]], axis=1)
    return Room.of([f"o{place}" for place in range(len(labels))], boxes, labels, candidates=candidates)


def test_the_shares_of_classes_sum_to_one() -> None:
    seen = room(("cup", None, None), ({}, {"cup": 0.5, "mug": 0.3}, {}))
    shares = class_shares(seen)
    assert shares.sum(axis=0) == pytest.approx(np.ones(3))
    assert shares[-2:, 2] == pytest.approx([NAMED, 1 - NAMED])


def test_a_scene_with_all_labels_has_one_class_an_object() -> None:
    assert class_shares(room(("cup", "plate"))).tolist() == [[1.0, 1.0]]


def test_the_features_have_a_row_for_each_class() -> None:
    seen, nouns = room(("cup", None)), Nouns(default_ontology().lexicon)
    features = nouns.features("cup", seen)
    assert features.shape[:2] == class_shares(seen).shape
    assert features[1, 1, :-3].tolist() == features[0, 0, :-3].tolist()


def test_similarity_is_expected_over_the_candidates() -> None:
    nouns = Nouns(default_ontology().lexicon)
    sure, half, bare = nouns.similarity("cup", room(("cup", None, None), ({}, {"cup": 0.5}, {})))
    assert (half, bare) == (pytest.approx(sure / 2), 0.0)


def test_what_is_as_large_as_labelled_cups_may_be_a_cup() -> None:
    seen = room(("cup", "cup", "bin", "bin", None, None), sides=(0.1, 0.09, 0.4, 0.45, 0.1, 0.42))
    sizes = Nouns(default_ontology().lexicon).features("cup", seen)[-2, :, -1]
    assert sizes[:4].tolist() == [0.0] * 4
    assert sizes[4] > 0 > sizes[5]


def test_a_noun_names_labels_and_expected_candidates() -> None:
    seen = room(("cup", "plate", None), ({}, {}, {"cup": 0.7, "mug": 0.2}))
    called = Nouns(default_ontology().lexicon).called(["cup", ""], seen)
    assert called[:2].tolist() == [1.0, 0.0] and 0.7 <= called[2] <= 0.9
