"""What an engine is and what it returns: the protocol, and the alignment of a description with a scene."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.evidence.evidence import Evidence
from deixis.reasoning.grounding.similarity import (
    graph_similarity,
)

if TYPE_CHECKING:
    from deixis.reasoning.grounding.hypotheses import Verdict
    from deixis.reasoning.grounding.matching.posterior import Posterior


@dataclass(frozen=True, eq=False)
class Alignment:
    """What an engine found: ``assignment`` (n1,) into the scene or ``UNMATCHED``, and how it came about."""

    engine: str
    assignment: NDArray[np.int64]
    matrix: NDArray[np.float64]  # (n1, n2) node similarities, Frobenius norm 1, or 0
    converged: bool
    proved_best: bool
    notes: tuple[str, ...] = ()
    finished: bool = True  # whether the time limit left the search its course
    gap: float = math.inf  # by how much another map may be more likely (log) at most; infinite where nobody knows
    verdict: Verdict | None = None  # over maps, sides and scenes: of engines that work with likelihoods
    seen: Evidence | None = None  # from the side from which the assignment is read, where that is not the evidence's
    margins: NDArray[np.float64] | None = None  # (n1,) what the next best choice for each would lose; nan: not known
    runners_up: NDArray[np.int64] | None = None  # (n1,) that choice, or UNMATCHED

    @property
    def posterior(self) -> Posterior | None:
        """The posterior of matches over all hypotheses."""
        return None if self.verdict is None else self.verdict.posterior

    @property
    def of_another(self) -> bool:
        """Whether the description is probably of another scene, so that only what labels tell is matched."""
        return self.verdict is not None and self.verdict.fits < 0.5

    @property
    def graph_similarity(self) -> float:
        return graph_similarity(self.matrix, self.assignment)


class Engine(Protocol):
    """Aligns the description with the scene until ``deadline``."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment: ...
