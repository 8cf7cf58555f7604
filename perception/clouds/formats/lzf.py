"""Compiled LZF, the compression of binary_compressed PCD files (the format of Lehmann's liblzf).

A control byte c below 32 is followed by c + 1 literal bytes. Any other control byte starts a back-reference: its upper
three bits are the length minus 2, extended by another byte if all three are set; its lower five bits and the next byte
are the distance minus 1.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

MAX_EXPANSION = 88
"""Maximum ratio of plain to packed bytes: a back-reference of 3 bytes stands for at most 264."""

_HASH_BITS = 14
_MAX_PLAIN, _MAX_REPEATED, _MAX_DISTANCE = 32, 264, 8192
_Bytes = NDArray[np.uint8]


@njit(cache=True)
def decompress(packed: _Bytes, out: _Bytes) -> tuple[int, int]:
    """Fill ``out`` and return the numbers of bytes read and written; both stop at the first damaged byte."""
    read = written = 0
    while read < len(packed):
        control = int(packed[read])
        if control < 32:
            length = control + 1
            if read + 1 + length > len(packed) or written + length > len(out):
                break
            for place in range(length):
                out[written + place] = packed[read + 1 + place]
            read += 1 + length
        else:
            length = control >> 5
            size = 3 if length == 7 else 2
            if read + size > len(packed):
                break
            if size == 3:
                length += int(packed[read + 1])
            length += 2
            source = written - ((control & 31) << 8) - int(packed[read + size - 1]) - 1
            if source < 0 or written + length > len(out):
                break
            for place in range(length):
                out[written + place] = out[source + place]
            read += size
        written += length
    return read, written


@njit(cache=True)
def compress(plain: _Bytes) -> _Bytes:
    """Pack bytes greedily: three bytes that occurred within the last 8192 bytes become a back-reference."""
    n = len(plain)
    out = np.empty(n + n // _MAX_PLAIN + 4, np.uint8)
    last = np.full(1 << _HASH_BITS, -1, np.int64)
    at = begin = size = 0
    while at < n:
        length = distance = 0
        if at + 2 < n:
            key = (int(plain[at]) << 16) | (int(plain[at + 1]) << 8) | int(plain[at + 2])
            place = ((key * 2654435761) >> 12) & ((1 << _HASH_BITS) - 1)
            source = last[place]
            last[place] = at
            if source >= 0 and at - source <= _MAX_DISTANCE:
                while length < _MAX_REPEATED and at + length < n and plain[source + length] == plain[at + length]:
                    length += 1
                distance = at - source - 1
        if length < 3:
            at += 1
            if at - begin == _MAX_PLAIN:
                size = _put_plain(plain, begin, at, out, size)
                begin = at
            continue
        size = _put_plain(plain, begin, at, out, size)
        if length - 2 < 7:
            out[size] = ((length - 2) << 5) | (distance >> 8)
        else:
            out[size] = (7 << 5) | (distance >> 8)
            size += 1
            out[size] = length - 9
        out[size + 1] = distance & 255
        size += 2
        at += length
        begin = at
    return out[: _put_plain(plain, begin, n, out, size)]


@njit(cache=True)
def _put_plain(plain: _Bytes, begin: int, end: int, out: _Bytes, size: int) -> int:
    """Write 0 to 32 literal bytes after their control byte, and return the new size."""
    if end > begin:
        out[size] = end - begin - 1
        size += 1
        for place in range(begin, end):
            out[size] = plain[place]
            size += 1
    return size
