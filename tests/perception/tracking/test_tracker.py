"""Tracker: identity and place of things that are hidden, moved, taken away and brought."""

import gc
import weakref
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from first_looks import HALF, MUG, PLATE, cut_rim

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.detection.detect import detect
from deixis.perception.errors import CloudError
from deixis.perception.simulator.films.film import FilmedFrame
from deixis.perception.simulator.films.stage import Action, Bring, Move, PassOver, Rest, TakeAway, film
from deixis.perception.simulator.laying import Placement
from deixis.perception.tracking.frames.image import optics_of
from deixis.perception.tracking.looks import whole
from deixis.perception.tracking.situation import Situation
from deixis.perception.tracking.tracker import Tracker

pytest.importorskip("open3d")

BOWL = Placement("bowl", "bowl", 0.2, -0.2, seed=4)


def followed(actions: Sequence[Action], rate: float = 10.0) -> list[tuple[FilmedFrame, Situation]]:
    story = film([PLATE, MUG], [Rest(0.2), *actions, Rest(1.0)])
    with Tracker(HALF) as tracker:
        return [(frame, tracker.update(frame.cloud, frame.at)) for frame in story.frames(rate, scale=0.4)]


@cache
def moved_mug() -> list[tuple[FilmedFrame, Situation]]:
    return followed([Move("mug", 0.1, -0.15, 0.6)])


def centres(now: Situation, frame: FilmedFrame) -> dict[str, np.ndarray]:
    """Return the middles of the tracked things in the simulator's frame of the table."""
    assert now.frame is not None
    change = frame.camera.pose @ np.linalg.inv(now.frame)
    return {thing.id: change[:3, :3] @ thing.centre + change[:3, 3] for thing in now.things}


def test_moved_thing_keeps_its_id_and_is_followed() -> None:
    offsets = []
    for frame, now in moved_mug():
        found = centres(now, frame)
        assert sorted(found) == ["t1", "t2"]
        mug = next(thing for thing in frame.things if thing.name == "mug")
        offsets.append(found["t2"] - mug.centre)
    held = [frame.things[1].held for frame, _ in moved_mug()]
    errors = np.linalg.norm(np.array(offsets) - offsets[0], axis=1)
    turned = 2 * np.sin(0.3) * np.linalg.norm(offsets[0])  # the mug's middle is not known exactly
    assert np.median(errors[held]) < 0.006 + turned and errors[-1] < 0.006 + turned
    _, now = moved_mug()[-1]
    assert not now.things[1].moving and now.things[1].since > 1.0 > now.things[0].since


@pytest.mark.parametrize("rate", [2.0, 5.0])
def test_moved_thing_rests_at_low_frame_rates(rate: float) -> None:
    story = film([PLATE, MUG], [Rest(0.5), Move("mug", 0.1, -0.15), Rest(3.0)])
    with Tracker(HALF) as tracker:
        for frame in story.frames(rate, scale=0.4):
            now = tracker.update(frame.cloud, frame.at)
    assert [thing.moving for thing in now.things] == [False, False]
    assert now.things[1].since > 1.0


def test_hidden_thing_is_known_for_two_seconds() -> None:
    story = followed([PassOver(0.12, 0.2)], rate=5)
    states = [{thing.id: thing.state for thing in now.things} for _, now in story]
    assert all(set(state) == {"t1", "t2"} for state in states)
    assert sum(state["t2"] == "hidden" for state in states) >= 8
    assert states[-1] == {"t1": "seen", "t2": "seen"} and not story[-1][1].things[1].since


def test_taken_thing_is_gone_and_brought_thing_is_new() -> None:
    story: list[tuple[FilmedFrame, Situation]] = []
    table = film([PLATE, MUG], [Rest(0.2), TakeAway("mug"), Rest(0.8), Bring(BOWL), Rest(0.8)])
    with Tracker(HALF) as tracker:
        story += [(frame, tracker.update(frame.cloud, frame.at)) for frame in table.frames(10, scale=0.4)]
        assert [thing.slot for thing in tracker._things] == [1, 2], "the pixels of the mug are free again"
    went = [(now.at, thing) for _, now in story for thing in now.went]
    came = [(now.at, name) for _, now in story for name in now.came]
    assert [thing.id for _, thing in went] == ["t2"] and went[0][1].state == "gone"
    assert went[0][1].seen_at < went[0][0] < came[-1][0]
    assert [name for _, name in came] == ["t1", "t2", "t3"]
    frame, now = story[-1]
    bowl = next(thing for thing in frame.things if thing.name == "bowl")
    assert np.linalg.norm(centres(now, frame)["t3"] - bowl.centre) < 0.02
    assert sorted(thing.id for thing in now.scene().objects) == ["t1", "t3"]


