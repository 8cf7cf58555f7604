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

CORRELATION = 0.6
"""Correlation between the log-probabilities of the right answers to two views of one thing: the mean over the
simulator's tableware, 0.4 for known and 0.75 for unknown things (benchmarks/bench_naming.py --correlation)."""

MAX_HELD_OUT = 400
"""Maximum number of views that are held out, distributed evenly over the categories."""


USUAL_SHORTENING, MAX_SHORTENING = 0.2, 0.5
"""Default and maximum of the exponent that :func:`shortening` returns."""


Progress = Callable[[int, int], None]
"""Callback with the number of views done, and the number of all views."""


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Normalised distances of v held-out views to c categories.

    ``truth`` is the category of each view; its ND to that category excludes all views of the same thing, and is inf if
    no others remain. This ND is corrected for the missing thing by the factor that :func:`shortening` describes.
    ``things`` has one number for all views of a thing; by default, each view shows a thing of its own.
    """

    normalised: NDArray[np.float64]  # (v, c)
    truth: NDArray[np.int64]  # (v,)
    things: NDArray[np.int64] | None = None  # (v,)

    @property
    def design_effect(self) -> float:
        """Number of views that are worth one independent view, at least 1 (Kish 1965).

        It is 1 + (m - 1) r for m views of a thing and a correlation r between the answers to two of them; m is the
        mean over views.
        """
        if self.things is None or not len(self.things):
            return 1.0
        counts = np.unique(self.things, return_counts=True)[1]
        return float(1 + (np.square(counts).sum() / counts.sum() - 1) * CORRELATION)

    @property
    def as_known(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Normalised distances (k, c) and truth (k,) of the views whose category has other things: leave one out."""
        left = np.isfinite(self.normalised[np.arange(len(self.truth)), self.truth])
        return self.normalised[left], self.truth[left]

    @property
    def as_unknown(self) -> NDArray[np.float64]:
        """Normalised distances (v, c), inf for the view's own category: leave one category out.

        Empty if there is only one category.
        """
        others = self.normalised.copy()
        others[np.arange(len(self.truth)), self.truth] = np.inf
        return others[np.isfinite(others).any(axis=1)]


def hold_out(
    categories: Sequence[InstanceCategory],
    indexes: Sequence[ViewIndex | None],
    settings: RecognitionSettings,
    progress: Progress | None = None,
) -> HeldOut:
    """Compute the normalised distances (ND) of held-out views; all views of a thing are held out together.

    At most ``MAX_HELD_OUT`` views, chosen evenly, are held out.
    The result is therefore about things that were never seen before, if it is known which thing each view shows.

    Parameters
    ----------
    categories
        Categories with their views.
    indexes
        Index of each category's views; None for an empty category.
    settings
        Settings of recognition. If there are more views than are searched exactly, the search is approximate, as in
        recognition.
    progress
        Callback with the number of views done, and the number of all views.

    Returns
    -------
    HeldOut
        ND of the held-out views to all categories, in their order.
    """
    share = -(-MAX_HELD_OUT // max(1, len(categories)))
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
    shown = {one: number for number, one in enumerate(dict.fromkeys(_thing(categories, *each) for each in chosen))}
    return HeldOut(rows, truth, np.array([shown[_thing(categories, *each)] for each in chosen], np.int64))


def _thing(categories: Sequence[InstanceCategory], number: int, place: int) -> tuple[int, int]:
    """Return the category of a view and the number of its thing there."""
    return number, int(categories[number].shown[place])


def shortening(fewer: Sequence[tuple[int, float]]) -> float:
    """Return the exponent a with which the distance D_C to a category falls with its number n of things, D_C ~ n^-a.

    A category without the held-out thing has one thing less than in recognition, and is a little farther for that
    reason alone.

    Parameters
    ----------
    fewer
        Pairs for held-out views: the number n of things that remain, at least 2, and the logarithm of D_C over D_C
        without one of these.

    Returns
    -------
    float
        Exponent from 0 to ``MAX_SHORTENING``; ``USUAL_SHORTENING`` without views.

    Examples
    --------
    >>> round(shortening([(2, -0.1 * np.log(2)), (4, -0.1 * np.log(4 / 3))]), 3)
    0.1
    """
    if not fewer:
        return USUAL_SHORTENING
    counts, falls = (np.array(column, np.float64) for column in zip(*fewer, strict=True))
    return float(np.clip(-falls.sum() / np.log(counts / (counts - 1)).sum(), 0.0, MAX_SHORTENING))


def _with_fewer(own: InstanceCategory, place: int, rest: NDArray[np.intp]) -> list[tuple[int, float]]:
    """Return, for each thing among the views ``rest``, the number of things and log(D_C / D_C without that thing).

    ``place`` is the held-out view. The list is empty for one thing, and for a distance of 0.
    """
    shown, distances = own.shown[rest], own.distances[place, rest]
    things, least = np.unique(shown), float(distances.min())
    if len(things) < 2 or least <= 0:
        return []
    return [(len(things), float(np.log(least / distances[shown != thing].min()))) for thing in things]


def _evenly(count: int, most: int) -> list[int]:
    """Return at most ``most`` of the numbers from 0 to ``count`` - 1, evenly spread.

    >>> _evenly(10, 4)
    [0, 2, 5, 7]
    """
    return [i * count // most for i in range(most)] if count > most else list(range(count))
