"""Find the objects of a matching problem that are exchangeable: swapping them preserves the value of every map."""

from __future__ import annotations

from collections import Counter, defaultdict
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from deixis.reasoning.grounding.matching.problem import Problem

Number = TypeVar("Number", np.float32, np.float64)

Facts = list[Counter[tuple[int, bool, int]]]  # of each object: kind, whether it is the subject, and the other end


def exchangeable(problem: Problem) -> tuple[tuple[int, ...], ...]:
    """Return the groups of objects any two of which can be swapped without changing the value of any map.

    Two objects are exchangeable where they have the same unary evidence and the same facts with every third object,
    and facts between the two hold in both directions. This is an equivalence relation, so that all orders of a group
    have the same value.

    Parameters
    ----------
    problem
        The problem.

    Returns
    -------
    tuple of tuple of int
        Positions of the objects of each group of at least two, sorted.

    Examples
    --------
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
        home = next((group for group in groups if _are_exchangeable(group[0], i, facts)), None)
        groups.append([i]) if home is None else home.append(i)
    found = [tuple(group) for groups in homes.values() for group in groups if len(group) > 1]
    return tuple(sorted(found))


def averaged(marginals: NDArray[Number], groups: tuple[tuple[int, ...], ...]) -> NDArray[Number]:
    """Return marginals (…, n1, n2 + 1) with the rows of each group replaced by their mean, which is exact.

    Parameters
    ----------
    marginals
        Probabilities of matches, shape (…, n1, n2 + 1).
    groups
        Positions of objects that can be swapped, from :func:`exchangeable`.

    Returns
    -------
    ndarray
        Copy, shape (…, n1, n2 + 1).

    Examples
    --------
    >>> averaged(np.array([[1.0, 0.0], [0.0, 1.0]]), ((0, 1),)).tolist()
    [[0.5, 0.5], [0.5, 0.5]]
    """
    result = marginals.copy()
    for group in groups:
        members = list(group)
        result[..., members, :] = marginals[..., members, :].mean(axis=-2, keepdims=True)
    return result


def _signature(i: int, problem: Problem, facts: Facts) -> tuple[object, ...]:
    """Return a key that exchangeable objects have in common and that few other objects share."""
    facts_of_object = tuple(sorted((kind, first, n) for (kind, first, _), n in facts[i].items()))
    own_evidence = np.where(problem.allowed[i], problem.unary[i], 0.0).tobytes(), problem.allowed[i].tobytes()
    return float(problem.absent[i]), own_evidence, facts_of_object


def _are_exchangeable(i: int, j: int, facts: Facts) -> bool:
    swap = {i: j, j: i}
    swapped = Counter({(kind, first, swap.get(k, k)): n for (kind, first, k), n in facts[i].items()})
    return swapped == facts[j]
