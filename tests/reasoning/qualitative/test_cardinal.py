"""Test the eight cones of direction between centres."""

from __future__ import annotations

import ast
import csv
import math
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.qualitative.relate import CARDINAL_DIRECTIONS, SAME_PLACE, cardinal_directions

OPPOSITE = dict(zip(CARDINAL_DIRECTIONS, CARDINAL_DIRECTIONS[4:] + CARDINAL_DIRECTIONS[:4], strict=True)) | {
    SAME_PLACE: SAME_PLACE
}


def squares(*centres: tuple[float, float], half: float = 1.0) -> NDArray[np.float64]:
    return np.array([[[x - half, y - half], [x + half, y + half]] for x, y in centres])


def direction(east: float, north: float) -> str:
    """Return the direction of the first square from the second, by its offset east and north."""
    return str(cardinal_directions(squares((east, north), (0, 0)))[0, 1])


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=2, max_size=6))
def test_the_converse_is_the_opposite_direction(centres: list[tuple[int, int]]) -> None:
    """Use whole offsets, which never lie on the border of two cones, whose tangent is irrational."""
    found = cardinal_directions(squares(*centres)).tolist()
    for i in range(len(centres)):
        for j in range(len(centres)):
            assert found[i][j] == OPPOSITE[found[j][i]]


@settings(max_examples=80, deadline=None)
@given(st.integers(-20, 20), st.integers(-20, 20))
def test_the_cone_with_the_nearest_axis_is_chosen(east: int, north: int) -> None:
    if east == north == 0:
        assert direction(0, 0) == "eq"
        return
    axes = {name: (math.sin(i * math.pi / 4), math.cos(i * math.pi / 4)) for i, name in enumerate(CARDINAL_DIRECTIONS)}
    assert direction(east, north) == max(axes, key=lambda name: east * axes[name][0] + north * axes[name][1])


@pytest.mark.parametrize(
    ("east", "north", "name"),
    [(0, 1, "n"), (1, 1, "ne"), (1, 0, "e"), (1, -1, "se"), (0, -1, "s"), (-1, -1, "sw"), (-1, 0, "w"), (-1, 1, "nw")],
)
def test_the_eight_directions_match_a_map(east: float, north: float, name: str) -> None:
    assert direction(east, north) == name


@pytest.mark.parametrize(
    ("x", "y", "there", "back"),
    [
        (2, 2, "ne", "sw"),  # (5, 5) lies 3 east and 3 north
        (2, 4, "e", "w"),  # 3 east, 1 north: 18 degrees off east, the cone ends at 22.5
        (3, 6, "se", "nw"),  # 2 east, 1 south: 26.6 degrees off east
        (4, 2, "n", "s"),  # 1 east, 3 north: 18 degrees off north
        (4, 3, "ne", "sw"),  # 1 east, 2 north: 26.6 degrees off north
        (5, 5, "eq", "eq"),
        (6, 8, "s", "n"),  # 1 west, 3 south
        (8, 6, "w", "e"),  # 3 west, 1 south
        (7, 3, "nw", "se"),  # 2 west, 2 north
    ],
)
def test_pairs_of_qsrlibs_tests_match_hand_results(x: float, y: float, there: str, back: str) -> None:
    found = cardinal_directions(squares((5, 5), (x, y)))
    assert (found[0, 1], found[1, 0]) == (there, back)


def test_the_size_of_a_box_does_not_matter() -> None:
    boxes = np.concatenate([squares((5, 5), half=4), squares((2, 2), half=0.5)])
    assert cardinal_directions(boxes).tolist() == [["eq", "ne"], ["sw", "eq"]]


def test_heights_do_not_matter() -> None:
    boxes = np.array([[[0, 2, 9.0], [1, 3, 10]], [[0, 0, 0], [1, 1, 1]]])
    assert cardinal_directions(boxes).tolist() == [["eq", "n"], ["s", "eq"]]


def test_no_boxes_have_no_directions() -> None:
    assert cardinal_directions(np.zeros((0, 2, 2))).shape == (0, 0)


@pytest.mark.skipif("DEIXIS_DATA" not in os.environ, reason="DEIXIS_DATA, the folder of reference data, is not set")
def test_all_pairs_of_qsrlibs_gold_data_agree() -> None:
    folder = Path(os.environ["DEIXIS_DATA"]) / "qsrlib-gold"
    gold: dict[tuple[str, str], str] = {}
    for line in ast.literal_eval((folder / "data1_cardir_defaults.txt").read_text()):
        time, subject, _, answer = line.split(",", 3)
        gold[time, subject] = ast.literal_eval(answer)["cardir"]
    with (folder / "data1.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert (len(rows), len(gold)) == (49, 98)
    for number, row in enumerate(rows):
        found = cardinal_directions(squares(*((float(row["x" + who]), float(row["y" + who])) for who in "12")))
        time = f"{number + 1}.0"
        assert (found[0, 1], found[1, 0]) == (gold[time, "o1"], gold[time, "o2"]), row
