"""Layouts over several tables: the text that describes one, and which relations hold and how things lie on tables.

A layout that a text described on one table, and that lay on others too, is one concept. Of each pair of roles it keeps
how often each wide word held of their things, how far apart they were, and of each role how often it was filled and how
its thing lay. All of it is sums, so the order of the tables does not matter, and a table can be taken back.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.grammar.script import Script
from deixis.learning.lesson import layout_name
from deixis.learning.scene_evidence import graph_evidence, named_by_candidates
from deixis.ontology.facts import Fact
from deixis.ontology.graph import RelationGraph, dispensable
from deixis.ontology.relation import Reading, Relation, Relations
from deixis.ontology.tbox import Ontology
from deixis.perception.scene import OrientedBox, PerceivedObject, Scene
from deixis.reasoning.comparison.explanation import NOTHING, MistakeOdds, TableEvidence
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.candidates import candidate_ratios
from deixis.reasoning.grounding.evidence.meaning import Meaning

Array = NDArray[np.float64]

TOLERANCE = 0.012
"""Overlap of two perceived boxes, in metres, up to which they count as touching."""

COMPARED = ("left", "top", "on")
"""Wide words whose frequencies are kept for each ordered pair of roles; their inverses follow."""

TOLD_HOLDS, TOLD_SUPPORT = 0.998, 0.98
"""Probability that a firm fact of a layout is seen to hold on a table without mistakes, and that of *on* and *under*,
which a small error of heights breaks."""

ELONGATED = 1.7
"""Ratio of the sides of a thing from which it has a direction."""

TURNED_FROM = np.deg2rad(28.0)
"""Angle from which a thing is compared with how it would lie straight."""

TURN_DEVIATION = np.deg2rad(7.0)
"""Standard deviation of the direction of things in their places."""

MIN_TURN_OUTLIERS = 1e-4
"""Least share of things that lie anyhow without a mistake. It is a tenth with no table seen, and a tenth of that with
each further one."""

LEARNED_WEIGHT = 0.5
"""Factor of the evidence of relations that were seen but not told, since those of different pairs depend on each other.
"""


OFFSET_DEVIATION, OFFSET_PRIOR = 0.05, 2.0
"""Prior standard deviation in metres of the offset between two things, and the number of tables that it counts as."""

FLOATING, SUPPORT_ERROR = 0.03, 0.02
"""Height in metres above the table from which a thing must rest on another one, and the error of that one's height."""

SLENDER = 0.02
"""Width in metres below which a thing that is more than twice as high as long cannot stand."""

HEIGHT_ERROR, HEIGHT_DEVIATION, HEIGHT_PRIOR = 0.01, 0.15, 2.0
"""Error of a height in metres, and prior standard deviation of its logarithm with the number of things it counts as."""

HEIGHT_OUTLIERS, HEIGHT_SPREAD = 0.01, 0.8
"""Share of things that are of any height, and the standard deviation of the logarithms of all heights."""

LOOKS_OUTLIERS = 0.002
"""Share of things whose candidates are independent of their names."""

PIECE_SHARE, PIECE_HEIGHT = 0.7, 0.012
"""Share of a thing that lies over another one, and metres by which it rises above it, for a piece of that one."""

OFFSET_OUTLIERS, REACH = 0.02, 0.7
"""Share of offsets that are arbitrary, and side in metres of the area of arbitrary ones."""


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
        On how many tables each role was filled.
    held
        How often each word held of the things of two roles, by word, subject and object.
    apart
        Offset in metres from the thing of the first role to that of the second, in x and y.
    axes
        Cosine and sine of twice the direction of each role's long thing, as sums.
    heights
        Logarithm of the height of each role's thing, see :func:`log_height`.
    """

    tables: int = 0
    filled: Mapping[str, Tally] = field(default_factory=dict)
    held: Mapping[tuple[str, str, str], Tally] = field(default_factory=dict)
    apart: Mapping[Pair, Moments] = field(default_factory=dict)
    axes: Mapping[str, Moments] = field(default_factory=dict)
    heights: Mapping[str, Moments] = field(default_factory=dict)

    def __add__(self, other: Experience) -> Experience:
        return Experience(
            self.tables + other.tables,
            _added(self.filled, other.filled),
            _added(self.held, other.held),
            _added(self.apart, other.apart),
            _added(self.axes, other.axes),
            _added(self.heights, other.heights),
        )

    def __neg__(self) -> Experience:
        return Experience(
            -self.tables,
            {key: -value for key, value in self.filled.items()},
            {key: -value for key, value in self.held.items()},
            {key: -value for key, value in self.apart.items()},
            {key: -value for key, value in self.axes.items()},
            {key: -value for key, value in self.heights.items()},
        )

    @classmethod
    def of_table(cls, roles: Sequence[str], things: Mapping[str, PerceivedObject], relations: Relations) -> Experience:
        """Return the experience of one table.

        Parameters
        ----------
        roles
            All roles of the layout.
        things
            The thing of each filled role.
        relations
            Relations of the ontology.

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
        heights = {name: Moments.of((float(log_height(box)),)) for name, box in zip(names, boxes, strict=True)}
        return cls(1, {role: Tally(float(role in things), 1.0) for role in roles}, held, apart, axes, heights)


