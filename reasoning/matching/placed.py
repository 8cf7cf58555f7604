"""A matching problem in which what is absent has a place all the same, at which nothing was perceived.

To the engines the places are further things. In the answer whoever is at one is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.matching.posterior import Posterior
from deixis.reasoning.matching.problem import UNMATCHED, Problem

AWAY = 0.1
"""How probable it is that an absent object is at none of the places, and that facts about it say nothing."""

NEVER = -1e6
"""What it is worth to leave out what is known to be there."""


@dataclass(frozen=True, eq=False)
class Placed:
    """``bare`` has the n2 perceived things alone; to ``problem`` places are added behind them, if there are any."""

    bare: Problem
    problem: Problem

    def without(self, fact: int) -> Placed:
        """The same but for one fact."""
        kept = np.arange(len(self.bare.ends)) != fact
        ends, kinds = self.bare.ends[kept], self.bare.kinds[kept]
        return Placed(replace(self.bare, ends=ends, kinds=kinds), replace(self.problem, ends=ends, kinds=kinds))

    def folded(self, assignment: NDArray[np.int64]) -> NDArray[np.int64]:
        """A map of ``problem`` as one of ``bare``: whoever is at a place is left out."""
        result: NDArray[np.int64] = np.where(assignment < self.bare.unary.shape[1], assignment, UNMATCHED)
        return result

    def folded_posterior(self, found: Posterior) -> Posterior:
        """The probabilities of ``bare`` from those of ``problem``: places are summed over."""
        n2, marginals = self.bare.unary.shape[1], found.marginals
        left_out = marginals[:, n2:].sum(axis=1, keepdims=True)
        return replace(found, marginals=np.concatenate([marginals[:, :n2], left_out], axis=1))

    def best_with(self, assignment: NDArray[np.int64], deadline: float = math.inf) -> float:
        """The highest value of ``problem`` with these matches (n1,), what is left out being anywhere but at a thing."""
        from deixis.reasoning.matching.exact import exact

        left_out = assignment == UNMATCHED
        if not left_out.any() or self.problem is self.bare:
            return self.problem.value(assignment)
        unary, n2 = np.full_like(self.problem.unary, -np.inf), self.bare.unary.shape[1]
        matched = np.flatnonzero(~left_out)
        unary[matched, assignment[matched]] = self.problem.unary[matched, assignment[matched]]
        unary[left_out, n2:] = self.problem.unary[left_out, n2:]
        absent = np.where(left_out, self.problem.absent, NEVER)
        return exact(replace(self.problem, unary=unary, absent=absent), deadline).value


def placed(
    ends: NDArray[np.int64],
    kinds: NDArray[np.int64],
    tables: NDArray[np.float32],
    unary: NDArray[np.float64],
    absent: NDArray[np.float64],
) -> Placed:
    """As for :class:`Problem`, but that ``tables`` (k, n2 + places, n2 + places) may have places behind the things.

    What it is worth to leave an object out is spread evenly over the places, but for ``AWAY``.

    >>> tables = np.zeros((1, 3, 3), np.float32)
    >>> found = placed(np.array([[0, 1]]), np.array([0]), tables, np.zeros((2, 1)), np.zeros(2))
    >>> np.exp(found.problem.unary).round(2).tolist(), np.exp(found.problem.absent).round(2).tolist()
    ([[1.0, 0.45, 0.45], [1.0, 0.45, 0.45]], [0.1, 0.1])
    """
    n2 = unary.shape[1]
    places = tables.shape[1] - n2
    bare = Problem(ends, kinds, tables[:, :n2, :n2], unary, absent)
    if not places:
        return Placed(bare, bare)
    each = np.repeat(absent[:, None] + math.log((1 - AWAY) / places), places, axis=1)
    away = absent + math.log(AWAY)
    return Placed(bare, Problem(ends, kinds, tables, np.concatenate([unary, each], axis=1), away))
