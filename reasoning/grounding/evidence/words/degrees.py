"""Degrees of words for pairs of boxes, and their log-likelihood ratios.

A term is a piecewise linear log degree; the degree of a word is exp of the sum of its terms: 1 at the prototype. A
speaker states the word of a pair in proportion to its degree, except for a share ``outliers`` of facts that are stated
of any pair: P(word | pair) is proportional to outliers + (1 - outliers) * degree. The likelihood ratio divides this by
its value for a random pair. The outliers bound the evidence of a single fact against a pair, ``chance`` the evidence
for it.
"""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, SAYING, RelationModel, RelationModels, Term
from deixis.ontology.relations.relation import Reading, Relation
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.words.meaning import beneath_model, own_frame_model
from deixis.reasoning.grounding.evidence.words.pair_features import UNKNOWN_AIM, View, beneath, own_frame, view

Array = NDArray[np.float64]

INVERSES = {"left": "right", "top": "bottom", "top_left": "bottom_right", "top_right": "bottom_left", "on": "under"}
INVERSES |= {inverse: word for word, inverse in INVERSES.items()}

OWN_SHARE = 2 / 3
"""Share of speakers who take a thing's own front for *in front of* it, where it has one; the others take the viewer's.

The weights fitted to descriptions of rooms (*ahead* in ``ontology/models/reference.json``) are twice as large for it.
"""

BLOCK = 1 << 14  # cells of a block: several arrays of this size fit in a processor's cache


def degree_of_view(model: RelationModel, features: View) -> Array:
    """Return exp of the sum of terms; terms of missing features are ignored.

    Parameters
    ----------
    model
        Model of a family of words.
    features
        Features of the pairs by name, at least one, each of shape (n, n).

    Returns
    -------
    ndarray
        Degrees in (0, 1], shape (n, n); 1 where the model has no term for the features.
    """
    logs = [_log_degree(term, features[term.feature]) for term in model.terms if term.feature in features]
    if not logs:  # the boxes say nothing about the word
        return np.ones_like(next(iter(features.values())))
    total = sum(logs[1:], start=logs[0])
    result: Array = np.exp(np.minimum(total, 0.0, out=total), out=total)
    return result


