"""Stage on which a hand carries out actions, one after the other, and the film of them.

The hand comes from beside the table, grips a thing, lifts it, sets it down elsewhere, takes it away, brings a new one,
or passes over. Things that lie on a carried thing go with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deixis.ontology.tbox import Ontology
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.simulator.cameras.camera import Camera, chair_camera
from deixis.perception.simulator.films.camera_paths import CameraPath
from deixis.perception.simulator.films.film import Film, FilmedThing, HandLeg, Pose, hand_mesh, moved_mesh, turned_pose
from deixis.perception.simulator.laying import (
    LaidTable,
    LaidThing,
    Placement,
    TableTop,
    lay,
    lowered,
    overlap_in_plan,
    plan_box,
    set_down,
    top_under,
)

HAND_SPEED = 0.5
"""Mean speed of the hand in metres per second, without the time for starting and stopping."""

START_SECONDS = 0.3
"""Time for starting and stopping on each part of the hand's way, in seconds."""

CARRY_CLEARANCE = 0.04
"""Height in metres at which a carried thing passes over the things below its way."""

OUTSIDE = 0.5
"""Distance in metres from the things at which the hand appears and vanishes."""

GRIP_SECONDS = 0.25
"""Time in which the hand closes or opens around a thing, in seconds."""

MAX_TILT = np.deg2rad(12.0)
"""Maximum angle in radians by which a thing is tilted while it is carried."""


