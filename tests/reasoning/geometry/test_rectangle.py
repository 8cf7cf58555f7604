"""Atoms and exact relations of boxes: laws, values worked out by hand, and agreement with QSRlib's own tests."""

from __future__ import annotations

import ast
import csv
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.errors import GraphError
from deixis.ontology.relations.relation import Reading, Relations
from deixis.reasoning.geometry.rectangle import box_relations, scene_relations

Boxes = NDArray[np.float64]
MakeBoxes = Callable[..., Boxes]

MIRRORED = {
    "left": "right",
    "right": "left",
    "top_left": "top_right",
    "top_right": "top_left",
    "bottom_left": "bottom_right",
    "bottom_right": "bottom_left",
}


def names(boxes: Boxes, relations: Relations) -> list[list[str]]:
    table = box_relations(boxes, relations).names
    return [[relations.members(1 << int(code))[0].word if code >= 0 else "" for code in row] for row in table]


def name(boxes: Boxes, relations: Relations) -> str:
    return names(boxes, relations)[0][1]


def overlap(a: Boxes, b: Boxes) -> bool:
    """Return whether the boxes share more than an edge in the plane."""
    return bool(((a[0] < b[1]) & (b[0] < a[1]))[:2].all())


def reference(a: Boxes, b: Boxes, a_is_later: bool) -> str:
    """Return the exact relation of a to b, neither a point nor a line, by the rules in plain words."""
    if overlap(a, b):
        if len(a[0]) == 3 and (a[0, 2] != b[0, 2] or a[1, 2] != b[1, 2]):
            over = a[0, 2] >= b[1, 2] or (a[0, 2] > b[0, 2] and a[1, 2] > b[1, 2])
            below = b[0, 2] >= a[1, 2] or (a[0, 2] < b[0, 2] and a[1, 2] < b[1, 2])
            if over or below:
                return "on" if over else "under"
        within = bool((a[0] >= b[0])[:2].all() and (a[1] <= b[1])[:2].all())
        around = bool((b[0] >= a[0])[:2].all() and (b[1] <= a[1])[:2].all())
        if within != around:
            return "on" if within else "under"
        dx, dy = (a.sum(axis=0) - b.sum(axis=0))[:2]
        if dx == dy == 0:
            return "on" if a_is_later else "under"
        if abs(dx) >= abs(dy):
            return "left" if dx < 0 else "right"
        return "bottom" if dy < 0 else "top"
    across = "left" if a[1, 0] <= b[0, 0] else "right" if a[0, 0] >= b[1, 0] else ""
    along = "top" if a[0, 1] >= b[1, 1] else "bottom" if a[1, 1] <= b[0, 1] else ""
    return "_".join(part for part in (along, across) if part)


@pytest.mark.parametrize("axes", [2, 3])
@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_every_pair_has_the_relation_of_the_reference(
    data: st.DataObject, axes: int, random_boxes: MakeBoxes, relations: Relations
) -> None:
    boxes = random_boxes(data, axes=axes, shortest=1)
    found = names(boxes, relations)
    for i, a in enumerate(boxes):
        for j, b in enumerate(boxes):
            assert found[i][j] == ("" if i == j else reference(a, b, i > j))


@pytest.mark.parametrize("axes", [2, 3])
@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_one_exact_relation_holds_and_its_inverse_in_reverse(
    data: st.DataObject, axes: int, random_boxes: MakeBoxes, relations: Relations
) -> None:
    """Include points, lines, ties and equal boxes."""
    boxes = random_boxes(data, axes=axes)
    table = box_relations(boxes, relations).names
    exact = {r.index: r for r in relations.of_reading(Reading.EXACT)}
    for i in range(len(boxes)):
        assert table[i, i] == -1
        for j in range(i):
            assert exact[int(table[i, j])].inverse == exact[int(table[j, i])].name


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_the_atoms_of_reversed_pairs_are_the_converses(
    data: st.DataObject, random_boxes: MakeBoxes, relations: Relations
) -> None:
    related = box_relations(random_boxes(data, axes=3), relations)
    for codes in (related.x, related.y, related.z):
        assert codes is not None
        np.testing.assert_array_equal(codes.T, 12 - codes)


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_only_one_exact_relation_admits_an_atom_of_unequal_boxes(
    data: st.DataObject, random_boxes: MakeBoxes, relations: Relations
) -> None:
    """Check that a planar atom that one exact relation admits gives that relation."""
    related = box_relations(random_boxes(data), relations)
    for i, j in zip(*np.nonzero(related.names >= 0), strict=True):
        fitting = [r for r in relations.of_reading(Reading.EXACT) if r.admits()[related.x[i, j], related.y[i, j]]]
        if len(fitting) == 1:
            assert fitting[0].index == related.names[i, j]
        else:
            assert len(fitting) == (2 if related.atom(int(i), int(j)) == "=,=" else 0)


