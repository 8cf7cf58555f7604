"""Node similarity of the paper (equations 5 to 9) in batches of sub-graphs, and the assignment by its matrix.

The assignment is the one with the largest sum of similarities (the Hungarian method; Kuhn 1955), which scipy finds by
shortest augmenting paths (Crouse 2016).

The description is first completed with the facts that inverses and transitivity imply. The whole calculus
(:mod:`deixis.reasoning.entailment.implications`) implies more facts, but in the wide reading, which names no exact
relation: with these facts, equations 5 to 9 found fewer objects.

Reading of the equations: equation 5 counts per label and direction, over the labels that both graphs use. Equations 6
and 7 are applied to each label by its own case (both degrees non-zero, both zero, otherwise) and summed over the shared
labels. Equations 8 and 9 stop when no entry changes by more than the tolerance. The result tells whether the iteration
converged. The matrix is zero where the graphs share no label.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import PaperGraph, RelationGraph
from deixis.ontology.relations.relation import Relation
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.grounding.matching.problem import UNMATCHED

if TYPE_CHECKING:
    from scipy.sparse import csr_array


def with_same_word(graph: RelationGraph, most: int, consistent: bool | None = None) -> RelationGraph:
    """Return the graph with the firm facts that inverses and transitivity of single words add, after the stated ones.

    Contradictory facts imply everything, so nothing is added to them.

    Parameters
    ----------
    graph
        The graph.
    most
        Maximum number of facts; nothing is added if there would be more.
    consistent
        Whether the firm facts can hold together; None if that is unknown.

    Returns
    -------
    RelationGraph
        The graph.

    Examples
    --------
    >>> from deixis.ontology.graph.graph import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact("a", (r["left"],), "b"), Fact("b", (r["top_left"],), "c")]
    >>> [str(fact) for fact in with_same_word(RelationGraph.from_facts(r, "abc", facts), 100).facts()]
    ['left(a, b)', 'top_left(b, c)', 'bottom_right(c, b)', 'right(b, a)']
    """
    if consistent is None:
        consistent = Implications(graph, time_limit=1.0).consistent
    if not consistent:
        return graph
    added = list(_added(graph))
    count = sum(len(pairs) for _, pairs in added)
    if not count or len(graph) + count > most:
        return graph
    pairs = np.concatenate([pairs for _, pairs in added]).astype(np.int32)
    bits = np.concatenate([np.full(len(pairs), relation.bit, np.int64) for relation, pairs in added])
    return RelationGraph(
        vocabulary=graph.vocabulary,
        nodes=graph.nodes,
        subjects=np.concatenate([graph.subjects, pairs[:, 0]]),
        objects=np.concatenate([graph.objects, pairs[:, 1]]),
        relation_sets=np.concatenate([graph.relation_sets, bits]),
        positive=np.concatenate([graph.positive, np.ones(count, np.bool_)]),
        optional=np.concatenate([graph.optional, np.zeros(count, np.bool_)]),
        weights=np.concatenate([graph.weights, np.ones(count)]),
        sources=(*graph.sources, *[None] * count) if graph.sources else (),
        kinds=graph.kinds,
        boxes=graph.boxes,
    )


def _added(graph: RelationGraph) -> Iterator[tuple[Relation, NDArray[np.int64]]]:
    """Yield each relation with the pairs (k, 2) that its facts and those of its inverse imply."""
    firm = graph.positive & ~graph.optional & (graph.weights >= 1.0)
    for relation in graph.vocabulary.values():
        inverse = graph.vocabulary[relation.inverse]
        same = np.flatnonzero(firm & np.isin(graph.relation_sets, (relation.bit, inverse.bit)))
        if len(same):
            # the pairs for which the relation follows from these facts alone, and is not stated
            stated = graph.relation_sets[same] == relation.bit
            ends = np.stack([graph.subjects[same], graph.objects[same]], axis=1).astype(np.int64)
            n = len(graph.nodes)
            if relation.transitive:
                few = RelationGraph(
                    vocabulary=graph.vocabulary,
                    nodes=graph.nodes,
                    subjects=graph.subjects[same],
                    objects=graph.objects[same],
                    relation_sets=graph.relation_sets[same],
                    positive=graph.positive[same],
                    optional=graph.optional[same],
                    weights=graph.weights[same],
                )
                pairs = Implications(few).pairs(relation)
            else:
                pairs = np.unique(ends[~stated][:, ::-1], axis=0)
            known = ends[stated, 0] * n + ends[stated, 1]
            yield relation, pairs[~np.isin(pairs[:, 0] * n + pairs[:, 1], known)]


TOLERANCE = 1e-8  # largest change of an entry at convergence
ITERATIONS = 500
CARRIED_CELLS = 1 << 20  # maximum number of cells in one product over several labels


@dataclass(frozen=True, eq=False)
class SimilarityMatrices:
    """Similarity matrices of b sub-graphs, each of Frobenius norm 1, or 0 where no nodes are similar."""

    matrices: NDArray[np.float64]  # (b, n1, n2); rows of nodes outside the sub-graph are 0
    converged: NDArray[np.bool_]  # (b,)
    iterations: int

    def transposed(self) -> SimilarityMatrices:
        """Return the similarity with the two graphs exchanged.

        Returns
        -------
        SimilarityMatrices
            The matrices, transposed.
        """
        return replace(self, matrices=self.matrices.transpose(0, 2, 1))


def node_similarity(
    first: PaperGraph,
    second: PaperGraph,
    members: NDArray[np.bool_] | None = None,
    prior: NDArray[np.float64] | None = None,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
    deadline: Deadline = Deadline.never(),
) -> SimilarityMatrices:
    """Iterate equations 5 to 9 for induced sub-graphs of ``first`` against the whole of ``second``.

    Parameters
    ----------
    first, second
        Graphs with n1 and n2 nodes.
    members
        Nodes of each sub-graph, shape (b, n1); by default, one sub-graph of all nodes.
    prior
        Factors of equation 5, shape (n1, n2), at least 0: 0 forbids a pair, 1 leaves it unchanged.
    tolerance
        Largest change of an entry at convergence.
    iterations
        Maximum number of iterations.
    deadline
        Time at which the iteration stops.

    Returns
    -------
    SimilarityMatrices
        Matrices of shape (b, n1, n2), the number of iterations, and whether they converged.

    Examples
    --------
    >>> import numpy as np
    >>> graph = PaperGraph(("a", "b"), np.array([[0, 1]], np.int32), np.zeros(1, np.int8), ("left",))
    >>> node_similarity(graph, graph).matrices[0].round(3).tolist()
    [[0.707, 0.0], [0.0, 0.707]]
    """
    kept = np.ones((1, len(first.vertices)), dtype=bool) if members is None else members
    step = _Iteration(first, second, kept)
    weight = np.ones((len(first.vertices), len(second.vertices))) if prior is None else prior
    base = step.degree_overlap() * weight[:, None, :]
    matrices = _normalised(base)
    converged = np.zeros(len(kept), dtype=bool)
    done = 0
    while done < iterations and not converged.all() and not deadline.passed:
        following = _normalised(step.neighbourhood(matrices) * base)
        converged = np.abs(following - matrices).max(axis=(0, 2), initial=0.0) <= tolerance
        matrices = following
        done += 1
    return SimilarityMatrices(matrices.transpose(1, 0, 2), converged, done)


def _normalised(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return matrices divided by their Frobenius norms (equation 9); a zero matrix stays zero."""
    norms = np.sqrt(np.einsum("abc,abc->b", matrices, matrices))[None, :, None]
    normalised: NDArray[np.float64] = np.divide(matrices, norms, out=np.zeros_like(matrices), where=norms > 0)
    return normalised


