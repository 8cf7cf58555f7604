"""Agreement of the points of a thing with a frame."""

import numpy as np
import pytest

from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.frames.image import FrameImage, Optics, table_view
from deixis.perception.tracking.things.sight import Sight, quaternion

SHAPE = 60, 120
OPTICS = Optics(np.array([[200.0, 0, 59.5], [0, 200.0, 29.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down: a pixel is 5 mm
RED, WOOD = (130.0, 40.0, 50.0), (140.0, 105.0, 73.0)
BOX = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.1, 0.05, 0.02))


def block(hidden: float = 0.0) -> tuple[Sight, np.ndarray]:
    """Return a red block of 10 cm by 5 cm, of which something hides a share from its left end, and its points."""
    depth, colour = np.ones(SHAPE, np.float32), np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    rows, columns = np.mgrid[25:35, 50:70]
    depth[rows, columns], colour[rows, columns] = 0.98, RED
    points = np.stack([(columns - 59.5) / 200 * 0.98, -(rows - 29.5) / 200 * 0.98, 0 * rows + 0.02], axis=-1)
    depth[20:40, 40 : 50 + round(20 * hidden)] = 0.5
    rays = np.stack([(np.indices(SHAPE)[1] - 59.5) / 200, (np.indices(SHAPE)[0] - 29.5) / 200, np.ones(SHAPE)], -1)
    image = FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, OPTICS)
    own = points.reshape(-1, 3)
    sight = Sight(
        own - (0, 0, 0.01), np.tile(RED, (len(own), 1)), image, table_view(OPTICS, BACK, SHAPE),
        np.zeros(SHAPE, np.bool_), 0.0015,
    )  # fmt: skip
    return sight, own


@pytest.mark.parametrize("hidden", [0.0, 0.5])
def test_hidden_points_count_neither_for_nor_against_a_pose(hidden: float) -> None:
    sight, _ = block(hidden)
    found = sight.agreement(np.array([0.0, 0.0, 0.01]), np.array([1.0, 0, 0, 0]))
    assert found.fit > 0.9 and found.exposed == pytest.approx(1 - hidden, abs=0.05)
    assert found.visible == pytest.approx(found.fit * found.exposed, abs=0.05)
    beside = sight.agreement(np.array([0.0, 0.1, 0.01]), np.array([1.0, 0, 0, 0]))
    assert beside.fit < 0.1 and beside.exposed == 1.0, "the table is seen there"


def test_pose_beside_a_thing_is_corrected_along_the_table() -> None:
    sight, own = block()
    start = np.eye(4)
    start[:3, 3] = 0.02, -0.01, 0.01
    pose, gain = sight.shifted(start, BOX, own)
    assert pose[:3, 3] == pytest.approx([0.0, 0.0, 0.01], abs=0.005) and gain > 0.1


def test_quaternion_has_its_real_part_first() -> None:
    turned = np.array([[0.0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]])
    assert np.abs(quaternion(turned)) == pytest.approx([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])
