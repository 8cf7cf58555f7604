"""Demands that hold together: all of them, as many as can be, or the least of them that cannot."""

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
    """A demand that was given up, and the demands beside which it cannot hold."""

    demand: Demand
    because: tuple[Demand, ...]


@dataclass(frozen=True)
class Relaxed:
    """A solution of the firm demands and of the soft ones that were kept; ``finished`` where all soft ones that were
    dropped were proved not to fit."""

    network: DifferenceNetwork
    kept: tuple[Demand, ...]
    dropped: tuple[Dropped, ...]
    finished: bool = True


def satisfy(
    points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: Deadline
) -> DifferenceNetwork | tuple[Demand, ...] | None:
    """Return a solution of the base and all demands; or demands that have none; or None where the time was up."""
    clauses = [*base, *(clause for demand in demands for clause in demand.clauses)]
    owners = [-1] * len(base) + [position for position, demand in enumerate(demands) for _ in demand.clauses]
    found = solve(points, 2, clauses, deadline)
    if found.outcome is SearchOutcome.REFUTED:
        return tuple(demands[p] for p in sorted({owners[clause] for clause in found.core} - {-1}))
    return found.network if found.outcome is SearchOutcome.SOLVED else None


def minimised(points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: Deadline) -> Minimal[Demand]:
    """Return demands that cannot all hold, made minimal as far as there is time."""

    def refuted(chosen: Sequence[Demand]) -> tuple[Demand, ...] | None:
        found = satisfy(points, base, chosen, deadline)
        return found if isinstance(found, tuple) else None

    return minimal_subset(demands, refuted, deadline, keep_last=True)


def relaxed(
    points: int, base: Sequence[Clause], firm: Sequence[Demand], soft: Sequence[Demand], deadline: Deadline
) -> Relaxed | tuple[Demand, ...] | None:
    """Return a solution of all firm demands and of as many soft ones as can be kept, the first ones rather than the
    last.

    Of soft demands that cannot hold beside the others the last one is given up, until the rest can; then those that
    were given up are tried again. Firm demands that cannot hold by themselves are returned; None where the time was
    up before anything was solved.
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
    """Take back in what was given up for the sake of something that was itself given up later."""
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