def _added(first: Mapping[Key, Value], second: Mapping[Key, Value]) -> dict[Key, Value]:
    total = dict(first)
    for key, value in second.items():
        total[key] = total[key] + value if key in total else value
    return total


def log_height(boxes: Array) -> Array:
    """Return logarithms of the heights of boxes, which differ little for things that are flat.

    Parameters
    ----------
    boxes
        Lower and upper corners in metres, shape (..., 2, 3).

    Returns
    -------
    ndarray
        Natural logarithms of the height in metres plus ``HEIGHT_ERROR``, shape (...).
    """
    height: Array = np.log(boxes[..., 1, 2] - boxes[..., 0, 2] + HEIGHT_ERROR)
    return height


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


def angle_between(first: float, second: float) -> float:
    """Return the angle between two directions without heads.

    Parameters
    ----------
    first, second
        Angles in radians.

    Returns
    -------
    float
        Angle in [0, pi / 2].
    """
    return float(abs((first - second + np.pi / 2) % np.pi - np.pi / 2))


@dataclass(frozen=True, eq=False)
class LearnedLayout:
    """A layout: the script that tells it, and the experience of the tables that were laid so.

    Attributes
    ----------
    name
        Name of the layout.
    script
        Description of the layout.
    experience
        What was seen.
    """

    name: str
    script: Script
    experience: Experience = field(default_factory=Experience)

    @classmethod
    def told(cls, script: Script) -> LearnedLayout:
        """Return the layout of a script, of which nothing was seen.

        Parameters
        ----------
        script
            The script.

        Returns
        -------
        LearnedLayout
            The layout with the name of the script.
        """
        return cls(layout_name(script), script)

    @cached_property
    def graph(self) -> RelationGraph:
        """Roles and told facts."""
        return self.script.graph()

    @property
    def roles(self) -> tuple[str, ...]:
        """Names of the roles."""
        return tuple(self.graph.nodes)

    @cached_property
    def expectations(self) -> tuple[tuple[Relation, int, int, float, float], ...]:
        """Wide relations between roles: the relation, the two roles, the probability that it holds, and its weight.

        Told facts come first, and what follows from them; then what was seen of other pairs.
        """
        relations, graph = self.graph.vocabulary, self.graph
        found: dict[tuple[int, int, int], tuple[Relation, int, int, float, float]] = {}
        for fact in self._told():
            (relation,), a, b = fact.relations, graph.index(fact.subject), graph.index(fact.object)
            holds = TOLD_SUPPORT if relation.word in ("on", "under") else TOLD_HOLDS
            share = fact.weight * holds + (1 - fact.weight) * 0.5
            found[relation.index, a, b] = (relation, a, b, share, 1.0)
        for (word, first, second), tally in sorted(self.experience.held.items()):
            if first not in graph.nodes or second not in graph.nodes:
                continue
            relation, a, b = relations[word], graph.index(first), graph.index(second)
            inverse = relations[relation.inverse]
            if (relation.index, a, b) not in found and (inverse.index, b, a) not in found and tally.of > 0:
                found[relation.index, a, b] = (relation, a, b, tally.probability, LEARNED_WEIGHT)
        return tuple(found.values())

    def _told(self) -> Iterator[Fact]:
        """Yield the facts of wide words that the script states or implies, each unordered pair and word once."""
        graph = self.graph
        implied = Implications(graph)
        done: set[tuple[str, str, str]] = set()
        derived = (Fact(s, (relation,), o) for relation, s, o in implied.triples())
        for fact in (*graph.facts(), *derived):
            if len(fact.relations) != 1 or not fact.positive or fact.subject == fact.object:
                continue
            (relation,) = fact.relations
            if relation.reading is not Reading.WIDE:
                continue
            key = (relation.name, fact.subject, fact.object)
            if key not in done and (relation.inverse, fact.object, fact.subject) not in done:
                done.add(key)
                yield fact

    def axis(self, role: str) -> float | None:
        """Return the direction in which the thing of a role usually lies.

        Parameters
        ----------
        role
            The role.

        Returns
        -------
        float or None
            Angle from the x axis in radians, in [0, pi); None if it is round, unknown or varies.
        """
        seen = self.experience.axes.get(role)
        if seen is None or seen.count < 0.5:
            return None
        cosine, sine = seen.mean
        if np.hypot(cosine, sine) < 0.7:
            return None
        return float(np.arctan2(sine, cosine) / 2 % np.pi)

    def evidence(
        self, scene: Scene, ontology: Ontology, meaning: Meaning, odds: MistakeOdds | None = None
    ) -> TableEvidence:
        """Return the evidence of the layout for a table.

        Parameters
        ----------
        scene
            The table, with the names that things may have.
        ontology
            Words, kinds and sizes.
        meaning
            Learned words and sizes.
        odds
            Log-odds of mistakes; the default ones if None.

        Returns
        -------
        TableEvidence
            Evidence for :func:`deixis.reasoning.comparison.explanation.explain`.
        """
        known = graph_evidence(self.graph, scene, ontology, meaning)
        ranked = [dict(thing.candidates) if named_by_candidates(thing) else None for thing in scene.objects]
        looks = candidate_ratios(self.graph, ranked, ontology.kinds, LOOKS_OUTLIERS)
        identity = np.where([each is not None for each in ranked], looks, known.labels) + known.sizes
        if known.colours is not None:
            identity = identity + known.colours
        identity = identity + self._heights(scene.boxes)
        boxes, turn, straight = self._poses(scene)
        ends, kinds, tables = self._tables(boxes, len(scene.objects), ontology.relations)
        spare = dispensable(self.graph.facts())
        optional = np.array([role in spare for role in self.roles], dtype=bool)
        low, high = scene.boxes[:, 0, :2], scene.boxes[:, 1, :2]
        over = np.all((low[:, None] < high[None]) & (low[None] < high[:, None]), axis=2)
        pieces = _pieces(scene.boxes)
        return TableEvidence(
            identity, turn, straight, ends, kinds, tables, optional, np.logical_not(over), pieces, odds or MistakeOdds()
        )

    def _poses(self, scene: Scene) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return boxes of all poses (p, 2, 3), the evidence of directions (n, p) and the straightened poses (n, m)."""
        n, m = len(self.roles), len(scene.objects)
        boxes = [np.array((thing.minimum, thing.maximum)) for thing in scene.objects]
        straight = np.full((n, m), NOTHING, dtype=np.int64)
        turn: list[Array] = [np.zeros(n) for _ in range(m)]
        usual = [self.axis(role) for role in self.roles]
        made: dict[tuple[int, int], int] = {}
        for t, thing in enumerate(scene.objects):
            seen = long_axis(thing)
            if seen is None or thing.oriented is None:
                continue
            for i, axis in enumerate(usual):
                if axis is None:
                    continue
                away = angle_between(seen, axis)
                likely = np.exp(-0.5 * (away / TURN_DEVIATION) ** 2) * np.sqrt(np.pi / 2) / TURN_DEVIATION
                outliers = max(MIN_TURN_OUTLIERS, 10.0 ** -(1 + self.experience.axes[self.roles[i]].count))
                turn[t][i] = float(np.log((1 - outliers) * likely + outliers))
                if away > TURNED_FROM:
                    key = (t, round(float(np.rad2deg(axis)) / 15) % 12)
                    if key not in made:
                        made[key] = len(boxes)
                        boxes.append(_lying(thing.oriented, axis, boxes[t]))
                        turn.append(np.zeros(n))
                    straight[i, t] = made[key]
        return np.array(boxes).reshape(len(boxes), 2, 3), np.stack(turn, axis=1), straight

    def _heights(self, boxes: Array) -> Array:
        """Return the evidence of heights for each role's thing being each box, shape (n, m)."""
        measured = log_height(boxes)
        evidence = np.zeros((len(self.roles), len(boxes)))
        chance = np.exp(-0.5 * ((measured - measured.mean()) / HEIGHT_SPREAD) ** 2) / HEIGHT_SPREAD
        for place, role in enumerate(self.roles):
            seen = self.experience.heights.get(role)
            if seen is None or seen.count < 0.5:
                continue
            n, own = seen.count, float(seen.deviation[0])
            variance = (n * own**2 + HEIGHT_PRIOR * HEIGHT_DEVIATION**2) / (n + HEIGHT_PRIOR) * (1 + 1 / n)
            likely = np.exp(-0.5 * (measured - seen.mean[0]) ** 2 / variance) / np.sqrt(variance)
            evidence[place] = np.log((1 - HEIGHT_OUTLIERS) * likely / chance + HEIGHT_OUTLIERS)
        return evidence

    def _offsets(self, boxes: Array, things: int) -> Iterator[tuple[int, int, Array]]:
        """Yield pairs of roles that a told fact relates, and the evidence of the offset of each pair of poses."""
        graph = self.graph
        centres = boxes.mean(axis=1)[:, :2]
        offset = centres[None, :] - centres[:, None]  # (p, p, 2)
        told = {tuple(sorted((fact.subject, fact.object))) for fact in graph.facts() if fact.subject != fact.object}
        for first, second in sorted(told):
            seen = self.experience.apart.get((first, second))
            if seen is None or seen.count < 1.5:
                continue
            n = seen.count
            variance = (n * seen.deviation**2 + OFFSET_PRIOR * OFFSET_DEVIATION**2) / (n + OFFSET_PRIOR) * (1 + 1 / n)
            distance = ((offset - seen.mean) ** 2 / variance).sum(axis=2)
            density = np.exp(-0.5 * distance) / (2 * np.pi * np.sqrt(variance.prod()))
            table = np.log((1 - OFFSET_OUTLIERS) * density * REACH**2 + OFFSET_OUTLIERS)
            np.fill_diagonal(table, 0.0)
            yield graph.index(first), graph.index(second), table

    def _tables(
        self, boxes: Array, things: int, relations: Relations
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
        """Return the roles of each expectation, its table, and the tables of log-likelihood ratios."""
        ends: list[tuple[int, int]] = []
        kinds: list[int] = []
        tables: list[Array] = []
        place: dict[tuple[int, float, float], int] = {}
        names = box_relations(boxes, relations, TOLERANCE).names if len(boxes) > 1 else np.zeros((1, 1), np.int8)
        for relation, a, b, share, weight in self.expectations:
            key = (relation.index, share, weight)
            if key not in place:
                holds = relations.degrees[relation.index][names] > 0
                np.fill_diagonal(holds, False)
                pairs = max(things * (things - 1), 1)
                chance = (float(holds[:things, :things].sum()) + 0.5) / (pairs + 1.0)
                values: Array = np.full(holds.shape, np.log((1 - share) / (1 - chance)))
                values[holds] = np.log(share / chance)
                table = weight * values
                np.fill_diagonal(table, 0.0)
                place[key] = len(tables)
                tables.append(table)
            ends.append((a, b))
            kinds.append(place[key])
        for a, b, table in self._offsets(boxes, things):
            ends.append((a, b))
            kinds.append(len(tables))
            tables.append(table)
        p = len(boxes)
        return (
            np.array(ends, dtype=np.int64).reshape(-1, 2),
            np.array(kinds, dtype=np.int64),
            np.array(tables, dtype=np.float64).reshape(-1, p, p),
        )


def _pieces(boxes: Array) -> NDArray[np.bool_]:
    """Return which boxes are probably pieces of other things.

    A piece lies mostly within another box in plan without rising above it, or it floats above the table and nothing
    supports it, or it is too slender to stand.
    """
    low, high = boxes[:, 0], boxes[:, 1]
    area = np.prod(high[:, :2] - low[:, :2], axis=1)
    shared = np.prod(
        np.clip(
            np.minimum(high[:, None, :2], high[None, :, :2]) - np.maximum(low[:, None, :2], low[None, :, :2]), 0, None
        ),
        axis=2,
    )
    within = (shared >= PIECE_SHARE * area[:, None]) & (area[:, None] < area[None, :])
    flat = high[:, None, 2] <= high[None, :, 2] + PIECE_HEIGHT
    under = (shared > 0) & (np.abs(low[:, None, 2] - high[None, :, 2]) < SUPPORT_ERROR)
    np.fill_diagonal(under, False)
    floats = (low[:, 2] > FLOATING) & ~under.any(axis=1)
    size = high - low
    slender = (size[:, :2].min(axis=1) < SLENDER) & (size[:, 2] > 2 * size[:, :2].max(axis=1))
    found: NDArray[np.bool_] = (within & flat).any(axis=1) | floats | slender
    return found


def _lying(thing: OrientedBox, axis: float, seen: Array) -> Array:
    """Return the box around a thing that is turned about its centre so that its long side has a direction."""
    length, width = max(thing.extents[:2]), min(thing.extents[:2])
    cosine, sine = abs(np.cos(axis)), abs(np.sin(axis))
    half = np.array([cosine * length + sine * width, sine * length + cosine * width]) / 2
    centre = np.array(thing.centre[:2])
    box = seen.copy()
    box[0, :2], box[1, :2] = centre - half, centre + half
    return box
