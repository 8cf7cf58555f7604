"""Calibration: threshold and probabilities by hand, compared with brute force, and from held-out views."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import (
    COLOUR_WEIGHT,
    MIN_HELD_OUT_ANSWERS,
    SHIPPED,
    SHIPPED_JOINT,
    Calibration,
    auroc,
    beside_colour,
    best_threshold,
    calibrate,
    calibrate_jointly,
    expected_calibration_error,
)
from deixis.perception.recognition.distances import category_distance
from deixis.perception.recognition.held_out import (
    MAX_SHORTENING,
    USUAL_SHORTENING,
    HeldOut,
    hold_out,
    shortening,
)
from deixis.perception.recognition.index import Effort
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.recogniser import Recogniser
from deixis.perception.recognition.settings import DEFAULT, RecognitionSettings

scores = st.lists(st.floats(0.01, 10), min_size=1, max_size=20).map(np.array)


def test_the_threshold_lies_in_the_middle_of_the_gap() -> None:
    assert best_threshold(np.array([0.2, 0.5]), np.array([0.9, 3.0])) == pytest.approx(0.7)


def test_a_rare_unknown_moves_the_threshold_up() -> None:
    known, unknown = np.array([0.2, 0.4, 1.0]), np.array([0.6, 0.8, 2.0])
    assert best_threshold(known, unknown, 0.5) == pytest.approx(0.5)
    assert best_threshold(known, unknown, 0.1) == pytest.approx(1.5)


def test_a_cut_between_two_neighbouring_numbers_is_the_lower_one() -> None:
    lower = float(np.nextafter(10.0, 0.0))
    assert best_threshold(np.array([lower]), np.array([10.0])) == lower


@settings(deadline=None)
@given(scores, scores, st.floats(0.05, 0.95))
def test_no_other_threshold_makes_fewer_errors(
    known: NDArray[np.float64], unknown: NDArray[np.float64], prior: float
) -> None:
    def errors(cut: float) -> float:
        return float((1 - prior) * (known > cut).mean() + prior * (unknown <= cut).mean())

    least = min(errors(cut) for cut in [0.0, *known, *unknown, 100.0])
    assert errors(best_threshold(known, unknown, prior)) == pytest.approx(least)


def test_probabilities_by_hand() -> None:
    calibration = Calibration(threshold=1, even=1, doubt=2, choice=1)
    # known: 1 / (1 + 0.5^2) = 0.8; shares 1 / 0.5 to 1 / 2
    np.testing.assert_allclose(calibration.probabilities(np.array([0.5, 2.0])), [0.64, 0.16, 0.2])


@settings(deadline=None)
@given(st.lists(st.one_of(st.floats(0, 1e6), st.just(np.inf)), min_size=1, max_size=6).map(np.array))
def test_probabilities_sum_to_one_in_order_of_distance(normalised: NDArray[np.float64]) -> None:
    *named, unknown = SHIPPED.probabilities(normalised)
    assert sum(named) + unknown == pytest.approx(1.0)
    assert np.isfinite(named).all()
    ordered = np.array(named)[np.argsort(normalised)]
    assert (np.diff(ordered) <= 1e-12).all()


def test_slips_spread_a_share_of_the_answers_evenly() -> None:
    sure = Calibration(threshold=1, even=1, doubt=2, choice=1, slips=0.1)
    np.testing.assert_allclose(sure.probabilities(np.array([0.5, 2.0])), [0.601, 0.169, 0.23])
    assert sure.probabilities(np.array([0.5, np.inf]))[1] == 0.0
    assert sure.probabilities(np.array([np.inf])).tolist() == [0.0, 1.0]


def test_weights_follow_the_success_on_held_out_views() -> None:
    rng = np.random.default_rng(0)
    told, even = drawn(0, 300), replace(SHIPPED, weights=(0.5, 0.5))
    noise = HeldOut(np.exp(rng.normal(0, 0.3, told.normalised.shape)), told.truth)
    first, second = (calibrate_jointly(each, start=even).weights for each in ((told, noise), (noise, told)))
    assert first == pytest.approx(second[::-1], abs=0.01) and first[0] > 0.6
    assert sum(first) == pytest.approx(1.0)


def test_one_descriptor_is_calibrated_without_weights() -> None:
    held = drawn(3, 200)
    assert calibrate_jointly([held], start=SHIPPED) == calibrate(held)


def test_expected_calibration_error_by_hand() -> None:
    confidence = np.array([0.95, 0.95, 0.15, 0.15])
    right = np.array([True, False, False, False])
    assert expected_calibration_error(confidence, right) == pytest.approx((0.9 + 0.3) / 4)


def drawn(seed: int, known: int) -> HeldOut:
    """Draw held-out answers from the model itself, with three categories."""
    rng = np.random.default_rng(seed)
    truth = rng.integers(0, 3, known)
    normalised = 1 + rng.exponential(0.8, (known, 3))
    normalised[np.arange(known), truth] = rng.normal(0.6, 0.15, known).clip(0.05)
    return HeldOut(normalised, truth)


def test_fitted_probabilities_are_calibrated_on_new_answers() -> None:
    calibration, fresh = calibrate(drawn(0, 300)), drawn(1, 2000)
    known, truth = fresh.as_known
    rows = np.concatenate([known, fresh.as_unknown])
    probabilities = calibration.probabilities(rows)
    answers = np.concatenate([truth, np.full(len(fresh.as_unknown), 3)])
    right = probabilities.argmax(axis=1) == answers
    assert expected_calibration_error(probabilities.max(axis=1), right) < 0.05
    assert 0.8 < calibration.threshold < 1.2 and calibration.calibrated


def test_too_few_answers_leave_the_shipped_threshold() -> None:
    calibration = calibrate(drawn(0, MIN_HELD_OUT_ANSWERS - 1))
    assert calibration.threshold == SHIPPED.threshold and not calibration.calibrated
    assert calibrate(HeldOut(np.empty((0, 0)), np.empty(0, np.int64))) == SHIPPED


def test_wrong_settings_are_an_error() -> None:
    with pytest.raises(RecognitionError, match="between 0 and 1"):
        calibrate(drawn(0, 20), prior_unknown=1.0)
    with pytest.raises(RecognitionError, match="threshold must be a number above 0"):
        Calibration(threshold=float("nan"), even=1, doubt=1, choice=1)


def categories_of(seed: int, count: int = 3, views: int = 6) -> list[InstanceCategory]:
    rng = np.random.default_rng(seed)
    middles = rng.normal(size=(count, 5)) * 4
    return [
        InstanceCategory.of(
            f"c{c}", [(f"c{c}-{i}", (middles[c] + rng.normal(size=(4, 5))).astype(np.float32)) for i in range(views)]
        )
        for c in range(count)
    ]


@settings(deadline=None)
@given(st.integers(0, 1000))
def test_holding_out_equals_recognising_without_the_view(seed: int) -> None:
    categories = categories_of(seed)
    held = hold_out(categories, Recogniser.of(categories).indexes, DEFAULT)
    assert held.normalised.shape == (18, 3)
    row = seed % 18
    own = categories[held.truth[row]]
    key = own.views.ids[row % 6]
    without = Recogniser.of([known.without_view(key) if known is own else known for known in categories])
    wanted = {known.category: known.normalised for known in without.recognise(own.views[row % 6]).candidates}
    shorter = held.normalised[row] / [wanted[known.name] for known in categories]
    others = np.arange(3) != held.truth[row]
    np.testing.assert_allclose(shorter[others], 1.0, rtol=1e-12)
    assert (5 / 6) ** MAX_SHORTENING - 1e-12 <= shorter[held.truth[row]] <= 1.0 + 1e-12


def test_distance_falls_with_the_number_of_things() -> None:
    rng = np.random.default_rng(0)
    counts = rng.integers(2, 9, 200)
    falls = -0.15 * np.log(counts / (counts - 1))
    assert shortening(list(zip(counts.tolist(), falls.tolist(), strict=True))) == pytest.approx(0.15)
    assert shortening([(2, -9.0)]) == MAX_SHORTENING and shortening([(2, 0.0)]) == 0.0
    assert shortening([]) == USUAL_SHORTENING


def test_views_of_one_thing_are_held_out_together() -> None:
    categories = [
        replace(known, things={key: f"thing {i // 3}" for i, key in enumerate(known.views.ids)})
        for known in categories_of(0)
    ]
    held = hold_out(categories, Recogniser.of(categories).indexes, RecognitionSettings(over_things=False, shrinkage=0))
    first = categories[0]
    far = [first.views[i] for i in (3, 4, 5)]
    rest = InstanceCategory.of("rest", [(str(i), view) for i, view in enumerate(far)])
    wanted = category_distance(first.views[0], rest.views)[0] / (rest.intra_category_distance or np.nan)
    assert held.normalised[0, 0] == pytest.approx(wanted * 2**-USUAL_SHORTENING)  # no category has three things


def test_holding_out_of_many_views_searches_approximately() -> None:
    categories = categories_of(3, count=3, views=40)
    few = replace(DEFAULT, exact_up_to=0, effort=Effort(lists=1, few=1))
    exact, approximate = (hold_out(categories, Recogniser.of(categories).indexes, each) for each in (DEFAULT, few))
    others = np.arange(3) != exact.truth[:, None]
    assert (approximate.normalised >= exact.normalised - 1e-12).all()
    assert (approximate.normalised > exact.normalised + 1e-12)[others].any()
    assert np.array_equal(approximate.normalised[~others], exact.normalised[~others])


def test_one_view_gives_only_an_unknown_answer() -> None:
    categories = [*categories_of(1, count=2), categories_of(2, count=3, views=1)[2]]
    held = hold_out(categories, Recogniser.of(categories).indexes, DEFAULT)
    assert (len(held.as_known[0]), len(held.as_unknown)) == (12, 13)


def test_a_calibrated_recogniser_separates_known_and_unknown() -> None:
    known = Recogniser.of(categories_of(4)).calibrated()
    assert known.calibration.calibrated and known.calibration.known == 18
    assert known.recognise(known.categories[1].views[0] + np.float32(0.1)).label == "c1"
    assert known.recognise(known.categories[1].views[0] + np.float32(50)).label is None


def test_one_category_alone_cannot_be_calibrated() -> None:
    assert Recogniser.of(categories_of(0, count=1)).calibrated().calibration == SHIPPED


def test_auroc_counts_pairs() -> None:
    rng = np.random.default_rng(1)
    known, unknown = rng.integers(0, 9, 40).astype(float), rng.integers(3, 12, 30).astype(float)
    pairs = [(u > k) + 0.5 * (u == k) for u in unknown for k in known]
    assert auroc(known, unknown) == pytest.approx(np.mean(pairs))


def test_auroc_of_nothing_is_nan() -> None:
    assert np.isnan(auroc(np.empty(0), np.ones(2))) and np.isnan(auroc(np.ones(2), np.empty(0)))


def test_a_few_answers_calibrate_nothing() -> None:
    held = HeldOut(np.array([[0.9, 2.0], [2.0, 0.8]]), np.array([0, 1]))
    assert calibrate(held) == SHIPPED
    many = HeldOut(np.tile(held.normalised, (MIN_HELD_OUT_ANSWERS, 1)), np.tile(held.truth, MIN_HELD_OUT_ANSWERS))
    assert calibrate(many).calibrated


def test_the_weight_of_colour_begins_near_0_and_may_grow() -> None:
    coloured = beside_colour(SHIPPED_JOINT)
    *shapes, colour = coloured.weights
    assert sum(coloured.weights) == pytest.approx(1.0) and colour == COLOUR_WEIGHT
    assert shapes[0] / shapes[1] == pytest.approx(SHIPPED_JOINT.weights[0] / SHIPPED_JOINT.weights[1])
    assert coloured.weights_widths[-1] > max(coloured.weights_widths[:-1])


def test_no_distance_is_below_the_floor() -> None:
    floored = Calibration(1, 1, 1, 1, weights=(0.5, 0.5), floors=(1e-6, 0.25))
    shape = np.array([1.0, 1.0])
    assert floored.mean([shape, np.array([0.0, 0.2])]).tolist() == [0.5, 0.5]
    assert floored.mean([shape, np.array([1.0, np.inf])]).tolist() == [1.0, np.inf]


@pytest.mark.parametrize("values", [(0.1,), (0.1, 0.0)])
def test_floors_and_widths_are_one_for_each_weight(values: tuple[float, ...]) -> None:
    with pytest.raises(RecognitionError, match="floors must be above 0"):
        Calibration(1, 1, 1, 1, weights=(0.5, 0.5), floors=values)
    with pytest.raises(RecognitionError, match="weights_widths must be above 0"):
        Calibration(1, 1, 1, 1, weights=(0.5, 0.5), weights_widths=values)
