"""Degrees of words, and what they weigh as evidence.

A term is a piecewise linear log degree; the degree of a word is exp of the sum of its terms: 1 at the prototype. A
speaker says the word of a pair as far as it fits, except that a share ``outliers`` of facts is said of anything:
P(word | pair) is proportional to outliers + (1 - outliers) * degree. Its ratio to the same for a random pair is the
likelihood ratio; the outliers bound what a single fact can say against a pair, ``chance`` what it can say for it.
"""

from __future__ import annotations

from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import FAMILIES, SAYING, RelationModel, RelationModels, Term
from deixis.ontology.relation import Reading, Relation
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.pair_features import View, view

Array = NDArray[np.float64]

INVERSES = {"left": "right", "top": "bottom", "top_left": "bottom_right", "top_right": "bottom_left", "on": "under"}
INVERSES |= {inverse: word for word, inverse in INVERSES.items()}

BLOCK = 1 << 14  # numbers that fit a processor's cache several times


def degree_of_view(model: RelationModel, features: View) -> Array:
    """Return exp of the sum of terms, shape (n, n), in (0, 1]; terms of features that are not there count as
    fitting."""
    logs = [_log_degree(term, features[term.feature]) for term in model.terms if term.feature in features]
    if not logs:
        return np.ones_like(next(iter(features.values())))
    total = sum(logs[1:], start=logs[0])
    result: Array = np.exp(np.minimum(total, 0.0, out=total), out=total)
    return result


def _log_degree(term: Term, feature: Array) -> Array:
    """Return what ``np.interp`` gives, up to rounding, as a sum of hinges: one for every knot where the slope bends.

    Block by block of rows, so that what is at work stays in the cache: twice as fast for a million pairs.
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
    """Return where the slope of a term changes, and by how much; it is 0 before the first knot and after the last."""
    bends = np.diff(np.diff(values) / np.diff(knots), prepend=0.0, append=0.0).tolist()
    return [(knot, bend) for knot, bend in zip(knots, bends, strict=True) if bend]


def word_degree(pairs: PairGeometry, word: str, models: RelationModels) -> Array:
    """Return how well one of the ten words describes each ordered pair, wide reading, shape (n, n), in (0, 1].

    >>> import numpy as np
    >>> from deixis.reasoning.geometry.pairs import pair_geometry
    >>> from deixis.reasoning.grounding.evidence.meaning import shipped_models
    >>> fork, plate = [[0.0, 0.0], [0.02, 0.2]], [[0.05, -0.02], [0.32, 0.25]]
    >>> pairs = pair_geometry(np.array([fork, plate]))
    >>> [word_degree(pairs, word, shipped_models())[0, 1].round(2).item() for word in ("left", "bottom_left", "right")]
    [0.85, 0.01, 0.0]
    """
    return degree_of_view(models[FAMILIES[word]], view(pairs, word))


class WordDegrees:
    """The degrees of words over pairs of a scene, each worked out once; an inverse's is that of the pairs reversed."""

    def __init__(self, pairs: PairGeometry, models: RelationModels) -> None:
        self._pairs, self._models = pairs, models
        self._found: dict[str, Array] = {}

    @cached_property
    def reverse(self) -> WordDegrees:
        """The degrees of the same pairs the other way round."""
        if self._pairs.reverse is self._pairs:
            return self
        other = WordDegrees(self._pairs.reverse, self._models)
        other.__dict__["reverse"] = self
        return other

    def of_word(self, word: str) -> Array:
        """See :func:`word_degree`."""
        if word not in self._found:
            inverse = self.reverse._found.get(INVERSES[word])
            self._found[word] = word_degree(self._pairs, word, self._models) if inverse is None else inverse.T
        return self._found[word]

    def of(self, relation: Relation) -> Array:
        """Return the degree of a relation, shape (n, n), in [0, 1]; raises UnknownTermError where its word has no
        model.

        In the exact reading the word has to fit better than the other nine: its degree times its share of the best.
        """
        self._models.of(relation)
        own = self.of_word(relation.word)
        if relation.reading is Reading.WIDE:
            return own
        best = np.max([self.of_word(word) for word in FAMILIES], axis=0)
        exact: Array = own * (own / best)
        return exact


def relation_degree(pairs: PairGeometry, relation: Relation, models: RelationModels) -> Array:
    """Return the degree of one relation: see :meth:`WordDegrees.of`."""
    return WordDegrees(pairs, models).of(relation)


def saying_degree(pairs: PairGeometry, models: RelationModels) -> Array:
    """Return how readily people speak of a pair with this one of the two as the subject, whatever the word, shape
    (n, n)."""
    return degree_of_view(models[SAYING], view(pairs, SAYING))


def log_likelihood_ratio(degree: Array, outliers: float, chance: float) -> Array:
    """Return log P(said | pair) - log P(said | random pair), natural logarithm, finite.

    >>> log_likelihood_ratio(np.array([1.0, 0.0]), outliers=0.01, chance=0.1).round(2).tolist()
    [2.22, -2.39]
    """
    ratio: Array = np.log(outliers + (1 - outliers) * degree) - np.log(outliers + (1 - outliers) * chance)
    return ratio


def relation_evidence(pairs: PairGeometry, relation: Relation, models: RelationModels) -> Array:
    """Return the log-likelihood ratio of a word alone, shape (n, n): that of ``left`` is that of ``right``
    transposed."""
    model = models.of(relation)
    return log_likelihood_ratio(relation_degree(pairs, relation, models), model.outliers, model.chance)
