"""Compare ways to name single views by the nearest one: accuracy, and how well the distance detects the unknown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.experiments.open_ended.contestants import D2, SPIN
from deixis.experiments.open_ended.described_views import DescribedViews
from deixis.perception.recognition.calibration import auroc
from deixis.perception.recognition.distances import Target, view_distances
from deixis.perception.recognition.learners.view_features import roots
from deixis.perception.recognition.settings import RecognitionSettings
from deixis.perception.recognition.spread import Width, spreads
from deixis.perception.recognition.views import PackedViews

Matrix = NDArray[np.float32]


class Split(NamedTuple):
    """Positions of the taught and the asked views, both in random order."""

    taught: NDArray[np.int64]
    asked: NDArray[np.int64]


def by_things(data: DescribedViews, seed: int) -> Split:
    """Split by things: half of each category's things to teach (rounded up), the others to ask about.

    Parameters
    ----------
    data
        Described views of things by category.
    seed
        Seed of the random choice of things, and of the order of the views.

    Returns
    -------
    Split
        Indices of the views that are taught and asked about. A category of one thing is taught only.
    """
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(data.views), bool)
    for category in data.kinds:
        things = rng.permutation(data.instances_of(category))
        taught[data.of(category, things[: -(-len(things) // 2)])] = True
    return _shuffled(taught, rng)


def by_views(data: DescribedViews, seed: int) -> Split:
    """Split by views: half of each thing's views to teach (rounded up), the others to ask about.

    Parameters
    ----------
    data
        Described views of things by category.
    seed
        Seed of the random choice of views, and of their order.

    Returns
    -------
    Split
        Indices of the views that are taught and asked about. A thing with one view is taught only.
    """
    rng = np.random.default_rng(seed)
    taught = np.zeros(len(data.views), bool)
    for thing in np.unique(data.instances):
        views = rng.permutation(np.flatnonzero(data.instances == thing))
        taught[views[: -(-len(views) // 2)]] = True
    return _shuffled(taught, rng)


def _shuffled(taught: NDArray[np.bool_], rng: np.random.Generator) -> Split:
    return Split(rng.permutation(np.flatnonzero(taught)), rng.permutation(np.flatnonzero(~taught)))


@dataclass(frozen=True)
class NamingMethod:
    """A way to name a view: by distance (``settings`` None) or normalised distance, over one kind of descriptor."""

    name: str
    descriptor: str
    settings: RecognitionSettings | None


@dataclass(frozen=True)
class Scores:
    """Share of views named correctly, and AUROC of the least (normalised) distance as a sign of the unknown.

    Each asked view counts once as it is, and once with its category left out of the taught ones.
    """

    accuracy: float
    auroc: float


def view_matrix(data: DescribedViews, descriptor: str, tick: Callable[[str], None]) -> Matrix:
    """Compute the distances D_V (n, n) of each view, a row, to each other, by square roots of spin images.

    Parameters
    ----------
    data
        Described views, n in all.
    descriptor
        Name of the descriptor.
    tick
        Called with a message after each row.

    Returns
    -------
    array
        Distances in single precision, shape (n, n).
    """
    sets = [roots(view[SPIN]) if descriptor == SPIN else view[descriptor] for view in data.views]
    packed = PackedViews.of((str(number), rows) for number, rows in enumerate(sets))
    out = np.empty((len(sets), len(sets)), np.float32)
    for number, rows in enumerate(sets):
        out[number] = view_distances(Target.of(rows), packed)
        tick(f"{data.name}: distances")
    return out


def d2_distances(data: DescribedViews) -> Matrix:
    """Compute Euclidean distances (n, n) of D2 histograms and extents.

    Parameters
    ----------
    data
        Described views, n in all.

    Returns
    -------
    array
        Distances, shape (n, n).
    """
    rows = np.concatenate([view[D2] for view in data.views])
    return np.stack([np.linalg.norm(rows - row, axis=1) for row in rows])


def split_scores(data: DescribedViews, distances: Matrix, split: Split, settings: RecognitionSettings | None) -> Scores:
    """Score one way of naming on one split.

    Parameters
    ----------
    data
        Described views, n in all.
    distances
        Distance from each view, a row, to each other, shape (n, n).
    split
        Views to teach and to ask about.
    settings
        Settings of the widths by which the distances to each category are divided, or None for plain distances.

    Returns
    -------
    Scores
        Share of correct names, and area under the ROC curve of the detection of unknown categories.
    """
    kinds = np.array(data.kinds)
    category = np.searchsorted(kinds, data.categories)
    places = [split.taught[category[split.taught] == number] for number in range(len(kinds))]
    nearest = np.stack([distances[np.ix_(split.asked, views)].min(axis=1) for views in places], axis=1)
    if settings is not None:
        things = [data.instances[views] if settings.over_things else None for views in places]
        widths = [Width.of(distances[np.ix_(views, views)], each) for views, each in zip(places, things, strict=True)]
        nearest = nearest / [one.value for one in spreads(widths, settings.prior_spread, settings.shrinkage)]
    right = category[split.asked]
    left_out = nearest.copy()
    left_out[np.arange(len(right)), right] = np.inf
    accuracy = float((nearest.argmin(axis=1) == right).mean())
    return Scores(accuracy, auroc(nearest.min(axis=1), left_out.min(axis=1)))
