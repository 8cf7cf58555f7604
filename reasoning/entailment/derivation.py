"""Why a fact holds: a tree of steps from the conclusion down to stated facts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from deixis.ontology.graph import Fact
from deixis.reasoning.entailment.bounds import Order


class Rule(StrEnum):
    """By what a claim holds."""

    STATED = "stated"
    ASSUMED = "assumed"  # one of the cases of a fact that leaves a choice
    INVERSE = "inverse"  # owl:inverseOf
    SUB_PROPERTY = "sub-property"  # rdfs:subPropertyOf
    MEANING = "meaning"  # the premise admits nothing that the conclusion does not
    TRANSITIVITY = "transitivity"  # owl:TransitiveProperty
    COMPOSITION = "composition"  # of the premises' relations in the rectangle algebra, from the first thing to the last
    CONJUNCTION = "conjunction"  # the premises hold of one pair, and together say it
    CASES = "cases"  # it holds whichever way a choice goes
    CONTRADICTION = "contradiction"  # a case that the other facts exclude


@dataclass(frozen=True, slots=True)
class Impossible:
    """The claim that an assumption cannot hold, and in words why."""

    reason: str

    def __str__(self) -> str:
        return f"impossible: {self.reason}"


Claim = Fact | Order | Impossible


@dataclass(frozen=True)
class Derivation:
    """A claim, the rule that gives it, and the derivations of what the rule needs."""

    fact: Claim
    rule: Rule
    premises: tuple[Derivation, ...] = ()

    def stated(self) -> tuple[Fact, ...]:
        """The stated facts that it rests on, without repetition, in the order of use."""
        return tuple(dict.fromkeys(self._stated()))

    def _stated(self) -> Iterator[Fact]:
        if self.rule is Rule.STATED and isinstance(self.fact, Fact):
            yield self.fact
        for premise in self.premises:
            yield from premise._stated()

    def lines(self, indent: str = "") -> Iterator[str]:
        """The derivation as indented text, conclusion first."""
        source = self.fact.source if isinstance(self.fact, Fact) else None
        place = f"   [{source}]" if self.rule is Rule.STATED and source else ""
        yield f"{indent}{self.fact}   by {self.rule}{place}"
        for premise in self.premises:
            yield from premise.lines(indent + "    ")
