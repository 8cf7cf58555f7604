"""Thin things of another colour on a plate, and prints."""

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.perception.detection.segmentation.lying import with_lying_things
from deixis.perception.detection.segmentation.surface import Surface, surface_of
from deixis.perception.detection.settings import DetectionSettings, SurfaceSettings
from deixis.perception.detection.table.neighbours import neighbour_table

SIDE = 90
CREAM, STEEL = (235, 225, 210), (140, 145, 155)


def _plate(
    rise: float, colour: tuple[int, int, int], slope: float = 0.0, noise: float = 0.0012
) -> tuple[Surface, NDArray[np.bool_]]:
    """Return a sloping square of 18 cm with a strip of 10 by 1 cm on it, and a mask of the strip."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 0.18, SIDE), np.linspace(0, 0.18, SIDE)))
    strip = (abs(x - 0.09) < 0.05) & (abs(y - 0.09) < 0.006)
    z = 0.02 + 0.5 * (x - 0.09) ** 2 + slope * y + rise * strip
    z += np.random.default_rng(0).normal(0, noise, len(z))
    neighbours = neighbour_table(np.zeros((len(x), 3)), np.arange(len(x)), (SIDE, SIDE), SurfaceSettings())
    paint = np.where(strip[:, None], colour, CREAM).astype(np.uint8)
    points, eye = np.stack([x, y, z], axis=1), np.array([0.09, 0.09, 0.9])
    return surface_of(points, paint, neighbours, np.full(len(x), noise), eye, SurfaceSettings()), strip


@pytest.mark.parametrize(
    ("rise", "colour", "slope", "count"),
    [(0.004, STEEL, 0.0, 2), (0.0, STEEL, 0.0, 1), (0.004, CREAM, 0.0, 1), (0.004, STEEL, 1.2, 1)],
    ids=["a knife on a plate", "a print", "a ridge of its colour", "a label on a steep side"],
)
def test_a_raised_strip_of_another_colour_is_separated(
    rise: float, colour: tuple[int, int, int], slope: float, count: int
) -> None:
    surface, strip = _plate(rise, colour, slope)
    found = with_lying_things(surface, np.zeros(len(surface), np.int32), DetectionSettings())
    assert found.max() + 1 == count
    if count == 2:
        assert (found[strip] == 1).mean() > 0.9 and (found[~strip] == 0).mean() > 0.97


def test_a_band_that_ends_with_its_thing_is_not_separated() -> None:
    surface, _ = _plate(0.004, STEEL)
    of = np.full(len(surface), 1, np.int32)
    of[surface.points[:, 1] > 0.085] = 0
    found = with_lying_things(surface, of, DetectionSettings())
    assert found.max() == 1, "the surface is seen at one side of it only"


def test_a_cloud_without_colours_stays_as_it_is() -> None:
    surface, _ = _plate(0.004, STEEL)
    bare = surface_of(surface.points, None, surface.neighbours, surface.sigma, np.ones(3), SurfaceSettings())
    assert not with_lying_things(bare, np.zeros(len(bare), np.int32), DetectionSettings()).any()
