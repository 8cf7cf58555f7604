"""Size distributions of boxes around things of a kind."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.properties.sizes import (
    IMAGE_SPREAD,
    SizeMixture,
    beside_each_other,
    from_above,
    in_image_from_above,
    in_image_from_aside,
    size_model,
    usual_size,
)

ONTOLOGY = default_ontology()
KINDS, SIZES = ONTOLOGY.kinds, ONTOLOGY.sizes


def iri(word: str) -> str:
    kind = KINDS.of_word(word)
    assert kind is not None
    return kind.iri


def in_image(word: str) -> SizeMixture:
    usual = usual_size(iri(word), SIZES)
    assert usual is not None
    return in_image_from_aside(iri(word), usual, SIZES)


def sides(look: SizeMixture) -> list[tuple[float, float]]:
    """Return length and width of the box in metres, for each view of it."""
    return [(float(np.exp(length)), float(np.exp(length + aspect))) for length, aspect in look.centres]


def test_a_usual_range_is_two_deviations_wide_to_both_sides() -> None:
    usual = SIZES.of(iri("soup spoon"))
    model = size_model(usual)
    assert np.exp(model.length[0]) == pytest.approx(usual.length.typical)
    assert 4 * model.length[1] == pytest.approx(np.log(usual.length.greatest / usual.length.least))


def test_unknown_kinds_have_no_usual_size() -> None:
    assert usual_size("https://example.org/unheard", SIZES) is None


def test_handle_lengthens_a_round_thing_at_any_angle() -> None:
    look = from_above(SizeModel((np.log(0.08), 0.1), (0.0, 0.05)), reach=0.4)
    hidden, along, *turned = sides(look)
    assert hidden == pytest.approx((0.08, 0.08)) and along == pytest.approx((0.08 * 1.4, 0.08))
    middle = 0.08 * (0.5 + 0.9 * np.cos(np.radians(45)))  # towards a corner both sides are as long
    assert turned[-1] == pytest.approx((middle, middle))
    assert look.shares.sum() == pytest.approx(1.0) and look.shares[0] == pytest.approx(0.2)
    assert [length for length, _ in (along, *turned)] == sorted(
        (length for length, _ in (along, *turned)), reverse=True
    )


def test_sizes_learned_from_images_are_unchanged() -> None:
    model = SizeModel((0.1, 0.1), (-0.2, 0.1), relative=True)
    assert sides(from_above(model, reach=0.4)) == sides(from_above(model))


def test_a_round_thing_looks_one_way_from_above() -> None:
    assert sides(from_above(SizeModel((np.log(0.27), 0.1), (0.0, 0.05)))) == [pytest.approx((0.27, 0.27))]


def test_a_long_thing_may_lie_at_any_angle() -> None:
    look = from_above(SizeModel((np.log(0.2), 0.1), (np.log(0.1), 0.1)))
    assert sides(look)[0] == pytest.approx((0.2, 0.02))
    assert sides(look)[-1] == pytest.approx((0.22 / np.sqrt(2), 0.22 / np.sqrt(2)))  # 45 degrees
    assert look.shares[0] == look.shares.max() and look.shares.sum() == pytest.approx(1)


def test_image_sizes_cover_top_front_and_side_views() -> None:
    look = in_image("adult")
    lengths, tall = np.exp(look.centres).T
    assert (lengths[0], tall[0]) == pytest.approx((0.5, 0.6))
    assert lengths[-2:] == pytest.approx([1.7, 1.7]) and tall[-2:] == pytest.approx([1.7 / 0.5, 1.7 / 0.3])
    assert look.shares[-2:] == pytest.approx([1 / 3, 1 / 3]) and look.shares.sum() == pytest.approx(1)


def test_a_plate_seen_from_the_side_is_flat() -> None:
    lengths, tall = np.exp(in_image("dinner plate").centres).T
    assert lengths == pytest.approx([0.27] * 4) and tall == pytest.approx([1, 1, 0.024 / 0.27, 0.024 / 0.27])


def test_a_fork_lies_as_well_across_an_image_as_along_it() -> None:
    usual = usual_size(iri("fork"), SIZES)
    assert usual is not None
    look = in_image_from_above(usual)
    tall, half = look.centres[:, 1], len(look.centres) // 2
    assert tall[:half].tolist() == (-tall[half:]).tolist() == from_above(usual).centres[:, 1].tolist()
    assert look.shares.sum() == pytest.approx(1) and look.shares[:half].tolist() == look.shares[half:].tolist()


def test_of_what_has_no_height_the_plan_is_all() -> None:
    model = SizeModel((np.log(0.3), 0.1), (-1.0, 0.1))
    aside = in_image_from_aside("https://example.org/unheard", model, SIZES)
    assert aside.centres.tolist() == in_image_from_above(model).centres.tolist() and not aside.relative


def test_what_images_taught_looks_as_they_showed_it() -> None:
    model = SizeModel((0.4, 0.1), (1.2, 0.3), relative=True)
    for look in (from_above(model), in_image_from_above(model), in_image_from_aside(iri("person"), model, SIZES)):
        assert (look.centres.tolist(), look.shares.tolist(), look.relative) == ([[0.4, 1.2]], [1.0], True)


def test_the_median_of_what_is_known_stands_for_the_scene() -> None:
    known = {kind: from_above(SizeModel((at, 0.1), (0.0, 0.05))) for kind, at in (("a", -2.0), ("b", 0.0))}
    few, many = (beside_each_other(known, ["a", "b"] * n) for n in (1, 20))
    assert few["a"].length == many["a"].length == -1.0 and few["b"].length == 1.0
    assert few["a"].relative and few["a"].spread[0] > many["a"].spread[0] > IMAGE_SPREAD


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
