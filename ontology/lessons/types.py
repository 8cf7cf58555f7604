"""Results of learning: layouts, categories of objects, and the lessons that taught them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Protocol

from deixis.answers import Answer, count, rounded
from deixis.arguments import checks_arguments
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.facts import Fact
from deixis.ontology.inflection import singular
from deixis.ontology.relations.relation import Relation, Relations
from deixis.ontology.things.colours import Rgb

if TYPE_CHECKING:
    from deixis.ontology.graph.graph import RelationGraph


ANONYMOUS = "user"
"""Name that is stored for a teacher whose name is not given."""


@dataclass(frozen=True, slots=True)
class Role:
    """A place in a layout: its name, the class IRI of its kind, whether that was declared, and the IRI of a colour.

    ``is_group`` is True for a group of unknown number (*the glasses*), which all things that fit it fill.
    """

    name: str
    kind: str | None = None
    declared: bool = False
    colour: str | None = None
    is_group: bool = False


@dataclass(frozen=True, repr=False)
class LayoutConcept(Answer):
    """A learned layout: its roles, the facts between them and the claims about them, as stated in one script.

    Examples
    --------
    >>> import deixis
    >>> from deixis.learning.lessons.lesson import layout_concept
    >>> layout = layout_concept(deixis.read_script(text="layout tea; cup on saucer; spoon right of cup"), "tea-1")
    >>> layout, layout.summary()
    (<LayoutConcept 'tea' of lesson tea-1: 3 roles, 2 facts>, "'tea' of lesson tea-1: 3 roles, 2 facts")
    >>> [role.name for role in layout.roles], layout.to_dict()["lesson"]
    (['cup', 'saucer', 'spoon'], 'tea-1')
    >>> print(layout.to_text())
    layout tea
    <BLANKLINE>
    cup on saucer
    spoon right of cup
    >>> relations = layout.graph(deixis.read_script(text="cup on saucer").ontology.relations)
    >>> relations.nodes
    ('cup', 'saucer', 'spoon')
    """

    lesson: str
    name: str
    title: str | None
    viewpoint: str | None
    roles: tuple[Role, ...]
    facts: tuple[Fact, ...]
    interchangeable: tuple[tuple[str, ...], ...] = ()
    claims: tuple[Claim, ...] = ()
    surface: str | None = None  # what everything stands on, which is not a role

    def summary(self) -> str:
        """Return the name of the layout, its lesson, and the numbers of its roles and statements."""
        parts = [count(len(self.roles), "role"), count(len(self.facts), "fact")]
        parts += [count(len(self.claims), "claim")] if self.claims else []
        return f"'{self.name}' of lesson {self.lesson}: {', '.join(parts)}"

    @checks_arguments
    def graph(self, vocabulary: Relations) -> RelationGraph:
        """Return the layout as a relation graph over its roles.

        Parameters
        ----------
        vocabulary
            Relations of the ontology.

        Returns
        -------
        RelationGraph
            A graph with a node for each role and an edge for each fact.
        """
        names = [role.name for role in self.roles]
        kinds, colours = ([role.kind for role in self.roles], [role.colour for role in self.roles])
        from deixis.ontology.graph.graph import RelationGraph

        return RelationGraph.from_facts(
            vocabulary, names, self.facts, kinds=kinds, colours=colours if any(colours) else ()
        )


@dataclass(frozen=True, slots=True)
class Alternative:
    """Another scene object that an object could be; ``perceived`` is None for being absent from the scene.

    ``cost`` is the loss of choosing it: log-likelihood, or similarity if the engine gives no ``probability``. It is NaN
    in a stored lesson, which does not keep it.
    """

    perceived: str | None
    cost: float = math.nan
    probability: float | None = None


@dataclass(frozen=True, slots=True, repr=False)
class Match(Answer):
    """An object of the description, and the scene object that it is matched to.

    ``score`` is the share of the comparable facts about the object that hold, by degree and weight; 1 without such
    facts. ``similarity`` is the paper's, and NaN in a stored lesson, which does not keep it. ``probability`` is the
    posterior probability of the match, None if the engine gives none. ``decided`` is True if the probability is high
    enough (:func:`deixis.reasoning.grounding.options.is_decided`), or if no other object is as similar.

    Examples
    --------
    >>> import deixis
    >>> script = deixis.read_script(text="fork left of plate")
    >>> scene = deixis.read_scene({"objects": [
    ...     {"id": "o1", "min": [0, 0], "max": [0.03, 0.2]}, {"id": "o2", "min": [0.1, 0], "max": [0.35, 0.25]}]})
    >>> match = deixis.ground(script, scene).matches["fork"]
    >>> match.perceived, match.decided, match.score
    ('o1', True, 1.0)
    >>> match.could_be, round(match.sureness, 2)
    ((), 0.99)
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
        probability = "" if self.probability is None else f", probability {rounded(self.probability)}"
        return f"{self.object} is {self.perceived}{probability}{'' if self.decided else ', undecided'}"

    @property
    def could_be(self) -> tuple[str, ...]:
        """Scene objects that the object may be, the match first; empty for a decided match."""
        others = tuple(other.perceived for other in self.alternatives if other.perceived is not None)
        return () if self.decided else (self.perceived, *others)

    @property
    def sureness(self) -> float:
        """Confidence in the match, in [0, 1].

        It is the probability if there is one, else 1 for a decided match, else one share for each object in
        ``could_be``. It is 0 for an undecided match without known alternatives.
        """
        if self.probability is not None:
            return self.probability
        if self.decided:
            return 1.0
        return 1.0 / len(self.could_be) if len(self.could_be) > 1 else 0.0


