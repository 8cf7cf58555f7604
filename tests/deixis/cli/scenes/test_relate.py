"""``deixis relate``: pairs, one pair, a matrix, JSON, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example

SCENE = example("place_setting.scene.json")


@pytest.fixture
def table(tmp_path: Path) -> Path:
    """A fork (2 by 20 cm) left of a plate (27 by 27 cm), with heights."""
    path = tmp_path / "table.scene.json"
    fork = {"id": "fork", "min": [0, 0, 0], "max": [2, 20, 1]}
    plate = {"id": "plate", "min": [5, -2, 0], "max": [32, 25, 3]}
    path.write_text(json.dumps({"unit": "cm", "objects": [fork, plate]}), encoding="utf-8")
    return path


def test_pairs_are_printed_in_rectangle_algebra_by_default(table: Path) -> None:
    assert deixis("relate", table) == (0, "fork   <,d   plate\nplate  >,di  fork\n", "")


def test_words_are_said_with_probabilities(table: Path) -> None:
    code, out, _ = deixis("relate", table, "--words", "--of", "fork", "--of", "plate")
    assert code == 0
    assert {"left", "near", "next_to", "shorter"} <= set(out.replace(",", " ").split())
    code, out, _ = deixis("relate", table, "--words", "--json")
    answer = json.loads(out)
    assert answer["pairs"][0]["words"]["left"] > 0.5
    assert "right" not in answer["pairs"][0]["words"]
    assert answer["between"] == []


@pytest.mark.parametrize(
    ("name", "options", "relation"),
    [
        ("ra", (), "<,d"),
        ("ba", (), "<,d,s"),
        ("allen", ("--axis", "z"), "s"),
        ("point", ("--axis", "y"), "<"),
        ("cd", (), "SW"),
        ("cd", ("--tolerance", "0.02"), "W"),
        ("cardir", (), "w"),
        ("rcc8", (), "DC"),
        ("ten", (), "left"),
        ("distance", ("--reference", "0.1"), "medium"),
    ],
)
def test_one_pair_in_each_calculus(table: Path, name: str, options: tuple[str, ...], relation: str) -> None:
    code, out, err = deixis("relate", table, "--calculus", name, "--of", "fork", "--of", "plate", *options)
    assert (code, out, err) == (0, f"fork  {relation}  plate\n", "")


def test_one_subject() -> None:
    code, out, err = deixis("relate", SCENE, "-c", "ten", "--of", "o1", "--json")
    assert (code, err) == (0, "")
    answer = json.loads(out)
    assert answer["calculus"] == "ten"
    assert {pair["subject"] for pair in answer["pairs"]} == {"o1"}
    assert len(answer["pairs"]) == len(answer["objects"]) - 1


def test_json_has_every_ordered_pair(table: Path) -> None:
    code, out, _ = deixis("relate", table, "--calculus", "rcc8", "--json")
    assert code == 0
    assert json.loads(out) == {
        "calculus": "rcc8",
        "objects": ["fork", "plate"],
        "pairs": [
            {"subject": "fork", "relation": "DC", "object": "plate"},
            {"subject": "plate", "relation": "DC", "object": "fork"},
        ],
    }


def test_a_matrix_has_subjects_in_rows(table: Path) -> None:
    assert deixis("relate", table, "--matrix")[1].splitlines() == [
        "       fork  plate",
        "fork   .     <,d",
        "plate  >,di  .",
    ]


def test_an_empty_scene_has_no_pairs(tmp_path: Path) -> None:
    path = tmp_path / "empty.scene.json"
    path.write_text('{"objects": []}', encoding="utf-8")
    assert deixis("relate", path) == (0, "There are no pairs.\n", "")
    assert deixis("relate", path, "--matrix") == (0, "There are no objects.\n", "")
    assert json.loads(deixis("relate", path, "--json")[1])["pairs"] == []


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--calculus", "rcc"), "no calculus 'rcc' relates boxes; did you mean 'rcc8'?"),
        (("--of", "frok"), "there is no object 'frok'; did you mean 'fork'?"),
        (("--of", "fork", "--of", "spoon"), "there is no object 'spoon'; there are: "),
        (("--of", "a", "--of", "b", "--of", "c"), "--of may be given once"),
        (("--matrix", "--of", "fork"), "--matrix excludes --of"),
        (("--matrix", "--words"), "--matrix excludes --of"),
        (("--calculus", "distance"), "needs the length `reference`"),
        (("--calculus", "allen", "--axis", "q"), "`axis` must be x, y or z, got 'q'"),
        (("--image", "x.jpg"), "an image ('x.jpg') can be chosen in annotation files only"),
    ],
)
def test_what_it_refuses(table: Path, options: tuple[str, ...], message: str) -> None:
    code, out, err = deixis("relate", table, *options)
    assert (code, out) == (2, "")
    assert message in err
    assert err.startswith("deixis: ")
    assert err.count("\n") == 1


def test_a_file_that_is_not_a_scene_is_refused(tmp_path: Path) -> None:
    code, out, err = deixis("relate", tmp_path / "none.json")
    assert (code, out) == (2, "")
    assert "none.json" in err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--calculus", "ra", "--axis", "z"), "--axis goes with point and allen only"),
        (("--of", "fork", "--of", "fork"), "got 'fork' twice"),
    ],
)
def test_an_option_that_would_do_nothing_is_refused(table: Path, options: tuple[str, ...], message: str) -> None:
    code, out, err = deixis("relate", table, *options)
    assert (code, out) == (2, "")
    assert message in err and err.count("\n") == 1


def test_json_is_laid_out_as_json_is_elsewhere(table: Path) -> None:
    for options in ((), ("--of", "fork")):
        out = deixis("relate", table, *options, "--json")[1]
        assert out == json.dumps(json.loads(out), indent=2, ensure_ascii=False) + "\n"


def test_a_scene_of_one_thing_has_no_pairs(tmp_path: Path) -> None:
    path = tmp_path / "one.scene.json"
    path.write_text(json.dumps({"unit": "cm", "objects": [{"id": "a", "min": [0, 0], "max": [1, 1]}]}))
    assert json.loads(deixis("relate", path, "--json")[1]) == {"calculus": "ra", "objects": ["a"], "pairs": []}
    assert deixis("relate", path) == (0, "There are no pairs.\n", "")
