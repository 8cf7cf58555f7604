"""What the labels of perceived things allow and weigh."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.labels import Label, label_evidence, named_objects

MakeGraph = Callable[..., RelationGraph]
KINDS: Kinds = default_ontology().kinds


def kinds_of(names: str) -> list[str | None]:
    found = [KINDS.of_word(name.rstrip("_0123456789")) for name in names.split()]
    return [kind.iri if kind else None for kind in found]


@pytest.fixture
def table(graph_of: MakeGraph) -> RelationGraph:
    names = "salad_fork dinner_fork plate wine_glass_1 wine_glass_2 thingamajig"
    return graph_of(nodes=names, kinds=kinds_of(names))


@pytest.mark.parametrize(
    ("label", "named"),
    [
        ("salad_fork", ["salad_fork"]),
        ("Salad  Fork", ["salad_fork"]),
        ("fork", ["salad_fork", "dinner_fork"]),
        ("cutlery", ["salad_fork", "dinner_fork"]),
        ("wine_glass", ["wine_glass_1", "wine_glass_2"]),
        ("wine_glass_2", ["wine_glass_2"]),
        ("glass", ["wine_glass_1", "wine_glass_2"]),
        ("plate", ["plate"]),
        ("dinner plate", []),
        ("thingamajig", ["thingamajig"]),
        ("spoon", []),
        ("gizmo", []),
        ("", []),
    ],
)
def test_what_a_label_names(label: str, named: list[str], table: RelationGraph) -> None:
    found = named_objects(table, label, KINDS)
    assert found.dtype == bool
    assert [table.nodes[i] for i in np.flatnonzero(found)] == named


def test_an_accent_may_be_written_in_two_ways(graph_of: MakeGraph) -> None:
    assert named_objects(graph_of(nodes=["cafe\u0301"]), "CAF\u00c9", KINDS).tolist() == [True]


def test_without_kinds_a_word_for_a_kind_names_nothing(graph_of: MakeGraph) -> None:
    assert not named_objects(graph_of(nodes="salad_fork"), "fork", KINDS).any()


def test_a_certain_label_allows_what_it_names_and_nothing_else(table: RelationGraph) -> None:
    allowed, bonus = label_evidence(table, [Label("fork"), None, Label("gizmo")], KINDS)
    assert allowed[:, 0].tolist() == [True, True, False, False, False, False]
    assert allowed[:, 1].all()
    assert not allowed[:, 2].any()
    assert not bonus.any()


def test_an_uncertain_label_weighs_its_odds_of_being_wrong(table: RelationGraph) -> None:
    allowed, bonus = label_evidence(table, [Label("fork", 0.9), Label("gizmo", 0.9)], KINDS)
    assert allowed.all()
    assert bonus[:2, 0] == pytest.approx([math.log(10), math.log(10)])
    assert not bonus[2:, 0].any()
    assert not bonus[:, 1].any()


def test_the_surer_a_label_the_more_it_weighs_and_no_confidence_weighs_nothing(table: RelationGraph) -> None:
    labels = [Label("plate", confidence) for confidence in (0.0, 0.1, 0.5, 0.99)]
    allowed, bonus = label_evidence(table, labels, KINDS)
    assert allowed.all()
    assert bonus[2, 0] == 0.0
    assert (np.diff(bonus[2]) > 0).all()
    assert np.isfinite(bonus).all()


def test_no_labels_and_no_objects_have_empty_evidence(graph_of: MakeGraph) -> None:
    allowed, bonus = label_evidence(graph_of(), [Label("fork")], KINDS)
    assert allowed.shape == bonus.shape == (0, 1)
    assert label_evidence(graph_of(nodes="a b"), [], KINDS)[0].shape == (2, 0)
