"""Evidence of stated facts for every pair of perceived boxes: graded (or crisp) tables for matching.

A model of the speaker gives the probability that a fact is stated of a pair, up to a constant that cancels against
chance:

- a word: outliers + (1 - outliers) * s * d, where d is the word's degree and s how readily people mention the pair;
- a choice (``or``): the mixture of its words with equal shares: d is the mean of their degrees;
- a denial (``not``): d is the product of the complements 1 - d of its words. A word that holds widely of a pair counts
  as fitting at any distance: a thing far to the left is still left, and people only mention it less often;
- a literal fact is stated of any pair, near or far, as readily as the pair's exact relation fits: 1 where it is the
  word, ``IMPLIED`` where it only implies the word, else 0; by chance one relation in ten fits. The share of literal
  facts is estimated from the whole description (:mod:`deixis.reasoning.grounding.evidence.facts.literalness`);
- a hedge of weight w: the fact holds with probability w, else it is ignored: log(w exp(l) + 1 - w), where l is the
  evidence of the fact. Below one half (*rarely*) the opposite is stated, with weight 1 - w;
- ``optional``: the fact holds half of the time: w is halved.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import prod

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.models.relations import SAYING, RelationModels
from deixis.ontology.relations.relation import Relation, Relations
from deixis.reasoning.errors import OutOfTimeError, SettingError
from deixis.reasoning.geometry.pairs import PairBlocks, PairGeometry, Surroundings
from deixis.reasoning.geometry.poses import Poses
from deixis.reasoning.geometry.rectangle import box_relations, require_boxes
from deixis.reasoning.grounding.evidence.facts.literalness import LITERAL, LITERAL_PRIOR, literal_share
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees, log_likelihood_ratio, saying_degree
from deixis.reasoning.grounding.evidence.words.meaning import OUTLIERS, shipped_models
from deixis.reasoning.grounding.evidence.words.pair_features import STATURE_WORDS
from deixis.reasoning.grounding.matching.problem import Problem, empty_tables

Array = NDArray[np.float64]

JUDGEMENT_SHARE = 0.2
"""Share of the time left for estimating how literally the facts are meant."""

JUDGEMENT_SECONDS_PER_CELL = 1.7e-8
"""Approximate seconds for the tables of both speakers, per pair of things and different fact."""

SIDE = 256
"""Things on either side of a block of pairs: small enough for a processor's cache."""

FORESEEN_FROM, FORESEEN_EXCESS = 4, 1.5
"""Number of blocks after which the total time is extrapolated, and the ratio of that to the time left from which the
computation stops."""

TABLE_CELLS = 1 << 18
"""Number of cells of tables that are computed together."""

IMPLIED = 0.1
"""Probability that a literal speaker says *left* of a pair whose exact relation is *top left*, instead of that word."""

LITERAL_CHANCE = 0.1
"""Chance degree of a literal word: one of ten exact relations."""

ABSENT_LOG_ODDS = -30.0
"""Default log-odds of an object's absence for the estimate of literalness."""


@dataclass(frozen=True, eq=False)
class FactTables:
    """Evidence of m facts in k tables, in the form of :class:`deixis.reasoning.grounding.matching.problem.Problem`."""

    edges: NDArray[np.int64]  # (m,) edges of the description: all except those of an object to itself
    ends: NDArray[np.int64]  # (m, 2) subject and object
    kinds: NDArray[np.int64]  # (m,) table of each fact
    tables: NDArray[np.float32]  # (k, n2, n2), log-likelihood ratios, finite, 0 on the diagonal


Said = tuple[int, bool, float]
"""Content of a fact: the set of relations as a bit mask, the sign, and the weight."""


def compared_facts(
    description: RelationGraph,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64], list[Said]]:
    """Return the m edges that can be compared with a scene, and their different contents.

    Parameters
    ----------
    description
        The objects and the facts. An edge of an object to itself cannot be compared.

    Returns
    -------
    tuple
        Edges, shape (m,); their subjects and objects, shape (m, 2); the index of each one's content, shape (m,); and
        the contents, sorted.
    """
    edges = np.flatnonzero(description.subjects != description.objects).astype(np.int64)
    columns = (description.relation_sets, description.affirmed, description.net_weights)
    keys = list(zip(*(column[edges].tolist() for column in columns), strict=True))
    distinct = sorted(set(keys))
    places = {key: place for place, key in enumerate(distinct)}
    return edges, _ends(description, edges), np.array([places[key] for key in keys], dtype=np.int64), distinct


