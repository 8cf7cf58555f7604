"""Options of grounding: names of engines and viewpoints, and what *decided* means; loads no engine."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class EngineName(StrEnum):
    """The engines that align a description with a scene (:mod:`deixis.reasoning.grounding.engines`)."""

    EXACT = "exact"
    SCALABLE = "scalable"
    SIMILARITY = "similarity"
    BLONDEL = "blondel"
    HEYMANS_SINGH = "heymans-singh"


class Select(StrEnum):
    """What chooses among sub-graphs under the paper's engine."""

    FACTS = "facts"  # the sum of degrees first, the graph similarity second
    SIMILARITY = "similarity"  # the graph similarity alone, as in the paper


class ViewpointName(StrEnum):
    """Where left and right are said from: as the scene states, or a side to be recovered
    (:mod:`deixis.workflows.viewpoint`)."""

    STATED = "stated"
    QUARTER = "quarter"  # turned by quarters of a circle
    UNKNOWN = "unknown"  # turned by any angle


DEFAULT_TIME_LIMIT = 10.0
"""Seconds that grounding may take where nobody says otherwise."""

DECIDED = 0.99
"""Probability from which a match is called decided: where things are missing, somewhat less is right than was said, for
an extra thing may fit all that is said of what is absent (docs/explanation/scoreboard.md)."""


DECIDED_LOWER_BOUND = 0.975
"""Probability of a decided match less the error of that probability, at least."""


def is_decided(probability: NDArray[np.float64], error: float | NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which of these probabilities (…,) are high enough, and known well enough, to call a match decided.

    ``error`` is by how much they may be off: one number for all of them, or one for each.

    >>> import numpy as np
    >>> is_decided(np.array([0.98, 0.995]), 0.01).tolist(), is_decided(np.array([0.995]), 0.05).tolist()
    ([False, True], [False])
    """
    decided: NDArray[np.bool_] = (probability >= DECIDED) & (probability - error >= DECIDED_LOWER_BOUND)
    return decided
