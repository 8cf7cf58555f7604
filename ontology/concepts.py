"""What is learned: layouts, categories of objects, and the lessons that taught them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations


@dataclass(frozen=True, slots=True)
class Role:
    """A place in a layout: its name, the class IRI of what fills it, and whether the script declared that."""

    name: str
    kind: str | None = None
    declared: bool = False


@dataclass(frozen=True)
class LayoutConcept:
    """A learned layout: the roles in it and the facts that hold between them, as one script states them."""

    lesson: str
    name: str
    title: str | None
    viewpoint: str | None
    roles: tuple[Role, ...]
    facts: tuple[Fact, ...]
    interchangeable: tuple[tuple[str, ...], ...] = ()

    def graph(self, vocabulary: Relations) -> RelationGraph:
        """The layout as a relation graph over its roles."""
        names = [role.name for role in self.roles]
        return RelationGraph.from_facts(vocabulary, names, self.facts, kinds=[role.kind for role in self.roles])


@dataclass(frozen=True, slots=True)
class MatchRecord:
    """What a lesson found to fill a role. ``perceived`` is None where nothing did; ``could_be`` are as good."""

    role: str
    perceived: str | None
    decided: bool
    score: float
    could_be: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class SeenObject:
    """A perceived object as a lesson keeps it; corners of 2 or 3 coordinates."""

    id: str
    minimum: tuple[float, ...]
    maximum: tuple[float, ...]
    label: str | None = None
    confidence: float = 1.0


@dataclass(frozen=True)
class SceneRecord:
    """A scene as a lesson keeps it: its objects, and the exact relation of pairs of them."""

    frame: str
    viewpoint: str
    unit: str
    objects: tuple[SeenObject, ...]
    relations: tuple[tuple[str, Relation, str], ...]


@dataclass(frozen=True)
class Lesson:
    """The learning of one layout, and of what fills its roles, from one script and one scene."""

    layout: LayoutConcept
    scene: SceneRecord
    matches: tuple[MatchRecord, ...]
    engine: str
    proved_best: bool
    started: datetime
    ended: datetime
    version: str
    script_file: str
    script_text: str
    scene_text: str

    @property
    def id(self) -> str:
        return self.layout.lesson

    def categories(self) -> tuple[MatchRecord, ...]:
        """The matches that teach a category: decided ones; what is doubtful or interchangeable teaches nothing."""
        return tuple(match for match in self.matches if match.decided and match.perceived is not None)


def next_lesson_id(name: str, known: Sequence[str]) -> str:
    """The id of a new lesson about a layout of this name.

    >>> next_lesson_id("formal_dinner", ["formal_dinner-1", "picnic-7"])
    'formal_dinner-2'
    """
    number = 1
    while f"{name}-{number}" in known:
        number += 1
    return f"{name}-{number}"