def _without_stature(said: Said, vocabulary: Relations) -> Said:
    """Return the content of a fact with weight 0 if one of its words compares heights, which a plan does not show."""
    mask, positive, weight = said
    about_stature = any(relation.word in STATURE_WORDS for relation in vocabulary.members(mask))
    return mask, positive, 0.0 if about_stature else weight


def fact_tables(
    description: RelationGraph,
    boxes: NDArray[np.float64],
    models: RelationModels | None = None,
    *,
    saying: bool = True,
    literal: float | None = None,
    unary: Array | None = None,
    absent: Array | None = None,
    allowed: NDArray[np.bool_] | None = None,
    deadline: Deadline = Deadline.never(),
) -> FactTables:
    """Return the evidence of every fact for every ordered pair of n2 boxes.

    Parameters
    ----------
    description
        The n1 objects and the facts.
    boxes
        Boxes of the things, shape (n2, 2, d).
    models
        Models of the relation words; by default, the shipped ones.
    saying
        Whether to model which pairs people mention; otherwise, only the words count.
    literal
        Share of facts that are meant literally, in [0, 1]; None to estimate it (:meth:`FactEvidence.literal`).
    unary, absent, allowed
        Evidence without facts for that estimate: shapes (n1, n2), (n1,) and (n1, n2).
    deadline
        End of the time limit.

    Returns
    -------
    FactTables
        Log-likelihood ratios in nats, with one table for each content that facts share.

    Raises
    ------
    SettingError
        ``literal`` or a weight is outside 0 to 1.
    GraphError, OutOfTimeError, UnknownTermError
        As for :meth:`FactEvidence.of`.
    """
    if literal is not None and not 0 <= literal <= 1:
        raise SettingError(f"`literal`, the share of literal facts, must be between 0 and 1, got {literal:g}")
    evidence = FactEvidence.of(description, boxes, models, saying=saying, deadline=deadline)
    return evidence.tables(evidence.literal(unary, absent, allowed) if literal is None else literal)


