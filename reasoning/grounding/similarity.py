"""The paper's node similarity (equations 5 to 9) in batches of sub-graphs, its completion of a description, and the
assignment of its matrix.

The whole calculus (:mod:`deixis.reasoning.entailment.implications`) says more, but in the wide reading, which names no
exact relation: with it, equations 5 to 9 were seen to find fewer objects.

How the equations are read: 5 counts per label and direction, over the labels that both graphs use; 6 and 7 are taken
per label, each label by its own case (both degrees non-zero, both zero, otherwise), and summed over the shared labels;
8 and 9 stop when no entry changes by more than the tolerance. Not converging is reported, and so is a matrix that
collapses to zero, which it does where the graphs share no label.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph import PaperGraph, RelationGraph
from deixis.ontology.relation import Relation
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.grounding.matching.problem import UNMATCHED

if TYPE_CHECKING:
    from scipy.sparse import csr_array


def with_same_word(graph: RelationGraph, most: int, consistent: bool | None = None) -> RelationGraph:
    """Return the graph with the firm facts that inverses and transitivity of single words add, after the stated ones.

    Facts that contradict each other imply everything, so that then nothing is added; nor is it where there would be
    more than ``most`` facts. ``consistent`` says whether the firm facts can hold together, where that is known.

    >>> from deixis.ontology.graph import Fact
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
    """Yield by relation the pairs that its facts and those of its inverse add."""
    firm = graph.positive & ~graph.optional & (graph.weights >= 1.0)
    for relation in graph.vocabulary.values():
        inverse = graph.vocabulary[relation.inverse]
        same = np.flatnonzero(firm & np.isin(graph.relation_sets, (relation.bit, inverse.bit)))
        if len(same):
            # the pairs of which the relation follows from these facts alone, without those of which it is stated
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


TOLERANCE = 1e-8
ITERATIONS = 500


@dataclass(frozen=True, eq=False)
class SimilarityMatrices:
    """Similarity matrices of Frobenius norm 1 (0 where nothing is alike), one for each of b sub-graphs."""

    matrices: NDArray[np.float64]  # (b, n1, n2); rows of nodes outside the sub-graph are 0
    converged: NDArray[np.bool_]  # (b,)
    iterations: int

    def transposed(self) -> SimilarityMatrices:
        """Return the same with the graphs exchanged."""
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

    ``members`` (b, n1) says which nodes each sub-graph has (default: one, of all nodes). ``prior`` (n1, n2), at least
    0, multiplies equation 5: 0 forbids a pair, 1 leaves it. At the ``deadline`` it stops.

    >>> import numpy as np
    >>> graph = PaperGraph(("a", "b"), ("a", "b"), np.array([[0, 1]], np.int32), np.zeros(1, np.int8), ("left",))
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
    """Return equation 9; a zero matrix stays zero."""
    norms = np.sqrt(np.einsum("abc,abc->b", matrices, matrices))[None, :, None]
    normalised: NDArray[np.float64] = np.divide(matrices, norms, out=np.zeros_like(matrices), where=norms > 0)
    return normalised


MAX_LOOPED = 32
"""Edges that are gone through in Python: loading sparse matrices takes longer."""


@dataclass(frozen=True, eq=False)
class _Edges:
    """Edges among n nodes, sorted pairs of row and column: a sparse matrix (n, n) of ones."""

    size: int
    pairs: Sequence[tuple[int, int]]

    def sums(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the product with a matrix of values (n, m)."""
        if len(self.pairs) > MAX_LOOPED:
            product: NDArray[np.float64] = self._sparse @ values
            return product
        total = np.zeros_like(values)
        for row, column in self.pairs:
            total[row] += values[column]
        return total

    @cached_property
    def _sparse(self) -> csr_array:
        from scipy.sparse import csr_array

        rows, columns = np.array(self.pairs).T
        return csr_array((np.ones(len(self.pairs)), (rows, columns)), shape=(self.size, self.size))


class _Iteration:
    """Equations 5 to 7 on arrays of shape (n1, b, n2): b sub-graphs of the first graph, L shared labels.

    Nodes of the first graph come first, so that what its edges of one label carry is two products of matrices, one of
    them sparse.
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
        self._forward, self._backward = self._by_label(len(shared))
        adjacency = second.adjacency()[shared]
        incoming, outgoing = np.zeros((2, len(shared), *self._kept.shape))
        for a, b, k in self._edges:
            present = self._kept[a] & self._kept[b]
            incoming[k, b] += present
            outgoing[k, a] += present
        self._in1, self._out1 = incoming, outgoing
        self._in2, self._out2 = adjacency.sum(axis=1), adjacency.sum(axis=2)
        self._into = adjacency * _inverse(self._in2)[:, None, :]
        self._out_of = (adjacency * _inverse(self._out2)[:, :, None]).transpose(0, 2, 1).copy()
        self._in_scale, self._out_scale = _inverse(self._in1), _inverse(self._out1)
        self._both_zero = self._zero_pairs(self._in1, self._in2) + self._zero_pairs(self._out1, self._out2)

    def _by_label(self, labels: int) -> tuple[list[_Edges], list[_Edges]]:
        """Return the first graph's edges of each label, from start to end and back."""
        n1, forward, backward = len(self._kept), [], []
        for label in range(labels):
            edges = [(start, end) for start, end, its_label in self._edges if its_label == label]
            forward.append(_Edges(n1, sorted((end, start) for start, end in edges)))
            backward.append(_Edges(n1, sorted(edges)))
        return forward, backward

    def _zero_pairs(self, degrees1: NDArray[np.float64], degrees2: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return for how many of the labels that a sub-graph uses both degrees are zero, shape (n1, b, n2)."""
        used = (self._in1.sum(axis=1) > 0)[:, None, :]
        zero1 = ((degrees1 == 0) & self._kept & used).astype(float)
        pairs: NDArray[np.float64] = np.einsum("lab,lc->abc", zero1, (degrees2 == 0).astype(float))
        return pairs

    def degree_overlap(self) -> NDArray[np.float64]:
        """Return equation 5, shape (n1, b, n2)."""
        total: NDArray[np.float64] = np.zeros((*self._kept.shape, self._into.shape[1]))
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
        for label, (forward, backward) in enumerate(zip(self._forward, self._backward, strict=True)):
            incoming = forward.sums(flat).reshape(n1 * b, n2) @ self._into[label]
            outgoing = backward.sums(flat).reshape(n1 * b, n2) @ self._out_of[label]
            total += self._in_scale[label][:, :, None] * incoming.reshape(n1, b, n2)
            total += self._out_scale[label][:, :, None] * outgoing.reshape(n1, b, n2)
        total /= 2
        return total


def _inverse(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return 1 over each degree, 0 where it is 0."""
    inverse: NDArray[np.float64] = np.divide(1.0, degrees, out=np.zeros_like(degrees), where=degrees > 0)
    return inverse


def assign(matrix: NDArray[np.float64], allowed: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return the assignment of rows to columns with the largest sum (the Hungarian method, through scipy).

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
    """Return the overall similarity of two graphs under an assignment, which the paper leaves open.

    The sum of the matched entries of the normalised matrix over the square root of how many are matched: at most 1,
    and 1 only where the matrix is a perfect one-to-one map.
    """
    rows = np.flatnonzero(assignment != UNMATCHED)
    if len(rows) == 0:
        return 0.0
    return float(matrix[rows, assignment[rows]].sum() / np.sqrt(len(rows)))