@pytest.mark.parametrize("axes", [2, 3])
@settings(max_examples=60, deadline=None)
@given(data=st.data(), by=st.tuples(*[st.integers(-50, 50)] * 3), scale=st.sampled_from([0.25, 3.0, 1024.0]))
def test_moving_and_scaling_changes_no_relation(
    data: st.DataObject,
    axes: int,
    by: tuple[int, int, int],
    scale: float,
    random_boxes: MakeBoxes,
    relations: Relations,
) -> None:
    boxes = random_boxes(data, axes=axes)
    before, after = (box_relations(b, relations) for b in (boxes, (boxes + np.array(by[:axes])) * scale))
    np.testing.assert_array_equal(before.names, after.names)
    np.testing.assert_array_equal(before.x, after.x)
    np.testing.assert_array_equal(before.y, after.y)


@pytest.mark.parametrize("axes", [2, 3])
@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_mirroring_only_exchanges_left_and_right(
    data: st.DataObject, axes: int, random_boxes: MakeBoxes, relations: Relations
) -> None:
    boxes = random_boxes(data, axes=axes)
    mirrored = boxes.copy()
    mirrored[:, 0, 0], mirrored[:, 1, 0] = -boxes[:, 1, 0], -boxes[:, 0, 0]
    expected = [[MIRRORED.get(word, word) for word in row] for row in names(boxes, relations)]
    assert names(mirrored, relations) == expected


@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_transposing_the_table_exchanges_the_axes(
    data: st.DataObject, random_boxes: MakeBoxes, relations: Relations
) -> None:
    boxes = random_boxes(data, least=2, most=2, shortest=1)
    dx, dy = np.abs(np.diff(boxes.sum(axis=1), axis=0)[0])
    assume(dx != dy)
    turned = {"left": "bottom", "bottom": "left", "right": "top", "top": "right"}
    turned |= {"top_left": "bottom_right", "bottom_right": "top_left"}
    word = name(boxes, relations)
    assert name(boxes[:, :, ::-1], relations) == turned.get(word, word)


@pytest.mark.parametrize("axes", [2, 3])
@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_order_of_listing_matters_only_for_equal_centres(
    data: st.DataObject, axes: int, random_boxes: MakeBoxes, relations: Relations
) -> None:
    boxes = random_boxes(data, axes=axes, shortest=1)
    centres = boxes.sum(axis=1)[:, :2]
    assume(len(np.unique(centres, axis=0)) == len(boxes))
    order = data.draw(st.permutations(range(len(boxes))))
    before = box_relations(boxes, relations).names
    np.testing.assert_array_equal(box_relations(boxes[order], relations).names, before[np.ix_(order, order)])


@pytest.mark.parametrize(
    ("a", "b", "atom", "word"),
    [
        ([(0, 1), (0, 1)], [(2, 3), (0, 1)], "<,=", "left"),
        ([(0, 1), (0, 1)], [(1, 2), (1, 2)], "m,m", "bottom_left"),
        ([(0, 1), (4, 5)], [(2, 3), (0, 1)], "<,>", "top_left"),
        ([(0, 4), (4, 5)], [(2, 6), (0, 1)], "o,>", "top"),
        ([(1, 2), (1, 2)], [(0, 3), (0, 3)], "d,d", "on"),
        ([(0, 3), (0, 3)], [(0, 2), (1, 3)], "si,fi", "under"),
        ([(0, 4), (0, 4)], [(3, 7), (1, 5)], "o,o", "left"),
        ([(0, 4), (0, 4)], [(1, 5), (3, 7)], "o,o", "bottom"),
        ([(0, 4), (0, 4)], [(2, 6), (2, 6)], "o,o", "left"),
        ([(2, 6), (0, 4)], [(0, 4), (2, 6)], "oi,o", "right"),
        ([(0, 4), (0, 6)], [(1, 2), (2, 9)], "di,o", "bottom"),
        ([(1, 1), (2, 2)], [(0, 3), (0, 3)], "d,d", "on"),
        ([(0, 0), (2, 2)], [(0, 3), (0, 3)], "m,d", "left"),
        ([(1, 1), (0, 3)], [(1, 1), (4, 5)], "=,<", "bottom"),
    ],
)
def test_atoms_and_relations_worked_out_by_hand(
    a: list[tuple[float, float]],
    b: list[tuple[float, float]],
    atom: str,
    word: str,
    boxes_of: MakeBoxes,
    relations: Relations,
) -> None:
    boxes = boxes_of(a, b)
    assert (box_relations(boxes, relations).atom(0, 1), name(boxes, relations)) == (atom, word)


