"""Places where a described object may be, and how much of them is in view.

The table is covered by boxes of one size, and the engine's evidence of the description for each of them says how
probable it is that the object is there. A place is in view if no thing hides it from the camera.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.script import Script
from deixis.perception.clouds.cloud import PointCloud
from deixis.perception.occlusion import hidden_places
from deixis.perception.scene import PerceivedObject, Scene
from deixis.reasoning.grounding.evidence.words.meaning import Meaning
from deixis.workflows.grounding.ground import GroundingRequest

Array = NDArray[np.float64]

GRID = (12, 9)
"""Number of boxes from left to right and from near to far."""

TABLE_MARGIN = 0.15
"""Distance in metres by which the table is taken to extend beyond its things."""

BOX_SIDE = 0.04
"""Side length in metres of the boxes."""

MAX_SUPPORT_HEIGHT = 0.05
"""Maximum height in metres of a thing on which an object may lie."""

MIN_PLACE_RATIO = 0.2
"""Minimum probability of a place where an object may well be, as a share of the probability of the best place."""

MIN_CAMERA_HEIGHT = 0.05
"""Minimum height in metres of a camera above the table whose position is known."""

MAX_THINGS = 90
"""Minimum number of things for which places are not computed."""


@dataclass(frozen=True, eq=False)
class Places:
    """Places on a table: centres of shape (k, 3) in metres, the probability of each, and which ones are in view."""

    centres: Array
    shares: Array
    in_view: NDArray[np.bool_]

    @property
    def share_in_view(self) -> float:
        """Probability that the object, if it is on the table, is in view."""
        return float(self.shares[self.in_view].sum())

    def may_be_at(self, thing: PerceivedObject) -> bool:
        """Return whether the object may well be where a thing is.

        Parameters
        ----------
        thing
            The thing.

        Returns
        -------
        bool
            True if the place that is nearest to the middle of the thing is not much less probable than the best one.
        """
        middle = (np.array(thing.minimum[:2]) + np.array(thing.maximum[:2])) / 2
        nearest = np.linalg.norm(self.centres[:, :2] - middle, axis=1).argmin()
        return bool(self.shares[nearest] >= MIN_PLACE_RATIO * self.shares.max())


def places_of(script: Script, role: str, scene: Scene, meaning: Meaning) -> Places | None:
    """Return where an object of a description may be on a table.

    Parameters
    ----------
    script
        The description.
    role
        Name of the object.
    scene
        The table, in metres, with heights.
    meaning
        Words and sizes.

    Returns
    -------
    Places or None
        The places; None if the table has no things, so that nothing is known about its extent, or more than
        ``MAX_THINGS``.
    """
    if not 0 < len(scene.objects) <= MAX_THINGS:
        return None
    centres = _grid(scene)
    half = BOX_SIDE / 2
    boxes = [
        PerceivedObject(f"place {number}", (x - half, y - half, z), (x + half, y + half, z + BOX_SIDE))
        for number, (x, y, z) in enumerate(centres.tolist())
    ]
    things = len(scene.objects)
    with_boxes = Scene((*scene.objects, *boxes), scene.frame, scene.viewpoint, scene.unit, viewer=scene.viewer)
    request = GroundingRequest(script, with_boxes.from_viewer(), sizes=False, meaning=meaning)
    problem = request.evidence(request.scene).problem
    index = request.graph.index(role)
    value = problem.unary[index, things:].copy()
    for (first, second), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
        if index in (first, second):
            table = problem.tables[kind] if first == index else problem.tables[kind].T
            other = problem.unary[second if first == index else first, :things]
            chances = np.exp(other - other.max())
            value += table[things:, :things] @ (chances / chances.sum())
    shares = np.exp(value - value.max())
    return Places(centres, shares / shares.sum(), _visible(centres, scene))


def _grid(scene: Scene) -> Array:
    """Return centres on the table, and on the low things that lie on it, shape (k, 3)."""
    low, high = scene.boxes[:, 0], scene.boxes[:, 1]
    axes = [
        np.linspace(low[:, axis].min() - TABLE_MARGIN, high[:, axis].max() + TABLE_MARGIN, number + 2)[1:-1]
        for axis, number in enumerate(GRID)
    ]
    plan = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    over = np.all((plan[:, None] > low[None, :, :2]) & (plan[:, None] < high[None, :, :2]), axis=2)
    tops = np.where(over & (high[None, :, 2] <= MAX_SUPPORT_HEIGHT), high[None, :, 2], 0.0).max(axis=1)
    return np.column_stack([plan, tops])


def _visible(centres: Array, scene: Scene) -> NDArray[np.bool_]:
    """Return which places are in view; all if the position of the camera is unknown."""
    clouds = (scene.cloud_of(thing.id) for thing in scene.objects if isinstance(thing.cloud, PointCloud | str))
    eye = next((np.array(cloud.origin, dtype=np.float64) for cloud in clouds), None)
    if eye is None or eye[2] < MIN_CAMERA_HEIGHT:
        return np.ones(len(centres), dtype=bool)
    high = [thing for thing in scene.objects if thing.maximum[2] > MAX_SUPPORT_HEIGHT]
    return ~hidden_places(centres + np.array([0.0, 0.0, BOX_SIDE / 2]), eye, high)
