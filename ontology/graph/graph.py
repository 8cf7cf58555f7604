"""The relation graph, which scripts and scenes are both turned into, and which grounding compares.

A :class:`RelationGraph` is a weighted directed multigraph over objects. Its edges are numpy arrays; a
:class:`~deixis.ontology.graph.facts.Fact` is one edge as an object. :class:`PaperGraph` is Definition 1 of the paper: a
directed graph with one label per edge.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.errors import GraphError
from deixis.ontology.graph.facts import OPTIONAL_WEIGHT, Fact, Source, dispensable
from deixis.ontology.relations.relation import Relations

if TYPE_CHECKING:
    import networkx as nx

__all__ = ["OPTIONAL_WEIGHT", "Fact", "PaperGraph", "RelationGraph", "Source", "dispensable"]


@dataclass(frozen=True, eq=False, repr=False)
class RelationGraph:
    """A weighted directed multigraph over named objects (n nodes, m edges).

    An edge has a set of relations (several are a disjunction), a sign, an optional flag, a weight and a source. Each
    relation has its reading, so that wide and exact relations are never mixed up.

    Examples
    --------
    >>> from deixis.ontology.graph.facts import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> relations = default_ontology().relations
    >>> facts = [Fact("fork", (relations["left"],), "plate"), Fact("napkin", (relations["on"],), "plate")]
    >>> graph = RelationGraph.from_facts(relations, ["fork", "napkin", "plate"], facts)
    >>> graph
    <RelationGraph 3 nodes, 2 edges>
    >>> graph.index("plate"), graph.subjects.tolist(), graph.objects.tolist()
    (2, [0, 1], [2, 2])
    >>> [str(fact) for fact in graph.facts()]
    ['left(fork, plate)', 'on(napkin, plate)']
    >>> graph.subgraph(["fork", "plate"]).nodes
    ('fork', 'plate')
    """

    vocabulary: Relations
    nodes: tuple[str, ...]
    subjects: NDArray[np.int32]  # (m,) node indices
    objects: NDArray[np.int32]  # (m,) node indices
    relation_sets: NDArray[np.int64]  # (m,) bit masks over relation indices
    positive: NDArray[np.bool_]  # (m,)
    optional: NDArray[np.bool_]  # (m,)
    weights: NDArray[np.float64]  # (m,)
    sources: tuple[Source | None, ...] = ()  # (m,), or empty if no edge has a source
    kinds: tuple[str | None, ...] = ()  # (n,) class IRIs, or empty
    colours: tuple[str | None, ...] = ()  # (n,) IRIs of described colours, or empty
    boxes: NDArray[np.float64] | None = None  # (n, 2, d): minimum and maximum corner, metres
    _index: dict[str, int] = field(init=False)

    def __repr__(self) -> str:
        return f"<RelationGraph {count(len(self.nodes), 'node')}, {count(len(self.subjects), 'edge')}>"

    def __post_init__(self) -> None:
        index = {name: i for i, name in enumerate(self.nodes)}
        if len(index) != len(self.nodes):
            twice = next(name for i, name in enumerate(self.nodes) if index[name] != i)
            raise GraphError(f"`nodes` must differ from one another, got '{twice}' twice")
        object.__setattr__(self, "_index", index)
        m = len(self.subjects)
        arrays = (self.objects, self.relation_sets, self.positive, self.optional, self.weights)
        if any(len(array) != m for array in arrays) or len(self.sources) not in (0, m):
            lengths = sorted({m, len(self.sources), *(len(array) for array in arrays)})
            raise GraphError(f"the edge arrays must have one length, got {lengths}")
        if len(self.kinds) not in (0, len(self.nodes)) or len(self.colours) not in (0, len(self.nodes)):
            raise GraphError(
                f"`kinds` and `colours` must have {len(self.nodes)} entries, one per node, or none, "
                f"got {len(self.kinds)} and {len(self.colours)}"
            )
        if self.boxes is not None and len(self.boxes) != len(self.nodes):
            raise GraphError(f"`boxes` must have {len(self.nodes)} boxes, one per node, got {len(self.boxes)}")

    @property
    def net_weights(self) -> NDArray[np.float64]:
        """Weights of what the edges affirm (m,), halved for optional edges."""
        return self.affirmed_weights * np.where(self.optional, OPTIONAL_WEIGHT, 1.0)

    @property
    def affirmed_weights(self) -> NDArray[np.float64]:
        """Weights of what the edges affirm (m,): a fact that holds rarely (0.2) is denied with 0.8."""
        weights: NDArray[np.float64] = np.maximum(self.weights, 1 - self.weights)
        return weights

    @property
    def affirmed(self) -> NDArray[np.bool_]:
        """True for edges that affirm a relation (m,); a fact that holds rarely is more likely denied."""
        affirmed: NDArray[np.bool_] = self.positive == (self.weights >= 0.5)
        return affirmed

    def affirming(self) -> RelationGraph:
        """Return an equivalent graph without weights below one half: rare facts become denials of the other weight.

        Returns
        -------
        RelationGraph
            The graph.
        """
        return replace(self, positive=self.affirmed, weights=self.affirmed_weights)

    @classmethod
    def from_facts(
        cls,
        vocabulary: Relations,
        nodes: Sequence[str],
        facts: Iterable[Fact],
        kinds: Sequence[str | None] = (),
        boxes: NDArray[np.float64] | None = None,
        colours: Sequence[str | None] = (),
    ) -> RelationGraph:
        """Return the graph of some facts.

        Parameters
        ----------
        vocabulary
            Relations of the ontology.
        nodes
            Names of the n objects.
        facts
            The facts, each of which becomes an edge.
        kinds
            Class IRI of each node or None; empty if no kind is known.
        boxes
            Minimum and maximum corners, shape (n, 2, d), or None.
        colours
            IRI of the colour of each node or None; empty if no colour is known.

        Returns
        -------
        RelationGraph
            The graph.

        Raises
        ------
        GraphError
            If a fact names an object that is not in ``nodes``.
        """
        index = {name: i for i, name in enumerate(nodes)}
        listed = list(facts)
        for fact in listed:
            for name in (fact.subject, fact.object):
                if name not in index:
                    raise GraphError(f"the fact {fact} names '{name}', which is not a node of the graph")
        return cls(
            vocabulary=vocabulary,
            nodes=tuple(nodes),
            subjects=np.array([index[f.subject] for f in listed], dtype=np.int32),
            objects=np.array([index[f.object] for f in listed], dtype=np.int32),
            relation_sets=np.array([f.relation_set for f in listed], dtype=np.int64),
            positive=np.array([f.positive for f in listed], dtype=np.bool_),
            optional=np.array([f.optional for f in listed], dtype=np.bool_),
            weights=np.array([f.weight for f in listed], dtype=np.float64),
            sources=tuple(f.source for f in listed),
            kinds=tuple(kinds),
            colours=tuple(colours),
            boxes=boxes,
        )

    def __len__(self) -> int:
        """Return the number of edges."""
        return len(self.subjects)

    def index(self, node: str) -> int:
        """Return the position of a node.

        Parameters
        ----------
        node
            Its name.

        Returns
        -------
        int
            The position.

        Raises
        ------
        GraphError
            If there is no node of that name.
        """
        try:
            return self._index[node]
        except KeyError:
            raise GraphError(f"the graph has no object '{node}'") from None

    def fact(self, edge: int) -> Fact:
        """Return one edge as a fact.

        Parameters
        ----------
        edge
            Position of the edge.

        Returns
        -------
        Fact
            The fact.
        """
        return Fact(
            subject=self.nodes[self.subjects[edge]],
            relations=self.vocabulary.members(int(self.relation_sets[edge])),
            object=self.nodes[self.objects[edge]],
            positive=bool(self.positive[edge]),
            optional=bool(self.optional[edge]),
            weight=float(self.weights[edge]),
            source=self.sources[edge] if self.sources else None,
        )

    def facts(self) -> Iterator[Fact]:
        """Yield all edges as facts, in their order.

        Yields
        ------
        Fact
            A fact.
        """
        return (self.fact(edge) for edge in range(len(self)))

    def subgraph(self, nodes: Sequence[str]) -> RelationGraph:
        """Return the induced subgraph of these nodes, in the order given.

        Parameters
        ----------
        nodes
            Names of the nodes, in the wanted order.

        Returns
        -------
        RelationGraph
            The graph with the edges among them.
        """
        keep = np.array([self.index(name) for name in nodes], dtype=np.int64)
        position = np.full(len(self.nodes), -1, dtype=np.int32)
        position[keep] = np.arange(len(keep), dtype=np.int32)
        edges = np.flatnonzero((position[self.subjects] >= 0) & (position[self.objects] >= 0))
        return RelationGraph(
            vocabulary=self.vocabulary,
            nodes=tuple(nodes),
            subjects=position[self.subjects[edges]],
            objects=position[self.objects[edges]],
            relation_sets=self.relation_sets[edges],
            positive=self.positive[edges],
            optional=self.optional[edges],
            weights=self.weights[edges],
            sources=tuple(self.sources[e] for e in edges) if self.sources else (),
            kinds=tuple(self.kinds[i] for i in keep) if self.kinds else (),
            colours=tuple(self.colours[i] for i in keep) if self.colours else (),
            boxes=None if self.boxes is None else self.boxes[keep],
        )

    def to_networkx(self) -> nx.MultiDiGraph[Any]:
        """Return the graph as a ``networkx.MultiDiGraph``, with one edge per fact.

        Returns
        -------
        networkx.MultiDiGraph
            Nodes are the names of the objects, with ``kind`` and ``colour`` (IRIs or None) and ``box`` (least and
            greatest corner in metres as lists, or None). Edges lead from subject to object, with ``relations`` (names,
            several are a disjunction), ``positive``, ``optional``, ``weight`` and ``source`` (file:line:column or
            None), as in :class:`Fact`.

        Examples
        --------
        >>> import networkx as nx
        >>> from deixis.grammar.layout.parser import parse_script
        >>> graph = parse_script("fork left or above plate; cup right of saucer").graph().to_networkx()
        >>> graph["fork"]["plate"][0]["relations"]
        ('left', 'top')
        >>> [sorted(part) for part in nx.weakly_connected_components(graph)]
        [['fork', 'plate'], ['cup', 'saucer']]
        """
        import networkx as nx

        graph: nx.MultiDiGraph[Any] = nx.MultiDiGraph()
        for i, name in enumerate(self.nodes):
            box = None if self.boxes is None else self.boxes[i].tolist()
            kind, colour = (known[i] if known else None for known in (self.kinds, self.colours))
            graph.add_node(name, kind=kind, colour=colour, box=box)
        for fact in self.facts():
            graph.add_edge(
                fact.subject,
                fact.object,
                relations=tuple(relation.name for relation in fact.relations),
                positive=fact.positive,
                optional=fact.optional,
                weight=fact.weight,
                source=str(fact.source) if fact.source else None,
            )
        return graph

    def paper_view(self) -> PaperGraph:
        """Return the graph of Definition 1: one word per edge and one edge per ordered pair.

        It leaves out facts that are not a single affirmed relation of the ten, and rare facts, which amount to denials.
        Of several facts about one pair, it keeps the most specific label: the one that implies the most others, and the
        first stated of equals.

        Returns
        -------
        PaperGraph
            The labelled graph.
        """
        labels, label_of = self.vocabulary.paper_labels
        telling = np.array([len(r.broader) for r in self.vocabulary.values()])
        plain = np.flatnonzero(self.positive & self.affirmed & (np.bitwise_count(self.relation_sets) == 1))
        plain = plain[label_of[np.round(np.log2(self.relation_sets[plain])).astype(np.int64)] >= 0]
        relation = np.round(np.log2(self.relation_sets[plain])).astype(np.int64)
        pair = self.subjects[plain].astype(np.int64) * len(self.nodes) + self.objects[plain]
        order = np.lexsort((plain, -telling[relation], pair))
        first = order[np.flatnonzero(np.diff(pair[order], prepend=-1))]
        kept = np.sort(first)
        return PaperGraph(
            vertices=self.nodes,
            edges=np.stack([self.subjects[plain[kept]], self.objects[plain[kept]]], axis=1),
            edge_labels=label_of[relation[kept]],
            labels=labels,
        )


@dataclass(frozen=True, eq=False)
class PaperGraph:
    """Definition 1: G = (V, E, lambda, alpha, L_V, L_E), a directed graph with labelled vertices and edges.

    The label lambda of a vertex is its name.
    """

    vertices: tuple[str, ...]  # V, and L_V
    edges: NDArray[np.int32]  # E, shape (m, 2): from, to
    edge_labels: NDArray[np.int8]  # alpha, shape (m,): positions in ``labels``
    labels: tuple[str, ...]  # L_E

    def adjacency(self) -> NDArray[np.float64]:
        """Return one 0/1 matrix per label.

        Returns
        -------
        ndarray
            Matrices of shape (labels, n, n); axis 1 is the start of an edge, axis 2 its end.
        """
        n = len(self.vertices)
        matrices = np.zeros((len(self.labels), n, n))
        matrices[self.edge_labels, self.edges[:, 0], self.edges[:, 1]] = 1.0
        return matrices

    def histograms(self) -> NDArray[np.int64]:
        """Return the labelled edge histograms of Definition 2.

        Returns
        -------
        ndarray
            Counts of shape (n, 2, labels): incoming, then outgoing edges.

        Examples
        --------
        >>> graph = PaperGraph(("a", "b"), np.array([[0, 1]], np.int32), np.zeros(1, np.int8), ("left",))
        >>> graph.histograms().tolist()
        [[[0], [1]], [[1], [0]]]
        """
        counts = np.zeros((len(self.vertices), 2, len(self.labels)), dtype=np.int64)
        for (start, end), label in zip(self.edges.tolist(), self.edge_labels.tolist(), strict=True):
            counts[end, 0, label] += 1
            counts[start, 1, label] += 1
        return counts
