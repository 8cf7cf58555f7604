"""Test the joining of parts of things whose middle is hidden."""

from __future__ import annotations

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.occlusion import joined_behind_others
from deixis.perception.scene import PerceivedObject, Scene

EYE = (0.0, -0.6, 0.7)


def block(name: str, low: tuple[float, float, float], high: tuple[float, float, float]) -> PerceivedObject:
    """Return a thing with a grid of points in its box."""
    axes = [np.linspace(a, b, 6) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3).astype(np.float32)
    return PerceivedObject(name, low, high, cloud=PointCloud(points, origin=EYE))


LEFT, RIGHT = block("o1", (-0.09, 0.2, 0.0), (-0.035, 0.22, 0.01)), block("o2", (0.035, 0.2, 0.0), (0.08, 0.22, 0.01))
GLASS = block("o3", (-0.04, 0.0, 0.0), (0.04, 0.08, 0.16))


def test_spoon_behind_a_glass_is_one_thing() -> None:
    scene = joined_behind_others(Scene((LEFT, RIGHT, GLASS)))
    assert scene.ids == ("o1", "o3")
    assert scene["o1"].maximum[0] == 0.08
    assert len(scene.cloud_of("o1")) == 432


def test_things_with_a_visible_gap_stay_apart() -> None:
    scene = Scene((LEFT, RIGHT))
    assert joined_behind_others(scene) is scene


def test_parallel_things_behind_a_glass_stay_apart() -> None:
    beside = block("o2", (0.035, 0.26, 0.0), (0.08, 0.28, 0.01))
    assert len(joined_behind_others(Scene((LEFT, beside, GLASS))).objects) == 3


def test_floating_bowl_of_a_glass_joins_its_foot() -> None:
    foot = block("o4", (0.3, 0.0, 0.0), (0.36, 0.06, 0.006))
    bowl = block("o5", (0.3, 0.0, 0.13), (0.36, 0.06, 0.19))
    assert len(joined_behind_others(Scene((foot, bowl))).objects) == 1


def test_thing_that_rests_on_another_stays_apart() -> None:
    saucer = block("o4", (0.3, 0.0, 0.0), (0.45, 0.15, 0.02))
    cup = block("o5", (0.33, 0.03, 0.02), (0.41, 0.11, 0.09))
    assert len(joined_behind_others(Scene((saucer, cup))).objects) == 2
