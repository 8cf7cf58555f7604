"""Outline of the table in plan."""

import numpy as np

from deixis.perception.tracking.table.outline import Outline


def test_outline_grows_and_knows_what_is_beyond() -> None:
    outline = Outline()
    assert not outline.beyond(np.array([[5.0, 5.0]])).any(), "nothing is known yet"
    square = np.array([(x, y) for x in np.linspace(0, 1, 9) for y in np.linspace(0, 1, 9)])
    outline.extend(square)
    assert outline.beyond(np.array([[0.5, 0.5], [1.02, 0.5], [1.2, 0.5]])).tolist() == [False, False, True]
    outline.extend(square + np.array([0.5, 0.0]))
    assert not outline.beyond(np.array([[1.2, 0.5]])).any()
    assert outline.is_crossed_by(np.array([(x, 0.5, 0.1) for x in np.linspace(1, 2, 40)]))
