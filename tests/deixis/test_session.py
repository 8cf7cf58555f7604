"""Deixis from Python as in its design: read, ground, infer; answers are plain immutable data."""

from __future__ import annotations

import copy
import dataclasses
import pickle
from collections.abc import Mapping
from datetime import datetime, tzinfo
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import deixis
from deixis.errors import ArgumentError, DeixisError
from deixis.examples_data import example
from deixis.memory.errors import MemoryFormatError
from deixis.perception.errors import SceneError
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.report.grounding.ground import grounding_lines
from deixis.testing import assert_grounds

SCRIPT1 = deixis.read_script(example("script1.layout"))
SCENE = deixis.read_scene(example("place_setting.scene.json"))
LABELLED = deixis.read_scene(example("place_setting.labelled.scene.json"))
TRUTH = {thing.label: thing.id for thing in LABELLED.objects}


def names(found: Grounding) -> dict[str, str]:
    return {name: match.perceived for name, match in found.matches.items()}


def box(id: str, x: float, **more: Any) -> dict[str, Any]:
    return {"id": id, "min": [x, 0.0], "max": [x + 1, 1.0], **more}


MUGS = deixis.read_script(text="the red mug, blue_mug, green mug left of plate; the plate is white")
SEEN = {"red_mug": "#b01c24", "blue_mug": "#2040a0", "green_mug": "green", "plate": [232, 230, 224]}


