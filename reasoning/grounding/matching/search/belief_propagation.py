"""Belief propagation: messages between facts, objects and things, for a map by slow cooling or for marginals.

Every fact sends each of its two objects a message about each thing, given the other evidence for the other object.
Every thing sends the objects a message about its demand, because it can be only one of them. On a tree, such messages
converge to the exact marginals; on the graph of a long description, whose cycles have many facts, they come near. Under
slow cooling, they converge to one of the best maps ("cavity approach" to aligning graphs: Bradde et al. 2010, EPL 89,
37009; messages of one-to-one maps: Huang and Jebara 2009, arXiv:0908.1769).

All messages of facts with the same table are computed by one matrix product, so that the work is dense linear algebra.
"""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.assignment import assign_until

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

FIRST_COLDNESS, LAST_COLDNESS = 4.0, 20.0  # inverse temperatures, times the mean range of a table
LEVELS = 80  # steps of cooling, fewer where all of them would multiply more cells than MAX_CELLS
MAX_CELLS = 1.2e11
MIN_LEVELS = 12  # with fewer steps, a short annealing gives as good a map
CELLS_PER_SECOND = 3e10  # approximate multiplications per second and core
DAMPING = 0.3  # share of the old message that is kept
MIN_LOG_MESSAGE = -69.0  # minimum log message; products of messages stay within single precision
RULED_OUT = -1e4  # log-likelihood of a match that is not allowed, and of one thing for two objects
STEPS, SETTLED = 30, 1e-2  # without cooling: maximum number of steps, and change of beliefs at convergence
GROWING_STEPS, GROWING_SHARE, FIRST_POWER = 20, 0.6, 0.3
# rounds in which the evidence grows, fewer where they would take more than that share of the time; its power at first
PLACINGS = 5  # number of times that absent objects get places
CERTAINLY_PRESENT = -20.0  # log-odds of absence up to which an object is certainly present
TIE_NOISE = 1e-3  # amplitude of random numbers that break ties between equal things

Messages = NDArray[np.float32]


class _Wiring(NamedTuple):
    """Slots (see ``problem.py``) sorted by the table that they read."""

    slot: NDArray[np.int64]  # (2m,): the slot of the problem
    owner: NDArray[np.int64]  # (2m,): the object of the slot
    other: NDArray[np.int64]  # (2m,): the object at the other end
    twin: NDArray[np.int64]  # (2m,): the same fact's slot there
    runs: list[tuple[int, int, int]]  # table, first slot, end: all slots that read it
    adder: csr_matrix  # (n1, 2m): sums the messages of each object's slots


def propagate(
    problem: Compiled, scale: float, deadline: Deadline = Deadline.never(), *, effort: float = 1.0, seed: int = 0
) -> NDArray[np.int64] | None:
    """Find a map by cooled belief propagation; return None where ``deadline`` or ``effort`` leave too few steps.

    Where the time is short, cooling is faster.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    scale
        Unit of temperature in nats: the mean range of a fact's table (``scalable.mean_range``).
    deadline
        End of the time limit.
    effort
        Factor on the number of steps; 1 is the full search.
    seed
        Seed of the random numbers.

    Returns
    -------
    ndarray or None
        Thing of each object, shape (n1,), with n2 for objects that are left out; None without enough steps.
    """
    slots, width, now = len(problem.kind), problem.unary.shape[1], time.perf_counter()
    cells = 1.0 + slots * width**2
    levels = effort * min(LEVELS, MAX_CELLS / cells)
    if levels < MIN_LEVELS or deadline.slowness * MIN_LEVELS * cells > CELLS_PER_SECOND * deadline.left:
        return None
    wiring, costs = _wire(problem), _costs(problem)
    unary = np.where(problem.allowed, np.maximum(problem.unary, RULED_OUT), RULED_OUT).astype(np.float32)
    field = np.random.default_rng(seed).normal(0.0, TIE_NOISE, unary.shape).astype(np.float32)
    facts, demand, weights = np.zeros((slots, width), np.float32), np.zeros_like(unary), np.empty_like(costs)
    belief, done = field, 0.0
    while done < 1.0:
        coldness = FIRST_COLDNESS * (LAST_COLDNESS / FIRST_COLDNESS) ** done / scale
        np.exp(np.multiply(costs, np.float32(coldness), out=weights), out=weights)
        incoming = wiring.adder @ facts + np.float32(coldness) * unary + field
        _update_demand(demand, incoming)
        belief = _normalised(incoming + demand)
        _update_facts(facts, _cavity_messages(facts, belief, wiring), weights, wiring)
        before, now = now, time.perf_counter()
        left = deadline.left
        if left <= MIN_LEVELS * (now - before) * (1.0 - done):
            return None
        done += max(1.0 / levels, (now - before) / left)
    return _one_to_one(belief, problem, deadline)


