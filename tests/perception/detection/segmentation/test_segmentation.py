"""Patches that respect edges, and evidence along the boundaries of regions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.perception.detection.detect import segments
from deixis.perception.detection.segmentation.boundaries import Boundaries, agglomerated, boundaries, creases
from deixis.perception.detection.segmentation.supervoxels import supervoxels
from deixis.perception.detection.segmentation.surface import Surface, surface_of
from deixis.perception.detection.settings import (
    BoundarySettings,
    DetectionSettings,
    SupervoxelSettings,
    SurfaceSettings,
)
from deixis.perception.detection.table.neighbours import neighbour_table

SIDE = 60
EYE = np.array([0.06, 0.06, 0.8])


def _folded(angle: float, paint: NDArray[np.uint8] | None = None) -> Surface:
    """Return two rectangles of 6 by 12 cm at an angle along x = 0.06, seen from above; a positive angle is a valley."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 0.12, SIDE), np.linspace(0, 0.12, SIDE)))
    z = np.abs(x - 0.06) * np.tan(angle / 2) + 0.1
    points = np.stack([x, y, z], axis=1)
    neighbours = neighbour_table(points, np.arange(SIDE * SIDE), (SIDE, SIDE), SurfaceSettings())
    return surface_of(points, paint, neighbours, np.full(len(points), 2e-4), EYE, SurfaceSettings())


