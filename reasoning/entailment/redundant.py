"""Facts that add nothing: they follow from the other facts of a graph."""

from __future__ import annotations

from collections import deque

from deixis.deadline import Deadline
from deixis.ontology.graph.graph import RelationGraph
from deixis.ontology.relations.relation import Reading
from deixis.reasoning.entailment.bounds import AXES, claims
from deixis.reasoning.entailment.demands import demands_of


def redundant_facts(graph: RelationGraph, deadline: Deadline = Deadline.never()) -> tuple[tuple[int, ...], bool]:
    """Find firm facts that can be left out one after another without losing an implication.

    The last facts are tried first, so that of two facts with one meaning the later one is redundant. A choice is
    redundant if the other facts imply one of its alternatives; choices by cases are not searched. A fact of a graded
    word is never redundant.

    Parameters
    ----------
    graph
        Consistent facts.
    deadline
        Time limit.

    Returns
    -------
    The edges of the redundant facts, ascending, and whether all facts were examined before the deadline.

    Examples
    --------
    >>> from deixis.ontology.graph.graph import Fact
    >>> from deixis.ontology.tbox import default_ontology
    >>> r = default_ontology().relations
    >>> facts = [Fact(s, (r["left"],), o) for s, o in ("ab", "bc", "ac")]
    >>> redundant_facts(RelationGraph.from_facts(r, ["a", "b", "c"], facts))
    ((2,), True)
    """
    demands, n = demands_of(graph), len(graph.nodes)
    after: list[list[tuple[int, bool, int]]] = [[] for _ in range(2 * AXES * n)]
    for axis in range(AXES):
        for low in range(2 * axis * n, 2 * axis * n + n):
            after[low].append((low + n, True, -1))
    bounds = demands.bounds
    rows = (bounds.tail.tolist(), bounds.head.tolist(), bounds.strict.tolist(), bounds.premise.tolist())
    for tail, head, strict, premise in zip(*rows, strict=True):
        after[tail].append((head, strict, premise))
    left_out: set[int] = set()

    def implied(tail: int, head: int, strict: bool) -> bool:
        seen: set[tuple[int, bool]] = {(tail, False)}
        queue = deque(seen)
        while queue:
            point, passed = queue.popleft()
            if point == head and (passed or not strict):
                return True
            for following, is_strict, premise in after[point]:
                state = (following, passed or is_strict)
                if premise not in left_out and state not in seen:
                    seen.add(state)
                    queue.append(state)
        return False

    for edge in reversed(demands.firm.tolist()):
        if deadline.passed:
            return tuple(sorted(left_out)), False
        fact = graph.fact(edge)
        if any(relation.reading is Reading.GRADED for relation in fact.relations):
            continue  # bounds are necessary for such a word, and do not imply it
        subject, obj = int(graph.subjects[edge]), int(graph.objects[edge])
        left_out.add(edge)
        if not all(
            any(all(implied(*bound.points(subject, obj, n), bound.strict) for bound in part) for part in alternatives)
            for alternatives in claims(fact)
        ):
            left_out.discard(edge)
    return tuple(sorted(left_out)), True
