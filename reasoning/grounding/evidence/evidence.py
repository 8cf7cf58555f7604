"""What grounding goes by: the facts, what labels, sizes and colours say, and how far each stated fact holds of a pair.

What an engine searches is :attr:`Evidence.problem`: facts, labels, sizes and colours as log-likelihood ratios that add
up, with what leaving an object out costs. Beside it stands the crisp reading, by which an answer says what holds: a
stated fact holds of a pair to the degree 1 where the pair's exact name is the word itself, 0.5 where the name only
implies the word in its wide reading, else 0. A choice (``or``) holds as far as its best alternative; a denial holds (1)
where none of its relations does, even widely. A fact is *satisfied* where its degree is above 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.ontology.colours import Colours
from deixis.ontology.graph import RelationGraph
from deixis.ontology.kinds import Kinds
from deixis.ontology.relation import Reading
from deixis.ontology.sizes import Sizes
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.evidence.candidates import Candidates, candidate_ratios
from deixis.reasoning.grounding.evidence.colours import colour_evidence
from deixis.reasoning.grounding.evidence.degrees import log_likelihood_ratio
from deixis.reasoning.grounding.evidence.facts import FactEvidence, hedged
from deixis.reasoning.grounding.evidence.labels import Label, classes
from deixis.reasoning.grounding.evidence.meaning import OUTLIERS, SHIPPED, Meaning
from deixis.reasoning.grounding.evidence.unary import LABEL_ERROR, label_ratios, size_evidence
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.memory_budget import different_facts

MAX_ABSENCE_ODDS = 0.015
"""Upper bound of the odds that an object is absent from a scene that has room for all."""

PRESENT_LOG_ODDS = -30.0
"""Log-odds of absence of an object that a certain label, or an answer, says is there."""

SECONDS_PER_CELL = 1e-8
"""Seconds that it takes to lay out a cell of the tables for an engine, which nothing interrupts."""

MAX_KEPT_THINGS = 150
"""Things up to which what the facts say of their pairs is kept beside the tables that are made of it."""

UNRELIABLE_PRIOR, UNRELIABLE_ERROR = 0.01, 0.7
"""Probability that the labels of a scene are not to be trusted, and that one of them is wrong then: whoever is wrong
once is often wrong again."""


@dataclass(frozen=True, eq=False)
class DoubtedLabels:
    """What labels say where they are not to be trusted: log-likelihood ratios (n1, n2), and by how much likelier, in
    nats, all labels together are then, of things that the description does not mention."""

    ratios: NDArray[np.float64]
    log_likelihood: float

    def reordered(self, both: tuple[NDArray[np.intp], ...]) -> DoubtedLabels:
        """Return the same with objects and things in another order, as ``numpy.ix_`` has it."""
        return replace(self, ratios=self.ratios[both])


@dataclass(frozen=True, eq=False)
class Whole:
    """The scene of which evidence holds a shortlist: what all its n things are, and what is left out.

    ``alone`` is the matching problem of all things without facts, ``doubted`` the same where labels are not to be
    trusted (None where no label can be doubted). ``outside`` (n1,) is about the posterior probability that each object
    is a thing that is not on the shortlist; ``labelled_inside`` (n1,) the share of what labels say of each object, or
    of its being none, that is said of the shortlist.
    """

    nodes: tuple[str, ...]
    boxes: NDArray[np.float64]  # (n, 2, d)
    alone: Problem
    doubted: Problem | None
    outside: NDArray[np.float64]
    labelled_inside: NDArray[np.float64]

    def reordered(self, rows: NDArray[np.int64]) -> Whole:
        """Return the same with the objects in another order."""

        def in_order(problem: Problem) -> Problem:
            return replace(
                problem,
                unary=problem.unary[rows],
                absent=problem.absent[rows],
                allowed=problem.allowed[rows],
            )

        return replace(
            self,
            alone=in_order(self.alone),
            doubted=None if self.doubted is None else in_order(self.doubted),
            outside=self.outside[rows],
            labelled_inside=self.labelled_inside[rows],
        )


@dataclass(frozen=True, eq=False)
class Evidence:
    """A description of n1 objects by m facts beside a scene of n2 things, with all that speaks for each match.

    ``labels``, ``sizes`` and ``colours`` (n1, n2) are finite log-likelihood ratios of each object being each perceived
    thing; no ``colours`` where none are known. ``allowed`` (n1, n2) says which object may be which thing: a certain
    label, or an answer, rules matches out. ``identified`` (n2,) are the things of which a certain label, or an answer,
    says what they are. ``doubted_labels`` are what labels say that are not to be trusted. Masks that are left out rule
    nothing out and identify nothing. ``consistent`` says whether the firm facts can hold together, where that is known
    already. By the ``deadline`` the facts' evidence has to be worked out: else :attr:`problem` raises OutOfTimeError.
    ``frugal``: there is no memory for chains of maps to be drawn, so that probabilities are beliefs. ``whole`` is the
    scene of which ``scene`` is a shortlist, where it is one.
    """

    description: RelationGraph
    scene: SceneRelations
    labels: NDArray[np.float64]
    sizes: NDArray[np.float64]
    meaning: Meaning = SHIPPED
    colours: NDArray[np.float64] | None = None
    doubted_labels: DoubtedLabels | None = None
    allowed: NDArray[np.bool_] = field(default_factory=lambda: np.array(True))
    identified: NDArray[np.bool_] = field(default_factory=lambda: np.array(False))
    consistent: bool | None = None
    deadline: Deadline = Deadline.never()
    frugal: bool = False
    whole: Whole | None = None

    def __post_init__(self) -> None:
        shape = (len(self.description.nodes), len(self.scene.nodes))
        object.__setattr__(self, "allowed", np.broadcast_to(self.allowed, shape))
        object.__setattr__(self, "identified", np.broadcast_to(self.identified, shape[1:]))

    @property
    def unary(self) -> NDArray[np.float64]:
        """What speaks for each match besides the facts, shape (n1, n2); 0 where it is not allowed."""
        total: NDArray[np.float64] = self.labels + self.sizes
        if self.colours is not None:
            total = total + self.colours
        return np.where(self.allowed, total, 0.0)

    @property
    def present(self) -> NDArray[np.bool_]:
        """Which objects are known to be there (n1,): those of which an identified thing bears the label."""
        present: NDArray[np.bool_] = np.any((self.labels > 0) & self.identified[None, :], axis=1)
        return present

    @property
    def absent(self) -> NDArray[np.float64]:
        """What leaving each object out is worth, shape (n1,)."""
        return np.where(self.present, PRESENT_LOG_ODDS, absence(len(self.labels), len(self.things)))

    @property
    def things(self) -> tuple[str, ...]:
        """All things of the scene, those that are not on a shortlist included."""
        return self.scene.nodes if self.whole is None else self.whole.nodes

    @property
    def without_facts(self) -> Problem:
        """The matching problem of all things of the scene, without facts."""
        if self.whole is not None:
            return self.whole.alone
        return without_facts(self.unary, self.absent, self.allowed)

    @cached_property
    def label_readings(self) -> tuple[tuple[float, Evidence], ...]:
        """The evidence with its labels taken as they are, then as not to be trusted, each with its log weight.

        There is one reading of weight 0 where no label can be doubted.
        """
        if self.doubted_labels is None:
            return ((0.0, self),)
        whole = self.whole
        if whole is not None and whole.doubted is not None:
            whole = replace(whole, alone=whole.doubted)
        doubted = replace(self, labels=self.doubted_labels.ratios, doubted_labels=None, whole=whole)
        if self.meaning.graded and self.scene.boxes is not None and len(self.scene.boxes) <= MAX_KEPT_THINGS:
            doubted.__dict__["_facts_said"] = self._said()
        trusted = math.log1p(-UNRELIABLE_PRIOR)
        return ((trusted, self), (math.log(UNRELIABLE_PRIOR) + self.doubted_labels.log_likelihood, doubted))

    @cached_property
    def problem(self) -> Problem:
        """The matching problem to be searched. A scene without boxes is taken literally, by the names of its pairs."""
        absent, boxes = self.absent, self.scene.boxes
        if boxes is None or not self.meaning.graded:
            # the crisp reading, chance being one pair for each of the names
            graph, edges = self.description, self.facts
            said = np.column_stack([self.degree_table, graph.net_weights[edges]])
            rows, kinds = np.unique(said, axis=0, return_inverse=True)
            exact = [relation.index for relation in graph.vocabulary.of_reading(Reading.EXACT)]
            tables = np.zeros((len(rows), len(self.scene.nodes), len(self.scene.nodes)), dtype=np.float32)
            for table, row in zip(tables, rows, strict=True):
                degrees = row[:-1][self.scene.names]
                table[:] = hedged(log_likelihood_ratio(degrees, OUTLIERS, float(row[exact].mean())), float(row[-1]))
                np.fill_diagonal(table, 0.0)
            ends = np.stack([graph.subjects[edges], graph.objects[edges]], axis=1).astype(np.int64)
            return Problem(ends, kinds.ravel().astype(np.int64), tables, self.unary, absent, self.allowed)
        spoken, unary = self._said(), self.unary
        facts = spoken.tables(spoken.literal(unary, absent, self.allowed))
        return Problem(facts.ends, facts.kinds, facts.tables, unary, absent, self.allowed)

    @cached_property
    def upper_problem(self) -> Problem:
        """A problem in which no map is worth less than in :attr:`problem`, and that is made without any search."""
        if self.scene.boxes is None or not self.meaning.graded:
            return self.problem
        facts = self._said().most()
        return Problem(facts.ends, facts.kinds, facts.tables, self.unary, self.absent, self.allowed)

    def _said(self) -> FactEvidence:
        """Return what the facts say of the boxes; of small scenes it is kept, for both readings of their labels."""
        known = self.__dict__.get("_facts_said")
        if known is None:
            boxes = self.scene.boxes
            assert boxes is not None
            laying_out = SECONDS_PER_CELL * different_facts(self.description) * len(boxes) ** 2
            known = FactEvidence.of(
                self.description,
                boxes,
                self.meaning.models,
                names=self.scene.names,
                everything=None if self.whole is None else self.whole.boxes,
                deadline=self.deadline.earlier(laying_out),
            )
            if len(boxes) <= MAX_KEPT_THINGS:
                self.__dict__["_facts_said"] = known
        return known

    @cached_property
    def facts(self) -> NDArray[np.int64]:
        """The edges of the description that can be compared: all but those of an object to itself."""
        return np.flatnonzero(self.description.subjects != self.description.objects)

    def firm(self) -> NDArray[np.bool_]:
        """Return which comparable facts must hold: neither optional nor hedged."""
        must: NDArray[np.bool_] = ~self.description.optional[self.facts] & (self.description.weights[self.facts] >= 1)
        return must

    @cached_property
    def degree_table(self) -> NDArray[np.float64]:
        """The degree of each comparable fact by the pair's exact name, shape (facts, relations + 1); last column 0."""
        degrees = self.description.vocabulary.degrees
        sets = self.description.relation_sets[self.facts]
        member = (sets[:, None] >> np.arange(len(degrees))[None, :] & 1).astype(bool)
        best = np.where(member[:, :, None], degrees[None, :, :], 0.0).max(axis=1, initial=0.0)
        denied = np.where(best > 0, 0.0, 1.0)
        table = np.where(self.description.affirmed[self.facts][:, None], best, denied)
        return np.concatenate([table, np.zeros((len(table), 1))], axis=1)

    def degrees(self, assignment: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return how far each comparable fact holds, 0 where an object of it is unmatched.

        ``assignment`` has shape (…, n1), the result (…, facts).
        """
        subjects = assignment[..., self.description.subjects[self.facts]]
        objects = assignment[..., self.description.objects[self.facts]]
        matched = (subjects != UNMATCHED) & (objects != UNMATCHED)
        names = np.where(matched, self.scene.names[subjects, objects], -1) if len(self.scene.nodes) else subjects
        degrees: NDArray[np.float64] = np.where(matched, self.degree_table[np.arange(len(self.facts)), names], 0.0)
        return degrees

    def total(self, assignment: NDArray[np.int64]) -> float:
        """Return the sum of degrees times weights, plus what labels say for each match."""
        return float(self.totals(assignment[None])[0])

    def totals(self, assignments: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the total of each of k assignments (k, n1)."""
        matched = assignments != UNMATCHED
        totals: NDArray[np.float64] = self.degrees(assignments) @ self.description.affirmed_weights[self.facts]
        if self.labels.size:
            said = self.labels[np.arange(assignments.shape[1]), np.where(matched, assignments, 0)]
            totals += np.where(matched, said, 0.0).sum(axis=1)
        return totals

    def seen_from(self, angle: float, mirrored: bool) -> Evidence:
        """Return the same evidence where the facts speak of the scene turned by ``angle`` (radians, counter-clockwise),
        having mirrored left and right if so; what the things are by themselves is the same from all sides.

        Raises GraphError where the scene has no boxes.
        """
        scene = self.scene
        if scene.boxes is None:
            raise GraphError("a scene without boxes cannot be seen from another side")
        boxes = turned(scene.boxes, angle, mirrored)
        return replace(self, scene=scene_relations(scene.nodes, boxes, scene.vocabulary, scene.kinds))

    def reordered(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Evidence:
        """Return the same evidence with the objects and the perceived things in another order."""
        both = np.ix_(rows, columns)
        return replace(
            self,
            description=self.description.subgraph([self.description.nodes[i] for i in rows]),
            scene=self.scene.reordered(columns),
            labels=self.labels[both],
            sizes=self.sizes[both],
            colours=None if self.colours is None else self.colours[both],
            doubted_labels=None if self.doubted_labels is None else self.doubted_labels.reordered(both),
            allowed=self.allowed[both],
            identified=self.identified[columns],
            whole=None if self.whole is None else self.whole.reordered(rows),
        )

    def in_order_of(self, other: Evidence) -> Evidence:
        """Return the same evidence with objects and things in the order of another's, whose names are the same."""
        rows = [self.description.index(name) for name in other.description.nodes]
        columns = [self.scene.index(name) for name in other.scene.nodes]
        return self.reordered(np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))


def absence(objects: int, things: int) -> float:
    """Return what leaving one of n1 objects out is worth in log-likelihood, beside n2 things.

    Whoever leaves an object out says that it is not there, and that one thing more was not described. The odds of
    either are those of Jeffreys' rule, (k + 1/2) / (n - k + 1/2), for the k that there are at least: all but as many
    as there are on the other side. And of k objects and k things there are k times as many maps that match all as of
    k - 1 and k - 1, so that each of the former is as many times less likely. But a few words about a full table are no
    sign that what they name is missing: where none has to be absent, its odds are ``MAX_ABSENCE_ODDS`` at most, and
    where most things are not described anyway, one more says nothing.

    >>> round(absence(12, 12), 1), round(absence(15, 12), 1), round(absence(2, 300), 1)
    (-4.9, -2.0, -4.2)
    """
    absent, extra = max(0, objects - things), max(0, things - objects)
    of_objects = (absent + 0.5) / (objects - absent + 0.5) if absent else min(0.5 / (objects + 0.5), MAX_ABSENCE_ODDS)
    of_things = (extra + 0.5) / (things - extra + 0.5) * max(1, min(objects, things))
    return math.log(of_objects) + min(0.0, math.log(of_things))


def no_unary_evidence(description: RelationGraph, scene: SceneRelations, meaning: Meaning = SHIPPED) -> Evidence:
    """Return the evidence of the facts alone: everything is allowed, and nothing else speaks for a match."""
    nothing = np.zeros((len(description.nodes), len(scene.nodes)))
    return Evidence(description, scene, nothing, nothing, meaning)


@dataclass(frozen=True, eq=False)
class ThingEvidence:
    """What is known of n2 things by themselves: log-likelihood ratios of n1 objects being them, as in
    :class:`Evidence`."""

    labels: NDArray[np.float64]
    sizes: NDArray[np.float64]
    colours: NDArray[np.float64] | None
    doubted_labels: DoubtedLabels | None
    allowed: NDArray[np.bool_]


def thing_evidence(
    description: RelationGraph,
    boxes: NDArray[np.float64] | None,
    labels: Sequence[Label | None],
    kinds: Kinds,
    sizes: Sizes,
    *,
    metric: bool = True,
    meaning: Meaning = SHIPPED,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
    label_error: float = LABEL_ERROR,
    candidates: Sequence[Candidates | None] = (),
) -> ThingEvidence:
    """Return what labels, sizes and colours say, each by its weight; arguments are those of :func:`evidence_from`."""
    weights, shape = meaning.weights, (len(description.nodes), len(labels))
    said, measured, allowed = np.zeros(shape), np.zeros(shape), np.ones(shape, dtype=bool)
    doubted = None
    if weights.labels > 0:
        told = label_ratios(description, labels, kinds, label_error)
        said, allowed = weights.labels * told.ratios, told.allowed
        ranked = np.zeros(shape)
        if any(candidates):
            ranked = weights.labels * np.where(allowed, candidate_ratios(description, candidates, kinds), 0.0)
            said = said + ranked
        if label_error > 0 and any(label is not None for label in labels):
            unreliable = label_ratios(description, labels, kinds, UNRELIABLE_ERROR)
            doubted = DoubtedLabels(
                weights.labels * unreliable.ratios + ranked, weights.labels * (unreliable.by_chance - told.by_chance)
            )
    if weights.sizes > 0 and boxes is not None:
        measured = weights.sizes * size_evidence(classes(description), boxes, sizes, meaning.sizes, metric)
    shades = None
    if weights.colours > 0 and seen is not None and colours is not None and description.colours:
        shades = weights.colours * colour_evidence(description.colours, seen, colours)
    return ThingEvidence(said, measured, shades, doubted, allowed)


def without_facts(unary: NDArray[np.float64], absent: NDArray[np.float64], allowed: NDArray[np.bool_]) -> Problem:
    """Return the matching problem of what is known of things by themselves (n1, n2), and no fact."""
    n2 = unary.shape[1]
    ends, nothing = np.zeros((0, 2), dtype=np.int64), np.zeros((0, n2, n2), dtype=np.float32)
    return Problem(ends, ends[:, 0], nothing, unary, absent, allowed)


def evidence_from(
    description: RelationGraph,
    scene: SceneRelations,
    labels: Sequence[Label | None],
    kinds: Kinds,
    sizes: Sizes,
    *,
    metric: bool = True,
    meaning: Meaning = SHIPPED,
    seen: NDArray[np.float64] | None = None,
    colours: Colours | None = None,
    label_error: float = LABEL_ERROR,
    deadline: Deadline = Deadline.never(),
    candidates: Sequence[Candidates | None] = (),
) -> Evidence:
    """Return facts, labels, sizes and colours together, each by its weight; ``metric`` where the scene's boxes are in
    metres.

    ``seen`` are the things' colours in sRGB, shape (n2, 3), NaN where not known; ``colours`` are the known terms.
    ``label_error`` is the probability that a label of confidence 1 is wrong; 0 takes such labels as identities.
    ``candidates`` are those of each thing, and weigh as labels do; none of any where they are left out.
    """
    known = thing_evidence(
        description,
        scene.boxes,
        labels,
        kinds,
        sizes,
        metric=metric,
        meaning=meaning,
        seen=seen,
        colours=colours,
        label_error=label_error,
        candidates=candidates,
    )
    return Evidence(
        description,
        scene,
        known.labels,
        known.sizes,
        meaning,
        known.colours,
        known.doubted_labels,
        known.allowed,
        np.any(~known.allowed, axis=0),
        deadline=deadline,
    )