def _log_degree(term: Term, feature: Array) -> Array:
    """Interpolate like ``np.interp``, up to rounding, by a sum of hinges: one for every knot where the slope changes.

    The computation goes by blocks of rows that fit in the cache, which is twice as fast for a million pairs.
    """
    bends = _bends(term.knots, term.values)
    logs = np.full_like(feature, term.values[0])
    rows = max(1, BLOCK // max(1, logs.shape[1]))
    for start in range(0, len(logs), rows):
        part, sums = feature[start : start + rows], logs[start : start + rows]
        for knot, bend in bends:
            hinge = part - knot
            np.maximum(hinge, 0.0, out=hinge)
            hinge *= bend
            sums += hinge
    return logs


@lru_cache(maxsize=1024)
def _bends(knots: tuple[float, ...], values: tuple[float, ...]) -> list[tuple[float, float]]:
    """Return the knots where the slope of a term changes, with the change; the slope is 0 outside the knots."""
    bends = np.diff(np.diff(values) / np.diff(knots), prepend=0.0, append=0.0).tolist()
    return [(knot, bend) for knot, bend in zip(knots, bends, strict=True) if bend]


def word_degree(pairs: PairGeometry, word: str, models: RelationModels) -> Array:
    """Return the degree of a word for each ordered pair, in its wide reading.

    Parameters
    ----------
    pairs
        Geometry of the pairs.
    word
        Name of the word: a relation without ``exactly_``.
    models
        Models of the words.

    Returns
    -------
    ndarray
        Degrees in (0, 1], shape (n, n).

    Raises
    ------
    UnknownTermError
        The word has no model.

    Examples
    --------
    >>> import numpy as np
    >>> from deixis.reasoning.geometry.pairs import pair_geometry
    >>> from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> pairs = pair_geometry(np.array([fork, plate]))
    >>> [word_degree(pairs, word, shipped_models())[0, 1].round(2).item() for word in ("left", "bottom_left", "right")]
    [0.86, 0.02, 0.0]
    """
    degree = degree_of_view(models[models.family(word)], view(pairs, word))
    own, known = own_degree(pairs, word)
    if not known.any():
        return degree
    return np.where(known, OWN_SHARE * own + (1 - OWN_SHARE) * degree, degree)


def own_degree(pairs: PairGeometry, word: str) -> tuple[Array, NDArray[np.bool_]]:
    """Return the degree of a word in the frames of things with a front, and for which pairs it has one.

    Parameters
    ----------
    pairs
        Geometry of the pairs of n subjects and m objects.
    word
        Name of the word.

    Returns
    -------
    tuple
        Degrees in [0, 1], and the mask of the pairs that have one; shape (n, m) each.
    """
    features = own_frame(pairs, word) if any(side.fronted.any() for side in pairs.poses) else None
    if features is None:
        empty = np.zeros((len(pairs.boxes), len(pairs.objects)))
        return empty, empty > 0
    return degree_of_view(own_frame_model(), features), features["aim"] != UNKNOWN_AIM


def frame_shares(pairs: PairGeometry, word: str, models: RelationModels) -> Array:
    """Return the probability that a word was meant in the frame of a thing with a front.

    Parameters
    ----------
    pairs
        Geometry of the pairs of n subjects and m objects.
    word
        Name of the word.
    models
        Models of the words.

    Returns
    -------
    ndarray
        Probabilities, shape (n, m); 0 for pairs without a known front.

    Raises
    ------
    UnknownTermError
        The word has no model.

    Examples
    --------
    >>> import numpy as np
    >>> from deixis.reasoning.geometry.pairs import pair_geometry
    >>> from deixis.reasoning.geometry.poses import Poses
    >>> from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
    >>> boxes = np.array([[[0.0, 2.0], [1.0, 3.0]], [[0.0, 0.0], [1.0, 1.0]]])
    >>> chair = Poses.of_boxes(boxes, fronts=np.array([[np.nan, np.nan], [0.0, 1.0]]))
    >>> frame_shares(pair_geometry(boxes, chair), "in_front", shipped_models())[0, 1].round(2).item()
    1.0
    """
    own, known = own_degree(pairs, word)
    viewed = (1 - OWN_SHARE) * degree_of_view(models[models.family(word)], view(pairs, word))
    return np.where(known, OWN_SHARE * own / (OWN_SHARE * own + viewed), 0.0)


class WordDegrees:
    """Cached degrees of words for the pairs of a scene; the degrees of an inverse are those of the reversed pairs."""

    def __init__(self, pairs: PairGeometry, models: RelationModels) -> None:
        self._pairs, self._models = pairs, models
        self._found: dict[str, Array] = {}

    @cached_property
    def reverse(self) -> WordDegrees:
        """Degrees of the reversed pairs."""
        if self._pairs.reverse is self._pairs:
            return self
        other = WordDegrees(self._pairs.reverse, self._models)
        other.__dict__["reverse"] = self
        return other

    def of_word(self, word: str) -> Array:
        """Return the degree of a word, as :func:`word_degree` does.

        Parameters
        ----------
        word
            Name of the word.

        Returns
        -------
        ndarray
            Degrees in (0, 1], shape (n, n), computed once.

        Raises
        ------
        UnknownTermError
            The word has no model.
        """
        if word not in self._found:
            inverse = self.reverse._found.get(INVERSES.get(word, ""))
            self._found[word] = word_degree(self._pairs, word, self._models) if inverse is None else inverse.T
        return self._found[word]

    @cached_property
    def _beneath(self) -> Array:
        """Degrees of what stands below a thing, between its legs, shape (n, m); 0 without heights."""
        features = beneath(self._pairs)
        if features is None:
            return np.zeros((len(self._pairs.boxes), len(self._pairs.objects)))
        return degree_of_view(beneath_model(), features)

    def held_by_front(self, word: str) -> NDArray[np.bool_]:
        """Return the pairs for which *in front of* or *behind* holds by the front of the object.

        Parameters
        ----------
        word
            ``in_front`` or ``behind``; no pair holds by the front for another word.

        Returns
        -------
        ndarray
            Mask of the pairs, shape (n, n).
        """
        features = own_frame(self._pairs, word)
        if features is None:
            return np.zeros((len(self._pairs.boxes), len(self._pairs.objects)), dtype=np.bool_)
        result: NDArray[np.bool_] = (features["aim"] >= 0) & (features["aim"] <= np.pi / 4)
        return result

    def undecided(self, word: str) -> NDArray[np.bool_]:
        """Return the pairs about which the scene says nothing, as their orientation is unknown.

        Parameters
        ----------
        word
            Name of the word.

        Returns
        -------
        ndarray
            Mask of the pairs, shape (n, n).
        """
        features = view(self._pairs, word)
        if "aim" not in features:
            return np.zeros((len(self._pairs.boxes), len(self._pairs.objects)), dtype=np.bool_)
        result: NDArray[np.bool_] = (features["aim"] == UNKNOWN_AIM) & ~own_degree(self._pairs, word)[1]
        return result

    def of(self, relation: Relation) -> Array:
        """Return the degree of a relation.

        In the exact reading, the word must fit better than the other nine: the result is its degree times the ratio of
        its degree to the best one. In the wide reading, *under* also fits what stands between the legs of a thing,
        which is not on it.

        Parameters
        ----------
        relation
            The relation, in its wide or exact reading.

        Returns
        -------
        ndarray
            Degrees in [0, 1], shape (n, n).

        Raises
        ------
        UnknownTermError
            The word of the relation has no model.
        """
        self._models.of(relation)
        own = self.of_word(relation.word)
        if relation.reading is not Reading.EXACT:
            return np.maximum(own, self._beneath) if relation.word == "under" else own
        best = np.max([self.of_word(word) for word in FAMILIES], axis=0)
        exact: Array = own * (own / best)
        return exact


def saying_degree(pairs: PairGeometry, models: RelationModels) -> Array:
    """Return how readily people mention each ordered pair, whatever the word.

    Parameters
    ----------
    pairs
        Geometry of the pairs.
    models
        Models of the words, with the one of ``saying``.

    Returns
    -------
    ndarray
        Degrees in (0, 1], shape (n, n).
    """
    return degree_of_view(models[SAYING], view(pairs, SAYING))


def log_likelihood_ratio(degree: Array, outliers: float, chance: float) -> Array:
    """Return log P(said | pair) - log P(said | random pair) in nats, finite.

    Parameters
    ----------
    degree
        Degrees of the pairs, in [0, 1], of any shape.
    outliers
        Share of statements that are made of a random pair.
    chance
        Mean degree of random pairs.

    Returns
    -------
    ndarray
        Ratios in nats, of the shape of ``degree``.

    Examples
    --------
    >>> log_likelihood_ratio(np.array([1.0, 0.0]), outliers=0.01, chance=0.1).round(2).tolist()
    [2.22, -2.39]
    """
    ratio: Array = np.log(outliers + (1 - outliers) * degree) - np.log(outliers + (1 - outliers) * chance)
    return ratio
