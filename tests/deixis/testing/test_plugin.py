"""Test the pytest plugin in suites of its own: fixtures, and layout files that are tests."""

from __future__ import annotations

import shutil

import numpy  # noqa: F401  (pytester forgets the modules of a run, and NumPy cannot be loaded twice)
import pytest

from deixis.errors import DeixisError
from deixis.examples_data import EXAMPLES
from deixis.testing.expectations import Expectation, expectations_in

BLOCK = """
# expect:
#   consistent
#   follows left(fork, knife)
#
#   not follows above(fork, knife)
#   grounds table.scene.json: fork = 1, knife = 3, candle = absent
"""
LAYOUT = "fork left of plate\nplate left of knife\noptional candle above plate\n"
SCENE = (
    '{"unit": "cm", "objects": [{"id": 1, "min": [0, 2], "max": [2.5, 21]},'
    ' {"id": 2, "min": [5, 0], "max": [30, 25]}, {"id": 3, "min": [33, 2], "max": [35, 23]}]}'
)


OPTIONS = ("-p", "no:dash")


def test_each_expectation_is_a_test(pytester: pytest.Pytester) -> None:
    (pytester.path / "dinner.layout").write_text(LAYOUT + BLOCK)
    (pytester.path / "table.scene.json").write_text(SCENE)
    pytester.runpytest_inprocess(*OPTIONS).assert_outcomes(passed=4)


def test_a_failed_expectation_names_its_line_and_says_why(pytester: pytest.Pytester) -> None:
    (pytester.path / "dinner.layout").write_text(LAYOUT + "# expect:\n#   follows left(knife, fork)\n")
    result = pytester.runpytest_inprocess(*OPTIONS)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*dinner.layout:5: expected: follows left(knife, fork)", "*cannot hold*"])


def test_a_malformed_expectation_is_reported_without_frames(pytester: pytest.Pytester) -> None:
    (pytester.path / "dinner.layout").write_text(LAYOUT + "# expect: is nice\n")
    result = pytester.runpytest_inprocess(*OPTIONS)
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*dinner.layout:4:1: 'is nice' is not an expectation*"])
    result.stdout.no_fnmatch_line("*src/deixis*")


def test_a_broken_script_fails_with_its_place(pytester: pytest.Pytester) -> None:
    (pytester.path / "dinner.layout").write_text("fork lft of plate\n# expect:\n#   consistent\n")
    result = pytester.runpytest_inprocess(*OPTIONS)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*dinner.layout:1:*"])


def test_layouts_without_expectations_are_not_tests(pytester: pytest.Pytester) -> None:
    (pytester.path / "dinner.layout").write_text(LAYOUT)
    pytester.runpytest_inprocess(*OPTIONS).assert_outcomes()


def test_fixtures_read_files_beside_the_test(pytester: pytest.Pytester) -> None:
    for name in ("formal_dinner.layout", "place_setting.scene.json"):
        shutil.copy(EXAMPLES / name, pytester.path / name)
    pytester.makepyfile(
        """
        def test_all(deixis_script, deixis_scene, deixis_session):
            script = deixis_script("formal_dinner.layout")
            assert len(deixis_scene("place_setting.scene.json").objects) == len(script.objects) == 12
            assert deixis_script("fork left of plate").objects == ("fork", "plate")
            assert not deixis_session.remembers()
        """
    )
    pytester.runpytest_inprocess(*OPTIONS).assert_outcomes(passed=1)


def test_expectations_have_the_lines_of_the_file() -> None:
    found = list(expectations_in(LAYOUT + BLOCK, "dinner.layout"))
    lines = (LAYOUT + BLOCK).splitlines()
    assert [one.text for one in found] == [lines[one.line - 1].lstrip("# ") for one in found]
    assert found[0] == Expectation(6, "consistent")


def test_an_expectation_may_follow_the_word_expect() -> None:
    text = "fork left of plate\n# expect: consistent\n#   follows left(fork, plate)\n"
    expected = [Expectation(2, "consistent"), Expectation(3, "follows left(fork, plate)")]
    assert list(expectations_in(text, "dinner.layout")) == expected
    repeated = text.replace("#   follows", "# expect: follows")
    assert list(expectations_in(repeated, "dinner.layout")) == expected


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ("# expect:\n# is nice\n", "dinner.layout:2:1: 'is nice' is not an expectation"),
        ("# expect:\nfork left of plate\n", "dinner.layout:2:1: an expectation block is comments up to the end"),
    ],
)
def test_lines_that_are_not_an_expectation_are_refused(block: str, message: str) -> None:
    with pytest.raises(DeixisError, match=message):
        list(expectations_in(block, "dinner.layout"))


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('assert_follows("fork left of plate", "left(frok, plate)")', "*no object 'frok'; did you mean 'fork'?"),
        ('assert_follows("fork left of plate", "left(fork plate)")', "*expected a comma and a second name*"),
        ('assert_grounds("fork left of plate", "table.scene.json", {"fork": 9})', "*'9', which is not in the scene*"),
        ('deixis_script("none.layout")', "*none.layout: there is no such file"),
        ('assert_follows("fork left of plate", "left(plate, fork)")', "*left(plate, fork) cannot hold*"),
    ],
)
def test_failures_are_reported_at_the_line_of_the_test(pytester: pytest.Pytester, line: str, message: str) -> None:
    (pytester.path / "table.scene.json").write_text(SCENE)
    pytester.makepyfile(f"from deixis.testing import *\ndef test_dinner(deixis_script):\n    {line}\n")
    result = pytester.runpytest_inprocess(*OPTIONS)
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines([message])
    result.stdout.no_fnmatch_line("*src/deixis*")
    result.stdout.no_fnmatch_line("*workflows*")
