"""Lessons of a memory, ready to be learned from again: descriptions, scenes and matches."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pyoxigraph as ox

from deixis.answers import count
from deixis.errors import DeixisError
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.memory.semantic.rdf.ledger import place
from deixis.ontology.lessons.read import LessonRecord, layouts, lesson_records, unknown_layout
from deixis.ontology.lessons.types import LayoutConcept, Lesson, WordLesson
from deixis.ontology.lessons.write import layout_iri
from deixis.ontology.rdf.triples import iri, last_part, text
from deixis.ontology.rdf.vocabulary import DX, W3C
from deixis.ontology.relations.relation import Relations
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import Kinds

if TYPE_CHECKING:
    from deixis.memory.semantic.store import SemanticMemory
    from deixis.ontology.graph.graph import RelationGraph
    from deixis.perception.scene import Scene


@dataclass(frozen=True)
class MatchedThings:
    """The thing that each object of a description was matched with: its place in the scene's list, or None."""

    things: tuple[int | None, ...]
    sureness: tuple[float, ...]  # 0 to 1
    decided: tuple[bool, ...]


@dataclass(frozen=True)
class Remembered:
    """One lesson. ``texts`` are its script and its scene as they were stored; lessons with equal texts count once."""

    lesson: str
    description: RelationGraph
    scene: Scene
    matched: MatchedThings
    texts: tuple[str, str]


@dataclass(frozen=True, repr=False)
class Recollection:
    """All lessons that can be read, and a line for each other lesson with the reason."""

    lessons: tuple[Remembered, ...]
    unreadable: tuple[str, ...] = ()

    def __repr__(self) -> str:
        left = f", {len(self.unreadable)} unreadable" if self.unreadable else ""
        return f"<Recollection {count(len(self.lessons), 'lesson')}{left}>"

    def of(self, ids: Iterable[str]) -> Recollection:
        """Return some of the lessons.

        Parameters
        ----------
        ids
            Ids of the lessons to keep.

        Returns
        -------
        Recollection
            The lessons with these ids.
        """
        wanted = set(ids)
        return Recollection(tuple(one for one in self.lessons if one.lesson in wanted))


def find_layout(memory: SemanticMemory, name: str, relations: Relations) -> LayoutConcept:
    """Return one layout of a memory, without reading the others.

    Parameters
    ----------
    memory
        The open memory.
    name
        Name of the layout, or id of its lesson.
    relations
        Relations of the ontology.

    Returns
    -------
    LayoutConcept
        The layout that was learned last with this name, or that of the lesson.

    Raises
    ------
    UnknownTermError
        If there is neither; the message suggests the nearest name.
    """
    store, graph = memory.store, graph_iri(GraphName.LEARNED)
    is_layout = (iri(W3C.RDFS_SUB_CLASS_OF), iri(DX.LAYOUT), graph)
    node = iri(layout_iri(name))
    if not any(store.quads_for_pattern(node, *is_layout)):
        named = lessons_named(memory, name)
        if not named:
            every = [quad.subject for quad in store.quads_for_pattern(None, *is_layout)]
            labels = (store.quads_for_pattern(one, iri(W3C.RDFS_LABEL), None, graph) for one in every)
            raise unknown_layout(name, (str(getattr(q.object, "value", "")) for found in labels for q in found))
        node = max(named, key=lambda one: place(store, last_part(one.value)))
    parts = [quad.subject for quad in store.quads_for_pattern(None, iri(DX.IN_LAYOUT), node, graph)]
    triples = (quad.triple for part in (node, *parts) for quad in store.quads_for_pattern(part, None, None, graph))
    (layout,) = layouts(triples, relations)
    return layout


def lessons_named(memory: SemanticMemory, name: str) -> list[ox.NamedNode]:
    """Return the layouts of one name, one for each lesson.

    Parameters
    ----------
    memory
        The open memory.
    name
        Name of the layout.

    Returns
    -------
    list of NamedNode
        IRIs of the layouts, in no stated order.
    """
    try:
        label = text(name)
    except ValueError:  # a lone surrogate, which no literal has
        return []
    store, graph = memory.store, graph_iri(GraphName.LEARNED)
    is_layout = (iri(W3C.RDFS_SUB_CLASS_OF), iri(DX.LAYOUT), graph)
    labelled = store.quads_for_pattern(None, iri(W3C.RDFS_LABEL), label, graph)
    nodes = (quad.subject for quad in labelled if isinstance(quad.subject, ox.NamedNode))
    return [one for one in nodes if any(store.quads_for_pattern(one, *is_layout))]


def recollect(learned: Iterable[ox.Triple], episodes: Iterable[ox.Triple], ontology: Ontology) -> Recollection:
    """Read the lessons from the triples of the learned graph and of the episodes graph.

    Parameters
    ----------
    learned
        Triples of the learned graph.
    episodes
        Triples of the graph of episodes.
    ontology
        Words of the language.

    Returns
    -------
    Recollection
        The lessons; unreadable ones are listed apart.
    """
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


def remembered_lesson(lesson: Lesson | WordLesson, ontology: Ontology) -> Remembered:
    """Return a lesson that was just learned as it will be read from the memory.

    Parameters
    ----------
    lesson
        The lesson.
    ontology
        Words of the language.

    Returns
    -------
    Remembered
        The lesson as it will be read.
    """
    layout, matches = (lesson.layout, lesson.matches) if isinstance(lesson, Lesson) else (None, ())
    texts = (lesson.script_file, lesson.script_text, lesson.scene_text)
    return _remembered(LessonRecord(lesson.id, *texts, matches, layout is None), layout, ontology)


def _remembered(record: LessonRecord, layout: LayoutConcept | None, ontology: Ontology) -> Remembered:
    from deixis.grammar.layout.parser import parse_script
    from deixis.perception.formats.scene_json import read_scene

    scene = read_scene(json.loads(record.scene_text))
    if layout is not None:
        description = layout.graph(ontology.relations)
    else:
        description = parse_script(record.script_text, record.script_file, ontology).graph()
    matched = (
        labelled(description, scene, ontology.kinds) if record.words_only else _matched(record, description, scene)
    )
    return Remembered(record.id, description, scene, matched, (record.script_text, record.scene_text))


def _matched(record: LessonRecord, description: RelationGraph, scene: Scene) -> MatchedThings:
    places = {id: place for place, id in enumerate(scene.ids)}
    matches = {match.object: match for match in record.matches}
    found = [matches.get(name) for name in description.nodes]
    return MatchedThings(
        tuple(places.get(match.perceived) if match else None for match in found),
        tuple(match.sureness if match else 0.0 for match in found),
        tuple(match is not None and match.decided for match in found),
    )


def labelled(description: RelationGraph, scene: Scene, kinds: Kinds) -> MatchedThings:
    """Match each object with the only thing whose label fits it, with the confidence of that label.

    Parameters
    ----------
    description
        Relation graph of a script.
    scene
        A scene with labels.
    kinds
        The known kinds, which labels are compared by.

    Returns
    -------
    Who
        Thing and confidence by object.
    """
    from deixis.learning.lessons.scene_evidence import scene_labels
    from deixis.reasoning.grounding.evidence.properties.labels import naming

    fitted = naming(description, list(scene_labels(scene).values()), kinds).fitted
    alone = fitted & (fitted.sum(axis=1) == 1)[:, None] & (fitted.sum(axis=0) == 1)[None, :]
    things = tuple(int(row.argmax()) if row.any() else None for row in alone)
    sure = tuple(0.0 if thing is None else scene.objects[thing].confidence for thing in things)
    return MatchedThings(things, sure, tuple(thing is not None for thing in things))
