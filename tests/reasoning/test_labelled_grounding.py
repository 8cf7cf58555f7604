"""What labels do to an answer: the certain ones settle, the others weigh against facts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from groundings import R, pairs
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.perception.settings import formal_setting
from deixis.reasoning.answer import Grounding
from deixis.reasoning.engines import engine_named
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.graded.unary import label_ratios
from deixis.reasoning.grounding import ground
from deixis.reasoning.labels import Label
from deixis.reasoning.rectangle import perceived_graph

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
KINDS = default_ontology().kinds


def labelled(description: RelationGraph, labels: dict[str, Label]) -> Grounding:
    scene = formal_setting()
    return labelled_scene(description, scene.graph(R), [labels.get(thing.id) for thing in scene.objects])


def labelled_scene(description: RelationGraph, scene: RelationGraph, labels: list[Label | None]) -> Grounding:
    said = label_ratios(description, labels, KINDS)
    return ground(Evidence(description, scene, said, np.zeros_like(said)), engine_named("exact"))


def test_a_certain_label_fixes_its_thing_against_all_facts(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = labelled(graph_of(*full_script), {"dinner_fork": Label("napkin"), "napkin": Label("dinner_fork")})
    assert (pairs(found)["napkin"], pairs(found)["dinner_fork"]) == ("dinner_fork", "napkin")
    assert found.violated


def test_a_label_settles_what_the_facts_leave_open(graph_of: MakeGraph, figure_7: list[str]) -> None:
    found = labelled(graph_of(*figure_7), {"salad_fork": Label("salad_fork")})
    assert pairs(found)["salad_fork"] == "salad_fork"
    assert found.matches["salad_fork"].decided
    assert "salad_fork" not in {name for group in found.interchangeable for name in group}


def test_a_certain_label_that_names_nothing_leaves_its_thing_out(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = labelled(graph_of(*full_script), {"soup_spoon": Label("gizmo")})
    (thing,) = found.unmatched_perceived
    assert (thing.name, thing.reason) == ("soup_spoon", "its label names nothing in the description")
    assert len(found.matches) == 11


def test_an_object_that_labels_leave_nothing_is_left_out_with_that_reason(
    graph_of: MakeGraph, boxes_of: MakeBoxes
) -> None:
    scene = perceived_graph(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(a, b)")
    found = labelled_scene(description, scene, [Label("a"), Label("a")])
    assert pairs(found) == {"a": "p"} or pairs(found) == {"a": "q"}
    assert [(entry.name, entry.reason) for entry in found.unmatched_objects] == [
        ("b", "the labels of the scene leave it nothing that it could be")
    ]
    assert len(found.unmatched_perceived) == 1


def test_an_uncertain_label_weighs_against_facts_and_loses_or_wins(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    """One fact speaks for a on the left; a label has to be surer than it is to speak louder."""
    scene = perceived_graph(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(a, b)")
    answers = {}
    for confidence in (0.2, 0.5, 0.99, 0.999):
        answers[confidence] = pairs(labelled_scene(description, scene, [None, Label("a", confidence)]))["a"]
    assert answers == {0.2: "p", 0.5: "p", 0.99: "q", 0.999: "q"}
