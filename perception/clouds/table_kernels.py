"""Compiled passage through tables: numbers in text, exact to the last bit, and binary rows of which columns are lists.

Text is read at the speed of the memory that it comes from. Numbers of more than 19 digits and extreme ones are left to
the caller, who is told where they stand. A decimal, w times a power of ten, becomes the nearest double by the algorithm
of Eisel and Lemire (D. Lemire, "Number parsing at a gigabyte per second", Software: Practice and Experience 51, 2021):
w is multiplied by the power of five in 128 bits, of which the upper ones settle the rounding. Where w and the power are
small, one operation on exact doubles does (W. D. Clinger, "How to read floating point numbers accurately", 1990).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

DONE, NO_NUMBER, TOO_FEW, TOO_MANY, BAD_LENGTH, TOO_SHORT = range(6)
"""What the walk through a table ended with."""
SKIPPED, LISTED, KEPT = -1, -2, -3
"""Roles of columns: not wanted; a list, its length first, as in PLY; and the one list whose values are wanted."""

_NAN, _INF, _INFINITY = b"NAN", b"INF", b"INFINITY"
_Bytes = NDArray[np.uint8]
MIN_POWER, MAX_POWER = -100, 60
"""Powers of ten within which a decimal is converted; doubles near their own limits are left to others."""

_EXACT = 2**53
_TENS = 10.0 ** np.arange(23)
_32, _LOW, _ONE = np.uint64(32), np.uint64(2**32 - 1), np.uint64(1)
_TO_55_BITS, _BEYOND_55 = np.uint64(9), np.uint64(2**9 - 1)
_MANTISSA_END = np.uint64(2**53)


def _fives() -> NDArray[np.uint64]:
    """Return powers of five, shifted to 128 bits of which the first is set: upper and lower half (powers, 2).

    They are rounded down, but the reciprocals down to -27, with which ties can occur, are rounded up.
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
    """Return upper and lower half of a product in 128 bits."""
    a1, a0, b1, b0 = a >> _32, a & _LOW, b >> _32, b & _LOW
    low, left, right = a0 * b0, a1 * b0, a0 * b1
    middle = (low >> _32) + (left & _LOW) + (right & _LOW)
    high = a1 * b1 + (left >> _32) + (right >> _32) + (middle >> _32)
    return high, (low & _LOW) | (middle << _32)


@njit(cache=True, error_model="numpy")
def nearest(w: np.uint64, power: int) -> float:
    """Return the double nearest to w times 10 to the ``power``, which lies within MIN_POWER and MAX_POWER; even on a
    tie."""
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
    # Just halfway between two doubles: to the even one. That needs a power of five that fits 64 bits.
    if low <= _ONE and -4 <= power <= 23 and mantissa & np.uint64(3) == _ONE and mantissa << dropped == high:
        mantissa -= _ONE
    mantissa = (mantissa + (mantissa & _ONE)) >> _ONE
    # 217706 / 65536 is the logarithm of 10 to the base 2, near enough for every double's power.
    exponent = ((217706 * power) >> 16) + 63 + (1 if upper else 0) - shift
    return math.ldexp(float(mantissa), exponent - 52)


@njit(cache=True)
def _is_blank(byte: int) -> bool:
    return byte == 32 or (9 <= byte <= 13)


@njit(cache=True)
def _value_start(text: _Bytes, at: int) -> int:
    """Return where the next value of this line begins, or -1 where there is none."""
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
    """Return where the next row begins: blank lines and those that begin with # or // are passed over."""
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
    """Return how many rows there are from ``at`` on."""
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
    """Return whether a word in capitals stands at ``at``, in any case."""
    if at + len(word) > len(text):
        return False
    same = True
    for place in range(len(word)):
        same = same and text[at + place] & 223 == word[place]
    return same


@njit(cache=True)
def _word_at(text: _Bytes, at: int) -> tuple[float, int]:
    """Return value and end of nan, inf or infinity in any case; the end is ``at`` where it is none of them."""
    if _spells(text, at, _NAN):
        return np.nan, at + len(_NAN)
    if _spells(text, at, _INFINITY):
        return np.inf, at + len(_INFINITY)
    if _spells(text, at, _INF):
        return np.inf, at + len(_INF)
    return 0.0, at


@njit(cache=True)
def _exponent_at(text: _Bytes, at: int) -> tuple[int, int]:
    """Return the number after an e, and its end; the end is ``at`` where there is none."""
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
    """Return a number's value, its end (``at`` where there is none) and whether the value is exact."""
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
    """Fill ``out`` (rows, wanted) from text, one row a line; ``roles`` says what to do with each column.

    A role is the place of the column in ``out``, or SKIPPED, or LISTED or KEPT. Fills in addition ``inexact`` (k, 4),
    row and column in ``out``, begin and end of values still to be rounded; ``lengths`` (rows,) of the list KEPT; and
    its ``values``. Returns what went wrong, at which byte, row and column, and how many inexact ones and values there
    are, which may be more than there was room for.
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
                # One blank is what mostly stands here, and a look at it is quicker than a call.
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
    """Walk through binary rows; fill ``starts`` and ``lengths`` (rows, wanted) of each wanted value or list: the byte
    at which it begins, and how many values it has.

    ``length_sizes`` is 0 for a column that is no list. Returns what went wrong, at which byte and in which row.
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
