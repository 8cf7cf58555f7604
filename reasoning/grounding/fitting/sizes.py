"""How large things of a kind are, learned from views of them and held near what is known before (empirical Bayes).

From few views a median says little and a deviation less. So both are drawn towards a prior: that of a usual size, or
where none is stated, what the views of all kinds have in common. Sizes are natural logarithms of length and aspect, as
:func:`deixis.reasoning.grounding.evidence.unary.log_sizes` gives them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.evidence.sizes import MIN_SPREAD

Array = NDArray[np.float64]

VIEWS_OF_PRIOR = 5.0
"""How many views the spread that is known before counts as."""

PRIOR_SPREAD = 0.2
"""Standard deviation of the logarithm within a kind before anything is seen: the mean over the TBox's usual sizes."""

SD_PER_MEDIAN_DEVIATION = 1.4826
"""A normal's standard deviation over its median absolute deviation (Rousseeuw and Croux 1993)."""

SD_PER_MEAN_DEVIATION = 1.2533
"""A normal's standard deviation over its mean absolute deviation."""


@dataclass(frozen=True, slots=True, eq=False)
class SizePrior:
    """What is held of a kind before things of it are seen: each of log length and log aspect, shape (2,).

    Typical sizes of kinds lie around ``centre``, ``between`` off (standard deviation); things of one kind lie
    ``within`` of what is typical of it.
    """

    centre: Array
    between: Array
    within: Array


def usual_prior(usual: SizeModel) -> SizePrior:
    """Return a usual size as a prior: what is typical may be off by as much as things of the kind differ."""
    centre, spread = np.array([usual.length, usual.aspect]).T
    return SizePrior(centre, spread, spread)


def pooled_prior(kinds: Sequence[Array]) -> SizePrior:
    """Return what the views of several kinds, each (n, 2), have in common; raises SettingError where there is none."""
    seen = [views for views in kinds if len(views)]
    if not seen:
        raise SettingError("a size is learned from one view at least")
    everything = np.concatenate(seen)
    centre = np.median(everything, axis=0)
    apart = np.sum([np.abs(views - np.median(views, axis=0)).sum(axis=0) for views in seen], axis=0)
    return pool(centre, np.abs(everything - centre).sum(axis=0), apart, len(everything), len(seen))


def pool(centre: Array, off_centre: Array, apart: Array, views: int, kinds: int) -> SizePrior:
    """Return the same from sums: of how far all views are from their common median, and from that of their own kind."""
    within = (SD_PER_MEAN_DEVIATION * apart + VIEWS_OF_PRIOR * PRIOR_SPREAD) / (views - kinds + VIEWS_OF_PRIOR)
    return SizePrior(centre, np.maximum(SD_PER_MEAN_DEVIATION * off_centre / views, within), within)


def learn_size(views: Array, prior: SizePrior, relative: bool = False) -> SizeModel:
    """Return the size of a kind from n views of things of it, (n, 2): the distribution of the next one.

    Its spread is the views' (median absolute deviation), mixed with the prior's, which counts as
    ``VIEWS_OF_PRIOR`` views; what is typical lies between the views' median and the prior's centre, by their precision;
    and the doubt about it is added. ``relative``: the views are, and upright, as images show them. Raises SettingError
    without a view.
    """
    if not len(views):
        raise SettingError("a size is learned from one view at least")
    median = np.median(views, axis=0)
    return size_of(len(views), median, np.median(np.abs(views - median), axis=0), prior, relative)


def size_of(n: int, median: Array, deviation: Array, prior: SizePrior, relative: bool = False) -> SizeModel:
    """Return the same from the median of n views, shape (2,), and their median absolute deviation from it."""
    spread = SD_PER_MEDIAN_DEVIATION * deviation
    variance = (n * spread**2 + VIEWS_OF_PRIOR * prior.within**2) / (n + VIEWS_OF_PRIOR)
    precision = n / variance + 1 / prior.between**2
    typical = (n * median / variance + prior.centre / prior.between**2) / precision
    doubted = np.maximum(np.sqrt(variance + 1 / precision), MIN_SPREAD)
    length, aspect = zip(typical.tolist(), doubted.tolist(), strict=True)
    return SizeModel(length, aspect if relative else (min(aspect[0], 0.0), aspect[1]), relative, float(n))


def learn_sizes(
    views: Mapping[str, Array], relative: bool = False, usual: Mapping[str, SizeModel] | None = None
) -> dict[str, SizeModel]:
    """Return the sizes of kinds from views of each, (n, 2), n at least 1: near its usual size, or what all have in
    common."""
    if not views:
        return {}
    pooled = pooled_prior(list(views.values()))
    priors = {kind: usual_prior(model) for kind, model in (usual or {}).items()}
    return {kind: learn_size(seen, priors.get(kind, pooled), relative) for kind, seen in views.items()}
