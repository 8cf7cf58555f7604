"""Search in calculi whose relations take several words: atom by atom, with closure after each.

No tractable subclass is known for such calculi, so that every pair is narrowed to an atom. The trail of the closure
shows which decisions a contradiction rests on; the search backtracks to the last but one of these, where the last is
excluded (conflict-directed backjumping; Prosser 1993). Pairs involved in contradictions are decided first (Boussemart
and others 2004), and the search restarts after increasing numbers of contradictions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.calculus import Calculus, bits
from deixis.reasoning.qualitative.networks.closure.cells import Planes
from deixis.reasoning.qualitative.networks.closure.state import NetworkState
from deixis.reasoning.qualitative.networks.closure.tables import tables
from deixis.reasoning.qualitative.networks.network import Network

FIRST_RESTART = 32  # contradictions before the first restart
RESTART_GROWTH = 1.5
MAX_WEIGHT = 1e100
WEIGHT_GROWTH = 1 / 0.95  # decay of the weight that a contradiction adds to a pair, from one contradiction to the next


@dataclass(frozen=True)
class _Decision:
    """A decision for an atom of a pair, taken when the trail had ``steps`` steps."""

    pair: tuple[int, int]
    atom: int
    steps: int


@dataclass(frozen=True)
class _Exclusion:
    """An atom removed from a pair while the first ``level`` decisions hold, because of those at ``culprits``."""

    pair: tuple[int, int]
    level: int
    culprits: frozenset[int]


class WideSearch:
    """A search for one atom per pair, for calculi whose networks are kept as bit planes.

    Parameters
    ----------
    network : Network
        What is stated.

    Examples
    --------
    >>> from deixis.reasoning.qualitative.calculi.registry import calculus
    >>> from deixis.reasoning.qualitative.networks.network import Constraint
    >>> joint = calculus("direction-distance")
    >>> stated = tuple(Constraint(0, k, joint.relation(["N,near", "S,near"])) for k in (1, 2))
    >>> search = WideSearch(Network(joint, 3, stated))
    >>> search.run(), search.decisions
    (True, 3)
    """

    def __init__(self, network: Network) -> None:
        self.decisions = self.conflicts = 0
        self._state = _RetractableState(network.calculus, network.size)
        self._state.add(network)
        self._calculus, self._made = network.calculus, list[_Decision]()
        self._excluded: list[_Exclusion] = []
        self._tried: dict[tuple[int, int], int] = {}
        self._weights, self._increment = np.ones((network.size, network.size)), 1.0
        table = network.calculus.compose
        universal = network.calculus.universal
        self._atom_weights = [table(1 << atom, universal).bit_count() for atom in range(len(network.calculus.atoms))]
        self._limit, self._until_restart = float(FIRST_RESTART), FIRST_RESTART

    def run(self, deadline: Deadline = Deadline.never()) -> bool | None:
        """Continue the search: True if every pair has one atom, False if that is impossible, None if out of time.

        Parameters
        ----------
        deadline
            End of the time limit, after which the search can be continued.

        Returns
        -------
        bool or None
            Result of the search.
        """
        while self._state.close(deadline):
            if self._state.emptied is not None:
                if not self._go_back(self._state.emptied):
                    return False
            elif not self._decide():
                return True
            if deadline.passed:
                return None
        return None

    def relations(self) -> NDArray[np.uint64]:
        """Return the current relations of all pairs.

        Returns
        -------
        ndarray
            Words of 64 atoms, shape (n, n, words), row to column.
        """
        return self._state.relations()

    def _decide(self) -> bool:
        """Choose for a pair the atom last tried, or that of most weight; return False if every pair has one."""
        pair = self._state.pair_to_decide(self._weights)
        if pair is None:
            return False
        left, tried = self._state.relation(*pair), self._tried.get(pair, 0)
        if not left & tried:
            tried = 1 << max(bits(left), key=self._atom_weights.__getitem__)
        self._tried[pair] = tried
        self._made.append(_Decision(pair, tried, self._state.steps))
        self.decisions += 1
        self._state.intersect(pair, tried)
        return True

    def _go_back(self, emptied: tuple[int, int]) -> bool:
        """Undo and exclude the last decision behind a contradiction; return False if it rests on no decision."""
        self.conflicts += 1
        needed = self._state.support(*emptied)
        self._increment *= WEIGHT_GROWTH
        self._weights[needed] += self._increment
        if self._increment > MAX_WEIGHT:
            self._weights, self._increment = np.maximum(self._weights / MAX_WEIGHT, 1 / MAX_WEIGHT), 1.0
        culprits = {level for level, made in enumerate(self._made) if needed[made.pair]}
        culprits = culprits.union(*(each.culprits for each in self._excluded if needed[each.pair]))
        if not culprits:
            return False
        last = max(culprits)
        rest = frozenset(culprits - {last})
        refuted, level = self._made[last], max(rest, default=-1) + 1
        self._until_restart -= 1
        if self._until_restart <= 0:
            self._limit *= RESTART_GROWTH
            self._until_restart, level = int(self._limit), 0
        self._state.undo(self._made[level].steps)
        del self._made[level:]
        self._excluded = [each for each in self._excluded if each.level <= level]
        if len(rest) <= level:
            self._excluded.append(_Exclusion(refuted.pair, level, rest))
            self._state.intersect(refuted.pair, self._calculus.universal & ~refuted.atom)
        return True


class _RetractableState(NetworkState):
    """A network that is being closed, whose last steps can be undone."""

    def __init__(self, calculus: Calculus, size: int) -> None:
        super().__init__(calculus, size, traced=True)
        assert isinstance(self._cells, Planes)
        self._planes, self._converses = self._cells.planes, tables(calculus).converses
        self._pair, self._id = np.zeros((2, 1), dtype=np.int64), np.zeros(1, dtype=np.int64)

    @property
    def steps(self) -> int:
        """Length of the trail."""
        return int(self._count[0])

    def intersect(self, pair: tuple[int, int], relation: int) -> None:
        """Intersect the relation of a pair with another."""
        self._pair[:, 0] = pair
        self.restrict(self._pair[0], self._pair[1], self._id, (relation,))

    def undo(self, steps: int) -> None:
        """Restore the network to the time when the trail had that length, and the network was closed."""
        from deixis.reasoning.qualitative.networks.closure.kernels import undo

        undo(steps, self._converses, self._planes, *self._bookkeeping)

    def pair_to_decide(self, weights: NDArray[np.float64]) -> tuple[int, int] | None:
        """Return the undecided pair with the fewest atoms for its weight (n, n)."""
        from deixis.reasoning.qualitative.networks.closure.kernels import lightest

        found = int(lightest(self._planes, weights))
        return None if found < 0 else divmod(found, self.size)
