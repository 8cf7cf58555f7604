"""Time the posterior over matches, and compare its marginals with those of a run many times as long.

Graded facts over generated tables, 10 % wrong, one in ten missing and one in ten extra. ``difference`` is the largest
over all matches and cases; ``mean`` is that of each object's likeliest thing. ``--quick`` takes one case and a shorter
reference.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from records import command_line, figure, recorded

from deixis.experiments.generated_tables import generate
from deixis.reasoning.grounding.evidence.facts.facts import fact_tables
from deixis.reasoning.grounding.matching.posterior import ladders as settings
from deixis.reasoning.grounding.matching.posterior.posterior import Posterior, posterior
from deixis.reasoning.grounding.matching.problem import Problem

ABSENT = math.log(0.05 / 0.95)  # as in grounding
LONGER = {8: 10, 12: 10, 30: 10, 100: 3}  # factor of proposals for the reference


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--quick", action="store_true", help="one case, and a shorter reference")
    with recorded(parser) as options:
        quick = options.quick
        posterior(_problem(8, 1.0, 0))
        print("objects  facts  exact  median time  error    difference  mean")
        for objects, longer in LONGER.items():
            for facts in (1.0, 1.5, 2.5):
                problems = [_problem(objects, facts, seed) for seed in range(1 if quick or objects == 100 else 3)]
                times, found = [], []
                for problem in problems:
                    started = time.perf_counter()
                    found.append(posterior(problem))
                    times.append(time.perf_counter() - started)
                with _longer(2 if quick else longer):
                    references = [posterior(problem, seed=1) for problem in problems]
                _print(objects, facts, times, found, references)


def _print(objects: int, facts: float, times: list[float], found: list[Posterior], longer: list[Posterior]) -> None:
    differences = [np.abs(a.marginals - b.marginals) for a, b in zip(found, longer, strict=True)]
    likeliest = [
        d[np.arange(objects), b.marginals.argmax(axis=1)].mean() for d, b in zip(differences, longer, strict=True)
    ]
    largest = max(float(d.max()) for d in differences)
    figure(f"{objects} objects, {facts:g} facts each: largest difference", largest, "probability")
    print(
        f"{objects:7}  {facts:5}  {sum(f.exact for f in found)} of {len(found)}  {1e3 * np.median(times):8.0f} ms  "
        f"{max(f.error for f in found):.4f}   {max(d.max() for d in differences):.4f}      {np.mean(likeliest):.4f}",
        flush=True,
    )


@contextmanager
def _longer(times: float) -> Iterator[None]:
    """Sample with ``times`` as many proposals, however well the chains agree."""
    before = settings.PROPOSALS, settings.TOLERANCE
    settings.PROPOSALS, settings.TOLERANCE = times * before[0], 1e-6
    try:
        yield
    finally:
        settings.PROPOSALS, settings.TOLERANCE = before


def _problem(objects: int, facts_each: float, seed: int) -> Problem:
    table = generate(objects, facts_each, 0.1, missing=objects // 10, extra=objects // 10, seed=seed)
    facts = fact_tables(table.description(), table.boxes)
    n1, n2 = len(table.truth), len(table.boxes)
    return Problem(facts.ends, facts.kinds, facts.tables, np.zeros((n1, n2)), np.full(n1, ABSENT))


if __name__ == "__main__":
    main()
