"""Answers as plain data: what the JSON of parse, infer and ground holds, on an example made by hand."""

from __future__ import annotations

import json
from typing import Any

import deixis
from deixis.report.json_answers import derivation_to_dict, grounding_to_dict, inference_to_dict, script_to_dict

SCRIPT = deixis.read_script(
    text='layout tea "Tea" seen from chair\ncup on saucer\nspoon right of saucer\n'
    "optional jug above saucer\nspoon is a Spoon"
)
SCENE: dict[str, Any] = {
    "unit": "px",
    "objects": [
        {"id": "o1", "min": [0, 0], "max": [10, 10]},
        {"id": "o2", "min": [3, 3], "max": [7, 7]},
        {"id": "o3", "min": [12, 2], "max": [13, 9]},
    ],
}


def through_json(data: dict[str, Any]) -> dict[str, Any]:
    """Write the data as JSON without nan, read it back, and require that nothing changed."""
    back: dict[str, Any] = json.loads(json.dumps(data, allow_nan=False))
    assert back == data
    return back


def test_a_script() -> None:
    data = through_json(script_to_dict(SCRIPT))
    assert [data[key] for key in ("file", "name", "title", "viewpoint")] == ["<text>", "tea", "Tea", "chair"]
    assert [node["id"] for node in data["objects"]] == ["cup", "saucer", "spoon", "jug"]
    assert [(f["relation"], f["subject"], f["object"], f["line"], f["optional"]) for f in data["facts"]] == [
        ("on", "cup", "saucer", 2, False),
        ("right", "spoon", "saucer", 3, False),
        ("top", "jug", "saucer", 4, True),
    ]
    assert {fact["status"] for fact in data["facts"]} == {"stated"}


def test_an_inference() -> None:
    data = through_json(inference_to_dict(deixis.infer(SCRIPT)))
    assert data["consistent"] is True
    inferred = [f for f in data["facts"] if f["status"] == "inferred"]
    assert ("left", "saucer", "spoon", [3]) in [
        (f["relation"], f["subject"], f["object"], f["lines"]) for f in inferred
    ]


def test_a_conflict() -> None:
    data = through_json(inference_to_dict(deixis.infer(deixis.read_script(text="a left of b\nc on d\nb left of a"))))
    assert data.keys() == {"consistent", "conflict"}
    assert data["consistent"] is False
    assert [fact["line"] for fact in data["conflict"]["facts"]] == [1, 3]


def test_a_derivation() -> None:
    inference = deixis.infer(deixis.read_script(text="a left of b; b left of c"))
    left = SCRIPT.ontology.relations["left"]
    derivation = inference.implications.derive(left, "a", "c")
    assert derivation is not None
    data = through_json(derivation_to_dict(derivation))
    assert data["rule"] == "transitivity"
    assert [(p["fact"]["subject"], p["fact"]["object"], p["rule"]) for p in data["premises"]] == [
        ("a", "b", "stated"),
        ("b", "c", "stated"),
    ]


def test_a_grounding() -> None:
    data = through_json(grounding_to_dict(deixis.ground(SCRIPT, SCENE)))
    assert {match["object"]: match["perceived"] for match in data["matches"]} == {
        "cup": "o2",
        "saucer": "o1",
        "spoon": "o3",
    }
    assert all(match["score"] == 1 and match["probability"] > 0.5 for match in data["matches"])
    assert (data["unmatched_objects"], data["unmatched_perceived"]) == (["jug"], [])
    assert data["left_out"].keys() == {"jug"}
    assert (data["facts"]["stated"], data["facts"]["satisfied"], data["facts"]["violated"]) == (3, 2, [])
    (entry,) = data["facts"]["open"]
    assert (entry["line"], entry["perceived"], entry["fact"]["relation"]) == (4, None, "top")
    assert (data["engine"], data["proved_best"], data["interchangeable"]) == ("exact", True, [])