@pytest.mark.parametrize(("angle", "count"), [(-1.6, 1), (-0.8, 1), (0.0, 1), (1.6, 2)])
def test_surfaces_separate_in_a_valley_and_not_on_a_ridge(angle: float, count: int) -> None:
    found = segments(_folded(angle), DetectionSettings())
    assert found.max() + 1 == count
    left = np.tile(np.arange(SIDE) < SIDE // 2 - 4, SIDE)
    right = np.tile(np.arange(SIDE) > SIDE // 2 + 4, SIDE)
    assert len(np.unique(found[left])) == 1 and len(np.unique(found[right])) == 1


def test_only_the_valley_is_a_crease_with_its_angle() -> None:
    surface = _folded(1.2)
    patches = supervoxels(surface, SupervoxelSettings())
    pairs = boundaries(surface, patches, DetectionSettings()).pairs
    near = np.abs(patches.middles[pairs, 0] - 0.06).min(axis=1) < 0.008
    assert 0.5 < np.median(creases(patches, pairs)[near & (creases(patches, pairs) > 0.1)]) <= 1.25
    assert creases(patches, pairs)[~near].max() < 0.1


def test_patches_meet_where_the_colour_changes() -> None:
    paint = np.full((SIDE * SIDE, 3), 200, np.uint8)
    dark = np.tile(np.arange(SIDE) < 23, SIDE)
    paint[dark] = (120, 30, 40)
    patches = supervoxels(_folded(0.0, paint), SupervoxelSettings())
    share = np.bincount(patches.of, dark) / np.bincount(patches.of)
    mixed = np.minimum(share, 1 - share) * np.bincount(patches.of)
    assert mixed.sum() < 0.03 * SIDE * SIDE


@settings(max_examples=40, deadline=None)
@given(st.integers(2, 30), st.integers(0, 10**6))
def test_no_boundary_with_little_evidence_is_left(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = np.triu_indices(count, 1)
    chosen = rng.random(len(a)) < 0.3
    pairs = np.stack([a[chosen], b[chosen]], axis=1).astype(np.int64)
    lengths, evidence = rng.integers(1, 9, len(pairs)).astype(float), rng.random(len(pairs))
    meeting = Boundaries(pairs, lengths, evidence, np.zeros(len(pairs)))
    of = agglomerated(meeting, 3 * rng.random((count, 3)), rng.random(count), BoundarySettings(merge_limit=0.5))
    assert of[0] == 0 and set(of.tolist()) == set(range(of.max() + 1))
    left = of[pairs]
    for one, other in {(int(min(p)), int(max(p))) for p in left if p[0] != p[1]}:
        between = np.sort(left, axis=1) == (one, other)
        meets = between.all(axis=1)
        assert (lengths[meets] * evidence[meets]).sum() / lengths[meets].sum() >= 0.5 - 1e-9


def merged_by_search(
    meeting: Boundaries, colours: NDArray[np.float64], weights: NDArray[np.float64], limits: BoundarySettings
) -> list[int]:
    """Return the regions of agglomeration by a search of all pairs before each merge.

    A pair that is refused for its colours is examined again when one of its regions has grown.
    """
    of, refused = np.arange(len(weights)), set[tuple[int, int]]()

    def unlike(a: int, b: int) -> float:
        first, second = (np.average(colours[of == k], axis=0, weights=weights[of == k]) for k in (a, b))
        return min(float(np.linalg.norm(first - second)) / limits.full_colour_difference, 1.0)

    def is_on(small: int, large: int, edges: dict[tuple[int, int], NDArray[np.float64]]) -> bool:
        around = [(sum(pair) - small, row) for pair, row in edges.items() if small in pair]
        alike = [row for other, row in around if unlike(large, other) < 0.5]
        length, total = np.sum(alike, axis=0)
        return bool(total >= limits.merge_limit * length)

    while True:
        edges: dict[tuple[int, int], NDArray[np.float64]] = {}
        for (a, b), length, evidence in zip(meeting.pairs.tolist(), meeting.lengths, meeting.evidence, strict=True):
            if of[a] != of[b]:
                pair = (min(of[a], of[b]), max(of[a], of[b]))
                edges[pair] = edges.get(pair, np.zeros(2)) + np.array([length, length * evidence])
        keys = [
            (total / length + limits.colour_delay * unlike(*pair), *pair)
            for pair, (length, total) in edges.items()
            if total / length < limits.merge_limit and pair not in refused
        ]
        if not keys:
            return [int(k) for k in np.unique(of, return_inverse=True)[1]]
        _, a, b = min(keys)
        small, large = (a, b) if weights[of == a].sum() < weights[of == b].sum() else (b, a)
        if unlike(a, b) == 1.0 and is_on(small, large, edges):
            refused.add((a, b))
        else:
            refused = {pair for pair in refused if not {a, b} & {*pair}}
            of[of == b] = a


@settings(max_examples=30, deadline=None)
@given(st.integers(2, 14), st.integers(0, 10**6))
def test_agglomeration_agrees_with_a_search_of_all_pairs(count: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    pairs = np.argwhere(np.triu(rng.random((count, count)) < 0.4, 1)).astype(np.int64)
    meeting = Boundaries(pairs, rng.integers(1, 9, len(pairs)).astype(float), rng.random(len(pairs)), np.zeros(0))
    given = (meeting, 8 * rng.random((count, 3)), 0.1 + rng.random(count), BoundarySettings())
    assert agglomerated(*given).tolist() == merged_by_search(*given)


@pytest.mark.parametrize(("tint", "expected"), [(0.0, [0, 0, 1]), (20.0, [0, 1, 1])])
def test_colour_decides_the_order_of_merges(tint: float, expected: list[int]) -> None:
    """Check that a rim is merged before the knife that ends smoothly on one half and hangs over the other."""
    knife, rim, other = (tint, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    pairs, evidence = np.array([[0, 1], [0, 2], [1, 2]]), np.array([0.0, 1.4, 0.1])
    meeting = Boundaries(pairs, np.array([4.0, 8.0, 4.0]), evidence, np.zeros(3))
    assert agglomerated(meeting, np.array([knife, rim, other]), np.ones(3), BoundarySettings()).tolist() == expected


@pytest.mark.parametrize(("evidence", "expected"), [(1.0, [0, 1, 2]), (0.3, [0, 0, 0])])
def test_a_knife_across_a_plate_joins_neither_half(evidence: float, expected: list[int]) -> None:
    """Check that a knife that ends smoothly on one half stays separate, and that the prints on a box do not."""
    meeting = Boundaries(np.array([[0, 1], [0, 2]]), np.array([4.0, 20.0]), np.array([0.1, evidence]), np.zeros(2))
    colours = np.array([(20.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)])
    assert agglomerated(meeting, colours, np.array([1.0, 4.0, 4.0]), BoundarySettings()).tolist() == expected


def test_a_smooth_surface_of_two_colours_is_one_object() -> None:
    meeting = Boundaries(np.array([[0, 1]]), np.ones(1), np.array([0.55]), np.zeros(1))
    assert agglomerated(
        meeting, np.array([[0.0, 0.0, 0.0], [90.0, 0.0, 0.0]]), np.ones(2), BoundarySettings()
    ).tolist() == [0, 0]
