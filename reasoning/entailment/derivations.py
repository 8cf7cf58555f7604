"""Derivations over bounds: every bound of a conclusion has a shortest path of facts, and paths become steps in words.

A path whose facts link the subject to the object is a chain: the composition of their relations in the rectangle
algebra, or transitivity where one word is all of it. A conclusion whose bounds go by different chains is their
conjunction. Where facts leave a choice it is derived by cases, each of which leads to it or to a contradiction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.relation import Reading, Relation, Relations
from deixis.reasoning.constraints.minimal import minimal_subset
from deixis.reasoning.constraints.paths import ShortestPaths
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.entailment.bounds import Bound, Conjunction, EndpointBounds, Order, bounds_of, denial, meaning
from deixis.reasoning.entailment.closed import order_graph
from deixis.reasoning.entailment.closing import consistent
from deixis.reasoning.entailment.demands import Choice, Demands, demands_of, demands_of_facts
from deixis.reasoning.errors import OutOfTimeError


@dataclass(frozen=True, slots=True)
class ImpossibleCase:
    """The claim that an assumption cannot hold, and in words why."""

    reason: str

    def __str__(self) -> str:
        return f"impossible: {self.reason}"


Claim = Fact | Order | ImpossibleCase
Derivation = Proof[Claim]

Path = tuple[int, ...]
"""Premises in the order in which they lead from the subject of a bound to its object, or the other way round."""

_MAX_TRIED = 40
"""Facts of a union of paths that are tried one by one for being superfluous."""


class OrderDerivations:
    """Shortest derivations from premises that are conjunctions of bounds.

    ``premises[k]`` is the fact whose bounds in ``bounds`` bear the number k; the last ones, from ``assumed`` on, are
    assumptions. Facts name objects by ``names``.
    """

    def __init__(
        self,
        vocabulary: Relations,
        names: Sequence[str],
        premises: Sequence[Fact | Order],
        bounds: EndpointBounds,
        assumed: int,
    ) -> None:
        self._vocabulary = vocabulary
        self._names = names
        self._premises = premises
        self._assumed = assumed
        self._bounds = bounds
        self._graph = order_graph(bounds, len(names))
        self._paths = ShortestPaths(self._graph)

    def prepare(self) -> None:
        """Build both graphs in which paths are searched; the first search does it otherwise."""
        assert self._paths.reverse is not None

    def circle(self) -> Path | None:
        """Return the premises of the contradiction that takes the fewest; None where they agree."""
        return self._graph.shortest_cycle()

    def costs(self, bound: Bound, subject: int, objects: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return how many premises a bound takes from a subject to each of some objects, ``FAR`` where it does not
        follow."""
        n, onward = len(self._names), bound.tail == 0
        root = bound.points(subject, subject, n)[0 if onward else 1]
        points = (2 * bound.axis + (bound.head_side if onward else bound.tail_side)) * n + objects
        return self._paths.costs(root, points, bound.strict, backwards=not onward)

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: k for k, name in enumerate(self._names)}

    @cached_property
    def _stated(self) -> dict[tuple[str, int, str], int]:
        """Where a fact is firmly stated just so: by subject, relation set and object."""
        stated: dict[tuple[str, int, str], int] = {}
        for k in np.unique(self._bounds.premise).tolist():
            fact = self._premises[k]
            if isinstance(fact, Fact) and fact.positive:
                stated.setdefault((fact.subject, fact.relation_set, fact.object), k)
        return stated

    def chains(self, relation: Relation, subject: str, obj: str) -> dict[Bound, Path] | None:
        """Return for every bound of a relation the facts that lead to it, as few as found; None where one has none."""
        stated = self._stated.get((subject, relation.bit, obj))
        if stated is not None:
            return dict.fromkeys(meaning(relation)[0], (stated,))
        found = _chains(self._paths, meaning(relation), self._index[subject], self._index[obj], len(self._names))
        if found is None or len(set(found.values())) < 2:
            return found
        ends = (relation, subject, obj)
        used = sorted({premise for path in found.values() for premise in path})
        for path in sorted(set(found.values()), key=len):
            alone = self._among(path, *ends)
            if alone is not None:
                return alone
        if len(used) <= _MAX_TRIED:
            for premise in reversed(used):
                rest = self._among([other for other in used if other != premise], *ends)
                if rest is not None:
                    used, found = [other for other in used if other != premise], rest
        return found

    def _among(self, chosen: Sequence[int], relation: Relation, subject: str, obj: str) -> dict[Bound, Path] | None:
        """Return the paths that use no other premises than these."""
        mask = np.zeros(len(self._premises), np.bool_)
        mask[list(chosen)] = True
        few = self._bounds.of_premises(mask)
        involved = dict.fromkeys([subject, obj])
        for premise in chosen:
            involved.update(dict.fromkeys((self._premises[premise].subject, self._premises[premise].object)))
        place = np.zeros(len(self._names), np.int64)
        nodes = [self._index[name] for name in involved]
        place[nodes] = np.arange(len(nodes))
        n = len(self._names)
        tail, head = (points // n * len(nodes) + place[points % n] for points in (few.tail, few.head))
        paths = ShortestPaths(order_graph(replace(few, tail=tail, head=head), len(nodes)))
        return _chains(paths, meaning(relation), int(place[nodes[0]]), int(place[nodes[1]]), len(nodes))

    def derive(self, relation: Relation, subject: str, obj: str) -> Derivation | None:
        """Return a derivation of the fact; None where no path leads to it."""
        found = self.chains(relation, subject, obj)
        return None if found is None else self.of_chains(found, relation, subject, obj)

    def of_chains(self, chains: dict[Bound, Path], relation: Relation, subject: str, obj: str) -> Derivation:
        """Return the derivation whose bounds go by these chains."""
        groups: dict[Path, list[Bound]] = {}
        for bound, path in chains.items():
            groups.setdefault(path, []).append(bound)
        goal = Fact(subject, (relation,), obj)
        if len(groups) == 1:
            return self._chain(goal, relation, next(iter(groups)))
        parts = [
            self._chain(claim, named, path)
            for path, bounds in groups.items()
            for claim, named in self._claims(bounds, subject, obj)
        ]
        return Proof(goal, Rule.CONJUNCTION, tuple(parts))

    def _claims(self, bounds: list[Bound], subject: str, obj: str) -> list[tuple[Fact | Order, Relation | None]]:
        """Return a relation that says just these bounds, or every bound by itself."""
        for relation in self._vocabulary.of_reading(Reading.WIDE):
            if len(meaning(relation)) == 1 and set(meaning(relation)[0]) == set(bounds):
                return [(Fact(subject, (relation,), obj), relation)]
        return [(Order(subject, obj, bound), None) for bound in bounds]

    def _chain(self, claim: Fact | Order, relation: Relation | None, path: Path) -> Derivation:
        """Return one claim from the facts that link its subject to its object."""
        steps, here = [], claim.subject
        for premise in path:
            fact = self._premises[premise]
            leaf = _leaf(fact, assumed=premise >= self._assumed)
            onward = fact.subject == here
            steps.append(leaf if onward else self._turned(fact, leaf))
            here = fact.object if onward else fact.subject
        if relation is None:
            return Proof(claim, Rule.MEANING if len(steps) == 1 else Rule.COMPOSITION, tuple(steps))
        wrapped = [_widened(step, relation) for step in steps]
        if all(step is not None for step in wrapped):
            if len(wrapped) == 1 and wrapped[0] is not None:
                return wrapped[0]
            if relation.transitive:
                return Proof(claim, Rule.TRANSITIVITY, tuple(step for step in wrapped if step is not None))
        return Proof(claim, Rule.MEANING if len(steps) == 1 else Rule.COMPOSITION, tuple(steps))

    def _turned(self, fact: Fact | Order, leaf: Derivation) -> Derivation:
        """Return the premise with its ends exchanged; an order of edges is the same claim from either end."""
        if isinstance(fact, Order):
            return Proof(Order(fact.object, fact.subject, fact.bound.reversed()), leaf.rule)
        inverse = tuple(self._vocabulary[relation.inverse] for relation in fact.relations)
        return Proof(Fact(fact.object, inverse, fact.subject, positive=fact.positive), Rule.INVERSE, (leaf,))


def _chains(paths: ShortestPaths, parts: Sequence[Conjunction], s: int, o: int, n: int) -> dict[Bound, Path] | None:
    """Return the fewest premises by which each bound holds of two of n objects; None where one does not."""
    if len(parts) != 1 or s == o:
        return None
    found: dict[Bound, Path] = {}
    for bound in parts[0]:
        tail, head = bound.points(s, o, n)
        onward = bound.tail == 0
        path = paths.path(*((tail, head) if onward else (head, tail)), bound.strict, backwards=not onward)
        if path is None:
            return None
        found[bound] = path
    return found


def _leaf(claim: Fact | Order, assumed: bool = False) -> Derivation:
    source = claim.source if isinstance(claim, Fact) and not assumed else None
    return Proof(claim, Rule.ASSUMED if assumed else Rule.STATED, source=source)


def _widened(step: Derivation, relation: Relation) -> Derivation | None:
    """Return the step as one of the relation: itself, or what it is a sub-property of; None where it is neither."""
    fact = step.claim
    if not isinstance(fact, Fact) or not fact.plain:
        return None
    if fact.relations[0] == relation:
        return step
    if relation.name in fact.relations[0].broader:
        return Proof(Fact(fact.subject, (relation,), fact.object), Rule.SUB_PROPERTY, (step,))
    return None


# ---- by cases


def follows(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: Deadline) -> bool:
    """Return whether a plain fact holds in every picture of the facts, of which there is one or none.

    Exact for every relation: what the goal denies is a list of choices, and none of them may have a picture. Raises
    OutOfTimeError.
    """
    return not consistent(demands_of_facts(vocabulary, [*facts, replace(goal, positive=False)]), deadline)


def needed_facts(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: Deadline) -> list[Fact]:
    """Return facts from which a goal that follows from all of them follows, and none of which can be spared.

    Raises OutOfTimeError.
    """
    found = minimal_subset(facts, lambda chosen: chosen if follows(chosen, goal, vocabulary, deadline) else None)
    return list(found.items)


def derive_by_cases(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: Deadline) -> Derivation | None:
    """Return a proof of a plain fact from facts, among them choices; None where it does not follow.

    It rests on facts of which none can be spared. Raises OutOfTimeError.
    """
    if not follows(facts, goal, vocabulary, deadline):
        return None
    needed = needed_facts(facts, goal, vocabulary, deadline)
    ends = Fact(goal.subject, goal.relations, goal.object)
    names = dict.fromkeys(name for fact in [*needed, ends] for name in (fact.subject, fact.object))
    graph = RelationGraph.from_facts(vocabulary, tuple(names), needed)
    return _ProofSearch(demands_of(graph), ends, deadline).run()


@dataclass(frozen=True, eq=False)
class _Assumption:
    """One alternative of a choice, as a claim that further steps may use."""

    claim: Fact | Order
    conjunction: Conjunction
    subject: int
    object: int


class _ProofSearch:
    """Proves one goal from few facts, splitting choices until every case is settled by orders alone."""

    def __init__(self, demands: Demands, goal: Fact, deadline: Deadline) -> None:
        self._demands = demands
        self._deadline = deadline
        self._goal = goal
        self._graph = demands.graph
        self._facts = list(demands.graph.facts())
        self._vocabulary = demands.graph.vocabulary

    def run(self) -> Derivation:
        return self._prove([], list(self._demands.choices))

    def _prove(self, assumed: list[_Assumption], choices: list[Choice]) -> Derivation:
        if self._deadline.passed:
            raise OutOfTimeError("the time limit struck before every case was written down")
        orders = self._orders(assumed)
        circle = orders.circle()
        if circle is not None:
            given = len(self._facts)
            leaves = [_leaf(self._facts[k]) if k < given else _leaf(assumed[k - given].claim, True) for k in circle]
            told = [str(leaf.claim) for leaf in leaves if leaf.rule is Rule.ASSUMED]
            return Proof(ImpossibleCase(" and ".join(told)), Rule.CONTRADICTION, tuple(leaves))
        goal = self._goal
        found = orders.derive(goal.relations[0], goal.subject, goal.object)
        if found is not None:
            return found
        choice, rest = choices[0], choices[1:]
        cases = [self._prove([*assumed, case], rest) for case in self._cases(choice)]
        leaf = _leaf(self._facts[choice.premise])
        return Proof(goal, Rule.CASES, (leaf, *cases))

    def _orders(self, assumed: Sequence[_Assumption]) -> OrderDerivations:
        n, given = len(self._graph.nodes), len(self._facts)
        rows = [
            (*bound.points(case.subject, case.object, n), bound.strict, given + k)
            for k, case in enumerate(assumed)
            for bound in case.conjunction
        ]
        bounds: EndpointBounds = self._demands.bounds.joined(bounds_of(rows))
        claims = [*self._facts, *(case.claim for case in assumed)]
        return OrderDerivations(self._vocabulary, self._graph.nodes, claims, bounds, given)

    def _cases(self, choice: Choice) -> list[_Assumption]:
        fact = self._facts[choice.premise]
        return [
            _Assumption(self._claim(fact, conjunction), conjunction, choice.subject, choice.object)
            for conjunction in choice.alternatives
        ]

    def _claim(self, fact: Fact, conjunction: Conjunction) -> Fact | Order:
        """Return an alternative in words: a relation of the fact, the denial of one, or an order of edges."""
        if fact.positive:
            for relation in fact.relations:
                if meaning(relation) == (conjunction,):
                    return Fact(fact.subject, (relation,), fact.object)
        wide = self._vocabulary.of_reading(Reading.WIDE)
        denied = next((other for other in wide if denial(other) == (conjunction,)), None)
        if denied is not None:
            return Fact(fact.subject, (denied,), fact.object, positive=False)
        return Order(fact.subject, fact.object, conjunction[0])
