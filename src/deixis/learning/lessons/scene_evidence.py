"""Evidence for matching a description with a scene, given an ontology and what a memory has learned."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from deixis.deadline import Deadline
from deixis.grammar.script import Script
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.rdf.vocabulary import DX
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import Kinds
from deixis.perception.scene import DEFAULT_VIEWPOINT, UNITS_OF_LENGTH, PerceivedObject, Scene
from deixis.reasoning.entailment.conflict import Conflict
from deixis.reasoning.grounding.evidence.claims.places import supporting_box
from deixis.reasoning.grounding.evidence.evidence import Evidence, evidence_from, thing_evidence
from deixis.reasoning.grounding.evidence.properties.labels import Label, naming
from deixis.reasoning.grounding.evidence.properties.unary import LABEL_ERROR
from deixis.reasoning.grounding.evidence.shortlisted import evidence_of_shortlist
from deixis.reasoning.grounding.evidence.words.meaning import SHIPPED, Meaning

ODD_SCALE = 10.0
"""Minimum ratio of seen to usual lengths at which the unit of a scene is doubted; units differ by 10 or more."""

HUGE = 8.0
"""Minimum median length of the things of a scene, in metres, at which its unit is doubted although no kind is known."""

SMALL_THING = 0.2
"""Length in metres that is expected of things of no known kind when a unit is proposed."""

SMALLER_UNITS = ("cm", "mm")
"""Units that a scene may have been written in."""


def evidence_of(script: Script, scene: Scene, meaning: Meaning = SHIPPED) -> Evidence:
    """Return the evidence of a script's facts and claims, and of a scene's labels, sizes and colours.

    Parameters
    ----------
    script
        The script.
    scene
        The scene.
    meaning
        Words and sizes, as shipped or as a memory has learned them.

    Returns
    -------
    Evidence
        Log-likelihood ratios of names and things, and of pairs.
    """
    return graph_evidence(script.graph(), scene, script.ontology, meaning, claims=script.claims)


def graph_evidence(
    description: RelationGraph,
    scene: Scene,
    ontology: Ontology,
    meaning: Meaning,
    label_error: float = LABEL_ERROR,
    deadline: Deadline = Deadline.never(),
    claims: Sequence[Claim] = (),
) -> Evidence:
    """Return the evidence for a description that is a graph already; see :func:`evidence_of`.

    Parameters
    ----------
    description
        The relation graph of the description.
    scene
        The scene.
    ontology
        The known words, kinds, sizes and colours.
    meaning
        Words and sizes, as shipped or as a memory has learned them.
    label_error
        Share of the labels with confidence 1 that are wrong.
    deadline
        Time limit of the computation.
    claims
        Claims of the description beside its facts.

    Returns
    -------
    Evidence
        Log-likelihood ratios of names and things, and of pairs.

    Raises
    ------
    OutOfTimeError
        If the deadline passes.
    """
    return evidence_from(
        description,
        scene.relations(ontology.relations, deadline=deadline),
        kinds=ontology.kinds,
        sizes=ontology.sizes,
        meaning=meaning,
        colours=ontology.colours,
        label_error=label_error,
        deadline=deadline,
        claims=claims,
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
    """Return the evidence for the few things of a large scene that can match the description.

    Neither are all pairs of things compared, nor is memory for them allocated.

    Parameters
    ----------
    description
        The relation graph of the description.
    scene
        The scene.
    ontology
        The known words, kinds, sizes and colours.
    meaning
        Words and sizes, as shipped or as a memory has learned them.
    gigabytes
        Memory limit in gigabytes (10^9 bytes).
    deadline
        Time limit of the computation.

    Returns
    -------
    Evidence
        Log-likelihood ratios of names and things, and of pairs.

    Raises
    ------
    OutOfMemoryError, OutOfTimeError
        If too many things are left after each was judged alone.
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
    """Return what perception reports about the things of a scene, as keyword arguments for the evidence functions."""
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
    """Return the labels of the things of a scene.

    Parameters
    ----------
    scene
        The scene.

    Returns
    -------
    dict
        Label by id, or None for a thing without one.
    """
    return {thing.id: Label(thing.label, thing.confidence) if thing.label else None for thing in scene.objects}


