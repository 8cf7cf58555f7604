"""A map with what every object would gain by every thing, kept up to date as objects exchange things; compiled.

Most exchanges that a search looks at are not made. With the gains kept, looking takes a few numbers, whatever the
facts; only an exchange that is made costs a row of a table for each fact of the two objects.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from deixis.reasoning.matching.compiled import Compiled


class KeptMap(NamedTuple):
    """A map and its gains, in single precision: :func:`refresh` now and then keeps the error of sums small."""

    labels: NDArray[np.int64]  # (n1,): n2 for what is left out
    holder: NDArray[np.int64]  # (n2 + 1,): who has the thing, -1 where nobody has; -1 for n2
    gains: NDArray[np.float32]  # (n1, n2 + 1): what object i is worth as thing p, the others as they are


def keep(labels: NDArray[np.int64], problem: Compiled) -> KeptMap:
    """A copy of a map (n1,), with its gains."""
    n1, width = problem.unary.shape
    state = KeptMap(labels.copy(), np.empty(width, dtype=np.int64), np.empty((n1, width), dtype=np.float32))
    refresh(state, problem)
    return state


@njit(cache=True, nogil=True)
def refresh(state, problem):  # type: ignore[no-untyped-def]
    """Computes all but the labels anew."""
    labels, gains, holder = state.labels, state.gains, state.holder
    holder[:] = -1
    for i in range(len(labels)):
        holder[labels[i]] = i
        gains[i] = problem.unary[i]
        for slot in range(problem.first[i], problem.first[i + 1]):
            gains[i] += problem.tables[problem.kind[problem.twin[slot]], labels[problem.other[slot]]]
    holder[-1] = -1


@njit(cache=True)
def said_twice(i, j, state, problem):  # type: ignore[no-untyped-def]
    """What an exchange of the things of two objects is worth beyond the two gains, for the facts between the two."""
    more, p, q = np.float32(0.0), state.labels[i], state.labels[j]
    for slot in range(problem.first[i], problem.first[i + 1]):
        if problem.other[slot] == j:
            kind = problem.kind[slot]
            more += problem.tables[kind, q, p] + problem.tables[kind, p, q]
    return more


@njit(cache=True)
def exchange(i, p, state, problem):  # type: ignore[no-untyped-def]
    """Gives object i thing p (n2: leaves it out), and whoever had it what i had."""
    old, j = state.labels[i], state.holder[p]
    out = len(state.holder) - 1
    _give(i, p, state, problem)
    if j >= 0:
        _give(j, old, state, problem)
    if p < out:
        state.holder[p] = i
    if old < out:
        state.holder[old] = j


@njit(cache=True)
def _give(i, p, state, problem):  # type: ignore[no-untyped-def]
    old = state.labels[i]
    for slot in range(problem.first[i], problem.first[i + 1]):
        j, kind = problem.other[slot], problem.kind[slot]
        for q in range(state.gains.shape[1]):
            state.gains[j, q] += problem.tables[kind, p, q] - problem.tables[kind, old, q]
    state.labels[i] = p
