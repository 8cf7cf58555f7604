"""deixis ground: text, JSON, pictures and exit codes."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from commands import deixis

from deixis.examples_data import example

SCRIPT1, FULL = example("script1.layout"), example("formal_dinner.layout")
SCENE = example("place_setting.scene.json")
PROMISED = {
    "engine": str,
    "matches": list,
    "frames": list,
    "unmatched_objects": list,
    "unmatched_perceived": list,
    "interchangeable": list,
    "graph_similarity": float,
    "facts": dict,
    "claims": list,
    "proved_best": bool,
    "seconds": float,
}
QUALIFYING = {
    "left_out": dict,
    "might_be": dict,
    "probabilities": dict,
    "converged": bool,
    "finished": bool,
    "notes": list,
}
MAGIC = {"png": b"\x89PNG\r\n\x1a\n", "svg": b"<?xml", "pdf": b"%PDF-"}


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_text_names_the_matches_and_what_is_open() -> None:
    code, out, err = deixis("ground", SCRIPT1, SCENE, "--no-sizes")
    assert (code, err) == (0, "")
    rows = [line.split() for line in out.splitlines()]
    assert ["dinner_plate", "o8"] in [row[:2] for row in rows]
    assert "    dinner_knife, water_glass" in out.splitlines()
    assert "Facts: 11 stated, 11 satisfied" in out
    assert "Proved the best answer; engine exact" in out


def test_text_and_json_report_claims_with_their_measures(tmp_path: Path) -> None:
    text = "fork left of plate; fork is at the left; fork is the largest; cup has material clay\n"
    script = write(tmp_path / "t.layout", text)
    boxes = (("a", 0, [0.03, 0.2, 0.01]), ("b", 0.3, [0.25, 0.25, 0.02]), ("c", 0.7, [0.08, 0.08, 0.1]))
    objects = [{"id": id, "min": [x, 0, 0], "max": [x + size[0], *size[1:]]} for id, x, size in boxes]
    scene = write(tmp_path / "t.scene.json", json.dumps({"objects": objects}))
    code, out, _ = deixis("ground", script, scene)
    assert code == 0
    assert "Claims: 3 stated, 1 satisfied, 1 violated, 1 undecidable" in out
    assert re.search(r"^    violated: largest\(fork\): .*\(.*t\.layout:1:\d+\)$", out, re.MULTILINE)
    claims = json.loads(deixis("ground", script, scene, "--json")[1])["claims"]
    assert [entry["verdict"] for entry in claims] == ["satisfied", "violated", "undecidable"]
    assert claims[1]["perceived"] == ["a"]
    assert claims[1]["measured"]


def test_text_without_claims_does_not_mention_them() -> None:
    assert "Claims" not in deixis("ground", FULL, SCENE)[1]


@pytest.mark.parametrize("engine", ["exact", "scalable", "similarity", "blondel"])
def test_only_the_paper_s_engine_prints_graph_similarity(engine: str) -> None:
    _, out, _ = deixis("ground", FULL, SCENE, "--engine", engine)
    assert ("graph similarity 0." in out.lower()) == (engine == "similarity")


def test_the_text_says_how_sure_the_answer_is(tmp_path: Path) -> None:
    assert "Sure of all 12 names: each match has a probability of at least 0.99." in deixis("ground", FULL, SCENE)[1]
    _, out, _ = deixis("ground", SCRIPT1, SCENE, "--no-sizes")
    (line,) = [line for line in out.splitlines() if line.startswith("Sure of ")]
    rows = [(float(row[2]), row[0]) for line in out.splitlines() if len(row := line.split()) > 2 and row[1][0] == "o"]
    least, name = min(rows[:12])
    assert line == f"Sure of 1 of 12 names (probability 0.99 or more); the least certain is {name} ({least:.2f})."
    out = deixis("ground", SCRIPT1, SCENE, "--engine", "similarity")[1]
    assert "of 12 names decided; the answer has no probabilities." in out
    left_out = write(tmp_path / "more.layout", "plate left of knife; candle, vase, lamp, clock left of fork")
    (line,) = [line for line in deixis("ground", left_out, SCENE)[1].splitlines() if line.startswith("Sure of ")]
    assert "of 7 names" in line
    one = write(tmp_path / "one.layout", "thingummy is red")
    assert "Not sure: thingummy has a probability of 0." in deixis("ground", one, SCENE)[1]


def test_kinds_are_printed_where_they_come_from_names(tmp_path: Path) -> None:
    script = write(
        tmp_path / "kinds.layout", "dinner_fork left of 2 plate\nwidget right of dinner_fork\njim is a knife\n"
    )
    lines = deixis("ground", script, SCENE)[1].splitlines()
    assert "Kinds taken from the names: dinner fork, plate (plate_1, plate_2)." in lines
    assert "No known kind: widget." in lines
    declared = write(tmp_path / "declared.layout", "jim is a knife\njoe is a fork\njim left of joe\n")
    lines = deixis("ground", declared, SCENE)[1].splitlines()
    assert not [line for line in lines if line.startswith(("Kinds", "No known kind"))]


@pytest.mark.parametrize("engine", ["exact", "similarity"])
def test_json_holds_what_is_promised(engine: str) -> None:
    code, out, err = deixis("ground", FULL, SCENE, "--json", "--engine", engine, "--time-limit", "60")
    data = json.loads(out)
    assert (code, err) == (0, "")
    gap = {"gap": float if engine == "exact" else type(None)}
    pivotal = {"pivotal": list if engine == "exact" else type(None)}
    fits = {"fits": float if engine == "exact" else type(None)}
    assert {key: type(value) for key, value in data.items()} == PROMISED | QUALIFYING | pivotal | gap | fits
    assert data["engine"] == engine
    assert data["proved_best"] is (engine == "exact")
    assert len(data["matches"]) == 12
    for match in data["matches"]:
        assert match.keys() == {
            "object",
            "perceived",
            "score",
            "similarity",
            "decided",
            "probability",
            "alternatives",
        }
        assert all(other.keys() == {"perceived", "cost", "probability"} for other in match["alternatives"])
        assert 0 <= match["score"] <= 1
    assert data["facts"].keys() == {"stated", "satisfied", "violated", "waived", "open"}
    assert data["facts"]["stated"] == 11


def test_json_of_an_english_text_holds_its_mentions(tmp_path: Path) -> None:
    text = tmp_path / "table.txt"
    text.write_text("The plate is left of the soup spoon. The spoon is right of a knife.", encoding="utf-8")
    found = json.loads(deixis("ground", text, SCENE, "--json")[1])
    assert found["mentions"]["soup_spoon"] == ["the soup spoon", "The spoon"]
    assert {match["object"] for match in found["matches"]} == {"plate", "soup_spoon", "knife"}


def test_text_output_gives_the_probability_of_the_description() -> None:
    told = "The description fits this scene with probability"
    assert told in deixis("ground", FULL, SCENE)[1]
    assert told not in deixis("ground", FULL, SCENE, "--engine", "similarity")[1]


def test_a_violated_fact_has_its_line_and_perceived_relation(tmp_path: Path) -> None:
    script = write(tmp_path / "s.layout", "a left of b\nb on c\nc left of a\n")
    boxes = [f'{{"id": "o{i}", "min": [{i}, 0], "max": [{i}.5, 1]}}' for i in range(3)]
    scene = write(tmp_path / "s.scene.json", f'{{"objects": [{", ".join(boxes)}]}}')
    code, out, _ = deixis("ground", script, scene, "--json")
    (entry,) = json.loads(out)["facts"]["violated"]
    assert code == 0
    assert entry.keys() == {"fact", "line", "degree", "perceived"}
    assert (entry["line"], entry["fact"]["relation"]) == (2, "on")
    assert entry["perceived"].keys() == {"relation", "subject", "object", "reading"}
    assert entry["perceived"]["reading"] == "exact"
    assert f"violated: on(b, c) ({script}:2:1): perceived is" in deixis("ground", script, scene)[1]


@pytest.mark.parametrize("ending", ["png", "svg", "pdf"])
def test_the_picture_is_written(tmp_path: Path, ending: str) -> None:
    path = tmp_path / "new" / f"found.{ending}"
    code, out, err = deixis("ground", SCRIPT1, SCENE, "--plot", path)
    assert (code, err) == (0, "")
    assert f"Written: {path}" in out
    data = path.read_bytes()
    assert data.startswith(MAGIC[ending])
    assert 5_000 < len(data) < 2_000_000


def test_with_json_only_json_is_printed(tmp_path: Path) -> None:
    code, out, _ = deixis("ground", SCRIPT1, SCENE, "--json", "--plot", tmp_path / "found.svg")
    assert code == 0
    assert json.loads(out)["facts"]["satisfied"] == 11


@pytest.mark.parametrize("name", ["found.bmp2", "found", "", "folder.png"])
def test_a_picture_that_cannot_be(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder.png").mkdir()
    code, _, err = deixis("ground", SCRIPT1, SCENE, "--plot", tmp_path / name)
    assert code == 2
    assert err.startswith(f"deixis: {tmp_path / name}: ")


def test_an_unwritable_place(tmp_path: Path) -> None:
    file = write(tmp_path / "file", "")
    code, _, err = deixis("ground", SCRIPT1, SCENE, "--plot", file / "found.png")
    assert code == 2
    assert "the folder of the picture cannot be created" in err


@pytest.mark.parametrize("engine", ["exact", "scalable"])
def test_a_time_limit_of_zero_gives_an_undecided_answer(tmp_path: Path, engine: str) -> None:
    script = write(tmp_path / "s.layout", "\n".join(f"a{i} left of a{(i * 7 + 1) % 20}" for i in range(1, 20)))
    boxes = [
        {"id": f"o{i}", "min": [i * 37 % 20, i * 11 % 20], "max": [i * 37 % 20 + 2, i * 11 % 20 + 2]} for i in range(20)
    ]
    scene = write(tmp_path / "s.scene.json", json.dumps({"objects": boxes}))
    code, out, err = deixis("ground", script, scene, "--time-limit", "0", "--json", "--engine", engine)
    data = json.loads(out)
    assert (code, err) == (3, "")
    assert data["proved_best"] is False and data["finished"] is False
    assert data["gap"] is None if engine == "scalable" else data["gap"] > 0
    assert len(data["matches"]) == 20
    assert any("time limit" in note for note in data["notes"])


@pytest.mark.parametrize("engine", ["exact", "similarity"])
def test_a_scene_without_objects_exits_with_1(tmp_path: Path, engine: str) -> None:
    scene = write(tmp_path / "s.scene.json", '{"objects": []}')
    code, out, err = deixis("ground", SCRIPT1, scene, "--json", "--engine", engine)
    data = json.loads(out)
    assert (code, err) == (1, "")
    assert data["matches"] == []
    assert len(data["unmatched_objects"]) == 12
    assert set(data["left_out"].values()) == {"nothing was perceived"}


@pytest.mark.parametrize("text", ["", "# only a comment\n", 'layout empty "Empty"\n'])
def test_a_script_without_objects_exits_with_1(tmp_path: Path, text: str) -> None:
    code, out, err = deixis("ground", write(tmp_path / "s.layout", text), SCENE, "--plot", tmp_path / "found.svg")
    assert (code, err) == (1, "")
    assert "Facts: 0 stated, 0 satisfied" in out
    assert ": the description names nothing." in out


def test_a_script_without_facts_leaves_all_undecided(tmp_path: Path) -> None:
    code, out, _ = deixis("ground", write(tmp_path / "s.layout", "x is a Fork; y is a Fork\n"), SCENE, "--json")
    data = json.loads(out)
    assert code == 0
    assert [match["decided"] for match in data["matches"]] == [False, False]
    assert data["interchangeable"] == [["x", "y"]]


def test_a_contradictory_script_is_grounded_with_a_note() -> None:
    code, out, _ = deixis("ground", example("contradiction.layout"), SCENE)
    assert code == 0
    assert "Note: the script contradicts itself" in out
    assert "violated" in out


def test_a_line_lists_the_first_equal_things_and_counts_the_rest(tmp_path: Path) -> None:
    things = [{"id": f"o{i}", "min": [0.0, 0.0], "max": [0.1, 0.1]} for i in range(30)]
    scene = {"frame": "table", "viewpoint": "chair", "unit": "m", "objects": things}
    (tmp_path / "t.scene.json").write_text(json.dumps(scene), encoding="utf-8")
    facts = "".join(f"f_{i} is a Fork\n" for i in range(30))
    (tmp_path / "t.layout").write_text(f"layout alike seen from chair\n{facts}", encoding="utf-8")
    _, out, _ = deixis("ground", tmp_path / "t.layout", tmp_path / "t.scene.json", "--engine", "similarity")
    line = next(line for line in out.splitlines() if line.startswith("f_0 "))
    assert line.endswith(", 17 more")


def test_swaps_of_indistinguishable_things_are_not_printed() -> None:
    arguments = ("ground", SCRIPT1, SCENE, "--no-sizes")
    _, out, _ = deixis(*arguments)
    without = [line for line in out.splitlines() if line.startswith("Without ")]
    assert len(without) == 1 and without[0].startswith("Without right(soup_spoon, fish_knife)")
    assert len(json.loads(deixis(*arguments, "--json")[1])["pivotal"]) > 1


def test_things_that_are_likelier_taken_alone_are_reported() -> None:
    arguments = (SCRIPT1, SCENE)
    _, out, _ = deixis("ground", *arguments, "--no-sizes")
    told = next(line for line in out.splitlines() if "taken alone, another thing is more likely for: " in line)
    likelier = re.findall(r"^(\w+) +o\d+ +(0\.\d+) +or o\d+ (0\.\d+)", out, re.MULTILINE)
    names = told.rpartition(": ")[2].rstrip(".").split(", ")
    for name, own, other in likelier:
        lead = float(other) - float(own)
        assert name in names if lead > 0.06 else abs(lead - 0.05) <= 0.01 or name not in names, name
    assert "taken alone" not in deixis("ground", *arguments)[1]


@pytest.mark.parametrize("said", ["car left of bus", "dinner_plate left of bread_plate"])
def test_a_script_about_nothing_in_the_scene_gets_a_message(said: str, tmp_path: Path) -> None:
    script, scene = tmp_path / "other.layout", tmp_path / "cutlery.scene.json"
    script.write_text(said + "\n", encoding="utf-8")
    boxes = {"s": ([0, 0], [0.03, 0.2]), "k": ([0.1, 0], [0.12, 0.22])}
    things = [{"id": name, "min": low, "max": high} for name, (low, high) in boxes.items()]
    scene.write_text(json.dumps({"unit": "m", "objects": things}), encoding="utf-8")
    code, out, _ = deixis("ground", script, scene, "--json")
    assert code == 1
    found = json.loads(out)
    assert not found["matches"] and len(found["unmatched_objects"]) == 2 and found["pivotal"] is None
    assert any("another scene" in note for note in found["notes"])


TWO_BOXES = {
    "unit": "cm",
    "objects": [{"id": "a", "min": [0, 0], "max": [25, 25]}, {"id": "b", "min": [30, 2], "max": [32, 23]}],
}


def test_each_object_left_out_has_a_line(tmp_path: Path) -> None:
    scene = write(tmp_path / "two.scene.json", json.dumps(TWO_BOXES))
    script = write(tmp_path / "three.layout", "knife right of plate\nteapot above plate")
    lines = deixis("ground", script, scene)[1].splitlines()
    assert [line.split()[:2] for line in lines[:2]] == [["knife", "b"], ["plate", "a"]]
    assert lines[2] == f"{'teapot':<24} left out"


def test_without_a_match_no_probability_of_the_scene(tmp_path: Path) -> None:
    far_too_large = {"objects": [{"id": "a", "min": [0, 0], "max": [30, 30]}]}
    scene = write(tmp_path / "large.scene.json", json.dumps(far_too_large))
    script = write(tmp_path / "two.layout", "knife right of plate")
    _, out, _ = deixis("ground", script, scene)
    assert out.startswith("No object was found.")
    assert "fits this scene with probability" not in out
    assert "Without a match, nothing shows whether the description is of this scene." in out


def test_an_undecided_match_lists_an_alternative() -> None:
    _, out, _ = deixis("ground", SCRIPT1, SCENE)
    rows = [line for line in out.splitlines()[:12] if float(line.split()[2]) < 0.99]
    assert rows and all(" or " in row for row in rows)


def test_a_fact_on_which_all_matches_depend_gets_a_short_line(tmp_path: Path) -> None:
    script, scene = tmp_path / "pair.layout", tmp_path / "pair.scene.json"
    script.write_text("fork facing plate; fork higher than plate; fork leaning against plate", encoding="utf-8")
    fork = {"id": "o1", "label": "fork", "min": [0, 0], "max": [3, 20]}
    plate = {"id": "o2", "label": "plate", "min": [6, 0], "max": [29, 23]}
    scene.write_text(json.dumps({"unit": "cm", "objects": [fork, plate]}), encoding="utf-8")
    _, out, _ = deixis("ground", script, scene)
    assert f"Without facing(fork, plate) ({script}:1:1): no match would be decided." in out
