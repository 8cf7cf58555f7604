"""Films of random actions on random tables, for measuring."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from deixis.ontology.tbox import Ontology, default_ontology
from deixis.perception.simulator.films.camera_paths import CameraPath
from deixis.perception.simulator.films.film import Film
from deixis.perception.simulator.films.stage import Action, Bring, Move, PassOver, Rest, Stage, TakeAway
from deixis.perception.simulator.laying import (
    LaidThing,
    Placement,
    PlanBox,
    TableTop,
    lay,
    plan_box,
    top_under,
)
from deixis.perception.simulator.meshes.tableware import drawn_plan, kind_named
from deixis.perception.simulator.scatter import KINDS, scattered
from deixis.perception.tracking.frames.frame import Frame

ROOM = 0.22
"""Distance in metres by which the table extends beyond the things that are on it at the start."""

GAP = 0.02
"""Minimum distance in metres between the boxes of a thing that is set down and of the others."""

PAUSE = 0.6
"""Seconds between two actions."""

MAX_THINGS = 12
"""Largest number of things that are on the table at a time for another one to be brought."""

ACTIONS = {"move": 0.35, "touch": 0.1, "stack": 0.1, "take": 0.12, "bring": 0.13, "pass": 0.2}
"""Shares of the actions: to a free place, beside another thing without a gap, onto another thing, and others."""


def random_film(
    things: int,
    actions: int,
    seed: int,
    *,
    path: CameraPath | None = None,
    sure_pass: bool = False,
) -> Film:
    """Return a film of a random table on which a hand carries out random actions.

    Parameters
    ----------
    things
        Number of things at the start.
    actions
        Number of actions. One for which there is no room is replaced by a hand that passes over a thing.
    seed
        Seed of things, places and actions.
    path
        Movement of the camera, or None for a camera that stands still.
    sure_pass
        True for a forearm that hides a thing for two seconds first, in addition to the actions.

    Returns
    -------
    Film
        Film that begins and ends with a pause.

    Raises
    ------
    SimulationError
        If ``things`` is not from 1 to 300.

    Examples
    --------
    >>> story = random_film(3, 2, seed=1)
    >>> len(story.poses(0.0)), len(story.legs) > 4
    (3, True)
    """
    ontology, rng = default_ontology(), np.random.default_rng([seed, 7])
    table = lay(scattered(things, seed, ontology=ontology), ontology=ontology)
    top = top_under(table.things, ROOM)
    stage = Stage(table.things, seed, ontology)
    names, weights = list(ACTIONS), np.array(list(ACTIONS.values()), dtype=np.float64)
    stage.carry_out(Rest(PAUSE))
    if sure_pass:
        stage.carry_out(_pass_over(stage, top, rng))
        stage.carry_out(Rest(PAUSE))
    for number in range(actions):
        kind = str(rng.choice(names, p=weights / weights.sum()))
        action: Action | None = _action(kind, stage, top, rng, number, ontology)
        arm = float(rng.choice([0.0, 0.0, -1.2, 1.2]))
        if action is None:
            action, arm = _pass_over(stage, top, rng), 0.0
        stage.carry_out(action, arm)
        stage.carry_out(Rest(PAUSE))
    return stage.film(top, path=path)


def _action(
    kind: str, stage: Stage, top: TableTop, rng: np.random.Generator, number: int, ontology: Ontology
) -> Move | TakeAway | Bring | None:
    """Return a random action of a kind, or None if there is no room for it."""
    if kind == "bring":
        if len(stage.laid) >= MAX_THINGS:
            return None
        word, instance = str(rng.choice(np.array(KINDS))), int(rng.integers(2**31))
        yaw = float(rng.uniform(0, 2 * np.pi))
        reach = float(np.hypot(*drawn_plan(kind_named(word, ontology), instance, ontology))) / 2
        place = _free_place(stage, top, (np.full(2, -reach), np.full(2, reach)), rng)
        brought = Placement(f"{word.replace(' ', '_')}_new_{number}", word, 0.0, 0.0, yaw, seed=instance)
        return None if place is None else Bring(replace(brought, x=place[0], y=place[1]))
    thing = _any(stage, rng)
    if thing is None or kind == "pass":
        return None
    if kind == "take":
        return TakeAway(thing.name) if len(stage.laid) > 1 else None
    low, high = plan_box(thing.mesh)
    middle = (low + high) / 2
    turn = float(rng.uniform(-np.pi / 2, np.pi / 2))
    if kind == "move":
        reach = float(np.linalg.norm(thing.mesh.vertices[:, :2] - middle, axis=1).max())
        place = _free_place(stage, top, (np.full(2, -reach), np.full(2, reach)), rng, but=thing.name)
        return None if place is None else Move(thing.name, *place, turn)
    other = _any(stage, rng, but=thing.name)
    if other is None or thing.mesh.vertices[:, 2].min() > 0.001 or other.mesh.vertices[:, 2].min() > 0.001:
        return None
    beneath, above = plan_box(other.mesh)
    if kind == "stack":
        fits = ((high - low) < 0.9 * (above - beneath)).all() and np.ptp(other.mesh.vertices[:, 2]) < 0.06
        place = (float((beneath + above)[0] / 2), float((beneath + above)[1] / 2))
        bare = all(
            _apart(plan_box(each.mesh), (beneath, above), 0.0) for each in _others(stage, other.name, thing.name)
        )
        return Move(thing.name, *place) if fits and bare else None
    for side in rng.permutation(4).tolist():
        axis, sign = side % 2, 1 if side < 2 else -1
        shift = (beneath + above) / 2 - middle
        shift[axis] = (above[axis] - low[axis] if sign > 0 else beneath[axis] - high[axis]) + sign * 0.002
        moved = (low + shift, high + shift)
        if _within(moved, top) and all(
            _apart(plan_box(each.mesh), moved, 0.001) for each in _others(stage, thing.name)
        ):
            return Move(thing.name, float(middle[0] + shift[0]), float(middle[1] + shift[1]))
    return None


def _pass_over(stage: Stage, top: TableTop, rng: np.random.Generator) -> PassOver:
    """Return a hand whose forearm hides a random thing from a person at the table."""
    target = _any(stage, rng)
    x, y = np.zeros(2) if target is None else np.mean(plan_box(target.mesh), axis=0)
    eye = (top.low[0] + top.high[0]) / 2
    return PassOver(float(x + (eye - x) / 3), float(y) + 0.1)


def _any(stage: Stage, rng: np.random.Generator, but: str | None = None) -> LaidThing | None:
    left = _others(stage, but)
    return left[int(rng.integers(len(left)))] if left else None


def _others(stage: Stage, *but: str | None) -> list[LaidThing]:
    return [thing for name, thing in stage.laid.items() if name not in but]


def _free_place(
    stage: Stage, top: TableTop, box: PlanBox, rng: np.random.Generator, but: str | None = None
) -> tuple[float, float] | None:
    """Return the place of a box (around the origin) that is apart from all other things, or None if none was found."""
    taken = [plan_box(thing.mesh) for thing in _others(stage, but)]
    for _ in range(200):
        place = rng.uniform(top.low, top.high)
        own = (box[0] + place, box[1] + place)
        if _within(own, top) and all(_apart(own, other, GAP) for other in taken):
            return float(place[0]), float(place[1])
    return None


def _within(box: PlanBox, top: TableTop) -> bool:
    return bool((box[0] > np.array(top.low) + GAP).all() and (box[1] < np.array(top.high) - GAP).all())


def _apart(box: PlanBox, other: PlanBox, gap: float) -> bool:
    return bool((box[0] > other[1] + gap).any() or (other[0] > box[1] + gap).any())


class FilmSource:
    """Frames of a film as a source of clouds.

    Parameters
    ----------
    film
        The film.
    rate
        Frames per second.
    seed
        Seed of the noise of the sensor.
    """

    def __init__(self, film: Film, rate: float = 10.0, seed: int = 0) -> None:
        self._film, self._rate, self._seed = film, rate, seed

    def frames(self) -> Iterator[Frame]:
        """Yield the frames of the film.

        Yields
        ------
        Frame
            Cloud in the camera's frame, with the truth: a
            :class:`~deixis.perception.simulator.films.film.FilmedFrame`.
        """
        yield from self._film.frames(self._rate, self._seed)
