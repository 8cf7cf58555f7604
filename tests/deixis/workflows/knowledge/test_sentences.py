"""Take back one sentence of several: what remains is what the other sentences teach, in all memories."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from deixis.learning.update import stale
from deixis.memory.journal import MARKS
from deixis.memory.semantic.rdf.graphs import ORDER, GraphName, graph_iri
from deixis.memory.verify import verify
from deixis.ontology.tbox import default_ontology
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.robot import Robot
from deixis.session import Session
from deixis.workflows.knowledge.sentences import without_sentence
from deixis.workflows.knowledge.unlearn import Selection
from deixis.workflows.layouts.read import read_script

NAME = "This is how a 'place' is laid."
SENTENCES = (
    "The fork is left of the plate.",
    "The knife is right of the plate.",
    "The spoon is right of the knife.",
    "The cup is behind the plate.",
    "The fork is left of the knife.",
)
TIMES, PLACES = re.compile(r'"[^"]*"\^\^<[^>]*dateTime>'), re.compile(r"\bline \d+: ")


def table(shift: float = 0.0) -> Scene:
    """Return a place for one person."""
    boxes = {
        "fork": ((0.0, 0.0), (0.03, 0.2)),
        "plate": ((0.08 + shift, 0.0), (0.33 + shift, 0.25)),
        "knife": ((0.40, 0.0), (0.43, 0.22)),
        "spoon": ((0.48, 0.0), (0.52, 0.2)),
        "cup": ((0.15, 0.40), (0.24, 0.49)),
    }
    things = [
        {"id": f"o{number}", "min": [*low, 0.0], "max": [*high, 0.02], "label": name}
        for number, (name, (low, high)) in enumerate(boxes.items())
    ]
    return read_scene({"objects": things})


def content(session: Session) -> Any:
    """Return everything in a memory but times, places in texts and the ontology, and the counts of tables."""
    store = session.memory().store
    quads = {
        PLACES.sub("", TIMES.sub("time", str(quad)))
        for graph in store.named_graphs()
        if graph not in (ORDER, MARKS, graph_iri(GraphName.ONTOLOGY)) and "/package/" not in str(graph)
        for quad in store.quads_for_pattern(None, None, None, graph)
        if quad.predicate.value.rpartition("#")[2] not in ("statedAt", "line")
    }
    return quads, [repr(each.experience(session.ontology.relations)) for each in session.tables()]


def learned(session: Session, *texts: str) -> None:
    """Learn from one table after the other."""
    for number, text in enumerate(texts):
        script = read_script(text=text, english=not text.startswith("layout"))
        session.learn(replace(script, name="place"), table(0.005 * number))


def text_of(sentences: list[int], in_english: bool) -> str:
    chosen = [SENTENCES[each] for each in sentences]
    if in_english:
        return " ".join(chosen)
    return "layout place\n" + "\n".join(
        each.lower().replace("the ", "").replace("is ", "").rstrip(".") for each in chosen
    )


FOLDERS = count()


@settings(max_examples=1, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.permutations(range(5)), st.integers(2, 5), st.integers(0, 4), st.booleans(), st.booleans())
@example([0, 1, 2, 3, 4], 3, 2, True, True)
def test_the_rest_is_as_if_the_sentence_had_never_been_said(
    tmp_path: Path, order: list[int], many: int, place: int, in_english: bool, another: bool
) -> None:
    """Tell sentences of which one goes, before another table or not."""
    sentences = list(order[:many])
    rest = [each for each in sentences if each != sentences[place % many]]
    after = [text_of(rest[:1], in_english)] * another
    folder = tmp_path / str(next(FOLDERS))
    with Session(folder / "all") as session:
        learned(session, text_of(sentences, in_english), *after)
        sentence = text_of([sentences[place % many]], in_english).split("\n")[-1]
        found = session.unlearn(Selection(sentence=sentence))
        assert found.revised == ("place-1",) and found.lessons == ()
        with_sentence = content(session)
    assert verify(folder / "all", None, lambda store: stale(store, default_ontology())).findings == ()
    with Session(folder / "rest") as session:
        learned(session, text_of(rest, in_english), *after)
        assert content(session) == with_sentence


def test_facts_stay_that_refer_to_the_sentence_that_goes(tmp_path: Path) -> None:
    robot = Robot(tmp_path)
    robot.sees(table())
    robot.told(f"{NAME} {SENTENCES[0]} Look, the knife is right of it. {SENTENCES[2]}")
    assert robot.unlearn(Selection(sentence="the fork is left of the plate")).revised == ("place-1",)
    assert [str(fact) for fact in robot.session.layout("place").facts] == ["right(knife, plate)", "right(spoon, knife)"]
    assert robot.layouts["place"].experience.tables == 1 and "fork" not in robot.layouts["place"].roles
    assert set(robot.lessons[0].settled) <= {"knife", "plate", "spoon"}
    (said,) = (each.statement.object for each in robot.diary.board.holding(Pattern(predicate="said")))
    assert said == f"{NAME} Look, the knife is right of it. {SENTENCES[2]}"
    robot.close()


def test_views_go_that_only_the_sentence_taught(tmp_path: Path) -> None:
    scene = table()
    random = np.random.default_rng(0)
    clouds = [random.uniform(thing.minimum, thing.maximum, (200, 3)).astype(np.float32) for thing in scene.objects]
    things = (replace(thing, cloud=PointCloud(cloud)) for thing, cloud in zip(scene.objects, clouds, strict=True))
    with Session(tmp_path) as session:
        session.learn(
            read_script(text="layout place; fork left of plate; spoon right of plate"),
            replace(scene, objects=tuple(things), file="<table>"),
        )
        assert session.categories() == {"fork": 1, "plate": 1, "spoon": 1}
        (change,) = session.unlearn(Selection(sentence="spoon right of plate")).views
        assert (change.before, change.category) == ("spoon", None)
        assert session.categories() == {"fork": 1, "plate": 1}
        assert set(session.views().lessons_of_views().values()) == {"place-1"}
    assert verify(tmp_path).findings == ()


def test_a_lesson_of_one_sentence_goes_with_it(tmp_path: Path) -> None:
    with Session(tmp_path) as session:
        learned(session, SENTENCES[0] + " Enjoy your meal.")
        found = session.unlearn(Selection(sentence=SENTENCES[0]))
        assert (found.lessons, found.revised) == (("place-1",), ())
        assert session.layouts() == ()


@pytest.mark.parametrize("sentence", ["The cup is blue.", "fork", ""])
def test_sentences_that_a_text_lacks_are_not_cut_out(sentence: str) -> None:
    assert without_sentence("The fork is left of the plate. The knife is long.", sentence, default_ontology()) is None
