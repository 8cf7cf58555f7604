"""What every learner looks like from outside."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

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
        """Of equal scores the first name goes first."""
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
        """The teacher says what a view shows."""
        ...

    def predict(self, view: ViewFeatures) -> Prediction:
        """What the view may be; nothing is learnt from being asked."""
        ...

    def correct(self, category: str, view: ViewFeatures) -> None:
        """The answer to the view was wrong: it shows the category."""
        ...

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """The answer to the view was right: it shows the category."""
        ...

    def forget(self, category: str) -> None: ...

    def rename(self, category: str, name: str) -> None:
        """Raises RecognitionError where the new name is another category's."""
        ...

    def merge(self, category: str, into: str) -> None:
        """What was known of one category is from now on known of the other."""
        ...
