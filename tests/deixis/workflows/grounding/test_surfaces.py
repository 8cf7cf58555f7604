"""The surface of a text: found in the scene, and neither an object, a role nor an extra thing."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deixis.grammar.script import Script
from deixis.learning.lessons.scene_evidence import surface_thing
from deixis.ontology.tbox import default_ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.grounding.answers.claims import ClaimOutcome, ClaimVerdict
from deixis.report.grounding.ground import grounding_lines
from deixis.report.layouts.imagine import imagination_lines
from deixis.session import Session
from deixis.workflows.grounding.check import Check, check
from deixis.workflows.grounding.ground import ground
from deixis.workflows.layouts.imagine import imagine
from deixis.workflows.layouts.read import read_script

TEXT = "The bowl is on the tray. The spoon is right of the bowl. The napkin is left of the bowl."
Box = tuple[tuple[float, float, float], tuple[float, float, float]]
BOXES: dict[str, Box] = {
    "tray": ((0.0, 0.0, 0.0), (0.5, 0.35, 0.02)),
    "bowl": ((0.18, 0.12, 0.02), (0.32, 0.26, 0.10)),
    "spoon": ((0.38, 0.08, 0.02), (0.40, 0.30, 0.03)),
    "napkin": ((0.05, 0.10, 0.02), (0.15, 0.25, 0.025)),
}
CUP: dict[str, Box] = {"cup": ((0.40, 0.02, 0.02), (0.47, 0.09, 0.10))}


def table(boxes: dict[str, Box], unlabelled: str = "") -> Scene:
    """Return the scene of some boxes, each with its name as label and ``seen_`` before it as id."""
    things = [
        PerceivedObject(f"seen_{name}", low, high, label=None if name == unlabelled else name, confidence=1.0)
        for name, (low, high) in boxes.items()
    ]
    return Scene(tuple(things))


def moved(name: str, by: tuple[float, float, float]) -> Scene:
    low, high = ((x + by[0], y + by[1], z + by[2]) for x, y, z in BOXES[name])
    return table(BOXES | {name: (low, high)})


def told(text: str = TEXT) -> Script:
    return read_script(text=text, english=True)


def on_surface(checked: Check) -> ClaimOutcome:
    (entry,) = [entry for entry in checked.table.claims if entry.claim.relation == "on"]
    return entry


def test_grounding_finds_the_surface_and_leaves_nothing_out() -> None:
    found = ground(told(), table(BOXES))
    assert found.surface == "tray" and found.matches["tray"].perceived == "seen_tray"
    assert not found.unmatched_perceived and set(found.object_matches) == {"bowl", "spoon", "napkin"}
    lines = "\n".join(grounding_lines(found))
    assert "seen_tray  the surface that the objects stand on" in lines
    assert "all 3 names" in lines and "Left out" not in lines


def test_a_layout_script_names_its_surface_in_its_header() -> None:
    script = read_script(text="layout on tray\nspoon right of bowl\nnapkin left of bowl")
    assert ground(script, table(BOXES)).surface == "tray"
    assert check(script, table(BOXES)).table.well


@pytest.mark.parametrize("unlabelled", ["", "tray"])
def test_the_surface_is_not_an_extra_thing(unlabelled: str) -> None:
    checked = check(told(TEXT + " The cup is right of the bowl."), table(BOXES | CUP, unlabelled))
    assert checked.table.well and checked.conforms
    assert checked.table.extra == ()


def test_something_else_on_the_table_is_still_extra() -> None:
    assert [one.perceived for one in check(told(), table(BOXES | CUP)).table.extra] == ["seen_cup"]


@pytest.mark.parametrize(
    ("by", "verdict", "measured"),
    [
        ((0.0, 0.0, 0.0), ClaimVerdict.SATISFIED, "its underside is 0 cm above the top of seen_tray"),
        ((0.0, 0.0, -0.01), ClaimVerdict.SATISFIED, "its underside is 0 cm above the top of seen_tray"),
        ((0.0, 0.0, 0.08), ClaimVerdict.VIOLATED, "its underside is 8 cm above the top of seen_tray"),
        ((0.0, 0.6, -0.02), ClaimVerdict.VIOLATED, "it is not above seen_tray"),
    ],
)
def test_on_the_surface_is_measured_from_its_box(
    by: tuple[float, float, float], verdict: ClaimVerdict, measured: str
) -> None:
    entry = on_surface(check(told(), moved("bowl", by)))
    assert (entry.verdict, entry.measured) == (verdict, measured)


def test_the_surface_does_not_compete_with_what_is_on_it() -> None:
    checked = check(told(TEXT + " The bowl is the largest thing on the tray."), table(BOXES))
    assert [entry.verdict for entry in checked.table.claims] == [ClaimVerdict.SATISFIED] * 3


def test_learning_keeps_the_surface_of_the_layout_not_a_role(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        learned = session.learn(told(), table(BOXES))
        (layout,) = session.layouts()
        assert {match.object for match in learned.lesson.matches} == {"bowl", "spoon", "napkin"}
        assert layout.surface == "tray" and "tray" not in {role.name for role in layout.roles}
        assert session.check(layout.name, table(BOXES)).table.well


def test_a_tray_that_is_an_object_is_not_the_surface() -> None:
    script = told("The tray is left of the jug. The bowl is right of the jug.")
    boxes: dict[str, Box] = {"tray": ((0.0, 0.0, 0.0), (0.3, 0.3, 0.02)), "jug": ((0.4, 0.1, 0.0), (0.5, 0.2, 0.2))}
    boxes |= {"bowl": ((0.6, 0.1, 0.0), (0.7, 0.2, 0.1))}
    found = ground(script, table(boxes))
    assert found.surface is None and found.matches["tray"].perceived == "seen_tray"


def test_two_things_with_the_label_of_the_surface_are_not_it() -> None:
    scene = table({"tray": BOXES["tray"], "bowl": BOXES["bowl"]})
    other = PerceivedObject("other", (1.0, 0.0, 0.0), (1.5, 0.35, 0.02), label="tray", confidence=1.0)
    graph, kinds = told().graph(), default_ontology().kinds
    assert surface_thing("tray", graph, scene, kinds) == "seen_tray"
    assert surface_thing("tray", graph, Scene((*scene.objects, other)), kinds) is None
    assert surface_thing(None, graph, scene, kinds) is None


def test_an_imagined_table_is_the_surface() -> None:
    imagined = imagine(told(), time_limit=5.0)
    (drawn,) = imagined.tables
    assert [entry.verdict for entry in drawn.claims] == [ClaimVerdict.SATISFIED]
    assert not any("not shown" in line for line in imagination_lines(imagined))


def test_the_documented_json_keeps_the_match_of_the_surface() -> None:
    from deixis.report.json_answers import grounding_to_dict

    data = json.loads(json.dumps(grounding_to_dict(ground(told(), table(BOXES)))))
    assert {match["object"]: match["perceived"] for match in data["matches"]}["tray"] == "seen_tray"
    assert data["surface"] == "tray" and data["unmatched_perceived"] == []
