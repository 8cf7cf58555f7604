"""Single views, named by what is nearest: how often rightly, and how well the unknown is told from the known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.open_ended.contestants import D2, SPIN
from deixis.experiments.open_ended.shown import Shown
from deixis.perception.recognition.calibration import auroc
from deixis.perception.recognition.distances import Target, view_distances
from deixis.perception.recognition.learners.view_features import roots
from deixis.perception.recognition.settings import RecognitionSettings
from deixis.perception.recognition.spread import Width, spreads
from deixis.perception.recognition.views import PackedViews

Matrix = NDArray[np.float32]


class Split(NamedTuple):
    """Places of views; both in random order."""

    taught: NDArray[np.int64]
    asked: NDArray[np.int64]


def by_things(shown: Shown, seed: int) -> Split:
    """Half of the things of each category to teach (rounded up), the other half to ask for."""
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(shown.views), bool)
    for category in shown.kinds:
        things = rng.permutation(shown.instances_of(category))
        taught[shown.of(category, things[: -(-len(things) // 2)])] = True
    return _shuffled(taught, rng)


def by_views(shown: Shown, seed: int) -> Split:
    """Half of the views of each thing to teach (rounded up), the other half to ask for."""
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(shown.views), bool)
    for thing in np.unique(shown.instances):
        views = rng.permutation(np.flatnonzero(shown.instances == thing))
        taught[views[: -(-len(views) // 2)]] = True
    return _shuffled(taught, rng)


def _shuffled(taught: NDArray[np.bool_], rng: np.random.Generator) -> Split:
    return Split(rng.permutation(np.flatnonzero(taught)), rng.permutation(np.flatnonzero(~taught)))


@dataclass(frozen=True)
class NamingMethod:
    """A way to name a view: by D_C (``settings`` None) or by ND, over the descriptors of one name."""

    name: str
    descriptor: str
    settings: RecognitionSettings | None


@dataclass(frozen=True)
class Scores:
    """The share of views named rightly, and the AUROC of the least ND (or D_C) as a sign of what is unknown: each
    asked view once as it is, and once with its category left out of what was taught."""

    accuracy: float
    auroc: float


def view_matrix(shown: Shown, descriptor: str, tick: Callable[[str], None]) -> Matrix:
    """D_V (n, n) from each view, a row, to each; by square roots of spin images."""
    sets = [roots(view[SPIN]) if descriptor == SPIN else view[descriptor] for view in shown.views]
    packed = PackedViews.of((str(number), rows) for number, rows in enumerate(sets))
    out = np.empty((len(sets), len(sets)), np.float32)
    for number, rows in enumerate(sets):
        out[number] = view_distances(Target.of(rows), packed)
        tick(f"{shown.name}: distances")
    return out


def d2_distances(shown: Shown) -> Matrix:
    """Euclidean distances (n, n) of D2 histograms and extents."""
    rows = np.concatenate([view[D2] for view in shown.views])
    return np.stack([np.linalg.norm(rows - row, axis=1) for row in rows])


def split_scores(shown: Shown, distances: Matrix, split: Split, settings: RecognitionSettings | None) -> Scores:
    """One way of naming on one split."""
    kinds = np.array(shown.kinds)
    category = np.searchsorted(kinds, shown.categories)
    places = [split.taught[category[split.taught] == number] for number in range(len(kinds))]
    nearest = np.stack([distances[np.ix_(split.asked, views)].min(axis=1) for views in places], axis=1)
    if settings is not None:
        things = [shown.instances[views] if settings.over_things else None for views in places]
        widths = [Width.of(distances[np.ix_(views, views)], each) for views, each in zip(places, things, strict=True)]
        nearest = nearest / [one.value for one in spreads(widths, settings.prior_spread, settings.shrinkage)]
    right = category[split.asked]
    left_out = nearest.copy()
    left_out[np.arange(len(right)), right] = np.inf
    accuracy = float((nearest.argmin(axis=1) == right).mean())
    return Scores(accuracy, auroc(nearest.min(axis=1), left_out.min(axis=1)))
