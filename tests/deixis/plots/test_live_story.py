"""Names of things in the pictures of a live run."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from deixis.plots import live_story
from deixis.robot.live.moments import Moment


def test_names_of_crowded_things_share_no_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn: list[Figure] = []
    monkeypatch.setattr(live_story, "_save", lambda figure, path: drawn.append(figure))
    owner = np.full((120, 160), -1)
    for number in range(8):
        owner[40:60, 10 + 12 * number : 20 + 12 * number] = number
    view = tmp_path / "view.npz"
    ids = np.array([f"t{number}" for number in range(8)])
    np.savez(view, image=np.full((480, 640, 3), 120, np.uint8), owner=owner, ids=ids)
    things = {str(id): "vegetable serving fork" for id in ids}
    moment = Moment(1.0, view, things, frozenset(), frozenset(), (), None, ())
    live_story.write_moments([moment], tmp_path / "story.png")
    (axes,) = drawn[0].axes
    boxes = [text.get_window_extent() for text in axes.texts]
    assert len(boxes) == 8
    assert not any(box.overlaps(other) for box, other in combinations(boxes, 2))
