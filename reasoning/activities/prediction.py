"""Predict what is laid next, and where, from examples of laid tables and from the order that a person stated.

Order. For each pair of steps, three hypotheses are compared: the first always comes before the second, the second
before the first, or their order is free. The examples give their posterior, and a stated order a strong prior. A step
can come next if no step that must come before it is still to come. Among those, a step is the more probable the more
often it was laid at all, and the more often it directly followed the step that was laid last.

Place. The offset of a thing from each thing that is there already, and from the origin of the table, has a mean and a
spread over the examples. The offsets with the least spread decide: a fork keeps its distance from the plate and not
from the edge of the table.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer
from deixis.reasoning.activities.activity import RELATION_HOLDS, STARTS_FIRST, Activity, LaidThing, Laying
from deixis.reasoning.errors import SettingError

STRICT = 0.1
"""Prior probability that one given step of a pair always comes before the other one."""

SLIP = 0.05
"""Probability that a person lays two things in an order other than her usual one."""

FOLLOWING = 8.0
"""Weight of the uniform prior of the next step, as a number of observations."""

SPREAD, SPREAD_WEIGHT = 0.06, 1.0
"""Prior standard deviation of an offset in metres, and the weight of this prior as a number of observations."""

TAKEN = 0.04
"""Distance in metres from a thing of an equal kind within which a place is taken."""

TABLE = "table"
"""Name of the reference of places that every table has."""

Item = tuple[str, int]
"""Kind of a thing, and its number among those of the kind in the order in which they are laid, from 1."""


@dataclass(frozen=True, slots=True)
class NextPlace:
    """Predicted place of a thing.

    Parameters
    ----------
    place
        Position in plan (x, y), in metres.
    spread
        Standard deviation along each axis, in metres.
    anchor
        Kind of the thing whose offset decides most, or ``table``.
    offset
        Position relative to the anchor (x, y), in metres.
    """

    place: tuple[float, float]
    spread: float
    anchor: str
    offset: tuple[float, float]


@dataclass(frozen=True, slots=True)
class NextThing:
    """Thing that may be laid next: its kind, the probability of that, and its place or None if none was learned."""

    kind: str
    probability: float
    place: NextPlace | None


@dataclass(frozen=True, repr=False)
class Prediction(Answer):
    """Things that may come next, most probable first, and the probability that nothing more comes."""

    activity: str
    laid: tuple[str, ...]
    things: tuple[NextThing, ...]
    finished: float

    def summary(self) -> str:
        """Return the most probable continuation with its probability."""
        if not self.things or self.finished > self.things[0].probability:
            return f"nothing more, probability {self.finished:.2f}"
        return f"{self.things[0].kind}, probability {self.things[0].probability:.2f}"


class LayingModel:
    """Model of the order and the places in which things are laid.

    Parameters
    ----------
    examples
        Layings from start to end. Their order does not matter.
    described
        Order that a person stated, or None.
    name
        Name of the activity, which predictions carry.

    Raises
    ------
    SettingError
        If there is neither an example nor a stated order.

    Examples
    --------
    >>> plate, fork, knife = (LaidThing(kind, None) for kind in ("plate", "fork", "knife"))
    >>> model = LayingModel([(plate, fork, knife), (plate, knife, fork)])
    >>> model.predict(()).summary()
    'plate, probability 0.54'
    >>> sorted(thing.kind for thing in model.predict((plate,)).things)
    ['fork', 'knife']
    """

    def __init__(self, examples: Sequence[Laying], described: Activity | None = None, name: str = "laying") -> None:
        self._name = name
        self._examples = [tuple(example) for example in examples if example]
        orders = [_numbered(example) for example in self._examples]
        stated_items = () if described is None else tuple((step.thing, step.number) for step in described.steps)
        self._items: tuple[Item, ...] = tuple(sorted({item for order in orders for item in order} | set(stated_items)))
        if not self._items:
            raise SettingError("a prediction needs at least one example of a laying, or a stated order")
        at = {item: number for number, item in enumerate(self._items)}
        n = len(self._items)
        self._before, self._present = np.zeros((n, n)), np.zeros(n)
        self._follows = np.zeros((n + 1, n))  # the last row is that of the start
        for order in orders:
            numbers = np.array([at[item] for item in order])
            self._present[numbers] += 1
            self._before[np.ix_(numbers, numbers)] += np.triu(np.ones((len(numbers),) * 2), 1)
            self._follows[np.append(-1, numbers[:-1]) % (n + 1), numbers] += 1
        self._at = at
        self._first = self._must_be_first(described, stated_items)

    def predict(self, laid: Laying) -> Prediction:
        """Predict what is laid next.

        Parameters
        ----------
        laid
            Things that were laid so far, in their order.

        Returns
        -------
        Prediction
            Kinds with probabilities and places; with the probability that nothing more comes, they sum to 1.
        """
        order = _numbered(laid)
        there = [self._at[item] for item in order if item in self._at]
        left = np.array([number for number in range(len(self._items)) if number not in there], dtype=np.int64)
        coming = self._still_coming(there, left)
        finished = float(np.prod(1 - coming))
        must = coming[:, None] * self._first[np.ix_(left, left)] * (1 - SLIP)
        free = np.prod(1 - must, axis=0) if len(left) else np.zeros(0)
        overdue = 1 - np.prod(1 - self._first[np.ix_(left, np.array(there, dtype=np.int64))], axis=1)
        weights = coming * free * self._succession(self._at.get(order[-1]) if order else -1, left, overdue)
        counts = Counter(kind for kind, _ in order)
        chances: dict[str, float] = {}
        for number, weight in zip(left.tolist(), weights.tolist(), strict=True):
            kind, rank = self._items[number]
            if rank == counts[kind] + 1:
                chances[kind] = weight
        total = sum(chances.values())
        things = [
            NextThing(kind, (1 - finished) * chance / total, self.place(kind, laid))
            for kind, chance in chances.items()
            if total > 0
        ]
        things.sort(key=lambda each: (-each.probability, each.kind))
        return Prediction(
            self._name, tuple(thing.kind for thing in laid), tuple(things), finished if total > 0 else 1.0
        )

    def place(self, kind: str, laid: Laying) -> NextPlace | None:
        """Predict the place of the next thing of a kind.

        Parameters
        ----------
        kind
            The kind.
        laid
            Things that are there.

        Returns
        -------
        NextPlace or None
            The place of that thing of the kind in the examples, counted from the left, that is still free and was
            there most often; None if no example has a place of the kind.
        """
        ranks = max((sum(_is(thing, kind) for thing in example) for example in self._examples), default=0)
        taken = [np.array(thing.place) for thing in laid if _is(thing, kind)]
        free = []
        for rank in range(ranks):
            found = self._place(kind, rank, laid)
            if found is not None:
                often, place = found
                near = min((float(np.linalg.norm(np.array(place.place) - other)) for other in taken), default=np.inf)
                free.append((near < max(TAKEN, place.spread), -often, rank, place))
        return min(free, key=lambda each: each[:3])[3] if free else None

    def _must_be_first(self, described: Activity | None, stated_items: Sequence[Item]) -> NDArray[np.float64]:
        """Return the posterior probability (n, n) that one step always comes before another one."""
        n = len(self._items)
        prior = np.full((n, n), STRICT)
        if described is not None:
            for a, one in enumerate(stated_items):
                for b, other in enumerate(stated_items):
                    if described.stated[a, b] == STARTS_FIRST:
                        i, j = self._at[one], self._at[other]
                        prior[i, j], prior[j, i] = RELATION_HOLDS, (1 - RELATION_HOLDS) / 2
        yes, no = self._before, self._before.T
        first = np.log(prior) + yes * math.log(1 - SLIP) + no * math.log(SLIP)
        free = np.log(1 - prior - prior.T) + (yes + no) * math.log(0.5)
        found: NDArray[np.float64] = np.exp(first - np.logaddexp(np.logaddexp(first, first.T), free))
        np.fill_diagonal(found, 0.0)
        for (kind, number), i in self._at.items():  # things of one kind are numbered in their order
            for (same, later), j in self._at.items():
                if kind == same and number != later:
                    found[i, j] = float(number < later)
        return found

    def _still_coming(self, there: Sequence[int], left: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the probability that each step that is left is still to come.

        A step that was only stated, without examples, is expected. A step was probably left out if steps that it should
        precede have been laid already.
        """
        examples = len(self._examples)
        seen = self._present[left]
        usual = np.where(seen > 0, (seen + 0.5) / (examples + 1.0), RELATION_HOLDS)
        odds = usual / (1 - usual)
        late = self._first[np.ix_(left, np.array(there, dtype=np.int64))]
        odds = odds * np.prod(late * SLIP + (1 - late), axis=1)
        coming: NDArray[np.float64] = odds / (1 + odds)
        return coming

    def _succession(
        self, last: int | None, left: NDArray[np.int64], overdue: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return how much more often than by chance each step that is left followed the last one directly.

        A step that is overdue, because two were swapped, follows whatever was laid last: what followed in the examples
        did so when the step was done.
        """
        if last is None or not len(left):
            return np.ones(len(left))
        counts = self._follows[last, left]
        found = (counts * len(left) + FOLLOWING) / (counts.sum() + FOLLOWING)
        mixed: NDArray[np.float64] = (1 - overdue) * found + overdue * found.max()
        return mixed

    def _place(self, kind: str, rank: int, laid: Laying) -> tuple[int, NextPlace] | None:
        """Return how often the thing of a kind and a rank from the left was there, and its place."""
        single = [each.kind for each in laid if each.place is not None and self._is_single(each.kind, laid)]
        often, found = 0, []
        for anchor in (TABLE, *single):
            offsets = np.array([
                np.subtract(own, other)
                for example in self._examples
                for own in [_ranked(example, kind, rank)]
                for other in [(0.0, 0.0) if anchor == TABLE else _ranked(example, anchor, 0)]
                if own is not None and other is not None
            ])  # fmt: skip
            if not len(offsets):
                continue
            often = max(often, len(offsets))
            mean, count = offsets.mean(axis=0), len(offsets)
            square = ((offsets - mean) ** 2).sum() / 2
            variance = (square + SPREAD_WEIGHT * SPREAD**2) / (count - 0.5 + SPREAD_WEIGHT) * (1 + 1 / count)
            here = np.zeros(2) if anchor == TABLE else np.array(_ranked(laid, anchor, 0))
            found.append((float(variance), anchor, mean, here))
        if not found:
            return None
        variances = np.array([each[0] for each in found])
        weights = variances**-2 / (variances**-2).sum()
        place = sum(weight * (each[2] + each[3]) for weight, each in zip(weights, found, strict=True))
        best = found[int(weights.argmax())]
        x, y = np.asarray(place).tolist()
        dx, dy = (np.asarray(place) - best[3]).tolist()
        return often, NextPlace((x, y), float(np.sqrt(weights @ variances)), best[1], (dx, dy))

    def _is_single(self, kind: str, laid: Laying) -> bool:
        """Return True if there is never more than one thing of a kind, so that it is known which one it is."""
        return all(sum(thing.kind == kind for thing in each) <= 1 for each in (*self._examples, laid))


def _numbered(laying: Laying) -> tuple[Item, ...]:
    counts: Counter[str] = Counter()
    items = []
    for thing in laying:
        counts[thing.kind] += 1
        items.append((thing.kind, counts[thing.kind]))
    return tuple(items)


def _is(thing: LaidThing, kind: str) -> bool:
    return thing.kind == kind and thing.place is not None


def _ranked(laying: Laying, kind: str, rank: int) -> tuple[float, float] | None:
    """Return the place of the thing of a kind that is at a rank from the left, or None."""
    places = sorted(thing.place for thing in laying if thing.kind == kind and thing.place is not None)
    return places[rank] if rank < len(places) else None
