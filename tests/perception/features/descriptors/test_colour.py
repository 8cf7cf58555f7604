"""The colour descriptor: it holds a histogram that shade and exposure hardly change."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.features.descriptors.colour import ColourDescriber

RED, BLUE, GREY = (190, 40, 40), (40, 70, 180), (128, 128, 128)
CHANNEL = st.integers(0, 255)


def described(colours: object) -> NDArray[np.float32]:
    rgb = np.atleast_2d(np.array(colours, np.uint8))
    return ColourDescriber().describe(PointCloud(np.zeros((len(rgb), 3), np.float32), rgb))


def apart(one: object, other: object) -> float:
    return float(np.linalg.norm(described(one) - described(other)))


@given(st.lists(st.tuples(CHANNEL, CHANNEL, CHANNEL), min_size=1, max_size=20))
def test_a_histogram_sums_to_one(colours: list[tuple[int, int, int]]) -> None:
    found = described(colours)
    assert found.shape == (1, ColourDescriber().size)
    assert float((found**2).sum()) == pytest.approx(1.0, abs=1e-5)


@given(st.lists(st.tuples(CHANNEL, CHANNEL, CHANNEL), min_size=2, max_size=20))
def test_the_order_of_points_does_not_matter(colours: list[tuple[int, int, int]]) -> None:
    assert apart(colours, colours[::-1]) < 1e-3


def test_shade_matters_far_less_than_hue() -> None:
    dim = tuple(part // 2 for part in RED)
    assert apart(RED, dim) < 0.3
    assert apart(RED, BLUE) == pytest.approx(np.sqrt(2.0), abs=1e-3)  # no cell in common
    assert apart(GREY, (230, 230, 230)) < 1e-3


def test_half_red_lies_between_red_and_grey() -> None:
    half = [RED, GREY]
    assert apart(half, RED) == pytest.approx(apart(half, GREY), abs=1e-3)
    assert apart(half, RED) < apart(RED, GREY)


def test_points_without_depth_are_ignored() -> None:
    points = np.array([[0, 0, 0], [np.nan, 0, 0]], np.float32)
    found = ColourDescriber().describe(PointCloud(points, np.array([RED, BLUE], np.uint8)))
    np.testing.assert_array_equal(found, described(RED))


def test_no_colours_or_points_give_no_descriptor() -> None:
    assert ColourDescriber().describe(PointCloud(np.zeros((3, 3), np.float32))).shape == (0, 64)
    empty = PointCloud(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint8))
    assert ColourDescriber().describe(empty).shape == (0, 64)
