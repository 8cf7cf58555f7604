"""Evidence of claims: places, sizes, orders, distances and arrangements as log-likelihood ratios for matching.

A claim about one object becomes evidence of its matches, a claim about two objects a table of pairs, as a fact does. A
claim about three objects (*between*) becomes two tables, of the subject with each of the others. Each averages the
degree over the things that the third object may be, in proportion to the evidence for it without facts, and has half of
the weight, so that the claim counts at most once. The exact value of a map for all three is not computed.

The ratio is that of facts: log(outliers + (1 - outliers) d) minus its value for a random thing, pair or triple of the
scene. It is finite, so that no claim rules a match out. A claim that a scene cannot decide (a material, the contents of
a cup, a distance in a photograph) adds nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph.claims import EACH_OTHER, PLACES, ROW_ORDERS, Claim
from deixis.ontology.models.relations import RelationModels
from deixis.ontology.relations.relation import Relations
from deixis.reasoning.geometry.overlap import gaps
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.grounding.evidence.claims.aims import AIMING, aim_degrees
from deixis.reasoning.grounding.evidence.claims.places import lean_in_things, lean_on_surface, place_degree
from deixis.reasoning.grounding.evidence.facts.facts import hedged
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees
from deixis.reasoning.grounding.evidence.words.meaning import BORDER, EXTREME, OUTLIERS

Array = NDArray[np.float64]

MAX_THINGS = 200
"""Maximum number of things of a scene in which claims are evaluated: triples take memory by its third power."""

TIE = 1e-9
"""Difference of lengths below which they are equal."""

OPTIONAL_SHARE = 0.5
"""Probability that an optional claim holds."""

MEASURES: dict[str, tuple[Callable[[Array], Array], int]] = {
    "largest": (lambda boxes: _mean_extent(boxes), 1),
    "smallest": (lambda boxes: _mean_extent(boxes), -1),
    "tallest": (lambda boxes: _extents(boxes)[:, -1], 1),
    "shortest": (lambda boxes: _extents(boxes)[:, -1], -1),
    "longest": (lambda boxes: _extents(boxes).max(axis=1), 1),
    "widest": (lambda boxes: _extents(boxes)[:, 0], 1),
    "leftmost": (lambda boxes: boxes[:, :, 0].mean(axis=1), -1),
    "rightmost": (lambda boxes: boxes[:, :, 0].mean(axis=1), 1),
}
"""Measure of boxes (n, 2, d), and the sign of its best value, for superlatives."""

SIZE_WORDS = {
    **dict.fromkeys(("big", "large", "huge", "giant"), "largest"),
    **dict.fromkeys(("small", "little", "tiny"), "smallest"),
    **dict.fromkeys(("tall", "high"), "tallest"),
    **dict.fromkeys(("short", "low"), "shortest"),
    **dict.fromkeys(("long",), "longest"),
    **dict.fromkeys(("wide", "broad"), "widest"),
}

SIZE_AMONG_THINGS = 0.5
"""Probability that a word of size compares a thing with the other things, instead of with its own kind."""

EDGE_TO_EDGE = 0.75
"""Share of stated distances that people measure between facing edges; the others are between centres.