@dataclass(frozen=True, slots=True)
class Rest:
    """Pause of some seconds in which nothing moves and no hand is there."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Move:
    """Lift a thing and set it down elsewhere.

    Parameters
    ----------
    name
        The thing.
    x, y
        New position in metres of the centre of the box that the thing had when it was first laid.
    turn
        Angle in radians by which it is turned about the vertical.
    """

    name: str
    x: float
    y: float
    turn: float = 0.0


@dataclass(frozen=True, slots=True)
class TakeAway:
    """Take a thing off the table, with all that lies on it."""

    name: str


@dataclass(frozen=True, slots=True)
class Bring:
    """Bring a new thing: a placement, or a thing that has its mesh at its place on the table already."""

    thing: Placement | LaidThing


@dataclass(frozen=True, slots=True)
class PassOver:
    """Hold the hand over a place for some seconds, without touching anything.

    Parameters
    ----------
    x, y
        Place of the fingers in plan, in metres.
    seconds
        Time for which the hand stays there.
    height
        Height of the fingers above the highest thing under the arm, in metres.
    """

    x: float
    y: float
    seconds: float = 2.0
    height: float = 0.03


Action = Rest | Move | TakeAway | Bring | PassOver


def film(
    table: LaidTable | Sequence[Placement],
    actions: Sequence[Action],
    *,
    seed: int = 0,
    arm: float | Sequence[float] = 0.0,
    camera: Camera | None = None,
    path: CameraPath | None = None,
    ontology: Ontology | None = None,
) -> Film:
    """Return the film of a table on which a hand carries out actions, one after the other.

    Parameters
    ----------
    table
        The table as it is laid at the start, or things to lay.
    actions
        What happens, in order.
    seed
        Seed of the tilt of carried things.
    arm
        Direction in radians from which the hand comes: 0 from the viewer, pi / 2 from the right; one for all actions,
        or one for each.
    camera
        Mean pose of the camera; by default that of a person at the table who sees all that is ever on it.
    path
        Movement of the camera, or None for a camera that stands still.
    ontology
        Kinds and their sizes; by default :func:`~deixis.ontology.tbox.default_ontology`.

    Returns
    -------
    Film
        Film with its frames and the truth.

    Raises
    ------
    SimulationError
        If an action names a thing that is not there, or a place or a time is not possible.

    Examples
    --------
    >>> mug = Placement("mug", "mug", 0.0, 0.0, seed=1)
    >>> moved_mug = film([mug], [Rest(0.5), Move("mug", 0.2, 0.1)])
    >>> first, last = (moved_mug.poses(at)["mug"][0][:2, 3].round(3).tolist() for at in (0, moved_mug.seconds))
    >>> first, last
    ([0.0, 0.0], [0.2, 0.1])
    """
    arms = [float(angle) for angle in np.asarray(arm).ravel()] * (len(actions) if np.ndim(arm) == 0 else 1)
    if len(arms) != len(actions):
        raise SimulationError(f"`arm` must be one angle or one for each of the {len(actions)} actions, got {len(arms)}")
    top, things = (
        (table.top, table.things) if isinstance(table, LaidTable) else (None, lay(table, None, ontology).things)
    )
    stage = Stage(things, seed, ontology)
    for action, angle in zip(actions, arms, strict=True):
        stage.carry_out(action, angle)
    return stage.film(top, camera, path)


def laying_film(
    table: LaidTable, *, pause: float = 0.4, seed: int = 0, order: Sequence[int] | None = None, **options: object
) -> Film:
    """Return the film in which a table is laid: its things are brought one after the other.

    Parameters
    ----------
    table
        The table as it is laid at the end.
    pause
        Seconds between two things.
    seed
        Seed of the tilt of carried things.
    order
        Numbers of the things in the order in which they are brought; a thing that lies on another one must come later.
        By default the order of the table.
    **options
        ``arm``, ``camera`` and ``path`` of :func:`film`.

    Returns
    -------
    Film
        Film that begins and ends with a pause.

    Raises
    ------
    SimulationError
        If ``order`` does not contain every thing once.

    Examples
    --------
    >>> from deixis.perception.simulator.laying import lay
    >>> table = lay([Placement("plate", "dinner plate", 0.0, 0.0), Placement("fork", "dinner fork", -0.25, 0.0)])
    >>> story = laying_film(table)
    >>> [len(story.poses(at)) for at in (0.0, story.seconds / 2, story.seconds)]
    [0, 2, 2]
    """
    numbers = list(range(len(table.things))) if order is None else list(order)
    if sorted(numbers) != list(range(len(table.things))):
        raise SimulationError(f"`order` must contain each number from 0 to {len(table.things) - 1} once, got {numbers}")
    actions: list[Action] = [Rest(pause)]
    for number in numbers:
        actions += [Bring(table.things[number]), Rest(pause)]
    return film(LaidTable(table.top, ()), actions, seed=seed, **options)  # type: ignore[arg-type]


class Stage:
    """Table on which a film is being made: its things and the way of the hand, up to the time ``at`` in seconds.

    Parameters
    ----------
    things
        Things that are on the table at the start.
    seed
        Seed of the tilt of carried things.
    ontology
        Kinds and their sizes; by default :func:`~deixis.ontology.tbox.default_ontology`.
    """

    def __init__(self, things: Sequence[LaidThing], seed: int = 0, ontology: Ontology | None = None) -> None:
        self.at = 0.0
        self.laid = {thing.name: thing for thing in things}
        """Things that are on the table now, by name."""
        self._legs: list[HandLeg] = []
        self._things: dict[str, FilmedThing] = {}
        self._ever: list[LaidThing] = list(things)
        self._rng, self._ontology = np.random.default_rng(seed), ontology
        for thing in things:
            pose = self._enter(thing)
            self._things[thing.name].begin(0.0, pose)

    def film(self, top: TableTop | None = None, camera: Camera | None = None, path: CameraPath | None = None) -> Film:
        """Return the film of what was carried out.

        Parameters
        ----------
        top
            Top of the table; by default it extends a little beyond all places where things were.
        camera
            Mean pose of the camera; by default that of a person at the table who sees all of these places.
        path
            Movement of the camera, or None for a camera that stands still.

        Returns
        -------
        Film
            Film up to the present time.
        """
        top = top or top_under(self._ever)
        camera = camera or chair_camera(LaidTable(top, tuple(self._ever)))
        return Film(top, tuple(self._things.values()), tuple(self._legs), self.at, camera, path)

    def carry_out(self, action: Action, arm: float = 0.0) -> None:
        """Carry out one action, which begins now.

        Parameters
        ----------
        action
            What happens.
        arm
            Direction in radians from which the hand comes: 0 from the viewer, pi / 2 from the right.

        Raises
        ------
        SimulationError
            If the action names a thing that is not there, or a place or a time is not possible.
        """
        if isinstance(action, Rest):
            self._require(action.seconds >= 0 and np.isfinite(action.seconds), f"a rest of {action.seconds} s")
            self.at += action.seconds
        elif isinstance(action, Move):
            self._move(action, arm)
        elif isinstance(action, TakeAway):
            self._take_away(action.name, arm)
        elif isinstance(action, Bring):
            self._bring(action.thing, arm)
        else:
            self._pass_over(action, arm)

    def _move(self, action: Move, arm: float) -> None:
        self._require(np.isfinite([action.x, action.y, action.turn]).all(), f"the place of '{action.name}'")
        carried = self._with_load(action.name)
        start = self._pose(action.name)
        end = turned_pose(action.turn) @ start
        end[:3, 3] = action.x, action.y, 0.0
        standing = moved_mesh(self._things[action.name].mesh, end)
        end[2, 3] -= standing.vertices[:, 2].min()
        others = [thing.mesh for name, thing in self.laid.items() if name not in carried]
        standing = moved_mesh(self._things[action.name].mesh, end)
        below = [mesh for mesh in others if overlap_in_plan(plan_box(standing), plan_box(mesh))]
        end[2, 3] += lowered(standing, below).vertices[:, 2].min() - standing.vertices[:, 2].min()
        grip = self._grip(action.name, arm)
        self._approach(grip, arm)
        self._grasp(carried, grip)
        relative = np.linalg.inv(_shifted(grip)) @ start
        place = (end @ np.linalg.inv(turned_pose(action.turn) @ relative))[:3, 3]
        self._carry(carried, grip, place, arm, action.turn)
        self._release(carried, end @ np.linalg.inv(start))
        self._leave(place, arm)

    def _take_away(self, name: str, arm: float) -> None:
        carried, grip = self._with_load(name), self._grip(name, arm)
        self._approach(grip, arm)
        self._grasp(carried, grip)
        self._leave(grip, arm, lift=self._lift(name))
        for each in carried:
            self._things[each].begin(self.at, None)
            del self.laid[each]

    def _bring(self, thing: Placement | LaidThing, arm: float) -> None:
        if isinstance(thing, Placement):
            thing = set_down(thing, list(self.laid.values()), self._ontology)
        self._require(thing.name not in self._things, f"a second thing called '{thing.name}'")
        pose = self._enter(thing)
        grip = self._grip(thing.name, arm)
        self._ever.append(thing)
        over = _above(grip, self._lift(thing.name))
        outside = self._outside(over, arm)
        self._things[thing.name].begin(self.at, np.linalg.inv(_shifted(grip)) @ pose, held=True)
        tilt = self._tilt()
        self._leg(outside, over, arm, tilt=tilt)
        self._leg(over, grip, arm)
        self._leg(grip, grip, arm)
        self._release([thing.name], np.eye(4))
        self._leave(grip, arm)

    def _pass_over(self, action: PassOver, arm: float) -> None:
        self._require(
            bool(np.isfinite([action.x, action.y]).all()) and 0 <= action.seconds < np.inf and action.height > 0,
            "the place, time or height of a hand that passes over",
        )
        under = moved_mesh(hand_mesh(), _shifted((action.x, action.y, 0.0)) @ turned_pose(arm))
        tops = [
            thing.mesh.vertices[:, 2].max()
            for thing in self.laid.values()
            if overlap_in_plan(plan_box(under), plan_box(thing.mesh))
        ]
        place = np.array([action.x, action.y, max(tops, default=0.0) + action.height])
        self._leg(self._outside(place, arm), place, arm)
        self._leg(place, place, arm, seconds=action.seconds)
        self._leg(place, self._outside(place, arm), arm)

    def _enter(self, thing: LaidThing) -> Pose:
        """Add a thing, and return its pose on the table."""
        low, high = thing.mesh.vertices.min(axis=0), thing.mesh.vertices.max(axis=0)
        pose = _shifted((low + high) / 2)
        own = Mesh(thing.mesh.vertices - pose[:3, 3], thing.mesh.faces)
        self._things[thing.name] = FilmedThing(thing.name, thing.kind, own, thing.colour)
        self.laid[thing.name] = thing
        return pose

    def _pose(self, name: str) -> Pose:
        pose = self._things[name].poses[-1]
        assert pose is not None, "a thing that is laid has a pose"
        return pose

    def _with_load(self, name: str) -> list[str]:
        """Return the thing and all that would sink without it."""
        if name not in self.laid:
            raise SimulationError(
                f"no thing named '{name}' is on the table at {self.at:.1f} s; it has {', '.join(self.laid) or 'none'}"
            )
        carried = [name]
        while True:
            left = {other: thing.mesh for other, thing in self.laid.items() if other not in carried}
            more = [
                other
                for other, mesh in left.items()
                if any(overlap_in_plan(plan_box(mesh), plan_box(self.laid[each].mesh)) for each in carried)
                and _sinks(mesh, [below for each, below in left.items() if each != other])
            ]
            if not more:
                return carried
            carried += more

    def _grip(self, name: str, arm: float) -> NDArray[np.float64]:
        """Return the place where the hand grips a thing: at its top, at most 3 cm within the side of the arm."""
        vertices = self.laid[name].mesh.vertices
        towards = np.array([np.sin(arm), -np.cos(arm)])
        middle = (vertices.min(axis=0) + vertices.max(axis=0))[:2] / 2
        narrow = min(np.ptp(vertices[:, :2], axis=0))
        reach = float(((vertices[:, :2] - middle) @ towards).max())
        place = middle + max(reach - 0.03, 0.0) * towards * (narrow > 0.1)
        near = np.linalg.norm(vertices[:, :2] - place, axis=1) < max(0.03, 0.4 * narrow)
        return np.append(place, vertices[near if near.any() else slice(None), 2].max())

    def _lift(self, name: str) -> float:
        """Return the height by which a thing is lifted, so that it passes over all others."""
        others = [thing.mesh.vertices[:, 2].max() for other, thing in self.laid.items() if other != name]
        bottom = float(self.laid[name].mesh.vertices[:, 2].min())
        return max(max(others, default=0.0) - bottom, 0.05) + CARRY_CLEARANCE

    def _tilt(self) -> NDArray[np.float64]:
        angle = self._rng.uniform(0, 2 * np.pi)
        tilt: NDArray[np.float64] = self._rng.uniform(0, MAX_TILT) * np.array([np.cos(angle), np.sin(angle), 0.0])
        return tilt

    def _outside(self, place: NDArray[np.float64], arm: float) -> NDArray[np.float64]:
        """Return the place beside the table from which the hand comes to a place."""
        towards = np.array([np.sin(arm), -np.cos(arm)])
        plans = [plan_box(thing.mesh) for thing in self._ever] or [(np.zeros(2), np.zeros(2))]
        corners = np.array([(x, y) for low, high in plans for x in (low[0], high[0]) for y in (low[1], high[1])])
        reach = max(float((corners @ towards).max()) - float(place[:2] @ towards), 0.0) + OUTSIDE
        return np.append(place[:2] + reach * towards, max(place[2], 0.25))

    def _approach(self, grip: NDArray[np.float64], arm: float) -> None:
        over = _above(grip, 0.08)
        self._leg(self._outside(over, arm), over, arm)
        self._leg(over, grip, arm)
        self._leg(grip, grip, arm)

    def _grasp(self, carried: Sequence[str], grip: NDArray[np.float64]) -> None:
        for name in carried:
            self._things[name].begin(self.at, np.linalg.inv(_shifted(grip)) @ self._pose(name), held=True)

    def _carry(
        self, carried: Sequence[str], grip: NDArray[np.float64], place: NDArray[np.float64], arm: float, turn: float
    ) -> None:
        rise = np.array([0.0, 0.0, max(self._lift(carried[0]), place[2] - grip[2] + CARRY_CLEARANCE)])
        over = np.array([place[0], place[1], (grip + rise)[2]])
        self._leg(grip, grip + rise, arm)
        self._leg(grip + rise, over, arm, turns=(0.0, turn), tilt=self._tilt())
        self._leg(over, place, arm, turns=(turn, turn))
        self._leg(place, place, arm, turns=(turn, turn))

    def _release(self, carried: Sequence[str], change: Pose) -> None:
        """Set carried things down; ``change`` takes their last places on the table to the new ones."""
        for name in carried:
            mesh = moved_mesh(self.laid[name].mesh, change)
            self.laid[name] = replace(self.laid[name], mesh=mesh)
            self._ever.append(replace(self.laid[name], name=f"{name} at {self.at:.3f} s"))
            thing = self._things[name]
            rests = [pose for pose, held in zip(thing.poses, thing.held, strict=True) if pose is not None and not held]
            if rests:
                thing.begin(self.at, change @ rests[-1])
            else:
                low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
                thing.begin(self.at, _shifted((low + high) / 2))

    def _leave(self, place: NDArray[np.float64], arm: float, lift: float = 0.08) -> None:
        over = _above(place, lift)
        self._leg(place, over, arm)
        self._leg(over, self._outside(over, arm), arm)

    def _leg(
        self,
        start: NDArray[np.float64],
        end: NDArray[np.float64],
        arm: float,
        *,
        seconds: float | None = None,
        turns: tuple[float, float] = (0.0, 0.0),
        tilt: NDArray[np.float64] | None = None,
    ) -> None:
        way = float(np.linalg.norm(end - start)) / HAND_SPEED + abs(turns[1] - turns[0]) / 2.0
        taken = (START_SECONDS + way if way > 0 else GRIP_SECONDS) if seconds is None else seconds
        places = np.stack([start, end]).astype(np.float64)
        self._legs.append(HandLeg(self.at, self.at + taken, places, arm, turns, np.zeros(3) if tilt is None else tilt))
        self.at += taken

    def _require(self, holds: bool | np.bool_, what: str) -> None:
        if not holds:
            raise SimulationError(f"{what} is not possible at {self.at:.1f} s of the film")


def _sinks(mesh: Mesh, others: Sequence[Mesh]) -> bool:
    """Return True if a thing would sink by more than 1 mm without the things that are not among ``others``."""
    bottom = float(mesh.vertices[:, 2].min())
    if bottom < 0.001:
        return False
    standing = Mesh(mesh.vertices - (0.0, 0.0, bottom), mesh.faces)
    below = [other for other in others if overlap_in_plan(plan_box(standing), plan_box(other))]
    below = [other for other in below if other.vertices[:, 2].min() < bottom]
    return float(lowered(standing, below).vertices[:, 2].min()) < bottom - 0.001


def _above(place: NDArray[np.float64], height: float) -> NDArray[np.float64]:
    raised: NDArray[np.float64] = place + np.array([0.0, 0.0, height])
    return raised


def _shifted(by: ArrayLike) -> Pose:
    pose = np.eye(4)
    pose[:3, 3] = by
    return pose
