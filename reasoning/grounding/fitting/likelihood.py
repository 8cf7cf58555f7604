"""Likelihood of graded models for examples of words stated of pairs, with its derivatives by the parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.errors import GraphError
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.relations import FAMILIES, MODEL_OF_WORD, SAYING, RelationModel
from deixis.reasoning.errors import SettingError
from deixis.reasoning.geometry.pairs import PairGeometry, pair_geometry
from deixis.reasoning.grounding.evidence.words.pair_features import View, view
from deixis.reasoning.grounding.fitting.parameters import MAX_STEP, Layout


@dataclass(frozen=True, eq=False)
class SaidPairs:
    """Examples of one scene: the word ``words[i]`` was stated of the pair ``ends[i]``.

    The weight of an annotated example is 1; that of an example from a grounding is less.
    """

    pairs: PairGeometry
    words: tuple[str, ...]  # (m,) words with a graded model
    ends: NDArray[np.int64]  # (m, 2): subject, object
    weights: NDArray[np.float64]  # (m,), at least 0


def said_pairs(
    description: RelationGraph,
    boxes: NDArray[np.float64],
    things: Sequence[int | None],
    confidence: Sequence[float] | Mapping[int, float] | None = None,
) -> SaidPairs:
    """Return the examples of a grounded description.

    Parameters
    ----------
    description
        The objects and the facts. Choices, denials and optional facts give no examples.
    boxes
        Boxes of the scene, shape (n2, 2, d).
    things
        Index of each object's box; None where it has none.
    confidence
        Probability of each object's match, 1 by default. The weight of an example is that of the fact times the
        confidences of both objects.

    Returns
    -------
    SaidPairs
        The pairs of boxes, and the word, the ends and the weight of each example.

    Raises
    ------
    GraphError
        A box does not exist.
    SettingError
        A confidence is outside 0 to 1.
    """
    pairs = pair_geometry(boxes)
    if len(things) != len(description.nodes):
        raise GraphError(f"`things` must name a box for each of {len(description.nodes)} objects, got {len(things)}")
    outside = [thing for thing in things if thing is not None and not 0 <= thing < len(pairs)]
    if outside:
        raise GraphError(f"there is no box {outside[0]}; the scene has {len(pairs)}")
    sure = [1.0 if confidence is None else float(confidence[i]) for i in range(len(things))]
    if not all(0 <= value <= 1 for value in sure):
        raise SettingError(f"`confidence` must be from 0 to 1 for each object, got {sure}")
    words, ends, weights = [], [], []
    index = {name: i for i, name in enumerate(description.nodes)}
    for fact in description.facts():
        subject, obj = index[fact.subject], index[fact.object]
        first, second = things[subject], things[obj]
        is_stated = (
            fact.plain and not fact.optional
        )  # a fact with *rarely* is not plain: it is an example of the opposite
        if is_stated and first is not None and second is not None and first != second:
            words.append(fact.relations[0].word)
            ends.append((first, second))
            weights.append(fact.weight * sure[subject] * sure[obj])
    return SaidPairs(pairs, tuple(words), np.array(ends, dtype=np.int64).reshape(-1, 2), np.array(weights))


Array = NDArray[np.float64]


class Likelihood:
    """Log-likelihood of all scenes, with its gradient by the values."""

    def __init__(self, scenes: Sequence[SaidPairs], layout: Layout, word_contrast: float) -> None:
        self.layout, self.word_contrast = layout, word_contrast
        self.scenes = [_Designed(scene, layout, word_contrast > 0) for scene in scenes if len(scene.words)]

    def __call__(self, values: Array) -> tuple[float, Array]:
        """Return the log-likelihood at ``values`` (k,), and its gradient (k,)."""
        total, gradient = 0.0, np.zeros_like(values)
        for scene in self.scenes:
            scores, slopes = scene.scores(values)
            found, pull = scene.contrast_pairs(scores)
            if self.word_contrast > 0:
                more, also = scene.contrast_words(scores)
                found += self.word_contrast * more
                pull = {word: pull[word] + self.word_contrast * also[word] for word in pull}
            total += found
            for word, (design, columns, _) in scene.designs.items():
                gradient[columns] += np.einsum("p,pk->k", pull[word] * slopes[word], design)
        return total, gradient

    def information(self, values: Array) -> Array:
        """Return the negated second derivative of the log-likelihood of the contrast between pairs.

        Parameters
        ----------
        values
            The k values of the models, in the order of the layout.

        Returns
        -------
        ndarray
            Positive semidefinite matrix of shape (k, k).
        """
        total = np.zeros((len(values), len(values)))
        for scene in self.scenes:
            scores, slopes = scene.scores(values)
            pull = scene.contrast_pairs(scores)[1]
            weights = scene.weights()
            for word, (design, columns, _) in scene.designs.items():
                share, slope = _softmax(scores[word]), slopes[word]
                sloped = slope[:, None] * design
                mean = share @ sloped
                spread = weights[word] * ((share[:, None] * sloped).T @ sloped - np.outer(mean, mean))
                bend = ((pull[word] * slope * (1 - slope))[:, None] * design).T @ design
                total[np.ix_(columns, columns)] += spread - bend
        return total


class Expansion:
    """Second-order expansion of a log-likelihood, with the interface of :class:`Likelihood`."""

    def __init__(self, centre: Array, gradient: Array, information: Array) -> None:
        self.centre, self.gradient, self.information = centre, gradient, information

    def __call__(self, values: Array) -> tuple[float, Array]:
        """Return the log-likelihood at ``values`` (k,), and its gradient (k,)."""
        step = values - self.centre
        bent = self.information @ step
        return float(self.gradient @ step - 0.5 * step @ bent), self.gradient - bent


class _Designed:
    """Design matrices of one scene: hat functions of every needed word for all p ordered pairs."""

    def __init__(self, scene: SaidPairs, layout: Layout, all_words: bool) -> None:
        apart = ~np.eye(len(scene.pairs), dtype=bool)
        saying = view(scene.pairs, SAYING)
        known = {model.name for model in layout.models}
        stated = [word for word in scene.words if MODEL_OF_WORD.get(word) in known]
        others = [word for word in FAMILIES if FAMILIES[word] in known] if all_words else []
        words = dict.fromkeys([*others, *stated])
        self.designs = {}
        for word in words:
            model = layout.model(MODEL_OF_WORD[word])
            parts = [hats(model, view(scene.pairs, word), apart), hats(layout.model(SAYING), saying, apart)]
            columns = np.concatenate([layout.columns(model.name), layout.columns(SAYING)])
            self.designs[word] = (np.concatenate(parts, axis=1), columns, model.outliers)
        position = np.full(apart.shape, -1)
        position[apart] = np.arange(apart.sum())
        self.stated_pairs = [
            (word, int(position[a, b]), float(weight))
            for word, (a, b), weight in zip(scene.words, scene.ends.tolist(), scene.weights.tolist(), strict=True)
            if word in words
        ]

    def scores(self, values: Array) -> tuple[dict[str, Array], dict[str, Array]]:
        """Return each word's log degree of every pair, outliers included, and its slope by the sum of terms."""
        scores, slopes = {}, {}
        for word, (design, columns, outliers) in self.designs.items():
            degree = (1 - outliers) * np.exp(np.minimum(design @ values[columns], MAX_STEP))
            scores[word] = np.log(outliers + degree)
            slopes[word] = degree / (outliers + degree)
        return scores, slopes

    def weights(self) -> dict[str, float]:
        """Return the total weight of each word's examples."""
        totals = dict.fromkeys(self.designs, 0.0)
        for word, _, weight in self.stated_pairs:
            totals[word] += weight
        return totals

    def contrast_pairs(self, scores: dict[str, Array]) -> tuple[float, dict[str, Array]]:
        """Return each word's pair among all pairs of the scene: log-likelihood, and its slope by the scores."""
        total, pull = 0.0, {word: np.zeros_like(score) for word, score in scores.items()}
        share = {word: _softmax(score) for word, score in scores.items()}
        for word, pair, weight in self.stated_pairs:
            total += weight * float(np.log(share[word][pair]))
            pull[word] -= weight * share[word]
            pull[word][pair] += weight
        return total, pull

    def contrast_words(self, scores: dict[str, Array]) -> tuple[float, dict[str, Array]]:
        """Return each pair's word among all words: log-likelihood, and its slope by the scores."""
        total, pull = 0.0, {word: np.zeros_like(score) for word, score in scores.items()}
        words = list(scores)
        share = np.stack([scores[word] for word in words])
        share = np.exp(share - share.max(axis=0))
        share /= share.sum(axis=0)
        for word, pair, weight in self.stated_pairs:
            total += weight * float(np.log(share[words.index(word), pair]))
            for other, part in zip(words, share[:, pair].tolist(), strict=True):
                pull[other][pair] += weight * ((other == word) - part)
        return total, pull


