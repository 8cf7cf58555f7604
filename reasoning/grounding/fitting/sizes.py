"""Learn the sizes of kinds from views, with a prior (empirical Bayes; Efron and Morris 1973).

With few views, a median is uncertain and a deviation more so. Therefore both are drawn towards a prior: that of a usual
size or, where no usual size is stated, the common distribution of the views of all kinds. Sizes are natural logarithms
of length and aspect, as :func:`deixis.reasoning.grounding.evidence.properties.unary.log_sizes` returns them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.models.sizes import SizeModel
from deixis.reasoning.errors import SettingError
from deixis.reasoning.grounding.evidence.properties.sizes import MIN_SPREAD

Array = NDArray[np.float64]

VIEWS_OF_PRIOR = 5.0
"""Weight of the prior spread, as a number of views."""

PRIOR_SPREAD = 0.2
"""Prior standard deviation of the logarithm within a kind: the mean over the usual sizes of the ontology."""

SD_PER_MEDIAN_DEVIATION = 1.4826
"""A normal's standard deviation over its median absolute deviation (Rousseeuw and Croux 1993)."""

SD_PER_MEAN_DEVIATION = 1.2533
"""A normal's standard deviation over its mean absolute deviation."""


@dataclass(frozen=True, slots=True, eq=False)
class SizePrior:
    """Prior of the size of a kind, for log length and log aspect."""

    centre: Array  # (2,) mean of the typical sizes of kinds
    between: Array  # (2,) standard deviation of the typical sizes
    within: Array  # (2,) standard deviation of things of one kind


def usual_prior(usual: SizeModel) -> SizePrior:
    """Return a usual size as a prior; its error has the same spread as things of the kind.

    Parameters
    ----------
    usual
        Usual size of a kind.

    Returns
    -------
    SizePrior
        Centre and spreads of log length and log aspect.
    """
    centre, spread = np.array([usual.length, usual.aspect]).T
    return SizePrior(centre, spread, spread)


def pooled_prior(kinds: Sequence[Array]) -> SizePrior:
    """Return the common prior of the sizes of several kinds.

    Parameters
    ----------
    kinds
        Views of each kind: log length and log aspect, shape (n, 2).

    Returns
    -------
    SizePrior
        Centre, spread of a kind's centre, and spread within a kind.

    Raises
    ------
    SettingError
        There is no view.
    """
    seen = [views for views in kinds if len(views)]
    if not seen:
        raise SettingError("`views` must have at least one view, got none; give the views of a kind")
    everything = np.concatenate(seen)
    centre = np.median(everything, axis=0)
    apart = np.sum([np.abs(views - np.median(views, axis=0)).sum(axis=0) for views in seen], axis=0)
    return pool(centre, np.abs(everything - centre).sum(axis=0), apart, len(everything), len(seen))


def pool(centre: Array, off_centre: Array, apart: Array, views: int, kinds: int) -> SizePrior:
    """Return the common prior from sums of deviations: from the common median, and from the medians of the kinds.

    Parameters
    ----------
    centre
        Median log length and log aspect of all views, shape (2,).
    off_centre
        Sum of the absolute deviations from ``centre``, shape (2,).
    apart
        Sum of the absolute deviations from the medians of the kinds, shape (2,).
    views
        Number of views.
    kinds
        Number of kinds.

    Returns
    -------
    SizePrior
        Centre, spread of a kind's centre, and spread within a kind.
    """
    within = (SD_PER_MEAN_DEVIATION * apart + VIEWS_OF_PRIOR * PRIOR_SPREAD) / (views - kinds + VIEWS_OF_PRIOR)
    return SizePrior(centre, np.maximum(SD_PER_MEAN_DEVIATION * off_centre / views, within), within)


def learn_size(views: Array, prior: SizePrior, relative: bool = False) -> SizeModel:
    """Return the predictive distribution of the sizes of a kind from n views.

    The spread combines that of the views (median absolute deviation) with the prior's, which counts as
    ``VIEWS_OF_PRIOR`` views. The typical size is the mean of the views' median and the prior's centre, weighted by
    precision; its uncertainty is added to the spread.

    Parameters
    ----------
    views
        Log length and log aspect of each view, shape (n, 2).
    prior
        Prior of the kind's size.
    relative
        Whether the views are from images: upright, and relative to the scene.

    Returns
    -------
    SizeModel
        Mean and spread of log length and log aspect.

    Raises
    ------
    SettingError
        There is no view.
    """
    if not len(views):
        raise SettingError("`views` must have at least one view, got none; give the views of a kind")
    median = np.median(views, axis=0)
    return size_of(len(views), median, np.median(np.abs(views - median), axis=0), prior, relative)


def size_of(n: int, median: Array, deviation: Array, prior: SizePrior, relative: bool = False) -> SizeModel:
    """Return the distribution of sizes from the median of n views and their median absolute deviation.

    Parameters
    ----------
    n
        Number of views, at least 1.
    median
        Median log length and log aspect, shape (2,).
    deviation
        Median absolute deviations from ``median``, shape (2,).
    prior
        Prior of the kind's size.
    relative
        Whether the views are from images: upright, and relative to the scene.

    Returns
    -------
    SizeModel
        Mean and spread of log length and log aspect.
    """
    spread = SD_PER_MEDIAN_DEVIATION * deviation
    variance = (n * spread**2 + VIEWS_OF_PRIOR * prior.within**2) / (n + VIEWS_OF_PRIOR)
    precision = n / variance + 1 / prior.between**2
    typical = (n * median / variance + prior.centre / prior.between**2) / precision
    doubted = np.maximum(np.sqrt(variance + 1 / precision), MIN_SPREAD)
    length, aspect = zip(typical.tolist(), doubted.tolist(), strict=True)
    return SizeModel(length, aspect if relative else (min(aspect[0], 0.0), aspect[1]), relative, float(n))


def learn_sizes(views: Mapping[str, Array], relative: bool = False) -> dict[str, SizeModel]:
    """Return the sizes of kinds from views of each, with the common prior of all views.

    Parameters
    ----------
    views
        Views by kind (class IRI): log length and log aspect, shape (n, 2), with n >= 1.
    relative
        Whether the views are from images: upright, and relative to the scene.

    Returns
    -------
    dict
        Distribution of sizes by kind.
    """
    if not views:
        return {}
    pooled = pooled_prior(list(views.values()))
    return {kind: learn_size(seen, pooled, relative) for kind, seen in views.items()}
