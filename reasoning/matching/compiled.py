"""The matching problem laid out for compiled loops: padded tables, and the facts of each object as a compressed list.

Things are counted from 0; the number n2 stands for "left out", so that every table has a row and a column for it, of
zeros, and no loop has to ask. Every fact is listed twice, once at each of its ends: such a *slot* reads its table with
the owner's thing as the row.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.matching.problem import UNMATCHED, Problem


class Compiled(NamedTuple):
    """Slots of object i: ``first[i]`` to ``first[i + 1]``. The diagonals of the tables, which no map reads, are 0."""

    tables: NDArray[np.float32]  # (2k, n2 + 1, n2 + 1): each table as it is, then each transposed
    unary: NDArray[np.float64]  # (n1, n2 + 1): the last column is what leaving the object out is worth
    first: NDArray[np.int64]  # (n1 + 1,)
    other: NDArray[np.int64]  # (2m,): the object at the other end
    kind: NDArray[np.int64]  # (2m,): which table, the owner's thing its row
    twin: NDArray[np.int64]  # (2m,): the same fact's slot at the other end


def compile_problem(problem: Problem) -> Compiled:
    """The problem as compiled loops read it."""
    k, n2, _ = problem.tables.shape
    m, n1 = len(problem.ends), len(problem.absent)
    tables = np.zeros((2 * k, n2 + 1, n2 + 1), dtype=np.float32)
    tables[:k, :n2, :n2] = problem.tables
    tables[:, np.arange(n2), np.arange(n2)] = 0.0
    tables[k:] = tables[:k].transpose(0, 2, 1)
    owner = problem.ends.T.ravel()
    order = np.argsort(owner, kind="stable")
    position = np.empty(2 * m, dtype=np.int64)
    position[order] = np.arange(2 * m)
    return Compiled(
        tables=tables,
        unary=np.concatenate([problem.unary, problem.absent[:, None]], axis=1).astype(np.float64),
        first=np.concatenate([[0], np.cumsum(np.bincount(owner, minlength=n1))]).astype(np.int64),
        other=problem.ends[:, ::-1].T.ravel()[order].astype(np.int64),
        kind=np.concatenate([problem.kinds, problem.kinds + k])[order].astype(np.int64),
        twin=position[(order + m) % max(2 * m, 1)],
    )


def to_labels(assignment: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """A map with n2 for what is left out."""
    return np.where(assignment == UNMATCHED, n2, assignment).astype(np.int64)


def to_assignment(labels: NDArray[np.int64], n2: int) -> NDArray[np.int64]:
    """A map with ``UNMATCHED`` for what is left out."""
    return np.where(labels == n2, UNMATCHED, labels).astype(np.int64)
