"""The laws of graded meaning: bounds, invariances, inverses, mirrors, monotony."""

from __future__ import annotations

import numpy as np
import pytest
from graded_words import relation_evidence
from hypothesis import given
from hypothesis import strategies as st
from laid_boxes import tables
from numpy.typing import NDArray

from deixis.errors import GraphError
from deixis.ontology.models.relations import FAMILIES, SAYING, RelationModel, RelationModels, Term
from deixis.ontology.relations.relation import Reading
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.words.degrees import (
    WordDegrees,
    degree_of_view,
    log_likelihood_ratio,
    saying_degree,
    word_degree,
)
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.grounding.evidence.words.pair_features import view
from deixis.reasoning.grounding.fitting.fit import chance_degree, random_scenes

RELATIONS = default_ontology().relations
MODELS = shipped_models()
WORDS = st.sampled_from(list(FAMILIES))
MIRRORED = {"left": "right", "top_left": "top_right", "bottom_left": "bottom_right"}
Array = NDArray[np.float64]


def degree(word: str, subject: list[list[float]], object: list[list[float]]) -> float:
    return float(word_degree(pair_geometry(np.array([subject, object], dtype=float)), word, MODELS)[0, 1])


@given(tables(axes=3), st.sampled_from(list(RELATIONS)))
def test_degrees_and_evidence_are_bounded_for_empty_boxes(boxes: Array, name: str) -> None:
    pairs = pair_geometry(boxes)
    degrees = WordDegrees(pairs, MODELS).of(RELATIONS[name])
    assert np.all((degrees >= 0) & (degrees <= 1))
    assert np.isfinite(relation_evidence(pairs, RELATIONS[name], MODELS)).all()
    assert np.all((saying_degree(pairs, MODELS) > 0) & (saying_degree(pairs, MODELS) <= 1))


@given(tables(), WORDS, st.sampled_from([0.25, 1.0, 4.0]), st.tuples(st.integers(-64, 64), st.integers(-64, 64)))
def test_moving_and_scaling_a_scene_changes_nothing(
    boxes: Array, word: str, factor: float, shift: tuple[int, int]
) -> None:
    moved = pair_geometry(boxes * factor + np.array(shift))
    assert word_degree(moved, word, MODELS) == pytest.approx(word_degree(pair_geometry(boxes), word, MODELS), abs=1e-9)


@given(tables(axes=3), st.sampled_from(list(RELATIONS)))
def test_the_inverse_of_the_exchanged_pair_is_as_likely(boxes: Array, name: str) -> None:
    pairs = pair_geometry(boxes)
    one = relation_evidence(pairs, RELATIONS[name], MODELS)
    other = relation_evidence(pairs, RELATIONS[RELATIONS[name].inverse], MODELS)
    if name == "under":  # also of what stands between the legs of a thing
        assert (one >= other.T - 1e-9).all()
    elif name == "on":
        assert (one <= other.T + 1e-9).all()
    else:
        assert one == pytest.approx(other.T, abs=1e-9)


@given(tables(), st.sampled_from(sorted(MIRRORED)))
def test_left_is_right_in_the_mirror(boxes: Array, word: str) -> None:
    mirrored = boxes.copy()
    mirrored[:, 0, 0], mirrored[:, 1, 0] = -boxes[:, 1, 0], -boxes[:, 0, 0]
    here, there = pair_geometry(boxes), pair_geometry(mirrored)
    assert word_degree(here, word, MODELS) == pytest.approx(word_degree(there, MIRRORED[word], MODELS), abs=1e-9)


@given(tables())
def test_top_is_bottom_upside_down(boxes: Array) -> None:
    turned = boxes.copy()
    turned[:, 0, 1], turned[:, 1, 1] = -boxes[:, 1, 1], -boxes[:, 0, 1]
    here, there = pair_geometry(boxes), pair_geometry(turned)
    assert word_degree(here, "top", MODELS) == pytest.approx(word_degree(there, "bottom", MODELS), abs=1e-9)


