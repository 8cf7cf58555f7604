"""Files of skeletons."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from source_tree import ROOT

from deixis.perception.errors import PointingError
from deixis.perception.formats.skeletons import read_skeletons, skeletons_of_lines


def line(at: object, **joints: object) -> str:
    return json.dumps({"at": at, "joints": joints})


def test_the_shipped_lines_satisfy_the_schema() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((ROOT / "docs" / "schema" / "skeleton.schema.json").read_text(encoding="utf-8"))
    text = (ROOT / "examples" / "showing.skeleton.jsonl").read_text(encoding="utf-8").splitlines()
    for one in text[:3]:
        jsonschema.validate(json.loads(one), schema)


def test_clocks_that_run_backwards_drop_the_frame() -> None:
    found = skeletons_of_lines([line(1), line(0.5), line(1), line(2)], "a.jsonl")
    assert [one.at for one in found.skeletons] == [1, 2]
    assert found.notes == ("a.jsonl: 2 lines, the first is 2: the time does not increase, so the frame is left out",)


def test_a_joint_that_is_not_finite_is_not_seen() -> None:
    found = skeletons_of_lines(['{"at": 1, "joints": {"head": [NaN, 0, 0], "neck": null, "left_hand": [0, 0, 1]}}'])
    assert found.skeletons[0].joints == {"left_hand": (0.0, 0.0, 1.0)}
    assert "not seen" in found.notes[0]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[1]", "a line must be an object"),
        ('{"joints": {}}', "'at' must be a finite number"),
        (line("now"), "'at' must be a finite number"),
        ('{"at": 1}', "'joints' must be an object"),
        (line(1, head=[0, 1]), "joint 'head' must be 3 numbers"),
        (line(1, head=[0, 1, 400]), "beyond 100 m"),
        ('{"at": 1, "joints": {}, "perzon": "x"}', "unknown key 'perzon'"),
        ('{"at": 1, "joints": {}', "not valid JSON"),
        ("{", "each line must be a whole JSON object"),
    ],
)
def test_a_wrong_line_is_named(text: str, message: str) -> None:
    with pytest.raises(PointingError, match="f.jsonl:2.*" + message.replace("(", r"\(")):
        skeletons_of_lines([line(0), text], "f.jsonl")


def test_a_file_that_is_missing_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(PointingError, match="there is no such file"):
        read_skeletons(tmp_path / "none.jsonl")


def test_wrong_lines_are_left_out_and_named_if_asked(tmp_path: Path) -> None:
    file, refused = tmp_path / "people.skeleton.jsonl", list[str]()
    file.write_bytes(f"{line(0)}\n[1]\n".encode() + b"\xff\n" + f"{line(1)}\n".encode())
    assert [one.at for one in read_skeletons(file, refused).skeletons] == [0, 1]
    assert [message.removeprefix(str(file)) for message in refused] == [
        ":2: a line must be an object {…}, got a list",
        ":3:1: the line is not UTF-8; save the file as UTF-8",
    ]
