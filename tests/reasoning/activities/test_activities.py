"""Ground, learn and recognise activities."""

from __future__ import annotations

import copy
import json
import random
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deixis.grammar.activities import (
    ActivityTextError,
    announced_thing,
    read_activities,
    read_activity,
    told_activity,
)
from deixis.reasoning.activities.activity import Activity, StepSequence, box_of
from deixis.reasoning.activities.grounding import ground_activity, recognise_activity
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import Fluent, Statement
from deixis.workflows.reasoning.activities import learn, recognise


def laid(words: str) -> StepSequence:
    """Return the sequence in which things are laid, one a second; they all stay."""
    fluents = [Fluent(f"f{at}", Statement(word, "laid"), Bounds(at, at)) for at, word in enumerate(words.split())]
    return StepSequence.of(reversed(fluents))


@pytest.mark.parametrize(
    ("told", "groups"),
    [
        ("first the plate, then the forks", [["plate"], ["fork (all)"]]),
        ("Put the plate on the table. Then two forks and a knife; finally, the wine glass.",
         [["plate"], ["fork (2)", "knife"], ["wine_glass"]]),
        ("the plate before the forks", [["plate"], ["fork (all)"]]),
        ("After the plate, the cup comes. Lay the spoon last", None),
        ("first the plate, next the cup, after that the spoon", [["plate"], ["cup"], ["spoon"]]),
    ],
)  # fmt: skip
def test_told_orders_are_read(told: str, groups: list[list[str]] | None) -> None:
    read = [[str(item) for item in group] for group in read_activity(told)]
    assert groups is None or read == groups


@pytest.mark.parametrize("told", ["", "then", "first the 12 #, then", "the plate, then the plate"])
def test_what_names_no_things_is_refused(told: str) -> None:
    with pytest.raises((ActivityTextError, SettingError)):
        told_activity(told, laid("plate"))


@pytest.mark.parametrize(
    ("said", "thing"),
    [
        ("First the plate.", "plate"),
        ("Then the salad fork", "salad fork"),
        ("Now I put the knife down.", "knife"),
        ("Finally, the napkin goes on the plate.", "napkin"),
        ("And now, to the right of it, the water glass.", "water glass"),
        ("The plate.", None),
        ("Then two forks.", None),
        ("First the plate, then the fork.", None),
        ("Now, where is the cup?", None),
        ("And this is a fork.", None),
        ("Now the plate is not on the table.", None),
        ("Now the fork is left of the plate.", None),
        ("Then we go home.", None),
        ("now", None),
        ("", None),
    ],
)
def test_announcements_name_the_one_thing_that_is_laid(said: str, thing: str | None) -> None:
    assert announced_thing(said) == thing


def test_a_told_activity_is_grounded_with_its_faults() -> None:
    seen = laid("fork cup plate fork")
    found = ground_activity(told_activity("first the plate, then the forks, then the knife", seen), seen)
    matched = {str(match.step): match.fluent for match in found.matches}
    assert matched["plate"] == "f2" and {matched["fork"], matched["fork 2"]} == {"f0", "f3"}
    assert [str(step) for step in found.missing] == ["knife"] and found.other == ("f1",)
    assert {str(second) for _, second in found.swapped} <= {"fork", "fork 2"} and len(found.swapped) == 1


orders = st.permutations(["plate", "fork", "knife", "cup"]).map(lambda words: laid(" ".join(words)))


@settings(max_examples=15, deadline=None)
@given(st.lists(orders, min_size=1, max_size=4), st.randoms(use_true_random=False))
def test_the_order_of_examples_does_not_matter(examples: list[StepSequence], order: random.Random) -> None:
    shuffled = order.sample(examples, len(examples))
    first, second = Activity.learned("dinner", examples), Activity.learned("dinner", shuffled)
    parts = [Activity.learned("dinner", [example]) for example in shuffled]
    joined = sum(parts[1:], start=parts[0])
    for other in (second, joined):
        assert first.steps == other.steps and first.examples == other.examples
        np.testing.assert_allclose(first.counts, other.counts, atol=1e-9)
        np.testing.assert_allclose(first.present, other.present)


