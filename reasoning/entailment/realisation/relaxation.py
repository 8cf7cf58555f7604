"""Consistent sets of demands: all, as many as possible, or a minimal set that is inconsistent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deixis.deadline import Deadline
from deixis.reasoning.constraints.difference import DifferenceNetwork
from deixis.reasoning.constraints.disjunctive import Clause, SearchOutcome, solve
from deixis.reasoning.constraints.minimal import Minimal, minimal_subset
from deixis.reasoning.entailment.realisation.demands import Demand


@dataclass(frozen=True, slots=True)
class Dropped:
    """A demand that was given up, and the demands that exclude it."""

    demand: Demand
    because: tuple[Demand, ...]


@dataclass(frozen=True)
class Relaxed:
    """A solution of the firm demands and of the soft ones that were kept.

    ``finished`` is True if all dropped soft demands were proved not to fit.
    """

    network: DifferenceNetwork
    kept: tuple[Demand, ...]
    dropped: tuple[Dropped, ...]
    finished: bool = True


def satisfy(
    points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: Deadline
) -> DifferenceNetwork | tuple[Demand, ...] | None:
    """Return a solution of the base and all demands, or inconsistent demands, or None if time runs out.

    Parameters
    ----------
    points
        Number of points on each axis.
    base
        Clauses that always hold.
    demands
        The demands.
    deadline
        Time limit.

    Returns
    -------
    DifferenceNetwork, tuple of Demand or None
        The solution; or demands that are inconsistent with the base; or None if time runs out.
    """
    clauses = [*base, *(clause for demand in demands for clause in demand.clauses)]
    owners = [-1] * len(base) + [position for position, demand in enumerate(demands) for _ in demand.clauses]
    found = solve(points, 2, clauses, deadline)
    if found.outcome is SearchOutcome.REFUTED:
        return tuple(demands[p] for p in sorted({owners[clause] for clause in found.core} - {-1}))
    return found.network if found.outcome is SearchOutcome.SOLVED else None


def minimised(points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: Deadline) -> Minimal[Demand]:
    """Return inconsistent demands, minimal as far as time allows.

    Parameters
    ----------
    points
        Number of points on each axis.
    base
        Clauses that always hold.
    demands
        Inconsistent demands.
    deadline
        Time limit.

    Returns
    -------
    Minimal
        Demands that are inconsistent together.
    """

    def refuted(chosen: Sequence[Demand]) -> tuple[Demand, ...] | None:
        found = satisfy(points, base, chosen, deadline)
        return found if isinstance(found, tuple) else None

    return minimal_subset(demands, refuted, deadline, keep_last=True)


def relaxed(
    points: int, base: Sequence[Clause], firm: Sequence[Demand], soft: Sequence[Demand], deadline: Deadline
) -> Relaxed | tuple[Demand, ...] | None:
    """Return a solution of all firm demands and of as many soft ones as possible, preferring the first ones.

    As long as soft demands are inconsistent with the others, the last one of a conflict is given up; then those given
    up are tried again. The function returns inconsistent firm demands instead, or None if time runs out before anything
    is solved.

    Parameters
    ----------
    points
        Number of points on each axis.
    base
        Clauses that always hold.
    firm
        Demands that must hold.
    soft
        Demands that are given up if necessary, the last first.
    deadline
        Time limit.

    Returns
    -------
    Relaxed, tuple of Demand or None
        The solution; or inconsistent firm demands; or None if time runs out.
    """
    kept, dropped = list(soft), list[Dropped]()
    while True:
        found = satisfy(points, base, [*firm, *kept], deadline)
        if not isinstance(found, tuple):
            break
        last = next((demand for demand in reversed(kept) if any(demand is other for other in found)), None)
        if last is None:
            return found
        kept = [demand for demand in kept if demand is not last]
        dropped.append(Dropped(last, tuple(other for other in found if other is not last)))
    if found is None:
        return None
    return _retried(points, base, firm, Relaxed(found, tuple(kept), tuple(dropped)), deadline)


def _retried(points: int, base: Sequence[Clause], firm: Sequence[Demand], best: Relaxed, deadline: Deadline) -> Relaxed:
    """Restore demands that were given up because of others that were given up later."""
    for dropped in _worth_trying(best):
        demands = [*firm, *best.kept, dropped.demand]
        found = satisfy(points, base, demands, deadline) if not deadline.passed else None
        if found is None:
            return Relaxed(best.network, best.kept, best.dropped, finished=False)
        if isinstance(found, DifferenceNetwork):
            rest = tuple(other for other in best.dropped if other is not dropped)
            best = Relaxed(found, (*best.kept, dropped.demand), rest)
    return best


def _worth_trying(best: Relaxed) -> Iterator[Dropped]:
    gone = {id(dropped.demand) for dropped in best.dropped}
    return (dropped for dropped in reversed(best.dropped) if any(id(other) in gone for other in dropped.because))
