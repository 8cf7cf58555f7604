"""Demands that hold together: all of them, as many as can be, or the least of them that cannot."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deixis.reasoning.entailment.realisation.demands import Demand
from deixis.reasoning.entailment.realisation.search import Clause, Refuted, Solved, TimedOut, solve


@dataclass(frozen=True, slots=True)
class Dropped:
    """A demand that was given up, and the demands beside which it cannot hold."""

    demand: Demand
    because: tuple[Demand, ...]


@dataclass(frozen=True)
class Relaxed:
    """A solution of the firm demands and of the soft ones that were kept; ``finished`` where all soft ones that were
    dropped were proved not to fit."""

    solved: Solved
    kept: tuple[Demand, ...]
    dropped: tuple[Dropped, ...]
    finished: bool = True


@dataclass(frozen=True)
class Contradiction:
    """Demands that cannot all hold; ``minimal`` where without any one of them the others were seen to."""

    demands: tuple[Demand, ...]
    minimal: bool


def satisfy(
    points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: float
) -> Solved | tuple[Demand, ...] | TimedOut:
    """A solution of the base and all demands; or demands that have none."""
    clauses = [*base, *(clause for demand in demands for clause in demand.clauses)]
    owners = [-1] * len(base) + [position for position, demand in enumerate(demands) for _ in demand.clauses]
    found = solve(points, clauses, deadline)
    if isinstance(found, Refuted):
        return tuple(demands[p] for p in sorted({owners[clause] for clause in found.core} - {-1}))
    return found


def minimised(points: int, base: Sequence[Clause], demands: Sequence[Demand], deadline: float) -> Contradiction:
    """Demands that cannot all hold, made minimal: each is left out in turn, for good where the others still cannot.

    Where the time is up they are given as they are then.
    """
    left, minimal = list(demands), True
    for demand in list(demands):
        if demand not in left:
            continue
        found = satisfy(points, base, [other for other in left if other is not demand], deadline)
        if isinstance(found, tuple):
            left = [other for other in left if any(other is kept for kept in found)]
        minimal &= not isinstance(found, TimedOut)
    return Contradiction(tuple(left), minimal)


def relaxed(
    points: int, base: Sequence[Clause], firm: Sequence[Demand], soft: Sequence[Demand], deadline: float
) -> Relaxed | tuple[Demand, ...] | TimedOut:
    """A solution of all firm demands and of as many soft ones as can be kept, the first ones rather than the last.

    Of soft demands that cannot hold beside the others the last one is given up, until the rest can; then those that
    were given up are tried again. Firm demands that cannot hold by themselves are returned; TimedOut where the time
    was up before anything was solved.
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
    if isinstance(found, TimedOut):
        return found
    return _retried(points, base, firm, Relaxed(found, tuple(kept), tuple(dropped)), deadline)


def _retried(points: int, base: Sequence[Clause], firm: Sequence[Demand], best: Relaxed, deadline: float) -> Relaxed:
    """Takes back in what was given up for the sake of something that was itself given up later."""
    for dropped in _worth_trying(best):
        demands = [*firm, *best.kept, dropped.demand]
        found = satisfy(points, base, demands, deadline) if time.monotonic() < deadline else TimedOut()
        if isinstance(found, TimedOut):
            return Relaxed(best.solved, best.kept, best.dropped, finished=False)
        if isinstance(found, Solved):
            rest = tuple(other for other in best.dropped if other is not dropped)
            best = Relaxed(found, (*best.kept, dropped.demand), rest)
    return best


def _worth_trying(best: Relaxed) -> Iterator[Dropped]:
    gone = {id(dropped.demand) for dropped in best.dropped}
    return (dropped for dropped in reversed(best.dropped) if any(id(other) in gone for other in dropped.because))