def test_bad_frames_are_named_and_change_nothing() -> None:
    frames = [frame for frame, _ in moved_mug()[:2]]
    good = frames[0].cloud
    with Tracker(HALF) as tracker:
        before = tracker.update(good, 1.0)
        empty = PointCloud(np.full_like(good.points, np.nan), good.colours, organised=good.organised)
        wrong = {
            "backwards": (good, 0.5),
            "finite|number": (good, np.nan),
            "empty": (empty, 1.1),
            "not an image": (replace(good, organised=None), 1.2),
            "size": (next(film([MUG], [Rest(0.1)]).frames(scale=0.25)).cloud, 1.3),
        }
        for words, (cloud, at) in wrong.items():
            now = tracker.update(cloud, at)
            assert len(now.notes) == 1 and any(word in now.notes[0] for word in words.split("|")), words
            assert [thing.id for thing in now.things] == [thing.id for thing in before.things]
        assert not tracker.update(frames[1].cloud, 1.4).notes


def test_cloud_without_a_table_is_reported_until_one_comes() -> None:
    cloud = moved_mug()[0][0].cloud
    assert cloud.organised is not None
    assert cloud.labels is not None
    plate_only = replace(cloud, points=np.where(cloud.labels[:, None] == 1, cloud.points, np.float32(np.nan)))
    with Tracker(HALF) as tracker:
        assert len(tracker.update(plate_only, 0.0).notes) == 1
        now = tracker.update(cloud, 0.1)
        assert [thing.id for thing in now.things] == ["t1", "t2"] and not now.notes


def test_table_laid_again_between_two_frames_is_detected_again() -> None:
    actions = (TakeAway("plate"), TakeAway("mug"), Bring(replace(PLATE, name="other", x=0.1)), Bring(BOWL))
    story = film([PLATE, MUG], [Rest(0.2), *actions, Rest(0.2)])
    first, second = story.frames(1 / story.seconds, scale=0.4)
    with Tracker(HALF) as tracker:
        tracker.update(first.cloud, 0.0)
        now = tracker.update(second.cloud, second.at)
        assert [thing.id for thing in now.went] == ["t1", "t2"] and all(each.state == "gone" for each in now.went)
        assert now.came == ("t3", "t4") == tuple(thing.id for thing in now.things)
        assert "looked at again" in now.notes[0]
        assert all(thing.state == "seen" for thing in tracker.update(second.cloud, second.at + 0.2).things)


def test_whole_look_merges_the_piece_of_a_thing() -> None:
    frame = next(iter(film([PLATE, MUG], [Rest(0.2)]).frames(5, scale=0.4)))
    found, cut = detect(frame.cloud), cut_rim(frame)
    with Tracker(HALF) as tracker:
        tracker.update(frame.cloud, 0.0)
        now, ids = tracker.look_again(cut.scene())
        assert [thing.id for thing in now.things] == ["t1", "t2", "t3"] and now.came == ("t3",)
        assert ids == {"o1": "t1", "o2": "t2", "o3": "t3"}
        now, ids = tracker.look_again(found.scene())
        assert [thing.id for thing in now.things] == ["t1", "t2"]
        assert [thing.id for thing in now.merged] == ["t3"]
        assert set(np.unique(tracker.owners())) == {-1, 0, 1}
        with pytest.raises(CloudError, match="perceived in the cloud of the last frame"):
            tracker.look_again(now.scene())


def test_work_grows_with_what_moves_and_ends_with_it() -> None:
    moving = [sum(thing.moving for thing in now.things) for _, now in moved_mug()]
    assert max(moving) == 1  # the plate rests, which costs nothing
    with Tracker(HALF) as tracker:
        needed: list[int] = []
        ever: list[weakref.ref[Any]] = []
        for frame in film([PLATE, MUG], [Rest(0.2), TakeAway("mug"), Rest(1.0)]).frames(3, scale=0.4):
            tracker.update(frame.cloud, frame.at)
            needed.append(tracker.particles)
            ever += [weakref.ref(thing) for thing in tracker._things]
        assert needed[0] == 0 < max(needed) and needed[-1] == 0
        gc.collect()
        kept = {each() for each in ever} - {None}
        assert kept == set(tracker._things), "the pipeline of the mug is freed with its memory"
        assert [thing.id for thing in tracker._things] == ["t1"]
        assert np.unique(tracker.owners()).tolist() == [-1, 0]


