"""Predict what is laid next, and where."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.reasoning.activities.activity import Activity, LaidThing, Laying, Step
from deixis.reasoning.activities.prediction import LayingModel
from deixis.reasoning.errors import NothingFoundError, SettingError
from deixis.workflows.reasoning.activities import learn, predict

PLACES = {"plate": (0.0, 0.0), "fork": (-0.2, 0.0), "knife": (0.2, 0.0), "cup": (0.3, 0.3)}


def laid(words: str, x: float = 0.0) -> Laying:
    """Return a laying of kinds, at their places shifted by x."""
    return tuple(LaidThing(word, (PLACES[word][0] + x, PLACES[word][1])) for word in words.split())


def likeliest(model: LayingModel, words: str) -> str:
    return model.predict(laid(words)).things[0].kind


layings = st.lists(st.permutations(list(PLACES)), min_size=1, max_size=5).map(
    lambda orders: [laid(" ".join(order)) for order in orders]
)


def test_steps_wait_for_what_always_comes_before() -> None:
    model = LayingModel([laid("plate fork knife cup"), laid("plate knife fork cup")] * 2)
    assert likeliest(model, "") == "plate"
    found = model.predict(laid("plate"))
    assert {thing.kind for thing in found.things[:2]} == {"fork", "knife"}
    assert likeliest(model, "plate knife") == "fork" and likeliest(model, "plate knife fork") == "cup"
    assert model.predict(laid("plate fork knife cup")).finished == 1.0


def test_what_mostly_follows_directly_is_predicted() -> None:
    model = LayingModel([laid("knife fork cup"), laid("cup knife fork")] * 3)
    assert likeliest(model, "knife") == "fork"


def test_optional_step_may_be_left_out() -> None:
    model = LayingModel([laid("plate fork cup"), laid("plate fork"), laid("plate fork"), laid("plate fork")])
    assert model.predict(laid("plate fork")).finished > 0.5
    assert model.predict(laid("plate")).finished < 0.1


def test_told_order_counts_until_examples_outvote_it() -> None:
    told = Activity.in_order("told", [[Step("cup")], [Step("plate")]])
    assert LayingModel([], told).predict(()).things[0].kind == "cup"
    assert LayingModel([laid("plate cup")], told).predict(()).things[0].kind == "cup"
    assert LayingModel([laid("plate cup")] * 6, told).predict(()).things[0].kind == "plate"


def test_place_goes_with_the_things_that_are_there() -> None:
    model = LayingModel([laid("plate fork knife", x) for x in (-0.2, 0.0, 0.1)])
    place = model.place("fork", laid("plate", x=0.5))
    assert place is not None and place.anchor == "plate"
    assert place.place == pytest.approx((0.3, 0.0), abs=0.03) and place.offset == pytest.approx((-0.2, 0.0), abs=0.03)
    assert model.place("cup", laid("plate")) is None


def test_second_thing_of_a_kind_goes_to_the_free_place() -> None:
    pair = (*laid("plate"), LaidThing("fork", (-0.2, 0.0)), LaidThing("fork", (-0.3, 0.0)))
    model = LayingModel([pair] * 3)
    for there, free in ((-0.2, -0.3), (-0.3, -0.2)):
        place = model.place("fork", (*laid("plate"), LaidThing("fork", (there, 0.0))))
        assert place is not None and place.place[0] == pytest.approx(free, abs=0.01)


@given(layings, st.permutations(list(PLACES)), st.integers(0, 4), st.integers())
@settings(max_examples=30, deadline=None)
def test_probabilities_sum_to_one_in_any_order_of_examples(
    examples: list[Laying], order: list[str], count: int, seed: int
) -> None:
    so_far = laid(" ".join(order[:count]))
    found = LayingModel(examples).predict(so_far)
    assert found.finished + sum(thing.probability for thing in found.things) == pytest.approx(1)
    assert not {thing.kind for thing in found.things} & {thing.kind for thing in so_far}
    again = LayingModel(random.Random(seed).sample(examples, len(examples))).predict(so_far)
    for one, other in zip(found.things, again.things, strict=True):
        assert one.probability == pytest.approx(other.probability)


def test_learned_activity_keeps_places_in_its_file(tmp_path: Path) -> None:
    fluents = [
        {"id": kind, "statement": [kind, "at", json.dumps([x - 0.1, y - 0.1, x + 0.1, y + 0.1])], "start": [at, at]}
        for at, (kind, (x, y)) in enumerate(PLACES.items())
    ]
    file, known = tmp_path / "a.fluents.json", tmp_path / "known.json"
    file.write_text(json.dumps({"origin": "noon", "fluents": fluents}), encoding="utf-8")
    learn("dinner", [file], known)
    thing = predict(None, known).things[0]
    assert thing.kind == "plate" and thing.place is not None
    assert thing.place.place == pytest.approx((0.0, 0.0), abs=1e-6)
    learn("lunch", [file], known)
    with pytest.raises(SettingError, match="dinner, lunch"):
        predict(None, known)
    with pytest.raises(NothingFoundError, match="'supper'"):
        predict(None, known, "supper")
