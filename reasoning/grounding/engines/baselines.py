"""Two node similarities from the literature: Blondel et al. (2004), and Heymans and Singh (2003).

Both compare weighted graphs: the description has an edge for every fact, the scene one for every pair with a positive
entry in the fact's table (divided by the largest entry). Facts of several kinds give several such pairs of graphs,
whose updates are added. Of the unary evidence, both use only the matches that are ruled out. The iteration ends at the
deadline. :class:`deixis.reasoning.grounding.engines.map_engines.BaselineEngine` makes engines of them with the
Hungarian method.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Problem

Matrix = NDArray[np.float64]

ITERATIONS = 100
TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class NodeSimilarity:
    """Similarity of every object and every thing."""

    matrix: Matrix  # (n1, n2), Frobenius norm 1
    finished: bool  # whether the iteration ended before the deadline


def blondel_similarity(problem: Problem, deadline: Deadline = Deadline.never()) -> NodeSimilarity:
    """Compute the similarity of Blondel et al.: the limit of the even iterates of S <- B S A' + B' S A from ones.

    Blondel, Gajardo, Heymans, Senellart and Van Dooren, "A measure of similarity between graph vertices", SIAM Review
    46 (2004); here summed over the kinds of facts.

    Parameters
    ----------
    problem
        The problem; of the unary evidence, only the matches that are ruled out are used.
    deadline
        End of the time limit.

    Returns
    -------
    NodeSimilarity
        Similarity after the last iteration, and whether the iteration ended before the deadline.
    """

    def update(s: Matrix) -> Matrix:
        total = np.zeros_like(s)
        for a, b in _graphs(problem):
            total += a @ s @ b.T + a.T @ s @ b
        return total

    return _iterate(lambda s: _normalised(update(_normalised(update(s)))), problem, deadline)


def heymans_singh_similarity(problem: Problem, deadline: Deadline = Deadline.never()) -> NodeSimilarity:
    """Compute the similarity of Heymans and Singh: agreement of neighbours minus their disagreement.

    Heymans and Singh, "Deriving phylogenetic trees from the similarity analysis of metabolic pathways",
    Bioinformatics 19 (2003): S <- (A1 + A2 + A3 + A4 - D1 - D2 - D3 - D4) / 4. A1 and A2 are the mean similarity of
    the nodes that the two have edges from and to, A3 and A4 of those that neither has; D1 to D4 of those that one of
    the two has and the other has not. A mean over no nodes is 0, but where neither of the two has any, A is the mean
    of all. Summed over the kinds of facts, which the paper does not have.

    Parameters
    ----------
    problem
        The problem; of the unary evidence, only the matches that are ruled out are used.
    deadline
        End of the time limit.

    Returns
    -------
    NodeSimilarity
        Similarity after the last iteration, and whether the iteration ended before the deadline.
    """

    def update(s: Matrix) -> Matrix:
        total = np.zeros_like(s)
        for a, b in _graphs(problem):
            for one, two in ((a, b), (a.T, b.T)):
                apart_one, apart_two = _complement(one), _complement(two)
                total += _alike(one, s, two) + _alike(apart_one, s, apart_two)  # A2 and A4; turned round, A1 and A3
                total -= _mean(one, s, apart_two) + _mean(apart_one, s, two)  # D2 and D4; turned round, D1 and D3
        return total / 4

    return _iterate(lambda s: _normalised(update(s)), problem, deadline)


def _graphs(problem: Problem) -> Iterator[tuple[Matrix, Matrix]]:
    """Yield the adjacency of the description (n1, n1) and of the scene (n2, n2), in [0, 1], for each kind of fact."""
    n1 = len(problem.absent)
    for kind in np.unique(problem.kinds):
        described = np.zeros((n1, n1))
        np.add.at(described, tuple(problem.ends[problem.kinds == kind].T), 1.0)
        seen = np.maximum(problem.tables[kind].astype(np.float64), 0.0)
        np.fill_diagonal(seen, 0.0)
        yield np.minimum(described, 1.0), seen / max(seen.max(initial=0.0), 1e-300)


def _complement(graph: Matrix) -> Matrix:
    other = 1.0 - graph
    np.fill_diagonal(other, 0.0)
    return other


def _mean(one: Matrix, s: Matrix, two: Matrix) -> Matrix:
    """Return the weighted mean of ``s`` over pairs of neighbours, shape (n1, n2); 0 for a node without neighbours."""
    weight = one.sum(axis=1)[:, None] * two.sum(axis=1)[None, :]
    mean: Matrix = np.divide(one @ s @ two.T, weight, out=np.zeros_like(s), where=weight > 0)
    return mean


def _alike(one: Matrix, s: Matrix, two: Matrix) -> Matrix:
    """Return the weighted mean over pairs of neighbours; two nodes without neighbours get the mean of ``s``."""
    neither = (one.sum(axis=1)[:, None] == 0) & (two.sum(axis=1)[None, :] == 0)
    alike: Matrix = np.where(neither, s.mean(), _mean(one, s, two))
    return alike


def _iterate(step: Callable[[Matrix], Matrix], problem: Problem, deadline: Deadline) -> NodeSimilarity:
    """Repeat a step from a matrix of ones, 0 where ruled out, until convergence or the deadline."""
    s = _normalised(problem.allowed.astype(np.float64))
    for _ in range(ITERATIONS):
        if deadline.passed:
            return NodeSimilarity(s, finished=False)
        following = _normalised(step(s) * problem.allowed) if s.size else s
        if np.abs(following - s).max(initial=0.0) <= TOLERANCE:
            return NodeSimilarity(following, finished=True)
        s = following
    return NodeSimilarity(s, finished=True)


def _normalised(matrix: Matrix) -> Matrix:
    norm = float(np.linalg.norm(matrix))
    return matrix / norm if norm > 0 else matrix
