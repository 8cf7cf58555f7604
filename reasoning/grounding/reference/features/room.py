"""The geometry of a scene for reference: sizes, distances, directions, and the viewers that a speaker may imagine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.geometry.overlap import common_lengths, gaps
from deixis.reasoning.grounding.reference.query import Person

Array = NDArray[np.float64]

VIEWERS = 8
"""Number of directions, evenly spaced, in which an unknown viewer may look."""

SURROUNDINGS = 0.5
"""Minimum share of the extents of a scene at which an object counts as part of its surroundings, such as a floor."""


@dataclass(frozen=True, eq=False)
class Room:
    """Objects of a scene as arrays; computed values are kept, so that many sentences about one scene are cheap.

    Parameters
    ----------
    ids
        Names of the n objects.
    boxes
        Lower and upper corners, shape (n, 2, 3); boxes without heights have heights of 0.
    labels
        Category of each object in the words of the scene's source, or None.
    colours
        Mean colours in sRGB, 0 to 255, shape (n, 3); NaN if unknown.
    fronts
        Unit vectors in the plane, shape (n, 2); NaN if unknown.
    viewer
        Whether the y axis points away from a viewer; False if the viewpoint is unknown.
    places
        Where the speaker and the addressee are in the plane, if it is known, shape (2,).
    candidates
        Possible names of each object with their probabilities, the sum at most 1; only those of objects without a label
        count.
    confidences
        Probability that each label is right, shape (n,); empty for labels that are certain. What it leaves over is
        that of an unknown class.
    """

    ids: tuple[str, ...]
    boxes: Array
    labels: tuple[str | None, ...]
    colours: Array
    fronts: Array
    viewer: bool = False
    places: Mapping[Person, Array] = field(default_factory=dict)
    candidates: tuple[Mapping[str, float], ...] = ()
    confidences: Array = field(default_factory=lambda: np.zeros(0))

    @classmethod
    def of(
        cls,
        ids: Sequence[str],
        boxes: Array,
        labels: Sequence[str | None],
        colours: Array | None = None,
        fronts: Array | None = None,
        viewer: bool = False,
        places: Mapping[Person, Array] | None = None,
        candidates: Sequence[Mapping[str, float]] | None = None,
        confidences: Array | None = None,
    ) -> Room:
        """Return a room of boxes with 2 or 3 axes, with unknown colours and fronts where none are given.

        Parameters
        ----------
        ids
            Names of the n objects.
        boxes
            Minimum and maximum corners, shape (n, 2, 2) or (n, 2, 3).
        labels
            Category of each object, or None.
        colours
            Mean colours in sRGB, 0 to 255, shape (n, 3); NaN if unknown.
        fronts
            Unit vectors in the plane, shape (n, 2); NaN if unknown.
        viewer
            Whether the y axis points away from a viewer.
        places
            Places of the speaker and the addressee in the plane, shape (2,) each, where known.
        candidates
            Possible names of each object with their probabilities; only those of objects without a label count.
        confidences
            Probability that each label is right, shape (n,); by default all labels are certain.

        Returns
        -------
        Room
            The room; boxes without heights get heights of 0.
        """
        n = len(ids)
        if boxes.shape[-1] == 2:
            boxes = np.concatenate([boxes, np.zeros((n, 2, 1))], axis=2)
        colours = np.full((n, 3), np.nan) if colours is None else colours
        fronts = np.full((n, 2), np.nan) if fronts is None else fronts
        return cls(
            tuple(ids),
            boxes.astype(np.float64),
            tuple(labels),
            colours,
            fronts,
            viewer,
            places or {},
            tuple(candidates or ({},) * n),
            np.ones(n) if confidences is None else confidences,
        )

    def __len__(self) -> int:
        return len(self.ids)

    @cached_property
    def without_label(self) -> NDArray[np.bool_]:
        """True for objects without a label, shape (n,)."""
        return np.array([label is None for label in self.labels], dtype=np.bool_)

    @cached_property
    def unlabelled(self) -> NDArray[np.bool_]:
        """True for objects without a label that is certain, shape (n,)."""
        return self.without_label | (self.confidences < 1) if len(self.confidences) else self.without_label

    @cached_property
    def names(self) -> tuple[Mapping[str, float], ...]:
        """Possible names of each object with their probabilities: its label, or else its candidates."""
        sure = self.confidences.tolist() or [1.0] * len(self)
        return tuple(
            each if label is None else {label: confidence}
            for label, each, confidence in zip(self.labels, self.candidates, sure, strict=True)
        )

    @cached_property
    def named(self) -> Array:
        """Probability that the class of each object is one of its names, shape (n,)."""
        return np.array([sum(names.values()) for names in self.names], dtype=np.float64)

    @cached_property
    def centres(self) -> Array:
        """Centres of the boxes, shape (n, 3)."""
        result: Array = self.boxes.mean(axis=1)
        return result

    @cached_property
    def extents(self) -> Array:
        """Side lengths of the boxes, shape (n, 3)."""
        result: Array = self.boxes[:, 1] - self.boxes[:, 0]
        return result

    @cached_property
    def bounds(self) -> Array:
        """Lower and upper corner of the box around all objects, shape (2, 3)."""
        return np.stack([self.boxes[:, 0].min(axis=0), self.boxes[:, 1].max(axis=0)])

    @cached_property
    def middle(self) -> Array:
        """Centre of the room in the plane, shape (2,)."""
        result: Array = self.bounds.mean(axis=0)[:2]
        return result

    @cached_property
    def surrounds(self) -> NDArray[np.bool_]:
        """True for objects that are as large as the room, such as its floor; shape (n,)."""
        room = np.maximum(self.bounds[1] - self.bounds[0], 1e-9)
        result: NDArray[np.bool_] = (self.extents[:, :2] > SURROUNDINGS * room[:2]).all(axis=1)
        return result

    @cached_property
    def scale(self) -> float:
        """Length by which distances are divided: the median diagonal of the objects within the room."""
        inside = self.extents[~self.surrounds] if not self.surrounds.all() else self.extents
        return max(float(np.median(np.linalg.norm(inside, axis=1))), 1e-9)

    @cached_property
    def is_flat(self) -> bool:
        """True if all objects are at one height, so that *top* is the far side of the scene."""
        return float(np.ptp(self.centres[:, 2])) < 0.1 * self.scale

    @cached_property
    def gaps(self) -> Array:
        """Distances between the boxes of all pairs over the scale, shape (n, n); 0 where they touch or overlap."""
        result: Array = np.linalg.norm(gaps(self.boxes), axis=2) / self.scale
        return result

    @cached_property
    def plane_gaps(self) -> Array:
        """Distances between the boxes as seen from above, over the scale, shape (n, n)."""
        result: Array = np.linalg.norm(gaps(self.boxes[:, :, :2]), axis=2) / self.scale
        return result

    @cached_property
    def offsets(self) -> Array:
        """Vectors from the second object's centre to the first one's over the scale, shape (n, n, 3)."""
        result: Array = (self.centres[:, None] - self.centres[None]) / self.scale
        return result

    @cached_property
    def distances(self) -> Array:
        """Distances of centres over the scale, shape (n, n)."""
        result: Array = np.linalg.norm(self.offsets, axis=2)
        return result

    @cached_property
    def covered(self) -> Array:
        """Share of the first object's area that lies over or under the second one, shape (n, n)."""
        area = np.prod(common_lengths(self.boxes[:, :, :2]), axis=2)
        own = np.maximum(np.prod(self.extents[:, :2], axis=1), 1e-9)
        result: Array = np.clip(area / own[:, None], 0.0, 1.0)
        return result

    @cached_property
    def contained(self) -> Array:
        """Share of the first object's volume that lies in the second one, shape (n, n)."""
        shares = common_lengths(self.boxes) / np.maximum(self.extents, 1e-6)[:, None]
        result: Array = np.clip(np.prod(shares, axis=2), 0.0, 1.0)
        return result

    @cached_property
    def lab(self) -> Array:
        """Colours in CIELAB, shape (n, 3); NaN if unknown."""
        from deixis.reasoning.grounding.evidence.properties.colours import lab_of_srgb

        return lab_of_srgb(self.colours)

    @cached_property
    def views(self) -> Array:
        """Directions in which a viewer may look, unit vectors of shape (v, 2); those of known people come last."""
        return np.concatenate([circle(VIEWERS), *self.headings.values()])

    @cached_property
    def headings(self) -> Mapping[Person, Array]:
        """Direction in which each person whose place is known looks at the scene, unit vectors of shape (1, 2)."""
        apart = {person: self.middle - place for person, place in self.places.items()}
        return {person: (way / max(float(np.linalg.norm(way)), 1e-9))[None] for person, way in apart.items()}

    def heading(self, person: Person | None) -> Array:
        """Return the directions in which a person may look.

        People sit opposite each other unless the places of both are known. Without any known place, each is the viewer.

        Parameters
        ----------
        person
            The person, or None for the viewer.

        Returns
        -------
        ndarray
            Unit vectors in the plane: of shape (1, 2) where the direction is known, and of shape (v, 2) otherwise.
        """
        if person is None or not self.headings:
            return self.views
        return self.headings[person] if person in self.headings else -next(iter(self.headings.values()))

    @cached_property
    def from_walls(self) -> Array:
        """Distances of each object from the left, near, right and far wall of the room, shape (n, 4)."""
        low = self.boxes[:, 0, :2] - self.bounds[0, :2]
        high = self.bounds[1, :2] - self.boxes[:, 1, :2]
        return np.concatenate([low, high], axis=1)

    @cached_property
    def inward(self) -> Array:
        """Unit vectors from the nearest wall of the room towards its inside, for each object, shape (n, 2)."""
        sides = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
        thin = self.extents[:, :2] / np.maximum(self.extents[:, :2].sum(axis=1, keepdims=True), 1e-9)
        cost = self.from_walls + self.scale * np.concatenate([thin, thin], axis=1)  # a flat object lies along its wall
        result: Array = sides[cost.argmin(axis=1)]
        return result

    @cached_property
    def wall_gaps(self) -> Array:
        """Distance of each object from the nearest wall of the room over the scale, shape (n,)."""
        result: Array = self.from_walls.min(axis=1) / self.scale
        return result

    @cached_property
    def corner_gaps(self) -> Array:
        """Distance of each object from the nearest corner of the room over the scale, shape (n,)."""
        apart = np.minimum(self.from_walls[:, :2], self.from_walls[:, 2:])
        result: Array = np.hypot(apart[:, 0], apart[:, 1]) / self.scale
        return result

    @cached_property
    def from_middle(self) -> Array:
        """Unit vectors in the plane from the middle of the room to each object, shape (n, 2)."""
        apart = self.centres[:, :2] - self.middle
        result: Array = apart / np.maximum(np.linalg.norm(apart, axis=1, keepdims=True), 1e-9)
        return result

    @cached_property
    def facing(self) -> Array:
        """Cosines that suit a viewer who looks at each object, shape (v, n, 6).

        They compare the view with the direction from the middle of the room, with the opposite of the object's front,
        and with the wall behind it (where the object is near a wall); then how far the view is along an axis, and the
        first and the third one again for objects with a known front only.
        """
        middle = self.views @ self.from_middle.T
        has_front: NDArray[np.bool_] = np.logical_not(np.isnan(self.fronts).any(axis=1))
        front = self.views @ -np.where(has_front[:, None], self.fronts, 0.0).T
        wall = self.views @ -self.inward.T * np.exp(-self.wall_gaps)
        axis = np.abs(self.views).max(axis=1)[:, None] * np.ones(len(self))
        return np.stack([middle, front, wall, axis, middle * has_front, wall * has_front], axis=2)


def circle(count: int) -> Array:
    """Return unit vectors in evenly spaced directions.

    Parameters
    ----------
    count
        Number of directions.

    Returns
    -------
    ndarray
        Unit vectors, shape (count, 2), counter-clockwise from the x axis.
    """
    angles = np.arange(count) * (2 * np.pi / count)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)
