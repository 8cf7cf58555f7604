"""What is stated of two objects, and where it was written."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deixis.ontology.relation import Relation


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


@dataclass(frozen=True, slots=True)
class Fact:
    """The subject stands in one of the relations to the object, or, where not ``positive``, in none of them.

    ``weight`` is above 0 and at most 1, below one half where it is rarely so; an ``optional`` fact need not hold.
    ``source`` is where it was written.

    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> print(Fact("fork", (r["left"], r["top_left"]), "plate", weight=0.8))
    left or top_left(fork, plate)
    """

    subject: str
    relations: tuple[Relation, ...]
    object: str
    positive: bool = True
    optional: bool = False
    weight: float = 1.0
    source: Source | None = None

    def __str__(self) -> str:
        names = " or ".join(relation.name for relation in self.relations)
        rarely = "rarely " if self.rare else ""
        return f"{rarely}{'' if self.positive else 'not '}{names}({self.subject}, {self.object})"

    @property
    def rare(self) -> bool:
        """Whether it is said to be rarely so, which is mostly not."""
        return self.weight < 0.5

    @property
    def affirmed_weight(self) -> float:
        """The weight of what it affirms: what is rarely so (0.2) is not so by 0.8."""
        return max(self.weight, 1 - self.weight)

    @property
    def plain(self) -> bool:
        """One relation that is affirmed, and not rarely so: what Definition 1 and equations 5-9 can see."""
        return self.positive and not self.rare and len(self.relations) == 1

    @property
    def relation_set(self) -> int:
        """The relations as a bit mask over their indices."""
        mask = 0
        for relation in self.relations:
            mask |= relation.bit
        return mask


OPTIONAL_WEIGHT = 0.5
"""By what the weight of an optional fact is multiplied."""


def dispensable(facts: Iterable[Fact]) -> frozenset[str]:
    """The objects of which something is said, but nothing firmly: no plain affirmed fact needs them to be there."""
    mentioned: set[str] = set()
    needed: set[str] = set()
    for fact in facts:
        mentioned |= {fact.subject, fact.object}
        if fact.positive and not fact.optional and fact.weight >= 1:
            needed |= {fact.subject, fact.object}
    return frozenset(mentioned - needed)
