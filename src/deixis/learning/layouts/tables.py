"""Tables on which layouts were taught, as the memory keeps them, and which thing each role is.

A lesson keeps what its grounding decided. What was settled later, by an answer, a pointing gesture or another table, is
kept with the view that was taught then. So a lesson or a teaching that is taken back takes its counts with it.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from deixis.answers import count
from deixis.errors import DeixisError
from deixis.learning.layouts.experience import Experience
from deixis.learning.views.teachings import boxes_key
from deixis.memory.semantic.rdf.graphs import GraphName, graph_iri
from deixis.ontology.lessons.read import layouts, lesson_records
from deixis.ontology.lessons.types import LayoutConcept
from deixis.ontology.lessons.write import layout_iri
from deixis.ontology.rdf.triples import iri, text
from deixis.ontology.rdf.vocabulary import W3C
from deixis.ontology.relations.relation import Relations
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import Scene

if TYPE_CHECKING:
    from deixis.memory.semantic.store import SemanticMemory

SettledRoles = Mapping[tuple[str, str], Mapping[str, str]]
"""Thing of each role that was settled after its lesson, by role, by the id of the lesson and the key of its boxes."""


@dataclass(frozen=True, eq=False, repr=False)
class TaughtTable:
    """A table of a layout.

    Attributes
    ----------
    lesson
        Id of the lesson.
    layout
        The layout, as this lesson described it.
    script_text
        The description in the layout language.
    scene
        The table, without clouds.
    things
        Id of the thing of each role whose thing is known.
    present
        Roles whose thing is on the table, whichever it is.
    """

    lesson: str
    layout: LayoutConcept
    script_text: str
    scene: Scene
    things: Mapping[str, str]
    present: frozenset[str]

    def __repr__(self) -> str:
        return f"<TaughtTable {self.lesson}: {count(len(self.things), 'known thing')}>"

    @property
    def is_measured(self) -> bool:
        """True if the boxes are in metres and have heights."""
        return self.scene.unit == "m" and bool(self.scene.objects) and len(self.scene.objects[0].minimum) == 3

    def experience(self, relations: Relations) -> Experience:
        """Return what the table adds to the counts of its layout.

        Parameters
        ----------
        relations
            Relations of the ontology.

        Returns
        -------
        Experience
            Sums over this table; nothing for a scene in pixels or without heights.
        """
        if not self.is_measured:
            return Experience()
        things = {role: self.scene[thing] for role, thing in self.things.items()}
        return Experience.of_table([role.name for role in self.layout.roles], things, relations, self.present)


def taught_tables(
    memory: SemanticMemory, ontology: Ontology, settled: SettledRoles, name: str | None = None
) -> Iterator[TaughtTable]:
    """Yield the tables of the lessons about layouts, in the order learned.

    Parameters
    ----------
    memory
        The open memory.
    ontology
        Words of the language.
    settled
        Roles that were settled after their lesson.
    name
        Name of the layout, or id of the lesson; None for all layouts.

    Yields
    ------
    TaughtTable
        A table; lessons whose scene cannot be read are left out.
    """
    learned = graph_iri(GraphName.LEARNED)
    for lesson in memory.lessons():
        labels = memory.store.quads_for_pattern(iri(layout_iri(lesson)), iri(W3C.RDFS_LABEL), None, learned)
        if any(name in (None, lesson) or quad.object == text(name or "") for quad in labels):
            table = _table(memory, lesson, ontology, settled)
            if table is not None:
                yield table


def _table(memory: SemanticMemory, lesson: str, ontology: Ontology, settled: SettledRoles) -> TaughtTable | None:
    from deixis.perception.formats.scene_json import read_scene

    contributions = memory.contributions(lesson)
    records = lesson_records(contributions.get(GraphName.LEARNED, ()), contributions.get(GraphName.EPISODES, ()))
    found = layouts(contributions.get(GraphName.LEARNED, ()), ontology.relations)
    if len(records) != 1 or len(found) != 1:
        return None
    try:
        scene = read_scene(json.loads(records[0].scene_text))
    except (DeixisError, ValueError):
        return None
    things = {match.object: match.perceived for match in records[0].matches if match.decided}
    # A lesson that was taken back leaves its id to a later one, which has other boxes.
    things.update(settled.get((lesson, boxes_key(scene)), {}))
    roles = {role.name for role in found[0].roles}
    known = {role: thing for role, thing in things.items() if role in roles and thing in scene.ids}
    present = frozenset(match.object for match in records[0].matches) | known.keys()
    return TaughtTable(lesson, found[0], records[0].script_text, scene, known, present)
