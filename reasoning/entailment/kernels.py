"""Compiled loops of :mod:`deixis.reasoning.entailment.closed`, on plain arrays.

A graph of points is in rows, as in :mod:`deixis.reasoning.constraints.path_kernels`. A row of bits has the points of
one group: bit b of word w is point 64 w + b.
"""

from __future__ import annotations

import numpy as np

from deixis.reasoning.kernel import kernel


@kernel()
def connected(first_ends, second_ends, n):  # type: ignore[no-untyped-def]
    """Return the connected component of each of n nodes, numbered in the order of their smallest nodes."""
    parent = np.arange(n)
    for k in range(len(first_ends)):
        a, b = first_ends[k], second_ends[k]
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    label = np.empty(n, np.int64)
    count = 0
    for node in range(n):
        if parent[node] == node:
            label[node] = count
            count += 1
        else:
            root = parent[node]
            while parent[root] != root:
                root = parent[root]
            label[node] = label[root]
    return label, count


@kernel()
def close(first, heads, strict, part, members, bit, start, width, weak, strong):  # type: ignore[no-untyped-def]
    """Fill the bit rows of the points that are not before (``weak``) and after (``strong``) each point.

    ``bit[u]`` is the position of point u in the rows of its group, ``start[u]`` the start of its row in the flat
    arrays, and ``width[u]`` its length in words. Components are taken in the order of ``members``, so that
    their successors are complete.
    """
    n = len(members)
    begin = 0
    while begin < n:
        end = begin
        here = part[members[begin]]
        while end < n and part[members[end]] == here:
            end += 1
        leader = members[begin]
        row, words = start[leader], width[leader]
        for k in range(begin, end):
            u = members[k]
            weak[row + (bit[u] >> 6)] |= np.uint64(1) << np.uint64(bit[u] & 63)
        for k in range(begin, end):
            u = members[k]
            for edge in range(first[u], first[u + 1]):
                v = heads[edge]
                other = start[v]
                if part[v] == here:
                    continue
                for w in range(words):
                    weak[row + w] |= weak[other + w]
                    strong[row + w] |= weak[other + w] if strict[edge] else strong[other + w]
        for k in range(begin + 1, end):
            u = start[members[k]]
            for w in range(words):
                weak[u + w] = weak[row + w]
                strong[u + w] = strong[row + w]
        begin = end


@kernel()
def and_block(target, rows, sizes, target_start, rows_start, row_side, column_side, transposed):  # type: ignore[no-untyped-def]
    """Intersect each group's (objects, objects) bit matrix with a block of its (points, points) one.

    The rows of the block are the low (0) or high (1) edges, and so are its columns; ``transposed`` exchanges the two.
    """
    one = np.uint64(1)
    for group in range(len(sizes)):
        n = sizes[group]
        words = (n + 63) >> 6
        begin, source = target_start[group], rows_start[group]
        if not transposed:
            for i in range(n):
                row = source + (row_side * n + i) * 2 * words + column_side * words
                for w in range(words):
                    target[begin + i * words + w] &= rows[row + w]
            continue
        block = np.zeros(n * words, np.uint64)
        for i in range(n):
            row = source + (row_side * n + i) * 2 * words + column_side * words
            word, mask = i >> 6, one << np.uint64(i & 63)
            for w in range(words):
                bits = rows[row + w]
                j = 64 * w
                while bits:
                    if bits & np.uint64(0xFFFFFFFF) == 0:
                        bits >>= np.uint64(32)
                        j += 32
                        continue
                    if bits & one:
                        block[j * words + word] |= mask
                    bits >>= one
                    j += 1
        for k in range(n * words):
            target[begin + k] &= block[k]


@kernel()
def clear_diagonal(target, sizes, target_start):  # type: ignore[no-untyped-def]
    """Clear the diagonal of each group's bit matrix."""
    for group in range(len(sizes)):
        words = (sizes[group] + 63) >> 6
        for i in range(sizes[group]):
            target[target_start[group] + i * words + (i >> 6)] &= ~(np.uint64(1) << np.uint64(i & 63))


@kernel()
def count_bits(target):  # type: ignore[no-untyped-def]
    """Return the number of bits that are set."""
    total = 0
    for bits in target:
        while bits:
            bits &= bits - np.uint64(1)
            total += 1
    return total


@kernel()
def list_pairs(target, sizes, target_start, objects_start, nodes, pairs):  # type: ignore[no-untyped-def]
    """Write the pairs in a flat bit matrix as node numbers into ``pairs``, by group and row."""
    found = 0
    for group in range(len(sizes)):
        n = sizes[group]
        words = (n + 63) >> 6
        for i in range(n):
            row = target_start[group] + i * words
            for w in range(words):
                bits = target[row + w]
                j = 64 * w
                while bits:
                    if bits & np.uint64(1):
                        pairs[found, 0] = nodes[objects_start[group] + i]
                        pairs[found, 1] = nodes[objects_start[group] + j]
                        found += 1
                    bits >>= np.uint64(1)
                    j += 1
