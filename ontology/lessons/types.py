"""What is learned: layouts, categories of objects, and the lessons that taught them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Protocol

from deixis.answers import Answer
from deixis.ontology.colours import Rgb
from deixis.ontology.facts import Fact
from deixis.ontology.relation import Relation, Relations

if TYPE_CHECKING:
    from deixis.ontology.graph import RelationGraph


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
        """Return the layout as a relation graph over its roles."""
        names = [role.name for role in self.roles]
        kinds, colours = ([role.kind for role in self.roles], [role.colour for role in self.roles])
        from deixis.ontology.graph import RelationGraph

        return RelationGraph.from_facts(
            vocabulary, names, self.facts, kinds=kinds, colours=colours if any(colours) else ()
        )


@dataclass(frozen=True, slots=True)
class Alternative:
    """Something else that an object could be; ``perceived`` None is that it is not there.

    ``cost`` is what choosing it would lose: log-likelihood, or similarity where the engine gives no ``probability``. A
    lesson does not keep it: NaN.
    """

    perceived: str | None
    cost: float = math.nan
    probability: float | None = None


@dataclass(frozen=True, slots=True, repr=False)
class Match(Answer):
    """An object of the description and the perceived thing that it is.

    ``score`` is the share of what is said of the object and can be compared that holds (by degree and weight; 1 where
    there is nothing), ``similarity`` the paper's (NaN in a lesson, which does not keep it), ``probability`` that of the
    match given all the evidence (None where the engine gives none). ``decided`` says that it is high enough
    (:func:`deixis.reasoning.grounding.options.is_decided`), or that nothing else is as similar.
    """

    object: str
    perceived: str
    score: float
    similarity: float
    decided: bool
    alternatives: tuple[Alternative, ...]
    probability: float | None = None

    def summary(self) -> str:
        """Return the object, its thing, and how probable that is."""
        probability = "" if self.probability is None else f", probability {self.probability:.3g}"
        return f"{self.object} is {self.perceived}{probability}{'' if self.decided else ', undecided'}"

    @property
    def could_be(self) -> tuple[str, ...]:
        """What the object may be, the match first, where that is not decided."""
        others = tuple(other.perceived for other in self.alternatives if other.perceived is not None)
        return () if self.decided else (self.perceived, *others)

    @property
    def sureness(self) -> float:
        """How sure the match is, 0 to 1: its probability; without one 1, or an equal share among what it could be.

        0 where it is not decided, and not known what else it could be.
        """
        if self.probability is not None:
            return self.probability
        if self.decided:
            return 1.0
        return 1.0 / len(self.could_be) if len(self.could_be) > 1 else 0.0


class SeenObject(Protocol):
    """What a lesson keeps of a perceived object: corners of 2 or 3 coordinates, the colour in sRGB."""

    @property
    def id(self) -> str: ...
    @property
    def minimum(self) -> tuple[float, ...]: ...
    @property
    def maximum(self) -> tuple[float, ...]: ...
    @property
    def label(self) -> str | None: ...
    @property
    def confidence(self) -> float: ...
    @property
    def colour(self) -> Rgb | None: ...


class SeenScene(Protocol):
    """What a lesson keeps of a scene; perception's ``Scene`` is one."""

    @property
    def frame(self) -> str: ...
    @property
    def viewpoint(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def objects(self) -> Sequence[SeenObject]: ...


SeenRelation = tuple[str, Relation, str]
"""The exact relation of a pair of perceived objects, by their ids."""


@dataclass(frozen=True)
class Lesson:
    """The learning of one layout, and of what fills its roles, from one script and one scene.

    ``relations`` are those of pairs of the scene's objects.
    """

    layout: LayoutConcept
    scene: SeenScene
    relations: tuple[SeenRelation, ...]
    matches: tuple[Match, ...]
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

    def categories(self) -> tuple[Match, ...]:
        """The matches that teach a category: decided ones; what is doubtful or interchangeable teaches nothing."""
        return tuple(match for match in self.matches if match.decided)


@dataclass(frozen=True)
class WordLesson:
    """What a script and a scene whose labels name its things teach: words and sizes, and no layout."""

    id: str
    scene: SeenScene
    started: datetime
    ended: datetime
    version: str
    script_file: str
    script_text: str
    scene_text: str
    engine: str = "labels"
    proved_best: bool = False


def next_lesson_id(name: str, taken: Callable[[str], bool]) -> str:
    """Return the id of a new lesson about a layout of this name; ``taken`` says which are.

    The number is one that is free behind one that is taken. It is looked for in steps that double, since there may be
    thousands of lessons of one name.

    >>> next_lesson_id("formal_dinner", ["formal_dinner-1", "picnic-7"].__contains__)
    'formal_dinner-2'
    """
    used, free = 0, 1
    while taken(f"{name}-{free}"):
        used, free = free, 2 * free
    while free - used > 1:
        middle = (used + free) // 2
        used, free = (middle, free) if taken(f"{name}-{middle}") else (used, middle)
    return f"{name}-{free}"
