"""The stage: where things truly are while a hand moves them."""

import numpy as np
import pytest

from deixis.perception.errors import SimulationError
from deixis.perception.simulator.films.film import Film
from deixis.perception.simulator.films.stage import Bring, Move, Rest, TakeAway, film, laying_film
from deixis.perception.simulator.laying import Placement, lay

PLATE = Placement("plate", "dinner plate", 0.0, 0.0, seed=1)
MUG = Placement("mug", "mug", 0.3, 0.1, seed=2)
FORK = Placement("fork", "dinner fork", 0.0, 0.0, 0.4, seed=3)


def seconds(story: Film, count: int = 200) -> np.ndarray:
    return np.linspace(0, story.seconds, count)


def test_resting_thing_keeps_its_pose() -> None:
    story = film([PLATE, MUG], [Rest(0.3), Move("mug", -0.3, 0.0, 1.0), Rest(0.3)])
    poses = [story.poses(at)["plate"] for at in seconds(story)]
    assert all(np.array_equal(pose, poses[0][0]) and not held for pose, held in poses)


def test_moved_thing_ends_at_its_new_place() -> None:
    story = film([PLATE, MUG], [Move("mug", -0.3, 0.05, 1.0)])
    before, after = story.poses(0.0)["mug"][0], story.poses(story.seconds)["mug"][0]
    turn = after[:3, :3] @ before[:3, :3].T
    assert after[:2, 3] == pytest.approx([-0.3, 0.05])
    assert np.arctan2(turn[1, 0], turn[0, 0]) == pytest.approx(1.0)
    assert after[2, 3] == pytest.approx(before[2, 3], abs=1e-6)


def test_thing_never_jumps_while_it_is_carried() -> None:
    story = film([PLATE, MUG], [Rest(0.2), Move("mug", -0.3, 0.05, 1.0), Rest(0.2)])
    times = seconds(story, 1000)
    places = np.array([story.poses(at)["mug"][0][:3, 3] for at in times])
    assert np.linalg.norm(np.diff(places, axis=0), axis=1).max() < 1.5 * np.diff(times)[0]
    assert any(story.poses(at)["mug"][1] for at in times)
    assert max(places[:, 2]) > places[0, 2] + 0.05


def test_carried_thing_takes_its_load_along() -> None:
    story = film([PLATE, FORK, MUG], [Move("plate", -0.2, 0.1)])
    before, after = story.poses(0.0), story.poses(story.seconds)
    first, last = (np.linalg.inv(poses["plate"][0]) @ poses["fork"][0] for poses in (before, after))
    assert np.allclose(first, last, atol=1e-9)
    assert np.array_equal(before["mug"][0], after["mug"][0])


def test_thing_set_down_on_another_rests_on_it() -> None:
    story = film([PLATE, MUG], [Move("mug", 0.0, 0.0)])
    plate, mug = (thing.mesh for thing in story.things)
    poses = story.poses(story.seconds)
    bottom = (mug.vertices @ poses["mug"][0][:3, :3].T + poses["mug"][0][:3, 3])[:, 2].min()
    assert 0.001 < bottom < np.ptp(plate.vertices[:, 2]) + 0.001


def test_taken_thing_goes_and_brought_thing_comes() -> None:
    story = film([PLATE, MUG], [TakeAway("mug"), Bring(FORK), Rest(0.1)])
    assert set(story.poses(0.0)) == {"plate", "mug"}
    assert set(story.poses(story.seconds)) == {"plate", "fork"}


def test_laying_film_ends_with_the_laid_table() -> None:
    table = lay([PLATE, FORK, MUG])
    story = laying_film(table, seed=1)
    for thing in table.things:
        middle = (thing.mesh.vertices.min(axis=0) + thing.mesh.vertices.max(axis=0)) / 2
        assert story.poses(story.seconds)[thing.name][0][:3, 3] == pytest.approx(middle)


@pytest.mark.parametrize(
    "action", [Move("jug", 0.0, 0.0), TakeAway("jug"), Bring(MUG), Move("mug", np.nan, 0.0), Rest(-1.0)]
)
def test_impossible_action_is_refused(action: Move | TakeAway | Bring | Rest) -> None:
    with pytest.raises(SimulationError, match=r"at 0\.0 s|placed twice"):
        film([MUG], [action])
