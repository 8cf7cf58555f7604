"""Numbers in text: equal to those that Python reads, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deixis.perception.clouds.content import Content
from deixis.perception.clouds.tables.number_table import read_table
from deixis.perception.errors import CloudError

FORMATS = ("{!r}", "{:.9g}", "{:e}", "{:.20f}", "{:.25e}", "{:+}", "{:.0f}")


def table(text: str, rows: int, width: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    content = Content("t.xyz", np.frombuffer(text.encode(), np.uint8))
    return read_table(content, 0, rows, width, range(width)).columns


@given(st.lists(st.tuples(st.floats(), st.sampled_from(FORMATS)), min_size=1, max_size=8))
@example([(5e-324, "{!r}"), (1.7976931348623157e308, "{!r}"), (2.0**53 + 2, "{:.0f}"), (-0.0, "{!r}")])
@settings(deadline=None)  # the first call compiles
def test_floats_are_read_as_python_reads_them(numbers: list[tuple[float, str]]) -> None:
    words = [form.format(number) for number, form in numbers]
    found = table(" ".join(words), 1, len(words))[0]
    np.testing.assert_array_equal(found.view(np.int64), np.array([float(w) for w in words]).view(np.int64))


@given(st.from_regex(r"[+-]?([0-9]{1,25}\.?[0-9]{0,25}|\.[0-9]{1,9})([eE][+-]?[0-9]{1,3})?", fullmatch=True))
@example("9007199254740993")
@example("123456789012345678901234567890e-10")
@example("0.000000000000000000000000000000000000000000000000000000000000000001e70")
@example("1" + "0" * 400)
@example("0e999")
@settings(deadline=None)
def test_decimals_are_read_as_python_reads_them(word: str) -> None:
    assert table(f"{word} 0", 1, 2)[0, 0] == float(word)


@given(st.integers(2**52, 2**53 - 1), st.integers(-4, 4))
@settings(deadline=None)
def test_a_decimal_halfway_between_doubles_rounds_to_even(half: int, power: int) -> None:
    tie = 2 * half + 1  # 54 bits, the last of which is set
    digits = tie * 5**-power if power < 0 else tie
    word = f"{digits}e{power}" if power < 0 else str(tie << power)
    assert table(f"{word} 0", 1, 2)[0, 0] == float(word)


def test_random_decimals_are_read_as_python_reads_them() -> None:
    rng = np.random.default_rng(17)
    digits = rng.integers(1, 2**63, 20_000) >> rng.integers(0, 63, 20_000)
    words = [f"{w}e{power}" for w, power in zip(digits.tolist(), rng.integers(-110, 70, 20_000).tolist(), strict=True)]
    np.testing.assert_array_equal(table("\n".join(words), len(words), 1)[:, 0], [float(word) for word in words])


@pytest.mark.parametrize("word", ["nan", "NaN", "-nan", "inf", "-Infinity", "+INF"])
def test_nan_and_infinity_are_read_as_words(word: str) -> None:
    np.testing.assert_array_equal(table(f"{word}\n", 1, 1)[0, 0], float(word))


@pytest.mark.parametrize(
    "word", ["1_0", "0x10", "1e", "1e+", "--1", ".", "+", "1.2.3", "1,5", "nano", "infinite", "1f", "²", "1d5", "na"]
)
def test_other_words_are_refused_as_numbers(word: str) -> None:
    with pytest.raises(CloudError, match=r"^t\.xyz:2: expected a number, got '"):
        table(f"1 2\n3 {word}", 2, 2)


def test_blank_lines_and_comments_are_skipped() -> None:
    assert table("\n# x y\n1\t2  \r\n\n// so\n 3 4", 2, 2).tolist() == [[1, 2], [3, 4]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("10 20\n30\n40 50", ":2: this line has 1 of the 2 values that the header declares"),
        ("1 2\n3 4 5\n6 7", ":2: this line has more than the 2 values that the header declares"),
        ("1 2\n3 4      ", ":2: the file ends after 2 of 3 rows"),
        ("1 2", ":1: the header declares 3 rows of 2 values, but the file has room for 2 values"),
        (f"1 {'7' * 1001}\n1 2\n3 4", ":1: a number must have at most 1000 characters, got 1001"),
    ],
)
def test_errors_name_the_line(text: str, message: str) -> None:
    with pytest.raises(CloudError) as raised:
        table(text, 3, 2)
    assert message in str(raised.value)
