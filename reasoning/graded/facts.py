"""What stated facts weigh for every pair of perceived boxes: graded (or crisp) tables for matching.

A saying model gives the probability that a fact is said of a pair, up to a constant that cancels against chance:

- a word: outliers + (1 - outliers) * s * d, with d the word's degree and s how readily the pair is spoken of;
- a choice (``or``): the mixture of its words, each as likely as the next: d is the mean of theirs;
- a denial (``not``): d is the product of the complements 1 - d of its words;
- of all speakers a share ``literal`` takes words literally: they say of any pair what the crisp reading admits, as
  readily as the degree 1, 0.5 or 0, which a name borne by one pair in ten has by chance;
- a hedge of weight w: it holds with probability w, else it says nothing: log(w exp(l) + 1 - w), with l its evidence;
- ``optional``: a fact that need not hold is one that holds every other time: w is halved.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Relation, Relations
from deixis.ontology.relation_models import SAYING, RelationModels
from deixis.reasoning.errors import SettingError
from deixis.reasoning.graded.degrees import log_likelihood_ratio, relation_degree, saying_degree
from deixis.reasoning.graded.geometry import PairGeometry, pair_geometry
from deixis.reasoning.graded.shipped import shipped_models
from deixis.reasoning.rectangle import box_relations

Array = NDArray[np.float64]

OPTIONAL_WEIGHT = 0.5
"""By what the weight of an optional fact is multiplied."""

LITERAL = 0.3
"""The share of literal speakers that is taken for granted."""

LITERAL_CHANCE = 0.1
"""The degree by chance of a word taken literally: it is one of ten names."""


@dataclass(frozen=True, eq=False)
class FactTables:
    """The facts of a description as :class:`deixis.reasoning.matching.problem.Problem` takes them (m facts, k tables).

    ``edges`` are the description's edges that are compared: all but those of an object to itself.
    """

    edges: NDArray[np.int64]  # (m,)
    ends: NDArray[np.int64]  # (m, 2)
    kinds: NDArray[np.int64]  # (m,)
    tables: NDArray[np.float32]  # (k, n2, n2), log-likelihood ratios, finite, 0 on the diagonal


def fact_tables(
    description: RelationGraph,
    boxes: NDArray[np.float64],
    models: RelationModels | None = None,
    *,
    saying: bool = True,
    literal: float = LITERAL,
) -> FactTables:
    """The evidence of every fact for every ordered pair of n2 boxes (n2, 2, d).

    ``saying`` takes into account which pairs people speak of; without it only the words count. Raises GraphError for
    boxes that are none, UnknownTermError for a word that has no model, SettingError for a weight or a share of literal
    speakers beyond 0 to 1.
    """
    if not 0 <= literal <= 1:
        raise SettingError(f"the share of literal speakers lies between 0 and 1, not at {literal:g}")
    said = _Speakers(pair_geometry(boxes), models or shipped_models(), description.vocabulary, saying, literal)
    edges = np.flatnonzero(description.subjects != description.objects)
    rows: dict[tuple[int, bool, float], int] = {}
    kinds = []
    for edge in edges.tolist():
        weight = float(description.weights[edge]) * (OPTIONAL_WEIGHT if description.optional[edge] else 1.0)
        key = (int(description.relation_sets[edge]), bool(description.positive[edge]), weight)
        kinds.append(rows.setdefault(key, len(rows)))
    tables = [said.evidence(description.vocabulary.members(mask), sign, weight) for mask, sign, weight in rows]
    stacked = np.array(tables, dtype=np.float32).reshape(len(tables), len(boxes), len(boxes))
    return FactTables(edges.astype(np.int64), _ends(description, edges), np.array(kinds, dtype=np.int64), stacked)


class _Speakers:
    """What is said of the pairs of one scene."""

    def __init__(
        self, pairs: PairGeometry, models: RelationModels, vocabulary: Relations, saying: bool, literal: float
    ) -> None:
        self.pairs, self.models, self.vocabulary, self.literal = pairs, models, vocabulary, literal
        self.spoken = saying_degree(pairs, models) if saying else np.ones((len(pairs), len(pairs)))
        self.spoken_by_chance = models[SAYING].chance if saying else 1.0
        self.names = box_relations(pairs.boxes, vocabulary).names if literal > 0 else None

    def evidence(self, relations: tuple[Relation, ...], positive: bool, weight: float) -> Array:
        """The log-likelihood ratio of one fact, shape (n2, n2)."""
        known = [self.models.of(relation) for relation in relations]
        degrees = np.stack([relation_degree(self.pairs, relation, self.models) for relation in relations])
        degree = combined(degrees, positive) * self.spoken
        chance = float(combined(np.array([model.chance for model in known]), positive)) * self.spoken_by_chance
        outliers = float(np.mean([model.outliers for model in known]))
        evidence = log_likelihood_ratio(degree, outliers, chance)
        if self.names is not None:
            crisp = literal_degree(relations, positive, self.names, self.vocabulary)
            by_chance = min(LITERAL_CHANCE * len(relations), 1.0)
            taken = log_likelihood_ratio(crisp, outliers, by_chance if positive else 1 - by_chance)
            evidence = _mixed(evidence, taken, self.literal)
        evidence = hedged(evidence, weight)
        np.fill_diagonal(evidence, 0.0)
        return evidence


def _mixed(graded: Array, literal: Array, share: float) -> Array:
    """The logarithm of a mixture of two likelihood ratios."""
    result: Array = np.log((1 - share) * np.exp(graded) + share * np.exp(literal))
    return result


def literal_degree(
    relations: tuple[Relation, ...], positive: bool, names: NDArray[np.integer], vocabulary: Relations
) -> Array:
    """The crisp reading, shape (n2, n2): 1, 0.5 or 0 by the exact name that each pair bears (-1: none)."""
    best = vocabulary.degrees[[relation.index for relation in relations]].max(axis=0)
    degree = best if positive else (best == 0).astype(np.float64)
    result: Array = np.where(names >= 0, degree[names], 0.0)
    return result


def combined(degrees: Array, positive: bool) -> Array:
    """The degree of a choice between words (axis 0), or of the denial of all of them.

    >>> combined(np.array([0.8, 0.2]), True).item(), round(combined(np.array([0.8, 0.5]), False).item(), 3)
    (0.5, 0.1)
    """
    result: Array = np.asarray(degrees.mean(axis=0) if positive else np.prod(1 - degrees, axis=0))
    return result


def hedged(evidence: Array, weight: float) -> Array:
    """The evidence of a fact that holds with probability ``weight`` and otherwise says nothing.

    >>> hedged(np.array([3.0, -3.0]), 1.0).tolist(), hedged(np.array([3.0, -3.0]), 0.8).round(2).tolist()
    ([3.0, -3.0], [2.79, -1.43])

    Raises SettingError for a weight that is not above 0 and at most 1.
    """
    if not 0 < weight <= 1:
        raise SettingError(f"a fact weighs above 0 and at most 1, not {weight:g}")
    if weight == 1:
        return evidence
    result: Array = np.logaddexp(evidence + np.log(weight), np.log1p(-weight))
    return result


def crisp_tables(description: RelationGraph, names: NDArray[np.int16]) -> FactTables:
    """The crisp reading as the special case: 1, 0.5 or 0 by the pair's exact name, times the weight.

    ``names`` (n2, n2): relation indices, -1 on the diagonal, as :attr:`deixis.reasoning.evidence.Evidence.names` has.
    """
    vocabulary = description.vocabulary
    edges = np.flatnonzero(description.subjects != description.objects)
    tables = np.zeros((len(edges), *names.shape), dtype=np.float32)
    for row, edge in enumerate(edges.tolist()):
        relations = vocabulary.members(int(description.relation_sets[edge]))
        degree = literal_degree(relations, bool(description.positive[edge]), names, vocabulary)
        tables[row] = degree * description.weights[edge]
    kinds = np.arange(len(edges), dtype=np.int64)
    return FactTables(edges.astype(np.int64), _ends(description, edges), kinds, tables)


def _ends(description: RelationGraph, edges: NDArray[np.intp]) -> NDArray[np.int64]:
    return np.stack([description.subjects[edges], description.objects[edges]], axis=1).astype(np.int64)
