"""The similarity of a scene and a layout.

The similarity follows Nedas and Egenhofer ("Spatial-Scene Similarity Queries", Transactions in GIS 2008): corresponding
objects and relations are compared by degrees, and anything without a counterpart counts as incompleteness. Both parts
are Dice's coefficients over the best grounding: twice the degrees of correspondence, divided by the total of both
sides. Objects have two thirds of the weight and relations one third; objects have all of it if no relations are stated.
So the similarity is 1 exactly if everything corresponds, and symmetric between two fully related scenes of at least two
objects.

- Objects correspond by kind: the degree halves with every kind, itself and broader ones, that only one of them has. A
  word for no known kind is its own kind (:func:`deixis.reasoning.grounding.evidence.properties.labels.classes`), of the
  objects with that name, numbers aside, and is similar to no other kind. An unlabelled object corresponds as far as its
  size is usual for the kind; in an image, its size relative to the others. Without any knowledge it corresponds fully.
- A size is fully usual within two deviations of the kind's, and less so outside, as a Gaussian of its logarithm.
- Relations correspond by the steps between directions: the degree halves with every step from the nearest exact
  relation that the stated relation admits.
- A direction is one of the 3 by 3 tiles around a box. The steps between two directions are the tiles from one to the
  other, two for a diagonal (Goyal and Egenhofer, "Similarity of Cardinal Directions", SSTD 2001). *On* and *under*
  share the middle tile, two steps apart.
- A layout states few of all relations, while a scene has them all. So as many relations of the scene need a counterpart
  as the layout would state of as many objects.

Both denominators are constants, and no term is below 0. So the best grounding is the optimum of a matching problem
whose value is the similarity itself.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.sizes import SizeModel
from deixis.ontology.relations.allen import Allen, allen_mask
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.ontology.tbox import Ontology
from deixis.ontology.things.kinds import Kinds
from deixis.ontology.things.sizes import Sizes
from deixis.reasoning.geometry.rectangle import SceneRelations
from deixis.reasoning.grounding.evidence.properties.labels import category_of, classes
from deixis.reasoning.grounding.evidence.properties.unary import log_sizes, looks_in_image
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem

Array = NDArray[np.float64]

SIZE_SPREAD = 0.35
"""Distance from the usual range, in natural logarithms of length, at which the similarity has fallen to exp(-1/2)."""


def usual_sizes(
    kinds: Sequence[str], boxes: NDArray[np.float64], sizes: Sizes, learned: Mapping[str, SizeModel], metric: bool
) -> dict[str, Array]:
    """Return how usual the sizes of n boxes are for some kinds, shape (n,) each, in [0, 1].

    Parameters
    ----------
    kinds
        Class IRIs of the kinds.
    boxes
        Minimum and maximum corners, shape (n, 2, d).
    sizes
        The usual sizes, in metres.
    learned
        Learned size models by class IRI, which replace the usual sizes.
    metric
        Whether boxes are in metres. If they are in pixels, sizes in metres are compared relative to each other, seen
        from above or from the side, whichever fits better. A kind without a known size fits every box.

    Returns
    -------
    dict
        Degrees in [0, 1] by kind, shape (n,) each.
    """
    if metric:
        extents = np.sort(boxes[:, 1, :2] - boxes[:, 0, :2], axis=1)[:, ::-1]
        logs = np.log(np.maximum(extents, 1e-9))
        return {kind: _within(logs, *_range(kind, sizes, learned)) for kind in dict.fromkeys(kinds)}
    from scipy.optimize import linear_sum_assignment

    logs = log_sizes(boxes, relative=True)
    best, usual = -1.0, {}
    for looks in looks_in_image(kinds, sizes, learned):
        # An object of a kind may appear in several ways in an image: the most similar one counts.
        view = dict.fromkeys(kinds, np.ones(len(boxes)))
        for kind in view.keys() & looks.keys():
            spread = 2 * looks[kind].spread
            ways = [_within(logs, centre - spread, centre + spread) for centre in looks[kind].centres]
            view[kind] = np.max(ways, axis=0)
        # The fit of the whole scene is the sum over the best assignment.
        table = np.array([view[kind] for kind in kinds])
        fit = float(table[linear_sum_assignment(table, maximize=True)].sum()) if table.size else 0.0
        if fit > best:
            best, usual = fit, view
    return usual


def _within(logs: Array, least: Array, greatest: Array) -> Array:
    beyond = np.maximum(0.0, np.maximum(least - logs, logs - greatest))
    result: Array = np.exp(-(beyond**2).sum(axis=1) / (2 * SIZE_SPREAD**2))
    return result


def _range(kind: str, sizes: Sizes, learned: Mapping[str, SizeModel]) -> tuple[Array, Array]:
    """Return the least and greatest logarithms of length and width, each (2,); two deviations from a learned mean."""
    model = learned.get(kind)
    if model is None or model.relative:
        usual = sizes.of(kind)
        ranges = usual.length, usual.width
        handle = np.log1p([0.0 if usual.reach is None else usual.reach.greatest, 0.0])
        return np.log([one.least for one in ranges]), np.log([one.greatest for one in ranges]) + handle
    (length, spread), (aspect, other) = model.length, model.aspect
    typical, off = np.array([length, length + aspect]), 2 * np.array([spread, math.hypot(spread, other)])
    return typical - off, typical + off


STEP_FACTOR = 0.5
"""Factor of the similarity for every step, which falls exponentially with distance (Shepard 1987)."""


class Closeness:
    """Degree of each exact relation for a fact, by relation index: 1 if admitted, halved with every step from that."""

    def __init__(self, vocabulary: Relations) -> None:
        self._vocabulary = vocabulary
        exact = vocabulary.of_reading(Reading.EXACT)
        tiles = {relation.index: _tile(relation) for relation in exact}
        self._steps = {
            (a, b): sum(abs(x - y) for x, y in zip(tiles[a], tiles[b], strict=True)) for a in tiles for b in tiles
        }
        self._names = tuple(tiles)
        self._known: dict[tuple[int, bool], Array] = {}

    def __call__(self, mask: int, positive: bool) -> Array:
        """Return the degree of each exact relation for a set of admitted relations, or for its denial."""
        if (mask, positive) in self._known:
            return self._known[mask, positive]
        members = [relation.index for relation in self._vocabulary.members(mask)]
        implied = self._vocabulary.degrees[members].max(axis=0, initial=0.0) > 0
        admitted = [name for name in self._names if implied[name] == positive]
        result = np.zeros(len(self._vocabulary))
        for name in self._names:
            if admitted:
                result[name] = STEP_FACTOR ** min(self._steps[name, other] for other in admitted)
        self._known[mask, positive] = result
        return result


def _tile(relation: Relation) -> tuple[int, int, int]:
    """Return the subject's position relative to the object: -1, 0 or 1 on x and y, and 1 on top of it or -1 below."""
    before, after = allen_mask([Allen.BEFORE, Allen.MEETS]), allen_mask([Allen.AFTER, Allen.MET_BY])
    x, y = (
        -1 if not atoms & ~before else 1 if not atoms & ~after else 0 for atoms in (relation.x_atoms, relation.y_atoms)
    )
    above = 0 if x or y else 1 if relation.word == "on" else -1
    return x, y, above


