"""Test the assertions for users' suites: what passes, and what the messages of failures show."""

from __future__ import annotations

import pytest

from deixis.errors import DeixisError
from deixis.examples_data import example
from deixis.testing import (
    assert_checks,
    assert_consistent,
    assert_contradictory,
    assert_follows,
    assert_grounds,
    assert_not_follows,
)

DINNER, SETTING = example("formal_dinner.layout"), example("place_setting.scene.json")
SECOND = example("second_table.scene.json")
CHAIN = "fork left of plate; plate left of knife"


def test_matches_that_hold_pass() -> None:
    found = assert_grounds(DINNER, SETTING, {"napkin": "o2", "dinner_plate": "o8"}, decided=True)
    assert found.matches["fork" if "fork" in found.matches else "salad_fork"].decided


def test_a_wrong_match_shows_what_was_found() -> None:
    with pytest.raises(AssertionError, match=r"(?s)napkin must be o8, got o2.*The whole grounding:.*dinner_plate"):
        assert_grounds(DINNER, SETTING, {"napkin": "o8"})


def test_an_absent_object_may_be_expected() -> None:
    scene = {"objects": [{"id": 1, "min": [0, 0], "max": [1, 1]}, {"id": 2, "min": [2, 0], "max": [3, 1]}]}
    script = "a left of b; optional c left of a"
    assert_grounds(script, scene, {"a": 1, "b": 2})
    with pytest.raises(AssertionError, match="a must be absent, got 1"):
        assert_grounds(script, scene, {"a": None})


def test_undecided_matches_show_the_alternatives() -> None:
    scene = {"objects": [{"id": i, "min": [2 * i, 0], "max": [2 * i + 1, 1]} for i in range(3)]}
    with pytest.raises(AssertionError, match="and not decided; it could be "):
        assert_grounds("a left of b", scene, {"b": 2}, decided=True)


def test_an_expected_name_must_be_in_the_script() -> None:
    with pytest.raises(DeixisError, match="`expected` names 'spoon', which the script does not mention"):
        assert_grounds(CHAIN, SETTING, {"spoon": "o1"})


def test_following_facts_pass_and_others_show_a_picture() -> None:
    assert_follows(CHAIN, "left(fork, knife)")
    with pytest.raises(AssertionError, match=r"(?s)top\(fork, knife\) does not follow.*fork"):
        assert_follows(CHAIN, "above(fork, knife)")


def test_a_fact_that_follows_shows_its_derivation() -> None:
    assert_not_follows(CHAIN, "above(fork, knife)")
    with pytest.raises(AssertionError, match=r"(?s)left\(fork, knife\) follows:.*left\(fork, plate\)"):
        assert_not_follows(CHAIN, "left(fork, knife)")


def test_contradictions_show_the_minimal_conflict() -> None:
    assert_consistent(CHAIN)
    with pytest.raises(AssertionError, match=r"(?s)left\(a, b\).*left\(b, a\)"):
        assert_consistent("a left of b; b left of a; c left of a")


def test_a_script_that_can_hold_shows_a_table() -> None:
    assert_contradictory("a left of b; b left of a")
    with pytest.raises(AssertionError, match=r"(?s)this table satisfies it:.*fork"):
        assert_contradictory(CHAIN)


def test_checks_name_exactly_the_faults() -> None:
    assert_checks(DINNER, SETTING)
    faults = {"missing": ["water_glass"], "misplaced": ["dinner_fork", "dinner_knife"], "extra": ["p1"]}
    assert_checks(DINNER, SECOND, **faults)
    with pytest.raises(AssertionError, match="missing must be empty, got water_glass"):
        assert_checks(DINNER, SECOND)
    with pytest.raises(AssertionError, match="extra must be empty, got p1"):
        assert_checks(DINNER, SECOND, **{**faults, "extra": []})
