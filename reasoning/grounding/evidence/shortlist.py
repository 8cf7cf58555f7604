"""Shortlist of the things of a large scene that the objects of a short description may be, without comparing all pairs.

Labels, sizes and colours select the candidates of each object. Each fact is compared with the pairs of its objects'
candidates only, which are its block. Messages between facts, objects and things (belief propagation, Pearl 1988; see
:mod:`deixis.reasoning.grounding.matching.search.belief_propagation`) then give approximate probabilities of the
candidates.

1. Facts are processed in the order of the size of their blocks, the smallest first. Between groups of facts, candidates
   that have become almost impossible are dropped, so that later blocks are smaller: an object of which only its
   position beside a labelled object is known is compared with the candidates of that object.
2. One more message from the likeliest candidates is sent to every thing of the scene, whatever its label, so that
   things that facts support return.
3. The shortlist holds the most probable things; the probability of the other things is part of the answer.

Memory grows with the sum of the blocks; time grows with that sum, and with the number of things times facts.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading
from deixis.reasoning.errors import OutOfMemoryError, OutOfTimeError
from deixis.reasoning.geometry.pairs import SPREAD, Surroundings
from deixis.reasoning.geometry.rectangle import cross_relations
from deixis.reasoning.grounding.evidence.facts.facts import SaidFacts, compared_facts, literal_degree
from deixis.reasoning.grounding.evidence.facts.literalness import LITERAL, LITERAL_PRIOR
from deixis.reasoning.grounding.evidence.words.degrees import WordDegrees, log_likelihood_ratio
from deixis.reasoning.grounding.evidence.words.meaning import OUTLIERS, Meaning, shipped_models
from deixis.reasoning.grounding.matching.problem import Problem

Array = NDArray[np.float64]
Things = NDArray[np.int64]

CANDIDATE_MARGIN = 6.0
"""Maximum difference in nats between the unary evidence of a candidate and that of the object's best thing."""

DROPPED, BEAM, HELD = 1e-4, 150, 0.5
"""Total belief of the candidates of an object that are dropped at a time; maximum number of candidates that are kept,
if they have at least the third share of the belief (the others return in the last step)."""

STAGE_CELLS, MAX_CELLS = 1_000_000, 8_000_000
"""Number of pairs compared before candidates are dropped again, unless one fact has more; and the maximum number of
pairs of all facts: the facts with most pairs, which discriminate least, are left for the end."""

CELLS_PER_SECOND, FIRST_SHARE, SECOND_SHARE = 3e6, 0.3, 0.15
"""Approximate number of pairs of candidates compared per second; shares of the time left for the first round of
messages, and for each of the later steps."""

ROWS_AT_ONCE, CELLS_AT_ONCE = 256, 1 << 16
"""Number of the subject's candidates, and of pairs, compared at a time: small enough for a processor's cache."""

MAX_SURROUNDED = 5000
"""Maximum number of things whose surroundings are computed at a time; otherwise those of the other end of a pair are
used."""

BYTES_PER_CELL = 8
"""Bytes per pair of candidates and fact: the ratio, and temporary arrays."""

LIKELIEST, FEW = 12, 3
"""Number of likeliest candidates of an object that send messages to all candidates of another object, and to every
thing of the scene; the first is also the minimum number of each object's things on the shortlist."""

TOLERANCES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1)
"""Maximum total belief of an object's things that are not on the shortlist; the first value for which the list is
short enough is used."""

TELLING = 0.2
"""Minimum total belief of the likeliest candidates of an object that send messages through a fact."""

STEPS, SETTLED, DAMPING = 40, 1e-3, 0.3
"""Maximum number of steps of messages, change of beliefs at convergence, and share of the old message that is kept."""

MAX_ODDS = 1e8
"""Maximum odds of a match in a message."""


@dataclass(frozen=True, eq=False)
class Shortlist:
    """The most likely things for n1 objects."""

    things: Things  # (k,) indices in rising order
    outside: Array  # (n1,) approximate probability that the object is another thing
    unused: int  # facts compared with the likeliest candidates only, because of the limits of time and memory


