"""Simulate a teacher: the joints of a person beside the table who points at things, with noise.

The proportions of the body are those of Drillis and Contini (1966). People bring the fingertip near the line from the
eye to what they point at (Taylor and McCloskey 1988; Herbort and Kunde 2016), some nearer to the line from the
shoulder. The elbow hangs so that the wrist is bent little, but the forearm alone aims badly at near things.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import SimulationError
from deixis.perception.pointing.gesture import unit
from deixis.perception.pointing.skeleton import Skeleton
from deixis.perception.scene import PerceivedObject, Scene

Array = NDArray[np.float64]

SHOULDER_HEIGHT, EYE_HEIGHT, HALF_SHOULDERS = 0.818, 0.936, 0.129
UPPER_ARM, FOREARM, HAND = 0.186, 0.146, 0.108
"""Lengths of the body as shares of the stature (Drillis and Contini 1966); ``HAND`` ends at the fingertip."""

EYE_FROM_HEAD = 0.08
"""Distance of the eyes from the middle of the head, in the direction of the gaze, in metres."""

MAX_LEAN = 0.25
"""Maximum distance by which the trunk leans towards a far place, in metres."""

MIN_GAP = 0.03
"""Distance from what is pointed at below which the fingertip does not come on purpose, in metres."""

FROM_SHOULDER = 0.1
"""Standard deviation of how far, from the eye towards the shoulder, the line of pointing begins, as a share."""

Pose = tuple[Array, Array, Array, Array]
"""Place of the fingertip, direction of the finger, shift of the trunk, and place looked at, each of shape (3,)."""

Key = tuple[float, Array, Array, Array, Array]
"""Time and pose."""

SEATED = 0.27
"""Loss of height of a seated person, as a share of the stature."""

TABLE_HEIGHT = 0.74
"""Height of the table's top above the floor, in metres."""


@dataclass(frozen=True)
class PointingNoise:
    """Noise of human pointing and of the tracker of joints.

    Parameters
    ----------
    joints
        Standard deviation of each coordinate of a joint from frame to frame, in metres, correlated over 0.15 s.
    offset
        Standard deviation of the error of a joint that stays over a gesture, in metres.
    aim
        Standard deviation of the direction from the fingertip to what is pointed at, in radians.
    place
        Standard deviation of the aimed place, in metres.
    dropped
        Probability that a joint is not seen in a frame.
    outliers
        Probability that a joint is seen about 0.1 m from its place in a frame.
    """

    joints: float = 0.01
    offset: float = 0.01
    aim: float = np.deg2rad(2.0)
    place: float = 0.005
    dropped: float = 0.02
    outliers: float = 0.005

    def times(self, factor: float) -> PointingNoise:
        """Return the noise with standard deviations multiplied by a factor.

        Parameters
        ----------
        factor
            The factor, at least 0.

        Returns
        -------
        PointingNoise
            The noise; probabilities are kept.
        """
        return PointingNoise(
            self.joints * factor,
            self.offset * factor,
            self.aim * factor,
            self.place * factor,
            self.dropped,
            self.outliers,
        )


@dataclass(frozen=True)
class Aim:
    """Aim of a simulated gesture.

    ``target`` is the id of the thing, or None for an empty place or the middle of two things. ``place`` is the aimed
    place in metres. ``start`` and ``finish`` are the times of the true hold, in seconds.
    """

    target: str | None
    place: tuple[float, float, float]
    start: float
    finish: float


@dataclass(frozen=True)
class Recording:
    """Skeletons of a simulated teacher, and what each gesture was aimed at."""

    skeletons: tuple[Skeleton, ...]
    aims: tuple[Aim, ...]


