"""The commands that read a script alone: parse, fmt and infer."""

from __future__ import annotations

import json
from pathlib import Path
from unittest.mock import patch

import pytest
from commands import deixis

from deixis.examples_data import example

SCRIPT1, CONTRADICTION = example("script1.layout"), example("contradiction.layout")


def script(folder: Path, text: str) -> Path:
    path = folder / "some.layout"
    path.write_bytes(text.encode())
    return path


def test_parse_prints_every_fact_with_its_line() -> None:
    code, out, err = deixis("parse", SCRIPT1)
    assert (code, err) == (0, "")
    assert len(out.splitlines()) == 12
    assert out.startswith('script1 "Formal dinner of Figure 7": 12 objects, 11 facts, seen from chair')
    assert "     6  top_left(bread_plate, dinner_plate)" in out.splitlines()


def test_parse_says_what_qualifies_a_fact(tmp_path: Path) -> None:
    code, out, _ = deixis("parse", script(tmp_path, "optional fork left of plate\nusually knife right of plate\n"))
    assert code == 0
    assert "1 fact" not in out
    assert "[optional]" in out
    assert "[weight 0." in out


@pytest.mark.parametrize("option", [["--json"], ["--format", "json"]])
def test_parse_as_json(option: list[str]) -> None:
    code, out, err = deixis("parse", SCRIPT1, *option)
    data = json.loads(out)
    assert (code, err) == (0, "")
    assert (data["name"], data["viewpoint"], len(data["objects"])) == ("script1", "chair", 12)
    assert [fact["line"] for fact in data["facts"]] == list(range(4, 15))
    first = data["facts"][0]
    assert (first["relation"], first["subject"], first["object"]) == ("right", "water_glass", "dinner_plate")
    assert (first["reading"], first["status"]) == ("wide", "stated")


@pytest.mark.parametrize(("form", "start"), [("turtle", "@prefix"), ("dot", "digraph")])
def test_parse_writes_the_graph(form: str, start: str) -> None:
    code, out, err = deixis("parse", SCRIPT1, "--format", form)
    assert (code, err) == (0, "")
    assert out.startswith(start)
    assert "water_glass" in out


def test_fmt_prints_the_canonical_form_and_leaves_the_file(tmp_path: Path) -> None:
    path = script(tmp_path, "left( fork,the plate )   # why not\n")
    assert deixis("fmt", path) == (0, "fork left of plate  # why not\n", "")
    assert path.read_bytes() == b"left( fork,the plate )   # why not\n"


def test_fmt_check_prints_nothing(tmp_path: Path) -> None:
    assert deixis("fmt", script(tmp_path, "left(fork, plate)\n"), "--check") == (1, "", "")
    assert deixis("fmt", script(tmp_path, "fork left of plate\n"), "--check") == (0, "", "")


def test_fmt_writes(tmp_path: Path) -> None:
    path = script(tmp_path, "left(fork, plate)")
    assert deixis("fmt", path, "--write") == (0, "", "")
    assert path.read_bytes() == b"fork left of plate\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["some.layout"]
    assert deixis("fmt", path, "--check", "--write")[0] == 2


def test_fmt_makes_line_ends_plain(tmp_path: Path) -> None:
    path = script(tmp_path, "fork left of plate\r\nknife right of plate\r\n")
    assert deixis("fmt", path, "--check")[0] == 1
    assert deixis("fmt", path, "-w")[0] == 0
    assert path.read_bytes() == b"fork left of plate\nknife right of plate\n"


def test_fmt_leaves_a_file_with_mistakes_alone(tmp_path: Path) -> None:
    path = script(tmp_path, "left(fork, plate)\nfork lft of plate\n")
    code, out, err = deixis("fmt", path, "--write")
    assert (code, out) == (2, "")
    assert f"{path}:2:6:" in err
    assert path.read_bytes() == b"left(fork, plate)\nfork lft of plate\n"


def test_fmt_leaves_the_old_file_where_writing_fails(tmp_path: Path) -> None:
    path = script(tmp_path, "left(fork, plate)\n")
    with patch.object(Path, "replace", side_effect=OSError(28, "No space left on device", str(path))):
        code, _, err = deixis("fmt", path, "--write")
    assert (code, err) == (2, f"deixis: {path}: No space left on device\n")
    assert path.read_bytes() == b"left(fork, plate)\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["some.layout"]


