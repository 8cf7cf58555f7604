"""What speaks for who is who: a description and a scene, with what an ontology and a memory know, as evidence."""

from __future__ import annotations

from typing import Any

from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.ontology.graph import RelationGraph
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.entailment.conflict import Conflict
from deixis.reasoning.grounding.evidence.evidence import Evidence, evidence_from, thing_evidence
from deixis.reasoning.grounding.evidence.labels import Label
from deixis.reasoning.grounding.evidence.meaning import SHIPPED, Meaning
from deixis.reasoning.grounding.evidence.unary import LABEL_ERROR
from deixis.reasoning.grounding.shortlisted import evidence_of_shortlist


def evidence_of(script: Script, scene: Scene, meaning: Meaning = SHIPPED) -> Evidence:
    """All that speaks for who is who: the script's facts, and the scene's relations, labels, sizes and colours."""
    return graph_evidence(script.graph(), scene, script.ontology, meaning)


def graph_evidence(
    description: RelationGraph,
    scene: Scene,
    ontology: Ontology,
    meaning: Meaning,
    label_error: float = LABEL_ERROR,
    deadline: Deadline = Deadline.never(),
) -> Evidence:
    """The same of a description that is a graph already, to be worked out until the deadline; of labels said to be
    certain a share ``label_error`` is wrong."""
    return evidence_from(
        description,
        scene.relations(ontology.relations, deadline=deadline),
        kinds=ontology.kinds,
        sizes=ontology.sizes,
        meaning=meaning,
        colours=ontology.colours,
        label_error=label_error,
        deadline=deadline,
        **_perceived(scene),
    )


def shortlisted_evidence(
    description: RelationGraph,
    scene: Scene,
    ontology: Ontology,
    meaning: Meaning,
    gigabytes: float,
    deadline: Deadline,
) -> Evidence:
    """Return the same for the few things of a large scene that the objects may be.

    Neither all pairs of things are compared, nor is memory for them taken: the whole takes ``gigabytes`` at the most.
    Raises OutOfMemoryError or OutOfTimeError where what is known of the things by themselves leaves too many.
    """
    known = thing_evidence(
        description,
        scene.boxes,
        kinds=ontology.kinds,
        sizes=ontology.sizes,
        meaning=meaning,
        colours=ontology.colours,
        **_perceived(scene),
    )
    return evidence_of_shortlist(
        description, scene.ids, scene.boxes, ontology.relations, known, meaning, gigabytes, deadline
    )


def _perceived(scene: Scene) -> dict[str, Any]:
    """Return what perception says of the things of a scene, as the evidence of things takes it."""
    labels = scene_labels(scene)
    ranked = [named_by_candidates(thing) for thing in scene.objects]
    return {
        "labels": [None if each else labels[thing.id] for thing, each in zip(scene.objects, ranked, strict=True)],
        "metric": scene.unit == "m",
        "seen": scene.colours,
        "candidates": [
            dict(thing.candidates) if each else None for thing, each in zip(scene.objects, ranked, strict=True)
        ],
    }


def scene_labels(scene: Scene) -> dict[str, Label | None]:
    """What perception calls each thing of a scene."""
    return {thing.id: Label(thing.label, thing.confidence) if thing.label else None for thing in scene.objects}


def named_by_candidates(thing: PerceivedObject) -> bool:
    """Return whether the candidates of a thing weigh in a grounding, and not its label: where that is not certain."""
    return bool(thing.candidates) and (thing.label is None or thing.confidence < 1)


def viewpoint_notes(viewpoint: str | None, scene: Scene) -> tuple[str, ...]:
    """Return what is to be said where a script speaks from another viewpoint than that of the scene."""
    if viewpoint is None or viewpoint == scene.viewpoint:
        return ()
    return (
        f"the script speaks as seen from '{viewpoint}' and the scene is seen from '{scene.viewpoint}': "
        "left and right were compared as they stand",
    )


def conflict_notes(conflict: Conflict | None) -> tuple[str, ...]:
    """Return what is to be said with an answer where a script contradicts itself."""
    if conflict is None:
        return ()
    return (f"the script contradicts itself, so that not all of it can hold: {conflict.reason}",)
