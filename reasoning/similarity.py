"""The paper's node similarity between two labelled directed graphs (equations 5 to 9), in batches of sub-graphs.

How the equations are read: 5 counts per label and direction, over the labels that both graphs use; 6 and 7 are taken
per label, each label by its own case (both degrees non-zero, both zero, otherwise), and summed over the shared labels;
8 and 9 stop when no entry changes by more than the tolerance. Not converging is reported, and so is a matrix that
collapses to zero, which it does where the graphs share no label.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import PaperGraph

if TYPE_CHECKING:
    from scipy.sparse import csr_array

TOLERANCE = 1e-8
ITERATIONS = 500


@dataclass(frozen=True, eq=False)
class NodeSimilarity:
    """Similarity matrices of Frobenius norm 1 (0 where collapsed), one for each of b sub-graphs of the first graph."""

    matrices: NDArray[np.float64]  # (b, n1, n2); rows of nodes outside the sub-graph are 0
    converged: NDArray[np.bool_]  # (b,)
    iterations: int

    @property
    def collapsed(self) -> NDArray[np.bool_]:
        """Where nothing in the two graphs is alike, shape (b,)."""
        return np.logical_not(self.matrices.any(axis=(1, 2)))

    def transposed(self) -> NodeSimilarity:
        """The same with the graphs exchanged."""
        return replace(self, matrices=self.matrices.transpose(0, 2, 1))


def node_similarity(
    first: PaperGraph,
    second: PaperGraph,
    members: NDArray[np.bool_] | None = None,
    prior: NDArray[np.float64] | None = None,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
    deadline: float = math.inf,
) -> NodeSimilarity:
    """Iterates equations 5 to 9 for induced sub-graphs of ``first`` against the whole of ``second``.

    ``members`` (b, n1) says which nodes each sub-graph has (default: one, of all nodes). ``prior`` (n1, n2), at least
    0, multiplies equation 5: 0 forbids a pair, 1 leaves it. At the ``deadline`` (``time.perf_counter``) it stops.

    >>> import numpy as np
    >>> graph = PaperGraph(("a", "b"), ("a", "b"), np.array([[0, 1]], np.int32), np.zeros(1, np.int8), ("left",))
    >>> node_similarity(graph, graph).matrices[0].round(3).tolist()
    [[0.707, 0.0], [0.0, 0.707]]
    """
    kept = np.ones((1, len(first.vertices)), dtype=bool) if members is None else members
    step = _Step(first, second, kept)
    weight = np.ones((len(first.vertices), len(second.vertices))) if prior is None else prior
    base = step.degree_overlap() * weight[:, None, :]
    matrices = _normalised(base)
    converged = np.zeros(len(kept), dtype=bool)
    done = 0
    while done < iterations and not converged.all() and time.perf_counter() < deadline:
        following = _normalised(step.neighbourhood(matrices) * base)
        converged = np.abs(following - matrices).max(axis=(0, 2), initial=0.0) <= tolerance
        matrices = following
        done += 1
    return NodeSimilarity(matrices.transpose(1, 0, 2), converged, done)


def _normalised(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    """Equation 9; a zero matrix stays zero."""
    norms = np.sqrt(np.einsum("abc,abc->b", matrices, matrices))[None, :, None]
    normalised: NDArray[np.float64] = np.divide(matrices, norms, out=np.zeros_like(matrices), where=norms > 0)
    return normalised


class _Step:
    """Equations 5 to 7 on arrays of shape (n1, b, n2): b sub-graphs of the first graph, L shared labels.

    Nodes of the first graph come first, so that what its edges of one label carry is two products of matrices, one of
    them sparse.
    """

    def __init__(self, first: PaperGraph, second: PaperGraph, kept: NDArray[np.bool_]) -> None:
        shared = np.intersect1d(first.edge_labels, second.edge_labels)
        self._kept = kept.T.copy()
        self._sizes = kept.sum(axis=1) * len(second.vertices)
        self._edges = _labelled_edges(first, shared)
        self._forward, self._backward = self._by_label(len(shared))
        adjacency = second.adjacency()[shared]
        self._in1, self._out1 = self._degrees(len(shared))
        self._in2, self._out2 = adjacency.sum(axis=1), adjacency.sum(axis=2)
        self._into = adjacency * _inverse(self._in2)[:, None, :]
        self._out_of = (adjacency * _inverse(self._out2)[:, :, None]).transpose(0, 2, 1).copy()
        self._in_scale, self._out_scale = _inverse(self._in1), _inverse(self._out1)
        self._both_zero = self._zero_pairs(self._in1, self._in2) + self._zero_pairs(self._out1, self._out2)

    def _degrees(self, labels: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """In- and out-degree by label in each sub-graph: shapes (L, n1, b)."""
        incoming, outgoing = np.zeros((2, labels, *self._kept.shape))
        for start, end, label in self._edges:
            present = self._kept[start] & self._kept[end]
            incoming[label, end] += present
            outgoing[label, start] += present
        return incoming, outgoing

    def _by_label(self, labels: int) -> tuple[list[csr_array], list[csr_array]]:
        """The first graph's edges of each label, from start to end and back: sparse, (n1, n1)."""
        from scipy.sparse import csr_array

        n1 = len(self._kept)
        forward = []
        for label in range(labels):
            edges = np.array([edge[:2] for edge in self._edges if edge[2] == label], dtype=np.int64).reshape(-1, 2)
            forward.append(csr_array((np.ones(len(edges)), (edges[:, 1], edges[:, 0])), shape=(n1, n1)))
        return forward, [csr_array(edges.T) for edges in forward]

    def _zero_pairs(self, degrees1: NDArray[np.float64], degrees2: NDArray[np.float64]) -> NDArray[np.float64]:
        """For how many of the labels that a sub-graph uses both degrees are zero, shape (n1, b, n2)."""
        used = (self._in1.sum(axis=1) > 0)[:, None, :]
        zero1 = ((degrees1 == 0) & self._kept & used).astype(float)
        pairs: NDArray[np.float64] = np.einsum("lab,lc->abc", zero1, (degrees2 == 0).astype(float))
        return pairs

    def degree_overlap(self) -> NDArray[np.float64]:
        """Equation 5, shape (n1, b, n2)."""
        total: NDArray[np.float64] = np.zeros((*self._kept.shape, self._into.shape[1]))
        for degrees1, degrees2 in ((self._in1, self._in2), (self._out1, self._out2)):
            for one, two in zip(degrees1, degrees2, strict=True):
                total += np.minimum(one[:, :, None], two)
        return total

    def neighbourhood(self, matrices: NDArray[np.float64]) -> NDArray[np.float64]:
        """The mean of equations 6 and 7, shape (n1, b, n2)."""
        mean = matrices.sum(axis=(0, 2)) / np.maximum(self._sizes, 1)
        total: NDArray[np.float64] = mean[:, None] * self._both_zero
        n1, b, n2 = matrices.shape
        flat = matrices.reshape(n1, b * n2)
        for label, (forward, backward) in enumerate(zip(self._forward, self._backward, strict=True)):
            incoming = (forward @ flat).reshape(n1 * b, n2) @ self._into[label]
            outgoing = (backward @ flat).reshape(n1 * b, n2) @ self._out_of[label]
            total += self._in_scale[label][:, :, None] * incoming.reshape(n1, b, n2)
            total += self._out_scale[label][:, :, None] * outgoing.reshape(n1, b, n2)
        total /= 2
        return total


def _labelled_edges(graph: PaperGraph, shared: NDArray[np.int8]) -> list[tuple[int, int, int]]:
    """The edges with a shared label: from, to, position of the label among the shared ones."""
    position = {int(label): i for i, label in enumerate(shared)}
    return [
        (start, end, position[label])
        for (start, end), label in zip(graph.edges.tolist(), graph.edge_labels.tolist(), strict=True)
        if label in position
    ]


def _inverse(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """1 over each degree, 0 where it is 0."""
    inverse: NDArray[np.float64] = np.divide(1.0, degrees, out=np.zeros_like(degrees), where=degrees > 0)
    return inverse
