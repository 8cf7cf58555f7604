"""Run algebraic closure in compiled loops for calculi of any size, on bit planes.

A network of n things is ``planes`` (n, words, atoms) of 64-bit words: bit b of ``planes[i, w, a]`` says that atom a is
possible from i to thing 64 w + b. The composition of one relation with a whole row of relations is then an OR of
planes, 64 pairs at a time.

These names are used throughout.

``sizes`` (3,): the number of atoms on each axis, padded by ones in front; an atom's code counts the last axis fastest.

``needs`` (3, bytes, 256, atoms of an axis): for each byte of the left relation and each atom of the result, the right
atoms that give it. In a calculus of one axis and more than 64 atoms it is (words, fours, 16, atoms), for every four
atoms of the left relation, with the right atoms in words.

``converses`` (atoms,): the code of each converse.

``full`` (words,): one bit per thing.

``dirty`` (n, words): the ordered pairs whose change must still be propagated; ``waiting`` (n,): how many of them a row
has.

``clock`` (5,): the current row, the passes done, the emptied pair and the thing that emptied it (-1: none).

``trail`` (room, 4): the removed atoms in order: row, column, atom, and the thing that caused it (-1: stated).

``count`` (1,): the length of the trail, -1 if none is kept.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from deixis.reasoning.kernel import Instruction, kernel

CLOSED, EMPTIED, PAUSED, FULL = 0, 1, 2, 3

ONE = np.uint64(1)
NONE = np.uint64(0)


def _trailing_zeros() -> Any:
    """Return numba's intrinsic for the instruction of the processor that counts trailing zeros."""
    from numba import types
    from numba.extending import intrinsic

    @intrinsic
    def trailing_zeros(typing, word):  # type: ignore[no-untyped-def]
        def generate(context, builder, signature, arguments):  # type: ignore[no-untyped-def]
            return builder.cttz(arguments[0], context.get_constant(types.boolean, True))

        return types.uint64(types.uint64), generate

    return trailing_zeros


def _low_bit(word):  # type: ignore[no-untyped-def]
    """Return the position of the lowest set bit of a word, not 0; unsigned, so that indexing skips the sign test."""
    return (int(word) & -int(word)).bit_length() - 1


low_bit = Instruction(_low_bit, _trailing_zeros)


def _steps(budget, sizes, needs, converses, full, planes, *rest):  # type: ignore[no-untyped-def]
    """Estimate the steps of closure: every pair is propagated several times, to every word of every atom."""
    return 8 * len(planes) * planes.size


@kernel()
def mark(i, k, dirty, waiting):  # type: ignore[no-untyped-def]
    """Queue the pair i, k for propagation, unless it waits already."""
    bit = ONE << np.uint64(k & 63)
    if i != k and not dirty[i, k >> 6] & bit:
        dirty[i, k >> 6] |= bit
        waiting[i] += 1


@kernel(lambda i, k, count, trail, needed: count)
def support(i, k, count, trail, needed):  # type: ignore[no-untyped-def]
    """Mark in ``needed`` (n, n) the pairs on which the relation of i and k rests, going back through the trail."""
    needed[min(i, k), max(i, k)] = True
    for m in range(count - 1, -1, -1):
        a, b, by = trail[m, 0], trail[m, 1], trail[m, 3]
        if by >= 0 and needed[min(a, b), max(a, b)]:
            needed[min(a, by), max(a, by)] = True
            needed[min(b, by), max(b, by)] = True


@kernel()
def may(planes, i, atom, k):  # type: ignore[no-untyped-def]
    """Return 1 if an atom is possible from i to k, otherwise 0."""
    return planes[i, k >> 6, atom] >> np.uint64(k & 63) & ONE


@kernel()
def empty(planes, i, k):  # type: ignore[no-untyped-def]
    """Return True if no atom is possible from i to k."""
    left = NONE
    for atom in range(planes.shape[2]):
        left |= may(planes, i, atom, k)
    return left == NONE