def test_image_of_a_single_place_has_no_optics() -> None:
    assert optics_of(PointCloud(np.tile(np.array([0, 0, 1], np.float32), (768, 1)), organised=(24, 32))) is None


MANY = [Placement(f"mug_{k}", "mug", 0.25 * (k % 4) - 0.375, 0.3 * (k // 4) - 0.15, seed=2) for k in range(8)]
"""Things of which the inner four can be missing without a change of the table or the camera."""


@cache
def table_without(count: int) -> PointCloud:
    inner = [MANY[k] for k in (1, 2, 5, 6)]
    kept = [thing for thing in MANY if thing not in inner[:count]]
    camera = film(MANY, [Rest(0.1)]).camera
    return next(iter(film(kept, [Rest(0.1)], camera=camera).frames(scale=0.35))).cloud


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_work_is_linear_in_what_left_and_ends_with_each(count: int) -> None:
    with Tracker(HALF) as tracker:
        assert len(tracker.update(table_without(0), 0.0).things) == len(MANY)
        names, ever = {thing.id for thing in tracker._things}, [weakref.ref(thing) for thing in tracker._things]
        tracker.update(table_without(count), 0.2)
        each = [thing.particles for thing in tracker._things if thing.active]
        assert len(each) == count and tracker.particles == sum(each)
        assert all(150 <= particles <= 1200 for particles in each), "the work for each does not depend on the others"
        went = list[str]()
        for at in (0.6, 1.1):
            went += [thing.id for thing in tracker.update(table_without(count), at).went]
            ever += [weakref.ref(thing) for thing in tracker._things]
        assert len(went) == count and tracker.particles == 0
        gc.collect()
        assert {thing for each in ever if (thing := each()) is not None} == set(tracker._things)
        assert {thing.id for thing in tracker._things} == names - set(went)
        assert len(np.unique(tracker.owners())) == 1 + len(MANY) - count, "their pixels are free"


def test_thing_hidden_in_a_hand_moves_with_it() -> None:
    cup = Placement("cup", "espresso cup", 0.15, 0.1, seed=3)
    story = film([PLATE, cup], [Rest(0.3), Move("cup", 0.1, -0.2), Rest(0.6)])
    with Tracker(HALF) as tracker:
        seen = [(frame, tracker.update(frame.cloud, frame.at)) for frame in story.frames(10, scale=0.4)]
    away = [float(np.linalg.norm(centres(now, frame)["t2"] - frame.things[1].centre)) for frame, now in seen]
    hidden = [frame.things[1].held and now.things[1].state == "hidden" for frame, now in seen]
    assert sum(hidden) >= 4, "the hand hides the cup on its way"
    assert np.array(away)[hidden].max() < 0.04 and away[-1] < 0.02


def test_things_far_from_a_hand_in_view_are_completed() -> None:
    far = Placement("mug", "mug", -0.45, 0.1, seed=2)
    near = Placement("plate", "dinner plate", 0.45, 0.1, seed=1)
    story = film([far, near], [PassOver(0.45, 0.1, seconds=2.0)], arm=np.pi / 2)
    done = dict[str, bool]()
    with Tracker(replace(HALF, complete_after=1.5)) as tracker:
        for frame in story.frames(5, scale=0.4):
            now = tracker.update(frame.cloud, frame.at)
            if now.busy:
                places = centres(now, frame)
                done = {"mug" if places[thing.id][0] < 0 else "plate": thing.completed for thing in tracker._things}
    assert done == {"mug": True, "plate": False}, "the hand is over the plate"


def test_pieces_of_the_first_look_are_joined_by_a_closer_one(monkeypatch: pytest.MonkeyPatch) -> None:
    frames = list(film([PLATE, MUG], [Rest(0.8)]).frames(10, scale=0.4))
    with Tracker(HALF) as tracker:
        monkeypatch.setattr(whole, "detect", lambda *_: cut_rim(frames[0]))
        assert len(tracker.update(frames[0].cloud, 0.0).things) == 3
        later = [tracker.update(frame.cloud, frame.at) for frame in frames[1:]]
        assert [thing.id for thing in later[-1].things] == ["t1", "t2"]
        assert [thing.id for now in later for thing in now.merged] == ["t3"]
        away = centres(later[-1], frames[-1])["t1"] - frames[-1].things[0].centre
        assert np.linalg.norm(away) < 0.01
