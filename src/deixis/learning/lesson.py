"""From a grounding to a lesson: what is kept of a script, a scene and who was who; and what follows from it all."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from deixis.grammar.format import format_script
from deixis.grammar.language import language_of
from deixis.grammar.script import Script
from deixis.ontology.lessons.types import LayoutConcept, Lesson, Role, SeenRelation
from deixis.ontology.relation import Relations
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.answer import Grounding

MAX_PAIRS = 2000
"""Ordered pairs of a scene whose relations are all kept; of a larger scene only those that the script compares."""


@dataclass(frozen=True, slots=True)
class Occasion:
    """When and by what something was learned."""

    started: datetime
    ended: datetime
    version: str


def layout_concept(script: Script, lesson: str, interchangeable: Iterable[tuple[str, ...]] = ()) -> LayoutConcept:
    """The layout that a script describes, as a concept of that lesson."""
    graph = script.graph()
    roles = [
        Role(name, kind, name in script.kinds, script.colours[name].iri if name in script.colours else None)
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
    )


def layout_name(script: Script) -> str:
    """The name in the header, or one made from the file's that a header can bear."""
    if script.name:
        return script.name
    stem = Path(script.file).name.strip("<>.").split(".")[0]
    name = re.sub(r"\W+", "_", stem).strip("_") or "layout"
    return name if language_of(script.ontology).reads_as_name(name) else f"layout_{name}"


def lesson_of(script: Script, scene: Scene, found: Grounding, id: str, occasion: Occasion) -> Lesson:
    """Everything that one grounding teaches."""
    return Lesson(
        layout=layout_concept(script, id, found.interchangeable),
        scene=scene,
        relations=tuple(_seen_relations(scene, script.ontology.relations, found)),
        matches=tuple(found.matches.values()),
        engine=found.engine,
        proved_best=found.proved_best,
        started=occasion.started,
        ended=occasion.ended,
        version=occasion.version,
        script_file=script.file,
        script_text=format_script(script),
        scene_text=json.dumps(scene_to_dict(scene), ensure_ascii=False, sort_keys=True),
    )


def _seen_relations(scene: Scene, relations: Relations, found: Grounding) -> Iterator[SeenRelation]:
    names, ids = scene.relations(relations).names, scene.ids
    compared = {entry.perceived for entry in found.outcomes if entry.perceived is not None}
    few = len(ids) * (len(ids) - 1) <= MAX_PAIRS
    for i, subject in enumerate(ids):
        for j, object in enumerate(ids):
            if i != j and (few or (subject, object) in compared):
                yield subject, relations.members(1 << int(names[i, j]))[0], object
