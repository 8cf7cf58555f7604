"""Depth-first branch and bound over partial one-to-one maps, with upper bounds by dual ascent; compiled.

A *message* moves part of the evidence in a fact's table to the unary terms of one of its ends, without changing the
value of any map. For any messages, the value is at most that of the best assignment by the unary terms alone, plus each
table's largest remaining entry. Messages are improved object by object, as in sequential reweighted message passing
(Kolmogorov 2015; for graph matching Swoboda et al. 2017): an object pulls the evidence from all its facts, then returns
an equal share to each of them. Prices of the things, from the linear assignment, enforce the one-to-one constraint. The
remaining entries of the tables are then never above 0, so that the value of the assignment is the bound.

A node of the search is a set of candidates for every object, with the messages and prices that bound it. Tightening a
node also drops candidates. The search then branches on the object with the fewest candidates, the most promising
candidate first. The stack is an array, so that a search can be stopped, inspected and resumed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.assignment import solve_assignment
from deixis.reasoning.kernel import njit


@njit(cache=True)
def pull(i, problem, unary, messages, candidates, counts):  # type: ignore[no-untyped-def]
    """Move the maximum remaining evidence of object i's facts to its unary terms.

    Parameters
    ----------
    i
        The object.
    problem
        The problem in the layout of compiled loops.
    unary, messages
        Evidence of matches, shape (n1, n2 + 1), and moved evidence of each slot, shape (2m, n2 + 1); changed in place.
    candidates, counts
        Candidates of each object, shape (n1, n2 + 1), and their number, shape (n1,).
    """
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
    """Move a share of each candidate's deficit to the best one from object i to each of its facts; return the best.

    Parameters
    ----------
    i
        The object.
    share
        Share of the deficit that each fact gets; at most 1 over the number of facts.
    problem
        The problem in the layout of compiled loops.
    unary, messages
        Evidence of matches, shape (n1, n2 + 1), and moved evidence of each slot, shape (2m, n2 + 1); changed in place.
    price
        Price of each thing, shape (n2 + 1,).
    candidates, counts
        Candidates of each object, shape (n1, n2 + 1), and their number, shape (n1,).

    Returns
    -------
    float
        Value of the best candidate, in nats.
    """
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
    """Drop the candidates of object i that are more than ``loss`` below its best one; return how many.

    Parameters
    ----------
    i
        The object.
    loss
        Largest difference from the best candidate, in nats.
    unary
        Evidence of matches, shape (n1, n2 + 1); -inf for those that are dropped.
    price
        Price of each thing, shape (n2 + 1,).
    candidates, counts
        Candidates of each object, shape (n1, n2 + 1), and their number, shape (n1,); changed in place.

    Returns
    -------
    int
        Number of dropped candidates.
    """
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
    """Pass messages for every object once, forward or backward; return false where the node is closed.

    Parameters
    ----------
    forward
        Whether to take the objects in ascending order.
    node
        The node, which is changed in place.
    problem
        The problem in the layout of compiled loops.
    loss
        The bound minus the sought value, in nats: a candidate that is more below the best one is dropped.

    Returns
    -------
    bool
        Whether the node is still open.
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
    """Lower the bound of a node until it is below the sought value, or ``patience`` more passes would not suffice.

    Parameters
    ----------
    node
        The node, which is changed in place.
    problem
        The problem in the layout of compiled loops.
    sought
        Value below which the node is closed, in nats.
    bound
        Upper bound of the node so far, in nats.
    passes
        Maximum number of passes.
    patience
        Number of further passes that must promise to close the node.
    column_of
        Array to fill with the map of the last assignment, shape (n1,).

    Returns
    -------
    float
        The lower bound, -inf for a closed node.
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


PASSES, PATIENCE = 30, 10  # maximum passes over a node, and number of further passes that must promise to close it
LEAF_PASSES = 2  # passes when listing all maps, where few nodes can be closed
DONE, BUDGET, FULL, DEEP = 0, 1, 2, 3
CLOSED, LEAF, OPEN = 0, 1, 2


class Node(NamedTuple):
    """Candidates of every object below a node, and the messages and prices that bound the value of its maps."""

    unary: NDArray[np.float64]  # (n1, n2 + 1): with the messages of the facts; -inf where dropped or not allowed
    messages: NDArray[np.float64]  # (2m, n2 + 1): message of each slot to its object
    candidates: NDArray[np.int32]  # (n1, n2 + 1): the first counts[i] of row i
    counts: NDArray[np.int64]  # (n1,)
    price: NDArray[np.float64]  # (n2 + 1,): prices of the things; that of absence is 0
    profit: NDArray[np.float64]  # (n1,): profits of the objects


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
    position: NDArray[np.int64]  # (depth,): number of its candidates that were tried
    depth: NDArray[np.int64]  # (1,): depth of the current node; -1 after the end of the search


class Record(NamedTuple):
    """Maps found by the search: the best map, or all maps of at least the sought value."""

    labels: NDArray[np.int64]  # (limit, n1): maps; only the first when searching the best one
    values: NDArray[np.float64]  # (limit,)
    found: NDArray[np.int64]  # (1,): number of maps
    sought: NDArray[np.float64]  # (1,): minimum value of a map
    step: NDArray[np.float64]  # (1,): minimum improvement over the best map so far; inf: all maps are kept
    nodes: NDArray[np.int64]  # (1,)


def new_stack(problem: Compiled, cells: float) -> Stack:
    """Return a stack with the root: every object with every allowed candidate, and no messages.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    cells
        Maximum size of the stack, in numbers of 8 bytes. The stack is not deeper than the search needs.

    Returns
    -------
    Stack
        The stack, with its depth at the root.
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
    """Continue the search for ``budget`` nodes; return DONE, BUDGET, FULL (no room for maps) or DEEP (for depth).

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    stack
        Nodes from the root to the current one, changed in place.
    record
        The maps that are found, changed in place.
    budget
        Maximum number of nodes to visit.

    Returns
    -------
    int
        State of the search.
    """
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
    """Return a view of the node at depth d.

    Parameters
    ----------
    d
        Depth, 0 for the root.
    stack
        The stack.

    Returns
    -------
    Node
        Arrays that share the memory of the stack.
    """
    return Node(
        stack.unary[d], stack.messages[d], stack.candidates[d], stack.counts[d], stack.price[d], stack.profit[d]
    )


