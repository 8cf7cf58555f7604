"""The rectangle algebra of boxes: the atom of every ordered pair, and the one of ten exact relations that it has.

An atom is a pair of Allen relations, between the projections on x and on y (Balbiani, Condotta and Fariñas del Cerro
1998), with a third one on z if heights are known. The exact relation is the one whose definition in the TBox admits the
atom. Three kinds of pairs need more than the planar atom. They are handled in this order:

1. Projections that overlap on both axes, with known heights: *on* or *under*, if z decides it.
2. Boxes that overlap in part (neither within the other): the larger offset of the two centres names the pair, or the x
   axis if both offsets are equal.
3. Boxes with the same centre that are equal or cross: the one listed later lies on the one listed earlier.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.ontology.graph.graph import PaperGraph, RelationGraph
from deixis.ontology.relations.allen import SYMBOLS, Allen
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.geometry.poses import Poses

ROW_CELLS = 1 << 18
"""Maximum number of pairs that are related at a time."""


@dataclass(frozen=True, eq=False)
class BoxRelations:
    """The atoms and exact relations of all ordered pairs of n boxes; row: subject, column: object."""

    x: NDArray[np.int8]  # (n, n) Allen codes
    y: NDArray[np.int8]  # (n, n) Allen codes
    z: NDArray[np.int8] | None  # (n, n) Allen codes, or None if heights are not known
    names: NDArray[np.int8]  # (n, n) relation indices of the exact reading; -1 on the diagonal

    def atom(self, subject: int, object: int) -> str:
        """Return the atom of a pair in the notation of QSRlib.

        Parameters
        ----------
        subject, object
            Positions of the two boxes.

        Returns
        -------
        str
            The Allen symbols on x and y (and z), separated by commas.
        """
        axes = (self.x, self.y) if self.z is None else (self.x, self.y, self.z)
        return ",".join(SYMBOLS[axis[subject, object]] for axis in axes)


def box_relations(
    boxes: NDArray[np.float64],
    vocabulary: Relations,
    tolerance: float = 0.0,
    ranks: NDArray[np.int64] | None = None,
) -> BoxRelations:
    """Compute the atom and the exact relation of every ordered pair of boxes.

    Parameters
    ----------
    boxes
        Minimum and maximum corners, shape (n, 2, d), d = 2 or 3, in metres: x to the viewer's right, y away from the
        viewer, z up.
    vocabulary
        The relations to name the pairs by.
    tolerance
        Distance in metres up to which two end points count as equal.
    ranks
        Order of the boxes for equal or crossing boxes of one centre, shape (n,); by default their positions.

    Returns
    -------
    BoxRelations
        Allen codes by axis and names of the exact relations, shape (n, n).

    Raises
    ------
    GraphError
        If ``boxes`` have another shape, are not finite, or have a greatest corner below the least.

    Examples
    --------
    >>> from deixis.ontology.tbox import default_ontology
    >>> relations = default_ontology().relations
    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> related = box_relations(np.array([fork, plate]), relations)
    >>> related.atom(0, 1), relations.members(1 << int(related.names[0, 1]))[0].name
    ('<,d', 'exactly_left')
    """
    require_boxes(boxes)
    order = np.arange(len(boxes)) if ranks is None else ranks
    codes, names = _related(boxes, order, slice(0, len(boxes)), vocabulary, tolerance)
    return BoxRelations(codes[0], codes[1], codes[2] if len(codes) == 3 else None, names)


@dataclass(frozen=True, eq=False)
class SceneRelations:
    """The objects of a scene and the exact relation of every ordered pair, which grounding compares a description with.

    ``names`` holds the indices of exact relations in ``vocabulary``; the row is the subject. The complete relation
    graph of n (n - 1) edges (:meth:`graph`) is a view for export.

    >>> from deixis.ontology.tbox import default_ontology
    >>> relations = default_ontology().relations
    >>> scene = scene_relations(["fork", "plate"], np.array([[[0, 0], [1, 1]], [[2, 0], [3, 1]]], float), relations)
    >>> scene.relation(0, 1).name
    'exactly_left'
    >>> [str(fact) for fact in scene.graph().facts()]
    ['exactly_left(fork, plate)', 'exactly_right(plate, fork)']
    """

    vocabulary: Relations
    nodes: tuple[str, ...]  # (n,)
    names: NDArray[np.int8]  # (n, n): relation indices, -1 on the diagonal
    boxes: NDArray[np.float64] | None = None  # (n, 2, d): minimum and maximum corner
    kinds: tuple[str | None, ...] = ()  # (n,) class IRIs, or empty
    poses: Poses | None = None  # of the n objects; None: axes along the sides of the boxes, no fronts

    def index(self, node: str) -> int:
        """Return the position of an object.

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
            If no object has that name.
        """
        try:
            return self.nodes.index(node)
        except ValueError:
            raise GraphError(f"the scene has no object '{node}'") from None

    def relation(self, subject: int, object: int) -> Relation:
        """Return the exact relation of an ordered pair of different objects.

        Parameters
        ----------
        subject, object
            Positions of two different objects.

        Returns
        -------
        Relation
            The relation.
        """
        return self.vocabulary.members(1 << int(self.names[subject, object]))[0]

    def reordered(self, order: NDArray[np.int64]) -> SceneRelations:
        """Return the scene with its objects in another order, or with some of them.

        Parameters
        ----------
        order
            Present positions of the objects to keep, in their new order, shape (k,).

        Returns
        -------
        SceneRelations
            The scene of k objects.
        """
        return SceneRelations(
            self.vocabulary,
            tuple(self.nodes[i] for i in order),
            self.names[np.ix_(order, order)],
            None if self.boxes is None else self.boxes[order],
            tuple(self.kinds[i] for i in order) if self.kinds else (),
            None if self.poses is None else self.poses[order],
        )

    def graph(self) -> RelationGraph:
        """Return the complete relation graph.

        Returns
        -------
        RelationGraph
            One edge per ordered pair, by subject, then by object.
        """
        subjects, objects = np.nonzero(~np.eye(len(self.nodes), dtype=bool))
        m = len(subjects)
        return RelationGraph(
            vocabulary=self.vocabulary,
            nodes=self.nodes,
            subjects=subjects.astype(np.int32),
            objects=objects.astype(np.int32),
            relation_sets=np.int64(1) << self.names[subjects, objects].astype(np.int64),
            positive=np.ones(m, dtype=bool),
            optional=np.zeros(m, dtype=bool),
            weights=np.ones(m),
            kinds=self.kinds,
            boxes=self.boxes,
        )

    def paper_view(self) -> PaperGraph:
        """Return the graph of Definition 1, with the word of every ordered pair as its edge label.

        Returns
        -------
        PaperGraph
            The graph, with the word of every ordered pair as its edge label.
        """
        labels, label_of = self.vocabulary.paper_labels
        subjects, objects = np.nonzero(self.names >= 0)
        return PaperGraph(
            vertices=self.nodes,
            edges=np.stack([subjects, objects], axis=1).astype(np.int32),
            edge_labels=label_of[self.names[subjects, objects]],
            labels=labels,
        )


def scene_relations(
    ids: Sequence[str],
    boxes: NDArray[np.float64],
    vocabulary: Relations,
    kinds: Sequence[str | None] = (),
    tolerance: float = 0.0,
    deadline: Deadline = Deadline.never(),
) -> SceneRelations:
    """Compute the exact relation of every ordered pair of the objects of a scene.

    Parameters
    ----------
    ids
        Names of the n objects. The order of the ids decides between equal or crossing boxes of one centre, so that the
        order of listing does not matter.
    boxes
        Minimum and maximum corners in metres, shape (n, 2, d), d = 2 or 3.
    vocabulary
        The relations to name the pairs by.
    kinds
        Class IRIs of the objects, or empty.
    tolerance
        Distance in metres up to which two end points count as equal.
    deadline
        Time limit.

    Returns
    -------
    SceneRelations
        The exact relations, shape (n, n), with the ids and kinds.

    Raises
    ------
    GraphError
        If the boxes are invalid, or the ids are not n different ones.
    OutOfTimeError
        At the ``deadline``.
    """
    if len(ids) != len(boxes) or len(set(ids)) != len(ids):
        raise GraphError(f"a scene of {len(boxes)} boxes must have {len(boxes)} different ids, got {len(set(ids))}")
    require_boxes(boxes)
    n = len(boxes)
    ranks = np.argsort(np.argsort(np.array(ids, dtype=np.str_)))
    names = np.empty((n, n), np.int8)
    step = max(1, ROW_CELLS // max(n, 1))
    for start in range(0, n, step):
        if start and deadline.passed:
            raise OutOfTimeError(f"time limit reached while relating {n} objects; raise it, or use fewer objects")
        rows = slice(start, start + step)
        names[rows] = _related(boxes, ranks, rows, vocabulary, tolerance)[1]
    return SceneRelations(vocabulary, tuple(ids), names, boxes, tuple(kinds))


def require_boxes(boxes: NDArray[np.float64]) -> None:
    """Raise GraphError unless boxes have shape (n, 2, 2) or (n, 2, 3), finite corners, and ordered corners.

    Parameters
    ----------
    boxes
        The boxes.

    Raises
    ------
    GraphError
        If they have not.
    """
    if boxes.ndim != 3 or boxes.shape[1] != 2 or boxes.shape[2] not in (2, 3):
        raise GraphError(f"boxes must have shape (n, 2, 2) or (n, 2, 3), got {boxes.shape}")
    if not np.isfinite(boxes).all():
        bad = int(np.flatnonzero(~np.isfinite(boxes).all(axis=(1, 2)))[0])
        raise GraphError(f"the corners of box {bad} must be finite, got {boxes[bad].tolist()}")
    if (boxes[:, 1] < boxes[:, 0]).any():
        bad = int(np.flatnonzero((boxes[:, 1] < boxes[:, 0]).any(axis=1))[0])
        raise GraphError(f"the lower corner of box {bad} must not be above the upper one, got {boxes[bad].tolist()}")


def cross_relations(
    subjects: NDArray[np.float64],
    objects: NDArray[np.float64],
    ranks: tuple[NDArray[np.int64], NDArray[np.int64]],
    vocabulary: Relations,
    tolerance: float = 0.0,
) -> tuple[list[NDArray[np.int8]], NDArray[np.int8]]:
    """Compute the relations of r boxes with n others.

    Where a box is paired with itself, its name means nothing.

    Parameters
    ----------
    subjects
        The r boxes, shape (r, 2, d).
    objects
        The n boxes, shape (n, 2, d).
    ranks
        Order of listing of both, shapes (r,) and (n,).
    vocabulary
        The relations to name the pairs by.
    tolerance
        Distance in metres up to which two end points count as equal.

    Returns
    -------
    tuple
        Allen codes by axis and names of the exact relations, each of shape (r, n).
    """
    codes = [
        allen_relations(
            subjects[:, None, 0, axis],
            subjects[:, None, 1, axis],
            objects[None, :, 0, axis],
            objects[None, :, 1, axis],
            tolerance,
        )
        for axis in range(objects.shape[2])
    ]
    x, y = codes[:2]
    exact = vocabulary.of_reading(Reading.EXACT)
    table = _name_table(exact)
    names = table[x, y]
    overlapping = _overlap_mask()[x] & _overlap_mask()[y]
    undecided = names < 0
    if len(codes) == 3:
        for relation in exact:
            if relation.z_atoms:
                settled = overlapping & (relation.z_atoms >> codes[2].astype(np.int64) & 1).astype(bool)
                names = np.where(settled, np.int8(relation.index), names)
                undecided &= ~settled
    return codes, np.where(undecided, _offset_names(subjects, objects, table, ranks), names)


def _related(
    boxes: NDArray[np.float64], ranks: NDArray[np.int64], rows: slice, vocabulary: Relations, tolerance: float
) -> tuple[list[NDArray[np.int8]], NDArray[np.int8]]:
    """Return the relations of some boxes (rows) to all boxes; the name of a box with itself is -1."""
    codes, names = cross_relations(boxes[rows], boxes, (ranks[rows], ranks), vocabulary, tolerance)
    own = np.arange(len(boxes))[rows]
    names[np.arange(len(own)), own] = -1
    return codes, names


def _name_table(exact: Sequence[Relation]) -> NDArray[np.int8]:
    """Return the exact relation that alone admits each planar atom, shape (13, 13); -1 for none or several."""
    admitted = np.stack([relation.admits() for relation in exact])
    table = np.full((13, 13), -1, dtype=np.int8)
    single = admitted.sum(axis=0) == 1
    indices = np.array([relation.index for relation in exact], dtype=np.int8)
    table[single] = indices[admitted.argmax(axis=0)[single]]
    return table


def _overlap_mask() -> NDArray[np.bool_]:
    """Return which Allen relations share more than an end point, shape (13,)."""
    codes = np.arange(13)
    return (codes > Allen.MEETS) & (codes < Allen.MET_BY)


def _offset_names(
    subjects: NDArray[np.float64],
    objects: NDArray[np.float64],
    table: NDArray[np.int8],
    ranks: tuple[NDArray[np.int64], NDArray[np.int64]],
) -> NDArray[np.int8]:
    """Return the relations by the larger offset of the centres on x and y, or by rank if both are zero."""
    here, there = subjects.mean(axis=1), objects.mean(axis=1)
    dx = here[:, None, 0] - there[None, :, 0]
    dy = here[:, None, 1] - there[None, :, 1]
    left, right = table[Allen.BEFORE, Allen.EQUALS], table[Allen.AFTER, Allen.EQUALS]
    bottom, top = table[Allen.EQUALS, Allen.BEFORE], table[Allen.EQUALS, Allen.AFTER]
    on, under = table[Allen.DURING, Allen.DURING], table[Allen.CONTAINS, Allen.CONTAINS]
    by_x = np.where(dx < 0, left, right)
    by_y = np.where(dy < 0, bottom, top)
    later = ranks[0][:, None] > ranks[1][None, :]
    by_order = np.where(later, on, under)
    names = np.where(np.abs(dx) >= np.abs(dy), by_x, by_y)
    named: NDArray[np.int8] = np.where((dx == 0) & (dy == 0), by_order, names).astype(np.int8)
    return named
