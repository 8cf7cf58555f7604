"""What is learned: layouts, categories of objects, and the lessons that taught them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from deixis.ontology.colours import Rgb
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Relation, Relations


@dataclass(frozen=True, slots=True)
class Role:
    """A place in a layout: its name, the class IRI of what fills it, whether that was declared, and a colour's IRI."""

    name: str
    kind: str | None = None
    declared: bool = False
    colour: str | None = None


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
        kinds, colours = ([role.kind for role in self.roles], [role.colour for role in self.roles])
        return RelationGraph.from_facts(
            vocabulary, names, self.facts, kinds=kinds, colours=colours if any(colours) else ()
        )


@dataclass(frozen=True, slots=True)
class MatchRecord:
    """What a lesson found to fill a role. ``perceived`` is None where that is not decided.

    ``could_be`` are then what it may be, and ``likeliest`` the one of them that goes best with all other matches.
    ``probability`` is that of ``perceived`` or ``likeliest``; None where the engine gave none.
    """

    role: str
    perceived: str | None
    decided: bool
    score: float
    could_be: tuple[str, ...] = ()
    probability: float | None = None
    likeliest: str | None = None

    @property
    def taken(self) -> str | None:
        """What the role is best taken for; None where nothing is known to fill it."""
        return self.perceived if self.perceived is not None else self.likeliest

    @property
    def sureness(self) -> float:
        """How sure that is, 0 to 1: the probability; without one 1, or an equal share among what it could be.

        0 where it is not decided, and not known what else it could be.
        """
        if self.probability is not None:
            return self.probability
        if self.perceived is not None:
            return 1.0
        return 1.0 / len(self.could_be) if len(self.could_be) > 1 else 0.0


@dataclass(frozen=True, slots=True)
class SeenObject:
    """A perceived object as a lesson keeps it; corners of 2 or 3 coordinates, the colour in sRGB."""

    id: str
    minimum: tuple[float, ...]
    maximum: tuple[float, ...]
    label: str | None = None
    confidence: float = 1.0
    colour: Rgb | None = None


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


@dataclass(frozen=True)
class WordLesson:
    """What a script and a scene whose labels name its things teach: words and sizes, and no layout."""

    id: str
    scene: SceneRecord
    started: datetime
    ended: datetime
    version: str
    script_file: str
    script_text: str
    scene_text: str
    engine: str = "labels"
    proved_best: bool = False


def next_lesson_id(name: str, known: Sequence[str]) -> str:
    """The id of a new lesson about a layout of this name.

    >>> next_lesson_id("formal_dinner", ["formal_dinner-1", "picnic-7"])
    'formal_dinner-2'
    """
    number = 1
    while f"{name}-{number}" in known:
        number += 1
    return f"{name}-{number}"
