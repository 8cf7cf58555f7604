"""Exact bounds on times and on differences of times: whole microseconds, each with a flag for *strictly less*.

An upper bound is a code of :mod:`deixis.reasoning.constraints.difference` in microseconds, so that *before* means *less
than*, without an epsilon. Integers add up without rounding, so a chain of 0.1 s steps never contradicts its sum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from deixis.reasoning.constraints.difference import UNBOUNDED, ZERO, add
from deixis.reasoning.errors import SettingError

TICKS = 1_000_000
"""Ticks per second; a time between two ticks is rounded to the nearest."""

MAX_SECONDS = 4e9
"""Maximum distance of a bound from the origin in seconds (about 126 years), so that all sums stay exact."""


def to_ticks(seconds: float) -> int:
    """Return a time as a whole number of microseconds, the nearest one.

    Parameters
    ----------
    seconds
        The time in seconds.

    Returns
    -------
    int
        The number of microseconds.

    Raises
    ------
    SettingError
        If the time is not finite, or farther away than ``MAX_SECONDS``.
    """
    if not math.isfinite(seconds):
        kind = "NaN" if math.isnan(seconds) else "infinity"  # without its sign: a lower bound comes here negated
        raise SettingError(f"a time must be a finite number of seconds, got {kind}")
    if abs(seconds) > MAX_SECONDS:
        raise SettingError(
            f"a time of {abs(seconds):g} s from the origin is beyond {MAX_SECONDS:g} s; is the unit right?"
        )
    return round(Fraction(seconds) * TICKS)


def encode(seconds: float, strict: bool = False) -> int:
    """Return the code of *x <= seconds*, or of *x < seconds*; infinity means no bound.

    Parameters
    ----------
    seconds
        The bound in seconds; infinity means no bound.
    strict
        True for *<*, False for *<=*.

    Returns
    -------
    int
        The code; a smaller code is a tighter bound.

    Examples
    --------
    >>> encode(0.0) == ZERO, encode(0.0, strict=True) < encode(0.0) < encode(0.000001, strict=True)
    (True, True)
    """
    if seconds == math.inf:
        return UNBOUNDED
    return 2 * to_ticks(seconds) + (not strict)


def text_of_ticks(ticks: int) -> str:
    """Return microseconds as text in seconds, without trailing zeros.

    Parameters
    ----------
    ticks
        Microseconds.

    Returns
    -------
    str
        Decimal number of seconds.

    Examples
    --------
    >>> text_of_ticks(2_500_000), text_of_ticks(-3_000_000), text_of_ticks(1700000000_250000)
    ('2.5', '-3', '1700000000.25')
    """
    whole, rest = divmod(abs(ticks), TICKS)
    sign = "-" if ticks < 0 else ""
    return f"{sign}{whole}" + (f".{rest:06d}".rstrip("0") if rest else "")


def bound_text(tail: str, head: str, code: int, origin: str) -> str:
    """Return an upper bound of a difference of two points in words.

    Parameters
    ----------
    tail, head
        Names of the points; the bound is on ``head - tail``.
    code
        Code of the bound.
    origin
        Name of the origin; a difference to it is a time.

    Returns
    -------
    str
        An inequality.

    Examples
    --------
    >>> bound_text("a.finish", "b.start", encode(5), "origin"), bound_text("a.start", "origin", encode(-2), "origin")
    ('b.start <= a.finish + 5', 'a.start >= 2')
    """
    ticks, equal = code >> 1, "=" if code & 1 else ""
    if tail == origin and head != origin:
        return f"{head} <{equal} {text_of_ticks(ticks)}"
    if head == origin and tail != origin:
        return f"{tail} >{equal} {text_of_ticks(-ticks)}"
    offset = "" if ticks == 0 else f" {'+' if ticks > 0 else '-'} {text_of_ticks(abs(ticks))}"
    return f"{head} <{equal} {tail}{offset}"


@dataclass(frozen=True, slots=True)
class Bounds:
    """The interval of a time, or of a difference of times, from ``lower`` to ``upper`` in seconds.

    An infinite bound is unknown; an open bound does not belong to the interval. Raises SettingError if the interval is
    empty, or a bound is not a number.

    >>> str(Bounds(0, 5)), str(Bounds(2.5)), str(Bounds(0, 5, upper_open=True))
    ('[0, 5]', '[2.5, ∞)', '[0, 5)')
    """

    lower: float = -math.inf
    upper: float = math.inf
    lower_open: bool = False
    upper_open: bool = False

    def __post_init__(self) -> None:
        if add(self.at_least, self.at_most) < ZERO:
            raise SettingError(f"no time lies in {self}; is the lower bound above the upper one?")

    @property
    def at_most(self) -> int:
        """Code of the upper bound."""
        return encode(self.upper, self.upper_open)

    @property
    def at_least(self) -> int:
        """Code of the lower bound, as an upper bound of the negated value."""
        return encode(-self.lower, self.lower_open)

    @classmethod
    def from_codes(cls, at_least: int, at_most: int) -> Bounds:
        """Return the bounds with two codes.

        Parameters
        ----------
        at_least
            Code of the upper bound of the negated value.
        at_most
            Code of the upper bound of the value.

        Returns
        -------
        Bounds
            The bounds in seconds.
        """
        lower = -math.inf if at_least >= UNBOUNDED else -(at_least >> 1) / TICKS
        upper = math.inf if at_most >= UNBOUNDED else (at_most >> 1) / TICKS
        return cls(lower, upper, at_least < UNBOUNDED and not at_least & 1, at_most < UNBOUNDED and not at_most & 1)

    def __str__(self) -> str:
        lower, upper = self.at_least, self.at_most
        low = "(-∞" if lower >= UNBOUNDED else ("[" if lower & 1 else "(") + text_of_ticks(-(lower >> 1))
        high = "∞)" if upper >= UNBOUNDED else text_of_ticks(upper >> 1) + ("]" if upper & 1 else ")")
        return f"{low}, {high}"


UNKNOWN = Bounds()
"""The bounds of an unknown time."""
