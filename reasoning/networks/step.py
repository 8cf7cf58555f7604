"""One step of a derivation: what follows about a pair, and from what."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deixis.ontology.source import Source
from deixis.reasoning.calculi.calculus import Calculus, ProductCalculus
from deixis.reasoning.networks.network import Network


@dataclass(frozen=True)
class Step:
    """``first`` bears ``relation`` to ``second``, as ``source`` states, or because of ``premises``.

    Two premises about (first, k) and (k, second) are composed. Premises about the pair itself hold together. A step
    without premises is stated.
    """

    first: int
    second: int
    relation: int
    premises: tuple[Step, ...] = ()
    source: Source | None = None

    @property
    def composed(self) -> bool:
        """Whether this is a composition of two premises."""
        return bool(self.premises) and (self.premises[0].first, self.premises[0].second) != (self.first, self.second)

    def stated(self) -> Iterator[Step]:
        """The stated steps that this one rests on, from left to right."""
        if not self.premises:
            yield self
        for premise in self.premises:
            yield from premise.stated()

    def lines(self, network: Network, depth: int = 0) -> Iterator[str]:
        """The tree in words, what follows first and what it rests on indented below."""
        how = "stated" if not self.premises else "composed" if self.composed else "together"
        where = f" {self.source}" if self.source is not None else ""
        what = f"{network.name(self.first)} {worded(network.calculus, self.relation)} {network.name(self.second)}"
        yield f"{'    ' * depth}{what}   {how}{where}"
        for premise in self.premises:
            yield from premise.lines(network, depth + 1)


def worded(calculus: Calculus, relation: int) -> str:
    """A relation for people: its atoms, or for each axis what it leaves there, ``any`` for everything.

    >>> from deixis.reasoning.calculi.registry import calculus
    >>> ra = calculus("ra")
    >>> worded(ra, ra.of_axes([ra.axes[0].relation(["<", "m"]), ra.axes[1].universal]))
    '( < m; any )'
    """
    if not relation:
        return "( nothing )"
    if isinstance(calculus, ProductCalculus) and not calculus.signs:
        return " or ".join(
            f"( {'; '.join(_axis(axis, part) for axis, part in zip(calculus.axes, box, strict=True))} )"
            for box in calculus.boxes(relation)
        )
    return f"( {_axis(calculus, relation)} )"


def _axis(calculus: Calculus, relation: int) -> str:
    return "any" if relation == calculus.universal else " ".join(calculus.members(relation))
