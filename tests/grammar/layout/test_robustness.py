"""Large and hostile input: a clear ScriptError in bounded time."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from timing import processor_time_below

from deixis.grammar.errors import ScriptError
from deixis.grammar.layout.parser import parse_script

_PIECES = 'the a fork plate left of on to or not is and , ; . ( ) : " # 2 99 usually optional layout include exactly'
PIECES = st.sampled_from([*_PIECES.split(), "\n"])


def problems(text: str) -> ScriptError:
    with pytest.raises(ScriptError) as caught:
        parse_script(text)
    return caught.value


@pytest.mark.slow
def test_a_hundred_thousand_lines() -> None:
    with processor_time_below(60):  # takes about 6 s
        script = parse_script("".join(f"fork{i} left of plate\n" for i in range(100_000)))
        assert len(script.facts) == 100_000


@pytest.mark.parametrize(
    "text",
    [
        "x" * 1_000_000,
        "word " * 200_000,
        "to the " * 150_000,
        "the " * 250_000,
        "left the " * 100_000,
        "x at the top " * 80_000,
        "(" * 100_000,
        "left(" * 100_000,
        '"' * 100_001,
        "\0" * 1_000_000,
        "?" * 1_000_000,
        "not " * 100_000,
        ", " * 100_000,
        "2" * 1_000_000,
        "- " * 100_000,
        "\u0301" * 100_000,
        "\ud800",
        "x\u2028y",
        "\x85",
    ],
    ids=lambda text: f"{text[:9]!r}",
)
def test_one_long_line(text: str) -> None:
    with processor_time_below(15):
        message = str(problems(text))
        assert len(message) < 2_000


def test_long_lists() -> None:
    many = ", ".join(f"n{i}" for i in range(50_000))
    assert len(parse_script(f"{many} left of plate").facts) == 50_000
    (problem,) = problems(f"{many} left of {many.replace('n', 'm')}").problems
    assert problem.message == "a script must state at most 1,000,000 facts; this statement exceeds that"
    (problem,) = problems(", ".join(f"99 n{i}" for i in range(20_000)) + " left of x").problems
    assert problem.message == "a script must name at most 1,000,000 objects; this statement exceeds that"


@given(st.text() | st.lists(PIECES).map(" ".join))
def test_every_text_is_read_or_raises_script_error(text: str) -> None:
    try:
        parse_script(text)
    except ScriptError as error:
        str(error)
