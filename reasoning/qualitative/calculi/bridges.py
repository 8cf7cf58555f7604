"""Translate relations between calculi: a bridge gives, for a relation in one, the relation of the same pair in another.

Each bridge follows from the geometry: boxes with sides along the axes, their centres, and regions with these boxes as
their bounding boxes. :func:`links_between` returns the bridges that apply to any network.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import combinations, product
from typing import Protocol, cast

import numpy as np

from deixis.ontology.relations.allen import Allen
from deixis.reasoning.geometry.allen import allen_relations
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus, bits
from deixis.reasoning.qualitative.calculi.distance import SAME
from deixis.reasoning.qualitative.calculi.registry import calculus


@dataclass(frozen=True, eq=False)
class Bridge:
    """A map from each atom of ``source`` to the relation of ``target`` that the same two things may have.

    A target atom is admitted exactly where some two things have both atoms, so that no information about the pair is
    lost.
    """

    source: Calculus
    target: Calculus
    admits: tuple[int, ...]

    def forward(self, relation: int) -> int:
        """Return the target relation that a source relation admits.

        Parameters
        ----------
        relation
            Relation of the source calculus, as a bit mask.

        Returns
        -------
        int
            Relation of the target calculus, as a bit mask.
        """
        mask = 0
        for code in bits(relation):
            mask |= self.admits[code]
        return mask

    def backward(self, relation: int) -> int:
        """Return the source relation that a target relation admits.

        Parameters
        ----------
        relation
            Relation of the target calculus, as a bit mask.

        Returns
        -------
        int
            Relation of the source calculus, as a bit mask.
        """
        return sum(1 << code for code, admitted in enumerate(self.admits) if admitted & relation)

    @cached_property
    def inverse(self) -> Bridge:
        """The bridge from the target to the source."""
        admits = tuple(self.backward(1 << code) for code in range(len(self.target.atoms)))
        return Bridge(self.target, self.source, admits)


@cache
def boxes_to_directions() -> Bridge:
    """Return the bridge from the rectangle algebra to cardinal directions, those between the centres of the boxes.

    Returns
    -------
    Bridge
        Bridge from ``ra`` to ``cd``.

    Examples
    --------
    >>> bridge = boxes_to_directions()
    >>> bridge.target.members(bridge.forward(bridge.source.relation(["<,d"])))
    ('SW', 'W', 'NW')
    """
    source, target = _product("ra"), _product("cd")
    # Orders of the two centres by Allen relation: intervals between six points show all of them.
    ends = np.array(list(combinations(range(6), 2)), dtype=np.float64)
    low, high = ends.T
    codes = allen_relations(low[:, None], high[:, None], low[None, :], high[None, :])
    middles = low + high
    signs = 1 + np.sign(middles[:, None] - middles[None, :]).astype(int)
    orders = [sum(1 << int(sign) for sign in np.unique(signs[codes == code])) for code in range(13)]
    admits = tuple(target.of_axes([orders[x], orders[y]]) for x, y in product(range(13), repeat=2))
    return Bridge(source, target, admits)


@cache
def boxes_to_regions() -> Bridge:
    """Return the bridge from the rectangle algebra to RCC-8 for regions that are boxes: one atom each.

    Returns
    -------
    Bridge
        Bridge from ``ra`` to ``rcc8``.

    Examples
    --------
    >>> bridge = boxes_to_regions()
    >>> bridge.target.members(bridge.forward(bridge.source.relation(["d,d", "d,s", "<,="])))
    ('DC', 'TPP', 'NTPP')
    """
    return _to_regions(_of_boxes)


@cache
def bounds_to_regions() -> Bridge:
    """Return the bridge from the rectangle algebra to RCC-8 for regions that the boxes bound, each in one piece.

    Regions are bounded and regular closed. In one piece, each reaches from side to side of its box, so that two must
    meet where the one box spans the other on x and is spanned by it on y. (For what combining the two calculi takes:
    Li and Cohn 2012.)

    Returns
    -------
    Bridge
        Bridge from ``ra`` to ``rcc8``.

    Examples
    --------
    >>> bridge = bounds_to_regions()
    >>> bridge.target.members(bridge.forward(bridge.source.relation(["d,d"])))
    ('DC', 'EC', 'PO', 'TPP', 'NTPP')
    >>> bridge.target.members(bridge.forward(bridge.source.relation(["=,="])))
    ('EC', 'PO', 'TPP', 'TPPI', 'EQ')
    """
    return _to_regions(_of_bounds)


@cache
def directions_to_distances() -> Bridge:
    """Return the bridge from cardinal directions to distance: ``EQ`` exactly where ``same``.

    Returns
    -------
    Bridge
        Bridge from ``cd`` to ``distance``.
    """
    source, target = calculus("cd"), calculus("distance")
    here = target.relation([SAME])
    admits = [target.universal & ~here] * len(source.atoms)
    admits[source.identity] = here
    return Bridge(source, target, tuple(admits))


@cache
def joint_to_directions() -> Bridge:
    """Return the bridge from direction with distance to direction alone.

    Returns
    -------
    Bridge
        Bridge from the joint calculus to ``cd``.
    """
    return _part(0, "cd")


@cache
def joint_to_distances() -> Bridge:
    """Return the bridge from direction with distance to distance alone.

    Returns
    -------
    Bridge
        Bridge from the joint calculus to ``distance``.
    """
    return _part(1, "distance")


@cache
def names_to_boxes() -> Bridge:
    """Return the bridge from the ten names to the rectangle-algebra atoms that each admits.

    Returns
    -------
    Bridge
        Bridge from ``ten`` to ``ra``.
    """
    from deixis.ontology.tbox import default_ontology
    from deixis.reasoning.qualitative.calculi.ten import named_parts

    return Bridge(calculus("ten"), calculus("ra"), tuple(named_parts(default_ontology().relations).values()))


def to_ra(names: int) -> int:
    """Return a relation of ``ten`` as a relation of the rectangle algebra, whose closure decides consistency.

    Parameters
    ----------
    names
        Relation of ``ten``, as a bit mask.

    Returns
    -------
    int
        Relation of the rectangle algebra, as a bit mask.

    Examples
    --------
    >>> calculus("ra").members(to_ra(calculus("ten").relation(["top_left"])))
    ('<,mi', '<,>', 'm,mi', 'm,>')
    """
    return names_to_boxes().forward(names)


def _product(name: str) -> ProductCalculus:
    return cast(ProductCalculus, calculus(name))


def _part(position: int, name: str) -> Bridge:
    source, target = calculus("direction-distance"), calculus(name)
    admits = tuple(1 << target.code(atom.split(",")[position]) for atom in source.atoms)
    return Bridge(source, target, admits)


_INSIDE = frozenset({Allen.STARTS, Allen.EQUALS, Allen.DURING, Allen.FINISHES})
_AROUND = frozenset(relation.converse for relation in _INSIDE)


def _to_regions(connected: Callable[[Allen, Allen], tuple[str, ...]]) -> Bridge:
    target = calculus("rcc8")
    return Bridge(calculus("ra"), target, tuple(target.relation(connected(x, y)) for x, y in product(Allen, repeat=2)))


def _of_boxes(x: Allen, y: Allen) -> tuple[str]:
    axes = {x, y}
    if axes & {Allen.BEFORE, Allen.AFTER}:
        return ("DC",)
    if axes & {Allen.MEETS, Allen.MET_BY}:
        return ("EC",)
    if axes == {Allen.EQUALS}:
        return ("EQ",)
    if axes <= _INSIDE:
        return ("NTPP",) if axes == {Allen.DURING} else ("TPP",)
    if axes <= _AROUND:
        return ("NTPPI",) if axes == {Allen.CONTAINS} else ("TPPI",)
    return ("PO",)


def _of_bounds(x: Allen, y: Allen) -> tuple[str, ...]:
    boxes = _of_boxes(x, y)[0]
    if boxes == "DC":
        return ("DC",)
    if boxes == "EC":
        return ("DC", "EC")
    crossing = (x in _AROUND and y in _INSIDE) or (x in _INSIDE and y in _AROUND)
    within = {"NTPP": ("TPP", "NTPP"), "NTPPI": ("TPPI", "NTPPI"), "EQ": ("TPP", "TPPI", "EQ"), "PO": ()}
    return (*(() if crossing else ("DC",)), "EC", "PO", *within.get(boxes, (boxes,)))


class Link(Protocol):
    """The atoms of one calculus that each atom of another admits."""

    @property
    def source(self) -> Calculus:
        """The calculus of the given relation."""
        ...

    @property
    def target(self) -> Calculus:
        """The calculus of the resulting relation."""
        ...

    def forward(self, relation: int) -> int:
        """Return the target atoms that at least one atom of a source relation admits.

        Parameters
        ----------
        relation
            Relation of the source calculus, as a bit mask.

        Returns
        -------
        int
            Relation of the target calculus, as a bit mask.
        """
        ...

    def backward(self, relation: int) -> int:
        """Return the source atoms that admit at least one atom of a target relation.

        Parameters
        ----------
        relation
            Relation of the target calculus, as a bit mask.

        Returns
        -------
        int
            Relation of the source calculus, as a bit mask.
        """
        ...


def links_between(calculi: Sequence[Calculus]) -> tuple[Link, ...]:
    """Return the bridges between any two of the given calculi.

    Boxes are taken as the bounding boxes of the regions of RCC-8.

    Parameters
    ----------
    calculi
        Calculi of networks over the same things.

    Returns
    -------
    tuple of Link
        The bridges, each with its source and target calculus.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> [(link.source.name, link.target.name) for link in links_between([calculus("rcc8"), calculus("ra")])]
    [('ra', 'rcc8')]
    """
    known = {
        frozenset(("ra", "cd")): boxes_to_directions,
        frozenset(("ra", "rcc8")): bounds_to_regions,
        frozenset(("ten", "ra")): names_to_boxes,
        frozenset(("cd", "distance")): directions_to_distances,
        frozenset(("direction-distance", "cd")): joint_to_directions,
        frozenset(("direction-distance", "distance")): joint_to_distances,
    }
    pairs = (frozenset((a.name, b.name)) for a, b in combinations(calculi, 2))
    return tuple(known[pair]() for pair in pairs if pair in known)
