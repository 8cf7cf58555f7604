"""Grounding where the side is not certain: the map as seen from the likeliest side, its probabilities over all sides.

The probability of a match is the sum over sides of p(side) p(match | side): what holds from a side that is itself
doubtful is no more probable than the side.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.engines import Alignment, Engine
from deixis.reasoning.evidence import Evidence
from deixis.reasoning.matching.posterior import Posterior, posterior

FIRST = 0.5
"""Share of the time for the likeliest side, which is all the answer where there is no time for others."""


@dataclass(frozen=True, eq=False)
class OtherSide:
    """How probable another side is, and the same description beside the scene as seen from there."""

    probability: float
    evidence: Evidence


@dataclass(frozen=True, eq=False)
class FromSides:
    """An engine that aligns as seen from the side of its evidence, which has a ``probability``, with the ``others``."""

    engine: Engine
    probability: float
    others: tuple[OtherSide, ...]

    def align(self, evidence: Evidence, deadline: float) -> Alignment:
        now = time.perf_counter()
        found = self.engine.align(evidence, now + FIRST * (deadline - now))
        if found.posterior is None or not self.others:
            return found
        parts = [(self.probability, found.posterior), *self._others(evidence, deadline)]
        looked = sum(share for share, _ in parts)
        note = f"a match is as probable as from all sides looked from: {len(parts)}, together {looked:.2f} probable"
        return replace(found, posterior=_mixed(parts), sides=len(parts), notes=(*found.notes, note))

    def _others(self, evidence: Evidence, deadline: float) -> list[tuple[float, Posterior]]:
        """From each other side, as far as the time allows: its probability, and what it makes of the matches."""
        found = []
        for number, side in enumerate(self.others):
            now = time.perf_counter()
            if now > deadline:
                break
            seen = side.evidence.reordered(*_as_in(evidence, side.evidence)).problem
            there = posterior(seen, now + (deadline - now) / (len(self.others) - number))
            if np.isfinite(there.error):
                found.append((side.probability, there))
        return found


def _mixed(parts: list[tuple[float, Posterior]]) -> Posterior:
    """The sum by probabilities; sides that nobody looked from add nothing, so that it is at least so probable."""
    marginals = np.sum([share * there.marginals for share, there in parts], axis=0)
    return Posterior(
        marginals, all(there.exact for _, there in parts), sum(share * there.error for share, there in parts)
    )


def _as_in(evidence: Evidence, other: Evidence) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where the objects and the things of one evidence stand in another."""
    rows = [other.description.index(name) for name in evidence.description.nodes]
    columns = [other.scene.index(name) for name in evidence.scene.nodes]
    return np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64)
