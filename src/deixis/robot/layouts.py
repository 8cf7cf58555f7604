"""Layouts over several tables: the text that describes one, and which relations hold and how things lie on tables.

A layout that a text described on one table, and that was laid on other tables too, is one concept. Its tables are
counted (:mod:`deixis.learning.layouts.experience`) and kept with the lessons in the memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.answers import count
from deixis.grammar.script import Script
from deixis.learning.layouts.experience import TOLERANCE, Experience, Spread, log_sizes, long_axis, predictive
from deixis.learning.lessons.lesson import layout_name
from deixis.learning.lessons.scene_evidence import graph_evidence, named_by_candidates
from deixis.ontology.graph.facts import Fact
from deixis.ontology.graph.graph import RelationGraph, dispensable
from deixis.ontology.relations.relation import Reading, Relation, Relations
from deixis.ontology.tbox import Ontology
from deixis.perception.oriented_box import OrientedBox
from deixis.perception.scene import Scene
from deixis.reasoning.comparison.explanation import NOTHING, MistakeOdds, TableEvidence
from deixis.reasoning.entailment.claim_facts import implications_with_claims
from deixis.reasoning.entailment.conflict import find_conflict
from deixis.reasoning.entailment.implications import Implications
from deixis.reasoning.geometry.overlap import common_lengths, overlapping
from deixis.reasoning.geometry.rectangle import box_relations
from deixis.reasoning.grounding.evidence.properties.candidates import candidate_ratios
from deixis.reasoning.grounding.evidence.words.meaning import Meaning

Array = NDArray[np.float64]

FACT_HOLDS, SUPPORT_HOLDS = 0.998, 0.98
"""Probability that a firm fact of a layout is seen to hold on a table without mistakes, and that of *on* and *under*,
which a small error of heights breaks."""

MIN_TURN = np.deg2rad(28.0)
"""Minimum angle at which a thing is compared with how it would lie straight."""

TURN_DEVIATION = np.deg2rad(7.0)
"""Standard deviation of the direction of things in their places."""

TURN_SHIFT = 0.05
"""Standard deviation of the distance in metres by which a turned thing is moved along each axis."""

MIN_TURN_OUTLIERS = 1e-4
"""Minimum share of things that lie at any angle without a mistake. It is a tenth with no table seen, and a tenth of
that with each further one."""

OBSERVED_WEIGHT = 0.25
"""Factor of the evidence of relations that were seen but not stated, as those of different pairs depend on each other.
"""


HELD_WEIGHT = 0.6
"""Factor of the evidence of relations that hold, since those of one thing in its place depend on each other."""

OFFSET_SPREAD, OFFSET_ERROR = Spread((0.05, 0.05), 2.0), 0.005
"""Prior of the deviation in metres of the offset between two things, where few tables were seen, and the error of an
offset."""

MIN_FLOATING_HEIGHT, SUPPORT_ERROR = 0.03, 0.02
"""Minimum height in metres at which a thing must rest on another one, and the error of the height of that one."""

MAX_SLENDER_WIDTH, MAX_SLENDERNESS = 0.02, 2.5
"""Width in metres below which a thing cannot stand if it is higher than ``MAX_SLENDERNESS`` times its width."""

MAX_KNOB = 0.03
"""Largest extent in metres of a knob, a piece on the top of another thing."""

SIZE_PRIOR = Spread((0.15, 0.15, 0.15), 2.0)
"""Prior of the deviations of the logarithms of length, width and height. It is wide, since things may be partly hidden
on any table."""

SIZE_OUTLIERS, SIZE_SPREAD = 0.01, 0.8
"""Share of things that are of any size along an axis, and the least standard deviation of the logarithms of all sizes.
"""

LOOKS_OUTLIERS = 0.002
"""Share of things whose candidates are independent of their names."""

PIECE_SHARE, PIECE_HEIGHT = 0.7, 0.012
"""Share of a thing that lies over another one, and metres by which it rises above it, for a piece of that one."""

OFFSET_OUTLIERS, OFFSET_AREA = 0.05, 0.7
"""Share of offsets that are arbitrary, and side in metres of the area of arbitrary ones."""


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


@dataclass(frozen=True, eq=False, repr=False)
class LearnedLayout:
    """A layout: the script that describes it, and the experience of its tables.

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

    def __repr__(self) -> str:
        return (
            f"<LearnedLayout '{self.name}': {count(len(self.roles), 'role')}, {count(self.experience.tables, 'table')}>"
        )

    @classmethod
    def told(cls, script: Script) -> LearnedLayout:
        """Return the layout of a script, without experience.

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

    def with_table(self, script: Script, seen: Experience) -> LearnedLayout:
        """Return the layout with one more table.

        The fuller description is kept, by its numbers of roles and facts, whichever came first.

        Parameters
        ----------
        script
            Description of the table.
        seen
            Counts of the table.

        Returns
        -------
        LearnedLayout
            The layout with the counts of all tables.
        """
        fuller = max((self.script, script), key=_fullness)
        return LearnedLayout(self.name, fuller, self.experience + seen)

    def contradiction(self, script: Script) -> str | None:
        """Return why the description and another one of the layout cannot both hold.

        Parameters
        ----------
        script
            The other description.

        Returns
        -------
        str or None
            The reason with the facts; None if both can hold.
        """
        graphs = self.graph, script.graph()
        facts = [fact for graph in graphs for fact in graph.facts() if fact.weight >= 1]
        names = sorted({name for graph in graphs for name in graph.nodes})
        both = RelationGraph.from_facts(self.graph.vocabulary, names, dict.fromkeys(facts))
        implied = implications_with_claims(both, (*self.script.claims, *script.claims))[1][-1]
        conflict = None if implied.consistent else find_conflict(implied)
        return None if conflict is None else f"{conflict.reason} ({', '.join(map(str, conflict.facts))})"

    @cached_property
    def graph(self) -> RelationGraph:
        """Roles and stated facts."""
        return self.script.graph()

    @property
    def roles(self) -> tuple[str, ...]:
        """Names of the roles."""
        return tuple(self.graph.nodes)

    @cached_property
    def expectations(self) -> tuple[tuple[Relation, int, int, float, float], ...]:
        """Wide relations between roles: the relation, the two roles, the probability that it holds, and its weight.

        Stated facts come first, and what follows from them; then what was seen of other pairs.
        """
        relations, graph = self.graph.vocabulary, self.graph
        found: dict[tuple[int, int, int], tuple[Relation, int, int, float, float]] = {}
        for fact in self._stated_and_implied():
            (relation,), a, b = fact.relations, graph.index(fact.subject), graph.index(fact.object)
            holds = SUPPORT_HOLDS if relation.word in ("on", "under") else FACT_HOLDS
            share = fact.weight * holds + (1 - fact.weight) * 0.5
            found[relation.index, a, b] = (relation, a, b, share, 1.0)
        for (word, first, second), tally in sorted(self.experience.held.items()):
            if first not in graph.nodes or second not in graph.nodes:
                continue
            relation, a, b = relations[word], graph.index(first), graph.index(second)
            inverse = relations[relation.inverse]
            if (relation.index, a, b) not in found and (inverse.index, b, a) not in found and tally.of > 0:
                found[relation.index, a, b] = (relation, a, b, tally.probability, OBSERVED_WEIGHT)
        return tuple(found.values())

    def _stated_and_implied(self) -> Iterator[Fact]:
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
        identity = np.where([each is not None for each in ranked], looks, known.labels) + self._sizes(
            scene, known.sizes
        )
        if known.colours is not None:
            identity = identity + known.colours
        boxes, turn, straight, origin = self._poses(scene)
        ends, kinds, tables = self._tables(boxes, origin, len(scene.objects), ontology.relations)
        dispensable_roles = dispensable(self.graph.facts())
        optional = np.array([role in dispensable_roles for role in self.roles], dtype=bool)
        apart = np.logical_not(overlapping(scene.boxes[:, :, :2]))
        pieces = _pieces(scene.boxes)
        return TableEvidence(
            identity, turn, straight, ends, kinds, tables, optional, apart, pieces, odds or MistakeOdds()
        )

    def _poses(self, scene: Scene) -> tuple[Array, Array, NDArray[np.int64], NDArray[np.int64]]:
        """Return the poses of the things: first each as seen, then those that are laid straight.

        The arrays are boxes (p, 2, 3), evidence of directions (n, p), straightened poses (n, m) and things (p,).
        """
        n, m = len(self.roles), len(scene.objects)
        boxes = [np.array((thing.minimum, thing.maximum)) for thing in scene.objects]
        straight = np.full((n, m), NOTHING, dtype=np.int64)
        turn: list[Array] = [np.zeros(n) for _ in range(m)]
        usual = [self.axis(role) for role in self.roles]
        made: dict[tuple[int, int], int] = {}
        origin = list(range(m))
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
                if away > MIN_TURN:
                    key = (t, round(float(np.rad2deg(axis)) / 15) % 12)
                    if key not in made:
                        made[key] = len(boxes)
                        boxes.append(_lying(thing.oriented, axis, boxes[t]))
                        turn.append(np.zeros(n))
                        origin.append(t)
                    straight[i, t] = made[key]
        return np.array(boxes).reshape(len(boxes), 2, 3), np.stack(turn, axis=1), straight, np.array(origin)

    def _sizes(self, scene: Scene, usual: Array) -> Array:
        """Return the evidence of sizes for each role's thing being each thing, shape (n, m).

        The sizes that were seen replace the usual ones of a kind.
        """
        measured = log_sizes(scene.objects)
        evidence = usual.copy()
        spread = np.maximum(measured.std(axis=0), SIZE_SPREAD)
        chance = np.exp(-0.5 * ((measured - measured.mean(axis=0)) / spread) ** 2) / spread / np.sqrt(2 * np.pi)
        for place, role in enumerate(self.roles):
            seen = self.experience.sizes.get(role)
            if seen is not None and seen.count > 0.5:
                likely = predictive(measured, seen, SIZE_PRIOR)
                ratios = np.log((1 - SIZE_OUTLIERS) * likely / chance + SIZE_OUTLIERS)
                evidence[place] = ratios.sum(axis=1)
        return evidence

    def _offsets(self, boxes: Array, things: int) -> Iterator[tuple[int, int, Array]]:
        """Yield pairs of roles that a stated fact relates, and the evidence of the offset of each pair of poses."""
        graph = self.graph
        centres = boxes.mean(axis=1)[:, :2]
        offset = centres[None, :] - centres[:, None]  # (p, p, 2)
        apart = self.experience.apart
        related = {tuple(sorted((fact.subject, fact.object))) for fact in graph.facts() if fact.subject != fact.object}
        prior = OFFSET_SPREAD.fitted((seen for pair, seen in apart.items() if pair in related), OFFSET_ERROR)
        for first, second in sorted(related):
            seen = apart.get((first, second))
            if seen is None or seen.count < 0.5:
                continue
            density = predictive(offset, seen, prior, OFFSET_ERROR).prod(axis=2)
            turned = np.arange(len(boxes)) >= things
            if turned.any():  # a turned thing may have been moved too
                moved = predictive(offset, seen, prior, OFFSET_ERROR, TURN_SHIFT).prod(axis=2)
                density = np.where(turned[:, None] | turned[None, :], (density + moved) / 2, density)
            values = np.log((1 - OFFSET_OUTLIERS) * density * OFFSET_AREA**2 + OFFSET_OUTLIERS)
            table = np.where(values > 0, HELD_WEIGHT * values, values)
            np.fill_diagonal(table, 0.0)
            yield graph.index(first), graph.index(second), table

    def _tables(
        self, boxes: Array, origin: NDArray[np.int64], things: int, relations: Relations
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
                table = weight * np.where(values > 0, HELD_WEIGHT * values, values)
                table = np.maximum(table, table[np.ix_(origin, origin)])  # a turned thing may also count as it lies
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


def _fullness(script: Script) -> tuple[int, int, str]:
    """Return a sort key of how much a description states; equal descriptions have equal keys."""
    from deixis.grammar.layout.format import format_script

    graph = script.graph()
    return len(graph.nodes), len(tuple(graph.facts())), format_script(script)


def _pieces(boxes: Array) -> NDArray[np.bool_]:
    """Return which boxes are probably pieces of other things.

    A piece lies mostly within another box in plan without rising above it, or mostly within its volume, or it floats
    above the table and nothing supports it, or it is too slender to stand, or it is a knob on another thing.
    """
    low, high = boxes[:, 0], boxes[:, 1]
    area = np.prod(high[:, :2] - low[:, :2], axis=1)
    common = common_lengths(boxes)
    shared = np.prod(common[:, :, :2], axis=2)
    within = (shared >= PIECE_SHARE * area[:, None]) & (area[:, None] < area[None, :])
    flat = high[:, None, 2] <= high[None, :, 2] + PIECE_HEIGHT
    under = (shared > 0) & (np.abs(low[:, None, 2] - high[None, :, 2]) < SUPPORT_ERROR)
    np.fill_diagonal(under, False)
    floats = (low[:, 2] > MIN_FLOATING_HEIGHT) & ~under.any(axis=1)
    size = high - low
    width = size[:, :2].min(axis=1)
    slender = (width < MAX_SLENDER_WIDTH) & (size[:, 2] > MAX_SLENDERNESS * width)
    inside = np.prod(common, axis=2) >= PIECE_SHARE * np.prod(size, axis=1)[:, None]
    np.fill_diagonal(inside, False)
    knob = (size.max(axis=1) < MAX_KNOB) & under.any(axis=1)
    found: NDArray[np.bool_] = (within & flat).any(axis=1) | inside.any(axis=1) | floats | slender | knob
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
