"""Close a network in rounds, each from the round before alone, so that short derivations are found first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.reasoning.constraints.proof import Proof, Rule
from deixis.reasoning.qualitative.calculi.calculus import Calculus, ProductCalculus
from deixis.reasoning.qualitative.networks.network import Network

_WORDS = {Rule.STATED: "stated", Rule.COMPOSITION: "composed", Rule.CONJUNCTION: "together"}


@dataclass(frozen=True, slots=True)
class PairRelation:
    """The statement that ``relation`` holds from ``first`` to ``second``."""

    first: int
    second: int
    relation: int


Step = Proof[PairRelation]
"""A proof step: premises on (first, k) and (k, second) are composed, premises on the pair itself are intersected."""


def step_lines(step: Step, network: Network, depth: int = 0) -> Iterator[str]:
    """Yield the lines of a proof in words, each conclusion first and its premises indented below.

    Parameters
    ----------
    step
        Last step of the proof.
    network
        The network, for the names of the things.
    depth
        Depth of the step in the proof, 0 for the last one.

    Yields
    ------
    str
        Line, indented by four spaces for each level.
    """
    claim, calculus = step.claim, network.calculus
    where = f" {step.source}" if step.source is not None else ""
    what = f"{network.name(claim.first)} {worded(calculus, claim.relation)} {network.name(claim.second)}"
    yield f"{'    ' * depth}{what}   {_WORDS[step.rule]}{where}"
    for premise in step.premises:
        yield from step_lines(premise, network, depth + 1)


def worded(calculus: Calculus, relation: int) -> str:
    """Write a relation for people: its atoms, or for each axis of a product the relation there, ``any`` if universal.

    Parameters
    ----------
    calculus
        Calculus of the relation.
    relation
        Relation as a bit mask.

    Returns
    -------
    str
        The relation in parentheses; *( nothing )* for the empty one.

    Examples
    --------
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


RelationTable = list[list[int]]


class Rounds:
    """A small network, closed breadth first, with the relation of each pair after each round."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._calculus = network.calculus
        self._universal = network.calculus.universal
        self._composed: dict[tuple[int, int], int] = {}
        self._known: dict[tuple[int, int, int], Step] = {}
        n, identity = self._network.size, 1 << self._calculus.identity
        table = [[identity if i == j else self._universal for j in range(n)] for i in range(n)]
        for c in self._network.constraints:
            table[c.first][c.second] &= c.relation
            table[c.second][c.first] &= self._calculus.converse(c.relation)
        self._tables: list[RelationTable] = [table]

    def derive(self, first: int, second: int, goal: int, deadline: Deadline) -> Step | None:
        """Return the derivation of a pair's relation.

        Parameters
        ----------
        first, second
            Numbers of two things; -1 for the empty relation of any pair.
        goal
            Relation as a bit mask, in which the derived one must be contained; 0 for the empty relation.
        deadline
            End of the time limit.

        Returns
        -------
        Step or None
            The last step with its premises; None if the rounds end or the time is up before.
        """
        while True:
            pair: tuple[int, int] | None = (first, second)
            if first < 0:
                rows = enumerate(self._tables[-1])
                pair = next(((i, j) for i, row in rows for j, relation in enumerate(row) if not relation), None)
            if pair is not None and not self._at(*pair, len(self._tables) - 1) & ~goal:
                return self._step(*pair, len(self._tables) - 1, goal)
            if not self._next_round(deadline):
                return None

    def _at(self, i: int, j: int, position: int) -> int:
        return self._tables[position][i][j]

    def _compose(self, first: int, second: int) -> int:
        key = (first, second)
        if key not in self._composed:
            self._composed[key] = self._calculus.compose(first, second)
        return self._composed[key]

    def _between(self, i: int, j: int, position: int) -> dict[int, int]:
        """Return the relation of a pair implied by each third thing, where it is not universal."""
        table, between = self._tables[position], {}
        for k in range(len(table)):
            left, right = table[i][k], table[k][j]
            if k not in (i, j) and left != self._universal and right != self._universal:
                relation = self._compose(left, right)
                if relation != self._universal:
                    between[k] = relation
        return between

    def _next_round(self, deadline: Deadline) -> bool:
        """Compute the next round; return False if nothing changed or time ran out."""
        last, changed = len(self._tables) - 1, False
        table = [list(row) for row in self._tables[last]]
        for i in range(len(table)):
            if deadline.passed:
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
        """Derive a relation within ``goal``, which the table at ``position`` gives, from the tables before it."""
        while position and not self._at(i, j, position - 1) & ~goal:
            position -= 1
        if not position:
            steps, relation = [], self._universal
            if i == j:
                relation = 1 << self._calculus.identity
            for c in self._network.constraints:
                if {c.first, c.second} == {i, j}:
                    stated = c.relation if (c.first, c.second) == (i, j) else self._calculus.converse(c.relation)
                    steps.append(Step(PairRelation(i, j, stated), Rule.STATED, source=c.source))
                    relation &= stated
            alone = [step for step in steps if not step.claim.relation & ~goal]
            if alone:
                return alone[0]
            return Step(PairRelation(i, j, relation), Rule.CONJUNCTION if steps else Rule.STATED, tuple(steps))
        before = position - 1
        options = self._between(i, j, before)
        enough = [k for k, relation in options.items() if not relation & ~goal]
        if enough:
            return min((self._composition(i, k, j, before) for k in enough), key=lambda step: step.size())
        # Intersect the relation before with those from third things, as few of them as a greedy choice finds.
        left, chosen = self._at(i, j, before), []
        own = left != self._universal
        while left & ~goal:
            k = min(options, key=lambda k: (left & options[k] & ~goal).bit_count())
            left &= options[k]
            chosen.append(k)
        premises = [self._exact(i, j, before)] if own else []
        premises += [self._composition(i, k, j, before) for k in chosen]
        return Step(PairRelation(i, j, left), Rule.CONJUNCTION, tuple(premises))

    def _exact(self, i: int, j: int, position: int) -> Step:
        key = (i, j, position)
        if key not in self._known:
            self._known[key] = self._step(i, j, position, self._at(i, j, position))
        return self._known[key]

    def _composition(self, i: int, k: int, j: int, before: int) -> Step:
        relation = self._compose(self._at(i, k, before), self._at(k, j, before))
        premises = (self._exact(i, k, before), self._exact(k, j, before))
        return Step(PairRelation(i, j, relation), Rule.COMPOSITION, premises)
