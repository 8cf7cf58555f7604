"""One-to-one assignment from a similarity matrix, and the graph similarity that it amounts to."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.matching.problem import UNMATCHED


def assign(matrix: NDArray[np.float64], allowed: NDArray[np.bool_]) -> NDArray[np.int64]:
    """The assignment of rows to columns with the largest sum (the Hungarian method, through scipy).

    ``matrix`` and ``allowed`` have shape (n1, n2). As many rows as possible are matched to allowed columns; the
    others are ``UNMATCHED``. Returns shape (n1,).

    >>> assign(np.array([[0.5, 0.5], [0.0, 0.5]]), np.ones((2, 2), dtype=bool)).tolist()
    [0, 1]
    """
    from scipy.optimize import linear_sum_assignment

    assignment = np.full(len(matrix), UNMATCHED, dtype=np.int64)
    if matrix.size == 0:
        return assignment
    reach = 1.0 + np.abs(matrix).max() * 2 * min(matrix.shape)
    rows, columns = linear_sum_assignment(np.where(allowed, matrix, -reach), maximize=True)
    possible = allowed[rows, columns]
    assignment[rows[possible]] = columns[possible]
    return assignment


def graph_similarity(matrix: NDArray[np.float64], assignment: NDArray[np.int64]) -> float:
    """The overall similarity of two graphs under an assignment, which the paper leaves open.

    The sum of the matched entries of the normalised matrix over the square root of how many are matched: at most 1,
    and 1 only where the matrix is a perfect one-to-one map.
    """
    rows = np.flatnonzero(assignment != UNMATCHED)
    if len(rows) == 0:
        return 0.0
    return float(matrix[rows, assignment[rows]].sum() / np.sqrt(len(rows)))