def shortlist(
    description: RelationGraph,
    boxes: Array,
    ranks: Things,
    alone: Problem,
    meaning: Meaning,
    most: int,
    gigabytes: float,
    deadline: Deadline = Deadline.never(),
) -> Shortlist:
    """Return the most likely things of n2 for n1 objects.

    Parameters
    ----------
    description
        The objects and the facts.
    boxes, ranks
        Boxes of all things, shape (n2, 2, d), and the ranks of their names, shape (n2,).
    alone
        Matching problem without facts: labels, sizes and colours.
    meaning
        Models of words, and weights of evidence.
    most
        Maximum length of the list.
    gigabytes
        Memory for the pairs of candidates, in units of 10^9 bytes.
    deadline
        End of the time limit.

    Returns
    -------
    Shortlist
        The chosen things, and what is known about the rest.

    Raises
    ------
    OutOfMemoryError, OutOfTimeError
        Labels, sizes and colours leave too many pairs of candidates.
    """
    weighing = _Weighing(description, boxes, ranks, meaning, deadline)
    close, everything = _candidates(alone), np.arange(len(boxes))
    messages, waiting = _staged(weighing, close, alone, gigabytes, deadline.share(FIRST_SHARE))
    if waiting and not messages.links:
        _refuse(weighing, messages, len(boxes), gigabytes)
    beliefs = _extended(weighing, messages, alone, waiting, close, LIKELIEST, deadline.share(SECOND_SHARE))
    again = [np.sort(np.argsort(-row[:-1], kind="stable")[:BEAM]) for row in beliefs]
    again = [np.intersect1d(some, known, assume_unique=True) for some, known in zip(again, close, strict=True)]
    messages, waiting = _staged(weighing, again, alone, gigabytes, deadline.share(SECOND_SHARE))
    others = [np.setdiff1d(everything, known, assume_unique=True) for known in close]
    found = _extended(weighing, messages, alone, waiting, others, FEW, deadline.share(SECOND_SHARE))
    return _chosen(_with_rest(found, beliefs, again), most, len(waiting))


def _staged(
    weighing: _Weighing, candidates: list[Things], alone: Problem, gigabytes: float, deadline: Deadline
) -> tuple[_Messages, list[int]]:
    """Return the messages after all affordable facts, those with the fewest pairs first, and the other facts."""
    messages, waiting, weighed = _Messages(candidates, alone), list(range(len(weighing.ends))), 0
    while waiting:
        now, in_memory = 0, gigabytes * 1e9 / BYTES_PER_CELL - messages.held_cells()
        affordable = min(in_memory, MAX_CELLS - weighed, deadline.left * weighing.cells_per_second)
        for fact in sorted(waiting, key=lambda fact: messages.cells(weighing.ends[fact])):
            cells = messages.cells(weighing.ends[fact])
            if now + cells > affordable or (now and now + cells > STAGE_CELLS):
                break
            now += cells
            waiting.remove(fact)
            subject, object = weighing.ends[fact].tolist()
            rows, columns = messages.candidates[subject], messages.candidates[object]
            messages.add(subject, object, weighing.ratios(fact, rows, columns), fact)
        weighed += now
        if not now and waiting:
            break
        messages.settle(deadline)
        if waiting:
            messages.drop()
    return messages, waiting


def _with_rest(found: Array, before: Array, again: list[Things]) -> Array:
    """Return beliefs (n1, n2 + 1) in which candidates that the second round left out keep their earlier beliefs.

    They matter where the likeliest candidates of an object do not have most of its belief.
    """
    rest = before.copy()
    rest[:, -1] = 0.0
    for row, some in zip(rest, again, strict=True):
        row[some] = 0.0
    share = rest.sum(axis=1, keepdims=True)
    result: Array = (1.0 - share) * found + rest
    return result


def _candidates(alone: Problem) -> list[Things]:
    """Return the things of each object whose unary evidence is near that of the best thing."""
    found = []
    for row, allowed in zip(alone.unary, alone.allowed, strict=True):
        best = row.max(where=allowed, initial=-np.inf)
        found.append(np.flatnonzero(allowed & (row >= best - CANDIDATE_MARGIN)))
    return found


def _refuse(weighing: _Weighing, messages: _Messages, things: int, gigabytes: float) -> None:
    """Raise an error where not one fact can be used, so that no thing is likelier than another."""
    if weighing.deadline.passed:
        raise OutOfTimeError(f"time limit reached before {things} things were compared; raise it, or pass fewer things")
    cells = min(messages.cells(ends) for ends in weighing.ends)
    known = f"labels and sizes leave {cells:,} pairs of {things} things to compare for each fact"
    needed = BYTES_PER_CELL * cells / 1e9
    if needed > gigabytes:
        raise OutOfMemoryError(
            f"{known}, which takes about {needed:.1f} GB; raise the memory limit (--memory-limit), or label more things"
        )
    raise OutOfTimeError(
        f"{known}, which takes about {cells / weighing.cells_per_second:.0f} s; raise the time limit (--time-limit), "
        "or label more things"
    )