MAX_DENSE = 1 << 18
"""Maximum number of multiplications for which edges are multiplied as a dense matrix."""

MAX_LOOPED = 256
"""Maximum number of edges of a Python loop where a dense matrix is too large; importing scipy.sparse takes longer."""


@dataclass(frozen=True, eq=False)
class _Edges:
    """Sparse matrix of ones of shape (r, n): edges from n nodes to r others, sorted by row and column."""

    shape: tuple[int, int]
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]

    def sums(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the product with a matrix of values (n, m), shape (r, m)."""
        product: NDArray[np.float64]
        if math.prod(self.shape) * values.shape[1] <= MAX_DENSE:
            product = self._dense @ values
        elif len(self.rows) <= MAX_LOOPED:
            product = np.zeros((self.shape[0], values.shape[1]))
            for row, column in zip(self.rows.tolist(), self.columns.tolist(), strict=True):
                product[row] += values[column]
        else:
            product = self._sparse @ values
        return product

    @cached_property
    def _dense(self) -> NDArray[np.float64]:
        dense = np.zeros(self.shape)
        np.add.at(dense, (self.rows, self.columns), 1.0)
        return dense

    @cached_property
    def _sparse(self) -> csr_array:
        from scipy.sparse import csr_array

        return csr_array((np.ones(len(self.rows)), (self.rows, self.columns)), shape=self.shape)


class _Iteration:
    """Equations 5 to 7 on arrays of shape (n1, b, n2), for b sub-graphs of the first graph and L shared labels.

    The nodes of the first graph are the first axis, so that a step is two matrix products, one of them sparse. One
    product covers as many labels and directions as fit in ``CARRIED_CELLS``.
    """

    def __init__(self, first: PaperGraph, second: PaperGraph, kept: NDArray[np.bool_]) -> None:
        shared = np.intersect1d(first.edge_labels, second.edge_labels)
        self._kept = kept.T.copy()
        self._sizes = kept.sum(axis=1) * len(second.vertices)
        position = {int(label): i for i, label in enumerate(shared)}
        self._edges = [
            (start, end, position[label])
            for (start, end), label in zip(first.edges.tolist(), first.edge_labels.tolist(), strict=True)
            if label in position
        ]
        adjacency = second.adjacency()[shared]
        incoming, outgoing = np.zeros((2, len(shared), *self._kept.shape))
        for a, b, k in self._edges:
            present = self._kept[a] & self._kept[b]
            incoming[k, b] += present
            outgoing[k, a] += present
        self._in1, self._out1 = incoming, outgoing
        self._in2, self._out2 = adjacency.sum(axis=1), adjacency.sum(axis=2)
        into = adjacency * _inverse(self._in2)[:, None, :]
        out_of = (adjacency * _inverse(self._out2)[:, :, None]).transpose(0, 2, 1)
        self._across = np.concatenate([into, out_of])  # (2L, n2, n2): to the end of each edge, then to its start
        self._scale = np.concatenate([_inverse(self._in1), _inverse(self._out1)])[:, :, :, None]
        self._parts = self._carried(len(shared))
        self._both_zero = self._zero_pairs(self._in1, self._in2) + self._zero_pairs(self._out1, self._out2)

    def _carried(self, labels: int) -> list[tuple[slice, _Edges]]:
        """Return the blocks of k labels and directions (of 2L), each with the first graph's edges, shape (k n1, n1)."""
        n1, b = self._kept.shape
        some = max(1, int(CARRIED_CELLS / max(1, n1 * b * self._across.shape[1])))
        edges = np.array(self._edges, dtype=np.int64).reshape(-1, 3)
        rows = np.concatenate([edges[:, 2] * n1 + edges[:, 1], (labels + edges[:, 2]) * n1 + edges[:, 0]])
        columns = edges[:, :2].T.ravel()
        order = np.lexsort([columns, rows])
        rows, columns = rows[order], columns[order]
        parts = []
        for start in range(0, 2 * labels, some):
            low, high = start * n1, min(start + some, 2 * labels) * n1
            these = slice(*np.searchsorted(rows, [low, high]))
            parts.append((slice(start, start + some), _Edges((high - low, n1), rows[these] - low, columns[these])))
        return parts

    def _zero_pairs(self, degrees1: NDArray[np.float64], degrees2: NDArray[np.float64]) -> NDArray[np.float64]:
        """Count the labels of a sub-graph for which both degrees are zero, shape (n1, b, n2)."""
        used = (self._in1.sum(axis=1) > 0)[:, None, :]
        zero1 = ((degrees1 == 0) & self._kept & used).astype(float)
        pairs: NDArray[np.float64] = np.einsum("lab,lc->abc", zero1, (degrees2 == 0).astype(float))
        return pairs

    def degree_overlap(self) -> NDArray[np.float64]:
        """Return equation 5, shape (n1, b, n2)."""
        total: NDArray[np.float64] = np.zeros((*self._kept.shape, self._across.shape[1]))
        for degrees1, degrees2 in ((self._in1, self._in2), (self._out1, self._out2)):
            for one, two in zip(degrees1, degrees2, strict=True):
                total += np.minimum(one[:, :, None], two)
        return total

    def neighbourhood(self, matrices: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the mean of equations 6 and 7, shape (n1, b, n2)."""
        mean = matrices.sum(axis=(0, 2)) / np.maximum(self._sizes, 1)
        total: NDArray[np.float64] = mean[:, None] * self._both_zero
        n1, b, n2 = matrices.shape
        flat = matrices.reshape(n1, b * n2)
        for part, edges in self._parts:
            carried = edges.sums(flat).reshape(-1, n1 * b, n2) @ self._across[part]
            total += (self._scale[part] * carried.reshape(-1, n1, b, n2)).sum(axis=0)
        total /= 2
        return total


def _inverse(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the inverse of each degree, 0 where the degree is 0."""
    inverse: NDArray[np.float64] = np.divide(1.0, degrees, out=np.zeros_like(degrees), where=degrees > 0)
    return inverse


def assign(matrix: NDArray[np.float64], allowed: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the assignment of rows to columns with the largest sum (the Hungarian method, through scipy).

    As many rows as possible are matched to allowed columns.

    Parameters
    ----------
    matrix
        Values, shape (n1, n2).
    allowed
        True for pairs that may be matched, shape (n1, n2).

    Returns
    -------
    ndarray
        Column of each row, ``UNMATCHED`` for the others, shape (n1,).

    Examples
    --------
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
    """Return the overall similarity of two graphs under an assignment.

    Parameters
    ----------
    matrix
        Normalised similarities, shape (n1, n2).
    assignment
        Column of each row, shape (n1,).

    Returns
    -------
    float
        The similarity, in [0, 1]; 1 only if the matrix is a perfect one-to-one map.

    Notes
    -----
    The paper does not define it. It is the sum of the matched entries over the square root of the number of matches.
    """
    rows = np.flatnonzero(assignment != UNMATCHED)
    if len(rows) == 0:
        return 0.0
    return float(matrix[rows, assignment[rows]].sum() / np.sqrt(len(rows)))
