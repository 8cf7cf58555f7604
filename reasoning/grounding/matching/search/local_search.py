"""Local search over maps: incremental gains, annealing, climbing, joint moves, reassignment, recombination; compiled.

Most exchanges that a search evaluates are not made. With cached gains, evaluating an exchange takes a few numbers,
whatever the number of facts; only making one costs a row of a table for each fact of the two objects.

Annealing considers all exchanges of an object: it gets another thing or none, and the object that had the thing gets
the old one. One exchange is drawn with a probability proportional to the exponential of its gain over the temperature,
as the largest of the gains with Gumbel noise (perturb and maximise, Papandreou and Yuille 2011).

Reassignment takes objects that share no facts. Their gains do not depend on each other while all other objects stay, so
that the best way to distribute their things and the unmatched things is a linear assignment: the best of exponentially
many neighbours of a map (very large-scale neighbourhood search; Ahuja, Ergun, Orlin and Punnen 2002).

Recombination divides the objects in which two maps differ into parts with no fact and no thing in common. Each part can
be taken from either map independently, so that the best combination is found part by part (partition crossover;
Whitley, Hains and Howe 2009 for tours, Tinos, Whitley and Chicano 2015 for sums of terms).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.assignment import solve_assignment
from deixis.reasoning.kernel import njit


class KeptMap(NamedTuple):
    """A map and its gains in single precision; regular calls of :func:`refresh` keep the rounding error small."""

    labels: NDArray[np.int64]  # (n1,): n2 for objects that are left out
    holder: NDArray[np.int64]  # (n2 + 1,): object that has the thing, -1 for none; -1 for n2
    gains: NDArray[np.float32]  # (n1, n2 + 1): value of object i as thing p, the others as they are; -inf: not allowed


def keep(labels: NDArray[np.int64], problem: Compiled) -> KeptMap:
    """Return a copy of a map with its gains.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), with n2 for objects that are left out.
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    KeptMap
        State that :func:`exchange` and :func:`anneal` change in place.
    """
    n1, width = problem.unary.shape
    state = KeptMap(labels.copy(), np.empty(width, dtype=np.int64), np.empty((n1, width), dtype=np.float32))
    refresh(state, problem)
    return state


@njit(cache=True, nogil=True)
def refresh(state, problem):  # type: ignore[no-untyped-def]
    """Recompute holders and gains from the labels.

    Parameters
    ----------
    state
        The map, changed in place.
    problem
        The problem in the layout of compiled loops.
    """
    labels, gains, holder = state.labels, state.gains, state.holder
    holder[:] = -1
    for i in range(len(labels)):
        holder[labels[i]] = i
        for p in range(gains.shape[1]):
            gains[i, p] = problem.unary[i, p] if problem.allowed[i, p] else -np.inf
        for slot in range(problem.first[i], problem.first[i + 1]):
            gains[i] += problem.tables[problem.kind[problem.twin[slot]], labels[problem.other[slot]]]
    holder[-1] = -1


@njit(cache=True)
def exchange(i, p, state, problem):  # type: ignore[no-untyped-def]
    """Give object i thing p (n2: leave it out), and the object that had p the thing of i.

    Parameters
    ----------
    i
        The object.
    p
        The thing, or n2.
    state
        The map, changed in place.
    problem
        The problem in the layout of compiled loops.
    """
    old, j = state.labels[i], state.holder[p]
    out = len(state.holder) - 1
    _reassign(i, p, state, problem)
    if j >= 0:
        _reassign(j, old, state, problem)
    if p < out:
        state.holder[p] = i
    if old < out:
        state.holder[old] = j


@njit(cache=True)
def _reassign(i, p, state, problem):  # type: ignore[no-untyped-def]
    old = state.labels[i]
    for slot in range(problem.first[i], problem.first[i + 1]):
        j, kind = problem.other[slot], problem.kind[slot]
        for q in range(state.gains.shape[1]):
            state.gains[j, q] += problem.tables[kind, p, q] - problem.tables[kind, old, q]
    state.labels[i] = p


MIN_GAIN = 1e-6  # minimum improvement of a map
MAX_PAIRED_CELLS = 5_000_000  # pairs of things that :func:`move_pairs` tries, times the facts between the two objects


@njit(cache=True, nogil=True)
def move_pairs(labels, problem):  # type: ignore[no-untyped-def]
    """Apply the best joint move of two objects that share facts, until none improves the map; return the total gain.

    The two get things that no other object has, or none. Where facts hold only if both objects move, no single move
    leads from one map to the better one, and annealing seldom does if the facts are many. The search ends where it
    would try more than ``MAX_PAIRED_CELLS``.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), changed in place.
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    float
        Total gain in nats, at least 0.
    """
    n1, width = problem.unary.shape
    gain_i, gain_j, buffer = np.empty(width), np.empty(width), np.empty(width, np.int64)
    total, cells, better = 0.0, 0, True
    while better:
        better = False
        for i in range(n1):
            others = problem.other[problem.first[i] : problem.first[i + 1]]
            for j in np.unique(others[others > i]):
                things = buffer[: _free(labels, np.array([i, j]), buffer) + 1]
                between = problem.first[i] + np.flatnonzero(others == j)
                cells += len(things) ** 2 * len(between)
                if cells > MAX_PAIRED_CELLS:
                    return total
                gains_of(i, labels, problem, gain_i)
                gains_of(j, labels, problem, gain_j)
                old_i, old_j = labels[i], labels[j]
                best = gain_i[old_i] + gain_j[old_j]
                for slot in between:
                    table = problem.tables[problem.kind[slot]]
                    gain_i -= table[:, old_j]
                    gain_j -= table[old_i]
                    best -= table[old_i, old_j]
                now = best
                for p in things:
                    for q in things:
                        if (p != q or p == width - 1) and problem.allowed[i, p] and problem.allowed[j, q]:
                            value = gain_i[p] + gain_j[q]
                            for slot in between:
                                value += problem.tables[problem.kind[slot], p, q]
                            if value > best + MIN_GAIN:
                                best, labels[i], labels[j] = value, p, q
                if best > now:
                    total, better = total + best - now, True
    return total


@njit(cache=True)
def gains_of(i, labels, problem, gain):  # type: ignore[no-untyped-def]
    """Fill ``gain`` (n2 + 1,) with the value of object i as each thing, with the other objects unchanged.

    Parameters
    ----------
    i
        The object.
    labels
        Thing of each object, shape (n1,).
    problem
        The problem in the layout of compiled loops.
    gain
        Array to fill, shape (n2 + 1,); -inf for matches that are not allowed.
    """
    gain[:] = problem.unary[i]
    for slot in range(problem.first[i], problem.first[i + 1]):
        kind, q = problem.kind[problem.twin[slot]], labels[problem.other[slot]]
        for p in range(len(gain)):
            gain[p] += problem.tables[kind, q, p]


NOISE_TABLE_SIZE = 1 << 13  # Gumbel numbers in a table, read from random positions
MIN_GAIN_SINGLE = 1e-4  # minimum improvement of a map: above the error of gains in single precision


@njit(cache=True, nogil=True)
def anneal(state, best, ahead, problem, sweeps, temperatures, noise, seeds):  # type: ignore[no-untyped-def]
    """Anneal for a number of sweeps over all objects, from a map.

    Every better map is stored in ``best``.

    Parameters
    ----------
    state
        The map, changed in place.
    best
        Best map so far, shape (n1,), changed in place.
    ahead
        Value of the map minus that of ``best``, in nats.
    problem
        The problem in the layout of compiled loops.
    sweeps
        Number of sweeps at each temperature.
    temperatures
        Temperatures in nats, shape (levels,); 0 only accepts gains.
    noise
        Gumbel numbers in single precision, shape (NOISE_TABLE_SIZE + n2 + 1,).
    seeds
        Seed of the random numbers at each temperature, shape (levels,).

    Returns
    -------
    float
        Value of the last map minus that of ``best``, in nats.
    """
    for level in range(len(temperatures)):
        np.random.seed(seeds[level])
        refresh(state, problem)
        temperature = np.float32(temperatures[level])
        order, facts = np.arange(len(state.labels)), np.zeros(len(state.holder), np.float32)
        for _ in range(sweeps):
            for a in range(len(order)):
                b = a + np.random.randint(len(order) - a)
                order[a], order[b] = order[b], order[a]
                at = np.random.randint(NOISE_TABLE_SIZE)
                p, gained = _draw(order[a], state, problem, temperature, noise, at, facts)
                if p != state.labels[order[a]]:
                    exchange(order[a], p, state, problem)
                    ahead += gained
                    if ahead > MIN_GAIN_SINGLE:
                        ahead = 0.0
                        best[:] = state.labels
    return ahead


def climb(labels: NDArray[np.int64], problem: Compiled, deadline: Deadline = Deadline.never()) -> None:
    """Apply the best move or swap of one object after another, until no sweep over all objects improves the map.

    Improvements below ``MIN_GAIN_SINGLE`` do not count.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), changed in place.
    problem
        The problem in the layout of compiled loops.
    deadline
        End of the time limit; the map so far is left then.
    """
    state, ahead, sweep = keep(labels, problem), 0.0, 0
    cold, noise = np.zeros(1), np.zeros(NOISE_TABLE_SIZE + len(state.holder), np.float32)
    while not deadline.passed:
        before = labels.copy()
        ahead = anneal(state, labels, ahead, problem, 1, cold, noise, np.array([sweep]))
        if (labels == before).all():
            return
        sweep += 1


@njit(cache=True)
def _draw(i, state, problem, temperature, noise, at, facts):  # type: ignore[no-untyped-def]
    """Draw a thing for object i; return it and the gain. The buffer ``facts`` (n2 + 1,) is all 0 before and after."""
    old, out = state.labels[i], len(state.holder) - 1
    for slot in range(problem.first[i], problem.first[i + 1]):
        q, kind = state.labels[problem.other[slot]], problem.kind[slot]
        if q < out:  # a fact with the object that has q is in both gains, as if the other object stayed
            facts[q] += problem.tables[kind, q, old] + problem.tables[kind, old, q]
    holder, gains, own = state.holder, state.gains, state.gains[i]
    base = own[old]
    top, chosen, gained = temperature * noise[at + old], old, np.float32(0.0)
    for p in range(out + 1):
        gain, j = own[p] - base, holder[p]
        if j >= 0:
            gain += gains[j, old] - gains[j, p] + facts[p]
        score = gain + temperature * noise[at + p]
        if score > top:
            top, chosen, gained = score, p, gain
    for slot in range(problem.first[i], problem.first[i + 1]):
        facts[state.labels[problem.other[slot]]] = 0.0
    return chosen, gained


CELLS_PER_CLOCK_CHECK = 2e6
"""Number of gains that are computed between two looks at the clock."""


def reassign(
    labels: NDArray[np.int64], problem: Compiled, patience: int, seed: int, deadline: Deadline = Deadline.never()
) -> float:
    """Reassign random sets of objects until ``patience`` sets in a row do not help; return the total gain.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), changed in place.
    problem
        The problem in the layout of compiled loops.
    patience
        Number of sets without a gain after which to stop.
    seed
        Seed of the random numbers.
    deadline
        End of the time limit; the map so far is left then.

    Returns
    -------
    float
        Total gain in nats.
    """
    total, failed, sets = 0.0, 0, max(1, int(CELLS_PER_CLOCK_CHECK / max(1, problem.unary.size)))
    while failed < patience and not deadline.passed:
        gained, failed = _reassign_sets(labels, problem, patience, failed, sets, seed)
        total, seed = total + gained, seed + 1
    return total


@njit(cache=True, nogil=True)
def _reassign_sets(labels, problem, patience, failed, sets, seed):  # type: ignore[no-untyped-def]
    """Reassign at most ``sets`` sets; return the gain, and how many sets in a row have not helped."""
    np.random.seed(seed)
    n1, width = problem.unary.shape
    cells, row, things = np.empty(n1 * width), np.empty(width), np.empty(width, np.int64)
    column_of, profit, price = np.empty(n1, np.int64), np.empty(n1), np.empty(width)
    total = 0.0
    for _ in range(sets):
        if failed >= patience:
            break
        chosen = _without_facts_between(problem)
        n_free = _free(labels, chosen, things)
        gain = cells[: len(chosen) * (n_free + 1)].reshape(len(chosen), n_free + 1)
        before = 0.0
        for a in range(len(chosen)):
            gains_of(chosen[a], labels, problem, row)
            before += row[labels[chosen[a]]]
            for b in range(n_free + 1):
                gain[a, b] = row[things[b]] if problem.allowed[chosen[a], things[b]] else -np.inf
        columns = column_of[: len(chosen)]
        gained = solve_assignment(gain, columns, price[:n_free], profit[: len(chosen)]) - before
        failed += 1
        if gained > MIN_GAIN:
            labels[chosen] = things[columns]
            total, failed = total + gained, 0
    return total, failed


@njit(cache=True)
def _without_facts_between(problem):  # type: ignore[no-untyped-def]
    """Return a random maximal set of objects, no two of which share a fact."""
    n1 = len(problem.unary)
    order, taken = np.random.permutation(n1), np.zeros(n1, np.bool_)
    chosen, count = np.empty(n1, np.int64), 0
    for i in order:
        if not taken[i]:
            chosen[count] = i
            count += 1
            for slot in range(problem.first[i], problem.first[i + 1]):
                taken[problem.other[slot]] = True
    return chosen[:count]


@njit(cache=True)
def _free(labels, chosen, things):  # type: ignore[no-untyped-def]
    """List in ``things`` those that no other object has, and last the absence n2; return the number of things."""
    out = len(things) - 1
    held = np.zeros(out + 1, np.bool_)
    held[labels] = True
    held[labels[chosen]] = False
    count = 0
    for p in range(out):
        if not held[p]:
            things[count] = p
            count += 1
    things[count] = out
    return count


@njit(cache=True, nogil=True)
def combine(labels, other, problem):  # type: ignore[no-untyped-def]
    """Copy into ``labels`` (n1,) each part of the other map with a higher value; return the total gain.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), changed in place.
    other
        Another map, shape (n1,).
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    float
        Total gain in nats, at least 0.
    """
    part = _parts(labels, other, problem)
    gain = np.zeros(len(labels))
    for i in range(len(labels)):
        if labels[i] == other[i]:
            continue
        root = _root(part, i)
        gain[root] += problem.unary[i, other[i]] - problem.unary[i, labels[i]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            j, kind = problem.other[slot], problem.kind[slot]
            if j > i or labels[j] == other[j]:  # a fact within the part counts once
                new_value = np.float64(problem.tables[kind, other[i], other[j]])
                gain[root] += new_value - problem.tables[kind, labels[i], labels[j]]
    total = 0.0
    for i in range(len(labels)):
        if gain[_root(part, i)] > 1e-9:
            labels[i] = other[i]
            total += max(gain[i], 0.0)
    return total


@njit(cache=True)
def _parts(labels, other, problem):  # type: ignore[no-untyped-def]
    """Return a forest (n1,) whose trees join differing objects that share a fact or a thing."""
    part, out = np.arange(len(labels)), problem.unary.shape[1] - 1
    new_owner = np.full(out + 1, -1)
    for i in range(len(labels)):
        new_owner[other[i]] = i
    for i in range(len(labels)):
        if labels[i] == other[i]:
            continue
        if labels[i] < out and new_owner[labels[i]] >= 0:
            part[_root(part, i)] = _root(part, new_owner[labels[i]])
        for slot in range(problem.first[i], problem.first[i + 1]):
            j = problem.other[slot]
            if labels[j] != other[j]:
                part[_root(part, i)] = _root(part, j)
    return part


@njit(cache=True)
def _root(part, i):  # type: ignore[no-untyped-def]
    while part[i] != i:
        part[i] = part[part[i]]
        i = part[i]
    return i
