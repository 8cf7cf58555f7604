"""Run the conflict-driven search in compiled loops: incremental closure, conflict analysis, learned nogoods.

A network has ``axes`` (one for a plain calculus) over n things. ``masks`` (axes, n, n) holds the remaining relation of
every pair on every axis, one bit per atom. A pair i < k on axis a is *edge* (a * n + i) * n + k, and is read from i to
k.

A *nogood* is a list of premises (edge, relation): not every edge can be within its relation. When all premises except
one hold, the last edge loses the atoms of its relation. Nogoods are stated (an alternative between axes) or learned
from a contradiction: every narrowing on the trail has a reason, the composition with a third thing or a nogood, and its
premises are widened as far as the same conclusion still follows, up to the first edge that alone represents all effects
of the last decision (Marques-Silva and Sakallah 1999; Ohrimenko, Stuckey and Codish 2009).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from deixis.reasoning.kernel import kernel
from deixis.reasoning.qualitative.networks.closure.kernels import low_bit
from deixis.reasoning.qualitative.networks.closure.mask_kernels import narrower

Array = Any

loop = kernel(lambda budget, *rest: 20 * budget, _nrt=False)
"""Decorator that compiles without reference counts.

Nothing here allocates, and counting each use of an array takes four fifths of the time of the search (numba counts with
atomic instructions whenever an array is taken from a tuple).
"""

CONSISTENT, INCONSISTENT, PAUSED, TRAIL_FULL, NOGOODS_FULL = 0, 1, 2, 3, 4

# positions in ``Memory.counts``
(
    LENGTH,  # length of the trail
    LEVEL,  # number of current decisions
    SEEN,  # narrowings of the trail that the nogoods have seen
    CONFLICT,  # the edge with an empty relation, otherwise -1
    NOGOODS,  # number of nogoods
    PREMISES,  # number of premises of all nogoods
    STATED,  # number of leading nogoods that are never forgotten
    DECISIONS,
    CONFLICTS,
    RESTARTS,
    UNTIL_RESTART,  # conflicts
    KEPT,  # learned nogoods to keep at a restart
) = range(12)
COUNTS = 12

DECISION, NOGOOD = -1, -2  # reasons on the trail: a decision; NOGOOD - c for nogood number c; otherwise the third thing
MAX_SCANNED = 4096  # candidates compared for a decision
RESTART_UNIT = 32  # conflicts before the first restart
ACTIVITY_GROWTH = 1 / 0.98  # decay of the activity that a conflict adds to an edge, from one conflict to the next
MAX_ACTIVITY = 1e100

ZERO = np.uint64(0)
ONE = np.uint64(1)


class Algebra(NamedTuple):
    """The data of the axes' calculi for the loops; a relation is cut into parts of ``width`` bits for look-ups."""

    width: int
    compositions: Array  # (axes, parts, 2^width, parts, 2^width)
    converses: Array  # (axes, parts, 2^width)
    full: Array  # (axes,) uint64: the universal relation
    rows: Array  # (axes, relations, parts, 2^width): each composed with each part of a right one
    known: Array  # (axes, relations): the relations in ``rows``; (axes, 0) if there are too many relations
    hulls: Array  # (axes, 2^atoms): the least tractable relation above each; (axes, 0) if only atoms are
    tractable: Array  # (axes, relations): the tractable relations, largest first, padded with 0
    weights: Array  # (axes, atoms): the number of atoms that each atom leaves possible when composed with each atom


