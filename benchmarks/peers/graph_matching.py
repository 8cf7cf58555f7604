"""Solve by SM, RRWM and IPFP of pygmtools, on the affinity of all pairs of matches (small problems only)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.engines.similarity import assign
from deixis.reasoning.grounding.matching.problem import Problem

MOST_CELLS = 2_000  # number of matches; the affinity has its square


@dataclass(frozen=True)
class Settings:
    """The settings of a solver.

    The solvers need affinities of at least 0: negative ones are set to 0 or, if ``shifted``, each fact's table is
    raised until none is negative.
    """

    solver: str
    shifted: bool = False
    options: tuple[tuple[str, float], ...] = ()  # arguments of the function of pygmtools

    def __str__(self) -> str:
        how = "affinities shifted" if self.shifted else "affinities clipped"
        return ", ".join([how, *(f"{name} {value:g}" for name, value in self.options), "else defaults"])


BEST = (
    Settings("sm"),
    Settings("rrwm", shifted=True, options=(("alpha", 0.4), ("beta", 30.0))),
    Settings("ipfp", shifted=True),
)
"""The settings that name most objects right in ``bench_peers.py``."""


def solve(problem: Problem, settings: Settings) -> NDArray[np.int64]:
    """Return one solver's map; raise ImportError if pygmtools is not installed.

    The solvers match as many objects as possible.
    """
    import pygmtools  # type: ignore[import-not-found, unused-ignore]

    n1, n2 = problem.unary.shape
    allowed = problem.allowed
    affinity = np.zeros((n2, n1, n2, n1))  # pygmtools lists matches by thing, then by object
    lowest = problem.tables.min(axis=(1, 2), keepdims=True, initial=0.0)
    tables = problem.tables - lowest if settings.shifted else np.maximum(problem.tables, 0.0)
    for (s, o), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
        affinity[:, s, :, o] += tables[kind]
        affinity[:, o, :, s] += tables[kind].T
    matches = affinity.reshape(n1 * n2, n1 * n2)
    np.fill_diagonal(matches, np.maximum(np.where(allowed, problem.unary, 0.0), 0.0).T.ravel())
    solver = getattr(pygmtools, settings.solver)
    with np.errstate(divide="ignore", invalid="ignore"):  # IPFP divides by 0 where a step gains nothing
        soft = solver(matches.astype(np.float32), n1=n1, n2=n2, backend="numpy", **dict(settings.options))
    return assign(np.asarray(soft, dtype=np.float64), allowed)
