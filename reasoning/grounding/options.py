"""Options of grounding: names of engines and viewpoints, and the definition of *decided*. Imports no engine."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class EngineName(StrEnum):
    """The engines that align a description with a scene (:mod:`deixis.reasoning.grounding.engines.registry`)."""

    EXACT = "exact"
    SCALABLE = "scalable"
    SIMILARITY = "similarity"
    BLONDEL = "blondel"
    HEYMANS_SINGH = "heymans-singh"


class Select(StrEnum):
    """Criterion by which the paper's engine chooses among sub-graphs."""

    FACTS = "facts"  # the sum of the facts' degrees, then the graph similarity
    SIMILARITY = "similarity"  # the graph similarity alone, as in the paper


class ViewpointName(StrEnum):
    """Side from which left and right are meant: as stated in the scene, or to be recovered.

    See :mod:`deixis.workflows.grounding.viewpoint`.
    """

    STATED = "stated"  # as the scene states it
    QUARTER = "quarter"  # recovered, turned by a multiple of 90 degrees
    UNKNOWN = "unknown"  # recovered, turned by any angle


DEFAULT_TIME_LIMIT = 10.0
"""Default time limit of grounding, in seconds."""

DECIDED = 0.99
"""Minimum probability of a decided match."""

DECIDED_LOWER_BOUND = 0.975
"""Minimum of a decided match's probability minus the error of that probability."""


def is_decided(probability: NDArray[np.float64], error: float | NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which matches are decided: their probability is high, and its error is small.

    Parameters
    ----------
    probability
        Probabilities of matches, any shape.
    error
        Errors of the probabilities: one number, or an array of the shape of ``probability``.

    Returns
    -------
    Boolean array of the shape of ``probability``.

    Examples
    --------
    >>> import numpy as np
    >>> is_decided(np.array([0.98, 0.995]), 0.01).tolist(), is_decided(np.array([0.995]), 0.05).tolist()
    ([False, True], [False])
    """
    decided: NDArray[np.bool_] = (probability >= DECIDED) & (probability - error >= DECIDED_LOWER_BOUND)
    return decided
