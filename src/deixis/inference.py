"""What a script implies, ready to be listed: the facts that follow with their lines, or the conflict."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deixis.grammar.script import Script
from deixis.ontology.graph import Fact
from deixis.reasoning.conflict import Conflict, find_conflict
from deixis.reasoning.implications import Implications, Rule

MANY_STEPS = 40
"""Stated facts of which an inferred one is listed with all its lines; ``--explain`` has the others."""


@dataclass(frozen=True, slots=True)
class Inferred:
    """A fact that follows, by what rule last, and from what: how many stated facts, and their lines unless too many."""

    fact: Fact
    rule: Rule
    steps: int
    lines: tuple[int, ...]


@dataclass(frozen=True)
class Inference:
    """What a script implies: every fact that follows without being stated, or the conflict that spoils it."""

    stated: tuple[Fact, ...]
    implications: Implications
    conflict: Conflict | None

    @property
    def consistent(self) -> bool:
        return self.conflict is None

    def inferred(self) -> tuple[Inferred, ...]:
        """The facts that follow without being stated; none where the script contradicts itself."""
        return tuple(self._inferred()) if self.consistent else ()

    def _inferred(self) -> Iterator[Inferred]:
        lines = [source.line if source else 0 for source in self.implications.graph.sources]
        for fact in self.implications.implied():
            steps = self.implications.steps(fact)
            if steps > MANY_STEPS:
                yield Inferred(fact, Rule.TRANSITIVITY, steps, ())
                continue
            rule, edges = self.implications.support(fact)
            yield Inferred(fact, rule, steps, tuple(sorted({lines[edge] for edge in edges})))


def inference_of(script: Script) -> Inference:
    """What follows from a script in the wide reading, and whether it contradicts itself."""
    implications = Implications(script.graph())
    return Inference(script.facts, implications, find_conflict(implications))
