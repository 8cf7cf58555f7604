"""Test what a robot keeps of the tables of one layout."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.learning.layouts.experience import Experience, Moments, Spread, log_sizes, long_axis, predictive
from deixis.ontology.tbox import default_ontology
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import PerceivedObject
from deixis.robot.layouts import LearnedLayout, _pieces, angle_between
from deixis.workflows.layouts.read import read_script

ROLES = ("fork", "knife", "plate")


def thing(name: str, x: float, y: float, yaw: float = np.pi / 2) -> PerceivedObject:
    """Return a long thing of 20 by 2 cm."""
    box = OrientedBox((x, y, 0.01), yaw, (0.2, 0.02, 0.02))
    half = np.abs([0.1 * np.cos(yaw) + 0.01 * np.sin(yaw), 0.1 * np.sin(yaw) + 0.01 * np.cos(yaw)])
    return PerceivedObject(name, (x - half[0], y - half[1], 0.0), (x + half[0], y + half[1], 0.02), oriented=box)


def table(places: tuple[float, ...]) -> Experience:
    things = {role: thing(role, x, 0.0) for role, x in zip(ROLES, places, strict=False)}
    return Experience.of_table(ROLES, things, default_ontology().relations)


places = st.lists(st.floats(-1, 1), min_size=0, max_size=3).map(tuple)


@settings(max_examples=20, deadline=None)
@given(st.lists(places, min_size=1, max_size=3))
def test_order_of_tables_does_not_matter(tables: list[tuple[float, ...]]) -> None:
    seen = [table(each) for each in tables]
    sums = [sum(order, Experience()) for order in permutations(seen)]
    for other in sums:
        assert other.tables == sums[0].tables
        assert other.held == sums[0].held
        assert other.filled == sums[0].filled
        for pair, moments in other.apart.items():
            assert moments.total == pytest.approx(sums[0].apart[pair].total, abs=1e-9)


def test_experience_counts_what_holds_and_how_far_apart() -> None:
    seen = table((0.0, 0.2)) + table((0.0, 0.4))
    assert seen.tables == 2
    assert (seen.held["left", "fork", "knife"].held, seen.held["left", "fork", "knife"].of) == (2, 2)
    assert seen.filled["plate"].held == 0
    assert seen.apart["fork", "knife"].mean[0] == pytest.approx(0.3)
    assert seen.apart["fork", "knife"].deviation[0] == pytest.approx(0.1)


def test_layout_knows_how_its_things_lie() -> None:
    script = read_script(text="layout place; fork left of knife")
    layout = LearnedLayout("place", script, table((0.0, 0.2)))
    assert layout.axis("fork") == pytest.approx(np.pi / 2)
    assert LearnedLayout.told(script).axis("fork") is None


def test_seen_relations_join_the_told_ones() -> None:
    script = read_script(text="layout place; fork left of knife; plate left of knife")
    layout = LearnedLayout("place", script, table((0.0, 0.4, 0.2)))
    told = {(r.name, layout.roles[a], layout.roles[b]): p for r, a, b, p, _ in layout.expectations}
    assert told["left", "fork", "knife"] == pytest.approx(0.998)
    assert told["left", "fork", "plate"] == pytest.approx(0.75)


def test_round_things_have_no_direction() -> None:
    plate = PerceivedObject("p", (0, 0, 0), (1, 1, 1), oriented=OrientedBox((0, 0, 0), 0.3, (1.0, 0.9, 1.0)))
    assert long_axis(plate) is None
    assert angle_between(0.1, np.pi - 0.1) == pytest.approx(0.2)


def test_height_counts_from_what_lies_below() -> None:
    low = PerceivedObject("banana", (0.3, 0.0, 0.038), (0.5, 0.05, 0.044))  # only its top is seen
    plate = PerceivedObject("plate", (0.0, 0.0, 0.0), (0.2, 0.2, 0.02))
    napkin = PerceivedObject("napkin", (0.05, 0.05, 0.02), (0.15, 0.15, 0.03))
    heights = np.exp(log_sizes([low, plate, napkin])[:, 2]) - 0.01
    assert heights == pytest.approx([0.044, 0.02, 0.01])


def test_parts_of_things_are_pieces() -> None:
    jug, half = [(0.0, 0.0, 0.0), (0.07, 0.1, 0.105)], [(-0.01, 0.0, 0.02), (0.07, 0.09, 0.09)]
    pot, knob = [(0.3, 0.0, 0.0), (0.45, 0.2, 0.12)], [(0.36, 0.09, 0.126), (0.38, 0.11, 0.14)]
    saucer, cup = [(0.6, 0.0, 0.0), (0.75, 0.15, 0.02)], [(0.63, 0.03, 0.007), (0.72, 0.12, 0.07)]
    assert _pieces(np.array([jug, half, pot, knob, saucer, cup])).tolist() == [False, True, False, True, False, False]


def test_predictions_narrow_as_more_is_seen() -> None:
    few, many = Moments.of((0.0,)), Moments(30.0, (0.0,), (0.0,))
    at = np.array([[0.0], [0.2]])
    middle, tail = zip(*(predictive(at, seen, Spread((0.05,), 2.0))[:, 0] for seen in (few, many)), strict=True)
    assert middle[1] > middle[0]
    assert tail[1] < tail[0]


@pytest.mark.parametrize("deviation", [0.01, 0.1])
def test_spread_is_fitted_to_several_quantities(deviation: float) -> None:
    random = np.random.default_rng(3)
    seen = [sum(map(Moments.of, random.normal(0, deviation, (3, 2)).tolist()), Moments()) for _ in range(200)]
    found = Spread((0.05, 0.05), 2.0).fitted(seen, 0.0)
    assert found.deviations == pytest.approx((deviation, deviation), rel=0.1)
    assert found.weight > 10  # all deviate alike


def test_unequal_quantities_give_a_spread_of_little_weight() -> None:
    random = np.random.default_rng(4)
    sizes = 0.01 * np.exp(random.normal(0, 1, 200))
    seen = [sum(map(Moments.of, random.normal(0, size, (3, 2)).tolist()), Moments()) for size in sizes]
    assert Spread((0.05, 0.05), 2.0).fitted(seen, 0.0).weight < 4


def test_few_quantities_keep_the_stated_spread() -> None:
    stated = Spread((0.05, 0.05), 2.0)
    seen = [Moments.of((0.0, 0.0)) + Moments.of((0.01, 0.01)) for _ in range(3)]
    assert stated.fitted(seen, 0.005) is stated
    assert stated.fitted([Moments.of((0.0, 0.0))] * 9, 0.005) is stated


def test_small_displacement_counts_where_tables_hardly_vary() -> None:
    from deixis.perception.scene import Scene
    from deixis.reasoning.comparison.explanation import explain
    from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED

    text = "layout place; left to right: fork, plate, knife, spoon; fork left of knife; cup above knife"
    script = read_script(text=text)
    roles = ("fork", "plate", "knife", "spoon", "cup")
    middles = np.array([(-0.2, 0.0), (0.0, 0.0), (0.2, 0.0), (0.26, 0.0), (0.2, 0.25)])

    def laid(places: np.ndarray) -> dict[str, PerceivedObject]:
        return {role: thing(role, x, y) for role, (x, y) in zip(roles, places.tolist(), strict=True)}

    def mistakes(spread: float) -> list[str]:
        random = np.random.default_rng(1)
        seen = [laid(middles + random.normal(0, spread, middles.shape)) for _ in range(4)]
        tables = [Experience.of_table(roles, things, default_ontology().relations) for things in seen]
        layout = LearnedLayout("place", script, sum(tables, Experience()))
        moved = laid(middles - np.array([(0.15, 0.0), (0, 0), (0, 0), (0, 0), (0, 0)]))
        named = [replace(one, label=role, candidates=((role, 0.99),)) for role, one in moved.items()]
        evidence = layout.evidence(Scene(tuple(named)), default_ontology(), SHIPPED)
        return [f"{one.kind} {layout.roles[one.roles[0]]}" for one in explain(evidence).mistakes]

    assert mistakes(0.01) == ["displaced fork"]
    assert mistakes(0.06) == []
