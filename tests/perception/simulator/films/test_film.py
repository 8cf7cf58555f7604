"""Films: what the camera sees of things that move, and the truth about it."""

from itertools import islice

import numpy as np

from deixis.perception.simulator.films.camera_paths import HeadMotion
from deixis.perception.simulator.films.stage import Move, PassOver, Rest, film
from deixis.perception.simulator.films.stories import random_film
from deixis.perception.simulator.laying import Placement

PLATE = Placement("plate", "dinner plate", 0.0, 0.0, seed=1)
MUG = Placement("mug", "mug", 0.3, 0.1, seed=2)


def test_passing_hand_hides_a_thing_for_two_seconds() -> None:
    story = film([PLATE, MUG], [Rest(0.2), PassOver(0.25, 0.2), Rest(0.2)])
    frames = list(story.frames(5, scale=0.3))
    shown = [frame.things[1].points for frame in frames]
    hidden = [points < 0.5 * shown[0] for points in shown]
    assert sum(hidden) >= 9 and not any(frame.things[1].held for frame in frames)
    assert shown[-1] > 0.9 * shown[0]


def test_equal_seeds_give_equal_clouds() -> None:
    stories = [random_film(3, 2, seed=4) for _ in range(2)]
    one, other = (list(islice(story.frames(2, seed=5, scale=0.25), 8)) for story in stories)
    assert all(np.array_equal(a.cloud.points, b.cloud.points, equal_nan=True) for a, b in zip(one, other, strict=True))
    again = next(stories[0].frames(2, seed=6, scale=0.25))
    assert not np.array_equal(again.cloud.points, one[0].cloud.points, equal_nan=True)


def test_true_box_holds_the_points_of_its_thing() -> None:
    story = film([PLATE, MUG], [Move("mug", -0.3, 0.05, 1.0)], path=HeadMotion(seed=2))
    for frame in islice(story.frames(3, scale=0.3), 3, 9):
        cloud = frame.cloud
        assert cloud.labels is not None
        for thing in frame.things:
            points = frame.camera.to_table(cloud.points[cloud.labels == thing.label].astype(float))
            assert (points >= thing.box[0] - 0.02).all() and (points <= thing.box[1] + 0.02).all()
