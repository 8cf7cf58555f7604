"""Scalable search: annealing from several starts, reheating of the best map, then moves and swaps until none helps.

For many objects, a second search anneals the map of belief propagation, and the best parts of both maps are combined.
The search is for problems of any size and proves nothing: the work of a step grows with the number of things and of an
object's facts, and the memory is little more than the tables. The result does not depend on the clock, unless the
deadline cuts the search short, and its quality does not depend on the order of the objects.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.problem import Compiled, Problem, to_assignment, to_labels
from deixis.reasoning.grounding.matching.search.belief_propagation import likeliest_map, propagate
from deixis.reasoning.grounding.matching.search.coarse_to_fine import CoarseToFine, is_large
from deixis.reasoning.grounding.matching.search.local_search import (
    CELLS_PER_CLOCK_CHECK,
    NOISE_TABLE_SIZE,
    anneal,
    climb,
    combine,
    keep,
    move_pairs,
    reassign,
)

FIRST_TEMPERATURE, REHEATED_TEMPERATURE, LAST_TEMPERATURE = (
    0.25,
    0.2,
    0.06,
)  # temperatures in units of the mean range of a table: first, reheated, and last
LEVELS, REHEATED_LEVELS = 15, 10  # temperatures on the way down from the first, and from the second
SINGLE_TURN_LEVELS = 40  # where there is one turn only
QUICK_TEMPERATURE = 0.35  # the first temperature where sweeps are few: what cools fast freezes sooner
SWEEPS = 3600  # over all objects, in all; small problems and large ones get more, those of many cells get fewer
SMALL_PROBLEM_SWEEPS, MAX_SWEEPS, MANY_OBJECTS, MAX_CELLS = 180_000, 6_000, 100, 8e8
MAX_TURNS, TURN_CELLS = 13, 11_700  # many short turns for few objects, one long one for many
FRESH_SHARE = 0.3  # share of turns that start from an empty map; the others reheat the best map
PATIENCE = 20  # reassignments in a row without a gain that end the search
LAST_SWEEPS = 3  # sweeps without noise after the deadline
MIN_PROPAGATED_OBJECTS, MAX_ANNEALED_OBJECTS = (
    50,
    400,
)  # minimum and maximum number of objects for each of the two searches
PARALLEL_EFFORT, FOLLOWING_EFFORT = (
    0.8,
    0.4,
)  # of the sweeps, where there are both: to anneal from nothing, and what the other finds
MIN_PROPAGATION_EFFORT = 0.2  # below, belief propagation has too few steps
MAX_TIME_SHARE = 1.25  # times its equal share of the time left that a temperature may take


@dataclass(frozen=True, eq=False)
class Found:
    """Result of a scalable search."""

    assignment: NDArray[np.int64]  # (n1,) the best map found
    value: float
    finished: bool  # whether the search ended before the deadline


def scalable(
    problem: Problem,
    deadline: Deadline = Deadline.never(),
    *,
    seed: int = 0,
    effort: float = 1.0,
    start: NDArray[np.int64] | None = None,
) -> Found:
    """Search a map of high value, at least as good as the start.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    deadline
        End of the time limit; the best map so far is returned then.
    seed
        Seed of the random numbers.
    effort
        Factor on the number of steps; 1 is the full search.
    start
        Map to start from, shape (n1,); by default, all objects are absent.

    Returns
    -------
    Found
        The best map, its value, and whether the search ended before the deadline.

    Raises
    ------
    MatchingError
        ``start`` is not a map of the problem.

    Examples
    --------
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
        best, finished = search_from(best, problem.compiled, deadline, seed, effort, MAX_TURNS)
    assignment = to_assignment(best, n2)
    return Found(assignment, problem.value(assignment), finished)


