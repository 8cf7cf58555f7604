"""Neighbours of pixels, as a table and without one."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.detection.settings import SurfaceSettings
from deixis.perception.detection.table.neighbours import (
    AdjacentPixels,
    ListedNeighbours,
    neighbour_table,
    neighbours_in_image,
)
from deixis.perception.detection.table.plane import CameraPose
from deixis.perception.detection.table.viewpoint import View


def _view(missing: float, shape: tuple[int, int], seed: int = 0) -> View:
    kept = np.flatnonzero(np.random.default_rng(seed).random(shape[0] * shape[1]) >= missing)
    return View(np.zeros((len(kept), 3)), kept, shape, CameraPose(np.zeros(3)))


@pytest.mark.parametrize("missing", [0.0, 0.1, 0.25])
@pytest.mark.parametrize("shape", [(1, 1), (3, 200), (130, 40)])
@pytest.mark.parametrize("rounds", [0, 1, 2, 5])
def test_adjacent_pixels_equal_a_table_of_them(missing: float, shape: tuple[int, int], rounds: int) -> None:
    view, rng = _view(missing, shape), np.random.default_rng(1)
    adjacent = AdjacentPixels(view.places, *view.pixels, shape)
    listed = ListedNeighbours(
        neighbour_table(view.points, view.places, shape, SurfaceSettings(min_neighbours_share=0.0))
    )
    values, apart = rng.normal(size=len(view.places)), rng.uniform(0, 2, len(view.places))
    assert adjacent.averaged(values, apart, rounds).tolist() == listed.averaged(values, apart, rounds).tolist()
    seeds, allowed = rng.random((2, len(values))) < np.array([[0.02], [0.5]])
    assert adjacent.grown(seeds, allowed).tolist() == listed.grown(seeds, allowed).tolist()
    chosen = np.flatnonzero(allowed)
    assert adjacent.among(chosen).tolist() == listed.among(chosen).tolist()


def test_an_image_without_many_pixels_takes_the_next_ones() -> None:
    assert isinstance(neighbours_in_image(_view(0.1, (60, 80)), SurfaceSettings()), AdjacentPixels)
    view = _view(0.6, (60, 80))
    found = neighbours_in_image(view, SurfaceSettings())
    table = neighbour_table(view.points, view.places, (60, 80), SurfaceSettings())
    assert isinstance(found, ListedNeighbours) and found.table.tolist() == table.tolist()


def test_only_an_image_has_adjacent_pixels() -> None:
    bare = View(np.zeros((5, 3)), np.arange(5), None, CameraPose(np.zeros(3)))
    with pytest.raises(ValueError, match="must be an image"):
        neighbours_in_image(bare, SurfaceSettings())
