"""Draw the size of a thing from the usual sizes of its kind."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deixis.ontology.things.sizes import Extent, SizeRange

SHARED_VARIATION = 0.7
"""Weight of the common random part in a thing's three lengths: a long spoon is also wide and high."""


@dataclass(frozen=True, slots=True)
class Size:
    """Extents of one thing in metres: width on x, length on y, height on z, as it lies with its head away from you."""

    width: float
    length: float
    height: float


def drawn_size(usual: SizeRange, rng: np.random.Generator, plan: tuple[float, float] | None = None) -> Size:
    """Draw a size within the usual range; each length has a triangular distribution with its mode at the typical one.

    Parameters
    ----------
    usual
        Ranges of width, length and height in metres.
    rng
        Source of the draws. Equal numbers are drawn with and without ``plan``.
    plan
        Width and length in metres; if given, only the height is drawn.

    Returns
    -------
    Size
        Extents in metres, which tend to be large or small together.
    """
    draws = rng.random(4)
    if plan is not None:
        width, length = plan
        large = share_below(usual.length, length)
        return Size(width, length, quantile(usual.height, _mixed(large, draws[3])))
    length = quantile(usual.length, _mixed(draws[0], draws[1]))
    round_thing = usual.length == usual.width
    width = length if round_thing else min(length, quantile(usual.width, _mixed(draws[0], draws[2])))
    return Size(width, length, quantile(usual.height, _mixed(draws[0], draws[3])))


def _mixed(common: float, own: float) -> float:
    return SHARED_VARIATION * common + (1 - SHARED_VARIATION) * own


def quantile(extent: Extent, share: float) -> float:
    """Return the length below which a share of the triangular distribution lies.

    Parameters
    ----------
    extent
        Least, typical and greatest length; the typical one is the mode.
    share
        Share in [0, 1].

    Returns
    -------
    float
        Length in the unit of the extent.

    Examples
    --------
    >>> quantile(Extent(0.0, 1.0, 2.0), 0.5), quantile(Extent(0.0, 1.0, 2.0), 1.0)
    (1.0, 2.0)
    """
    low, mode, high = extent.least, extent.typical, extent.greatest
    if high == low:
        return low
    turn = (mode - low) / (high - low)
    if share <= turn:
        return low + float(np.sqrt(share * (high - low) * (mode - low)))
    return high - float(np.sqrt((1 - share) * (high - low) * (high - mode)))


def share_below(extent: Extent, length: float) -> float:
    """Return the share of the triangular distribution below a length, the inverse of :func:`quantile`.

    Parameters
    ----------
    extent
        Least, typical and greatest length; the typical one is the mode.
    length
        Length in the unit of the extent; one outside of it counts as its nearest end.

    Returns
    -------
    float
        Share in [0, 1]; 0.5 for an extent of one length.
    """
    low, mode, high = extent.least, extent.typical, extent.greatest
    at = min(max(length, low), high)
    if high == low:
        return 0.5
    if at <= mode:
        return (at - low) ** 2 / ((high - low) * (mode - low)) if mode > low else 0.0
    return 1 - (high - at) ** 2 / ((high - low) * (high - mode))
