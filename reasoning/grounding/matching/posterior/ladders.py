"""Marginals and evidence of large problems: ladders of Markov chains that run until they agree.

A ladder is a set of chains from the posterior's own temperature to one at which chains mix within a few sweeps
(``sampling.py``). Several ladders begin at different maps, drawn by belief propagation, and are cooled. Their
difference is the error of each object's marginals: where a chain is stuck, or had no time to mix, the ladders differ
and the error is large (between-chain variance; Gelman and Rubin 1992).
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.posterior.exchangeable import averaged
from deixis.reasoning.grounding.matching.posterior.sampling import (
    Chains,
    Guide,
    begin,
    cool,
    guide_by,
    new_chains,
    sample,
)
from deixis.reasoning.grounding.matching.posterior.starts import Starts, starts_of
from deixis.reasoning.grounding.matching.problem import Compiled, Problem
from deixis.reasoning.grounding.matching.search.belief_propagation import likeliest_map
from deixis.reasoning.grounding.matching.search.coarse_to_fine import CoarseToFine, is_large

Array = NDArray[np.float64]

LADDERS = 8

RUNGS_PER_ROOT, MIN_RUNGS, MAX_CHAIN_OBJECTS = 1.6, 3, 1600
"""Number of temperatures of a full ladder per square root of the number of objects; minimum number; and maximum number
of objects in all chains of a ladder, which may end a ladder before the hottest temperature."""

MIN_COLDNESS = 0.3
"""Coldness at which chains mix within a few sweeps: that of the hottest chain, and of all chains at the start."""

WARM_COLDNESS = 0.7
"""Coldness of all chains at the start where a ladder cannot have all temperatures: hotter chains lose more of what
belief propagation found than they find again while they are cooled."""

COOLING_TURNS, COOLING_SWEEPS, COOLING_SHARE = 200, 5, 0.5
"""Number of turns that cool every chain from MIN_COLDNESS to its own coldness, sweeps per turn, and share of the time;
where the time is short, turns are skipped evenly."""

FIRST_SWEEPS = 50
"""Sweeps of the first two parts of a run; the next two parts are twice as long, and so on."""

TOLERANCE = 0.007
"""Error of the marginals at which sampling stops."""

PROPOSALS, MAX_PROPOSALS = 2e5, 4e8
"""Maximum number of proposals for each object in all chains, and for all objects."""

BELIEF_DRAWS = 8.0
"""Number of independent draws that the beliefs count as when marginals are estimated."""

PROPOSALS_PER_CLOCK_CHECK = 5e4

GUIDE_SHARE, COARSE_GUIDE_SHARE = 0.2, 0.6
"""Shares of the time that the guide may take: of dense belief propagation, and of that from coarse to fine."""

CHAINS_SHARE = 0.9
"""Share of the time after the guide that the chains may take; the rest is for comparing them."""

EVIDENCE_TOLERANCE = 0.2
"""Error of a log evidence, in nats, at which sampling stops."""


class Sampled(NamedTuple):
    """Sampled marginals of n1 objects and n2 things, and what they rest on."""

    marginals: Array  # (n1, n2 + 1): the last column is the probability of absence
    errors: Array  # (n1,): standard error of each object's marginals, infinite where no chains were compared
    problem: Compiled  # with the places of absent objects


def sampled_marginals(
    problem: Compiled,
    groups: tuple[tuple[int, ...], ...],
    deadline: Deadline,
    seed: int,
    places: NDArray[np.float32] | None = None,
) -> Sampled:
    """Estimate the marginals by sampling, and the error of each object's marginals.

    Ladders run in parts, each two parts twice as long as the two before, until the last two parts of all ladders agree
    within ``TOLERANCE``; earlier parts are discarded as burn-in. Where the deadline leaves time for less than two
    parts, the marginals are those of belief propagation, and their errors are infinite.

    Parameters
    ----------
    problem
        The problem in the layout of compiled loops.
    groups
        Groups of exchangeable objects, which get the same marginals.
    deadline
        End of the time limit.
    seed
        Seed of the random numbers.
    places
        Likelihood ratios of the facts at the places of absent objects, shape (2k, g, n2); None where they have none.

    Returns
    -------
    Sampled
        Marginals, shape (n1, n2 + 1), the standard error of each object's, shape (n1,), and the problem with the places
        of absent objects.
    """
    n1 = len(problem.unary)
    steps = max(RUNGS_PER_ROOT * math.sqrt(n1), MIN_RUNGS)
    rungs = max(int(min(steps, MAX_CHAIN_OBJECTS / n1)), MIN_RUNGS)
    coldness = 1.0 - (1.0 - MIN_COLDNESS) * np.arange(rungs) / (steps - 1)
    run, beliefs = _start(problem, np.maximum(coldness, MIN_COLDNESS), deadline, seed, places)
    beliefs = averaged(beliefs, groups)
    marginals, errors = beliefs, np.full(n1, math.inf)
    left = min(PROPOSALS, MAX_PROPOSALS / n1) / (LADDERS * rungs)
    parts: list[_Part] = []
    for number, part in enumerate(run.parts(left)):
        part.counts[:] /= np.float32(part.sweeps)
        parts = [*parts[-1:], _Part(part.sweeps, averaged(part.counts, groups) if groups else part.counts, part.values)]
        marginals, errors = _agreement(parts, beliefs)
        if number and errors.max() <= TOLERANCE:
            break
    return Sampled(marginals, errors, run.problem)


def log_evidence(problem: Problem, deadline: Deadline = Deadline.never(), *, seed: int = 0) -> tuple[float, float]:
    """Return the log-likelihood ratio in nats of the evidence against chance over all allowed maps, and its error.

    It is the logarithm of the sum over all maps of the exponential of their values, minus that sum with the costs of
    absence alone. The error is estimated from the differences of ladders and from a coarser integration rule.

    Parameters
    ----------
    problem
        The problem of n1 objects and n2 things.
    deadline
        End of the time limit.
    seed
        Seed of the random numbers.

    Returns
    -------
    tuple
        The ratio and its standard error, in nats; NaN and infinity where the deadline left no time.

    Examples
    --------
    >>> ends, nothing = np.zeros((0, 2), np.int64), np.zeros((0, 1, 1), np.float32)
    >>> alone = Problem(ends, ends[:, 0], nothing, np.array([[-2.0]]), np.array([-9.0]))
    >>> value, error = log_evidence(alone)
    >>> abs(value + 2.0) < 0.1, error < EVIDENCE_TOLERANCE
    (True, True)
    """
    n1, n2 = problem.unary.shape
    if not n1 or not n2:
        return 0.0, 0.0
    rungs = int(max(2 * RUNGS_PER_ROOT * math.sqrt(n1), 4 * MIN_RUNGS)) | 1
    coldness = np.linspace(1.0, 0.0, rungs) ** 1.5
    run, _ = _start(problem.compiled, coldness, deadline, seed)
    found, error = math.nan, math.inf
    for part in run.parts(min(PROPOSALS, MAX_PROPOSALS / n1) / (LADDERS * rungs)):
        means = part.values / part.sweeps
        fine, coarse = (-np.trapezoid(means[:, ::step], coldness[::step], axis=1) for step in (1, 2))
        found = float(fine.mean())
        error = float(fine.std(ddof=1) / math.sqrt(LADDERS) + abs(fine.mean() - coarse.mean()) / 3)
        if error <= EVIDENCE_TOLERANCE:
            break
    return found, error


def warm() -> None:
    """Compile the chains, or load their compiled code, so that a time limit is spent on running them."""
    tables, ends = np.zeros((1, 2, 2), np.float32), np.array([[0, 1]])
    tiny = Problem(ends, np.array([0]), tables, np.zeros((2, 2)), np.zeros(2))
    next(_start(tiny.compiled, np.array([1.0, 0.5]), Deadline.never(), 0)[0].parts(1.0))
    likeliest_map(CoarseToFine(tiny.compiled, None).beliefs()[0], tiny.compiled)


@dataclass(frozen=True, eq=False)
class _Part:
    """Counts and values of all ladders over a number of sweeps."""

    sweeps: int
    counts: NDArray[np.float32]  # (LADDERS, n1, n2 + 1): how often, or in which share, each object was each thing
    values: Array  # (LADDERS, K): sums


@dataclass(frozen=True, eq=False)
class _Run:
    """Running ladders, in as many threads as there are processors."""

    starts: Starts
    guide: Guide
    ladders: tuple[Chains, ...]
    seed: int
    deadline: Deadline

    @property
    def problem(self) -> Compiled:
        """Problem with the places of absent objects."""
        return self.starts.problem

    @property
    def first_coldness(self) -> float:
        """Coldness of all chains at the start."""
        last = float(self.ladders[0].coldness[-1])
        return WARM_COLDNESS if self.starts.is_large and last > WARM_COLDNESS else min(MIN_COLDNESS, last)

    @property
    def rungs(self) -> int:
        """Number of chains of a ladder."""
        return len(self.ladders[0].coldness)

    def parts(self, most: float) -> Iterator[_Part]:
        """Yield one part after another, until the ``most`` sweeps, or until the deadline, which cuts the last short."""
        with ThreadPoolExecutor(min(LADDERS, os.cpu_count() or 1)) as pool:
            if not self._cool(pool):
                return
            done = 0
            for number in count():
                sweeps = FIRST_SWEEPS << (number // 2)
                if number > 1 and done + sweeps > most:
                    return
                part = self._sampled(pool, number, sweeps)
                done += part.sweeps
                if part.sweeps:
                    yield part
                if part.sweeps < sweeps:
                    return

    def _cool(self, pool: ThreadPoolExecutor) -> bool:
        """Begin the ladders and cool their chains, faster where time is short; return False where there is no time."""
        seeds, guides = np.random.default_rng([self.seed, 0]), [self.guide] * LADDERS
        if self.starts.is_large:
            runs = [guide_by(run, self.problem.allowed, 1.0) for run in self.starts.runs]
            guides = [runs[run] for run in self.starts.of_ladders(LADDERS)]
        for chains, guide in zip(self.ladders, guides, strict=True):
            if self.deadline.passed:
                return False
            begin(chains, self.problem, guide, int(seeds.integers(1 << 30)))
        until = self.deadline.share(COOLING_SHARE)
        seconds, progress = until.left, 0.0
        turns = COOLING_TURNS * min(1.0, (1.0 - self.first_coldness) / (1.0 - MIN_COLDNESS))
        at_once = max(1, int(PROPOSALS_PER_CLOCK_CHECK / (COOLING_SWEEPS * self.rungs * len(self.problem.unary))))
        while progress < 1.0:
            if self.deadline.passed:
                return False
            elapsed = 1.0 - until.left / seconds if 0.0 < seconds < math.inf else 0.0
            steps: list[float] = []
            drawn: list[list[int]] = []
            while progress < 1.0 and len(steps) < at_once:
                progress = min(1.0, max(progress + 1.0 / turns, elapsed))
                steps.append(progress)
                drawn.append(seeds.integers(1 << 30, size=LADDERS).tolist())
            list(pool.map(self._cool_some_turns, self.ladders, zip(*drawn, strict=True), [steps] * LADDERS))
        return True

    def _cool_some_turns(self, chains: Chains, seeds: tuple[int, ...], steps: list[float]) -> None:
        hottest = self.first_coldness
        for seed, progress in zip(seeds, steps, strict=True):
            coldness = hottest + (chains.coldness - hottest) * progress
            cool(chains, self.problem, self.guide, coldness, COOLING_SWEEPS, seed)

    def _sampled(self, pool: ThreadPoolExecutor, number: int, sweeps: int) -> _Part:
        """Run all ladders for a number of sweeps, or until the deadline."""
        seeds = np.random.default_rng([self.seed, 1 + number])
        counts = np.zeros((LADDERS, *self.problem.unary.shape), np.float32)
        values, done = np.zeros((LADDERS, self.rungs)), 0
        at_once = max(1, int(PROPOSALS_PER_CLOCK_CHECK / (self.rungs * len(self.problem.unary))))
        while done < sweeps and not self.deadline.passed:
            turn = min(at_once, sweeps - done)
            drawn = seeds.integers(1 << 30, size=LADDERS).tolist()

            def run(number: int, turn: int = turn, drawn: list[int] = drawn) -> None:
                chains, seed = self.ladders[number], drawn[number]
                sample(chains, counts[number], values[number], self.problem, self.guide, turn, seed)

            list(pool.map(run, range(LADDERS)))
            done += turn
        return _Part(done, counts, values)


def _start(
    problem: Compiled, coldness: Array, deadline: Deadline, seed: int, places: NDArray[np.float32] | None = None
) -> tuple[_Run, Array]:
    """Return a run at those temperatures (K,), and the beliefs (n1, n2 + 1) that guide it."""
    share = COARSE_GUIDE_SHARE if is_large(problem) else GUIDE_SHARE
    starts = starts_of(problem, places, deadline.share(share))
    ladders, beliefs = tuple(new_chains(problem, coldness) for _ in range(LADDERS)), starts.beliefs
    guide = guide_by(beliefs, problem.allowed)
    return _Run(starts, guide, ladders, seed, deadline.share(CHAINS_SHARE)), beliefs


def _agreement(parts: list[_Part], beliefs: Array) -> tuple[Array, Array]:
    """Return the marginals (n1, n2 + 1) by the last parts, and the largest standard error of each object's (n1,).

    The error is the larger of the standard errors between ladders and between their parts. An object's effective sample
    size is that of independent draws with its error (Gelman and Rubin 1992), and the beliefs ``beliefs`` (n1, n2 + 1)
    count as ``BELIEF_DRAWS`` more draws. Where chains mix, they determine the result; where each is stuck at a map,
    they are a few draws, which show no probability near 0 or 1. An object that is the same thing in all draws gets the
    lower quartile of the effective sample sizes of the others.
    """
    sweeps = sum(part.sweeps for part in parts)
    mean, squared = np.zeros_like(beliefs), np.zeros_like(beliefs)
    for number in range(LADDERS):  # one after the other, to hold little
        mean += _mean_of(parts, number, sweeps) / LADDERS
    for number in range(LADDERS):
        squared += (_mean_of(parts, number, sweeps) - mean) ** 2
    squared /= LADDERS * (LADDERS - 1)
    if len(parts) > 1:
        halves, spread = LADDERS * len(parts), np.zeros_like(beliefs)
        for counts in (counts for part in parts for counts in part.counts):
            spread += (counts - mean) ** 2
        squared = np.maximum(squared, spread / (halves * (halves - 1)))
    variance, noise = (mean * (1.0 - mean)).sum(axis=1), squared.sum(axis=1)
    varied = variance > 1.0 / sweeps
    draws = np.divide(variance, noise, out=np.full(len(mean), np.inf), where=varied & (noise > 0))
    usual = np.quantile(draws[np.isfinite(draws)], 0.25) if np.isfinite(draws).any() else LADDERS
    draws = np.clip(np.where(np.isfinite(draws), draws, usual), 1.0, LADDERS * sweeps)[:, None]
    marginals = (draws * mean + BELIEF_DRAWS * beliefs) / (draws + BELIEF_DRAWS)
    errors = np.sqrt(squared.max(axis=1)) + 1.0 / (LADDERS * sweeps)
    return marginals, errors


def _mean_of(parts: list[_Part], number: int, sweeps: int) -> Array:
    """Return the shares of one ladder over all parts (n1, n2 + 1)."""
    mean: Array = np.sum([part.counts[number] * (part.sweeps / sweeps) for part in parts], axis=0)
    return mean
