"""Recovery of the viewpoint of a description."""

from __future__ import annotations

import math
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.experiments.place_settings import formal_setting
from deixis.grammar.layout.parser import parse_script, read_layout
from deixis.ontology.graph.graph import RelationGraph
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.evidence.facts.facts import fact_tables
from deixis.reasoning.grounding.hypotheses.viewpoint import COARSE_ANGLES, Viewpoints, recover_viewpoint
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search.exact import exact

Boxes = NDArray[np.float64]
FORMAL = read_layout(str(Path(__file__).parents[4] / "examples" / "formal_dinner.layout")).graph()
QUARTER = math.pi / 2


def problem(description: RelationGraph, boxes: Boxes) -> Problem:
    said = fact_tables(description, boxes)
    n1 = len(description.nodes)
    return Problem(said.ends, said.kinds, said.tables, np.zeros((n1, len(boxes))), np.full(n1, -3.0))


def recovered(description: RelationGraph, boxes: Boxes, *, any_angle: bool = False, mirror: bool = True) -> Viewpoints:
    return recover_viewpoint(boxes, lambda seen: problem(description, seen), any_angle=any_angle, mirror=mirror)


def spun(boxes: Boxes, angle: float) -> Boxes:
    """Return the enclosing boxes of a turned table: square things are round, others rectangles."""
    cos, sin = math.cos(angle), math.sin(angle)
    corners = (
        np.stack([boxes[:, i, 0] for i in (0, 0, 1, 1)], axis=1),
        np.stack([boxes[:, i, 1] for i in (0, 1, 0, 1)], axis=1),
    )
    x, y = corners[0] * cos - corners[1] * sin, corners[0] * sin + corners[1] * cos
    result = np.stack([np.stack([x.min(1), y.min(1)], axis=1), np.stack([x.max(1), y.max(1)], axis=1)], axis=1)
    sides = boxes[:, 1] - boxes[:, 0]
    for k in np.flatnonzero(np.abs(sides[:, 0] - sides[:, 1]) < 1e-3):
        centre = result[k].mean(axis=0)
        result[k] = [centre - sides[k] / 2, centre + sides[k] / 2]
    return result


def named(boxes_of: list[str]) -> NDArray[np.int64]:
    return np.array([boxes_of.index(name) for name in FORMAL.nodes])


@st.composite
def boxes(draw: st.DrawFn) -> Boxes:
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    n, d = draw(st.integers(0, 6)), draw(st.sampled_from([2, 3]))
    low = rng.uniform(-1, 1, (n, d))
    return np.stack([low, low + rng.uniform(0.01, 1, (n, d))], axis=1).reshape(n, 2, d)


@given(boxes(), st.booleans())
def test_a_whole_turn_changes_nothing(some: Boxes, mirrored: bool) -> None:
    assert np.array_equal(turned(some, 2 * math.pi, mirrored), turned(some, 0.0, mirrored))


@given(boxes())
def test_four_quarter_turns_and_two_mirrors_are_identity(some: Boxes) -> None:
    around = some
    for _ in range(4):
        around = turned(around, QUARTER)
    assert np.array_equal(around, some)
    assert np.array_equal(turned(turned(some, 0.0, True), 0.0, True), some)


@given(boxes(), st.floats(0, 7))
def test_turning_there_and_back_keeps_every_centre(some: Boxes, angle: float) -> None:
    back = turned(turned(some, angle), -angle)
    assert back.mean(axis=1) == pytest.approx(some.mean(axis=1), abs=1e-9)


@given(boxes(), st.floats(0, 7), st.booleans())
def test_a_turned_box_is_a_box_and_heights_stay(some: Boxes, angle: float, mirrored: bool) -> None:
    found = turned(some, angle, mirrored)
    assert (found[:, 1] >= found[:, 0]).all()
    assert np.array_equal(found[:, :, 2:], some[:, :, 2:])


def test_the_rectangle_in_an_enclosing_box_is_found_again() -> None:
    fork = np.array([[[0.2, 0.1], [0.225, 0.3]]])
    for degrees in (10, 30, 60, 80, 130, 200):
        assert turned(spun(fork, math.radians(degrees)), -math.radians(degrees)) == pytest.approx(fork, abs=1e-9)


def test_a_round_thing_stays_as_large_at_any_angle() -> None:
    plate = np.array([[[0.2, 0.1], [0.47, 0.37]]])
    sides = np.diff(turned(plate, 0.6), axis=1)
    assert sides == pytest.approx(np.full((1, 1, 2), 0.27))


@pytest.mark.parametrize("quarters", [0, 1, 2, 3])
@pytest.mark.parametrize("mirrored", [False, True])
def test_quarter_turns_and_mirrors_are_recovered(quarters: int, mirrored: bool) -> None:
    scene = formal_setting(quarters, 0.01)
    changed = turned(scene.boxes, quarters * QUARTER)
    changed = turned(changed, 0.0, mirrored)
    found = recovered(FORMAL, changed)
    again = turned(changed, found.best.angle, found.best.mirrored)
    assert found.best.mirrored == mirrored
    assert again.mean(axis=1) == pytest.approx(scene.boxes.mean(axis=1), abs=1e-9)
    assert found.best.assignment.tolist() == named(list(scene.ids)).tolist()
    assert found.best.probability > (0.4 if mirrored else 0.9)
    assert len(found.ties) == 1


