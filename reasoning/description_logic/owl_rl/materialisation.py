"""OWL 2 RL materialisation: all triples that the rules derive, their derivations, and contradictions.

>>> from deixis.reasoning.description_logic.terms import Triple
>>> from deixis.reasoning.description_logic.terms import SUB_CLASS_OF, TYPE
>>> known = Materialisation([Triple("<urn:Fork>", SUB_CLASS_OF, "<urn:Cutlery>")])
>>> [str(triple) for triple in known.add([Triple("<urn:f>", TYPE, "<urn:Fork>")])]
['<urn:f> <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> <urn:Cutlery> .']
>>> [step.rule for step in known.derivation([Triple("<urn:f>", TYPE, "<urn:Cutlery>")])]
[None, None, 'cax-sco']
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.reasoning.description_logic.owl_rl.chaining import ForwardChaining
from deixis.reasoning.description_logic.owl_rl.facts import Fact
from deixis.reasoning.description_logic.terms import Triple
from deixis.reasoning.errors import NotEntailedError


@dataclass(frozen=True, slots=True)
class InferenceStep:
    """One step of a derivation: a triple, and the W3C name of its rule, or None for a stated triple."""

    triple: Triple
    rule: str | None
    premises: tuple[Triple, ...] = ()


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Triples that cannot all hold, and the W3C name of the rule that they violate."""

    rule: str
    premises: tuple[Triple, ...]


class Materialisation:
    """All triples that follow by the rules of OWL 2 RL from the triples added so far.

    :mod:`deixis.reasoning.description_logic.owl_rl.rules` lists the rules and the omitted ones. The cost of adding
    triples is proportional to their consequences. To remove triples, materialise the remaining ones again.
    """

    def __init__(self, triples: Iterable[Triple] = (), deadline: Deadline = Deadline.never()) -> None:
        self._chaining = ForwardChaining()
        self.add(triples, deadline)

    def add(self, triples: Iterable[Triple], deadline: Deadline = Deadline.never()) -> tuple[Triple, ...]:
        """Add triples, and return the triples that follow now and did not before, in the order found.

        After a LimitError, the materialisation must be started again.

        Parameters
        ----------
        triples
            Stated triples.
        deadline
            End of the time limit.

        Returns
        -------
        tuple of Triple
            Derived triples.

        Raises
        ------
        LimitError
            The deadline passed.
        """
        facts = [self._chaining.terms.fact(triple) for triple in triples]
        return tuple(map(self._triple, self._chaining.add(facts, deadline)))

    @property
    def inferred(self) -> tuple[Triple, ...]:
        """Triples that follow and were not stated, in the order found."""
        literals = self._chaining.terms.literals  # only rules use their datatypes
        why = self._chaining.why.items()
        return tuple(self._triple(fact) for fact, rule in why if rule is not None and fact[0] not in literals)

    @property
    def contradictions(self) -> tuple[Contradiction, ...]:
        """Contradictions in the order found; empty if no rule finds one."""
        found = self._chaining.contradictions.items()
        return tuple(Contradiction(name, tuple(map(self._triple, premises))) for (name, _), premises in found)

    def __contains__(self, triple: Triple) -> bool:
        return self._chaining.terms.known_fact(triple) in self._chaining.why

    def __len__(self) -> int:
        return len(self._chaining.why)

    def derivation(self, triples: Iterable[Triple]) -> tuple[InferenceStep, ...]:
        """Return the steps from stated triples to these triples, each once and after its premises.

        Parameters
        ----------
        triples
            Triples that follow.

        Returns
        -------
        tuple of InferenceStep
            Steps, each with its rule, its premises and its conclusion.

        Raises
        ------
        NotEntailedError
            A triple does not follow.
        """
        steps: dict[Fact, InferenceStep] = {}
        for triple in triples:
            fact = self._chaining.terms.known_fact(triple)
            if fact is None or fact not in self._chaining.why:
                raise NotEntailedError(f"does not follow by the rules of OWL 2 RL: {triple}")
            todo = [fact]
            while todo:
                step_fact = todo[-1]
                name, premises = self._chaining.why[step_fact] or (None, ())
                missing = [premise for premise in premises if premise not in steps]
                if missing and step_fact not in steps:
                    todo += missing
                else:
                    todo.pop()
                    steps.setdefault(
                        step_fact, InferenceStep(self._triple(step_fact), name, tuple(map(self._triple, premises)))
                    )
        return tuple(steps.values())

    def _triple(self, fact: Fact) -> Triple:
        return self._chaining.terms.triple(fact)
