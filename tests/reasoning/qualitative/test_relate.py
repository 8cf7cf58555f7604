"""Compare the atoms of boxes with QSRlib's answers and with each calculus's own laws."""

from __future__ import annotations

import ast
import csv
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from timing import processor_time_below

from deixis.errors import DeixisError, GraphError, UnknownTermError
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import SettingError, UnknownCalculusError
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.relate import RELATED, Related, relate, signs_of

CALCULI = [name for name in RELATED if name != "cardir"]
GOLD = {"ra": "ra", "rcc8": "rcc8", "cardir": "cardir"}


def boxes_of(*rows: tuple[tuple[float, ...], tuple[float, ...]]) -> NDArray[np.float64]:
    return np.array(rows, dtype=np.float64)


def sides(least: int, most: int) -> st.SearchStrategy[tuple[int, int]]:
    return st.tuples(st.integers(least, most), st.integers(1, 4)).map(lambda side: (side[0], side[0] + side[1]))


blocks = st.lists(st.tuples(sides(0, 5), sides(0, 5), sides(0, 3)), min_size=3, max_size=3).map(
    lambda things: np.array(things, dtype=np.float64).transpose(0, 2, 1)
)


@pytest.mark.parametrize("name", CALCULI)
@settings(max_examples=40, deadline=None)
@given(boxes=blocks)
def test_relations_of_boxes_obey_the_calculus(name: str, boxes: NDArray[np.float64]) -> None:
    """Check identity on the diagonal, converses across it, and the composition over a third box."""
    found, codes = calculus(name), relate(boxes, name, reference=2.0)
    for i, j, k in np.ndindex(3, 3, 3):
        assert found.converse(1 << int(codes[i, j])) == 1 << int(codes[j, i])
        assert found.compose(1 << int(codes[i, j]), 1 << int(codes[j, k])) >> int(codes[i, k]) & 1
        assert codes[i, i] == found.identity


@settings(max_examples=40, deadline=None)
@given(boxes=blocks)
def test_rectangles_and_blocks_agree_with_scenes(boxes: NDArray[np.float64]) -> None:
    seen = box_relations(boxes, default_ontology().relations)
    flat = box_relations(boxes[:, :, :2], default_ontology().relations)
    ra, ba = relate(boxes, "ra"), relate(boxes, "ba")
    for i, j in np.ndindex(3, 3):
        assert signs_of("ra")[ra[i, j]] == flat.atom(i, j)
        assert signs_of("ba")[ba[i, j]] == seen.atom(i, j)


@settings(max_examples=40, deadline=None)
@given(boxes=blocks)
def test_names_agree_with_scenes_where_the_plane_gives_one(boxes: NDArray[np.float64]) -> None:
    relations = default_ontology().relations
    seen = box_relations(boxes[:, :, :2], relations)
    codes = relate(boxes, "ten")
    for i, j in np.ndindex(3, 3):
        sign = signs_of("ten")[codes[i, j]]
        if i != j and sign != "overlap":
            assert sign == relations.members(1 << int(seen.names[i, j]))[0].word


@pytest.mark.parametrize(
    ("name", "options", "expected"),
    [
        ("point", {}, ("<", ">")),
        ("point", {"axis": "y"}, ("<", ">")),
        ("point", {"axis": "z"}, (">", "<")),
        ("allen", {}, ("<", ">")),
        ("allen", {"axis": "y"}, ("d", "di")),
        ("allen", {"axis": "z"}, ("mi", "m")),
        ("allen", {"tolerance": 0.031}, ("m", "mi")),
        ("ra", {}, ("<,d", ">,di")),
        ("ba", {}, ("<,d,mi", ">,di,m")),
        ("cd", {}, ("SW", "NE")),
        ("cd", {"tolerance": 0.02}, ("W", "E")),
        ("cardir", {}, ("w", "e")),
        ("rcc8", {}, ("DC", "DC")),
        ("rcc8", {"tolerance": 0.031}, ("EC", "EC")),
        ("ten", {}, ("left", "right")),
        ("distance", {"reference": 0.2}, ("near", "near")),
        ("distance", {"reference": 0.1}, ("medium", "medium")),
        ("distance", {"reference": 0.05}, ("far", "far")),
        ("direction-distance", {"reference": 0.1}, ("SW,medium", "NE,medium")),
        ("direction-distance", {"reference": 0.1, "tolerance": 0.02}, ("W,medium", "E,medium")),
    ],
)
def test_a_fork_on_a_cloth_and_a_plate_by_hand(
    name: str, options: dict[str, float | str], expected: tuple[str, str]
) -> None:
    """Take centres (0.01, 0.1) and (0.185, 0.115): 0.175 apart on x, 0.015 on y, 0.1756 in all."""
    boxes = boxes_of(((0.0, 0.0, 0.03), (0.02, 0.2, 0.05)), ((0.05, -0.02, 0.0), (0.32, 0.25, 0.03)))
    codes = relate(boxes, name, **options)  # type: ignore[arg-type]
    assert (signs_of(name)[codes[0, 1]], signs_of(name)[codes[1, 0]]) == expected


