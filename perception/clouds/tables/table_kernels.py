"""Compiled parsers of tables: numbers in text, exact to the last bit, and binary rows with lists.

The kernels return the places of numbers with more than 19 digits or an extreme exponent, and leave those to the caller.
A decimal, w times a power of ten, becomes the nearest double by the algorithm of Eisel and Lemire (D. Lemire, "Number
parsing at a gigabyte per second", Software: Practice and Experience 51, 2021): w is multiplied by the power of five in
128 bits, and the upper bits decide the rounding. If w and the power are small, one operation on exact doubles suffices
(W. D. Clinger, "How to read floating point numbers accurately", 1990).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

DONE, NO_NUMBER, TOO_FEW, TOO_MANY, BAD_LENGTH, TOO_SHORT = range(6)
"""Statuses with which the parsing of a table ends."""
SKIPPED, LISTED, KEPT = -1, -2, -3
"""Roles of columns: skipped; a list preceded by its length, as in PLY; and the one list whose values are wanted."""

_NAN, _INF, _INFINITY = b"NAN", b"INF", b"INFINITY"
_Bytes = NDArray[np.uint8]
MIN_POWER, MAX_POWER = -100, 60
"""Range of powers of ten in which the kernel converts decimals; the caller converts the others."""

_TENS = 10.0 ** np.arange(23)
_32, _LOW, _ONE = np.uint64(32), np.uint64(2**32 - 1), np.uint64(1)
_TO_55_BITS, _BEYOND_55 = np.uint64(9), np.uint64(2**9 - 1)
_MANTISSA_END = np.uint64(2**53)


def _fives() -> NDArray[np.uint64]:
    """Return powers of five, shifted so that the first of 128 bits is set: upper and lower half, shape (powers, 2).

    They are rounded down, except the reciprocals down to -27, which allow ties and are rounded up.
    """
    halves = []
    for power in range(MIN_POWER, MAX_POWER + 1):
        five = 5 ** abs(power)
        size = five.bit_length()
        bits = (five << 128) >> size if power >= 0 else (1 << (size + 127)) // five + (power >= -27)
        halves.append((bits >> 64, bits & (2**64 - 1)))
    return np.array(halves, np.uint64)


_FIVES = _fives()


@njit(cache=True)
def _product(a: np.uint64, b: np.uint64) -> tuple[np.uint64, np.uint64]:
    """Return the upper and lower half of a product in 128 bits."""
    a1, a0, b1, b0 = a >> _32, a & _LOW, b >> _32, b & _LOW
    low, left, right = a0 * b0, a1 * b0, a0 * b1
    middle = (low >> _32) + (left & _LOW) + (right & _LOW)
    high = a1 * b1 + (left >> _32) + (right >> _32) + (middle >> _32)
    return high, (low & _LOW) | (middle << _32)


@njit(cache=True, error_model="numpy")
def nearest(w: np.uint64, power: int) -> float:
    """Return the double nearest to w * 10**power, the even one on a tie.

    ``power`` must lie within MIN_POWER and MAX_POWER.
    """
    if w <= _MANTISSA_END and -22 <= power <= 22:
        ten = float(_TENS[abs(power)])
        return float(w) / ten if power < 0 else float(w) * ten
    shift = 0
    while not w >> np.uint64(63):
        w <<= _ONE
        shift += 1
    high, low = _product(w, _FIVES[power - MIN_POWER, 0])
    if high & _BEYOND_55 == _BEYOND_55:
        more, _ = _product(w, _FIVES[power - MIN_POWER, 1])
        low += more
        if low < more:
            high += _ONE
    upper = high >> np.uint64(63)
    dropped = upper + _TO_55_BITS
    mantissa = high >> dropped
    # A value halfway between two doubles rounds to the even one; ties need a power of five that fits 64 bits.
    if low <= _ONE and -4 <= power <= 23 and mantissa & np.uint64(3) == _ONE and mantissa << dropped == high:
        mantissa -= _ONE
    mantissa = (mantissa + (mantissa & _ONE)) >> _ONE
    # 217706 / 65536 approximates log2(10) well enough for the powers of all doubles.
    exponent = ((217706 * power) >> 16) + 63 + (1 if upper else 0) - shift
    return math.ldexp(float(mantissa), exponent - 52)


@njit(cache=True)
def _is_blank(byte: int) -> bool:
    return byte == 32 or (9 <= byte <= 13)


@njit(cache=True)
def _value_start(text: _Bytes, at: int) -> int:
    """Return the byte at which the next value of this line begins, or -1 if it has no more values."""
    while at < len(text):
        if text[at] > 32:
            return at
        if text[at] != 32 and text[at] != 9:
            break
        at += 1
    return -1


@njit(cache=True)
def _token_end(text: _Bytes, at: int) -> int:
    while at < len(text) and not _is_blank(text[at]):
        at += 1
    return at


@njit(cache=True)
def row_start(text: _Bytes, at: int) -> int:
    """Return the byte at which the next row begins, skipping blank lines and comments (# or //)."""
    while at < len(text):
        if _is_blank(text[at]):
            at += 1
        elif text[at] == 35 or (text[at] == 47 and at + 1 < len(text) and text[at + 1] == 47):
            while at < len(text) and text[at] != 10:
                at += 1
        else:
            break
    return at


@njit(cache=True)
def count_rows(text: _Bytes, at: int) -> int:
    """Return the number of rows from byte ``at`` on."""
    rows = 0
    at = row_start(text, at)
    while at < len(text):
        rows += 1
        while at < len(text) and text[at] != 10 and text[at] != 13:
            at += 1
        at = row_start(text, at)
    return rows


@njit(cache=True)
def _spells(text: _Bytes, at: int, word: bytes) -> bool:
    """Return True if the text at ``at`` spells ``word`` (in capitals), ignoring case."""
    if at + len(word) > len(text):
        return False
    same = True
    for place in range(len(word)):
        same = same and text[at + place] & 223 == word[place]
    return same


@njit(cache=True)
def _word_at(text: _Bytes, at: int) -> tuple[float, int]:
    """Return the value and end of nan, inf or infinity, ignoring case; for other text the end is ``at``."""
    if _spells(text, at, _NAN):
        return np.nan, at + len(_NAN)
    if _spells(text, at, _INFINITY):
        return np.inf, at + len(_INFINITY)
    if _spells(text, at, _INF):
        return np.inf, at + len(_INF)
    return 0.0, at


@njit(cache=True)
def _exponent_at(text: _Bytes, at: int) -> tuple[int, int]:
    """Return the integer after an e, and its end; the end is ``at`` if there is no integer."""
    begin = at
    negative = at < len(text) and text[at] == 45
    if at < len(text) and (text[at] == 45 or text[at] == 43):
        at += 1
    digits = at
    power = 0
    while at < len(text) and 48 <= text[at] <= 57:
        power = min(power * 10 + (text[at] - 48), 100_000)
        at += 1
    return (-power if negative else power), (begin if at == digits else at)


@njit(cache=True, error_model="numpy")
def _number_at(text: _Bytes, at: int) -> tuple[float, int, bool]:
    """Return the value of a number, its end (``at`` if there is no number), and True if the value is exact."""
    begin = at
    negative = at < len(text) and text[at] == 45
    if at < len(text) and (text[at] == 45 or text[at] == 43):
        at += 1
    mantissa = power = point = 0
    first = at
    while at < len(text) and 48 <= text[at] <= 57:
        mantissa = mantissa * 10 + (text[at] - 48)
        at += 1
    if at < len(text) and text[at] == 46:
        point = 1
        at += 1
        fraction = at
        while at < len(text) and 48 <= text[at] <= 57:
            mantissa = mantissa * 10 + (text[at] - 48)
            at += 1
        power = fraction - at
    digits = at - first - point
    if not digits:
        value, stop = (0.0, at) if point else _word_at(text, at)
        return (-value if negative else value), (begin if stop == at else stop), True
    if at < len(text) and (text[at] == 101 or text[at] == 69):
        more, stop = _exponent_at(text, at + 1)
        if stop == at + 1:
            return 0.0, begin, True
        power, at = power + more, stop
    # 19 digits fit 64 bits.
    exact = digits <= 19 and MIN_POWER <= power <= MAX_POWER
    value = nearest(np.uint64(mantissa), power) if exact and mantissa else 0.0
    return (-value if negative else value), at, exact


@njit(cache=True)
def parse_rows(
    text: _Bytes,
    at: int,
    roles: NDArray[np.int64],
    out: NDArray[np.float64],
    inexact: NDArray[np.int64],
    lengths: NDArray[np.int64],
    values: NDArray[np.float64],
) -> tuple[int, int, int, int, int, int]:
    """Parse rows of text, one per line, into ``out``.

    Parameters
    ----------
    text
        Bytes of the file.
    at
        Byte at which the first row begins.
    roles
        Role of each column: its index in ``out``, or SKIPPED, LISTED or KEPT.
    out
        Filled with the values, shape (rows, wanted).
    inexact
        Filled with row, column, begin and end of the values that the caller must round, shape (k, 4).
    lengths
        Filled with the length of the list KEPT in each row, shape (rows,).
    values
        Filled with the values of the list KEPT.

    Returns
    -------
    The status; the byte, row and column at which parsing ended; and the numbers of inexact values and of list values,
    which may exceed the room for them.
    """
    many = filled = 0
    for row in range(len(out)):
        at = row_start(text, at)
        for column in range(len(roles)):
            role = roles[column]
            measured = role > LISTED
            left = 1
            while left:
                left -= 1
                # Values are usually one blank apart, and checking for it is faster than a call.
                if at < len(text) and text[at] == 32:
                    at += 1
                if at == len(text) or text[at] <= 32:
                    start = _value_start(text, at)
                    if start < 0:
                        return TOO_FEW, at, row, column, many, filled
                    at = start
                if role == SKIPPED:
                    at = _token_end(text, at)
                    continue
                value, stop, exact = _number_at(text, at)
                if stop == at or not (stop == len(text) or _is_blank(text[stop])):
                    return NO_NUMBER, at, row, column, many, filled
                if role < 0 and not exact:
                    return NO_NUMBER, at, row, column, many, filled
                if role >= 0:
                    out[row, role] = value
                    if not exact:
                        if many < len(inexact):
                            inexact[many] = (row, role, at, stop)
                        many += 1
                elif not measured:
                    if not 0 <= value <= len(text) or value != np.floor(value):
                        return BAD_LENGTH, at, row, column, many, filled
                    measured, left = True, int(value)
                    if role == KEPT:
                        lengths[row] = left
                elif role == KEPT:
                    if filled < len(values):
                        values[filled] = value
                    filled += 1
                at = stop
        if at < len(text) and text[at] != 10 and _value_start(text, at) >= 0:
            return TOO_MANY, at, row, len(roles), many, filled
    return DONE, at, len(out), 0, many, filled


@njit(cache=True)
def _length_at(data: NDArray[np.uint8], at: int, size: int, signed: bool, big: bool) -> int:
    value = 0
    for place in range(size):
        value = (value << 8) | int(data[at + (place if big else size - 1 - place)])
    if signed and value >> (8 * size - 1):
        value -= 1 << (8 * size)
    return value


@njit(cache=True)
def walk_rows(
    data: NDArray[np.uint8],
    at: int,
    sizes: NDArray[np.int64],
    length_sizes: NDArray[np.int64],
    signed: NDArray[np.bool_],
    big: bool,
    slots: NDArray[np.int64],
    starts: NDArray[np.int64],
    lengths: NDArray[np.int64],
) -> tuple[int, int, int]:
    """Find the wanted values and lists in binary rows.

    Parameters
    ----------
    data
        Bytes of the file.
    at
        Byte at which the first row begins.
    sizes
        Size of the values of each column, in bytes.
    length_sizes
        Size of the length of each list, in bytes; 0 for a column that is not a list.
    signed
        True for each column whose length is a signed integer.
    big
        True if the lengths are big-endian.
    slots
        Index of each column in ``starts`` and ``lengths``, or SKIPPED.
    starts, lengths
        Filled with the first byte and the number of values of each value or list, shape (rows, wanted).

    Returns
    -------
    The status, and the byte and row at which the walk ended.
    """
    for row in range(len(starts)):
        for column in range(len(sizes)):
            length = 1
            size = length_sizes[column]
            if size:
                if at + size > len(data):
                    return TOO_SHORT, at, row
                length = _length_at(data, at, size, signed[column], big)
                if length < 0:
                    return BAD_LENGTH, at, row
                at += size
            if at + length * sizes[column] > len(data):
                return TOO_SHORT, at, row
            if slots[column] != SKIPPED:
                starts[row, slots[column]] = at
                lengths[row, slots[column]] = length
            at += length * sizes[column]
    return DONE, at, len(starts)
