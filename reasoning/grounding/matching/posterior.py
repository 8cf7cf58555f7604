"""The posterior of matches: by enumeration where few maps count, else by sampling.

The probability of a map is proportional to the exponential of its value. The sum over all maps but a stated mass is
exact (``summing.py``). Whether it can be had is judged from sums that leave out more, which cost little. Else several
ladders of Markov chains, from independent starts, are run twice as long each time until they agree (``sampling.py``);
what they differ by is the stated error. Objects that are exchangeable have one marginal, so that no chain has to visit
all of their orders.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deixis.deadline import Deadline
from deixis.reasoning.grounding.matching.enumeration import add_up, factors
from deixis.reasoning.grounding.matching.problem import Compiled, MatchingError, Problem, to_assignment, to_labels
from deixis.reasoning.grounding.matching.sampling import Ladder, ladder, most_said_twice, sample
from deixis.reasoning.grounding.matching.scalable import search_from

Facts = list[Counter[tuple[int, bool, int]]]  # of each object: kind, whether it is the subject, and the other end


def exchangeable(problem: Problem) -> tuple[tuple[int, ...], ...]:
    """The groups of objects any two of which could change places without changing the value of any map.

    Two objects are such where they have the same unary evidence and the same facts with every third object, and what
    is said of the two is said both ways round. That is an equivalence, so that all orders of a group are as good.

    >>> alike = Problem(np.array([[0, 2], [1, 2]]), np.zeros(2, np.int64), np.zeros((1, 3, 3), np.float32),
    ...                 np.zeros((3, 3)), np.zeros(3))
    >>> exchangeable(alike)
    ((0, 1),)
    """
    facts: Facts = [Counter() for _ in problem.absent]
    for (s, o), kind in zip(problem.ends.tolist(), problem.kinds.tolist(), strict=True):
        facts[s][kind, True, o] += 1
        facts[o][kind, False, s] += 1
    homes: defaultdict[tuple[object, ...], list[list[int]]] = defaultdict(list)
    for i in range(len(problem.absent)):
        groups = homes[_signature(i, problem, facts)]
        home = next((group for group in groups if _twins(group[0], i, facts)), None)
        groups.append([i]) if home is None else home.append(i)
    found = [tuple(group) for groups in homes.values() for group in groups if len(group) > 1]
    return tuple(sorted(found))


def averaged(marginals: NDArray[np.float64], groups: tuple[tuple[int, ...], ...]) -> NDArray[np.float64]:
    """Marginals (…, n1, n2 + 1) with the same row, their mean, for all members of a group: what the posterior's have.

    >>> averaged(np.array([[1.0, 0.0], [0.0, 1.0]]), ((0, 1),)).tolist()
    [[0.5, 0.5], [0.5, 0.5]]
    """
    result = marginals.copy()
    for group in groups:
        members = list(group)
        result[..., members, :] = marginals[..., members, :].mean(axis=-2, keepdims=True)
    return result


def _signature(i: int, problem: Problem, facts: Facts) -> tuple[object, ...]:
    """What exchangeable objects have in common, whatever the others are called; few others have it."""
    said = tuple(sorted((kind, first, n) for (kind, first, _), n in facts[i].items()))
    alone = np.where(problem.allowed[i], problem.unary[i], 0.0).tobytes(), problem.allowed[i].tobytes()
    return float(problem.absent[i]), alone, said


def _twins(i: int, j: int, facts: Facts) -> bool:
    swap = {i: j, j: i}
    swapped = Counter({(kind, first, swap.get(k, k)): n for (kind, first, k), n in facts[i].items()})
    return swapped == facts[j]


Marginals = NDArray[np.float64]
Groups = tuple[tuple[int, ...], ...]

THRESHOLDS = (1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)  # of the best map's weight: less is left out of a sum
NODE_GROWTH, ERROR_FALL = 5.0, 15.0  # of the nodes, and of the error, from one threshold to the next, about
SMALL_SEARCH_RATIO = 100  # a search of so much fewer nodes than there may be is no sign of one that takes too long
SUM_CELLS, FACTOR_CELLS = 6e7, 4e6  # work for sums, and room for facts; beyond, maps are sampled

LADDERS = 4
PARTS = 8  # of a run, half of which are compared with the other half
MIN_COLDNESS = 0.7  # the least coldness: where facts decide, colder maps are stuck, and hotter ones say little
TEMPERATURES = (3, 6)  # fewest and most temperatures
ROUNDS = 4  # proposals for every object in a sweep
FIRST_SWEEPS = (8, 32)  # of a part of the first run, fewest and most: a quarter of what there may be
TOLERANCE = 0.007  # the standard error that is good enough
PROPOSALS, MAX_PROPOSALS = 6e5, 2.4e7  # for each object, in all ladders and temperatures; and for all objects
MAX_OBJECTS_WITH_OWN_START = 80  # up to which chains begin at maps of their own
THRESHOLD_TABLE_SIZE = 1 << 16
START_EFFORT = 0.1


@dataclass(frozen=True, eq=False)
class Posterior:
    """``marginals`` (n1, n2 + 1): the probability of each thing for each object; last, of its being left out.

    ``error``: at most so much mass is missing where ``exact``; otherwise the largest standard error of a marginal over
    ladders and halves of their runs, which is no guarantee, and infinite where there are not two to compare.
    ``log_total`` is the logarithm of the sum of the exponentials of all maps' values; nan where it is not known.
    """

    marginals: Marginals
    exact: bool
    error: float
    log_total: float = math.nan

    @property
    def entropy(self) -> Marginals:
        """Of each object's marginal, in nats, shape (n1,): 0 where it is certain."""
        p = self.marginals
        logs = np.log(p, out=np.zeros_like(p), where=p > 0)
        entropy: Marginals = np.maximum(0.0, -(p * logs).sum(axis=1))
        return entropy


