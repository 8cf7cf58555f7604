"""Facts: the relation stated between two objects, and the place where it was written."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deixis.arguments import require_fields
from deixis.errors import GraphError
from deixis.ontology.relations.relation import Relation
from deixis.printable import visible_line


@dataclass(frozen=True, slots=True, order=True)
class Source:
    """A span of a file, lines and columns counted from 1, the end exclusive.

    >>> str(Source("dinner.layout", 3, 1, 3, 23))
    'dinner.layout:3:1'
    """

    file: str
    line: int
    column: int
    end_line: int
    end_column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


@dataclass(frozen=True, slots=True, repr=False)
class Fact:
    """A statement that the subject stands in one of the relations to the object, or, if not ``positive``, in none.

    ``weight`` is above 0 and at most 1, and below 0.5 for a fact that is rarely true. An ``optional`` fact need not
    hold. ``source`` is the place where the fact was written. A field of another type is an ArgumentError, a weight
    outside its range or a fact without a relation a GraphError.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> print(Fact("fork", (r["left"], r["top_left"]), "plate", weight=0.8))
    left or top_left(fork, plate)
    >>> fact = Fact("fork", (r["left"],), "plate", weight=0.2)
    >>> fact
    <Fact rarely left(fork, plate); weight 0.2>
    >>> fact.rare, fact.affirmed_weight, fact.plain, fact.relation_set == r["left"].bit
    (True, 0.8, False, True)
    """

    subject: str
    relations: tuple[Relation, ...]
    object: str
    positive: bool = True
    optional: bool = False
    weight: float = 1.0
    source: Source | None = None

    def __post_init__(self) -> None:
        if not self._has_usual_types():
            require_fields(self)
            object.__setattr__(self, "relations", tuple(self.relations))
        if not self.relations:
            raise GraphError("`relations` must have at least one relation, got none")
        if not 0 < self.weight <= 1:
            raise GraphError(f"`weight` must be above 0 and at most 1, got {self.weight}")

    def _has_usual_types(self) -> bool:
        """Return whether the fields need no further check; an inference makes 100,000 facts."""
        return (
            type(self.subject) is type(self.object) is str
            and type(self.relations) is tuple
            and {*map(type, self.relations)} == {Relation}
            and type(self.positive) is type(self.optional) is bool
            and type(self.weight) is float
            and (self.source is None or type(self.source) is Source)
        )

    def __repr__(self) -> str:
        notes = ["optional"] if self.optional else []
        notes += [f"weight {self.weight:g}"] if self.weight != 1 else []
        notes += [str(self.source)] if self.source is not None else []
        return visible_line(f"<Fact {'; '.join([str(self), *notes])}>")

    def __str__(self) -> str:
        names = " or ".join(relation.name for relation in self.relations)
        rarely = "rarely " if self.rare else ""
        return f"{rarely}{'' if self.positive else 'not '}{names}({self.subject}, {self.object})"

    @property
    def rare(self) -> bool:
        """True if the fact is said to hold rarely, so that its negation is more likely."""
        return self.weight < 0.5

    @property
    def affirmed_weight(self) -> float:
        """Weight of the more likely of the fact and its negation: a fact that holds rarely (0.2) is denied with 0.8."""
        return max(self.weight, 1 - self.weight)

    @property
    def plain(self) -> bool:
        """True for a single affirmed relation that is not rare, as Definition 1 and equations 5-9 of the paper need."""
        return self.positive and not self.rare and len(self.relations) == 1

    @property
    def relation_set(self) -> int:
        """Bit mask of the relations, over their indices."""
        mask = 0
        for relation in self.relations:
            mask |= relation.bit
        return mask


OPTIONAL_WEIGHT = 0.5
"""Factor by which the weight of an optional fact is multiplied."""


def dispensable(facts: Iterable[Fact]) -> frozenset[str]:
    """Return the objects that no certain fact needs: all facts about them are denied, optional or hedged.

    Parameters
    ----------
    facts
        The facts.

    Returns
    -------
    frozenset of str
        Names of the objects.
    """
    mentioned: set[str] = set()
    needed: set[str] = set()
    for fact in facts:
        mentioned |= {fact.subject, fact.object}
        if fact.positive and not fact.optional and fact.weight >= 1:
            needed |= {fact.subject, fact.object}
    return frozenset(mentioned - needed)