def test_learned_activities_are_recognised_with_noise(tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    learn("dinner", [laid("plate fork knife cup"), laid("plate knife fork cup")], known)
    learn("supper", [laid("cup knife fork plate")], known)
    learn("supper", [laid("cup fork knife plate")], known)
    assert [(each.name, each.examples) for each in read_activities(known)] == [("dinner", 2), ("supper", 2)]
    assert recognise(laid("plate candle fork cup"), known).name == "dinner"
    assert recognise(laid("cup fork plate"), known).name == "supper"
    assert recognise(laid("hat coat"), known).name is None


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("{", "json:1:2: this is not valid JSON"),
        ("{}", "must be an object with the list 'activities'"),
        ("[]", "must be an object with the list 'activities'"),
        ('{"activities": [7]}', "activity 1: it must be an object, got a number"),
        ('{"activities": [{"name": "x"}]}', "activity 'x': the key 'examples, steps, present, counts' is missing"),
    ],
)
def test_a_file_without_activities_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    (tmp_path / "known.json").write_text(text)
    with pytest.raises(ActivityTextError) as caught:
        read_activities(tmp_path / "known.json")
    assert reason in str(caught.value)


KNOWN = {
    "name": "tea",
    "examples": 2,
    "steps": [["cup", "laid", None, 1], ["spoon", None, "table", 1]],
    "present": [2.0, 1],
    "layings": [[["cup", [0.1, 0.2]], ["spoon", None]]],
    "counts": [[0, 1, 0, 1.0]],
}
VALUES: list[object] = [None, True, -1, 0.5, 10**300, "", "7", [], [None], [[1]], {}, {"a": 1}]


def places_in(data: object, before: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Return the place of every value in some JSON."""
    parts = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [before, *(place for key, part in parts for place in places_in(part, (*before, key)))]


@pytest.mark.parametrize("place", places_in(KNOWN)[1:], ids=str)
@pytest.mark.parametrize("value", VALUES, ids=str)
def test_a_wrong_value_never_breaks_the_reader(tmp_path: Path, place: tuple[str | int, ...], value: object) -> None:
    entry: Any = copy.deepcopy(KNOWN)
    inner = entry
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    file = tmp_path / "known.json"
    file.write_text(json.dumps({"activities": [entry]}))
    try:
        learn("tea", [laid("cup spoon")], file)
    except ActivityTextError as error:
        message = str(error)
        assert json.loads(file.read_text()) == {"activities": [entry]}  # nothing is lost
    else:
        message = ""
        recognise(laid("cup spoon"), file)
    assert not message or message.startswith(f"{file}: not a file of activities: activity ")


def test_steps_with_and_without_an_object_are_learned_together() -> None:
    parts = [("cup", "laid"), ("cup", "laid", "table"), ("cup", "kept", "table")]
    seen = StepSequence.of(Fluent(f"f{at}", Statement(*part), Bounds(at, at)) for at, part in enumerate(parts))
    activity = Activity.learned("tea", [seen])
    assert [str(step) for step in activity.steps] == ["cup kept table", "cup laid", "cup laid table"]
    assert (activity + activity).steps == activity.steps


def test_a_file_that_names_an_activity_twice_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "known.json"
    file.write_text(json.dumps({"activities": [KNOWN, KNOWN]}))
    with pytest.raises(ActivityTextError, match="activity 'tea': an earlier one has this name; rename one of them"):
        read_activities(file)


def test_an_activity_without_a_name_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingError, match="the name of an activity must have at least one word"):
        learn(" ", [laid("cup spoon")], tmp_path / "known.json")
    assert not (tmp_path / "known.json").exists()


def test_an_empty_sequence_matches_no_activity() -> None:
    dinner = Activity.learned("dinner", [laid("plate fork")])
    assert recognise_activity([dinner], laid("")).name is None


@pytest.mark.parametrize(
    "box", ["[" * 50_000, f"[{'9' * 400}, 1, 2, 3]", "[1e400, 1, 2, 3]", '{"a": 1}', "null", "[true]", "x"]
)
def test_a_place_that_is_not_a_box_is_refused(box: str) -> None:
    assert box_of(Statement("cup", "at", box)) is None
    assert StepSequence.of([Fluent("f1", Statement("cup", "at", box), Bounds(1, 1))]).laying[0].place is None


def test_examples_that_are_learned_at_once_are_all_kept(tmp_path: Path) -> None:
    known = tmp_path / "known.json"
    threads = [threading.Thread(target=learn, args=("tea", [laid("cup spoon")], known)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [each.examples for each in read_activities(known)] == [8]
    assert list(tmp_path.iterdir()) == [known]


@pytest.mark.parametrize(("said", "number"), [("nine", 9), ("twelve", 12), ("the seven", 7), ("10", 10), ("two", 2)])
def test_a_number_of_things_is_never_a_part_of_their_name(said: str, number: int) -> None:
    ((item,),) = read_activity(f"first {said} cups")
    assert (item.kind, item.count) == ("cup", number)
