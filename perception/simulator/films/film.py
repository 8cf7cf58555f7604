"""Film of a table on which a hand moves things, with the true pose of every thing in every frame.

A film holds what moves when: the poses of its things and the way of the hand over time. Its frames are what a camera
sees of that. Equal films give equal clouds for equal seeds. :mod:`~deixis.perception.simulator.films.stage` makes
films.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.depth import Intrinsics
from deixis.perception.clouds.mesh import Mesh
from deixis.perception.errors import SimulationError
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import PerceivedObject, Scene
from deixis.perception.simulator.cameras.camera import Camera
from deixis.perception.simulator.cameras.depth import DepthSensor, coloured, measured_look
from deixis.perception.simulator.films.camera_paths import CameraPath
from deixis.perception.simulator.laying import TableTop
from deixis.perception.simulator.meshes.hand import SKIN, hand
from deixis.perception.simulator.meshes.rays import Hits, RayCaster
from deixis.perception.tracking.frames.frame import Frame

MIN_POINTS = 20
"""Minimum number of points at which a thing counts as visible."""

JOINT_NOISE = 0.01
"""Standard deviation of the measured places of joints, in metres."""

ARM_JOINTS = ("right_shoulder", "right_elbow", "right_wrist", "right_hand_tip")
ARM = np.array([[0.0, -0.55, 0.3], [0.0, -0.42, 0.1], [0.0, -0.17, 0.05], [0.0, 0.0, 0.0]])
"""Places of the joints in metres in the frame of the mesh of the hand, whose grip is at the origin."""

Pose = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ThingTruth:
    """True state of one thing in one frame.

    Parameters
    ----------
    name, kind
        Name and kind of the thing.
    label
        Label of its points in the cloud.
    pose
        Transform (4, 4) from the thing's own frame to the table's. The own frame is parallel to the table's, with its
        origin in the middle of the thing's box, when the thing is first laid.
    box
        Lower and upper corner (2, 3) in the table's frame, in metres.
    points
        Number of points of the cloud that show it.
    held
        True while the hand holds or carries it.
    """

    name: str
    kind: str | None
    label: int
    pose: Pose
    box: NDArray[np.float64]
    points: int
    held: bool

    @property
    def centre(self) -> NDArray[np.float64]:
        """Origin of its own frame in the table's frame, shape (3,), in metres."""
        position: NDArray[np.float64] = self.pose[:3, 3]
        return position

    @property
    def visible(self) -> bool:
        """True if at least ``MIN_POINTS`` points show it."""
        return self.points >= MIN_POINTS


@dataclass(frozen=True, eq=False)
class FilmedFrame(Frame):
    """Frame of a film in the camera's frame, with the truth.

    Parameters
    ----------
    things
        State of each thing that is on the table or in the hand.
    camera
        The camera with its pose in the table's frame.
    """

    things: tuple[ThingTruth, ...] = ()
    camera: Camera = field(default_factory=lambda: Camera(np.eye(4)))

    def scene(self) -> Scene:
        """Return the true scene: the things with their boxes, in the table's frame.

        Returns
        -------
        Scene
            An object for each thing, with the id ``o`` and its label in the cloud, labelled with its name.
        """
        boxes = ((thing, *thing.box.round(6).tolist()) for thing in self.things)
        return Scene(
            tuple(
                PerceivedObject(f"o{thing.label}", tuple(low), tuple(high), thing.name) for thing, low, high in boxes
            ),
            file="<simulated film>",
        )


@dataclass(frozen=True, eq=False)
class FilmedThing:
    """Thing of a film: its mesh in its own frame, and where it is over time.

    ``starts`` (s,) are the seconds from which ``poses`` hold: in the table's frame, or in that of the grip while it is
    ``held``; None while the thing is not there.
    """

    name: str
    kind: str | None
    mesh: Mesh
    colour: tuple[int, int, int]
    starts: list[float] = field(default_factory=list)
    poses: list[Pose | None] = field(default_factory=list)
    held: list[bool] = field(default_factory=list)

    def begin(self, at: float, pose: Pose | None, held: bool = False) -> None:
        """Add a state that holds from a time on.

        Parameters
        ----------
        at
            Time in seconds, not before that of the last state.
        pose
            Pose in the table's frame, or in that of the grip; None if the thing is not there.
        held
            True if the hand holds the thing.
        """
        self.starts.append(at)
        self.poses.append(pose)
        self.held.append(held)

    def state(self, at: float) -> tuple[Pose | None, bool]:
        """Return the pose and True if it is held, at a time.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        tuple
            Pose in the table's frame, in that of the grip if it is held, or None; and whether it is held.
        """
        number = bisect_right(self.starts, at) - 1
        return (self.poses[number], self.held[number]) if number >= 0 else (None, False)


