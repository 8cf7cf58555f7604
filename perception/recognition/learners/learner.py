"""What every learner looks like from outside, and what those share that keep the views they were taught."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from typing import Protocol

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.view_features import ViewFeatures


@dataclass(frozen=True)
class Prediction:
    """What a learner takes a view for: known categories with their scores, the likeliest first, and a doubt.

    A higher ``score`` is likelier; a higher ``unknown`` says that the view is rather of no known category. Both compare
    within a learner, not between two. Without a category, or a view that can be described, nothing is ranked and
    ``unknown`` is infinite.

    >>> Prediction.of({"cup": -1.2, "mug": -0.8}, unknown=0.8).best
    'mug'
    """

    ranked: tuple[tuple[str, float], ...] = ()
    unknown: float = float("inf")

    @classmethod
    def of(cls, scores: dict[str, float], unknown: float) -> Prediction:
        """Return the categories by score; of equal scores the first name goes first."""
        ranked = sorted(scores.items(), key=lambda item: (-item[1], item[0]))
        return cls(tuple(ranked), unknown) if ranked else cls()

    @property
    def best(self) -> str | None:
        """The likeliest category; None where nothing is ranked."""
        return self.ranked[0][0] if self.ranked else None


class Learner(Protocol):
    """Categories that come into being when a teacher names a view; none is there before.

    Whatever names a category that is not known raises RecognitionError, but for ``learn`` and ``correct``, which begin
    a new one. The same calls in the same order give the same predictions.
    """

    @property
    def name(self) -> str: ...

    @property
    def categories(self) -> tuple[str, ...]:
        """The names of what is known, in the order in which it was taught."""
        ...

    @property
    def stored(self) -> int:
        """Instances, or prototypes, that are kept of all categories together."""
        ...

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Learn what a view shows, as the teacher says it."""
        ...

    def predict(self, view: ViewFeatures) -> Prediction:
        """Return what the view may be; nothing is learnt from being asked."""
        ...

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Learn that the answer to the view was wrong: it shows the category."""
        ...

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Learn that the answer to the view was right: it shows the category."""
        ...

    def forget(self, category: str) -> None: ...

    def rename(self, category: str, name: str) -> None:
        """Raise RecognitionError where the new name is another category's."""
        ...

    def merge(self, category: str, into: str) -> None:
        """Move what is known of one category to another."""
        ...


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
        """Keep the view."""
        self._views[category] = (*self._views.get(category, ()), view)
        self._added(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Keep the view, as if it had been taught."""
        self.learn(category, view)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Keep nothing; raise RecognitionError where the category is not known."""
        require_known(category, self._views)

    def forget(self, category: str) -> None:
        """Drop the category with all its views."""
        require_known(category, self._views)
        del self._views[category]
        self._rebuilt(category, ())

    def rename(self, category: str, name: str) -> None:
        """Keep the category's place in the order."""
        require_free(category, name, self._views)
        self._views = {name if old == category else old: views for old, views in self._views.items()}
        self._rebuilt(category, ())
        self._rebuilt(name, self._views[name])

    def merge(self, category: str, into: str) -> None:
        """Keep the views of the second category, and then those of the first."""
        require_two(category, into, self._views)
        self._views[into] += self._views.pop(category)
        self._rebuilt(category, ())
        self._rebuilt(into, self._views[into])

    @abstractmethod
    def predict(self, view: ViewFeatures) -> Prediction:
        """Return what the view may be."""

    @abstractmethod
    def _added(self, category: str, view: ViewFeatures) -> None:
        """Take in one more view of a category."""

    @abstractmethod
    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        """Replace the views of a category; without any it is gone."""


def require_known(category: str, known: Collection[str]) -> None:
    """Raise RecognitionError, with the names there are, where the category is none of them."""
    if category not in known:
        raise RecognitionError(f"there is no category '{category}'; known are: {', '.join(known) or 'none'}")


def require_free(category: str, name: str, known: Collection[str]) -> None:
    """Raise RecognitionError unless the category is known and the name is its own or nobody's."""
    require_known(category, known)
    if name in known and name != category:
        raise RecognitionError(f"there is a category '{name}' already; merge '{category}' into it instead")


def require_two(category: str, into: str, known: Collection[str]) -> None:
    """Raise RecognitionError unless two different known categories are named."""
    require_known(category, known)
    require_known(into, known)
    if category == into:
        raise RecognitionError(f"'{category}' cannot be merged into itself")
