"""Answers of the tracker: each thing with its place, its state and since when."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import DEFAULT_VIEWPOINT, PerceivedObject, Scene

State = Literal["seen", "hidden", "gone"]


@dataclass(frozen=True, eq=False)
class TrackedThing:
    """One thing at one time.

    Parameters
    ----------
    id
        Name of the thing, which is never used again: ``t1``, ``t2`` and so on.
    box
        Lower and upper corner in the table's frame, in metres, shape (2, 3).
    oriented
        Box that is turned about the vertical.
    cloud
        Points of the thing in the table's frame.
    pose
        Transform (4, 4) from the frame that it had when it was first seen to the table's. That frame is parallel to the
        table's, with its origin in the middle of the box.
    certainty
        Probability in (0, 1] that the thing is there: the share of its visible points that agree, and less the longer
        it has not been seen.
    since
        Time in seconds since which it is at this place; while it moves, the time of the frame.
    first_seen, seen_at
        Times in seconds when it was first and last seen.
    state
        ``seen``, ``hidden`` (something hides it), or ``gone``.
    moving
        True while it moves.
    spread
        Standard deviation in metres of the middle along the thing, of which something hides an end; 0 if its ends are
        seen.
    """

    id: str
    box: NDArray[np.float64]
    oriented: OrientedBox
    cloud: PointCloud
    pose: NDArray[np.float64]
    certainty: float
    since: float
    first_seen: float
    seen_at: float
    state: State
    moving: bool
    spread: float = 0.0

    @property
    def centre(self) -> NDArray[np.float64]:
        """Middle of the thing in the table's frame, shape (3,), in metres."""
        place: NDArray[np.float64] = self.pose[:3, 3]
        return place


@dataclass(frozen=True, eq=False)
class Situation:
    """All that is known after a frame.

    Parameters
    ----------
    at
        Time of the frame in seconds.
    number
        Number of frames that the tracker was given before.
    things
        Things that are there, in the order in which they came.
    came
        Ids of the things that are new in this frame.
    went
        Things that are gone since this frame; ``seen_at`` is the time since when.
    frame
        Transform (4, 4) from the frame of the cloud to the table's, or None while no table is known.
    notes
        Warnings about the frame.
    merged
        Things that turned out to be parts of other ones.
    busy
        True if a hand, or something else that is not a thing, moves over the table.
    """

    at: float
    number: int
    things: tuple[TrackedThing, ...] = ()
    came: tuple[str, ...] = ()
    went: tuple[TrackedThing, ...] = ()
    frame: NDArray[np.float64] | None = None
    notes: tuple[str, ...] = ()
    merged: tuple[TrackedThing, ...] = ()
    busy: bool = False

    def scene(self, viewpoint: str = DEFAULT_VIEWPOINT) -> Scene:
        """Return the things as a scene, in the table's frame.

        Parameters
        ----------
        viewpoint
            Name of the side from which the camera looks.

        Returns
        -------
        Scene
            An object for each thing that is there, with the id of the thing.
        """
        return scene_of(self.things, self.at, viewpoint)


def scene_of(things: Iterable[TrackedThing], at: float, viewpoint: str = DEFAULT_VIEWPOINT) -> Scene:
    """Return tracked things as a scene, in the table's frame.

    Parameters
    ----------
    things
        The things.
    at
        Time of the frame in seconds.
    viewpoint
        Name of the side from which the camera looks.

    Returns
    -------
    Scene
        An object for each thing, with the id of the thing.
    """
    objects = [
        PerceivedObject(
            thing.id,
            tuple(thing.box[0].round(6).tolist()),
            tuple(thing.box[1].round(6).tolist()),
            cloud=thing.cloud,
            oriented=thing.oriented.rounded(6),
        )
        for thing in things
    ]
    return Scene(tuple(objects), viewpoint=viewpoint, file=f"<frame at {at:.2f} s>")
