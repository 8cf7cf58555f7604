"""A decimal, w times a power of ten, as the nearest double: compiled, and exact.

The algorithm is Eisel and Lemire's (D. Lemire, "Number parsing at a gigabyte per second", Software: Practice and
Experience 51, 2021): w is multiplied by the power of five in 128 bits, of which the upper ones settle the
rounding. Where w and the power are small, one operation on exact doubles does (W. D. Clinger, "How to read floating
point numbers accurately", 1990).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

MIN_POWER, MAX_POWER = -100, 60
"""Powers of ten within which a decimal is converted; doubles near their own limits are left to others."""

_EXACT = 2**53
_TENS = 10.0 ** np.arange(23)
_32, _LOW, _ONE = np.uint64(32), np.uint64(2**32 - 1), np.uint64(1)
_TO_55_BITS, _BEYOND_55 = np.uint64(9), np.uint64(2**9 - 1)
_MANTISSA_END = np.uint64(2**53)


def _fives() -> NDArray[np.uint64]:
    """Powers of five, shifted to 128 bits of which the first is set: upper and lower half (powers, 2).

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
    """Upper and lower half of a product in 128 bits."""
    a1, a0, b1, b0 = a >> _32, a & _LOW, b >> _32, b & _LOW
    low, left, right = a0 * b0, a1 * b0, a0 * b1
    middle = (low >> _32) + (left & _LOW) + (right & _LOW)
    high = a1 * b1 + (left >> _32) + (right >> _32) + (middle >> _32)
    return high, (low & _LOW) | (middle << _32)


@njit(cache=True, error_model="numpy")
def nearest(w: np.uint64, power: int) -> float:
    """The double nearest to w times 10 to the ``power``, which lies within MIN_POWER and MAX_POWER; even on a tie."""
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
