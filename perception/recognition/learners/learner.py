"""The protocol of all learners, and the base class of those that store the taught views."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from typing import Protocol

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.view_features import ViewFeatures


@dataclass(frozen=True)
class Prediction:
    """Prediction for a view: known categories with scores, the most likely first, and a score for unknown.

    Higher scores are more likely; a higher ``unknown`` means that the view is more likely of no known category. Both
    are comparable within a learner only. Without categories, or for a view without descriptors, ``ranked`` is empty and
    ``unknown`` infinite.

    >>> Prediction.of({"cup": -1.2, "mug": -0.8}, unknown=0.8).best
    'mug'
    """

    ranked: tuple[tuple[str, float], ...] = ()
    unknown: float = float("inf")

    @classmethod
    def of(cls, scores: dict[str, float], unknown: float) -> Prediction:
        """Return a prediction from the categories' scores; equal scores are ordered by name.

        Parameters
        ----------
        scores
            Score of each category; higher ones are more likely.
        unknown
            Score of unknown.

        Returns
        -------
        Prediction
            Prediction; an empty one without categories.
        """
        ranked = sorted(scores.items(), key=lambda item: (-item[1], item[0]))
        return cls(tuple(ranked), unknown) if ranked else cls()

    @property
    def best(self) -> str | None:
        """Most likely category; None without categories."""
        return self.ranked[0][0] if self.ranked else None


class Learner(Protocol):
    """Learner of categories, which begin when a teacher names a view.

    All methods raise RecognitionError for an unknown category, except ``learn`` and ``correct``, which begin a new one.
    The same calls in the same order give the same predictions.
    """

    name: str
    """Name of the learner."""

    @property
    def categories(self) -> tuple[str, ...]:
        """Names of the known categories, in the order of teaching."""
        ...

    @property
    def stored(self) -> int:
        """Number of instances, or prototypes, that are stored for all categories together."""
        ...

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Learn that a view shows the category.

        Parameters
        ----------
        category
            Name of the category, which may be new.
        view
            View with the descriptors of this learner.
        """
        ...

    def predict(self, view: ViewFeatures) -> Prediction:
        """Return the prediction for a view, without learning from it.

        Parameters
        ----------
        view
            View with the descriptors of this learner.

        Returns
        -------
        Prediction
            Known categories with scores, the most likely first; empty if the view cannot be compared.
        """
        ...

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Learn that the prediction for a view was wrong: it shows the category.

        Parameters
        ----------
        category
            Category that the view shows, which may be new.
        view
            View with the descriptors of this learner.
        """
        ...

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Learn that the prediction for a view was right: it shows the category.

        Parameters
        ----------
        category
            Category that was predicted.
        view
            View with the descriptors of this learner.

        Raises
        ------
        RecognitionError
            If the category is not known.
        """
        ...

    def forget(self, category: str) -> None:
        """Remove a category.

        Parameters
        ----------
        category
            Name of a known category.

        Raises
        ------
        RecognitionError
            If the category is not known.
        """
        ...

    def rename(self, category: str, name: str) -> None:
        """Rename a category.

        Parameters
        ----------
        category
            Name of a known category.
        name
            New name of it.

        Raises
        ------
        RecognitionError
            If the category is not known, or another one has the new name.
        """
        ...

    def merge(self, category: str, into: str) -> None:
        """Move the knowledge of one category to another, and remove the first.

        Parameters
        ----------
        category
            Category that is removed.
        into
            Category that keeps the knowledge of both.

        Raises
        ------
        RecognitionError
            If one of the categories is not known, or both are one category.
        """
        ...


class TaughtViews(Learner, ABC):
    """Base class of learners that store views by category, and are notified when a category changes.

    A view is stored when it is taught and when a prediction is corrected, as in the open-ended protocol of Seabra Lopes
    and Chauhan (2007) and in the paper; a right prediction adds nothing.
    """

    name = ""

    def __init__(self) -> None:
        self._views: dict[str, tuple[ViewFeatures, ...]] = {}

    @property
    def categories(self) -> tuple[str, ...]:
        """Names of the known categories, in the order of teaching."""
        return tuple(self._views)

    @property
    def stored(self) -> int:
        """Number of stored views."""
        return sum(map(len, self._views.values()))

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Store the view."""
        self._views[category] = (*self._views.get(category, ()), view)
        self._added(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Store the view, as if it had been taught."""
        self.learn(category, view)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Store nothing."""
        require_known(category, self._views)

    def forget(self, category: str) -> None:
        """Remove the category with all its views."""
        require_known(category, self._views)
        del self._views[category]
        self._rebuilt(category, ())

    def rename(self, category: str, name: str) -> None:
        """Rename the category, which keeps its place in the order."""
        require_free(category, name, self._views)
        self._views = {name if old == category else old: views for old, views in self._views.items()}
        self._rebuilt(category, ())
        self._rebuilt(name, self._views[name])

    def merge(self, category: str, into: str) -> None:
        """Append the views of the first category to those of the second."""
        require_two(category, into, self._views)
        self._views[into] += self._views.pop(category)
        self._rebuilt(category, ())
        self._rebuilt(into, self._views[into])

    @abstractmethod
    def predict(self, view: ViewFeatures) -> Prediction:
        """Return the prediction for a view."""

    @abstractmethod
    def _added(self, category: str, view: ViewFeatures) -> None:
        """Process one more view of a category."""

    @abstractmethod
    def _rebuilt(self, category: str, views: tuple[ViewFeatures, ...]) -> None:
        """Replace the views of a category; without views it is removed."""


def require_known(category: str, known: Collection[str]) -> None:
    """Raise RecognitionError if a category is not known.

    Parameters
    ----------
    category
        Name of the category.
    known
        Names of the known categories, which the error lists.

    Raises
    ------
    RecognitionError
        If the category is not known.
    """
    if category not in known:
        raise RecognitionError(f"unknown category '{category}'; the categories are: {', '.join(known) or 'none'}")


def require_free(category: str, name: str, known: Collection[str]) -> None:
    """Raise RecognitionError unless the category is known, and the name is its own or not in use.

    Parameters
    ----------
    category
        Name of the category.
    name
        New name of it.
    known
        Names of the known categories.

    Raises
    ------
    RecognitionError
        If the category is not known, or another one has the new name.
    """
    require_known(category, known)
    if name in known and name != category:
        raise RecognitionError(f"there is a category '{name}' already; merge '{category}' into it instead")


def require_two(category: str, into: str, known: Collection[str]) -> None:
    """Raise RecognitionError unless both categories are known and different.

    Parameters
    ----------
    category, into
        Names of the two categories.
    known
        Names of the known categories.

    Raises
    ------
    RecognitionError
        If one of them is not known, or both are one category.
    """
    require_known(category, known)
    require_known(into, known)
    if category == into:
        raise RecognitionError(f"'{category}' cannot be merged into itself")