@kernel()
def _take(i, k, atom, by, planes, converses, trail, count):  # type: ignore[no-untyped-def]
    """Remove an atom from a pair, seen from both things."""
    planes[i, k >> 6, atom] &= ~(ONE << np.uint64(k & 63))
    planes[k, i >> 6, converses[atom]] &= ~(ONE << np.uint64(i & 63))
    if count[0] >= 0:
        trail[count[0], 0] = i
        trail[count[0], 1] = k
        trail[count[0], 2] = atom
        trail[count[0], 3] = by
        count[0] += 1


@kernel(lambda firsts, *rest: len(firsts) * rest[4].shape[2])
def restrict(firsts, seconds, ids, masks, start, planes, converses, dirty, waiting, clock, trail, count):  # type: ignore[no-untyped-def]
    """Intersect pairs with relations, from constraint ``start`` on; return the first constraint not dealt with.

    ``masks`` (relations, 64-bit words) holds the relations; the loop ends at the first constraint that empties its
    pair.
    """
    atoms = planes.shape[2]
    for m in range(start, len(firsts)):
        if count[0] >= 0 and count[0] + atoms > len(trail):
            return m
        i, k = firsts[m], seconds[m]
        changed = False
        for atom in range(atoms):
            kept = masks[ids[m], atom >> 6] >> np.uint64(atom & 63) & ONE
            if not kept and may(planes, i, atom, k):
                _take(i, k, atom, -1, planes, converses, trail, count)
                changed = True
        if changed:
            mark(i, k, dirty, waiting)
            mark(k, i, dirty, waiting)
            if empty(planes, i, k):
                clock[2], clock[3], clock[4] = i, k, -1
                return len(firsts)
    return len(firsts)


@kernel(_steps)
def advance(  # type: ignore[no-untyped-def]
    budget, sizes, needs, converses, full, planes, dirty, waiting, clock, trail, count
):
    """Propagate ``budget`` changes; return CLOSED, EMPTIED, PAUSED (budget spent) or FULL (no room in the trail)."""
    n, words, atoms = planes.shape
    changed = np.zeros(words, dtype=np.uint64)
    removed = np.zeros((words, atoms), dtype=np.uint64)
    scratch = np.zeros((3, atoms), dtype=np.uint64)
    boxes = np.zeros((max(1, sizes[0] * sizes[1]), 3), dtype=np.uint64)
    required = np.zeros((max(3, (sizes.max() + 63) >> 6), sizes.max()), dtype=np.uint64)
    idle = 0
    while idle <= n:
        i = clock[0]
        if waiting[i] == 0:
            clock[0] = i + 1 if i + 1 < n else 0
            idle += 1
            continue
        idle = 0
        for w in range(words):
            while dirty[i, w]:
                if budget <= 0:
                    return PAUSED
                if count[0] >= 0 and count[0] + n * atoms > len(trail):
                    return FULL
                j = (w << 6) + int(low_bit(dirty[i, w]))
                dirty[i, w] &= dirty[i, w] - ONE
                waiting[i] -= 1
                budget -= 1
                clock[1] += 1
                if atoms == sizes[2] and atoms > 64:
                    some = _remove_wide(i, j, needs, planes, required, removed)
                elif atoms == sizes[2]:
                    some = _remove_table(i, j, needs, planes, required, removed)
                else:
                    some = _remove_product(i, j, sizes, needs, planes, required, boxes, scratch, removed)
                if some and not _apply(
                    i, j, removed, converses, full, planes, dirty, waiting, clock, changed, trail, count
                ):
                    return EMPTIED
    return CLOSED


