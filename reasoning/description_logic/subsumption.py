"""Subsumption and satisfiability in the part of OWL in which lessons speak, decided without a reasoner's process.

A class has named super-classes and existential restrictions (``some things that it shows are forks``); classes may be
disjoint; properties have super-properties, inverses, domains and ranges. In this fragment of the profile OWL 2 EL (plus
ranges and inverses, which fillers without restrictions of their own do not turn into more), what is told and what
domains add, followed upwards, is every super-class there is: no rule leads back down. A class is impossible where two
disjoint classes are above it, or above what it must show. Anything beyond is refused (:exc:`BeyondLessonsError`), never
guessed; a differential test holds the answers to HermiT's.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cache

from deixis.reasoning.errors import ReasonerError

THING, NOTHING = "http://www.w3.org/2002/07/owl#Thing", "http://www.w3.org/2002/07/owl#Nothing"

BEYOND = tuple(
    f"http://www.w3.org/2002/07/owl#{name}"
    for name in (
        "equivalentClass", "complementOf", "unionOf", "intersectionOf", "oneOf", "disjointUnionOf", "hasKey",
        "propertyChainAxiom", "equivalentProperty", "propertyDisjointWith", "sameAs", "allValuesFrom", "hasValue",
        "hasSelf", "cardinality", "minCardinality", "maxCardinality", "qualifiedCardinality",
        "minQualifiedCardinality", "maxQualifiedCardinality", "onProperties", "withRestrictions",
        "datatypeComplementOf", "sourceIndividual",
    )
)  # fmt: skip
"""The properties (IRIs) that take an ontology out of the fragment."""


class BeyondLessonsError(ReasonerError):
    """An ontology says more than lessons do; a description-logic reasoner must decide."""


@dataclass(frozen=True)
class ToldClass:
    """What is said of a class: its named super-classes, and pairs of a property and the class of what it leads to."""

    broader: frozenset[str] = frozenset()
    shows: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True)
class PropertyEnds:
    """What holds of both ends of a property, super-properties and inverses included; whether it leads to one thing."""

    domains: frozenset[str] = frozenset()
    ranges: frozenset[str] = frozenset()
    functional: bool = False


class Subsumption:
    """The super-classes of classes, from what ``told`` says of each; only classes that are asked about are looked at.

    ``ends`` says the same of properties; ``disjoint`` are groups of classes no two of which have a thing in common.

    >>> said = {"fork": ToldClass(frozenset({"cutlery"})), "cutlery": ToldClass(frozenset({"thing"}))}
    >>> sorted(Subsumption(lambda name: said.get(name, ToldClass())).broader("fork"))
    ['cutlery', 'thing']
    """

    def __init__(
        self,
        told: Callable[[str], ToldClass],
        ends: Callable[[str], PropertyEnds] = lambda prop: PropertyEnds(),
        disjoint: Sequence[frozenset[str]] = (),
    ) -> None:
        self._told, self._ends, self._disjoint = told, cache(ends), disjoint
        self._classes: dict[str, ToldClass] = {}
        self._broader: dict[str, frozenset[str]] = {}

    def broader(self, name: str) -> frozenset[str]:
        """Return every named super-class but the class itself and owl:Thing; of an impossible class the told ones."""
        known = self._broader.get(name)
        if known is None:
            known = self._broader[name] = frozenset(self._above([name]) - {name, THING})
        return known

    def satisfiable(self, *names: str) -> bool:
        """Return whether a thing can belong to all of these classes at once.

        Raises BeyondLessonsError where that cannot be decided here.
        """
        above = self._above(names)
        if NOTHING in above or any(len(group & above) > 1 for group in self._disjoint):
            return False
        return all(self._can_show(prop, filler) for name in above for prop, filler in self._class(name).shows)

    def _can_show(self, prop: str, filler: str) -> bool:
        ends = self._ends(prop)
        if ends.functional:
            raise BeyondLessonsError(f"<{prop}> is functional, and a class is restricted by it")
        fillers = [filler, *ends.ranges]
        if any(self._class(name).shows for name in self._above(fillers)):
            raise BeyondLessonsError(f"a class shows <{filler}>, which shows something in its turn")
        return self.satisfiable(*fillers)

    def _above(self, names: Iterable[str]) -> set[str]:
        """Return these classes and all above them."""
        todo = list(names)
        above = set(todo)
        while todo:
            told = self._class(todo.pop())
            domains = (self._ends(prop).domains for prop, _ in told.shows)
            new = told.broader.union(*domains) - above
            above |= new
            todo += new
        return above

    def _class(self, name: str) -> ToldClass:
        known = self._classes.get(name)
        if known is None:
            known = self._classes[name] = self._told(name)
        return known