PLATE, MAT = [(2.0, 8.0), (2.0, 8.0)], [(0.0, 10.0), (0.0, 10.0)]


@pytest.mark.parametrize(
    ("plate_z", "mat_z", "word"),
    [
        ((1.0, 2.0), (0.0, 1.0), "on"),
        ((5.0, 6.0), (0.0, 1.0), "on"),
        ((0.5, 2.0), (0.0, 1.0), "on"),
        ((0.0, 1.0), (1.0, 2.0), "under"),
        ((0.0, 1.0), (5.0, 6.0), "under"),
        ((0.0, 1.0), (0.0, 1.0), "on"),
        ((0.0, 2.0), (0.0, 1.0), "on"),
    ],
)
def test_heights_decide_on_or_else_the_outline(
    plate_z: tuple[float, float], mat_z: tuple[float, float], word: str, boxes_of: MakeBoxes, relations: Relations
) -> None:
    assert name(boxes_of([*PLATE, plate_z], [*MAT, mat_z]), relations) == word


def test_known_heights_put_an_overhanging_plate_on_its_mat(boxes_of: MakeBoxes, relations: Relations) -> None:
    plate, mat = [(8.0, 14.0), (2.0, 8.0)], MAT
    assert name(boxes_of(plate, mat), relations) == "right"
    assert name(boxes_of([*plate, (1.0, 2.0)], [*mat, (0.0, 1.0)]), relations) == "on"
    assert name(boxes_of([*mat, (0.0, 1.0)], [*plate, (1.0, 2.0)]), relations) == "under"


def test_heights_do_not_matter_for_boxes_side_by_side(boxes_of: MakeBoxes, relations: Relations) -> None:
    low, high = [(0.0, 1.0), (0.0, 1.0), (0.0, 1.0)], [(1.0, 2.0), (0.0, 1.0), (5.0, 6.0)]
    assert name(boxes_of(low, high), relations) == "left"


def test_of_two_equal_boxes_the_later_lies_on_the_earlier(boxes_of: MakeBoxes, relations: Relations) -> None:
    twice = boxes_of(PLATE, PLATE)
    assert names(twice, relations) == [["", "under"], ["on", ""]]
    crossing = boxes_of([(0, 10), (4, 6)], [(4, 6), (0, 10)])
    assert names(crossing, relations) == [["", "under"], ["on", ""]]
    assert names(crossing[::-1], relations) == [["", "under"], ["on", ""]]


def test_an_overlap_within_the_tolerance_counts_as_meeting(boxes_of: MakeBoxes, relations: Relations) -> None:
    boxes = boxes_of([(0, 1.001), (0, 4)], [(1, 5), (1, 3)])
    assert box_relations(boxes, relations).atom(0, 1) == "o,di"
    assert box_relations(boxes, relations, tolerance=0.01).atom(0, 1) == "m,di"


def test_an_atom_has_a_third_symbol_if_heights_are_known(boxes_of: MakeBoxes, relations: Relations) -> None:
    boxes = boxes_of([*PLATE, (1.0, 2.0)], [*MAT, (0.0, 1.0)])
    assert box_relations(boxes, relations).atom(0, 1) == "d,d,mi"


def test_a_thousand_objects_are_related(relations: Relations) -> None:
    low = np.random.default_rng(1).uniform(0, 10, (1000, 2))
    boxes = np.stack([low, low + 0.3], axis=1)
    related = box_relations(boxes, relations)
    assert related.names.shape == related.x.shape == related.y.shape == (1000, 1000)
    assert related.z is None
    assert (related.names >= 0).sum() == 999_000


