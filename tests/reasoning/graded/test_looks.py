"""How boxes look around things of a kind: from above, in images, and beside each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.ontology.size_model import SizeModel
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.graded.looks import (
    IN_IMAGE,
    Look,
    beside_each_other,
    from_above,
    from_any_side,
    size_model,
    usual_size,
)

ONTOLOGY = default_ontology()
KINDS, SIZES = ONTOLOGY.kinds, ONTOLOGY.sizes


def iri(word: str) -> str:
    kind = KINDS.of_word(word)
    assert kind is not None
    return kind.iri


def in_image(word: str) -> Look:
    usual = usual_size(iri(word), SIZES)
    assert usual is not None
    return from_any_side(iri(word), usual, SIZES)


def sides(look: Look) -> list[tuple[float, float]]:
    """Length and width of the box in metres, of each way in which it looks."""
    return [(float(np.exp(length)), float(np.exp(length + aspect))) for length, aspect in look.centres]


def test_a_usual_range_is_two_deviations_wide_to_both_sides() -> None:
    usual = SIZES.of(iri("soup spoon"))
    model = size_model(usual)
    assert np.exp(model.length[0]) == pytest.approx(usual.length.typical)
    assert 4 * model.length[1] == pytest.approx(np.log(usual.length.greatest / usual.length.least))


def test_of_what_the_ontology_does_not_know_there_is_no_usual_size() -> None:
    assert usual_size("https://example.org/unheard", SIZES) is None


def test_a_round_thing_looks_one_way_from_above() -> None:
    assert sides(from_above(SizeModel((np.log(0.27), 0.1), (0.0, 0.05)))) == [pytest.approx((0.27, 0.27))]


def test_a_long_thing_may_lie_at_any_angle() -> None:
    look = from_above(SizeModel((np.log(0.2), 0.1), (np.log(0.1), 0.1)))
    assert sides(look)[0] == pytest.approx((0.2, 0.02))
    assert sides(look)[-1] == pytest.approx((0.22 / np.sqrt(2), 0.22 / np.sqrt(2)))  # 45 degrees
    assert look.shares[0] == look.shares.max() and look.shares.sum() == pytest.approx(1)


def test_a_person_in_an_image_is_seen_from_above_from_the_front_or_from_the_side() -> None:
    look = in_image("person")
    assert sides(look)[0] == pytest.approx((0.5, 0.3))
    assert sides(look)[-2:] == [pytest.approx((1.6, 0.5)), pytest.approx((1.6, 0.3))]
    assert look.shares[-2:] == pytest.approx([1 / 3, 1 / 3]) and look.shares.sum() == pytest.approx(1)


def test_a_plate_seen_from_the_side_is_flat() -> None:
    assert sides(in_image("dinner plate")) == [
        pytest.approx((0.27, 0.27)),
        pytest.approx((0.27, 0.024)),
        pytest.approx((0.27, 0.024)),
    ]


@pytest.mark.parametrize("relative", [False, True])
def test_of_what_has_no_height_or_was_learned_from_images_the_plan_is_all(relative: bool) -> None:
    model = SizeModel((np.log(0.3), 0.1), (-1.0, 0.1), relative)
    kind = iri("dinner plate") if relative else "https://example.org/unheard"
    look = from_any_side(kind, model, SIZES)
    assert look.centres.tolist() == from_above(model).centres.tolist() and look.relative == relative


def test_the_median_of_what_is_known_stands_for_the_scene() -> None:
    known = {kind: from_above(SizeModel((at, 0.1), (0.0, 0.05))) for kind, at in (("a", -2.0), ("b", 0.0))}
    few, many = (beside_each_other(known, ["a", "b"] * n) for n in (1, 20))
    assert few["a"].length == many["a"].length == -1.0 and few["b"].length == 1.0
    assert few["a"].relative and few["a"].spread[0] > many["a"].spread[0] > IN_IMAGE


def test_the_more_known_things_differ_the_less_their_median_says() -> None:
    spreads = []
    for far in (0.5, 5.0):
        known = {kind: from_above(SizeModel((at, 0.1), (0.0, 0.05))) for kind, at in (("a", -far), ("b", far))}
        spreads.append(beside_each_other(known, ["a", "b"])["a"].spread[0])
    assert spreads[0] < spreads[1]


def test_what_is_relative_already_stays_as_it_is() -> None:
    look = replace(from_above(SizeModel((0.0, 0.1), (0.0, 0.05))), relative=True)
    assert beside_each_other({"a": look}, ["a"]) == {"a": look}
    metric = from_above(SizeModel((2.0, 0.1), (0.0, 0.05)))
    assert beside_each_other({"a": look, "b": metric}, ["a", "b"])["a"] is look


@given(st.floats(-4, 4))
def test_units_do_not_matter_beside_each_other(shift: float) -> None:
    lengths = {"a": -2.0, "b": -1.0, "c": 0.5}
    here, there = (
        beside_each_other({k: from_above(SizeModel((at + by, 0.1), (0.0, 0.05))) for k, at in lengths.items()}, "abc")
        for by in (0.0, shift)
    )
    for kind, look in here.items():
        assert there[kind].centres == pytest.approx(look.centres) and there[kind].spread == pytest.approx(look.spread)
