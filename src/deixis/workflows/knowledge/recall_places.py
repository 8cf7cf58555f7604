"""Relate things whose boxes are recorded: *the fork was left of the plate*, where only boxes are on the blackboard.

A box holds from a start to a finish; two things are related as long as both boxes hold. A relation word holds of two
boxes if its graded model gives it a degree of at least ``MIN_DEGREE``.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.memory.episodes.fluents.episode import EpisodicFluent
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.grounding.evidence.words.degrees import word_degree
from deixis.reasoning.grounding.evidence.words.meaning import shipped_models
from deixis.reasoning.temporal.bounds import Bounds

MIN_DEGREE = 0.3
"""Minimum degree at which a relation word holds of two boxes; the degrees of directions fall with the distance."""

MIN_DURATION = 1e-3
"""Time in seconds before the end of a box at which its place is described."""

SUPPORT = ("on", "inside")
"""Relations that say best where a thing is."""

MIN_SUPPORT_DEGREE = 0.5
"""Minimum degree at which such a relation is said rather than another one."""

DIRECTIONS = ("left", "right", "in_front", "behind", "near")
"""Relations that say where a thing is otherwise; of equal ones, the first."""

DIAGONALS = ("top_left", "top_right", "bottom_left", "bottom_right")
"""Relations that say where a thing is if no direction does."""

COARSE = 0.5
"""Factor on the degree of *near*, which says less than a direction."""


@dataclass(frozen=True, slots=True)
class RelatedPlace:
    """Relation of a thing in its box to another one, as long as both are where they are.

    Attributes
    ----------
    relation
        Name of the relation.
    other
        The other thing.
    start, finish
        Bounds of the times in which it begins and ceases to hold, in seconds.
    """

    relation: str
    other: str
    start: Bounds
    finish: Bounds


class RecordedBoxes:
    """Boxes of things that hold in one window of time.

    Parameters
    ----------
    fluents
        Fluents of boxes.
    """

    def __init__(self, fluents: Sequence[EpisodicFluent]) -> None:
        boxes = {each.id: box for each in fluents if (box := _box(each)) is not None}
        self._fluents = [each for each in fluents if each.id in boxes]
        self._boxes = np.array([boxes[each.id] for each in self._fluents]).reshape(-1, 2, 3)
        self._degrees: dict[str, NDArray[np.float64]] = {}

    def related(self, fluent: str, relation: str, others: frozenset[str] | None) -> RelatedPlace | None:
        """Return how a thing in its box stands in a relation to one of others.

        Parameters
        ----------
        fluent
            Id of the fluent of its box.
        relation
            Name of the relation.
        others
            Other things; None for any.

        Returns
        -------
        RelatedPlace or None
            The relation that holds longest; None if it does not hold.
        """
        own = self._index(fluent)
        if own is None:
            return None
        degrees = self._degree(relation)[own]
        found = [
            self._place(own, other, relation)
            for other in np.flatnonzero(degrees >= MIN_DEGREE).tolist()
            if self._may_be_landmark(own, other, others)
        ]
        return max(found, key=lambda each: _duration(each.start, each.finish), default=None)

    def described(self, fluent: str, landmarks: frozenset[str], at: float) -> RelatedPlace | None:
        """Return the relation that says best where a thing in its box is.

        Parameters
        ----------
        fluent
            Id of the fluent of its box.
        landmarks
            Things with names.
        at
            Time in seconds at which the relation must hold; if the thing is not in its box then, the nearest time.

        Returns
        -------
        RelatedPlace or None
            What the thing is in or on, else where it is from the landmark that stayed longest, of these the one whose
            word fits best (to one decimal), and of these the nearest; None if no word fits.
        """
        own = self._index(fluent)
        if own is None:
            return None
        best = self._best(own, landmarks, at, (*SUPPORT, *DIRECTIONS))
        return best if best is not None else self._best(own, landmarks, at, DIAGONALS)

    def _best(self, own: int, landmarks: frozenset[str], at: float, words: Sequence[str]) -> RelatedPlace | None:
        """Return the one of some relations that says best where a thing in its box is at a time."""
        box = self._fluents[own]
        at = max(min(at, box.finish.upper - MIN_DURATION), box.start.lower)
        best: tuple[tuple[float, float, float], int, str] | None = None
        centres = self._boxes.mean(axis=1)
        for other in range(len(self._fluents)):
            if self._may_be_landmark(own, other, landmarks):
                start, finish = self._both(own, other)
                if not start.lower <= at < finish.upper:
                    continue
                duration = _duration(start, finish)
                for word in words:
                    degree = float(self._degree(word)[own, other]) * (COARSE if word == "near" else 1.0)
                    lasting = np.inf if word in SUPPORT and degree >= MIN_SUPPORT_DEGREE else duration
                    fits = lasting, round(degree, 1), -float(np.linalg.norm(centres[own] - centres[other]))
                    if degree >= MIN_DEGREE and (best is None or fits > best[0]):
                        best = fits, other, word
        return None if best is None else self._place(own, best[1], best[2])

    def _may_be_landmark(self, own: int, other: int, among: frozenset[str] | None) -> bool:
        """Return whether another box is that of another thing, one of some, and holds at the same time."""
        start, finish = self._both(own, other)
        thing = self._fluents[other].statement.subject
        is_other = self._fluents[own].statement.subject != thing and (among is None or thing in among)
        return is_other and start.lower < finish.upper

    def _both(self, one: int, other: int) -> tuple[Bounds, Bounds]:
        """Return when both boxes begin and cease to hold together."""
        starts = [self._fluents[each].start for each in (one, other)]
        ends = [self._fluents[each].finish for each in (one, other)]
        start = replace(max(starts, key=lambda each: each.lower), upper=max(each.upper for each in starts))
        first = min(ends, key=lambda each: each.upper)
        if first.upper < np.inf:  # one that has not ended may end at any time, but not before it is said to
            first = replace(first, lower=min(each.lower for each in ends if each.upper < np.inf))
        return start, first

    def _place(self, own: int, other: int, relation: str) -> RelatedPlace:
        return RelatedPlace(relation, self._fluents[other].statement.subject, *self._both(own, other))

    def _index(self, fluent: str) -> int | None:
        return next((number for number, each in enumerate(self._fluents) if each.id == fluent), None)

    def _degree(self, relation: str) -> NDArray[np.float64]:
        if relation not in self._degrees:
            self._degrees[relation] = word_degree(pair_geometry(self._boxes), relation, shipped_models())
        return self._degrees[relation]


def _box(fluent: EpisodicFluent) -> NDArray[np.float64] | None:
    """Return the box of a fluent, shape (2, 3); None for a text that is not a box, as others may have written it."""
    try:
        box = np.array(json.loads(fluent.statement.object or ""), dtype=np.float64)
    except ValueError:
        return None
    return box.reshape(2, 3) if box.shape == (6,) and np.isfinite(box).all() else None


def _duration(start: Bounds, finish: Bounds) -> float:
    return finish.upper - start.lower
