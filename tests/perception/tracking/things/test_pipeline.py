"""Pipelines of things: their poses at rest."""

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox, turned_axes
from deixis.perception.tracking.frames.image import FrameImage, Optics, table_view
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.things.pipeline import Pipeline

SHAPE = 120, 160
OPTICS = Optics(np.array([[200.0, 0, 79.5], [0, 200.0, 59.5], [0, 0, 1]]), np.zeros(3))
BACK = np.diag([1.0, -1.0, -1.0, 1.0])
BACK[2, 3] = 1.0  # the camera is one metre above the table and looks down: a pixel is 5 mm
WOOD, RED = (140, 105, 73), (130, 40, 50)
NAPKIN = np.s_[40:80, 50:110]


def flat_thing() -> Pipeline:
    """Return a red thing of 10 cm by 10 cm by 1 cm."""
    points = np.random.default_rng(1).uniform(-0.05, 0.05, (2000, 3)) * (1, 1, 0.1)
    cloud = PointCloud(points.astype(np.float32), np.tile(np.array(RED, np.uint8), (len(points), 1)))
    pose = np.eye(4)
    pose[:3, 3] = 0.3, 0.2, 0.005
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.1, 0.1, 0.01))
    return Pipeline("t1", 1, cloud, np.array([0.05, 0.05, 0.005]), box, pose, 0.0, TrackingSettings())


def test_pose_at_rest_is_that_of_all_pixels_of_the_thing() -> None:
    depth = np.ones(SHAPE, np.float32)
    depth[NAPKIN] = 0.99
    colour = np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    colour[NAPKIN] = RED
    rows, columns = np.indices(SHAPE)
    rays = np.stack([(columns - 79.5) / 200, (rows - 59.5) / 200, np.ones(SHAPE)], axis=-1)
    image = FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, OPTICS)
    own = image.places(np.flatnonzero(depth < 1), BACK)
    middle = (own.min(axis=0) + own.max(axis=0)) / 2
    sides = np.append(np.ptp(own, axis=0)[:2], 0.01)
    pose = np.eye(4)
    pose[:3, 3] = middle + np.array([0.012, -0.015, 0.0])
    cloud = PointCloud((own - middle).astype(np.float32), np.tile(np.array(RED, np.uint8), (len(own), 1)))
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, tuple(sides.tolist()))
    napkin = Pipeline("t1", 1, cloud, sides / 2, box, pose, 0.0, TrackingSettings())
    hidden = rows > 70  # one of its edges
    depth[hidden] = 0.5
    seen = image.places(np.flatnonzero((colour == RED).all(axis=-1) & ~hidden), BACK)
    napkin.align(image, table_view(OPTICS, BACK, SHAPE), depth == 1.0, seen, 0.0015)
    assert napkin.pose[:2, 3] == pytest.approx(middle[:2], abs=0.004)
    assert napkin.last_rest is napkin.pose


def test_rectangle_whose_box_fits_across_is_turned() -> None:
    depth, colour = np.ones(SHAPE, np.float32), np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    depth[NAPKIN], colour[NAPKIN] = 0.99, RED
    rows, columns = np.indices(SHAPE)
    rays = np.stack([(columns - 79.5) / 200, (rows - 59.5) / 200, np.ones(SHAPE)], axis=-1)
    image = FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, OPTICS)
    seen = image.places(np.flatnonzero(depth < 1), BACK)
    middle = (seen.min(axis=0) + seen.max(axis=0)) / 2
    sides = np.append(np.ptp(seen, axis=0)[[1, 0]], 0.01)  # 20 cm by 30 cm; the frame shows 30 cm by 20 cm
    across = turned_axes(np.pi / 2).T
    cloud = PointCloud(((seen - middle) @ across).astype(np.float32), np.tile(np.array(RED, np.uint8), (len(seen), 1)))
    pose = np.eye(4)
    pose[:3, 3] = middle + np.array([0.02, 0.01, 0.0])
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, tuple(sides.tolist()))
    napkin = Pipeline("t1", 1, cloud, sides / 2, box, pose, 0.0, TrackingSettings())
    napkin.align(image, table_view(OPTICS, BACK, SHAPE), np.zeros(SHAPE, np.bool_), seen, 0.0015)
    assert napkin.pose[:2, 3] == pytest.approx(middle[:2], abs=0.004)
    assert abs(napkin.pose[0, 0]) < 0.05 and napkin.contains(seen, 0.005).all()


