"""Equation 4 and the decision, by hand, and the answers where the equations are undefined."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.calibration import Calibration
from deixis.perception.recognition.distances import view_distance
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.recogniser import Recogniser, recognise
from deixis.perception.recognition.settings import MIN_LABEL_PROBABILITY, PAPER, RecognitionSettings
from deixis.perception.recognition.spread import SpreadSource

STRICT = Calibration(threshold=1.5, even=1.5, doubt=3.0, choice=4.0)


def seen(*values: float) -> NDArray[np.float32]:
    """Return descriptors that are single numbers."""
    return np.array(values, np.float32)[:, None]


def category(name: str, *views: NDArray[np.float32]) -> InstanceCategory:
    return InstanceCategory.of(name, [(f"{name}{i}", view) for i, view in enumerate(views)])


WIDE = category("wide", seen(0), seen(8))  # ICD 8
NARROW = category("narrow", seen(20), seen(22))  # ICD 2


def test_the_smallest_normalised_distance_wins() -> None:
    found = recognise(seen(15), [WIDE, NARROW], PAPER, STRICT)
    by_name = {candidate.category: candidate for candidate in found.candidates}
    assert (by_name["wide"].distance, by_name["wide"].spread.value, by_name["wide"].normalised) == (7, 8, 7 / 8)
    assert (by_name["narrow"].distance, by_name["narrow"].normalised) == (5, 2.5)
    assert found.label == "wide" and found.candidates[0].nearest == "wide1"
    assert found.exact and found.probability == by_name["wide"].probability


def test_above_the_threshold_for_all_categories_is_unknown() -> None:
    found = recognise(seen(40), [WIDE, NARROW], PAPER, STRICT)
    assert found.label is None and found.candidates[0].normalised == 4.0
    assert found.probability == found.unknown > 0.9
    assert "above the threshold 1.5" in found.reasons[0]


def test_at_the_threshold_is_known() -> None:
    assert recognise(seen(25), [NARROW], replace(PAPER, prior_spread=2.0), STRICT).label == "narrow"


def test_one_view_is_divided_by_the_median_icd() -> None:
    single = category("single", seen(100))
    found = recognise(seen(101), [WIDE, NARROW, single], PAPER, STRICT)
    assert found.label == "single"
    assert found.candidates[0].spread.value == 5.0 and found.candidates[0].spread.source is SpreadSource.POOLED
    assert any("'single' has one view" in reason for reason in found.reasons)


def test_views_of_one_thing_count_as_one_thing() -> None:
    near = [("a", seen(20)), ("b", seen(20.5)), ("c", seen(26))]
    two = InstanceCategory.of("two", near, {"a": "x", "b": "x", "c": "y"})  # over things: 6 and 5.5, to and fro
    one = InstanceCategory.of("one", [("d", seen(100)), ("e", seen(101))], {"d": "z", "e": "z"})
    spreads = Recogniser.of([two, one], RecognitionSettings(shrinkage=0.0)).spreads
    assert [(spread.value, spread.source) for spread in spreads] == [
        (5.75, SpreadSource.MEASURED),
        (5.75, SpreadSource.POOLED),
    ]
    assert "'one' has one thing" in recognise(seen(102), [two, one], calibration=STRICT).reasons[1]
    assert recognise(seen(102), [two, one], PAPER, STRICT).candidates[0].spread.value == 1.0


def test_the_icd_of_few_things_shrinks_most() -> None:
    found = recognise(seen(23), [WIDE, NARROW], RecognitionSettings(shrinkage=2.0), STRICT).candidates[0]
    assert found.spread.value == (2 * 2 + 2 * 5) / 4 and found.spread.source is SpreadSource.SHRUNK
    many = category("narrow", *(seen(20 + 2 * (i % 2)) for i in range(200)))
    spread = Recogniser.of([WIDE, many], RecognitionSettings(shrinkage=2.0)).spreads[1]
    assert abs(spread.value - (many.intra_category_distance or 0.0)) < 0.1


def test_the_reason_names_the_divisor_of_d_c() -> None:
    (plain, *_), (drawn, *_) = (
        recognise(seen(23), [WIDE, NARROW], settings, STRICT).reasons
        for settings in (PAPER, RecognitionSettings(shrinkage=2.0))
    )
    assert "ND 0.5 (D_C 1 to view 'narrow1' / 2: its ICD over 2 views), within" in plain
    assert "(D_C 1 to view 'narrow1' / 3.5: its ICD over 2 things, 2, shrunk towards the median); its" in drawn


def test_identical_views_are_divided_by_the_median_icd() -> None:
    found = recognise(seen(101), [WIDE, category("copies", seen(100), seen(100))], PAPER, STRICT)
    assert found.candidates[0].category == "copies" and found.candidates[0].normalised == 1 / 8
    assert any("no two views that differ" in reason for reason in found.reasons)


def test_a_constant_replaces_the_icd_if_there_is_no_other() -> None:
    settings = RecognitionSettings(prior_spread=4.0)
    found = recognise(seen(1), [category("only", seen(0))], settings, STRICT)
    assert found.candidates[0].normalised == 0.25 and found.candidates[0].spread.source is SpreadSource.PRIOR
    assert any("a constant" in reason for reason in found.reasons[1:])


def test_a_view_without_descriptors_is_unknown() -> None:
    found = recognise(np.empty((0, 1), np.float32), [WIDE])
    assert (found.label, found.candidates, found.unknown) == (None, (), 1.0)
    assert found.reasons == ("the view has no descriptor: nothing on it could be described",)


def test_nothing_taught_is_unknown() -> None:
    assert recognise(seen(1), []).reasons == ("no category has been taught",)


def test_a_category_of_empty_views_is_never_the_answer() -> None:
    dark = InstanceCategory("dark").with_view("d", np.empty((0, 1), np.float32))
    found = recognise(seen(1), [dark, WIDE], calibration=STRICT)
    assert found.label == "wide"
    last = found.candidates[-1]
    assert (last.category, last.distance, last.nearest, last.probability) == ("dark", math.inf, None, 0.0)
    alone = recognise(seen(1), [dark])
    assert alone.label is None and alone.unknown == 1.0 and alone.reasons == ("no remembered view has a descriptor",)


def test_the_same_view_again_is_certain() -> None:
    found = recognise(seen(0), [WIDE, NARROW], calibration=STRICT)
    assert found.candidates[0].normalised == 0.0 and found.probability > 0.999


def random_categories(seed: int) -> tuple[list[InstanceCategory], NDArray[np.float32]]:
    rng = np.random.default_rng(seed)

    def view() -> NDArray[np.float32]:
        return rng.normal(size=(rng.integers(1, 8), 6)).astype(np.float32)

    return [category(name, *(view() for _ in range(rng.integers(1, 6)))) for name in "abcd"], view()


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_equations_as_written_give_the_same_answer(seed: int) -> None:
    categories, target = random_categories(seed)
    found = recognise(target, categories)
    for candidate in found.candidates:
        own = next(known for known in categories if known.name == candidate.category)
        least = min(view_distance(target, own.views[i]) for i in range(len(own)))
        assert candidate.distance == pytest.approx(least, rel=1e-12)
        assert candidate.normalised == candidate.distance / candidate.spread.value
    normalised = [candidate.normalised for candidate in found.candidates]
    assert normalised == sorted(normalised)
    assert (found.label is not None) == (found.candidates[0].probability >= MIN_LABEL_PROBABILITY)
    assert sum(candidate.probability for candidate in found.candidates) + found.unknown == pytest.approx(1)


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_learning_and_forgetting_equal_starting_again(seed: int) -> None:
    categories, target = random_categories(seed)
    grown = Recogniser.of(categories[:1]).learned(category("z", seen(*[0.0] * 3).repeat(6, axis=1)))
    for known in categories[1:]:
        for count in range(1, len(known) + 1):
            grown = grown.learned(category(known.name, *(known.views[i] for i in range(count))))
    assert grown.forgotten("z").recognise(target).candidates == Recogniser.of(categories).recognise(target).candidates


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_the_order_of_categories_does_not_matter(seed: int) -> None:
    categories, target = random_categories(seed)
    one, other = recognise(target, categories), recognise(target, categories[::-1])
    assert one.label == other.label
    assert [known.normalised for known in one.candidates] == [known.normalised for known in other.candidates]


def test_an_approximate_search_is_among_the_reasons() -> None:
    found = recognise(seen(7), [WIDE, NARROW], RecognitionSettings(exact_up_to=3))
    assert found.label == "wide" and not found.exact and "approximate" in found.reasons[-1]


def test_wrong_categories_and_settings_are_an_error() -> None:
    with pytest.raises(RecognitionError, match="names of categories must be distinct"):
        Recogniser.of([WIDE, WIDE])
    with pytest.raises(RecognitionError, match="different lengths: 1 in 'wide', 2 in 'flat'"):
        Recogniser.of([WIDE, category("flat", np.zeros((1, 2), np.float32))])
    with pytest.raises(RecognitionError, match="unknown category 'x'"):
        Recogniser.of([WIDE]).forgotten("x")
    with pytest.raises(RecognitionError, match="the remembered views' 1"):
        recognise(np.zeros((1, 2), np.float32), [WIDE])
    with pytest.raises(RecognitionError, match="`prior_spread` must be"):
        RecognitionSettings(prior_spread=0.0)
    with pytest.raises(RecognitionError, match="`shrinkage` must be at least 0"):
        RecognitionSettings(shrinkage=-1.0)
