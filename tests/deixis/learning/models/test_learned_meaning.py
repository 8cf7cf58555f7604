"""Learned words and sizes in a session: used at once, recorded with their provenance, removed with their lessons."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from commands import deixis

from deixis.examples_data import example
from deixis.memory.semantic.exchange import export_memory
from deixis.memory.semantic.rdf.graphs import ModelSet
from deixis.ontology.models.relation_triples import models_from_triples
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.errors import NothingFoundError
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED
from deixis.reasoning.grounding.fitting.fit import FEW_SCENES
from deixis.session import Session
from deixis.workflows.layouts.read import read_script

FULL, LABELLED = (example(name) for name in ("formal_dinner.layout", "place_setting.labelled.scene.json"))
PLATE = "https://w3id.org/deixis/onto#DinnerPlate"
SCRIPT = "layout tea; cup left of dinner_plate; spoon right of dinner_plate"


def table(shift: float, plate: float = 0.4, labels: bool = True) -> Scene:
    """Return a scene with a cup, a dinner plate of some width, and a spoon, all labelled."""
    sides = {"cup": (-0.2, -0.1), "dinner_plate": (0.0, plate), "spoon": (plate + 0.05, plate + 0.08)}
    objects = [
        {"id": name[:2], "min": [low + shift, 0], "max": [high + shift, plate], "label": name if labels else None}
        for name, (low, high) in sides.items()
    ]
    return read_scene({"objects": objects})


def taught(path: Path, *shifts: float) -> Session:
    session = Session(path)
    session.learn_relations([(read_script(text=SCRIPT), table(shift)) for shift in shifts])
    return session


def test_without_a_memory_the_shipped_models_are_in_force(tmp_path: Path) -> None:
    with Session(tmp_path / "none") as session:
        assert session.meaning() is SHIPPED
        assert session.recollection().lessons == ()
        with pytest.raises(NothingFoundError, match="there are no lessons at"):
            session.learn_relations()
    assert not (tmp_path / "none").exists()


def test_learned_words_and_sizes_are_in_force_at_once_and_later(tmp_path: Path) -> None:
    with taught(tmp_path / "memory", 0.0, 0.1, 0.2) as session:
        now = session.meaning()
    with Session(tmp_path / "memory") as session:
        assert session.memory().lessons() == ("words_tea-1", "words_tea-2", "words_tea-3")
        later = session.meaning()
        assert session.meaning() is later
        assert session.query("ASK { ?l a dx:Layout }").boolean is False
    assert now.models is not None and later.models is not None
    assert now.models == later.models
    where = later.models["horizontal"].provenance
    assert (where.examples, where.lessons) == (6, ("words_tea-1", "words_tea-2", "words_tea-3"))
    assert 0.36 < np.exp(later.sizes[PLATE].length[0]) < 0.4  # plates are usually 0.27 wide
    assert later.sizes[PLATE].views == 3


@pytest.mark.slow
def test_grounding_a_check_and_a_lesson_go_by_what_was_learned(tmp_path: Path) -> None:
    """Match the thing of the learned size with the plate, not the thing of the usual size."""
    sides = {"usual": (0.0, 0.27), "seen": (0.5, 0.9)}
    things = [{"id": id, "min": [low, 0], "max": [high, high - low]} for id, (low, high) in sides.items()]
    scene = read_scene({"objects": [*things, {"id": "near", "min": [-0.2, 0], "max": [-0.1, 0.2]}]})
    script = read_script(text="layout tea; dinner_plate right of cup")
    with Session(tmp_path / "plain") as session:
        before = session.check(script, scene).table.grounding.matches["dinner_plate"].perceived
    with taught(tmp_path / "memory", 0.0, 0.1, 0.2) as session:
        grounded = session.ground(script, scene).matches["dinner_plate"].perceived
        after = session.check(script, scene).table.grounding.matches["dinner_plate"].perceived
        learned = session.learn(script, scene).grounding.matches["dinner_plate"].perceived
    assert (before, grounded, after, learned) == ("usual", "seen", "seen", "seen")


def test_forgetting_a_lesson_takes_back_what_it_taught(tmp_path: Path) -> None:
    with taught(tmp_path / "memory", 0.0, 0.1, 0.2) as session:
        session.forget("words_tea-2")
        meaning = session.meaning()
        assert meaning.models is not None
        assert meaning.models["horizontal"].provenance.lessons == ("words_tea-1", "words_tea-3")
        assert meaning.models["horizontal"].provenance.examples == 4
        assert PLATE not in meaning.sizes  # two views are too few
        alone = meaning.models
    with taught(tmp_path / "other", 0.0, 0.2) as session:
        again = session.meaning().models
        assert again is not None
        assert again["horizontal"].terms == alone["horizontal"].terms
        session.forget("words_tea-1")
        session.forget("words_tea-2")
        assert session.meaning().models is None
        assert session.memory().models(ModelSet.WORDS) == []


def test_forgetting_one_of_many_lessons_looks_at_no_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Bound the difference to the words of the other lessons by two fifths of what the contradicting lesson changes."""
    shifts = [number / 10 for number in range(FEW_SCENES + 5)]
    gone = [(read_script(text="layout tea; spoon left of dinner_plate"), table(0.05))]
    with taught(tmp_path / "memory", *shifts) as session:
        session.learn_relations(gone)
        before = session.meaning().models
    monkeypatch.setattr("deixis.learning.update.fit", None)
    with Session(tmp_path / "memory") as session:
        session.forget("words_tea-26")
        now = session.meaning().models
    monkeypatch.undo()
    with Session(tmp_path / "memory") as session:
        session.learn_relations()
        anew = session.meaning().models
    assert before is not None
    assert now is not None
    assert anew is not None
    assert now["horizontal"].provenance.lessons == anew["horizontal"].provenance.lessons
    assert len(now["horizontal"].provenance.lessons) == FEW_SCENES + 5
    values = [np.concatenate([term.values for term in models["horizontal"].terms]) for models in (before, now, anew)]
    assert np.abs(values[1] - values[2]).max() < 0.4 * np.abs(values[0] - values[2]).max()


