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


USUAL_SHORTENING, MAX_SHORTENING = 0.2, 0.5
"""The power of :func:`shortening` where nothing says what it is, and the largest one."""


Progress = Callable[[int, int], None]
"""Is told how many views are done, and how many there are."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Normalised distances of v held-out views to c categories.

    ``truth`` is each view's own category; its ND there is without the view itself, and without the other views of the
    same thing: inf where nothing remains. It is brought to the number of things that the category has, as the other
    categories have theirs: see :func:`shortening`.
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
    rows = np.full((len(chosen), len(categories)), np.inf)
    fewer: list[tuple[int, float]] = []
    for done, (number, place) in enumerate(chosen):
        if progress is not None:
            progress(done, len(chosen))
        own = categories[number]
        rest = np.flatnonzero(own.shown != own.shown[place])
        left = list(widths)
        left[number] = own.width(settings.over_things, rest)
        target = Target.of(own.views[place])
        divisors = [spread.value for spread in spreads(left, settings.prior_spread, settings.shrinkage)]
        reduced = None
        for other, index in enumerate(indexes):
            if index is None or other == number:
                continue
            reduced = index.reduction(target.descriptors) if reduced is None else reduced
            rows[done, other] = index.nearest(target, reduced, effort).distance / divisors[other]
        if len(rest):
            rows[done, number] = own.distances[place, rest].min() / divisors[number]
            fewer += _with_fewer(own, place, rest)
    truth = np.array([number for number, _ in chosen], np.int64)
    things = np.array([len(np.unique(category.shown)) for category in categories], np.float64)[truth]
    rows[np.arange(len(rows)), truth] *= (things / np.maximum(things - 1, 1)) ** -shortening(fewer)
    return HeldOut(rows, truth)


def shortening(fewer: Sequence[tuple[int, float]]) -> float:
    """Return the power a by which D_C falls with the number n of things in a category, D_C ~ n^-a.

    A category that a thing was held out of has one thing less than when something new is seen, and is a little farther
    for that reason alone. ``fewer`` are, of held-out views, the numbers n of things that remain and the logarithms of
    D_C over D_C without one of these. The power is between 0 and ``MAX_SHORTENING``; of no such view it is
    ``USUAL_SHORTENING``.

    >>> round(shortening([(2, -0.1 * np.log(2)), (4, -0.1 * np.log(4 / 3))]), 3)
    0.1
    """
    if not fewer:
        return USUAL_SHORTENING
    counts, falls = (np.array(column, np.float64) for column in zip(*fewer, strict=True))
    return float(np.clip(-falls.sum() / np.log(counts / (counts - 1)).sum(), 0.0, MAX_SHORTENING))


def _with_fewer(own: InstanceCategory, place: int, rest: NDArray[np.intp]) -> list[tuple[int, float]]:
    """Return for each thing of the places ``rest`` how many there are, and the logarithm of D_C of a view over that
    without the thing; none of one thing, or where a distance is 0."""
    shown, distances = own.shown[rest], own.distances[place, rest]
    things, least = np.unique(shown), float(distances.min())
    if len(things) < 2 or least <= 0:
        return []
    return [(len(things), float(np.log(least / distances[shown != thing].min()))) for thing in things]


def _evenly(count: int, most: int) -> list[int]:
    """Return at most ``most`` numbers of 0 to ``count``, evenly spread.

    >>> _evenly(10, 4)
    [0, 2, 5, 7]
    """
    return [i * count // most for i in range(most)] if count > most else list(range(count))
