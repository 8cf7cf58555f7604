"""Derivations over bounds: the shortest path of facts to every bound of a conclusion, in words.

A path whose facts link the subject to the object is a chain: composition of their relations in the rectangle algebra,
or transitivity if all have one word. A conclusion whose bounds have different chains is their conjunction. With choices
among the facts, it is derived by cases, each of which leads to it or to a contradiction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading, Relation, Relations
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
    """The claim that an assumption cannot hold, with the reason in words."""

    reason: str

    def __str__(self) -> str:
        return f"impossible: {self.reason}"


Claim = Fact | Order | ImpossibleCase
Derivation = Proof[Claim]

Path = tuple[int, ...]
"""Premises in the order in which they link the subject of a bound to its object, or the reverse."""

_MAX_TRIED = 40
"""Maximum number of facts in a union of paths that are tested one by one for being needed."""


class OrderDerivations:
    """Shortest derivations from premises that are conjunctions of bounds.

    ``premises[k]`` is the fact whose bounds have the number k in ``bounds``; those from ``assumed`` on are assumptions.
    Facts refer to objects by ``names``.
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
        """Build both graphs for the search of paths, which the first search would build otherwise."""
        assert self._paths.reverse is not None

    def cycle(self) -> Path | None:
        """Return the premises of the contradiction with the fewest premises, or None if they are consistent.

        Returns
        -------
        Path or None
            The premises, or None if they are consistent.
        """
        return self._graph.shortest_cycle()

    def costs(self, bound: Bound, subject: int, objects: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the number of premises of a bound from a subject to some objects.

        Parameters
        ----------
        bound
            The bound.
        subject
            Position of the subject.
        objects
            Positions of the k objects, shape (k,).

        Returns
        -------
        ndarray
            Numbers of shape (k,); ``FAR`` where the bound does not follow.
        """
        n, forwards = len(self._names), bound.tail == 0
        root = bound.points(subject, subject, n)[0 if forwards else 1]
        points = (2 * bound.axis + (bound.head_side if forwards else bound.tail_side)) * n + objects
        return self._paths.costs(root, points, bound.strict, backwards=not forwards)

    @cached_property
    def _index(self) -> dict[str, int]:
        return {name: k for k, name in enumerate(self._names)}

    @cached_property
    def _stated(self) -> dict[tuple[str, int, str], int]:
        """Premises that state a fact directly: by subject, relation set and object."""
        stated: dict[tuple[str, int, str], int] = {}
        for k in sorted(set(self._bounds.premise.ravel().tolist())):
            fact = self._premises[k]
            if isinstance(fact, Fact) and fact.positive:
                stated.setdefault((fact.subject, fact.relation_set, fact.object), k)
        return stated

    def chains(self, relation: Relation, subject: str, obj: str) -> dict[Bound, Path] | None:
        """Return for every bound of a relation a short path of facts to it.

        Parameters
        ----------
        relation
            The relation.
        subject, obj
            Names of the objects.

        Returns
        -------
        dict or None
            Path by bound, or None if a bound has no path.
        """
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
        """Return the paths that use only these premises."""
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
        """Return a derivation of a fact.

        Parameters
        ----------
        relation
            The relation.
        subject, obj
            Names of the objects.

        Returns
        -------
        Derivation or None
            The derivation, or None if no path leads to the fact.
        """
        found = self.chains(relation, subject, obj)
        return None if found is None else self.of_chains(found, relation, subject, obj)

    def of_chains(self, chains: dict[Bound, Path], relation: Relation, subject: str, obj: str) -> Derivation:
        """Return the derivation of a fact by given paths.

        Parameters
        ----------
        chains
            Path by bound, as of :meth:`chains`.
        relation
            The relation.
        subject, obj
            Names of the objects.

        Returns
        -------
        Derivation
            The derivation.
        """
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
        """Return one relation that has exactly these bounds, or every bound by itself."""
        for relation in self._vocabulary.of_reading(Reading.WIDE):
            if len(meaning(relation)) == 1 and set(meaning(relation)[0]) == set(bounds):
                return [(Fact(subject, (relation,), obj), relation)]
        return [(Order(subject, obj, bound), None) for bound in bounds]

    def _chain(self, claim: Fact | Order, relation: Relation | None, path: Path) -> Derivation:
        """Return the derivation of one claim from the facts that link its subject to its object."""
        steps, here = [], claim.subject
        for premise in path:
            fact = self._premises[premise]
            leaf = _leaf(fact, assumed=premise >= self._assumed)
            forwards = fact.subject == here
            steps.append(leaf if forwards else self._turned(fact, leaf))
            here = fact.object if forwards else fact.subject
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
    """Return the fewest premises of each bound between two of n objects, or None if a bound does not hold."""
    if len(parts) != 1 or s == o:
        return None
    found: dict[Bound, Path] = {}
    for bound in parts[0]:
        tail, head = bound.points(s, o, n)
        forwards = bound.tail == 0
        path = paths.path(*((tail, head) if forwards else (head, tail)), bound.strict, backwards=not forwards)
        if path is None:
            return None
        found[bound] = path
    return found


def _leaf(claim: Fact | Order, assumed: bool = False) -> Derivation:
    source = claim.source if isinstance(claim, Fact) and not assumed else None
    return Proof(claim, Rule.ASSUMED if assumed else Rule.STATED, source=source)


def _widened(step: Derivation, relation: Relation) -> Derivation | None:
    """Return the step as a derivation of the relation, if it is equal or a super-property; else None."""
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
    """Return whether a plain fact holds in every picture of some facts.

    The test is exact for every relation: the denial of the goal is a list of choices, none of which may have a picture.

    Parameters
    ----------
    facts
        The facts.
    goal
        The plain fact.
    vocabulary
        Relations of the ontology.
    deadline
        Time limit.

    Returns
    -------
    bool
        True if it holds.

    Raises
    ------
    OutOfTimeError
        If the deadline passes first.
    """
    return not consistent(demands_of_facts(vocabulary, [*facts, replace(goal, positive=False)]), deadline)


def needed_facts(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: Deadline) -> list[Fact]:
    """Return a minimal set of facts that imply a goal.

    Parameters
    ----------
    facts
        Facts that all together imply it.
    goal
        The plain fact.
    vocabulary
        Relations of the ontology.
    deadline
        Time limit.

    Returns
    -------
    list of Fact
        The needed facts, in order.

    Raises
    ------
    OutOfTimeError
        If the deadline passes first.
    """
    found = minimal_subset(facts, lambda chosen: chosen if follows(chosen, goal, vocabulary, deadline) else None)
    return list(found.items)


def derive_by_cases(facts: Sequence[Fact], goal: Fact, vocabulary: Relations, deadline: Deadline) -> Derivation | None:
    """Return a proof of a plain fact from facts with choices.

    Parameters
    ----------
    facts
        The facts.
    goal
        The plain fact.
    vocabulary
        Relations of the ontology.
    deadline
        Time limit.

    Returns
    -------
    Derivation or None
        A proof that rests on a minimal set of facts, or None if the goal does not follow.

    Raises
    ------
    OutOfTimeError
        If the deadline passes first.
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
    """A search for a proof of one goal from few facts, which splits choices until orders alone settle every case."""

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
            raise OutOfTimeError("time limit reached before every case was proved")
        orders = self._orders(assumed)
        cycle = orders.cycle()
        if cycle is not None:
            given = len(self._facts)
            leaves = [_leaf(self._facts[k]) if k < given else _leaf(assumed[k - given].claim, True) for k in cycle]
            assumptions = [str(leaf.claim) for leaf in leaves if leaf.rule is Rule.ASSUMED]
            return Proof(ImpossibleCase(" and ".join(assumptions)), Rule.CONTRADICTION, tuple(leaves))
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
