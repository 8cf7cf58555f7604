"""Minimal subsets: of items that together have a property, some that have it and of which none can be spared.

The property must be monotone: it stays when items are added, as inconsistency and entailment do. Few items are left out
one by one (deletion: Chinneck and Dravnieks 1991); of many, the shortest beginning that still has the property is
bracketed, and its last item is needed (progression: Marques-Silva, Janota and Belov, CAV 2013). Both drop items from
the end as long as the rest has the property, so that they agree, and with QuickXplain (Junker 2004). A test that can
tell on which of the items the property rests makes the rest smaller at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError

Item = TypeVar("Item")

FEW = 8
"""Items that are left out one by one; of more, the shortest beginning is bracketed for each needed one."""

Test = Callable[[list[Item]], Sequence[Item] | None]
"""Returns those of the items on which the property rests (all, if it cannot tell), None where they do not have it."""

FirstOf = Callable[[Iterable[list[Item]]], tuple[int, Sequence[Item]] | None]
"""Returns the place of the first of several lists that has the property, and on what it rests; None where none has."""


@dataclass(frozen=True)
class Minimal(Generic[Item]):
    """Items that have a property; where ``proved``, without any one of them the others do not."""

    items: tuple[Item, ...]
    proved: bool


def minimal_subset(
    items: Sequence[Item], test: Test[Item], deadline: Deadline = Deadline.never(), keep_last: bool = False
) -> Minimal[Item]:
    """Return a minimal subset of items that have a property, in their order; it keeps rather the first or last ones.

    ``test`` is asked of ever fewer items until ``deadline``, at which those left are returned. That ``items`` have the
    property is taken for granted.

    >>> minimal_subset([3, 5, 8, 1], lambda chosen: chosen if sum(chosen) >= 9 else None)
    Minimal(items=(3, 8), proved=True)
    """

    way = -1 if keep_last else 1

    def first_of(candidates: Iterable[list[Item]]) -> tuple[int, Sequence[Item]] | None:
        for place, candidate in enumerate(candidates):
            if deadline.passed:
                raise LimitError("the time was up between two tests")
            core = test(candidate[::way])
            if core is not None:
                return place, core
        return None

    found = minimal_by(items[::way], first_of)
    return Minimal(found.items[::way], found.proved and not deadline.passed)


def minimal_by(items: Sequence[Item], first_of: FirstOf[Item], width: int = 1) -> Minimal[Item]:
    """Return the same by a test of several candidates in one go, about ``width`` of them.

    That is for tests that are slow to start, such as a reasoner in a process of its own. Where a test raises
    LimitError, the items that were left then are returned, not proved to be minimal.
    """
    rest, needed = list(items), list[Item]()
    bracketing = width > 1 and len(items) > FEW  # a bracket takes one go for each needed item, deletion for each other
    try:
        while rest:
            if len(rest) <= FEW and not bracketing:
                found = first_of([*rest[:k], *rest[k + 1 :], *needed] for k in reversed(range(len(rest))))
                if found is None:
                    break
                k = len(rest) - 1 - found[0]
                rest, needed = _among(rest[:k], found[1]), [*rest[k + 1 :], *needed]
                continue
            low, step = 0, 1  # the beginning that it takes has low items or more, and all are enough
            while low < len(rest):
                high = len(rest)
                lengths = range(low, high, -(-(high - low) // width)) if width > 1 else [max(low, high - step)]
                found = first_of([*rest[:length], *needed] for length in lengths)
                if found is None:
                    low, step = lengths[-1] + 1, max(1, step // 2)
                    continue
                place, core = found
                low, step = (lengths[place - 1] + 1 if place else low), 2 * step
                enough = rest[: lengths[place]]
                rest = _among(enough, core)
                low = min(low, len(rest)) if len(rest) == len(enough) else 0
            needed = [*rest[-1:], *needed]
            rest = rest[:-1]
    except LimitError:
        return Minimal((*rest, *needed), False)
    return Minimal((*rest, *needed), True)


def _among(items: Sequence[Item], core: Sequence[Item]) -> list[Item]:
    """Return the items that a core contains, by identity, in their order."""
    inside = {id(item) for item in core}
    return [item for item in items if id(item) in inside]
