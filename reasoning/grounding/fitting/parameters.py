"""Parameters of several models in one vector, with their prior and the bounds that keep trends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.relations import RelationModel, Term, Trend

Array = NDArray[np.float64]

RIDGE = 0.1
"""Prior precision of a value relative to that of differences between knots."""

MAX_STEP = 20.0
"""Maximum difference between log degrees of neighbouring knots."""


class Layout:
    """Positions of the values of each term in one vector."""

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
        """Return the model with a name.

        Parameters
        ----------
        name
            Name of a model of the layout.

        Returns
        -------
        RelationModel
            The model with its initial values.
        """
        return next(model for model in self.models if model.name == name)

    def columns(self, name: str) -> NDArray[np.int64]:
        """Return the positions of all values of a model.

        Parameters
        ----------
        name
            Name of a model.

        Returns
        -------
        ndarray
            Positions among the k values, increasing within each term.
        """
        spans = [self.slices[name, term.feature] for term in self.model(name).terms]
        return np.concatenate([np.arange(span.start, span.stop) for span in spans])

    def steps(self) -> Array:
        """Return the matrix that turns (first value, increments) of every term into values.

        Returns
        -------
        ndarray
            Block-diagonal matrix of shape (k, k), with a lower triangle of ones for each term.
        """
        from scipy.linalg import block_diag

        matrix: Array = block_diag(*(np.tril(np.ones((len(term.knots),) * 2)) for term in self.terms))
        return matrix

    def precision(self) -> Array:
        """Return the prior's precision matrix: of differences from knot to knot and, with a small weight, of values.

        Returns
        -------
        ndarray
            Symmetric matrix of shape (k, k).
        """
        from scipy.linalg import block_diag

        blocks = []
        for term in self.terms:
            difference = np.diff(np.eye(len(term.knots)), axis=0)
            blocks.append(difference.T @ difference + RIDGE * np.eye(len(term.knots)))
        matrix: Array = block_diag(*blocks)
        return matrix

    def bounds(self) -> list[tuple[float, float]]:
        """Return the bounds of first values and increments; increments of a term with a trend have its sign.

        Returns
        -------
        list of tuple
            Least and greatest value of each of the k numbers.
        """
        found = []
        for term in self.terms:
            low = 0.0 if term.trend is Trend.RISING else -MAX_STEP
            high = 0.0 if term.trend is Trend.FALLING else MAX_STEP
            found += [(-MAX_STEP, MAX_STEP)] + [(low, high)] * (len(term.knots) - 1)
        return found
