"""Derivations where facts leave a choice: by cases, each of which leads to the conclusion or to a contradiction."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Reading, Relation, Relations
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.entailment.bounds import Bounds, Conjunction, Order, bounds_of, denial, meaning
from deixis.reasoning.entailment.choices import Choice, OutOfTimeError
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.demands import Demands, demands_of, demands_of_facts
from deixis.reasoning.entailment.derivation import Derivation, Impossible, Rule
from deixis.reasoning.entailment.derivations import OrderDerivations


def follows(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: float) -> bool:
    """Whether a plain fact holds in every picture of the facts, of which there is one or none.

    Exact for every relation: what the goal denies is a list of choices, and none of them may have a picture. Raises
    OutOfTimeError.
    """
    return not consistent(demands_of_facts(vocabulary, [*facts, replace(goal, positive=False)]), deadline)


def needed_facts(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: float) -> list[Fact]:
    """Facts from which a goal that follows from all of them follows, and none of which can be spared.

    Raises OutOfTimeError.
    """
    return minimal_subset(facts, lambda chosen: follows(chosen, goal, vocabulary, deadline))


def derive_by_cases(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: float) -> Derivation | None:
    """A proof of a plain fact from facts, among them choices; None where it does not follow.

    It rests on facts of which none can be spared. Raises OutOfTimeError.
    """
    if not follows(facts, goal, vocabulary, deadline):
        return None
    needed = needed_facts(facts, goal, vocabulary, deadline)
    ends = Fact(goal.subject, goal.relations, goal.object)
    names = dict.fromkeys(name for fact in [*needed, ends] for name in (fact.subject, fact.object))
    graph = RelationGraph.from_facts(vocabulary, tuple(names), needed)
    return _Proof(demands_of(graph), ends, deadline).run()


@dataclass(frozen=True, eq=False)
class _Assumption:
    """One alternative of a choice, as a claim that further steps may use."""

    claim: Fact | Order
    conjunction: Conjunction
    subject: int
    object: int


class _Proof:
    """Proves one goal from few facts, splitting choices until every case is settled by orders alone."""

    def __init__(self, demands: Demands, goal: Fact, deadline: float) -> None:
        self._demands = demands
        self._deadline = deadline
        self._goal = goal
        self._graph = demands.graph
        self._facts = list(demands.graph.facts())
        self._vocabulary = demands.graph.vocabulary

    def run(self) -> Derivation:
        return self._prove([], list(self._demands.choices))

    def _prove(self, assumed: list[_Assumption], choices: list[Choice]) -> Derivation:
        if time.monotonic() > self._deadline:
            raise OutOfTimeError("the time limit struck before every case was written down")
        orders = self._orders(assumed)
        circle = orders.paths.circle()
        if circle is not None:
            return self._contradiction(circle, assumed)
        goal = self._goal
        found = orders.derive(goal.relations[0], goal.subject, goal.object)
        if found is not None:
            return found
        choice, rest = choices[0], choices[1:]
        cases = [self._prove([*assumed, case], rest) for case in self._cases(choice)]
        leaf = Derivation(self._facts[choice.premise], Rule.STATED)
        return Derivation(goal, Rule.CASES, (leaf, *cases))

    def _orders(self, assumed: Sequence[_Assumption]) -> OrderDerivations:
        n, given = len(self._graph.nodes), len(self._facts)
        rows = [
            (*bound.points(case.subject, case.object, n), bound.strict, given + k)
            for k, case in enumerate(assumed)
            for bound in case.conjunction
        ]
        bounds: Bounds = self._demands.bounds.joined(bounds_of(rows))
        claims = [*self._facts, *(case.claim for case in assumed)]
        return OrderDerivations(self._vocabulary, self._graph.nodes, claims, bounds, given)

    def _contradiction(self, circle: Sequence[int], assumed: Sequence[_Assumption]) -> Derivation:
        given = len(self._facts)
        leaves = [
            Derivation(self._facts[k], Rule.STATED) if k < given else Derivation(assumed[k - given].claim, Rule.ASSUMED)
            for k in circle
        ]
        told = [str(leaf.fact) for leaf in leaves if leaf.rule is Rule.ASSUMED]
        return Derivation(Impossible(" and ".join(told)), Rule.CONTRADICTION, tuple(leaves))

    def _cases(self, choice: Choice) -> list[_Assumption]:
        fact = self._facts[choice.premise]
        return [
            _Assumption(self._claim(fact, conjunction), conjunction, choice.subject, choice.object)
            for conjunction in choice.alternatives
        ]

    def _claim(self, fact: Fact, conjunction: Conjunction) -> Fact | Order:
        """An alternative in words: a relation of the fact, the denial of one, or an order of edges."""
        if fact.positive:
            for relation in fact.relations:
                if meaning(relation) == (conjunction,):
                    return Fact(fact.subject, (relation,), fact.object)
        denied = _denied_by(conjunction, self._vocabulary)
        if denied is not None:
            return Fact(fact.subject, (denied,), fact.object, positive=False)
        return Order(fact.subject, fact.object, conjunction[0])


def _denied_by(conjunction: Conjunction, vocabulary: Relations) -> Relation | None:
    wide = vocabulary.of_reading(Reading.WIDE)
    return next((relation for relation in wide if denial(relation) == (conjunction,)), None)
