"""Solve by straightforward swap annealing, compiled: a random object and thing, the change summed fact by fact."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Compiled, Problem, compile_problem, to_assignment
from deixis.reasoning.grounding.matching.search.scalable import mean_range

HOT, COLD = 1.0, 0.1  # in units of the mean range of a table; see bench_peers.py


def proposals(objects: int) -> int:
    """Return the number of proposals, chosen so that 30, 100 and 1,000 objects take about 0.1, 0.4 and 20 s."""
    return int(np.interp(np.log(objects), np.log([30, 100, 1000]), [1e6, 2.5e6, 4e7]))


def solve(
    problem: Problem, *, steps: int | None = None, seed: int = 0, hot: float = HOT, cold: float = COLD
) -> NDArray[np.int64]:
    """Return the best map seen, starting from a random one."""
    compiled: Compiled = compile_problem(problem)
    n1, n2 = problem.unary.shape
    rng = np.random.default_rng(seed)
    labels = np.full(n1, n2)
    matched = min(n1, n2)
    labels[rng.permutation(n1)[:matched]] = rng.permutation(n2)[:matched]
    labels = np.where(compiled.allowed[np.arange(n1), labels], labels, n2)
    scale = mean_range(compiled)
    best = _anneal(labels, compiled, steps or proposals(n1), hot * scale, cold * scale, seed)
    return to_assignment(best, n2)


@njit(cache=True)
def _anneal(labels, problem, steps, hot, cold, seed):  # type: ignore[no-untyped-def]
    np.random.seed(seed)
    n1, out = len(labels), problem.unary.shape[1] - 1
    holder = np.full(out + 1, -1)
    for i in range(n1):
        holder[labels[i]] = i
    holder[out] = -1
    best, value, best_value = labels.copy(), 0.0, 0.0
    temperature, factor = hot, (cold / hot) ** (1.0 / steps)
    for _ in range(steps):
        temperature *= factor
        i, p = np.random.randint(n1), np.random.randint(out + 1)
        old, j = labels[i], holder[p]
        if p == old:
            continue
        before = _both(i, j, labels, problem)
        labels[i] = p
        if j >= 0:
            labels[j] = old
        change = _both(i, j, labels, problem) - before
        if change < 0.0 and np.random.random() >= np.exp(change / temperature):
            labels[i] = old
            if j >= 0:
                labels[j] = p
            continue
        if p < out:
            holder[p] = i
        if old < out:
            holder[old] = j
        value += change
        if value > best_value + 1e-9:
            best_value = value
            best[:] = labels
    return best


@njit(cache=True)
def _both(i, j, labels, problem):  # type: ignore[no-untyped-def]
    total = problem.unary[i, labels[i]]
    for slot in range(problem.first[i], problem.first[i + 1]):
        total += problem.tables[problem.kind[slot], labels[i], labels[problem.other[slot]]]
    if j >= 0:
        total += problem.unary[j, labels[j]]
        for slot in range(problem.first[j], problem.first[j + 1]):
            if problem.other[slot] != i:
                total += problem.tables[problem.kind[slot], labels[j], labels[problem.other[slot]]]
    return total
