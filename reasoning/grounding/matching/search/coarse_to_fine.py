"""Belief propagation from coarse to fine: messages about groups of things, then about smaller and smaller groups.

A round of dense belief propagation costs the number of facts times the square of the number of things. Things that lie
near each other have similar rows in the tables of all facts, so that messages about them are similar too. Here the
things are first divided into a few dozen *cells*, and all things of a cell share their messages. Then every cell is
divided in two, the messages about it are those that its halves begin with, and each object keeps its most probable
cells only (hierarchical messages: Felzenszwalb and Huttenlocher 2006; candidates that are pruned from coarse to fine:
Fleuret and Geman 2001). A round costs the number of facts times the square of the number of candidates, which does not
grow with the scene. The last cells are single things.

The whole scene is aligned before its parts are, as in dense belief propagation with growing evidence.
"""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.errors import OutOfTimeError
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.belief_propagation import (
    DAMPING,
    RULED_OUT,
    SETTLED,
    Messages,
    placed_at,
)
from deixis.reasoning.kernel import njit

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

MIN_COARSE_THINGS = 200
"""Minimum number of things at which belief propagation goes from coarse to fine."""

FIRST_CELLS, KEPT_CELLS = 64, 48
"""Minimum number of cells at the first level, and number of cells that an object keeps before they are divided."""

ROUNDS, LAST_ROUNDS = 6, 30
"""Rounds of messages at each level, and maximum number at the last one."""

FIRST_POWER = 0.6
"""Power of the evidence at the first level; it grows to 1 at the last level."""

ABSENT_SHARES, ROUNDS_PER_PLACING = (0.25, 0.12, 0.06, 0.03, 0.0), 3
"""Minimum number of absent objects, as a share of the matches that are believed (the sum of the probabilities of each
object's likeliest thing), each time that absent objects get places at the last level; and rounds between these times.
The number is estimated from above: where absence is improbable at first, each absent object gets a wrong thing, which
then confirms that few are absent. Where few matches are believed, there is little to confirm it, and the evidence
hardly changes any estimate of the number: one that begins high would stay high."""

NEGLIGIBLE, UNCHANGED = 1e-3, -11.5
"""Share of the likeliest candidate below which a candidate does not count in a message; and log belief, relative to the
likeliest candidate, below which the messages about a candidate stay as they are."""

PROJECTIONS, COMPONENTS = 16, 6
"""Random projections of each table, and principal components of the projections, by which things are divided."""


def is_large(problem: Compiled) -> bool:
    """Return True if belief propagation on a problem goes from coarse to fine.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    bool
        False for a scene of fewer things than :data:`MIN_COARSE_THINGS`.
    """
    return bool(problem.unary.shape[1] > MIN_COARSE_THINGS)


class _Cells(NamedTuple):
    """Groups of things that follow each other in the order of the tree: cell c is ``order[start[c]:start[c + 1]]``."""

    order: NDArray[np.int64]  # (n2,)
    start: NDArray[np.int64]  # (cells + 1,)

    @property
    def sizes(self) -> NDArray[np.int64]:
        """Number of things of each cell, shape (cells,)."""
        return np.diff(self.start)

    def halves(self) -> tuple[_Cells, NDArray[np.int64]]:
        """Return cells of half the size, and the two halves of each cell, shape (cells, 2), -1 for no second one."""
        middle = (self.start[:-1] + self.start[1:]) // 2
        divided = self.sizes > 1
        first = np.arange(len(middle)) + np.concatenate([[0], np.cumsum(divided)[:-1]])
        start = np.unique(np.concatenate([self.start, middle[divided]]))
        return _Cells(self.order, start), np.stack([first, np.where(divided, first + 1, -1)], axis=1)


class _Candidates(NamedTuple):
    """Cells that each object may be in; the last column is absence."""

    cells: NDArray[np.int32]  # (n1, K): the number of cells for absence
    unary: NDArray[np.float32]  # (n1, K): logarithm of the evidence of the cell's things, without facts
    sizes: NDArray[np.float64]  # (n1, K): number of things


