"""Infer what follows from a script."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deixis.answers import Answer, count
from deixis.deadline import Deadline
from deixis.errors import DeixisError, UnknownTermError
from deixis.grammar.parser import parse_script
from deixis.grammar.script import Script
from deixis.ontology.facts import Fact
from deixis.ontology.relation import nearest
from deixis.reasoning.constraints.proof import Rule
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.conflict import Conflict, find_conflict
from deixis.reasoning.entailment.demands import demands_of
from deixis.reasoning.entailment.implications import TIME_LIMIT, Implications
from deixis.reasoning.errors import OutOfTimeError
from deixis.workflows.read import as_script

MAX_STEPS_LISTED = 12
"""Stated facts of which an inferred one is listed with all its lines; ``--explain`` has the others."""


@dataclass(frozen=True, slots=True)
class Inferred:
    """A fact that follows, by what rule last, and from what: how many stated facts, and their lines unless too many.

    0 facts: which they are was not found out within the time limit.
    """

    fact: Fact
    rule: Rule
    steps: int
    lines: tuple[int, ...]


@dataclass(frozen=True, repr=False)
class Inference(Answer):
    """Facts that follow from a script without being stated, or the conflict in it.

    Where the time limit struck, ``decided`` is False if it is not known whether there is a conflict, and ``complete``
    if further facts may follow.
    """

    stated: tuple[Fact, ...]
    implications: Implications
    conflict: Conflict | None
    decided: bool
    deadline: Deadline  # searches for what facts rest on end then

    def summary(self) -> str:
        """Return the verdict, without searching for what follows."""
        if not self.decided:
            return f"{count(len(self.stated), 'stated fact')}: undecided within the time limit"
        verdict = "consistent" if self.consistent else "contradictory"
        return f"{count(len(self.stated), 'stated fact')}: {verdict}"

    @property
    def consistent(self) -> bool:
        """True if no conflict was found."""
        return self.conflict is None

    @property
    def complete(self) -> bool:
        """True if no further facts follow."""
        return self.implications.complete

    def inferred(self) -> tuple[Inferred, ...]:
        """Return the facts that follow without being stated; none where the script contradicts itself."""
        return tuple(self.each_inferred())

    def each_inferred(self) -> Iterator[Inferred]:
        """Yield the facts that follow without being stated one by one: there may be millions."""
        if not self.consistent or not self.decided:
            return
        places = [source.line if source else 0 for source in self.implications.graph.sources]
        for fact, steps in self.implications.implied_with_steps():
            if steps > MAX_STEPS_LISTED:
                yield Inferred(fact, Rule.COMPOSITION, steps, ())
                continue
            try:
                support = self.implications.support(fact, self.deadline)
            except OutOfTimeError:
                yield Inferred(fact, Rule.CASES, 0, ())
                continue
            lines = tuple(sorted({places[edge] for edge in support.edges}))
            yield Inferred(fact, support.rule, len(support.edges), lines)


LAST_SHARE = 0.1
"""Of the time limit, for saying why a script contradicts itself, where seeing that took all of it."""


def inference_of(script: Script, time_limit: float = TIME_LIMIT) -> Inference:
    """Return what follows from a script, and whether it contradicts itself, within about ``time_limit`` seconds.

    Only facts that leave a choice take a search, and so need a limit.
    """
    deadline = Deadline.after(time_limit)
    implications = Implications(script.graph(), time_limit)
    possible = implications.consistent
    conflict = None if possible else find_conflict(implications, max(deadline, Deadline.after(LAST_SHARE * time_limit)))
    return Inference(script.facts, implications, conflict, implications.decided, deadline)


def verdict_of(script: Script | str | Path, time_limit: float = TIME_LIMIT) -> bool | None:
    """Return whether a script can hold, without saying why not; None where the time limit left that open."""
    try:
        return consistent(demands_of(as_script(script).graph()), Deadline.after(time_limit))
    except OutOfTimeError:
        return None


def infer(script: Script | str | Path, time_limit: float = TIME_LIMIT) -> Inference:
    """Infer what follows from a script in the wide reading, and whether it contradicts itself.

    The time limit is for facts that leave a choice; the others need no search.
    """
    return inference_of(as_script(script), time_limit)


def plain_fact(text: str, name: str) -> Fact:
    """Return the one plain, firm fact in a text; ``name`` is what an error calls the text. Raises DeixisError."""
    facts = parse_script(text, name).facts
    if len(facts) != 1 or not facts[0].plain or facts[0].optional or facts[0].weight < 1:
        raise DeixisError(f"{name}: '{text}' is not one plain, firm fact; write it like 'left(fork, plate)'")
    return facts[0]


def require_names(inference: Inference, fact: Fact, name: str) -> None:
    """Raise UnknownTermError, with the nearest name, unless the script names both objects of a fact."""
    nodes = inference.implications.graph.nodes
    for thing in (fact.subject, fact.object):
        if thing not in nodes:
            hint = nearest(thing, nodes)
            suggestion = f"; did you mean '{hint}'?" if hint else ""
            raise UnknownTermError(f"{name}: the script names no '{thing}'{suggestion}")
