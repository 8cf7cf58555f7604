"""Infer what follows from a script."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.deadline import Deadline
from deixis.errors import DeixisError, UnknownTermError
from deixis.grammar.layout.parser import parse_script
from deixis.grammar.script import Script
from deixis.ontology.graph.facts import Fact
from deixis.ontology.relations.relation import Relation
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.entailment.claim_facts import (
    ClaimFact,
    facts_of_claims,
    implications_with_claims,
    with_facts_of_claims,
)
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.conflict import Conflict, find_conflict
from deixis.reasoning.entailment.demands import demands_of
from deixis.reasoning.entailment.derivations import Derivation
from deixis.reasoning.entailment.implications import TIME_LIMIT, Implications
from deixis.reasoning.errors import OutOfTimeError, require_time_limit
from deixis.spelling import nearest
from deixis.workflows.layouts.read import as_script

MAX_STEPS_LISTED = 12
"""Stated facts of which an inferred one is listed with all its lines; ``--explain`` has the others."""


@dataclass(frozen=True, slots=True)
class Inferred:
    """A fact that follows, the rule of its last step, and the stated facts that it follows from.

    ``steps`` is the number of these facts, 0 where the time limit was reached before they were found; ``lines`` are
    their lines in the script, empty for a long derivation.
    """

    fact: Fact
    rule: Rule
    steps: int
    lines: tuple[int, ...]


@dataclass(frozen=True, repr=False)
class Inference(Answer):
    """Facts that follow from a script without being stated, or the conflict in it.

    If the time limit was reached, ``decided`` is False if it is not known whether there is a conflict, and ``complete``
    if further facts may follow.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.infer(deixis.read_script(text="fork left of plate; plate left of knife"))
    >>> found.consistent, found.complete
    (True, True)
    >>> first = found.inferred()[0]
    >>> str(first.fact), str(first.rule), first.lines
    ('left(fork, knife)', 'transitivity', (1,))
    >>> sum(1 for _ in found.each_inferred())
    4
    >>> derivation = found.derive(first.fact.relations[0], "fork", "knife")
    >>> [str(premise.claim) for premise in derivation.premises]
    ['left(fork, plate)', 'left(plate, knife)']
    """

    stated: tuple[Fact, ...]
    implications: Implications
    conflict: Conflict | None
    decided: bool
    deadline: Deadline  # searches for what facts rest on end then
    of_claims: tuple[ClaimFact, ...] = ()  # facts that claims imply, which are edges of the graph after the stated ones
    earlier: tuple[Implications, ...] = ()  # of the facts before those of *between* were added, in the order of adding

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
        """Return the facts that follow without being stated.

        Returns
        -------
        tuple of Inferred
            The facts; empty if the script contradicts itself.
        """
        return tuple(self.each_inferred())

    @checks_arguments
    def derive(self, relation: Relation, subject: str, thing: str) -> Derivation | None:
        """Return a derivation of a fact from stated facts and claims, or None if it does not follow.

        Parameters
        ----------
        relation
            Relation of the fact, from the subject to the thing.
        subject, thing
            Names of two objects.

        Returns
        -------
        Derivation or None
            Derivation of ``relation(subject, thing)``; None if the fact does not follow.
        """
        fact = Fact(subject, (relation,), thing)
        found = self._first_that_implies(fact).derive(relation, subject, thing)
        return None if found is None else self._with_claims(found, {str(entry.fact): entry for entry in self.of_claims})

    def _with_claims(self, derivation: Derivation, by_fact: Mapping[str, ClaimFact]) -> Derivation:
        """Return a derivation whose leaves are stated facts and claims, instead of the facts that claims imply."""
        entry = by_fact.get(str(derivation.claim)) if derivation.rule is Rule.STATED else None
        if entry is None:
            premises = tuple(self._with_claims(premise, by_fact) for premise in derivation.premises)
            return replace(derivation, premises=premises)
        leaves: list[Any] = [Proof(str(entry.claim), Rule.STATED, source=entry.claim.source)]
        if entry.given is not None:
            given = entry.given
            leaves.append(self.derive(given.relations[0], given.subject, given.object))
        return replace(derivation, rule=Rule.CLAIM, premises=tuple(leaves), source=None)

    def each_inferred(self) -> Iterator[Inferred]:
        """Yield the facts that follow without being stated, one by one, since there may be millions.

        Yields
        ------
        Inferred
            A fact with the rule that was applied last and the number of stated facts that it rests on.
        """
        if not self.consistent or not self.decided:
            return
        for entry in self.of_claims:
            stated = self._lines_of(entry)
            yield Inferred(entry.fact, Rule.CLAIM, len(stated), stated)
        for fact, steps in self.implications.implied_with_steps():
            if steps > MAX_STEPS_LISTED:
                yield Inferred(fact, Rule.COMPOSITION, steps, ())
                continue
            try:
                support = self._first_that_implies(fact).support(fact, self.deadline)
            except OutOfTimeError:
                yield Inferred(fact, Rule.CASES, 0, ())
                continue
            yield Inferred(fact, support.rule, len(support.edges), self._lines(support.edges))

    def _first_that_implies(self, fact: Fact) -> Implications:
        """Return the earliest implications that contain a fact, so that what *between* implies explains no premise."""
        if not fact.plain:
            return self.implications
        ends = fact.relations[0], fact.subject, fact.object
        return next((implied for implied in self.earlier if implied.holds(*ends)), self.implications)

    def _lines(self, edges: Sequence[int]) -> tuple[int, ...]:
        """Return the lines that state the facts of edges, with those of the claims and facts that imply them."""
        sources = self.implications.graph.sources
        first = len(sources) - len(self.of_claims)
        found: set[int] = set()
        for edge in edges:
            source = sources[edge]
            if edge < first:
                found.add(source.line if source else 0)
            else:
                found |= set(self._lines_of(self.of_claims[edge - first]))
        return tuple(sorted(found))

    def _lines_of(self, entry: ClaimFact) -> tuple[int, ...]:
        lines = {entry.claim.source.line} if entry.claim.source is not None else set()
        if entry.given is not None:
            support = self._first_that_implies(entry.given).support(entry.given, self.deadline)
            lines |= set(self._lines(support.edges))
        return tuple(sorted(lines))


def inference_of(script: Script, time_limit: float = TIME_LIMIT) -> Inference:
    """Return what follows from a script, and whether it contradicts itself.

    Only facts that leave a choice take a search, and so need a limit.

    Parameters
    ----------
    script
        The script.
    time_limit
        Seconds for the search.

    Returns
    -------
    Inference
        The facts that follow, or the minimal conflict.
    """
    deadline = Deadline.after(time_limit)
    of_claims, implied = implications_with_claims(script.graph(), script.claims, time_limit)
    implications = implied[-1]
    possible = implications.consistent
    conflict = None if possible else find_conflict(implications, deadline.for_reasons(time_limit))
    return Inference(script.facts, implications, conflict, implications.decided, deadline, of_claims, implied[:-1])


def verdict_of(script: Script | str | Path, time_limit: float = TIME_LIMIT) -> bool | None:
    """Return whether the facts of a script can all hold, without a reason.

    Parameters
    ----------
    script
        The script, or its file.
    time_limit
        Seconds for the search.

    Returns
    -------
    bool or None
        The verdict, or None if the time limit left it open.
    """
    deadline = Deadline.after(time_limit)
    try:
        read = as_script(script, deadline=deadline)
        graph = read.graph()
        found = facts_of_claims(read.claims, graph.nodes, graph.vocabulary)
        together = with_facts_of_claims(graph, found) if found else graph
        return consistent(demands_of(together), deadline)
    except OutOfTimeError:
        return None


@checks_arguments
def infer(script: Script | str | Path, time_limit: float = TIME_LIMIT) -> Inference:
    """Infer what follows from a script in the wide reading, and whether it contradicts itself.

    Parameters
    ----------
    script
        The script, or its file.
    time_limit
        Seconds for reading the script and for facts that leave a choice; the others need no search.

    Returns
    -------
    Inference
        The facts that follow, each with a derivation, or the minimal conflict.

    Raises
    ------
    ScriptError
        If the script is invalid.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.infer(deixis.read_script(text="fork left of plate; plate left of knife"))
    >>> found
    <Inference 2 stated facts: consistent>
    >>> [str(each.fact) for each in found.inferred() if each.steps > 1]
    ['left(fork, knife)', 'right(knife, fork)']
    >>> deixis.infer(deixis.read_script(text="fork left of plate; plate left of fork")).consistent
    False
    """
    require_time_limit(time_limit)
    deadline = Deadline.after(time_limit)
    read = as_script(script, deadline=deadline)
    return inference_of(read, deadline.left)


def plain_fact(text: str, name: str) -> Fact:
    """Return the one plain, firm fact in a text.

    Parameters
    ----------
    text
        The text, such as ``left(fork, plate)``.
    name
        Name of the text in messages.

    Returns
    -------
    Fact
        The fact.

    Raises
    ------
    DeixisError
        If the text holds anything else.
    """
    facts = parse_script(text, name).facts
    if len(facts) != 1 or not facts[0].plain or facts[0].optional or facts[0].weight < 1:
        raise DeixisError(f"{name}: '{text}' is not one plain, firm fact; write it like 'left(fork, plate)'")
    return facts[0]


def require_names(inference: Inference, fact: Fact, name: str) -> None:
    """Raise UnknownTermError unless the script names both objects of a fact.

    Parameters
    ----------
    inference
        The inference over the script.
    fact
        The fact.
    name
        Name of the fact's text in the message.

    Raises
    ------
    UnknownTermError
        If it does not; the message suggests the nearest name.
    """
    nodes = inference.implications.graph.nodes
    for thing in (fact.subject, fact.object):
        if thing not in nodes:
            hint = nearest(thing, nodes)
            advice = f"did you mean '{hint}'?" if hint else f"there are: {', '.join(nodes)}"
            raise UnknownTermError(f"{name}: the script has no object '{thing}'; {advice}")
