"""What joins two calculi: what a relation in one says of the same two things in the other.

:mod:`deixis.reasoning.calculi.bridges` has them; these are the ones that apply to any network.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Protocol

from deixis.reasoning.calculi.calculus import Calculus


class Link(Protocol):
    """What the atoms of one calculus admit of another's."""

    @property
    def source(self) -> Calculus:
        """The calculus that is read."""
        ...

    @property
    def target(self) -> Calculus:
        """The calculus that is narrowed."""
        ...

    def forward(self, relation: int) -> int:
        """The target's atoms that some atom of a source relation admits."""
        ...

    def backward(self, relation: int) -> int:
        """The source's atoms that admit some atom of a target relation."""
        ...


def links_between(calculi: Sequence[Calculus]) -> tuple[Link, ...]:
    """The bridges between any two of some calculi; regions of RCC-8 have the boxes as their bounding boxes.

    >>> from deixis.reasoning.calculi.registry import calculus
    >>> [(link.source.name, link.target.name) for link in links_between([calculus("rcc8"), calculus("ra")])]
    [('ra', 'rcc8')]
    """
    from deixis.reasoning.calculi import bridges

    known = {
        frozenset(("ra", "cd")): bridges.boxes_to_directions,
        frozenset(("ra", "rcc8")): bridges.bounds_to_regions,
        frozenset(("ten", "ra")): bridges.names_to_boxes,
        frozenset(("cd", "distance")): bridges.directions_to_distances,
        frozenset(("direction-distance", "cd")): bridges.joint_to_directions,
        frozenset(("direction-distance", "distance")): bridges.joint_to_distances,
    }
    pairs = (frozenset((a.name, b.name)) for a, b in combinations(calculi, 2))
    return tuple(known[pair]() for pair in pairs if pair in known)
