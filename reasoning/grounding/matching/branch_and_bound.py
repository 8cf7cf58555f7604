"""Depth-first branch and bound over partial one-to-one maps, with upper bounds by dual ascent; compiled.

Every fact's table can hand part of what it says to the unary terms of its two ends (a *message*), without changing the
value of any map. For any messages the value is at most that of the best assignment by the unary terms alone, plus each
table's largest remaining entry. Messages are improved object by object, as in sequential reweighted message passing
(Kolmogorov 2015; for graph matching Swoboda et al. 2017): an object pulls in all that its facts can still say, then
hands them an equal share of it. Prices of the things, from the linear assignment, hold the one-to-one constraint in.
What a table has left is never above 0 then, so that the assignment's value by itself is the bound.

A node of the search is a set of candidates for every object, with the messages and prices that bound it. It is
tightened, which also drops candidates; then the object with the fewest candidates is given each of them in turn, the
most promising first. The stack is an array, so that a search can be stopped, looked at, and resumed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.assignment import solve_assignment
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.kernel import njit


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


PASSES, PATIENCE = 30, 10  # over a node, and how many more like the last one must promise to close it
LEAF_PASSES = 2  # where all maps are wanted, and few nodes can be closed
DONE, BUDGET, FULL, DEEP = 0, 1, 2, 3
CLOSED, LEAF, OPEN = 0, 1, 2


class Node(NamedTuple):
    """What is still possible below a node, and what proves how good it can be."""

    unary: NDArray[np.float64]  # (n1, n2 + 1): with what the facts handed over; -inf for what is no candidate (more)
    messages: NDArray[np.float64]  # (2m, n2 + 1): what each slot handed to its owner
    candidates: NDArray[np.int32]  # (n1, n2 + 1): the first counts[i] of row i
    counts: NDArray[np.int64]  # (n1,)
    price: NDArray[np.float64]  # (n2 + 1,): of the things; that of staying without is 0
    profit: NDArray[np.float64]  # (n1,): of the objects


class Stack(NamedTuple):
    """Nodes by depth, and the state of each: the arrays of :class:`Node` with a leading axis of depth."""

    unary: NDArray[np.float64]
    messages: NDArray[np.float64]
    candidates: NDArray[np.int32]
    counts: NDArray[np.int64]
    price: NDArray[np.float64]
    profit: NDArray[np.float64]
    bound: NDArray[np.float64]  # (depth,)
    branch: NDArray[np.int64]  # (depth,): the object that the node branches on
    position: NDArray[np.int64]  # (depth,): how many of its candidates have been tried
    depth: NDArray[np.int64]  # (1,): of the node at work; -1 when the search is over


class Record(NamedTuple):
    """What the search found: the best map, or all maps that reach what is sought."""

    labels: NDArray[np.int64]  # (limit, n1): the best one first where one is looked for
    values: NDArray[np.float64]  # (limit,)
    found: NDArray[np.int64]  # (1,): how many
    sought: NDArray[np.float64]  # (1,): what a map has to reach
    step: NDArray[np.float64]  # (1,): by how much a map has to be better than the best so far; inf: all are kept
    nodes: NDArray[np.int64]  # (1,)


def new_stack(problem: Compiled, cells: float) -> Stack:
    """A stack with the root on it: every object with every candidate, nothing handed over.

    It is as deep as the search can get, or as so many cells allow.
    """
    n1, width = problem.unary.shape
    slots = len(problem.kind)
    depth = int(min(n1 + 1, max(1, cells // ((2 * n1 + slots) * width + 1))))
    stack = Stack(
        np.empty((depth, n1, width)),
        np.empty((depth, slots, width)),
        np.empty((depth, n1, width), dtype=np.int32),
        np.empty((depth, n1), dtype=np.int64),
        np.zeros((depth, width)),
        np.zeros((depth, n1)),
        np.full(depth, np.inf),
        np.full(depth, -1, dtype=np.int64),
        np.zeros(depth, dtype=np.int64),
        np.zeros(1, dtype=np.int64),
    )
    stack.unary[0] = np.where(problem.allowed, problem.unary, -np.inf)
    stack.messages[0] = 0.0
    stack.counts[0] = problem.allowed.sum(axis=1)
    stack.candidates[0] = np.argsort(~problem.allowed, axis=1, kind="stable")
    return stack


@njit(cache=True)
def search(problem, stack, record, budget):  # type: ignore[no-untyped-def]
    """Searches on for ``budget`` nodes; says whether it is over, stopped there, or lacks room for maps or depth."""
    column_of = np.empty(len(problem.unary), np.int64)
    while stack.depth[0] >= 0:
        d = stack.depth[0]
        if stack.branch[d] < 0:
            if budget == 0:
                return BUDGET
            budget -= 1
            record.nodes[0] += 1
            state = _look_at(d, problem, stack, record, column_of)
            if state == LEAF and record.found[0] == len(record.values):
                return FULL
            if state == LEAF:
                _keep(stack.candidates[d, :, 0].astype(np.int64), problem, record)
            if state != OPEN:
                stack.depth[0] = d - 1
                continue
        if d + 1 == len(stack.bound):
            return DEEP
        _descend(d, stack, record)
    return DONE


@njit(cache=True)
def node_at(d, stack):  # type: ignore[no-untyped-def]
    return Node(
        stack.unary[d], stack.messages[d], stack.candidates[d], stack.counts[d], stack.price[d], stack.profit[d]
    )


@njit(cache=True)
def _look_at(d, problem, stack, record, column_of):  # type: ignore[no-untyped-def]
    """Tightens a new node and chooses what it branches on; says whether it is closed, one map, or open."""
    node = node_at(d, stack)
    all_maps = record.step[0] == np.inf
    passes = LEAF_PASSES if all_maps else PASSES
    stack.bound[d] = tighten(node, problem, record.sought[0], stack.bound[d], passes, PATIENCE, column_of)
    if stack.bound[d] < record.sought[0]:
        return CLOSED
    if not all_maps:
        _keep(column_of, problem, record)
        if stack.bound[d] < record.sought[0]:
            return CLOSED
    i = -1
    for j in range(len(node.counts)):
        if node.counts[j] > 1 and (i < 0 or _before(j, i, node, problem)):
            i = j
    if i < 0:
        return LEAF if all_maps else CLOSED
    _sort(node.candidates[i, : node.counts[i]], node.unary[i], node.price)
    stack.branch[d], stack.position[d] = i, 0
    return OPEN


@njit(cache=True)
def _before(j, i, node, problem):  # type: ignore[no-untyped-def]
    """Whether to branch on j rather than on i: fewer candidates, then more facts."""
    if node.counts[j] != node.counts[i]:
        return node.counts[j] < node.counts[i]
    return problem.first[j + 1] - problem.first[j] > problem.first[i + 1] - problem.first[i]


@njit(cache=True)
def _sort(candidates, unary, price):  # type: ignore[no-untyped-def]
    """Best first, by insertion: there are few."""
    for a in range(1, len(candidates)):
        p = candidates[a]
        k = a
        while k > 0 and unary[candidates[k - 1]] - price[candidates[k - 1]] < unary[p] - price[p]:
            candidates[k] = candidates[k - 1]
            k -= 1
        candidates[k] = p


@njit(cache=True)
def _keep(labels, problem, record):  # type: ignore[no-untyped-def]
    """Records a map that reaches what is sought; where one is looked for, more is sought from then on."""
    value = evaluate(labels, problem)
    if value < record.sought[0]:
        return
    place = record.found[0] if record.step[0] == np.inf else 0
    record.labels[place], record.values[place] = labels, value
    record.found[0] = place + 1
    if record.step[0] < np.inf:
        record.sought[0] = value + record.step[0]


@njit(cache=True)
def evaluate(labels, problem):  # type: ignore[no-untyped-def]
    """The value of a map with n2 for what is left out."""
    value = 0.0
    for i in range(len(labels)):
        value += problem.unary[i, labels[i]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            if problem.other[slot] > i:
                value += problem.tables[problem.kind[slot], labels[i], labels[problem.other[slot]]]
    return value


@njit(cache=True)
def child_bound(d, stack):  # type: ignore[no-untyped-def]
    """What the next child of a node can be worth at most."""
    i, at = stack.branch[d], stack.position[d]
    if at >= stack.counts[d, i]:
        return -np.inf
    p = stack.candidates[d, i, at]
    return stack.bound[d] - (stack.profit[d, i] - (stack.unary[d, i, p] - stack.price[d, p]))


@njit(cache=True)
def _descend(d, stack, record):  # type: ignore[no-untyped-def]
    """Puts the next child of a node on the stack, or takes the node off where none is left that could do."""
    bound = child_bound(d, stack)
    if bound < record.sought[0]:
        stack.branch[d] = -1
        stack.depth[0] = d - 1
        return
    i = stack.branch[d]
    p = stack.candidates[d, i, stack.position[d]]
    stack.position[d] += 1
    parent, child = node_at(d, stack), node_at(d + 1, stack)
    child.unary[:], child.messages[:], child.candidates[:] = parent.unary, parent.messages, parent.candidates
    child.counts[:], child.price[:], child.profit[:] = parent.counts, parent.price, parent.profit
    stack.bound[d + 1], stack.branch[d + 1] = bound, -1
    if _give(i, p, child):
        stack.depth[0] = d + 1


@njit(cache=True)
def _give(i, p, node):  # type: ignore[no-untyped-def]
    """Leaves object i only p, and p to no other object; false where another has nothing left."""
    node.candidates[i, 0], node.counts[i] = p, 1
    kept = node.unary[i, p]
    node.unary[i] = -np.inf
    node.unary[i, p] = kept
    node.profit[i] = kept - node.price[p]
    if p == len(node.price) - 1:
        return True
    for j in range(len(node.counts)):
        if j != i and node.unary[j, p] > -np.inf:
            node.unary[j, p] = -np.inf
            left = 0
            for a in range(node.counts[j]):
                if node.candidates[j, a] != p:
                    node.candidates[j, left] = node.candidates[j, a]
                    left += 1
            node.counts[j] = left
            if left == 0:
                return False
    return True
