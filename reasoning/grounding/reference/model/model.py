"""Score the objects of a room against a query, and return the probability of each.

A description is scored in logarithms: the noun against the label, properties and relations by weighted features. The
landmark of a relation is summed over its own posterior, the viewer over all directions. All of it is one log-linear
model with latent landmarks and viewers, whose weights are fitted by maximum likelihood
(:mod:`deixis.reasoning.grounding.reference.model.fitting`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.things.colours import Colours
from deixis.reasoning.grounding.reference.features.nouns import NAMED, NAMED_WEIGHT, class_shares
from deixis.reasoning.grounding.reference.features.properties import SIDES, called_by, property_features
from deixis.reasoning.grounding.reference.features.relations import ANY_RELATION, FAMILIES, RELATIONS, VIEWED, Pairs
from deixis.reasoning.grounding.reference.features.room import Room
from deixis.reasoning.grounding.reference.model.likelihood import (
    Score,
    constant,
    log_complement,
    log_mixture,
    log_shares,
    log_sum,
    weighted,
)
from deixis.reasoning.grounding.reference.query import (
    Description,
    Person,
    Property,
    Query,
    Relation,
    Viewer,
    readings,
)

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Kept = TypeVar("Kept")
NounFit = Callable[[str, Room], Array]
"""Function from a noun and a room to features of each object under its k possible classes, shape (k, n, f)."""

IMPOSSIBLE = -30.0
"""Log score of a landmark that is the candidate itself."""

MAX_UNKNOWN_LANDMARKS = 40
"""Maximum number of objects that a landmark may be in a scene without labels for it."""

PERSPECTIVES = {Person.ADDRESSEE: 0.75, Person.SPEAKER: 0.25}
"""Share of descriptions whose sides are those of a person, where both are known and no perspective is stated."""

PLACES = {"left": "left", "right": "right", "in_front": "front", "behind": "back", "corner": "corner", "edge": "edge"}
PLACES |= {"middle": "middle"}
"""Places in a scene that relations to the scene as a whole tell."""

OPPOSITES = {"left": "right", "right": "left", "front": "back", "back": "front", "near": "far", "far": "near"}

MISNAMED = 0.005
"""Share of descriptions whose noun fits none of its candidates, so that any object may be meant."""

UNLISTED = {"wall": Property("position", "wall")}
"""Landmarks that the objects of a scene seldom include, with the property that a relation to them then stands for."""

COUNTED = frozenset({"proximity", "support", "inside"})
"""Families of relations whose landmarks are counted (*the table with four chairs*)."""

COUNTED_GAP = 0.4
"""Maximum distance of a counted landmark over the scale of the scene."""

LIKELY = 0.5
"""Minimum probability at which an object counts as one of the class that a noun names."""

SIZE_TOLERANCE = 1.0
"""Sum of the logarithms by which the sides of an object without a label may lie outside the usual ones of a noun."""

DOUBTS = ("always", "words", "rivals", "relations", "viewed", "unseen", "unread", "other_classes")
"""Features of a description that show how reliable its log probabilities are: a constant, the logarithm of its
number of words over 10, that of the number of candidates with the label of the best one, the number of relations, and
whether it depends on the view, mentions a landmark that the room does not have, is not all understood, and has
candidates with other labels."""

USUAL_WORDS = (3, 40)
"""Range of the number of words; a longer or shorter description counts as one at its end."""

UNCALIBRATED = np.concatenate([np.zeros(len(DOUBTS)), [-30.0], np.zeros(len(DOUBTS) - 1)])
"""Weights of :func:`calibrated` that change nothing."""

MAX_LANDMARKS = 12
"""Maximum number of objects that a landmark may be; the rest fit its noun less well."""


@dataclass(frozen=True, eq=False)
class Lexis:
    """Word knowledge of the model: the fit of nouns to labels, and colour terms."""

    noun_fit: NounFit
    similarity: Callable[[str, Room], Array]
    called: Callable[[Iterable[str], Room], Array]
    number_fit: Callable[[bool, Room], Array]
    colours: Colours


@dataclass(frozen=True, eq=False)
class Model:
    """The log-linear model: weights by name, and the words that it knows."""

    weights: Mapping[str, Array]
    lexis: Lexis
    kept: dict[tuple[int, str], Any] | None = None

    def candidates(self, query: Query, room: Room) -> Indices:
        """Return the objects that the query may mean: those that its noun may name.

        These are all objects if the noun names none, or if any object has no label.

        Parameters
        ----------
        query
            The query.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Positions of the x candidates, increasing.
        """

        def named() -> Indices:
            known = np.flatnonzero(self._fit(query.target, room) > 0)
            return known if len(known) and not room.unlabelled.any() else np.arange(len(room))

        return self._keep(query, "candidates", named)

    def scores(self, query: Query, room: Room) -> Score:
        """Return the log probability of each candidate, summed over the readings of the query.

        Parameters
        ----------
        query
            The query.
        room
            The scene of n objects.

        Returns
        -------
        Score
            Log probabilities in nats, shape (x,), in the order of :meth:`candidates`.
        """
        among, views = self.candidates(query, room), self._viewer(query, room)
        targets = self._keep(query, "readings", lambda: tuple(readings(query.target)))
        found = [self._description(target, room, among, target=True) for target in targets]
        scores = [log_shares(log_sum(views[:, None] + one, 0), 0) for one in found]
        if len(scores) == 1:
            return scores[0]
        lifted = (np.arange(len(scores)) > 0).astype(np.float64)[:, None]
        return log_mixture(scores, log_shares(weighted(lifted, "lifted", self.weights), 0))

    def probabilities(self, query: Query, room: Room) -> Array:
        """Return the calibrated probability of each object.

        Parameters
        ----------
        query
            The query.
        room
            The scene of n objects.

        Returns
        -------
        ndarray
            Probabilities, shape (n,), which add up to 1.
        """
        among, logs = self.candidates(query, room), self.scores(query, room).value
        shares = calibrated(logs, self.doubts(query, room, logs), self.weights.get("calibration", UNCALIBRATED))
        found = np.full(len(room), MISNAMED / len(room))
        found[among] += (1 - MISNAMED) * shares
        return found

    def doubts(self, query: Query, room: Room, logs: Array) -> Array:
        """Return features of a description that show how reliable its log probabilities are.

        Parameters
        ----------
        query
            The query.
        room
            The scene of n objects.
        logs
            Log probabilities of the candidates, shape (x,).

        Returns
        -------
        ndarray
            Features in the order of :data:`DOUBTS`, shape (d,).
        """
        among, relations = self.candidates(query, room), query.target.relations
        best = room.labels[among[int(logs.argmax())]]
        rivals = sum(room.labels[i] == best for i in among)
        viewed = any(RELATIONS.get(one.name, ANY_RELATION)[0] in VIEWED for one in relations)
        unseen = any(
            self._unseen(one, room) and not places_of(relation) for relation in relations for one in relation.arguments
        )
        length = float(np.log(np.clip(query.words, *USUAL_WORDS) / 10))
        labelled = not room.unlabelled.any()
        known = {
            "always": 1.0,
            "words": length if labelled else max(length, 0.0),  # few words do not make up for missing labels
            "rivals": np.log(rivals) if labelled else 0.0,
            "relations": min(len(relations), 3),
            "viewed": viewed or any(one.word in SIDES for one in query.target.properties),
            "unseen": unseen,
            "unread": 1 - query.understood,
            "other_classes": labelled and rivals < len(among),
        }
        return np.array([float(known[name]) for name in DOUBTS])

    def _keep(self, part: object, what: str, compute: Callable[[], Kept]) -> Kept:
        """Return what does not depend on the weights, computed once for each part of a query while these are fitted."""
        if self.kept is None:
            return compute()
        key = (id(part), what)  # a query keeps its parts, so that their ids are not used again
        if key not in self.kept:
            self.kept[key] = compute()
        found: Kept = self.kept[key]
        return found

    def _description(self, description: Description, room: Room, among: Indices, target: bool = False) -> Score:
        """Return log scores of the objects ``among`` for a description, shape (v or 1, x)."""
        rivals, nouns, numbers = self._keep(
            description,
            f"noun of {among.tobytes()!r}",
            lambda: (
                self._rivals(description, room, among),
                self._noun_features(description, room)[:, among],
                self.lexis.number_fit(description.plural, room)[among],
            ),
        )
        found = self._named(nouns, class_shares(room, self._share_named(description, room))[:, among])[None]
        if description.noun:
            found = found + weighted(numbers, "number", self.weights)[None]
        if target:
            sizes = np.zeros((len(among), 2))
            if not room.unlabelled.any():  # with missing labels, the sizes of classes are unknown
                for group in rivals:
                    sizes[group] = (len(group) > 1, np.log(len(group)))
            found = (
                found
                + weighted(np.column_stack([sizes, room.surrounds[among].astype(np.float64)]), "target", self.weights)[
                    None
                ]
            )
        for prop in description.properties:
            if (score := self._property(prop, room, among, rivals)) is not None:
                found = found + score
        for relation in description.relations:
            if (score := self._relation(relation, room, among, rivals)) is not None:
                found = found + score
        return found

    def _named(self, features: Array, shares: Array) -> Score:
        """Return log scores of a noun, shape (x,), summed over the possible classes of each object.

        Parameters
        ----------
        features
            Features of the noun and each class, shape (k, x, f).
        shares
            Probabilities of the classes, shape (k, x).
        """
        if len(features) == 1:
            return weighted(features[0], "noun", self.weights)
        with np.errstate(divide="ignore"):
            return log_sum(weighted(features, "noun", self.weights) + constant(np.log(shares)), 0)

    def _rivals(self, description: Description, room: Room, among: Indices) -> tuple[Indices, ...]:
        """Return the groups of objects that compete: those with one label, then those that have the said colour too.

        *The tallest red cup* is compared with the red cups, and a blue cup with all cups. Objects without a label
        compete with the cups if their sizes are rather those of cups. All objects compete for *the tallest object*, and
        wherever no noun is given and any of them has no label.
        """
        anything = not description.noun and (description.anything or room.unlabelled.any())
        groups = (np.arange(len(among)),) if anything else rival_groups(room, among)
        bare = room.without_label
        if description.noun and bare.any() and not bare.all():
            named = self._called(description, room) > LIKELY
            sized = bare & (self._size_fit(description, room) > 0)
            if named[among].any():
                groups = (*groups, np.flatnonzero((named | sized)[among]))
        for prop in description.properties:
            if prop.positive and (called := called_by(prop.word, room, self.lexis.colours)) is not None:
                parts = (group[called[among[group]]] for group in groups)
                groups = (*groups, *(part for part in parts if len(part)))
        return groups

    def _property(self, prop: Property, room: Room, among: Indices, rivals: tuple[Indices, ...]) -> Score | None:
        def measured() -> tuple[str, Array] | None:
            known = property_features(prop, room, among, rivals, self.lexis.colours)
            return None if known is None else (known[0], stacked(known[1]))

        known = self._keep(prop, f"property of {among.tobytes()!r}", measured)
        if known is None:
            return None
        score = weighted(known[1], known[0], self.weights)
        return score if prop.positive else _denied(score)

    def _relation(self, relation: Relation, room: Room, among: Indices, rivals: tuple[Indices, ...]) -> Score | None:
        if not relation.arguments:
            return None
        if any(self._unseen(argument, room) for argument in relation.arguments):
            if (unlisted := UNLISTED.get(relation.arguments[0].noun)) is not None:
                instead = self._keep(relation, "instead", lambda: replace(unlisted, positive=relation.positive))
                return self._property(instead, room, among, rivals)
            places = self._keep(relation, "places", lambda: places_of(relation))
            scores = (self._property(one, room, among, rivals) for one in places)
            known = [one for one in scores if one is not None]
            return sum(known[1:], known[0]) if known else None
        family, sign = RELATIONS.get(relation.name, ANY_RELATION)
        if family == "between":
            score = self._between(relation, room, among, rivals)
        else:
            score = self._binary(relation, family, sign, room, among, rivals)
            if family in COUNTED and (relation.arguments[0].count or 0) > 1:
                score = score + self._counted(relation.arguments[0], room, among)
        return score if relation.positive else _denied(score)

    def _binary(
        self, relation: Relation, family: str, sign: float, room: Room, among: Indices, rivals: tuple[Indices, ...]
    ) -> Score:
        argument = relation.arguments[0]
        landmarks = self._landmarks(argument, room)
        own = log_shares(self._description(argument, room, landmarks), 1)

        def compared() -> Array:
            if relation.inverted:
                pairs = Pairs(room, landmarks, among, rival_groups(room, landmarks))
                return np.swapaxes(stacked(FAMILIES[family](pairs, sign)), 1, 2)
            return stacked(FAMILIES[family](Pairs(room, among, landmarks, rivals), sign))

        features = self._keep(relation, f"pairs of {among.tobytes()!r}", compared)
        name = relation.name if relation.degree == "plain" else f"{relation.name} {relation.degree}"
        block = f"{family} inverted" if relation.inverted else family
        score = weighted(features, f"{block}/{name}", self.weights)
        same = IMPOSSIBLE * (among[:, None] == landmarks[None]).astype(np.float64)[None]
        score = score + constant(same) + own[:, None, :]
        if family in VIEWED:
            score = score + self._seen(room, landmarks)
        return log_sum(score, 2)

    def _between(self, relation: Relation, room: Room, among: Indices, rivals: tuple[Indices, ...]) -> Score:
        first, second = relation.arguments[0], relation.arguments[-1]
        ones, others = (self._landmarks(one, room)[:MAX_LANDMARKS] for one in (first, second))
        landmarks = np.union1d(ones, others)
        one = log_shares(self._description(first, room, landmarks), 1)
        other = log_shares(self._description(second, room, landmarks), 1)
        pairs = Pairs(room, among, landmarks, rivals)
        features = self._keep(
            relation, f"pairs of {among.tobytes()!r}", lambda: stacked(FAMILIES["between"](pairs, 1.0))
        )
        score = weighted(features, "between/between", self.weights)
        n = len(landmarks)
        ends = np.stack([np.repeat(landmarks, n), np.tile(landmarks, n)])
        bad = (among[:, None] == ends[0]) | (among[:, None] == ends[1]) | (ends[0] == ends[1])[None]
        both = _outer(one, other)
        return log_sum(score + constant(IMPOSSIBLE * bad[None].astype(np.float64)) + both[:, None, :], 2)

    def _counted(self, description: Description, room: Room, among: Indices) -> Score:
        """Return log scores of having the stated number of landmarks close by, shape (1, x)."""

        def counted() -> Array:
            close = (room.gaps[among] < COUNTED_GAP) & (self._fit(description, room) > 0)
            close[np.arange(len(among)), among] = False
            off = np.abs(close.sum(axis=1) - (description.count or 1))
            return np.stack([off == 0, -np.minimum(off, 3)], axis=1).astype(np.float64)

        return weighted(self._keep(description, f"count of {among.tobytes()!r}", counted), "count", self.weights)[None]

    def _noun_features(self, description: Description, room: Room) -> Array:
        """Return the features of the noun that fits each object best, shape (k, n, f)."""
        first = self.lexis.noun_fit(description.noun, room)
        if not description.other_nouns:
            return first
        features = np.stack([first, *(self.lexis.noun_fit(noun, room) for noun in description.other_nouns)])
        best = np.argmax([self.lexis.similarity(noun, room) for noun in description.nouns], axis=0)
        found: Array = np.moveaxis(features[best, :, np.arange(len(room))], 0, 1)
        return found

    def _share_named(self, description: Description, room: Room) -> float:
        """Return the prior probability that an object of an unknown class is of the class that the nouns name.

        It is the share of that class among the objects of the scene whose classes are known, drawn to ``NAMED``.
        """
        if not description.noun or not room.unlabelled.any():
            return NAMED
        called = float(self._called(description, room).sum())
        return (called + NAMED_WEIGHT * NAMED) / (float(room.named.sum()) + NAMED_WEIGHT)

    def _called(self, description: Description, room: Room) -> Array:
        """Return the probability that a noun of a description names the class of each object, shape (n,)."""
        return self._keep(description, "called", lambda: self.lexis.called(description.nouns, room))

    def _fit(self, description: Description, room: Room) -> Array:
        """Return how well the nouns of a description fit each object, shape (n,), in [0, 1]."""
        fit = self.lexis.similarity(description.noun, room)
        for noun in description.other_nouns:
            fit = np.maximum(fit, self.lexis.similarity(noun, room))
        return fit

    def _size_fit(self, description: Description, room: Room) -> Array:
        """Return how well the sizes of objects without a label fit a noun, 0 without information, shape (n,)."""
        result: Array = self._noun_features(description, room)[-2:][0, :, -1]  # of the class that the noun names
        return result

    def _unseen(self, description: Description, room: Room) -> bool:
        """Return whether a landmark has a noun that names none of the objects, nor has one without a label its size."""

        def unnamed() -> bool:
            if not description.noun or room.unlabelled.all():
                return False
            sized = room.unlabelled & (self._size_fit(description, room) > -SIZE_TOLERANCE)
            return not (self._fit(description, room) > 0).any() and not sized.any()

        return self._keep(description, "unseen", unnamed)

    def _landmarks(self, description: Description, room: Room) -> Indices:
        """Return the objects that a landmark may be: those that fit its noun best, and those without a label."""
        return self._keep(description, "landmarks", lambda: self._best_landmarks(description, room))

    def _best_landmarks(self, description: Description, room: Room) -> Indices:
        fit = self._fit(description, room)
        named = np.argsort(-fit, kind="stable")[: min(int((fit > 0).sum()), MAX_LANDMARKS)]
        if len(named) and not room.unlabelled.any():
            return np.sort(named)
        others = np.flatnonzero(room.unlabelled) if description.noun and room.unlabelled.any() else np.arange(len(room))
        by_size = others[np.argsort(-self._size_fit(description, room)[others], kind="stable")]
        return np.union1d(named, by_size[:MAX_UNKNOWN_LANDMARKS])

    def _seen(self, room: Room, landmarks: Indices) -> Score:
        """Return log probabilities of the views for a speaker who looks at each landmark, shape (v, 1, a)."""
        if room.viewer:
            return constant(np.zeros((1, 1, 1)))
        return log_shares(weighted(room.facing[:, landmarks], "seen", self.weights), 0)[:, None]

    def _viewer(self, query: Query, room: Room) -> Score:
        """Return log probabilities of the views, shape (v,)."""
        if query.viewer is not None:
            return self._stated(query.viewer, room)
        if room.viewer:
            away = room.views[:, 1] > 1 - 1e-9
            return constant(np.log(np.where(away, 0.95 / away.sum(), 0.05 / max((~away).sum(), 1))))
        if room.headings:
            return constant(_people(room, room.headings))
        if any(RELATIONS.get(relation.name, ("", 0))[0] in VIEWED for relation in query.target.relations):
            return constant(np.zeros(len(room.views)))
        features = self._keep(query, "viewer", lambda: self._seen_from(query, room))
        return log_shares(weighted(features, "viewer", self.weights), 0)

    def _seen_from(self, query: Query, room: Room) -> Array:
        """Return the mean features of viewers who look at the objects that fit the noun best, shape (v, f)."""
        fit = self._fit(query.target, room)
        shares = np.where(fit >= max(fit.max(), 1e-9), 1.0, 0.0) if fit.max() > 0 else np.ones(len(room))
        result: Array = np.einsum("vnf,n->vf", room.facing, shares / shares.sum())
        return result

    def _stated(self, viewer: Viewer, room: Room) -> Score:
        if viewer.person is not None:
            if viewer.person in room.headings:
                return constant(_people(room, [viewer.person]))
            return self._viewer(self._keep(viewer, "anyone", lambda: Query(Description(""))), room)
        if self._unseen(viewer.landmark, room):
            return self._viewer(self._keep(viewer, "anyone", lambda: Query(Description(""))), room)
        landmarks = self._landmarks(viewer.landmark, room)
        own = log_shares(self._description(viewer.landmark, room, landmarks), 1)
        own = log_sum(own + constant(np.array(-np.log(len(own.value)))), 0)
        if viewer.stance == "towards" and viewer.target is not None:
            from_to = self._towards(viewer.target, room, landmarks)
            views = log_shares(from_to, 0)
        else:
            views = log_shares(weighted(room.facing[:, landmarks], f"viewer/{viewer.stance}", self.weights), 0)
        return log_sum(views + own[None], 1)

    def _towards(self, target: Description, room: Room, landmarks: Indices) -> Score:
        goals = self._landmarks(target, room)
        share = np.exp(log_shares(self._description(target, room, goals), 1).value.mean(axis=0))
        goal = share @ room.centres[goals, :2] / share.sum()
        apart = goal - room.centres[landmarks, :2]
        apart /= np.maximum(np.linalg.norm(apart, axis=1, keepdims=True), 1e-9)
        return weighted((room.views @ apart.T)[:, :, None], "towards", self.weights)


def calibrated(logs: Array, doubts: Array, weights: Array) -> Array:
    """Return log probabilities as calibrated probabilities.

    They are raised to a power and mixed with equal shares, which stand for descriptions without information. Both the
    logarithm of the power and the log odds of the equal shares are linear in the doubts.

    Parameters
    ----------
    logs
        Log probabilities of x candidates, shape (x,).
    doubts
        Features of the description, shape (d,).
    weights
        Weights of the power and of the equal shares, shape (2 d,).

    Returns
    -------
    ndarray
        Probabilities, shape (x,), which add up to 1.
    """
    power, vain = weights.reshape(2, -1) @ doubts
    scaled = logs * np.exp(np.clip(power, -3.0, 2.0))
    noise = 1 / (1 + np.exp(-vain))
    result: Array = (1 - noise) * np.exp(scaled - np.logaddexp.reduce(scaled)) + noise / len(logs)
    return result


def places_of(relation: Relation) -> tuple[Property, ...]:
    """Return the places in the scene that a relation to a landmark outside it tells.

    *On the left side of the table* is on the left, where the table itself is not an object of the scene, and *closest
    to the left edge of it* is leftmost.

    Parameters
    ----------
    relation
        A relation to a landmark.

    Returns
    -------
    tuple of Property
        Properties of the position of the described object; none for other relations.
    """
    words = [one.word for argument in relation.arguments for one in argument.properties if one.word in SIDES]
    if relation.name in PLACES:
        words.append(PLACES[relation.name])
    if relation.name == "far":
        words = [OPPOSITES[word] for word in words if word in OPPOSITES]
    return tuple(
        Property("position", word, relation.degree, positive=relation.positive) for word in dict.fromkeys(words)
    )


def rival_groups(room: Room, among: Indices) -> tuple[Indices, ...]:
    """Return the positions of objects with the same label; objects without labels compete with all of these.

    Parameters
    ----------
    room
        The scene.
    among
        Positions of the objects that compete.

    Returns
    -------
    tuple of ndarray
        Positions in ``among`` of the objects of each label.
    """
    groups: dict[str | None, list[int]] = {}
    for position, index in enumerate(among):
        groups.setdefault(room.labels[index], []).append(position)
    return tuple(np.array(group) for group in groups.values())


def _people(room: Room, among: Iterable[Person]) -> Array:
    """Return log probabilities of the views if one of some people is the viewer, shape (v,)."""
    shares = np.full(len(room.views), 0.05 / len(room.views))
    chances = {person: PERSPECTIVES[person] for person in among}
    for place, person in enumerate(room.headings, start=len(room.views) - len(room.headings)):
        shares[place] += 0.95 * chances.get(person, 0.0) / sum(chances.values())
    result: Array = np.log(shares)
    return result


def stacked(features: Mapping[str, Array]) -> Array:
    """Return features along a last axis, broadcast to one shape.

    Parameters
    ----------
    features
        The f features by name, arrays that broadcast.

    Returns
    -------
    ndarray
        Features of the broadcast shape with a last axis of length f.
    """
    return np.stack(np.broadcast_arrays(*features.values()), axis=-1)


def _denied(score: Score) -> Score:
    """Return the log probability that something is not the object that the words single out."""
    return log_complement(log_shares(score, score.value.ndim - 1), 0.95)


def _outer(first: Score, second: Score) -> Score:
    """Return sums of all pairs of scores of shape (v, a), as shape (v, a²)."""
    total = first[:, :, None] + second[:, None, :]
    shape = total.value.shape
    return Score(
        total.value.reshape(shape[0], -1),
        ((total, lambda given: given.reshape(shape)),),
    )
