"""Time one more difference constraint in a simple temporal network of 100 and of 500 fluents, beside peers.

The peers start from scratch with each constraint: scipy's Floyd-Warshall gives the same minimal distances, networkx's
Bellman-Ford only detects a negative cycle. Both get their matrix or graph ready made, and bounds that are not strict.
Ours adds the constraint and undoes it again, in exact bounds. Then all times of a table are computed from scratch.
"""

from __future__ import annotations

import networkx as nx
import numpy as np
from common import medians
from records import command_line, ratio, recorded
from scipy.sparse import csr_array
from scipy.sparse.csgraph import floyd_warshall

from deixis.reasoning.constraints.difference import UNBOUNDED
from deixis.reasoning.temporal.bounds import Bounds
from deixis.reasoning.temporal.fluent import EndDifference, Fluent, Statement
from deixis.reasoning.temporal.network import DifferenceConstraint, SimpleTemporalNetwork, difference
from deixis.reasoning.temporal.timeline import Timeline

SIZES = {100: 7, 500: 3}
ADDED = 20


def story(n: int) -> tuple[list[Fluent], list[EndDifference]]:
    """Return fluents known to some seconds, and four times as many differences known to about a second."""
    rng = np.random.default_rng(4)
    starts = rng.uniform(0, 10 * n, n).round(3)
    finishes = starts + rng.uniform(5, 60, n).round(3)
    truth = {"start": starts, "finish": finishes}
    fluents = [
        Fluent(f"f{k}", Statement("cup", "on", f"place {k}"), Bounds(s - 20, s + 20), Bounds(f - 20, f + 20))
        for k, (s, f) in enumerate(zip(starts.tolist(), finishes.tolist(), strict=True))
    ]
    differences = []
    for _ in range(4 * n):
        i, j = rng.choice(n, 2, replace=False).tolist()
        end, other = rng.choice(["start", "finish"], 2).tolist()
        between = float(truth[other][j] - truth[end][i])
        slack = float(rng.uniform(1, 15))
        differences.append(EndDifference(f"f{i}.{end}", f"f{j}.{other}", Bounds(between - slack, between + slack)))
    return fluents, differences


def constraints_of(differences: list[EndDifference]) -> list[tuple[DifferenceConstraint, ...]]:
    return [difference(d.tail, d.head, d.bounds) for d in differences]


def weights(network: SimpleTemporalNetwork) -> csr_array:
    """Return the stated constraints as a sparse matrix in seconds."""
    least: dict[tuple[int, int], float] = {}
    for c in network.constraints:
        cell = network.index(c.tail), network.index(c.head)
        least[cell] = min(least.get(cell, np.inf), (c.code >> 1) / 1e6)
    rows, columns = np.array(list(least)).T
    size = len(network.points)
    return csr_array((np.array(list(least.values())), (rows, columns)), shape=(size, size))


def add_and_undo(network: SimpleTemporalNetwork, new: list[tuple[DifferenceConstraint, ...]]) -> None:
    length = len(network.constraints)
    for constraints in new:
        assert network.try_add(constraints)
        network.back(length)


def changed_by(network: SimpleTemporalNetwork, new: list[tuple[DifferenceConstraint, ...]]) -> int:
    """Return the mean number of distances that one difference changes."""
    length, before, changed = len(network.constraints), network.distances.copy(), 0
    for constraints in new:
        assert network.try_add(constraints)
        changed += int((network.distances != before).sum())
        network.back(length)
    return changed // len(new)


def measure(n: int, runs: int) -> None:
    fluents, differences = story(n)
    timeline = Timeline(fluents, differences[:-ADDED])
    network, new = timeline.network, constraints_of(differences[-ADDED:])
    matrix = weights(network)
    entries = matrix.tocoo()
    graph = nx.DiGraph()
    graph.add_weighted_edges_from(zip(*entries.coords, entries.data.tolist(), strict=True))
    theirs = floyd_warshall(matrix)
    known = network.distances < UNBOUNDED
    assert np.allclose(network.distances[known] / 2e6, theirs[known], atol=1e-5), "the distances are not the same"
    added, scipys, networkxs = medians(
        lambda: add_and_undo(network, new),
        lambda: floyd_warshall(matrix),
        lambda: nx.negative_edge_cycle(graph),
        runs=runs,
    )
    built, followed = medians(lambda: Timeline(fluents, differences), timeline.chronology, runs=3)
    one = added / ADDED
    ratio(f"one more difference in {n} fluents, Floyd-Warshall from scratch", scipys, one, "scipy")
    ratio(f"one more difference in {n} fluents, Bellman-Ford, consistency only", networkxs, one, "networkx")
    print(f"{n} fluents, {len(network.points)} points, {len(network.constraints)} constraints")
    print(f"  one difference more changes {changed_by(network, new)} distances on average")
    print(f"  deixis, add one difference and undo it:        {one * 1e3:9.3f} ms")
    print(f"  scipy Floyd-Warshall, from scratch:            {scipys * 1e3:9.3f} ms ({scipys / one:.0f} times)")
    print(f"  networkx Bellman-Ford, consistency only:       {networkxs * 1e3:9.3f} ms ({networkxs / one:.0f} times)")
    print(f"  deixis, the whole network from nothing:        {built * 1e3:9.1f} ms")
    print(f"  deixis, all bounds and all pairs' Allen masks: {followed * 1e3:9.1f} ms")


def main() -> None:
    parser = command_line(__file__, __doc__)
    with recorded(parser):
        for n, runs in SIZES.items():
            measure(n, runs)


if __name__ == "__main__":
    main()
