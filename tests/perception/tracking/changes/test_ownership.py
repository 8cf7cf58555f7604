"""Pixels that may show several things."""

import numpy as np
import pytest
from first_looks import HALF, PLATE, first_look

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.tracking.changes.ownership import things_around
from deixis.perception.tracking.things.model import Model

pytest.importorskip("open3d")


def test_pixels_in_two_boxes_are_those_of_the_thing_that_agrees() -> None:
    look = first_look([PLATE])
    image, plate = look.image, next(iter(look.things))
    pixels = np.flatnonzero(look.table.reference.owner == 1)
    points = image.places(pixels, look.view.back)
    shown = np.abs(points[:, 0] - plate.pose[0, 3]) < 0.01  # a blue knife across the plate
    image.colour.reshape(-1, 3)[pixels[shown]] = 40, 60, 160
    pose = np.eye(4)
    pose[:3, 3] = points[shown].mean(axis=0)
    own = (points[shown] - pose[:3, 3]).astype(np.float32)
    cloud = PointCloud(own, np.full((shown.sum(), 3), (40, 60, 160), np.uint8))
    box = OrientedBox((0.0, 0.0, 0.0), np.pi / 2, (0.26, 0.1, 0.06))  # wider than the knife
    look.things.enter(Model(cloud, np.array([0.05, 0.13, 0.03]), box, pose), 0.0)
    things, of = things_around(image, pixels, points, 0.0, look.things, HALF)
    knife = np.array([thing.id for thing in things])[of] == "t2"
    assert knife[shown].mean() > 0.95 and knife[~shown].mean() < 0.05
