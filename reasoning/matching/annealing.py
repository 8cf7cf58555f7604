"""Annealing by whole blocks: objects without facts between them are matched anew, all at once; compiled.

Given the rest of the map, what an object gains by each thing does not depend on the other objects of such a block, so
that the best matches of the block are a linear assignment. With Gumbel noise on the gains, scaled by a temperature, its
solution is a random map that prefers the better ones (perturb and maximise, Papandreou and Yuille 2011); without noise
it is the best the block can do.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from deixis.reasoning.matching.branching import evaluate
from deixis.reasoning.matching.linear_assignment import solve_assignment

NOISE = 1 << 13  # Gumbel numbers drawn once and read from random places; a power of 2


@njit(cache=True)
def anneal(labels, best, problem, steps, temperature, block, noise, seed):  # type: ignore[no-untyped-def]
    """So many steps at one temperature; ``labels`` moves on, ``best`` (n1,) takes every map better than it.

    ``noise`` (NOISE,) holds Gumbel numbers.
    """
    np.random.seed(seed)
    value, best_value = evaluate(labels, problem), evaluate(best, problem)
    order = np.arange(len(labels))
    for _ in range(steps):
        value += rematch(_independent(order, problem, block), labels, problem, temperature, noise)
        if value > best_value + 1e-9:
            best_value = value
            best[:] = labels


@njit(cache=True)
def _independent(order, problem, block):  # type: ignore[no-untyped-def]
    """Up to ``block`` objects at random, no two of them in one fact; shuffles ``order``."""
    taken = np.zeros(len(order), np.bool_)
    chosen = np.empty(min(block, len(order)), np.int64)
    count = 0
    for a in range(len(order)):
        b = a + np.random.randint(len(order) - a)
        order[a], order[b] = order[b], order[a]
        i = order[a]
        if taken[i]:
            continue
        chosen[count] = i
        count += 1
        if count == len(chosen):
            break
        for slot in range(problem.first[i], problem.first[i + 1]):
            taken[problem.other[slot]] = True
    return chosen[:count]


@njit(cache=True)
def rematch(block, labels, problem, temperature, noise):  # type: ignore[no-untyped-def]
    """Matches a block anew to its own things and those that nobody has; returns what that gained."""
    out = problem.unary.shape[1] - 1
    free = np.ones(out + 1, np.bool_)
    free[labels] = False
    free[labels[block]] = True
    free[out] = True
    things = np.flatnonzero(free)
    gain = block_gains(block, things, labels, problem)
    noisy = gain.copy()
    if temperature > 0.0:
        for row in range(len(block)):
            at = np.random.randint(NOISE)
            for column in range(len(things)):
                noisy[row, column] += temperature * noise[(at + column) & (NOISE - 1)]
    found = np.empty(len(block), np.int64)
    price, profit = np.empty(len(things) - 1), np.empty(len(block))
    solve_assignment(noisy, found, price, profit)
    gained = 0.0
    for row in range(len(block)):
        before = np.searchsorted(things, labels[block[row]])
        gained += gain[row, found[row]] - gain[row, before]
    labels[block] = things[found]
    return gained


@njit(cache=True)
def block_gains(block, things, labels, problem):  # type: ignore[no-untyped-def]
    """What each object of a block is worth as each thing, with the others as they are: (block, things)."""
    gain = np.empty((len(block), len(things)))
    for row in range(len(block)):
        i = block[row]
        for column in range(len(things)):
            gain[row, column] = problem.unary[i, things[column]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            j, twin = problem.other[slot], problem.twin[slot]
            said = problem.tables[problem.kind[twin], labels[j]]
            for column in range(len(things)):
                gain[row, column] += said[things[column]]
    return gain


@njit(cache=True)
def climb(labels, problem):  # type: ignore[no-untyped-def]
    """Moves and swaps of one object after another, each the best there is, until none helps."""
    out = problem.unary.shape[1] - 1
    holder = np.full(out + 1, -1)
    for i in range(len(labels)):
        holder[labels[i]] = i
    holder[out] = -1
    everything, one = np.arange(out + 1), np.empty(1, np.int64)
    better = True
    while better:
        better = False
        for i in range(len(labels)):
            one[0] = i
            gain = block_gains(one, everything, labels, problem)[0]
            best, chosen = 1e-9, -1
            for p in range(out + 1):
                if p != labels[i] and gain[p] > -np.inf:
                    gained = _exchange_gain(i, p, holder[p], gain, labels, problem)
                    if gained > best:
                        best, chosen = gained, p
            if chosen >= 0:
                better = True
                _exchange(i, chosen, labels, holder, out)


@njit(cache=True)
def _exchange_gain(i, p, j, gain, labels, problem):  # type: ignore[no-untyped-def]
    """What it gains to give object i thing p, and i's thing to j, who had p (or had nobody, -1)."""
    old = labels[i]
    gained = gain[p] - gain[old]
    if j < 0:
        return gained
    gained += problem.unary[j, old] - problem.unary[j, p]
    for slot in range(problem.first[j], problem.first[j + 1]):
        table, k = problem.tables[problem.kind[slot]], problem.other[slot]
        if k == i:  # counted at i's end with j still at p
            gained += np.float64(table[old, p]) - np.float64(table[p, p])
        else:
            gained += np.float64(table[old, labels[k]]) - np.float64(table[p, labels[k]])
    return gained


@njit(cache=True)
def _exchange(i, p, labels, holder, out):  # type: ignore[no-untyped-def]
    old, j = labels[i], holder[p]
    labels[i] = p
    if p < out:
        holder[p] = i
    if j >= 0:
        labels[j] = old
    if old < out:
        holder[old] = j
