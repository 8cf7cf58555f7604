"""Average the last frames of a camera, which may move, so that what stands still is seen with less noise."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.tracking.frames.image import Optics


@dataclass(frozen=True, eq=False)
class _Taken:
    """Frame with the projection of the table's frame to its pixels, as in ``TableView``."""

    cloud: PointCloud
    matrix: NDArray[np.float64]
    offset: NDArray[np.float64]


class RecentFrames:
    """The last frames of a camera whose pose in the table's frame is known.

    Parameters
    ----------
    optics
        The camera.
    count
        Largest number of frames that are kept.

    Examples
    --------
    >>> from deixis.perception.clouds.depth import Intrinsics, back_projected
    >>> lens, rng = Intrinsics(40, 30, 40.0, 40.0, 19.5, 14.5), np.random.default_rng(0)
    >>> optics = Optics(np.array([[40, 0, 19.5], [0, 40, 14.5], [0, 0, 1]]), np.zeros(3))
    >>> recent = RecentFrames(optics, 5)
    >>> for _ in range(5):
    ...     wall = back_projected(rng.normal(1.0, 0.002, (30, 40)), lens)
    ...     recent.add(PointCloud(wall, organised=(30, 40)), np.eye(4))
    >>> mean = recent.mean(0.01, 0.0, 40.0)
    >>> [round(float(np.std(cloud[:, 2])), 4) for cloud in (wall, mean.points)]
    [0.002, 0.0009]
    """

    def __init__(self, optics: Optics, count: int) -> None:
        self._optics = optics
        self._frames: deque[_Taken] = deque(maxlen=count)

    def __len__(self) -> int:
        return len(self._frames)

    def add(self, cloud: PointCloud, back: NDArray[np.float64]) -> None:
        """Take in a frame.

        Parameters
        ----------
        cloud
            Organised cloud in the camera's frame, of the size of those before.
        back
            Transform (4, 4) from the frame of the cloud to that of the table.
        """
        out = np.linalg.inv(back)
        offset = self._optics.matrix @ (out[:3, 3] - self._optics.eye)
        self._frames.append(_Taken(cloud, self._optics.matrix @ out[:3, :3], offset))

    def mean(self, tolerance: float, noise: float, colour: float) -> PointCloud:
        """Return the last frame with the means of all measurements of what it shows.

        A measurement of an earlier frame counts where it shows the surface and the colour of the last one.

        Parameters
        ----------
        tolerance, noise
            Difference of two depths up to which they show one surface: the first, or the second times the squared
            depth, whichever is larger.
        colour
            Distance of two colours in RGB up to which they are those of one place.

        Returns
        -------
        PointCloud
            The last cloud, with points that are moved along their rays, and mean colours.
        """
        from deixis.perception.tracking.kernels import depths, mean_of

        *before, last = self._frames
        shape = last.cloud.organised
        assert shape is not None, "the frames of the tracker are organised"
        axis = self._optics.matrix[2]

        def depth_of(cloud: PointCloud) -> NDArray[np.float32]:
            points = np.ascontiguousarray(cloud.points.reshape(*shape, 3))
            return np.asarray(depths(points, axis.astype(np.float32), np.float32(-axis @ self._optics.eye)))

        def shade_of(cloud: PointCloud) -> NDArray[np.uint8]:
            shade = np.zeros(cloud.points.shape, np.uint8) if cloud.colours is None else cloud.colours
            return np.ascontiguousarray(shade.reshape(*shape, 3))

        now = depth_of(last.cloud)
        total, weight, shade = now.astype(np.float64), (now > 0).astype(np.float64), shade_of(last.cloud)
        tint = shade.astype(np.float64)
        for frame in before:
            turn = frame.matrix @ np.linalg.inv(last.matrix)
            shift = frame.offset - turn @ last.offset
            mean_of(
                now, shade, depth_of(frame.cloud), shade_of(frame.cloud), turn, shift, tolerance, noise, colour,
                total, tint, weight,
            )  # fmt: skip
        seen = weight > 0
        factor = np.where(seen, total / np.maximum(weight * now, 1e-9), np.nan).ravel()
        eye = self._optics.eye
        points = ((last.cloud.points - eye) * factor[:, None] + eye).astype(np.float32)
        colours = None
        if last.cloud.colours is not None:
            colours = (tint / np.maximum(weight, 1)[..., None]).round().astype(np.uint8).reshape(-1, 3)
        return replace(last.cloud, points=points, colours=colours)
