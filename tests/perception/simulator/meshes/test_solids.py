"""Solids: closed, with outward faces, and of the volume given by a formula."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from solid_checks import is_closed, volume

from deixis.perception.simulator.meshes.solids import fitted, joined, moved, revolved, thick_sheet, tube


def test_a_revolved_rectangle_is_a_prism_over_a_regular_polygon() -> None:
    solid = revolved([(0, 0), (0.1, 0), (0.1, 0.3), (0, 0.3)], segments=12)
    polygon = 12 / 2 * 0.1**2 * np.sin(2 * np.pi / 12)
    assert is_closed(solid)
    assert volume(solid) == pytest.approx(polygon * 0.3)


@given(st.lists(st.floats(0.01, 0.2), min_size=2, max_size=8), st.integers(3, 20))
def test_a_revolved_profile_has_the_volume_of_its_frustums(radii: list[float], sides: int) -> None:
    heights = np.arange(len(radii)) * 0.05
    solid = revolved([(0, 0), *zip(radii, heights, strict=True), (0, float(heights[-1]))], segments=sides)
    a, b = np.array(radii[:-1]), np.array(radii[1:])
    frustums = 0.05 * (a**2 + a * b + b**2) / 3 * sides / 2 * np.sin(2 * np.pi / sides)
    assert is_closed(solid)
    assert volume(solid) == pytest.approx(frustums.sum(), rel=0.2, abs=1e-9)  # twisted quads are two triangles
    assert volume(solid) > 0


def test_a_profile_must_end_on_the_axis() -> None:
    with pytest.raises(ValueError, match="on the axis"):
        revolved([(0, 0), (0.1, 0), (0.1, 0.3)])


def test_a_straight_tube_has_the_volume_of_an_elliptic_bar() -> None:
    path = np.stack([np.zeros(5), np.linspace(0, 1, 5), np.zeros(5)], axis=1)
    bar = tube(path, width=0.2, depth=0.1, sides=64)
    assert is_closed(bar)
    assert volume(bar) == pytest.approx(np.pi * 0.1 * 0.05, rel=2e-3)


def test_a_sheet_with_a_hole_has_the_volume_of_its_cells() -> None:
    x, y = np.meshgrid(np.arange(4.0), np.arange(4.0))
    cells = np.ones((3, 3), dtype=bool)
    cells[1, 1] = False
    sheet = thick_sheet(x, y, 0 * x, 0 * x + 0.5, cells)
    assert is_closed(sheet)
    assert volume(sheet) == pytest.approx(8 * 0.5)
    assert len(sheet.vertices) == 32


def test_joined_solids_keep_their_volumes() -> None:
    cup = revolved([(0, 0), (0.1, 0), (0.1, 0.3), (0, 0.3)])
    far = moved(cup, by=(1.0, 0.0, 0.0))
    assert volume(joined(cup, far)) == pytest.approx(2 * volume(cup))


def test_a_fitted_mesh_has_the_extents_and_stands_on_0() -> None:
    solid = fitted(revolved([(0, 3), (7, 3), (2, 5), (0, 5)]), 0.2, 0.3, 0.05)
    low, high = solid.vertices.min(axis=0), solid.vertices.max(axis=0)
    assert low.tolist() == [-0.1, -0.15, 0.0]
    assert high.tolist() == pytest.approx([0.1, 0.15, 0.05], abs=1e-15)


@pytest.mark.parametrize(("quarters", "tip"), [(0, [0, 1]), (1, [-1, 0]), (2, [0, -1]), (-1, [1, 0])])
def test_a_quarter_turn_is_counter_clockwise_and_exact(quarters: int, tip: list[int]) -> None:
    x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0])
    sheet = thick_sheet(x, y, 0 * x, 0 * x + 1)
    away = int(np.argmax((sheet.vertices == [0, 1, 0]).all(axis=1)))
    turned = moved(sheet, yaw=quarters * np.pi / 2)
    assert turned.vertices[away, :2].tolist() == tip
    assert volume(turned) == pytest.approx(1.0)
