"""Find the person who put down, moved or took a thing: the one whose hand was at the thing when its place changed.

The person is found only if one hand was near enough to every place that the change has, came from elsewhere or left
again, and no other hand was as near. Hands that no skeleton shows are possible too; they have a fixed weight.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.perception.pointing.gesture import unit
from deixis.perception.pointing.skeleton import SIDES, Skeleton

Array = NDArray[np.float64]

KEPT_SECONDS = 30.0
"""Time in seconds for which the places of hands are kept."""

SPREAD = 0.05
"""Standard deviation in metres of the distance between a thing and the hand that holds it."""

UNSEEN = 0.05
"""Weight of a hand that no skeleton shows, relative to the weight of a seen hand that touches the thing."""

MIN_PROBABILITY = 0.8
"""Minimum probability of the person who is named."""

MIN_TRAVEL = 0.15
"""Minimum distance in metres by which the hand moves within ``TRAVEL_SECONDS`` before or after it is at the thing."""

TRAVEL_SECONDS = 2.0
"""Time in seconds before and after a contact in which the hand must come or go."""

OUTLIERS = 0.05
"""Share of the frames of a contact whose distances may be too small, because a joint was measured in a wrong place."""

HAND_LENGTH = 0.1
"""Distance in metres from the wrist to the middle of the hand, for skeletons without hands."""


@dataclass(frozen=True, eq=False)
class Contact:
    """A place of a thing that a hand must have reached.

    Attributes
    ----------
    box
        Lower and upper corner of the thing there, shape (2, 3), in metres.
    start, finish
        First and last time in seconds at which the hand may have been there.
    """

    box: Array
    start: float
    finish: float


@dataclass(frozen=True, slots=True)
class Actor:
    """Name of the person who changed the place of a thing, and the probability that it was this person."""

    person: str
    probability: float


class HandLog:
    """Places of the hands of all persons over the last ``KEPT_SECONDS``.

    Examples
    --------
    >>> log = HandLog()
    >>> for number in range(11):
    ...     log.add(Skeleton(number / 10, {"left_hand": (number / 10, 0.0, 0.1)}, "Ada"))
    >>> cup = np.array([[0.46, -0.04, 0.0], [0.54, 0.04, 0.1]])
    >>> log.actor([Contact(cup, 0.3, 0.7)])
    Actor(person='Ada', probability=0.9523809523809523)
    >>> log.actor([Contact(cup + 0.3, 0.3, 0.7)]) is None
    True
    """

    def __init__(self) -> None:
        self._places: dict[tuple[str, str], deque[tuple[float, Array]]] = defaultdict(deque)

    def add(self, skeleton: Skeleton) -> None:
        """Add the hands of a skeleton, and drop those that are too old.

        Parameters
        ----------
        skeleton
            Joints of one person, in the frame of the boxes.
        """
        for side, place in _hands(skeleton):
            known = self._places[skeleton.person, side]
            known.append((skeleton.at, place))
        for key, places in list(self._places.items()):
            while places and places[0][0] < skeleton.at - KEPT_SECONDS:
                places.popleft()
            if not places:
                del self._places[key]

    def actor(self, contacts: Sequence[Contact]) -> Actor | None:
        """Return the person whose one hand was at all places of a change.

        Parameters
        ----------
        contacts
            Where the thing was before, where it was after, or both.

        Returns
        -------
        Actor or None
            The person; None if the probability is below ``MIN_PROBABILITY``.
        """
        weights: dict[str, float] = {}
        for (person, _), places in self._places.items():
            distance = _distance(places, contacts)
            weight = float(np.exp(-0.5 * (distance / SPREAD) ** 2))
            weights[person] = max(weights.get(person, 0.0), weight)
        if not weights:
            return None
        best = max(weights, key=weights.__getitem__)
        probability = weights[best] / (sum(weights.values()) + UNSEEN)
        return Actor(best, probability) if probability >= MIN_PROBABILITY else None


def _hands(skeleton: Skeleton) -> Iterator[tuple[str, Array]]:
    """Yield the place of each hand that was seen."""
    for side in SIDES:
        joints = [skeleton.joints.get(f"{side}_{name}") for name in ("hand_tip", "hand", "wrist", "elbow")]
        tip, hand, wrist, elbow = (None if each is None else np.array(each, dtype=np.float64) for each in joints)
        if tip is not None or hand is not None:
            yield side, tip if tip is not None else hand  # type: ignore[misc]
        elif wrist is not None and elbow is not None:
            yield side, wrist + HAND_LENGTH * unit(wrist - elbow)


def _distance(places: Sequence[tuple[float, Array]], contacts: Sequence[Contact]) -> float:
    """Return the largest distance of a hand from a place that it had to reach; infinity for a hand that stays there."""
    times, points = np.array([at for at, _ in places]), np.array([point for _, point in places])
    largest = 0.0
    for contact in contacts:
        during = np.flatnonzero((times >= contact.start) & (times <= contact.finish))
        if not len(during):
            return np.inf
        outside = np.maximum(np.maximum(contact.box[0] - points[during], points[during] - contact.box[1]), 0.0)
        distances = np.linalg.norm(outside, axis=1)
        nearest = during[distances.argmin()]
        around = np.abs(times - times[nearest]) <= TRAVEL_SECONDS
        if np.linalg.norm(points[around] - points[nearest], axis=1).max() < MIN_TRAVEL:
            return np.inf
        largest = max(largest, float(np.sort(distances)[int(OUTLIERS * len(distances))]))
    return largest
