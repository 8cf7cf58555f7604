"""Estimates of how literally a description is meant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.grounding.evidence.facts import facts
from deixis.reasoning.grounding.evidence.facts.facts import FactEvidence, fact_tables
from deixis.reasoning.grounding.evidence.facts.literalness import (
    LITERAL,
    LITERAL_PRIOR,
    MAX_JUDGED_OBJECTS,
    literal_share,
)
from deixis.reasoning.grounding.matching.problem import Problem

R = default_ontology().relations


def share_of(table: GeneratedTable) -> float:
    return judged(table.description(), table.boxes)


def judged(description: RelationGraph, boxes: NDArray[np.float64]) -> float:
    graded, literal = (problem(description, boxes, share) for share in (0.0, LITERAL))
    return literal_share((graded, literal), np.arange(len(description.nodes)))


def problem(description: RelationGraph, boxes: NDArray[np.float64], share: float) -> Problem:
    """Return the problem of the facts alone, with every object present."""
    said, n1 = fact_tables(description, boxes, literal=share), len(description.nodes)
    return Problem(said.ends, said.kinds, said.tables, np.zeros((n1, len(boxes))), np.full(n1, -30.0))


@pytest.mark.parametrize("seed", range(5))
def test_exact_names_with_some_errors_are_literal(seed: int) -> None:
    assert share_of(generate(12, 2.5, 0.1, seed=seed)) > 0.85


def test_what_nothing_makes_true_literally_is_not_meant_so() -> None:
    """Everybody is left of the next one, but each stands far more above than left of it."""
    boxes = np.array([[[-3.0 * i, 10.0 * i], [1.0 - 3.0 * i, 8.0 + 10.0 * i]] for i in range(6)])
    names = [f"o{i}" for i in range(6)]
    facts = [Fact(names[i + 1], (R["left"],), names[i]) for i in range(5)]
    assert judged(RelationGraph.from_facts(R, names, facts), boxes) < 0.2


def test_where_nothing_is_said_the_share_is_the_prior() -> None:
    silent = RelationGraph.from_facts(R, ["a", "b"], [])
    assert judged(silent, np.array([[[0.0, 0], [1, 1]]] * 2)) == pytest.approx(LITERAL * LITERAL_PRIOR)


def test_the_order_of_listing_changes_no_table() -> None:
    table = generate(12, 1.5, 0.2, seed=3)
    said, rng = table.description(), np.random.default_rng(1)
    first = fact_tables(said, table.boxes)
    for _ in range(5):
        rows, columns = rng.permutation(12), rng.permutation(12)
        again = fact_tables(said.subgraph([said.nodes[i] for i in rows]), table.boxes[columns])
        for number in range(len(again.kinds)):
            ends = rows[again.ends[number]]
            (same,) = np.flatnonzero((first.ends == ends).all(axis=1))
            before = first.tables[first.kinds[same]][np.ix_(columns, columns)]
            assert again.tables[again.kinds[number]] == pytest.approx(before, abs=1e-5)


def test_what_labels_say_counts_in_the_judgement() -> None:
    """Check that known matches show that a description is not literal."""
    boxes = np.array([[[0.0, 0.0], [1.0, 8.0]], [[3.0, 10.0], [4.0, 18.0]], [[0.5, 20.0], [1.5, 28.0]]])
    said = RelationGraph.from_facts(R, ["a", "b", "c"], [Fact("a", (R["top"],), "b"), Fact("b", (R["top"],), "c")])
    known = np.eye(3)[::-1] > 0
    graded, literal = (problem(said, boxes, share) for share in (0.0, LITERAL))
    order = np.arange(3)
    free = literal_share((graded, literal), order)
    told = literal_share((replace(graded, allowed=known), replace(literal, allowed=known)), order)
    assert told <= free
    mixed = fact_tables(said, boxes, allowed=known, absent=np.full(3, -30.0))
    assert mixed.tables == pytest.approx(fact_tables(said, boxes, literal=told).tables, abs=1e-4)


def test_of_a_large_description_a_connected_part_is_judged() -> None:
    assert share_of(generate(2 * MAX_JUDGED_OBJECTS, 2.5, 0.1, seed=1)) > 0.85


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 1000), st.floats(0.0, LITERAL))
def test_no_evidence_is_above_the_most_at_any_share(seed: int, share: float) -> None:
    table = generate(5, 1.6, 0.2, seed=seed)
    said = FactEvidence.of(table.description(), table.boxes)
    assert (said.most().tables >= said.tables(share).tables - 1e-5).all()
    assert 0 <= said.literal() <= LITERAL


def test_without_time_for_the_tables_the_share_is_the_prior(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = generate(8, 4.0, 0.0, seed=1)
    said = FactEvidence.of(drawn.description(), drawn.boxes, deadline=Deadline.after(60.0))
    assert said.literal() > 0.5
    monkeypatch.setattr(facts, "JUDGEMENT_SECONDS_PER_CELL", 1.0)
    assert said.literal() == LITERAL * LITERAL_PRIOR
