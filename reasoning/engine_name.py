"""The names of the engines; nothing else, so that the command line can list them without loading any."""

from __future__ import annotations

from enum import StrEnum


class EngineName(StrEnum):
    """The engines that align a description with a scene (:mod:`deixis.reasoning.engines`)."""

    EXACT = "exact"
    SCALABLE = "scalable"
    SIMILARITY = "similarity"
    BLONDEL = "blondel"
    HEYMANS_SINGH = "heymans-singh"