class SeenObject(Protocol):
    """A perceived object as a lesson stores it."""

    @property
    def id(self) -> str:
        """Identifier of the object in its scene."""
        ...

    @property
    def minimum(self) -> tuple[float, ...]:
        """Minimum corner of the bounding box, 2 or 3 coordinates in the scene's unit."""
        ...

    @property
    def maximum(self) -> tuple[float, ...]:
        """Maximum corner of the bounding box, 2 or 3 coordinates in the scene's unit."""
        ...

    @property
    def label(self) -> str | None:
        """Label that a recogniser or an annotation gave."""
        ...

    @property
    def confidence(self) -> float:
        """Confidence in the label, in [0, 1]."""
        ...

    @property
    def colour(self) -> Rgb | None:
        """Mean colour in sRGB."""
        ...


class SeenScene(Protocol):
    """A scene as a lesson stores it; perception's ``Scene`` has this type."""

    @property
    def frame(self) -> str:
        """Name of the coordinate frame."""
        ...

    @property
    def viewpoint(self) -> str:
        """Name of the viewpoint that the scene is seen from."""
        ...

    @property
    def unit(self) -> str:
        """Unit of the coordinates."""
        ...

    @property
    def objects(self) -> Sequence[SeenObject]:
        """Perceived objects, in their order."""
        ...


SeenRelation = tuple[str, Relation, str]
"""Exact relation of a pair of perceived objects: subject id, relation, object id."""


@dataclass(frozen=True, repr=False)
class Lesson:
    """The learning of one layout, and of the objects in its roles, from one script and one scene.

    ``relations`` are the exact relations of pairs of the scene's objects. ``events`` are the ids of what was
    said in the episodes of the memory, which keeps them; exports do not have them.
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
    teacher: str = ANONYMOUS
    scene_file: str = ""
    told_text: str | None = None  # the words of a person, where the script was made from them
    events: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<Lesson {self.id}: {count(len(self.layout.roles), 'role')}, {len(self.matches)} matched>"

    @property
    def id(self) -> str:
        """Identifier of the lesson, which is that of its layout."""
        return self.layout.lesson

    def category_of(self, match: Match) -> str:
        """Return the name of the category that a match teaches.

        Parameters
        ----------
        match
            Match of the lesson.

        Returns
        -------
        str
            Name of its object; of a member of a group, the singular of that.
        """
        groups = {role.name for role in self.layout.roles if role.is_group}
        if match.object not in groups:
            return match.object
        return singular(match.object.replace("_", " ")).replace(" ", "_")

    def categories(self) -> tuple[Match, ...]:
        """Return the decided matches, which teach a category.

        Returns
        -------
        tuple of Match
            The matches; doubtful or interchangeable objects teach no category.
        """
        return tuple(match for match in self.matches if match.decided)


@dataclass(frozen=True)
class WordLesson:
    """The learning of words and sizes, but no layout, from a script and a scene whose labels name its objects."""

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
    teacher: str = ANONYMOUS
    scene_file: str = ""
    told_text: str | None = None


def next_lesson_id(name: str, taken: Callable[[str], bool]) -> str:
    """Return the id of a new lesson about a layout of this name.

    The number is free and the one before it is taken. It is searched for in doubling steps, since one name may have
    thousands of lessons.

    Parameters
    ----------
    name
        Name of the layout.
    taken
        Function that returns whether an id is in use.

    Returns
    -------
    str
        Name and number, such as ``formal_dinner-2``.

    Examples
    --------
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
