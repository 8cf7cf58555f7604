"""Learning vector quantisation, with prototypes that move and multiply at errors, and features for each category."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import RecognitionError
from deixis.perception.recognition.learners.learner import Learner, Prediction, require_free, require_known, require_two
from deixis.perception.recognition.learners.one_class import POOLED_DESCRIBERS
from deixis.perception.recognition.learners.view_features import ViewFeatures, pooled

Vector = NDArray[np.float64]


@dataclass(eq=False)
class _Moments:
    """Number, sum and sum of squares of vectors."""

    count: int
    total: Vector
    squares: Vector

    @classmethod
    def sum(cls, parts: Sequence[_Moments]) -> _Moments:
        totals = sum((part.total for part in parts), np.zeros(1))
        return cls(sum(part.count for part in parts), totals, sum((part.squares for part in parts), np.zeros(1)))

    def without(self, part: _Moments) -> _Moments:
        return _Moments(self.count - part.count, self.total - part.total, self.squares - part.squares)

    @property
    def mean(self) -> Vector:
        return self.total / max(self.count, 1)

    @property
    def variance(self) -> Vector:
        return np.maximum(self.squares / max(self.count, 1) - self.mean**2, 0.0)


@dataclass(eq=False)
class _Prototypes:
    """Prototypes of a category: places (m, d), and the number of moves of each (m,)."""

    moments: _Moments
    places: Vector
    moved: NDArray[np.int64] = field(default_factory=lambda: np.zeros(1, np.int64))


class VectorQuantisation(Learner):
    """Learner by incremental vector quantisation with features selected per category; it stores no views.

    The method is that of S. Kirstein, H. Wersing, H.-M. Gross, E. Koerner: A life-long learning vector quantization
    approach for interactive learning of multiple categories, Neural Networks 28, 2012. A wrong answer adds a prototype.
    The winner moves towards a view that it named correctly, and away from one that it named wrongly, at its own rate,
    which decays with its moves and so preserves earlier learning. A category measures distances only in the features
    that separate it from others. Changed: features are selected by their score alone, from running moments (the squared
    difference of means over the variances, of the category and of all others), instead of by a wrapper that tries
    combinations on stored views; a prototype belongs to one category. Omitted: the short-term store of views.

    Scores are minus the mean squared distance to the nearest prototype over the category's features, each divided by
    its variance over all views; ``unknown`` is the least of these distances. ``features`` is the number of features
    that a category selects.
    """

    name = "LVQ"

    def __init__(
        self,
        descriptors: Sequence[str] = POOLED_DESCRIBERS,
        features: int = 200,
        rate: float = 0.2,
        decay: float = 10.0,
    ) -> None:
        if features < 1 or not 0.0 <= rate <= 1.0 or not decay > 0.0:
            raise RecognitionError(
                "`features` must be at least 1, `rate` in [0, 1] and `decay` above 0,"
                f" got {features}, {rate:g} and {decay:g}"
            )
        self._descriptors, self._features, self._rate, self._decay = tuple(descriptors), features, rate, decay
        self._known: dict[str, _Prototypes | None] = {}

    @property
    def categories(self) -> tuple[str, ...]:
        """Names of the known categories, in the order of teaching."""
        return tuple(self._known)

    @property
    def stored(self) -> int:
        """Number of prototypes."""
        return sum(len(one.places) for one in self._known.values() if one is not None)

    def predict(self, view: ViewFeatures) -> Prediction:
        """Rank the categories by the nearest prototype."""
        vector = pooled(view, self._descriptors)
        nearest = {} if vector is None else self._nearest(vector)
        if not nearest:
            return Prediction()
        return Prediction.of(
            {name: -distance for name, (distance, _) in nearest.items()}, min(d for d, _ in nearest.values())
        )

    def learn(self, category: str, view: ViewFeatures) -> None:
        """Correct with a view that would be named wrongly, or else confirm."""
        if category in self._known and self.predict(view).best == category:
            self.confirm(category, view)
        else:
            self.correct(category, view)

    def correct(self, category: str, view: ViewFeatures) -> None:
        """Add a prototype at the view, and move the wrong winner away from it."""
        vector = pooled(view, self._descriptors)
        if vector is None:
            self._known.setdefault(category, None)
            return
        taken = self._winner(vector)
        if taken is not None and taken[0] != category:
            self._move(*taken, vector, -1.0)
        self._count(category, vector)
        known = self._known[category]
        if known is not None and known.moments.count > 1:
            known.places = np.vstack([known.places, vector])
            known.moved = np.append(known.moved, 0)

    def confirm(self, category: str, view: ViewFeatures) -> None:
        """Move the category's nearest prototype towards the view."""
        require_known(category, self.categories)
        vector = pooled(view, self._descriptors)
        if vector is None:
            return
        found = self._nearest(vector).get(category)
        self._count(category, vector)
        if found is not None:
            self._move(category, found[1], vector, 1.0)

    def forget(self, category: str) -> None:
        """Remove the category with its prototypes and features."""
        require_known(category, self.categories)
        del self._known[category]

    def rename(self, category: str, name: str) -> None:
        """Rename the category, which keeps its place in the order."""
        require_free(category, name, self.categories)
        self._known = {name if old == category else old: one for old, one in self._known.items()}

    def merge(self, category: str, into: str) -> None:
        """Join the prototypes and the moments of both categories."""
        require_two(category, into, self.categories)
        one, other = self._known[into], self._known.pop(category)
        if one is None or other is None:
            self._known[into] = one or other
            return
        moments = _Moments.sum([one.moments, other.moments])
        moved = np.concatenate([one.moved, other.moved])
        self._known[into] = _Prototypes(moments, np.vstack([one.places, other.places]), moved)

    def _count(self, category: str, vector: Vector) -> None:
        seen = _Moments(1, vector, vector**2)
        known = self._known.get(category)
        if known is None:
            self._known[category] = _Prototypes(seen, vector[None])
        else:
            known.moments = _Moments.sum([known.moments, seen])

    def _nearest(self, vector: Vector) -> dict[str, tuple[float, int]]:
        """Return the distance and the index of each category's nearest prototype."""
        known = {name: one for name, one in self._known.items() if one is not None}
        if not known:
            return {}
        everything = _Moments.sum([one.moments for one in known.values()])
        scale = 1.0 / (everything.variance + 1e-6)
        found = {}
        for name, one in known.items():
            chosen = self._selected(one.moments, everything)
            apart = ((one.places[:, chosen] - vector[chosen]) ** 2 * scale[chosen]).mean(axis=1)
            found[name] = float(apart.min()), int(apart.argmin())
        return found

    def _selected(self, own: _Moments, everything: _Moments) -> NDArray[np.int64]:
        """Return the features (f,) that separate a category from others; all of them if there are no others."""
        others, size = everything.without(own), len(own.total)
        if not others.count or self._features >= size:
            return np.arange(size)
        score = (own.mean - others.mean) ** 2 / (own.variance + others.variance + 1e-6)
        return np.sort(np.argpartition(-score, self._features)[: self._features])

    def _winner(self, vector: Vector) -> tuple[str, int] | None:
        nearest = self._nearest(vector)
        if not nearest:
            return None
        name = min(nearest, key=lambda category: nearest[category][0])
        return name, nearest[name][1]

    def _move(self, category: str, place: int, vector: Vector, toward: float) -> None:
        known = self._known[category]
        if known is not None:
            rate = self._rate * float(np.exp(-known.moved[place] / self._decay))
            known.places[place] += toward * rate * (vector - known.places[place])
            known.moved[place] += 1
