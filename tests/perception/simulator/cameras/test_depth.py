"""The depth camera: exact without noise, noisy as in the paper, and with true labels."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from solid_checks import distances

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera, chair_camera, looking_pose
from deixis.perception.simulator.cameras.depth import DISPARITY_STEP, NOISE, DepthSensor, in_table_frame, look, see
from deixis.perception.simulator.laying import LaidTable, Placement, TableTop, lay, truth_scene
from deixis.perception.simulator.meshes.rays import RayCaster
from deixis.perception.simulator.scatter import scattered

BARE = LaidTable(TableTop((-5.0, -5.0), (5.0, 5.0)), ())
IDEAL = DepthSensor.ideal()


def labels_of(cloud: PointCloud) -> NDArray[np.int32]:
    assert cloud.labels is not None
    return cloud.labels


def above(height: float) -> Camera:
    return Camera(looking_pose((0.0, 0.0, height), (0.0, 0.0, 0.0)))


def test_an_ideal_sensor_measures_the_bare_table_exactly() -> None:
    camera = Camera(looking_pose((0.0, -0.5, 0.7), (0.0, 0.0, 0.0)))
    cloud = see(BARE, camera, IDEAL)
    assert cloud.organised == (480, 640)
    assert cloud.finite.all()
    assert np.abs(camera.to_table(cloud.points)[:, 2]).max() < 1e-5
    v, u = np.mgrid[:480, :640]
    assert np.abs(camera.pixels(camera.to_table(cloud.points)) - np.column_stack([u.ravel(), v.ravel()])).max() < 0.01


@pytest.mark.parametrize("z", [0.7, 1.0, 2.0])
def test_noise_has_the_published_standard_deviation(z: float) -> None:
    cloud = see(BARE, above(z), DepthSensor(missing=0.0, grazing=(3.0, 4.0)), seed=1)
    error = cloud.points[:, 2].astype(np.float64) - z
    sigma = 1.425e-3 * z**2
    assert error.std() == pytest.approx(sigma, rel=0.01)
    assert abs(error.mean()) < 5 * sigma / np.sqrt(len(error))
    assert (np.abs(error) < 2 * sigma).mean() == pytest.approx(0.9545, abs=0.003)  # as in a normal distribution


def test_noise_moves_points_along_their_rays() -> None:
    cloud = see(BARE, above(1.0), DepthSensor(noise=5.0), seed=1)
    points = cloud.points[cloud.finite]
    rays = above(1.0).directions()[cloud.finite]
    assert np.abs(points[:, :2] / points[:, 2:] - rays[:, :2]).max() < 1e-5


def test_the_stated_share_of_points_is_missing() -> None:
    cloud = see(BARE, above(1.0), DepthSensor(missing=0.05), seed=2)
    assert 1 - cloud.finite.mean() == pytest.approx(0.05, abs=0.002)
    assert np.array_equal(labels_of(cloud), np.where(cloud.finite, 0, -1))


def test_points_go_missing_at_grazing_angles() -> None:
    camera = Camera(looking_pose((0.0, -1.5, 0.25), (0.0, 0.0, 0.0)))
    cloud = see(BARE, camera, DepthSensor(noise=0.0, missing=0.0), seed=3)
    truth = camera.to_table(see(BARE, camera, IDEAL).points) - camera.eye
    angle = np.rad2deg(np.arccos(-truth[:, 2] / np.linalg.norm(truth, axis=1)))
    assert cloud.finite[angle < 72].all()
    assert not cloud.finite[angle > 88].any()
    assert cloud.finite[(angle > 79.5) & (angle < 80.5)].mean() == pytest.approx(0.5, abs=0.05)


def test_quantised_depths_are_those_of_whole_disparities() -> None:
    cloud = see(BARE, above(1.5), DepthSensor(quantised=True), seed=4)
    z = cloud.points[cloud.finite, 2].astype(np.float64)
    disparity = 1 / (DISPARITY_STEP * z)
    assert np.abs(disparity - np.rint(disparity)).max() < 1e-3
    steps = np.diff(np.unique(np.rint(disparity)))
    assert len(steps) >= 2 and (steps == 1).all()
    assert np.unique(z)[1] - np.unique(z)[0] == pytest.approx(DISPARITY_STEP * 1.5**2, rel=0.02)


@pytest.fixture(scope="module")
def table() -> LaidTable:
    return lay(scattered(8, 1))


def test_labelled_points_are_within_noise_of_their_thing(table: LaidTable) -> None:
    camera = chair_camera(table)
    cloud = see(table, camera, seed=5)
    assert cloud.labels is not None
    points, true = camera.to_table(cloud.points), see(table, camera, IDEAL)
    bound = 5.2 * NOISE * float(np.nanmax(true.points[:, 2])) ** 2 * 1.3  # a ray is longer than its depth
    for label, mesh in enumerate([table.top.mesh, *(thing.mesh for thing in table.things)]):
        mine = points[cloud.labels == label]
        assert distances(mine, mesh).max() < bound
        exact = camera.to_table(true.points[true.labels == label])
        assert len(exact) == 0 or distances(exact, mesh).max() < 5e-5
    assert ((cloud.labels < 0) == ~cloud.finite).all()


def test_a_thing_in_front_hides_the_one_behind() -> None:
    bottle, fork = Placement("bottle", "bottle", 0.0, 0.0), Placement("fork", "fork", 0.0, 0.16, yaw=np.pi / 2)
    low = Camera(looking_pose((0.0, -0.8, 0.15), (0.0, 0.0, 0.1)))
    hidden, free = see(lay([bottle, fork]), low, IDEAL), see(lay([fork]), low, IDEAL)
    assert np.count_nonzero(hidden.labels == 2) < 0.8 * np.count_nonzero(free.labels == 1)


def test_colours_are_those_of_the_things(table: LaidTable) -> None:
    cloud = see(table, chair_camera(table), IDEAL)
    assert cloud.colours is not None
    for label, thing in enumerate(table.things, start=1):
        seen = cloud.colours[cloud.labels == label].astype(float)
        wanted = np.array(thing.colour, dtype=float)
        assert len(seen)
        ratio = seen.mean(axis=0) / wanted
        assert ratio.min() > 0.44 and ratio.max() <= 1.0
        assert np.ptp(ratio) < 0.05  # shaded, and of one tint


def test_the_noise_depends_on_the_seed(table: LaidTable) -> None:
    camera = chair_camera(table)
    one, again, other = (see(table, camera, seed=seed) for seed in (1, 1, 2))
    assert np.array_equal(one.points, again.points, equal_nan=True)
    assert one.colours is not None and again.colours is not None
    assert np.array_equal(one.colours, again.colours)
    assert not np.array_equal(one.points, other.points, equal_nan=True)


def test_a_cloud_in_the_frame_of_the_table(table: LaidTable) -> None:
    camera = chair_camera(table)
    cloud = in_table_frame(see(table, camera, IDEAL), camera)
    assert cloud.origin == pytest.approx(tuple(camera.eye))
    assert np.abs(cloud.points[cloud.labels == 0, 2]).max() < 0.0301
    top = see(table, camera, IDEAL)
    assert cloud.organised == top.organised
    for label, thing in enumerate(truth_scene(table).objects, start=1):
        mine = cloud.points[cloud.labels == label]
        assert (mine >= np.array(thing.minimum) - 1e-5).all() and (mine <= np.array(thing.maximum) + 1e-5).all()
        assert (thing.id, thing.label) == (f"o{label}", table.things[label - 1].name)


def test_an_image_of_nothing_has_no_points() -> None:
    up = Camera(looking_pose((0.0, 0.0, 1.0), (0.0, 0.0, 2.0)))
    found = look(RayCaster([BARE.top.mesh]), up, DepthSensor(), np.random.default_rng(0))
    assert not np.isfinite(found.points).any()
    assert (found.mesh == -1).all()


def test_impossible_sensors_are_an_error() -> None:
    for name, value in (
        ("noise", -1.0),
        ("noise", np.nan),
        ("missing", 1.5),
        ("missing", np.nan),
        ("colour_noise", 300),
    ):
        setting: dict[str, Any] = {name: value}
        with pytest.raises(SimulationError, match=f"^`{name}` must be from 0 to .*, got {value:g}$"):
            DepthSensor(**setting)
    with pytest.raises(SimulationError, match="grazing"):
        DepthSensor(grazing=(1.0, 0.5))
