"""Graded models of the relation words as data: their parameters, and the examples that they were fitted to.

A model is a sum of terms. A term maps one feature of a pair of boxes to the logarithm of a degree; it is piecewise
linear between knots, and 0 where the pair fits the word best. The degrees are computed in
:mod:`deixis.reasoning.grounding.evidence`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from enum import IntEnum

from deixis.errors import OntologyError, UnknownTermError
from deixis.ontology.relations.relation import Relation
from deixis.spelling import nearest

SAYING = "saying"
"""Name of the model of the pairs that people mention at all, in whatever relation."""


class Trend(IntEnum):
    """Direction in which the values of a term must go for the word to keep its meaning."""

    FALLING = -1
    FREE = 0
    RISING = 1


@dataclass(frozen=True, slots=True)
class Term:
    """A log degree as a function of a feature: ``values[i]`` at ``knots[i]``, linear between knots, constant outside.

    Raises OntologyError if the knots do not increase, a number is not finite, or a value is above 0 or goes against
    the trend.
    """

    feature: str
    knots: tuple[float, ...]
    values: tuple[float, ...]
    trend: Trend = Trend.FREE

    def __post_init__(self) -> None:
        where = f"the term '{self.feature}'"
        if len(self.knots) != len(self.values) or len(self.knots) < 2:
            raise OntologyError(
                f"{where}: there must be at least two knots, and one value per knot, "
                f"got {len(self.knots)} knots and {len(self.values)} values"
            )
        if not all(map(math.isfinite, (*self.knots, *self.values))):
            raise OntologyError(f"{where}: knots and values must be finite, got {self.knots} and {self.values}")
        if any(b <= a for a, b in zip(self.knots, self.knots[1:], strict=False)):
            raise OntologyError(f"{where}: knots must increase, got {self.knots}")
        if max(self.values) > 1e-9:
            raise OntologyError(f"{where}: a log degree must be at most 0, got {max(self.values):g}")
        if any((b - a) * self.trend < -1e-9 for a, b in zip(self.values, self.values[1:], strict=False)):
            raise OntologyError(f"{where}: its values must be {self.trend.name.lower()}, got {self.values}")


@dataclass(frozen=True, slots=True)
class Provenance:
    """Origin of a model: ``examples`` facts of ``sources`` (files) and ``lessons`` (ids), and when it was made.

    ``version`` is the version of Deixis, ``strength`` that of the prior (the shipped models), None if it is not known.
    """

    sources: tuple[str, ...] = ()
    examples: float = 0.0
    made: datetime | None = None
    version: str = ""
    lessons: tuple[str, ...] = ()
    strength: float | None = None


@dataclass(frozen=True, slots=True)
class RelationModel:
    """Graded meaning of a family of words that mirror each other; the model ``saying`` is of mentioning a pair at all.

    ``outliers`` is the share of facts that fit any pair, ``chance`` the mean degree of a random pair.
    """

    name: str  # a value of FAMILIES or GRADED_FAMILIES, or 'saying'
    terms: tuple[Term, ...]
    outliers: float
    chance: float
    provenance: Provenance = field(default_factory=Provenance)

    def __post_init__(self) -> None:
        if not 0 < self.outliers < 1 or not 0 < self.chance <= 1:
            raise OntologyError(
                f"the model '{self.name}': outliers and chance must lie between 0 and 1, "
                f"got {self.outliers:g} and {self.chance:g}"
            )
        if len({term.feature for term in self.terms}) != len(self.terms):
            raise OntologyError(f"the model '{self.name}' has two terms for one feature")

    def without(self, *features: str) -> RelationModel:
        """Return the model without the terms of some features.

        Parameters
        ----------
        features
            Names of the features.

        Returns
        -------
        RelationModel
            The model with the other terms.
        """
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
"""Model of each of the ten words, shared with its mirror images and its inverse."""

GRADED_FAMILIES: Mapping[str, str] = {
    "near": "nearness",
    "next_to": "adjacency",
    "far": "farness",
    "in_front": "vertical",
    "behind": "vertical",
    "above": "height",
    "below": "height",
    "inside": "containment",
    "containing": "containment",
    "touching": "contact",
    "against": "contact",
    "leaning": "contact",
    "leaned_on_by": "contact",
    "along": "along",
    "across": "crossing",
    "crossed_by": "crossing",
    "stacked": "support",
    "stacked_under": "support",
    "around": "adjacency",
    "ringed_by": "adjacency",
    "parallel": "parallels",
    "aligned": "alignment",
    "level_with": "level",
    "bigger": "comparison",
    "smaller": "comparison",
    "taller": "comparison",
    "shorter": "comparison",
    "longer": "comparison",
    "less_long": "comparison",
    "wider": "comparison",
    "narrower": "comparison",
    "opposite": "opposition",
    "facing": "facing",
    "faced_by": "facing",
    "pointing": "pointing",
    "pointed_at_by": "pointing",
}
"""Model of each word in the graded reading."""

ORIENTED = frozenset({"facing", "pointing"})
"""Models of words that say nothing about things without a known orientation."""

MODEL_OF_WORD: Mapping[str, str] = {**FAMILIES, **GRADED_FAMILIES}
"""Model of every word that has one."""


@dataclass(frozen=True, repr=False)
class RelationModels:
    """All graded models, by name."""

    models: Mapping[str, RelationModel]

    def __repr__(self) -> str:
        return f"<RelationModels {', '.join(self.models)}>"

    def __post_init__(self) -> None:
        missing = {*FAMILIES.values(), SAYING} - set(self.models)
        if missing:
            raise OntologyError(f"there is no graded model '{min(missing)}'; start from the shipped ones")

    def __getitem__(self, name: str) -> RelationModel:
        try:
            return self.models[name]
        except KeyError:
            raise UnknownTermError(
                f"there is no graded model '{name}'; the models are {', '.join(self.models)}"
            ) from None

    def of(self, relation: Relation) -> RelationModel:
        """Return the model of the word of a relation.

        Parameters
        ----------
        relation
            The relation.

        Returns
        -------
        RelationModel
            The model.

        Raises
        ------
        UnknownTermError
            If the word has no model.
        """
        family = self.family(relation.word)
        if family not in self.models:
            raise UnknownTermError(f"the word '{relation.word}' has no graded model")
        return self.models[family]

    @staticmethod
    def family(word: str) -> str:
        """Return the name of the model of a word.

        Parameters
        ----------
        word
            The relation word.

        Returns
        -------
        str
            The name; a word and its inverse have one model.

        Raises
        ------
        UnknownTermError
            If the word has no model.
        """
        if word not in MODEL_OF_WORD:
            hint = nearest(word, MODEL_OF_WORD)
            advice = f"; did you mean '{hint}'?" if hint else ""
            raise UnknownTermError(f"the word '{word}' has no graded model{advice}")
        return MODEL_OF_WORD[word]

    def replaced(self, *models: RelationModel) -> RelationModels:
        """Return a copy with other models.

        Parameters
        ----------
        models
            Models that replace those of the same names.

        Returns
        -------
        RelationModels
            The copy.
        """
        return RelationModels({**self.models, **{model.name: model for model in models}})
