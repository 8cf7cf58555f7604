"""Make a lesson from a grounding: its script, its scene and its matches."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np

from deixis.grammar.layout.format import format_script
from deixis.grammar.layout.language import language_of
from deixis.grammar.script import Script
from deixis.ontology.lessons.types import ANONYMOUS, LayoutConcept, Lesson, Match, Role, SeenRelation
from deixis.ontology.relations.relation import Relations
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answers.answer import Grounding
from deixis.reasoning.grounding.options import is_decided

MAX_PAIRS = 2000
"""Maximum number of ordered pairs of things for which all relations are kept.

In a larger scene only the pairs that the script compares are kept.
"""


@dataclass(frozen=True, slots=True)
class Occasion:
    """Time span in which something was learned, the version of the program that learned it, and the teacher.

    ``events`` are the ids in the episodes of what the teacher said.
    """

    started: datetime
    ended: datetime
    version: str
    teacher: str = ANONYMOUS
    events: tuple[str, ...] = ()


def layout_concept(script: Script, lesson: str, interchangeable: Iterable[tuple[str, ...]] = ()) -> LayoutConcept:
    """Return the layout that a script describes, as a concept of a lesson.

    Parameters
    ----------
    script
        The script.
    lesson
        Id of the lesson.
    interchangeable
        Groups of names that the description cannot tell apart.

    Returns
    -------
    LayoutConcept
        The layout.
    """
    graph = script.graph()
    roles = [
        Role(
            name,
            kind,
            name in script.kinds,
            script.colours[name].iri if name in script.colours else None,
            name in script.uncounted,
        )
        for name, kind in zip(graph.nodes, graph.kinds or (None,) * len(graph.nodes), strict=True)
    ]
    return LayoutConcept(
        lesson=lesson,
        name=layout_name(script),
        title=script.title,
        viewpoint=script.viewpoint,
        roles=tuple(roles),
        facts=tuple(graph.facts()),
        interchangeable=tuple(interchangeable),
        claims=script.claims,
        surface=script.surface,
    )


def layout_name(script: Script) -> str:
    """Return the layout name in the header of a script, or a valid name made from its file name.

    Parameters
    ----------
    script
        The script.

    Returns
    -------
    str
        The name.
    """
    if script.name:
        return script.name
    stem = Path(script.file).name.strip("<>.").split(".")[0]
    name = re.sub(r"\W+", "_", stem).strip("_") or "layout"
    return name if language_of(script.ontology).reads_as_name(name) else f"layout_{name}"


def lesson_of(script: Script, scene: Scene, found: Grounding, id: str, occasion: Occasion) -> Lesson:
    """Return the lesson that a grounding teaches.

    Parameters
    ----------
    script
        The script.
    scene
        The scene.
    found
        Grounding of the script in the scene.
    id
        Id of the lesson.
    occasion
        Time span and version of the program.

    Returns
    -------
    Lesson
        The lesson.
    """
    return Lesson(
        layout=layout_concept(script, id, found.interchangeable),
        scene=scene,
        relations=tuple(_seen_relations(scene, script.ontology.relations, found)),
        matches=tuple(_each_member(found)),
        engine=found.engine,
        proved_best=found.proved_best,
        started=occasion.started,
        ended=occasion.ended,
        version=occasion.version,
        script_file=script.file,
        script_text=format_script(script),
        scene_text=json.dumps(scene_to_dict(scene), ensure_ascii=False, sort_keys=True),
        teacher=occasion.teacher,
        scene_file=scene.file,
        told_text=None if script.reading is None else script.reading.text,
        events=occasion.events,
    )


def _each_member(found: Grounding) -> Iterator[Match]:
    """Yield the matches of a grounding; of a group of unknown number, one for each member."""
    for name, match in found.object_matches.items():
        if not found.members.get(name):
            yield match
        for member in found.members.get(name, ()):
            sure = is_decided(np.array(member.probability), 0.0)
            yield replace(
                match, perceived=member.perceived, probability=member.probability, decided=bool(sure), alternatives=()
            )


def _seen_relations(scene: Scene, relations: Relations, found: Grounding) -> Iterator[SeenRelation]:
    names, ids = scene.relations(relations).names, scene.ids
    compared = {entry.perceived for entry in found.outcomes if entry.perceived is not None}
    few = len(ids) * (len(ids) - 1) <= MAX_PAIRS
    for i, subject in enumerate(ids):
        for j, object in enumerate(ids):
            if i != j and (few or (subject, object) in compared):
                yield subject, relations.members(1 << int(names[i, j]))[0], object
