"""Fit words to lessons: which lessons count, with which weight, and equal ones once."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.learning.lessons.recollection import MatchedThings, Recollection, Remembered, labelled, recollect
from deixis.learning.models.words import fit, informed, new_lessons
from deixis.ontology.lessons.write import asserted_triples, episode_triples
from deixis.ontology.models.relations import Term
from deixis.ontology.tbox import default_ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.workflows.layouts.read import read_script

ONTOLOGY = default_ontology()
SCRIPT = "fork left of plate; knife right of plate"
KINDS = ONTOLOGY.kinds
THINGS = {"fork": (0, 2), "plate": (5, 32), "knife": (35, 37)}


def scene(*labels: str, confidence: float = 1.0) -> Scene:
    objects = [
        {"id": f"o{i}", "min": [low, 0], "max": [high, 20]}
        | ({"label": name, "confidence": confidence} if name in labels else {})
        for i, (name, (low, high)) in enumerate(THINGS.items())
    ]
    return read_scene({"unit": "cm", "objects": objects})


def remembered(lesson: str, sure: tuple[float, ...] = (1.0,) * 3, texts: tuple[str, str] | None = None) -> Remembered:
    description = read_script(text=SCRIPT).graph()
    places = tuple(list(THINGS).index(name) for name in description.nodes)
    return Remembered(lesson, description, scene(), MatchedThings(places, sure, (True,) * 3), texts or (lesson, ""))


def examples(*lessons: Remembered) -> float:
    return fit(Recollection(lessons)).models["horizontal"].provenance.examples


def test_a_fact_counts_by_how_sure_both_its_matches_are() -> None:
    description = read_script(text=SCRIPT).graph()
    sure = tuple({"fork": 0.5, "plate": 0.8, "knife": 1.0}[name] for name in description.nodes)
    assert examples(remembered("a-1")) == 2
    assert examples(remembered("a-1", sure)) == pytest.approx(0.5 * 0.8 + 0.8 * 1.0)


def test_equal_lessons_count_once_and_are_both_named() -> None:
    twice = fit(Recollection((remembered("a-1", texts=("s", "t")), remembered("a-2", texts=("s", "t")))))
    assert twice.models["horizontal"].provenance.examples == 2
    assert twice.lessons == ("a-1", "a-2")
    assert examples(remembered("a-1"), remembered("b-1")) == 4


def test_lessons_that_teach_nothing_leave_the_shipped_models() -> None:
    unsure = remembered("b-1", (0.0, 0.0, 0.0))
    assert fit(Recollection((remembered("a-1"), unsure))).lessons == ("a-1",)
    nothing = fit(Recollection((unsure,), ("c-1: broken",)))
    assert (nothing.taught, nothing.left_out) == ((), ("c-1: broken",))
    assert nothing.models == shipped_models()


def test_models_record_their_lessons_and_the_prior_strength() -> None:
    learned = fit(Recollection((remembered("a-1"), remembered("b-1"))), 2.5)
    assert learned.taught == ("horizontal", "saying")
    assert informed(learned.changed) == (frozenset({"a-1", "b-1"}), 2.5)
    assert informed([]) == (frozenset(), 1.0)


def test_examples_move_a_model_and_a_strong_prior_holds_it() -> None:
    def moved(number: int, strength: float) -> float:
        lessons = tuple(remembered(f"a-{i}") for i in range(number))
        model, prior = (models["saying"] for models in (fit(Recollection(lessons), strength).models, shipped_models()))
        pairs = zip(model.terms, prior.terms, strict=True)
        return sum(float(np.abs(degrees(term) - degrees(before)).max()) for term, before in pairs)

    def degrees(term: Term) -> NDArray[np.float64]:
        return np.interp(np.linspace(-1, 1, 41), term.knots, term.values)

    assert moved(8, 1.0) > moved(1, 1.0) > moved(1, 20.0) > 0


def test_an_invalid_strength_is_refused() -> None:
    with pytest.raises(SettingError, match="strength"):
        fit(Recollection((remembered("a-1"),)), 0.0)


def test_a_label_matches_one_thing_with_its_confidence() -> None:
    graph = read_script(text=SCRIPT).graph()
    who = labelled(graph, scene("fork", "plate", confidence=0.7), KINDS)
    by_name = dict(zip(graph.nodes, zip(who.things, who.sureness, strict=True), strict=True))
    assert by_name == {"fork": (0, 0.7), "plate": (1, 0.7), "knife": (None, 0.0)}


def test_a_narrower_label_matches_the_only_fitting_object() -> None:
    graph = read_script(text=SCRIPT).graph()
    labels = {"o0": "dinner fork", "o1": "dinner plate", "o2": "knife"}
    seen = scene()
    seen = replace(seen, objects=tuple(replace(thing, label=labels[thing.id]) for thing in seen.objects))
    assert dict(zip(graph.nodes, labelled(graph, seen, KINDS).things, strict=True)) == {
        "fork": 0,
        "plate": 1,
        "knife": 2,
    }
    seen = replace(seen, objects=tuple(replace(thing, label="salad fork") for thing in seen.objects))
    assert set(labelled(graph, seen, KINDS).things) == {None}


def test_new_examples_become_lessons_once_and_round_trip(tmp_path: Path) -> None:
    included, file = tmp_path / "more.layout", tmp_path / "t.layout"
    included.write_text("knife right of plate", encoding="utf-8")
    file.write_text('layout tea\ninclude "more.layout"\nusually fork left of plate\n', encoding="utf-8")
    script, whole, part = read_script(file), scene(*THINGS), scene("fork")
    found, left_out = new_lessons(
        [(script, whole), (script, whole), (script, part)], Recollection(()), ["words_tea-1"].__contains__
    )
    assert [lesson.id for lesson in found] == ["words_tea-2"]
    assert "remembered already, as words_tea-2" in left_out[-1]
    assert "no plain fact" in left_out[0]
    (lesson,) = found
    assert list(asserted_triples(lesson))
    recollection = recollect([], episode_triples(lesson), ONTOLOGY)
    (again,) = recollection.lessons
    assert [str(fact) for fact in again.description.facts()] == [str(fact) for fact in script.facts]
    assert examples(again) == pytest.approx(sum(fact.weight for fact in script.facts))
    assert examples(again) < 2  # one fact is hedged
    assert again.matched.decided == (True, True, True)
    assert new_lessons([(script, whole)], recollection, [].__contains__)[0] == []


def test_an_unreadable_lesson_is_left_out_with_the_reason() -> None:
    script = read_script(text=SCRIPT)
    (lesson,), _ = new_lessons([(script, scene(*THINGS))], Recollection(()), [].__contains__)
    found = recollect([], episode_triples(replace(lesson, scene_text="{")), ONTOLOGY)
    assert found.lessons == ()
    assert found.unreadable[0].startswith(f"{lesson.id}: ")
