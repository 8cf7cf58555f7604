"""Words of pairs, and what is between what."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.errors import LimitError
from deixis.reasoning.grounding.evidence.claims.scene_words import MAX_THINGS, scene_words

ROW = np.array([[[x, 0.0, 0.0], [x + 0.1, 0.1, h]] for x, h in ((0.0, 0.1), (0.3, 0.3), (0.6, 0.1))])


def test_the_middle_of_a_row_is_between_the_ends() -> None:
    assert [triple[:3] for triple in scene_words(ROW).triples()] == [(1, 0, 2)]


def test_heights_are_compared_where_boxes_have_them() -> None:
    assert "taller" in scene_words(ROW).of(1, 0)
    assert "taller" not in scene_words(ROW[:, :, :2]).of(1, 0)


def test_nothing_is_said_about_unknown_fronts() -> None:
    assert np.isnan(scene_words(ROW).degrees["facing"]).all()
    assert "facing" not in scene_words(ROW).of(0, 1)


def test_too_many_things_are_refused() -> None:
    with pytest.raises(LimitError, match="at most"):
        scene_words(np.repeat(ROW[:1], MAX_THINGS + 1, axis=0))