def posterior(
    problem: Problem,
    deadline: Deadline = Deadline.never(),
    *,
    mass: float = 1e-3,
    seed: int = 0,
    start: NDArray[np.int64] | None = None,
) -> Posterior:
    """The posterior over maps by its marginals, until ``deadline``.

    It is exact but for ``mass`` where that can be shown by adding up maps in little time, and sampled otherwise. Chains
    begin at maps of their own; of more than ``MAX_OBJECTS_WITH_OWN_START`` objects at ``start`` (n1,), a map of high
    value, where it is known: to look for others would take longer than the chains. Past the deadline that map, or
    nobody's being anything, is all the answer. Raises MatchingError for a mass that is not between 0 and 1, and where
    ``start`` is no map of the problem.

    >>> problem = Problem(np.zeros((0, 2), np.int64), np.zeros(0, np.int64), np.zeros((0, 1, 1), np.float32),
    ...                   np.array([[np.log(3.0)]]), np.zeros(1))
    >>> found = posterior(problem)
    >>> found.marginals.round(3).tolist(), found.exact
    ([[0.75, 0.25]], True)
    """
    if start is not None:
        problem.require_map(start)
    exact = exact_posterior(problem, deadline, mass=mass, seed=seed)
    if exact is not None:
        return exact
    n1, n2 = problem.unary.shape
    if deadline.passed:
        labels = np.full(n1, n2) if start is None else to_labels(start, n2)
        return Posterior((labels[:, None] == np.arange(n2 + 1)).astype(np.float64), False, math.inf)
    begin = None if start is None or n1 <= MAX_OBJECTS_WITH_OWN_START else to_labels(start, n2)
    return _sampled(problem, problem.compiled, deadline, seed, begin)


def exact_posterior(
    problem: Problem, deadline: Deadline = Deadline.never(), *, mass: float = 1e-3, seed: int = 0
) -> Posterior | None:
    """The exact posterior but for ``mass``, or None where that would take long, or longer than until the deadline.

    Raises MatchingError for a mass that is not between 0 and 1.
    """
    if not 0 < mass < 1:
        raise MatchingError(f"the mass that may be missing lies between 0 and 1, not at {mass}")
    n1, n2 = problem.unary.shape
    if n1 == 0 or n2 == 0:
        nobody = np.ones((n1, 1)) if n2 == 0 else np.zeros((0, n2 + 1))
        return Posterior(nobody, True, 0.0, float(problem.absent.sum()))
    compiled, width = problem.compiled, n2 + 1
    if len(compiled.kind) * width * width > FACTOR_CELLS or deadline.passed:
        return None
    best, _ = search_from(np.full(n1, width - 1), compiled, deadline, seed, START_EFFORT, 2)
    parts = factors(compiled)
    top = math.exp(problem.value(to_assignment(best, width - 1)) - parts.log_scale)
    nodes = int(SUM_CELLS / (n1 * width))
    for threshold in THRESHOLDS:
        if deadline.passed:
            return None
        marginals, (total, missing, looked_at) = add_up(compiled, parts, threshold * top, nodes)
        if missing == math.inf or total <= 0:
            return None
        error = missing / (total + missing)
        if error <= mass:
            summed = math.log(total + missing) + parts.log_scale
            return Posterior(averaged(marginals / total, exchangeable(problem)), True, error, summed)
        if (
            looked_at * SMALL_SEARCH_RATIO > nodes
            and looked_at * NODE_GROWTH ** math.log(error / mass, ERROR_FALL) > nodes
        ):
            return None
    return None


