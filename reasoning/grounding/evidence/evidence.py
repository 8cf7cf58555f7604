"""Evidence of grounding: facts, labels, sizes and colours of a description in a scene, and the degrees of facts.

Engines search :attr:`Evidence.problem`: facts, labels, sizes and colours as log-likelihood ratios that are added up,
and the costs of leaving objects out. The answer reports facts by the crisp reading: a fact holds of a pair to degree 1
where the pair's exact relation is the stated word, 0.5 where the exact relation only implies the word in its wide
reading, else 0. The degree of a choice (``or``) is that of its best alternative; the degree of a denial is 1 where none
of its relations holds, even widely. A fact is *satisfied* where its degree is above 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.errors import GraphError
from deixis.ontology.graph.claims import Claim
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading, Relation
from deixis.ontology.things.colours import Colours
from deixis.ontology.things.kinds import Kinds
from deixis.ontology.things.sizes import Sizes
from deixis.reasoning.geometry.pairs import pair_geometry
from deixis.reasoning.geometry.rectangle import SceneRelations, scene_relations
from deixis.reasoning.geometry.turning import turned
from deixis.reasoning.grounding.evidence.claims.claims import ClaimTables, claim_tables
from deixis.reasoning.grounding.evidence.facts.facts import FactEvidence, FactTables, SaidFacts, hedged
from deixis.reasoning.grounding.evidence.facts.latent_places import place_ratios
from deixis.reasoning.grounding.evidence.properties.candidates import Candidates, candidate_ratios
from deixis.reasoning.grounding.evidence.properties.colours import colour_evidence
from deixis.reasoning.grounding.evidence.properties.labels import Label, classes
from deixis.reasoning.grounding.evidence.properties.unary import LABEL_ERROR, label_ratios, size_evidence
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees, frame_shares, log_likelihood_ratio
from deixis.reasoning.grounding.evidence.words.meaning import OUTLIERS, SHIPPED, Meaning, shipped_models
from deixis.reasoning.grounding.evidence.words.pair_features import OWN_WORDS, STATURE_WORDS
from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem
from deixis.reasoning.grounding.memory_budget import different_facts

MAX_ABSENCE_ODDS = 0.015
"""Upper bound of the odds that an object is absent from a scene with at least as many things as objects."""

PRESENT_LOG_ODDS = -30.0
"""Log-odds of absence of an object that a certain label, or an answer of the user, identifies."""

SECONDS_PER_CELL = 1e-8
"""Seconds for copying one cell of the tables for an engine, which cannot be interrupted."""

HELD_FROM = 0.5
"""Minimum degree at which a graded word counts as holding of a pair."""

MAX_KEPT_THINGS = 150
"""Maximum number of things for which the likelihood ratios of all pairs are cached beside the tables."""

MIN_LOG_ODDS_OF_THIRD = -30.0
"""Evidence of a match that is not allowed, for the third object of a claim."""

UNRELIABLE_PRIOR, UNRELIABLE_ERROR = 0.01, 0.7
"""Probability that the labels of a scene are unreliable, and the probability that an unreliable label is wrong: errors
of a labeller are correlated."""


@dataclass(frozen=True, eq=False)
class DoubtedLabels:
    """Evidence of labels under the hypothesis that the labels of the scene are unreliable.

    Attributes
    ----------
    ratios
        Log-likelihood ratios of the matches, shape (n1, n2).
    log_likelihood
        Log-likelihood ratio in nats of all labels, unreliable against reliable, for things that the description does
        not mention.
    """

    ratios: NDArray[np.float64]
    log_likelihood: float

    def reordered(self, both: tuple[NDArray[np.intp], ...]) -> DoubtedLabels:
        """Return a copy with objects and things in another order.

        Parameters
        ----------
        both
            Positions of the objects and of the things in the new order, as ``numpy.ix_`` returns them.

        Returns
        -------
        DoubtedLabels
            The copy.
        """
        return replace(self, ratios=self.ratios[both])


@dataclass(frozen=True, eq=False)
class Whole:
    """Whole scene of n things, of which the evidence holds a shortlist.

    Attributes
    ----------
    nodes
        Names of all things.
    boxes
        Boxes of all things, shape (n, 2, d).
    alone
        Matching problem of all things, without facts.
    doubted
        Matching problem of all things without facts, if labels are unreliable; None where no label can be doubted.
    outside
        Approximate posterior probability that each object is a thing that is not on the shortlist, shape (n1,).
    labelled_inside
        Posterior probability by labels alone that each object is on the shortlist or absent, shape (n1,).
    """

    nodes: tuple[str, ...]
    boxes: NDArray[np.float64]
    alone: Problem
    doubted: Problem | None
    outside: NDArray[np.float64]
    labelled_inside: NDArray[np.float64]

    def reordered(self, rows: NDArray[np.int64]) -> Whole:
        """Return a copy with the objects in another order.

        Parameters
        ----------
        rows
            Position of each object in the new order, shape (n1,).

        Returns
        -------
        Whole
            The copy.
        """

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
    """A description of n1 objects and m facts, a scene of n2 things, and the evidence for each match.

    Attributes
    ----------
    description
        The objects and the facts.
    scene
        The things, with their boxes and relations.
    labels, sizes
        Log-likelihood ratios of each object being each thing, shape (n1, n2), finite.
    meaning
        Models of words, and weights of evidence.
    colours
        Log-likelihood ratios by colour, shape (n1, n2); None where no colours are known.
    doubted_labels
        Evidence of the labels if they are unreliable; None where no label can be doubted.
    allowed
        Matches that are allowed, shape (n1, n2): a certain label, or an answer of the user, rules matches out. By
        default, all are allowed.
    identified
        Things that a certain label, or an answer, identifies, shape (n2,). By default, none is.
    consistent
        Whether the firm facts can hold together; None where that is unknown.
    deadline
        Time by which the evidence of the facts must be computed; after it, :attr:`problem` raises OutOfTimeError.
    memory_limited
        True where the memory does not suffice for Markov chains, so that marginals come from belief propagation.
    whole
        Whole scene, where ``scene`` is a shortlist of it.
    claims
        Claims of the description; only graded words in scenes with boxes take them into account.
    metric
        Whether the boxes are in metres; otherwise they are in pixels.
    surface
        Name of the thing that is the surface which the objects stand on, so that no object is matched to it; None if
        the scene does not have it.
    uncounted
        Names of the objects that are groups of unknown number, each of which stands for all things that fit it.
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
    memory_limited: bool = False
    whole: Whole | None = None
    claims: tuple[Claim, ...] = ()
    metric: bool = True
    surface: str | None = None
    uncounted: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        shape = (len(self.description.nodes), len(self.scene.nodes))
        object.__setattr__(self, "allowed", np.broadcast_to(self.allowed, shape))
        object.__setattr__(self, "identified", np.broadcast_to(self.identified, shape[1:]))

    @property
    def unary(self) -> NDArray[np.float64]:
        """Evidence for each match without the facts, shape (n1, n2); 0 where the match is not allowed."""
        total = self._of_things
        if self._claimed is not None:
            total = total + self._claimed.unary
        return np.where(self.allowed, total, 0.0)

    @property
    def of_kinds(self) -> NDArray[np.float64]:
        """Log-likelihood ratios by size and colour, shape (n1, n2)."""
        return self.sizes if self.colours is None else self.sizes + self.colours

    @property
    def _of_things(self) -> NDArray[np.float64]:
        return self.labels + self.of_kinds

    @cached_property
    def _claimed(self) -> ClaimTables | None:
        """Evidence of the claims; None where there are none, or nothing to evaluate them by."""
        if not self.claims or self.scene.boxes is None or not self.meaning.graded:
            return None
        alone = np.where(self.allowed, self._of_things, MIN_LOG_ODDS_OF_THIRD)
        known, models = self.description, self.meaning.models or shipped_models()
        surface = None if self.surface is None else self.scene.index(self.surface)
        boxes, poses = self.scene.boxes, self.scene.poses
        return claim_tables(
            self.claims, known.nodes, boxes, known.vocabulary, models, alone, self.metric, surface, poses
        )

    def with_surface(self, thing: str | None) -> Evidence:
        """Return a copy in which a thing is the surface, and no object is matched to it.

        Parameters
        ----------
        thing
            Name of the thing; None, or a thing that is not on the shortlist, changes nothing.

        Returns
        -------
        Evidence
            The evidence with the surface.
        """
        if thing is None or thing not in self.scene.nodes:
            return self
        others = np.array([node != thing for node in self.scene.nodes])
        return replace(self, allowed=self.allowed & others[None, :], surface=thing)

    def _with_claims(self, facts: FactTables, stated: SaidFacts | None = None, literal: float = 0.0) -> Problem:
        """Return the matching problem of the tables of the facts, followed by those of the claims.

        With the different facts and the share of literal ones, absent objects have places; a shortlist has none.
        """
        ends, kinds, tables = facts.ends, facts.kinds, facts.tables
        if self._claimed is not None and len(self._claimed.ends):
            more = self._claimed
            ends = np.concatenate([ends, more.ends])
            kinds = np.concatenate([kinds, len(tables) + np.arange(len(more.ends), dtype=np.int64)])
            tables = np.concatenate([tables, more.tables])
        places, boxes = None, self.scene.boxes
        if stated is not None and boxes is not None and len(boxes) and self.whole is None:
            of_claims = len(tables) - len(facts.tables)
            places = partial(place_ratios, stated, boxes, literal, of_claims, self.scene.poses)
        return Problem(ends, kinds, tables, self.unary, self.absent, self.allowed, places)

    @property
    def present(self) -> NDArray[np.bool_]:
        """Mask (n1,) of the objects that are certainly present: an identified thing has their label."""
        present: NDArray[np.bool_] = np.any((self.labels > 0) & self.identified[None, :], axis=1)
        return present

    @property
    def absent(self) -> NDArray[np.float64]:
        """Log-odds of each object's absence, shape (n1,). A group is absent if two or more things are."""
        single = absence(len(self.labels), len(self.things))
        least = np.array([2.0 if name in self.uncounted else 1.0 for name in self.description.nodes])
        return np.where(self.present, PRESENT_LOG_ODDS, single * least)

    @property
    def things(self) -> tuple[str, ...]:
        """Names of all things of the scene, including those that are not on the shortlist."""
        return self.scene.nodes if self.whole is None else self.whole.nodes

    @property
    def without_facts(self) -> Problem:
        """Matching problem of all things of the scene, without facts."""
        if self.whole is not None:
            return self.whole.alone
        return without_facts(self.unary, self.absent, self.allowed)

    @cached_property
    def label_readings(self) -> tuple[tuple[float, Evidence], ...]:
        """Evidence with reliable labels, then with unreliable labels, each with its log weight.

        Where no label can be doubted, there is only the first, with log weight 0.
        """
        if self.doubted_labels is None:
            return ((0.0, self),)
        whole = self.whole
        if whole is not None and whole.doubted is not None:
            whole = replace(whole, alone=whole.doubted)
        doubted = replace(self, labels=self.doubted_labels.ratios, doubted_labels=None, whole=whole)
        if self.meaning.graded and self.scene.boxes is not None and len(self.scene.boxes) <= MAX_KEPT_THINGS:
            doubted.__dict__["_cached_fact_evidence"] = self._fact_evidence()
        trusted = math.log1p(-UNRELIABLE_PRIOR)
        return ((trusted, self), (math.log(UNRELIABLE_PRIOR) + self.doubted_labels.log_likelihood, doubted))

    @cached_property
    def problem(self) -> Problem:
        """Matching problem for engines; a scene without boxes is read literally, by the relations of its pairs."""
        absent, boxes = self.absent, self.scene.boxes
        if boxes is None or not self.meaning.graded:
            # the crisp reading; by chance, each exact relation is equally frequent
            graph, edges = self.description, self.facts
            contents = np.column_stack([self.degree_table, graph.net_weights[edges]])
            rows, kinds = np.unique(contents, axis=0, return_inverse=True)
            exact = [relation.index for relation in graph.vocabulary.of_reading(Reading.EXACT)]
            tables = np.zeros((len(rows), len(self.scene.nodes), len(self.scene.nodes)), dtype=np.float32)
            silent = np.isin(np.arange(len(rows)), kinds.ravel()[list(self.modelled)]) if boxes is None else ()
            for kind, (table, row) in enumerate(zip(tables, rows, strict=True)):
                if boxes is None and silent[kind]:
                    continue
                degrees = row[:-1][self.scene.names]
                table[:] = hedged(log_likelihood_ratio(degrees, OUTLIERS, float(row[exact].mean())), float(row[-1]))
                np.fill_diagonal(table, 0.0)
            ends = np.stack([graph.subjects[edges], graph.objects[edges]], axis=1).astype(np.int64)
            return Problem(ends, kinds.ravel().astype(np.int64), tables, self.unary, absent, self.allowed)
        facts, unary = self._fact_evidence(), self.unary
        literal = facts.literal(unary, absent, self.allowed)
        return self._with_claims(facts.tables(literal), facts.ratios.facts, literal)

    @cached_property
    def upper_problem(self) -> Problem:
        """Matching problem in which every map has at least its value in :attr:`problem`; needs no search."""
        if self.scene.boxes is None or not self.meaning.graded:
            return self.problem
        return self._with_claims(self._fact_evidence().most())

    def _fact_evidence(self) -> FactEvidence:
        """Return the evidence of the facts for the boxes; for small scenes it is cached, for both label readings."""
        known = self.__dict__.get("_cached_fact_evidence")
        if known is None:
            boxes = self.scene.boxes
            assert boxes is not None
            cells = different_facts(self.description) * len(boxes) ** 2
            laying_out = self.deadline.slowness * SECONDS_PER_CELL * cells
            known = FactEvidence.of(
                self.description,
                boxes,
                self.meaning.models,
                names=self.scene.names,
                everything=None if self.whole is None else self.whole.boxes,
                poses=self.scene.poses,
                is_plan=self._is_plan,
                deadline=self.deadline.earlier(laying_out),
            )
            if len(boxes) <= MAX_KEPT_THINGS:
                self.__dict__["_cached_fact_evidence"] = known
        return known

    @cached_property
    def facts(self) -> NDArray[np.int64]:
        """Edges of the description that can be compared: all except those of an object to itself."""
        return np.flatnonzero(self.description.subjects != self.description.objects)

    def firm(self) -> NDArray[np.bool_]:
        """Return the mask of comparable facts that must hold: neither optional nor hedged.

        Returns
        -------
        ndarray
            Mask of shape (facts,).
        """
        must: NDArray[np.bool_] = ~self.description.optional[self.facts] & (self.description.weights[self.facts] >= 1)
        return must

    @cached_property
    def degree_table(self) -> NDArray[np.float64]:
        """Degree of each comparable fact by the pair's exact relation, shape (facts, relations + 1); last column 0."""
        degrees = self.description.vocabulary.degrees
        sets, place = np.unique(self.description.relation_sets[self.facts], return_inverse=True)
        member = (sets[:, None] >> np.arange(len(degrees))[None, :] & 1).astype(bool)
        best = np.where(member[:, :, None], degrees[None, :, :], 0.0).max(axis=1, initial=0.0)[place.ravel()]
        denied = np.where(best > 0, 0.0, 1.0)
        table = np.where(self.description.affirmed[self.facts][:, None], best, denied)
        return np.concatenate([table, np.zeros((len(table), 1))], axis=1)

    def degrees(self, assignment: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the degree to which each comparable fact holds, 0 where one of its objects is unmatched.

        Parameters
        ----------
        assignment
            Thing of each object, -1 for none; shape (…, n1).

        Returns
        -------
        ndarray
            Degrees in [0, 1], shape (…, facts), in the order of ``facts``.
        """
        subjects = assignment[..., self.description.subjects[self.facts]]
        objects = assignment[..., self.description.objects[self.facts]]
        matched = (subjects != UNMATCHED) & (objects != UNMATCHED)
        names = np.where(matched, self.scene.names[subjects, objects], -1) if len(self.scene.nodes) else subjects
        degrees: NDArray[np.float64] = np.where(matched, self.degree_table[np.arange(len(self.facts)), names], 0.0)
        for fact, table in self.modelled.items():
            ends = subjects[..., fact], objects[..., fact]
            degrees[..., fact] = np.where(matched[..., fact], table[ends], 0.0)
        return degrees

    @cached_property
    def modelled(self) -> dict[int, NDArray[np.float64]]:
        """Degrees of comparable facts with a word that only its model decides, (n2, n2) each, by their positions.

        The degree is the model's where the word holds, that is, where it is at least one half, and 0 elsewhere. It is
        one half in a scene without boxes, which says nothing about such words.
        """
        found: dict[int, NDArray[np.float64]] = {}
        graph, known = self.description, {}
        for place, edge in enumerate(self.facts.tolist()):
            relations = graph.vocabulary.members(int(graph.relation_sets[edge]))
            if not any(relation.by_model or self._may_be_own(relation) for relation in relations):
                continue
            key = int(graph.relation_sets[edge]), bool(graph.affirmed[edge])
            if key not in known:
                known[key] = self._held(relations, key[1])
            found[place] = known[key]
        return found

    def _held(self, relations: tuple[Relation, ...], positive: bool) -> NDArray[np.float64]:
        n = len(self.scene.nodes)
        if self.scene.boxes is None:
            return np.full((n, n), 0.5)
        degrees, crisp = self._word_degrees, self.description.vocabulary.degrees
        best, undecided = np.zeros((n, n)), np.ones((n, n), dtype=np.bool_)
        for relation in relations:
            undecided &= relation.by_model and (
                degrees.undecided(relation.word) | (self._is_plan and relation.word in STATURE_WORDS)
            )
            by_name = np.where(self.scene.names >= 0, crisp[relation.index][self.scene.names], 0.0)
            if self._may_be_own(relation):  # it holds in the viewer's frame, or in that of the object
                by_name = np.maximum(by_name, degrees.held_by_front(relation.word))
            best = np.maximum(best, degrees.of(relation) if relation.by_model else by_name)
        if not positive:
            return np.where((best < HELD_FROM) | undecided, 1.0, 0.0)
        return np.where(undecided, 1.0, np.where(best >= HELD_FROM, best, 0.0))

    @property
    def _is_plan(self) -> bool:
        """True if the boxes are in metres and have no heights, so that the scene is seen from above."""
        return self.metric and self.scene.boxes is not None and self.scene.boxes.shape[2] == 2

    def _may_be_own(self, relation: Relation) -> bool:
        """Return whether a word that is not decided by its model alone has a frame of some thing of the scene."""
        poses = self.scene.poses
        return relation.word in OWN_WORDS and poses is not None and bool(poses.fronted.any())

    def frame_shares(self, word: str) -> NDArray[np.float64]:
        """Return the probability that a word is meant in the frame of a thing with a front.

        Parameters
        ----------
        word
            Name of the word.

        Returns
        -------
        ndarray
            Probabilities by subject and object, shape (n2, n2). The scene must have boxes.
        """
        assert self.scene.boxes is not None
        pairs = pair_geometry(self.scene.boxes, self.scene.poses)
        return frame_shares(pairs, word, self.meaning.models or shipped_models())

    @cached_property
    def _word_degrees(self) -> WordDegrees:
        assert self.scene.boxes is not None
        return WordDegrees(pair_geometry(self.scene.boxes, self.scene.poses), self.meaning.models or shipped_models())

    def total(self, assignment: NDArray[np.int64]) -> float:
        """Return the sum of degrees times weights, plus the log-likelihood ratios of labels of the matches.

        Parameters
        ----------
        assignment
            Thing of each object, -1 for none; shape (n1,).

        Returns
        -------
        float
            The sum, which :meth:`totals` returns for many assignments.
        """
        return float(self.totals(assignment[None])[0])

    def totals(self, assignments: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the total of each of k assignments: degrees times weights, plus the log-likelihood ratios of labels.

        Parameters
        ----------
        assignments
            Thing of each object in each assignment, -1 for none; shape (k, n1).

        Returns
        -------
        ndarray
            Totals, shape (k,).
        """
        matched = assignments != UNMATCHED
        totals: NDArray[np.float64] = self.degrees(assignments) @ self.description.affirmed_weights[self.facts]
        if self.labels.size:
            label_values = self.labels[np.arange(assignments.shape[1]), np.where(matched, assignments, 0)]
            totals += np.where(matched, label_values, 0.0).sum(axis=1)
        return totals

    def seen_from(self, angle: float, mirrored: bool) -> Evidence:
        """Return the evidence with the facts read in the scene as seen from another side.

        Labels, sizes and colours do not depend on the side.

        Parameters
        ----------
        angle
            Angle in radians by which the scene is turned counter-clockwise.
        mirrored
            Whether left and right are exchanged before.

        Returns
        -------
        Evidence
            Evidence with other relations of the pairs.

        Raises
        ------
        GraphError
            The scene has no boxes.
        """
        scene = self.scene
        if scene.boxes is None:
            raise GraphError("a scene without boxes cannot be seen from another side")
        boxes = turned(scene.boxes, angle, mirrored)
        poses = None if scene.poses is None else scene.poses.turned(angle, mirrored)
        relations = scene_relations(scene.nodes, boxes, scene.vocabulary, scene.kinds)
        return replace(self, scene=replace(relations, poses=poses))

    def reordered(self, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Evidence:
        """Return a copy with the objects and the things in another order.

        Parameters
        ----------
        rows
            Position of each object in the new order, shape (n1,).
        columns
            Position of each thing in the new order, shape (n2,).

        Returns
        -------
        Evidence
            The copy.
        """
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
        """Return a copy with the order of objects and things of ``other``, which has the same names.

        Parameters
        ----------
        other
            Evidence of the same objects and things.

        Returns
        -------
        Evidence
            The copy.
        """
        rows = [self.description.index(name) for name in other.description.nodes]
        columns = [self.scene.index(name) for name in other.scene.nodes]
        return self.reordered(np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))


def absence(objects: int, things: int) -> float:
    """Return the log-odds that one of n1 objects is absent from a scene of n2 things.

    Leaving an object out means that it is absent, and that one more thing is not described. The odds of either follow
    Jeffreys' rule, (k + 1/2) / (n - k + 1/2), for the least possible number k: the excess over the other side. Also,
    there are k times as many complete maps of k objects and k things as of k - 1 and k - 1, so that each of them is k
    times less likely. A short description of a full table is not evidence that its objects are missing: where no object
    has to be absent, the odds are at most ``MAX_ABSENCE_ODDS``, and where most things are not described anyway, one
    more undescribed thing is not evidence.

    Parameters
    ----------
    objects
        Number n1 of objects.
    things
        Number n2 of things.

    Returns
    -------
    float
        Log-odds in nats, usually negative.

    Examples
    --------
    >>> round(absence(12, 12), 1), round(absence(15, 12), 1), round(absence(2, 300), 1)
    (-4.9, -2.0, -4.2)
    """
    absent, extra = max(0, objects - things), max(0, things - objects)
    of_objects = (absent + 0.5) / (objects - absent + 0.5) if absent else min(0.5 / (objects + 0.5), MAX_ABSENCE_ODDS)
    of_things = (extra + 0.5) / (things - extra + 0.5) * max(1, min(objects, things))
    return math.log(of_objects) + min(0.0, math.log(of_things))


def no_unary_evidence(description: RelationGraph, scene: SceneRelations, meaning: Meaning = SHIPPED) -> Evidence:
    """Return the evidence of the facts alone: all matches are allowed, without labels, sizes and colours.

    Parameters
    ----------
    description
        The n1 objects and the facts.
    scene
        The n2 things, with their relations.
    meaning
        Models of words, and weights of evidence.

    Returns
    -------
    Evidence
        Evidence with zeros of shape (n1, n2) for labels and sizes.
    """
    nothing = np.zeros((len(description.nodes), len(scene.nodes)))
    return Evidence(description, scene, nothing, nothing, meaning)


@dataclass(frozen=True, eq=False)
class ThingEvidence:
    """Evidence without the facts: fields of :class:`Evidence` for n1 objects and n2 things."""

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
    """Return the weighted evidence of labels, sizes and colours; parameters as for :func:`evidence_from`.

    Parameters
    ----------
    description
        The n1 objects and the facts; only the objects count here.
    boxes
        Boxes of the n2 things, shape (n2, 2, d); None where they are unknown.
    labels
        Label of each thing; None where it has none.
    kinds, sizes
        Known kinds, and their usual sizes.
    metric
        Whether the boxes are in metres; otherwise they are in pixels.
    meaning
        Weights of evidence, and learned sizes.
    seen
        Colours of the things in sRGB, shape (n2, 3), NaN where unknown.
    colours
        Known colour terms.
    label_error
        Probability that a label of confidence 1 is wrong.
    candidates
        Names of each thing with probabilities; by default, no thing has any.

    Returns
    -------
    ThingEvidence
        Log-likelihood ratios in nats, and allowed matches, each of shape (n1, n2).
    """
    weights, shape = meaning.weights, (len(description.nodes), len(labels))
    label_values, measured, allowed = np.zeros(shape), np.zeros(shape), np.ones(shape, dtype=bool)
    doubted = None
    if weights.labels > 0:
        by_labels = label_ratios(description, labels, kinds, label_error)
        label_values, allowed = weights.labels * by_labels.ratios, by_labels.allowed
        ranked = np.zeros(shape)
        if any(candidates):
            ranked = weights.labels * np.where(allowed, candidate_ratios(description, candidates, kinds), 0.0)
            label_values = label_values + ranked
        if label_error > 0 and any(label is not None for label in labels):
            unreliable = label_ratios(description, labels, kinds, UNRELIABLE_ERROR)
            doubted = DoubtedLabels(
                weights.labels * unreliable.ratios + ranked,
                weights.labels * (unreliable.by_chance - by_labels.by_chance),
            )
    if weights.sizes > 0 and boxes is not None:
        measured = weights.sizes * size_evidence(classes(description), boxes, sizes, meaning.sizes, metric)
    shades = None
    if weights.colours > 0 and seen is not None and colours is not None and description.colours:
        shades = weights.colours * colour_evidence(description.colours, seen, colours)
    return ThingEvidence(label_values, measured, shades, doubted, allowed)


def without_facts(unary: NDArray[np.float64], absent: NDArray[np.float64], allowed: NDArray[np.bool_]) -> Problem:
    """Return the matching problem without facts.

    Parameters
    ----------
    unary
        Evidence of each match in nats, shape (n1, n2).
    absent
        Value of leaving each object out, in nats, shape (n1,).
    allowed
        Allowed matches, shape (n1, n2).

    Returns
    -------
    Problem
        Problem with these arrays and no tables of facts.
    """
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
    claims: Sequence[Claim] = (),
) -> Evidence:
    """Combine facts, labels, sizes and colours of a description and a scene into evidence.

    Parameters
    ----------
    description
        The n1 objects and the facts.
    scene
        The n2 things, with their relations and boxes.
    labels
        Label of each thing; None where it has none.
    kinds, sizes
        Known kinds, and their usual sizes.
    metric
        Whether the boxes are in metres; otherwise they are in pixels.
    meaning
        Models of words, and weights of evidence.
    seen
        Colours of the things in sRGB, shape (n2, 3), NaN where unknown.
    colours
        Known colour terms.
    label_error
        Probability that a label of confidence 1 is wrong; with 0, such labels identify things.
    deadline
        Time by which the evidence of the facts must be computed.
    candidates
        Names of each thing with probabilities, weighted like labels; by default, no thing has any.
    claims
        Claims of the description beside its facts.

    Returns
    -------
    Evidence
        Evidence for n1 objects and n2 things.
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
        claims=tuple(claims),
        metric=metric,
    )