def mugs(colours: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene of three mugs that differ only in colour, and a plate."""
    at = {"green_mug": 0.0, "red_mug": 1.5, "blue_mug": 3.0, "plate": 6.0}
    return {"unit": "px", "objects": [box(f"the {name}", x, colour=colours.get(name)) for name, x in at.items()]}


def test_colours_tell_apart_what_words_cannot() -> None:
    found = deixis.ground(MUGS, mugs(SEEN))
    assert names(found) == {name: f"the {name}" for name in SEEN}
    assert all(match.decided for match in found.matches.values())
    assert not found.interchangeable
    assert ("blue_mug", "green_mug", "red_mug") in deixis.ground(MUGS, mugs({})).interchangeable


def test_a_colour_that_does_not_fit_loses_to_the_facts() -> None:
    swapped = {**SEEN, "plate": "black"}
    assert names(deixis.ground(MUGS, mugs(swapped)))["plate"] == "the plate"


def test_as_the_design_has_it() -> None:
    script = deixis.read_script(example("formal_dinner.layout"))
    found = deixis.ground(script, SCENE)
    assert found.matches["dinner_plate"].perceived == "o8"
    assert names(found) == TRUTH
    assert all(match.decided for match in found.matches.values())
    assert found.proved_best
    assert not found.violated


def test_paths_and_dicts_will_do() -> None:
    script, scene = example("formal_dinner.layout"), example("place_setting.scene.json")
    assert names(deixis.ground(str(script), str(scene))) == names(deixis.ground(script, scene)) == TRUTH
    assert names(deixis.ground(deixis.read_script(text="a left of b"), {"objects": [box("p", 5), box("q", 0)]})) == {
        "a": "q",
        "b": "p",
    }


def test_absent_objects_are_absent() -> None:
    found = deixis.ground(deixis.read_script(text="a left of b; b left of c"), {"objects": [box("p", 0), box("q", 5)]})
    assert len(found.matches) == 2
    (absent,) = found.unmatched_objects
    assert absent.name not in found.matches
    with pytest.raises(KeyError):
        found.matches[absent.name]


def test_a_script_comes_from_a_path_or_a_text() -> None:
    with pytest.raises(TypeError, match="must be given a path or `text`, got neither"):
        deixis.read_script()
    with pytest.raises(TypeError, match="must be given a path or `text`, got both"):
        deixis.read_script("some.layout", text="a left of b")


def test_errors_are_deixis_errors_and_built_in_ones() -> None:
    with pytest.raises(deixis.DeixisError, match="there is no engine 'magic'") as caught:
        deixis.ground(SCRIPT1, SCENE, engine="magic")
    assert isinstance(caught.value, LookupError)
    with pytest.raises(deixis.DeixisError):
        deixis.read_script(text="fork lft of plate")
    with pytest.raises(deixis.DeixisError):
        deixis.read_scene({"objects": [box("o", 0), box("o", 1)]})


def test_names_are_offered_and_others_are_refused() -> None:
    assert set(deixis.__all__) <= set(dir(deixis))
    assert all(getattr(deixis, name) is not None for name in deixis.__all__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = deixis.nothing


def test_another_viewpoint_is_noted() -> None:
    script = deixis.read_script(text="layout seen from window\na left of b")
    (note,) = deixis.ground(script, {"objects": [box("p", 0), box("q", 5)]}).notes
    assert "'window'" in note
    assert "'chair'" in note
    assert not any("seen from" in note or "chair" in note for note in deixis.ground(SCRIPT1, SCENE).notes)


def test_a_contradictory_script_is_noted() -> None:
    found = deixis.ground(example("contradiction.layout"), SCENE)
    assert any(note.startswith("the script contradicts itself") for note in found.notes)
    assert found.violated


def test_certain_labels_decide() -> None:
    found = deixis.ground(SCRIPT1, LABELLED)
    assert names(found) == TRUTH
    assert sum(match.decided for match in found.matches.values()) == 12
    assert found.interchangeable == ()


def test_certain_labels_outweigh_facts() -> None:
    scene = {"objects": [box("p", 5, label="a"), box("q", 0)]}
    found = deixis.ground(deixis.read_script(text="a left of b"), scene)
    assert names(found) == {"a": "p", "b": "q"}
    assert len(found.violated) == 1


@pytest.mark.parametrize(("confidence", "fork"), [(0.1, "q"), (0.9, "p"), (0.0, "q")])
def test_an_uncertain_label_weighs(confidence: float, fork: str) -> None:
    scene = {"unit": "px", "objects": [box("p", 5, label="fork", confidence=confidence), box("q", 0)]}
    assert_grounds("fork left of plate", scene, {"fork": fork})


def test_an_uncertain_label_settles_what_facts_leave_open() -> None:
    script = deixis.read_script(text="gizmo left of plate; doodad left of plate")
    things = [box("p", 0), box("q", 2, label="gizmo", confidence=0.9), box("r", 8)]
    found = deixis.ground(script, {"unit": "px", "objects": things})
    assert names(found) == {"gizmo": "q", "plate": "r", "doodad": "p"}
    unlabelled = deixis.ground(script, {"unit": "px", "objects": [box("p", 0), box("q", 2), box("r", 8)]})
    assert unlabelled.interchangeable == (("doodad", "gizmo"),)
    assert (found.matches["gizmo"].probability or 0) > 0.5 >= (unlabelled.matches["gizmo"].probability or 0)


EXPECTED: dict[str, Grounding] = {}
"""Answers of each engine in the order of the files, each computed once."""


@settings(max_examples=8, deadline=None)
@given(st.permutations(range(12)), st.permutations(range(11)), st.sampled_from(["exact", "similarity"]))
def test_the_order_of_lines_and_things_does_not_matter(things: list[int], lines: list[int], engine: str) -> None:
    stated = [str(fact) for fact in SCRIPT1.facts]
    expected = EXPECTED.get(engine) or EXPECTED.setdefault(engine, deixis.ground(SCRIPT1, SCENE, engine=engine))
    script = deixis.read_script(text="\n".join(stated[i] for i in lines))
    found = deixis.ground(script, SCENE.reordered(things), engine=engine)
    assert names(found) == names(expected)
    assert {frozenset(group) for group in found.interchangeable} == {frozenset(g) for g in expected.interchangeable}
    assert found.graph_similarity == pytest.approx(expected.graph_similarity)
    assert {n: m.decided for n, m in found.matches.items()} == {n: m.decided for n, m in expected.matches.items()}


def test_results_cannot_be_changed() -> None:
    found = deixis.ground(SCRIPT1, SCENE)
    assert isinstance(found.matches, Mapping)
    with pytest.raises(TypeError):
        found.matches["napkin"] = None  # type: ignore[index]
    for thing, field in ((found, "engine"), (found.matches["napkin"], "perceived"), (found.outcomes[0], "degree")):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(thing, field, None)
    assert isinstance(found.outcomes, tuple)
    assert isinstance(found.interchangeable, tuple)


def test_infer_takes_a_script_or_a_path() -> None:
    path = example("formal_dinner.layout")
    for inference in (deixis.infer(path), deixis.infer(str(path)), deixis.infer(deixis.read_script(path))):
        assert inference.consistent
        assert len(inference.stated) == 11
        assert "left(salad_fork, soup_spoon)" in {str(derivation.fact) for derivation in inference.inferred()}


def test_nothing_is_inferred_from_a_contradiction() -> None:
    inference = deixis.infer(example("contradiction.layout"))
    assert not inference.consistent
    assert inference.conflict is not None
    assert len(inference.conflict.facts) == 3
    assert inference.inferred() == ()


def test_a_session_without_a_memory_has_learned_nothing(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        assert (session.layouts(), session.tables(), session.categories()) == ((), (), {})
        assert not session.remembers() and not session.path.exists()


def test_an_empty_scene() -> None:
    found = deixis.ground(SCRIPT1, Scene(()))
    assert not found.matches
    assert found.graph_similarity == 0


def test_two_words_about_a_full_table_are_found_but_uncertain() -> None:
    scene = {"unit": "px", "objects": [box(f"p{i}", i) for i in range(40)]}
    found = deixis.ground(deixis.read_script(text="fork left of plate"), scene)
    assert set(found.matches) == {"fork", "plate"} and not found.violated
    assert not any(match.decided for match in found.matches.values())
    assert len(grounding_lines(found)[0]) < 200


def test_many_things_left_out_for_one_reason_are_one_line() -> None:
    scene = {"objects": [box(f"p{i}", 3 * i) for i in range(40)]}
    shown = grounding_lines(deixis.ground(deixis.read_script(text="fork left of plate"), scene))
    told = [line for line in shown if line.startswith("Left out:")]
    assert len(told) < 5 and any("more (--json lists all): " in line for line in told)


def test_a_closed_session_does_not_take_the_memory_again(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(example("formal_dinner.layout"), SCENE)
    for needs_it in (session.layouts, lambda: session.query("ASK {}"), lambda: session.views(create=True)):
        with pytest.raises(MemoryFormatError, match="this session is closed"):
            needs_it()
    with pytest.raises(MemoryFormatError, match="this session is closed"), session:
        pass
    with deixis.Session(tmp_path / "memory") as another:
        assert another.layouts()


def test_an_invalid_scene_gets_an_error_with_the_valid_forms() -> None:
    with pytest.raises(SceneError, match=r"from a file or from parsed JSON, not from int"):
        deixis.read_scene(3)  # type: ignore[arg-type]


def test_names_with_lone_surrogates_are_unknown_names(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(SCRIPT1, SCENE)
        for call in (session.layout, session.show, session.concept, session.forget):
            with pytest.raises(DeixisError, match=r"no (layout|lesson) 'a\\udcff'"):
                call("a\udcff")
        with pytest.raises(DeixisError, match=r"no layout"):
            session.check("a\udcff", SCENE)


def test_a_session_is_neither_copied_nor_pickled(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        for attempt in (copy.copy, copy.deepcopy, pickle.dumps):
            with pytest.raises(TypeError, match="a Session cannot be copied or pickled"):
                attempt(session)


def test_the_repr_of_a_session_is_one_line(tmp_path: Path) -> None:
    assert repr(deixis.Session(tmp_path / "a\nb")) == rf"<Session {tmp_path}/a\nb>"


def test_rows_of_a_query_can_be_copied_and_pickled(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(SCRIPT1, SCENE)
        found = session.query("SELECT ?role ?name WHERE { ?role a dx:Role ; rdfs:label ?name }")
    for copied in (copy.deepcopy(found), pickle.loads(pickle.dumps(found))):
        assert (copied.rows, copied.rows[0].name, copied.to_dict()) == (found.rows, found.rows[0].name, found.to_dict())


def test_a_teaching_with_half_a_role_is_refused(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        for settles in ((), ("lesson",), ("lesson", 3), "ab"):
            with pytest.raises(ArgumentError, match="`settles` must be a tuple of a string and a string or None"):
                session.teach(SCENE, "o1", "mug", settles=settles)  # type: ignore[arg-type]


def test_a_query_takes_numbers_of_numpy(tmp_path: Path) -> None:
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(SCRIPT1, SCENE)
        limits = {"time_limit": np.float32(9), "memory_limit": np.int64(2**30)}
        assert session.query("ASK { ?a ?b ?c }", **limits).boolean  # type: ignore[arg-type]


def test_a_category_is_named_by_a_text(tmp_path: Path) -> None:
    with (
        deixis.Session(tmp_path / "memory") as session,
        pytest.raises(ArgumentError, match="`category` must be a string, got 3"),
    ):
        session.teach(SCENE, "o1", 3)  # type: ignore[arg-type]


def test_show_gives_the_last_lesson_after_the_clock_went_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Clock(datetime):
        @classmethod
        def now(cls, tz: tzinfo | None = None) -> Clock:
            return cls(2020, 1, 1, tzinfo=tz)

    scene = mugs(SEEN)
    with deixis.Session(tmp_path / "memory") as session:
        session.learn(deixis.read_script(text="layout row\nred_mug left of plate"), scene)
        monkeypatch.setattr("deixis.workflows.knowledge.learn.datetime", Clock)
        session.learn(deixis.read_script(text="layout row\ngreen_mug left of plate"), scene)
        assert "green_mug" in session.show("row")
        assert session.memory().lessons() == ("row-1", "row-2")
