"""Test the tables of keys below JSON answers."""

from __future__ import annotations

from documentation.json_reference import key_table
from documentation.page_examples import Command, Ran


def table(output: str) -> list[str]:
    return key_table(Ran(Command("deixis ground --json"), output)).splitlines()[2:]


def test_a_key_has_its_path_its_types_and_the_first_example() -> None:
    rows = table('{"matches": [{"object": "fork", "probability": null}, {"object": "cup", "probability": 0.9}]}')
    assert rows == [
        "| `matches` | array |  |",
        '| `matches[].object` | string | `"fork"` |',
        "| `matches[].probability` | null or number | `0.9` |",
    ]


def test_nested_arrays_and_long_values_stay_short() -> None:
    rows = table('{"groups": [["a", "b"]], "text": "' + "x" * 100 + '"}')
    assert rows[0] == '| `groups` | array | `[["a", "b"]]` |'
    assert len(rows) == 2
    assert rows[1].endswith("…` |")


def test_entries_by_the_names_of_objects_share_one_path() -> None:
    rows = table('{"objects": ["fork", "cup"], "sizes": {"fork": 0.2, "cup": 0.1}}')
    assert rows[1:] == ["| `sizes` | object |  |", "| `sizes.NAME` | number | `0.2` |"]
