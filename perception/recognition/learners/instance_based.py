"""The paper's learner: a category is its instances, and the nearest category, by equations 1 to 4, is the answer."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.errors import RecognitionError
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.learners.learner import Prediction
from deixis.perception.recognition.learners.taught_views import TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures, roots
from deixis.perception.recognition.recogniser import Recogniser

SHRINKAGE = 15.0
"""Views that the median ICD counts for beside a category's own; chosen on simulated tableware (docs/open_ended.md)."""


class InstanceBased(TaughtViews):
    """Equations 1 to 4 over one descriptor; a score is minus ND, and unknown is the least ND.

    Taken from the paper (and Kasaei et al., Interactive open-ended learning for 3D object recognition, 2015):
    equations 1 to 4; an instance more at each teaching and at each correction. Added, each of which can be left out:

    - Descriptors are replaced by their square roots, so that the distance of equation 1 is Hellinger's between spin
      images, which sum to 1 (``root`` False: as they are).
    - Equation 3 from few instances is mostly chance, and a category that is divided by a large ICD swallows views of
      all others. So the ICD is drawn to the median one of all categories, as :func:`shrunk` says
      (``shrinkage`` 0: equations 3 and 4 as they stand).
    - ``by_distance`` names the category of least D_C (equation 2), and leaves ND to say what is unknown.

    What stands in for the ICD of one instance, or of identical ones, is the recogniser's
    (:mod:`deixis.perception.recognition.spread`). Left out: the threshold and probabilities, which belong to
    recognition as a whole.
    """

    def __init__(
        self,
        descriptor: str = "spin_images",
        *,
        root: bool = True,
        shrinkage: float = SHRINKAGE,
        by_distance: bool = False,
        name: str = "equations 1-4, ICD shrunk",
    ) -> None:
        super().__init__()
        if not 0.0 <= shrinkage < np.inf:
            raise RecognitionError(f"an ICD is shrunk by 0 views or more, not {shrinkage:g}")
        self.name = name
        self._descriptor, self._root, self._shrinkage, self._by_distance = descriptor, root, shrinkage, by_distance
        self._instances: dict[str, InstanceCategory] = {}
        self._recogniser = Recogniser.of([])
        self._number = 0

    def predict(self, view: ViewFeatures) -> Prediction:
        """Ranks by ND, or by D_C; categories without a view that can be compared are left out."""
        found = self._recogniser.recognise(self._described(view)).candidates
        usable = [candidate for candidate in found if candidate.nearest is not None]
        if not usable:
            return Prediction()
        distances = np.array([one.distance for one in usable])
        spreads = shrunk([one.spread.value for one in usable], [one.views for one in usable], self._shrinkage)
        ranking = distances if self._by_distance else distances / spreads
        scores = {one.category: -float(value) for one, value in zip(usable, ranking, strict=True)}
        return Prediction.of(scores, float((distances / spreads).min()))

    def _described(self, view: ViewFeatures) -> NDArray[np.float32]:
        return roots(view[self._descriptor]) if self._root else view[self._descriptor]

    def _added(self, category: str, view: ViewFeatures) -> None:
        before = self._instances.get(category) or InstanceCategory(category)
        self._set(before.with_view(self._next(), self._described(view)))

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        if category in self._instances:
            del self._instances[category]
            self._recogniser = self._recogniser.forgotten(category)
        if views:
            self._set(InstanceCategory.of(category, [(self._next(), self._described(view)) for view in views]))

    def _set(self, category: InstanceCategory) -> None:
        self._instances[category.name] = category
        self._recogniser = self._recogniser.learned(category)

    def _next(self) -> str:
        self._number += 1
        return str(self._number)


def shrunk(spreads: Sequence[float], views: Sequence[int], shrinkage: float) -> NDArray[np.float64]:
    """What equation 4 divides by, (m,): (n ICD + s M) / (n + s) for a category of n views, M being the median ICD.

    An estimate from n views is drawn to what is known of all categories as if that came from ``shrinkage`` views.

    >>> shrunk([1.0, 3.0, 8.0], [5, 5, 15], shrinkage=5.0).tolist()
    [2.0, 3.0, 6.75]
    """
    own, counts = np.array(spreads, np.float64), np.array(views, np.float64)
    return (counts * own + shrinkage * np.median(own)) / (counts + shrinkage)
