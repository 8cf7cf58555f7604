"""The matching problem as arrays: unary evidence of matches, evidence of facts for pairs, and costs of absence.

A partial one-to-one map gives each of n1 objects one of n2 perceived things, or none. Its value is the sum of the unary
evidence of each match, of the table entry of every fact whose two objects are matched, and of the cost of each object
that is left out. All are log-likelihood ratios against chance in nats, so that they add up to the logarithm of a
posterior, up to a constant.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError

UNMATCHED = -1
"""Thing of an object that is left out, in an assignment."""

PLACES_PER_THING, MIN_PLACES, MAX_PLACES = 3.0, 200, 900
"""Approximate number of places of absent objects for each thing of a scene, and their minimum and maximum number."""


class MatchingError(DeixisError, ValueError):
    """Error for arrays that are not a valid matching problem, or not a valid map of it."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Matching problem of m facts between n1 objects, and n2 things, with k tables that facts share.

    Attributes
    ----------
    ends
        Subject and object of each fact, two different objects, shape (m, 2).
    kinds
        Table of each fact, shape (m,).
    tables
        Evidence of a fact for each pair (subject's thing, object's thing), shape (k, n2, n2), finite.
    unary
        Evidence of each match without facts, shape (n1, n2), finite; ignored where not allowed.
    absent
        Value of leaving each object out, shape (n1,), finite, usually negative.
    allowed
        Matches that a map may make, shape (n1, n2), or one value for all; by default, all.
    places
        Function of the approximate maximum number g of places (by default ``MAX_PLACES``). It computes the likelihood
        ratios of a fact with one end at each place and the other at each thing, shape (2k, g, n2): the subject at the
        place, then the object. Absent objects are at such places when marginals are sampled. None where the facts about
        absent objects count as by chance.

    Raises
    ------
    MatchingError
        A shape does not fit, an index is out of range, or a number is not finite.
    """

    ends: NDArray[np.int64]
    kinds: NDArray[np.int64]
    tables: NDArray[np.float32]
    unary: NDArray[np.float64]
    absent: NDArray[np.float64]
    allowed: NDArray[np.bool_] = field(default_factory=lambda: np.array(True))
    places: Callable[..., NDArray[np.float32]] | None = None

    def __post_init__(self) -> None:
        if self.allowed.ndim == 0:  # one value for all matches
            object.__setattr__(self, "allowed", np.full(self.unary.shape, bool(self.allowed)))
        self._check_shapes()
        n1 = len(self.absent)
        if ((self.ends < 0) | (self.ends >= n1)).any() or (self.ends[:, 0] == self.ends[:, 1]).any():
            raise MatchingError(f"`ends` must be two different objects from 0 to {n1 - 1} for each fact")
        if ((self.kinds < 0) | (self.kinds >= len(self.tables))).any():
            raise MatchingError(f"`kinds` must be tables from 0 to {len(self.tables) - 1}")
        if not all(np.isfinite(table).all() for table in self.tables):
            raise MatchingError("`tables` must be finite numbers")
        if not np.isfinite(self.absent).all():
            raise MatchingError("`absent` must be finite numbers")
        if not np.isfinite(self.unary).all():
            raise MatchingError("`unary` must be finite numbers; rule matches out with `allowed`")

    def _check_shapes(self) -> None:
        m, (n1, n2) = len(self.ends), self.unary.shape if self.unary.ndim == 2 else (-1, -1)
        wanted = {
            "ends": (m, 2),
            "kinds": (m,),
            "tables": (len(self.tables), n2, n2),
            "unary": (n1, n2),
            "absent": (n1,),
            "allowed": (n1, n2),
        }
        for name, shape in wanted.items():
            if getattr(self, name).shape != shape:
                raise MatchingError(f"`{name}` must have shape {shape}, got {getattr(self, name).shape}")

    @cached_property
    def compiled(self) -> Compiled:
        """Problem in the layout of compiled loops, computed once."""
        return compile_problem(self)

    def value(self, assignment: NDArray[np.int64]) -> float:
        """Return the value of a map; -inf if a match is not allowed.

        Parameters
        ----------
        assignment
            Thing of each object, with ``UNMATCHED`` for objects left out; shape (n1,).

        Returns
        -------
        float
            Value in nats.

        Examples
        --------
        >>> none = np.zeros((0, 2), np.int64)
        >>> problem = Problem(none, none[:, 0], np.zeros((0, 1, 1), np.float32), np.array([[2.0]]), np.array([-1.0]))
        >>> problem.value(np.array([0])), problem.value(np.array([UNMATCHED]))
        (2.0, -1.0)
        """
        matched = assignment != UNMATCHED
        objects = np.flatnonzero(matched)
        if not self.allowed[objects, assignment[objects]].all():
            return -math.inf
        p, q = assignment[self.ends[:, 0]], assignment[self.ends[:, 1]]
        both = (p != UNMATCHED) & (q != UNMATCHED)
        facts = self.tables[self.kinds[both], p[both], q[both]].sum(dtype=np.float64)
        return float(facts + self.unary[objects, assignment[objects]].sum() + self.absent[~matched].sum())

    def require_map(self, assignment: NDArray[np.int64]) -> None:
        """Raise MatchingError unless the array is a partial one-to-one map with allowed matches.

        Parameters
        ----------
        assignment
            Thing of each object, with ``UNMATCHED`` for objects left out; shape (n1,).

        Raises
        ------
        MatchingError
            The shape is wrong, a thing does not exist or is given to two objects, or a match is not allowed.
        """
        n1, n2 = self.unary.shape
        if assignment.shape != (n1,) or ((assignment < UNMATCHED) | (assignment >= n2)).any():
            raise MatchingError(
                f"a map must give each of {n1} objects a thing from 0 to {n2 - 1}, or {UNMATCHED}, "
                f"got {assignment.tolist()!r:.60}"
            )
        objects = np.flatnonzero(assignment != UNMATCHED)
        if len(set(assignment[objects].tolist())) != len(objects):
            raise MatchingError(f"a map must give each thing to one object only, got {assignment.tolist()!r:.60}")
        if not self.allowed[objects, assignment[objects]].all():
            raise MatchingError("a map must not make a match that `allowed` rules out")


def empty_tables(kinds: int, things: int) -> NDArray[np.float32]:
    """Allocate the tables of a problem, filled with 0, so that compiling the problem does not copy them.

    They are a view of the array that :class:`Compiled` holds; tables and a copy would take half as much memory again.

    Parameters
    ----------
    kinds
        Number k of tables.
    things
        Number n2 of things.

    Returns
    -------
    ndarray
        Zeros of shape (k, n2, n2).
    """
    return np.zeros((2 * kinds, things + 1, things + 1), np.float32)[:kinds, :things, :things]


class Compiled(NamedTuple):
    """Problem in the layout of compiled loops. Each fact has two slots, one for each end.

    The slots of object i are ``first[i]`` to ``first[i + 1]``. The diagonals of the tables, which no map reads, are 0.
    """

    tables: NDArray[np.float32]  # (2k, n2 + 1, n2 + 1): each table as it is, then each transposed
    unary: NDArray[np.float64]  # (n1, n2 + 1): finite; the last column is the value of leaving the object out
    allowed: NDArray[np.bool_]  # (n1, n2 + 1): allowed matches; the last column is true
    first: NDArray[np.int64]  # (n1 + 1,)
    other: NDArray[np.int64]  # (2m,): the object at the other end
    kind: NDArray[np.int64]  # (2m,): the table, whose rows are the things of the slot's object
    twin: NDArray[np.int64]  # (2m,): the same fact's slot at the other end
    away: NDArray[np.float32]  # (2m, n2 + 1): evidence of the fact if the slot's object is absent, by the other's thing
    # of (0, n2 + 1) if facts about absent objects count 0; only sampling reads it


def compile_problem(problem: Problem) -> Compiled:
    """Return the problem in the layout of compiled loops.

    All arrays are in C order, because loops would be compiled again for another order.

    Parameters
    ----------
    problem
        The problem of m facts, n1 objects and n2 things.

    Returns
    -------
    Compiled
        Its arrays. Tables of :func:`empty_tables` are shared with the problem, others are copied.
    """
    k, n2, _ = problem.tables.shape
    m, n1 = len(problem.ends), len(problem.absent)
    tables = _allocation_of(problem.tables)
    if tables is None:
        tables = np.zeros((2 * k, n2 + 1, n2 + 1), dtype=np.float32)
        tables[:k, :n2, :n2] = problem.tables
    tables[:, np.arange(n2), np.arange(n2)] = 0.0
    for table, turned in zip(tables[:k], tables[k:], strict=True):
        turned[:] = table.T
    owner = problem.ends.T.ravel()
    order = np.argsort(owner, kind="stable")
    position = np.empty(2 * m, dtype=np.int64)
    position[order] = np.arange(2 * m)
    return Compiled(
        tables=tables,
        unary=np.ascontiguousarray(np.concatenate([problem.unary, problem.absent[:, None]], axis=1), dtype=np.float64),
        allowed=np.ascontiguousarray(np.concatenate([problem.allowed, np.ones((n1, 1), dtype=bool)], axis=1)),
        first=np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=n1))]).astype(np.int64),
        other=problem.ends[:, ::-1].T.ravel()[order].astype(np.int64),
        kind=np.concatenate([problem.kinds, problem.kinds + k])[order].astype(np.int64),
        twin=position[(order + m) % max(2 * m, 1)],
        away=np.zeros((0, n2 + 1), dtype=np.float32),
    )


def _allocation_of(tables: NDArray[np.float32]) -> NDArray[np.float32] | None:
    """Return the array that :func:`empty_tables` allocated for tables (k, n2, n2); None for other tables."""
    room, (k, n2, _) = tables.base, tables.shape
    if not isinstance(room, np.ndarray) or room.shape != (2 * k, n2 + 1, n2 + 1) or room.dtype != np.float32:
        return None
    return room if room.ctypes.data == tables.ctypes.data else None


def to_labels(assignment: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """Return a map with n2 for objects that are left out, as compiled loops need it.

    Parameters
    ----------
    assignment
        Thing of each object, shape (n1,), with ``UNMATCHED`` for objects that are left out.
    n2
        Number of things.

    Returns
    -------
    ndarray
        Thing of each object, or n2; shape (n1,).
    """
    return np.where(assignment == UNMATCHED, n2, assignment).astype(np.int64)


def to_assignment(labels: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """Return a map with ``UNMATCHED`` for objects that are left out, as a problem needs it.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), with n2 for objects that are left out.
    n2
        Number of things.

    Returns
    -------
    ndarray
        Thing of each object, or ``UNMATCHED``; shape (n1,).
    """
    return np.where(labels == n2, UNMATCHED, labels).astype(np.int64)
