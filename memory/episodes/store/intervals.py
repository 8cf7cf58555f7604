"""Index of intervals of time in an ordered store, whose queries cost the same however many intervals it holds.

Each interval is registered at one node of a binary tree over all times that is never built: the highest node that lies
in the interval (Kriegel, Pötke and Seidl 2000, *Managing intervals efficiently in object-relational databases*). Two
keys per interval hold the node with the lower end, and the node with the upper end. An interval meets a window if its
node lies in the window, or if its node lies on the path from the root to one end of the window and its own end reaches
into it. So a query reads one range of keys per node of the two paths, at most 107, and one range for the window itself.

Times are whole microseconds, shifted so that they are at least 1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from deixis.memory.episodes.store.keys import Keys
from deixis.reasoning.temporal.bounds import TICKS

BITS = 53
"""Height of the tree: times lie below 2 ** BITS."""

_OFFSET = 1 << (BITS - 1)
_LAST = (1 << BITS) - 1


def tick(seconds: float) -> int:
    """Return a time as a position in the tree.

    Parameters
    ----------
    seconds
        Seconds since the origin; may be infinite.

    Returns
    -------
    int
        Microseconds, shifted and limited to [1, 2 ** BITS).
    """
    if math.isinf(seconds):
        return 1 if seconds < 0 else _LAST
    return min(max(round(seconds * TICKS) + _OFFSET, 1), _LAST)


def fork(lower: int, upper: int) -> int:
    """Return the highest node of the tree in an interval.

    Parameters
    ----------
    lower, upper
        Ends of the interval, at least 1, which belong to it.

    Returns
    -------
    int
        The node: the number in the interval that is divisible by the highest power of 2.

    Examples
    --------
    >>> fork(5, 11), fork(3, 3), fork(1, 7), fork(4, 7)
    (8, 3, 4, 4)
    """
    low_bits = ((lower - 1) ^ upper).bit_length() - 1
    return upper >> low_bits << low_bits


def interval_keys(start: float, finish: float, ending: bytes) -> tuple[bytes, bytes]:
    """Return the two keys of an interval from a start, which belongs to it, to a finish, which does not.

    Parameters
    ----------
    start, finish
        Earliest start and latest finish in seconds; may be infinite.
    ending
        Last part of the keys, which tells apart equal intervals.

    Returns
    -------
    tuple of bytes
        The key with the lower end, and the key with the upper end.
    """
    lower = tick(start)
    upper = max(lower, tick(finish) - 1) if math.isfinite(finish) else _LAST
    node = fork(lower, upper)
    return _key(b"<", node, lower) + ending, _key(b">", node, upper) + ending


def endings_meeting(keys: Keys, start: float, end: float) -> Iterator[bytes]:
    """Yield the endings of the intervals that meet a window, each once, in no particular order.

    Parameters
    ----------
    keys
        The store with the keys of the intervals.
    start, end
        Ends of the window in seconds, which belong to it; may be infinite.

    Yields
    ------
    bytes
        What :func:`interval_keys` was given as ``ending``.
    """
    first, last = tick(start), tick(end)
    for node in _path(first):
        if node < first:
            yield from _endings(keys, _key(b">", node, first), _after(b">", node))
    yield from _endings(keys, _key(b"<", first, 0), _after(b"<", last))
    for node in _path(last):
        if node > last:
            yield from _endings(keys, _key(b"<", node, 0), _key(b"<", node, last + 1))


def _path(position: int) -> Iterator[int]:
    """Yield the nodes from the root down to a position, without the position itself."""
    node, step = 1 << (BITS - 1), 1 << (BITS - 2)
    while node != position and step:
        yield node
        node += step if position > node else -step
        step >>= 1
    if node != position:
        yield node


def _key(kind: bytes, node: int, end: int) -> bytes:
    return kind + node.to_bytes(7, "big") + end.to_bytes(7, "big")


def _after(kind: bytes, node: int) -> bytes:
    """Return the smallest key above all keys of a node."""
    return kind + (node + 1).to_bytes(7, "big")


def _endings(keys: Keys, first: bytes, stop: bytes) -> Iterator[bytes]:
    for key in keys.between(first, stop):
        yield key[15:]
