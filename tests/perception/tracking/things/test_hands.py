"""Hands that come over the table from outside."""

import numpy as np

from deixis.perception.tracking.frames.image import FrameImage, Optics
from deixis.perception.tracking.table.outline import Outline
from deixis.perception.tracking.things.hands import MAX_STEP, Hands

ROWS, COLUMNS = 60, 80
OPTICS = Optics(np.array([[80.0, 0, 39.5], [0, 80.0, 29.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down


def image_of_arm(rows: int, height: float = 0.2) -> tuple[FrameImage, np.ndarray]:
    """Return a frame with an arm from the lower border over some rows, and a mask of it."""
    depth = np.full((ROWS, COLUMNS), 1.0, np.float32)
    depth[ROWS - rows :, 35:45] = 1.0 - height
    row, column = np.indices(depth.shape)
    rays = np.stack([column, row, np.ones(depth.shape)], axis=-1) @ np.linalg.inv(OPTICS.matrix).T
    points = (rays * depth[..., None]).astype(np.float32)
    return FrameImage(points, depth, np.zeros_like(points), OPTICS), depth < 1


def test_step_of_a_hand_is_that_of_its_end() -> None:
    hands, outline = Hands(), Outline()
    for rows in (20, 25):
        image, arm = image_of_arm(rows)
        assert (hands.see(image, arm, outline, BACK) == arm).all()
    ahead = 5 * 0.8 / 80  # five rows at a depth of 0.8 m
    tip = image.places(np.array([(ROWS - 22) * COLUMNS + 40]), BACK)[0]
    step = hands.carried(tip - np.array([0, ahead, 0]), 0.05)
    assert step is not None and np.allclose(step, [0, ahead, 0], atol=0.004)
    assert hands.carried(tip + np.array([0.5, 0, 0]), 0.05) is None, "the thing is out of its reach"


def test_new_hand_carries_nothing() -> None:
    hands, outline = Hands(), Outline()
    image, arm = image_of_arm(20)
    hands.see(image, arm, outline, BACK)
    tip = image.places(np.array([(ROWS - 18) * COLUMNS + 40]), BACK)[0]
    assert hands.carried(tip, 0.05) is None, "it was not there in the frame before"
    image, arm = image_of_arm(58)
    assert MAX_STEP < 38 * 0.8 / 80
    hands.see(image, arm, outline, BACK)
    assert hands.carried(tip, 1.0) is None, "an end that jumps is another hand's"
    assert not hands.see(image, np.zeros_like(arm), outline, BACK).any()
