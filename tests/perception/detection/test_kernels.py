from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from deixis.perception.detection.kernels import grow, meetings, planes, planes_in_image
from deixis.perception.detection.settings import SurfaceSettings
from deixis.perception.detection.table.neighbours import neighbour_table


@pytest.mark.parametrize("count", [3, 100])
def test_meetings_equal_a_plain_count_of_neighbours(count: int) -> None:
    rng = np.random.default_rng(0)
    size = 3000
    of = rng.integers(count, size=size).astype(np.int32)
    neighbours = rng.integers(-1, size, size=(size, 8)).astype(np.int32)
    points, jump = rng.random((size, 3)), np.full(size, 0.5)
    pairs, total, jumped = meetings(of, neighbours, points, jump, count)
    expected: Counter[tuple[int, int]] = Counter()
    beyond: Counter[tuple[int, int]] = Counter()
    for point, others in enumerate(neighbours.tolist()):
        for other in others:
            if other >= 0 and of[point] != of[other]:
                pair = (int(min(of[point], of[other])), int(max(of[point], of[other])))
                expected[pair] += 1
                beyond[pair] += int(np.linalg.norm(points[point] - points[other]) > 0.5)
    found = [(a, b) for a, b in pairs.tolist()]
    assert found == sorted(expected)  # of 100 patches, more pairs meet than the first table has room for
    assert total.tolist() == [expected[pair] for pair in found]
    assert jumped.tolist() == [beyond[pair] for pair in found]


def test_patches_that_do_not_meet_have_no_pairs() -> None:
    alone = np.full((2, 8), -1, np.int32)
    pairs, total, jumped = meetings(np.array([0, 1], np.int32), alone, np.zeros((2, 3)), np.ones(2), 2)
    assert (pairs.shape, total.shape, jumped.shape) == ((0, 2), (0,), (0,))


@pytest.mark.parametrize("step_cost", [1.0, 1e6])
def test_patches_grow_along_the_cheapest_paths(step_cost: float) -> None:
    """Compare with scipy's algorithm; steps of a high cost exceed the range of the buckets."""
    rng, (rows, columns) = np.random.default_rng(0), (40, 50)
    count = rows * columns
    points, normals, colours = rng.random((3, count, 3))
    neighbours = neighbour_table(points, np.arange(count), (rows, columns), SurfaceSettings())
    jump = rng.uniform(0.5, 1.0) * np.ones(count)
    seeds = rng.choice(count, 30, replace=False)
    found = grow(seeds, 0.1, (1.5, step_cost, 0.05, 0.1), points, points, normals, colours, neighbours, jump)
    start, place = np.nonzero(neighbours >= 0)
    end = neighbours[start, place]
    way = points[end] - points[start]
    near = np.linalg.norm(way, axis=1) <= jump[0]
    start, end, way = start[near], end[near], way[near]
    tint = np.linalg.norm(colours[start] - colours[end], axis=1)
    cost = np.linalg.norm(way, axis=1) / 0.1 + 1.5 * np.linalg.norm(normals[start] - normals[end], axis=1)
    cost += step_cost * np.abs((way * (normals[start] + normals[end])).sum(axis=1) / 2)
    cost += 0.05 * np.maximum(tint - 0.1, 0.0)
    graph = coo_array((cost, (start, end)), shape=(count, count)).tocsr()
    _, _, source = dijkstra(graph, indices=seeds, min_only=True, return_predecessors=True)
    reached = source >= 0
    assert reached.sum() > 1000
    assert (seeds[found[reached]] == source[reached]).all()
    assert (found[~reached] >= len(seeds)).all()


def _bowl(noise: float) -> tuple[NDArray[np.float64], NDArray[np.int32], tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Return the points of a bowl from above with holes in the image, their neighbours and their pixels."""
    rng, side = np.random.default_rng(1), 70
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(-0.07, 0.07, side), np.linspace(-0.07, 0.07, side)))
    points = np.stack([x, y, 4 * (x**2 + y**2) + rng.normal(0, noise, side**2)], axis=1)
    kept = np.flatnonzero(rng.random(side**2) > 0.05)
    neighbours = neighbour_table(points[kept], kept, (side, side), SurfaceSettings())
    row, column = np.divmod(kept, side)
    return points[kept], neighbours, (row, column)


def test_planes_of_an_image_equal_those_along_paths() -> None:
    points, neighbours, pixels = _bowl(0.0003)
    radius, jump, eye = np.full(len(points), 0.006), np.full(len(points), 0.01), np.array([0.0, 0.0, 1.0])
    steps = np.array(sorted(np.ndindex(9, 9), key=lambda step: (step[0] - 4) ** 2 + (step[1] - 4) ** 2)) - 4
    normals, smooth = planes_in_image(points, *pixels, radius, np.full(len(points), 4.0), eye, steps)
    expected, moved = planes(points, neighbours, radius, jump, eye, 120)
    same = np.abs(normals - expected).max(axis=1) < 1e-9
    assert same.mean() > 0.99
    assert np.abs(smooth - moved)[same].max() < 1e-9


def test_a_plane_of_an_image_takes_no_point_out_of_reach() -> None:
    points, _, pixels = _bowl(0.0)
    points = points * (1.0, 1.0, 0.0)
    points[len(points) // 2, 2] = 0.02
    radius, eye = np.full(len(points), 0.006), np.array([0.0, 0.0, 1.0])
    steps = np.array([[0, 0], [0, 1], [1, 0], [0, -1], [-1, 0]])
    normals, smooth = planes_in_image(points, *pixels, radius, np.ones(len(points)), eye, steps)
    flat = np.delete(np.arange(len(points)), len(points) // 2)
    assert np.allclose(np.abs(normals[flat, 2]), 1.0)
    assert np.allclose(smooth, points)