@pytest.mark.parametrize("n", [0, 1])
@pytest.mark.parametrize("axes", [2, 3])
def test_no_object_and_one_object_have_no_relations(n: int, axes: int, relations: Relations) -> None:
    assert box_relations(np.zeros((n, 2, axes)), relations).names.tolist() == [[-1]] * n
    assert len(scene_relations(["a"][:n], np.zeros((n, 2, axes)), relations).graph()) == 0


@pytest.mark.parametrize(
    ("boxes", "message"),
    [
        (np.zeros((2, 4)), r"must have shape .* got \(2, 4\)"),
        (np.zeros((2, 2, 4)), r"got \(2, 2, 4\)"),
        (np.zeros((2, 3, 2)), r"got \(2, 3, 2\)"),
        (np.array([[[0.0, 0], [1, 1]], [[0, 0], [np.nan, 1]]]), "the corners of box 1 must be finite, got"),
        (np.array([[[-np.inf, 0], [1, 1]]]), "the corners of box 0 must be finite, got"),
        (np.array([[[0.0, 0], [1, 1]], [[0, 2], [1, 1]]]), "the lower corner of box 1 must not be above the upper one"),
    ],
)
def test_invalid_boxes_are_graph_errors(boxes: Boxes, message: str, relations: Relations) -> None:
    with pytest.raises(GraphError, match=message):
        box_relations(boxes, relations)


def test_a_scene_graph_has_one_exact_edge_per_ordered_pair(boxes_of: MakeBoxes, relations: Relations) -> None:
    boxes = boxes_of(MAT, PLATE, [(12, 13), (0, 9)])
    graph = scene_relations(["mat", "plate", "knife"], boxes, relations).graph()
    assert sorted(map(str, graph.facts())) == [
        "exactly_left(mat, knife)",
        "exactly_left(plate, knife)",
        "exactly_on(plate, mat)",
        "exactly_right(knife, mat)",
        "exactly_right(knife, plate)",
        "exactly_under(mat, plate)",
    ]
    assert graph.boxes is boxes


def centred(x: float, y: float, width: float, length: float) -> list[tuple[float, float]]:
    return [(x - width / 2, x + width / 2), (y - length / 2, y + length / 2)]


@pytest.mark.parametrize(
    ("x", "y", "there", "back"),
    [
        (2, 2, ">,>", "<,<"),  # 4..6 after 1..3 on both axes
        (2, 3, ">,mi", "<,m"),  # on y 4..6 is met by 2..4
        (2, 5, ">,=", "<,="),
        (3, 6, "mi,o", "m,oi"),  # on x 4..6 is met by 2..4, on y it overlaps 5..7
        (4, 4, "oi,oi", "o,o"),
        (5, 5, "=,=", "=,="),
        (6, 7, "o,m", "oi,mi"),
        (7, 2, "m,>", "mi,<"),
        (8, 8, "<,<", ">,>"),
    ],
)
def test_pairs_of_qsrlib_tests_worked_out_by_hand(
    x: float, y: float, there: str, back: str, boxes_of: MakeBoxes, relations: Relations
) -> None:
    """Relate a square of side 2 centred on (5, 5), so from 4 to 6 on both axes, to one centred on (x, y)."""
    related = box_relations(boxes_of(centred(5, 5, 2, 2), centred(x, y, 2, 2)), relations)
    assert (related.atom(0, 1), related.atom(1, 0)) == (there, back)


@pytest.mark.skipif("DEIXIS_DATA" not in os.environ, reason="DEIXIS_DATA, the folder of reference data, is not set")
def test_pairs_of_qsrlib_gold_data_have_its_atoms(boxes_of: MakeBoxes, relations: Relations) -> None:
    folder = Path(os.environ["DEIXIS_DATA"]) / "qsrlib-gold"
    gold: dict[tuple[str, str, str], str] = {}
    for line in ast.literal_eval((folder / "data1_ra_defaults.txt").read_text()):
        time, subject, object, answer = line.split(",", 3)
        gold[time, subject, object] = ast.literal_eval(answer)["ra"]
    with (folder / "data1.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 49
    assert len(gold) == 98
    for number, row in enumerate(rows):
        pair = [centred(*(float(row[key + who]) for key in ("x", "y", "w", "l"))) for who in "12"]
        related = box_relations(boxes_of(*pair), relations)
        time = f"{number + 1}.0"
        assert (related.atom(0, 1), related.atom(1, 0)) == (gold[time, "o1", "o2"], gold[time, "o2", "o1"]), row