class Memory(NamedTuple):
    """The whole state of the search; arrays of length e = axes * n * n are indexed by edge."""

    masks: Array  # (axes, n, n)
    flat: Array  # (e,): the same memory
    allowed: Array  # (e,): the stated relation; settled when a tractable one within it contains the rest
    candidates: Array  # (c,): the edges to settle, those with the fewest atoms first
    counts: Array  # (COUNTS,)
    # the trail
    edges: Array  # (room,): the edge narrowed
    olds: Array  # (room,): its relation before
    reasons: Array  # (room,)
    earlier: Array  # (room,): the previous narrowing of the same edge, or -1
    latest: Array  # (e,): the last narrowing of an edge, or -1
    starts: Array  # (room,): the length of the trail at the start of each level
    cursors: Array  # (room,): at each level, the first candidate that was not settled
    stamps: Array  # (room,): at each level, the last contradiction with a premise of that level
    # the edges whose narrowing must still be propagated, in a list for each number of atoms left
    first: Array  # (65,)
    last: Array  # (65,)
    following: Array  # (e,): the next in the list, -1 at the end, -2 for an edge that does not wait
    # weights
    activity: Array  # (e,)
    increment: Array  # (1,)
    tried: Array  # (e,): the tractable relation last decided
    # conflict analysis
    needed: Array  # (e,): the relation of a premise
    since: Array  # (e,): the narrowing since which the premise holds, or -1 if it always held
    premises: Array  # (room + e,): the edges with premises; an edge may occur twice
    # nogoods
    begins: Array  # (nogoods + 1,)
    premise_edges: Array  # (room for premises,)
    premise_masks: Array  # (room for premises,)
    levels: Array  # (nogoods,): number of different levels among the premises when learned
    watched: Array  # (2 nogoods,): two premises of each
    next_watch: Array  # (2 nogoods,)
    watches: Array  # (e,): the first watch on an edge, or -1


@loop
def _converse(axis, relation, algebra):  # type: ignore[no-untyped-def]
    part, out = (ONE << np.uint64(algebra.width)) - ONE, ZERO
    left = np.uint64(relation)
    for p in range(algebra.converses.shape[1]):
        out |= np.uint64(algebra.converses[axis, p, left & part])
        left >>= np.uint64(algebra.width)
    return out


@loop
def _composed(axis, first, second, algebra):  # type: ignore[no-untyped-def]
    part, shift, out = (ONE << np.uint64(algebra.width)) - ONE, np.uint64(algebra.width), ZERO
    for p in range(algebra.compositions.shape[1]):
        left = first >> (shift * np.uint64(p)) & part
        for q in range(algebra.compositions.shape[1]):
            out |= np.uint64(algebra.compositions[axis, p, left, q, second >> (shift * np.uint64(q)) & part])
    return out


@loop
def _atoms(relation):  # type: ignore[no-untyped-def]
    count = 0
    left = np.uint64(relation)
    while left:
        left &= left - ONE
        count += 1
    return count


@loop
def _mask(edge, memory):  # type: ignore[no-untyped-def]
    return np.uint64(memory.flat[edge])


@loop
def _set(edge, relation, algebra, memory):  # type: ignore[no-untyped-def]
    n = memory.masks.shape[1]
    axis, place = edge // (n * n), edge % (n * n)
    i, k = place // n, place % n
    memory.masks[axis, i, k] = relation
    memory.masks[axis, k, i] = _converse(axis, relation, algebra)


@loop
def _narrow(edge, relation, reason, algebra, memory):  # type: ignore[no-untyped-def]
    """Leave an edge with less, and note why."""
    counts = memory.counts
    length = counts[LENGTH]
    memory.edges[length] = edge
    memory.olds[length] = _mask(edge, memory)
    memory.reasons[length] = reason
    memory.earlier[length] = memory.latest[edge]
    memory.latest[edge] = length
    counts[LENGTH] = length + 1
    _set(edge, relation, algebra, memory)
    if relation == ZERO:
        counts[CONFLICT] = edge
    else:
        _enqueue(edge, relation, memory)


@loop
def _enqueue(edge, relation, memory):  # type: ignore[no-untyped-def]
    if memory.following[edge] != -2:
        return
    bucket = _atoms(relation)
    memory.following[edge] = -1
    if memory.first[bucket] < 0:
        memory.first[bucket] = edge
    else:
        memory.following[memory.last[bucket]] = edge
    memory.last[bucket] = edge


