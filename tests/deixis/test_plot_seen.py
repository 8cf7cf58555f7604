"""What the pictures of perceived and recognised things show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from deixis import plot_seen
from deixis.grammar.parser import parse_script
from deixis.laying import lay_script
from deixis.perceiving import Perceived, in_frame, perceive
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.recognising import Recognised
from deixis.simulation import simulate


def table_before_a_wall() -> tuple[Perceived, int]:
    """A simulated plate on a table, and behind the points of these those of a wall; how many are not the wall's."""
    cloud = simulate(lay_script(parse_script("plate on table"), seed=1), seed=1).cloud
    cloud = cloud.take(cloud.finite)
    across, up = (axis.ravel() for axis in np.mgrid[-1:1:0.05, -0.5:0.5:0.05])
    wall = np.stack([across, up, np.full(across.shape, 4.0)], axis=1)
    return perceive(PointCloud(np.concatenate([cloud.points, wall]).astype(np.float32))), len(cloud)


def test_what_is_far_from_the_table_is_not_drawn() -> None:
    found, near = table_before_a_wall()
    points = in_frame(found.cloud, found.detection.frame).points
    shown = plot_seen._worth_showing(points, found)
    assert len(found.scene.objects) == 1
    assert shown[:near].mean() > 0.99
    assert not shown[near:].any()


def test_everything_is_drawn_where_there_is_no_table() -> None:
    found = perceive(PointCloud(np.array([[0.0, 0.0, 1.0], [9.0, 9.0, 9.0]], np.float32)))
    assert found.detection.table is None
    assert plot_seen._worth_showing(found.cloud.points, found).tolist() == [True, True]


def test_a_recognised_thing_is_named_with_its_id(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    things = (PerceivedObject("o1", (0, 0, 0), (1, 1, 1), label="cup"), PerceivedObject("o2", (2, 0, 0), (3, 1, 1)))
    written: list[str | None] = []
    monkeypatch.setattr(plot_seen, "write_names", lambda _f, _a, named: written.extend(one.label for one in named))
    plot_seen.plot_recognised(Recognised(Scene(things), {}), tmp_path / "seen.png")
    assert written == ["o1 cup", "o2 unknown"]