@kernel()
def _require(relation, axis, size, needs, required):  # type: ignore[no-untyped-def]
    """Set for each atom of the result the right atoms that give it together with some atom of ``relation``."""
    for c in range(size):
        required[axis, c] = NONE
    for byte in range((size + 7) >> 3):
        value = (relation >> np.uint64(8 * byte)) & np.uint64(255)
        if value:
            row = needs[axis, byte, value]
            for c in range(size):
                required[axis, c] |= row[c]


@kernel()
def _remove_table(i, j, needs, planes, required, removed):  # type: ignore[no-untyped-def]
    """Set removed[a] to the things k for which j excludes atom a from i to k; return False if there are no such things.

    Most atoms remain, and the first few of the right atoms usually show that.
    """
    _, words, atoms = planes.shape
    relation = NONE
    for atom in range(atoms):
        relation |= may(planes, i, atom, j) << np.uint64(atom)
    _require(relation, 2, atoms, needs, required)
    found = NONE
    for w in range(words):
        mine, others = planes[i, w], planes[j, w]
        for c in range(atoms):
            gone, needed = mine[c], required[2, c]
            while gone and needed:
                gone &= ~others[low_bit(needed)]
                needed &= needed - ONE
            removed[w, c] = gone
            found |= gone
    return found != NONE


@kernel()
def _remove_wide(i, j, needs, planes, required, removed):  # type: ignore[no-untyped-def]
    """Set ``removed`` for more than 64 atoms: the right atoms take several words of ``required``."""
    _, words, atoms = planes.shape
    parts = len(needs)
    required[:parts] = NONE
    for four in range(needs.shape[1]):
        value = 0
        for bit in range(min(4, atoms - 4 * four)):
            value |= int(may(planes, i, 4 * four + bit, j)) << bit
        if value:
            for part in range(parts):
                row = needs[part, four, value]
                for c in range(atoms):
                    required[part, c] |= row[c]
    found = NONE
    for w in range(words):
        mine, others = planes[i, w], planes[j, w]
        for c in range(atoms):
            gone = mine[c]
            for part in range(parts):
                needed = required[part, c]
                while gone and needed:
                    gone &= ~others[(part << 6) + int(low_bit(needed))]
                    needed &= needed - ONE
            removed[w, c] = gone
            found |= gone
    return found != NONE


