"""Minimal subsets: subsets of items that have a property and lose it if any item is left out.

The property must be monotone: it stays when items are added, as inconsistency and entailment do. From few items, one at
a time is left out (deletion: Chinneck and Dravnieks 1991). From many, a search with growing steps brackets the shortest
prefix that still has the property; its last item is needed (progression: Marques-Silva, Janota and Belov, CAV 2013).
Both methods drop items from the end as long as the rest has the property, so they agree with each other and with
QuickXplain (Junker 2004). A test that reports which items the property rests on removes the others at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from deixis.deadline import Deadline
from deixis.reasoning.errors import LimitError

Item = TypeVar("Item")

FEW = 8
"""Number of items up to which one at a time is left out; with more items, the shortest prefix is bracketed."""

Test = Callable[[list[Item]], Sequence[Item] | None]
"""Test that returns the items on which the property rests (all, if it cannot tell), or None without the property."""

FirstOf = Callable[[Iterable[list[Item]]], tuple[int, Sequence[Item]] | None]
"""Test that returns the position of the first list with the property, and the items on which it rests, or None."""


@dataclass(frozen=True)
class Minimal(Generic[Item]):
    """Items that have a property; if ``proved``, no proper subset of them has it."""

    items: tuple[Item, ...]
    proved: bool


def minimal_subset(
    items: Sequence[Item], test: Test[Item], deadline: Deadline = Deadline.never(), keep_last: bool = False
) -> Minimal[Item]:
    """Return a minimal subset of items that has a property, in their order.

    Parameters
    ----------
    items
        Items that have the property.
    test
        Test of a subset: the items on which the property rests, or None if the subset does not have it.
    deadline
        Time at which the items left so far are returned, not proved to be minimal.
    keep_last
        Prefer the last items to the first ones.

    Returns
    -------
    Minimal[Item]
        The subset, and whether it is proved to be minimal.

    Examples
    --------
    >>> minimal_subset([3, 5, 8, 1], lambda chosen: chosen if sum(chosen) >= 9 else None)
    Minimal(items=(3, 8), proved=True)
    """
    way = -1 if keep_last else 1

    def first_of(candidates: Iterable[list[Item]]) -> tuple[int, Sequence[Item]] | None:
        for place, candidate in enumerate(candidates):
            if deadline.passed:
                raise LimitError("time limit reached between two tests")
            core = test(candidate[::way])
            if core is not None:
                return place, core
        return None

    found = minimal_by(items[::way], first_of)
    return Minimal(found.items[::way], found.proved and not deadline.passed)


def minimal_by(items: Sequence[Item], first_of: FirstOf[Item], width: int = 1) -> Minimal[Item]:
    """Return a minimal subset by a test of several candidates in one run.

    This suits tests that are slow to start, such as a reasoner in its own process.

    Parameters
    ----------
    items
        Items that have the property.
    first_of
        Function from candidates to the position of one that has the property, with the items it rests on, or None.
    width
        About the number of candidates of one run.

    Returns
    -------
    Minimal[Item]
        The subset. If a test raises LimitError, it has the items left so far, not proved to be minimal.
    """
    rest, needed = list(items), list[Item]()
    bracketing = width > 1 and len(items) > FEW  # bracketing needs one run per needed item, deletion one per other item
    try:
        while rest:
            if len(rest) <= FEW and not bracketing:
                found = first_of([*rest[:k], *rest[k + 1 :], *needed] for k in reversed(range(len(rest))))
                if found is None:
                    break
                k = len(rest) - 1 - found[0]
                rest, needed = _among(rest[:k], found[1]), [*rest[k + 1 :], *needed]
                continue
            low, step = 0, 1  # the prefix needs at least low items, and all items are enough
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
