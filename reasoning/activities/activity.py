"""Activities as temporal relation graphs: steps, and for each pair of steps the Allen relations that it may have.

A described activity states sets of relations; a learned one counts, over its examples, how often each relation held and
how often each step was there. The counts are sums, so the order of the examples does not matter.
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.allen import ALL_ALLEN
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.endpoints import allen_masks, converse_masks, distances_from_bounds
from deixis.reasoning.temporal.fluent import Fluent, Statement

RELATIONS = 13

STEP_PRESENT, RELATION_HOLDS = 0.95, 0.97
"""Probabilities that a described step is carried out, and that a described relation between two steps holds."""

PRIOR = 1.0
"""Weight of the prior of the relations of a pair, as a number of examples."""

STARTS_FIRST = 0b0000000011111
"""Mask of the Allen relations in which the first fluent starts before the second one."""


@dataclass(frozen=True, slots=True)
class Step:
    """A kind of fluent: of a thing, with a predicate and an object, where these are not None.

    ``number`` counts equal steps of one activity in the order in which they start, from 1. Steps are ordered by these
    parts; a part that is None comes first.
    """

    thing: str
    predicate: str | None = None
    object: str | None = None
    number: int = 1

    def fits(self, other: Step) -> bool:
        """Return whether a step of a sequence is one of this kind.

        Parameters
        ----------
        other
            Step of a sequence.

        Returns
        -------
        bool
            True if the thing is equal, and predicate and object are where they are given.
        """
        return (
            self.thing == other.thing
            and self.predicate in (None, other.predicate)
            and self.object in (None, other.object)
        )

    def __lt__(self, other: Step) -> bool:
        """Return whether this step comes before another one."""
        first, second = (
            (each.thing, each.predicate or "", each.object or "", each.number, each.predicate is not None)
            for each in (self, other)
        )
        return first < second

    def __str__(self) -> str:
        words = " ".join(part for part in (self.thing, self.predicate, self.object) if part)
        return f"{words} {self.number}" if self.number > 1 else words


@dataclass(frozen=True, slots=True)
class LaidThing:
    """Thing that was laid: its kind, and the middle of its box in plan (x, y) in metres, or None."""

    kind: str
    place: tuple[float, float] | None


Laying = tuple[LaidThing, ...]
"""Things in the order in which they were laid."""


@dataclass(frozen=True, eq=False)
class StepSequence:
    """Fluents in the order of their starts, with the step that each is and the relations that each pair may have."""

    fluents: tuple[Fluent, ...]
    steps: tuple[Step, ...]

    @classmethod
    def of(cls, fluents: Iterable[Fluent]) -> StepSequence:
        """Return the sequence of some fluents.

        Parameters
        ----------
        fluents
            The fluents, in any order. The things in their statements are named by kinds, with or without numbers.

        Returns
        -------
        StepSequence
            The sequence.
        """
        ordered = tuple(sorted(fluents, key=lambda each: (each.start.lower, each.start.upper, each.id)))
        seen: Counter[tuple[str, str, str | None]] = Counter()
        steps = []
        for each in ordered:
            statement = each.statement
            if box_of(statement) is not None:
                statement = Statement(statement.subject, "placed")
            key = (
                kind_of(statement.subject),
                statement.predicate,
                None if statement.object is None else kind_of(statement.object),
            )
            seen[key] += 1
            steps.append(Step(*key, seen[key]))
        return cls(ordered, tuple(steps))

    @property
    def laying(self) -> Laying:
        """Things in the order of their fluents, with the places that statements of the predicate ``at`` give."""
        places = [box_of(each.statement) for each in self.fluents]
        return tuple(
            LaidThing(step.thing, None if box is None else middle_of(box))
            for step, box in zip(self.steps, places, strict=True)
        )

    @cached_property
    def masks(self) -> NDArray[np.uint16]:
        """Allen relations that each pair may have by the bounds of its ends, shape (n, n)."""
        n = len(self.fluents)
        if n == 0:
            return np.zeros((0, 0), np.uint16)
        distances = distances_from_bounds([each.start for each in self.fluents], [each.finish for each in self.fluents])
        return allen_masks(distances, np.arange(1, n + 1), np.arange(n + 1, 2 * n + 1))

    @cached_property
    def members(self) -> NDArray[np.float64]:
        """Relations of the masks as numbers 0 and 1, shape (n, n, 13)."""
        return members_of(self.masks)

    @property
    def shares(self) -> NDArray[np.float64]:
        """Probability of each relation of each pair if all that are possible are as likely, shape (n, n, 13)."""
        shares: NDArray[np.float64] = self.members / self.members.sum(axis=2, keepdims=True)
        return shares


def kind_of(name: str) -> str:
    """Return the kind in the name of a thing: without its number, and with underscores.

    Parameters
    ----------
    name
        The name.

    Returns
    -------
    str
        The kind.

    Examples
    --------
    >>> kind_of("Wine glass 2"), kind_of("fork_1")
    ('wine_glass', 'fork')
    """
    words = name.replace("_", " ").lower().split()
    return "_".join(words[:-1] if len(words) > 1 and words[-1].isdigit() else words)


def box_of(statement: Statement) -> tuple[float, ...] | None:
    """Return the box in a statement of place from the blackboard.

    Parameters
    ----------
    statement
        Such as ``at(fork, [0.1, 0.2, 0.12, 0.4])``.

    Returns
    -------
    tuple or None
        Lower and upper corner, 4 or 6 numbers in metres; None if it is not a statement of a box.
    """
    if statement.predicate != "at" or statement.object is None:
        return None
    try:
        corners = tuple(map(float, json.loads(statement.object)))
    except (ValueError, TypeError, OverflowError, RecursionError):
        return None
    return corners if len(corners) in (4, 6) and all(map(math.isfinite, corners)) else None


def middle_of(box: tuple[float, ...]) -> tuple[float, float]:
    """Return the middle of a box in plan.

    Parameters
    ----------
    box
        Lower and upper corner, 4 or 6 numbers in metres.

    Returns
    -------
    tuple
        x and y in metres.

    Examples
    --------
    >>> middle_of((0.0, 0.0, 0.0, 0.2, 0.4, 0.1))
    (0.1, 0.2)
    """
    half = len(box) // 2
    return (box[0] + box[half]) / 2, (box[1] + box[half + 1]) / 2


def members_of(masks: NDArray[np.uint16]) -> NDArray[np.float64]:
    """Return masks as arrays over the thirteen relations.

    Parameters
    ----------
    masks
        Masks of any shape.

    Returns
    -------
    ndarray
        1 where the relation is in the mask, else 0; one axis of length 13 more.
    """
    return ((masks[..., None] >> np.arange(RELATIONS)) & 1).astype(np.float64)


def _pooled(
    parts: Iterable[tuple[Sequence[Step], NDArray[np.float64], NDArray[np.float64]]],
) -> tuple[tuple[Step, ...], NDArray[np.uint16], NDArray[np.float64], NDArray[np.float64]]:
    """Return all steps of some parts, unrestricted relations, and the sums of presences (n,) and counts (n, n, 13)."""
    parts = list(parts)
    steps = tuple(sorted({step for names, _, _ in parts for step in names}))
    place, n = {step: number for number, step in enumerate(steps)}, len(steps)
    present, counts = np.zeros(n), np.zeros((n, n, RELATIONS))
    for names, presences, relations in parts:
        at = np.array([place[step] for step in names], dtype=np.int64)
        present[at] += presences
        counts[np.ix_(at, at)] += relations
    return steps, np.full((n, n), ALL_ALLEN, dtype=np.uint16), present, counts


@dataclass(frozen=True, eq=False)
class Activity:
    """A kind of activity.

    Attributes
    ----------
    name
        Its name.
    steps
        Its steps, in order of their names.
    stated
        Masks of the relations that a person stated, shape (n, n); all relations for other pairs.
    present
        Number of examples that have each step, shape (n,).
    counts
        Expected number of examples in which each relation held, shape (n, n, 13).
    examples
        Number of examples; 0 for a described activity.
    layings
        Things with their places, in the order of each example that has any.
    """

    name: str
    steps: tuple[Step, ...]
    stated: NDArray[np.uint16]
    present: NDArray[np.float64]
    counts: NDArray[np.float64]
    examples: int = 0
    layings: tuple[Laying, ...] = ()

    @classmethod
    def in_order(cls, name: str, groups: Sequence[Sequence[Step]]) -> Activity:
        """Return a described activity: the steps of each group start before those of the next one.

        Parameters
        ----------
        name
            Its name.
        groups
            Groups of steps; the order within a group is free.

        Returns
        -------
        Activity
            The activity.

        Raises
        ------
        SettingError
            If there is no step, or a step occurs twice.
        """
        place = {step: number for number, group in enumerate(groups) for step in group}
        if not place or len(place) < sum(map(len, groups)):
            raise SettingError("an activity must have at least one step, and each step once")
        steps = tuple(sorted(place))
        stated = np.full((len(steps),) * 2, ALL_ALLEN, dtype=np.uint16)
        for a, first in enumerate(steps):
            for b, second in enumerate(steps):
                if place[first] < place[second]:
                    stated[a, b] = STARTS_FIRST
        order = np.array([place[step] for step in steps])
        stated = np.where(order[:, None] > order[None], converse_masks(stated.T), stated).astype(np.uint16)
        n = len(steps)
        return cls(name, steps, stated, np.zeros(n), np.zeros((n, n, RELATIONS)))

    @classmethod
    def learned(cls, name: str, examples: Iterable[StepSequence]) -> Activity:
        """Return an activity that was learned from examples, in any order.

        Parameters
        ----------
        name
            Its name.
        examples
            One or more sequences of fluents.

        Returns
        -------
        Activity
            The activity.

        Raises
        ------
        SettingError
            If there is no example, or no example has a fluent.
        """
        examples = list(examples)
        if not any(example.steps for example in examples):
            raise SettingError("an activity is learned from one or more sequences with at least one fluent")
        layings = tuple(example.laying for example in examples if example.steps)
        pooled = _pooled((example.steps, np.ones(len(example.steps)), example.shares) for example in examples)
        return cls(name, *pooled, len(examples), layings)

    def __add__(self, other: Activity) -> Activity:
        """Return the activity of the examples of two learned activities."""
        pooled = _pooled((each.steps, each.present, each.counts) for each in (self, other))
        return Activity(self.name, *pooled, self.examples + other.examples, self.layings + other.layings)

    @property
    def presence(self) -> NDArray[np.float64]:
        """Probability that each step is carried out, shape (n,)."""
        if not self.examples:
            return np.full(len(self.steps), STEP_PRESENT)
        return (self.present + 0.5) / (self.examples + 1.0)

    def relations(self, chance: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the probability of each relation of each pair of steps.

        Parameters
        ----------
        chance
            Probability of each relation of a pair of fluents in general, shape (13,).

        Returns
        -------
        ndarray
            Shape (n, n, 13).
        """
        stated = members_of(self.stated)
        inside = stated * chance
        inside /= inside.sum(axis=2, keepdims=True)
        outside = (1 - stated) * chance
        rest = outside.sum(axis=2, keepdims=True)
        outside = np.divide(outside, rest, out=np.zeros_like(outside), where=rest > 0)
        holds = np.where(rest > 0, RELATION_HOLDS, 1.0)
        prior = holds * inside + (1 - holds) * outside
        total = self.counts.sum(axis=2, keepdims=True)
        found: NDArray[np.float64] = (self.counts + PRIOR * prior) / (total + PRIOR)
        return found

    def usual_order(self) -> tuple[tuple[Step, Step], ...]:
        """Return the pairs of steps in which the first always started first, as described or in all examples.

        Returns
        -------
        tuple of tuple
            Pairs of steps.
        """
        first = members_of(np.array([STARTS_FIRST], np.uint16))[0]
        pairs = []
        for a, b in zip(*np.nonzero(~np.eye(len(self.steps), dtype=bool)), strict=True):
            of = self.counts[a, b].sum()
            stated = self.stated[a, b] != ALL_ALLEN and not int(self.stated[a, b]) & ~STARTS_FIRST
            if stated or (of > 1 and (self.counts[a, b] @ first) >= of - 1e-9):
                pairs.append((self.steps[a], self.steps[b]))
        return tuple(pairs)