def test_after_a_reset_the_lessons_can_teach_again(tmp_path: Path) -> None:
    with taught(tmp_path / "memory", 0.0) as session:
        learned = session.meaning().models
        session.forget_relations()
        assert session.meaning().models is None
        assert session.memory().lessons() == ("words_tea-1",)
        again = session.learn_relations()
        assert (again.lessons, again.kept) == (("words_tea-1",), ())
        assert learned is not None
        assert again.models["horizontal"].terms[0] in learned["horizontal"].terms


@pytest.mark.slow
def test_a_grounding_teaches_words_by_how_sure_it_is(tmp_path: Path) -> None:
    with Session(tmp_path / "memory") as session:
        session.learn(read_script(text=SCRIPT), table(0.0, 0.27, labels=False))
        (lesson,) = session.recollection().lessons
        assert lesson.matched.things == (0, 1, 2)
        assert all(0 < sure <= 1 for sure in lesson.matched.sureness)
        learned = session.learn_relations()
    sure = dict(zip(lesson.description.nodes, lesson.matched.sureness, strict=True))
    expected = sure["dinner_plate"] * (sure["cup"] + sure["spoon"])
    assert learned.models["horizontal"].provenance.examples == pytest.approx(expected)


def test_learned_models_survive_export_and_merge_on_import(tmp_path: Path) -> None:
    with taught(tmp_path / "first", 0.0, 0.1) as session:
        (tmp_path / "first.trig").write_text(export_memory(session.memory()), encoding="utf-8")
    with Session(tmp_path / "copy") as session:
        session.import_(tmp_path / "first.trig")
        assert export_memory(session.memory()) == (tmp_path / "first.trig").read_text(encoding="utf-8")
    with Session(tmp_path / "second") as session:
        script = read_script(text=SCRIPT.replace("tea", "coffee"))
        session.learn_relations([(script, table(0.3))])
        session.import_(tmp_path / "first.trig")
        meaning = session.meaning()
        models = models_from_triples(session.memory().models(ModelSet.WORDS))
    lessons = ("words_coffee-1", "words_tea-1", "words_tea-2")
    assert {model.provenance.lessons for model in models} == {lessons}
    assert meaning.models is not None
    assert meaning.models["horizontal"].provenance.examples == 6
    assert meaning.sizes[PLATE].views == 3


@pytest.mark.slow
def test_the_commands_say_what_is_kept_and_stats_count_it(tmp_path: Path) -> None:
    memory = tmp_path / "memory"
    code, out, _ = deixis("learn-relation", FULL, LABELLED, "--memory", memory)
    assert (code, out.splitlines()[-3:-1]) == (
        0,
        ["lessons     words_formal_dinner-1", "kept as     words_formal_dinner-1"],
    )
    counted = json.loads(deixis("memory", "stats", "--json", "--memory", memory)[1])
    assert (counted["lessons"], counted["layouts"], counted["relation_models"], counted["size_models"]) == (1, 0, 5, 0)
    assert deixis("memory", "forget", "words_formal_dinner-1", "--memory", memory)[0] == 0
    code, out, _ = deixis("relation", "left", "--memory", memory)
    assert "shipped, from prototypes" in out
