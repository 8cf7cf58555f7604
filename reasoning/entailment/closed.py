"""Closure of orders on the axes by bit sets: the implications of bounds for every pair of edges.

Bounds of the kinds < and <= between points are the convex part of the point algebra. Reachability, with or without a
strict step, decides it (Vilain, Kautz and van Beek 1990): an order of two points holds in every picture exactly if
there is a path for it. Objects that no facts connect are never compared, so each connected group has its own bit rows.
They are closed in one pass from the last points to the first: the row of a point is the union of the rows of its
successors. Time grows with bounds times objects / 64, memory with the square of the number of objects in a group.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.relation import Reading, Relation
from deixis.reasoning.constraints.paths import OrderGraph
from deixis.reasoning.entailment.bounds import AXES, Bound, EndpointBounds, meaning
from deixis.reasoning.errors import LimitError

MAX_CONNECTED = 12_000
"""Maximum number of objects that facts connect to one another; memory grows with its square."""

Words = NDArray[np.uint64]


@dataclass(frozen=True, eq=False)
class Groups:
    """n objects in g connected groups; the objects of a group are contiguous."""

    label: NDArray[np.int64]  # (n,): the group of each object
    place: NDArray[np.int64]  # (n,): the position of each object in its group
    nodes: NDArray[np.int64]  # (n,): the objects, sorted by group
    start: NDArray[np.int64]  # (g + 1,): the start of each group in ``nodes``

    @cached_property
    def sizes(self) -> NDArray[np.int64]:
        """Number of objects in each group, shape (g,)."""
        return np.diff(self.start)

    @cached_property
    def words(self) -> NDArray[np.int64]:
        """Number of 64-bit words with one bit per object, by group, shape (g,)."""
        return (self.sizes + 63) >> 6

    @cached_property
    def pair_start(self) -> NDArray[np.int64]:
        """Start of the (objects, objects) bit matrix of each group, shape (g + 1,)."""
        return np.concatenate([[0], np.cumsum(self.sizes * self.words)])

    def members(self, group: int) -> NDArray[np.int64]:
        """Return the objects of a group.

        Parameters
        ----------
        group
            Number of the group.

        Returns
        -------
        ndarray
            Positions of its objects, sorted.
        """
        return self.nodes[self.start[group] : self.start[group + 1]]


def groups_of(subjects: NDArray[np.integer], objects: NDArray[np.integer], n: int) -> Groups:
    """Return the connected groups of objects.

    Parameters
    ----------
    subjects, objects
        Positions of the ends of each edge, shape (k,).
    n
        Number of objects.

    Returns
    -------
    Groups
        The groups.

    Raises
    ------
    LimitError
        If a group has more than ``MAX_CONNECTED`` objects.
    """
    from deixis.reasoning.entailment.kernels import connected

    label, count = connected(subjects.astype(np.int64), objects.astype(np.int64), n)
    sizes = np.bincount(label, minlength=count)
    if n and sizes.max() > MAX_CONNECTED:
        raise LimitError(
            f"the facts connect {sizes.max()} objects to one another; inference allows at most "
            f"{MAX_CONNECTED}: describe the table in parts"
        )
    nodes = np.argsort(label, kind="stable")
    start = np.concatenate([[0], np.cumsum(sizes)])
    place = np.empty(n, np.int64)
    place[nodes] = np.arange(n) - start[label[nodes]]
    return Groups(label, place, nodes, start)


@dataclass(frozen=True, eq=False)
class AxisRows:
    """The closed bit rows of one axis, all groups in one flat array.

    Group k has 2 m rows for its m objects, low edges first. A row has 2 ``words[k]`` words: low edges, then high edges.
    """

    weak: Words  # bit set: the row's point is not after the column's
    strong: Words  # bit set: the row's point is before the column's
    start: NDArray[np.int64]  # (g + 1,): the start of each group


@dataclass(frozen=True, eq=False)
class Orders:
    """The orders that bounds imply; ``axes[k]`` is None if there are no bounds on axis k."""

    groups: Groups
    axes: tuple[AxisRows | None, ...]

    def implies(self, bound: Bound, subject: int, obj: int) -> bool:
        """Return whether a bound holds between two objects in every picture.

        Parameters
        ----------
        bound
            The bound.
        subject, obj
            Positions of the objects.

        Returns
        -------
        bool
            True if it holds.
        """
        rows = self.axes[bound.axis]
        label, place = self.groups.label, self.groups.place
        if rows is None or label[subject] != label[obj]:
            return False
        ends = (place[subject], place[obj])
        group = label[subject]
        size, words = int(self.groups.sizes[group]), int(self.groups.words[group])
        row = rows.start[group] + (bound.tail_side * size + ends[bound.tail]) * 2 * words
        column = int(ends[bound.head])
        bits = (rows.strong if bound.strict else rows.weak)[row + bound.head_side * words + (column >> 6)]
        return bool(int(bits) >> (column & 63) & 1)

    def relation_bits(self, relation: Relation) -> Words:
        """Return the pairs that have the relation in every picture, as the flat bit matrices of all groups.

        The matrix of a group has shape (objects, objects). Its diagonal is empty. A relation that is not a single
        conjunction of bounds has no pairs, and neither has a graded word, for which bounds are not sufficient.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        Words
            The bits in words.
        """
        if relation not in self._found:
            self._found[relation] = self._relation_bits(relation)
        return self._found[relation]

    @cached_property
    def _found(self) -> dict[Relation, Words]:
        return {}

    def _relation_bits(self, relation: Relation) -> Words:
        from deixis.reasoning.entailment.kernels import and_block, clear_diagonal

        groups = self.groups
        alternatives = meaning(relation)
        total = int(groups.pair_start[-1])
        if (
            relation.reading is Reading.GRADED
            or len(alternatives) != 1
            or any(self.axes[bound.axis] is None for bound in alternatives[0])
        ):
            return np.zeros(total, np.uint64)
        bits = np.full(total, ~np.uint64(0))
        for bound in alternatives[0]:
            rows = self.axes[bound.axis]
            assert rows is not None
            flat = rows.strong if bound.strict else rows.weak
            sides = (bound.tail_side, bound.head_side)
            and_block(bits, flat, groups.sizes, groups.pair_start, rows.start, *sides, bound.tail == 1)
        clear_diagonal(bits, groups.sizes, groups.pair_start)
        return bits

    def pairs(self, relation: Relation) -> NDArray[np.int64]:
        """Return the pairs that have a relation in every picture.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        ndarray
            Positions, shape (k, 2), by subject, then by object.
        """
        from deixis.reasoning.entailment.kernels import count_bits, list_pairs

        bits = self.relation_bits(relation)
        pairs = np.empty((count_bits(bits), 2), np.int64)
        groups = self.groups
        list_pairs(bits, groups.sizes, groups.pair_start, groups.start, groups.nodes, pairs)
        if len(groups.sizes) > 1:
            pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
        return pairs

    def count(self, relation: Relation) -> int:
        """Return the number of pairs that have the relation in every picture.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        int
            The number of ordered pairs.
        """
        from deixis.reasoning.entailment.kernels import count_bits

        return int(count_bits(self.relation_bits(relation)))


def order_graph(bounds: EndpointBounds, n: int) -> OrderGraph:
    """Return the graph of bounds between the 6 n points of n objects; each low edge is before its high edge.

    Parameters
    ----------
    bounds
        The bounds.
    n
        Number of objects.

    Returns
    -------
    OrderGraph
        The graph.
    """
    low = (np.arange(AXES)[:, None] * 2 * n + np.arange(n)).ravel()
    return OrderGraph.of(
        2 * AXES * n,
        np.concatenate([bounds.tail, low]),
        np.concatenate([bounds.head, low + n]),
        np.concatenate([bounds.strict, np.ones(len(low), np.bool_)]),
        np.concatenate([bounds.premise, np.full(len(low), -1)]),
    )


def orders_of(bounds: EndpointBounds, groups: Groups) -> Orders | None:
    """Close bounds between the edges of objects.

    Parameters
    ----------
    bounds
        The bounds.
    groups
        The connected groups of the objects.

    Returns
    -------
    Orders or None
        All implied orders, or None if no picture satisfies the bounds.
    """
    axes: list[AxisRows | None] = []
    n = len(groups.label)
    axis_of = bounds.tail // (2 * n) if n else bounds.tail
    for axis in range(AXES):
        chosen = axis_of == axis
        rows = _axis_rows(bounds, chosen, axis, groups) if chosen.any() else None
        if rows is None and chosen.any():
            return None
        axes.append(rows)
    return Orders(groups, tuple(axes))


def _axis_rows(bounds: EndpointBounds, chosen: NDArray[np.bool_], axis: int, groups: Groups) -> AxisRows | None:
    """Return the closed rows of an axis, or None if its bounds are inconsistent."""
    from deixis.reasoning.entailment.kernels import close

    n = len(groups.label)
    base, low = 2 * axis * n, np.arange(n)
    graph = OrderGraph.of(
        2 * n,
        np.concatenate([bounds.tail[chosen] - base, low]),
        np.concatenate([bounds.head[chosen] - base, low + n]),
        np.concatenate([bounds.strict[chosen], np.ones(n, np.bool_)]),
        np.concatenate([bounds.premise[chosen], np.full(n, -1)]),
    )
    if graph.contradictory:
        return None
    start = np.concatenate([[0], np.cumsum(4 * groups.sizes * groups.words)])
    words, sizes = groups.words[groups.label], groups.sizes[groups.label]
    bit = np.concatenate([groups.place, 64 * words + groups.place])
    row = start[groups.label] + 2 * words * groups.place
    rows = np.concatenate([row, row + 2 * words * sizes])
    weak, strong = np.zeros(start[-1], np.uint64), np.zeros(start[-1], np.uint64)
    close(graph.first, graph.heads, graph.strict, *graph.parts, bit, rows, np.tile(2 * words, 2), weak, strong)
    return AxisRows(weak, strong, start)
