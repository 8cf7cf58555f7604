"""Which objects the labels of perceived things name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.labels import named_objects

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