@njit(cache=True)
def _look_at(d, problem, stack, record, column_of):  # type: ignore[no-untyped-def]
    """Tighten a new node and choose the object to branch on; return CLOSED, LEAF or OPEN."""
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
        if node.counts[j] > 1 and (i < 0 or _branches_first(j, i, node, problem)):
            i = j
    if i < 0:
        return LEAF if all_maps else CLOSED
    _sort(node.candidates[i, : node.counts[i]], node.unary[i], node.price)
    stack.branch[d], stack.position[d] = i, 0
    return OPEN


@njit(cache=True)
def _branches_first(j, i, node, problem):  # type: ignore[no-untyped-def]
    """Return whether to branch on j rather than on i: fewer candidates, then more facts."""
    if node.counts[j] != node.counts[i]:
        return node.counts[j] < node.counts[i]
    return problem.first[j + 1] - problem.first[j] > problem.first[i + 1] - problem.first[i]


@njit(cache=True)
def _sort(candidates, unary, price):  # type: ignore[no-untyped-def]
    """Sort the candidates, best first, by insertion, because there are few."""
    for a in range(1, len(candidates)):
        p = candidates[a]
        k = a
        while k > 0 and unary[candidates[k - 1]] - price[candidates[k - 1]] < unary[p] - price[p]:
            candidates[k] = candidates[k - 1]
            k -= 1
        candidates[k] = p


@njit(cache=True)
def _keep(labels, problem, record):  # type: ignore[no-untyped-def]
    """Record a map of at least the sought value; when searching the best map, raise the sought value."""
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
    """Return the value of a map (n1,) with n2 for objects that are left out.

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
    value = 0.0
    for i in range(len(labels)):
        value += problem.unary[i, labels[i]]
        for slot in range(problem.first[i], problem.first[i + 1]):
            if problem.other[slot] > i:
                value += problem.tables[problem.kind[slot], labels[i], labels[problem.other[slot]]]
    return value


@njit(cache=True)
def child_bound(d, stack):  # type: ignore[no-untyped-def]
    """Return an upper bound on the value of the next child of a node.

    Parameters
    ----------
    d
        Depth of the node.
    stack
        The stack.

    Returns
    -------
    float
        Upper bound in nats.
    """
    i, at = stack.branch[d], stack.position[d]
    if at >= stack.counts[d, i]:
        return -np.inf
    p = stack.candidates[d, i, at]
    return stack.bound[d] - (stack.profit[d, i] - (stack.unary[d, i, p] - stack.price[d, p]))


@njit(cache=True)
def _descend(d, stack, record):  # type: ignore[no-untyped-def]
    """Push the next child of a node on the stack, or pop the node where no child can reach the sought value."""
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
    if _fix(i, p, child):
        stack.depth[0] = d + 1


@njit(cache=True)
def _fix(i, p, node):  # type: ignore[no-untyped-def]
    """Restrict object i to thing p, and exclude p for other objects; return false where one has no candidate left."""
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
