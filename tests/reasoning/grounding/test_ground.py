"""Grounding of descriptions in scenes."""

from __future__ import annotations

import math
import random
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from groundings import R, answer, evidence, pairs, right
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.experiments.place_settings import formal_setting
from deixis.ontology.graph.graph import RelationGraph
from deixis.perception.scene import Scene
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.answers.answer import Grounding, Outcome
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.hypotheses.hypotheses import AS_IT_STANDS
from deixis.reasoning.grounding.options import DECIDED

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
ENGINES = ["exact", "similarity"]


def shuffled(rng: random.Random, sentences: Sequence[str], graph_of: MakeGraph) -> RelationGraph:
    facts = rng.sample(list(sentences), len(sentences))
    nodes = list(graph_of(*facts).nodes)
    return graph_of(*facts, nodes=rng.sample(nodes, len(nodes)))


def reordered(rng: random.Random, scene: Scene) -> Scene:
    return scene.reordered(rng.sample(range(len(scene.objects)), len(scene.objects)))


@pytest.mark.parametrize("engine", ENGINES)
def test_figure_7_is_satisfied_with_interchangeable_groups(
    engine: str, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    found = answer(graph_of(*figure_7), formal_setting(), engine)
    assert found.engine == engine
    assert len(found.matches) == 12
    assert len(found.satisfied) == 11
    assert found.violated == ()
    assert {frozenset(group) for group in found.interchangeable} == {
        frozenset({"salad_fork", "dinner_fork"}),
        frozenset({"dessert_fork", "dessert_spoon"}),
        frozenset({"dinner_knife", "water_glass"}),
    }
    assert found.converged
    assert found.unmatched_objects == found.unmatched_perceived == ()
    assert found.proved_best == (engine == "exact")


def test_what_figure_7_cannot_tell_apart_is_not_called_decided(graph_of: MakeGraph, figure_7: list[str]) -> None:
    found = answer(graph_of(*figure_7), formal_setting())
    grouped = {name for group in found.interchangeable for name in group}
    assert len(grouped) == 6
    assert not any(found.matches[name].decided for name in grouped)
    fork = found.matches["salad_fork"]
    other = found.matches["dinner_fork"]
    assert other.perceived in [a.perceived for a in fork.alternatives]
    assert {fork.perceived, other.perceived} <= {thing.id for thing in formal_setting().objects}


def test_what_figure_7_settles_is_decided(graph_of: MakeGraph, figure_7: list[str]) -> None:
    found = answer(graph_of(*figure_7), formal_setting())
    for name in ("napkin", "dinner_plate", "bread_plate", "butter_knife"):
        assert found.matches[name].perceived == name
        assert (found.matches[name].probability or 0) > 0.9
    assert found.matches["dinner_plate"].decided


@pytest.mark.parametrize("engine", ENGINES)
def test_the_fuller_script_is_grounded_whole_in_every_order(
    engine: str, graph_of: MakeGraph, full_script: list[str]
) -> None:
    rng = random.Random(7)
    for _ in range(20):
        found = answer(shuffled(rng, full_script, graph_of), reordered(rng, formal_setting()), engine)
        assert right(found) == len(found.matches) == 12
        assert len(found.satisfied) == 11
        assert found.interchangeable == ()


@pytest.mark.parametrize("seed", range(20))
def test_fuller_script_survives_small_displacements(seed: int, graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(graph_of(*full_script), formal_setting(seed, displacement=0.01))
    assert right(found) == 12
    assert found.proved_best


@pytest.mark.parametrize("engine", ENGINES)
def test_exactly_the_glasses_that_are_not_there_are_left_out(
    engine: str, graph_of: MakeGraph, full_script: list[str], absent_glasses: list[str]
) -> None:
    found = answer(graph_of(*full_script, *absent_glasses), formal_setting(), engine)
    left_out = {entry.name for entry in found.unmatched_objects}
    assert left_out == {"white_wine_glass", "red_wine_glass", "champagne_glass"}
    assert right(found) == 12
    assert all("names more objects than were perceived" in entry.reason for entry in found.unmatched_objects)
    assert {str(entry.fact) for entry in found.of(Outcome.OPEN)} == set(absent_glasses)
    assert all(entry.perceived is None and entry.seen is None for entry in found.of(Outcome.OPEN))


PLAIN: dict[str, Grounding] = {}
"""The answers by engine when nothing is shuffled, each worked out once."""


@pytest.mark.parametrize("engine", ENGINES)
@settings(max_examples=12, deadline=None)
@given(seed=st.integers(0, 2**20))
def test_the_answer_does_not_depend_on_any_order(
    engine: str, seed: int, graph_of: MakeGraph, figure_7: list[str]
) -> None:
    """Facts, objects and perceived things are shuffled; what is interchangeable is settled by names."""
    rng = random.Random(seed)
    scene = formal_setting()
    plain = PLAIN.get(engine) or PLAIN.setdefault(engine, answer(graph_of(*figure_7), scene, engine))
    found = answer(shuffled(rng, figure_7, graph_of), reordered(rng, scene), engine)
    assert pairs(found) == pairs(plain)
    assert found.interchangeable == plain.interchangeable
    assert found.graph_similarity == pytest.approx(plain.graph_similarity)
    assert {name: m.decided for name, m in found.matches.items()} == {
        name: m.decided for name, m in plain.matches.items()
    }


@settings(max_examples=25, deadline=None)
@given(data=st.data(), seed=st.integers(0, 2**20))
def test_no_order_changes_the_answer_to_random_questions(
    data: st.DataObject, seed: int, graph_of: MakeGraph, random_boxes: MakeBoxes
) -> None:
    boxes = np.unique(random_boxes(data, most=5, shortest=1), axis=0)
    ids = [f"o{i}" for i in range(len(boxes))]
    words = st.sampled_from(["left", "top", "on", "top_left", "left or on", "not right"])
    names = st.sampled_from("abcde")
    triples = st.tuples(words, names, names).filter(lambda t: t[1] != t[2])
    drawn = data.draw(st.lists(triples, min_size=1, max_size=6, unique_by=lambda t: t[1:]))
    sentences = [f"{word}({s}, {o})" for word, s, o in drawn]
    rng = random.Random(seed)
    plain = ground(no_unary_evidence(graph_of(*sentences), scene_relations(ids, boxes, R)), engine_named("exact"))
    centres = boxes.sum(axis=1)
    if len(np.unique(centres, axis=0)) < len(boxes):
        return  # which of two concentric boxes lies on the other is a matter of listing
    order = rng.sample(range(len(ids)), len(ids))
    scene = scene_relations([ids[i] for i in order], boxes[order], R)
    found = ground(no_unary_evidence(shuffled(rng, sentences, graph_of), scene), engine_named("exact"))
    assert pairs(found) == pairs(plain)


def test_a_violated_fact_is_reported_with_what_was_perceived(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(
        graph_of(*full_script, "left(bread_plate, salad_fork)", "right(napkin, soup_spoon)"), formal_setting()
    )
    assert right(found) == 12
    (wrong,) = [entry for entry in found.violated if entry.fact.subject == "napkin"]
    assert str(wrong.fact) == "right(napkin, soup_spoon)"
    assert wrong.fact.source is not None
    assert wrong.fact.source.line == 13
    assert (wrong.outcome, wrong.degree, wrong.perceived) == (Outcome.VIOLATED, 0.0, ("napkin", "soup_spoon"))
    assert wrong.seen is not None
    assert wrong.seen.word == "left"
    assert found.matches["napkin"].score < 1


def test_violated_optional_fact_is_waived_without_cost(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(graph_of(*full_script, "optional right(napkin, soup_spoon)"), formal_setting())
    assert found.violated == ()
    assert [str(entry.fact) for entry in found.of(Outcome.WAIVED)] == ["right(napkin, soup_spoon)"]
    assert found.matches["soup_spoon"].score == 1.0


def test_an_optional_fact_that_holds_is_satisfied(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(graph_of(*full_script, "optional left(napkin, soup_spoon)"), formal_setting())
    assert len(found.satisfied) == 12


def test_score_is_the_weighted_mean_degree(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    """a lies top left of b: left holds to 0.5 and weighs 1, top left wholly and weighs 0.5; on, as rarely, does not."""
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (4, 5)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(a, b)", "0.5 top_left(a, b)", "0.2 on(a, b)")
    found = ground(no_unary_evidence(description, scene), engine_named("exact"))
    assert found.matches["a"].score == pytest.approx((0.5 + 0.5 + 0.8) / 2.3)
    assert [entry.degree for entry in found.outcomes] == [0.5, 1.0, 1.0]
    assert {entry.outcome for entry in found.outcomes} == {Outcome.SATISFIED}


def test_an_object_of_which_nothing_is_said_scores_1(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    scene = scene_relations(["p"], boxes_of([(0, 1), (0, 1)]), R)
    found = ground(no_unary_evidence(graph_of(nodes="a"), scene), engine_named("exact"))
    assert found.matches["a"].score == 1.0


def test_more_things_than_objects_leave_some_out_with_a_reason(graph_of: MakeGraph, full_script: list[str]) -> None:
    fewer = [s for s in full_script if "napkin" not in s and "soup_spoon" not in s]
    found = answer(graph_of(*fewer), formal_setting())
    assert len(found.matches) == 10
    assert len(found.unmatched_perceived) == 2
    assert all("fewer things than were perceived" in entry.reason for entry in found.unmatched_perceived)


def test_the_cost_of_an_alternative_is_what_it_loses(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    found = ground(no_unary_evidence(graph_of("left(a, b)"), scene), engine_named("exact"))
    a = found.matches["a"]
    costs = {other.perceived: other.cost for other in a.alternatives}
    probabilities = {other.perceived: other.probability for other in a.alternatives}
    assert probabilities["q"] is not None and a.probability is not None
    assert costs["q"] == pytest.approx(math.log(a.probability / probabilities["q"]))
    assert a.decided == (a.probability >= DECIDED)


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("objects", "things"), [(0, 0), (0, 2), (2, 0)])
def test_nothing_said_or_nothing_seen_is_answered(
    engine: str, objects: int, things: int, graph_of: MakeGraph, boxes_of: MakeBoxes
) -> None:
    boxes = boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)])[:things] if things else np.zeros((0, 2, 2))
    scene = scene_relations(["p", "q"][:things], boxes, R)
    description = graph_of("left(a, b)") if objects else graph_of()
    found = ground(no_unary_evidence(description, scene), engine_named(engine))
    assert dict(found.matches) == {}
    assert found.graph_similarity == 0.0
    assert [entry.reason for entry in found.unmatched_objects] == ["nothing was perceived"] * objects
    assert [entry.reason for entry in found.unmatched_perceived] == ["the description names nothing"] * things
    assert all(entry.outcome is Outcome.OPEN for entry in found.outcomes)


def test_contradictory_description_is_still_grounded(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(graph_of(*full_script, "right(napkin, dinner_plate)"), formal_setting())
    assert right(found) == 12
    assert [str(entry.fact) for entry in found.violated] == ["right(napkin, dinner_plate)"]


def test_matches_and_outcomes_are_in_the_order_of_the_script(graph_of: MakeGraph, full_script: list[str]) -> None:
    description = graph_of(*full_script)
    found = answer(description, formal_setting())
    assert tuple(found.matches) == description.nodes
    assert [str(entry.fact) for entry in found.outcomes] == full_script


def test_the_names_of_the_pairs_are_worked_out_once(
    graph_of: MakeGraph, full_script: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import deixis.reasoning.geometry.rectangle as rectangle
    import deixis.reasoning.grounding.evidence.facts.facts as facts

    related, counts = rectangle.scene_relations, []

    def counted(ids: Sequence[str], *others: Any, **options: Any) -> rectangle.SceneRelations:
        counts.append(len(ids))
        return related(ids, *others, **options)

    def again(*_: object) -> None:
        raise AssertionError("the names of the pairs are known already")

    monkeypatch.setattr(rectangle, "scene_relations", counted)
    monkeypatch.setattr(facts, "box_relations", again)
    scene = formal_setting()
    ground(evidence(graph_of(*full_script), scene), engine_named("exact", sides=AS_IT_STANDS))
    answer(graph_of(*full_script), scene, "similarity")
    assert counts == [len(scene.objects)]


def test_notes_of_the_caller_come_first_and_the_time_is_stated(graph_of: MakeGraph, full_script: list[str]) -> None:
    started = time.perf_counter()
    question = evidence(graph_of(*full_script), formal_setting())
    found = ground(question, engine_named("exact"), notes=("as seen from the window",))
    assert found.notes[0] == "as seen from the window"
    assert 0 < found.seconds <= time.perf_counter() - started


def test_the_matches_cannot_be_changed(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = answer(graph_of(*full_script), formal_setting())
    with pytest.raises(TypeError):
        found.matches["napkin"] = found.matches["soup_spoon"]  # type: ignore[index]
