"""The alignment with the largest total, by branch and bound over partial one-to-one maps; compiled.

An object's potential for a perceived thing is what it has for certain (unary evidence and facts to objects placed
already) plus half of the best that each fact to an object not yet placed could give. Half a fact's best from either
end is never less than what it can give, so the placed total plus every open object's best potential bounds the total
from above. Potentials are kept up to date as objects are placed. Depth first, best potential first.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import Fact, RelationGraph
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.alignment_kernels import advance, climb, value
from deixis.reasoning.evidence import UNMATCHED, Evidence

CHUNK = 100_000
"""Nodes of the search between two looks at the clock."""

MAX_CELLS = 30_000_000
"""Potentials that the search may hold (objects x objects x perceived things); beyond, it only improves locally."""

SLACK = 1e-9
"""Totals nearer than this count as equal: far below half of the lightest hedge, far above rounding."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """The best assignment found (n1,), its objective, and whether nothing better exists."""

    assignment: NDArray[np.int64]
    value: float
    proved: bool


class Search:
    """One alignment problem, prepared once and solved under changing restrictions.

    The objective is the evidence's total, then the number of matched objects, then ``preference`` (n1, n2), of any
    scale, each counting only where those before it are equal.
    """

    def __init__(self, evidence: Evidence, preference: NDArray[np.float64]) -> None:
        n1, n2 = evidence.allowed.shape
        self._shape = n1, n2
        self._gains = evidence.degree_table * evidence.description.weights[evidence.facts][:, None]
        self._names = evidence.names.astype(np.int64)
        self._ends = np.stack(
            [evidence.description.subjects[evidence.facts], evidence.description.objects[evidence.facts]], axis=1
        ).astype(np.int64)
        spread = max(float(np.abs(preference).max(initial=0.0)) * max(n1, 1), 1e-300)
        self._unary = evidence.bonus + 1e-6 + preference / spread * 1e-7
        self._allowed = evidence.allowed
        self._best_as = _best_gains(self._gains, self._names)
        self._first, self._incident = _incidence(self._ends, n1)
        self._order = _order(n1, self._ends)

    def value(self, assignment: NDArray[np.int64]) -> float:
        """The objective of an assignment."""
        return float(value(assignment, self._gains, self._names, self._ends, self._unary))

    def improve(self, assignment: NDArray[np.int64]) -> NDArray[np.int64]:
        """Moves and swaps, each the best there is, until none helps."""
        improved = assignment.copy()
        climb(improved, self._gains, self._names, self._ends, self._first, self._incident, self._unary, self._allowed)
        return improved

    def solve(
        self,
        start: NDArray[np.int64],
        deadline: float,
        forbidden: tuple[int, int] | None = None,
        floor: float = -np.inf,
    ) -> Optimum:
        """The best assignment, beginning from ``start``, until ``deadline`` (``time.perf_counter``).

        ``forbidden`` excludes one pair (``start`` must not have it). Assignments of at most ``floor`` are not looked
        for: ``start`` comes back where there is none better.
        """
        allowed = self._allowed
        if forbidden is not None:
            allowed = allowed.copy()
            allowed[forbidden] = False
        best = start.copy()
        value = max(self.value(best), floor)
        n1, n2 = self._shape
        if n1 == 0 or n2 == 0:
            return Optimum(best, value, proved=True)
        if n1 * n1 * n2 > MAX_CELLS:
            return Optimum(best, value, proved=False)
        state = _State(self, allowed, value, best)
        proved = state.run(deadline)
        return Optimum(best, float(state.value[0]), proved)


def warm() -> None:
    """Compiles the search, or loads it compiled: seconds the first time, later a fraction of one."""
    evidence = Evidence(*_tiny())
    search = Search(evidence, np.ones((2, 2)))
    search.solve(search.improve(np.array([1, 0])), time.perf_counter() + 1.0)


def _tiny() -> tuple[RelationGraph, RelationGraph, NDArray[np.bool_], NDArray[np.float64]]:
    relations = default_ontology().relations
    exact = relations["exactly_left"]
    facts = [Fact("a", (exact,), "b"), Fact("b", (relations[exact.inverse],), "a")]
    graph = RelationGraph.from_facts(relations, ["a", "b"], facts)
    return graph, graph, np.ones((2, 2), dtype=bool), np.zeros((2, 2))


class _State:
    """The stack of a running search, so that it can be stopped and resumed."""

    def __init__(self, search: Search, allowed: NDArray[np.bool_], value: float, best: NDArray[np.int64]) -> None:
        n1, n2 = allowed.shape
        self.value = np.array([value])
        potentials = np.zeros((n1 + 1, n1, n2))
        potentials[0] = search._unary
        for fact, (s, o) in enumerate(search._ends):
            potentials[0, s] += search._best_as[0, fact] / 2
            potentials[0, o] += search._best_as[1, fact] / 2
        self._arguments = (
            search._gains,
            search._names,
            search._ends,
            search._first,
            search._incident,
            search._best_as,
            search._order,
            allowed,
            potentials,
            np.zeros(n1 + 1),  # placed totals
            np.full((n1, n2 + 1), -1, dtype=np.int64),  # candidates by depth, best first
            np.full(n1, -1, dtype=np.int64),  # position among them, -1: not opened
            np.full(n1, UNMATCHED, dtype=np.int64),  # current assignment
            np.zeros(n2, dtype=np.bool_),  # taken
            np.zeros(1, dtype=np.int64),  # depth
            self.value,
            best,
        )

    def run(self, deadline: float) -> bool:
        while not advance(*self._arguments, CHUNK, SLACK):
            if time.perf_counter() > deadline:
                return False
        return True


def _best_gains(gains: NDArray[np.float64], names: NDArray[np.int64]) -> NDArray[np.float64]:
    """The best that a fact can give with a perceived thing as its subject, or object: shape (2, facts, n2)."""
    n2 = len(names)
    best = np.zeros((2, len(gains), n2))
    if n2 < 2 or len(gains) == 0:
        return best
    distinct, inverse = np.unique(gains, axis=0, return_inverse=True)
    for row, gain in enumerate(distinct):
        table = gain[names]
        np.fill_diagonal(table, 0.0)
        best[0, inverse.ravel() == row] = table.max(axis=1)
        best[1, inverse.ravel() == row] = table.max(axis=0)
    return best


def _incidence(ends: NDArray[np.int64], n1: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The facts of each object, as a compressed list: object i's are ``incident[first[i]:first[i + 1]]``."""
    objects = ends.T.ravel()
    facts = np.tile(np.arange(len(ends)), 2)
    order = np.argsort(objects, kind="stable")
    first = np.concatenate([[0], np.cumsum(np.bincount(objects, minlength=n1))]).astype(np.int64)
    return first, facts[order].astype(np.int64)


def _order(n1: int, ends: NDArray[np.int64]) -> NDArray[np.int64]:
    """Objects in the order of placing: next the one with most facts to those placed, then with most facts."""
    weight = np.zeros((n1, n1), dtype=np.int64)
    np.add.at(weight, (ends[:, 0], ends[:, 1]), 1)
    weight += weight.T
    total = weight.sum(axis=1)
    linked = np.zeros(n1, dtype=np.int64)
    free = np.ones(n1, dtype=bool)
    order = []
    for _ in range(n1):
        candidates = np.flatnonzero(free)
        best = candidates[np.lexsort((-total[candidates], -linked[candidates]))[0]]
        order.append(best)
        free[best] = False
        linked += weight[best]
    return np.array(order, dtype=np.int64)
