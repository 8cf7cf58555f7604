"""Random maps by their probability: Markov chains at several temperatures that exchange maps; compiled.

A step proposes an exchange: a thing, or being left out, for an object, and whoever had the thing gets what the object
had (Metropolis et al. 1953). Its reverse is proposed as often, so that the chain's limit is the posterior. Hot chains
cross valleys that the cold one would not, and hand it what they find (replica exchange; Geyer 1991, Hukushima and
Nemoto 1996).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.local_search import KeptMap, exchange, refresh, said_twice
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.kernel import njit

REFRESH = 64  # sweeps after which gains are computed anew


class Ladder(NamedTuple):
    """r chains, each a map with its gains, and who is at which temperature: the first is the posterior's own."""

    labels: NDArray[np.int64]  # (r, n1)
    holder: NDArray[np.int64]  # (r, n2 + 1)
    gains: NDArray[np.float32]  # (r, n1, n2 + 1)
    values: NDArray[np.float64]  # (r,): up to a constant
    at: NDArray[np.int64]  # (r,): the chain at each temperature
    coldness: NDArray[np.float64]  # (r,): 1 over the temperature, falling from 1


def ladder(labels: NDArray[np.int64], problem: Compiled, coldness: NDArray[np.float64]) -> Ladder:
    """As many chains as temperatures, all at one map (n1,)."""
    r, (n1, width) = len(coldness), problem.unary.shape
    return Ladder(
        np.tile(labels, (r, 1)),
        np.empty((r, width), dtype=np.int64),
        np.empty((r, n1, width), dtype=np.float32),
        np.zeros(r),
        np.arange(r),
        coldness,
    )


@njit(cache=True)
def sample(chains, counts, problem, sweeps, rounds, thresholds, most, seed):  # type: ignore[no-untyped-def]
    """So many sweeps, each of ``rounds`` over all objects in every chain, then exchanges between temperatures.

    After each, what every object is in the coldest chain is counted, (n1, n2 + 1). ``thresholds`` are logarithms of
    uniform random numbers, a power of 2 of them, read from random places on; ``most`` is what
    :func:`most_said_twice` gives. Returns the share of exchanges made.
    """
    np.random.seed(seed)
    made, tried = 0, 0
    for sweep in range(sweeps):
        for rung in range(len(chains.at)):
            r = chains.at[rung]
            state = KeptMap(chains.labels[r], chains.holder[r], chains.gains[r])
            if sweep % REFRESH == 0:
                refresh(state, problem)
            chains.values[r] += _walk(state, problem, chains.coldness[rung], rounds, thresholds, most)
        for rung in range(sweep % 2, len(chains.at) - 1, 2):
            tried += 1
            made += _swap(rung, chains)
        cold = chains.labels[chains.at[0]]
        for i in range(len(cold)):
            counts[i, cold[i]] += 1
    return made / max(tried, 1)


@njit(cache=True)
def _swap(rung, chains):  # type: ignore[no-untyped-def]
    """Exchanges the chains at two neighbouring temperatures, or not, as their maps' values say."""
    cold, hot = chains.at[rung], chains.at[rung + 1]
    gained = (chains.coldness[rung] - chains.coldness[rung + 1]) * (chains.values[hot] - chains.values[cold])
    if gained < 0.0 and np.random.random() >= np.exp(gained):
        return False
    chains.at[rung], chains.at[rung + 1] = hot, cold
    return True


@njit(cache=True)
def _walk(state, problem, coldness, rounds, thresholds, most):  # type: ignore[no-untyped-def]
    """So many proposals for each object; returns what the exchanges that were made gained.

    Objects come at random, not in turn: the way back from where one takes the thing of another and leaves it with none
    is a proposal for the other.
    """
    labels, holder, gains = state.labels, state.holder, state.gains
    n1, width = np.uint64(len(labels)), np.uint64(len(holder))
    total, at = 0.0, np.random.randint(len(thresholds))
    bits = np.uint64(np.random.randint(1, 1 << 62))
    for _ in range(rounds * len(labels)):
        bits = _shifted(bits)
        i = np.int64((((bits >> np.uint64(16)) & np.uint64(0xFFFFFF)) * n1) >> np.uint64(24))
        p = np.int64(((bits >> np.uint64(40)) * width) >> np.uint64(24))
        at = (at + 1) & (len(thresholds) - 1)
        old, j = labels[i], holder[p]
        if p == old:
            continue
        gained = gains[i, p] - gains[i, old]
        if j >= 0:
            gained += gains[j, old] - gains[j, p]
            if coldness * (gained + most) <= thresholds[at]:
                continue
            gained += said_twice(i, j, state, problem)
        if coldness * gained > thresholds[at]:
            exchange(i, p, state, problem)
            total += gained
    return total


@njit(cache=True)
def _shifted(bits):  # type: ignore[no-untyped-def]
    """The next 64 random bits (xorshift; Marsaglia 2003): several times as fast as the usual generator."""
    bits ^= bits << np.uint64(13)
    bits ^= bits >> np.uint64(7)
    bits ^= bits << np.uint64(17)
    return bits


def most_said_twice(problem: Compiled) -> float:
    """No facts between two objects make an exchange of their things worth more beyond the gains."""
    owner = np.repeat(np.arange(len(problem.unary)), np.diff(problem.first))
    pairs = np.unique(owner * len(problem.unary) + problem.other, return_counts=True)[1]
    return 2.0 * float(pairs.max(initial=0)) * max(0.0, float(problem.tables.max(initial=0.0))) + 1e-3
