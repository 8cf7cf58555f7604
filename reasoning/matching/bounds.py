"""Upper bounds by dual ascent on the facts and on one-to-one-ness; compiled.

Every fact's table can hand part of what it says to the unary terms of its two ends (a *message*), without changing the
value of any map. For any messages the value is at most that of the best assignment by the unary terms alone, plus each
table's largest remaining entry. Messages are improved object by object, as in sequential reweighted message passing
(Kolmogorov 2015; for graph matching Swoboda et al. 2017): an object pulls in all that its facts can still say, then
hands them an equal share of it. Prices of the things, from the linear assignment, hold the one-to-one constraint in.
What a table has left is never above 0 then, so that the assignment's value by itself is the bound.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from deixis.reasoning.matching.linear_assignment import solve_assignment


@njit(cache=True)
def pull(i, problem, unary, messages, candidates, counts):  # type: ignore[no-untyped-def]
    """Takes into object i's unary terms the most that each of its facts can still say."""
    out = unary.shape[1] - 1
    for slot in range(problem.first[i], problem.first[i + 1]):
        j, twin = problem.other[slot], problem.twin[slot]
        table = problem.tables[problem.kind[slot]]
        for a in range(counts[i]):
            p = candidates[i, a]
            if unary[i, p] == -np.inf:
                continue
            most = -np.inf
            for b in range(counts[j]):
                q = candidates[j, b]
                most = max(most, table[p, q] - messages[twin, q] if q != p or p == out else -np.inf)
            unary[i, p] += most - messages[slot, p]
            if most > -np.inf:
                messages[slot, p] = most


@njit(cache=True)
def hand_out(i, share, problem, unary, messages, price, candidates, counts):  # type: ignore[no-untyped-def]
    """Hands each fact of object i a share of what its candidates lack against the best one; returns the best."""
    best = -np.inf
    for a in range(counts[i]):
        p = candidates[i, a]
        best = max(best, unary[i, p] - price[p])
    for slot in range(problem.first[i], problem.first[i + 1]):
        for a in range(counts[i]):
            p = candidates[i, a]
            messages[slot, p] -= share * (unary[i, p] - price[p] - best)
    degree = problem.first[i + 1] - problem.first[i]
    for a in range(counts[i]):
        p = candidates[i, a]
        unary[i, p] -= share * degree * (unary[i, p] - price[p] - best)
    return best


@njit(cache=True)
def drop_candidates(i, loss, unary, price, candidates, counts):  # type: ignore[no-untyped-def]
    """Rules out what lacks more than ``loss`` against object i's best candidate."""
    best = -np.inf
    for a in range(counts[i]):
        best = max(best, unary[i, candidates[i, a]] - price[candidates[i, a]])
    kept = 0
    for a in range(counts[i]):
        p = candidates[i, a]
        if unary[i, p] > -np.inf and best - (unary[i, p] - price[p]) <= loss:
            candidates[i, kept] = p
            kept += 1
        else:
            unary[i, p] = -np.inf
    dropped = counts[i] - kept
    counts[i] = kept
    return dropped


@njit(cache=True)
def one_pass(forward, node, problem, loss):  # type: ignore[no-untyped-def]
    """Every object once, in order or against it; false where that shows that the node is worth less than is sought.

    ``loss`` is the bound less what is sought: a candidate that lacks more against the best one is dropped.
    """
    n1 = len(node.counts)
    for step in range(n1):
        i = step if forward else n1 - 1 - step
        before = node.profit[i]
        pull(i, problem, node.unary, node.messages, node.candidates, node.counts)
        after = _best(i, node.unary, node.price, node.candidates, node.counts)
        loss += after - before
        if not loss >= 0.0:  # nothing is left for the object, or too little for the map
            return False
        drop_candidates(i, loss, node.unary, node.price, node.candidates, node.counts)
        share = 1.0 / (problem.first[i + 1] - problem.first[i] + 0.5)
        hand_out(i, share, problem, node.unary, node.messages, node.price, node.candidates, node.counts)
        node.profit[i] = after
    return True


@njit(cache=True)
def _best(i, unary, price, candidates, counts):  # type: ignore[no-untyped-def]
    best = -np.inf
    for a in range(counts[i]):
        best = max(best, unary[i, candidates[i, a]] - price[candidates[i, a]])
    return best


@njit(cache=True)
def tighten(node, problem, sought, bound, passes, patience, column_of):  # type: ignore[no-untyped-def]
    """Lowers the bound of a node until it is below what is sought, or ``patience`` more such passes would not do it.

    Fills in the map that the last assignment gives, and returns the bound, which may be what came in.
    """
    for turn in range(passes):
        if not one_pass(turn % 2 == 0, node, problem, bound - sought):
            return -np.inf
        found = solve_assignment(node.unary, column_of, node.price[:-1], node.profit)
        gained, bound = bound - found, min(found, bound)
        if not bound >= sought:
            return -np.inf
        for i in range(len(node.counts)):
            drop_candidates(i, bound - sought, node.unary, node.price, node.candidates, node.counts)
        if gained < np.inf and gained * patience < bound - sought:
            break
    return bound
