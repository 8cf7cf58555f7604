"""The implications of statements about fluents, and queries over them.

A fluent holds at t if start <= t < finish. A *scenario* is a choice of times that is consistent with all statements.
Names such as *held* mean in every scenario, names such as *may have held* in at least one.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from deixis.answers import Answer, count
from deixis.arguments import checks_arguments
from deixis.ontology.relations.allen import Allen, members
from deixis.reasoning.constraints.difference import ZERO, add_arrays
from deixis.reasoning.errors import SettingError
from deixis.reasoning.temporal.bounds import Bounds, encode, to_ticks
from deixis.reasoning.temporal.errors import UnknownFluentError
from deixis.reasoning.temporal.fluent import ANYTHING, Fluent, Pattern

_ORIGIN, _START, _FINISH = range(3)
_PRECEDES = 1 << Allen.BEFORE | 1 << Allen.MEETS
_FOLLOWS = 1 << Allen.AFTER | 1 << Allen.MET_BY


class Status(StrEnum):
    """The consistency of all statements; an inconsistency raises TemporalConflictError instead."""

    CONSISTENT = "consistent"
    UNDECIDED = "undecided"  # the time limit was reached first


class TemporalOrder(StrEnum):
    """The order of two fluents that holds in every scenario."""

    PRECEDES = "precedes"  # the first has finished when the second starts
    FOLLOWS = "follows"
    CONCURRENT = "concurrent"  # there is a time at which both hold


@dataclass(frozen=True, slots=True)
class Window:
    """The times t with ``begin <= t < end``, in seconds since the origin.

    Raises SettingError if the window is empty, or an end is not finite.
    """

    begin: float
    end: float

    def __post_init__(self) -> None:
        if not (isfinite(self.begin) and isfinite(self.end)):
            raise SettingError(f"a window must have finite ends, got {self.begin} and {self.end}")
        if not to_ticks(self.begin) < to_ticks(self.end):
            raise SettingError(f"a window must begin before it ends, got {self.begin:g} and {self.end:g}")


@dataclass(frozen=True, eq=False, repr=False)
class Chronology(Answer):
    """The implied times and relations of n fluents.

    ``spans`` (k, n, 3, 3), int64, holds for each of k cases of the disjunctions and each fluent the minimal distances
    among origin, start and finish, as codes of :mod:`deixis.reasoning.constraints.difference`. ``masks`` (n, n),
    uint16, holds the Allen relations that the row's fluent may have to the column's. If ``exact``, both are as tight as
    possible. Otherwise some disjunctions were ignored: what is certain is still certain, but what is possible may not
    be. Times are in seconds since ``origin``, a description in words; ``file`` is the file that the fluents come from.

    Examples
    --------
    >>> import deixis
    >>> found = deixis.chronology("examples/serving.fluents.json")
    >>> str(found.start("served")), str(found.finish("served")), str(found.duration("carried"))
    ('[30, 60]', '(34, ∞)', '[10, 15]')
    >>> [relation.name for relation in found.relations("fetch", "pouring")]
    ['BEFORE']
    >>> found.certain_order("fetch", "pouring").value
    'precedes'
    >>> def names(fluents):
    ...     return [fluent.id for fluent in fluents]
    >>> names(found.held_at(28)), names(found.may_have_held(28))
    ([], ['fetch', 'carried', 'cleared'])
    >>> window = Window(20, 40)
    >>> names(found.held_within(window)), names(found.may_have_held_within(window))
    (['carried'], ['fetch', 'carried', 'served', 'pouring', 'cleared'])
    >>> names(found.held_throughout(window)), names(found.may_have_held_throughout(window))
    ([], ['cleared'])
    >>> len(found.certain_orders(window))
    7
    """

    fluents: tuple[Fluent, ...]
    spans: NDArray[np.int64]
    masks: NDArray[np.uint16]
    status: Status
    exact: bool
    origin: str = ""
    file: str = "<fluents>"

    def summary(self) -> str:
        """Return the number of fluents and the verdict."""
        return f"{count(len(self.fluents), 'fluent')}: {self.status}"

    @cached_property
    def _places(self) -> dict[str, int]:
        return {fluent.id: place for place, fluent in enumerate(self.fluents)}

    def _place(self, fluent_id: str) -> int:
        try:
            return self._places[fluent_id]
        except KeyError:
            raise UnknownFluentError("fluent", fluent_id, self._places) from None

    @checks_arguments
    def start(self, fluent_id: str) -> Bounds:
        """Return the tightest bounds of a fluent's start.

        Parameters
        ----------
        fluent_id
            Id of the fluent.

        Returns
        -------
        Bounds
            Bounds in seconds since the origin.
        """
        return self._bounds(fluent_id, _ORIGIN, _START)

    @checks_arguments
    def finish(self, fluent_id: str) -> Bounds:
        """Return the tightest bounds of a fluent's finish.

        Parameters
        ----------
        fluent_id
            Id of the fluent.

        Returns
        -------
        Bounds
            Bounds in seconds since the origin.
        """
        return self._bounds(fluent_id, _ORIGIN, _FINISH)

    @checks_arguments
    def duration(self, fluent_id: str) -> Bounds:
        """Return the tightest bounds of the time from a fluent's start to its finish.

        Parameters
        ----------
        fluent_id
            Id of the fluent.

        Returns
        -------
        Bounds
            Bounds in seconds.
        """
        return self._bounds(fluent_id, _START, _FINISH)

    def _bounds(self, fluent_id: str, tail: int, head: int) -> Bounds:
        span = self.spans[:, self._place(fluent_id)].max(axis=0)
        return Bounds.from_codes(int(span[head, tail]), int(span[tail, head]))

    @checks_arguments
    def held_at(self, time: float, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that certainly held at a time: start <= time < finish in every scenario.

        Parameters
        ----------
        time
            Seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.

        Raises
        ------
        SettingError
            If the time is not finite.
        """
        return self._chosen(self._certain(*_at(time)), pattern)

    @checks_arguments
    def may_have_held(self, time: float, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that may have held at a time: start <= time < finish in some scenario.

        Parameters
        ----------
        time
            Seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.

        Raises
        ------
        SettingError
            If the time is not finite.
        """
        return self._chosen(self._possible(*_at(time)), pattern)

    @checks_arguments
    def held_throughout(self, window: Window, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that certainly held throughout a window, in every scenario.

        That is, start <= begin and end <= finish.

        Parameters
        ----------
        window
            Begin and end in seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.
        """
        return self._chosen(self._certain(*_throughout(window)), pattern)

    @checks_arguments
    def may_have_held_throughout(self, window: Window, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that may have held throughout a window, in some scenario.

        That is, start <= begin and end <= finish.

        Parameters
        ----------
        window
            Begin and end in seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.
        """
        return self._chosen(self._possible(*_throughout(window)), pattern)

    @checks_arguments
    def held_within(self, window: Window, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that certainly held at some time in a window, in every scenario.

        That is, start < end and begin < finish.

        Parameters
        ----------
        window
            Begin and end in seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.
        """
        return self._chosen(self._certain(*_within(window)), pattern)

    @checks_arguments
    def may_have_held_within(self, window: Window, pattern: Pattern = ANYTHING) -> tuple[Fluent, ...]:
        """Return the fluents that may have held at some time in a window, in some scenario.

        That is, start < end and begin < finish.

        Parameters
        ----------
        window
            Begin and end in seconds since the origin.
        pattern
            Pattern of their statements.

        Returns
        -------
        tuple of Fluent
            The fluents, in the order of listing.
        """
        return self._chosen(self._possible(*_within(window)), pattern)

    def _certain(self, start: int, finish: int) -> NDArray[np.bool_]:
        """Return whether all cases have start under a bound, and the negated finish under another, shape (n,)."""
        below = self.spans[:, :, _ORIGIN, _START] <= start
        certain = below & (self.spans[:, :, _FINISH, _ORIGIN] <= finish)
        return np.asarray(certain.all(axis=0))

    def _possible(self, start: int, finish: int) -> NDArray[np.bool_]:
        """Return whether both bounds can be added without a negative cycle in some case, shape (n,).

        There are three simple cycles through the new constraints: through the first, the second, or both.
        """
        first = add_arrays(self.spans[:, :, _START, _ORIGIN], start) >= ZERO
        second = add_arrays(self.spans[:, :, _ORIGIN, _FINISH], finish) >= ZERO
        both = add_arrays(add_arrays(self.spans[:, :, _START, _FINISH], start), finish) >= ZERO
        return np.asarray((first & second & both).any(axis=0))

    def _chosen(self, which: NDArray[np.bool_], pattern: Pattern) -> tuple[Fluent, ...]:
        return tuple(
            f for f, chosen in zip(self.fluents, which, strict=True) if chosen and pattern.matches(f.statement)
        )

    @checks_arguments
    def relations(self, a: str, b: str) -> tuple[Allen, ...]:
        """Return the Allen relations that one fluent may have to another.

        Parameters
        ----------
        a, b
            Ids of the fluents.

        Returns
        -------
        tuple of Allen
            The relations of a to b; a single one is certain.
        """
        return members(int(self.masks[self._place(a), self._place(b)]))

    @checks_arguments
    def certain_order(self, a: str, b: str) -> TemporalOrder | None:
        """Return the certain order of two fluents.

        The order is PRECEDES if a.finish <= b.start in every scenario, FOLLOWS if b.finish <= a.start, and CONCURRENT
        if they share a time in every scenario.

        Parameters
        ----------
        a, b
            Ids of the fluents.

        Returns
        -------
        TemporalOrder or None
            The order, or None if no order is certain.
        """
        mask = int(self.masks[self._place(a), self._place(b)])
        if not mask & ~_PRECEDES:
            return TemporalOrder.PRECEDES
        if not mask & ~_FOLLOWS:
            return TemporalOrder.FOLLOWS
        return None if mask & (_PRECEDES | _FOLLOWS) else TemporalOrder.CONCURRENT

    @checks_arguments
    def certain_orders(
        self, window: Window | None = None, pattern: Pattern = ANYTHING
    ) -> tuple[tuple[Fluent, TemporalOrder, Fluent], ...]:
        """Return the certain order of each two fluents, or of those that may have held at some time in a window.

        Each two fluents come once, in the order of listing, or reversed if the first follows the second.

        Parameters
        ----------
        window
            Times in seconds that both fluents may have held at, or None for all times.
        pattern
            Pattern of the statements of both fluents.

        Returns
        -------
        tuple of tuple
            Pairs of fluents with their order.
        """
        everything = tuple(fluent for fluent in self.fluents if pattern.matches(fluent.statement))
        chosen = everything if window is None else self.may_have_held_within(window, pattern)
        found = []
        for position, a in enumerate(chosen):
            for b in chosen[position + 1 :]:
                order = self.certain_order(a.id, b.id)
                if order is TemporalOrder.FOLLOWS:
                    found.append((b, TemporalOrder.PRECEDES, a))
                elif order is not None:
                    found.append((a, order, b))
        return tuple(found)


def _at(time: float) -> tuple[int, int]:
    """Return the bounds on start and on the negated finish for holding at a time."""
    if not isfinite(time):
        raise SettingError(f"a time must be a finite number of seconds, got {time}")
    return encode(time), encode(-time, strict=True)


def _throughout(window: Window) -> tuple[int, int]:
    """Return the bounds on start and on the negated finish for holding throughout a window."""
    return encode(window.begin), encode(-window.end)


def _within(window: Window) -> tuple[int, int]:
    """Return the bounds on start and on the negated finish for holding at some time in a window."""
    return encode(window.end, strict=True), encode(-window.begin, strict=True)
