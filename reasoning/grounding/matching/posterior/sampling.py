"""Random maps by their probability: Markov chains at several temperatures that exchange maps; compiled.

A step proposes an exchange: an object gets another thing or absence, and the object that had the thing gets the old one
(Metropolis et al. 1953, Hastings 1970). Objects and things are drawn by a *guide*, fixed probabilities near the
marginals, so that few proposals are wasted on impossible matches. Hastings' ratio corrects for the guide, and a uniform
share of proposals reaches every map. Hot chains cross valleys that the cold chain would not, and pass their maps to it
(replica exchange; Geyer 1991, Hukushima and Nemoto 1996).

A chain at coldness b has the density exp(r + b (v - r)), where v is the value of a map and r the cost of the objects
that it leaves out: at b = 0 only that cost counts, at b = 1 it is the posterior. The mean of v - r over b from 0 to 1
is therefore the log-likelihood ratio of the evidence against chance (thermodynamic integration; Gelman and Meng 1998).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.kernel import njit

EVEN_SHARE = 0.05
"""Share of the proposals for an object that are drawn uniformly from its allowed things."""

FLATTENING = 0.5
"""Usual power of the beliefs by which the other proposals are drawn, so that chains can leave likely things."""

SETTLED_WEIGHT = 0.25
"""Frequency of proposals for an object with certain beliefs, relative to one with uninformative beliefs."""

START_DRAWS = 20
"""Number of things drawn for an object of a first map before it is left out, if all of them are taken."""


class Guide(NamedTuple):
    """Probabilities of proposals, with Walker's alias tables to draw objects and things in constant time."""

    weight: NDArray[np.float32]  # (n1, n2 + 1): probability of the object times that of the thing given the object
    keep: NDArray[np.float32]  # (n1, n2 + 1): probability of keeping a uniformly drawn thing, else its alias is used
    alias: NDArray[np.int32]  # (n1, n2 + 1)
    keep_object: NDArray[np.float32]  # (1, n1): as ``keep``, for objects
    alias_object: NDArray[np.int32]  # (1, n1)


class Chains(NamedTuple):
    """K chains of one ladder, each a map: the first is at the posterior's own coldness, the others are hotter."""

    labels: NDArray[np.int64]  # (K, n1)
    holder: NDArray[np.int64]  # (K, n2 + 1): object that has the thing, -1 for none; -1 for n2
    values: NDArray[np.float64]  # (K,): v - r
    coldness: NDArray[np.float64]  # (K,): falling from 1


def new_chains(problem: Compiled, coldness: NDArray[np.float64]) -> Chains:
    """Return chains at given coldnesses; :func:`begin` draws their maps.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    coldness
        Inverse temperature of each chain, shape (K,); 1 is that of the posterior.

    Returns
    -------
    Chains
        K chains without maps.
    """
    rungs, (n1, width) = len(coldness), problem.unary.shape
    labels, holder = np.zeros((rungs, n1), np.int64), np.full((rungs, width), -1, np.int64)
    return Chains(labels, holder, np.zeros(rungs), coldness)


def guide_by(beliefs: NDArray[np.floating], allowed: NDArray[np.bool_], power: float = FLATTENING) -> Guide:
    """Return the guide by beliefs; it never proposes a match that is not allowed.

    Parameters
    ----------
    beliefs
        Estimated probability of each match, shape (n1, n2 + 1).
    allowed
        Allowed matches, shape (n1, n2 + 1).
    power
        Power of the beliefs by which things are drawn; less than 1 so that chains can leave likely things.

    Returns
    -------
    Guide
        Distributions from which chains draw proposals in constant time.
    """
    chance = np.where(allowed, np.maximum(beliefs, 0.0).astype(np.float32) ** np.float32(power), np.float32(0.0))
    chance /= np.maximum(chance.sum(axis=1, keepdims=True), np.float32(1e-30))
    chance *= np.float32(1.0 - EVEN_SHARE)
    chance += np.float32(EVEN_SHARE) * allowed / allowed.sum(axis=1, keepdims=True).astype(np.float32)
    often = SETTLED_WEIGHT + (1 - SETTLED_WEIGHT) * (1.0 - beliefs.max(axis=1, initial=0.0))
    often = (often / often.sum()).astype(np.float32)
    keep, alias = _alias_tables(chance)
    keep_object, alias_object = _alias_tables(often[None, :])
    return Guide(often[:, None] * chance, keep, alias, keep_object, alias_object)


