"""The engines beside each other, and the paper's: its sub-graphs, its limits, and what it says about them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from groundings import R, answer, evidence
from numpy.typing import NDArray

import deixis.reasoning.grounding.engines.similarity_engine as similarity_engine
from deixis.deadline import Deadline
from deixis.errors import UnknownTermError
from deixis.experiments.place_settings import formal_setting
from deixis.ontology.graph.graph import RelationGraph
from deixis.reasoning.geometry.rectangle import scene_relations
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.engines.similarity_engine import CUT_SHORT
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.options import Select

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
ENGINES = ["exact", "similarity"]


@pytest.mark.parametrize("engine", ENGINES)
def test_no_relation_in_common_is_noted_and_gives_no_nan(engine: str, graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    found = ground(no_unary_evidence(graph_of("on(a, b)"), scene), engine_named(engine))
    assert any("similarity is zero" in note for note in found.notes)
    assert found.graph_similarity == 0.0
    assert all(not math.isnan(match.similarity) for match in found.matches.values())
    assert [str(entry.fact) for entry in found.violated] == ["on(a, b)"]


def test_facts_that_the_similarity_cannot_see_are_listed(graph_of: MakeGraph, full_script: list[str]) -> None:
    description = graph_of(*full_script, "not on(napkin, bread_plate)", "left or top_left(salad_fork, dinner_plate)")
    found = answer(description, formal_setting())
    (note,) = [note for note in found.notes if "the similarity ignores" in note]
    assert "not on(napkin, bread_plate)" in note
    assert "left or top_left(salad_fork, dinner_plate)" in note
    assert len(found.satisfied) == 13


def test_what_is_rarely_so_is_not_what_the_similarity_looks_for(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    found = ground(no_unary_evidence(graph_of("0.2 left(a, b)"), scene), engine_named("similarity"))
    assert found.graph_similarity == 0.0
    assert "the similarity ignores facts that are not one affirmed relation: rarely left(a, b)" in found.notes


def test_exact_engine_skips_an_expensive_similarity(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph, full_script: list[str]
) -> None:
    monkeypatch.setattr(similarity_engine, "_MAX_MULTIPLICATIONS", 1.0)
    found = answer(graph_of(*full_script), formal_setting())
    assert found.proved_best
    assert not found.converged
    assert {name: match.perceived for name, match in found.matches.items()} == {name: name for name in found.matches}


def test_an_unknown_engine_is_an_error_that_names_the_known_ones() -> None:
    with pytest.raises(UnknownTermError, match="no engine 'magic'; the engines are: exact, scalable, similarity"):
        engine_named("magic")


def test_more_subgraphs_than_are_tried_is_noted(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph, full_script: list[str], absent_glasses: list[str]
) -> None:
    monkeypatch.setattr(similarity_engine, "MAX_SUBGRAPHS", 100)
    found = answer(graph_of(*full_script, *absent_glasses), formal_setting(), "similarity")
    assert any("455 sub-graphs are too many" in note and "heuristic" in note for note in found.notes)
    assert len(found.matches) == 12


def test_too_many_subgraphs_use_the_heuristic(
    monkeypatch: pytest.MonkeyPatch, graph_of: MakeGraph, full_script: list[str]
) -> None:
    monkeypatch.setattr(similarity_engine, "MAX_SUBGRAPHS", 1)
    found = answer(graph_of(*full_script[:6]), formal_setting(), "similarity")
    assert any("sub-graphs are too many" in note for note in found.notes)
    assert len(found.matches) == len(graph_of(*full_script[:6]).nodes)


def test_select_decides_the_criterion_for_subgraphs(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    """Leave out one of four objects: what satisfies most facts is not what is most similar."""
    description = graph_of("top(c, d)", "right(a, b)", "left(a, d)", "right(c, b)", nodes="a b c d")
    boxes = boxes_of([(4, 6), (4, 5)], [(0, 2), (4, 5)], [(2, 3), (3, 4)])
    question = no_unary_evidence(description, scene_relations(["p", "q", "r"], boxes, R))
    by_facts, by_similarity = (
        ground(question, engine_named("similarity", select)) for select in (Select.FACTS, Select.SIMILARITY)
    )
    assert by_similarity.graph_similarity > by_facts.graph_similarity + 0.1
    assert sum(e.degree for e in by_facts.outcomes) > sum(e.degree for e in by_similarity.outcomes) + 0.4
    assert not by_similarity.proved_best


def test_the_exact_value_is_never_below_that_of_the_similarity(graph_of: MakeGraph, full_script: list[str]) -> None:
    for seed in range(3):
        question = evidence(graph_of(*full_script), formal_setting(seed, displacement=0.05))
        exact, similar = (engine_named(engine).align(question, Deadline.after(10.0)) for engine in ENGINES)
        assert question.problem.value(exact.assignment) >= question.problem.value(similar.assignment) - 1e-6


@pytest.mark.parametrize("most", [similarity_engine.MAX_SUBGRAPHS, 100])
@pytest.mark.parametrize("absent", [True, False])
def test_similarity_at_its_deadline_is_cut_short(
    most: int,
    absent: bool,
    monkeypatch: pytest.MonkeyPatch,
    graph_of: MakeGraph,
    full_script: list[str],
    absent_glasses: list[str],
) -> None:
    monkeypatch.setattr(similarity_engine, "MAX_SUBGRAPHS", most)
    monkeypatch.setattr(similarity_engine, "_SUBGRAPHS_PER_BLOCK", 10)
    question = evidence(graph_of(*full_script, *(absent_glasses if absent else [])), formal_setting())
    found = engine_named("similarity").align(question, Deadline.after(0.0))
    assert np.count_nonzero(found.assignment >= 0) == 12
    assert not found.finished
    assert found.notes[-1] == CUT_SHORT
    assert engine_named("similarity").align(question, Deadline.never()).finished