OBJECT_WEIGHT = 2 / 3
"""Weight of objects in the similarity; relations have the rest.

Of 1/3, 1/2, 3/5 and 2/3, this value retrieved best in ``benchmarks/bench_retrieval.py`` with seed 2.
"""


@dataclass(frozen=True, eq=False)
class Described:
    """A layout prepared for comparison: its kinds of objects, and its facts as sets of admitted exact relations."""

    name: str
    graph: RelationGraph

    @cached_property
    def named_kinds(self) -> tuple[tuple[str, str], ...]:
        """Class of each object and category of its name, both as IRIs."""
        return tuple(
            (kind, category_of(node)) for kind, node in zip(classes(self.graph), self.graph.nodes, strict=True)
        )

    @cached_property
    def edges(self) -> NDArray[np.int64]:
        """Facts that can be compared, which are all except those of an object to itself."""
        return np.flatnonzero(self.graph.subjects != self.graph.objects)

    @cached_property
    def weights(self) -> Array:
        """Weights of the comparable facts."""
        return self.graph.net_weights[self.edges]

    @cached_property
    def total(self) -> float:
        """Total weight of the comparable facts."""
        return float(self.weights.sum())

    @cached_property
    def densest(self) -> Array:
        """Weights of the facts about each ordered pair, the largest first."""
        n = len(self.graph.nodes)
        pair = self.graph.subjects[self.edges].astype(np.int64) * n + self.graph.objects[self.edges]
        sums = np.bincount(pair, self.weights).astype(np.float64)
        result: Array = np.sort(sums[sums > 0])[::-1]
        return result


