"""The few things of a large scene that the objects of a short description may be, without comparing all pairs.

Facts are weighed for pairs of candidates only, a block for each fact, and what things are by themselves (labels, sizes,
colours) says who is a candidate. Messages between facts, objects and things (belief propagation; see
:mod:`deixis.reasoning.grounding.matching.belief_propagation`) then say about how probable each candidate is.

1. Facts are taken in the order of their blocks, the smallest first. After each few, candidates that have become all but
   impossible are dropped, so that later blocks are smaller: an object of which nothing is known but that it lies beside
   one with a label is compared with what that may be.
2. By one message more from the likeliest candidates, every thing of the scene is weighed, whatever its label says: what
   facts speak for comes back.
3. The shortlist holds what is left by probability; how much of the beliefs is not on it is part of the answer.

Memory grows with the sum of the blocks, time with that and with the things by facts.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.ontology.graph import RelationGraph
from deixis.ontology.relation import Reading
from deixis.reasoning.errors import OutOfMemoryError, OutOfTimeError
from deixis.reasoning.geometry.pairs import SPREAD, Surroundings
from deixis.reasoning.geometry.rectangle import cross_relations
from deixis.reasoning.grounding.evidence.degrees import log_likelihood_ratio
from deixis.reasoning.grounding.evidence.facts import SaidFacts, compared_facts, literal_degree
from deixis.reasoning.grounding.evidence.literalness import LITERAL, LITERAL_PRIOR
from deixis.reasoning.grounding.evidence.meaning import OUTLIERS, Meaning, shipped_models
from deixis.reasoning.grounding.matching.problem import Problem

Array = NDArray[np.float64]
Things = NDArray[np.int64]

CANDIDATE_MARGIN = 6.0
"""Nats by which a thing may speak less for itself than the best thing of an object and still be a candidate."""

DROPPED, BEAM, HELD = 1e-4, 150, 0.5
"""Belief of all candidates of an object together that are dropped at a time, on the way; how many are kept where they
hold so much of it, the others being looked at again in the end."""

STAGE_CELLS, MAX_CELLS = 1_000_000, 8_000_000
"""Pairs of the facts that are weighed before candidates are dropped again, unless one fact has more; and pairs of all
facts at the most: those with most pairs, which tell least apart, are left for the end."""

CELLS_PER_SECOND, FIRST_SHARE, SECOND_SHARE = 3e6, 0.3, 0.15
"""Pairs of candidates that are weighed in a second, about, and the shares of the time left for the first round of
messages, and for each of the steps that follow."""

ROWS_AT_ONCE, CELLS_AT_ONCE = 256, 1 << 16
"""Candidates of the subject, and pairs, that are weighed at a time: small enough for a processor's cache."""

MAX_SURROUNDED = 5000
"""Things of which it is worked out how crowded they are; of more at a time, the other side of a pair tells it."""

BYTES_PER_CELL = 8
"""Of a pair of candidates by fact: its ratio, and what is at work beside it."""

LIKELIEST, FEW = 12, 3
"""Candidates of an object by which all its candidates are weighed anew, and every thing of the scene; and how many of
each are on the shortlist at least."""

TOLERANCES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1)
"""Beliefs that an object's things that are not on the shortlist may have together: the first for which it fits."""

TELLING = 0.2
"""Belief that the likeliest candidates of an object have together, at least, where facts tell of others by them."""

STEPS, SETTLED, DAMPING = 40, 1e-3, 0.3
"""Steps of messages at most, the change at which they end, and the share of a message that stays as it was."""

MAX_ODDS = 1e8