@given(tables())
def test_vertical_is_horizontal_turned_by_a_quarter(boxes: Array) -> None:
    low, high = boxes[:, 0], boxes[:, 1]
    turned = np.stack([np.stack([-high[:, 1], low[:, 0]], axis=1), np.stack([-low[:, 1], high[:, 0]], axis=1)], axis=1)
    here, there = pair_geometry(boxes), pair_geometry(turned)
    assert word_degree(here, "top", MODELS) == pytest.approx(word_degree(there, "left", MODELS), abs=1e-9)


@given(tables(least=2, most=2), st.integers(1, 30))
def test_moving_left_lowers_left_only_by_distance(boxes: Array, by: int) -> None:
    further = boxes.copy()
    further[0, :, 0] -= by
    blind = RelationModels({name: model.without("gap") for name, model in MODELS.models.items()})
    before = word_degree(pair_geometry(boxes), "left", blind)[0, 1]
    assert word_degree(pair_geometry(further), "left", blind)[0, 1] >= before - 1e-9


@given(tables(least=2, most=2), st.integers(1, 30))
def test_moving_left_never_lowers_left_until_boxes_part(boxes: Array, by: int) -> None:
    further = boxes.copy()
    further[0, :, 0] -= by
    before, after = pair_geometry(boxes), pair_geometry(further)
    if after.gap[0, 1] <= before.gap[0, 1]:
        assert word_degree(after, "left", MODELS)[0, 1] >= word_degree(before, "left", MODELS)[0, 1] - 1e-9


def test_the_prototype_of_left_holds_wholly() -> None:
    assert degree("left", [[-1, 0], [0, 1]], [[0, 0], [1, 1]]) == pytest.approx(1.0, abs=0.005)


def test_the_prototype_of_on_holds_wholly() -> None:
    assert degree("on", [[0.4, 0.4], [0.6, 0.6]], [[0, 0], [1, 1]]) == 1.0


def test_degrees_fall_along_the_conceptual_neighbourhood() -> None:
    plate: list[list[float]] = [[0, 0], [1, 1]]
    left, diagonal, above = [[-1.2, 0], [-0.2, 1]], [[-1.2, 1.2], [-0.2, 2.2]], [[0, 1.2], [1, 2.2]]
    right = [[1.2, 0], [2.2, 1]]
    found = [degree("left", box, plate) for box in (left, diagonal, above, right)]
    assert found == sorted(found, reverse=True)
    assert found[0] > 0.8
    assert found[1] < 0.5
    assert found[2] < 0.1


def test_heights_decide_support_where_they_are_known() -> None:
    plate = [[0, 0, 0], [1, 1, 0.1]]
    over = np.array([[[0.4, 0.4, 0.1], [0.6, 0.6, 0.2]], plate])
    below = np.array([[[0.4, 0.4, -0.2], [0.6, 0.6, -0.1]], plate])
    assert word_degree(pair_geometry(over), "on", MODELS)[0, 1] == 1.0
    assert word_degree(pair_geometry(below), "on", MODELS)[0, 1] < 0.2


@pytest.mark.parametrize(
    ("box", "under"),
    [
        ([[0.3, 0.3, 0.0], [0.6, 0.6, 0.3]], True),  # a bin between the legs of a desk
        ([[0.3, 0.3, 0.7], [0.6, 0.6, 0.8]], False),  # a book on the desk
        ([[0.3, 0.3, 0.5], [0.6, 0.6, 0.6]], False),  # something in its drawer
        ([[1.2, 0.3, 0.0], [1.5, 0.6, 0.3]], False),  # a bin beside the desk
        ([[0.3, 0.3, 0.0], [0.6, 0.6, 1.4]], False),  # a lamp through it
    ],
)
def test_what_stands_between_the_legs_of_a_thing_is_under_it(box: list[list[float]], under: bool) -> None:
    boxes = np.array([box, [[0, 0, 0], [1, 1, 0.7]]], dtype=float)
    degrees = WordDegrees(pair_geometry(boxes), MODELS)
    found = degrees.of(RELATIONS["under"])[0, 1]
    assert (found > 0.9) if under else (found < 0.2)
    assert degrees.of(RELATIONS["exactly_under"])[0, 1] < 0.2


