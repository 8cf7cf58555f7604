"""Objects that labels name."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.ontology.things.kinds import Kinds
from deixis.reasoning.grounding.evidence.properties.labels import Label, naming

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
        ("dinner plate", ["plate"]),
        ("dinner_plate_3", ["plate"]),
        ("plate_2", ["plate"]),
        ("wine_glass_3", []),
        ("thingamajig_2", ["thingamajig"]),
        ("thingamajig", ["thingamajig"]),
        ("spoon", []),
        ("gizmo", []),
        ("", []),
    ],
)
def test_what_a_label_names(label: str, named: list[str], table: RelationGraph) -> None:
    assert names(table, label) == [named]


@pytest.mark.parametrize(
    ("label", "named"),
    [
        ("rice_bowl", ["bowl", "red_bowl"]),
        ("soup_bowl", ["bowl", "noodle_bowl", "red_bowl"]),
        ("noodle bowl", ["noodle_bowl"]),
        ("couch", ["settee_1"]),
        ("love seat", ["settee_1"]),
        ("seat", ["settee_1"]),
    ],
)
def test_a_label_names_by_its_head_noun(label: str, named: list[str], graph_of: MakeGraph) -> None:
    objects = "bowl noodle_bowl red_bowl settee_1"
    kinds = [default_ontology().of_name(name)[0] for name in objects.split()]
    graph = graph_of(nodes=objects, kinds=[kind.iri if kind else None for kind in kinds])
    assert names(graph, label) == [named]


def test_an_accent_may_be_written_in_two_ways(graph_of: MakeGraph) -> None:
    assert names(graph_of(nodes=["cafe\u0301"]), "CAF\u00c9") == [["cafe\u0301"]]


def test_without_kinds_a_word_for_a_kind_names_nothing(graph_of: MakeGraph) -> None:
    assert names(graph_of(nodes="salad_fork"), "fork") == [[]]


def test_broader_labels_name_objects_that_they_do_not_fit(table: RelationGraph) -> None:
    found = naming(table, [Label("cutlery"), Label("dinner plate"), None], KINDS)
    assert found.named.shape == found.fitted.shape == (6, 3)
    assert [table.nodes[i] for i in np.flatnonzero(found.named[:, 0])] == ["salad_fork", "dinner_fork"]
    assert not found.fitted[:, 0].any()
    assert [table.nodes[i] for i in np.flatnonzero(found.fitted[:, 1])] == ["plate"]
    assert not found.named[:, 2].any()


@pytest.mark.parametrize(
    ("objects", "labels", "named"),
    [
        ("fork dinner_fork", ["dinner fork"], [["dinner_fork"]]),
        ("fork dinner_fork", ["dinner fork", "fork"], [["dinner_fork"], ["fork"]]),
        ("fork dinner_fork", ["dinner fork", "salad fork"], [["dinner_fork"], ["fork"]]),
        ("fork dinner_fork", ["dinner fork", "dinner fork"], [["fork", "dinner_fork"]] * 2),
        ("fork plate", ["dinner fork", "fork"], [[], ["fork"]]),
        ("fork_1 fork_2", ["dinner fork", "fork"], [["fork_1", "fork_2"]] * 2),
        ("fork_1 fork_2", ["dinner fork", "fork_1"], [["fork_2"], ["fork_1"]]),
        ("fork", ["dinner fork", "salad fork"], [["fork"], ["fork"]]),
        ("fork", ["dinner fork", "cutlery"], [["fork"], ["fork"]]),
        ("serviette", ["napkin", "napkin"], [["serviette"], ["serviette"]]),
    ],
)
def test_exact_names_precede_narrower_labels(
    objects: str, labels: list[str], named: list[list[str]], graph_of: MakeGraph
) -> None:
    assert names(graph_of(nodes=objects, kinds=kinds_of(objects)), *labels) == named


def test_a_narrower_label_gives_way_to_names_that_are_as_sure(graph_of: MakeGraph) -> None:
    graph = graph_of(nodes="fork", kinds=kinds_of("fork"))
    for sureness, named in ((0.5, [[], ["fork"]]), (0.7, [["fork"], ["fork"]])):
        labels = [Label("dinner fork", sureness), Label("fork", 0.6)]
        assert naming(graph, labels, KINDS).named.T.tolist() == [[bool(column)] for column in named]


def names(graph: RelationGraph, *labels: str) -> list[list[str]]:
    found = naming(graph, [Label(label) for label in labels], KINDS).named
    assert found.dtype == bool
    return [[graph.nodes[i] for i in np.flatnonzero(column)] for column in found.T]