Centres are seldom meant: 30 cm between those of two things of 40 cm would be things that overlap."""

BEFORE_ON_EACH_SIDE = 0.5
"""Degree of *on each side* for things in front of and behind a third one, instead of left and right of it."""

NOTHING = {"none_on": "on", "none_under": "under", "none_inside": "inside", "empty": "inside"}
"""Relation that no thing has to the subject."""


@dataclass(frozen=True, eq=False)
class ClaimTables:
    """Evidence of claims: of matches (n1, n2), and tables (k, n2, n2) of the pairs of objects ``ends`` (k, 2)."""

    unary: Array
    ends: NDArray[np.int64]
    tables: NDArray[np.float32]


def claim_tables(
    claims: Sequence[Claim],
    nodes: Sequence[str],
    boxes: Array,
    vocabulary: Relations,
    models: RelationModels,
    unary: Array,
    metric: bool = True,
    surface: int | None = None,
    poses: Poses | None = None,
) -> ClaimTables:
    """Return the evidence of claims about n1 objects for n2 boxes.

    Parameters
    ----------
    claims
        The claims; those about objects that are not in ``nodes`` are left out.
    nodes
        Names of the objects.
    boxes
        Boxes of the things, shape (n2, 2, d), d is 2 or 3.
    vocabulary, models
        Relation words and their models, for claims that are made of relations.
    unary
        Evidence of the matches without facts and claims, shape (n1, n2): what the third object of a claim may be.
    metric
        Whether the boxes are in metres; otherwise, distances say nothing.
    surface
        Index of the box of the surface that the objects stand on; None if it is not among the boxes.
    poses
        Fronts, heads and long axes of the things; None where they are unknown.

    Returns
    -------
    Log-likelihood ratios in nats, finite.
    """
    index = {name: i for i, name in enumerate(nodes)}
    claim_ratios = np.zeros(unary.shape)
    pairs: dict[tuple[int, int], Array] = {}
    if 1 < len(boxes) <= MAX_THINGS:
        scene = ClaimDegrees(np.asarray(boxes, dtype=np.float64), vocabulary, models, metric, surface, poses)
        for claim in (*claims, *_flanked(claims)):
            if any(name not in index for name in (*claim.subjects, *claim.arguments)):
                continue
            if claim.relation == "ordinal":
                members = [index[name] for name in (*claim.subjects, *claim.arguments)]
                chances = np.minimum(sum((_chances(unary[member]) for member in members), np.zeros(len(boxes))), 1.0)
                degree = ordinal_degrees(claim.value or "", scene.centres, chances)
                if degree is not None and claim.arguments:
                    claim_ratios[index[claim.subjects[0]]] += _ratio(claim, degree, 1.0)
                continue
            for ends, degree, share in scene.of(claim):
                positions = tuple(index[name] for name in ends)
                if len(set(positions)) < len(positions):
                    continue
                if len(positions) == 1:
                    claim_ratios[positions[0]] += _ratio(claim, degree, share)
                elif len(positions) == 2:
                    pairs[positions[0], positions[1]] = pairs.get((positions[0], positions[1]), 0.0) + _ratio(
                        claim, degree, share
                    )
                else:
                    for third, axis in ((2, 2), (1, 1)):
                        part = _ratio(claim, degree, share / 2, _chances(unary[positions[third]]), axis)
                        ends_left = positions[0], positions[3 - third]
                        pairs[ends_left] = pairs.get(ends_left, 0.0) + part
    tables = np.zeros((len(pairs), len(boxes), len(boxes)), dtype=np.float32)
    for table, ratio in zip(tables, pairs.values(), strict=True):
        table[:] = ratio
        np.fill_diagonal(table, 0.0)
    return ClaimTables(claim_ratios, np.array(list(pairs), dtype=np.int64).reshape(-1, 2), tables)


def _flanked(claims: Sequence[Claim]) -> Iterator[Claim]:
    """Yield what claims of two things on each side of a third one say together: the third one is between them."""
    sides: dict[tuple[str, ...], list[Claim]] = {}
    for claim in claims:
        if claim.relation == "each_side" and claim.positive and claim.arguments:
            sides.setdefault(claim.arguments, []).append(claim)
    for flanked, found in sides.items():
        things = tuple(dict.fromkeys(subject for claim in found for subject in claim.subjects))
        if len(things) == 2:
            yield replace(found[0], relation="between", subjects=flanked, arguments=things)


def _chances(unary: Array) -> Array:
    """Return the probabilities of the things for one object, by its evidence alone."""
    weights = np.exp(unary - unary.max())
    chances: Array = weights / weights.sum()
    return chances


def _ratio(claim: Claim, degree: Array, share: float, third: Array | None = None, axis: int = 0) -> Array:
    """Return the weighted log-likelihood ratio of a claim from its degrees for all things, pairs or triples."""
    if not claim.positive:
        degree = 1 - degree
    apart = np.ones(degree.shape, dtype=bool)
    n = len(degree)
    same = np.arange(n)
    if degree.ndim == 2:
        apart[same, same] = False
    elif degree.ndim == 3:
        apart[same, same, :] = apart[same, :, same] = apart[:, same, same] = False
    chance = float(degree[apart].mean()) if apart.any() else 1.0
    if third is not None:
        weights = apart * (third[None, None, :] if axis == 2 else third[None, :, None])
        total = weights.sum(axis=axis)
        mean = np.divide((weights * degree).sum(axis=axis), total, out=np.full((n, n), chance), where=total > 1e-12)
        degree = mean
    ratio = np.log(OUTLIERS + (1 - OUTLIERS) * degree) - np.log(OUTLIERS + (1 - OUTLIERS) * chance)
    weight = claim.weight * (OPTIONAL_SHARE if claim.optional else 1.0)
    if weight <= 0:
        return np.zeros_like(ratio)
    return share * hedged(ratio, min(weight, 1.0))


Degrees = Iterator[tuple[tuple[str, ...], Array, float]]
"""Objects (one to three), the degrees for the things that they may be, and the share of the evidence that counts."""


_ORDERS = {"left": (0, 1), "right": (0, -1), "near": (1, 1), "front": (1, 1), "far": (1, -1), "back": (1, -1)}
"""Axis along which the members of a group are counted from a side, and the sign of its direction."""


def ordinal_degrees(value: str, centres: Array, chances: Array) -> Array | None:
    """Return the probability that each thing is the n-th of a group, counted from a side.

    Parameters
    ----------
    value
        Rank and side, such as ``2 from left``; the rank -1 is the last.
    centres
        Centres of n things, shape (n, 2) or (n, 3).
    chances
        Probability that each thing belongs to the group, shape (n,).

    Returns
    -------
    ndarray or None
        Probabilities, shape (n,): of as many members before the thing as the rank says (a Poisson binomial
        distribution); None for a side or a rank that is not known.

    Notes
    -----
    The distribution of the number of successes of independent trials with unequal probabilities is described in Y. H.
    Wang, "On the number of successes in independent trials", Statistica Sinica 3, 1993.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    >>> ordinal_degrees("2 from right", x, np.array([1.0, 1.0, 1.0])).tolist()
    [0.0, 1.0, 0.0]
    """
    rank, _, side = value.partition(" from ")
    if side not in _ORDERS or not rank.lstrip("-").isdigit() or int(rank) == 0:
        return None
    axis, sign = _ORDERS[side]
    number = abs(int(rank))
    along = centres[:, axis] * (sign if int(rank) > 0 else -sign)
    counts = np.zeros((len(along), number))
    counts[:, 0] = 1.0
    for place, chance in zip(along, chances, strict=True):
        share = np.where(along > place + TIE, chance, 0.0)[:, None]
        moved = np.concatenate([np.zeros((len(along), 1)), counts[:, :-1]], axis=1)
        counts = (1 - share) * counts + share * moved
    result: Array = counts[:, -1]
    return result


def between_degrees(centres: Array) -> Array:
    """Return the degrees of *between* for all triples of things: a subject, and the two that it is between.

    Parameters
    ----------
    centres
        Centres of the things, shape (n, 2).

    Returns
    -------
    ndarray
        Degrees by subject, first and second, shape (n, n, n), in (0, 1].
    """
    way = centres[None, :, :] - centres[:, None, :]  # from first to second
    length = np.maximum((way**2).sum(axis=2), 1e-12)
    off = centres[:, None, None, :] - centres[None, :, None, :]
    share = (off * way[None]).sum(axis=3) / length
    across = np.abs(off[..., 0] * way[None, ..., 1] - off[..., 1] * way[None, ..., 0]) / length
    # prototype: the middle three fifths; one half: level with one of them, or off by two fifths of their distance
    along = np.interp(share, (-0.25, 0.0, 0.2, 0.8, 1.0, 1.25), (EXTREME, BORDER, 0.0, 0.0, BORDER, EXTREME))
    return np.asarray(np.exp(along + np.interp(across, (0.15, 0.4, 1.0), (0.0, BORDER, EXTREME))))


class ClaimDegrees:
    """Degrees of claims in one scene; ``surface`` is the index of the box that the claims call the surface."""

    def __init__(
        self,
        boxes: Array,
        vocabulary: Relations,
        models: RelationModels,
        metric: bool,
        surface: int | None = None,
        poses: Poses | None = None,
    ) -> None:
        self.boxes, self.vocabulary, self.models, self.metric = boxes, vocabulary, models, metric
        self.poses = poses
        # a box in an image shows the front of a table as well as its top
        self.surface = surface if boxes.shape[2] == 3 else None
        self.centres = boxes[:, :, :2].mean(axis=1)

    @cached_property
    def words(self) -> WordDegrees:
        """Degrees of relation words for all pairs."""
        return WordDegrees(pair_geometry(self.boxes), self.models)

    @cached_property
    def gaps(self) -> Array:
        """Distances of the outlines of all pairs on the surface, shape (n, n)."""
        apart = gaps(self.boxes[:, :, :2])
        result: Array = np.hypot(apart[..., 0], apart[..., 1])
        return result

    @cached_property
    def distances(self) -> Array:
        """Distances of the centres of all pairs on the surface, shape (n, n)."""
        off = self.centres[:, None] - self.centres[None]
        result: Array = np.hypot(off[..., 0], off[..., 1])
        return result

    def relation(self, word: str) -> Array:
        """Return the degrees of a relation of the ontology, shape (n, n).

        Parameters
        ----------
        word
            Name of the relation.

        Returns
        -------
        ndarray
            Degrees by subject and object, in [0, 1].

        Raises
        ------
        UnknownTermError
            The ontology has no such relation, or its word has no model.
        """
        return self.words.of(self.vocabulary[word])

    def of(self, claim: Claim) -> Degrees:
        """Yield the degrees of a claim for each object, pair or triple that it is about; nothing if undecidable.

        Parameters
        ----------
        claim
            The claim.

        Yields
        ------
        tuple
            Positions of the objects that the degrees are about, the degrees with one axis for each of them, and the
            weight of these degrees.
        """
        term, subjects, arguments = claim.relation, claim.subjects, claim.arguments
        if term in ROW_TERMS and len(subjects) > 1:
            yield from self._arrangement(claim)
            return
        for subject in subjects:
            if len(arguments) == 2 and term in ("between", "closer", "farther"):
                yield (subject, *arguments), self.triple_degrees(term), 1.0
            elif not arguments:
                degree = self.degrees_alone(claim)
                if degree is not None:
                    yield (subject,), degree, 1.0
            else:
                pair = self.pair_degrees(claim)
                for other in arguments if pair is not None and term != "between" else ():
                    assert pair is not None
                    yield (subject, other), pair, 1.0

    def degrees_alone(self, claim: Claim) -> Array | None:
        """Return the degree of a claim about one object for each thing, shape (n,); None if boxes do not decide it.

        Parameters
        ----------
        claim
            A claim with a place, a size or another property of its subject.

        Returns
        -------
        ndarray or None
            Degrees in [0, 1], shape (n,), or None.
        """
        term, value = claim.relation, claim.value
        if term in PLACES:
            return place_degree(term, value, lean_on_surface(self.boxes, self.surface))
        if term == "in_front" and value is not None:  # of the viewer
            lean = lean_on_surface(self.boxes, self.surface)
            near, ahead = (np.asarray(place_degree(place, "near", lean)) for place in ("part", "middle"))
            return np.asarray(near * ahead)
        if term in ("left", "right") and value is not None:  # of the viewer
            return place_degree("part", term, lean_on_surface(self.boxes, self.surface))
        if term in MEASURES:
            measure, sign = MEASURES[term]
            return _extreme(self._without_surface(sign * measure(self.boxes)))
        if term == "size" and value in SIZE_WORDS:
            measure, sign = MEASURES[SIZE_WORDS[value]]
            degree = np.exp(np.interp(_rank(sign * measure(self.boxes)), (0.0, 0.5, 0.75), (EXTREME, BORDER, 0.0)))
            return np.asarray(SIZE_AMONG_THINGS * degree + (1 - SIZE_AMONG_THINGS) * degree.mean())
        if term in NOTHING:
            degree = self.relation(NOTHING[term]).copy()
            np.fill_diagonal(degree, 0.0)
            return np.asarray(1 - degree.max(axis=0))
        if term == "on" and self.boxes.shape[2] == 3:
            return self._standing()
        if term == "parallel" and value is not None:
            return self._along(value)
        if term in AIMING and self.poses is not None:
            return aim_degrees(term, value, self.poses)
        return None

    def _without_surface(self, values: Array) -> Array:
        """Return values of all things (n, …) with that of the surface below all others."""
        if self.surface is not None:
            values = values.copy()
            values[self.surface] = -np.inf
        return values

    def _standing(self) -> Array:
        """Return the degree to which each thing stands on the surface.

        On a surface with a box, the centre of the thing is within the box, and its underside is at the top of the box,
        or below it, as in a tray with a rim. Without such a box, the underside is the lowest of the scene.
        """
        low, height = self.boxes[:, 0, 2], max(float(np.median(_extents(self.boxes)[:, 2])), 1e-9)
        above = low - low.min() if self.surface is None else np.maximum(low - self.boxes[self.surface, 1, 2], 0.0)
        degree = np.exp(np.interp(above / height, (0.1, 0.5, 1.0), (0.0, BORDER, EXTREME)))
        return np.asarray(degree if self.surface is None else np.where(self.over_surface, degree, np.exp(EXTREME)))

    @cached_property
    def over_surface(self) -> NDArray[np.bool_]:
        """Mask (n,) of the things whose centre is within the outline of the surface and that are not below it."""
        assert self.surface is not None
        low, high = self.boxes[self.surface]
        within = ((self.centres >= low[:2]) & (self.centres <= high[:2])).all(axis=1)
        others = np.arange(len(self.boxes)) != self.surface
        return np.asarray(within & others & (self.boxes[:, 0, 2] >= low[2]))

    def _along(self, value: str) -> Array | None:
        """Return the degree to which the long axis of each thing is parallel to an edge of the surface."""
        words = set(value.split())
        if words & {"near", "far", "front", "back"}:
            axis = 0
        elif words & {"left", "right", "side"}:
            axis = 1
        else:
            return None
        extents = _extents(self.boxes)
        longer = (extents[:, axis] - extents[:, 1 - axis]) / np.maximum(extents[:, :2].sum(axis=1), 1e-9)
        return np.asarray(np.exp(np.interp(longer, (-1.0, 0.0, 0.3), (EXTREME, BORDER, 0.0))))

    def pair_degrees(self, claim: Claim) -> Array | None:
        """Return the degree of a claim about two objects for each pair, shape (n, n); None if undecidable.

        Parameters
        ----------
        claim
            A claim that relates its subject to another object.

        Returns
        -------
        ndarray or None
            Degrees by subject and other object, shape (n, n), in [0, 1], or None.
        """
        term, value = claim.relation, claim.value
        if term in PLACES:
            lean = place_degree(term, value, lean_in_things(self.boxes))
            # at the place or beside it: one half at a gap of a mean size
            size = (_extents(self.boxes)[:, :2].prod(axis=1) ** 0.5)[:, None]
            apart = self.gaps / np.maximum((size + size.T) / 2, 1e-9)
            beside = np.exp(np.interp(apart, (0.0, 1.0, 3.0), (0.0, BORDER, EXTREME)))
            return None if lean is None else np.asarray(lean * beside)
        if term in AIMING and self.poses is not None:
            return aim_degrees(term, value, self.poses, self.boxes)
        if term == "each_side":
            beside, before = (np.maximum(self.relation(word), self.relation(word).T) for word in ("left", "in_front"))
            return np.asarray(np.maximum(beside, BEFORE_ON_EACH_SIDE * before))
        if term in ("nearest", "farthest"):
            sign = -1 if term == "nearest" else 1
            gaps = sign * self.distances
            np.fill_diagonal(gaps, -np.inf)
            return np.stack([_extreme(column) for column in self._without_surface(gaps).T], axis=1)
        if term in MEASURES:
            measure, sign = MEASURES[term]
            return _more(sign * measure(self.boxes))
        if term in ("distance", "distance_less", "distance_more") and claim.metres and self.metric:
            edges, centres = (distance_degree(term, known, claim.metres) for known in (self.gaps, self.distances))
            return np.asarray(EDGE_TO_EDGE * edges + (1 - EDGE_TO_EDGE) * centres)
        if term in ("closer", "farther") and value is not None:  # to the edge
            lean = lean_on_surface(self.boxes, self.surface)
            place = place_degree("edge", value.removesuffix("edge").strip() or None, lean)
            return None if place is None else _more(place if term == "closer" else -place)
        return None

    def triple_degrees(self, term: str) -> Array:
        """Return the degrees of triples (subject, first, second), shape (n, n, n).

        Parameters
        ----------
        term
            ``between``, ``closer`` (to the first than to the second) or ``farther``.

        Returns
        -------
        ndarray
            Degrees in [0, 1].
        """
        if term != "between":  # closer to the first than the second is, or than to the second
            d = self.distances if term == "closer" else -self.distances
            than_second = np.exp(_more_log(d[None, :, :] - d[:, :, None], self.distances))
            to_second = np.exp(_more_log(d[:, None, :] - d[:, :, None], self.distances))
            return np.asarray((than_second + to_second) / 2)
        return between_degrees(self.centres)

    def _arrangement(self, claim: Claim) -> Degrees:
        term, subjects = claim.relation, claim.subjects
        if term == "row":
            order = ROW_ORDERS.get(claim.value or "")
            if order is not None:
                degree = self.relation(order)
                for pair in pairwise(subjects):
                    yield pair, degree, 1.0
                return
        every = list(combinations(subjects, 2))
        degree = self.relation("aligned" if term == "row" else EACH_OTHER[term])
        for pair in every:
            yield pair, degree, (len(subjects) - 1) / len(every)


ROW_TERMS = frozenset({"row", *EACH_OTHER})


def _extents(boxes: Array) -> Array:
    extents: Array = boxes[:, 1] - boxes[:, 0]
    return extents


def _mean_extent(boxes: Array) -> Array:
    extents = _extents(boxes)
    mean: Array = np.prod(extents, axis=1) ** (1 / extents.shape[1])
    return mean


def _rank(values: Array) -> Array:
    """Return the share of the other values that are smaller, with ties as one half, shape (n,)."""
    difference = values[:, None] - values[None]
    equal = np.abs(difference) < TIE
    below = (difference >= TIE).sum(axis=1) + (equal.sum(axis=1) - 1) / 2
    return np.asarray(below / max(len(values) - 1, 1))


def _extreme(values: Array) -> Array:
    """Return the degree of having the greatest of n values: one half for the second, then less."""
    better = (values[:, None] < values[None] - TIE).sum(axis=1)
    return np.asarray(np.exp(np.interp(better, (0, 1, 4), (0.0, BORDER, EXTREME))))


def _more(values: Array) -> Array:
    """Return the degree to which each value is above each other one: one half where equal, by their spread."""
    unit = max(float(np.std(values)), 1e-9)
    off = (values[:, None] - values[None]) / unit
    return np.asarray(np.exp(np.interp(off, (-1.0, 0.0, 0.25), (EXTREME, BORDER, 0.0))))


def _more_log(off: Array, distances: Array) -> Array:
    """Return the log degree of a difference of distances above 0, in units of the median distance."""
    unit = max(float(np.median(distances)), 1e-9)
    return np.asarray(np.interp(off / unit, (-1.0, 0.0, 0.25), (EXTREME, BORDER, 0.0)))


def distance_degree(term: str, distances: Array, metres: float) -> Array:
    """Return the degree of a stated distance: one half at a ratio of 1.6; beyond a bound, at a ratio of 1.3.

    Parameters
    ----------
    term
        ``distance`` for the stated one, or the term of a bound.
    distances
        Distances of the things in metres, of any shape.
    metres
        Stated distance in metres.

    Returns
    -------
    ndarray
        Degrees in (0, 1], of the shape of ``distances``.
    """
    off = np.log(np.maximum(distances, 0.01) / metres)
    if term == "distance":
        knots, values = (np.log(1.25), np.log(1.6), np.log(3.0)), (0.0, BORDER, EXTREME)
        return np.asarray(np.exp(np.interp(np.abs(off), knots, values)))
    if term == "distance_more":
        off = -off
    return np.asarray(np.exp(np.interp(off, (0.0, np.log(1.3), np.log(2.5)), (0.0, BORDER, EXTREME))))
