"""Naive Bayes over bags of visual words, which are clusters of descriptors of local shapes."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Prediction, TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures, roots

SAMPLE = 8000
"""Maximum number of descriptors from which clusters are computed."""

ROUNDS = 15


@dataclass(frozen=True, eq=False)
class Codebook:
    """Codebook of w words: the centres (w, d) of clusters, in square roots of one descriptor."""

    descriptor: str
    centres: NDArray[np.float64]

    @classmethod
    def of(
        cls, views: Iterable[ViewFeatures], words: int = 80, descriptor: str = "spin_images", seed: int = 0
    ) -> Codebook:
        """Return a codebook of the descriptors of views, by k-means.

        It does not use categories.

        Parameters
        ----------
        views
            Views, of which one must have a descriptor.
        words
            Number of words; there are fewer if there are fewer distinct descriptors.
        descriptor
            Name of the descriptor.
        seed
            Seed of the first centres.

        Returns
        -------
        Codebook
            Codebook whose words are the centres of the clusters.

        Raises
        ------
        RecognitionError
            If ``words`` is below 1, or no view has a descriptor.

        Notes
        -----
        The first centres are chosen by k-means++ (Arthur and Vassilvitskii 2007).
        """
        from scipy.cluster.vq import kmeans2

        found = [view[descriptor] for view in views]
        rows = roots(np.concatenate(found)).astype(np.float64) if found else np.empty((0, 1))
        if words < 1 or not len(rows):
            raise RecognitionError(f"{words} words of '{descriptor}' cannot be found among {len(rows)} descriptors")
        rng = np.random.default_rng(seed)
        if len(rows) > SAMPLE:
            rows = rows[np.sort(rng.choice(len(rows), SAMPLE, replace=False))]
        count = min(words, len(np.unique(rows, axis=0)))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an empty cluster keeps its centre
            centres, _ = kmeans2(rows, count, iter=ROUNDS, minit="++", rng=rng)
        return cls(descriptor, centres)

    def __len__(self) -> int:
        return len(self.centres)

    def counts(self, view: ViewFeatures) -> NDArray[np.float64]:
        """Return the counts of the words in a view; each descriptor counts as its nearest word.

        Parameters
        ----------
        view
            View with the codebook's descriptor.

        Returns
        -------
        ndarray
            Counts of the w words, shape (w,).
        """
        rows = roots(view[self.descriptor])
        distances = (self.centres**2).sum(axis=1) - 2.0 * rows @ self.centres.T
        return np.bincount(distances.argmin(axis=1), minlength=len(self)).astype(np.float64)


class NaiveBayes(TaughtViews):
    """Learner by multinomial naive Bayes over the words of a codebook.

    The method is that of S. H. Kasaei, M. Oliveira, G. H. Lim, L. Seabra Lopes, A. M. Tome: Towards lifelong assistive
    robotics: a tight coupling between object perception and manipulation, Neurocomputing 291, 2018. Spin images become
    words of a codebook that is learned in advance without supervision. A category is the counts of its views' words,
    with Laplace smoothing, and a prior by the number of its views; an update costs no more than counting. Changed: a
    ``prior`` of 0 makes all categories equally likely, since a teacher corrects hard ones, and so shows them, more
    often; ``smoothing`` is the initial count of each word. Omitted: grasps.

    A score is the mean log-likelihood of a word. ``unknown`` is the difference between the largest possible score, that
    of the view's own shares of words, and the best score: the Kullback-Leibler divergence of the view from the
    category.
    """

    name = "naive Bayes"

    def __init__(self, codebook: Codebook, smoothing: float = 0.5, prior: float = 0.0) -> None:
        super().__init__()
        if not smoothing > 0.0 or prior < 0.0:
            raise RecognitionError(
                f"`smoothing` must be above 0 and `prior` at least 0, got {smoothing:g} and {prior:g}"
            )
        self._codebook, self._smoothing, self._prior = codebook, smoothing, prior
        self._counts: dict[str, NDArray[np.float64]] = {}  # (w,) each

    def predict(self, view: ViewFeatures) -> Prediction:
        """Rank the categories by posterior probability."""
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
