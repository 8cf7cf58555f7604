"""Beliefs that ladders of chains start from: of one run of belief propagation, or of several in a large scene.

In a large scene, belief propagation has many fixed points: a part whose neighbourhoods repeat, such as a row of similar
places, may be settled one place beside its own, and chains do not leave it. Runs with different divisions of the things
settle different parts wrongly, but most of them agree on what is right. So their mean is a good start of one more run.

The value of a run is that of the best map of its beliefs. Half of the ladders start from the runs in proportion to the
exponential of the values, in units of the square root of the number of objects: the values of the maps of a posterior
differ by that order. The other half is divided evenly. Ladders therefore disagree on what the runs disagree on, and
their error is large there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior.sampling import map_value
from deixis.reasoning.grounding.matching.problem import Compiled
from deixis.reasoning.grounding.matching.search.belief_propagation import beliefs_with_places, likeliest_map
from deixis.reasoning.grounding.matching.search.coarse_to_fine import CoarseToFine, is_large

Array = NDArray[np.float64]

RUNS = 4
"""Maximum number of independent runs; one more starts from their mean."""

EVEN_SHARE = 0.5
"""Share that is divided evenly among the runs, because the best run may have settled a part wrongly too."""

SECONDS_OF_REFINEMENT = 0.8
"""Approximate duration of a refinement, in units of that of a run."""


@dataclass(frozen=True, eq=False)
class Starts:
    """Beliefs of R runs of belief propagation about n1 objects and n2 things.

    Attributes
    ----------
    problem
        Problem with the places of absent objects of the run with the largest value.
    runs
        Beliefs of each run, shape (R, n1, n2 + 1).
    values
        Value of the best map of each run's beliefs, in nats, shape (R,).
    """

    problem: Compiled
    runs: tuple[NDArray[np.float32], ...]
    values: Array

    @property
    def shares(self) -> Array:
        """Share of each run, shape (R,), with sum 1."""
        by_value = np.exp((self.values - self.values.max()) / math.sqrt(max(len(self.runs[0]), 1)))
        shares: Array = (1.0 - EVEN_SHARE) * by_value / by_value.sum() + EVEN_SHARE / len(by_value)
        return shares

    @property
    def is_large(self) -> bool:
        """True if belief propagation went from coarse to fine, because the scene is large."""
        return is_large(self.problem)

    @property
    def beliefs(self) -> Array:
        """Mean beliefs of the runs, weighted by their shares, shape (n1, n2 + 1)."""
        mean = np.zeros(self.runs[0].shape)
        for share, run in zip(self.shares, self.runs, strict=True):
            mean += share * run
        return mean

    def of_ladders(self, ladders: int) -> list[int]:
        """Return the run that each ladder starts from, in proportion to the shares of the runs.

        Parameters
        ----------
        ladders
            Number of ladders.

        Returns
        -------
        list of int
            Number of a run for each ladder.
        """
        middles = (np.arange(ladders) + 0.5) / ladders
        chosen: list[int] = np.minimum(np.searchsorted(np.cumsum(self.shares), middles), len(self.runs) - 1).tolist()
        return chosen


def starts_of(problem: Compiled, places: NDArray[np.float32] | None, deadline: Deadline) -> Starts:
    """Run belief propagation, several times from coarse to fine where a scene is large and the time suffices.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    places
        Likelihood ratios of the facts at the places of absent objects, shape (2k, g, n2); None where they have none.
    deadline
        End of the time limit; the first run takes place even without time.

    Returns
    -------
    Starts
        The beliefs and the problem with the places of absent objects.
    """
    with threadpool_limits(1, "blas"):
        if not is_large(problem):
            beliefs, placed = beliefs_with_places(problem, places, deadline)
            return Starts(placed, (beliefs,), np.array([0.0]))
        propagation, before = CoarseToFine(problem, places), deadline.left
        found = _with_run(None, *propagation.beliefs(deadline), deadline)
        seconds = before - deadline.left if math.isfinite(before) else 0.0
        while len(found.runs) < RUNS:
            # The second run shows where the first is wrong, so time is reserved for a refinement only after it.
            needed = 1.0 if len(found.runs) == 1 else 1.0 + SECONDS_OF_REFINEMENT
            if deadline.left <= needed * seconds:
                break
            found = _with_run(found, *propagation.beliefs(deadline, seed=len(found.runs)), deadline)
        if len(found.runs) > 1 and deadline.left > SECONDS_OF_REFINEMENT * seconds:
            found = _with_run(found, *propagation.refined(found.beliefs.astype(np.float32), deadline), deadline)
    return found


def _with_run(starts: Starts | None, beliefs: NDArray[np.float32], placed: Compiled, deadline: Deadline) -> Starts:
    """Return the starts with one more run: its beliefs (n1, n2 + 1), and the problem with its places."""
    value = map_value(likeliest_map(beliefs, placed, deadline), placed)
    if starts is None:
        return Starts(placed, (beliefs,), np.array([value]))
    best = placed if value > starts.values.max() else starts.problem
    return Starts(best, (*starts.runs, beliefs), np.append(starts.values, value))
