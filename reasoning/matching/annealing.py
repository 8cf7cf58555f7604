"""Annealing by heat baths: one object after another gets a thing by chance, the better ones more often; compiled.

For an object, all exchanges are looked at: each thing, or none, and to whoever has it what the object had. One is drawn
with a probability that grows exponentially with what it gains over the temperature, as the largest of the gains with
Gumbel noise on them (perturb and maximise, Papandreou and Yuille 2011).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from deixis.reasoning.matching.kept_gains import exchange, refresh

NOISE = 1 << 13  # Gumbel numbers in a table, read from random places on
BETTER = 1e-4  # what a map has to be better by: more than the error of gains in single precision


@njit(cache=True, nogil=True)
def anneal(state, best, ahead, problem, sweeps, temperature, noise, seed):  # type: ignore[no-untyped-def]
    """So many sweeps over all objects, from a map that is worth ``ahead`` more than ``best`` (n1,).

    ``best`` takes every map that is better. Returns by how much the last map is. ``noise`` (NOISE + n2 + 1,) holds
    Gumbel numbers in single precision.
    """
    np.random.seed(seed)
    refresh(state, problem)
    order, facts = np.arange(len(state.labels)), np.zeros(len(state.holder), np.float32)
    for _ in range(sweeps):
        for a in range(len(order)):
            b = a + np.random.randint(len(order) - a)
            order[a], order[b] = order[b], order[a]
            at = np.random.randint(NOISE)
            p, gained = _draw(order[a], state, problem, np.float32(temperature), noise, at, facts)
            if p != state.labels[order[a]]:
                exchange(order[a], p, state, problem)
                ahead += gained
                if ahead > BETTER:
                    ahead = 0.0
                    best[:] = state.labels
    return ahead


@njit(cache=True)
def _draw(i, state, problem, temperature, noise, at, facts):  # type: ignore[no-untyped-def]
    """A thing for object i, and what the exchange gains; ``facts`` (n2 + 1,) is all 0 before and after."""
    old, out = state.labels[i], len(state.holder) - 1
    for slot in range(problem.first[i], problem.first[i + 1]):
        q, kind = state.labels[problem.other[slot]], problem.kind[slot]
        if q < out:  # what kept_gains.said_twice adds up for one pair
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