def test_tables_at_any_angle_ground_as_well_as_unturned_ones() -> None:
    rng, turned_right, unturned_right, ignored_right = np.random.default_rng(5), 0, 0, 0
    for seed in range(4):
        scene = formal_setting(seed, 0.015)
        truth, angle = named(list(scene.ids)), float(rng.uniform(0, 2 * math.pi))
        changed = spun(scene.boxes, angle)
        found = recovered(FORMAL, changed, any_angle=True)
        error = (found.best.angle + angle + math.pi) % (2 * math.pi) - math.pi
        assert abs(error) < math.radians(12)
        assert not found.best.mirrored
        turned_right += int((found.best.assignment == truth).sum())
        unturned_right += int((exact(problem(FORMAL, scene.boxes)).assignment == truth).sum())
        ignored_right += int((exact(problem(FORMAL, changed)).assignment == truth).sum())
    assert turned_right >= unturned_right
    assert ignored_right < 0.8 * turned_right


def test_a_description_that_cannot_tell_says_so() -> None:
    row = np.array([[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]])
    found = recovered(parse_script("cup left of mug").graph(), row, mirror=False)
    assert {round(view.angle / QUARTER) for view in found.ties} == {0, 2}
    assert found.best.probability == pytest.approx(found.viewpoints[1].probability)
    assert found.ties[0].assignment.tolist() == found.ties[1].assignment.tolist()[::-1]


def test_weak_evidence_of_a_mirror_does_not_mirror() -> None:
    row = np.array([[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]])
    found = recovered(parse_script("cup left of mug").graph(), row)
    assert len(found.ties) == 4
    assert not found.best.mirrored
    mirrored = [view for view in found.viewpoints if view.mirrored]
    assert sum(view.probability for view in mirrored) == pytest.approx(0.05)


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 1000))
def test_probabilities_sum_to_one_in_any_order(seed: int) -> None:
    rng = np.random.default_rng(seed)
    low = rng.uniform(0, 1, (4, 2))
    some = np.stack([low, low + 0.2], axis=1)
    description = parse_script("cup left of mug; plate above mug; mug right of jug").graph()
    found, other = recovered(description, some), recovered(description, some[::-1])
    assert sum(view.probability for view in found.viewpoints) == pytest.approx(1.0)
    for one, same in zip(found.viewpoints, other.viewpoints, strict=True):
        assert one.probability == pytest.approx(same.probability, abs=1e-6)


def test_a_scene_of_nothing_has_every_viewpoint() -> None:
    found = recovered(parse_script("cup left of mug").graph(), np.zeros((0, 2, 2)))
    assert len(found.ties) == 8
    assert found.best.assignment.tolist() == [-1, -1]


def test_invalid_boxes_are_refused() -> None:
    with pytest.raises(GraphError, match="must be finite"):
        turned(np.full((1, 2, 2), np.nan), 1.0)


def looked_until(monkeypatch: pytest.MonkeyPatch, most: int) -> tuple[Viewpoints, list[Boxes]]:
    """Recover the viewpoint of a formal dinner with a deadline after a number of problems; return those built, too."""
    scene, built, deadline = formal_setting(0, 0.01), list[Boxes](), Deadline.after(1000.0)
    real = time.monotonic

    def now() -> float:
        return real() + (2000 if len(built) >= most else 0)

    monkeypatch.setattr("deixis.deadline.time.monotonic", now)

    def noted(seen: Boxes) -> Problem:
        built.append(seen)
        return problem(FORMAL, seen)

    return recover_viewpoint(scene.boxes, noted, any_angle=True, deadline=deadline), built


def test_quarter_turns_come_first_until_the_deadline(monkeypatch: pytest.MonkeyPatch) -> None:
    found, built = looked_until(monkeypatch, 10)
    assert len(built) == 10
    assert not found.exact
    assert not found.everywhere
    boxes = formal_setting(0, 0.01).boxes
    quarters = [turned(boxes, k * QUARTER, mirrored) for mirrored in (False, True) for k in range(4)]
    for seen, expected in zip(built, quarters, strict=False):
        assert np.array_equal(seen, expected)


def test_scene_as_it_stands_is_searched_without_time() -> None:
    found = recover_viewpoint(
        formal_setting(0, 0.01).boxes, lambda seen: problem(FORMAL, seen), deadline=Deadline.after(0.0)
    )
    assert [view.angle for view in found.viewpoints] == [0.0]
    assert not found.exact


def test_arc_without_time_for_refinement_stays_coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    found, built = looked_until(monkeypatch, 2 * COARSE_ANGLES + 7)
    assert len(built) == 2 * COARSE_ANGLES + 7
    assert not found.everywhere
    assert sum(view.probability for view in found.viewpoints) == pytest.approx(1.0)
    assert min(found.best.angle, 2 * math.pi - found.best.angle) < math.radians(10)


def test_angles_all_around_give_no_side() -> None:
    row = np.array([[[0.0, 0.0], [1.0, 1.0]], [[2.0, 0.0], [3.0, 1.0]]])
    nothing = Problem(
        np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 2, 2), np.float32), np.eye(2), np.zeros(2)
    )
    around = recover_viewpoint(row, lambda _: nothing, any_angle=True)
    assert around.best.concentration == pytest.approx(0.0, abs=1e-9)
    assert recovered(FORMAL, formal_setting(0, 0.01).boxes, any_angle=True).best.concentration > 0.9