@dataclass(frozen=True, eq=False)
class ComparedScene:
    """A scene prepared for comparison: exact relations of pairs, classes of the labels (IRI or None), boxes or None.

    ``metric`` is True for boxes in metres, and False for boxes in pixels.
    """

    name: str
    ids: tuple[str, ...]  # (n2,)
    names: NDArray[np.int8]  # (n2, n2), -1 on the diagonal
    kinds: tuple[str | None, ...]  # (n2,)
    boxes: Array | None  # (n2, 2, d)
    metric: bool = True

    @cached_property
    def counts(self) -> NDArray[np.int64]:
        """Number of ordered pairs with each exact relation, by relation index."""
        named = self.names[self.names >= 0]
        return np.bincount(named) if len(named) else np.zeros(0, np.int64)


def compared_scene(name: str, scene: SceneRelations, metric: bool = True) -> ComparedScene:
    """Prepare a scene for comparison.

    Parameters
    ----------
    name
        Name of the scene.
    scene
        Its relations; ``scene.kinds`` are the classes of its labels.
    metric
        True for a scene in metres, False in pixels.

    Returns
    -------
    ComparedScene
        The scene with the numbers that comparisons need.
    """
    kinds = scene.kinds or (None,) * len(scene.nodes)
    return ComparedScene(name, scene.nodes, scene.names, kinds, scene.boxes, metric)


@dataclass(frozen=True, eq=False)
class Likeness:
    """The similarity of a scene and a layout in [0, 1], and the grounding that gives it, shape (n1,).

    ``similarity`` is the weighted mean of ``objects`` and ``relations``, or ``objects`` alone if there are no facts.
    ``proved`` is True if no other grounding gives a larger similarity.
    """

    layout: str
    scene: str
    similarity: float
    objects: float
    relations: float
    assignment: NDArray[np.int64]
    proved: bool


@dataclass(frozen=True, slots=True)
class Shares:
    """Weights of objects and relations, and the totals of both sides."""

    objects: float
    relations: float
    things: int
    facts: float