def test_a_distance_equal_to_a_bound_is_in_the_range_below() -> None:
    boxes = boxes_of(*(((x, 0.0), (x + 2.0, 2.0)) for x in (0.0, 1.0, 3.0, 3.5)))
    codes = relate(boxes, "distance", reference=1.0)
    assert [signs_of("distance")[code] for code in codes[0]] == ["same", "near", "medium", "far"]


@pytest.mark.skipif("DEIXIS_DATA" not in os.environ, reason="DEIXIS_DATA, the folder of reference data, is not set")
@pytest.mark.parametrize("name", GOLD)
def test_all_pairs_of_qsrlibs_gold_data_agree(name: str) -> None:
    folder = Path(os.environ["DEIXIS_DATA"]) / "qsrlib-gold"
    gold: dict[tuple[str, str, str], str] = {}
    for line in ast.literal_eval((folder / f"data1_{name}_defaults.txt").read_text()):
        moment, subject, object, answer = line.split(",", 3)
        gold[moment, subject, object] = ast.literal_eval(answer)[name]
    with (folder / "data1.csv").open() as file:
        rows = [{key: float(value) for key, value in row.items() if key[0] != "o"} for row in csv.DictReader(file)]
    assert (len(rows), len(gold)) == (49, 98)
    for number, row in enumerate(rows, 1):
        ends = [((row["x" + who], row["y" + who]), (row["w" + who] / 2, row["l" + who] / 2)) for who in "12"]
        boxes = boxes_of(*(((x - w, y - h), (x + w, y + h)) for (x, y), (w, h) in ends))
        codes = relate(boxes, name)
        found = [signs_of(name)[code].lower() for code in (codes[0, 1], codes[1, 0])]
        assert found == [gold[f"{number}.0", "o1", "o2"], gold[f"{number}.0", "o2", "o1"]], row


@pytest.mark.parametrize("name", RELATED)
def test_a_thousand_boxes_take_less_than_a_second(name: str) -> None:
    rng = np.random.default_rng(3)
    low = rng.uniform(0, 10, (1000, 3))
    boxes = np.stack([low, low + rng.uniform(0.1, 3, (1000, 3))], axis=1)
    relate(boxes[:2], name, reference=1.0)
    with processor_time_below(0.9):
        assert relate(boxes, name, reference=1.0).shape == (1000, 1000)


@pytest.mark.parametrize("name", RELATED)
def test_no_boxes_have_no_relations(name: str) -> None:
    assert relate(np.zeros((0, 2, 3)), name, reference=1.0).shape == (0, 0)


@pytest.mark.parametrize(
    ("name", "options", "kind", "message"),
    [
        ("rcc9", {}, UnknownCalculusError, "did you mean 'rcc8'"),
        ("zzz", {}, UnknownCalculusError, "there are point, allen"),
        ("ba", {}, GraphError, "no heights"),
        ("allen", {"axis": "z"}, GraphError, "no heights"),
        ("allen", {"axis": "w"}, SettingError, "x, y or z, got 'w'"),
        ("point", {"axis": "xy"}, SettingError, "x, y or z, got 'xy'"),
        ("ra", {"tolerance": -1.0}, SettingError, "tolerance"),
        ("ra", {"tolerance": float("nan")}, SettingError, "tolerance"),
        ("distance", {}, SettingError, "needs the length `reference`"),
        ("distance", {"reference": 0.0}, SettingError, "`reference` must be a length"),
        ("distance", {"reference": float("nan")}, SettingError, "`reference` must be a length"),
    ],
)
def test_invalid_arguments_are_refused(
    name: str, options: dict[str, float | str], kind: type[DeixisError], message: str
) -> None:
    with pytest.raises(kind, match=message):
        relate(np.zeros((2, 2, 2)), name, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("boxes", [np.zeros((2, 3)), np.zeros((2, 2, 4)), np.array([[[1.0, 0], [0, 1]]])])
def test_invalid_boxes_are_refused(boxes: NDArray[np.float64]) -> None:
    with pytest.raises(GraphError):
        relate(boxes, "ra")


def test_pairs_are_selected_by_name() -> None:
    boxes = boxes_of(((0, 0), (1, 1)), ((2, 0), (3, 1)), ((5, 0), (6, 1)))
    related = Related("allen", ("fork", "plate", "knife"), relate(boxes, "allen"))
    assert list(related.pairs("fork")) == [("fork", "<", "plate"), ("fork", "<", "knife")]
    assert list(related.pairs("knife", "plate")) == [("knife", ">", "plate")]
    assert len(list(related.pairs())) == 6
    with pytest.raises(UnknownTermError, match="did you mean 'fork'"):
        list(related.pairs("frok"))
