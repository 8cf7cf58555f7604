"""Protocol of engines, and the alignment of a description with a scene that they return."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.engines.similarity import (
    graph_similarity,
)
from deixis.reasoning.grounding.evidence.evidence import Evidence

if TYPE_CHECKING:
    from deixis.reasoning.grounding.hypotheses.hypotheses import Verdict
    from deixis.reasoning.grounding.matching.posterior.posterior import Posterior


@dataclass(frozen=True, eq=False)
class Alignment:
    """Result of an engine for n1 objects and n2 things: the assignment, and how certain it is."""

    engine: str
    assignment: NDArray[np.int64]  # (n1,) the thing of each object, or UNMATCHED
    matrix: NDArray[np.float64]  # (n1, n2) node similarities with Frobenius norm 1, or all 0
    converged: bool  # whether the node similarities converged
    proved_best: bool
    notes: tuple[str, ...] = ()
    finished: bool = True  # whether the search ended before the time limit
    gap: float = math.inf  # upper bound in nats on how much likelier another map may be; infinite where unknown
    verdict: Verdict | None = None  # posterior over maps, sides and scenes; None of engines without likelihoods
    seen: Evidence | None = None  # evidence from the side of the assignment, where that is not the stated side
    margins: NDArray[np.float64] | None = None  # (n1,) loss of the next best choice of each object; nan: unknown
    runners_up: NDArray[np.int64] | None = None  # (n1,) next best choice of each object, or UNMATCHED

    @property
    def posterior(self) -> Posterior | None:
        """Posterior of the matches over all hypotheses; None of engines without likelihoods."""
        return None if self.verdict is None else self.verdict.posterior

    @property
    def of_another(self) -> bool:
        """True where the description is probably of another scene, so that only labels give matches."""
        return self.verdict is not None and self.verdict.fits < 0.5

    @property
    def graph_similarity(self) -> float:
        """Overall similarity of the two graphs under the assignment, in [0, 1]."""
        return graph_similarity(self.matrix, self.assignment)


class Engine(Protocol):
    """Method that aligns a description with a scene."""

    def align(self, evidence: Evidence, deadline: Deadline) -> Alignment:
        """Find the best alignment of a description with a scene.

        Parameters
        ----------
        evidence
            Log-likelihood ratios of n1 objects and n2 things, and of pairs.
        deadline
            Time limit.

        Returns
        -------
        Alignment
            The best alignment found, and whether it is proved.
        """
        ...
