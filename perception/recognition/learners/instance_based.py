"""The instance-based learner of the paper: the answer is the nearest category by equations 1 to 4."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.learners.learner import Prediction, TaughtViews
from deixis.perception.recognition.learners.view_features import ViewFeatures, roots
from deixis.perception.recognition.recogniser import Recogniser
from deixis.perception.recognition.settings import DEFAULT, RecognitionSettings

INSTANCES = "equations 1-4, ICD of things"
"""Default name of the learner."""


class InstanceBased(TaughtViews):
    """Learner by equations 1 to 4 over one descriptor.

    A score is minus the normalised distance ND (equation 4), and ``unknown`` is the least ND.

    Equations 1 to 4, and a new instance at each teaching and each correction, are those of the paper (and of Kasaei et
    al., Interactive open-ended learning for 3D object recognition, 2015). There are three optional additions:

    - Descriptors are replaced by their square roots, so that the distance of equation 1 is the Hellinger distance
      between spin images, which sum to 1 (not with ``root`` False).
    - Equation 3 is over pairs of views of different things, and shrunk towards the median ICD of all categories, for
      the reasons in :mod:`deixis.perception.recognition.spread` (not with ``settings`` :data:`.PAPER`).
    - ``by_distance`` ranks categories by D_C (equation 2), and uses ND only for ``unknown``.

    Omitted: the threshold and probabilities, which belong to recognition as a whole.
    """

    def __init__(
        self,
        descriptor: str = "spin_images",
        *,
        root: bool = True,
        by_distance: bool = False,
        settings: RecognitionSettings = DEFAULT,
        name: str = INSTANCES,
    ) -> None:
        super().__init__()
        self.name = name
        self._descriptor, self._root, self._by_distance = descriptor, root, by_distance
        self._instances: dict[str, InstanceCategory] = {}
        self._recogniser = Recogniser.of([], settings)
        self._number = 0

    def predict(self, view: ViewFeatures) -> Prediction:
        """Rank the categories that have a comparable view by normalised distance, or by distance."""
        found = self._recogniser.recognise(self._described(view)).candidates
        usable = [candidate for candidate in found if candidate.nearest is not None]
        if not usable:
            return Prediction()
        scores = {one.category: -(one.distance if self._by_distance else one.normalised) for one in usable}
        return Prediction.of(scores, usable[0].normalised)

    def _described(self, view: ViewFeatures) -> NDArray[np.float32]:
        return roots(view[self._descriptor]) if self._root else view[self._descriptor]

    def _added(self, category: str, view: ViewFeatures) -> None:
        before = self._instances.get(category) or InstanceCategory(category)
        self._set(before.with_view(self._next(), self._described(view), view.thing))

    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        if category in self._instances:
            del self._instances[category]
            self._recogniser = self._recogniser.forgotten(category)
        if views:
            named = {self._next(): view for view in views}
            things = {key: view.thing for key, view in named.items() if view.thing is not None}
            described = [(key, self._described(view)) for key, view in named.items()]
            self._set(InstanceCategory.of(category, described, things))

    def _set(self, category: InstanceCategory) -> None:
        self._instances[category.name] = category
        self._recogniser = self._recogniser.learned(category)

    def _next(self) -> str:
        self._number += 1
        return str(self._number)
