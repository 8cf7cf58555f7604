"""Moving cameras: the pose of the camera, things that keep identity and place, and the reference that is carried."""

from functools import cache

import numpy as np
import pytest

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.simulator.cameras.camera import Camera, looking_pose
from deixis.perception.simulator.films.camera_paths import CameraPath, HeadMotion, Walk
from deixis.perception.simulator.films.film import FilmedFrame
from deixis.perception.simulator.films.stage import Move, Rest, film
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.camera.motion import moved_by
from deixis.perception.tracking.frames.image import FrameImage, Optics, table_view
from deixis.perception.tracking.settings import TrackingSettings
from deixis.perception.tracking.situation import Situation
from deixis.perception.tracking.table.reference import Reference
from deixis.perception.tracking.tracker import STRANGE, Tracker

pytest.importorskip("open3d")

PLATE = Placement("plate", "dinner plate", -0.2, 0.05, seed=1)
MUG = Placement("mug", "mug", 0.2, 0.1, seed=2)
WALK = Walk(np.deg2rad(25.0), 2.4, sway=None)


def seen_by(path: CameraPath, *actions: Rest | Move) -> list[tuple[FilmedFrame, Situation]]:
    story = film([PLATE, MUG], actions, path=path)
    with Tracker(TrackingSettings(stride=1)) as tracker:
        return [(frame, tracker.update(frame.cloud, frame.at)) for frame in story.frames(10, scale=0.35)]


@cache
def walked() -> list[tuple[FilmedFrame, Situation]]:
    return seen_by(WALK, Rest(2.4))


def changes_of_frame(story: list[tuple[FilmedFrame, Situation]]) -> np.ndarray:
    """Return how far the tracker's frame of the table is from where it was at the start, (n, 4, 4)."""
    frames = [np.eye(4) if now.frame is None else now.frame for _, now in story]
    poses = np.array([seen.camera.pose @ np.linalg.inv(frame) for (seen, _), frame in zip(story, frames, strict=True)])
    return np.asarray(np.linalg.inv(poses[0]) @ poses)


def test_pose_of_the_camera_is_followed_on_a_walk() -> None:
    apart = changes_of_frame(walked())
    assert np.linalg.norm(apart[:, :3, 3], axis=1).max() < 0.004
    turned = np.arccos(np.clip((np.trace(apart[:, :3, :3], axis1=1, axis2=2) - 1) / 2, -1, 1))
    assert np.degrees(turned).max() < 0.4
    way = [frame.camera.eye for frame, _ in walked()]
    assert np.linalg.norm(way[-1] - way[0]) > 0.1, "the camera moved"


def test_resting_things_stay_under_a_walking_camera() -> None:
    for _, now in walked():
        assert [(thing.id, thing.state, thing.moving) for thing in now.things] == [
            ("t1", "seen", False),
            ("t2", "seen", False),
        ]
        assert not now.notes
    first, last = walked()[0][1], walked()[-1][1]
    for before, after in zip(first.things, last.things, strict=True):
        assert np.linalg.norm(before.centre - after.centre) < 0.003 and after.since == 0.0


def test_moved_thing_is_followed_by_a_swaying_camera() -> None:
    story = seen_by(HeadMotion(seed=2), Rest(0.1), Move("mug", 0.1, -0.05, 0.4), Rest(0.5))
    assert {thing.id for _, now in story for thing in now.things} == {"t1", "t2"}
    frame, now = story[-1]
    assert now.frame is not None
    change = frame.camera.pose @ np.linalg.inv(now.frame)
    mug = next(thing for thing in now.things if thing.id == "t2")
    place = change[:3, :3] @ mug.centre + change[:3, 3]
    assert np.linalg.norm(place - frame.things[1].centre) < 0.02 and not mug.moving and mug.since > 0


def test_jump_of_the_camera_is_noted() -> None:
    frames = [next(film([PLATE, MUG], [Rest(0.1)], camera=camera).frames(scale=0.35)) for camera in jumping()]
    with Tracker(TrackingSettings(stride=1)) as tracker:
        before = tracker.update(frames[0].cloud, 0.0).things
        first, later = (tracker.update(frames[1].cloud, at) for at in (0.1, 0.6))
        assert first.notes == (STRANGE,) and first.busy and not first.went and len(first.things) == len(before)
        assert any("the camera moved" in note for note in later.notes)
        assert [thing.id for thing in later.went] == [thing.id for thing in before]
        assert not {thing.id for thing in later.things} & {thing.id for thing in before}


def test_single_frame_of_another_place_changes_nothing() -> None:
    here, there = (next(film([PLATE, MUG], [Rest(0.1)], camera=camera).frames(scale=0.35)) for camera in jumping())
    with Tracker(TrackingSettings(stride=1)) as tracker:
        seen = [tracker.update(frame.cloud, at) for at, frame in ((0.0, here), (0.5, there), (1.0, here), (1.5, there))]
        assert [now.notes for now in seen] == [(), (STRANGE,), (), (STRANGE,)]
        assert len({tuple(thing.id for thing in now.things) for now in seen}) == 1


def test_nothing_is_concluded_while_a_hand_hides_the_view() -> None:
    frames = [frame for frame, _ in walked()[:12]]
    with Tracker(TrackingSettings(stride=1)) as tracker:
        for frame in frames[:6]:
            before = tracker.update(frame.cloud, frame.at)
        for frame in frames[6:9]:
            assert frame.cloud.organised is not None
            near = PointCloud(
                0.3 * frame.cloud.points, np.zeros_like(frame.cloud.colours), organised=frame.cloud.organised
            )
            hidden = tracker.update(near, frame.at)
            assert hidden.busy and [thing.state for thing in hidden.things] == ["seen", "seen"] and not hidden.went
        for frame in frames[9:]:
            now = tracker.update(frame.cloud, frame.at)
    assert [thing.id for thing in now.things] == [thing.id for thing in before.things] and not now.notes
    for one, other in zip(before.things, now.things, strict=True):
        assert np.linalg.norm(one.centre - other.centre) < 0.003


def jumping() -> list[Camera]:
    eyes = [(0.0, -0.7, 0.7), (0.7, 0.0, 0.9)]
    return [Camera(looking_pose(eye, (0.0, 0.0, 0.0))) for eye in eyes]


@pytest.mark.parametrize("shift", [0.0, 0.004, -0.013])
def test_carried_reference_comes_back(shift: float) -> None:
    rows, columns = 40, 60
    optics = Optics(np.array([[50.0, 0, 29.5], [0, 50.0, 19.5], [0, 0, 1]]), np.zeros(3))
    here = np.diag([1.0, -1.0, -1.0, 1.0])
    here[2, 3] = 1.0  # one metre above the table, looking down
    there = here.copy()
    there[0, 3] += shift
    depth = np.full((rows, columns), 1.0, np.float32)
    depth[10:20, 20:40] = 0.9
    owner = np.where(depth < 1, 1, 0).astype(np.int16)
    image = FrameImage(
        np.zeros((rows, columns, 3), np.float32), depth, np.zeros((rows, columns, 3), np.float32), optics
    )
    one, other = (table_view(optics, pose, (rows, columns)) for pose in (here, there))
    assert moved_by(one, other) == pytest.approx(50 * abs(shift), rel=1e-6)
    reference = Reference(image, owner, 0.0)
    reference.carry(one, other, 0.025)
    reference.carry(other, one, 0.025)
    inner = np.s_[2:-2, 2:-2]
    assert np.allclose(reference.depth[inner], depth[inner], atol=1e-5)
    assert (reference.owner[inner] == owner[inner]).mean() > 0.99