def hats(model: RelationModel, features: View, apart: NDArray[np.bool_]) -> Array:
    """Return the weight of every knot of every term for every pair, by linear interpolation.

    Parameters
    ----------
    model
        Model of a family of words.
    features
        Features of the pairs of a scene, by name, each of shape (n, n).
    apart
        Mask of the p pairs to use, shape (n, n).

    Returns
    -------
    ndarray
        Weights in [0, 1], shape (p, knots), the knots of all terms side by side.
    """
    parts = []
    for term in model.terms:
        knots = np.array(term.knots)
        if term.feature not in features:
            parts.append(np.zeros((int(apart.sum()), len(knots))))
            continue
        at = np.clip(features[term.feature][apart], knots[0], knots[-1])
        right = np.clip(np.searchsorted(knots, at, side="right"), 1, len(knots) - 1)
        share = (at - knots[right - 1]) / (knots[right] - knots[right - 1])
        weights = np.zeros((len(at), len(knots)))
        rows = np.arange(len(at))
        weights[rows, right - 1], weights[rows, right] = 1 - share, share
        parts.append(weights)
    return np.concatenate(parts, axis=1)


def _softmax(scores: Array) -> Array:
    shifted = np.exp(scores - scores.max())
    result: Array = shifted / shifted.sum()
    return result