def test_fmt_as_json(tmp_path: Path) -> None:
    path = script(tmp_path, "left(fork, plate)\n")
    code, out, _ = deixis("fmt", path, "--json", "--check")
    assert code == 1
    assert json.loads(out) == {"file": str(path), "canonical": False, "text": "fork left of plate\n"}


def test_infer_prints_stated_and_inferred(tmp_path: Path) -> None:
    code, out, err = deixis("infer", script(tmp_path, "a left of b\nb left of c\n"))
    assert (code, err) == (0, "")
    assert "Stated (2):" in out
    assert "    left(a, c)   by transitivity from lines 1, 2" in out.splitlines()


def test_infer_as_json(tmp_path: Path) -> None:
    code, out, _ = deixis("infer", script(tmp_path, "a left of b\nb left of c\n"), "--json")
    data = json.loads(out)
    assert code == 0
    assert data["consistent"] is True
    assert {fact["status"] for fact in data["facts"]} == {"stated", "inferred"}
    (found,) = (f for f in data["facts"] if (f["relation"], f["subject"], f["object"]) == ("left", "a", "c"))
    assert (found["rule"], found["lines"]) == ("transitivity", [1, 2])


def test_explain_prints_the_derivation() -> None:
    code, out, err = deixis("infer", example("formal_dinner.layout"), "--explain", "left(salad_fork, soup_spoon)")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith("left(salad_fork, soup_spoon)")
    assert len(lines) == 6


def test_explain_as_json() -> None:
    arguments = ["infer", example("formal_dinner.layout"), "--json", "--explain"]
    code, out, _ = deixis(*arguments, "left(salad_fork, soup_spoon)")
    data = json.loads(out)
    assert code == 0
    assert len(data["derivation"]["premises"]) == 5
    code, out, _ = deixis(*arguments, "right(salad_fork, soup_spoon)")
    answer = json.loads(out)
    assert (code, answer["derivation"]) == (1, None)
    assert [answer["fact"][key] for key in ("relation", "subject", "object")] == ["right", "salad_fork", "soup_spoon"]
    assert "file" not in answer["fact"]


def test_a_statement_that_does_not_follow_exits_with_1() -> None:
    code, out, err = deixis("infer", SCRIPT1, "--explain", "left(dessert_fork, soup_spoon)")
    assert (code, err) == (1, "")
    assert out == "left(dessert_fork, soup_spoon) does not follow from the script (--why-not says why).\n"


def test_what_lies_on_a_plate_shares_its_sides() -> None:
    code, out, _ = deixis("infer", SCRIPT1, "--explain", "left(napkin, soup_spoon)")
    assert code == 0
    assert out.splitlines()[0] == "left(napkin, soup_spoon)   by composition"
    assert {line.split("   ")[-1].strip("[]").rsplit(":", 2)[1] for line in out.splitlines() if "[" in line} == {
        "5",
        "13",
        "14",
    }


def test_why_not_shows_a_table_without_the_fact() -> None:
    code, out, err = deixis("infer", SCRIPT1, "--why-not", "left(dessert_fork, soup_spoon)")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0].startswith(
        "left(dessert_fork, soup_spoon) does not follow: it is false on this table, where every firm fact holds "
        "(the numbers only order the sides of the boxes)."
    )
    assert "    right edge of dessert_fork <= left edge of soup_spoon" in lines
    _, out, _ = deixis("infer", SCRIPT1, "--why-not", "left(dessert_fork, soup_spoon)", "--json")
    data = json.loads(out)
    boxes = {box["id"]: box for box in data["picture"]}
    assert not data["follows"]
    assert boxes["dessert_fork"]["max"][0] > boxes["soup_spoon"]["min"][0]
    assert boxes["soup_spoon"]["min"][0] >= boxes["fish_knife"]["max"][0]
    assert {"min", "max", "id"} == boxes["napkin"].keys()


