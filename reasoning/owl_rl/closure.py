"""The transitive closure of one relation, kept while pairs are added.

Source: Italiano, *Amortized efficiency of a path retrieval data structure*, Theoretical Computer Science 48 (1986):
a new pair (x, y) joins what reaches x with what y reaches, and only pairs that are new are looked at.
"""

from __future__ import annotations

from collections.abc import Iterator

Pair = tuple[int, int]


class TransitiveClosure:
    """A transitive relation.

    >>> closure = TransitiveClosure()
    >>> list(closure.add(1, 2)), list(closure.add(2, 3))
    ([], [((1, 3), (1, 2), (2, 3))])
    """

    def __init__(self) -> None:
        self._after: dict[int, set[int]] = {}
        self._before: dict[int, set[int]] = {}

    def add(self, x: int, y: int) -> Iterator[tuple[Pair, Pair, Pair]]:
        """Adds a pair; gives each pair that is now in the closure, after the two that it follows from."""
        after, before = self._after, self._before
        if y in after.get(x, ()):
            return
        later = {y, *after.get(y, ())}
        for a in (x, *before.get(x, ())):
            reached = after.setdefault(a, set())
            new = later - reached
            reached |= new
            for b in new:
                before.setdefault(b, set()).add(a)
            if y in new and a != x:
                yield (a, y), (a, x), (x, y)
            yield from (((a, b), (a, y), (y, b)) for b in new if b != y)