def beliefs(problem: Compiled, deadline: Deadline = Deadline.never(), *, steps: int = STEPS) -> Messages:
    """Return the marginals of belief propagation without cooling, with an unknown error.

    They are exact where the facts form no cycle and objects do not compete for things. On a long description they are
    overconfident, and serve to guide sampling. The iteration also ends when no object's probabilities change by more
    than ``SETTLED`` in total.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    deadline
        End of the time limit.
    steps
        Maximum number of rounds of messages.

    Returns
    -------
    ndarray
        Probability of each match, shape (n1, n2 + 1); the last column is that of being left out.
    """
    return beliefs_with_places(problem, None, deadline, steps=steps)[0]


def beliefs_with_places(
    problem: Compiled,
    places: NDArray[np.float32] | None,
    deadline: Deadline = Deadline.never(),
    *,
    steps: int = STEPS,
) -> tuple[Messages, Compiled]:
    """Return the marginals of belief propagation, and the problem with a place for each object if it is absent.

    The evidence is weak in the first rounds, so that the whole scene is aligned before its parts are: otherwise, a part
    whose neighbourhoods repeat (a row of alike places) often settles one place beside its own. The places are chosen by
    the messages, several times while the evidence grows (:func:`located`).

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    places
        Likelihood ratios of the facts at g places, shape (2k, g, n2); see
        :class:`deixis.reasoning.grounding.matching.problem.Problem`. None where absent objects have no places.
    deadline
        End of the time limit. Where the time is short, the evidence grows faster.
    steps
        Maximum number of rounds of messages after the evidence has grown.

    Returns
    -------
    tuple
        Probability of each match, shape (n1, n2 + 1); the last column is that of absence. Then the problem with the
        evidence of absent objects.
    """
    wiring, costs, start = _wire(problem), _costs(problem), problem
    unary = np.where(problem.allowed, np.maximum(problem.unary, RULED_OUT), RULED_OUT).astype(np.float32)
    facts, demand = np.zeros((len(problem.kind), unary.shape[1]), np.float32), np.zeros_like(unary)
    before = found = np.zeros_like(unary)
    weights, away, placings = np.empty_like(costs), None, 0
    until = deadline.share(GROWING_SHARE)
    seconds, progress, full_power = until.left, 0.0, False
    for _ in range(GROWING_STEPS + steps):
        if not full_power:
            full_power = progress >= 1.0
            power = np.float32(FIRST_POWER + (1.0 - FIRST_POWER) * progress)
            np.exp(np.multiply(costs, power, out=weights), out=weights)
            evidence = unary.copy()
            evidence[:, :-1] *= power
        incoming = wiring.adder @ facts + evidence
        _update_demand(demand, incoming)
        belief = _normalised(incoming + demand)
        before, found = found, np.exp(belief)
        found /= found.sum(axis=1, keepdims=True)
        if deadline.passed or (full_power and np.abs(found - before).sum(axis=1).max(initial=0.0) <= SETTLED):
            break
        cavity = _cavity_messages(facts, belief, wiring)
        if places is not None and int(progress * PLACINGS) > placings:
            placings = int(progress * PLACINGS)
            problem = located(start, places, cavity, found, wiring)
            unary[:, -1] = evidence[:, -1] = problem.unary[:, -1]
        if places is not None and placings:
            away = _away_weights(problem, wiring, power)
        _update_facts(facts, cavity, weights, wiring, away)
        elapsed = 1.0 - until.left / seconds if 0.0 < seconds < math.inf else 0.0
        progress = min(1.0, max(progress + 1.0 / GROWING_STEPS, elapsed))
    return found, problem