def search_from(
    labels: NDArray[np.int64], compiled: Compiled, deadline: Deadline, seed: int, effort: float, most: int
) -> tuple[NDArray[np.int64], bool]:
    """Search from a map by annealing and belief propagation.

    For many objects, annealing and belief propagation have a thread each; for very many objects, only belief
    propagation is followed by annealing.

    Parameters
    ----------
    labels
        Map to start from, shape (n1,), with n2 for objects that are left out.
    compiled
        The problem in the layout of compiled loops.
    deadline
        End of the time limit.
    seed
        Seed of the random numbers.
    effort
        Factor on the number of steps; 1 is the full search.
    most
        Maximum number of turns of annealing.

    Returns
    -------
    tuple
        The best map found, shape (n1,), and whether the search ended before the deadline.
    """
    if len(labels) < MIN_PROPAGATED_OBJECTS or effort < MIN_PROPAGATION_EFFORT:
        return _annealed(labels, compiled, deadline, seed, effort, most)
    if len(labels) > MAX_ANNEALED_OBJECTS:
        return _propagated(labels, compiled, deadline, seed, effort, most)
    from concurrent.futures import ThreadPoolExecutor

    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, "blas"), ThreadPoolExecutor(1) as pool:
        beside = pool.submit(_annealed, labels, compiled, deadline, seed, PARALLEL_EFFORT * effort, most)
        best, finished = _propagated(labels, compiled, deadline, seed, effort, most)
        other, finished_too = beside.result()
    if combine(best, other, compiled) > 0.0:
        climb(best, compiled, deadline)
    return best, finished and finished_too


def _annealed(
    labels: NDArray[np.int64], compiled: Compiled, deadline: Deadline, seed: int, effort: float, most: int
) -> tuple[NDArray[np.int64], bool]:
    """Anneal in at most ``most`` turns, the first one from ``labels`` (n1,)."""
    n1, width = compiled.unary.shape
    rng, noise = _random_numbers(seed, width)
    scale, best, unmatched = mean_range(compiled), labels.copy(), np.full(n1, width - 1)
    plan, sweeps = turns_and_sweeps(n1, width)
    for turn, (hot, levels) in enumerate(plan[:most]):
        found = unmatched.copy() if turn and hot == FIRST_TEMPERATURE else best.copy()
        schedule = scale * _relative_temperatures(hot, levels)
        finished = _cool(found, compiled, deadline, schedule, max(1, round(effort * sweeps)), noise, rng)
        if not finished:
            anneal(keep(found, compiled), found, 0.0, compiled, LAST_SWEEPS, np.zeros(1), noise, np.array([seed]))
        combine(best, found, compiled)
        if not finished:
            return best, False
    climb(best, compiled, deadline)
    if reassign(best, compiled, PATIENCE, seed, deadline) > 0.0:
        climb(best, compiled, deadline)
    if not deadline.passed and move_pairs(best, compiled) > 0.0:
        climb(best, compiled, deadline)
    return best, not deadline.passed


def _random_numbers(seed: int, width: int) -> tuple[np.random.Generator, NDArray[np.float32]]:
    """Return a generator, and a table of Gumbel numbers that was drawn from it."""
    noise, state = _gumbel_table(seed, width)
    rng = np.random.default_rng(seed)
    rng.bit_generator.state = state
    return rng, noise


@lru_cache(maxsize=16)
def _gumbel_table(seed: int, width: int) -> tuple[NDArray[np.float32], Any]:
    """Return the table of Gumbel numbers of a seed, and the state of the generator after they were drawn."""
    rng = np.random.default_rng(seed)
    noise = rng.gumbel(size=NOISE_TABLE_SIZE + width).astype(np.float32)
    return noise, rng.bit_generator.state


@lru_cache(maxsize=16)
def _relative_temperatures(hot: float, levels: int) -> NDArray[np.float64]:
    """Return the temperatures of a turn, the last one zero, in units of the mean range of a table."""
    return np.append(np.geomspace(hot, LAST_TEMPERATURE, levels), 0.0)


