"""Simulated views of single things."""

from __future__ import annotations

import numpy as np
import pytest

from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.views import CAMERA_DISTANCES, views_of
from deixis.perception.simulator.meshes.solids import moved
from deixis.perception.simulator.meshes.tableware import make


def test_views_show_only_the_thing_at_the_stated_distance() -> None:
    views = views_of(make("bowl", 1).mesh, 20, seed=1)
    assert len(views) == 20
    for view in views:
        assert view.finite.all()
        assert view.origin == (0.0, 0.0, 0.0)
        middle = (view.points.min(axis=0) + view.points.max(axis=0)) / 2
        assert CAMERA_DISTANCES[0] - 0.1 < np.linalg.norm(middle) < CAMERA_DISTANCES[1] + 0.1
        assert len(view) > 2000


@pytest.mark.parametrize("kind", ["mug", "dinner fork", "bottle"])
def test_a_view_is_about_as_large_as_the_thing(kind: str) -> None:
    thing = make(kind, 2)
    diagonal = float(np.linalg.norm([thing.size.width, thing.size.length, thing.size.height]))
    for exact, noisy in zip(views_of(thing.mesh, 6, 3, noise=0.0), views_of(thing.mesh, 6, 3), strict=True):
        assert np.linalg.norm(np.ptp(exact.points, axis=0)) <= 1.42 * diagonal
        spread = exact.points - exact.points.mean(axis=0)
        assert 2 * np.linalg.norm(spread, axis=1).max() >= 0.6 * diagonal
        assert 0.8 * len(exact) < len(noisy) < len(exact)


def test_more_views_add_to_fewer_and_seeds_differ() -> None:
    mesh = make("cup", 1).mesh
    few, many, other = views_of(mesh, 2, 5), views_of(mesh, 4, 5), views_of(mesh, 2, 6)
    assert all(np.array_equal(a.points, b.points) for a, b in zip(few, many, strict=False))
    assert not np.array_equal(few[0].points, many[2].points)
    assert not np.array_equal(few[0].points, other[0].points)


def test_where_the_mesh_stands_does_not_matter() -> None:
    mesh = make("cup", 1).mesh
    here, there = views_of(mesh, 1, 5, noise=0.0)[0], views_of(moved(mesh, by=(3.0, 2.0, 1.0)), 1, 5, noise=0.0)[0]
    assert np.abs(here.points - there.points).max() < 1e-5


def test_cameras_are_all_around_and_above() -> None:
    directions = []
    mesh = make("tumbler", 1).mesh
    for view in views_of(mesh, 40, 7, noise=0.0):
        directions.append(view.points.mean(axis=0) / np.linalg.norm(view.points.mean(axis=0)))
        assert directions[-1][2] > 0.9  # it is in the centre of the image
    heights = [float(np.ptp(view.points[:, 1])) for view in views_of(mesh, 40, 7, noise=0.0)]
    assert max(heights) > 1.15 * min(heights)


def test_a_mesh_too_large_or_without_faces_is_an_error() -> None:
    mesh = make("cup", 1).mesh
    with pytest.raises(SimulationError, match="unit"):
        views_of(Mesh(mesh.vertices * 1000, mesh.faces), 1, 0)
    with pytest.raises(SimulationError, match="must have faces"):
        views_of(Mesh(mesh.vertices, mesh.faces[:0]), 1, 0)


def test_an_upright_view_is_in_the_frame_of_the_table() -> None:
    mesh = make("mug", seed=1).mesh
    aside, upright = views_of(mesh, 1, seed=3)[0], views_of(mesh, 1, seed=3, upright=True)[0]
    assert abs(float(upright.points[:, 2].min())) < 0.01
    distances = [np.linalg.norm(each.points - np.array(each.origin), axis=1) for each in (aside, upright)]
    np.testing.assert_allclose(distances[1], distances[0], atol=1e-5)