def named_by_candidates(thing: PerceivedObject) -> bool:
    """Return whether the candidates of a thing are used instead of its label.

    Parameters
    ----------
    thing
        The thing.

    Returns
    -------
    bool
        True if it has candidates and no certain label.
    """
    return bool(thing.candidates) and (thing.label is None or thing.confidence < 1)


def surface_thing(surface: str | None, description: RelationGraph, scene: Scene, kinds: Kinds) -> str | None:
    """Find the thing of a scene that is the surface which the objects of a description stand on.

    It is the only thing whose label fits the name of the surface, or else the thing that most others stand on, unless
    its label fits an object of the description.

    Parameters
    ----------
    surface
        Name of the surface; None if the description has none.
    description
        The relation graph of the description.
    scene
        The scene.
    kinds
        The known kinds, which labels are compared by.

    Returns
    -------
    str or None
        Id of the thing; None if the surface has no name, is an object of the description, or is not in the scene.
    """
    if surface is None or surface in description.nodes:
        return None
    labels = list(scene_labels(scene).values())
    named = naming(RelationGraph.from_facts(description.vocabulary, [surface], ()), labels, kinds).fitted[0]
    described = np.asarray(naming(description, labels, kinds).fitted.any(axis=0))
    if named.sum() == 1 and not described[named].any():
        return scene.ids[int(named.argmax())]
    support = None if scene.unit == "px" else supporting_box(scene.boxes)
    return None if support is None or described[support] else scene.ids[support]


def viewpoint_notes(viewpoint: str | None, scene: Scene) -> tuple[str, ...]:
    """Return a note if the viewpoint of a script differs from that of the scene.

    Parameters
    ----------
    viewpoint
        Viewpoint of the script, or None.
    scene
        The scene.

    Returns
    -------
    tuple of str
        At most one note.
    """
    if viewpoint is None or viewpoint == scene.viewpoint:
        return ()
    default = ", the default" if scene.viewpoint == DEFAULT_VIEWPOINT else ""
    return (
        f"the viewpoint of the script is '{viewpoint}' and that of the scene is '{scene.viewpoint}'{default}: "
        "left and right were compared without conversion; if the scene was seen from "
        f"""'{viewpoint}' too, write "viewpoint": "{viewpoint}" in it""",
    )


def unit_notes(scene: Scene, names: Sequence[str], ontology: Ontology) -> tuple[str, ...]:
    """Return a note if the things of a scene in metres are far larger or smaller than usual.

    The usual length is the median over the described names and the labels of the scene whose kinds have sizes; two of
    them are needed. Without them, only things that fit on no table and in no room are noted.

    Parameters
    ----------
    scene
        The scene.
    names
        Names of the described objects, which tell their kinds.
    ontology
        Kinds with their usual sizes.

    Returns
    -------
    tuple of str
        At most one note; it proposes the unit with which the things would have usual lengths.
    """
    if scene.unit != "m" or not scene.objects:
        return ()
    labels = [thing.label for thing in scene.objects if thing.label is not None]
    kinds = [ontology.of_name(name)[0] for name in (*names, *labels)]
    usual = [ontology.sizes.of(kind.iri) for kind in kinds if kind is not None]
    lengths = [size.length.typical for size in usual if size.stated_of != DX.THING]
    seen = float(np.median(np.ptp(scene.boxes[:, :, :2], axis=1).max(axis=1)))
    known = float(np.median(lengths)) if len(lengths) >= 2 else None
    if seen <= 0 or (known is None and seen < HUGE) or (known is not None and 1 / ODD_SCALE < seen / known < ODD_SCALE):
        return ()
    expected = SMALL_THING if known is None else known
    unit = min(SMALLER_UNITS, key=lambda unit: abs(np.log(seen * UNITS_OF_LENGTH[unit] / expected)))
    if seen < expected:
        return (
            f'half of the things are shorter than {1000 * seen:.2g} mm: check the numbers and the "unit" of the scene',
        )
    return (f'half of the things are longer than {seen:.3g} m; if they are not, add "unit": "{unit}" to the scene',)


def conflict_notes(conflict: Conflict | None) -> tuple[str, ...]:
    """Return a note if a script contradicts itself.

    Parameters
    ----------
    conflict
        Contradiction in the script, or None.

    Returns
    -------
    tuple of str
        At most one note.
    """
    if conflict is None:
        return ()
    return (f"the script contradicts itself, so that not all of it can hold: {conflict.reason}",)
