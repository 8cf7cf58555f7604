"""Retrieve the layouts most similar to a scene, and the scenes most similar to a layout.

Each comparison needs a grounding. Two upper bounds on the similarity show which pairs need no comparison: one from
counts of kinds and relations alone, and one from an assignment in which every fact is free. The result is the same as
if all pairs had been compared.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from deixis.deadline import Deadline
from deixis.reasoning.comparison.likeness import ComparedScene, Comparison, Described, Likeness
from deixis.reasoning.errors import SettingError

Progress = Callable[[int, int], None]
"""Callback with the number of comparisons made, and the number of all candidates."""

BOUND_TOLERANCE = 1e-5
"""Largest amount by which a bound may be below a similarity because of rounding."""


def rank_layouts(
    scene: ComparedScene,
    layouts: Iterable[Described],
    comparison: Comparison,
    top: int = 10,
    deadline: Deadline = Deadline.never(),
    progress: Progress | None = None,
) -> list[Likeness]:
    """Rank layouts by their similarity to a scene.

    Parameters
    ----------
    scene
        The scene.
    layouts
        The layouts to rank.
    comparison
        The similarity.
    top
        Maximum number of results, at least 1.
    deadline
        Time at which each comparison returns its best grounding so far, not proved to be the best.
    progress
        Called with the number of layouts compared, and that of all.

    Returns
    -------
    list of Likeness
        The most similar layouts, best first, equal ones by name.

    Raises
    ------
    SettingError
        If ``top`` is less than 1.
    """
    return _ranked([(layout, scene) for layout in layouts], comparison, top, deadline, progress)


def rank_scenes(
    layout: Described,
    scenes: Iterable[ComparedScene],
    comparison: Comparison,
    top: int = 10,
    deadline: Deadline = Deadline.never(),
    progress: Progress | None = None,
) -> list[Likeness]:
    """Rank scenes by their similarity to a layout.

    Parameters
    ----------
    layout
        The layout.
    scenes
        The scenes to rank.
    comparison
        The similarity.
    top
        Maximum number of results, at least 1.
    deadline
        Time at which each comparison returns its best grounding so far, not proved to be the best.
    progress
        Called with the number of scenes compared, and that of all; those whose bound is too small are not compared.

    Returns
    -------
    list of Likeness
        The most similar scenes, best first, equal ones by name.

    Raises
    ------
    SettingError
        If ``top`` is less than 1.
    """
    return _ranked([(layout, scene) for scene in scenes], comparison, top, deadline, progress)


def _ranked(
    pairs: Sequence[tuple[Described, ComparedScene]],
    comparison: Comparison,
    top: int,
    deadline: Deadline,
    progress: Progress | None,
) -> list[Likeness]:
    """Compare the pair of the largest bound next, until no bound reaches the similarity of the last result."""
    if top < 1:
        raise SettingError(f"`top` must be at least 1, got {top}")
    open_ = [(-quick_bound(comparison, *pair), k, False) for k, pair in enumerate(pairs)]
    heapq.heapify(open_)
    found: list[Likeness] = []
    least = -math.inf
    while open_ and -open_[0][0] >= least - BOUND_TOLERANCE:
        bound, k, tight = heapq.heappop(open_)
        if not tight:
            heapq.heappush(open_, (max(bound, -assignment_bound(comparison, *pairs[k])), k, True))
            continue
        found.append(comparison.likeness(*pairs[k], deadline))
        if progress is not None:
            progress(len(found), len(pairs))
        if len(found) >= top:
            least = sorted((one.similarity for one in found), reverse=True)[top - 1]
    return sorted(found, key=lambda one: (-one.similarity, one.layout, one.scene))[:top]


def quick_bound(comparison: Comparison, layout: Described, scene: ComparedScene) -> float:
    """Return an upper bound of the similarity from counts alone: of equal kinds, and of pairs with each relation.

    Parameters
    ----------
    comparison
        The similarity.
    layout
        The layout.
    scene
        The scene.

    Returns
    -------
    float
        The bound, in [0, 1].
    """
    shares, alike = comparison.shares(layout, scene), comparison.objects(layout, scene)
    objects = min(alike.max(axis=1, initial=0.0).sum(), alike.max(axis=0, initial=0.0).sum())
    bound = 2 * shares.objects * float(objects) / max(shares.things, 1)
    graph, edges = layout.graph, layout.edges
    facts_by_relation: dict[tuple[int, bool], dict[tuple[int, int], float]] = {}
    for edge, weight in zip(edges.tolist(), layout.weights.tolist(), strict=True):
        key = (int(graph.relation_sets[edge]), bool(graph.positive[edge]))
        pair = (int(graph.subjects[edge]), int(graph.objects[edge]))
        by_pair = facts_by_relation.setdefault(key, {})
        by_pair[pair] = by_pair.get(pair, 0.0) + weight
    total = 0.0
    for (mask, positive), by_pair in facts_by_relation.items():
        close = comparison.closeness(mask, positive)[: len(scene.counts)]
        order = np.argsort(-close)
        available = np.repeat(close[order], np.minimum(scene.counts[order], len(by_pair)))[: len(by_pair)]
        heaviest = sorted(by_pair.values(), reverse=True)
        total += float(np.dot(heaviest[: len(available)], available))
    return bound + 2 * shares.relations * total / shares.facts


def assignment_bound(comparison: Comparison, layout: Described, scene: ComparedScene) -> float:
    """Return an upper bound of the similarity: the best assignment if each fact chooses its other end freely.

    Parameters
    ----------
    comparison
        The similarity.
    layout
        The layout.
    scene
        The scene.

    Returns
    -------
    float
        The bound, in [0, 1].

    Notes
    -----
    Each object counts half of every fact about it (Gilmore 1962, Lawler 1963).
    """
    from scipy.optimize import linear_sum_assignment

    problem = comparison.problem(layout, scene)
    if not problem.unary.size:
        return 0.0
    gains = problem.unary.copy()
    forth, back = problem.tables.max(axis=2) / 2, problem.tables.max(axis=1) / 2
    np.add.at(gains, problem.ends[:, 0], forth[problem.kinds])
    np.add.at(gains, problem.ends[:, 1], back[problem.kinds])
    rows, columns = linear_sum_assignment(gains, maximize=True)
    return float(gains[rows, columns].sum())
