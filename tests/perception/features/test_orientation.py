"""Orientation measured in simulated clouds: heads and handles, which turn with their things."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.orientation import MIN_PROBABILITY, Orientation, orientation, with_headings
from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.simulator.cameras.views import views_of
from deixis.perception.simulator.meshes.tableware import make


def cloud(kind: str, seed: int = 3) -> PointCloud:
    return views_of(make(kind, seed=seed).mesh, count=1, seed=seed, upright=True)[0]


@pytest.mark.parametrize(
    ("kind", "part"), [("fork", "head"), ("knife", "head"), ("spoon", "head"), ("mug", "handle"), ("cup", "handle")]
)
def test_front_is_the_head_or_the_handle(kind: str, part: str) -> None:
    found = orientation(cloud(kind).points)
    assert found.part == part and found.confidence > MIN_PROBABILITY
    assert found.front is not None and found.front[1] > math.cos(math.radians(20))


@pytest.mark.parametrize("kind", ["plate", "bowl", "water glass", "bottle"])
def test_round_things_without_a_handle_have_no_front(kind: str) -> None:
    assert orientation(cloud(kind).points) == Orientation()


@pytest.mark.parametrize("kind", ["fork", "mug"])
@pytest.mark.parametrize("degrees", [40, 135, 250])
def test_front_turns_with_the_thing(kind: str, degrees: int) -> None:
    points, angle = cloud(kind).points, math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    turned = points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    before, after = orientation(points).front, orientation(turned).front
    assert before is not None and after is not None
    x, y = before
    assert after == pytest.approx((cosine * x - sine * y, sine * x + cosine * y), abs=0.2)


def test_few_points_have_no_orientation() -> None:
    assert orientation(np.zeros((0, 3))) == Orientation()
    assert orientation(np.random.default_rng(0).normal(size=(10, 3))) == Orientation()


def test_scene_gets_the_headings_of_its_clouds() -> None:
    things = tuple(
        PerceivedObject(kind, (0.0, 0.0, 0.0), (0.2, 0.2, 0.1), cloud=cloud(kind)) for kind in ("knife", "plate")
    )
    knife, plate = with_headings(Scene(things)).objects
    assert knife.heading is not None and knife.heading.part == "head"
    assert plate.heading is None
    assert with_headings(Scene(things, frame="object")).objects == things
