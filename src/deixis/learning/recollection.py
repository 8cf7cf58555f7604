"""What a memory remembers of its lessons, ready to be learned from again: what was said, what was seen, who was who."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass

import pyoxigraph as ox

from deixis.errors import DeixisError
from deixis.grammar.parser import parse_script
from deixis.learning.scene_evidence import scene_labels
from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.ontology.lessons.read import LessonRecord, layouts, lesson_records
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.tbox import Ontology
from deixis.perception.formats.scene_json import read_scene
from deixis.perception.scene import Scene
from deixis.reasoning.grounding.evidence.labels import naming


@dataclass(frozen=True)
class Who:
    """What each object of a description was taken for: a place in the scene's list, or None; and how sure that is."""

    things: tuple[int | None, ...]
    sureness: tuple[float, ...]  # 0 to 1
    decided: tuple[bool, ...]


@dataclass(frozen=True)
class Remembered:
    """One lesson. ``texts`` are its script and its scene as they were kept: equal ones say the same thing again."""

    lesson: str
    description: RelationGraph
    scene: Scene
    who: Who
    texts: tuple[str, str]


@dataclass(frozen=True)
class Recollection:
    """All lessons that can be read, by id; and of the others, a line each, why not."""

    lessons: tuple[Remembered, ...]
    unreadable: tuple[str, ...] = ()

    def of(self, ids: Iterable[str]) -> Recollection:
        """Those lessons alone."""
        wanted = set(ids)
        return Recollection(tuple(one for one in self.lessons if one.lesson in wanted))


def recollect(learned: Iterable[ox.Triple], episodes: Iterable[ox.Triple], ontology: Ontology) -> Recollection:
    """Reads the lessons in the triples of the learned graph and of the episodes."""
    learned = list(learned)
    by_lesson = {layout.lesson: layout for layout in layouts(learned, ontology.relations)}
    found: list[Remembered] = []
    unreadable: list[str] = []
    for record in lesson_records(learned, episodes):
        try:
            found.append(_remembered(record, by_lesson.get(record.id), ontology))
        except (DeixisError, ValueError) as error:
            unreadable.append(f"{record.id}: {str(error).splitlines()[0]}")
    return Recollection(tuple(found), tuple(unreadable))


def _remembered(record: LessonRecord, layout: LayoutConcept | None, ontology: Ontology) -> Remembered:
    scene = read_scene(json.loads(record.scene_text))
    if layout is not None:
        description = layout.graph(ontology.relations)
    else:
        description = parse_script(record.script_text, record.script_file, ontology).graph()
    who = labelled(description, scene, ontology.kinds) if record.words_only else _matched(record, description, scene)
    return Remembered(record.id, description, scene, who, (record.script_text, record.scene_text))


def _matched(record: LessonRecord, description: RelationGraph, scene: Scene) -> Who:
    places = {id: place for place, id in enumerate(scene.ids)}
    matches = {match.object: match for match in record.matches}
    found = [matches.get(name) for name in description.nodes]
    return Who(
        tuple(places.get(match.perceived) if match else None for match in found),
        tuple(match.sureness if match else 0.0 for match in found),
        tuple(match is not None and match.decided for match in found),
    )


def labelled(description: RelationGraph, scene: Scene, kinds: Kinds) -> Who:
    """What labels say: an object is the one thing whose label fits it, as surely as the label is."""
    fitted = naming(description, list(scene_labels(scene).values()), kinds).fitted
    alone = fitted & (fitted.sum(axis=1) == 1)[:, None] & (fitted.sum(axis=0) == 1)[None, :]
    things = tuple(int(row.argmax()) if row.any() else None for row in alone)
    sure = tuple(0.0 if thing is None else scene.objects[thing].confidence for thing in things)
    return Who(things, sure, tuple(thing is not None for thing in things))