def located(
    problem: Compiled,
    places: NDArray[np.float32],
    cavity: Messages,
    belief: Messages,
    wiring: _Wiring,
) -> Compiled:
    """Return the problem with a place for each object by messages, at which it is if it is absent.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops, with the prior odds of absence.
    places
        Likelihood ratios of the facts at g places, shape (2k, g, n2).
    cavity
        Messages to the facts about the other object of each slot, in the order of ``wiring``, shape (2m, n2 + 1).
    belief
        Probability of each match, shape (n1, n2 + 1).
    wiring
        Slots in the order of their tables.

    Returns
    -------
    Compiled
        Copy with values of absence and of the facts about absent objects.
    """
    chances = cavity / cavity.sum(axis=1, keepdims=True)
    likelihoods = np.empty((len(cavity), places.shape[1]), np.float32)
    for table, first, end in wiring.runs:
        np.matmul(chances[first:end, :-1], places[table].T, out=likelihoods[first:end])
    likelihoods += chances[:, -1:]
    log_likelihood = wiring.adder @ np.log(likelihoods, out=likelihoods)
    return placed_at(problem, places, log_likelihood, float(belief[:, -1].sum()))


def placed_at(
    problem: Compiled, places: NDArray[np.float32], log_likelihood: NDArray[np.float32], absent: float
) -> Compiled:
    """Return the problem with the most likely place of each object, at which it is if it is absent.

    An object that is absent is somewhere, and its facts are about that place. Each object gets the place with the
    largest product of its facts' likelihoods, given the messages about the others. Its absence gets the mean of that
    product over all places, relative to this place: the likelihood that the facts fit some place by chance is the mean
    over the places. The prior odds of absence are by the expected number of absent objects (empirical Bayes): the
    number of things that are not described grows with it.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops, with the prior odds of absence.
    places
        Likelihood ratios of the facts at g places, shape (2k, g, n2).
    log_likelihood
        Logarithm of the likelihood of each object's facts at each place, shape (n1, g).
    absent
        Expected number of absent objects.

    Returns
    -------
    Compiled
        Copy with values of absence and of the facts about absent objects.
    """
    n1, width = problem.unary.shape
    chosen = log_likelihood.argmax(axis=1)
    log_mean = np.log(np.exp(log_likelihood - log_likelihood.max(axis=1, keepdims=True)).mean(axis=1))
    owner = np.repeat(np.arange(n1), np.diff(problem.first))
    away = np.zeros((len(problem.kind), width), np.float32)
    for table in range(len(places)):
        here = problem.kind == table
        away[here, :-1] = np.log(places[table][chosen[owner[here]]])
    unary = problem.unary.copy()
    expected = min(absent, n1 / 2)
    gain = _log_odds_of_absence(expected, n1, width - 1) - _log_odds_of_absence(max(0, n1 - width + 1), n1, width - 1)
    unary[:, -1] += np.where(unary[:, -1] > CERTAINLY_PRESENT, max(0.0, gain) + log_mean, 0.0)
    return problem._replace(unary=unary, away=away)


def _log_odds_of_absence(absent: float, objects: int, things: int) -> float:
    """Return the log-odds of an object's absence, against being one given thing, if a number of objects are absent."""
    return math.log((absent + 0.5) / (objects - absent + 0.5) * (max(0.0, things - objects + absent) + 0.5))


def belief_seconds(problem: Compiled) -> float:
    """Estimate the seconds of a step of :func:`beliefs`, with the preparation.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    float
        Estimated time in seconds, by the number of messages and the size of the tables.
    """
    width = problem.unary.shape[1]
    return float((len(problem.kind) + 20 * len(problem.tables)) * width**2 / CELLS_PER_SECOND)


def _wire(problem: Compiled) -> _Wiring:
    from scipy.sparse import csr_matrix

    n1, slots = len(problem.unary), len(problem.kind)
    order = np.argsort(problem.kind, kind="stable")
    position = np.empty(slots, dtype=np.int64)
    position[order] = np.arange(slots)
    tables, first = np.unique(problem.kind[order], return_index=True)
    ends = np.append(first, slots)[1:]
    owner = np.repeat(np.arange(n1), np.diff(problem.first))[order]
    return _Wiring(
        order,
        owner,
        problem.other[order],
        position[problem.twin[order]],
        [(int(table), int(a), int(b)) for table, a, b in zip(tables, first, ends, strict=True)],
        csr_matrix((np.ones(slots, np.float32), (owner, np.arange(slots))), shape=(n1, slots)),
    )