@dataclass(frozen=True, eq=False)
class FactEvidence:
    """Evidence of m facts (k different ones) about n1 objects for n2 boxes, for any share of literal facts.

    It is built by :meth:`of`. The share is estimated with boxes and objects in a fixed order, so that it does not
    depend on the order in which they were given. Pairs are compared when the evidence is first used.
    """

    edges: NDArray[np.int64]  # (m,) edges of the description
    ends: NDArray[np.int64]  # (m, 2) subject and object
    kinds: NDArray[np.int64]  # (m,) which different fact each is
    order: NDArray[np.intp]  # (n2,) boxes sorted by coordinates
    by_name: NDArray[np.intp]  # (n1,) objects sorted by name
    models: RelationModels | None  # None: the shipped models
    compared: Callable[[RelationModels], _FactRatios]
    deadline: Deadline

    @classmethod
    def of(
        cls,
        description: RelationGraph,
        boxes: NDArray[np.float64],
        models: RelationModels | None = None,
        *,
        saying: bool = True,
        names: NDArray[np.integer] | None = None,
        everything: NDArray[np.float64] | None = None,
        poses: Poses | None = None,
        is_plan: bool = False,
        deadline: Deadline = Deadline.never(),
    ) -> FactEvidence:
        """Build the evidence of a description for boxes.

        Parameters
        ----------
        description
            The objects and the facts.
        boxes
            Boxes of the things, shape (n2, 2, d).
        models
            Models of the relation words; by default, the shipped ones.
        saying
            Whether to model which pairs people mention.
        names
            Exact relations of the pairs as indices, shape (n2, n2), where they are already known.
        everything
            All boxes of the scene, shape (n, 2, d), where ``boxes`` are only some of them.
        poses
            Poses of the n2 things; None for axes along the sides of the boxes, and no fronts.
        is_plan
            Whether the boxes are seen from above, without heights: *taller* and *shorter* then carry no information.
        deadline
            End of the time limit.

        Returns
        -------
        FactEvidence
            Evidence whose methods compute the tables.

        Raises
        ------
        GraphError
            ``boxes`` are not valid boxes.
        OutOfTimeError
            The deadline passed; the methods raise it, too.
        UnknownTermError, SettingError
            Raised by the methods only: a word has no model, or a weight is outside 0 to 1.
        """
        edges, ends, kinds, distinct = compared_facts(description)
        if is_plan:
            distinct = [_without_stature(said, description.vocabulary) for said in distinct]
        order = np.zeros(0, dtype=np.intp)
        if len(boxes):
            order = np.lexsort(np.reshape(boxes, (len(boxes), -1)).T[::-1])
        if names is None:
            names = box_relations(np.asarray(boxes, dtype=np.float64), description.vocabulary).names
        names, boxes = names[np.ix_(order, order)], np.asarray(boxes[order], dtype=np.float64)
        require_boxes(boxes)
        posed = None if poses is None else poses[order]
        nearer: PairBlocks | Surroundings
        if everything is None:
            nearer = PairBlocks.of(boxes, deadline, posed)
        else:
            nearer = Surroundings.of(boxes, everything, deadline, posed)

        def compared(known: RelationModels) -> _FactRatios:
            return _FactRatios(nearer, names, SaidFacts(known, description.vocabulary, saying, distinct), deadline)

        by_name = np.argsort(np.array(description.nodes, dtype=str))
        return cls(edges, ends, kinds, order, by_name, models, compared, deadline)

    @cached_property
    def ratios(self) -> _FactRatios:
        """Likelihood ratios of the facts by the models."""
        return self.compared(self.models or shipped_models())

    def literal(
        self,
        unary: Array | None = None,
        absent: Array | None = None,
        allowed: NDArray[np.bool_] | None = None,
    ) -> float:
        """Estimate the share of facts that are meant literally, in [0, ``literalness.LITERAL``].

        The estimate uses the shipped models and the evidence without facts, as in
        :class:`deixis.reasoning.grounding.matching.problem.Problem`. Where the time does not suffice for the tables of
        both speakers, it is the prior share.

        Parameters
        ----------
        unary
            Evidence of each match in nats, shape (n1, n2); 0 by default.
        absent
            Value of leaving each object out, in nats, shape (n1,).
        allowed
            Allowed matches, shape (n1, n2); all by default.

        Returns
        -------
        float
            Expected share of literal facts.
        """
        shape = len(self.by_name), len(self.order)
        seconds = JUDGEMENT_SECONDS_PER_CELL * int(self.kinds.max(initial=-1) + 1) * len(self.order) ** 2
        if self.deadline.slowness * seconds > JUDGEMENT_SHARE * self.deadline.left:
            return LITERAL * LITERAL_PRIOR
        alone = np.zeros(shape) if unary is None else np.ascontiguousarray(unary[:, self.order])
        away = np.full(shape[0], ABSENT_LOG_ODDS) if absent is None else absent
        may = np.ones(shape, dtype=bool) if allowed is None else allowed[:, self.order]
        shipped = self.ratios if self.models is None else self.compared(shipped_models())  # not kept
        either = (Problem(self.ends, self.kinds, shipped.tables(share), alone, away, may) for share in (0.0, LITERAL))
        return literal_share(either, self.by_name, self.deadline.share(JUDGEMENT_SHARE))

    def tables(self, literal: float) -> FactTables:
        """Return the evidence if a share of the facts is meant literally.

        Parameters
        ----------
        literal
            Share of facts that are meant literally, in [0, 1].

        Returns
        -------
        FactTables
            Log-likelihood ratios in nats.

        Raises
        ------
        OutOfTimeError
            The deadline passed.
        UnknownTermError, SettingError
            A word has no model, or a weight is outside 0 to 1.
        """
        return self._as_given(self.ratios.tables(literal, np.argsort(self.order)))

    def most(self) -> FactTables:
        """Return an upper bound of the evidence of every pair, for any share that :meth:`literal` may return.

        Returns
        -------
        FactTables
            Tables of upper bounds in nats.
        """
        back = np.argsort(self.order)
        graded, literal = self.ratios.tables(0.0, back), self.ratios.tables(LITERAL, back)
        return self._as_given(np.maximum(graded, literal, out=graded))

    def _as_given(self, tables: NDArray[np.float32]) -> FactTables:
        return FactTables(self.edges, self.ends, self.kinds, tables)