def mug_and_image(handle: float) -> tuple[Pipeline, FrameImage, np.ndarray]:
    """Return a mug with a handle along x, a frame in which it has another direction, and the points of the frame."""
    rng = np.random.default_rng(2)
    angle, z = rng.uniform(0, 2 * np.pi, 6000), rng.uniform(0.0, 0.1, 6000)
    body = np.column_stack([0.04 * np.cos(angle), 0.04 * np.sin(angle), z])
    ear = rng.uniform((0.04, -0.006, 0.02), (0.075, 0.006, 0.09), (600, 3))
    both = np.concatenate([body, ear])
    pose = np.eye(4)
    pose[:3, 3] = 0.0175, 0.0, 0.05
    cloud = PointCloud((both - pose[:3, 3]).astype(np.float32), np.tile(np.array(RED, np.uint8), (len(both), 1)))
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.115, 0.08, 0.1))
    mug = Pipeline("t1", 1, cloud, np.array([0.0575, 0.04, 0.05]), box, pose, 0.0, TrackingSettings())
    seen = np.concatenate([body, ear @ turned_axes(handle)]) + np.array([0.004, -0.003, 0.0])
    optics = Optics(np.array([[500.0, 0, 79.5], [0, 500.0, 59.5], [0, 0, 1]]), np.zeros(3))
    depth, colour = np.ones(SHAPE, np.float32), np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    view = table_view(optics, BACK, SHAPE)
    order = np.argsort(seen[:, 2])
    pixels, away = view.pixels(seen[order])
    depth.ravel()[pixels], colour.reshape(-1, 3)[pixels] = away, RED
    rows, columns = np.indices(SHAPE)
    rays = np.stack([(columns - 79.5) / 500, (rows - 59.5) / 500, np.ones(SHAPE)], axis=-1)
    return mug, FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, optics), seen


@pytest.mark.parametrize("handle", [1.2, -2.5])
def test_mug_at_rest_is_turned_to_its_handle(handle: float) -> None:
    mug, image, seen = mug_and_image(handle)
    mug.align(image, table_view(image.optics, BACK, SHAPE), np.zeros(SHAPE, np.bool_), seen, 0.0015)
    middle = np.array([0.0175, 0.0]) @ turned_axes(handle)[:2, :2] + (0.004, -0.003)
    assert mug.pose[:2, 3] == pytest.approx(middle, abs=0.008)
    assert np.arctan2(mug.pose[1, 0], mug.pose[0, 0]) == pytest.approx(handle, abs=0.3)


@pytest.mark.parametrize(("degrees", "is_flat"), [(8.0, True), (60.0, False)])
def test_thing_that_seems_tilted_at_rest_lies_flat(degrees: float, is_flat: bool) -> None:
    napkin = flat_thing()
    depth, colour = np.ones(SHAPE, np.float32), np.broadcast_to(WOOD, (*SHAPE, 3)).astype(np.float32)
    view = table_view(OPTICS, BACK, SHAPE)
    pixels, away = view.pixels(napkin.placed_points)
    depth.ravel()[pixels], colour.reshape(-1, 3)[pixels] = away, RED
    rows, columns = np.indices(SHAPE)
    rays = np.stack([(columns - 79.5) / 200, (rows - 59.5) / 200, np.ones(SHAPE)], axis=-1)
    image = FrameImage((rays * depth[..., None]).astype(np.float32), depth, colour, OPTICS)
    tilted, angle = napkin.pose.copy(), np.deg2rad(degrees)
    tilted[1:3, 1:3] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    napkin.pose = tilted
    napkin.align(image, view, np.zeros(SHAPE, np.bool_), image.places(pixels, BACK), 0.0015)
    assert (napkin.pose[2, 2] == pytest.approx(1.0)) == is_flat


