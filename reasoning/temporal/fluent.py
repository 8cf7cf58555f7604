"""Fluents: statements that hold for a time, and statements about that time.

A fluent is as on the blackboard of RACE (Rockel et al. 2013): an instance with a statement, a start and a finish, each
known only to lie in an interval of seconds since an origin, or not known at all. It holds from its start on, but not at
its finish, so that of two fluents that meet, exactly one holds at the instant between them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from deixis.ontology.relations.allen import ALL_ALLEN, members
from deixis.reasoning.constraints.difference import ZERO, add
from deixis.reasoning.temporal.bounds import UNKNOWN, Bounds
from deixis.reasoning.temporal.errors import FluentError

ORIGIN = "origin"
"""Name of the point from which times are counted."""


@dataclass(frozen=True, slots=True)
class Statement:
    """The content of a fluent: a subject, a predicate, and possibly an object.

    >>> str(Statement("cup", "on", "table")), str(Statement("door", "open"))
    ('on(cup, table)', 'open(door)')
    """

    subject: str
    predicate: str
    object: str | None = None

    def __str__(self) -> str:
        return f"{self.predicate}({self.subject}{'' if self.object is None else f', {self.object}'})"


@dataclass(frozen=True, slots=True)
class Pattern:
    """A pattern of statements, by subject, predicate and object; None matches everything.

    >>> Pattern(predicate="on").matches(Statement("cup", "on", "table"))
    True
    """

    subject: str | None = None
    predicate: str | None = None
    object: str | None = None

    def matches(self, statement: Statement) -> bool:
        """Return whether a statement matches the pattern.

        Parameters
        ----------
        statement
            Subject, predicate and object.

        Returns
        -------
        bool
            True if each part that the pattern gives is that of the statement.
        """
        return (
            self.subject in (None, statement.subject)
            and self.predicate in (None, statement.predicate)
            and self.object in (None, statement.object)
        )


ANYTHING = Pattern()


@dataclass(frozen=True, slots=True)
class Fluent:
    """A statement that holds from some time to some later time, both known within bounds.

    ``source`` is the place where it was stated. Raises FluentError if the bounds leave no start before a finish.

    >>> str(Fluent("f1", Statement("cup", "on", "table"), Bounds(0, 2), Bounds(5)))
    'f1: on(cup, table) from [0, 2] to [5, ∞)'
    """

    id: str
    statement: Statement
    start: Bounds = UNKNOWN
    finish: Bounds = UNKNOWN
    source: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        longest = add(self.start.at_least, self.finish.at_most)
        if longest <= ZERO:
            raise FluentError(
                f"{_place(self.source)}the fluent '{self.id}' must start before it finishes, "
                f"got a start in {self.start} and a finish in {self.finish}"
            )

    @property
    def points(self) -> tuple[str, str]:
        """Names of its two ends."""
        return f"{self.id}.start", f"{self.id}.finish"

    def __str__(self) -> str:
        return f"{self.id}: {self.statement} from {self.start} to {self.finish}"


@dataclass(frozen=True, slots=True)
class AllenStatement:
    """The statement that fluent ``a`` has one of a set of Allen relations, a 13-bit mask, to fluent ``b``.

    Raises FluentError if the set is empty, or a fluent is related to itself.

    >>> str(AllenStatement("f1", 0b11, "f2"))
    'before or meets(f1, f2)'
    """

    a: str
    relations: int
    b: str
    source: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        where = _place(self.source)
        if not 0 < self.relations <= ALL_ALLEN:
            raise FluentError(f"{where}'{self.a}' and '{self.b}' must have at least one of the thirteen relations")
        if self.a == self.b:
            raise FluentError(f"{where}the fluent '{self.a}' is related to itself")

    @property
    def fluents(self) -> tuple[str, ...]:
        """Ids of the two fluents."""
        return self.a, self.b

    def __str__(self) -> str:
        return allen_text(self.a, self.relations, self.b)


@dataclass(frozen=True, slots=True)
class EndDifference:
    """The statement that the time from one point to another lies within bounds, in seconds.

    A point is ``ID.start`` or ``ID.finish`` of a fluent, or ``origin``. Raises FluentError if the points are equal.

    >>> str(EndDifference("f1.finish", "f2.start", Bounds(0, 5)))
    'f2.start - f1.finish in [0, 5]'
    """

    tail: str
    head: str
    bounds: Bounds
    source: str | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        if self.tail == self.head:
            raise FluentError(f"{_place(self.source)}the time from '{self.tail}' to itself is always 0")

    @property
    def fluents(self) -> tuple[str, ...]:
        """Ids of the fluents of the points."""
        points = (point for point in (self.tail, self.head) if point != ORIGIN)
        return tuple(dict.fromkeys(point.rpartition(".")[0] for point in points))

    def __str__(self) -> str:
        return f"{self.head} - {self.tail} in {self.bounds}"


TemporalRelation = AllenStatement | EndDifference


def _place(source: str | None) -> str:
    return f"{source}: " if source else ""


def allen_text(a: str, mask: int, b: str) -> str:
    """Return a set of Allen relations between two fluents, in words.

    Parameters
    ----------
    a, b
        Ids of the fluents.
    mask
        Mask of the relations of a to b.

    Returns
    -------
    str
        A phrase.
    """
    if mask == ALL_ALLEN:
        return f"any relation({a}, {b})"
    return " or ".join(relation.name.lower() for relation in members(mask)) + f"({a}, {b})"
