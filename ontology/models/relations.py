"""What a relation word means by degrees, as data: the parameters of graded models, and where they come from.

A model is a sum of terms. A term maps one feature of a pair of boxes to the logarithm of a degree, piecewise linear
between knots, 0 where it fits the word best. Nothing here computes; :mod:`deixis.reasoning.grounding.evidence` does.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import IntEnum

from deixis.errors import OntologyError, UnknownTermError
from deixis.ontology.relation import Relation, nearest

SAYING = "saying"
"""The name of the model of which pairs people speak of at all, whatever the word."""


class Trend(IntEnum):
    """Which way a term must go for the word to keep its meaning."""

    FALLING = -1
    FREE = 0
    RISING = 1


@dataclass(frozen=True, slots=True)
class Term:
    """Log degree by a feature: ``values[i]`` at ``knots[i]``, linear between them, constant beyond.

    Raises OntologyError where knots do not rise, numbers are not finite, a value is above 0 or against the trend.
    """

    feature: str
    knots: tuple[float, ...]
    values: tuple[float, ...]
    trend: Trend = Trend.FREE

    def __post_init__(self) -> None:
        where = f"the term '{self.feature}'"
        if len(self.knots) != len(self.values) or len(self.knots) < 2:
            raise OntologyError(f"{where}: give one value a knot, and two knots at least")
        if not all(map(math.isfinite, (*self.knots, *self.values))):
            raise OntologyError(f"{where}: a knot or a value is not finite")
        if any(b <= a for a, b in zip(self.knots, self.knots[1:], strict=False)):
            raise OntologyError(f"{where}: knots must rise")
        if max(self.values) > 1e-9:
            raise OntologyError(f"{where}: a log degree is 0 at the most, not {max(self.values):g}")
        if any((b - a) * self.trend < -1e-9 for a, b in zip(self.values, self.values[1:], strict=False)):
            raise OntologyError(f"{where}: its values must be {self.trend.name.lower()}")


@dataclass(frozen=True, slots=True)
class Provenance:
    """What a model was made from: ``examples`` facts of ``sources`` (files) and ``lessons`` (ids), when, and by what.

    ``version`` is that of Deixis, ``strength`` that of the prior, the shipped models; None where it is not known.
    """

    sources: tuple[str, ...] = ()
    examples: float = 0.0
    made: datetime | None = None
    version: str = ""
    lessons: tuple[str, ...] = ()
    strength: float | None = None


@dataclass(frozen=True, slots=True)
class RelationModel:
    """The graded meaning of a family of words that mirror each other, or, named ``saying``, of speaking of a pair.

    ``outliers`` is the share of facts that are said of any pair whatever; ``chance`` the mean degree of a random pair.
    """

    name: str  # 'horizontal', 'vertical', 'diagonal', 'support' or 'saying'
    terms: tuple[Term, ...]
    outliers: float
    chance: float
    provenance: Provenance = field(default_factory=Provenance)

    def __post_init__(self) -> None:
        if not 0 < self.outliers < 1 or not 0 < self.chance <= 1:
            raise OntologyError(f"the model '{self.name}': outliers and chance lie between 0 and 1")
        if len({term.feature for term in self.terms}) != len(self.terms):
            raise OntologyError(f"the model '{self.name}' has two terms for one feature")

    def without(self, *features: str) -> RelationModel:
        """Return the same model blind to some features."""
        terms = tuple(term for term in self.terms if term.feature not in features)
        return RelationModel(self.name, terms, self.outliers, self.chance, self.provenance)


FAMILIES: Mapping[str, str] = {
    "left": "horizontal",
    "right": "horizontal",
    "top": "vertical",
    "bottom": "vertical",
    "top_left": "diagonal",
    "top_right": "diagonal",
    "bottom_left": "diagonal",
    "bottom_right": "diagonal",
    "on": "support",
    "under": "support",
}
"""The model that each word shares with its mirror images and its inverse."""


@dataclass(frozen=True)
class RelationModels:
    """All models, by name."""

    models: Mapping[str, RelationModel]

    def __post_init__(self) -> None:
        missing = {*FAMILIES.values(), SAYING} - set(self.models)
        if missing:
            raise OntologyError(f"there is no graded model '{min(missing)}'; start from the shipped ones")

    def __getitem__(self, name: str) -> RelationModel:
        try:
            return self.models[name]
        except KeyError:
            raise UnknownTermError(f"there is no graded model '{name}'") from None

    def of(self, relation: Relation) -> RelationModel:
        """Return the model of a relation's word; raises UnknownTermError where it has none."""
        if relation.word not in FAMILIES:
            hint = nearest(relation.word, FAMILIES)
            advice = f"; did you mean '{hint}'?" if hint else ""
            raise UnknownTermError(f"the word '{relation.word}' has no graded model{advice}")
        return self[FAMILIES[relation.word]]

    def replaced(self, *models: RelationModel) -> RelationModels:
        """Return the same with some models exchanged for others of their names."""
        return RelationModels({**self.models, **{model.name: model for model in models}})