class SaidFacts:
    """Likelihood ratios of k different facts (relations, sign, weight), for a graded and for a literal speaker.

    ``literal`` (k, relations + 1) holds the likelihood ratios of a literal speaker by the exact relation of the pair;
    the last column is for pairs without one (index -1). ``weights`` (k, 1) holds the weights of the facts.
    """

    def __init__(self, models: RelationModels, vocabulary: Relations, saying: bool, distinct: Sequence[Said]) -> None:
        self.models, self.vocabulary, self.saying = models, vocabulary, saying
        self.mean_mention_weight = models[SAYING].chance if saying else 1.0
        self.contents = [(vocabulary.members(mask), positive, weight) for mask, positive, weight in distinct]
        by_name = [self._literal(relations, positive) for relations, positive, _ in self.contents]
        self.literal = np.reshape(by_name, (len(by_name), len(vocabulary) + 1))
        self.weights = np.reshape([weight for _, _, weight in self.contents], (-1, 1))
        # a fact with a word that only its model decides has no literal meaning
        self.modelled = [any(relation.by_model for relation in relations) for relations, _, _ in self.contents]
        self.literally = np.reshape([0.0 if modelled else 1.0 for modelled in self.modelled], (-1, 1))

    def mention_weight(self, pairs: PairGeometry) -> NDArray[np.float32] | np.float32:
        """Return how readily people mention each pair of a block, in (0, 1].

        Parameters
        ----------
        pairs
            Geometry of the pairs of the block, with n subjects and m objects.

        Returns
        -------
        ndarray or np.float32
            Degrees, shape (n, m), or 1 for all pairs where mentions are not modelled.
        """
        return saying_degree(pairs, self.models).astype(np.float32) if self.saying else np.float32(1.0)

    def ratio(
        self,
        fact: int,
        degrees_of: WordDegrees,
        names: NDArray[np.uint8],
        mention_weight: NDArray[np.float32] | np.float32,
    ) -> NDArray[np.float32]:
        """Return the likelihood ratio of a fact for each pair of a block, for a graded speaker against chance.

        Parameters
        ----------
        fact
            Position of the fact among the k different ones.
        degrees_of
            Degrees of the words for the pairs of the block.
        names
            Index of the exact relation of each pair, shape (n, m).
        mention_weight
            How readily people mention each pair, from :meth:`mention_weight`.

        Returns
        -------
        ndarray
            Likelihood ratios, shape (n, m).
        """
        relations, positive, _ = self.contents[fact]
        outliers = float(np.mean([self.models.of(relation).outliers for relation in relations]))
        chances = np.array([self.models.of(relation).chance for relation in relations])
        fitting = [degrees_of.of(relation) for relation in relations]
        if not positive:
            holds = [np.append(self.vocabulary.degrees[relation.index] > 0, False) for relation in relations]
            chances = np.maximum(chances, [LITERAL_CHANCE * known.sum() for known in holds])
            fitting = [np.maximum(degree, known[names]) for degree, known in zip(fitting, holds, strict=True)]
        chance = float(combined(chances, positive))
        if self.modelled[fact]:  # such a word is said at any distance that fits it
            mention_weight = np.float32(1.0)
        else:
            chance *= self.mean_mention_weight
        by_chance = outliers + (1 - outliers) * chance
        degrees = combined(fitting, positive)
        ratio: NDArray[np.float32] = degrees.astype(np.float32)
        ratio *= mention_weight
        ratio *= np.float32((1 - outliers) / by_chance)
        ratio += np.float32(outliers / by_chance)
        return ratio

    def offset(self, facts: int | slice, share: float) -> NDArray[np.float32]:
        """Return the terms to add to graded ratios, by exact relation: those of a literal speaker and of hedges.

        Parameters
        ----------
        facts
            Position of a fact, or of several.
        share
            Share of literal facts, in [0, 1].

        Returns
        -------
        ndarray
            Terms, shape (…, relations + 1), with one row for each fact of a slice.
        """
        weights, shares = self.weights[facts], share * self.literally[facts]
        offset: NDArray[np.float32] = (weights * shares * self.literal[facts] + (1 - weights)).astype(np.float32)
        return offset

    def mixed(
        self,
        fact: int,
        degrees_of: WordDegrees,
        names: NDArray[np.uint8],
        mentioned: NDArray[np.float32] | np.float32,
        share: float,
    ) -> NDArray[np.float32]:
        """Return the likelihood ratio of a fact for each pair of a block, if a share of the facts is literal.

        Parameters
        ----------
        fact
            Position of the fact among the k different ones.
        degrees_of
            Degrees of the words for the pairs of the block.
        names
            Index of the exact relation of each pair, shape (n, m).
        mentioned
            How readily people mention each pair, from :meth:`mention_weight`.
        share
            Share of literal facts, in [0, 1].

        Returns
        -------
        ndarray
            Likelihood ratios, shape (n, m).
        """
        ratio = self.ratio(fact, degrees_of, names, mentioned)
        ratio *= np.float32(self.contents[fact][2] * (1 - share * float(self.literally[fact, 0])))
        ratio += self.offset(fact, share)[names]
        return ratio

    def _literal(self, relations: tuple[Relation, ...], positive: bool) -> Array:
        names = np.append(np.arange(len(self.vocabulary)), -1)
        degree = literal_degree(relations, positive, names, self.vocabulary, IMPLIED)
        chance = min(LITERAL_CHANCE * len(relations), 1.0)
        return np.exp(log_likelihood_ratio(degree, OUTLIERS, chance if positive else 1 - chance))