@dataclass(frozen=True, eq=False)
class HandLeg:
    """Part of the way of the hand, from ``start`` to ``finish`` in seconds.

    ``places`` (2, 3) are the positions of the grip, ``arm`` is the angle of the forearm about the vertical, and
    ``turns`` (2,) are the angles by which the grip is turned about the vertical. ``tilt`` (3,) is the rotation vector
    of the grip in the middle of the way.
    """

    start: float
    finish: float
    places: NDArray[np.float64]
    arm: float
    turns: tuple[float, float] = (0.0, 0.0)
    tilt: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))

    def grip(self, at: float) -> Pose:
        """Return the pose of the grip at a time of this leg.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        ndarray
            Transform of shape (4, 4) to the table's frame.
        """
        from scipy.spatial.transform import Rotation

        share = np.clip((at - self.start) / max(self.finish - self.start, 1e-9), 0.0, 1.0)
        smooth_share = share**3 * (10 - 15 * share + 6 * share**2)  # least jerk (Flash and Hogan 1985)
        pose = np.eye(4)
        pose[:3, 3] = self.places[0] + smooth_share * (self.places[1] - self.places[0])
        turn = self.turns[0] + smooth_share * (self.turns[1] - self.turns[0])
        tilted = Rotation.from_rotvec(np.sin(np.pi * smooth_share) ** 2 * self.tilt)
        pose[:3, :3] = (tilted * Rotation.from_euler("z", turn)).as_matrix()
        return pose

    def arm_pose(self, at: float) -> Pose:
        """Return the pose of the mesh of the hand at a time of this leg.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        ndarray
            Transform of shape (4, 4) to the table's frame.
        """
        pose = turned_pose(self.arm)
        pose[:3, 3] = self.grip(at)[:3, 3]
        return pose


@dataclass(frozen=True, eq=False)
class Film:
    """Table on which things move, seen by a camera.

    Parameters
    ----------
    top
        Top of the table.
    things
        All things that are ever on it; the points of the first one have label 1.
    legs
        Ways of the hand, in order.
    seconds
        Length of the film.
    camera
        Mean pose of the camera.
    path
        Movement of the camera, or None if it stands still.
    """

    top: TableTop
    things: tuple[FilmedThing, ...]
    legs: tuple[HandLeg, ...]
    seconds: float
    camera: Camera
    path: CameraPath | None = None

    @property
    def hand_label(self) -> int:
        """Label of the points of the hand."""
        return len(self.things) + 1

    def hand_leg(self, at: float) -> HandLeg | None:
        """Return the leg of the hand's way at a time.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        HandLeg or None
            None while the hand is not there.
        """
        number = bisect_right([leg.start for leg in self.legs], at) - 1
        return self.legs[number] if number >= 0 and at < self.legs[number].finish else None

    def poses(self, at: float) -> dict[str, tuple[Pose, bool]]:
        """Return the pose of each thing that is there at a time, and whether it is held.

        Parameters
        ----------
        at
            Time in seconds.

        Returns
        -------
        dict
            Transform (4, 4) to the table's frame, and True if it is held, by name.
        """
        leg, found = self.hand_leg(at), {}
        for thing in self.things:
            pose, held = thing.state(at)
            if pose is not None:
                found[thing.name] = (leg.grip(at) @ pose if held and leg is not None else pose, held)
        return found

    def frames(
        self, rate: float = 10.0, seed: int = 0, sensor: DepthSensor | None = None, scale: float = 1.0
    ) -> Iterator[FilmedFrame]:
        """Yield the frames of the film.

        Parameters
        ----------
        rate
            Frames per second.
        seed
            Seed of the noise of the sensor.
        sensor
            Errors of the sensor; those of a Kinect by default.
        scale
            Factor on the rows and columns of the image, at most 1.

        Yields
        ------
        FilmedFrame
            Cloud in the camera's frame with the truth. Labels are -1 without a measurement, 0 for the table, then the
            numbers of the things, and at last that of the hand.

        Raises
        ------
        SimulationError
            If ``rate`` or ``scale`` is not possible.
        """
        if not 0 < rate <= 1000 or not 0 < scale <= 1:
            raise SimulationError(f"`rate` must be from 0 to 1000 and `scale` from 0 to 1, got {rate:g} and {scale:g}")
        resting = _RestingHits()
        for number in range(int(np.floor(self.seconds * rate + 1e-9)) + 1):
            rng = np.random.default_rng([seed, number])
            yield self._frame(number, number / rate, resting, sensor or DepthSensor(), rng, scale)

    def skeletons(self, person: str, rate: float = 30.0, seed: int = 0) -> tuple[Skeleton, ...]:
        """Return the right arm of the person whose hand is filmed, while it is there.

        Parameters
        ----------
        person
            Name of the person.
        rate
            Frames per second.
        seed
            Seed of the noise of the joints.

        Returns
        -------
        tuple of Skeleton
            Shoulder, elbow, wrist and fingertip in the frame of the table, with normal noise of ``JOINT_NOISE``.
        """
        rng, found = np.random.default_rng([seed, len(self.legs)]), []
        for number in range(int(np.floor(self.seconds * rate + 1e-9)) + 1):
            leg = self.hand_leg(number / rate)
            if leg is not None:
                pose = leg.arm_pose(number / rate)
                places = (pose[:3, :3] @ ARM.T).T + pose[:3, 3] + rng.normal(0.0, JOINT_NOISE, ARM.shape)
                joints = {
                    name: (float(x), float(y), float(z)) for name, (x, y, z) in zip(ARM_JOINTS, places, strict=True)
                }
                found.append(Skeleton(number / rate, joints, person))
        return tuple(found)

    def _frame(
        self,
        number: int,
        at: float,
        resting: _RestingHits,
        sensor: DepthSensor,
        rng: np.random.Generator,
        scale: float,
    ) -> FilmedFrame:
        camera = self.camera if self.path is None else self.path.moved(self.camera, at)
        camera = replace(camera, lens=camera.lens if scale == 1 else _scaled(camera.lens, scale))
        poses, leg = self.poses(at), self.hand_leg(at)
        still = {0: (self.top.mesh, np.eye(4))}
        moving: dict[int, tuple[Mesh, Pose]] = {}
        for label, thing in enumerate(self.things, start=1):
            if thing.name in poses:
                pose, held = poses[thing.name]
                (moving if held else still)[label] = (thing.mesh, pose)
        if leg is not None:
            moving[self.hand_label] = (hand_mesh(), leg.arm_pose(at))
        rays, hits = resting.of(still, camera)
        if moving:
            hits = _nearest(hits, _cast(moving, camera, rays))
        look = measured_look(hits, rays, camera.lens, sensor, rng)
        palette = [self.top.colour, *(thing.colour for thing in self.things), SKIN]
        cloud = coloured(look, palette, camera.lens, sensor, rng)
        counts = np.bincount(look.mesh + 1, minlength=self.hand_label + 2)
        truth = tuple(
            ThingTruth(thing.name, thing.kind, label, pose, _box(thing.mesh, pose), int(counts[label + 1]), held)
            for label, thing in enumerate(self.things, start=1)
            if thing.name in poses
            for pose, held in [poses[thing.name]]
        )
        return FilmedFrame(cloud, at, number, None, truth, camera)


