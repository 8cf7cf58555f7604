"""Counts over tables of one layout: which relations hold, how far apart things are, how they lie, how large they are.

All of it is sums, so the order of the tables does not matter, and a table can be taken back.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.ontology.relations.relation import Relations
from deixis.perception.scene import PerceivedObject
from deixis.reasoning.geometry.rectangle import box_relations

Array = NDArray[np.float64]

TOLERANCE = 0.012
"""Overlap of two perceived boxes, in metres, up to which they count as touching."""

COMPARED = ("left", "top", "on")
"""Wide words whose frequencies are kept for each ordered pair of roles; their inverses follow."""

ELONGATED = 1.7
"""Minimum ratio of the sides of a thing at which it has a direction."""

SIZE_ERROR = 0.01
"""Error of a size, in metres."""

MIN_POOLED = 4
"""Minimum number of quantities, each measured more than once, from whose deviations a prior is fitted."""

MAX_SPREAD_WEIGHT = 20.0
"""Maximum weight of a fitted prior, as a number of values."""

COVERED = 0.5
"""Minimum share of a thing in plan above another thing at which its height is measured from its lower end.

Below this share, it is measured from the table, since the sides of a thing may be hidden by its top.
"""


@dataclass(frozen=True)
class Tally:
    """Number of tables on which a statement could be compared, and on how many of them it held."""

    held: float = 0.0
    of: float = 0.0

    def __add__(self, other: Tally) -> Tally:
        return Tally(self.held + other.held, self.of + other.of)

    def __neg__(self) -> Tally:
        return Tally(-self.held, -self.of)

    @property
    def is_empty(self) -> bool:
        """True if no table is counted."""
        return self.of == 0

    @property
    def probability(self) -> float:
        """Posterior mean that it holds on the next table, with the prior of Jeffreys."""
        return (self.held + 0.5) / (self.of + 1.0)


@dataclass(frozen=True)
class Moments:
    """Sums of a vector of numbers and of their squares, for means and deviations."""

    count: float = 0.0
    total: tuple[float, ...] = (0.0, 0.0)
    squares: tuple[float, ...] = (0.0, 0.0)

    @classmethod
    def of(cls, values: Sequence[float]) -> Moments:
        """Return the sums of one vector.

        Parameters
        ----------
        values
            The numbers.

        Returns
        -------
        Moments
            Count 1, the numbers, and their squares.
        """
        return cls(1.0, tuple(values), tuple(value * value for value in values))

    def __add__(self, other: Moments) -> Moments:
        return Moments(
            self.count + other.count,
            tuple(a + b for a, b in zip(self.total, other.total, strict=True)),
            tuple(a + b for a, b in zip(self.squares, other.squares, strict=True)),
        )

    def __neg__(self) -> Moments:
        return Moments(-self.count, tuple(-a for a in self.total), tuple(-a for a in self.squares))

    @property
    def is_empty(self) -> bool:
        """True if no vector is counted."""
        return self.count == 0

    @property
    def mean(self) -> Array:
        """Mean of each number."""
        return np.array(self.total) / self.count

    @property
    def deviation(self) -> Array:
        """Standard deviation of each number."""
        return np.sqrt(np.maximum(np.array(self.squares) / self.count - self.mean**2, 0.0))


Pair = tuple[str, str]
Key = TypeVar("Key")
Value = TypeVar("Value", Tally, Moments)


@dataclass(frozen=True)
class Experience:
    """Sums over tables of one layout, to which tables are added and from which they are taken.

    Attributes
    ----------
    tables
        Number of tables.
    filled
        On how many tables each role was filled. A thing counts as there if it is not known which one it is.
    held
        How often each word held of the things of two roles, by word, subject and object.
    apart
        Offset in metres from the thing of the first role to that of the second, in x and y.
    axes
        Cosine and sine of twice the direction of each role's long thing, as sums.
    sizes
        Logarithms of the sizes of each role's thing, see :func:`log_sizes`.
    """

    tables: int = 0
    filled: Mapping[str, Tally] = field(default_factory=dict)
    held: Mapping[tuple[str, str, str], Tally] = field(default_factory=dict)
    apart: Mapping[Pair, Moments] = field(default_factory=dict)
    axes: Mapping[str, Moments] = field(default_factory=dict)
    sizes: Mapping[str, Moments] = field(default_factory=dict)

    def __add__(self, other: Experience) -> Experience:
        return Experience(
            self.tables + other.tables,
            _added(self.filled, other.filled),
            _added(self.held, other.held),
            _added(self.apart, other.apart),
            _added(self.axes, other.axes),
            _added(self.sizes, other.sizes),
        )

    def __neg__(self) -> Experience:
        return Experience(
            -self.tables,
            {key: -value for key, value in self.filled.items()},
            {key: -value for key, value in self.held.items()},
            {key: -value for key, value in self.apart.items()},
            {key: -value for key, value in self.axes.items()},
            {key: -value for key, value in self.sizes.items()},
        )

    def offset(self, first: str, second: str) -> Array | None:
        """Return the mean offset from the thing of one role to that of another.

        Parameters
        ----------
        first, second
            The roles.

        Returns
        -------
        ndarray or None
            Offset in x and y, in metres; None if the two were never seen together.
        """
        if (first, second) in self.apart:
            return self.apart[first, second].mean
        return -self.apart[second, first].mean if (second, first) in self.apart else None

    def size(self, role: str) -> Array | None:
        """Return the mean size of the thing of a role, along the x and y axes as it mostly lay.

        Parameters
        ----------
        role
            The role.

        Returns
        -------
        ndarray or None
            Extents in x and y, in metres; None if no thing of the role was seen.
        """
        if role not in self.sizes:
            return None
        length, width, _ = np.exp(self.sizes[role].mean) - SIZE_ERROR
        cosine, sine = self.axes[role].mean if role in self.axes else (1.0, 0.0)
        direction = np.arctan2(sine, cosine) / 2
        along, across = abs(np.cos(direction)), abs(np.sin(direction))
        return np.array([length * along + width * across, length * across + width * along])

    @classmethod
    def of_table(
        cls,
        roles: Sequence[str],
        things: Mapping[str, PerceivedObject],
        relations: Relations,
        present: Collection[str] = (),
    ) -> Experience:
        """Return the experience of one table.

        Parameters
        ----------
        roles
            All roles that were described.
        things
            The thing of each role whose thing is known.
        relations
            Relations of the ontology.
        present
            Roles whose thing is on the table, whichever it is.

        Returns
        -------
        Experience
            Sums over one table.
        """
        names = sorted(things)
        boxes = np.array([(things[name].minimum, things[name].maximum) for name in names])
        held: dict[tuple[str, str, str], Tally] = {}
        apart: dict[Pair, Moments] = {}
        if len(names) > 1:
            found = box_relations(boxes, relations, TOLERANCE).names
            centres = boxes.mean(axis=1)
            for word in COMPARED:
                degrees = relations.degrees[relations[word].index]
                for a, first in enumerate(names):
                    for b, second in enumerate(names):
                        if a != b:
                            held[word, first, second] = Tally(float(degrees[found[a, b]] > 0), 1.0)
            for a, first in enumerate(names):
                for b, second in enumerate(names[:a]):
                    apart[second, first] = Moments.of((centres[a] - centres[b])[:2].tolist())
        axes = {}
        for name in names:
            direction = long_axis(things[name])
            if direction is not None:
                axes[name] = Moments.of((float(np.cos(2 * direction)), float(np.sin(2 * direction))))
        measured = log_sizes([things[name] for name in names]).tolist()
        sizes = {name: Moments.of(values) for name, values in zip(names, measured, strict=True)}
        filled = {role: Tally(float(role in things or role in present), 1.0) for role in roles}
        return cls(1, filled, held, apart, axes, sizes)


def _added(first: Mapping[Key, Value], second: Mapping[Key, Value]) -> dict[Key, Value]:
    total = dict(first)
    for key, value in second.items():
        total[key] = total[key] + value if key in total else value
        if total[key].is_empty:  # all of it was taken back
            del total[key]
    return total


def log_sizes(things: Sequence[PerceivedObject]) -> Array:
    """Return logarithms of the length, width and height of things on one table, which differ little for small ones.

    Parameters
    ----------
    things
        The things, with boxes in metres.

    Returns
    -------
    ndarray
        Natural logarithms of the sizes in metres plus ``SIZE_ERROR``, shape (n, 3).
    """
    if not things:
        return np.zeros((0, 3))
    boxes = np.array([(thing.minimum, thing.maximum) for thing in things])
    low, high = boxes[:, 0], boxes[:, 1]
    shared = np.minimum(high[:, None, :2], high[None, :, :2]) - np.maximum(low[:, None, :2], low[None, :, :2])
    area = np.prod(high[:, :2] - low[:, :2], axis=1)
    over = np.prod(np.clip(shared, 0, None), axis=2) >= COVERED * area[:, None]
    resting = (over & (high[None, :, 2] < high[:, None, 2])).any(axis=1)
    plan = [
        sorted(size[:2] if thing.oriented is None else thing.oriented.extents[:2], reverse=True)
        for thing, size in zip(things, (high - low).tolist(), strict=True)
    ]
    height = np.maximum(high[:, 2] - np.where(resting, low[:, 2], 0.0), 0.0)  # a tracked thing may be below the table
    found: Array = np.log(np.column_stack([plan, height]) + SIZE_ERROR)
    return found


@dataclass(frozen=True)
class Spread:
    """Prior of the deviations of several quantities of one kind: usual deviation of each component, and its weight.

    Attributes
    ----------
    deviations
        Usual standard deviation of each component.
    weight
        Number of values as which the prior counts.
    """

    deviations: tuple[float, ...]
    weight: float

    def fitted(self, seen: Iterable[Moments], error: float) -> Spread:
        """Return the prior that the deviations of some quantities suggest; this one where they are too few.

        Parameters
        ----------
        seen
            Moments of each quantity.
        error
            Standard deviation of the error of one measurement.

        Returns
        -------
        Spread
            The prior with the greatest marginal likelihood, by moments.

        Notes
        -----
        The sample variances are scaled F variables if the true ones have a scaled inverse chi-square distribution. Its
        scale and its degrees of freedom follow from the mean and the variance of their logarithms: G. K. Smyth, "Linear
        models and empirical Bayes methods", Statistical Applications in Genetics and Molecular Biology 3, 2004.
        """
        from scipy.special import digamma, polygamma

        several = [one for one in seen if one.count > 1.5]
        if len(several) < MIN_POOLED:
            return self
        free = np.array([one.count - 1 for one in several])[:, None]
        variances = np.stack([one.deviation for one in several]) ** 2 * (free + 1) / free + error**2
        logs = np.log(variances) - digamma(free / 2) + np.log(free / 2)
        middle = logs.mean(axis=0)
        excess = float((logs - middle).var(axis=0, ddof=1).mean() - polygamma(1, free / 2).mean())
        weight = MAX_SPREAD_WEIGHT if excess <= 0 else min(2 * _inverse_trigamma(excess), MAX_SPREAD_WEIGHT)
        scale = np.exp(middle + digamma(weight / 2) - np.log(weight / 2))
        return Spread(tuple(np.sqrt(scale).tolist()), weight)


def _inverse_trigamma(value: float) -> float:
    """Return the number whose trigamma function is a positive value, by Newton's method."""
    from scipy.special import polygamma

    found = 0.5 + 1 / value
    for _ in range(20):
        trigamma = float(polygamma(1, found))
        found += trigamma * (1 - trigamma / value) / float(polygamma(2, found))
    return found