def _propagated(
    labels: NDArray[np.int64], compiled: Compiled, deadline: Deadline, seed: int, effort: float, most: int
) -> tuple[NDArray[np.int64], bool]:
    """Anneal the map of belief propagation briefly, or where the time does not suffice for it, anneal in full.

    Where cooled belief propagation takes too long in a large scene, the map is that of beliefs from coarse to fine.
    """
    found = propagate(compiled, mean_range(compiled), deadline.share(0.5), effort=effort, seed=seed)
    if found is None and is_large(compiled) and not deadline.passed:
        beliefs, _ = CoarseToFine(compiled, None).beliefs(deadline.share(0.5), seed=seed)
        found = likeliest_map(beliefs, compiled, deadline)
    if found is None:
        return _annealed(labels, compiled, deadline, seed + 1, effort, most)
    climb(found, compiled, deadline)
    best = labels.copy()
    combine(best, found, compiled)
    return _annealed(best, compiled, deadline, seed + 1, FOLLOWING_EFFORT * effort, most)


def turns_and_sweeps(objects: int, width: int) -> tuple[list[tuple[float, int]], int]:
    """Return the first temperature and number of temperatures of each turn, and the sweeps per temperature.

    Parameters
    ----------
    objects
        Number n1 of objects.
    width
        Number of choices of an object, n2 + 1.

    Returns
    -------
    tuple
        Plan of the turns, and the number of sweeps. Temperatures are in units of :func:`mean_range`.
    """
    turns = int(np.clip(TURN_CELLS / objects**2, 1, MAX_TURNS))
    fresh = math.ceil(FRESH_SHARE * turns)
    enough = max(SWEEPS, SWEEPS * (objects / MANY_OBJECTS) ** 0.2, min(SMALL_PROBLEM_SWEEPS / objects, MAX_SWEEPS))
    sweeps = min(enough, MAX_CELLS / (objects * width))
    plan = [(FIRST_TEMPERATURE, LEVELS)] * fresh + [(REHEATED_TEMPERATURE, REHEATED_LEVELS)] * (turns - fresh)
    if turns == 1:
        plan = [(FIRST_TEMPERATURE if sweeps >= SWEEPS else QUICK_TEMPERATURE, SINGLE_TURN_LEVELS)]
    return plan, max(1, round(sweeps / sum(levels for _, levels in plan)))


def _cool(
    best: NDArray[np.int64],
    compiled: Compiled,
    deadline: Deadline,
    schedule: NDArray[np.float64],
    sweeps: int,
    noise: NDArray[np.float32],
    rng: np.random.Generator,
) -> bool:
    """Anneal once from ``best`` (n1,), which receives the best map; return false where the deadline cut it short.

    Each temperature gets at most ``MAX_TIME_SHARE`` times its share of the time left: a search with little time cools
    faster, and does not stop while it is hot. Where the steps at a temperature are few, one call makes those of several
    temperatures, because a call costs as much as some hundred steps.
    """
    state, ahead, finished = keep(best, compiled), 0.0, True
    part = max(1, int(CELLS_PER_CLOCK_CHECK / state.gains.size))
    together = max(1, part // sweeps)
    for level in range(0, len(schedule), together):
        if deadline.passed:
            return False
        temperatures = schedule[level : level + together]
        next_level = deadline.share(min(1.0, MAX_TIME_SHARE * len(temperatures) / (len(schedule) - level)))
        for done in range(0, sweeps, part):
            if next_level.passed:
                finished = False
                break
            seeds = rng.integers(1 << 31, size=len(temperatures))
            ahead = anneal(state, best, ahead, compiled, min(part, sweeps - done), temperatures, noise, seeds)
    return finished


def mean_range(compiled: Compiled) -> float:
    """Return the mean range of the facts' tables (largest minus least entry), or 1 where all of them are constant.

    Parameters
    ----------
    compiled
        The problem in the layout of compiled loops.

    Returns
    -------
    float
        Mean range in nats.
    """
    if len(compiled.kind) == 0:
        return 1.0
    tables = compiled.tables[: len(compiled.tables) // 2]  # each comes again transposed
    spans = tables.max(axis=(1, 2)) - tables.min(axis=(1, 2))
    return float(spans[compiled.kind % len(tables)].mean()) or 1.0