@njit(cache=True)
def _alias_tables(chance):  # type: ignore[no-untyped-def]
    """Build the tables of Walker's alias method (1977; Vose 1991) for each row of probabilities."""
    rows, width = chance.shape
    keep, alias = np.ones((rows, width), np.float32), np.empty((rows, width), np.int32)
    small, large, scaled = np.empty(width, np.int64), np.empty(width, np.int64), np.empty(width)
    for i in range(rows):
        n_small, n_large, row_sum = 0, 0, 0.0
        for p in range(width):
            row_sum += chance[i, p]
        for p in range(width):
            alias[i, p] = p
            scaled[p] = chance[i, p] * width / row_sum
            if scaled[p] < 1.0:
                small[n_small] = p
                n_small += 1
            else:
                large[n_large] = p
                n_large += 1
        while n_small > 0 and n_large > 0:
            n_small -= 1
            low, high = small[n_small], large[n_large - 1]
            keep[i, low], alias[i, low] = scaled[low], high
            scaled[high] -= 1.0 - scaled[low]
            if scaled[high] < 1.0:
                n_large -= 1
                small[n_small] = high
                n_small += 1
    return keep, alias


@njit(cache=True, nogil=True)
def begin(chains, problem, guide, seed):  # type: ignore[no-untyped-def]
    """Draw a map by the guide for every chain.

    Parameters
    ----------
    chains
        The chains, changed in place.
    problem
        The problem in the layout of compiled loops.
    guide
        Distributions of the proposals.
    seed
        Seed of the random numbers.
    """
    np.random.seed(seed)
    n1, width = guide.weight.shape
    for k in range(len(chains.coldness)):
        labels, holder = chains.labels[k], chains.holder[k]
        holder[:] = -1
        for i in np.random.permutation(n1):
            labels[i] = width - 1
            for _ in range(START_DRAWS):
                p = _drawn(i, guide.keep, guide.alias)
                if p < width - 1 and problem.allowed[i, p] and holder[p] < 0:
                    labels[i], holder[p] = p, i
                    break
        chains.values[k] = _value(labels, problem)


def map_value(labels: NDArray[np.int64], problem: Compiled) -> float:
    """Return the value of a map, including the facts about absent objects where these have places.

    Parameters
    ----------
    labels
        Thing of each object, shape (n1,), with n2 for objects that are left out.
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    float
        Value in nats.
    """
    out = problem.unary.shape[1] - 1
    return float(_value(labels, problem) + problem.unary[labels == out, out].sum())


@njit(cache=True)
def _drawn(row, keep, alias):  # type: ignore[no-untyped-def]
    p = np.random.randint(keep.shape[1])
    return p if np.random.random() < keep[row, p] else np.int64(alias[row, p])