def _sampled(
    problem: Problem, compiled: Compiled, deadline: Deadline, seed: int, start: NDArray[np.int64] | None
) -> Posterior:
    """A short run of ladders, then one as long as the first one's error shows to be needed, and so on.

    Each leaves out all before, as being on the way. All ladders begin at ``start`` (n1,), where there is one.
    """
    n1, width = compiled.unary.shape
    groups, rng = exchangeable(problem), np.random.default_rng(seed)
    coldness = np.geomspace(1.0, MIN_COLDNESS, int(np.clip(1 + 0.7 * math.sqrt(n1), *TEMPERATURES)))
    thresholds = -rng.exponential(size=THRESHOLD_TABLE_SIZE)
    ladders = []
    for number in range(LADDERS):
        labels = start
        if labels is None:
            labels, _ = search_from(np.full(n1, width - 1), compiled, deadline, seed + number, START_EFFORT, 1)
        ladders.append(ladder(labels, compiled, coldness))
        if deadline.passed:
            break
    left = int(min(PROPOSALS * n1, MAX_PROPOSALS) / (LADDERS * PARTS * ROUNDS * n1 * len(coldness)))
    sweeps = int(np.clip(left / 4, *FIRST_SWEEPS))
    marginals, error = averaged(np.eye(width)[ladders[0].labels[0]], groups), math.inf
    allowed = compiled.allowed
    while True:
        counts = _run(ladders, compiled, sweeps, deadline, thresholds, rng)
        if counts is None:
            break
        marginals, error = _agreement(averaged(counts / sweeps, groups), allowed, LADDERS * PARTS * sweeps)
        left -= sweeps
        wanted = max(2 * sweeps, math.ceil(sweeps * (error / TOLERANCE) ** 2))
        if error <= TOLERANCE or left < sweeps:
            break
        sweeps = min(wanted, left)
    return Posterior(marginals, False, error)


def _run(
    ladders: list[Ladder],
    compiled: Compiled,
    sweeps: int,
    deadline: Deadline,
    thresholds: NDArray[np.float64],
    rng: np.random.Generator,
) -> NDArray[np.float64] | None:
    """Counts by half, ladder and match (2, LADDERS, n1, n2 + 1); None where the deadline struck."""
    if len(ladders) < LADDERS or deadline.passed:
        return None
    counts, most = np.zeros((2, LADDERS, *compiled.unary.shape)), most_said_twice(compiled)
    for part in range(PARTS):
        for chains, count in zip(ladders, counts[2 * part // PARTS], strict=True):
            sample(chains, count, compiled, sweeps, ROUNDS, thresholds, most, int(rng.integers(1 << 31)))
            if deadline.passed:
                return None
    return counts / (PARTS // 2)


def _agreement(shares: NDArray[np.float64], allowed: NDArray[np.bool_], sweeps: int) -> tuple[Marginals, float]:
    """The mean of all halves, and the largest standard error of a marginal, halves taken as independent runs.

    What happened in none of the ``sweeps``, or in all, may yet be otherwise in the next: one sweep more is taken to
    have been anything that is ``allowed`` (n1, n2 + 1), and no error is smaller than the share of one.
    """
    halves = shares.reshape(-1, *shares.shape[2:])
    error = float(halves.std(axis=0, ddof=1).max() / math.sqrt(len(halves)))
    anything = allowed / allowed.sum(axis=1, keepdims=True)
    return (sweeps * halves.mean(axis=0) + anything) / (sweeps + 1), max(error, 1 / sweeps)