class _RestingHits:
    """Hits of the things that rest, kept from frame to frame while neither they nor the camera move."""

    def __init__(self) -> None:
        self._key: object = None
        self._found: tuple[NDArray[np.float64], Hits] | None = None

    def of(self, meshes: Mapping[int, tuple[Mesh, Pose]], camera: Camera) -> tuple[NDArray[np.float64], Hits]:
        """Return the rays of the camera in the table's frame, shape (r, 3), and their hits."""
        key = (camera.pose.tobytes(), camera.lens, tuple((k, pose.tobytes()) for k, (_, pose) in meshes.items()))
        if self._found is None or self._key != key:
            rays = camera.directions() @ camera.pose[:3, :3].T
            self._key, self._found = key, (rays, _cast(meshes, camera, rays))
        return self._found


def _cast(meshes: Mapping[int, tuple[Mesh, Pose]], camera: Camera, rays: NDArray[np.float64]) -> Hits:
    """Return the hits of meshes in their poses, with their labels as numbers."""
    found = RayCaster([moved_mesh(mesh, pose) for mesh, pose in meshes.values()]).cast(camera.eye, rays)
    labels = np.array([*meshes, -1], dtype=np.int32)
    return replace(found, mesh=labels[found.mesh])


def _nearest(one: Hits, other: Hits) -> Hits:
    nearer = other.distance < one.distance
    return Hits(
        np.where(nearer, other.distance, one.distance),
        np.where(nearer, other.mesh, one.mesh),
        np.where(nearer[:, None], other.normals, one.normals),
    )


@cache
def hand_mesh() -> Mesh:
    """Return the mesh of the hand of all films, in its own frame.

    Returns
    -------
    Mesh
        Hand whose grip, between the tips of the fingers and the thumb, is at the origin.
    """
    return hand()


def _scaled(lens: Intrinsics, scale: float) -> Intrinsics:
    width, height = max(round(lens.width * scale), 2), max(round(lens.height * scale), 2)
    across, down = width / lens.width, height / lens.height
    cx, cy = (lens.cx + 0.5) * across - 0.5, (lens.cy + 0.5) * down - 0.5
    return replace(lens, width=width, height=height, fx=lens.fx * across, fy=lens.fy * down, cx=cx, cy=cy)


def _box(mesh: Mesh, pose: Pose) -> NDArray[np.float64]:
    vertices = mesh.vertices @ pose[:3, :3].T + pose[:3, 3]
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])


def moved_mesh(mesh: Mesh, pose: Pose) -> Mesh:
    """Return a mesh at a pose.

    Parameters
    ----------
    mesh
        Mesh in its own frame.
    pose
        Transform (4, 4) from that frame.

    Returns
    -------
    Mesh
        Mesh in the frame to which the transform leads.
    """
    return Mesh(mesh.vertices @ pose[:3, :3].T + pose[:3, 3], mesh.faces)


def turned_pose(angle: float) -> Pose:
    """Return the pose that turns about the vertical through the origin.

    Parameters
    ----------
    angle
        Angle in radians.

    Returns
    -------
    ndarray
        Transform of shape (4, 4).
    """
    cosine, sine = np.cos(angle), np.sin(angle)
    pose = np.eye(4)
    pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return pose
