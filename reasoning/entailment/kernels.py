"""The compiled loops under :mod:`deixis.reasoning.entailment.closed`, on plain arrays.

A graph of points is in rows: the edges out of point u are ``first[u]:first[u + 1]`` of ``heads`` and ``strict``. A row
of bits holds points of one group: bit b of word w is point 64 w + b.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def rows_of(tails, n):  # type: ignore[no-untyped-def]
    """Where each point's edges begin, shape (n + 1,), and the edges in the order of their tails."""
    first = np.zeros(n + 1, np.int64)
    for u in tails:
        first[u + 1] += 1
    for u in range(n):
        first[u + 1] += first[u]
    place = first[:-1].copy()
    order = np.empty(len(tails), np.int64)
    for edge in range(len(tails)):
        u = tails[edge]
        order[place[u]] = edge
        place[u] += 1
    return first, order


@njit(cache=True)
def connected(first_ends, second_ends, n):  # type: ignore[no-untyped-def]
    """The connected part of each of n nodes, numbered in the order of their least nodes."""
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


@njit(cache=True)
def strong_parts(first, heads):  # type: ignore[no-untyped-def]
    """Strongly connected parts (Tarjan 1972, without recursion), numbered so that edges lead to lower numbers.

    Returns the part of each point, and the points in the order of their parts.
    """
    n = len(first) - 1
    index = np.full(n, -1, np.int64)
    low = np.zeros(n, np.int64)
    part = np.full(n, -1, np.int64)
    members = np.empty(n, np.int64)
    stack = np.empty(n, np.int64)
    calls = np.empty(n, np.int64)
    place = first[:-1].copy()
    height, listed, parts, counter = 0, 0, 0, 0
    for root in range(n):
        if index[root] >= 0:
            continue
        depth = 0
        calls[0] = root
        index[root] = low[root] = counter
        counter += 1
        stack[height] = root
        height += 1
        while depth >= 0:
            u = calls[depth]
            if place[u] < first[u + 1]:
                v = heads[place[u]]
                place[u] += 1
                if index[v] < 0:
                    index[v] = low[v] = counter
                    counter += 1
                    stack[height] = v
                    height += 1
                    depth += 1
                    calls[depth] = v
                elif part[v] < 0 and index[v] < low[u]:
                    low[u] = index[v]
                continue
            if low[u] == index[u]:
                while True:
                    height -= 1
                    v = stack[height]
                    part[v] = parts
                    members[listed] = v
                    listed += 1
                    if v == u:
                        break
                parts += 1
            depth -= 1
            if depth >= 0 and low[u] < low[calls[depth]]:
                low[calls[depth]] = low[u]
    return part, members


@njit(cache=True)
def strict_within(first, heads, strict, part):  # type: ignore[no-untyped-def]
    """A strict edge whose ends are forced to be equal: its tail, or -1 where there is none."""
    for u in range(len(first) - 1):
        for edge in range(first[u], first[u + 1]):
            if strict[edge] and part[heads[edge]] == part[u]:
                return u
    return -1


@njit(cache=True)
def close(first, heads, strict, part, members, bit, start, width, weak, strong):  # type: ignore[no-untyped-def]
    """Fills the bit rows of what lies not before (``weak``) and after (``strong``) each point.

    ``bit[u]`` is point u's place in its group's rows, ``start[u]`` where its row begins in the flat arrays,
    ``width[u]`` its length in words. Parts are taken in the order of ``members``, so that what they lead to is
    complete.
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


@njit(cache=True)
def and_block(target, rows, sizes, target_start, rows_start, row_side, column_side, transposed):  # type: ignore[no-untyped-def]
    """Intersects each group's (objects, objects) bit matrix with a block of its (points, points) one.

    The block's rows are the low (0) or high (1) edges, as are its columns; ``transposed`` exchanges the two.
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


@njit(cache=True)
def clear_diagonal(target, sizes, target_start):  # type: ignore[no-untyped-def]
    for group in range(len(sizes)):
        words = (sizes[group] + 63) >> 6
        for i in range(sizes[group]):
            target[target_start[group] + i * words + (i >> 6)] &= ~(np.uint64(1) << np.uint64(i & 63))


@njit(cache=True)
def count_bits(target):  # type: ignore[no-untyped-def]
    total = 0
    for bits in target:
        while bits:
            bits &= bits - np.uint64(1)
            total += 1
    return total


@njit(cache=True)
def list_pairs(target, sizes, target_start, objects_start, nodes, pairs):  # type: ignore[no-untyped-def]
    """Writes the pairs of a flat bit matrix as node numbers into ``pairs``, by group and row."""
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