class _Weighing:
    """Likelihood ratios of facts for any pairs of things, computed on demand."""

    def __init__(
        self, description: RelationGraph, boxes: Array, ranks: Things, meaning: Meaning, deadline: Deadline
    ) -> None:
        _, self.ends, self.kinds, distinct = compared_facts(description)
        self.boxes, self.ranks, self.vocabulary, self.deadline = boxes, ranks, description.vocabulary, deadline
        self.graded, self.distinct = meaning.graded, distinct
        self.facts = SaidFacts(meaning.models or shipped_models(), description.vocabulary, True, distinct)
        self.distances = np.zeros((0, 0), np.float32)  # of known things to others, as in Surroundings
        self.known = np.zeros(len(boxes), dtype=bool)
        self.weighed, self.seconds = 0, 0.0
        self.exact = [relation.index for relation in self.vocabulary.of_reading(Reading.EXACT)]

    def ratios(self, fact: int, rows: Things, columns: Things) -> NDArray[np.float32]:
        """Return the likelihood ratios (r, c) of a fact for things of its subject (rows) and its object (columns)."""
        found, started = np.empty((len(rows), len(columns)), np.float32), time.monotonic()
        near, far = self._surroundings(rows), self._surroundings(columns)
        for some, others in _blocks(len(rows), len(columns)):
            if self.deadline.passed:
                raise OutOfTimeError(
                    f"time limit reached while {len(self.boxes)} things were compared; raise it, or pass fewer things"
                )
            found[some, others] = self._block(
                int(self.kinds[fact]), rows[some], columns[others], near, far, some, others
            )
        found[rows[:, None] == columns[None, :]] = 0.0  # no thing is two objects
        self.weighed, self.seconds = self.weighed + found.size, self.seconds + time.monotonic() - started
        return found

    @property
    def cells_per_second(self) -> float:
        """Number of pairs compared per second: a prior guess combined with the measurements so far."""
        return (self.weighed + CELLS_PER_SECOND) / (self.seconds + 1.0)

    def _surroundings(self, things: Things) -> Surroundings:
        """Return the surroundings of things, which are cached; empty ones for more than ``MAX_SURROUNDED`` things."""
        if not self.graded or len(things) > MAX_SURROUNDED:
            return Surroundings(self.boxes[things], np.zeros((len(things), 0), np.float32))
        if not len(self.distances):
            self.distances = np.empty((len(self.boxes), min(SPREAD, len(self.boxes))), np.float32)
        new = things[~self.known[things]]
        if len(new):
            self.distances[new] = Surroundings.of(self.boxes[new], self.boxes, self.deadline).distances
            self.known[new] = True
        return Surroundings(self.boxes[things], self.distances[things])

    def _block(
        self,
        kind: int,
        rows: Things,
        columns: Things,
        near: Surroundings,
        far: Surroundings,
        some: slice,
        others: slice,
    ) -> NDArray[np.float32]:
        here, there = self.boxes[rows], self.boxes[columns]
        _, names = cross_relations(here, there, (self.ranks[rows], self.ranks[columns]), self.vocabulary)
        if self.graded:
            pairs = near.block_with(some, far, others)
            degrees, mentioned = WordDegrees(pairs, self.facts.models), self.facts.mention_weight(pairs)
            return self.facts.mixed(kind, degrees, names.astype(np.uint8), mentioned, LITERAL * LITERAL_PRIOR)
        relations, positive, weight = self.facts.contents[kind]
        by_name = literal_degree(relations, positive, np.arange(len(self.vocabulary)), self.vocabulary)
        ratio = np.exp(log_likelihood_ratio(by_name, OUTLIERS, float(by_name[self.exact].mean())))
        literal: NDArray[np.float32] = (weight * ratio + 1 - weight).astype(np.float32)[names]
        return literal


