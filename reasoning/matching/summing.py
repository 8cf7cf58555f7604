"""The probabilities of matches by adding up maps one by one, with a proof of how much is missing; compiled.

A depth-first search over partial maps. Each fact is first bounded by what its two ends say by themselves (the messages
of ``bounds.py``), so that what it then still says of a pair is at most 0. The sum over all maps below a partial one is
hence at most the product, over the objects that are left, of the sums over what each may still be. Where that is below
a threshold the search turns back, and counts the bound as missing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from deixis.reasoning.matching.bounds import tighten
from deixis.reasoning.matching.branching import new_stack, node_at
from deixis.reasoning.matching.compiled import Compiled

PASSES = 30  # of messages
NOTHING = -1e12  # a value that every map has: no match is dropped for being worth less


class Sum(NamedTuple):
    """The search's state by depth (n1 + 1), and what it found."""

    weights: NDArray[np.float64]  # (depth, n1, n2 + 1): odds of each thing against the object's best; 0 where taken
    sums: NDArray[np.float64]  # (depth, n1): of the weights, of objects that are left; 1 of others
    chosen: NDArray[np.int64]  # (depth,): the object that a node branches on
    position: NDArray[np.int64]  # (depth,): the next thing to try for it
    prefix: NDArray[np.float64]  # (depth,): the weight of the partial map
    below: NDArray[np.float64]  # (depth,): what was found below the node so far
    labels: NDArray[np.int64]  # (n1,): -1 for what is left
    marginals: NDArray[np.float64]  # (n1, n2 + 1): weights of the maps found, by match


class Factors(NamedTuple):
    """The posterior as a product: of an odds for every match, and of a number up to 1 for every fact's pair."""

    weights: NDArray[np.float64]  # (n1, n2 + 1)
    idle: NDArray[np.float64]  # (n2 + 1,): for every thing that nobody is, up to 1
    facts: NDArray[np.float64]  # (2m, n2 + 1, n2 + 1): at each slot, the owner's thing the row
    log_scale: float  # the logarithm of what all products are to be multiplied by


def factors(problem: Compiled) -> Factors:
    """The problem's messages, and what they leave."""
    stack, column_of = new_stack(problem, 1.0), np.empty(len(problem.unary), dtype=np.int64)
    node = node_at(0, stack)
    tighten(node, problem, NOTHING, np.inf, PASSES, 10**18, column_of)
    left = problem.tables[problem.kind] - node.messages[:, :, None] - node.messages[problem.twin][:, None, :]
    things = np.arange(left.shape[1] - 1)
    left[:, things, things] = -np.inf  # no two objects are one thing
    left = np.where(np.isnan(left) | (left == np.inf), -np.inf, left)
    above = np.maximum(left.max(axis=(1, 2), initial=-np.inf), 0.0)
    net = node.unary - node.price
    best = net.max(axis=1)
    scale = float(best.sum() + node.price.sum() + above.sum() / 2)
    return Factors(np.exp(net - best[:, None]), np.exp(-node.price), np.exp(left - above[:, None, None]), scale)


