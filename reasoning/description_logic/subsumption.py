"""Subsumption and satisfiability in the fragment of OWL that lessons use, decided without a reasoner's process.

A class has named super-classes and existential restrictions (``some things that it shows are forks``). Classes may be
disjoint; properties have super-properties, inverses, domains and ranges. The fragment is within OWL 2 EL (Baader,
Brandt and Lutz, "Pushing the EL envelope", IJCAI 2005) plus ranges and inverses, which imply nothing more here, since
fillers have no restrictions of their own. All super-classes are found by following the stated ones and those from
domains upwards, since no rule leads downwards. A class is unsatisfiable if two disjoint classes are above it, or above
a class that it must show. Other axioms are refused (:exc:`BeyondLessonsError`). A differential test compares the
answers with HermiT's.
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
"""The properties (IRIs) that are outside of the fragment."""


class BeyondLessonsError(ReasonerError):
    """An ontology outside of the fragment of lessons, which a description-logic reasoner must decide."""


@dataclass(frozen=True)
class ClassAxioms:
    """The axioms of a class: its named super-classes, and its restrictions as pairs of a property and a class."""

    broader: frozenset[str] = frozenset()
    shows: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True)
class PropertyEnds:
    """Domains and ranges of a property, including those of super-properties and inverses, and its functionality."""

    domains: frozenset[str] = frozenset()
    ranges: frozenset[str] = frozenset()
    functional: bool = False


class Subsumption:
    """The super-classes of classes, computed on demand from ``told``, a function from a class to its axioms.

    ``ends`` is such a function for properties; ``disjoint`` are groups of pairwise disjoint classes.

    >>> axioms = {"fork": ClassAxioms(frozenset({"cutlery"})), "cutlery": ClassAxioms(frozenset({"thing"}))}
    >>> sorted(Subsumption(lambda name: axioms.get(name, ClassAxioms())).broader("fork"))
    ['cutlery', 'thing']
    """

    def __init__(
        self,
        class_axioms: Callable[[str], ClassAxioms],
        ends: Callable[[str], PropertyEnds] = lambda prop: PropertyEnds(),
        disjoint: Sequence[frozenset[str]] = (),
    ) -> None:
        self._class_axioms, self._ends, self._disjoint = class_axioms, cache(ends), disjoint
        self._classes: dict[str, ClassAxioms] = {}
        self._broader: dict[str, frozenset[str]] = {}

    def broader(self, name: str) -> frozenset[str]:
        """Return every named super-class except the class itself and owl:Thing; stated ones if it is unsatisfiable.

        Parameters
        ----------
        name
            Name of a class.

        Returns
        -------
        frozenset of str
            Names of the super-classes.
        """
        known = self._broader.get(name)
        if known is None:
            known = self._broader[name] = frozenset(self._above([name]) - {name, THING})
        return known

    def satisfiable(self, *names: str) -> bool:
        """Return whether all of these classes can have a common member.

        Parameters
        ----------
        *names
            Names of classes.

        Returns
        -------
        bool
            False if no model has a common member.

        Raises
        ------
        BeyondLessonsError
            The axioms are outside of the fragment that this module decides.
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
            raise BeyondLessonsError(f"a class shows <{filler}>, which has a restriction of its own")
        return self.satisfiable(*fillers)

    def _above(self, names: Iterable[str]) -> set[str]:
        """Return these classes and all their super-classes."""
        todo = list(names)
        above = set(todo)
        while todo:
            axioms = self._class(todo.pop())
            domains = (self._ends(prop).domains for prop, _ in axioms.shows)
            new = axioms.broader.union(*domains) - above
            above |= new
            todo += new
        return above

    def _class(self, name: str) -> ClassAxioms:
        known = self._classes.get(name)
        if known is None:
            known = self._classes[name] = self._class_axioms(name)
        return known