def test_unlikeness_grows_with_the_distance_and_with_the_hue() -> None:
    napkin = flat_thing()
    pose = napkin.pose
    places = pose[:3, 3] + np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.055, 0.0, 0.0), (0.07, 0.0, 0.0)])
    own, other, beside, away = napkin.unlikeness(places, np.array([RED, WOOD, RED, RED], np.float64))
    assert own < 0.5 and own < beside < away and away > 6
    assert own + 1 < other < away, "a part may have another colour"


def test_parts_are_confirmed_by_a_second_view() -> None:
    napkin, end = flat_thing(), np.array([(0.36, 0.2, 0.005), (0.37, 0.2, 0.005)])
    assert not napkin.is_suspected and not napkin.confirms(end).any() and napkin.is_suspected
    assert not napkin.confirms(end + np.array([0.0, 0.05, 0.0])).any(), "the second view shows something else"
    assert napkin.confirms(end + np.array([0.0, 0.002, 0.0])).all() and not napkin.is_suspected


@pytest.mark.parametrize(("speed", "leaves"), [(0.0, False), (0.5, True), (-0.5, False)])
def test_thing_leaves_the_image_where_its_movement_leads_it(speed: float, leaves: bool) -> None:
    napkin = flat_thing()
    napkin._velocity = np.array([speed, 0.0, 0.0])
    assert napkin.is_leaving(table_view(OPTICS, BACK, SHAPE), 0.2) == leaves, "the image ends 5 cm to the right"


def test_merged_thing_keeps_the_name_it_was_longest_known_by() -> None:
    options = TrackingSettings().detection.outlines
    end = flat_thing().pose[:3, 3] + np.random.default_rng(2).uniform((0.05, -0.05, 0), (0.15, 0.05, 0.005), (500, 3))
    tints = np.tile(RED, (500, 1)).astype(np.float32)
    for away, at, name in ((0.05, 0.0, "t2"), (0.15, 0.0, "t1"), (0.05, 3.0, "t2"), (0.15, -3.0, "t2")):
        whole, part = flat_thing(), flat_thing()
        part.id, part.at, part._middles = "t2", at, [(at, whole.pose[:3, 3] + np.array([away, 0.0, 0.0]))]
        whole.seen_at = 5.0
        whole.extend(end, tints, options)  # its middle moves by 5 cm
        whole.take_name([part], 5.0)
        assert {whole.id, part.id} == {"t1", "t2"} and whole.id == name
        assert whole.at == (at if name == "t2" else 0.0)


def test_thing_rides_on_what_carries_it() -> None:
    plate = flat_thing()
    points = (plate.cloud.points * np.array([0.8, 0.2, 1.0])).astype(np.float32)
    pose = plate.pose.copy()
    pose[:3, 3] += 0.01, 0.02, 0.03
    box = OrientedBox((0.0, 0.0, 0.0), 0.0, (0.08, 0.02, 0.01))
    knife = Pipeline("t2", 2, PointCloud(points), np.array([0.04, 0.01, 0.005]), box, pose, 0.0, TrackingSettings())
    assert knife.lies_on(plate) and not plate.lies_on(knife), "only the smaller thing lies on the other one"
    assert not knife.is_carried_off(0.01), "nothing carries it yet"
    knife.load_onto(plate)
    assert knife.carrier is plate and not knife.is_carried_off(0.01)
    plate.pose = np.array([[0.0, -1, 0, 0.1], [1, 0, 0, 0.1], [0, 0, 1, 0.2], [0, 0, 0, 1]])
    assert knife.is_carried_off(0.01)
    knife.ride()
    assert knife.pose[:3, 3] == pytest.approx([0.1 - 0.02, 0.1 + 0.01, 0.23])
    assert knife.pose[:3, :3] == pytest.approx(plate.pose[:3, :3])
    plate.lost()
    assert not knife.is_carried_off(0.01), "it is not known where the plate is"
    knife.pose = knife.pose.copy()
    knife.pose[0, 3] += 0.2
    plate.pose = np.eye(4)
    assert not knife.lies_on(plate), "it is beside the plate"
