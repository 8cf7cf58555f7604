from __future__ import annotations

import numpy as np
import pytest

from deixis.reasoning.geometry.coordinates import coordinates, norms


@pytest.mark.parametrize("count", [0, 1, 4096, 10_001])
@pytest.mark.parametrize("shape", [(3,), (2, 3), (8, 3)])
def test_coordinates_are_products_with_the_axes(count: int, shape: tuple[int, ...]) -> None:
    rng = np.random.default_rng(0)
    points, axes = rng.normal(size=(count, 3)), rng.normal(size=shape)
    np.testing.assert_allclose(coordinates(points, axes), points @ axes.T, atol=1e-12)


@pytest.mark.parametrize("count", [0, 1, 1000])
def test_norms_equal_those_of_numpy(count: int) -> None:
    vectors = np.random.default_rng(0).normal(size=(count, 3))
    assert norms(vectors).tolist() == np.linalg.norm(vectors, axis=1).tolist()
