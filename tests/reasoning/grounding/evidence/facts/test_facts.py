"""Evidence of stated facts for pairs of boxes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from graded_words import relation_evidence
from hypothesis import given, settings
from hypothesis import strategies as st
from laid_boxes import tables
from numpy.typing import NDArray

from deixis.experiments.generated_tables import generate
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.rectangle import box_relations, scene_relations
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.evidence.facts.facts import crisp_tables, fact_tables, hedged
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.grounding.matching.problem import Problem

R = default_ontology().relations
BOXES = np.array([[[0, 0], [1, 1]], [[2, 0], [3, 1]], [[0, 3], [1, 4]], [[0.2, 0.2], [0.6, 0.6]]], dtype=float)


def table(*relations: str, saying: bool = False, **qualities: object) -> NDArray[np.float64]:
    fact = Fact("a", tuple(R[name] for name in relations), "b", **qualities)  # type: ignore[arg-type]
    graph = RelationGraph.from_facts(R, ["a", "b"], [fact])
    found: NDArray[np.float64] = fact_tables(graph, BOXES, saying=saying, literal=0.0).tables[0].astype(np.float64)
    return found


def test_a_plain_fact_weighs_what_its_word_does() -> None:
    alone = relation_evidence(pair_geometry(BOXES), R["left"], shipped_models())
    np.fill_diagonal(alone, 0.0)
    assert table("left") == pytest.approx(alone, abs=1e-5)


def test_choice_supports_either_word_less_than_one_alone() -> None:
    either, left, top = table("left", "top"), table("left"), table("top")
    assert either[0, 1] > 0 and either[2, 0] > 0
    assert either[0, 1] < left[0, 1] and either[2, 0] < top[2, 0]


def test_denial_is_evidence_against_the_pair_of_the_word() -> None:
    denied = table("left", positive=False)
    assert denied[0, 1] < -0.5
    assert 0 < denied[1, 0] < 0.4


def test_a_denied_choice_denies_each() -> None:
    denied = table("left", "top", positive=False)
    assert denied[0, 1] < -0.5 and denied[2, 0] < -0.5


def test_a_hedge_weakens_both_ways_and_optional_more() -> None:
    plain, usually, optional = table("left"), table("left", weight=0.8), table("left", optional=True)
    for pair in ((0, 1), (1, 0)):
        assert abs(plain[pair]) > abs(usually[pair]) > abs(optional[pair]) > 0


@given(st.floats(-20, 20), st.floats(0.01, 1))
def test_a_hedged_fact_lies_between_nothing_and_the_plain_one(evidence: float, weight: float) -> None:
    found = float(hedged(np.array([evidence]), weight)[0])
    assert min(0.0, evidence) - 1e-9 <= found <= max(0.0, evidence) + 1e-9
    assert found >= math.log1p(-weight) - 1e-9 if weight < 1 else True


@pytest.mark.parametrize("weight", [0.0, -1.0, 1.5, math.nan])
def test_an_invalid_weight_is_refused(weight: float) -> None:
    with pytest.raises(SettingError, match="at most 1"):
        hedged(np.zeros(1), weight)


@given(tables(axes=3), st.sampled_from(list(R)), st.booleans(), st.booleans(), st.sampled_from([0.2, 1.0]))
@settings(deadline=None)
def test_every_table_is_finite(
    boxes: NDArray[np.float64], name: str, positive: bool, optional: bool, by: float
) -> None:
    fact = Fact("a", (R[name], R["on"]), "b", positive, optional, by)
    found = fact_tables(RelationGraph.from_facts(R, ["a", "b"], [fact]), boxes)
    assert np.isfinite(found.tables).all()


def test_equal_facts_share_a_table_of_the_problem() -> None:
    left, on = (R["left"],), (R["on"],)
    facts = [Fact("a", left, "b"), Fact("b", left, "c"), Fact("c", on, "a"), Fact("a", left, "a")]
    graph = RelationGraph.from_facts(R, ["a", "b", "c"], facts)
    found = fact_tables(graph, BOXES)
    assert found.edges.tolist() == [0, 1, 2]
    assert found.kinds.tolist() == [0, 0, 1]
    problem = Problem(found.ends, found.kinds, found.tables, np.zeros((3, 4)), np.full(3, -5.0))
    value = found.tables[0, 0, 1] + found.tables[0, 1, 2] + found.tables[1, 2, 0]
    assert problem.value(np.array([0, 1, 2])) == pytest.approx(float(value), abs=1e-5)


def test_larger_reference_and_neighbours_are_likelier() -> None:
    boxes = np.array([[[0, 0], [1, 1]], [[1.5, 0], [4.5, 3]], [[9, 0], [10, 1]]], dtype=float)
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
    spoken, alone = (fact_tables(graph, boxes, saying=flag).tables[0] for flag in (True, False))
    assert spoken[0, 1] > alone[0, 1]
    assert spoken[0, 1] - spoken[0, 2] > alone[0, 1] - alone[0, 2]


def test_literal_share_favours_exact_relations() -> None:
    far = np.array([[[0, 0], [1, 1]], [[90, 0], [91, 1]], [[0.8, 0], [1.8, 1]]], dtype=float)
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
    none, some, all_of = (fact_tables(graph, far, literal=share).tables[0] for share in (0.0, 0.3, 1.0))
    assert none[0, 1] < some[0, 1] < all_of[0, 1]
    assert all_of[0, 1] == pytest.approx(np.log(1 / (0.01 + 0.99 * 0.1)), abs=1e-4)
    with pytest.raises(SettingError, match="share of literal facts"):
        fact_tables(graph, far, literal=1.5)


def test_literal_speaker_states_implied_words_rarely() -> None:
    beside, off = [[0, 0], [1, 1]], [[3, 5], [4, 6]]
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b")])
    found = fact_tables(graph, np.array([beside, [[3, 0], [4, 1]], off], dtype=float), literal=1.0).tables[0]
    assert np.exp(found[0, 2] - found[0, 1]) == pytest.approx(0.01 + 0.99 * 0.1, abs=1e-4)
    assert np.exp(found[1, 0] - found[0, 1]) == pytest.approx(0.01, abs=1e-4)


def test_no_facts_make_no_tables() -> None:
    found = fact_tables(RelationGraph.from_facts(R, ["a"], []), BOXES)
    assert found.tables.shape == (0, 4, 4) and found.ends.shape == (0, 2)


def test_the_crisp_reading_is_the_special_case() -> None:
    facts = [
        Fact("a", (R["left"],), "b"),
        Fact("b", (R["top"], R["on"]), "c", weight=0.5),
        Fact("a", (R["on"],), "c", False),
    ]
    graph = RelationGraph.from_facts(R, ["a", "b", "c"], facts)
    evidence = no_unary_evidence(graph, scene_relations([f"o{i}" for i in range(4)], BOXES, R))
    found = crisp_tables(graph, evidence.scene.names)
    problem = Problem(found.ends, found.kinds, found.tables, np.zeros((3, 4)), np.zeros(3))
    for assignment in ([0, 1, 2], [3, 2, 1], [2, 3, 0]):
        chosen = np.array(assignment)
        assert problem.value(chosen) == pytest.approx(evidence.total(chosen))


@given(st.floats(0.15, 50.0))
def test_what_is_farther_left_is_no_less_denied_to_be_left(apart: float) -> None:
    boxes = np.array([[[0.0, 0.0], [0.1, 0.1]], [[apart, 0.0], [apart + 0.1, 0.1]]])
    graph = RelationGraph.from_facts(R, ["a", "b"], [Fact("a", (R["left"],), "b", positive=False)])
    denied = fact_tables(graph, boxes, literal=0.0).tables[0]
    assert denied[0, 1] < -0.5 < 0 < denied[1, 0]


def test_rarely_reverses_the_evidence() -> None:
    rarely, denied = table("left", weight=0.2), table("left", positive=False, weight=0.8)
    assert np.array_equal(rarely, denied)
    assert rarely[0, 1] < 0 < rarely[1, 0]
    assert table("left", positive=False, weight=0.2)[0, 1] > 0


def test_tables_made_block_by_block_are_those_of_the_whole_scene(monkeypatch: pytest.MonkeyPatch) -> None:
    laid = generate(23, seed=3)
    denied = [Fact(f.subject, f.relations, f.object, positive=False) for f in list(laid.description().facts())[:5]]
    said = RelationGraph.from_facts(R, laid.description().nodes, [*laid.description().facts(), *denied])
    whole = fact_tables(said, laid.boxes, literal=0.3).tables
    monkeypatch.setattr("deixis.reasoning.grounding.evidence.facts.facts.SIDE", 7)
    monkeypatch.setattr("deixis.reasoning.geometry.pairs.ROW_CELLS", 50)
    monkeypatch.setattr("deixis.reasoning.geometry.rectangle.ROW_CELLS", 50)
    np.testing.assert_allclose(fact_tables(said, laid.boxes, literal=0.3).tables, whole, atol=1e-5)
    assert laid.scene().names.tolist() == box_relations(laid.boxes, R).names.tolist()