@dataclass
class Teacher:
    """A person beside a table, drawn from a seed, who points with either arm.

    Parameters
    ----------
    scene
        Things in metres, with heights, z = 0 at the table's top.
    seed
        Seed of the body, the place and the gestures.
    noise
        Noise of pointing and of the joints.
    rate
        Frames a second.
    person
        Name in the skeletons.

    Raises
    ------
    SimulationError
        If the scene has no heights or no objects, or the rate is not positive.
    """

    scene: Scene
    seed: int = 0
    noise: PointingNoise = field(default_factory=PointingNoise)
    rate: float = 30.0
    person: str = "teacher"

    def __post_init__(self) -> None:
        if self.scene.boxes.shape[2:] != (3,) or not self.scene.objects:
            raise SimulationError("a teacher needs a scene with at least one object and with heights")
        if not self.rate > 0:
            raise SimulationError(f"`rate` must be above 0 frames a second, got {self.rate:g}")
        self._random = random = np.random.default_rng(self.seed)
        self._stature = float(np.clip(random.normal(1.7, 0.1), 1.45, 2.05))
        self._seated = bool(random.random() < 0.4)
        low, high = self.scene.boxes[:, 0, :2].min(axis=0), self.scene.boxes[:, 1, :2].max(axis=0)
        middle, half = (low + high) / 2, (high - low) / 2 + 0.1
        side = random.choice(4, p=[0.4, 0.2, 0.2, 0.2])  # at the chair, on the right, behind, on the left
        outward = np.array([(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)][side])
        along = np.array([-outward[1], outward[0]])
        gap, shift = random.uniform(0.15, 0.3), random.uniform(-0.6, 0.6)
        feet = middle + outward * (np.abs(outward) @ half + gap) + along * shift * (np.abs(along) @ half)
        turn = random.normal(0.0, np.deg2rad(15))
        facing = unit(middle - feet)
        facing = np.array(
            [np.cos(turn) * facing[0] - np.sin(turn) * facing[1], np.sin(turn) * facing[0] + np.cos(turn) * facing[1]]
        )
        down = TABLE_HEIGHT + (SEATED * self._stature if self._seated else 0.0)
        lean = facing * random.uniform(0.05, 0.2)
        self._ahead = np.array([*facing, 0.0])
        self._neck = np.array([*(feet + lean), SHOULDER_HEIGHT * self._stature - down])
        self._eye = np.array([*(feet + lean * 1.5), EYE_HEIGHT * self._stature - down]) + EYE_FROM_HEAD * self._ahead
        self._middle = np.array([*middle, 0.0])
        self._rightward = np.array([facing[1], -facing[0], 0.0])
        self._swivel = random.normal(np.deg2rad(30), np.deg2rad(15))

    def points_at(self, targets: Sequence[str | None], hold: float | None = None) -> Recording:
        """Return the skeletons while the teacher points at things, one after the other.

        Parameters
        ----------
        targets
            Id of each thing, or None for a place that is not on a thing, such as between two things.
        hold
            Duration of each hold in seconds; by default drawn from 0.4 to 1.2.

        Returns
        -------
        Recording
            The skeletons, and what each gesture was aimed at.

        Raises
        ------
        SimulationError
            If an id is not in the scene.
        """
        random, paths, aims, now = self._random, [], [], 0.5
        side, rest = "right", {name: self._rest(name) for name in ("left", "right")}
        keys = [(0.0, *rest[side]), (now, *rest[side])]
        for target in targets:
            place = self._empty_place() if target is None else self._place_on(target)
            wanted = "right" if (place - self._neck) @ self._rightward > random.normal(-0.15, 0.1) else "left"
            if wanted != side or random.random() < 0.5:  # take the arm back before the next gesture
                now += random.uniform(0.4, 0.7)
                keys += [(now, *rest[side]), (now + 0.3, *rest[side])]
                now += 0.3
                if wanted != side:
                    paths.append((side, keys))
                    side, keys = wanted, [(now, *rest[wanted])]
            now += random.uniform(0.45, 0.8)
            pose = self._pose(place, side, self._clearance(place, target))
            lasting = random.uniform(0.4, 1.2) if hold is None else hold
            keys += [(now, *pose), (now + lasting, *pose)]
            aims.append(Aim(target, tuple(place.tolist()), now, now + lasting))
            now += lasting
        keys += [(now + 0.6, *rest[side]), (now + 1.0, *rest[side])]
        paths.append((side, keys))
        return Recording(self._skeletons(paths, rest, now + 1.0), tuple(aims))

    def _place_on(self, target: str) -> Array:
        """Return a place on a thing: near the middle of its upper side, or of a tall thing lower."""
        if target not in self.scene.ids:
            raise SimulationError(f"there is no thing '{target}' to point at; there are: {', '.join(self.scene.ids)}")
        thing = self.scene[target]
        offset = np.clip(self._random.normal(0.0, 0.2, 3), -0.45, 0.45)
        height = thing.maximum[2] - thing.minimum[2]
        up = max(0.0, 1.0 - abs(self._random.normal(0.0, 0.3))) * height
        middle, axes, extents = _frame(thing)
        place = middle + offset[:2] * extents @ axes
        return np.array([*place, thing.minimum[2] + up])

    def _empty_place(self) -> Array:
        """Return a place on the table that is not on a thing: between two neighbours, or anywhere."""
        boxes, random = self.scene.boxes, self._random
        middles = boxes.mean(axis=1)
        if len(boxes) > 1 and random.random() < 0.5:
            first = random.integers(len(boxes))
            second = np.argsort(np.linalg.norm(middles - middles[first], axis=1))[1]
            line = middles[first, :2] + np.linspace(0, 1, 101)[:, None] * (middles[second] - middles[first])[:2]
            on = (
                ((line[:, None] > boxes[None, :, 0, :2]) & (line[:, None] < boxes[None, :, 1, :2]))
                .all(axis=2)
                .any(axis=1)
            )
            if not on.all():
                return np.array([*line[~on][(~on).sum() // 2], 0.0])
        low, high = boxes[:, 0, :2].min(axis=0) - 0.15, boxes[:, 1, :2].max(axis=0) + 0.15
        place = random.uniform(low, high)
        for _ in range(100):
            off = np.maximum(boxes[:, 0, :2] - place, place - boxes[:, 1, :2]).max(axis=1)
            if (off > 0.08).all():
                break
            place = random.uniform(low, high)
        return np.array([*place, 0.0])

    def _clearance(self, place: Array, target: str | None) -> float:
        """Return the distance in plan from a place to the nearest thing other than the one that is meant."""
        boxes = self.scene.boxes[[name != target for name in self.scene.ids], :, :2]
        off = np.maximum(np.maximum(boxes[:, 0] - place[:2], place[:2] - boxes[:, 1]), 0.0)
        return float(np.linalg.norm(off, axis=1).min(initial=1.0))

    def _shoulder(self, side: str) -> Array:
        sign = 1.0 if side == "right" else -1.0
        result: Array = self._neck + sign * HALF_SHOULDERS * self._stature * self._rightward
        return result

    def _rest(self, side: str) -> Pose:
        """Return the pose of an arm at rest: in the lap, or hanging."""
        shoulder = self._shoulder(side)
        length = (UPPER_ARM + FOREARM + HAND) * self._stature
        if self._seated:
            return (
                shoulder + 0.55 * length * self._ahead - np.array([0.0, 0.0, 0.62 * length]),
                self._ahead,
                np.zeros(3),
                self._middle,
            )
        return shoulder - np.array([0.0, 0.0, 0.97 * length]), np.array([0.0, 0.0, -1.0]), np.zeros(3), self._middle

    def _pose(self, place: Array, side: str, clearance: float) -> Pose:
        """Return a pose of an arm that points at a place; the trunk leans towards a place that is far.

        The finger comes about as near to the place as the next other thing is, where it can reach so far.
        """
        random, length = self._random, (UPPER_ARM + FOREARM + HAND) * self._stature
        reach = random.uniform(0.85, 0.98) * length
        gap = min(random.lognormal(np.log(0.12), 0.5), max(clearance * random.lognormal(0.0, 0.3), MIN_GAP))
        shoulder, eye = self._shoulder(side), self._eye
        ahead = np.array([*(place - shoulder)[:2], 0.0])
        missing = float(np.linalg.norm(place - shoulder)) - gap - reach
        lean = np.clip(missing, 0.0, MAX_LEAN) * random.uniform(0.3, 1.0) * unit(ahead)
        shoulder, eye = shoulder + lean, eye + 1.3 * lean
        origin = eye + abs(random.normal(0.0, FROM_SHOULDER)) * (shoulder - eye)
        line = unit(place - origin)
        along, off = (shoulder - origin) @ line, float(np.linalg.norm(np.cross(shoulder - origin, line)))
        farthest = along + np.sqrt(max(float(reach**2 - off**2), 0.0))  # where the line leaves the sphere of reach
        tip = origin + min(farthest, float((place - origin) @ line) - gap) * line
        distance = float(np.linalg.norm(place - tip))
        tip = tip + random.normal(0.0, self.noise.aim, 3) * distance + random.normal(0.0, self.noise.place, 3)
        straight = unit(tip - shoulder)
        finger = unit(unit(place - tip) + random.uniform(0.0, 0.6) * straight + random.normal(0.0, 0.08, 3))
        return tip, finger, lean, place

    def _skeletons(
        self, paths: Sequence[tuple[str, Sequence[Key]]], rest: dict[str, Pose], end: float
    ) -> tuple[Skeleton, ...]:
        """Return noisy skeletons along the paths of the arms."""
        times = np.arange(0.0, end, 1 / self.rate)
        lean, looked, arms = np.zeros((len(times), 3)), np.tile(self._middle, (len(times), 1)), {}
        for side in ("left", "right"):
            tips, fingers = (np.tile(part, (len(times), 1)) for part in rest[side][:2])
            for moved, keys in paths:
                if moved == side:
                    during = (times >= keys[0][0]) & (times <= keys[-1][0])
                    tips[during], fingers[during], lean[during], looked[during] = _along(keys, times[during])
            arms[side] = tips, unit(fingers)
        eye = self._eye + 1.3 * lean
        joints = {"head": eye - EYE_FROM_HEAD * unit(looked - eye), "neck": self._neck + lean}
        for side, (tips, fingers) in arms.items():
            places = self._arm(side, tips, fingers, lean)
            names = ("shoulder", "elbow", "wrist", "hand_tip")
            joints |= {f"{side}_{name}": place for name, place in zip(names, places, strict=True)}
        bends = [key[0] for _, keys in paths for key in keys]
        seen = {name: self._measured(places, times, bends) for name, places in joints.items()}
        return tuple(
            Skeleton(
                float(at),
                {name: tuple(places[i].tolist()) for name, places in seen.items() if np.isfinite(places[i, 0])},
                self.person,
            )
            for i, at in enumerate(times)
        )

    def _arm(self, side: str, tips: Array, fingers: Array, lean: Array) -> tuple[Array, Array, Array, Array]:
        """Return shoulder, elbow, wrist and fingertip, each of shape (t, 3), for given fingertips (two-link arm)."""
        shoulder = self._shoulder(side) + lean
        upper, lower = UPPER_ARM * self._stature, FOREARM * self._stature
        wrists = tips - HAND * self._stature * fingers
        reach = np.linalg.norm(wrists - shoulder, axis=1, keepdims=True)
        leaned = np.maximum(reach - 0.98 * (upper + lower), 0.0)
        ahead = unit(wrists - shoulder)
        shoulder = shoulder + leaned * ahead  # so that the arm is long enough
        reach = np.clip(reach - leaned, abs(upper - lower) + 0.02, None)
        along = (reach**2 + upper**2 - lower**2) / (2 * reach)
        off = np.sqrt(np.maximum(upper**2 - along**2, 0.0))
        outward = self._rightward * (1.0 if side == "right" else -1.0)
        angles = np.deg2rad(np.linspace(-30.0, 100.0, 9))[:, None, None]
        hanging = np.array([0.0, 0.0, -1.0]) * np.cos(angles) + outward * np.sin(angles)  # (9, 1, 3)
        bend = unit(hanging - (hanging * ahead).sum(axis=2, keepdims=True) * ahead)
        elbows = shoulder + along * ahead + off * bend
        wrist_bend = np.arccos(np.clip((unit(wrists - elbows) * fingers).sum(axis=2), -1.0, 1.0))
        effort = 3 * wrist_bend**2 + (angles[..., 0] - self._swivel) ** 2
        share = np.exp(-3 * (effort - effort.min(axis=0)))
        bend = unit(
            ((share / share.sum(axis=0))[..., None] * bend).sum(axis=0)
        )  # smooth in time, unlike the least effort
        return shoulder, shoulder + along * ahead + off * bend, wrists, tips

    def _measured(self, places: Array, times: Array, bends: Sequence[float]) -> Array:
        """Return places with the noise of a tracker; NaN where the joint is not seen."""
        noise, random, n = self.noise, self._random, len(times)
        kept = np.exp(-1 / (0.15 * self.rate))
        jitter = random.normal(0.0, noise.joints, (n, 3))
        for i in range(1, n):
            jitter[i] = kept * jitter[i - 1] + np.sqrt(1 - kept**2) * jitter[i]
        knots = np.unique([0.0, *bends, float(times[-1])])
        offsets = np.stack(
            [np.interp(times, knots, random.normal(0.0, noise.offset, len(knots))) for _ in range(3)], axis=1
        )
        wild = (random.random(n) < noise.outliers)[:, None] * random.normal(0.0, 0.1, (n, 3))
        found: Array = places + jitter + offsets + wild
        found[random.random(n) < noise.dropped] = np.nan
        return found


def _frame(thing: PerceivedObject) -> tuple[Array, Array, Array]:
    """Return the middle (2,), the axes as rows (2, 2), and the extents (2,) of a thing in plan."""
    if thing.oriented is not None:
        box = thing.oriented
        return np.array(box.centre[:2]), box.axes[:2, :2], np.array(box.extents[:2])
    low, high = np.array(thing.minimum[:2]), np.array(thing.maximum[:2])
    return (low + high) / 2, np.eye(2), high - low


def _along(keys: Sequence[Key], times: Array) -> Pose:
    """Return poses between key poses, with the smoothest acceleration (Flash and Hogan 1985)."""
    at = np.array([key[0] for key in keys])
    before = np.clip(np.searchsorted(at, times, side="right") - 1, 0, len(at) - 2)
    share = np.clip((times - at[before]) / np.maximum(at[before + 1] - at[before], 1e-9), 0.0, 1.0)
    smooth = (10 * share**3 - 15 * share**4 + 6 * share**5)[:, None]
    tips, fingers, leans, looked = (np.array([key[number] for key in keys]) for number in (1, 2, 3, 4))

    def between(ends: Array) -> Array:
        result: Array = ends[before] + smooth * (ends[before + 1] - ends[before])
        return result

    return between(tips), between(fingers), between(leans), between(looked)
