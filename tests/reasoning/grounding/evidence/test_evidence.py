"""Degrees of facts, absence, and the matching problem of evidence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.experiments.generated_tables import generate
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.grounding.evidence import evidence as evidence_module
from deixis.reasoning.grounding.evidence.evidence import Evidence, absence, no_unary_evidence
from deixis.reasoning.grounding.evidence.facts.facts import FactEvidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]


@pytest.fixture
def top_left_pair(boxes_of: MakeBoxes, relations: Relations) -> SceneRelations:
    """p lies exactly top left of q."""
    return scene_relations(["p", "q"], boxes_of([(0, 1), (4, 5)], [(2, 3), (0, 1)]), relations)


@pytest.mark.parametrize(
    ("sentence", "degree"),
    [
        ("top_left(a, b)", 1.0),
        ("exactly_top_left(a, b)", 1.0),
        ("left(a, b)", 0.5),
        ("top(a, b)", 0.5),
        ("exactly_left(a, b)", 0.0),
        ("right(a, b)", 0.0),
        ("left or top_left(a, b)", 1.0),
        ("right or top(a, b)", 0.5),
        ("right or bottom(a, b)", 0.0),
        ("not right(a, b)", 1.0),
        ("not left(a, b)", 0.0),
        ("not exactly_left(a, b)", 1.0),
        ("not right or top(a, b)", 0.0),
        ("bottom_right(b, a)", 1.0),
        ("right(b, a)", 0.5),
        ("0.8 left(a, b)", 0.5),
        ("optional left(a, b)", 0.5),
    ],
)
def test_degrees_by_hand(sentence: str, degree: float, top_left_pair: SceneRelations, graph_of: MakeGraph) -> None:
    evidence = no_unary_evidence(graph_of(sentence, nodes="a b"), top_left_pair)
    assert evidence.degrees(np.array([0, 1])).tolist() == [degree]


def test_the_total_weighs_degrees_and_adds_what_labels_say(top_left_pair: SceneRelations, graph_of: MakeGraph) -> None:
    description = graph_of("top_left(a, b)", "0.8 left(a, b)", "0.5 right(a, b)", nodes="a b")
    bonus = np.array([[0.25, 4.0], [8.0, 2.0]])
    evidence = Evidence(description, top_left_pair, bonus, np.zeros((2, 2)))
    assert evidence.total(np.array([0, 1])) == pytest.approx(1.0 + 0.4 + 0.25 + 2.0)
    assert evidence.total(np.array([1, 0])) == pytest.approx(0.5 * 0.5 + 4.0 + 8.0)
    assert evidence.total(np.array([0, UNMATCHED])) == pytest.approx(0.25)
    assert evidence.total(np.array([UNMATCHED, UNMATCHED])) == 0.0


def test_a_fact_about_an_object_and_itself_is_not_compared(top_left_pair: SceneRelations, graph_of: MakeGraph) -> None:
    evidence = no_unary_evidence(graph_of("left(a, a)", "left(a, b)", nodes="a b"), top_left_pair)
    assert evidence.facts.tolist() == [1]
    assert evidence.degrees(np.array([0, 1])).tolist() == [0.5]


def test_reordered_evidence_says_the_same(top_left_pair: SceneRelations, graph_of: MakeGraph) -> None:
    bonus = np.array([[0.25, 4.0], [8.0, 2.0]])
    sizes, allowed = np.array([[0.5, 1.0], [1.5, 2.0]]), np.array([[True, False], [True, True]])
    evidence = Evidence(graph_of("left(a, b)", nodes="a b"), top_left_pair, bonus, sizes, allowed=allowed)
    turned = evidence.reordered(np.array([1, 0]), np.array([1, 0]))
    assert turned.description.nodes == ("b", "a")
    assert turned.scene.nodes == ("q", "p")
    np.testing.assert_array_equal(turned.unary, evidence.unary[::-1, ::-1])
    np.testing.assert_array_equal(turned.allowed, [[True, True], [False, True]])
    assert turned.total(np.array([0, 1])) == evidence.total(np.array([0, 1]))


@given(st.integers(1, 60), st.integers(1, 400))
def test_absence_never_beats_a_match_with_room_for_all(objects: int, things: int) -> None:
    worth = absence(objects, things)
    assert worth < -2.9 if objects <= things else worth > absence(things, things)


def test_places_of_absent_objects_need_no_second_comparison(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(evidence_module, "MAX_KEPT_THINGS", 3)
    built = []
    original = FactEvidence.of

    def of(*arguments: Any, **options: Any) -> FactEvidence:
        built.append(arguments)
        return original(*arguments, **options)

    monkeypatch.setattr(FactEvidence, "of", of)
    table = generate(6, 2.0, seed=1)
    problem = no_unary_evidence(table.description(), table.scene()).problem
    assert problem.places is not None and len(built) == 1
