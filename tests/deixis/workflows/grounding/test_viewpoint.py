"""Scenes as seen from another side."""

from __future__ import annotations

import math

import numpy as np
import pytest

from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.grounding.hypotheses.viewpoint import Viewpoint
from deixis.workflows.grounding.viewpoint import scene_from


@pytest.mark.parametrize(("mirrored", "front"), [(False, [0, 1]), (True, [0, -1])])
def test_fronts_turn_with_the_boxes(mirrored: bool, front: list[float]) -> None:
    chair = PerceivedObject("chair", (0.0, 0.0), (0.5, 0.5), front=(1.0, 0.0))
    side = Viewpoint(math.pi / 2, mirrored, 1.0, 0.0, np.zeros(0, np.int64))
    np.testing.assert_allclose(scene_from(Scene((chair,)), side).fronts, [front], atol=1e-12)
