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
    posterior: Posterior | None = None  # of engines that work with likelihoods
    sides: int = 1  # from so many sides, each by its probability
    of_another: bool = False  # whether nothing is matched because the description is probably of another scene
    margins: NDArray[np.float64] | None = None  # (n1,) what the next best choice for each would lose; nan: not known
    runners_up: NDArray[np.int64] | None = None  # (n1,) that choice, or UNMATCHED

    @property
    def graph_similarity(self) -> float:
        return graph_similarity(self.matrix, self.assignment)


class Engine(Protocol):
    """Aligns the description with the scene until ``deadline``."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment: ...
