"""Closure in rounds, each from the round before alone, so that what follows is found by the shortest way first."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

from deixis.ontology.graph import Source
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus
from deixis.reasoning.qualitative.networks.network import Network


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

    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
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


Table = list[list[int]]


class Rounds:
    """A small network, closed breadth first; what each round left of each pair is kept."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._calculus = network.calculus
        self._universal = network.calculus.universal
        self._composed: dict[tuple[int, int], int] = {}
        self._known: dict[tuple[int, int, int], Step] = {}
        self._tables: list[Table] = [self._stated()]

    def _stated(self) -> Table:
        n, identity = self._network.size, 1 << self._calculus.identity
        table = [[identity if i == j else self._universal for j in range(n)] for i in range(n)]
        for c in self._network.constraints:
            table[c.first][c.second] &= c.relation
            table[c.second][c.first] &= self._calculus.converse(c.relation)
        return table

    def derive(self, first: int, second: int, goal: int, deadline: float) -> Step | None:
        """The derivation of a relation within ``goal``; of any pair's empty relation where ``first`` is -1.

        None where the rounds end, or ``deadline`` (time.monotonic) comes, before that.
        """
        while True:
            pair = (first, second) if first >= 0 else self._emptied()
            if pair is not None and not self._at(*pair, len(self._tables) - 1) & ~goal:
                return self._step(*pair, len(self._tables) - 1, goal)
            if not self._next_round(deadline):
                return None

    def _emptied(self) -> tuple[int, int] | None:
        table = self._tables[-1]
        return next(((i, j) for i, row in enumerate(table) for j, relation in enumerate(row) if not relation), None)

    def _at(self, i: int, j: int, position: int) -> int:
        return self._tables[position][i][j]

    def _compose(self, first: int, second: int) -> int:
        key = (first, second)
        if key not in self._composed:
            self._composed[key] = self._calculus.compose(first, second)
        return self._composed[key]

    def _between(self, i: int, j: int, position: int) -> dict[int, int]:
        """What each third thing leaves of a pair, where that is less than everything."""
        table, between = self._tables[position], {}
        for k in range(len(table)):
            left, right = table[i][k], table[k][j]
            if k not in (i, j) and left != self._universal and right != self._universal:
                relation = self._compose(left, right)
                if relation != self._universal:
                    between[k] = relation
        return between

    def _next_round(self, deadline: float) -> bool:
        """Whether there is another round, and was time for it."""
        last, changed = len(self._tables) - 1, False
        table = [list(row) for row in self._tables[last]]
        for i in range(len(table)):
            if time.monotonic() > deadline:
                return False
            for j in range(i + 1, len(table)):
                relation = table[i][j]
                for other in self._between(i, j, last).values():
                    relation &= other
                if relation != table[i][j]:
                    table[i][j], table[j][i] = relation, self._calculus.converse(relation)
                    changed = True
        self._tables.append(table)
        return changed

    def _step(self, i: int, j: int, position: int, goal: int) -> Step:
        """Derives a relation within ``goal``, which the table at ``position`` gives, from the tables before it."""
        while position and not self._at(i, j, position - 1) & ~goal:
            position -= 1
        if not position:
            return self._leaf(i, j, goal)
        before = position - 1
        options = self._between(i, j, before)
        enough = [k for k, relation in options.items() if not relation & ~goal]
        if enough:
            return min((self._composition(i, k, j, before) for k in enough), key=lambda s: sum(1 for _ in s.stated()))
        return self._together(i, j, before, goal, options)

    def _exact(self, i: int, j: int, position: int) -> Step:
        key = (i, j, position)
        if key not in self._known:
            self._known[key] = self._step(i, j, position, self._at(i, j, position))
        return self._known[key]

    def _composition(self, i: int, k: int, j: int, before: int) -> Step:
        relation = self._compose(self._at(i, k, before), self._at(k, j, before))
        return Step(i, j, relation, (self._exact(i, k, before), self._exact(k, j, before)))

    def _together(self, i: int, j: int, before: int, goal: int, options: dict[int, int]) -> Step:
        """The relation of before and what third things leave, as few of them as greed finds."""
        left, chosen = self._at(i, j, before), []
        own = left != self._universal
        while left & ~goal:
            k = min(options, key=lambda k: (left & options[k] & ~goal).bit_count())
            left &= options[k]
            chosen.append(k)
        premises = [self._exact(i, j, before)] if own else []
        premises += [self._composition(i, k, j, before) for k in chosen]
        return Step(i, j, left, tuple(premises))

    def _leaf(self, i: int, j: int, goal: int) -> Step:
        """What is stated of the pair, the least that is enough."""
        steps, relation = [], self._universal
        if i == j:
            relation = 1 << self._calculus.identity
        for c in self._network.constraints:
            if {c.first, c.second} == {i, j}:
                stated = c.relation if (c.first, c.second) == (i, j) else self._calculus.converse(c.relation)
                steps.append(Step(i, j, stated, (), c.source))
                relation &= stated
        alone = [step for step in steps if not step.relation & ~goal]
        if alone:
            return alone[0]
        return Step(i, j, relation, tuple(steps))
