"""The errors of perception; each also derives from ValueError."""

from __future__ import annotations

from deixis.errors import DeixisError


class SceneError(DeixisError, ValueError):
    """A scene that cannot be read, or that contradicts itself; the message names the file and the place in it."""


class CloudError(DeixisError, ValueError):
    """A point cloud that cannot be read, or arrays that make none."""


class RecognitionError(DeixisError, ValueError):
    """Descriptors, categories or settings that do not fit together; the message names which, and what would fit."""


class SimulationError(DeixisError, ValueError):
    """A thing, a table or a camera that cannot be simulated; the message says which and why."""
