"""Errors of perception; each also derives from ValueError."""

from __future__ import annotations

from deixis.errors import DeixisError


class SceneError(DeixisError, ValueError):
    """Scene that cannot be read or is inconsistent; the message names the file and the place in it."""


class CloudError(DeixisError, ValueError):
    """Point cloud that cannot be read, or arrays that do not form one."""


class RecognitionError(DeixisError, ValueError):
    """Descriptors, categories or settings that do not fit together; the message names them and the remedy."""


class SimulationError(DeixisError, ValueError):
    """Object, table or camera that cannot be simulated; the message names it and the reason."""


class PointingError(DeixisError, ValueError):
    """Skeleton, gesture or file of skeletons that is invalid; the message names the place and the remedy."""
