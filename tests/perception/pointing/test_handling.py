"""Persons who changed the place of a thing, found from their hands."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from deixis.perception.pointing.handling import KEPT_SECONDS, Contact, HandLog
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.simulator.films.stage import Bring, Move, Rest, TakeAway, film
from deixis.perception.simulator.laying import Placement

BOX = np.array([[-0.04, -0.04, 0.0], [0.04, 0.04, 0.1]])
CONTACT = Contact(BOX, 0.8, 1.2)


def path(person: str, *places: tuple[float, float, float], side: str = "right") -> list[Skeleton]:
    """Return skeletons of a hand that is at the places in turn, half a second apart."""
    times = np.arange(0.0, (len(places) - 1) / 2 + 1e-9, 1 / 30)
    knots = np.arange(len(places)) / 2
    columns = [np.interp(times, knots, column) for column in np.array(places).T]
    return [
        Skeleton(float(at), {f"{side}_hand_tip": (x, y, z)}, person)
        for at, x, y, z in zip(times, *columns, strict=True)
    ]


OUTSIDE, AT_THING, NEAR = (0.5, -0.5, 0.2), (0.0, 0.0, 0.1), (0.0, -0.09, 0.1)
REACHES = path("Ada", OUTSIDE, OUTSIDE, AT_THING, OUTSIDE, OUTSIDE)


def log_of(*skeletons: Skeleton) -> HandLog:
    log = HandLog()
    for each in sorted(skeletons, key=lambda each: each.at):
        log.add(each)
    return log


def test_the_hand_at_the_thing_is_the_actor() -> None:
    far = path("Ben", OUTSIDE, OUTSIDE, (0.3, 0.3, 0.1), OUTSIDE)
    found = log_of(*REACHES, *far).actor([CONTACT])
    assert found is not None
    assert found.person == "Ada"
    assert found.probability == pytest.approx(1 / 1.05, abs=1e-3)


@pytest.mark.parametrize(
    "others",
    [
        path("Ben", OUTSIDE, OUTSIDE, NEAR, OUTSIDE),  # both hands are at the thing
        path("Ben", OUTSIDE, OUTSIDE, AT_THING, OUTSIDE, side="left"),
    ],
)
def test_two_hands_at_the_thing_leave_the_actor_unknown(others: list[Skeleton]) -> None:
    assert log_of(*REACHES, *others).actor([CONTACT]) is None


def test_a_hand_that_stays_at_the_thing_does_not_carry_it() -> None:
    assert log_of(*path("Ada", AT_THING, AT_THING, AT_THING, AT_THING)).actor([CONTACT]) is None


def test_a_move_needs_the_hand_at_both_places() -> None:
    moved = [CONTACT, Contact(BOX + np.array([0.3, 0.0, 0.0]), 1.2, 1.8)]
    assert log_of(*REACHES).actor(moved) is None
    carries = path("Ada", OUTSIDE, OUTSIDE, AT_THING, (0.3, 0.0, 0.1), OUTSIDE, OUTSIDE)
    found = log_of(*carries).actor(moved)
    assert found is not None
    assert found.person == "Ada"


def test_without_hands_no_person_is_named() -> None:
    assert HandLog().actor([CONTACT]) is None
    assert log_of(*REACHES, Skeleton(KEPT_SECONDS + 10, {"right_hand": OUTSIDE})).actor([CONTACT]) is None


def test_a_skeleton_without_hands_has_them_beyond_the_wrists() -> None:
    arms = [
        Skeleton(each.at, {"left_elbow": (x, y - 0.4, z), "left_wrist": (x, y - 0.1, z)}, "Ada")
        for each in REACHES
        for x, y, z in [each.joints["right_hand_tip"]]
    ]
    found = log_of(*arms).actor([CONTACT])
    assert found is not None


def boxes_of(thing: str, made: object, at: float) -> NDArray[np.float64]:
    """Return the box of a filmed thing at a time."""
    mesh = next(each.mesh for each in made.things if each.name == thing)  # type: ignore[attr-defined]
    pose = made.poses(at)[thing][0]  # type: ignore[attr-defined]
    vertices = mesh.vertices @ pose[:3, :3].T + pose[:3, 3]
    return np.array([vertices.min(axis=0), vertices.max(axis=0)])


def test_the_filmed_hand_brings_moves_and_takes() -> None:
    cup = Placement("cup", "mug", 0.0, 0.0)
    made = film([Placement("plate", "plate", 0.4, 0.0)], [Rest(1.0), Bring(cup), Rest(1.0)])
    rests = made.legs[2].finish
    log = log_of(*made.skeletons("Ada"))
    arrival = Contact(boxes_of("cup", made, made.seconds), rests - 1.5, rests + 0.3)
    found = log.actor([arrival])
    assert found is not None and found.person == "Ada"
    plate = Contact(boxes_of("plate", made, made.seconds), rests - 1.5, rests + 0.3)
    assert log.actor([plate]) is None
    for action in (Move("cup", 0.0, 0.3), TakeAway("cup")):
        made = film([cup], [Rest(1.0), action])
        begins = made.legs[1].finish
        departure = Contact(boxes_of("cup", made, 0.0), begins - 0.3, begins + 1.5)
        found = log_of(*made.skeletons("Ben")).actor([departure])
        assert found is not None and found.person == "Ben"
