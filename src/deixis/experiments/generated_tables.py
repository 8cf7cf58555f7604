"""Generate laid tables, descriptions of them with known mistakes, and the truth, to compare engines on.

Seats stand in rows; each is laid with some pieces of a formal setting, a little out of place. A description names some
of the pieces by facts between two of them, half of the facts between near neighbours and half between any two. A share
of the facts is wrong: its relation is replaced by a neighbouring one (the next direction around; any direction for a
piece that lies on another, and the reverse). ``missing`` described pieces are then removed from the table, ``extra``
ones were never described. The same seed gives the same table. Every piece has a kind, which a description may state or
omit. Other layouts put the same pieces in clusters, or in straight rows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.graph import Fact, RelationGraph
from deixis.ontology.relations.relation import Reading, Relations
from deixis.ontology.tbox import default_ontology
from deixis.reasoning.geometry.rectangle import SceneRelations, box_relations, scene_relations
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

# A formal setting: centre (x, y) from the middle of the dinner plate, then width and depth, in metres. The napkin lies
# on the dinner plate, the butter knife on the bread plate.
SETTING = {
    "dinner plate": (0.00, 0.00, 0.27, 0.27),
    "napkin": (0.00, 0.00, 0.16, 0.10),
    "dinner fork": (-0.17, 0.00, 0.025, 0.20),
    "salad fork": (-0.21, -0.01, 0.022, 0.17),
    "dinner knife": (0.17, 0.00, 0.022, 0.23),
    "fish knife": (0.21, 0.00, 0.022, 0.20),
    "soup spoon": (0.25, -0.01, 0.035, 0.18),
    "dessert fork": (0.00, 0.17, 0.16, 0.022),
    "dessert spoon": (0.00, 0.21, 0.17, 0.030),
    "bread plate": (-0.24, 0.19, 0.15, 0.15),
    "butter knife": (-0.24, 0.19, 0.14, 0.018),
    "water glass": (0.17, 0.20, 0.08, 0.08),
    "wine glass": (0.26, 0.23, 0.07, 0.07),
}
PIECES = np.array(list(SETTING.values()))
SEAT = np.array([0.75, 0.70])  # from one seat to the next, metres
JITTER = 0.015  # standard deviation of a piece's position, in metres
CLUSTER, CLUSTER_APART = 12, 1.0  # pieces of a cluster; approximate distance from one to the next, in metres
ROW_STEP = 0.3  # metres from one place of a row to the next, and from row to row
NEAR = 6  # number of near neighbours
RING = ("top", "top_right", "right", "bottom_right", "bottom", "bottom_left", "left", "top_left")


@dataclass(frozen=True, eq=False)
class GeneratedTable:
    """Perceived boxes (n2), m facts about n1 objects, and the truth: which box each object is."""

    boxes: NDArray[np.float64]  # (n2, 2, 2): minimum and maximum corner, metres
    ends: NDArray[np.int64]  # (m, 2): subject and object
    words: NDArray[np.int64]  # (m,): index of the stated exact relation
    off: NDArray[np.bool_]  # (m,): True if it was replaced by a neighbouring one
    truth: NDArray[np.int64]  # (n1,): which thing each object is, UNMATCHED where it is missing
    pieces: NDArray[np.int64]  # (n1,): which piece of SETTING each object is

    def description(self, *, kinds: bool = False) -> RelationGraph:
        """Return the facts as a description, in the wide reading of scripts.

        Parameters
        ----------
        kinds
            True to state the kind of each object too.

        Returns
        -------
        RelationGraph
            Graph of n1 objects named ``d0000``, ``d0001``, … and m facts.
        """
        ontology = default_ontology()
        relations = ontology.relations
        exact = list(relations.values())
        names = [f"d{i:04}" for i in range(len(self.truth))]
        facts = [
            Fact(names[s], (relations.wide(exact[word]),), names[o])
            for (s, o), word in zip(self.ends.tolist(), self.words.tolist(), strict=True)
        ]
        kind_iris = [ontology.kinds.words[piece].iri for piece in SETTING] if kinds else []
        return RelationGraph.from_facts(relations, names, facts, [kind_iris[i] for i in self.pieces] if kinds else ())

    def scene(self) -> SceneRelations:
        """Return the perceived scene: the exact relation of every ordered pair.

        Returns
        -------
        SceneRelations
            Relations of n2 things named ``o0000``, ``o0001``, …
        """
        names = [f"o{p:04}" for p in range(len(self.boxes))]
        return scene_relations(names, self.boxes, default_ontology().relations)

    def crisp(self, *, centred: bool = False) -> Problem:
        """Return the matching problem with crisp degrees.

        The degree is 1 if the exact relation is the word, 0.5 if it implies it, otherwise 0.

        Parameters
        ----------
        centred
            True to subtract each word's mean degree over the scene's pairs, so that a failing fact counts against a
            match and leaving an object out can be optimal.

        Returns
        -------
        Problem
            Problem with n1 objects, n2 things and m facts; without evidence about single objects.
        """
        relations = default_ontology().relations
        n1, n2 = len(self.truth), len(self.boxes)
        words, kinds = np.unique(self.words, return_inverse=True)
        tables = np.zeros((len(words), n2, n2), dtype=np.float32)
        if n2 > 1:
            names = box_relations(self.boxes, relations).names
            wide = [relations.wide(list(relations.values())[word]).index for word in words]
            degrees = np.concatenate([relations.degrees, np.zeros((len(relations.degrees), 1))], axis=1)
            for row, word in enumerate(wide):
                tables[row] = degrees[word][names]
                tables[row] -= float(tables[row].sum() / (n2 * (n2 - 1))) if centred else 0.0
        return Problem(self.ends, kinds.ravel().astype(np.int64), tables, np.zeros((n1, n2)), np.zeros(n1))


def generate(
    objects: int,
    facts_each: float = 2.5,
    off: float = 0.1,
    missing: int = 0,
    extra: int = 0,
    *,
    seed: int,
    layout: Layout | None = None,
) -> GeneratedTable:
    """Generate a table, a description of it with known mistakes, and the truth.

    Parameters
    ----------
    objects
        The number of described pieces.
    facts_each
        The number of facts per object.
    off
        The share of wrong facts, in [0, 1].
    missing
        The number of described pieces to remove from the table.
    extra
        The number of pieces that are not described.
    seed
        The seed of the table; the same arguments give the same table.
    layout
        The function that lays the pieces, one of ``LAYOUTS``; :func:`lay_boxes` if None.

    Returns
    -------
    The boxes, the facts and the truth.
    """
    rng = np.random.default_rng([seed, objects])
    boxes, pieces = (layout or lay_boxes)(objects + extra, rng)
    relations = default_ontology().relations
    ends = _draw_pairs(boxes, objects, round(facts_each * objects), rng)
    names = box_relations(boxes, relations).names[ends[:, 0], ends[:, 1]]
    wrong = np.zeros(len(ends), dtype=bool)
    wrong[rng.choice(len(ends), round(off * len(ends)), replace=False)] = True
    words = names.astype(np.int64)
    words[wrong] = [rng.choice(neighbours(int(name), relations)) for name in names[wrong]]
    kept = np.ones(len(boxes), dtype=bool)
    kept[rng.choice(objects, missing, replace=False)] = False
    shown = rng.permutation(np.flatnonzero(kept))
    truth = np.full(len(boxes), UNMATCHED, dtype=np.int64)
    truth[shown] = np.arange(len(shown))
    return GeneratedTable(boxes[shown], ends, words, wrong, truth[:objects], pieces[:objects])


def lay_boxes(count: int, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Lay seats, three quarters of the pieces each, in rows four times as long as deep; return boxes and pieces.

    Parameters
    ----------
    count
        Number of pieces.
    rng
        Random generator.

    Returns
    -------
    tuple of array
        Minimum and maximum corners in metres, shape (count, 2, 2), and indices into :data:`SETTING`, shape (count,).
    """
    seats = max(1, round(count / (0.75 * len(PIECES)) + 0.5))
    columns = max(1, round(2 * np.sqrt(seats)))
    places = np.stack([np.arange(seats) % columns, np.arange(seats) // columns], axis=1) * SEAT
    chosen = rng.permutation(seats * len(PIECES))[:count]
    seat, piece = np.divmod(chosen, len(PIECES))
    centres = places[seat] + PIECES[piece, :2] + rng.normal(0, JITTER, (count, 2))
    halves = PIECES[piece, 2:] * rng.uniform(0.9, 1.1, (count, 1)) / 2
    return np.stack([centres - halves, centres + halves], axis=1), piece.astype(np.int64)


def lay_clusters(count: int, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Lay any pieces in round clusters of about ``CLUSTER`` each, at random places; return boxes and pieces.

    Parameters
    ----------
    count
        Number of pieces.
    rng
        Random generator.

    Returns
    -------
    tuple of array
        Minimum and maximum corners in metres, shape (count, 2, 2), and indices into :data:`SETTING`, shape (count,).
    """
    clusters = max(1, round(count / CLUSTER))
    places = rng.uniform(0, 1, (clusters, 2)) * np.sqrt(clusters) * CLUSTER_APART
    centres = places[rng.integers(clusters, size=count)] + rng.normal(0, CLUSTER_APART / 4, (count, 2))
    return _boxes_at(centres, rng)


def lay_rows(count: int, rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Lay any pieces in straight rows, about twice as long as deep, slightly askew; return boxes and pieces.

    Parameters
    ----------
    count
        Number of pieces.
    rng
        Random generator.

    Returns
    -------
    tuple of array
        Minimum and maximum corners in metres, shape (count, 2, 2), and indices into :data:`SETTING`, shape (count,).
    """
    columns = max(1, round(np.sqrt(2 * count)))
    places = rng.permutation(columns * -(-count // columns))[:count]
    centres = np.stack([places % columns, places // columns], axis=1) * ROW_STEP
    return _boxes_at(centres + rng.normal(0, JITTER, (count, 2)), rng)


Layout = Callable[[int, np.random.Generator], tuple[NDArray[np.float64], NDArray[np.int64]]]

LAYOUTS: dict[str, Layout] = {"seats": lay_boxes, "clusters": lay_clusters, "rows": lay_rows}


def _boxes_at(centres: NDArray[np.float64], rng: np.random.Generator) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return a random piece for each centre (n, 2), as boxes (n, 2, 2), and its index (n,)."""
    piece = rng.integers(len(PIECES), size=len(centres))
    halves = PIECES[piece, 2:] * rng.uniform(0.9, 1.1, (len(centres), 1)) / 2
    return np.stack([centres - halves, centres + halves], axis=1), piece.astype(np.int64)


def _draw_pairs(boxes: NDArray[np.float64], objects: int, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Draw ordered pairs of different objects: half with a near one, half with any; no unordered pair twice."""
    near = nearest(boxes[:objects])
    count = min(count, objects * (objects - 1) // 2)
    found: dict[tuple[int, int], tuple[int, int]] = {}
    while len(found) < count:
        subject = int(rng.integers(objects))
        other = int(rng.choice(near[subject])) if rng.random() < 0.5 else int(rng.integers(objects))
        if subject != other:
            found.setdefault((min(subject, other), max(subject, other)), (subject, other))
    return np.array(list(found.values()), dtype=np.int64).reshape(-1, 2)


def nearest(boxes: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the :data:`NEAR` nearest others of every box, by their centres.

    Parameters
    ----------
    boxes
        Minimum and maximum corners in metres, shape (n, 2, 2).

    Returns
    -------
    array
        Indices of the others, the nearest first, shape (n, min(NEAR, n - 1)).
    """
    centres = boxes.mean(axis=1)
    distance = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    return np.argsort(distance, axis=1)[:, 1 : NEAR + 1]


def neighbours(name: int, relations: Relations) -> list[int]:
    """Return the neighbours of an exact relation: the directions beside it; all directions for *on* and *under*.

    Parameters
    ----------
    name
        Index of the exact relation.
    relations
        All relations of the ontology.

    Returns
    -------
    list of int
        Indices of exact relations: two for a direction, eight for another relation.
    """
    word = list(relations.values())[name].word
    around = RING.index(word) if word in RING else -1
    near = [RING[around - 1], RING[(around + 1) % len(RING)]] if word in RING else list(RING)
    exact = {relation.word: relation.index for relation in relations.of_reading(Reading.EXACT)}
    return [exact[other] for other in near]
