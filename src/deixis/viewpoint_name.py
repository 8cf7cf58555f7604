"""The names of the sides from which a scene is seen; nothing else, so that the command line lists them at once."""

from __future__ import annotations

from enum import StrEnum


class ViewpointName(StrEnum):
    """Where left and right are said from: as the scene states, or a side to be recovered (:mod:`deixis.sides`)."""

    STATED = "stated"
    QUARTER = "quarter"  # turned by quarters of a circle
    UNKNOWN = "unknown"  # turned by any angle
