"""Compare the engines for the matching problem with CP-SAT, FAQ and swap annealing on the same generated tables.

There are two tables: proofs (8 to 30 objects, with all optima), and values (30 to 1,000 objects, one in ten missing and
one in ten extra, for crisp and graded facts, few and many, with and without mistakes). Values are relative to the best
found by any method in the run; the scalable engine at four times its effort is only a reference for that. ``--quick``
takes a few cases of each.
"""

from __future__ import annotations

import math
import resource
import statistics
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from peers import annealing, cp_sat, faq, graph_matching
from records import command_line, figure, recorded

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import GeneratedTable, generate
from deixis.reasoning.grounding.engines.registry import engine_named
from deixis.reasoning.grounding.evidence.evidence import no_unary_evidence
from deixis.reasoning.grounding.evidence.facts.facts import fact_tables
from deixis.reasoning.grounding.ground import ground
from deixis.reasoning.grounding.matching.problem import Problem
from deixis.reasoning.grounding.matching.search.exact import exact, maps_within, warm
from deixis.reasoning.grounding.matching.search.scalable import scalable

T = TypeVar("T")

PROOF_LIMIT = 30.0  # seconds for one case
REFERENCE_LIMIT = 2.0  # seconds of the exact engine as a reference for the best value
SETTINGS = [(facts, off) for off in (0.0, 0.2, 0.1) for facts in (1.0, 1.5, 2.5)]  # facts per object, share off
QUICK = [(30, 1, SETTINGS[-1:]), (100, 1, SETTINGS[-1:])]  # objects, cases per row, rows
FULL = [(30, 3, SETTINGS), (100, 1, SETTINGS), (300, 1, SETTINGS[0::4]), (1000, 1, SETTINGS[-1:])]
HURRY = 1.0  # seconds
ABSENT = math.log(0.05 / 0.95)  # as in grounding


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--quick", action="store_true", help="a few cases of each")
    with recorded(parser) as options:
        quick = options.quick
        warm()
        annealing.solve(generate(8, seed=0).crisp(), steps=10)
        print("seeds from 0; times are medians (the longest in brackets); proofs: 2.5 facts per object, 10 % off\n")
        for centred in (False, True):
            _proofs(3 if quick else 10, centred)
        for objects, cases, settings in QUICK if quick else FULL:
            _values(objects, cases, settings)
        _in_a_hurry(1 if quick else 3)
        print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.2f} GB")


def _proofs(cases: int, centred: bool) -> None:
    print(
        f"proofs, {'centred' if centred else 'plain'} degrees\nobjects  exact                proved  nodes  "
        "CP-SAT               proved  all optima"
    )
    for objects in (8, 12, 15, 30):
        out = objects // 10 if centred else 0
        problems = [generate(objects, missing=out, extra=out, seed=s).crisp(centred=centred) for s in range(cases)]
        ours, found = _timed(lambda p: exact(p, Deadline.after(PROOF_LIMIT)), problems)
        listing, maps = _timed(lambda p: maps_within(p, 0.0, Deadline.after(PROOF_LIMIT)), problems)
        nodes = statistics.median(f.nodes for f in found)
        line = f"{objects:7}  {_span(ours)}  {sum(f.proved for f in found):6}  {nodes:5.0f}"
        try:
            theirs, solved = _timed(lambda p: cp_sat.solve(p, PROOF_LIMIT), problems)
        except ImportError:
            line += "  skipped: ortools is not installed"
        else:
            line += f"  {_span(theirs)}  {sum(s.proved for s in solved):6}"
            for problem, mine, other in zip(problems, found, solved, strict=True):
                if mine.proved and other.proved and abs(mine.value - problem.value(other.assignment)) > 0.01:
                    line += f"  DIFFERENT: {mine.value} and {problem.value(other.assignment)}"
        print(f"{line}  {_span(listing)}, {sum(m.complete for m in maps)} complete", flush=True)
    print(f"of {cases} cases\n")


