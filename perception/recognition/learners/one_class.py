"""One-class learning: a description of each category from its own views only."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.extras import require
from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Prediction, TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures, pooled

POOLED_DESCRIBERS = ("spin_images", "good", "d2_extents")
"""Names of the descriptors that are pooled into a view's vector."""


class SupportVectorDescription(TaughtViews):
    """Learner with a support vector data description (SVDD) per category, over pooled descriptors, with an RBF kernel.

    The method is that of L. Seabra Lopes, A. Chauhan: How many words can my robot learn? An approach and experiments
    with one-class learning, Interaction Studies 8(1), 2007. A category is described by its own instances only, so that
    a new category changes no other; it is retrained when an instance is added. A view belongs to the category in whose
    boundary it is deepest, or least outside, relative to the size of the description. Omitted: features of 2-D
    contours, and spoken names.

    scikit-learn's one-class SVM is used: for a kernel with constant k(x, x), such as the RBF, it has the same support
    vectors as the smallest ball of SVDD (Schoelkopf et al. 2001). With f(x) = sum of a_i k(x_i, x), which is rho on the
    boundary, scores are f(x) / rho: 1 on the boundary, and more inside. ``outliers`` is nu, the share of a category's
    own views that may lie outside; ``reach`` is the width of the kernel, exp(-|x - y|^2 / reach^2).

    Raises MissingExtraError if scikit-learn is not installed, and RecognitionError for settings out of range.
    """

    name = "SVDD"

    def __init__(
        self, descriptors: Sequence[str] = POOLED_DESCRIBERS, outliers: float = 0.1, reach: float = 0.5
    ) -> None:
        super().__init__()
        require("sklearn", "the learner SVDD")
        if not 0.0 < outliers < 1.0 or not reach > 0.0:
            raise RecognitionError(f"`outliers` must be in (0, 1) and `reach` above 0, got {outliers:g} and {reach:g}")
        self._descriptors, self._outliers, self._gamma = tuple(descriptors), outliers, reach**-2
        self._machines: dict[str, Any] = {}

    def predict(self, view: ViewFeatures) -> Prediction:
        """Rank the categories by the depth of the view in their descriptions; ``unknown`` is 1 - the best score."""
        vector = pooled(view, self._descriptors)
        if vector is None or not self._machines:
            return Prediction()
        scores = {name: _depth(machine, vector) for name, machine in self._machines.items()}
        return Prediction.of(scores, 1.0 - max(scores.values()))

    def _added(self, category: str, view: ViewFeatures) -> None:
        self._rebuilt(category, self._views[category])

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        self._machines.pop(category, None)
        vectors = [vector for view in views if (vector := pooled(view, self._descriptors)) is not None]
        if vectors:
            from sklearn.svm import OneClassSVM

            machine = OneClassSVM(kernel="rbf", gamma=self._gamma, nu=self._outliers)
            self._machines[category] = machine.fit(np.stack(vectors))


def _depth(machine: Any, vector: NDArray[np.float64]) -> float:
    rho = -float(np.ravel(machine.intercept_)[0])
    return float(machine.score_samples(vector[None])[0]) / max(rho, 1e-12)