@kernel()
def _remove_product(i, j, sizes, needs, planes, required, boxes, scratch, removed):  # type: ignore[no-untyped-def]
    """Set ``removed`` for a product calculus: box by box of i's relation to j, and for each box axis by axis."""
    _, words, atoms = planes.shape
    removed[:] = planes[i]
    for box in range(_boxes(i, j, sizes, planes, boxes)):
        for axis in range(3):
            if sizes[axis] > 1:
                _require(boxes[box, axis], axis, sizes[axis], needs, required)
        for w in range(words):
            now, before = planes[j, w], 1
            for axis in range(3):
                size = sizes[axis]
                if size > 1:
                    _compose_axis(now, required[axis], before, size, atoms // (before * size), scratch[axis])
                    now = scratch[axis]
                before *= size
            for atom in range(atoms):
                removed[w, atom] &= ~now[atom]
    return True


@kernel()
def _compose_axis(given, required, before, size, after, out):  # type: ignore[no-untyped-def]
    """Compose on one axis: ``given`` and ``out`` (atoms,) hold the things of one word for every atom."""
    for outer in range(before):
        for c in range(size):
            target = (outer * size + c) * after
            out[target : target + after] = NONE
            needed = required[c]
            while needed:
                source = (outer * size + int(low_bit(needed))) * after
                needed &= needed - ONE
                for k in range(after):
                    out[target + k] |= given[source + k]


@kernel()
def _boxes(i, j, sizes, planes, boxes):  # type: ignore[no-untyped-def]
    """Write the relation of i to j as a disjoint union of products; return how many."""
    rows = np.zeros((sizes[0], sizes[1]), dtype=np.uint64)
    for a in range(sizes[0]):
        for b in range(sizes[1]):
            for c in range(sizes[2]):
                rows[a, b] |= may(planes, i, (a * sizes[1] + b) * sizes[2] + c, j) << np.uint64(c)
    found = 0
    for a in range(sizes[0]):
        first = _alike(rows, a)
        if first == NONE:
            continue
        for b in range(sizes[1]):
            row, second, seen = rows[a, b], NONE, row_seen(rows[a], b)
            if row and not seen:
                for other in range(b, sizes[1]):
                    if rows[a, other] == row:
                        second |= ONE << np.uint64(other)
                boxes[found, 0], boxes[found, 1], boxes[found, 2] = first, second, row
                found += 1
    return found


@kernel()
def row_seen(row, position):  # type: ignore[no-untyped-def]
    """Return True if the row at ``position`` equals an earlier one."""
    return (row[:position] == row[position]).any()


@kernel()
def _alike(rows, a):  # type: ignore[no-untyped-def]
    """Return the slabs equal to slab a; 0 if an earlier slab is equal to it."""
    alike = NONE
    for other in range(len(rows)):
        if (rows[other] == rows[a]).all():
            if other < a:
                return NONE
            alike |= ONE << np.uint64(other)
    return alike


@kernel()
def _apply(i, j, removed, converses, full, planes, dirty, waiting, clock, changed, trail, count):  # type: ignore[no-untyped-def]
    """Remove from row i what j excludes, and mark what changed; return False if a pair is emptied."""
    _, words, atoms = planes.shape
    changed[:] = NONE
    for w in range(words):
        for atom in range(atoms):
            gone = removed[w, atom]
            changed[w] |= gone
            while gone:
                _take(i, (w << 6) + int(low_bit(gone)), atom, j, planes, converses, trail, count)
                gone &= gone - ONE
    for w in range(words):
        if not changed[w]:
            continue
        alive = NONE
        for atom in range(atoms):
            alive |= planes[i, w, atom]
        if alive != full[w]:
            clock[2], clock[3], clock[4] = i, (w << 6) + int(low_bit(full[w] & ~alive)), j
            return False
        left = changed[w]
        while left:
            k = (w << 6) + int(low_bit(left))
            left &= left - ONE
            mark(i, k, dirty, waiting)
            mark(k, i, dirty, waiting)
    return True


@kernel()
def undo(length, converses, planes, dirty, waiting, clock, trail, count):  # type: ignore[no-untyped-def]
    """Restore the atoms removed since the trail had that length, when the network was closed."""
    for m in range(count[0] - 1, length - 1, -1):
        i, k, atom = trail[m, 0], trail[m, 1], trail[m, 2]
        planes[i, k >> 6, atom] |= ONE << np.uint64(k & 63)
        planes[k, i >> 6, converses[atom]] |= ONE << np.uint64(i & 63)
    count[0] = length
    dirty[:] = NONE
    waiting[:] = 0
    clock[2:] = -1


@kernel()
def lightest(planes, weights):  # type: ignore[no-untyped-def]
    """Return the undecided pair i < k with the fewest atoms for its weight, as i * n + k; -1 if all are decided."""
    n, _, atoms = planes.shape
    best, best_score = -1, np.inf
    for i in range(n):
        for k in range(i + 1, n):
            left = 0
            for atom in range(atoms):
                left += int(may(planes, i, atom, k))
            if left > 1 and left / weights[i, k] < best_score:
                best, best_score = i * n + k, left / weights[i, k]
    return best


@kernel()
def relations(planes, out):  # type: ignore[no-untyped-def]
    """Write every pair's relation, (n, n, 64-bit words of atoms)."""
    n, words, atoms = planes.shape
    out[:] = NONE
    for i in range(n):
        for atom in range(atoms):
            bit = ONE << np.uint64(atom & 63)
            for w in range(words):
                left = planes[i, w, atom]
                while left:
                    out[i, (w << 6) + int(low_bit(left)), atom >> 6] |= bit
                    left &= left - ONE
