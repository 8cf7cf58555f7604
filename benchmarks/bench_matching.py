"""The engines for the matching problem beside CP-SAT, FAQ and swap annealing, over the same generated tables.

Two tables: proofs (8 to 30 objects, with all optima), and values (30 to 1,000 objects, one in ten missing and one in
ten extra). Values are relative to the best that anything found in the run. ``--quick`` takes a few cases of each.
"""

from __future__ import annotations

import resource
import statistics
import sys
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import TypeVar

import numpy as np
from generated_tables import generate
from numpy.typing import NDArray
from peers import annealing, cp_sat, faq, graph_matching

from deixis.reasoning.matching.exact import exact, maps_within, warm
from deixis.reasoning.matching.problem import Problem
from deixis.reasoning.matching.scalable import scalable

T = TypeVar("T")

PROOF_LIMIT = 30.0  # seconds for one case


def main() -> None:
    quick = "--quick" in sys.argv
    warm()
    annealing.solve(generate(8, seed=0).crisp(), steps=10)
    print("2.5 facts an object, 10 % off; seeds from 0; times are medians (the longest in brackets)\n")
    for centred in (False, True):
        _proofs(3 if quick else 10, centred)
    _values({30: 2, 100: 1, 1000: 1} if quick else {30: 10, 100: 5, 300: 3, 1000: 2})
    print(f"peak memory {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20:.2f} GB")


def _proofs(cases: int, centred: bool) -> None:
    print(
        f"proofs, {'centred' if centred else 'plain'} degrees\nobjects  exact                proved  nodes  "
        "CP-SAT               proved  all optima"
    )
    for objects in (8, 12, 15, 30):
        out = objects // 10 if centred else 0
        problems = [generate(objects, missing=out, extra=out, seed=s).crisp(centred=centred) for s in range(cases)]
        ours, found = _timed(lambda p: exact(p, time.perf_counter() + PROOF_LIMIT), problems)
        listing, maps = _timed(lambda p: maps_within(p, 0.0, time.perf_counter() + PROOF_LIMIT), problems)
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


def _values(cases: dict[int, int]) -> None:
    for objects, count in cases.items():
        out = objects // 10
        problems = [generate(objects, missing=out, extra=out, seed=s).crisp(centred=True) for s in range(count)]
        engines: dict[str, Callable[[Problem], NDArray[np.int64]]] = {
            "scalable": lambda p: scalable(p).assignment,
            "annealing": annealing.solve,
        }
        if objects <= 100:
            engines["annealing, ten times as long"] = lambda p: annealing.solve(
                p, steps=10 * annealing.proposals(len(p.absent))
            )
            engines["faq, ten starts"] = faq.solve
        if objects * objects <= graph_matching.MOST_CELLS:
            for name in graph_matching.SOLVERS:
                engines[name] = partial(graph_matching.solve, solver=name)
        times, values = {}, {}
        for name, engine in engines.items():
            try:
                times[name], maps = _timed(engine, problems)
            except ImportError:
                print(f"  {name}: skipped, not installed")
                continue
            values[name] = [p.value(m) for p, m in zip(problems, maps, strict=True)]
        best = np.max(list(values.values()), axis=0)
        print(f"{objects} objects, {count} cases: value over the best found; median seconds (longest)")
        for name in values:
            print(f"  {name:30} {np.mean(np.array(values[name]) / best):.4f}  {_span(times[name])}", flush=True)


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
