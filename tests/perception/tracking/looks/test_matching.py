"""Matches of detected objects with tracked things."""

import numpy as np
import pytest
from first_looks import HALF, PLATE, first_look

from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.looks.matching import matches, overlap
from deixis.perception.tracking.looks.whole import shown

pytest.importorskip("open3d")


def test_thin_thing_beside_its_pixels_is_the_same_thing() -> None:
    look = first_look([PLATE, Placement("knife", "butter knife", 0.1, 0.0, seed=3)])
    reference, things = look.table.reference, list(look.things)
    of = shown(look.found.labels, look.cloud, HALF.stride)
    reference.owner = np.roll(reference.owner, 3, axis=1)
    assert overlap(reference.owner == 2, of == 1) < 0.3, "few pixels are at the same places"
    assert matches(of, 2, look.image, look.view.back, reference, things) == dict(enumerate(things))
