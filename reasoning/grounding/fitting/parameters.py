"""The values of several models in one vector, the prior over them, and what keeps a trend."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import RelationModel, Term, Trend

Array = NDArray[np.float64]

RIDGE = 0.1
"""How much the prior holds a value itself, relative to how much it holds differences."""

MAX_STEP = 20.0
"""No log degree is farther from the next one."""


class Layout:
    """Where the values of each term stand in one vector."""

    def __init__(self, models: Sequence[RelationModel]) -> None:
        self.models = tuple(models)
        self.slices: dict[tuple[str, str], slice] = {}
        self.terms: list[Term] = []
        start = 0
        for model in models:
            for term in model.terms:
                self.slices[model.name, term.feature] = slice(start, start + len(term.knots))
                self.terms.append(term)
                start += len(term.knots)
        self.prior = np.concatenate([term.values for term in self.terms])

    def model(self, name: str) -> RelationModel:
        return next(model for model in self.models if model.name == name)

    def columns(self, name: str) -> NDArray[np.int64]:
        """Return the positions of all values of a model."""
        spans = [self.slices[name, term.feature] for term in self.model(name).terms]
        return np.concatenate([np.arange(span.start, span.stop) for span in spans])

    def steps(self) -> Array:
        """Return the matrix that turns (first value, increments) of every term into values."""
        from scipy.linalg import block_diag

        matrix: Array = block_diag(*(np.tril(np.ones((len(term.knots),) * 2)) for term in self.terms))
        return matrix

    def precision(self) -> Array:
        """Return the prior's precision of all values: differences from knot to knot, and, more loosely, values."""
        from scipy.linalg import block_diag

        blocks = []
        for term in self.terms:
            difference = np.diff(np.eye(len(term.knots)), axis=0)
            blocks.append(difference.T @ difference + RIDGE * np.eye(len(term.knots)))
        matrix: Array = block_diag(*blocks)
        return matrix

    def bounds(self) -> list[tuple[float, float]]:
        """Return what first values and increments may be: increments of a term with a trend have its sign."""
        found = []
        for term in self.terms:
            low = 0.0 if term.trend is Trend.RISING else -MAX_STEP
            high = 0.0 if term.trend is Trend.FALLING else MAX_STEP
            found += [(-MAX_STEP, MAX_STEP)] + [(low, high)] * (len(term.knots) - 1)
        return found
