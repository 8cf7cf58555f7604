"""Disjunctions over a simple temporal network, decided by backtracking over their convex pieces.

This is the meta-search of temporal constraint satisfaction (Dechter, Meiri & Pearl 1991; Stergiou &
Koubarakis 2000): choose a piece for every disjunction so that the network stays consistent. Before each choice every
disjunction is held against what the network admits of its pair: what it already says is dropped, what leaves one piece
is taken (forward checking), and the disjunction with the fewest pieces left is chosen from next.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from deixis.reasoning.temporal.claims import Disjunction, allen_constraints
from deixis.reasoning.temporal.endpoints import masks_of_pairs
from deixis.reasoning.temporal.explanation import Explanation, Rule
from deixis.reasoning.temporal.fluent import allen_text
from deixis.reasoning.temporal.network import SimpleTemporalNetwork, Trail


@dataclass(frozen=True, slots=True)
class Open:
    """A disjunction that is not decided, with the pieces of it that the network admits."""

    disjunction: Disjunction
    pieces: tuple[int, ...]


@dataclass
class Propagation:
    """What the network says of disjunctions: what had to be taken, what stays open, and the one that is impossible."""

    trails: list[Trail] = field(default_factory=list)
    open: tuple[Open, ...] = ()
    impossible: Disjunction | None = None


@dataclass(frozen=True, slots=True)
class Search:
    """How many scenarios were found, whether these are all there are, and, if there is none, why, where asked."""

    found: int
    complete: bool
    refutation: Explanation | None = None


def propagate(
    network: SimpleTemporalNetwork, disjunctions: Sequence[Disjunction], deadline: float, explain: bool = False
) -> Propagation:
    """Takes into the network what disjunctions come down to, until nothing more is forced or the deadline comes.

    With ``explain`` each constraint taken in carries the refutation of the other pieces.
    """
    result = Propagation()
    waiting = tuple(disjunctions)
    while True:
        result.open = still_open = _held_against(network, waiting)
        empty = next((entry for entry in still_open if not entry.pieces), None)
        if empty is not None:
            result.impossible = empty.disjunction
            return result
        waiting = tuple(entry.disjunction for entry in still_open if len(entry.pieces) > 1)
        if len(waiting) == len(still_open):
            return result
        for entry in still_open:
            if len(entry.pieces) == 1:
                trail = _take(network, entry.disjunction, entry.pieces[0], _eliminated(network, entry, explain))
                if trail is None:  # two that are forced exclude each other
                    result.impossible = entry.disjunction
                    return result
                result.trails.append(trail)
        if time.monotonic() > deadline:
            result.open = _held_against(network, waiting)
            return result


def _held_against(network: SimpleTemporalNetwork, disjunctions: Sequence[Disjunction]) -> tuple[Open, ...]:
    """The disjunctions that the network does not imply, each with the pieces that it admits."""
    if not disjunctions:
        return ()
    pairs = np.array([[network.index(point) for point in d.points] for d in disjunctions], dtype=np.int64)
    admitted = masks_of_pairs(network.distances, pairs).tolist()
    return tuple(
        Open(disjunction, tuple(piece for piece in disjunction.pieces if piece & mask))
        for disjunction, mask in zip(disjunctions, admitted, strict=True)
        if mask & ~disjunction.relations
    )


def _eliminated(network: SimpleTemporalNetwork, entry: Open, explain: bool) -> Explanation:
    """Why the one piece that is left must hold."""
    disjunction = entry.disjunction
    premises = [disjunction.why]
    if explain:
        premises += refutations(network, disjunction, [p for p in disjunction.pieces if p not in entry.pieces])
    text = allen_text(disjunction.a, entry.pieces[0], disjunction.b)
    return Explanation(text, Rule.ELIMINATION, tuple(premises))


def refutations(network: SimpleTemporalNetwork, disjunction: Disjunction, pieces: Sequence[int]) -> list[Explanation]:
    """The negative cycle that each of some pieces closes."""
    found = []
    for piece in pieces:
        assumed = Explanation(allen_text(disjunction.a, piece, disjunction.b), Rule.CASE)
        found.append(network.refutation(allen_constraints(disjunction.a, piece, disjunction.b, assumed)))
    return found


def _take(network: SimpleTemporalNetwork, disjunction: Disjunction, piece: int, why: Explanation) -> Trail | None:
    return network.try_add(allen_constraints(disjunction.a, piece, disjunction.b, why))


class _Node:
    """One choice of the search: a piece taken, what followed from it, and the next disjunction to choose from."""

    def __init__(
        self,
        network: SimpleTemporalNetwork,
        disjunctions: Sequence[Disjunction],
        deadline: float,
        explain: bool,
        taken: Sequence[Trail] = (),
    ) -> None:
        self.refuted: list[Explanation] = []
        self.solved = False
        propagation = propagate(network, disjunctions, deadline, explain)
        self._trails = [*taken, *propagation.trails]
        self.impossible = propagation.impossible
        self.chosen = min(propagation.open, key=lambda entry: len(entry.pieces), default=None)
        self.rest = [entry.disjunction for entry in propagation.open if entry is not self.chosen]
        self._pieces = iter(() if self.impossible or self.chosen is None else self.chosen.pieces)
        if self.impossible is not None and explain:
            self.refuted = refutations(network, self.impossible, self.impossible.pieces)

    @property
    def is_scenario(self) -> bool:
        return self.impossible is None and self.chosen is None

    def next_piece(self) -> int | None:
        return next(self._pieces, None)

    def leave(self, network: SimpleTemporalNetwork) -> None:
        for trail in reversed(self._trails):
            network.undo(trail)

    def refutation(self) -> Explanation:
        """Every piece of the disjunction chosen here is refuted."""
        disjunction = self.impossible or (self.chosen.disjunction if self.chosen else None)
        assert disjunction is not None
        return Explanation("no alternative is left", Rule.CASES, (disjunction.why, *self.refuted))


def search(
    network: SimpleTemporalNetwork,
    disjunctions: Sequence[Disjunction],
    visit: Callable[[], None],
    deadline: float,
    most: int = 1,
    explain: bool = False,
) -> Search:
    """Goes through the scenarios: consistent choices of a piece for every disjunction.

    ``visit`` is called while the network holds each one; the network is as before in the end. Stops after ``most``
    scenarios, and at ``deadline`` (of ``time.monotonic``); ``complete`` is False then.
    """
    found = 0
    root = _Node(network, disjunctions, deadline, explain)
    stack = [root]
    while stack:
        node = stack[-1]
        if node.is_scenario and not node.solved:
            visit()
            found, node.solved = found + 1, True
        piece = node.next_piece()
        if piece is None:
            _ascend(network, stack, explain)
        elif found >= most or time.monotonic() > deadline:
            for left in reversed(stack):
                left.leave(network)
            return Search(found, complete=False)
        else:
            _descend(network, stack, piece, deadline, explain)
    return Search(found, True, root.refutation() if explain and not found else None)


def _ascend(network: SimpleTemporalNetwork, stack: list[_Node], explain: bool) -> None:
    """Leaves the top node, which is exhausted, and tells the one below what came of it."""
    node = stack.pop()
    node.leave(network)
    if not stack:
        return
    stack[-1].solved |= node.solved
    if explain and not node.solved:
        stack[-1].refuted.append(node.refutation())


def _descend(network: SimpleTemporalNetwork, stack: list[_Node], piece: int, deadline: float, explain: bool) -> None:
    """Takes one piece of the top node's disjunction; the network admits some relation of it."""
    node = stack[-1]
    assert node.chosen is not None
    disjunction = node.chosen.disjunction
    assumed = Explanation(allen_text(disjunction.a, piece, disjunction.b), Rule.CASE)
    trail = _take(network, disjunction, piece, assumed)
    assert trail is not None
    stack.append(_Node(network, node.rest, deadline, explain, [trail]))