def _blocks(rows: int, columns: int) -> Iterator[tuple[slice, slice]]:
    wide = max(1, CELLS_AT_ONCE // min(ROWS_AT_ONCE, max(rows, 1)))
    for start in range(0, rows, ROWS_AT_ONCE):
        for left in range(0, columns, wide):
            yield slice(start, start + ROWS_AT_ONCE), slice(left, left + wide)


@dataclass
class _Link:
    """A fact between two objects, with its last messages."""

    fact: int
    ends: tuple[int, int]  # subject and object
    ratios: NDArray[np.float32]  # (r, c) likelihood ratios of their candidates
    log_messages: list[Array]  # log messages to the two ends, for each candidate and, last, for absence


class _Messages:
    """Belief propagation between n1 objects, facts and things, over the objects' candidates."""

    def __init__(self, candidates: list[Things], alone: Problem) -> None:
        self.candidates = candidates
        self.things = alone.unary.shape[1]
        self.links: list[_Link] = []
        self.alone = [
            np.append(row[things], out) for row, things, out in zip(alone.unary, candidates, alone.absent, strict=True)
        ]
        self.demand = [np.zeros(len(things) + 1) for things in candidates]

    def cells(self, ends: NDArray[np.int64]) -> int:
        """Return the number of pairs of candidates of a fact between two objects."""
        return len(self.candidates[int(ends[0])]) * len(self.candidates[int(ends[1])])

    def held_cells(self) -> int:
        """Return the number of pairs in memory."""
        return sum(link.ratios.size for link in self.links)

    def add(self, subject: int, object: int, ratios: NDArray[np.float32], fact: int) -> None:
        """Add a fact with its likelihood ratios (r, c)."""
        log_messages = [np.zeros(len(self.candidates[end]) + 1) for end in (subject, object)]
        self.links.append(_Link(fact, (subject, object), ratios, log_messages))

    def log_totals(self) -> list[Array]:
        """Return the sum of unary evidence and messages of facts, for the candidates and absence of each object."""
        total = [alone.copy() for alone in self.alone]
        for link in self.links:
            for end, log_messages in zip(link.ends, link.log_messages, strict=True):
                total[end] += log_messages
        return total

    def beliefs(self) -> list[Array]:
        """Return the approximate probability of each object's candidates and, last, of its absence."""
        return [_shares(known + demand) for known, demand in zip(self.log_totals(), self.demand, strict=True)]

    def settle(self, deadline: Deadline) -> None:
        """Exchange messages until the beliefs converge, or until the deadline."""
        before = self.beliefs()
        for _ in range(STEPS):
            self._ask_things()
            known = self.log_totals()
            logs = [one + demand for one, demand in zip(known, self.demand, strict=True)]
            for link in self.links:
                (s, o), (to_s, to_o) = link.ends, link.log_messages
                weights_s, weights_o = _weights(logs[s] - to_s), _weights(logs[o] - to_o)
                _damped_update(to_o, weights_s[:-1] @ link.ratios, weights_s)
                _damped_update(to_s, link.ratios @ weights_o[:-1], weights_o)
            after = self.beliefs()
            change = max((float(np.abs(a - b).sum()) for a, b in zip(after, before, strict=True)), default=0.0)
            if change < SETTLED or deadline.passed:
                return
            before = after

    def _ask_things(self) -> None:
        """Update the message of every thing to each object: the odds that another object is this thing."""
        wanted, own = np.zeros(self.things), []
        for known, demand, things in zip(self.log_totals(), self.demand, self.candidates, strict=True):
            share = _shares(known + demand)
            odds = share * np.exp(np.minimum(-demand, 60.0)) / np.maximum(1.0 - share, 1e-12)
            odds = np.minimum(odds[:-1], MAX_ODDS)
            wanted[things] += odds
            own.append(odds)
        for demand, things, odds in zip(self.demand, self.candidates, own, strict=True):
            log_message = -np.log1p(np.maximum(wanted[things] - odds, 0.0))
            demand[:-1] = DAMPING * demand[:-1] + (1 - DAMPING) * log_message

    def drop(self) -> None:
        """Drop the least likely candidates of the objects that have facts."""
        linked = {end for link in self.links for end in link.ends}
        kept = [
            _likeliest(belief[:-1]) if i in linked else np.ones(len(belief) - 1, dtype=bool)
            for i, belief in enumerate(self.beliefs())
        ]
        for i, keep in enumerate(kept):
            self.candidates[i], keep = self.candidates[i][keep], np.append(keep, True)
            self.alone[i], self.demand[i] = self.alone[i][keep], self.demand[i][keep]
        for link in self.links:
            s, o = link.ends
            link.ratios = np.ascontiguousarray(link.ratios[np.ix_(kept[s], kept[o])])
            link.log_messages = [
                message[np.append(kept[end], True)] for end, message in zip(link.ends, link.log_messages, strict=True)
            ]


def _likeliest(belief: Array) -> NDArray[np.bool_]:
    """Return the mask (c,) of candidates to keep: all except ``DROPPED``; of these, ``BEAM`` if they have ``HELD``."""
    order = np.argsort(-belief, kind="stable")
    sums = np.cumsum(belief[order])
    kept = np.zeros(len(belief), dtype=bool)
    if not len(belief):
        return kept
    count = int((sums < (1 - DROPPED) * sums[-1]).sum()) + 1
    if count > BEAM and sums[BEAM - 1] >= HELD * sums[-1]:
        count = BEAM
    kept[order[:count]] = True
    return kept


def _weights(logs: Array) -> NDArray[np.float32]:
    weights: NDArray[np.float32] = np.exp(logs - logs.max()).astype(np.float32)
    return weights


def _shares(logs: Array) -> Array:
    weights = np.exp(logs - logs.max())
    shares: Array = weights / weights.sum()
    return shares


def _damped_update(log_message: Array, by_thing: NDArray[np.float32], weights: NDArray[np.float32]) -> None:
    """Update the message of a fact to an object, for its candidates and its absence, in place."""
    total = float(weights.sum())
    new = np.append(np.log(np.maximum(by_thing + weights[-1], 1e-30) / total), 0.0)
    log_message *= DAMPING
    log_message += (1 - DAMPING) * new


def _extended(
    weighing: _Weighing,
    messages: _Messages,
    alone: Problem,
    waiting: list[int],
    reach: list[Things],
    most: int,
    deadline: Deadline,
) -> Array:
    """Return approximate probabilities (n1, n2 + 1) that each object is each thing in its ``reach``, or absent.

    A fact sends messages to things that are not candidates from at most ``most`` of the likeliest candidates of its
    other object. So do the facts that are ``waiting``, whose candidates were not compared.
    """
    n1, n2 = alone.unary.shape
    candidates = messages.candidates
    logs = [known + demand for known, demand in zip(messages.log_totals(), messages.demand, strict=True)]
    log_unary = [np.where(alone.allowed[i, things], alone.unary[i, things], -np.inf) for i, things in enumerate(reach)]
    cells = sum(len(reach[end]) for end in weighing.ends.ravel().tolist())
    each = max(1, int(min(most, deadline.left * weighing.cells_per_second / max(cells, 1))))
    facts = [(link.fact, link.ends, link.log_messages) for link in messages.links]
    silent = [np.zeros(1), np.zeros(1)]
    facts += [(fact, (int(weighing.ends[fact, 0]), int(weighing.ends[fact, 1])), silent) for fact in waiting]
    for fact, ends, from_fact in facts:
        for place in (0, 1):
            here, there = ends[place], ends[1 - place]
            if deadline.passed or not len(candidates[there]):
                continue
            weights = _shares(logs[there] - from_fact[1 - place])
            likeliest = np.argsort(-weights[:-1], kind="stable")[:each]
            things, kept = candidates[there][likeliest], weights[likeliest]
            if kept.sum() < TELLING or not len(reach[here]):
                continue
            rows, columns = (reach[here], things) if place == 0 else (things, reach[here])
            ratios = weighing.ratios(fact, rows, columns)
            by_thing = (ratios if place == 0 else ratios.T) @ kept + (1.0 - kept.sum())
            log_unary[here] += np.log(np.maximum(by_thing, 1e-30))
    found = np.zeros((n1, n2 + 1))
    unused = np.bincount(weighing.ends[waiting].ravel(), minlength=n1) > 0
    for i in range(n1):
        log = np.full(n2 + 1, -np.inf)
        log[reach[i]] = log_unary[i]
        if not unused[i]:
            log[candidates[i]] = logs[i][:-1]
        log[-1] = logs[i][-1]
        found[i] = _shares(log)
    return found


def _chosen(beliefs: Array, most: int, unused: int) -> Shortlist:
    """Return the things that have all belief except for the least tolerance for which they are at most ``most``."""
    n1, n2 = beliefs.shape[0], beliefs.shape[1] - 1
    order = np.argsort(-beliefs[:, :-1], axis=1, kind="stable")
    sums = np.cumsum(np.take_along_axis(beliefs[:, :-1], order, axis=1), axis=1)
    things = np.zeros(0, dtype=np.int64)
    for tolerance in (*TOLERANCES, None):
        if tolerance is None:
            count = np.full(n1, max(1, most // max(n1, 1)))
        else:
            count = (sums < sums[:, -1:] - tolerance).sum(axis=1) + 1
        count = np.clip(count, min(LIKELIEST, max(1, most // max(n1, 1))), n2)
        things = np.unique(np.concatenate([row[:number] for row, number in zip(order, count, strict=True)]))
        if len(things) <= most:
            break
    outside = np.clip(sums[:, -1] - beliefs[:, things].sum(axis=1), 0.0, 1.0)
    return Shortlist(things, outside, unused)