def test_why_not_says_what_excludes_a_fact() -> None:
    code, out, _ = deixis("infer", SCRIPT1, "--why-not", "right(salad_fork, soup_spoon)")
    assert code == 0
    lines = out.splitlines()
    assert lines[0] == "right(salad_fork, soup_spoon) cannot hold, since this does:"
    assert lines[1].startswith("    left(salad_fork, soup_spoon)   by ")
    _, out, _ = deixis("infer", SCRIPT1, "--why-not", "right(salad_fork, soup_spoon)", "--json")
    assert json.loads(out)["excluded_by"]["fact"]["relation"] == "left"


def test_why_not_of_what_does_follow_exits_with_1() -> None:
    code, out, _ = deixis("infer", SCRIPT1, "--why-not", "left(salad_fork, soup_spoon)")
    assert code == 1
    assert out.splitlines()[0] == "left(salad_fork, soup_spoon) does follow:"


def test_all_that_holds_as_ntriples(tmp_path: Path) -> None:
    script = tmp_path / "row.layout"
    script.write_text("a left of b\nb left of c\n", encoding="utf-8")
    code, out, _ = deixis("infer", str(script), "--ntriples")
    assert code == 0
    left = "<https://w3id.org/deixis/onto#left>"
    assert [line for line in out.splitlines() if left in line] == [
        f"<urn:deixis:graph:{s}> {left} <urn:deixis:graph:{o}> ." for s, o in ("ab", "ac", "bc")
    ]
    assert deixis("infer", str(script), "--ntriples", "--json")[0] == 2


def test_a_long_listing_is_cut_with_its_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("deixis.report.layouts.script.MAX_INFERRED_LISTED", 3)
    script = tmp_path / "row.layout"
    script.write_text("left to right: a, b, c, d\n", encoding="utf-8")
    code, out, _ = deixis("infer", str(script))
    assert code == 0
    assert "Inferred (9):" in out
    assert out.splitlines()[-1] == "    and 6 more: --ntriples prints all that holds, --json everything"


def test_why_not_refuses_an_object_that_the_script_does_not_name() -> None:
    code, out, err = deixis("infer", SCRIPT1, "--why-not", "left(salad_frok, soup_spoon)")
    assert (code, out) == (2, "")
    assert err == "deixis: --why-not: the script has no object 'salad_frok'; did you mean 'salad_fork'?\n"


def test_choices_that_are_not_weighed_in_time_leave_it_undecided(tmp_path: Path) -> None:
    script = tmp_path / "choices.layout"
    script.write_text("a left or right of b\nb left or right of c\na is not left of c\n", encoding="utf-8")
    code, out, err = deixis("infer", str(script), "--time-limit", "0")
    assert (code, err) == (3, "")
    assert out.startswith("Undecided: time limit reached")
    code, out, _ = deixis("infer", str(script), "--time-limit", "0", "--json")
    assert (code, json.loads(out)["consistent"]) == (3, None)
    assert deixis("infer", str(script))[0] == 0


@pytest.mark.parametrize(
    "text", ["blah", "", "left(a)", "left(a, b); left(b, c)", "not left(a, b)", "a left or right b"]
)
def test_an_explain_text_that_is_not_a_fact_is_bad_input(text: str) -> None:
    code, out, err = deixis("infer", SCRIPT1, "--explain", text)
    assert (code, out) == (2, "")
    assert err.startswith("deixis: ")


def test_a_contradiction_prints_its_minimal_conflict_only() -> None:
    code, out, err = deixis("infer", CONTRADICTION)
    assert (code, err) == (1, "")
    lines = out.splitlines()
    assert lines[0] == "The script contradicts itself: 'salad_fork' cannot be both left of and right of 'dinner_fork'."
    assert [line.partition(": ")[2] for line in lines[1:4]] == [
        "left(salad_fork, dinner_fork)",
        "left(dinner_fork, dinner_plate)",
        "left(dinner_plate, salad_fork)",
    ]
    assert len(lines) == 5
    assert "napkin" not in out


def test_a_contradiction_as_json() -> None:
    code, out, _ = deixis("infer", CONTRADICTION, "--json")
    data = json.loads(out)
    assert code == 1
    assert data.keys() == {"consistent", "conflict"}
    assert [fact["line"] for fact in data["conflict"]["facts"]] == [5, 6, 8]


def test_the_version_is_that_of_the_package() -> None:
    from deixis import __version__

    assert deixis("--version") == (0, f"deixis {__version__}\n", "")
