"""Which objects a description cannot tell apart: the orbits of its automorphisms.

Two objects are interchangeable where a renaming of the objects that exchanges them leaves every fact, and everything
else known of each object, as it was. Colour refinement (Weisfeiler and Leman) finds who may be; a swap of the two, or
a search that follows one choice at a time, proves it. What could not be proved within the budget is not claimed.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Sequence

from deixis.ontology.graph import RelationGraph

BUDGET = 20_000
"""Colour refinements at the most, over a whole description."""

_Edges = tuple[tuple[tuple[int, Hashable], ...], ...]
"""For each node its neighbours, each with the edge's colour, which includes the direction."""


def interchangeable(graph: RelationGraph, colours: Sequence[Hashable]) -> list[tuple[str, ...]]:
    """The groups of two and more objects that the description cannot tell apart, in node order.

    ``colours`` holds what else is known of each node; only nodes of equal colour can be interchangeable.

    >>> from deixis.ontology.graph import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> left = (default_ontology().relations["left"],)
    >>> facts = [Fact("salad_fork", left, "plate"), Fact("dinner_fork", left, "plate")]
    >>> graph = RelationGraph.from_facts(default_ontology().relations, ["plate", "salad_fork", "dinner_fork"], facts)
    >>> interchangeable(graph, [0, 0, 0])
    [('salad_fork', 'dinner_fork')]
    """
    edges = _edges(graph)
    search = _Automorphisms(edges)
    stable = search.refine(_numbered(colours))
    classes: dict[int, list[int]] = defaultdict(list)
    for node, colour in enumerate(stable):
        classes[colour].append(node)
    groups = []
    for members in classes.values():
        groups += [group for group in _orbits(members, stable, search) if len(group) > 1]
    return [tuple(graph.nodes[i] for i in group) for group in sorted(groups)]


def _edges(graph: RelationGraph) -> _Edges:
    lists: list[list[tuple[int, Hashable]]] = [[] for _ in graph.nodes]
    for edge in range(len(graph)):
        s, o = int(graph.subjects[edge]), int(graph.objects[edge])
        colour = (
            int(graph.relation_sets[edge]),
            bool(graph.positive[edge]),
            bool(graph.optional[edge]),
            float(graph.weights[edge]),
        )
        lists[s].append((o, (0, *colour)))
        lists[o].append((s, (1, *colour)))
    return tuple(tuple(neighbours) for neighbours in lists)


def _numbered(colours: Sequence[Hashable]) -> list[int]:
    numbers: dict[Hashable, int] = {}
    return [numbers.setdefault(colour, len(numbers)) for colour in colours]


def _orbits(members: list[int], stable: list[int], search: _Automorphisms) -> list[list[int]]:
    orbits: list[list[int]] = []
    for node in members:
        for orbit in orbits:
            if search.exchangeable(orbit[0], node, stable):
                orbit.append(node)
                break
        else:
            orbits.append([node])
    return orbits


class _Automorphisms:
    """Finds automorphisms of one graph, within a budget of refinements."""

    def __init__(self, edges: _Edges) -> None:
        self._edges = edges
        self._bags = [Counter(neighbours) for neighbours in edges]
        self._budget = BUDGET

    def refine(self, colours: list[int]) -> list[int]:
        """The coarsest stable colouring that is finer; numbers depend on structure alone, not on node order."""
        count = len(set(colours))
        while True:
            self._budget -= 1
            signatures = [
                (colours[node], tuple(sorted(Counter((c, colours[j]) for j, c in self._edges[node]).items(), key=repr)))
                for node in range(len(colours))
            ]
            ranks = {signature: rank for rank, signature in enumerate(sorted(set(signatures), key=repr))}
            colours = [ranks[signature] for signature in signatures]
            if len(ranks) == count:
                return colours
            count = len(ranks)

    def exchangeable(self, a: int, b: int, stable: list[int]) -> bool:
        """Whether some automorphism takes ``a`` to ``b``."""
        return self._twins(a, b) or self._extends(self._marked(stable, a), self._marked(stable, b))

    def _twins(self, a: int, b: int) -> bool:
        """Whether swapping the two and leaving all others is an automorphism."""
        swap = {a: b, b: a}
        swapped = Counter({(swap.get(j, j), c): count for (j, c), count in self._bags[a].items()})
        return swapped == self._bags[b]

    def _marked(self, colours: list[int], node: int) -> list[int]:
        marked = [2 * colour for colour in colours]
        marked[node] += 1
        return marked

    def _extends(self, first: list[int], second: list[int]) -> bool:
        """Whether some automorphism takes the one colouring to the other."""
        if self._budget <= 0:
            return False
        first, second = self.refine(first), self.refine(second)
        if Counter(first) != Counter(second):
            return False
        cell = next((c for c, count in sorted(Counter(first).items()) if count > 1), None)
        if cell is None:
            return self._is_automorphism(first, second)
        chosen = self._marked(first, first.index(cell))
        choices = (node for node, colour in enumerate(second) if colour == cell)
        return any(self._extends(chosen, self._marked(second, node)) for node in choices)

    def _is_automorphism(self, first: list[int], second: list[int]) -> bool:
        position = {colour: node for node, colour in enumerate(second)}
        image = [position[colour] for colour in first]
        return all(
            Counter({(image[j], c): count for (j, c), count in self._bags[node].items()}) == self._bags[image[node]]
            for node in range(len(image))
        )
