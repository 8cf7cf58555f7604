"""Leave-one-thing-out and leave-one-category-out distances of the stored views."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.recognition.distances import Target
from deixis.perception.recognition.index import ViewIndex
from deixis.perception.recognition.instances import InstanceCategory
from deixis.perception.recognition.settings import RecognitionSettings
from deixis.perception.recognition.spread import spreads

MAX_HELD_OUT = 400
"""Views that are held out, at most; evenly over the categories."""


Progress = Callable[[int, int], None]
"""Is told how many views are done, and how many there are."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Normalised distances of v held-out views to c categories.

    ``truth`` is each view's own category; its ND there is without the view itself, and without the other views of the
    same thing: inf where nothing remains.
    """

    normalised: NDArray[np.float64]  # (v, c)
    truth: NDArray[np.int64]  # (v,)

    @property
    def as_known(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """ND (k, c) and truth (k,) of the views whose category has others: leave one out."""
        left = np.isfinite(self.normalised[np.arange(len(self.truth)), self.truth])
        return self.normalised[left], self.truth[left]

    @property
    def as_unknown(self) -> NDArray[np.float64]:
        """ND (v, c) without that of the view's own category (inf): leave one category out. None if it is the only."""
        others = self.normalised.copy()
        others[np.arange(len(self.truth)), self.truth] = np.inf
        return others[np.isfinite(others).any(axis=1)]


def hold_out(
    categories: Sequence[InstanceCategory],
    indexes: Sequence[ViewIndex | None],
    settings: RecognitionSettings,
    most: int = MAX_HELD_OUT,
    progress: Progress | None = None,
) -> HeldOut:
    """Hold views out, ``most`` of all categories together, evenly chosen; views of one thing are held out together.

    So what follows is about things never seen before, where categories know which thing a view shows. Among more views
    than are searched exactly, other categories are searched as recognition searches them.
    """
    share = -(-most // max(1, len(categories)))
    chosen = [(number, place) for number, each in enumerate(categories) for place in _evenly(len(each), share)]
    widths = [category.width(settings.over_things) for category in categories]
    effort = settings.effort_among(sum(map(len, categories)))
    rows = np.empty((len(chosen), len(categories)))
    for done, (number, place) in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        own = categories[number]
        rest = np.flatnonzero(own.shown != own.shown[place])
        left = list(widths)
        left[number] = own.width(settings.over_things, rest)
        target = Target.of(own.views[place])
        distances = np.full(len(categories), np.inf)
        reduced = None
        for other, index in enumerate(indexes):
            if index is None or other == number:
                continue
            reduced = index.reduction(target.descriptors) if reduced is None else reduced
            distances[other] = index.nearest(target, reduced, effort).distance
        if len(rest):
            distances[number] = own.distances[place, rest].min()
        rows[done] = distances / [spread.value for spread in spreads(left, settings.prior_spread, settings.shrinkage)]
    return HeldOut(rows, np.array([number for number, _ in chosen], np.int64))


def _evenly(count: int, most: int) -> list[int]:
    """Return at most ``most`` numbers of 0 to ``count``, evenly spread.

    >>> _evenly(10, 4)
    [0, 2, 5, 7]
    """
    return [i * count // most for i in range(most)] if count > most else list(range(count))