class _FactRatios:
    """Likelihood ratios of k different facts for all pairs of one scene.

    They are kept as ratios instead of logarithms, because speakers and hedges are mixtures.
    """

    def __init__(
        self, pairs: PairBlocks | Surroundings, names: NDArray[np.integer], facts: SaidFacts, deadline: Deadline
    ) -> None:
        self.names = np.where(names < 0, len(facts.vocabulary), names).astype(np.uint8)
        self.facts, self.deadline = facts, deadline
        self.graded = np.empty((len(facts.contents), *names.shape), np.float32)
        starts, started = range(0, len(names), SIDE), time.monotonic()
        blocks = [(a, b) for a in starts for b in starts if b <= a]
        for done, (subject, object) in enumerate(blocks):
            needed = (time.monotonic() - started) / max(done, 1) * (len(blocks) - done)
            self._require_time(needed if done >= FORESEEN_FROM else 0.0)
            subjects, objects = slice(subject, subject + SIDE), slice(object, object + SIDE)
            self._fill(subjects, objects, pairs.block(subjects, objects))

    def tables(self, share: float, order: NDArray[np.int64] | None = None) -> NDArray[np.float32]:
        """Return the evidence if ``share`` of the facts are literal, shape (k, n2, n2), 0 on the diagonals.

        ``order`` (n2,) is the order of the things in the result.
        """
        n, k, known = len(self.names), len(self.facts.contents), self.facts
        tables = empty_tables(k, n)
        some = max(1, min(k, TABLE_CELLS // max(n * n, 1)))
        room = np.empty((some, n, n), dtype=np.float32)
        for start in range(0, k, some):
            self._require_time()
            part = slice(start, start + some)
            likelihoods = room[: min(some, k - start)]
            np.take(known.offset(part, share), self.names, axis=1, out=likelihoods, mode="clip")
            scales = (known.weights[part] * (1 - share * known.literally[part])).astype(np.float32)[:, :, None]
            likelihoods += np.multiply(self.graded[part], scales, out=tables[part])
            np.log(likelihoods, out=likelihoods)
            likelihoods[:, np.arange(n), np.arange(n)] = 0.0
            if order is None:
                tables[part] = likelihoods
            else:
                for row, place in enumerate(order.tolist()):
                    np.take(likelihoods[:, place], order, axis=1, out=tables[part, row], mode="clip")
        return tables

    def _require_time(self, needed: float = 0.0) -> None:
        """Raise OutOfTimeError at the deadline, or where the seconds ``needed`` are far more than the time left.

        A scene of a single block is quick, and never raises.
        """
        if len(self.names) > SIDE and (self.deadline.passed or needed > FORESEEN_EXCESS * self.deadline.left):
            raise OutOfTimeError(
                f"time limit reached before the evidence of {len(self.names)} things was computed; raise it, or "
                "ground a smaller scene"
            )

    def _fill(self, subjects: slice, objects: slice, pairs: PairGeometry) -> None:
        """Compute the likelihood ratios of a block of pairs, and of the reversed pairs."""
        degrees = WordDegrees(pairs, self.facts.models)
        both = [(subjects, objects, pairs, degrees), (objects, subjects, pairs.reverse, degrees.reverse)]
        for rows, columns, some, fitting in both if subjects != objects else both[:1]:
            mention_weight = self.facts.mention_weight(some)
            for fact in range(len(self.graded)):
                self.graded[fact, rows, columns] = self.facts.ratio(
                    fact, fitting, self.names[rows, columns], mention_weight
                )


def literal_degree(
    relations: tuple[Relation, ...],
    positive: bool,
    names: NDArray[np.integer],
    vocabulary: Relations,
    implied: float = 0.5,
) -> Array:
    """Return crisp degrees by the exact relation of each pair: 1, ``implied``, or 0.

    Parameters
    ----------
    relations
        Relations of the fact, any one of which may hold.
    positive
        False for a denial.
    names
        Index of the exact relation of each pair, -1 for none; shape (n2, n2).
    vocabulary
        The known relations.
    implied
        Degree where a relation holds only in its wide reading.

    Returns
    -------
    ndarray
        Degrees, shape (n2, n2); 0 for pairs without a relation.
    """
    best = vocabulary.degrees[[relation.index for relation in relations]].max(axis=0)
    degree = np.where((best > 0) & (best < 1), implied, best) if positive else (best == 0).astype(np.float64)
    result: Array = np.where(names >= 0, degree[names], 0.0)
    return result


def combined(degrees: Sequence[Array] | Array, positive: bool) -> Array:
    """Return the degree of a choice between words (axis 0), or of the denial of all of them.

    Parameters
    ----------
    degrees
        Degrees of the words, each of the same shape.
    positive
        True for a choice, False for a denial.

    Returns
    -------
    ndarray
        The mean degree for a choice; for a denial, the product of the complements.

    Examples
    --------
    >>> combined(np.array([0.8, 0.2]), True).item(), round(combined(np.array([0.8, 0.5]), False).item(), 3)
    (0.5, 0.1)
    """
    if positive:
        return np.asarray(sum(degrees[1:], start=degrees[0]) / len(degrees))
    return np.asarray(prod([1 - degree for degree in degrees]))


def hedged(evidence: Array, weight: float) -> Array:
    """Return the evidence of a fact that holds with probability ``weight`` and is ignored otherwise.

    Parameters
    ----------
    evidence
        Log-likelihood ratios of the fact in nats, of any shape.
    weight
        Probability that the fact holds, above 0 and at most 1.

    Returns
    -------
    ndarray
        Log-likelihood ratios in nats, of the shape of ``evidence``.

    Raises
    ------
    SettingError
        The weight is not above 0 and at most 1.

    Examples
    --------
    >>> hedged(np.array([3.0, -3.0]), 1.0).tolist(), hedged(np.array([3.0, -3.0]), 0.8).round(2).tolist()
    ([3.0, -3.0], [2.79, -1.43])
    """
    if not 0 < weight <= 1:
        raise SettingError(f"the weight of a fact must be above 0 and at most 1, got {weight:g}")
    if weight == 1:
        return evidence
    result: Array = np.logaddexp(evidence + np.log(weight), np.log1p(-weight))
    return result


def crisp_tables(description: RelationGraph, names: NDArray[np.integer]) -> FactTables:
    """Return tables of the crisp reading: 1, 0.5 or 0 by the pair's exact relation, times the weight of the fact.

    Parameters
    ----------
    description
        The objects and the facts.
    names
        Index of the exact relation of each pair, -1 on the diagonal, shape (n2, n2), as in
        :class:`deixis.reasoning.geometry.rectangle.SceneRelations`.

    Returns
    -------
    FactTables
        Tables of degrees times weights.
    """
    vocabulary = description.vocabulary
    edges = np.flatnonzero(description.subjects != description.objects)
    tables = np.zeros((len(edges), *names.shape), dtype=np.float32)
    for row, edge in enumerate(edges.tolist()):
        relations = vocabulary.members(int(description.relation_sets[edge]))
        degree = literal_degree(relations, bool(description.affirmed[edge]), names, vocabulary)
        tables[row] = degree * description.affirmed_weights[edge]
    kinds = np.arange(len(edges), dtype=np.int64)
    return FactTables(edges.astype(np.int64), _ends(description, edges), kinds, tables)


def _ends(description: RelationGraph, edges: NDArray[np.intp]) -> NDArray[np.int64]:
    return np.stack([description.subjects[edges], description.objects[edges]], axis=1).astype(np.int64)