def test_a_fact_is_bounded_by_the_outliers_and_by_chance() -> None:
    ratio = log_likelihood_ratio(np.array([0.0, 0.1, 1.0]), outliers=0.01, chance=0.1)
    assert ratio[1] == 0.0
    assert ratio[2] - ratio[0] == pytest.approx(np.log(100))


@pytest.mark.parametrize("word", sorted(FAMILIES))
def test_the_best_word_is_mostly_the_exact_name_of_random_boxes(word: str) -> None:
    """Check that the word with the best degree is mostly the exact relation of the pair."""
    agreed = total = 0
    for pairs in map(pair_geometry, random_scenes()[:40]):
        names = box_relations(pairs.boxes, RELATIONS).names
        graded = np.argmax([word_degree(pairs, other, MODELS) for other in FAMILIES], axis=0)
        here = names == next(r.index for r in RELATIONS.of_reading(Reading.EXACT) if r.word == word)
        agreed += int(((graded == list(FAMILIES).index(word)) & here).sum())
        total += int(here.sum())
    assert agreed > 0.7 * total


def test_chance_is_the_mean_degree_of_random_pairs() -> None:
    pairs = [pair_geometry(boxes) for boxes in random_scenes()]
    for name, model in MODELS.models.items():
        assert chance_degree(model, pairs) == pytest.approx(model.chance, abs=0.001), name


def test_chance_of_no_pairs_is_1() -> None:
    assert chance_degree(MODELS[SAYING], []) == 1.0


@pytest.mark.parametrize("count", [0, 1])
def test_no_pairs_raise_no_error(count: int) -> None:
    boxes = np.zeros((count, 2, 2))
    assert word_degree(pair_geometry(boxes), "left", MODELS).shape == (count, count)
    assert saying_degree(pair_geometry(boxes), MODELS).shape == (count, count)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_boxes_that_are_not_finite_are_refused(bad: float) -> None:
    with pytest.raises(GraphError, match="must be finite"):
        pair_geometry(np.array([[[0.0, 0.0], [bad, 1.0]]]))


def test_a_box_inside_out_is_refused() -> None:
    with pytest.raises(GraphError, match="lower corner of box 0 must not be above"):
        pair_geometry(np.array([[[1.0, 0.0], [0.0, 1.0]]]))


def test_the_nearest_things_are_not_crowded() -> None:
    boxes = np.array([[[x, 0.0], [x + 1.0, 1.0]] for x in (0.0, 2.0, 10.0)])
    crowd = pair_geometry(boxes).crowd
    assert crowd[0, 1] == 0.0
    assert crowd[0, 2] == 1.0
    assert crowd[1, 2] == 0.5


def test_points_do_not_crowd_each_other_by_rounding() -> None:
    places = np.random.default_rng(0).uniform(size=(30, 1, 2))
    assert (pair_geometry(np.repeat(places, 2, axis=1)).crowd == 0.0).all()


def test_a_term_of_an_unknown_feature_counts_as_fitting() -> None:
    features = view(pair_geometry(np.zeros((2, 2, 2))), "on")
    assert "rise" not in features
    assert np.all(degree_of_view(MODELS["support"].without("across", "foot", "gap"), features) == 1.0)


@given(
    st.lists(st.floats(-2, 2, allow_subnormal=False), min_size=2, max_size=9, unique_by=lambda knot: round(knot, 2)),
    st.lists(st.floats(-5, 0), min_size=9, max_size=9),
    st.booleans(),
)
def test_a_degree_is_linear_between_knots_as_numpy_interpolates(
    knots: list[float], values: list[float], turned: bool
) -> None:
    term = Term("gap", tuple(sorted(knots)), tuple(values[: len(knots)]))
    looked_at = np.random.default_rng(0).uniform(-3, 3, (150, 150))  # several blocks
    feature = looked_at.T if turned else looked_at
    found = degree_of_view(RelationModel("support", (term,), 0.01, 0.1), {"gap": feature})
    np.testing.assert_allclose(found, np.exp(np.interp(feature, term.knots, term.values)), rtol=1e-9)
    assert found.max() <= 1.0
