"""Random maps by their probability: a Markov chain that exchanges things between objects; compiled."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def sample(labels, counts, problem, proposals, seed):  # type: ignore[no-untyped-def]
    """Moves ``labels`` on by so many Metropolis steps, counting after each what one object is (n1, n2 + 1).

    A step proposes a thing, or being left out, for an object; whoever had the thing gets what the object had. Its
    reverse is proposed as often, so that the chain's limit is the posterior. Each object's count goes up by what it is
    for as many steps as it was that, so that the counts of all objects have one sum.
    """
    np.random.seed(seed)
    n1, out = len(labels), counts.shape[1] - 1
    holder = np.full(out + 1, -1)
    for i in range(n1):
        holder[labels[i]] = i
    holder[out] = -1
    since = np.zeros(n1, np.int64)
    for step in range(1, proposals + 1):
        i, p = np.random.randint(n1), np.random.randint(out + 1)
        old, j = labels[i], holder[p]
        if p == old:
            continue
        before = _both(i, j, labels, problem)
        labels[i] = p
        if j >= 0:
            labels[j] = old
        if np.random.random() >= np.exp(min(0.0, _both(i, j, labels, problem) - before)):
            labels[i] = old
            if j >= 0:
                labels[j] = p
            continue
        counts[i, old] += step - since[i]
        since[i] = step
        if p < out:
            holder[p] = i
        if old < out:
            holder[old] = j
        if j >= 0:
            counts[j, p] += step - since[j]
            since[j] = step
    for i in range(n1):
        counts[i, labels[i]] += proposals - since[i]


@njit(cache=True)
def _share(i, labels, problem):  # type: ignore[no-untyped-def]
    """What object i's match contributes, with the others as they are."""
    total = problem.unary[i, labels[i]]
    for slot in range(problem.first[i], problem.first[i + 1]):
        total += problem.tables[problem.kind[slot], labels[i], labels[problem.other[slot]]]
    return total


@njit(cache=True)
def _both(i, j, labels, problem):  # type: ignore[no-untyped-def]
    """What the matches of two objects contribute, or of i alone where j is -1; facts between the two count once."""
    total = _share(i, labels, problem)
    if j < 0:
        return total
    total += _share(j, labels, problem)
    for slot in range(problem.first[i], problem.first[i + 1]):
        if problem.other[slot] == j:
            total -= problem.tables[problem.kind[slot], labels[i], labels[j]]
    return total
