"""The panel of a picture that shows segments as the camera sees them: each in its colour, outlined and named."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.scene import PerceivedObject, Scene
from deixis.plots.figure import INK, PALE_PALETTE, PALETTE

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARGIN = 0.1
"""Margin around the things, as a share of their extent."""

BACKGROUND_STRENGTH = 0.35
"""Share of the image's own shade in points that belong to no thing; the rest is white."""

UNMEASURED = 0.98


@dataclass(frozen=True, eq=False)
class CameraPicture:
    """An image of segments, and its things as boxes in its pixels, x to the right and y up.

    ``picture`` has shape (height, width, 3), its first row on top.
    """

    picture: NDArray[np.float64]
    things: tuple[PerceivedObject, ...]

    @property
    def shape(self) -> float:
        """Ratio of width to height."""
        return float(self.picture.shape[1] / self.picture.shape[0])


def camera_of(cloud: PointCloud, labels: NDArray[np.int32], scene: Scene) -> CameraPicture:
    """Return the camera's view of an organised cloud, cropped to its things.

    Measured points of no thing are grey, and unmeasured ones nearly white.

    Parameters
    ----------
    cloud
        An organised cloud of n points.
    labels
        Number of the thing that each point belongs to, shape (n,).
    scene
        The scene with these things.

    Returns
    -------
    CameraPicture
        The image, and the places of the things in it.
    """
    assert cloud.organised is not None
    numbers = labels.reshape(cloud.organised)
    # Give each point the colour of its thing, shaded by the brightness of the image where the cloud has colours.
    grey = np.full(len(cloud), 0.75) if cloud.colours is None else cloud.colours.mean(axis=1) / 255.0
    picture = np.repeat((1.0 - BACKGROUND_STRENGTH * (1.0 - grey))[:, None], 3, axis=1)
    picture[~cloud.finite] = UNMEASURED
    on_things = labels >= 0
    shade = 1.0 if cloud.colours is None else (0.55 + 0.45 * grey[on_things])[:, None]
    picture[on_things] = colours_of(labels[on_things]) * shade
    picture = picture.reshape(*cloud.organised, 3)
    # Crop to the things; keep the whole image without things.
    where = np.argwhere(numbers >= 0)
    if not len(where):
        rows, columns = slice(None), slice(None)
    else:
        low, high = where.min(axis=0), where.max(axis=0)
        more = int(MARGIN * (high - low).max()) + 2
        (top, left), (bottom, right) = np.maximum(low - more, 0).tolist(), (high + more + 1).tolist()
        rows, columns = slice(top, bottom), slice(left, right)
    numbers, picture = numbers[rows, columns], picture[rows, columns]
    from scipy.ndimage import binary_erosion, binary_fill_holes

    things = []
    for number, thing in enumerate(scene.objects):
        mask = numbers == number
        if mask.any():
            # Darken the outermost pixels; holes inside get no edge.
            filled = binary_fill_holes(mask)
            edge: NDArray[np.bool_] = filled & ~binary_erosion(filled, iterations=2)
            picture[edge] *= 0.5
            name = thing.label or thing.id
            ys, xs = np.nonzero(mask[::-1])  # y up
            low, high = (float(xs.min()), float(ys.min())), (float(xs.max() + 1), float(ys.max() + 1))
            things.append(PerceivedObject(name, low, high, label=name))
    return CameraPicture(picture, tuple(things))


def draw_camera(axes: Axes, camera: CameraPicture) -> None:
    """Draw the image in pixel coordinates, y up, without the names.

    Parameters
    ----------
    axes
        Axes to draw into.
    camera
        The image.
    """
    height, width = camera.picture.shape[:2]
    axes.imshow(camera.picture, extent=(0, width, 0, height))
    axes.set_title("As the camera sees it", color=INK, fontsize=12, loc="left")
    axes.set_axis_off()


def colours_of(numbers: NDArray[np.integer]) -> NDArray[np.float64]:
    """Return a colour for each number: those of the palette, then each of them paler.

    Parameters
    ----------
    numbers
        Whole numbers, shape (n,).

    Returns
    -------
    ndarray
        Red, green and blue in [0, 1], shape (n, 3).
    """
    from matplotlib.colors import to_rgb

    colours = np.array([to_rgb(colour) for colour in (*PALETTE, *PALE_PALETTE)])
    chosen: NDArray[np.float64] = colours[np.asarray(numbers) % len(colours)]
    return chosen
