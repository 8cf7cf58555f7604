"""The compiled loops of the exact engine, on plain arrays.

Throughout: ``gains`` (facts, names + 1) is what a fact gives by the exact name of its pair; ``names`` (n2, n2) the
exact names; ``ends`` (facts, 2) the subject and object of each fact; ``incident[first[i]:first[i + 1]]`` the facts of
object i; ``unary`` (n1, n2) what speaks for a match by itself; ``allowed`` (n1, n2) which matches may be; an
assignment (n1,) holds -1 for what is unmatched.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def value(assignment, gains, names, ends, unary):  # type: ignore[no-untyped-def]
    total = 0.0
    for i in range(len(assignment)):
        if assignment[i] >= 0:
            total += unary[i, assignment[i]]
    for fact in range(len(ends)):
        p, q = assignment[ends[fact, 0]], assignment[ends[fact, 1]]
        if p >= 0 and q >= 0:
            total += gains[fact, names[p, q]]
    return total


@njit(cache=True)
def _share(i, assignment, gains, names, ends, first, incident, unary):  # type: ignore[no-untyped-def]
    """What object i's match contributes, with the others as they are."""
    if assignment[i] < 0:
        return 0.0
    total = unary[i, assignment[i]]
    for k in range(first[i], first[i + 1]):
        fact = incident[k]
        p, q = assignment[ends[fact, 0]], assignment[ends[fact, 1]]
        if p >= 0 and q >= 0:
            total += gains[fact, names[p, q]]
    return total


@njit(cache=True)
def _between(i, j, assignment, gains, names, ends, first, incident):  # type: ignore[no-untyped-def]
    """What the facts between two objects contribute; it is in the share of either."""
    total = 0.0
    for k in range(first[i], first[i + 1]):
        fact = incident[k]
        if ends[fact, 0] == j or ends[fact, 1] == j:
            p, q = assignment[ends[fact, 0]], assignment[ends[fact, 1]]
            if p >= 0 and q >= 0:
                total += gains[fact, names[p, q]]
    return total


@njit(cache=True)
def climb(assignment, gains, names, ends, first, incident, unary, allowed):  # type: ignore[no-untyped-def]
    n1, n2 = allowed.shape
    holder = np.full(n2, -1)
    for i in range(n1):
        if assignment[i] >= 0:
            holder[assignment[i]] = i
    better = True
    while better:
        better = False
        for i in range(n1):
            for p in range(n2):
                old, j = assignment[i], holder[p]
                if p == old or not allowed[i, p] or (j >= 0 and old >= 0 and not allowed[j, old]):
                    continue
                before = _share(i, assignment, gains, names, ends, first, incident, unary)
                if j >= 0:
                    before += _share(j, assignment, gains, names, ends, first, incident, unary)
                    before -= _between(i, j, assignment, gains, names, ends, first, incident)
                assignment[i] = p
                if j >= 0:
                    assignment[j] = old
                after = _share(i, assignment, gains, names, ends, first, incident, unary)
                if j >= 0:
                    after += _share(j, assignment, gains, names, ends, first, incident, unary)
                    after -= _between(i, j, assignment, gains, names, ends, first, incident)
                if after > before + 1e-12:
                    better = True
                    holder[p] = i
                    if old >= 0:
                        holder[old] = j
                else:
                    assignment[i] = old
                    if j >= 0:
                        assignment[j] = p


@njit(cache=True)
def advance(  # type: ignore[no-untyped-def]
    gains, names, ends, first, incident, best_as, order, allowed,
    potentials, placed, candidates, position, assignment, taken, depth, value, best, budget, slack,
):  # fmt: skip
    """Searches on for ``budget`` nodes; True where the whole tree has been searched."""
    n1, n2 = allowed.shape
    for _ in range(budget):
        d = depth[0]
        if d < 0:
            return True
        if d == n1:
            if placed[d] > value[0] + slack * 1e-6:
                value[0] = placed[d]
                best[:] = assignment
            depth[0] = d - 1
            continue
        i = order[d]
        if position[d] < 0:
            _open(d, i, potentials, allowed, taken, candidates)
            position[d] = 0
        else:
            if assignment[i] >= 0:
                taken[assignment[i]] = False
                assignment[i] = -1
            position[d] += 1
        if position[d] > n2 or (position[d] > 0 and candidates[d, position[d] - 1] < 0):
            position[d] = -1
            depth[0] = d - 1
            continue
        p = candidates[d, position[d]]
        bound = _place(
            d, i, p, gains, names, ends, first, incident, best_as, order, allowed, potentials, placed, assignment, taken
        )
        if bound > value[0] + slack * 1e-6:
            depth[0] = d + 1
    return False


@njit(cache=True)
def _open(d, i, potentials, allowed, taken, candidates):  # type: ignore[no-untyped-def]
    """Lists the free candidates of an object, best potential first; leaving it out comes last (-1)."""
    n2 = allowed.shape[1]
    count = 0
    for p in range(n2):
        if allowed[i, p] and not taken[p]:
            k = count
            while k > 0 and potentials[d, i, candidates[d, k - 1]] < potentials[d, i, p]:
                candidates[d, k] = candidates[d, k - 1]
                k -= 1
            candidates[d, k] = p
            count += 1
    candidates[d, count] = -1


@njit(cache=True)
def _place(  # type: ignore[no-untyped-def]
    d, i, p, gains, names, ends, first, incident, best_as, order, allowed, potentials, placed, assignment, taken
):
    """Places object i at p (or leaves it out), brings the potentials up to date, and returns the new upper bound."""
    n1, n2 = allowed.shape
    for e in range(d + 1, n1):
        j = order[e]
        for q in range(n2):
            potentials[d + 1, j, q] = potentials[d, j, q]
    gained = potentials[d, i, p] if p >= 0 else 0.0
    assignment[i] = p
    if p >= 0:
        taken[p] = True
    for k in range(first[i], first[i + 1]):
        fact = incident[k]
        i_end = 0 if ends[fact, 0] == i else 1
        j = ends[fact, 1 - i_end]
        if _is_placed(j, d, order):
            continue
        for q in range(n2):
            potentials[d + 1, j, q] -= best_as[1 - i_end, fact, q] / 2
            if p >= 0 and q != p:
                name = names[p, q] if i_end == 0 else names[q, p]
                potentials[d + 1, j, q] += gains[fact, name]
        if p >= 0:
            gained -= best_as[i_end, fact, p] / 2
    placed[d + 1] = placed[d] + gained
    bound = placed[d + 1]
    for e in range(d + 1, n1):
        j = order[e]
        top = 0.0
        for q in range(n2):
            if allowed[j, q] and not taken[q] and potentials[d + 1, j, q] > top:
                top = potentials[d + 1, j, q]
        bound += top
    return bound


@njit(cache=True)
def _is_placed(j, d, order):  # type: ignore[no-untyped-def]
    return (order[:d] == j).any()
