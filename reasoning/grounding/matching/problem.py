"""The matching problem on plain arrays: what every fact and every object says for being which perceived thing.

A partial one-to-one map gives each of n1 objects one of n2 perceived things, or none. Its value is the sum of what
speaks for each match by itself, of what every fact with two matched ends says of the pair that they are matched to, and
of what it costs to leave an object out. All are log-likelihood ratios against chance (natural logarithm), so that they
add up to the logarithm of a posterior, up to a constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.errors import DeixisError

UNMATCHED = -1


class MatchingError(DeixisError, ValueError):
    """Arrays that state no matching problem, or a map that is none of its maps."""


@dataclass(frozen=True, eq=False)
class Problem:
    """m facts between n1 objects, and n2 perceived things. Facts that say the same share a row of ``tables``.

    Raises MatchingError where a shape does not fit, an index leads nowhere, or a number is not what it has to be.
    """

    ends: NDArray[np.int64]  # (m, 2): subject and object, different ones
    kinds: NDArray[np.int64]  # (m,): which table a fact reads
    tables: NDArray[np.float32]  # (k, n2, n2): what a fact says of the pair (subject's thing, object's thing); finite
    unary: NDArray[np.float64]  # (n1, n2): what speaks for a match by itself, finite; not read where not allowed
    absent: NDArray[np.float64]  # (n1,): what leaving the object out is worth, finite, usually negative
    allowed: NDArray[np.bool_] = field(default_factory=lambda: np.array(True))  # (n1, n2): which matches a map may make

    def __post_init__(self) -> None:
        if self.allowed.ndim == 0:  # one value for all matches
            object.__setattr__(self, "allowed", np.full(self.unary.shape, bool(self.allowed)))
        self._check_shapes()
        n1 = len(self.absent)
        if ((self.ends < 0) | (self.ends >= n1)).any() or (self.ends[:, 0] == self.ends[:, 1]).any():
            raise MatchingError(f"a fact holds between two different objects, counted from 0 to {n1 - 1}")
        if ((self.kinds < 0) | (self.kinds >= len(self.tables))).any():
            raise MatchingError(f"a fact reads one of the tables, counted from 0 to {len(self.tables) - 1}")
        if not all(np.isfinite(table).all() for table in self.tables):
            raise MatchingError("what a fact says of a pair has to be a finite number")
        if not np.isfinite(self.absent).all():
            raise MatchingError("what leaving an object out is worth has to be a finite number")
        if not np.isfinite(self.unary).all():
            raise MatchingError("what speaks for a match has to be a finite number; rule matches out by 'allowed'")

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
                raise MatchingError(f"the array '{name}' has to have shape {shape}, not {getattr(self, name).shape}")

    @cached_property
    def compiled(self) -> Compiled:
        """The problem as compiled loops read it: laid out once for all that look at it."""

        return compile_problem(self)

    def value(self, assignment: NDArray[np.int64]) -> float:
        """The value of one map, shape (n1,), ``UNMATCHED`` for what is left out; -inf for one that is not allowed.

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
        """Raises MatchingError unless the array is a partial one-to-one map that nothing rules out."""
        n1, n2 = self.unary.shape
        if assignment.shape != (n1,) or ((assignment < UNMATCHED) | (assignment >= n2)).any():
            raise MatchingError(f"a map gives each of {n1} objects a thing from 0 to {n2 - 1}, or {UNMATCHED}")
        objects = np.flatnonzero(assignment != UNMATCHED)
        if len(np.unique(assignment[objects])) != len(objects):
            raise MatchingError("a map gives no thing to two objects")
        if not self.allowed[objects, assignment[objects]].all():
            raise MatchingError("a map makes no match that is ruled out")


def empty_tables(kinds: int, things: int) -> NDArray[np.float32]:
    """Return room for the tables of a problem (k, n2, n2), to be filled in, that compiling it does not copy.

    It is part of what :class:`Compiled` holds, which takes two thirds of the memory of tables and a copy.
    """
    return np.zeros((2 * kinds, things + 1, things + 1), np.float32)[:kinds, :things, :things]


class Compiled(NamedTuple):
    """Slots of object i: ``first[i]`` to ``first[i + 1]``. The diagonals of the tables, which no map reads, are 0."""

    tables: NDArray[np.float32]  # (2k, n2 + 1, n2 + 1): each table as it is, then each transposed
    unary: NDArray[np.float64]  # (n1, n2 + 1): finite; the last column is what leaving the object out is worth
    allowed: NDArray[np.bool_]  # (n1, n2 + 1): which matches a map may make; the last column is true
    first: NDArray[np.int64]  # (n1 + 1,)
    other: NDArray[np.int64]  # (2m,): the object at the other end
    kind: NDArray[np.int64]  # (2m,): which table, the owner's thing its row
    twin: NDArray[np.int64]  # (2m,): the same fact's slot at the other end


def compile_problem(problem: Problem) -> Compiled:
    """Return the problem as compiled loops read it.

    All arrays are in C order, whatever the order of the problem's: loops are compiled anew for another one.
    """
    k, n2, _ = problem.tables.shape
    m, n1 = len(problem.ends), len(problem.absent)
    tables = _room_of(problem.tables)
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
    )


def _room_of(tables: NDArray[np.float32]) -> NDArray[np.float32] | None:
    """Return what :func:`empty_tables` made for tables (k, n2, n2), or None for others."""
    room, (k, n2, _) = tables.base, tables.shape
    if not isinstance(room, np.ndarray) or room.shape != (2 * k, n2 + 1, n2 + 1) or room.dtype != np.float32:
        return None
    return room if room.ctypes.data == tables.ctypes.data else None


def to_labels(assignment: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """A map with n2 for what is left out."""
    return np.where(assignment == UNMATCHED, n2, assignment).astype(np.int64)


def to_assignment(labels: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """A map with ``UNMATCHED`` for what is left out."""
    return np.where(labels == n2, UNMATCHED, labels).astype(np.int64)
