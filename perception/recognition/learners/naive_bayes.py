"""A view as a bag of words, and naive Bayes over them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.codebook import Codebook
from deixis.perception.recognition.learners.learner import Prediction
from deixis.perception.recognition.learners.taught_views import TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures


class NaiveBayes(TaughtViews):
    """Multinomial naive Bayes over the words of a codebook.

    Taken from S. H. Kasaei, M. Oliveira, G. H. Lim, L. Seabra Lopes, A. M. Tome: Towards lifelong assistive robotics: a
    tight coupling between object perception and manipulation, Neurocomputing 291, 2018: spin images become words of a
    codebook that is learnt unsupervised beforehand; a category is the counts of its views' words, with Laplace
    smoothing, and a prior by the number of its views; a view updates them at no more than the cost of counting.
    Changed: ``prior`` 0 takes all categories for equally likely, since a teacher corrects, and so shows, hard ones more
    often; ``smoothing`` is what each word is counted beforehand. Left out: the grasps.

    A score is the mean log-likelihood of a word; unknown is how far the best of them lies below that of the view's own
    shares of words, the most that any can have: the Kullback-Leibler divergence of the view from the category.
    """

    name = "naive Bayes"

    def __init__(self, codebook: Codebook, smoothing: float = 0.5, prior: float = 0.0) -> None:
        super().__init__()
        if not smoothing > 0.0 or prior < 0.0:
            raise RecognitionError(f"smoothing is above 0 and a prior's weight not below, not {smoothing:g}, {prior:g}")
        self._codebook, self._smoothing, self._prior = codebook, smoothing, prior
        self._counts: dict[str, NDArray[np.float64]] = {}  # (w,) each

    def predict(self, view: ViewFeatures) -> Prediction:
        """Ranks by the posterior."""
        if not self._counts or not view.has(self._codebook.descriptor):
            return Prediction()
        words = self._codebook.counts(view)
        number = words.sum()
        scores = {name: float(words @ self._log(counts)) / number for name, counts in self._counts.items()}
        shares = words[words > 0] / number
        unknown = float(shares @ np.log(shares)) - max(scores.values())
        for name in scores:
            scores[name] += self._prior * float(np.log(len(self._views[name]) / self.stored)) / number
        return Prediction.of(scores, unknown)

    def _log(self, counts: NDArray[np.float64]) -> NDArray[np.float64]:
        smoothed = counts + self._smoothing
        result: NDArray[np.float64] = np.log(smoothed / smoothed.sum())
        return result

    def _added(self, category: str, view: ViewFeatures) -> None:
        self._counts[category] = self._counts.get(category, np.zeros(len(self._codebook)))
        if view.has(self._codebook.descriptor):
            self._counts[category] = self._counts[category] + self._codebook.counts(view)

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        self._counts.pop(category, None)
        for view in views:
            self._added(category, view)
