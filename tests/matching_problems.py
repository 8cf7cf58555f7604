"""Small matching problems drawn at random, and all their maps one by one: what the engines are held against."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, permutations, product

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import UNMATCHED, Problem


@st.composite
def problems(draw: st.DrawFn, most: int = 4) -> Problem:
    """Draw up to ``most`` objects and things; levels with many ties, or real numbers; some matches ruled out."""
    n1, n2, k = draw(st.integers(0, most)), draw(st.integers(0, most)), draw(st.integers(1, 3))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    m = draw(st.integers(0, 7)) if n1 > 1 else 0
    ends = np.array([rng.choice(n1, 2, replace=False) for _ in range(m)], dtype=np.int64).reshape(m, 2)
    if draw(st.booleans()):
        tables, unary = rng.choice([0.0, 0.5, 1.0], (k, n2, n2)), rng.choice([0.0, 0.0, 0.5], (n1, n2))
        absent = rng.choice([0.0, 0.5, -1.0], n1)
    else:
        tables, unary, absent = rng.normal(0, 2, (k, n2, n2)), rng.normal(0, 1, (n1, n2)), rng.normal(-1, 1, n1)
    ruled_out = rng.random((n1, n2)) < draw(st.sampled_from([0.0, 0.0, 0.3, 1.0]))
    kinds = rng.integers(0, k, m)
    return Problem(ends, kinds, tables.astype(np.float32), unary, absent, ~ruled_out)


def every_map(problem: Problem) -> dict[tuple[int, ...], float]:
    """Compute the value of every map, fact by fact."""
    n1, n2 = problem.unary.shape
    found = {}
    for choice in product(range(UNMATCHED, n2), repeat=n1):
        things = [p for p in choice if p != UNMATCHED]
        if len(set(things)) < len(things):
            continue
        if not all(problem.allowed[i, p] for i, p in enumerate(choice) if p != UNMATCHED):
            continue
        value = sum(problem.absent[i] if p == UNMATCHED else problem.unary[i, p] for i, p in enumerate(choice))
        for (s, o), kind in zip(problem.ends, problem.kinds, strict=True):
            if UNMATCHED not in (choice[s], choice[o]):
                value += float(problem.tables[kind, choice[s], choice[o]])
        found[choice] = float(value)
    return found


def reordered(problem: Problem, rows: NDArray[np.int64], columns: NDArray[np.int64]) -> Problem:
    """Return the problem with its objects and its things in another order."""
    return Problem(
        np.argsort(rows)[problem.ends].reshape(-1, 2),
        problem.kinds,
        problem.tables[:, columns][:, :, columns],
        problem.unary[rows][:, columns],
        problem.absent[rows],
        problem.allowed[rows][:, columns],
    )


def maps(allowed: NDArray[np.bool_]) -> Iterator[NDArray[np.int64]]:
    """Yield every map of objects to things that a mask allows, of shape (n1,) each."""
    n1, n2 = allowed.shape
    for count in range(min(n1, n2) + 1):
        for rows in combinations(range(n1), count):
            for columns in permutations(range(n2), count):
                assignment = np.full(n1, UNMATCHED, dtype=np.int64)
                assignment[list(rows)] = columns
                if allowed[list(rows), list(columns)].all():
                    yield assignment
