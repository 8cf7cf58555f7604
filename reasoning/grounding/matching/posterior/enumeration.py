"""Sum of the weights of maps by depth-first search over partial maps, with a bound on the missing mass; compiled.

Messages (as in ``branch_and_bound.py``) first move evidence of each fact to its two ends, so that the remaining entries
of its table are at most 0. The sum over all maps below a partial map is then at most the product, over the remaining
objects, of the sums over their candidates. Where that is below a threshold, the search turns back and adds the bound to
the missing mass.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.branch_and_bound import new_stack, node_at, tighten
from deixis.reasoning.kernel import njit

PASSES = 30  # of messages
LOWEST_VALUE = -1e12  # lower bound of the value of every map, so that no match is dropped


class Factors(NamedTuple):
    """Posterior as a product of odds for every match and a factor of at most 1 for every fact's pair."""

    weights: NDArray[np.float64]  # (n1, n2 + 1)
    idle: NDArray[np.float64]  # (n2 + 1,): factor of at most 1 for every unmatched thing
    facts: NDArray[np.float64]  # (2m, n2 + 1, n2 + 1): at each slot, with the things of its object as rows
    log_scale: float  # logarithm of the common factor of all products


def factors(problem: Compiled) -> Factors:
    """Return the posterior of a problem as factors, after moving evidence by messages.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.

    Returns
    -------
    Factors
        Factors of matches, of unmatched things and of facts, with the logarithm of their common factor.
    """
    stack, column_of = new_stack(problem, 1.0), np.empty(len(problem.unary), dtype=np.int64)
    node = node_at.interpretation(0, stack)
    tighten(node, problem, LOWEST_VALUE, np.inf, PASSES, 10**18, column_of)
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
    """Sum the weights of maps, visiting at most ``nodes`` partial maps with a bound above ``threshold``.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    parts
        Its posterior as factors.
    threshold
        Bound on the sum below a partial map, at or below which the search turns back.
    nodes
        Maximum number of partial maps to visit.

    Returns
    -------
    tuple
        Sums by match, shape (n1, n2 + 1), and an array of shape (3,): the total sum, a bound on the missing mass
        (infinite where the nodes did not suffice), and the number of nodes.
    """
    marginals, counts = np.zeros_like(parts.weights), np.zeros(3)
    _search(parts.weights, parts.idle, parts.facts, problem.first, problem.other, threshold, nodes, marginals, counts)
    return marginals, counts


# The arrays of the search are local to it, and handed to what it calls one by one: as fields of a tuple, each use of
# one would count references to it, which took most of the time.


@njit(cache=True)
def _search(root, idle, facts, first, other, threshold, nodes, marginals, counts):  # type: ignore[no-untyped-def]
    n1, width = root.shape
    weights = np.zeros((n1 + 1, n1, width))  # by depth: odds of each thing against the object's best; 0 where taken
    sums, most = np.ones((n1 + 1, n1)), np.ones((n1 + 1, n1))  # of the weights, of objects that are left; 1 of others
    chosen, position = np.zeros(n1 + 1, np.int64), np.zeros(n1 + 1, np.int64)  # who is branched on, its next thing
    prefix, rest = np.ones(n1 + 1), np.ones(n1 + 1)  # of the partial map; product of the other objects' sums
    below = np.zeros(n1 + 1)  # what was found below the node so far
    labels, used = np.full(n1, -1), np.zeros(width, np.bool_)  # -1 for what is left
    weights[0] = root
    for i in range(n1):
        sums[0, i], most[0, i] = root[i].sum(), root[i].max()
    _open(0, labels, sums, most, chosen, rest)
    depth = 0
    while depth >= 0:
        i, p = chosen[depth], position[depth]
        if p == width:
            depth -= 1
            if depth >= 0:  # what was found goes to the match and to the node; the match is taken back
                i = chosen[depth]
                marginals[i, labels[i]] += below[depth + 1]
                below[depth] += below[depth + 1]
                used[labels[i]], labels[i] = False, -1
            continue
        position[depth] += 1
        weight = prefix[depth] * weights[depth, i, p]
        bound = weight * rest[depth]
        if bound > threshold:  # which is loose, and costs little
            counts[2] += 1
            if counts[2] > nodes:
                counts[1] = np.inf
                return
            if depth + 1 == n1:
                found = weight * _idle(p, used, idle)
                marginals[i, p] += found
                below[depth] += found
                continue
            labels[i] = p
            _assign(depth, i, p, labels, weights, sums, most, facts, first, other)
            bound = weight * _product(sums[depth + 1], -1)
        if bound <= threshold:
            counts[1] += bound
            labels[i] = -1
            continue
        used[p] = True
        depth += 1
        _open(depth, labels, sums, most, chosen, rest)
        prefix[depth], position[depth], below[depth] = weight, 0, 0.0
    counts[0] = below[0]


@njit(cache=True)
def _idle(last, used, idle):  # type: ignore[no-untyped-def]
    """Return the product of the factors of unmatched things, if the last object is the thing ``last``."""
    product = 1.0
    for p in range(len(idle)):
        if not used[p] and p != last:
            product *= idle[p]
    return product


@njit(cache=True)
def _open(depth, labels, sums, most, chosen, rest):  # type: ignore[no-untyped-def]
    """Choose the object to branch on: that with the fewest effective candidates, the sum over the largest weight."""
    fewest = np.inf
    for i in range(len(labels)):
        if labels[i] < 0:
            few = sums[depth, i] / max(most[depth, i], 1e-300)
            if few < fewest:
                chosen[depth], fewest = i, few
    rest[depth] = _product(sums[depth], chosen[depth])


@njit(cache=True)
def _product(sums, but):  # type: ignore[no-untyped-def]
    """Return the product of the sums of all remaining objects except ``but``."""
    product = 1.0
    for i in range(len(sums)):
        if i != but:
            product *= sums[i]
    return product


@njit(cache=True)
def _assign(depth, i, p, labels, weights, sums, most, facts, first, other):  # type: ignore[no-untyped-def]
    """Fill in the child node in which object i is thing p: exclude p for other objects, and apply i's facts."""
    n1, width = weights.shape[1], weights.shape[2]
    for j in range(n1):
        if labels[j] < 0:
            for q in range(width):
                weights[depth + 1, j, q] = weights[depth, j, q]
            if p < width - 1:
                weights[depth + 1, j, p] = 0.0
    for slot in range(first[i], first[i + 1]):
        j = other[slot]
        if labels[j] < 0:
            for q in range(width):
                weights[depth + 1, j, q] *= facts[slot, p, q]
    for j in range(n1):
        total, greatest = 1.0, 1.0
        if labels[j] < 0:
            total, greatest = 0.0, 0.0
            for q in range(width):
                total += weights[depth + 1, j, q]
                greatest = max(greatest, weights[depth + 1, j, q])
        sums[depth + 1, j], most[depth + 1, j] = total, greatest