def _values(objects: int, cases: int, chosen: list[tuple[float, float]]) -> None:
    print(f"\nvalues, {objects} objects, {cases} case(s) per row: value over the best found; median seconds (longest)")
    for graded in (False, True):
        for facts, off in chosen:
            out = objects // 10
            tables = [generate(objects, facts, off, missing=out, extra=out, seed=s) for s in range(cases)]
            problems = [_graded(table) if graded else table.crisp(centred=True) for table in tables]
            what = f"{'graded' if graded else 'crisp'}, {facts} facts per object, {off:.0%} off"
            print(f" {what}")
            _row(f"{objects} objects, {what}", problems)


def _row(what: str, problems: list[Problem]) -> None:
    times, values = {}, {}
    for name, engine in _engines(*problems[0].unary.shape).items():
        try:
            times[name], maps = _timed(engine, problems)
        except ImportError:
            continue
        values[name] = [p.value(m) for p, m in zip(problems, maps, strict=True)]
    best = np.max(list(values.values()), axis=0)
    for name in values:
        figure(f"{what}: {name}", float(np.mean(np.array(values[name]) / best)), "of the best value found")
        print(f"   {name:30} {np.mean(np.array(values[name]) / best):.4f}  {_span(times[name])}", flush=True)


def _in_a_hurry(cases: int) -> None:
    """Time the whole of grounding under a short time limit, from boxes and facts to the answer."""
    print(f"\nscalable grounding, time limit {HURRY:g} s: objects, seconds of the processor, seconds by the clock")
    for objects in (100, 300, 1000):
        out, spent, waited = objects // 10, [], []
        for seed in range(cases):
            table = generate(objects, missing=out, extra=out, seed=seed)
            evidence = no_unary_evidence(table.description(), table.scene())
            worked, started = time.process_time(), time.perf_counter()
            ground(evidence, engine_named("scalable"), Deadline.after(HURRY))
            spent.append(time.process_time() - worked)
            waited.append(time.perf_counter() - started)
        print(f"{objects:7}  {statistics.median(spent):.2f}  {statistics.median(waited):.2f}", flush=True)


def _graded(table: GeneratedTable) -> Problem:
    """Return the problem that grounding solves: log-likelihood ratios of graded meaning."""
    facts = fact_tables(table.description(), table.boxes)
    n1, n2 = len(table.truth), len(table.boxes)
    return Problem(facts.ends, facts.kinds, facts.tables, np.zeros((n1, n2)), np.full(n1, ABSENT))


def _engines(n1: int, n2: int) -> dict[str, Callable[[Problem], NDArray[np.int64]]]:
    """Return the scalable engine and those peers that are fast enough at this size."""
    engines: dict[str, Callable[[Problem], NDArray[np.int64]]] = {
        "scalable": lambda p: scalable(p).assignment,
        "annealing": annealing.solve,
        "scalable, four times as long": lambda p: scalable(p, effort=4.0, seed=1).assignment,
    }
    if n1 <= 100:
        steps = 10 * annealing.proposals(n1)
        engines["annealing, ten times as long"] = partial(annealing.solve, steps=steps)
        engines["faq, ten starts"] = faq.solve
    if n1 <= 30:
        engines["exact, two seconds"] = lambda p: exact(p, Deadline.after(REFERENCE_LIMIT)).assignment
    if n1 * n2 <= graph_matching.MOST_CELLS:
        for settings in graph_matching.BEST:
            engines[settings.solver] = partial(graph_matching.solve, settings=settings)
    return engines


def _timed(job: Callable[[Problem], T], problems: Iterable[Problem]) -> tuple[list[float], list[T]]:
    times, found = [], []
    for problem in problems:
        started = time.perf_counter()
        found.append(job(problem))
        times.append(time.perf_counter() - started)
    return times, found


def _span(times: list[float]) -> str:
    if max(times) < 1:
        return f"{1e3 * statistics.median(times):6.1f} ms ({1e3 * max(times):6.1f})"
    return f"{statistics.median(times):6.2f} s  ({max(times):6.2f})"


if __name__ == "__main__":
    main()