def _costs(problem: Compiled) -> Messages:
    """Return each table minus its largest entry, (k, n2 + 1, n2 + 1), with one thing for two objects ruled out."""
    tables = problem.tables[: len(problem.tables) // 2]  # each comes again transposed
    costs: Messages = tables - tables.max(axis=(1, 2), keepdims=True)
    things = np.arange(tables.shape[1] - 1)
    costs[:, things, things] = RULED_OUT
    return costs


def _update_demand(demand: Messages, incoming: Messages) -> None:
    """Update in place the log messages of things to objects (n1, n2 + 1): that no other object is this thing.

    The message is 1 / (1 + s), where s is the sum of the odds that each other object is the thing, without the thing's
    own message. Leaving objects out is not exclusive.
    """
    belief = _normalised(incoming + demand)
    share = np.exp(belief)
    odds = np.exp(np.minimum(belief - demand, 60.0))
    odds /= np.maximum(share.sum(axis=1, keepdims=True) - share, 1e-20)
    capped = np.minimum(odds[:, :-1], 1e8).astype(np.float64)  # single precision would lose the others beside one
    message = np.log((1.0 + np.maximum(capped.sum(axis=0) - capped, 0.0)).astype(np.float32))
    demand *= np.float32(DAMPING)
    demand[:, :-1] -= np.float32(1.0 - DAMPING) * message


def _cavity_messages(facts: Messages, belief: Messages, wiring: _Wiring) -> Messages:
    """Return the messages (2m, n2 + 1) about the other object of each slot, by all evidence but the slot's fact."""
    cavity = belief[wiring.other]
    cavity -= facts[wiring.twin]
    np.exp(cavity, out=cavity)
    return cavity


def _away_weights(problem: Compiled, wiring: _Wiring, power: np.float32) -> Messages:
    """Return powers of the likelihoods of facts about absent objects, (2m, n2 + 1), in the scale of ``_costs``."""
    tables = problem.tables[: len(problem.tables) // 2]
    largest = tables.max(axis=(1, 2))[problem.kind[wiring.slot] % max(len(tables), 1)]
    weights = problem.away[wiring.slot]
    weights -= largest[:, None]
    weights *= power
    return np.exp(weights, out=weights)


def _update_facts(
    facts: Messages, cavity: Messages, weights: Messages, wiring: _Wiring, away: Messages | None = None
) -> None:
    """Update in place the log messages (2m, n2 + 1) of each fact to the object of each slot.

    ``cavity`` holds the messages about the other objects, ``away`` the likelihoods of facts about absent objects, where
    these have places; shape (2m, n2 + 1) each.
    """
    outgoing = np.empty_like(facts)
    for table, first, end in wiring.runs:
        matrix = weights[table].T if table < len(weights) else weights[table - len(weights)]
        if away is None:
            np.matmul(cavity[first:end], matrix, out=outgoing[first:end])
        else:
            np.matmul(cavity[first:end, :-1], matrix[:-1], out=outgoing[first:end])
    if away is not None:
        outgoing += cavity[:, -1:] * away[wiring.twin]
        outgoing[:, -1] = np.einsum("sq,sq->s", cavity, away)
    np.log(np.maximum(outgoing, math.exp(MIN_LOG_MESSAGE), out=outgoing), out=outgoing)
    outgoing = np.maximum(_normalised(outgoing), MIN_LOG_MESSAGE, out=outgoing)
    facts *= np.float32(DAMPING)
    outgoing *= np.float32(1.0 - DAMPING)
    facts += outgoing


def _normalised(messages: Messages) -> Messages:
    """Shift each row in place so that its largest logarithm is 0."""
    messages -= messages.max(axis=1, keepdims=True)
    return messages


def likeliest_map(beliefs: Messages, problem: Compiled, deadline: Deadline = Deadline.never()) -> NDArray[np.int64]:
    """Return the map with the largest product of probabilities.

    Parameters
    ----------
    beliefs
        Probability of each match, shape (n1, n2 + 1).
    problem
        The problem in the layout of compiled loops.
    deadline
        End of the time limit; objects whose likeliest thing another object has are left out after it.

    Returns
    -------
    ndarray
        Thing of each object, shape (n1,), with n2 for objects that are left out.
    """
    return _one_to_one(np.log(np.maximum(beliefs, np.float32(1e-12))), problem, deadline)


def _one_to_one(belief: Messages, problem: Compiled, deadline: Deadline) -> NDArray[np.int64]:
    """Return the map with the largest sum of log beliefs, as far as the time allows."""
    return assign_until(np.where(problem.allowed, belief.astype(np.float64), -np.inf), deadline)
