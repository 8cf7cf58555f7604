"""Reading JSON strictly: each mistake comes with its place and with what to do."""

from __future__ import annotations

import pytest

from deixis.errors import DeixisError
from deixis.ontology.strict_json import parse_json, parse_json_line, read_json_lines


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"objects": [\n {"id": "a",\n {"id": "b"}]}', "3:2: the '{' at 2:2 is not closed; add '}' before the ','"),
        ('{"objects": [\n {"id": "a"\n]}', "3:1: the '{' at 2:2 is not closed; add '}' before this ']'"),
        ('{"min": [0, 1}', "1:14: the '[' at 1:9 is not closed; add ']' before this '}'"),
        ('{"objects": []', "1:15: the '{' at 1:1 is not closed; add '}' at the end"),
        ('{"a}": [1, 2', "1:13: the '[' at 1:8 is not closed; add ']' at the end"),
        ("[1, 2,]", "1:7: remove the ',' before this ']'"),
        ('{"a": 1,}', "1:9: remove the ',' before this '}'"),
        ('[{"a": 1} {"a": 2}]', "1:11: a ',' is missing before this"),
        ('{"a" 1}', "1:6: a ':' is missing between the key and its value"),
        ("{'a': 1}", '1:2: write strings in double quotes ("), not in single ones'),
        ('{"a": "b\n"}', "1:9: a string must be closed by '\"' on its own line"),
        ("[fork]", "1:2: a value is expected here"),
        (" \n", ": the text is empty"),
    ],
    ids=range(13),
)
def test_a_mistake_comes_with_what_to_do(text: str, message: str) -> None:
    place, _, what = message.partition(": ")
    with pytest.raises(DeixisError) as caught:
        parse_json(text, "t.json", DeixisError, None)
    assert place in str(caught.value)
    assert f"this is not valid JSON: {what}" in str(caught.value)


def test_mistakes_in_a_file_of_json_lines_have_their_line() -> None:
    with pytest.raises(DeixisError, match=r"^t.jsonl:3:9: .* the '\{' at 3:4 is not closed"):
        parse_json_line('\ufeff[1,{"a":', "t.jsonl", 3, DeixisError, None)
    with pytest.raises(DeixisError, match=r"^t.jsonl:3: the JSON is nested too deeply"):
        parse_json_line("[" * 50_000, "t.jsonl", 3, DeixisError, None)


def test_refused_lines_are_left_out_and_reported() -> None:
    def positive(data: int, where: str) -> int:
        if data <= 0:
            raise DeixisError(f"{where}: must be positive, got {data}")
        return data

    lines, refused = ["3", " ", "-1", "{", "4"], list[str]()
    assert list(read_json_lines(lines, "t.jsonl", positive, DeixisError, None, refused)) == [(1, 3), (5, 4)]
    assert [message.split(" ")[0] for message in refused] == ["t.jsonl:3:", "t.jsonl:4:"]
    with pytest.raises(DeixisError, match=r"t\.jsonl:3: must be positive"):
        list(read_json_lines(lines, "t.jsonl", positive, DeixisError, None))


@pytest.mark.parametrize("digits", ["9" * 309, "-" + "9" * 309, "9" * 5000], ids=len)
@pytest.mark.parametrize("no_number", [None, "is not a number"])
def test_whole_numbers_that_no_double_holds_are_refused(digits: str, no_number: str | None) -> None:
    with pytest.raises(DeixisError, match=r"^t\.json:1:2: a number of \d+ digits is too large: at most 308 "):
        parse_json(f"[{digits}]", "t.json", DeixisError, no_number)


@pytest.mark.parametrize("sign", ["", "-"])
def test_the_largest_whole_number_converts_to_a_double(sign: str) -> None:
    (number,) = parse_json(f"[{sign}{'9' * 308}]", "t.json", DeixisError, None)
    assert abs(float(number)) == 1e308


def test_numbers_that_overflow_are_refused_where_infinity_is() -> None:
    with pytest.raises(DeixisError, match=r"^t\.json:1:7: the number -1e400 is too large"):
        parse_json('{"x": -1e400}', "t.json", DeixisError, "is not a number")
    assert parse_json("[1e400]", "t.json", DeixisError, None) == [float("inf")]