@loop
def _dequeue(memory):  # type: ignore[no-untyped-def]
    """Return the waiting edge with the fewest atoms, or -1."""
    for bucket in range(len(memory.first)):
        edge = memory.first[bucket]
        if edge >= 0:
            memory.first[bucket] = memory.following[edge]
            memory.following[edge] = -2
            return edge
    return -1


@loop
def _clear_queue(memory):  # type: ignore[no-untyped-def]
    while _dequeue(memory) >= 0:
        pass


@loop
def _undo_last(algebra, memory):  # type: ignore[no-untyped-def]
    memory.counts[LENGTH] -= 1
    length = memory.counts[LENGTH]
    edge = memory.edges[length]
    _set(edge, np.uint64(memory.olds[length]), algebra, memory)
    memory.latest[edge] = memory.earlier[length]


@loop
def _back_to(level, algebra, memory):  # type: ignore[no-untyped-def]
    counts = memory.counts
    if level < counts[LEVEL]:
        start = memory.starts[level + 1]
        while counts[LENGTH] > start:
            _undo_last(algebra, memory)
        counts[LEVEL] = level
    counts[SEEN] = counts[LENGTH]
    counts[CONFLICT] = -1
    _clear_queue(memory)


@loop
def _pass_on(edge, changed, lefts, algebra, memory):  # type: ignore[no-untyped-def]
    """Compose an edge with every third thing, both ways; stop when a pair is emptied."""
    masks, counts = memory.masks, memory.counts
    n = masks.shape[1]
    axis, place = edge // (n * n), edge % (n * n)
    ends = (place // n, place % n)
    for turn in range(2):
        i, k = ends[turn], ends[1 - turn]
        relation = np.uint64(masks[axis, i, k])
        if relation == algebra.full[axis]:
            return
        rows = algebra.rows[axis, _row_place(axis, relation, algebra)]
        if len(rows) == 2:
            found = narrower(masks[axis, i], masks[axis, k], algebra.width, rows[0], rows[1], changed, lefts)
        else:
            found = _narrower_in_parts(masks[axis, i], masks[axis, k], algebra.width, rows, changed, lefts)
        for c in range(found):
            j = changed[c]
            if j in (i, k):
                continue
            left = np.uint64(lefts[c])
            if i < j:
                _narrow((axis * n + i) * n + j, left, k, algebra, memory)
            else:
                _narrow((axis * n + j) * n + i, _converse(axis, left, algebra), k, algebra, memory)
            if counts[CONFLICT] >= 0:
                return


@loop
def _row_place(axis, relation, algebra):  # type: ignore[no-untyped-def]
    """Return the position in ``rows`` of the relation's compositions with each part of a right one."""
    if not algebra.known.shape[1]:
        _fill_rows(axis, relation, algebra.rows[axis, 0], algebra)
        return ZERO
    if not algebra.known[axis, relation]:
        _fill_rows(axis, relation, algebra.rows[axis, relation], algebra)
        algebra.known[axis, relation] = True
    return relation


@loop
def _fill_rows(axis, relation, rows, algebra):  # type: ignore[no-untyped-def]
    part, left = (ONE << np.uint64(algebra.width)) - ONE, relation
    for p in range(len(rows)):
        table = algebra.compositions[axis, p, left & part]
        for q in range(rows.shape[0]):
            for right in range(rows.shape[1]):
                before = np.uint64(rows[q, right]) if p else ZERO
                rows[q, right] = np.uint64(table[q, right]) | before
        left >>= np.uint64(algebra.width)


@loop
def _narrower_in_parts(mine, others, width, rows, changed, lefts):  # type: ignore[no-untyped-def]
    """List the narrowed pairs of a row, and their new relations, where relations are cut into more than two parts."""
    found, shift = ZERO, np.uint64(width)
    part = (ONE << shift) - ONE
    for k in range(len(mine)):
        other, through = np.uint64(others[k]), ZERO
        for p in range(len(rows)):
            through |= np.uint64(rows[p, other & part])
            other >>= shift
        left = np.uint64(mine[k]) & through
        changed[found], lefts[found] = k, left
        found += np.uint64(left != np.uint64(mine[k]))
    return found


@loop
def _tell_nogoods(edge, algebra, memory):  # type: ignore[no-untyped-def]
    """Visit the nogoods that watch an edge; return how many."""
    counts, mask = memory.counts, _mask(edge, memory)
    before, watch, visited = -1, memory.watches[edge], 0
    while watch >= 0:
        visited += 1
        following = memory.next_watch[watch]
        if mask & ~np.uint64(memory.premise_masks[memory.watched[watch]]):
            before, watch = watch, following
            continue
        other = memory.watched[watch ^ 1]
        other_edge, other_relation = memory.premise_edges[other], np.uint64(memory.premise_masks[other])
        other_mask = _mask(other_edge, memory)
        if not other_mask & other_relation:
            before, watch = watch, following
            continue
        nogood, moved = watch >> 1, -1
        for position in range(memory.begins[nogood], memory.begins[nogood + 1]):
            if position != other and _mask(memory.premise_edges[position], memory) & ~np.uint64(
                memory.premise_masks[position]
            ):
                moved = position
                break
        if moved >= 0:
            memory.watched[watch] = moved
            if before < 0:
                memory.watches[edge] = following
            else:
                memory.next_watch[before] = following
            target = memory.premise_edges[moved]
            memory.next_watch[watch] = memory.watches[target]
            memory.watches[target] = watch
            watch = following
            continue
        _narrow(other_edge, other_mask & ~other_relation, NOGOOD - nogood, algebra, memory)
        if counts[CONFLICT] >= 0:
            return visited
        before, watch = watch, following
    return visited


@loop
def _watch(nogood, side, position, memory):  # type: ignore[no-untyped-def]
    watch, edge = 2 * nogood + side, memory.premise_edges[position]
    memory.watched[watch] = position
    memory.next_watch[watch] = memory.watches[edge]
    memory.watches[edge] = watch


@loop
def _established(edge, relation, memory):  # type: ignore[no-untyped-def]
    """Return the narrowing that brought an edge within a relation; -1 if it always was."""
    at = memory.latest[edge]
    while at >= 0 and not np.uint64(memory.olds[at]) & ~relation:
        at = memory.earlier[at]
    return at


@loop
def _need(edge, relation, found, opened, memory):  # type: ignore[no-untyped-def]
    """Add a premise; return the number of edges with one, and how many of these are of the last level."""
    counts = memory.counts
    old = memory.since[edge]
    if old >= 0:
        relation &= np.uint64(memory.needed[edge])
        if relation == np.uint64(memory.needed[edge]):
            return found, opened
    since = _established(edge, relation, memory)
    if since < memory.starts[1]:
        return found, opened
    start = memory.starts[counts[LEVEL]]
    memory.needed[edge] = relation
    memory.since[edge] = since
    if old < 0:
        memory.premises[found] = edge
        found += 1
        memory.activity[edge] += memory.increment[0]
    if since >= start and old < start:
        opened += 1
    return found, opened


@loop
def _need_pair(axis, i, k, relation, found, opened, algebra, memory):  # type: ignore[no-untyped-def]
    n = memory.masks.shape[1]
    if i < k:
        return _need((axis * n + i) * n + k, relation, found, opened, memory)
    return _need((axis * n + k) * n + i, _converse(axis, relation, algebra), found, opened, memory)


@loop
def _need_composition(edge, third, gone, found, opened, algebra, memory):  # type: ignore[no-untyped-def]
    """Add the widest premises on two sides of a triangle that exclude the atoms ``gone`` from an edge."""
    n = memory.masks.shape[1]
    axis, place = edge // (n * n), edge % (n * n)
    i, k = place // n, place % n
    full = algebra.full[axis]
    left_edge = (axis * n + min(i, third)) * n + max(i, third)
    right_edge = (axis * n + min(k, third)) * n + max(k, third)
    if memory.latest[left_edge] >= memory.latest[right_edge]:
        left = full & ~_composed(axis, gone, np.uint64(memory.masks[axis, k, third]), algebra)
        right = full & ~_composed(axis, _converse(axis, left, algebra), gone, algebra)
    else:
        right = full & ~_composed(axis, np.uint64(memory.masks[axis, third, i]), gone, algebra)
        left = full & ~_composed(axis, gone, _converse(axis, right, algebra), algebra)
    found, opened = _need_pair(axis, i, third, left, found, opened, algebra, memory)
    return _need_pair(axis, third, k, right, found, opened, algebra, memory)


@loop
def _learn(algebra, memory):  # type: ignore[no-untyped-def]
    """Turn the contradiction into a nogood, backtrack to the level where it first applies, and narrow by it."""
    counts, since, needed = memory.counts, memory.since, memory.needed
    found, opened = _need(counts[CONFLICT], ZERO, 0, 0, memory)
    counts[CONFLICTS] += 1
    first = True
    while True:
        at = counts[LENGTH] - 1
        edge = memory.edges[at]
        if since[edge] == at and opened == 1 and not first:
            break
        resolved = since[edge] == at
        old = np.uint64(memory.olds[at])
        _undo_last(algebra, memory)
        if not resolved:
            continue
        first = False
        relation = np.uint64(needed[edge])
        gone, reason = old & ~relation, memory.reasons[at]
        since[edge] = -1
        opened -= 1
        # the edge keeps its place among ``premises``; an edge needed again is listed twice
        found, opened = _need(edge, old | relation, found, opened, memory)
        if reason >= 0:
            found, opened = _need_composition(edge, reason, gone, found, opened, algebra, memory)
        else:
            nogood = NOGOOD - reason
            for position in range(memory.begins[nogood], memory.begins[nogood + 1]):
                other = memory.premise_edges[position]
                if other != edge:
                    wanted = np.uint64(memory.premise_masks[position])
                    found, opened = _need(other, wanted, found, opened, memory)
    # the premises needed are the nogood; the current edge goes first, that of the highest level before it second
    _write_nogood(edge, found, algebra, memory)


@loop
def _level_of(at, memory):  # type: ignore[no-untyped-def]
    low, high = 0, memory.counts[LEVEL]
    while low < high:
        middle = (low + high + 1) >> 1
        if memory.starts[middle] <= at:
            low = middle
        else:
            high = middle - 1
    return low


@loop
def _at_root(edge, memory):  # type: ignore[no-untyped-def]
    """Return the relation of an edge before any decision."""
    at, relation = memory.latest[edge], _mask(edge, memory)
    while at >= memory.starts[1]:
        relation = np.uint64(memory.olds[at])
        at = memory.earlier[at]
    return relation


@loop
def _known(axis, i, k, before, algebra, memory):  # type: ignore[no-untyped-def]
    """Return the relation of two things by premises that held before a narrowing, or before any decision."""
    n = memory.masks.shape[1]
    edge = (axis * n + min(i, k)) * n + max(i, k)
    relation = _at_root(edge, memory)
    if 0 <= memory.since[edge] < before:
        relation &= np.uint64(memory.needed[edge])
    return relation if i < k else _converse(axis, relation, algebra)


@loop
def _follows(edge, algebra, memory):  # type: ignore[no-untyped-def]
    """Return True if a premise follows from those that held before it, by the reason of its own narrowing."""
    n = memory.masks.shape[1]
    axis, place = edge // (n * n), edge % (n * n)
    i, k = place // n, place % n
    at = memory.since[edge]
    reason, wrong = memory.reasons[at], _at_root(edge, memory) & ~np.uint64(memory.needed[edge])
    if reason >= 0:
        left = _known(axis, i, reason, at, algebra, memory)
        right = _known(axis, reason, k, at, algebra, memory)
        return wrong & _composed(axis, left, right, algebra) == ZERO
    if reason == DECISION:
        return False
    nogood = NOGOOD - reason
    for position in range(memory.begins[nogood], memory.begins[nogood + 1]):
        other, relation = memory.premise_edges[position], np.uint64(memory.premise_masks[position])
        if other == edge:
            if wrong & ~relation:
                return False
        else:
            known = _at_root(other, memory)
            if 0 <= memory.since[other] < at:
                known &= np.uint64(memory.needed[other])
            if known & ~relation:
                return False
    return True


@loop
def _write_nogood(asserting, found, algebra, memory):  # type: ignore[no-untyped-def]
    counts, since, needed = memory.counts, memory.since, memory.needed
    nogood, begin = counts[NOGOODS], counts[PREMISES]
    length, back, second, different = begin + 1, 0, -1, 1
    memory.premise_edges[begin] = asserting
    memory.premise_masks[begin] = needed[asserting]
    for c in range(found):
        edge = memory.premises[c]
        if edge != asserting and since[edge] >= 0 and _follows(edge, algebra, memory):
            memory.premises[c] = -1 - edge
    since[asserting] = -1
    for c in range(found):
        edge = memory.premises[c]
        if edge < 0 or since[edge] < 0:
            continue
        level = _level_of(since[edge], memory)
        memory.premise_edges[length] = edge
        memory.premise_masks[length] = needed[edge]
        if level > back:
            back, second = level, length
        if memory.stamps[level] != counts[CONFLICTS]:
            memory.stamps[level] = counts[CONFLICTS]
            different += 1
        length += 1
        since[edge] = -1
    for c in range(found):
        if memory.premises[c] < 0:
            since[-1 - memory.premises[c]] = -1
    _back_to(back, algebra, memory)
    relation = np.uint64(memory.premise_masks[begin])
    reason = DECISION
    if length > begin + 1:
        reason = NOGOOD - nogood
        memory.begins[nogood + 1] = length
        counts[NOGOODS] += 1
        counts[PREMISES] = length
        memory.levels[nogood] = different
        _watch(nogood, 0, begin, memory)
        _watch(nogood, 1, second, memory)
    _narrow(asserting, _mask(asserting, memory) & ~relation, reason, algebra, memory)


@loop
def _forget(algebra, memory):  # type: ignore[no-untyped-def]
    """Forget nogoods at level 0: keep those that connect the fewest levels, and drop premises that always hold."""
    counts = memory.counts
    total, learned = counts[NOGOODS], counts[NOGOODS] - counts[STATED]
    limit = 1 << 30
    if learned > counts[KEPT]:
        sizes = memory.premises  # room for counting
        for size in range(64):
            sizes[size] = 0
        for nogood in range(counts[STATED], total):
            sizes[min(63, memory.levels[nogood])] += 1
        limit, room = 0, counts[KEPT] // 2
        while limit < 62 and sizes[limit] <= room:
            room -= sizes[limit]
            limit += 1
        counts[KEPT] += counts[KEPT] // 10
    for edge in range(len(memory.watches)):
        memory.watches[edge] = -1
    kept, length = 0, 0
    stated = counts[STATED]
    begin = 0
    for nogood in range(total):
        start, begin = begin, memory.begins[nogood + 1]
        end = begin
        if nogood >= counts[STATED] and memory.levels[nogood] > limit and memory.levels[nogood] > 2:
            continue
        target, vain = length, False
        for position in range(start, end):
            edge, relation = memory.premise_edges[position], memory.premise_masks[position]
            mask = _mask(edge, memory)
            if not mask & np.uint64(relation):
                vain = True
                break
            if mask & ~np.uint64(relation):
                memory.premise_edges[target], memory.premise_masks[target] = edge, relation
                target += 1
        if vain or target < length + 2:
            if nogood < counts[STATED]:
                stated -= 1
            if not vain:
                if target == length:
                    counts[CONFLICT] = 0
                else:
                    edge = memory.premise_edges[length]
                    left = _mask(edge, memory) & ~np.uint64(memory.premise_masks[length])
                    _narrow(edge, left, DECISION, algebra, memory)
                if counts[CONFLICT] >= 0:
                    return
            continue
        memory.levels[kept] = memory.levels[nogood]
        memory.begins[kept + 1] = target
        _watch(kept, 0, length, memory)
        _watch(kept, 1, length + 1, memory)
        length = target
        kept += 1
    counts[NOGOODS], counts[PREMISES], counts[STATED] = kept, length, stated


@loop
def luby(k):  # type: ignore[no-untyped-def]
    """Return term k, from 1 on, of 1 1 2 1 1 2 4 … (Luby, Sinclair and Zuckerman 1993)."""
    while True:
        power = 1
        while (1 << power) - 1 < k:
            power += 1
        if (1 << power) - 1 == k:
            return 1 << (power - 1)
        k -= (1 << (power - 1)) - 1


@loop
def _hull(edge, mask, algebra, memory):  # type: ignore[no-untyped-def]
    """Return the least tractable relation that contains ``mask``; ``mask`` itself if only atoms are tractable."""
    if not algebra.hulls.shape[1]:
        return mask
    n = memory.masks.shape[1]
    return np.uint64(algebra.hulls[edge // (n * n), mask])


@loop
def _settled(edge, mask, algebra, memory):  # type: ignore[no-untyped-def]
    if not algebra.hulls.shape[1]:
        return mask & (mask - ONE) == ZERO
    return _hull(edge, mask, algebra, memory) & ~np.uint64(memory.allowed[edge]) == ZERO


@loop
def _weigh(axis, relation, algebra):  # type: ignore[no-untyped-def]
    total, left = 0.0, relation
    while left:
        total += algebra.weights[axis, low_bit(left)]
        left &= left - ONE
    return total


@loop
def _decide(algebra, memory):  # type: ignore[no-untyped-def]
    """Choose a relation for the edge most active for its atoms; return the candidates examined, -1 if none is left."""
    counts = memory.counts
    start = memory.cursors[counts[LEVEL]]
    best, best_score, front, seen, c = -1, -1.0, -1, 0, start
    while c < len(memory.candidates) and seen < MAX_SCANNED:
        edge = memory.candidates[c]
        mask = _mask(edge, memory)
        if not _settled(edge, mask, algebra, memory):
            if front < 0:
                front = c
            seen += 1
            score = (memory.activity[edge] + memory.increment[0]) / _atoms(mask)
            if score > best_score:
                best, best_score = edge, score
        c += 1
    if front < 0:
        front = c
    forbidden = ZERO
    nogood = 0
    while best < 0 and nogood < counts[STATED]:
        best, forbidden = _alternative(nogood, algebra, memory)
        nogood += 1
    if best < 0:
        return -1
    counts[LEVEL] += 1
    counts[DECISIONS] += 1
    memory.starts[counts[LEVEL]] = counts[LENGTH]
    memory.cursors[counts[LEVEL]] = front
    allowed = np.uint64(memory.allowed[best]) & ~forbidden
    _narrow(best, _choice(best, allowed, algebra, memory), DECISION, algebra, memory)
    return c - start + nogood


@loop
def _alternative(nogood, algebra, memory):  # type: ignore[no-untyped-def]
    """Return the premise of a stated nogood to decide against, as edge and relation; edge -1 if one is false."""
    best, best_score, relation = -1, -1.0, ZERO
    for position in range(memory.begins[nogood], memory.begins[nogood + 1]):
        edge, wanted = memory.premise_edges[position], np.uint64(memory.premise_masks[position])
        mask = _mask(edge, memory)
        if not _hull(edge, mask, algebra, memory) & wanted:
            return -1, ZERO
        if mask & ~wanted:
            score = (memory.activity[edge] + memory.increment[0]) / _atoms(mask & ~wanted)
            if score > best_score:
                best, best_score, relation = edge, score, wanted
    return best, relation


@loop
def _choice(edge, allowed, algebra, memory):  # type: ignore[no-untyped-def]
    """Return the relation to decide: within the last one tried, otherwise the tractable one or atom of most weight."""
    n = memory.masks.shape[1]
    axis, mask, tried = edge // (n * n), _mask(edge, memory), np.uint64(memory.tried[edge])
    if mask & tried and not tried & ~allowed:
        return mask & tried
    most, best = 0.0, ZERO
    if algebra.hulls.shape[1]:
        for t in range(algebra.tractable.shape[1]):
            tractable = np.uint64(algebra.tractable[axis, t])
            if mask & tractable and not tractable & ~allowed:
                weight = _weigh(axis, mask & tractable, algebra)
                if weight > most:
                    most, best = weight, tractable
    else:
        left = mask & allowed
        while left:
            atom = left & ~(left - ONE)
            left &= left - ONE
            weight = _weigh(axis, atom, algebra)
            if weight > most:
                most, best = weight, atom
    memory.tried[edge] = best
    return mask & best


@kernel(lambda algebra, memory: 5 * memory.masks.size, _nrt=False)
def queue_edges(algebra, memory):  # type: ignore[no-untyped-def]
    """Queue all stated edges for propagation, before the first search of a network that is not closed."""
    axes, n, _ = memory.masks.shape
    for axis in range(axes):
        for i in range(n):
            for k in range(i + 1, n):
                relation = np.uint64(memory.masks[axis, i, k])
                if relation != algebra.full[axis]:
                    _enqueue((axis * n + i) * n + k, relation, memory)
    _forget(algebra, memory)


@loop
def search(budget, changed, lefts, algebra, memory):  # type: ignore[no-untyped-def]
    """Search for ``budget`` look-ups; return CONSISTENT, INCONSISTENT, PAUSED, TRAIL_FULL or NOGOODS_FULL."""
    counts = memory.counts
    n = memory.masks.shape[1]
    while True:
        if counts[CONFLICT] >= 0:
            if counts[LEVEL] == 0:
                return INCONSISTENT
            if counts[NOGOODS] + 2 > len(memory.levels) or counts[PREMISES] + min(
                counts[LENGTH], len(memory.latest)
            ) + 2 > len(memory.premise_edges):
                return NOGOODS_FULL
            _learn(algebra, memory)
            counts[UNTIL_RESTART] -= 1
            memory.increment[0] *= ACTIVITY_GROWTH
            if memory.increment[0] > MAX_ACTIVITY:
                for edge in range(len(memory.activity)):
                    memory.activity[edge] /= MAX_ACTIVITY
                memory.increment[0] /= MAX_ACTIVITY
            continue
        if budget <= 0:
            return PAUSED
        if counts[LENGTH] + 2 * n + counts[NOGOODS] + 2 > len(memory.edges):
            return TRAIL_FULL
        if counts[SEEN] < counts[LENGTH]:
            edge = memory.edges[counts[SEEN]]
            counts[SEEN] += 1
            budget -= _tell_nogoods(edge, algebra, memory)
            continue
        edge = _dequeue(memory)
        if edge >= 0:
            _pass_on(edge, changed, lefts, algebra, memory)
            budget -= 2 * n
            continue
        if counts[LEVEL] == 0:
            for at in range(counts[LENGTH]):
                memory.latest[memory.edges[at]] = -1
            counts[LENGTH] = counts[SEEN] = 0
        if counts[UNTIL_RESTART] <= 0:
            counts[RESTARTS] += 1
            counts[UNTIL_RESTART] = RESTART_UNIT * luby(counts[RESTARTS])
            _back_to(0, algebra, memory)
            if counts[RESTARTS] > 1:
                _forget(algebra, memory)
            continue
        scanned = _decide(algebra, memory)
        if scanned < 0:
            return CONSISTENT
        budget -= scanned