def predictive(values: Array, seen: Moments, prior: Spread, error: float = 0.0, moved: float = 0.0) -> Array:
    """Return the density of the next value of a quantity, for values of which some were seen.

    Parameters
    ----------
    values
        Values at which it is wanted, shape (..., d).
    seen
        Values that were seen, at least one.
    prior
        Prior of the deviations.
    error
        Standard deviation of the error of one measurement, which no value is more exact than.
    moved
        Standard deviation of what the next value differs by besides.

    Returns
    -------
    ndarray
        Density of each component, shape (..., d): that of Student's t, whose tails are long as long as few were seen.

    Notes
    -----
    Student's t is the posterior predictive distribution of a normal quantity of unknown mean and variance: A. Gelman
    and others, *Bayesian Data Analysis*, chapter 3. Here the prior spreads the deviation and leaves the mean as it was
    seen.
    """
    from scipy.stats import t

    n, weight = seen.count, prior.weight
    squares = n * seen.deviation**2 + (n - 1) * error**2 + weight * np.array(prior.deviations) ** 2
    free = n - 1 + weight
    density: Array = t.pdf(values, free, seen.mean, np.sqrt(squares / free * (1 + 1 / n) + moved**2))
    return density


def long_axis(thing: PerceivedObject) -> float | None:
    """Return the direction of the long side of a thing.

    Parameters
    ----------
    thing
        The thing.

    Returns
    -------
    float or None
        Angle from the x axis in radians, in [0, pi); None for a thing that is about as long as wide.
    """
    if thing.oriented is None:
        return None
    first, second, _ = thing.oriented.extents
    if max(first, second) < ELONGATED * max(min(first, second), 1e-6):
        return None
    return float((thing.oriented.yaw + (0.0 if first >= second else np.pi / 2)) % np.pi)
