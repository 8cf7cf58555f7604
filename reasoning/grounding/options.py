"""Names of engines and viewpoints, importable without loading any engine."""

from __future__ import annotations

from enum import StrEnum


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
