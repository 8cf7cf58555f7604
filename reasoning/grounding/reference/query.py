"""Descriptions of one object as data: a noun, properties, and relations to other described objects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum


class Person(StrEnum):
    """Someone who takes part in the conversation: *me* and *you*."""

    SPEAKER = "speaker"
    ADDRESSEE = "addressee"


@dataclass(frozen=True, slots=True)
class Property:
    """A property of the described object: ``red``, ``tallest``, ``second`` from the left, ``corner`` of the room.

    ``dimension`` is the kind of the property (``colour``, ``size``, ``height``, ``length``, ``width``, ``position``,
    ``rank``) and ``word`` its value (``red``, ``tall``, ``left``). ``rank`` is the place in an order, counted from 1
    (-1 for the last). ``degree`` is ``plain``, ``comparative`` or ``superlative``. ``person`` is the one whose place
    it is judged from (*closest to you*, *on my left*), None for the viewer of the whole description.
    """

    dimension: str
    word: str
    degree: str = "plain"
    rank: int | None = None
    positive: bool = True
    person: Person | None = None


@dataclass(frozen=True, slots=True)
class Relation:
    """A relation of the described object to the objects that its arguments describe.

    ``degree`` is ``superlative`` for *closest to*, ``comparative`` for *closer to*. ``inverted`` is True where the
    described object is the landmark: *the desk with the lamp on it* is inverted *on*.
    """

    name: str
    arguments: tuple[Description, ...]
    degree: str = "plain"
    positive: bool = True
    inverted: bool = False


@dataclass(frozen=True, slots=True)
class Description:
    """A noun phrase: what it says about the object that it stands for; ``noun`` is empty where no noun is given.

    ``count`` is the number of objects in a group (*between two chairs*); None for one object. ``plural`` is True for a
    noun in the plural. ``anything`` is True for a noun that every object fits (*the tallest thing*). ``other_nouns``
    are further nouns, of which one may fit instead (*the window or mirror*).
    """

    noun: str
    properties: tuple[Property, ...] = ()
    relations: tuple[Relation, ...] = ()
    count: int | None = None
    negated: bool = False
    plural: bool = False
    other_nouns: tuple[str, ...] = ()
    anything: bool = False

    @property
    def nouns(self) -> tuple[str, ...]:
        """All nouns of the description, of which one fits."""
        return (self.noun, *self.other_nouns)

    def parts(self) -> Iterator[Description]:
        """Yield this description and those of all objects that it mentions.

        Yields
        ------
        Description
            Description; this one first.
        """
        yield self
        for relation in self.relations:
            for argument in relation.arguments:
                yield from argument.parts()


def readings(description: Description) -> Iterator[Description]:
    """Yield a description, and the one in which its last phrase belongs to the described object.

    In *the pillow on the bed that is closest to the door*, the bed or the pillow may be closest to the door.

    Parameters
    ----------
    description
        The description.

    Yields
    ------
    Description
        Reading; the description as it was parsed comes first.
    """
    yield description
    last = description.relations[-1] if description.relations else None
    if last is None or len(last.arguments) != 1 or not last.positive or not last.arguments[0].relations:
        return
    (landmark,) = last.arguments
    *rest, lifted = landmark.relations
    bare = replace(last, arguments=(replace(landmark, relations=tuple(rest)),))
    yield replace(description, relations=(*description.relations[:-1], bare, lifted))


@dataclass(frozen=True, slots=True)
class Viewer:
    """The viewer of a description: *facing the window*, *from the door*, *as you enter through the door*.

    ``stance`` is ``facing`` (the viewer looks at ``landmark``), ``from`` (the viewer looks from it into the room),
    ``towards`` (the viewer looks from ``landmark`` at ``target``) or ``person`` (``person`` looks at the scene: *from
    your point of view*).
    """

    stance: str
    landmark: Description
    target: Description | None = None
    person: Person | None = None


@dataclass(frozen=True, slots=True)
class Query:
    """A description of the object that is meant, and of the viewer if one is mentioned.

    ``understood`` is the share of the words that the query expresses, ``words`` the number of words of the text.
    """

    target: Description
    viewer: Viewer | None = None
    understood: float = 1.0
    words: int = 0
