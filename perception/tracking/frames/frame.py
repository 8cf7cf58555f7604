"""One cloud of a stream, with its time."""

from __future__ import annotations

from dataclasses import dataclass

from deixis.perception.clouds.cloud import PointCloud


@dataclass(frozen=True, eq=False)
class Frame:
    """Cloud of one moment.

    Parameters
    ----------
    cloud
        Points in metres, in the frame of the camera or in any frame that stays fixed to it.
    at
        Time in seconds since the start of the stream or of a memory.
    number
        Number of the frame in its stream, from 0; numbers of dropped frames are missing.
    problem
        Why the cloud could not be read, in one line; the cloud is then empty. None if all is well.
    """

    cloud: PointCloud
    at: float
    number: int
    problem: str | None = None
