"""Find boxes that satisfy networks in several calculi: a proof that the networks are consistent together.

The constraints on a pair, in any calculus, amount to a set of types of pairs (:mod:`.pair_types`). The search starts
from boxes given by a scenario of the rectangle algebra, or from random ones, and repeats two steps: it picks for each
pair the permitted type nearest to the boxes, with a piece of other types around it; and it moves the boxes so that the
pairs are as little out of their pieces as possible
(:mod:`deixis.reasoning.qualitative.networks.realisation.placement`). Boxes that fit are verified in every calculus. A
search that finds none proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.qualitative.calculi.registry import calculus
from deixis.reasoning.qualitative.networks.network import Constraint, Network
from deixis.reasoning.qualitative.networks.realisation.pair_types import (
    BOUNDS,
    COMPARED,
    GREATER,
    LESS,
    Piece,
    pair_types,
    piece_around,
)
from deixis.reasoning.qualitative.networks.realisation.placement import FEASIBLE, Boxes, Placement, place, rounded
from deixis.reasoning.qualitative.networks.search.consistency import Verdict, solve
from deixis.reasoning.qualitative.relate import relate

Closed = Callable[[str, int, int], int]
"""Function from the name of a calculus and a pair to the relation of the pair after closure."""

MEASURED = ("distance", "direction-distance")
"""Calculi in which the size of things matters."""
MAX_TRIES = 20
"""Maximum number of starts of the search."""
MAX_MOVES = 12
"""Maximum number of linear programs from one start."""
MAX_ALL_PAIRS = 40
"""Maximum number of things for which closed relations of all pairs guide the search, not only those of stated pairs."""
MAX_PAIRS = 4000
"""Maximum number of stated pairs for which the search runs."""
MARGINS = (2.0**-5, 2.0**-9)
"""Margins of strict orders in units of the reference length, used in turn where distances matter; otherwise 1."""
ROUNDING = 1e-9
"""Relative error of distances that a verdict must not depend on; that of floating point is far smaller."""


@dataclass(frozen=True, eq=False)
class FoundBoxes:
    """Verified boxes, shape (n, 2, 2), distances in units of the reference length; or None, with the reason in words.

    ``impossible`` is True if it is proved that there are no such boxes.
    """

    boxes: Boxes | None
    reason: str = ""
    impossible: bool = False


def satisfies(boxes: Boxes, network: Network) -> bool:
    """Return True if boxes satisfy every constraint of a network.

    Parameters
    ----------
    boxes
        Boxes of shape (n, 2, 2), in units of the reference length. Sums of two coordinates must be exact in floating
        point, as they are of whole numbers below 2^52.
    network
        A network of n things in a calculus that boxes are related in.

    Returns
    -------
    bool
        False for boxes at the bound of a distance range, unless both ranges are permitted.

    Examples
    --------
    >>> ra = calculus("ra")
    >>> network = Network(ra, 2, (Constraint(0, 1, ra.relation(["<,=", "m,="])),))
    >>> boxes = np.array([[[0.0, 0], [1, 1]], [[1, 0], [2, 1]]])
    >>> satisfies(boxes, network), satisfies(boxes[::-1], network)
    (True, False)
    """
    references = (1 - ROUNDING, 1 + ROUNDING) if network.calculus.name in MEASURED else (1.0,)
    codes = [relate(boxes, network.calculus.name, reference=reference) for reference in references]
    return all(c.relation >> int(found[c.first, c.second]) & 1 for found in codes for c in network.constraints)


def rectangles(networks: Sequence[Network], closed: Closed, without: str = "") -> Network:
    """Return the constraints on boxes in the rectangle algebra that the networks imply.

    Regions of ``rcc8`` are taken to be the boxes themselves.

    Parameters
    ----------
    networks
        Networks over the same things, each in its own calculus.
    closed
        Function that returns what closing leaves of a pair, by the name of the calculus.
    without
        Name of the calculus whose network is left out; by default, none is.

    Returns
    -------
    Network
        Network in the rectangle algebra over the same things.
    """
    return _Pairs([network for network in networks if network.calculus.name != without], closed).rectangles()


def unrelated(networks: Sequence[Network]) -> tuple[str, ...]:
    """Return the names of the networks' calculi in which boxes are not related here, or with other distance ranges.

    Parameters
    ----------
    networks
        Networks, each in its own calculus.

    Returns
    -------
    tuple of str
        Names, in the order of the networks.
    """
    names = [network.calculus.name for network in networks]
    known = pair_types().atoms
    return tuple(
        name
        for name, network in zip(names, networks, strict=True)
        if name not in known or network.calculus is not calculus(name)
    )


def find_boxes(
    networks: Sequence[Network], closed: Closed, deadline: Deadline = Deadline.never(), seed: int = 0
) -> FoundBoxes:
    """Search for boxes that satisfy all networks over the same things.

    Parameters
    ----------
    networks
        Networks over the same things, each in its own calculus.
    closed
        What closing leaves of a pair by the name of the calculus. It guides the search; boxes are verified against
        the constraints as stated.
    deadline
        When to stop.
    seed
        The seed of the random starts.

    Returns
    -------
    FoundBoxes
        Boxes that were verified, or None with the reason.
    """
    odd = unrelated(networks)
    if odd:
        return FoundBoxes(None, f"the search for boxes does not cover {', '.join(odd)}")
    if not networks[0].size:
        return FoundBoxes(np.zeros((0, 2, 2)))
    if len(_stated_pairs(networks)) > MAX_PAIRS:
        return FoundBoxes(None, f"the search for boxes covers at most {MAX_PAIRS:,} constrained pairs")
    pairs = _Pairs(networks, closed)
    solution = solve(pairs.rectangles(), deadline, scenario=True)
    if solution.verdict is Verdict.INCONSISTENT:
        return FoundBoxes(None, "no boxes satisfy all constraints", impossible=True)
    if solution.scenario is None:
        return FoundBoxes(None, "the time limit was reached before boxes were found")
    boxes = _Search(networks, pairs, np.random.default_rng(seed)).run(solution.scenario, deadline)
    if boxes is not None:
        return FoundBoxes(boxes)
    reason = "the time limit was reached before boxes were found" if deadline.passed else "no boxes were found"
    return FoundBoxes(None, reason)


def _stated_pairs(networks: Sequence[Network]) -> list[tuple[int, int]]:
    """Return the pairs of different things that a constraint relates, lower number first."""
    pairs = {(min(c.first, c.second), max(c.first, c.second)) for network in networks for c in network.constraints}
    return sorted((i, j) for i, j in pairs if i != j)


class _Pairs:
    """The pairs with some known relation, and the types permitted for each."""

    def __init__(self, networks: Sequence[Network], closed: Closed) -> None:
        self.size = networks[0].size
        names = [network.calculus.name for network in networks]
        places: dict[tuple[int, ...], int] = {}
        pairs = list(combinations(range(self.size), 2)) if self.size <= MAX_ALL_PAIRS else _stated_pairs(networks)
        ids = [places.setdefault(tuple(closed(name, i, j) for name in names), len(places)) for i, j in pairs]
        self.sets = [pair_types().permitted(dict(zip(names, relations, strict=True))) for relations in places]
        telling = [k for k, position in enumerate(ids) if not self.sets[position].all()]
        self.pairs = np.array([pairs[k] for k in telling], dtype=np.int64).reshape(-1, 2)
        self.ids = np.array([ids[k] for k in telling], dtype=np.int64)  # positions in ``sets``

    def rectangles(self) -> Network:
        """Return the relations that the pairs must have in the rectangle algebra."""
        codes = pair_types().atoms["ra"]
        relations = [sum(1 << code for code in np.unique(codes[each]).tolist()) for each in self.sets]
        stated = zip(self.pairs.tolist(), self.ids.tolist(), strict=True)
        return Network(calculus("ra"), self.size, tuple(Constraint(i, j, relations[k]) for (i, j), k in stated))


class _Search:
    """The search for boxes, from several starts."""

    def __init__(self, networks: Sequence[Network], pairs: _Pairs, rng: np.random.Generator) -> None:
        self._networks, self._pairs, self._rng = networks, pairs, rng
        self._measured = any(network.calculus.name in MEASURED and network.constraints for network in networks)
        self._permitted = np.array(pairs.sets, dtype=np.bool_).reshape(-1, len(pair_types().reaches))[
            pairs.ids
        ]  # (pairs, types)
        self._margin = 1.0
        self._order = np.arange(11)  # order in which types are widened to pieces
        self._pieces: dict[tuple[int, int], Piece] = {}

    def run(self, scenario: Network, deadline: Deadline) -> Boxes | None:
        """Return verified boxes; None if none were found."""
        best: Placement | None = None
        for attempt in range(MAX_TRIES):
            if self._measured:
                self._margin = MARGINS[attempt % len(MARGINS)]
            if attempt:
                self._order, self._pieces = self._rng.permutation(11), {}
            if attempt == 0:
                start = self._sized(_ranked(scenario))
            elif best is not None and attempt % 2:
                start = self._shaken(best)
            else:
                start = self._sized(self._random())
            last = self._descend(start, deadline)
            if last is None:
                return None
            if last.fits:
                exact = rounded(last, whole=not self._measured)
                if exact is not None and all(satisfies(exact, network) for network in self._networks):
                    return exact
            if best is None or last.slack.sum() < best.slack.sum():
                best = last
        return None

    def _descend(self, boxes: Boxes, deadline: Deadline) -> Placement | None:
        """Move boxes from a start until they fit or stop improving, and return the placement; None if time ran out.

        Pairs that stay out of their pieces weigh more with every move, and types are chosen at random to some degree
        after the first moves, so that the search does not stay where no single choice helps.
        """
        weights = np.ones(len(self._pairs.ids))
        best: Placement | None = None
        for move in range(MAX_MOVES):
            kinds = self._nearest(boxes, loosely=move > 2)[0]
            pieces = []
            for permitted, kind in zip(self._pairs.ids.tolist(), kinds.tolist(), strict=True):
                if deadline.passed:
                    return None
                if (permitted, kind) not in self._pieces:
                    piece = piece_around(self._pairs.sets[permitted], kind, self._order)
                    self._pieces[permitted, kind] = piece
                pieces.append(self._pieces[permitted, kind])
            placement = place(boxes, self._pairs.pairs, pieces, weights, self._margin, deadline)
            if placement is None:
                return None
            if placement.fits:
                return placement
            if best is None or placement.slack.sum() < best.slack.sum():
                best = placement
            weights[placement.slack > FEASIBLE] += 1
            boxes = placement.boxes
        return best

    def _nearest(self, boxes: Boxes, loosely: bool = False) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return for each pair the nearest permitted type and its distance from the boxes, both of shape (pairs,)."""
        types, pairs = pair_types(), self._pairs.pairs
        ends = np.concatenate([boxes[pairs[:, 0]], boxes[pairs[:, 1]]], axis=1)
        differences = np.einsum("pea,ke->pak", ends, COMPARED)[:, :, None]  # (pairs, 2, 1, 5)
        below, above = types.orders == LESS, types.orders == GREATER
        off = np.where(below, differences, np.where(above, -differences, np.abs(differences)))
        off += np.where(below | above, self._margin / 2, 0.0)
        on_axes = np.maximum(off, 0).sum(axis=3)  # (pairs, 2, 17)
        missed = on_axes[:, 0, types.axes[:, 0]] + on_axes[:, 1, types.axes[:, 1]]
        if self._measured:
            distances = np.hypot(differences[:, 0, 0, -1], differences[:, 1, 0, -1])[:, None]
            reaches = np.maximum(BOUNDS[:-1] - distances, 0) + np.maximum(distances - BOUNDS[1:], 0)
            missed += reaches[:, types.reaches]
        missed[~self._permitted] = np.inf
        weighed = missed * np.exp(self._rng.normal(0, 0.5, missed.shape)) if loosely else missed
        nearest = weighed.argmin(axis=1)
        return nearest, np.take_along_axis(missed, nearest[:, None], axis=1)[:, 0]

    def _random(self) -> Boxes:
        size = (self._pairs.size, 1, 2)
        centres, halves = self._rng.normal(0, 2, size), np.exp(self._rng.normal(0, 1, size))
        return np.concatenate([centres - halves, centres + halves], axis=1)

    def _shaken(self, placement: Placement) -> Boxes:
        """Return the boxes, with some of the pairs out of place moved at random."""
        wrong = np.unique(self._pairs.pairs[placement.slack > FEASIBLE])
        some = wrong[self._rng.random(len(wrong)) < 0.5]
        moved = placement.boxes.copy()
        spread = np.ptp(moved.mean(axis=1), axis=0) / 2 + self._margin
        moved[some] += self._rng.normal(0, 1, (len(some), 1, 2)) * spread
        return moved

    def _sized(self, boxes: Boxes) -> Boxes:
        """Return the boxes scaled to the size that fits the distances best."""
        if not self._measured or not len(self._pairs.ids):
            return boxes
        sizes: list[Boxes] = [boxes * 2.0**scale for scale in range(-6, 5)]
        return min(sizes, key=lambda sized: float(self._nearest(sized)[1].sum()))


def _ranked(scenario: Network) -> Boxes:
    """Return boxes whose end points are their ranks in a scenario of the rectangle algebra; shape (n, 2, 2)."""
    n, types = scenario.size, pair_types()
    orders = dict(zip((types.atoms["ra"] // 13).tolist(), types.orders[types.axes[:, 0], :4].tolist(), strict=True))
    below = np.zeros((2, 2 * n, 2 * n), dtype=np.bool_)
    below[:, 2 * np.arange(n), 2 * np.arange(n) + 1] = True
    for c in scenario.constraints:
        for axis, interval in enumerate(divmod(c.relation.bit_length() - 1, 13)):
            for k, order in enumerate(orders[interval]):
                a, b = 2 * c.first + k // 2, 2 * c.second + k % 2
                below[axis, a, b], below[axis, b, a] = order == LESS, order == GREATER
    ranks = np.stack([np.unique(counts, return_inverse=True)[1] for counts in below.sum(axis=1)])
    return ranks.reshape(2, n, 2).transpose(1, 2, 0).astype(np.float64)
