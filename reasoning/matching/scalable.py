"""The scalable engine: annealing by blocks from several starts, then moves and swaps until none helps.

It proves nothing, and is for any size: its work for a step grows with the block, the facts and the things, and it
holds little more than the tables. What it finds does not depend on the clock, unless the deadline cuts it short, nor in
quality on the order of the objects.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.matching.annealing import NOISE, anneal, climb
from deixis.reasoning.matching.branching import evaluate
from deixis.reasoning.matching.compiled import Compiled, compile_problem, to_assignment, to_labels
from deixis.reasoning.matching.problem import Problem

HOT, COLD = 0.3, 0.05  # first and last temperature, in units of the mean range of a table
LEVELS = 40  # temperatures on the way
STEPS = 160  # blocks matched anew at each temperature
LEAST_BLOCK, MOST_BLOCK = 4, 128  # objects of a block: a quarter of all, within these
STARTS = 3
WORK = 4e6  # cells of blocks at each temperature over all starts, about: large problems get fewer starts


@dataclass(frozen=True, eq=False)
class Found:
    """The best map found (n1,), its value, and whether the deadline left time for all starts."""

    assignment: NDArray[np.int64]
    value: float
    finished: bool


def scalable(
    problem: Problem,
    deadline: float = math.inf,
    *,
    seed: int = 0,
    effort: float = 1.0,
    start: NDArray[np.int64] | None = None,
) -> Found:
    """A map of high value until ``deadline`` (``time.perf_counter``), never worse than ``start`` (default: nobody).

    ``effort`` multiplies the steps. Raises MatchingError where ``start`` is no map of the problem.

    >>> tables = np.array([[[0, 1], [0, 0]]], np.float32)
    >>> problem = Problem(np.array([[0, 1]]), np.array([0]), tables, np.zeros((2, 2)), np.full(2, -1.0))
    >>> found = scalable(problem)
    >>> found.assignment.tolist(), found.value
    ([0, 1], 1.0)
    """
    n1, n2 = problem.unary.shape
    if start is not None:
        problem.require_map(start)
    best = np.full(n1, n2) if start is None else to_labels(start, n2)
    finished = True
    if n1 and n2:
        best, finished = search_from(best, compile_problem(problem), deadline, seed, effort, STARTS)
    assignment = to_assignment(best, n2)
    return Found(assignment, problem.value(assignment), finished)


def search_from(
    labels: NDArray[np.int64], compiled: Compiled, deadline: float, seed: int, effort: float, most: int
) -> tuple[NDArray[np.int64], bool]:
    """The best of at most ``most`` starts, the first from ``labels`` (n1,), and whether all came to their end."""
    rng = np.random.default_rng(seed)
    noise = rng.gumbel(size=NOISE)
    n1, width = compiled.unary.shape
    block = min(max(LEAST_BLOCK, n1 // 4), MOST_BLOCK)
    starts = int(np.clip(WORK / (STEPS * block * width), 1, most))
    best, best_value = labels, evaluate(labels, compiled)
    for number in range(starts):
        current = labels.copy() if number == 0 else np.full(n1, width - 1)
        found = current.copy()
        whole = _cool(current, found, compiled, deadline, block, noise, rng, max(1, round(effort * STEPS)))
        climb(found, compiled)
        value = evaluate(found, compiled)
        if value > best_value:
            best, best_value = found, value
        if not whole:
            return best, False
    return best, True


def _cool(
    current: NDArray[np.int64],
    best: NDArray[np.int64],
    compiled: Compiled,
    deadline: float,
    block: int,
    noise: NDArray[np.float64],
    rng: np.random.Generator,
    steps: int,
) -> bool:
    """One annealing from hot to cold; false where the deadline struck."""
    scale = mean_range(compiled)
    for temperature in [*np.geomspace(HOT, COLD, LEVELS), 0.0]:
        if time.perf_counter() > deadline:
            return False
        anneal(current, best, compiled, steps, temperature * scale, block, noise, int(rng.integers(1 << 31)))
    return True


def mean_range(compiled: Compiled) -> float:
    """The mean over all facts of largest less least entry, or 1 where there is no fact that distinguishes."""
    if len(compiled.kind) == 0:
        return 1.0
    spans = compiled.tables.max(axis=(1, 2)) - compiled.tables.min(axis=(1, 2))
    return float(spans[compiled.kind].mean()) or 1.0
