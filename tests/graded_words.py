"""Evidence of single words for pairs, as the facts of a description weigh it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import RelationModels
from deixis.ontology.relations.relation import Relation
from deixis.reasoning.geometry.pairs import PairGeometry
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees, log_likelihood_ratio


def relation_evidence(pairs: PairGeometry, relation: Relation, models: RelationModels) -> NDArray[np.float64]:
    """Return the log-likelihood ratio in nats of one relation for each ordered pair, shape (n, n)."""
    model = models.of(relation)
    return log_likelihood_ratio(WordDegrees(pairs, models).of(relation), model.outliers, model.chance)
