"""The Python function of ``deixis read``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis as deixis_command

import deixis
from deixis.errors import DeixisError
from deixis.report.renderers import to_rows

TEXT = "The fork is left of the plate. The jug zig zags to which the. The spoon was on the plate."


def test_read_answers_as_the_command(tmp_path: Path) -> None:
    file = tmp_path / "text.txt"
    file.write_text(TEXT)
    found = deixis.read(file)
    assert found.to_dict() == json.loads(deixis_command("read", file, "--json")[1])
    assert found.to_text() == deixis_command("read", file)[1].rstrip("\n")


def test_rows_say_what_is_asserted() -> None:
    rows = to_rows(deixis.read(text=TEXT))
    assert [(row["fact"], row["asserted"], row["sentence"]) for row in rows] == [
        ("left(fork, plate)", True, 0),
        ("on(spoon, plate)", False, 2),
    ]


def test_a_strict_reading_refuses_what_is_not_understood() -> None:
    with pytest.raises(DeixisError, match="<text>:1:58: not understood"):
        deixis.read(text=TEXT, strict=True)


def test_a_layout_is_refused_with_the_command_that_reads_it() -> None:
    with pytest.raises(DeixisError, match="'deixis parse' reads layouts"):
        deixis.read("examples/script1.layout")


def test_a_file_or_a_text_must_be_given() -> None:
    with pytest.raises(TypeError, match="must be given a path or `text`"):
        deixis.read()
