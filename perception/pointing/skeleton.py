"""Skeletons: places of the joints of a person at one time, and their arms as arrays over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.errors import PointingError

Array = NDArray[np.float64]
Position = tuple[float, float, float]

SIDES = ("left", "right")
ARM_JOINTS = ("shoulder", "elbow", "wrist")
"""Joints that an arm needs, such as ``left_elbow``; the ``left_hand_tip`` may be there too."""

EYES = ("left_eye", "right_eye")
HEAD = ("head", "nose", "neck")
"""Joints that stand for the eyes if there are none, the best one first."""

MAX_REACH = 100.0
"""Maximum absolute value of a coordinate of a joint, in metres."""


@dataclass(frozen=True, slots=True)
class Skeleton:
    """Joints of one person at one time.

    Parameters
    ----------
    at
        Time in seconds, on the clock of the scene and of the utterances.
    joints
        Place of each joint that was seen, in metres in the frame of the scene (z up, 0 at the table's top). The names
        ``head``, ``left_eye``, ``left_shoulder``, ``left_elbow``, ``left_wrist``, ``left_hand``, ``left_hand_tip``, and
        those of the right side count; other joints may be there.
    person
        Name of the person.

    Raises
    ------
    PointingError
        If the time or a coordinate is not finite, or a joint does not have three coordinates.
    """

    at: float
    joints: Mapping[str, Position]
    person: str = "person"

    def __post_init__(self) -> None:
        if not np.isfinite(self.at):
            raise PointingError(f"the time of a skeleton must be finite, got {self.at}")
        for name, place in self.joints.items():
            if len(place) != 3 or not np.isfinite(place).all() or max(map(abs, place)) > MAX_REACH:
                raise PointingError(
                    f"the joint '{name}' must have 3 finite coordinates of at most {MAX_REACH:g} m, got {place};"
                    " leave out a joint that was not seen"
                )


@dataclass(frozen=True, eq=False)
class ArmTrack:
    """One arm of a person over n frames in which shoulder, elbow and wrist were seen.

    ``times`` has shape (n,), in seconds; the places have shape (n, 3), in metres. ``tips`` are those of the fingertip,
    else of the hand, else of the wrist. ``eyes`` are NaN where neither eyes nor head were seen.
    """

    person: str
    side: str
    times: Array
    shoulders: Array
    elbows: Array
    wrists: Array
    tips: Array
    eyes: Array

    def __len__(self) -> int:
        return len(self.times)


def arm_track(skeletons: Sequence[Skeleton], side: str) -> ArmTrack:
    """Return one arm of a person as arrays; frames without its shoulder, elbow or wrist are left out.

    Parameters
    ----------
    skeletons
        Skeletons of one person, in order of time.
    side
        ``left`` or ``right``.

    Returns
    -------
    ArmTrack
        The arm, possibly with no frame.
    """
    needed = [f"{side}_{name}" for name in ARM_JOINTS]
    seen = [one for one in skeletons if all(name in one.joints for name in needed)]
    shoulders, elbows, wrists = (_places([one.joints[name] for one in seen]) for name in needed)
    tips = [_first(one, (f"{side}_hand_tip", f"{side}_hand", f"{side}_wrist")) for one in seen]
    person = seen[0].person if seen else "person"
    times = np.array([one.at for one in seen], dtype=np.float64)
    return ArmTrack(person, side, times, shoulders, elbows, wrists, _places(tips), _places([_eye(one) for one in seen]))


def _places(places: Sequence[Position | None]) -> Array:
    unseen = (np.nan, np.nan, np.nan)
    return np.array([unseen if one is None else one for one in places], dtype=np.float64).reshape(-1, 3)


def _first(skeleton: Skeleton, names: Sequence[str]) -> Position | None:
    return next((skeleton.joints[name] for name in names if name in skeleton.joints), None)


def _eye(skeleton: Skeleton) -> Position | None:
    """Return the place between the eyes that were seen, else the head's, or None."""
    eyes = [skeleton.joints[name] for name in EYES if name in skeleton.joints]
    if not eyes:
        return _first(skeleton, HEAD)
    x, y, z = np.mean(eyes, axis=0).tolist()
    return (x, y, z)
