"""Candidate groundings: the maps that the evidence leaves, each with its probability.

Objects that the description treats alike could be exchanged at will, so that k of them stand for k! maps. Such a
*group* is kept as one: a row gives its members things in some order, and stands for every order, all as probable. A
question about a member takes it out of its group (:meth:`Candidates.pinned`), which multiplies rows by k, never by k!.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.matching.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

if TYPE_CHECKING:
    from deixis.reasoning.grounding.matching.exact import Maps

MAX_LISTED_MAPS = 5_000
"""Maps that are listed one by one; beyond, interchangeable objects are held as groups."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """k maps of n1 objects to things, ``UNMATCHED`` for what is left out, and their probabilities; equal ones are one.

    ``groups`` are disjoint sets of two and more objects whose things may be permuted in every row. ``complete``: no
    other map is as good. Weights need not be normalised: they are. Raises SettingError for arrays that do not fit, no
    candidate, or weights of which one is below 0 or all are 0.
    """

    assignments: NDArray[np.int64]  # (k, n1)
    weights: NDArray[np.float64]  # (k,)
    groups: tuple[tuple[int, ...], ...] = ()
    complete: bool = True

    def __post_init__(self) -> None:
        if self.assignments.ndim != 2 or self.weights.shape != self.assignments.shape[:1]:
            raise SettingError("candidates are an array of maps (k, n1) and as many weights (k,)")
        if not len(self.weights) or not (self.weights >= 0).all() or not 0 < self.weights.sum() < np.inf:
            raise SettingError("there has to be a candidate, and the weights are at least 0 and have a sum above 0")
        members = [i for group in self.groups for i in group]
        if len(set(members)) != len(members) or any(not 0 <= i < self.assignments.shape[1] for i in members):
            raise SettingError("groups are disjoint sets of objects")
        maps, inverse = np.unique(self._in_order(), axis=0, return_inverse=True)
        weights = np.bincount(inverse.ravel(), self.weights, len(maps))
        object.__setattr__(self, "assignments", maps)
        object.__setattr__(self, "weights", weights / weights.sum())

    def _in_order(self) -> NDArray[np.int64]:
        """Return the rows with the things of every group sorted, so that no two of them stand for the same maps."""
        rows = self.assignments.copy()
        for group in self.groups:
            rows[:, list(group)] = np.sort(rows[:, list(group)], axis=1)
        return rows

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.weights)

    @cached_property
    def bits(self) -> float:
        """The entropy of the candidates, permutations included.

        >>> Candidates(np.array([[0, 1, 2]]), np.ones(1), groups=((0, 1, 2),)).bits == math.log2(6)
        True
        """
        positive = self.weights[self.weights > 0]
        rows = -float(positive @ np.log2(positive))
        return max(0.0, rows + float(self.weights @ self._log_orders) / math.log(2))

    @cached_property
    def count(self) -> int:
        """How many maps there are, permutations included."""
        return sum(self._orders(row) for row in self.assignments)

    @cached_property
    def _log_orders(self) -> NDArray[np.float64]:
        return np.array([math.log(self._orders(row)) for row in self.assignments])

    def _orders(self, row: NDArray[np.int64]) -> int:
        """Return different ways to give the things of a row to the members of each group."""
        total = 1
        for members in self.groups:
            total *= math.factorial(len(members)) // math.factorial(int((row[list(members)] == UNMATCHED).sum()))
        return total

    @property
    def best(self) -> NDArray[np.int64]:
        """The most probable map, shape (n1,); the first among equals."""
        found: NDArray[np.int64] = self.assignments[np.argmax(np.round(self.weights, 12))]
        return found

    @cached_property
    def undecided(self) -> tuple[int, ...]:
        """The objects that are not the same thing in all candidates."""
        varying = set(np.flatnonzero((self.assignments != self.assignments[:1]).any(axis=0)).tolist())
        for group in self.groups:
            if len({*self.assignments[0, list(group)].tolist()}) > 1:
                varying |= {*group}
        return tuple(sorted(varying))

    @property
    def likeliest_shares(self) -> NDArray[np.float64]:
        """How probable it is that each object is what it is in the most probable map, shape (n1,)."""
        shares: NDArray[np.float64] = self.weights @ (self.assignments == self.best)
        for group in self.groups:
            members = list(group)
            shares[members] /= max(1, len({*self.best[members].tolist()}))
        return shares

    @cached_property
    def stand_ins(self) -> tuple[int, ...]:
        """The objects of which questions are worth asking: of each group the first two, for the others are alike."""
        skipped = {i for group in self.groups for i in sorted(group)[2:]}
        return tuple(i for i in range(self.assignments.shape[1]) if i not in skipped)

    def pinned(self, objects: Iterable[int]) -> Candidates:
        """Return the same candidates in as many rows as it takes to have these objects in no group."""
        result = self
        for i in objects:
            group = next((group for group in result.groups if i in group), None)
            if group is not None:
                rows, others = np.arange(len(result)), tuple(j for j in group if j != i)
                swapped = []
                for j in group:
                    exchanged = result.assignments.copy()
                    exchanged[rows, i], exchanged[rows, j] = result.assignments[rows, j], result.assignments[rows, i]
                    swapped.append(exchanged)
                left = tuple(other for other in result.groups if other != group)
                groups = (*left, others) if len(others) > 1 else left
                weights = np.tile(result.weights / len(group), len(group))
                result = Candidates(np.concatenate(swapped), weights, groups, result.complete)
        return result

    def kept(self, rows: NDArray[np.bool_]) -> Candidates:
        """Return only some of the rows; raises SettingError for none."""
        return Candidates(self.assignments[rows], self.weights[rows], self.groups, self.complete)


def candidates_of(
    problem: Problem, deadline: Deadline = Deadline.never(), *, margin: float = 0.0, limit: int = MAX_LISTED_MAPS
) -> Candidates:
    """Return the maps worth at most ``margin`` less than the best, weighted by the exponential of their values.

    Where there are more than ``limit``, the things of interchangeable objects are taken as those of the best map, and
    held as groups; ``complete`` is then False, as it is where the deadline struck.

    >>> none = np.zeros((0, 2), np.int64)
    >>> alike = Problem(none, none[:, 0], np.zeros((0, 9, 9), np.float32), np.ones((9, 9)), np.zeros(9))
    >>> found = candidates_of(alike, limit=100)
    >>> len(found), found.count, found.complete
    (1, 362880, False)
    """
    from deixis.reasoning.grounding.matching.exact import maps_within

    found = maps_within(problem, margin, deadline, limit=limit)
    if found.complete:
        return _weighted(found, (), complete=True)
    groups = exchangeable(problem)
    if not groups or not found.limited:
        return _weighted(found, (), complete=False)
    best = found.assignments[0]
    allowed = problem.allowed.copy()
    for i in (i for group in groups for i in group):
        allowed[i] = np.arange(allowed.shape[1]) == best[i]
    rest = maps_within(replace(problem, allowed=allowed), margin, deadline, limit=limit)
    return _weighted(rest, groups, complete=False)


def _weighted(maps: Maps, groups: tuple[tuple[int, ...], ...], complete: bool) -> Candidates:
    return Candidates(maps.assignments, np.exp(maps.values - maps.values.max()), groups, complete)
