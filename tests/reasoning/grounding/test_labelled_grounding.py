"""Grounding with labels."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from groundings import R, pairs
from numpy.typing import NDArray

from deixis.experiments.place_settings import formal_setting
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import Evidence, evidence_from
from deixis.reasoning.grounding.evidence.properties.labels import Label
from deixis.reasoning.grounding.evidence.properties.unary import LABEL_ERROR, UnaryWeights
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.reasoning.grounding.ground import ground

MakeGraph = Callable[..., RelationGraph]
MakeBoxes = Callable[..., NDArray[np.float64]]
KINDS = default_ontology().kinds
FORK_AND_PLATE = [KINDS.words[word].iri for word in ("fork", "plate")]


def labelled(description: RelationGraph, labels: dict[str, Label], error: float = LABEL_ERROR) -> Grounding:
    scene = formal_setting()
    return labelled_scene(description, scene.relations(R), [labels.get(thing.id) for thing in scene.objects], error)


def labelled_scene(
    description: RelationGraph, scene: SceneRelations, labels: list[Label | None], error: float = LABEL_ERROR
) -> Grounding:
    return ground(labels_alone(description, scene, labels, error), engine_named("exact"))


def labels_alone(
    description: RelationGraph, scene: SceneRelations, labels: list[Label | None], error: float
) -> Evidence:
    meaning = Meaning(weights=UnaryWeights(sizes=0.0))
    return evidence_from(
        description, scene, labels, KINDS, default_ontology().sizes, meaning=meaning, label_error=error
    )


def test_labels_free_of_error_fix_their_things_against_all_facts(graph_of: MakeGraph, full_script: list[str]) -> None:
    wrong = {"dinner_fork": Label("napkin"), "napkin": Label("dinner_fork")}
    found = labelled(graph_of(*full_script), wrong, error=0.0)
    assert (pairs(found)["napkin"], pairs(found)["dinner_fork"]) == ("dinner_fork", "napkin")
    assert found.violated


def test_a_label_settles_what_the_facts_leave_open(graph_of: MakeGraph, figure_7: list[str]) -> None:
    found = labelled(graph_of(*figure_7), {"salad_fork": Label("salad_fork")})
    assert pairs(found)["salad_fork"] == "salad_fork"
    assert found.matches["salad_fork"].decided
    assert "salad_fork" not in {name for group in found.interchangeable for name in group}


def test_errorless_label_without_object_excludes_its_thing(graph_of: MakeGraph, full_script: list[str]) -> None:
    found = labelled(graph_of(*full_script), {"soup_spoon": Label("gizmo")}, error=0.0)
    (thing,) = found.unmatched_perceived
    assert thing.name == "soup_spoon"
    assert thing.reason == "the labels of the scene rule out every object that it could be"
    assert len(found.matches) == 11


def test_object_ruled_out_by_labels_has_that_reason(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(a, b)")
    found = labelled_scene(description, scene, [Label("a"), Label("a")], error=0.0)
    assert pairs(found) == {"a": "p"} or pairs(found) == {"a": "q"}
    assert [(entry.name, entry.reason) for entry in found.unmatched_objects] == [
        ("b", "the labels of the scene rule out every thing that it could be")
    ]
    assert len(found.unmatched_perceived) == 1


def test_uncertain_label_competes_with_facts(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    """Check that a label must be more certain than the fact that supports a on the left."""
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(a, b)")
    answers = {}
    for confidence in (0.2, 0.5, 0.99, 0.999):
        answers[confidence] = pairs(labelled_scene(description, scene, [None, Label("a", confidence)]))["a"]
    assert answers == {0.2: "p", 0.5: "p", 0.99: "q", 0.999: "q"}


def test_a_narrower_label_says_where_the_broader_object_is(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    """Check that two certain labels are stronger than a fact that contradicts them."""
    scene = scene_relations(["p", "q"], boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)]), R)
    description = graph_of("left(fork, plate)", kinds=FORK_AND_PLATE)
    found = labelled_scene(description, scene, [Label("dinner plate"), Label("dinner fork")])
    assert pairs(found) == {"fork": "q", "plate": "p"}
    assert all((match.probability or 0) > 0.95 for match in found.matches.values())


def test_exact_name_precedes_a_narrower_thing(graph_of: MakeGraph, boxes_of: MakeBoxes) -> None:
    boxes = boxes_of([(0, 1), (0, 1)], [(2, 3), (0, 1)], [(4, 5), (0, 1)])
    description = graph_of("left(fork, plate)", kinds=FORK_AND_PLATE)
    scene = scene_relations(["p", "q", "r"], boxes, R)
    found = labelled_scene(description, scene, [Label("dinner fork"), Label("plate"), Label("fork")])
    assert pairs(found) == {"fork": "r", "plate": "q"}
    assert (found.matches["fork"].probability or 0) > 0.95
