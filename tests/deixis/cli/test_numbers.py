"""Check that number options say in words what they allow, in their help and in their errors."""

from __future__ import annotations

import pytest
from commands import deixis


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("retrieve --top 0 a", "'--top': must be a whole number of at least 1, got 0"),
        ("retrieve --top many a", "'--top': must be a whole number of at least 1, got many"),
        ("retrieve --least 3 a", "'--least': must be a number from 0 to 1, got 3"),
        ("time --at noon a", "'--at': must be a number, got noon"),
        ("episodes add a b c --certainty high", "'--certainty': must be a number"),
        ("retrieve --top \x1b[31m a", r"got \u001b[31m"),
    ],
)
def test_the_error_says_what_is_allowed(command: str, message: str) -> None:
    code, out, err = deixis(*command.split(" "))
    assert (code, out) == (2, "")
    assert message in err


def test_the_help_gives_the_range_in_words() -> None:
    _, out, _ = deixis("retrieve", "--help")
    text = " ".join(out.split())
    assert "[default: 5; at least 1]" in text
    assert "[default: 0.5; 0 to 1]" in text


def test_a_number_within_the_range_is_taken() -> None:
    code, out, _ = deixis("simulate", "--seed", "0", "--help")
    assert code == 0
    assert "at least 0" in out
