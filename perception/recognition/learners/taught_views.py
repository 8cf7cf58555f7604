"""What learners share that keep the views they were taught."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Prediction
from deixis.perception.recognition.learners.view_features import ViewFeatures


class TaughtViews(ABC):
    """Views by category. A learner builds upon them what it predicts from, and is told when a category changes.

    A view is kept when it is taught and when an answer is corrected, as in the open-ended protocol of Seabra Lopes and
    Chauhan (2007) and in the paper; a right answer adds nothing.
    """

    name = ""

    def __init__(self) -> None:
        self._views: dict[str, tuple[ViewFeatures, ...]] = {}

    @property
    def categories(self) -> tuple[str, ...]:
        """In the order in which they were taught first."""
        return tuple(self._views)

    @property
    def stored(self) -> int:
        """Views that are kept."""
        return sum(map(len, self._views.values()))

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Keeps the view."""
        self._views[category] = (*self._views.get(category, ()), view)
        self._added(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Keeps the view, as if it had been taught."""
        self.learn(category, view)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Keeps nothing; raises RecognitionError where the category is not known."""
        require_known(category, self._views)

    def forget(self, category: str) -> None:
        """Drops the category with all its views."""
        require_known(category, self._views)
        del self._views[category]
        self._rebuilt(category, ())

    def rename(self, category: str, name: str) -> None:
        """Keeps the category's place in the order."""
        require_free(category, name, self._views)
        self._views = {name if old == category else old: views for old, views in self._views.items()}
        self._rebuilt(category, ())
        self._rebuilt(name, self._views[name])

    def merge(self, category: str, into: str) -> None:
        """The views of the second, and then those of the first."""
        require_two(category, into, self._views)
        self._views[into] += self._views.pop(category)
        self._rebuilt(category, ())
        self._rebuilt(into, self._views[into])

    @abstractmethod
    def predict(self, view: ViewFeatures) -> Prediction:
        """What the view may be."""

    @abstractmethod
    def _added(self, category: str, view: ViewFeatures) -> None:
        """One view more is kept of a category."""

    @abstractmethod
    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        """A category has these views from now on; without any it is gone."""


def require_known(category: str, known: Collection[str]) -> None:
    """Raises RecognitionError, with the names there are, where the category is none of them."""
    if category not in known:
        raise RecognitionError(f"there is no category '{category}'; known are: {', '.join(known) or 'none'}")


def require_free(category: str, name: str, known: Collection[str]) -> None:
    """Raises RecognitionError unless the category is known and the name is its own or nobody's."""
    require_known(category, known)
    if name in known and name != category:
        raise RecognitionError(f"there is a category '{name}' already; merge '{category}' into it instead")


def require_two(category: str, into: str, known: Collection[str]) -> None:
    """Raises RecognitionError unless two different known categories are named."""
    require_known(category, known)
    require_known(into, known)
    if category == into:
        raise RecognitionError(f"'{category}' cannot be merged into itself")
