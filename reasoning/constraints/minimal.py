"""Minimal subsets: of many items that together have a property, some that have it and of which none can be spared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

Item = TypeVar("Item")


def minimal_subset(items: Sequence[Item], holds: Callable[[Sequence[Item]], bool]) -> list[Item]:
    """A subset for which ``holds`` is true and of which no item can be left out, in the order of ``items``.

    ``holds`` must be true of ``items`` and stay true when items are added, as inconsistency does. Asks about
    k log(n / k) times for k items kept of n (QuickXplain: Junker 2004). The earlier items are preferred.

    >>> minimal_subset([3, 5, 8, 1], lambda chosen: sum(chosen) >= 9)
    [3, 8]
    """
    if holds([]):
        return []
    kept = set(_explain([], False, list(range(len(items))), lambda chosen: holds([items[k] for k in sorted(chosen)])))
    return [item for k, item in enumerate(items) if k in kept]


def _explain(
    background: list[int], grown: bool, candidates: list[int], holds: Callable[[Sequence[int]], bool]
) -> list[int]:
    if grown and holds(background):
        return []
    if len(candidates) == 1:
        return candidates
    half = len(candidates) // 2
    first, second = candidates[:half], candidates[half:]
    from_second = _explain(background + first, bool(first), second, holds)
    from_first = _explain(background + from_second, bool(from_second), first, holds)
    return from_first + from_second
