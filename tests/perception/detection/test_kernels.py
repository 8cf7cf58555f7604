from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from deixis.perception.detection.kernels import meetings


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
