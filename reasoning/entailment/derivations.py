"""Derivations over bounds: every bound of a conclusion has a shortest path of facts, and paths become steps in words.

A path whose facts link the subject to the object is a chain: the composition of their relations in the rectangle
algebra, or transitivity where one word is all of it. A conclusion whose bounds go by different chains is their
conjunction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from deixis.ontology.graph import Fact
from deixis.ontology.relation import Reading, Relation, Relations
from deixis.reasoning.entailment.bounds import Bound, Bounds, Conjunction, Order, meaning
from deixis.reasoning.entailment.derivation import Derivation, Rule
from deixis.reasoning.entailment.paths import OrderPaths, Path

_TRIED = 40
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
        bounds: Bounds,
        assumed: int,
    ) -> None:
        self._vocabulary = vocabulary
        self._names = names
        self._premises = premises
        self._assumed = assumed
        self._bounds = bounds
        self.paths = OrderPaths(bounds, len(names))

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

    def chains(self, relation: Relation, subject: str, object: str) -> dict[Bound, Path] | None:
        """For every bound of a relation the facts that lead to it, as few as found; None where one has none."""
        stated = self._stated.get((subject, relation.bit, object))
        if stated is not None:
            return dict.fromkeys(meaning(relation)[0], (stated,))
        found = self._paths(self.paths, meaning(relation), self._index[subject], self._index[object])
        if found is None or len(set(found.values())) < 2:
            return found
        return self._fewer(found, relation, subject, object)

    @staticmethod
    def _paths(paths: OrderPaths, parts: Sequence[Conjunction], s: int, o: int) -> dict[Bound, Path] | None:
        if len(parts) != 1 or s == o:
            return None
        found: dict[Bound, Path] = {}
        for bound in parts[0]:
            path = paths.path(bound, s, o)
            if path is None:
                return None
            found[bound] = path
        return found

    def _fewer(self, found: dict[Bound, Path], relation: Relation, subject: str, object: str) -> dict[Bound, Path]:
        """One chain for all bounds where there is one; else the chains without superfluous facts."""
        ends = (relation, subject, object)
        used = sorted({premise for path in found.values() for premise in path})
        for path in sorted(set(found.values()), key=len):
            alone = self._among(path, *ends)
            if alone is not None:
                return alone
        if len(used) <= _TRIED:
            for premise in reversed(used):
                rest = self._among([other for other in used if other != premise], *ends)
                if rest is not None:
                    used, found = [other for other in used if other != premise], rest
        return found

    def _among(self, chosen: Sequence[int], relation: Relation, subject: str, object: str) -> dict[Bound, Path] | None:
        """The paths that use no other premises than these."""
        mask = np.zeros(len(self._premises), np.bool_)
        mask[list(chosen)] = True
        few = self._bounds.of_premises(mask)
        involved = dict.fromkeys([subject, object])
        for premise in chosen:
            involved.update(dict.fromkeys((self._premises[premise].subject, self._premises[premise].object)))
        place = np.zeros(len(self._names), np.int64)
        nodes = [self._index[name] for name in involved]
        place[nodes] = np.arange(len(nodes))
        n = len(self._names)
        tail, head = (points // n * len(nodes) + place[points % n] for points in (few.tail, few.head))
        paths = OrderPaths(replace(few, tail=tail, head=head), len(nodes))
        return self._paths(paths, meaning(relation), int(place[nodes[0]]), int(place[nodes[1]]))

    def derive(self, relation: Relation, subject: str, object: str) -> Derivation | None:
        """A derivation of the fact; None where no path leads to it."""
        found = self.chains(relation, subject, object)
        return None if found is None else self.of_chains(found, relation, subject, object)

    def of_chains(self, chains: dict[Bound, Path], relation: Relation, subject: str, object: str) -> Derivation:
        """The derivation whose bounds go by these chains."""
        groups: dict[Path, list[Bound]] = {}
        for bound, path in chains.items():
            groups.setdefault(path, []).append(bound)
        goal = Fact(subject, (relation,), object)
        if len(groups) == 1:
            return self._chain(goal, relation, next(iter(groups)))
        parts = [
            self._chain(claim, named, path)
            for path, bounds in groups.items()
            for claim, named in self._claims(bounds, subject, object)
        ]
        return Derivation(goal, Rule.CONJUNCTION, tuple(parts))

    def _claims(self, bounds: list[Bound], subject: str, object: str) -> list[tuple[Fact | Order, Relation | None]]:
        """A relation that says just these bounds, or every bound by itself."""
        for relation in self._vocabulary.of_reading(Reading.WIDE):
            if len(meaning(relation)) == 1 and set(meaning(relation)[0]) == set(bounds):
                return [(Fact(subject, (relation,), object), relation)]
        return [(Order(subject, object, bound), None) for bound in bounds]

    def _chain(self, claim: Fact | Order, relation: Relation | None, path: Path) -> Derivation:
        """One claim from the facts that link its subject to its object."""
        steps = self._steps(path, claim.subject)
        if relation is None:
            return Derivation(claim, Rule.MEANING if len(steps) == 1 else Rule.COMPOSITION, tuple(steps))
        wrapped = [_widened(step, relation) for step in steps]
        if all(step is not None for step in wrapped):
            if len(wrapped) == 1 and wrapped[0] is not None:
                return wrapped[0]
            if relation.transitive:
                return Derivation(claim, Rule.TRANSITIVITY, tuple(step for step in wrapped if step is not None))
        return Derivation(claim, Rule.MEANING if len(steps) == 1 else Rule.COMPOSITION, tuple(steps))

    def _steps(self, path: Path, start: str) -> list[Derivation]:
        """The premises of a path, each read in the direction in which it is passed."""
        steps, here = [], start
        for premise in path:
            fact = self._premises[premise]
            leaf = Derivation(fact, Rule.ASSUMED if premise >= self._assumed else Rule.STATED)
            onward = fact.subject == here
            steps.append(leaf if onward else self._turned(fact, leaf))
            here = fact.object if onward else fact.subject
        return steps

    def _turned(self, fact: Fact | Order, leaf: Derivation) -> Derivation:
        """The premise with its ends exchanged; an order of edges is the same claim from either end."""
        if isinstance(fact, Order):
            return Derivation(Order(fact.object, fact.subject, fact.bound.reversed()), leaf.rule)
        inverse = tuple(self._vocabulary[relation.inverse] for relation in fact.relations)
        return Derivation(Fact(fact.object, inverse, fact.subject, positive=fact.positive), Rule.INVERSE, (leaf,))


def _widened(step: Derivation, relation: Relation) -> Derivation | None:
    """The step as one of the relation: itself, or what it is a sub-property of; None where it is neither."""
    fact = step.fact
    if not isinstance(fact, Fact) or not fact.plain:
        return None
    if fact.relations[0] == relation:
        return step
    if relation.name in fact.relations[0].broader:
        return Derivation(Fact(fact.subject, (relation,), fact.object), Rule.SUB_PROPERTY, (step,))
    return None
