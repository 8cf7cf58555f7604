"""Run the robot on a recorded folder of clouds and skeletons: it records who did what, from the hands alone."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deixis.memory.episodes.blackboard import Blackboard
from deixis.memory.episodes.fluents.episode import Origin
from deixis.memory.episodes.predicates import ACTS, AT, MOVED, POINTED_AT, TOOK
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.simulator.cameras.camera import chair_camera
from deixis.perception.simulator.films.film import Film
from deixis.perception.simulator.films.stage import Action, Move, Rest, Stage, TakeAway
from deixis.perception.simulator.laying import LaidTable, Placement, lay, top_under
from deixis.perception.tracking.frames.stream import recording
from deixis.reasoning.temporal.fluent import Pattern
from deixis.robot.live.run import live_robot
from deixis.robot.live.story import PEOPLE, StorySettings
from deixis.session import Session

pytest.importorskip("open3d")

THINGS = {"plate": (0.0, 0.0), "mug": (0.28, 0.25), "bowl": (-0.28, 0.3)}
ACTS_DONE: tuple[tuple[str | None, Action, float], ...] = (
    ("Ada", Move("mug", 0.28, -0.05), 0.0),
    ("Ben", TakeAway("bowl"), np.pi / 2),
    (None, Move("mug", -0.28, 0.0), 0.0),  # the sensor did not see this person
)
RATE, PAUSE, SCALE = 5.0, 2.0, 0.5


def filmed() -> tuple[Film, list[tuple[str | None, float, float]]]:
    """Return the film, and who acts from when to when."""
    laid = lay([Placement(name, name, x, y, seed=k) for k, (name, (x, y)) in enumerate(THINGS.items())], None, None)
    stage, when = Stage(laid.things, 1), list[tuple[str | None, float, float]]()
    stage.carry_out(Rest(PAUSE))
    for person, action, arm in ACTS_DONE:
        began = stage.at
        stage.carry_out(action, arm)
        when.append((person, began, stage.at))
        stage.carry_out(Rest(PAUSE))
    top = top_under(laid.things)
    return stage.film(top, chair_camera(LaidTable(top, laid.things))), when


def write_recording(folder: Path) -> None:
    """Write the clouds, and the skeletons of two persons in the camera's frame."""
    film, when = filmed()
    for _ in recording(film.frames(RATE, seed=1, scale=SCALE), folder):
        pass
    seen = [
        replace(each, person=person)
        for each in film.skeletons("anyone", seed=1)
        for person, start, finish in when
        if person is not None and start <= each.at <= finish
    ]
    lines = [json.dumps({"at": each.at, "person": each.person, "joints": in_camera(each, film)}) for each in seen]
    (folder / PEOPLE).write_text("\n".join((*lines, "")), encoding="utf-8")


def in_camera(skeleton: Skeleton, film: Film) -> dict[str, list[float]]:
    """Return the joints of a skeleton in the frame of the camera, as files have them."""
    places = film.camera.to_camera(np.array(list(skeleton.joints.values())))
    return dict(zip(skeleton.joints, places.tolist(), strict=True))


@pytest.fixture(scope="module")
def memory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    write_recording(folder / "clouds")
    with live_robot(folder / "memory", StorySettings(str(folder / "clouds")), lambda line: None) as robot:
        assert robot.wait(120.0) and robot.problem is None
    return folder / "memory"


def test_acts_are_recorded_from_hands(memory: Path) -> None:
    with Blackboard.open(memory) as board:
        acts = [each for each in board.holding() if each.statement.predicate in ACTS]
        things = {each.statement.subject for each in board.holding(Pattern(predicate=AT))}
    assert [(each.statement.subject, each.statement.predicate) for each in acts] == [("Ada", MOVED), ("Ben", TOOK)]
    assert {each.statement.object for each in acts} < things
    assert all(each.certainty > 0.9 and each.source.origin is Origin.SEEN for each in acts)


def test_hands_that_grip_do_not_point(memory: Path) -> None:
    with Blackboard.open(memory) as board:
        assert board.holding(Pattern(predicate=POINTED_AT)) == ()


@pytest.mark.parametrize(
    ("question", "words"),
    [
        ("What happened to t1?", "t1 was there from"),
        ("What did Ada do?", "Ada moved t3 at"),
        ("What did Ben take away?", "Ben took t1 away at"),
        ("Who moved t3 first?", "Ada moved t3 at"),
        ("Who moved t3 last?", "Not known: who moved t3 at"),
    ],
)
def test_persons_and_their_acts_are_recalled(memory: Path, question: str, words: str) -> None:
    with Session(memory) as session:
        assert session.recall(question).answer.startswith(words)
