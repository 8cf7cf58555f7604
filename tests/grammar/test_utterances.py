"""Utterances and files of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from source_tree import ROOT

from deixis.grammar.utterances import Utterance, UtteranceError, read_utterances, utterances_of_lines


def test_lines_are_put_in_order_of_time() -> None:
    found = utterances_of_lines(['{"text": "b", "at": 2}', "", '{"text": "a", "at": 1, "confidence": 0.5}'])
    assert [(one.text, one.confidence) for one in found] == [("a", 0.5), ("b", 1.0)]


def test_a_line_separator_in_a_text_ends_no_line(tmp_path: Path) -> None:
    said = Utterance("this is\u2028a fork", 1.0)
    (tmp_path / "words.said.jsonl").write_text(json.dumps(said.to_dict(), ensure_ascii=False), encoding="utf-8")
    assert read_utterances(tmp_path / "words.said.jsonl") == (said,)


def test_an_utterance_is_read_from_its_own_data() -> None:
    said = Utterance("this is a fork", 1.0, 2.5, "anna", 0.9)
    assert utterances_of_lines([json.dumps(said.to_dict())]) == (said,)


def test_the_shipped_lines_satisfy_the_schema() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((ROOT / "docs" / "schema" / "utterance.schema.json").read_text(encoding="utf-8"))
    said = read_utterances(ROOT / "examples" / "showing.said.jsonl")
    assert len(said) == 4
    for one in said:
        jsonschema.validate(one.to_dict(), schema)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('{"text": "a"}', "'at' is missing"),
        ('{"text": " ", "at": 1}', "not all blank"),
        ('{"text": 3, "at": 1}', "'text' must be a string"),
        ('{"text": "a", "at": "1"}', "'at' must be a number"),
        ('{"text": "a", "at": NaN}', "NaN is not a number"),
        ('{"text": "a", "at": 2, "until": 1}', "'until' must not be before"),
        ('{"text": "a", "at": 2, "confidence": 1.5}', "'confidence' must be from 0 to 1"),
        ('{"text": "a", "at": 2, "by": "x"}', 'unknown key "by"'),
        ("3", "must be an object"),
    ],
)
def test_a_wrong_line_is_named(line: str, message: str) -> None:
    with pytest.raises(UtteranceError, match="said.jsonl:1.*" + message):
        utterances_of_lines([line], "said.jsonl")


def test_wrong_lines_are_left_out_and_named_if_asked(tmp_path: Path) -> None:
    file, refused = tmp_path / "words.said.jsonl", list[str]()
    file.write_bytes(b'{"text": "a", "at": 1}\n{"at": 2}\n\xff\n{"text": "b", "at": 0}\n')
    assert [one.text for one in read_utterances(file, refused)] == ["b", "a"]
    assert [message.removeprefix(str(file)) for message in refused] == [
        ":2: 'text' is missing",
        ":3:1: the line is not UTF-8; save the file as UTF-8",
    ]