@dataclass(frozen=True, eq=False)
class Shortlist:
    """``things`` (k,), rising: those worth a look; ``outside`` (n1,): about how probable it is that an object is none
    of them and not absent either; ``unused`` facts were weighed only beside the likeliest candidates, for want of time
    or memory."""

    things: Things
    outside: Array
    unused: int


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
    """Return which of n2 things are worth a look for n1 objects, ``most`` of them at the most.

    Parameters
    ----------
    description
        The objects and the facts.
    boxes, ranks
        All things (n2, 2, d), and the order of their names (n2,).
    alone
        The problem without facts: what speaks for each thing by itself.
    meaning
        How words are taken.
    most
        Length of the list at the most.
    gigabytes
        Memory that pairs of candidates may take.
    deadline
        When it has to be done.

    Raises
    ------
    OutOfMemoryError, OutOfTimeError
        Where what is known of things by themselves leaves too many pairs of candidates.
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
    """Return what facts make of the candidates, taken in the order of their pairs, and the facts left for want of time
    or memory."""
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
    """Return beliefs (n1, n2 + 1) in which the candidates that were left out the second time have what they had.

    Where an object's likeliest candidates do not hold most of what was believed, the others are not to be forgotten.
    """
    rest = before.copy()
    rest[:, -1] = 0.0
    for row, some in zip(rest, again, strict=True):
        row[some] = 0.0
    share = rest.sum(axis=1, keepdims=True)
    result: Array = (1.0 - share) * found + rest
    return result


def _candidates(alone: Problem) -> list[Things]:
    """Return the things of each object that speak for themselves about as well as the best."""
    found = []
    for row, allowed in zip(alone.unary, alone.allowed, strict=True):
        best = row.max(where=allowed, initial=-np.inf)
        found.append(np.flatnonzero(allowed & (row >= best - CANDIDATE_MARGIN)))
    return found


def _refuse(weighing: _Weighing, messages: _Messages, things: int, gigabytes: float) -> None:
    """Raise an error where not one fact can be used: nothing then tells which things are worth a look."""
    if weighing.deadline.passed:
        raise OutOfTimeError(f"the time limit passed before {things} things were compared; raise it, or look at fewer")
    cells = min(messages.cells(ends) for ends in weighing.ends)
    known = f"what labels and sizes tell leaves {cells:,} pairs of {things} things to compare for each fact"
    needed = BYTES_PER_CELL * cells / 1e9
    if needed > gigabytes:
        raise OutOfMemoryError(
            f"{known}, which takes about {needed:.1f} GB: raise the memory limit (--memory-limit), or label more things"
        )
    raise OutOfTimeError(
        f"{known}, which takes about {cells / weighing.cells_per_second:.0f} s: raise the time limit (--time-limit), "
        "or label more things"
    )


class _Weighing:
    """The likelihood ratios of facts for any pairs of things, worked out when they are asked for."""

    def __init__(
        self, description: RelationGraph, boxes: Array, ranks: Things, meaning: Meaning, deadline: Deadline
    ) -> None:
        _, self.ends, self.kinds, distinct = compared_facts(description)
        self.boxes, self.ranks, self.vocabulary, self.deadline = boxes, ranks, description.vocabulary, deadline
        self.graded, self.distinct = meaning.graded, distinct
        self.facts = SaidFacts(meaning.models or shipped_models(), description.vocabulary, True, distinct)
        self.distances = np.zeros((0, 0), np.float32)  # of things that are known, to others: see Surroundings
        self.known = np.zeros(len(boxes), dtype=bool)
        self.weighed, self.seconds = 0, 0.0
        self.exact = [relation.index for relation in self.vocabulary.of_reading(Reading.EXACT)]

    def ratios(self, fact: int, rows: Things, columns: Things) -> NDArray[np.float32]:
        """Return the likelihood ratio of a fact for each thing of the subject with each of the object, (r, c)."""
        found, started = np.empty((len(rows), len(columns)), np.float32), time.monotonic()
        near, far = self._surroundings(rows), self._surroundings(columns)
        for some, others in _blocks(len(rows), len(columns)):
            if self.deadline.passed:
                raise OutOfTimeError(
                    f"the time limit passed while {len(self.boxes)} things were compared; raise it, or look at fewer"
                )
            found[some, others] = self._block(
                int(self.kinds[fact]), rows[some], columns[others], near, far, some, others
            )
        found[rows[:, None] == columns[None, :]] = 0.0  # no thing is two objects
        self.weighed, self.seconds = self.weighed + found.size, self.seconds + time.monotonic() - started
        return found

    @property
    def cells_per_second(self) -> float:
        """How many pairs are weighed in a second: a guess, and what was seen so far, on a busy machine, too."""
        return (self.weighed + CELLS_PER_SECOND) / (self.seconds + 1.0)

    def _surroundings(self, things: Things) -> Surroundings:
        """Return the surroundings of some things, which are worked out once; of all things none are."""
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
            return self.facts.mixed(kind, pairs, names.astype(np.uint8), LITERAL * LITERAL_PRIOR)
        relations, positive, weight = self.facts.said[kind]
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
    """A fact: its two objects, the ratios of their candidates, and what it last told either of them, the last entry of
    its being absent."""

    fact: int
    ends: tuple[int, int]
    ratios: NDArray[np.float32]
    told: list[Array]


class _Messages:
    """Beliefs of n1 objects about their candidates, by what facts and things tell them."""

    def __init__(self, candidates: list[Things], alone: Problem) -> None:
        self.candidates = candidates
        self.things = alone.unary.shape[1]
        self.links: list[_Link] = []
        self.alone = [
            np.append(row[things], out) for row, things, out in zip(alone.unary, candidates, alone.absent, strict=True)
        ]
        self.demand = [np.zeros(len(things) + 1) for things in candidates]

    def cells(self, ends: NDArray[np.int64]) -> int:
        """Return how many pairs of candidates a fact has."""
        return len(self.candidates[int(ends[0])]) * len(self.candidates[int(ends[1])])

    def held_cells(self) -> int:
        """Return how many pairs are held."""
        return sum(link.ratios.size for link in self.links)

    def add(self, subject: int, object: int, ratios: NDArray[np.float32], fact: int) -> None:
        """Take a fact into account from now on."""
        told = [np.zeros(len(self.candidates[end]) + 1) for end in (subject, object)]
        self.links.append(_Link(fact, (subject, object), ratios, told))

    def known(self) -> list[Array]:
        """Return what each object is told, by itself and by its facts."""
        total = [alone.copy() for alone in self.alone]
        for link in self.links:
            for end, told in zip(link.ends, link.told, strict=True):
                total[end] += told
        return total

    def beliefs(self) -> list[Array]:
        """Return about how probable each candidate is; last, absence."""
        return [_shares(known + demand) for known, demand in zip(self.known(), self.demand, strict=True)]

    def settle(self, deadline: Deadline) -> None:
        """Exchange messages until beliefs change no more."""
        before = self.beliefs()
        for _ in range(STEPS):
            self._ask_things()
            known = self.known()
            logs = [one + demand for one, demand in zip(known, self.demand, strict=True)]
            for link in self.links:
                (s, o), (to_s, to_o) = link.ends, link.told
                weights_s, weights_o = _weights(logs[s] - to_s), _weights(logs[o] - to_o)
                _tell(to_o, weights_s[:-1] @ link.ratios, weights_s)
                _tell(to_s, link.ratios @ weights_o[:-1], weights_o)
            after = self.beliefs()
            change = max((float(np.abs(a - b).sum()) for a, b in zip(after, before, strict=True)), default=0.0)
            if change < SETTLED or deadline.passed:
                return
            before = after

    def _ask_things(self) -> None:
        """Have every thing tell each object how much the others want it."""
        wanted, own = np.zeros(self.things), []
        for known, demand, things in zip(self.known(), self.demand, self.candidates, strict=True):
            share = _shares(known + demand)
            odds = share * np.exp(np.minimum(-demand, 60.0)) / np.maximum(1.0 - share, 1e-12)
            odds = np.minimum(odds[:-1], MAX_ODDS)
            wanted[things] += odds
            own.append(odds)
        for demand, things, odds in zip(self.demand, self.candidates, own, strict=True):
            told = -np.log1p(np.maximum(wanted[things] - odds, 0.0))
            demand[:-1] = DAMPING * demand[:-1] + (1 - DAMPING) * told

    def drop(self) -> None:
        """Drop the least likely candidates of the objects whose likeliest ones hold most of what is believed."""
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
            link.told = [told[np.append(kept[end], True)] for end, told in zip(link.ends, link.told, strict=True)]


def _likeliest(belief: Array) -> NDArray[np.bool_]:
    """Return which candidates are kept (c,): all but ``DROPPED``, and of these ``BEAM`` where they hold ``HELD``."""
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


def _tell(told: Array, by_thing: NDArray[np.float32], weights: NDArray[np.float32]) -> None:
    """Change what a fact tells an object of its candidates, and of its absence, in place."""
    total = float(weights.sum())
    new = np.append(np.log(np.maximum(by_thing + weights[-1], 1e-30) / total), 0.0)
    told *= DAMPING
    told += (1 - DAMPING) * new


def _extended(
    weighing: _Weighing,
    messages: _Messages,
    alone: Problem,
    waiting: list[int],
    reach: list[Things],
    most: int,
    deadline: Deadline,
) -> Array:
    """Return about how probable it is that each object is each thing in its reach, or absent, shape (n1, n2 + 1).

    Facts tell of other things than the candidates by the likeliest candidates, ``most`` at the most, of the other
    object; what the rest of those may be says nothing. So do facts that are ``waiting``, of which no candidates were
    compared.
    """
    n1, n2 = alone.unary.shape
    candidates = messages.candidates
    logs = [known + demand for known, demand in zip(messages.known(), messages.demand, strict=True)]
    told = [np.where(alone.allowed[i, things], alone.unary[i, things], -np.inf) for i, things in enumerate(reach)]
    cells = sum(len(reach[end]) for end in weighing.ends.ravel().tolist())
    each = max(1, int(min(most, deadline.left * weighing.cells_per_second / max(cells, 1))))
    facts = [(link.fact, link.ends, link.told) for link in messages.links]
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
            told[here] += np.log(np.maximum(by_thing, 1e-30))
    found = np.zeros((n1, n2 + 1))
    unused = np.bincount(weighing.ends[waiting].ravel(), minlength=n1) > 0
    for i in range(n1):
        log = np.full(n2 + 1, -np.inf)
        log[reach[i]] = told[i]
        if not unused[i]:
            log[candidates[i]] = logs[i][:-1]
        log[-1] = logs[i][-1]
        found[i] = _shares(log)
    return found


def _chosen(beliefs: Array, most: int, unused: int) -> Shortlist:
    """Return the things that hold all beliefs but a tolerance, the least for which they are few enough."""
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