class _Slots(NamedTuple):
    """Slots of the problem (see ``problem.py``), and the order in which those of a table follow each other."""

    owner: NDArray[np.int64]  # (2m,)
    other: NDArray[np.int64]  # (2m,)
    twin: NDArray[np.int64]  # (2m,)
    kind: NDArray[np.int64]  # (2m,)
    order: NDArray[np.int64]  # (2m,)


class CoarseToFine:
    """Belief propagation from coarse to fine on one problem, which can begin several times.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    places
        Likelihood ratios of the facts at g places, shape (2k, g, n2); see
        :class:`deixis.reasoning.grounding.matching.problem.Problem`. None where absent objects have no places.
    """

    def __init__(self, problem: Compiled, places: NDArray[np.float32] | None) -> None:
        from scipy.sparse import csr_matrix

        self.problem, self.places = problem, places
        n1, slots = len(problem.unary), len(problem.kind)
        owner = np.repeat(np.arange(n1), np.diff(problem.first))
        order = np.argsort(problem.kind, kind="stable")
        self.slots = _Slots(owner, problem.other, problem.twin, problem.kind, order)
        self.adder = csr_matrix((np.ones(slots, np.float32), (owner, np.arange(slots))), shape=(n1, slots))
        tables = problem.tables[: len(problem.tables) // 2]
        self.largest = tables.max(axis=(1, 2)) if len(tables) else np.zeros(1, np.float32)

    def beliefs(self, deadline: Deadline = Deadline.never(), *, seed: int = 0) -> tuple[Messages, Compiled]:
        """Return approximate marginals, and the problem with a place for each object if it is absent.

        Parameters
        ----------
        deadline
            End of the time limit. Where the time is short, the levels have fewer rounds, but at least one; past it, the
            beliefs are those of the last level that was done, and the things of a cell share its probability by their
            evidence without facts.
        seed
            Seed of the division into cells, on which the result depends in scenes with repetitions.

        Returns
        -------
        tuple
            Probability of each match, shape (n1, n2 + 1); the last column is that of absence. Then the problem with the
            evidence of absent objects.
        """
        n1, n2 = len(self.problem.unary), self.problem.unary.shape[1] - 1
        cells = _Cells(_order_of_things(self.problem, seed), np.array([0, n2]))
        while len(cells.sizes) < min(FIRST_CELLS, n2):
            cells, _ = cells.halves()
        levels = math.ceil(math.log2(max(cells.sizes.max(initial=1), 1)))
        known = self._evidence(cells.order)
        chosen = np.tile(np.arange(len(cells.sizes)), (n1, 1))
        facts = np.zeros((len(self.slots.kind), chosen.shape[1] + 1), np.float32)
        demand = np.zeros((n1, chosen.shape[1] + 1), np.float32)
        candidates = _candidates(known, self.problem.unary[:, -1], cells, chosen, 1.0)
        done = candidates, cells, _by_evidence(candidates)
        with suppress(OutOfTimeError):
            likelihoods = self._likelihoods(cells.order, deadline)
            for level in range(levels):
                power = FIRST_POWER ** (1.0 - level / levels)
                candidates = _candidates(known, self.problem.unary[:, -1], cells, chosen, power)
                weights = _weights(likelihoods, cells, power, deadline)
                until = deadline.share(1.0 / (levels - level + 2))
                share, facts, _ = self._rounds(cells, candidates, weights, power, facts, demand, ROUNDS, until)
                done = candidates, cells, share
                kept = np.sort(np.argpartition(-share[:, :-1], min(KEPT_CELLS, share.shape[1] - 1) - 1)[:, :KEPT_CELLS])
                cells, halves = cells.halves()
                chosen = halves[np.take_along_axis(candidates.cells[:, :-1], kept, axis=1)].reshape(n1, -1)
                columns = np.column_stack([np.repeat(kept, 2, axis=1), np.full(n1, share.shape[1] - 1)])
                demand = np.take_along_axis(demand, columns, axis=1)
                facts = np.take_along_axis(facts, columns[self.slots.owner], axis=1)
            candidates = _candidates(known, self.problem.unary[:, -1], cells, chosen, 1.0)
            weights = _weights(likelihoods, cells, 1.0, deadline)
            share, _, problem = self._rounds(
                cells, candidates, weights, 1.0, facts, demand, LAST_ROUNDS, deadline, self.places
            )
            return _of_all_things(share, candidates, cells), problem
        return _of_things_in_cells(*done, known[0]), self.problem

    def refined(self, beliefs: Messages, deadline: Deadline = Deadline.never()) -> tuple[Messages, Compiled]:
        """Return the marginals of belief propagation that begins at given beliefs, and the problem with places.

        Parameters
        ----------
        beliefs
            Probability of each match, shape (n1, n2 + 1).
        deadline
            End of the time limit.

        Returns
        -------
        tuple
            As of :meth:`beliefs`.
        """
        n1, n2 = len(self.problem.unary), self.problem.unary.shape[1] - 1
        order = np.arange(n2)  # single things need no division
        cells = _Cells(order, np.arange(n2 + 1))
        kept = min(2 * KEPT_CELLS, n2)
        chosen = np.sort(np.argpartition(-beliefs[:, :-1], kept - 1)[:, :kept])
        candidates = _candidates(self._evidence(order), self.problem.unary[:, -1], cells, chosen, 1.0)
        weights = _weights(self._likelihoods(order), cells, 1.0)
        first = np.log(np.column_stack([np.take_along_axis(beliefs, chosen, axis=1), beliefs[:, -1]]) + 1e-6)
        facts = np.zeros((len(self.slots.kind), kept + 1), np.float32)
        demand = np.zeros((n1, kept + 1), np.float32)
        share, _, problem = self._rounds(
            cells, candidates, weights, 1.0, facts, demand, LAST_ROUNDS, deadline, self.places, first.astype(np.float32)
        )
        return _of_all_things(share, candidates, cells), problem

    def _rounds(
        self,
        cells: _Cells,
        candidates: _Candidates,
        weights: NDArray[np.float32],
        power: float,
        facts: Messages,
        demand: Messages,
        most: int,
        deadline: Deadline,
        places: NDArray[np.float32] | None = None,
        first: Messages | None = None,
    ) -> tuple[Messages, Messages, Compiled]:
        """Send messages for at most ``most`` rounds; return the probabilities of candidates (n1, K) and the messages.

        The messages of demand (n1, K) are changed in place, those of facts (2m, K) are returned. The first beliefs are
        those of the messages unless they are given (n1, K). The last result is the problem with places.
        """
        problem, slots = self.problem, self.slots
        largest = self.largest[slots.kind % len(self.largest)][:, None]
        absent = np.repeat(np.exp(-np.float32(power) * largest), candidates.cells.shape[1], axis=1)
        things = np.append(cells.order, problem.unary.shape[1] - 1)
        before, placings = np.zeros_like(demand), 0
        with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
            for done in range(most):
                incoming = self.adder @ facts + candidates.unary
                _update_demand(demand, incoming, candidates, len(cells.sizes))
                belief = incoming + demand if done or first is None else first
                belief -= belief.max(axis=1, keepdims=True)
                share = np.exp(belief)
                share /= share.sum(axis=1, keepdims=True)
                change, before = np.abs(share - before).sum(axis=1).max(initial=0.0), share
                settled = change <= SETTLED and (places is None or placings == len(ABSENT_SHARES))
                if done and (deadline.passed or settled):
                    break
                if places is not None and placings < len(ABSENT_SHARES) and done % ROUNDS_PER_PLACING == 0:
                    seen = things[candidates.cells]
                    fits = self._fits_of_places(seen, _cavities(belief, facts, slots))
                    believed = float(share[:, :-1].max(axis=1).sum())
                    expected = max(float(share[:, -1].sum()), ABSENT_SHARES[placings] * believed)
                    problem = placed_at(self.problem, places, fits, expected)
                    candidates.unary[:, -1] = problem.unary[:, -1]
                    absent = np.exp(np.take_along_axis(problem.away, seen[slots.other], axis=1) - largest)
                    placings += 1
                facts = _sent(facts, belief, absent, candidates.cells, weights, slots, pool)
        return share, facts, problem

    def _fits_of_places(self, things: NDArray[np.int64], cavity: Messages) -> NDArray[np.float32]:
        """Return the logarithm of the likelihood of each object's facts at each place, (n1, g).

        ``things`` (n1, K) are the candidates, ``cavity`` (2m, K) the messages about the other object of each slot.
        """
        from scipy.sparse import csr_matrix

        assert self.places is not None
        fits = np.zeros((len(things), self.places.shape[1]), np.float32)
        for kind in np.unique(self.slots.kind):
            here = np.flatnonzero(self.slots.kind == kind)
            rows, columns = np.nonzero(cavity[here, :-1])
            seen = things[self.slots.other[here][rows], columns]
            shape = len(here), self.places.shape[2]
            messages: csr_matrix = csr_matrix((cavity[here[rows], columns], (rows, seen)), shape=shape)
            likelihoods = messages @ self.places[kind].T + cavity[here, -1:]
            fits += self.adder[:, here] @ np.log(likelihoods)
        return fits

    def _likelihoods(self, order: NDArray[np.int64], deadline: Deadline = Deadline.never()) -> NDArray[np.float32]:
        """Return each table's likelihoods in the order of the things, (k, n2, n2), divided by the largest one.

        One thing for two objects has likelihood 0. Raise OutOfTimeError past the deadline.
        """
        kinds, n2 = len(self.problem.tables) // 2, len(order)
        likelihoods = np.empty((kinds, n2, n2), np.float32)
        for kind in range(kinds):
            _require_time(deadline)
            np.exp(self.problem.tables[kind][np.ix_(order, order)] - self.largest[kind], out=likelihoods[kind])
            np.fill_diagonal(likelihoods[kind], 0.0)
        return likelihoods

    def _evidence(self, order: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the likelihoods of matches in the order of the things, (n1, n2), relative to each object's largest."""
        unary = np.where(self.problem.allowed[:, :-1], self.problem.unary[:, :-1], -np.inf)[:, order]
        largest = np.maximum(unary.max(axis=1, initial=-np.inf), RULED_OUT)
        return np.exp(unary - largest[:, None]), largest


def _of_all_things(share: Messages, candidates: _Candidates, cells: _Cells) -> Messages:
    """Return the probabilities of candidates (n1, K) as those of all things and of absence, (n1, n2 + 1)."""
    found = np.zeros((len(share), len(cells.order) + 1), np.float32)
    is_real = candidates.unary > RULED_OUT
    is_real[:, -1] = True
    things = np.append(cells.order, len(cells.order))[candidates.cells]
    np.add.at(found, (np.nonzero(is_real)[0], things[is_real]), share[is_real])
    found /= found.sum(axis=1, keepdims=True)
    return found


def _by_evidence(candidates: _Candidates) -> Messages:
    """Return the probabilities of candidates (n1, K) by their evidence without facts."""
    share: Messages = np.exp(candidates.unary - candidates.unary.max(axis=1, keepdims=True))
    share /= share.sum(axis=1, keepdims=True)
    return share


def _of_things_in_cells(
    candidates: _Candidates, cells: _Cells, share: Messages, likelihoods: NDArray[np.float64]
) -> Messages:
    """Return the probabilities of cells (n1, K) as those of all things and of absence, (n1, n2 + 1).

    The things of a cell share its probability in proportion to their likelihoods (n1, n2), in the order of the cells.
    """
    n1, count = len(share), len(cells.sizes)
    of_cells = np.zeros((n1, count + 1))
    np.add.at(of_cells, (np.arange(n1)[:, None], candidates.cells), np.where(candidates.unary > RULED_OUT, share, 0.0))
    sums = np.maximum(np.add.reduceat(likelihoods, cells.start[:-1], axis=1), 1e-300)
    found = np.zeros((n1, len(cells.order) + 1), np.float32)
    found[:, cells.order] = likelihoods * np.repeat(of_cells[:, :-1] / sums, cells.sizes, axis=1)
    found[:, -1] = np.maximum(of_cells[:, -1], 1e-30)
    found /= found.sum(axis=1, keepdims=True)
    return found


def _order_of_things(problem: Compiled, seed: int) -> NDArray[np.int64]:
    """Return an order of the things (n2,) in which those with similar rows of the tables are near each other.

    The rows of all tables are projected at random (Johnson and Lindenstrauss 1984), then on their principal components.
    The things are divided in two halves along the component with the largest variance, and so is each half.
    """
    n2, tables = problem.unary.shape[1] - 1, len(problem.tables)
    used = np.sqrt(np.bincount(problem.kind % max(tables // 2, 1), minlength=max(tables // 2, 1)))
    random = np.random.default_rng(seed).normal(size=(n2, PROJECTIONS)).astype(np.float32)
    profiles = (
        np.zeros((n2, 1))
        if not tables
        else np.concatenate(
            [problem.tables[kind, :n2, :n2] @ random * used[kind % len(used)] for kind in range(tables)], axis=1
        ).astype(np.float64)
    )
    profiles -= profiles.mean(axis=0)
    _, axes = np.linalg.eigh(profiles.T @ profiles)
    positions = profiles @ axes[:, -COMPONENTS:]
    order, waiting = np.arange(n2), [(0, n2)]
    while waiting:
        first, end = waiting.pop()
        if end - first > 1:
            part, middle = order[first:end], (first + end) // 2
            there = positions[part]
            order[first:end] = part[np.argsort(there[:, there.var(axis=0).argmax()], kind="stable")]
            waiting += [(first, middle), (middle, end)]
    return order


def _require_time(deadline: Deadline) -> None:
    if deadline.passed:
        raise OutOfTimeError("time limit reached before belief propagation came to single things")


def _weights(
    likelihoods: NDArray[np.float32], cells: _Cells, power: float, deadline: Deadline = Deadline.never()
) -> NDArray[np.float32]:
    """Return the powers of mean likelihoods of pairs of cells, (2k, cells, cells): each table, then each transposed.

    Raise OutOfTimeError past the deadline.
    """
    kinds, count, sizes = len(likelihoods), len(cells.sizes), cells.sizes
    weights = np.empty((2 * kinds, count, count), np.float32)
    pairs = np.maximum(np.outer(sizes, sizes) - np.diag(sizes), 1).astype(np.float32)
    for kind, table in enumerate(likelihoods):
        _require_time(deadline)
        sums = np.add.reduceat(np.add.reduceat(table, cells.start[:-1], axis=0), cells.start[:-1], axis=1)
        weights[kind] = (sums / pairs) ** np.float32(power)
        weights[kinds + kind] = weights[kind].T
    return weights


def _candidates(
    known: tuple[NDArray[np.float64], NDArray[np.float64]],
    absent: NDArray[np.float64],
    cells: _Cells,
    chosen: NDArray[np.int64],
    power: float,
) -> _Candidates:
    """Return the chosen cells (n1, K), -1 for none, as candidates with their evidence, and absence as the last one."""
    likelihoods, largest = known
    count, is_none = len(cells.sizes), chosen < 0
    sums = np.add.reduceat(likelihoods, cells.start[:-1], axis=1) / cells.sizes
    means = np.take_along_axis(sums, np.where(is_none, 0, chosen), axis=1)
    sizes = cells.sizes[np.where(is_none, 0, chosen)].astype(np.float64)
    with np.errstate(divide="ignore"):
        unary = power * (np.log(means) + largest[:, None]) + np.log(sizes)
    unary = np.where(is_none, RULED_OUT, np.maximum(unary, RULED_OUT))
    n1 = len(chosen)
    return _Candidates(
        np.column_stack([np.where(is_none, 0, chosen), np.full(n1, count)]).astype(np.int32),
        np.column_stack([unary, absent]).astype(np.float32),
        np.column_stack([sizes, np.ones(n1)]),
    )


def _update_demand(demand: Messages, incoming: Messages, candidates: _Candidates, count: int) -> None:
    """Update in place the log messages of things to objects (n1, K): that no other object is this thing.

    As in dense belief propagation, for one thing of each cell: the odds of a cell are shared evenly by its things.
    """
    belief = incoming + demand
    belief -= belief.max(axis=1, keepdims=True)
    share = np.exp(belief) / candidates.sizes
    total = (share * candidates.sizes).sum(axis=1, keepdims=True)
    odds = np.exp(np.minimum(belief - demand, 60.0)) / candidates.sizes / np.maximum(total - share, 1e-20)
    capped = np.where(candidates.unary[:, :-1] > RULED_OUT, np.minimum(odds[:, :-1], 1e8), 0.0)
    here = candidates.cells[:, :-1]
    sums = np.bincount(here.ravel(), capped.ravel(), minlength=count)[here]
    demand *= np.float32(DAMPING)
    demand[:, :-1] -= ((1.0 - DAMPING) * np.log1p(np.maximum(sums - capped, 0.0))).astype(np.float32)


def _cavities(belief: Messages, facts: Messages, slots: _Slots) -> Messages:
    """Return the messages (2m, K) about the other object of each slot, by all evidence but the slot's fact."""
    cavity = belief[slots.other] - facts[slots.twin]
    cavity -= cavity.max(axis=1, keepdims=True)
    np.exp(cavity, out=cavity)
    cavity[cavity < NEGLIGIBLE] = 0.0
    cavity /= cavity.sum(axis=1, keepdims=True)
    return cavity


def _sent(
    facts: Messages,
    belief: Messages,
    absent: Messages,
    cells: NDArray[np.int32],
    weights: NDArray[np.float32],
    slots: _Slots,
    pool: ThreadPoolExecutor,
) -> Messages:
    """Return the next log messages (2m, K) of each fact to the object of each slot, computed in threads."""
    sent, count = np.empty_like(facts), len(facts)
    parts = max(1, 4 * (os.cpu_count() or 1))
    ends = [count * part // parts for part in range(parts + 1)]

    def send(part: int) -> None:
        send_messages(sent, facts, belief, absent, cells, weights, slots, ends[part], ends[part + 1])

    list(pool.map(send, range(parts)))
    return sent


@njit(cache=True, nogil=True)
def send_messages(sent, facts, belief, absent, cells, weights, slots, first, end):  # type: ignore[no-untyped-def]
    """Compute the next messages of some facts to the object of each slot.

    Parameters
    ----------
    sent
        Array to fill with the log messages about the candidates, shape (2m, K).
    facts
        The present log messages, shape (2m, K).
    belief
        Log beliefs of the objects, shape (n1, K), 0 for the likeliest candidate.
    absent
        Likelihood of the slot's fact if the slot's object is absent, by the other's candidate, shape (2m, K).
    cells
        Candidates of each object, shape (n1, K); the last one is absence.
    weights
        Likelihoods of pairs of cells, shape (2k, cells, cells).
    slots
        The slots of the problem.
    first, end
        The part of ``slots.order`` to compute.
    """
    last, kinds = facts.shape[1] - 1, len(weights) // 2
    message, result = np.empty(last + 1, np.float32), np.empty(last + 1, np.float32)
    senders, receivers, here = np.empty(last, np.int64), np.empty(last, np.int64), np.empty(last, np.int64)
    for at in range(first, end):
        s = slots.order[at]
        i, j, t, kind = slots.owner[s], slots.other[s], slots.twin[s], slots.kind[s]
        n_senders, n_receivers = 0, 0
        message[last] = belief[j, last] - facts[t, last]
        top = message[last]
        for b in range(last):
            if belief[j, b] >= UNCHANGED:
                senders[n_senders] = b
                n_senders += 1
                message[b] = belief[j, b] - facts[t, b]
                top = max(top, message[b])
        message[last] = np.exp(message[last] - top)
        for a in range(last):
            if belief[i, a] >= UNCHANGED:
                receivers[n_receivers], here[n_receivers] = a, cells[i, a]
                result[n_receivers] = message[last] * absent[t, a]
                n_receivers += 1
        from_absence = message[last] * absent[s, last]
        turned = weights[kind - kinds if kind >= kinds else kind + kinds]  # rows are the things of the other object
        for sender in range(n_senders):
            b = senders[sender]
            weight = np.exp(message[b] - top)
            from_absence += weight * absent[s, b]
            if weight >= NEGLIGIBLE:
                row = turned[cells[j, b]]
                for a in range(n_receivers):
                    result[a] += weight * row[here[a]]
        top = max(from_absence, np.float32(1e-30))
        for a in range(n_receivers):
            top = max(top, result[a])
        sent[s] = facts[s]
        for a in range(n_receivers):
            log_message = np.log(max(result[a] / top, np.float32(1e-30)))
            sent[s, receivers[a]] = DAMPING * facts[s, receivers[a]] + (1.0 - DAMPING) * log_message
        log_message = np.log(max(from_absence / top, np.float32(1e-30)))
        sent[s, last] = DAMPING * facts[s, last] + (1.0 - DAMPING) * log_message
