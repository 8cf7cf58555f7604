"""Arguments of a cloud that are not arrays of the right kind."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from deixis.errors import DeixisError
from deixis.perception.clouds.cloud import PointCloud

POINTS = np.zeros((2, 3), np.float32)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("points", None),
        ("points", [[0, 0, 0]]),
        ("points", POINTS.astype(complex)),
        ("points", np.array([["a", "b", "c"]])),
        ("colours", np.full((2, 3), 0.5)),
        ("labels", ["cup", "mug"]),
        ("normals", "up"),
        ("organised", (2,)),
        ("organised", (1.0, 2.0)),
    ],
)
def test_what_is_not_an_array_of_numbers_is_refused(name: str, value: Any) -> None:
    with pytest.raises(DeixisError, match=f"`{name}` must be"):
        PointCloud(**({"points": POINTS} | {name: value}))


def test_an_image_has_no_negative_sides() -> None:
    with pytest.raises(DeixisError, match="an image of -1 row"):
        PointCloud(POINTS, organised=(-1, -2))


@pytest.mark.parametrize("chosen", [np.array([900]), np.zeros(3, bool), np.array([0.0])])
def test_indices_that_are_not_points_are_refused(chosen: Any) -> None:
    with pytest.raises(DeixisError, match="`chosen` must be a mask or indices of the 2 points"):
        PointCloud(POINTS).take(chosen)