def add_up(
    problem: Compiled, parts: Factors, threshold: float, nodes: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Searches until ``nodes`` partial maps were looked at, turning back where less than ``threshold`` is below.

    Returns the weights of the maps found, by match (n1, n2 + 1), and (3,): the sum of them all, a bound on what is
    missing (inf where the nodes did not suffice), and the number of nodes.
    """
    n1, width = parts.weights.shape
    state = Sum(
        np.zeros((n1 + 1, n1, width)),
        np.ones((n1 + 1, n1)),
        np.zeros(n1 + 1, dtype=np.int64),
        np.zeros(n1 + 1, dtype=np.int64),
        np.ones(n1 + 1),
        np.zeros(n1 + 1),
        np.full(n1, -1),
        np.zeros((n1, width)),
    )
    state.weights[0] = parts.weights
    state.sums[0] = parts.weights.sum(axis=1)
    counts = np.zeros(3)
    _search(problem, parts, state, threshold, nodes, counts)
    return state.marginals, counts


@njit(cache=True)
def _search(problem, parts, state, threshold, nodes, counts):  # type: ignore[no-untyped-def]
    depth, n1, width = 0, len(state.labels), state.marginals.shape[1]
    state.chosen[0] = _next_object(0, state)
    while depth >= 0:
        if state.position[depth] == width:
            depth -= 1
            if depth >= 0:
                _add(depth, state.below[depth + 1], state)
            continue
        p = state.position[depth]
        state.position[depth] += 1
        below = _child(depth, p, problem, parts, state, threshold, counts)
        if counts[2] > nodes:
            counts[1] = np.inf
            return
        if below <= threshold:
            counts[1] += below
            state.labels[state.chosen[depth]] = -1
        elif depth + 1 == n1:
            _add(depth, state.prefix[depth + 1] * _idle(parts, state), state)
        else:
            depth += 1
            state.chosen[depth], state.position[depth], state.below[depth] = _next_object(depth, state), 0, 0.0
    counts[0] = state.below[0]


@njit(cache=True)
def _child(depth, p, problem, parts, state, threshold, counts):  # type: ignore[no-untyped-def]
    """A bound on the sum over the maps below a child, which is worked out only where a looser one does not do."""
    i = state.chosen[depth]
    weight = state.prefix[depth] * state.weights[depth, i, p]
    below = weight * _product(depth, i, state)
    if below <= threshold:
        return below
    counts[2] += 1
    _assign(depth, i, p, weight, problem, parts, state)
    return weight * _product(depth + 1, -1, state)


@njit(cache=True)
def _idle(parts, state):  # type: ignore[no-untyped-def]
    """The factor for the things that nobody is."""
    product, used = 1.0, np.zeros(len(parts.idle), np.bool_)
    used[state.labels] = True
    for p in range(len(parts.idle)):
        if not used[p]:
            product *= parts.idle[p]
    return product


@njit(cache=True)
def _add(depth, found, state):  # type: ignore[no-untyped-def]
    """What was found below a child, to its match and to the node; takes the match back."""
    i = state.chosen[depth]
    state.marginals[i, state.labels[i]] += found
    state.below[depth] += found
    state.labels[i] = -1


@njit(cache=True)
def _next_object(depth, state):  # type: ignore[no-untyped-def]
    """The object that is left with the fewest things in effect: the least sum over the largest weight."""
    chosen, fewest = -1, np.inf
    for i in range(len(state.labels)):
        if state.labels[i] < 0:
            most = 0.0
            for p in range(state.weights.shape[2]):
                most = max(most, state.weights[depth, i, p])
            few = state.sums[depth, i] / max(most, 1e-300)
            if few < fewest:
                chosen, fewest = i, few
    return chosen


@njit(cache=True)
def _product(depth, but, state):  # type: ignore[no-untyped-def]
    """Of the sums of the objects that are left, but one."""
    product = 1.0
    for i in range(len(state.labels)):
        if i != but:
            product *= state.sums[depth, i]
    return product


@njit(cache=True)
def _assign(depth, i, p, weight, problem, parts, state):  # type: ignore[no-untyped-def]
    """The node one deeper, in which object i is p: others may not be p, and its facts weigh on their ends."""
    width = state.marginals.shape[1]
    state.labels[i] = p
    state.prefix[depth + 1] = weight
    before, after = state.weights[depth], state.weights[depth + 1]
    for j in range(len(state.labels)):
        if state.labels[j] < 0:
            after[j] = before[j]
            if p < width - 1:
                after[j, p] = 0.0
    for slot in range(problem.first[i], problem.first[i + 1]):
        j = problem.other[slot]
        if state.labels[j] < 0:
            after[j] *= parts.facts[slot, p]
    for j in range(len(state.labels)):
        state.sums[depth + 1, j] = after[j].sum() if state.labels[j] < 0 else 1.0
