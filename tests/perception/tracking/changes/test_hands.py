"""Hands that come over the table from outside."""

import numpy as np

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.changes.hands import MAX_STEP, Hands
from deixis.perception.tracking.frames.image import FrameImage, Optics
from deixis.perception.tracking.kernels import NEARER, SAME, UNKNOWN
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.table.outline import Outline
from deixis.perception.tracking.table.reference import Changes
from deixis.perception.tracking.things.pipeline import Pipeline

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


def changes_at(mask: np.ndarray, state: int = NEARER) -> Changes:
    """Return changes whose pixels in a mask are in a state, and the others as in the reference."""
    return Changes(np.where(mask, state, SAME).astype(np.uint8), np.zeros((1, 7), np.int64))


def test_step_of_a_hand_is_that_of_its_end() -> None:
    hands, outline = Hands(), Outline()
    for rows in (20, 25):
        image, arm = image_of_arm(rows)
        assert (hands.see(image, changes_at(arm), outline, BACK) == arm).all()
    ahead = 5 * 0.8 / 80  # five rows at a depth of 0.8 m
    tip = image.places(np.array([(ROWS - 22) * COLUMNS + 40]), BACK)[0]
    step = hands.carried(tip - np.array([0, ahead, 0]), 0.05)
    assert step is not None and np.allclose(step, [0, ahead, 0], atol=0.004)
    assert hands.carried(tip + np.array([0.5, 0, 0]), 0.05) is None, "the thing is out of its reach"


def test_new_hand_carries_nothing() -> None:
    hands, outline = Hands(), Outline()
    image, arm = image_of_arm(20)
    hands.see(image, changes_at(arm), outline, BACK)
    tip = image.places(np.array([(ROWS - 18) * COLUMNS + 40]), BACK)[0]
    assert hands.carried(tip, 0.05) is None, "it was not there in the frame before"
    image, arm = image_of_arm(58)
    assert MAX_STEP < 38 * 0.8 / 80
    hands.see(image, changes_at(arm), outline, BACK)
    assert hands.carried(tip, 1.0) is None, "an end that jumps is another hand's"
    assert not hands.see(image, changes_at(np.zeros_like(arm)), outline, BACK).any()


def test_way_of_a_hand_since_a_time_begins_where_the_thing_was() -> None:
    hands, outline, tips = Hands(), Outline(), []
    for at, rows in enumerate((15, 20, 25, 30)):
        image, arm = image_of_arm(rows)
        hands.see(image, changes_at(arm), outline, BACK, at=float(at))
        tips.append(image.places(np.array([(ROWS - rows + 3) * COLUMNS + 40]), BACK)[0])
    way = hands.moved_since(1.0, tips[1], 0.05)
    assert way is not None and np.allclose(way, [0, 10 * 0.8 / 80, 0], atol=0.004)
    assert hands.moved_since(1.0, tips[1] + np.array([0.5, 0, 0]), 0.05) is None, "it was out of the hand's reach"
    assert hands.moved_since(4.0, tips[1], 0.05) is None, "no hand was seen since"


def test_low_thing_that_comes_into_view_is_not_a_hand() -> None:
    for height, is_hand in ((0.01, False), (0.2, True)):
        image, surface = image_of_arm(20, height)
        assert Hands().see(image, changes_at(surface, UNKNOWN), Outline(), BACK).any() == is_hand
        assert Hands().see(image, changes_at(surface, NEARER), Outline(), BACK).any(), "it is over what is known"


def test_known_thing_that_comes_into_view_is_not_a_hand() -> None:
    image, surface = image_of_arm(20)
    points = image.places(np.flatnonzero(surface), BACK)
    middle, half = (points.min(axis=0) + points.max(axis=0)) / 2, np.ptp(points, axis=0) / 2
    pose = np.eye(4)
    pose[:3, 3] = middle
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, tuple((2 * half).tolist()))
    bottle = Pipeline(
        "t1", 1, PointCloud((points - middle).astype(np.float32)), half, box, pose, 0.0, TrackingSettings()
    )
    assert not Hands().see(image, changes_at(surface, UNKNOWN), Outline(), BACK, [bottle]).any()
    assert Hands().see(image, changes_at(surface, NEARER), Outline(), BACK, [bottle]).any(), "something is before it"


def test_thing_far_from_all_hands_was_not_set_down() -> None:
    hands = Hands()
    image, arm = image_of_arm(20)
    hands.see(image, changes_at(arm), Outline(), BACK, at=2.0)
    hands.see(image, changes_at(np.zeros_like(arm)), Outline(), BACK, at=3.0)
    tip = image.places(np.array([(ROWS - 18) * COLUMNS + 40]), BACK)[0]
    assert hands.were_near(tip, 0.05, since=1.5)
    assert not hands.were_near(tip + np.array([0.3, 0.0, 0.0]), 0.05, since=1.5)
    assert not hands.were_near(tip, 0.05, since=2.5), "the hand had gone"
