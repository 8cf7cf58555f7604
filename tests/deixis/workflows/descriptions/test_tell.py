"""Telling layouts and scenes in English: reading the text gives the same facts, and grounding it the same objects."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import deixis
from deixis.grammar.english.reader import read_english
from deixis.grammar.script import Script
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import OutOfTimeError
from deixis.workflows.layouts.infer import inference_of

EXAMPLES = Path(deixis.__file__).parents[2] / "examples"
RELATIONS = default_ontology().relations
NAMES = ["fork", "plate", "wine_glass", "jug", "cup_1", "cup_2", "dinner_fork", "spoon"]
WIDE = ["left of", "right of", "above", "below", "on", "under", "top left of", "bottom right of"]
GRADED = ["near", "next to", "inside", "containing", "behind", "taller than", "stacked on", "facing", "ringed by"]
FRONT = ["", "", "", "", "usually ", "not ", "optional ", "probably ", "optional not ", "rarely "]


def statements(relations: list[str], fronts: list[str]) -> st.SearchStrategy[list[str]]:
    ends = st.lists(st.sampled_from(NAMES), min_size=2, max_size=2, unique=True)
    said = st.builds(lambda f, r, e: f"{f}{e[0]} {r} {e[1]}", st.sampled_from(fronts), st.sampled_from(relations), ends)
    return st.lists(said, min_size=1, max_size=7)


def read_again(told: deixis.Telling) -> Script:
    return deixis.read_script(text=told.text, english=True)


def meanings(script: Script) -> set[tuple[object, ...]]:
    """Return the facts of a script, each from the side that is first by name; what is rarely so need not hold."""
    found: set[tuple[object, ...]] = set()
    facts = [f.content for f in script.reading.stated] if script.reading else script.facts
    for fact in facts:
        if isinstance(fact, deixis.Fact):
            forward = (sorted(r.name for r in fact.relations), fact.subject, fact.object)
            backward = (sorted(r.inverse for r in fact.relations), fact.object, fact.subject)
            names, subject, thing = min(forward, backward)
            optional = fact.optional or fact.weight <= 0.5
            found.add((tuple(names), subject, thing, fact.positive, optional, fact.weight))
    return found


@given(statements(WIDE + GRADED, FRONT))
@settings(max_examples=60, deadline=None)
def test_reading_all_told_facts_gives_the_same_facts(said: list[str]) -> None:
    script = deixis.read_script(text="\n".join(said))
    told = deixis.tell(script, all_facts=True)
    assert told.misread == ()
    assert meanings(read_again(told)) == meanings(script)


@given(statements(WIDE, [""]))
@settings(max_examples=40, deadline=None)
def test_what_is_left_out_follows_from_the_description(said: list[str]) -> None:
    script = deixis.read_script(text="\n".join(said))
    told = deixis.tell(script)
    again = read_again(told)
    if not inference_of(script).consistent:
        assert meanings(again) == meanings(script)
        return
    follows = {(r.fact.relations[0].name, r.fact.subject, r.fact.object) for r in inference_of(again).inferred()}
    follows |= {(f.relations[0].name, f.subject, f.object) for f in again.facts}
    follows |= {(RELATIONS[name].inverse, thing, subject) for name, subject, thing in follows}
    assert {(f.relations[0].name, f.subject, f.object) for f in script.facts} <= follows


def test_sentences_join_subjects_and_predicates() -> None:
    script = deixis.read_script(text="fork, spoon left of plate\nfork, spoon below jug\nnot on(fork, mat)")
    assert deixis.tell(script).text == (
        "The fork and the spoon are left of the plate and nearer to you than the jug. The fork is not on the mat."
    )


def test_places_are_on_the_surface_that_the_layout_names() -> None:
    text = "layout work on bench; lamp at the far left corner; mug left of jug"
    told = deixis.tell(deixis.read_script(text=text)).text
    assert "in the far left corner of the bench" in told
    read = read_english(told)
    assert read.surface == "bench"
    assert "corner(lamp, 'far left')" in map(str, read.claims)


def test_numbered_objects_are_counted() -> None:
    script = deixis.read_script(text="2 wine_glass above knife; wine_glass_1 left of wine_glass_2")
    told = deixis.tell(script)
    first, second = (sentence.text for sentence in told.sentences)
    assert first == "Two wine glasses are farther from you than the knife."
    assert second == "The first wine glass is left of the second wine glass."


def test_choices_are_read_as_one_fact() -> None:
    script = deixis.read_script(text="fork left of or top left of plate; usually jug left of or behind plate")
    again = read_again(deixis.tell(script))
    assert [(str(fact), fact.weight) for fact in again.facts] == [
        ("left or top_left(fork, plate)", 1.0),
        ("left or behind(jug, plate)", 0.8),
    ]


def test_kinds_and_colours_are_described() -> None:
    script = deixis.read_script(text="prong is a fork; prong left of plate; plate is white")
    again = read_again(deixis.tell(script))
    assert again.kinds["prong"].label == "fork"
    assert again.colours["plate"].label == "white"


def test_names_that_would_be_misread_are_in_backticks() -> None:
    script = deixis.read_script(text='"left shoe" on table; "of" left of "left shoe"')
    told = deixis.tell(script)
    assert told.misread == ()
    assert meanings(read_again(told)) == meanings(script)


@pytest.mark.parametrize("name", ["chopsticks", "scissors", "sunglasses", "shoes", "boots"])
def test_a_plural_name_is_read_again_as_one_object(name: str) -> None:
    script = deixis.read_script(text=f"{name} left of plate; mug behind {name}")
    told = deixis.tell(script)
    assert f"{name} are left of" in told.text.replace("`", "")
    assert told.misread == () and meanings(read_again(told)) == meanings(script)


def test_a_label_that_is_a_plural_has_a_plural_verb() -> None:
    boxes = {"plate": (10, 33), "chopsticks": (35, 37), "mug": (50, 58)}
    objects = [{"id": f"o{n}", "min": [a, 5], "max": [b, 25], "label": n} for n, (a, b) in boxes.items()]
    told = deixis.tell({"unit": "cm", "objects": objects})
    assert "he chopsticks are " in told.text and "chopsticks is" not in told.text


def test_an_english_text_is_described_with_its_claims() -> None:
    text = "The lamp is in the far left corner of the desk. The cup is between the lamp and the jug. The cup is red."
    told = deixis.tell(deixis.read_script(text=text, english=True))
    again = read_again(told)
    assert told.misread == ()
    assert {str(c) for c in again.claims} == {
        "corner(lamp, 'far left')",
        "between(cup, lamp, jug)",
        "colour(cup, 'red')",
    }


@pytest.mark.parametrize("name", ["place_setting.labelled", "second_table", "study"])
def test_a_told_scene_finds_its_objects(name: str) -> None:
    told = deixis.tell(EXAMPLES / f"{name}.scene.json")
    scene = deixis.read_scene(EXAMPLES / f"{name}.scene.json")
    assert all(thing.found for thing in told.objects)
    for thing in told.objects:
        if thing.description is not None:
            assert deixis.refer(thing.description, scene).target == thing.id


@given(st.integers(0, 10_000))
@settings(max_examples=8, deadline=None)
def test_descriptions_in_random_scenes_single_out(seed: int) -> None:
    random = np.random.default_rng(seed)
    low = random.permutation(16)[:6, None] // [[1, 4]] % 4 * 0.3 + random.uniform(0, 0.1, (6, 2))
    boxes = [
        {"id": f"o{i}", "min": corner.tolist(), "max": (corner + 0.12).tolist(), "label": label}
        for i, (corner, label) in enumerate(zip(low, ["plate", "cup", "cup", "cup", "jug", "spoon"], strict=True))
    ]
    scene = deixis.read_scene({"objects": boxes})
    told = deixis.tell(scene)
    assert told.misread == ()
    assert {thing.id for thing in told.objects} == set(scene.ids)
    for thing in told.objects:
        if thing.description is not None:
            assert deixis.refer(thing.description, scene).target == thing.id


def test_an_empty_scene_has_nothing_to_tell() -> None:
    told = deixis.tell({"objects": []})
    assert (told.text, told.notes) == ("", ("the scene has no objects",))


def test_a_text_without_time_to_read_it_has_a_note() -> None:
    told = deixis.tell(deixis.read_script(text="fork left of plate"), time_limit=0)
    assert told.text == "The fork is left of the plate."
    assert "time limit reached: the text was not read again" in told.notes


def test_without_time_to_ground_the_text_nothing_is_added(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = EXAMPLES / "second_table.scene.json"
    plain = deixis.tell(scene, time_limit=120.0)

    def late(*_: object, **__: object) -> None:
        raise OutOfTimeError("time limit reached")

    monkeypatch.setattr("deixis.workflows.grounding.ground.ground", late)
    telling = deixis.tell(scene, time_limit=120.0)
    assert len(telling.facts) <= len(plain.facts)
    assert {thing.found for thing in telling.objects} == {None}
    assert "time limit reached: whether the text singles out each object was not checked" in telling.notes