@njit(cache=True)
def _value(labels, problem):  # type: ignore[no-untyped-def]
    """Return the value of a map minus the cost of the objects that it leaves out."""
    total, out = 0.0, problem.unary.shape[1] - 1
    for i in range(len(labels)):
        if labels[i] < out:
            total += problem.unary[i, labels[i]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            if problem.other[slot] > i:
                total += _of_fact(problem, slot, labels[i], labels[problem.other[slot]])
    return total


@njit(cache=True)
def _of_fact(problem, slot, p, q):  # type: ignore[no-untyped-def]
    """Return the evidence of a slot's fact if its object is p and the other one is q."""
    out = problem.unary.shape[1] - 1
    if len(problem.away) and p == out:
        return problem.away[slot, q]
    if len(problem.away) and q == out:
        return problem.away[problem.twin[slot], p]
    return problem.tables[problem.kind[slot], p, q]


@njit(cache=True, nogil=True)
def cool(chains, problem, guide, coldness, sweeps, seed):  # type: ignore[no-untyped-def]
    """Run all chains for a number of sweeps at other coldnesses (K,) than their own, while cooling.

    Parameters
    ----------
    chains
        The chains, changed in place.
    problem
        The problem in the layout of compiled loops.
    guide
        Distributions of the proposals.
    coldness
        Inverse temperature of each chain, shape (K,).
    sweeps
        Number of sweeps.
    seed
        Seed of the random numbers.
    """
    np.random.seed(seed)
    steps = sweeps * chains.labels.shape[1]
    for k in range(len(coldness)):
        chains.values[k] += _walk(chains.labels[k], chains.holder[k], problem, guide, coldness[k], steps)


@njit(cache=True, nogil=True)
def sample(chains, counts, sums, problem, guide, sweeps, seed):  # type: ignore[no-untyped-def]
    """Run every chain for a number of sweeps over all objects, with exchanges between temperatures after each.

    Parameters
    ----------
    chains
        The chains, changed in place.
    counts
        Array to which the things of the coldest chain are added after each sweep, shape (n1, n2 + 1).
    sums
        Array to which the values of all chains are added after each sweep, shape (K,).
    problem
        The problem in the layout of compiled loops.
    guide
        Distributions of the proposals.
    sweeps
        Number of sweeps.
    seed
        Seed of the random numbers.

    Returns
    -------
    int
        Number of exchanges made.
    """
    np.random.seed(seed)
    n1, rungs = chains.labels.shape[1], len(chains.coldness)
    made = 0
    for sweep in range(sweeps):
        for k in range(rungs):
            coldness = chains.coldness[k]
            chains.values[k] += _walk(chains.labels[k], chains.holder[k], problem, guide, coldness, n1)
        for k in range(sweep % 2, rungs - 1, 2):
            made += _swap(k, chains)
        for i in range(n1):
            counts[i, chains.labels[0, i]] += 1
        for k in range(rungs):
            sums[k] += chains.values[k]
    return made


@njit(cache=True)
def _swap(k, chains):  # type: ignore[no-untyped-def]
    """Exchange the maps at two neighbouring temperatures with the Metropolis probability; return whether done."""
    gained = (chains.coldness[k] - chains.coldness[k + 1]) * (chains.values[k + 1] - chains.values[k])
    if gained < 0.0 and np.random.random() >= np.exp(gained):
        return False
    for i in range(chains.labels.shape[1]):
        chains.labels[k, i], chains.labels[k + 1, i] = chains.labels[k + 1, i], chains.labels[k, i]
    for p in range(chains.holder.shape[1]):
        chains.holder[k, p], chains.holder[k + 1, p] = chains.holder[k + 1, p], chains.holder[k, p]
    chains.values[k], chains.values[k + 1] = chains.values[k + 1], chains.values[k]
    return True


@njit(cache=True)
def _walk(labels, holder, problem, guide, coldness, steps):  # type: ignore[no-untyped-def]
    """Make a number of proposals; return the total gain of v - r."""
    out, total = guide.weight.shape[1] - 1, 0.0
    for _ in range(steps):
        i = _drawn(0, guide.keep_object, guide.alias_object)
        p, old = _drawn(i, guide.keep, guide.alias), labels[i]
        if p == old or not problem.allowed[i, p]:
            continue
        j = holder[p]
        if j >= 0 and not problem.allowed[j, old]:
            continue
        gained, paid = _change(i, p, j, labels, problem)
        there, back = np.float64(guide.weight[i, p]), np.float64(guide.weight[i, old])
        if j >= 0 and old == out:  # only the other one's claim to its thing leads back
            back = np.float64(guide.weight[j, p])
        elif j >= 0:  # the other one proposes the same exchange, there and back
            there += guide.weight[j, old]
            back += guide.weight[j, p]
        if np.random.random() * there >= back * np.exp(min(coldness * gained + paid, 700.0)):
            continue
        total += gained
        labels[i] = p
        if j >= 0:
            labels[j] = old
        if p < out:
            holder[p] = i
        if old < out:
            holder[old] = j
    return total


@njit(cache=True)
def _change(i, p, j, labels, problem):  # type: ignore[no-untyped-def]
    """Return the changes of v - r and r if object i gets thing p, and j, which had p (-1: none), gets i's thing."""
    old, out = labels[i], problem.unary.shape[1] - 1
    tables, placed = problem.tables, len(problem.away) > 0
    gained, paid = 0.0, 0.0
    if p == out:
        paid += problem.unary[i, out]
    else:
        gained += problem.unary[i, p]
    if old == out:
        paid -= problem.unary[i, out]
    else:
        gained -= problem.unary[i, old]
    for slot in range(problem.first[i], problem.first[i + 1]):
        other = problem.other[slot]
        q = labels[other]
        if other == j:
            q, r = old, p  # the other object takes the place that this one leaves
        else:
            r = q
        if placed:
            gained += _of_fact(problem, slot, p, q) - _of_fact(problem, slot, old, r)
        else:
            gained += tables[problem.kind[slot], p, q] - tables[problem.kind[slot], old, r]
    if j < 0:
        return gained, paid
    if old == out:
        paid += problem.unary[j, out]
    else:
        gained += problem.unary[j, old]
    gained -= problem.unary[j, p]
    for slot in range(problem.first[j], problem.first[j + 1]):
        if problem.other[slot] != i:
            q = labels[problem.other[slot]]
            if placed:
                gained += _of_fact(problem, slot, old, q) - _of_fact(problem, slot, p, q)
            else:
                gained += tables[problem.kind[slot], old, q] - tables[problem.kind[slot], p, q]
    return gained, paid
