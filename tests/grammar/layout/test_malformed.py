"""The catalogue of malformed scripts, malformed.txt, each with its whole error message.

A case is the script, a line ``----`` and the message; a line ``====`` separates two cases.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.parser import parse_script

CASES = [
    tuple(case.split("\n----\n"))
    for case in Path(__file__).with_name("malformed.txt").read_text(encoding="utf-8").rstrip("\n").split("\n====\n")
]


def test_the_catalogue_is_complete() -> None:
    assert len(CASES) >= 100
    assert len({script for script, _ in CASES}) == len(CASES)


@pytest.mark.parametrize(("script", "message"), CASES, ids=[script[:40] for script, _ in CASES])
def test_malformed(script: str, message: str) -> None:
    with pytest.raises(ScriptError) as caught:
        parse_script(script, "t.layout")
    assert str(caught.value) == message


@pytest.mark.parametrize("character", ["\0", "\x07", "\r", "\x1b"])
def test_control_characters(character: str) -> None:
    for script, where in ((f"ab{character} on c", "a script"), (f'"b{character}" on c', "a name")):
        with pytest.raises(ScriptError) as caught:
            parse_script(script)
        (problem,) = caught.value.problems
        assert problem.message == f"a control character (U+{ord(character):04X}) cannot be in {where}"
        assert (problem.source.line, problem.source.column) == (1, 3)


def test_long_lines_are_cut_around_the_caret() -> None:
    with pytest.raises(ScriptError) as caught:
        parse_script("x" * 500 + " ? " + "y" * 500)
    _, line, caret, _ = str(caught.value).split("\n")
    assert (len(line), line[0], line[-1], line[caret.index("^")]) == (102, "…", "…", "?")
