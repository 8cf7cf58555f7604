"""Checking a table: verdicts, and that the SHACL report says the same."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import pytest
import rdflib
from hypothesis import given, settings
from hypothesis import strategies as st

import deixis
from deixis.examples_data import example
from deixis.experiments.place_settings import formal_setting
from deixis.grammar.english.reader import read_english
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Heading, PerceivedObject, Scene
from deixis.reasoning.comparison.checking import RoleVerdict
from deixis.report.json_answers import check_to_dict
from deixis.report.layouts.script import check_lines
from deixis.session import Session
from deixis.testing import assert_checks
from deixis.workflows.grounding.check import Check
from deixis.workflows.layouts.read import read_script

SH = rdflib.Namespace("http://www.w3.org/ns/shacl#")
FULL = read_script(example("formal_dinner.layout"))


def check(scene: Scene, text: str | None = None) -> Check:
    return Session(Path("unused")).check(FULL if text is None else read_script(text=text), scene)


def without(scene: Scene, *ids: str) -> Scene:
    return replace(scene, objects=tuple(o for o in scene.objects if o.id not in ids))


def swapped(scene: Scene, a: str, b: str) -> Scene:
    label = {a: b, b: a}
    return replace(scene, objects=tuple(replace(o, label=label.get(o.label or "", o.label)) for o in scene.objects))


def roles(checked: Check, verdict: RoleVerdict) -> set[str]:
    return {entry.role for entry in checked.table.of(verdict)}


@pytest.mark.parametrize(("unit", "misplaced"), [("cm", 0), ("px", 1)])  # a photograph shows heights on y
def test_boxes_seen_from_above_do_not_show_which_is_taller(unit: str, misplaced: int) -> None:
    things = [
        {"id": "o1", "min": [0, 0], "max": [3, 20], "label": "fork"},
        {"id": "o2", "min": [6, 0], "max": [29, 23], "label": "plate"},
    ]
    found = check(deixis.read_scene({"unit": unit, "objects": things}), "fork left of plate; fork taller than plate")
    assert len(roles(found, RoleVerdict.MISPLACED)) == misplaced


def test_a_table_that_is_laid_right_has_nothing_wrong_with_it() -> None:
    checked = assert_checks(FULL, formal_setting())
    assert checked.conforms
    assert len(checked.table.of(RoleVerdict.CORRECT)) == 12


def test_a_swap_that_labels_reveal_is_reported_for_both() -> None:
    swap = {"dinner_knife", "dinner_fork"}
    checked = assert_checks(FULL, swapped(formal_setting(), *sorted(swap)), misplaced=swap)
    assert not checked.table.well and not checked.conforms
    told = {str(b.fact): b for entry in checked.table.of(RoleVerdict.MISPLACED) for b in entry.broken}
    broken = told["left(dinner_fork, dinner_plate)"]
    assert broken.fact.source is not None and broken.fact.source.line == 7
    assert broken.seen is not None and broken.seen.word == "right"


def test_what_is_missing_and_what_is_extra_is_named() -> None:
    scene = without(formal_setting(), "water_glass")
    napkin = PerceivedObject("n2", (0.5, 0.1), (0.6, 0.2), label="napkin")
    vase = PerceivedObject("v", (0.7, 0.1), (0.8, 0.2), label="vase")
    more = replace(scene, objects=(*scene.objects, napkin, vase))
    checked = assert_checks(FULL, more, missing={"water_glass"}, extra={"n2", "v"})
    assert {extra.perceived: extra.reason for extra in checked.table.extra} == {
        "n2": "one napkin too many",
        "v": "the layout has no unfilled role for a vase",
    }


def test_an_unnamed_extra_object_has_the_reason_that_applies() -> None:
    scene = Scene((PerceivedObject("p", (0.0, 0.0), (0.27, 0.27)), PerceivedObject("q", (2.0, 2.0), (2.01, 2.01))))
    (extra,) = check(scene, "plate is a DinnerPlate").table.extra
    assert (extra.perceived, extra.reason) == ("q", "the scene has more objects than the layout has roles")
    (extra,) = check(Scene(scene.objects[:1]), "dinner_fork left of dinner_knife").table.extra
    assert (extra.perceived, extra.reason) == ("p", "it fits none of the unfilled roles of the layout")


def box(id: str, low: tuple[float, ...], sides: tuple[float, ...], label: str | None = None) -> PerceivedObject:
    return PerceivedObject(id, low, tuple(a + b for a, b in zip(low, sides, strict=True)), label=label)


PLATE = box("plate", (0.0, 0.0, 0.0), (0.25, 0.25, 0.02), "plate")
CUBE = (0.3, 0.3, 0.3)


def test_a_thing_of_wrong_size_and_place_is_not_a_misplaced_fork() -> None:
    scene = Scene((PLATE, box("o2", (0.3, 0.06, 0.0), CUBE)))
    checked = assert_checks("fork left of plate", scene, missing={"fork"}, extra={"o2"})
    (extra,) = checked.table.extra
    assert extra.reason == "it fits none of the unfilled roles of the layout"
    assert not checked.table.well


def test_a_thing_too_high_for_a_knife_is_not_a_misplaced_knife() -> None:
    mug = box("o2", (0.4, 0.06, 0.0), (0.12, 0.12, 0.1))  # as long and as wide as a knife that lies aslant
    low = box("o2", (0.4, 0.06, 0.0), (0.12, 0.12, 0.02))
    layout, knife = "butter_knife left of plate", {"butter_knife"}
    assert_checks(layout, Scene((PLATE, mug)), missing=knife, extra={"o2"})
    assert_checks(layout, Scene((PLATE, low)), misplaced=knife)


def test_a_thing_with_the_size_or_label_of_a_fork_is_misplaced() -> None:
    for other in (box("o2", (0.4, 0.06, 0.0), (0.025, 0.19, 0.01)), box("o2", (0.3, 0.06, 0.0), CUBE, "fork")):
        checked = check(Scene((PLATE, other)), "fork left of plate")
        assert "fork" in roles(checked, RoleVerdict.MISPLACED) and not checked.table.extra


def test_a_thing_where_a_fork_belongs_is_undetermined() -> None:
    for label in (None, "fork"):
        fork = replace(box("o2", (-0.4, 0.0, 0.0), CUBE), label=label, confidence=0.8)
        assert roles(check(Scene((PLATE, fork)), "fork left of plate"), RoleVerdict.UNDETERMINED) == {"fork"}


def test_what_is_called_a_fork_and_is_seen_in_part_is_misplaced() -> None:
    part = replace(box("o2", (0.4, 0.06, 0.0), (0.03, 0.05, 0.01)), label="fork", confidence=0.85)
    assert_checks("fork left of plate", Scene((PLATE, part)), misplaced={"fork"})


def test_a_thing_of_another_colour_is_a_finding_of_its_own() -> None:
    text = "the red mug left of plate\nnapkin is white; napkin on plate\nknife right of plate; knife is grey"
    scene = Scene(
        (
            PerceivedObject("a", (0.0, 0.05), (0.09, 0.14), label="mug", colour=(30, 58, 110)),
            PerceivedObject("n", (0.2, 0.1), (0.3, 0.2), label="napkin", colour=(244, 244, 240)),
            PerceivedObject("p", (0.15, 0.0), (0.4, 0.25), label="plate", colour=(192, 32, 32)),  # no colour is said
            PerceivedObject("k", (0.45, 0.0), (0.47, 0.22), label="knife"),  # none is seen
        ),
        unit="m",
    )
    checked = assert_checks(text, scene, miscoloured={"red_mug"})
    assert roles(checked, RoleVerdict.CORRECT) == {"napkin", "plate", "knife"}
    assert not checked.table.well and not checked.conforms
    assert "miscoloured  red_mug (a): blue, not red" in check_lines(checked)
    data = check_to_dict(checked)
    assert data["miscoloured"] == [{"object": "red_mug", "perceived": "a", "described": "red", "seen": "blue"}]
    report = rdflib.Graph().parse(data=checked.report, format="turtle")
    assert {str(value).rsplit("#")[-1] for value in report.objects(None, SH.value)} == {"blue"}


def test_what_is_misplaced_may_be_of_another_colour_too() -> None:
    scene = Scene(
        (
            PerceivedObject("n", (0.6, 0.1), (0.7, 0.2), label="napkin", colour=(192, 32, 32)),
            PerceivedObject("p", (0.15, 0.0), (0.4, 0.25), label="plate"),
        ),
        unit="m",
    )
    checked = check(scene, "napkin is white; napkin left of plate")
    assert "napkin" in roles(checked, RoleVerdict.MISPLACED)
    assert [entry.role for entry, _ in checked.table.miscoloured] == ["napkin"]
    assert {line.split()[0] for line in check_lines(checked)[1:]} >= {"misplaced", "miscoloured"}


def test_without_labels_a_place_is_never_called_correct() -> None:
    checked = check(formal_setting().without_labels())
    assert checked.table.well
    assert len(checked.table.of(RoleVerdict.UNDETERMINED)) == 12
    assert not checked.table.of(RoleVerdict.CORRECT)


def test_an_unsure_label_does_not_identify_a_thing() -> None:
    scene = formal_setting()
    unsure = replace(scene, objects=tuple(replace(o, confidence=0.6) for o in scene.objects))
    assert len(check(unsure).table.of(RoleVerdict.UNDETERMINED)) == 12


def test_a_thing_of_a_narrower_name_fills_its_role() -> None:
    labels = {"a": "dinner fork", "b": "salad fork", "p": "dinner plate", "q": "bread plate", "r": "plate"}
    places = {"a": (0.0, 0.02), "b": (0.05, 0.07), "p": (0.6, 0.8), "q": (0.9, 1.0), "r": (0.1, 0.35)}
    objects = tuple(PerceivedObject(id, (x, 0.0), (X, 0.2), label=labels[id]) for id, (x, X) in places.items())
    checked = check(Scene(objects), "2 fork left of plate")
    assert roles(checked, RoleVerdict.CORRECT) == {"fork_1", "fork_2", "plate"}
    assert {extra.perceived: extra.reason for extra in checked.table.extra} == {
        "p": "the layout has no unfilled role for a dinner plate",
        "q": "the layout has no unfilled role for a bread plate",
    }


def test_what_is_optional_may_be_absent_and_may_fail() -> None:
    scene = read_scene({"objects": [{"id": "f", "min": [0, 0], "max": [1, 1], "label": "fork"},
                                    {"id": "p", "min": [2, 0], "max": [3, 1], "label": "plate"}]})  # fmt: skip
    checked = assert_checks("fork left of plate; optional vase above plate; optional fork above plate", scene)
    assert checked.conforms
    assert roles(checked, RoleVerdict.ABSENT) == {"vase"}


@pytest.mark.parametrize("how", ["usually", "optional"])
def test_what_is_absent_is_said_to_be_dispensable_and_not_how(how: str) -> None:
    scene = replace(formal_setting(), objects=tuple(o for o in formal_setting().objects if o.id == "dinner_plate"))
    lines = check_lines(check(scene, f"dinner_plate is a plate; {how} vase above dinner_plate"))
    assert "absent       vase, which is optional" in lines


def test_a_hedged_fact_that_fails_is_a_warning_and_no_fault() -> None:
    scene = read_scene({"objects": [{"id": "f", "min": [0, 0], "max": [1, 1], "label": "fork"},
                                    {"id": "p", "min": [2, 0], "max": [3, 1], "label": "plate"}]})  # fmt: skip
    checked = assert_checks("usually fork right of plate", scene)
    assert checked.conforms
    assert SH.Warning in set(
        rdflib.Graph().parse(data=checked.report, format="turtle").objects(None, SH.resultSeverity)
    )


def test_denials_and_choices_are_checked() -> None:
    scene = read_scene({"objects": [{"id": "f", "min": [0, 0], "max": [1, 1], "label": "fork"},
                                    {"id": "p", "min": [2, 0], "max": [3, 1], "label": "plate"}]})  # fmt: skip
    assert_checks("fork left of or above plate; fork not right of plate", scene)
    wrong = check(scene, "fork not left of plate; fork right of or above plate")
    assert len(wrong.table.broken) == 2 and not wrong.conforms


@settings(deadline=None, max_examples=15)
@given(
    st.integers(0, 50),
    st.lists(st.sampled_from(FULL.objects), max_size=3, unique=True),
    st.lists(st.sampled_from(FULL.objects), min_size=2, max_size=2, unique=True),
)
def test_the_shacl_report_says_what_the_verdicts_say(seed: int, absent: list[str], swap: list[str]) -> None:
    checked = check(without(swapped(formal_setting(seed), *swap), *absent))
    report = rdflib.Graph().parse(data=checked.report, format="turtle")
    results = [
        str(report.value(result, SH.focusNode)).rsplit("/", 2)[1:]
        for result in report.subjects(rdflib.RDF.type, SH.ValidationResult)
    ]
    facts = list(FULL.graph().facts())
    assert {name for kind, name in results if kind == "role"} == roles(checked, RoleVerdict.MISSING)
    assert {str(facts[int(name) - 1]) for kind, name in results if kind == "fact"} == {
        str(entry.fact) for entry in checked.table.broken
    }
    assert {name for kind, name in results if kind not in ("role", "fact")} == {
        e.perceived for e in checked.table.extra
    }
    assert checked.conforms == checked.table.well


@pytest.mark.parametrize("swap", list(combinations(FULL.objects, 2)))
def test_of_any_swapped_pair_both_are_reported_and_nothing_else(swap: tuple[str, str]) -> None:
    checked = check(swapped(formal_setting(), *swap))
    assert roles(checked, RoleVerdict.MISPLACED) == set(swap)
    assert {entry.in_place_of for entry in checked.table.of(RoleVerdict.MISPLACED)} == set(swap)


@pytest.mark.parametrize(
    "turn", [("salad_fork", "dinner_knife", "soup_spoon"), ("salad_fork", "dinner_fork", "dinner_knife")]
)
def test_exactly_the_three_swapped_objects_are_misplaced(turn: tuple[str, str, str]) -> None:
    label = dict(zip(turn, (*turn[1:], turn[0]), strict=True))
    scene = formal_setting()
    turned = replace(scene, objects=tuple(replace(o, label=label.get(o.label or "", o.label)) for o in scene.objects))
    assert roles(check(turned), RoleVerdict.MISPLACED) == set(turn)


def test_a_thing_without_a_failed_fact_is_not_misplaced() -> None:
    boxes = {"fork": 1, "knife": 0, "plate": 2, "salt_shaker": 4}
    scene = Scene(tuple(PerceivedObject(n, (x, 0.0), (x + 0.5, 1.0), label=n) for n, x in boxes.items()))
    says = "fork left of plate; knife right of plate; salt_shaker is a SaltShaker"
    assert roles(check(scene, says), RoleVerdict.MISPLACED) == {"knife"}
    assert roles(check(scene, says + "; optional salt_shaker above plate"), RoleVerdict.MISPLACED) == {"knife"}


def test_hedged_and_denied_objects_are_optional_but_reported() -> None:
    boxes = {"fork": (0.0, 0.0), "plate": (2.0, 0.0), "candle": (2.0, -3.0)}
    scene = Scene(tuple(PerceivedObject(n, (x, y), (x + 1, y + 1), label=n) for n, (x, y) in boxes.items()))
    checked = check(scene, "maybe candle above plate; fork left of plate; not vase on plate")
    assert checked.table.well and checked.conforms
    assert [str(entry.fact) for entry in checked.table.unexpected] == ["top(candle, plate)"]
    assert roles(
        check(without(scene, "candle"), "maybe candle above plate; fork left of plate"), RoleVerdict.ABSENT
    ) == {"candle"}


def test_a_number_of_things_alike_is_correct_by_its_name() -> None:
    scene = Scene(
        (
            PerceivedObject("a", (0.0, 2.0), (1.0, 3.0), label="wine glass"),
            PerceivedObject("b", (2.0, 2.0), (3.0, 3.0), label="wine glass"),
            PerceivedObject("p", (0.0, 0.0), (3.0, 1.0), label="plate"),
        )
    )
    assert len(check(scene, "2 wine_glass above plate").table.of(RoleVerdict.CORRECT)) == 3


def test_why_a_place_is_undetermined_is_said() -> None:
    scene = formal_setting()
    first, second, *_ = scene.objects
    doubtful = replace(first, confidence=0.83)
    shown = check_lines(check(replace(scene, objects=(doubtful, replace(second, label=None), *scene.objects[2:]))))
    assert any(line.endswith(f"labelled '{first.label}' with confidence 0.83, below 0.9") for line in shown)
    assert any(line.endswith("lies in its place, but nothing shows what it is") for line in shown)
    assert "correct      10 of 12, 2 undetermined" in shown
    assert any(line.startswith("Labels in the scene, or recognition, would show") for line in shown)


CLAIMED = """layout desk "My desk" on desk
dinner_plate is a DinnerPlate
dinner_fork left of dinner_plate; dinner_knife right of dinner_plate
dinner_plate between dinner_fork and dinner_knife
dinner_fork, dinner_plate, dinner_knife in a row from left to right
dinner_knife {distance} cm from dinner_fork
usually dinner_knife nearest to dinner_fork
dinner_plate has contents soup"""


@pytest.mark.parametrize(("distance", "well"), [("at most 50", True), ("at least 80", False)])
def test_claims_are_checked_and_conform_to_shapes(distance: str, well: bool) -> None:
    text = CLAIMED.format(distance=distance)
    scene = formal_setting()
    kept = {"dinner_fork", "dinner_plate", "dinner_knife"}
    checked = check(without(scene, *(o.id for o in scene.objects if o.label not in kept)), text)
    assert (checked.table.well, checked.conforms) == (well, well)
    answer = check_to_dict(checked)["claims"]
    assert [entry["verdict"] for entry in answer[:2]] == ["satisfied", "satisfied"]
    assert [entry["verdict"] for entry in answer[2:]] == [
        "satisfied" if well else "violated",
        "violated",
        "undecidable",
    ]
    told = "\n".join(check_lines(checked))
    assert ("cm from dinner_fork" in told.split("unexpected")[0]) is not well
    assert "unexpected   nearest(dinner_knife, dinner_fork)" in told
    assert "unchecked    contents(dinner_plate, 'soup'): boxes do not show the contents" in told


def test_a_learned_layout_keeps_its_claims(tmp_path: Path) -> None:
    text = CLAIMED.format(distance="at most 50")
    with Session(tmp_path / "memory") as session:
        session.learn(read_script(text=text), formal_setting())
        layout = session.layout("desk")
        assert [str(claim) for claim in layout.claims] == [str(claim) for claim in read_script(text=text).claims]
        assert layout.surface == "desk"
        count = "SELECT ?c { ?c a dx:Claim ; dx:term 'distance_less' ; dx:metres ?m FILTER(?m = 0.5) }"
        assert len(session.query(count).rows) == 1
        assert session.show("desk").splitlines()[-1] == "dinner_plate has contents soup"
        session.forget("desk-1")
        assert session.query("SELECT ?c { ?c a dx:Claim }").rows == ()


def laid(knife: tuple[float, float]) -> Scene:
    """Return a plate with a knife to the right of it, whose head points in a direction."""
    plate = box("p", (0.0, 0.0, 0.0), (0.26, 0.26, 0.02), "plate")
    lying = box("k", (0.3, 0.02, 0.0), (0.02, 0.22, 0.01), "knife")
    return Scene((plate, replace(lying, heading=Heading("head", knife, 0.99))))


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("knife pointing to plate", "turn it 90° counter-clockwise"),
        ("knife with its handle away", "turn it around"),
        ("knife pointing right", "turn it 90° clockwise"),
        ("knife not pointing away", "turn it away from there"),
    ],
)
def test_a_knife_turned_the_wrong_way_comes_with_a_remedy(text: str, remedy: str) -> None:
    checked = check(laid((0.0, 1.0)), f"knife right of plate; {text}")
    assert roles(checked, RoleVerdict.TURNED) == {"knife"} and not roles(checked, RoleVerdict.MISPLACED)
    (entry,) = check_to_dict(checked)["turned"]
    assert [said["remedy"] for said in entry["statements"]] == [remedy]
    assert f"turned       knife (k): {remedy}" in "\n".join(check_lines(checked))
    assert not checked.table.well and not checked.conforms


def test_an_unknown_side_of_a_blade_is_not_a_fault() -> None:
    checked = check(laid((0.0, 1.0)), "knife right of plate; knife facing plate")
    assert checked.table.well and checked.conforms


def glasses(*places: tuple[float, float]) -> Scene:
    """Return a plate and glasses at places in plan."""
    plate = box("p", (-0.13, -0.13, 0.0), (0.26, 0.26, 0.02), "plate")
    low = [(x - 0.03, y - 0.03, 0.0) for x, y in places]
    return Scene((plate, *(box(f"g{n}", at, (0.06, 0.06, 0.12), "glass") for n, at in enumerate(low, start=1))))


def group(scene: Scene) -> Check:
    return Session().check(read_english("The glasses stand behind the plate."), scene)


def test_each_member_of_a_group_is_checked() -> None:
    checked = group(glasses((0.0, 0.25), (0.08, 0.25), (0.08, -0.25)))
    assert {entry.perceived for entry in checked.table.of(RoleVerdict.CORRECT)} == {"p", "g1", "g2"}
    (wrong,) = checked.table.of(RoleVerdict.MISPLACED)
    assert (wrong.role, wrong.perceived) == ("glasses", "g3") and not checked.table.extra
    assert not checked.conforms and "behind(glasses, plate)" in checked.report


def test_a_group_is_well_laid_or_missing_as_a_whole() -> None:
    checked = group(glasses((0.0, 0.25), (0.08, 0.25)))
    assert checked.table.well and checked.conforms
    assert roles(group(glasses()), RoleVerdict.MISSING) == {"glasses"}


def test_a_learned_group_teaches_and_checks_all_members(tmp_path: Path) -> None:
    session, seen = Session(tmp_path), glasses((0.0, 0.25), (0.08, 0.25))
    learned = session.learn(read_english("The glasses stand behind the plate."), seen)
    assert [match.perceived for match in learned.lesson.categories() if match.object == "glasses"] == ["g1", "g2"]
    assert learned.categories == ("glass", "plate")
    checked = session.check(learned.lesson.layout.name, glasses((0.0, 0.25), (0.08, -0.25)))
    assert {entry.perceived for entry in checked.table.of(RoleVerdict.MISPLACED)} == {"g2"}
    session.close()


def test_a_misspelt_label_has_the_missing_role_as_suggestion() -> None:
    script = deixis.read_script(text="lamp right of plate; fork left of plate")
    corners = [[0.0, 0.0], [0.1, 0.0], [0.5, 0.0]], [[0.03, 0.2], [0.33, 0.23], [0.65, 0.15]]
    scene = Scene.from_boxes(*corners, labels=["fork", "plate", "lampp"])
    (extra,) = deixis.check(script, scene).table.extra
    assert extra.reason.endswith("for a lampp; did you mean 'lamp'?")
