"""Candidate groundings: the maps that the evidence leaves, each with its probability.

Objects that the description treats alike can be exchanged, so that k of them have k! maps. Such a *group* is stored
once: a row gives its members things in one order, and represents every order, all equally probable. A question about a
member takes it out of its group (:meth:`Candidates.pinned`), which multiplies the rows by k, not by k!.
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
from deixis.reasoning.grounding.matching.posterior.exchangeable import exchangeable
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

if TYPE_CHECKING:
    from deixis.reasoning.grounding.matching.search.exact import Maps

MAX_LISTED_MAPS = 5_000
"""Maximum number of maps that are listed one by one; beyond it, interchangeable objects are stored as groups."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """Possible maps of n1 objects to things, with their probabilities. Equal maps are merged.

    Attributes
    ----------
    assignments
        k maps, shape (k, n1), with ``UNMATCHED`` for objects that are left out.
    weights
        Probabilities, shape (k,); they are normalised.
    groups
        Disjoint sets of two or more objects whose things can be permuted in every row.
    complete
        Whether all maps within the margin are listed.

    Raises
    ------
    SettingError
        The shapes do not fit, there is no candidate, or the weights are negative or all 0.
    """

    assignments: NDArray[np.int64]
    weights: NDArray[np.float64]
    groups: tuple[tuple[int, ...], ...] = ()
    complete: bool = True

    def __post_init__(self) -> None:
        if self.assignments.ndim != 2 or self.weights.shape != self.assignments.shape[:1]:
            raise SettingError(
                f"`assignments` must have shape (k, n1), and `weights` shape (k,), "
                f"got {self.assignments.shape} and {self.weights.shape}"
            )
        if not len(self.weights) or not (self.weights >= 0).all() or not 0 < self.weights.sum() < np.inf:
            raise SettingError("`weights` must have at least one entry, each at least 0, and a sum above 0")
        members = [i for group in self.groups for i in group]
        if len(set(members)) != len(members) or any(not 0 <= i < self.assignments.shape[1] for i in members):
            raise SettingError(f"`groups` must be disjoint sets of objects, got {self.groups}")
        maps, inverse = np.unique(self._in_order(), axis=0, return_inverse=True)
        weights = np.bincount(inverse.ravel(), self.weights, len(maps))
        object.__setattr__(self, "assignments", maps)
        object.__setattr__(self, "weights", weights / weights.sum())

    def _in_order(self) -> NDArray[np.int64]:
        """Return the rows with the things of every group sorted, so that different rows represent different maps."""
        rows = self.assignments.copy()
        for group in self.groups:
            rows[:, list(group)] = np.sort(rows[:, list(group)], axis=1)
        return rows

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.weights)

    @cached_property
    def bits(self) -> float:
        """Entropy of the candidates in bits, including permutations.

        >>> Candidates(np.array([[0, 1, 2]]), np.ones(1), groups=((0, 1, 2),)).bits == math.log2(6)
        True
        """
        positive = self.weights[self.weights > 0]
        rows = -float(positive @ np.log2(positive))
        return max(0.0, rows + float(self.weights @ self._log_orders) / math.log(2))

    @cached_property
    def count(self) -> int:
        """Number of maps, including permutations."""
        return sum(self._orders(row) for row in self.assignments)

    @cached_property
    def _log_orders(self) -> NDArray[np.float64]:
        return np.array([math.log(self._orders(row)) for row in self.assignments])

    def _orders(self, row: NDArray[np.int64]) -> int:
        """Return the number of different ways to give the things of a row to the members of each group."""
        total = 1
        for members in self.groups:
            total *= math.factorial(len(members)) // math.factorial(int((row[list(members)] == UNMATCHED).sum()))
        return total

    @property
    def best(self) -> NDArray[np.int64]:
        """Most probable map, shape (n1,); the first of equally probable ones."""
        found: NDArray[np.int64] = self.assignments[np.argmax(np.round(self.weights, 12))]
        return found

    @cached_property
    def undecided(self) -> tuple[int, ...]:
        """Objects that are not the same thing in all candidates."""
        varying = set(np.flatnonzero((self.assignments != self.assignments[:1]).any(axis=0)).tolist())
        for group in self.groups:
            if len({*self.assignments[0, list(group)].tolist()}) > 1:
                varying |= {*group}
        return tuple(sorted(varying))

    @property
    def likeliest_shares(self) -> NDArray[np.float64]:
        """Probability of each object's match in the most probable map, shape (n1,)."""
        shares: NDArray[np.float64] = self.weights @ (self.assignments == self.best)
        for group in self.groups:
            members = list(group)
            shares[members] /= max(1, len({*self.best[members].tolist()}))
        return shares

    @cached_property
    def stand_ins(self) -> tuple[int, ...]:
        """Objects to ask about: all except those beyond the first two of each group, which are like these."""
        skipped = {i for group in self.groups for i in sorted(group)[2:]}
        return tuple(i for i in range(self.assignments.shape[1]) if i not in skipped)

    def pinned(self, objects: Iterable[int]) -> Candidates:
        """Return the same candidates with ``objects`` in no group, which may take more rows.

        Parameters
        ----------
        objects
            Positions of objects.

        Returns
        -------
        Candidates
            Candidates with the same maps.
        """
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

    def select(self, rows: NDArray[np.bool_]) -> Candidates:
        """Return the candidates of some rows.

        Parameters
        ----------
        rows
            Mask of the rows to keep, shape (k,).

        Returns
        -------
        Candidates
            The rows with their weights and the same groups.

        Raises
        ------
        SettingError
            The mask is empty.
        """
        return Candidates(self.assignments[rows], self.weights[rows], self.groups, self.complete)


def candidates_of(
    problem: Problem, deadline: Deadline = Deadline.never(), *, margin: float = 0.0, limit: int = MAX_LISTED_MAPS
) -> Candidates:
    """Return the maps whose values are close to the best, with weights exp(value).

    Where there are more than ``limit``, interchangeable objects get the things of the best map and are stored as
    groups; ``complete`` is then False, as it is where the deadline was reached.

    Parameters
    ----------
    problem
        The matching problem.
    deadline
        End of the time limit.
    margin
        Largest difference from the best value, in nats.
    limit
        Maximum number of listed maps, before groups are formed.

    Returns
    -------
    Candidates
        The maps, best first, with their weights and groups.

    Examples
    --------
    >>> none = np.zeros((0, 2), np.int64)
    >>> alike = Problem(none, none[:, 0], np.zeros((0, 9, 9), np.float32), np.ones((9, 9)), np.zeros(9))
    >>> found = candidates_of(alike, limit=100)
    >>> len(found), found.count, found.complete
    (1, 362880, False)
    """
    from deixis.reasoning.grounding.matching.search.exact import maps_within

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