class Comparison:
    """A comparison of layouts with scenes, which caches the degrees of relations and kinds.

    ``learned`` sizes, by class IRI, replace the usual ones of the TBox; relative ones only for scenes in pixels.
    """

    def __init__(self, ontology: Ontology, learned: Mapping[str, SizeModel] | None = None) -> None:
        self._learned = dict(learned or {})
        self._kinds: Kinds = ontology.kinds
        self._sizes: Sizes = ontology.sizes
        self.closeness = Closeness(ontology.relations)
        self._of_kinds: dict[tuple[str, str], float] = {}

    def likeness(self, layout: Described, scene: ComparedScene, deadline: Deadline = Deadline.never()) -> Likeness:
        """Return the similarity of a layout and a scene by the best grounding found.

        Parameters
        ----------
        layout
            The layout.
        scene
            The scene.
        deadline
            Time limit; the similarity is then a lower bound.

        Returns
        -------
        Likeness
            Similarity, matches, and whether it is proved.
        """
        from deixis.reasoning.grounding.matching.search.exact import exact

        problem = self.problem(layout, scene)
        best = exact(problem, deadline)
        shares = self.shares(layout, scene)
        matched = np.flatnonzero(best.assignment != UNMATCHED)
        objects = float(problem.unary[matched, best.assignment[matched]].sum())
        relations = problem.value(best.assignment) - objects
        of_objects = objects / shares.objects if shares.objects else 0.0
        of_relations = relations / shares.relations if shares.relations else 0.0
        similarity = round(min(1.0, objects + relations), 6)  # tables are of single precision
        return Likeness(
            layout.name,
            scene.name,
            similarity,
            round(min(1.0, of_objects), 6),
            round(min(1.0, of_relations), 6),
            best.assignment,
            best.proved,
        )

    def problem(self, layout: Described, scene: ComparedScene) -> Problem:
        """Return the matching problem in which the value of a map is the similarity that it gives.

        Parameters
        ----------
        layout
            The layout.
        scene
            The scene.

        Returns
        -------
        Problem
            The matching problem.
        """
        shares, n2 = self.shares(layout, scene), len(scene.names)
        graph = layout.graph
        edges = layout.edges
        columns = graph.relation_sets[edges], graph.affirmed[edges], layout.weights
        keys = list(zip(*(column.tolist() for column in columns), strict=True))
        distinct = list(dict.fromkeys(keys))
        tables = np.zeros((len(distinct), n2, n2), dtype=np.float32)
        for row, (mask, positive, weight) in enumerate(distinct):
            close = self.closeness(int(mask), bool(positive))
            named_kinds = np.where(scene.names >= 0, close[scene.names], 0.0)
            tables[row] = named_kinds * (2 * shares.relations * weight / shares.facts)
        positions = {key: row for row, key in enumerate(distinct)}
        ends = np.stack([graph.subjects[layout.edges], graph.objects[layout.edges]], axis=1).astype(np.int64)
        kinds = np.array([positions[key] for key in keys], dtype=np.int64)
        unary = self.objects(layout, scene) * (2 * shares.objects / max(shares.things, 1))
        return Problem(ends, kinds, tables, unary, np.zeros(len(graph.nodes)))

    def objects(self, layout: Described, scene: ComparedScene) -> Array:
        """Return the degree to which each object corresponds to each thing, shape (n1, n2), in [0, 1].

        Parameters
        ----------
        layout
            A layout of n1 objects.
        scene
            A scene of n2 things.

        Returns
        -------
        Array
            Degrees in [0, 1], shape (n1, n2).
        """
        named_kinds = layout.named_kinds
        sized = [kind for kind, _ in named_kinds if kind in self._kinds or kind in self._learned]
        usual: Mapping[str, Array] = {}
        if scene.boxes is not None and len(scene.boxes):
            usual = usual_sizes(sized, scene.boxes, self._sizes, self._learned, scene.metric)
        alike = {pair: self._like(*pair, scene, usual) for pair in dict.fromkeys(named_kinds)}
        return np.array([alike[pair] for pair in named_kinds]).reshape(len(named_kinds), len(scene.kinds))

    def _like(self, kind: str, name: str, scene: ComparedScene, usual: Mapping[str, Array]) -> Array:
        """Return how far each thing (n2,) corresponds to an object, by its kind, its size or its exact name."""
        found = usual[kind].copy() if kind in usual else np.ones(len(scene.kinds))
        for p, label in enumerate(scene.kinds):
            if label is not None:
                found[p] = 1.0 if label == name else self._kinship(kind, label)
        return found

    def _kinship(self, a: str, b: str) -> float:
        """Return 1 for equal kinds, times ``STEP_FACTOR`` for every kind that only one of them has, itself included.

        It is 0 if the kinds differ and one is not a known kind.
        """
        if (a, b) not in self._of_kinds:
            self._of_kinds[a, b] = float(a == b)
            if a in self._kinds and b in self._kinds:
                first, second = ({iri, *self._kinds[iri].broader} for iri in (a, b))
                self._of_kinds[a, b] = float(STEP_FACTOR ** len(first ^ second))
        return self._of_kinds[a, b]

    def shares(self, layout: Described, scene: ComparedScene) -> Shares:
        """Return the weights of both parts, and the number of objects and the weight of facts on both sides.

        Parameters
        ----------
        layout
            The layout.
        scene
            The scene.

        Returns
        -------
        Shares
            Both weights with the counts.
        """
        n1, n2 = len(layout.graph.nodes), len(scene.names)
        if not layout.total:
            return Shares(1.0, 0.0, n1 + n2, 1.0)
        pairs = n2 * (n2 - 1)
        density = layout.total / (n1 * (n1 - 1))
        counterpart = max(density * pairs, float(layout.densest[:pairs].sum()))
        return Shares(OBJECT_WEIGHT, 1 - OBJECT_WEIGHT, n1 + n2, layout.total + counterpart)
