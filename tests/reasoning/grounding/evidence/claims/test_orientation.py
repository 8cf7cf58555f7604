"""Facing, pointing, opposite and the frames of *in front of*."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import deixis
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import Heading
from deixis.reasoning.grounding.answers.answer import Outcome
from deixis.reasoning.grounding.reference.answer import Frame
from deixis.testing import assert_grounds

AROUND = [[0.0, 0.0, 0.5], [0.0, 1.2, 0.5], [0.0, -1.2, 0.5], [1.2, 0.0, 0.5]]


def scene(front: tuple[float, float] | None) -> deixis.Scene:
    """Return a chair with a lamp behind, in front of and to the right of it, as the viewer sees them."""
    names = ["chair", "far", "near", "side"]
    bare = deixis.Scene.from_boxes(centre=AROUND, size=[[0.5] * 3] * 4, ids=names, labels=["chair", *["lamp"] * 3])
    return replace(bare, objects=(replace(bare.objects[0], front=front), *bare.objects[1:]))


def test_in_front_is_taken_by_the_front_of_the_thing() -> None:
    found = assert_grounds("lamp in front of chair", scene((0.0, 1.0)), {"lamp": "far"})
    assert found.frames[0].frame is Frame.OBJECT
    assert found.outcomes[0].outcome is Outcome.SATISFIED


def test_in_front_is_the_viewers_without_a_front() -> None:
    found = assert_grounds("lamp in front of chair", scene(None), {"lamp": "near"})
    assert found.frames[0].frame is Frame.VIEWER


@pytest.mark.parametrize(("front", "lamp"), [((0.0, 1.0), "far"), ((1.0, 0.0), "side"), ((0.0, -2.0), "near")])
def test_a_front_tells_what_a_thing_faces(front: tuple[float, float], lamp: str) -> None:
    assert_grounds("chair facing lamp", scene(front), {"lamp": lamp})


def test_without_a_front_facing_says_nothing() -> None:
    found = assert_grounds("chair facing lamp", scene(None), {"chair": "chair"})
    shares = [found.matches["lamp"].probability, *(one.probability for one in found.matches["lamp"].alternatives)]
    assert np.ptp([share for share in shares if share and share > 0.05]) == pytest.approx(0.0, abs=1e-6)
    assert found.violated == ()


def test_a_long_thing_points_along_its_axis() -> None:
    knife = deixis.Scene.from_boxes(
        centre=[[0.0, 0.0, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0]],
        size=[[0.2, 0.02, 0.01], [0.1, 0.1, 0.1], [0.1, 0.1, 0.1]],
        yaw=[math.pi / 4, 0.0, 0.0],
        ids=["knife", "right", "left"],
        labels=["knife", "cup", "cup"],
    )
    assert isinstance(knife.objects[0].oriented, OrientedBox)
    assert_grounds("knife pointing to cup", knife, {"cup": "right"})


def cutlery(*heads: tuple[float, float] | None) -> deixis.Scene:
    """Return knives in a row, with the directions of their heads."""
    count = len(heads)
    names = [f"k{number}" for number in range(1, count + 1)]
    bare = deixis.Scene.from_boxes(
        centre=[[0.1 * i, 0.0, 0.0] for i in range(count)],
        size=[[0.02, 0.2, 0.01]] * count,
        ids=names,
        labels=["knife"] * count,
    )
    known = [None if way is None else Heading("head", way, 0.99) for way in heads]
    return replace(bare, objects=tuple(replace(t, heading=h) for t, h in zip(bare.objects, known, strict=True)))


@pytest.mark.parametrize(
    ("text", "knife"),
    [("knife pointing away", "k1"), ("knife with its handle away", "k2"), ("knife not pointing away", "k2")],
)
def test_claim_of_direction_picks_the_thing_that_points_there(text: str, knife: str) -> None:
    found = assert_grounds(text, cutlery((0.0, 1.0), (0.0, -1.0)), {"knife": knife})
    assert (found.matches["knife"].probability or 0) > 0.85


def test_claim_of_direction_is_neutral_without_headings() -> None:
    (match,) = assert_grounds("knife pointing away", cutlery(None, None), {}).matches.values()
    assert match.probability == pytest.approx(0.5, abs=0.02)


def test_head_decides_which_thing_a_knife_points_at() -> None:
    knife = cutlery((-1.0, 0.0), None, None)
    left = replace(knife.objects[2], minimum=(-0.35, -0.05, 0.0), maximum=(-0.25, 0.05, 0.1), label="cup")
    right = replace(knife.objects[1], minimum=(0.25, -0.05, 0.0), maximum=(0.35, 0.05, 0.1), label="cup")
    seen = replace(knife, objects=(knife.objects[0], left, right))
    assert_grounds("knife pointing to cup", seen, {"cup": "k3"})
