"""Fit how probable it is that a match is a coincidence, on generated tables, and print the effect on others.

The tables have 12 to 100 objects of three layouts, of which none, a twentieth or a tenth are missing and as many things
are not described; one fact in ten is wrong. Seeds from ``FITTED_SEEDS`` on are fitted to. For these and for as many
tables of other seeds, the command prints the decided and the right matches and the calibration error, without and with
the shipped weights of :mod:`deixis.reasoning.grounding.matching.posterior.coincidences`. Intervals are Wilson's, 95 per
cent, as if matches of one table were independent. ``--tables N`` is the number of large tables of each setting and
layout.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from bench_faults import interval
from bench_large import case
from records import command_line, recorded

from deixis.deadline import Deadline
from deixis.experiments.generated_tables import LAYOUTS
from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.reasoning.grounding.fitting.coincidences import JudgedTable, fit_coincidences
from deixis.reasoning.grounding.matching.posterior.coincidences import SHIPPED_WEIGHTS, CoincidenceWeights, coincidences
from deixis.reasoning.grounding.matching.posterior.posterior import posterior
from deixis.reasoning.grounding.options import is_decided

FITTED_SEEDS, OTHER_SEEDS = 500, 900
SETTINGS = [  # objects, facts per object, kinds known, share missing, tables for each large one
    (12, 2.0, False, 0.0, 4),
    (12, 2.0, False, 0.1, 4),
    (12, 2.0, True, 0.0, 3),
    (12, 2.0, True, 0.1, 3),
    (30, 3.5, False, 0.0, 2),
    (30, 3.5, False, 0.1, 2),
    (100, 6.0, False, 0.0, 1),
    (100, 6.0, False, 0.05, 1),
    (100, 6.0, False, 0.1, 1),
    (100, 2.5, True, 0.1, 1),
]
NO_COINCIDENCES = CoincidenceWeights(0.0, 1.0, 0.0, 1.0)


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--tables", type=int, default=2, help="large tables of each setting and layout")
    parser.add_argument("--limit", type=float, default=6.0, help="time limit of a posterior, in seconds")
    parser.add_argument("--fit-only", action="store_true", help="no tables of other seeds")
    with recorded(parser) as options:
        fitted = [list(judged(setting, options.tables, FITTED_SEEDS, options.limit)) for setting in SETTINGS]
        print(f"shipped: {listed(SHIPPED_WEIGHTS)}\nfitted: {listed(fit_coincidences(fitted))}", flush=True)
        print_effect("tables fitted to", fitted)
        if not options.fit_only:
            others = [list(judged(setting, options.tables, OTHER_SEEDS, options.limit)) for setting in SETTINGS]
            print_effect("other tables", others)


def judged(setting: tuple[int, float, bool, float, int], large: int, seed: int, limit: float) -> Iterator[JudgedTable]:
    """Yield the tables of a setting with their posteriors."""
    objects, facts, kinds, share, count = setting
    for layout in LAYOUTS:
        for number in range(count * large):
            problem, truth = case(objects, facts, seed + number, layout, kinds, share)
            found = posterior(problem, Deadline.after(limit))
            things = problem.unary.shape[1]
            yield JudgedTable(
                coincidences(problem, found.marginals),
                found.marginals[:, :things].argmax(axis=1) == truth,
                truth == things,
                found.marginals[np.arange(objects), truth],
                found.errors,
            )


def listed(weights: CoincidenceWeights) -> str:
    """Return the weights with their names."""
    return ", ".join(f"{name} {value:.3g}" for name, value in weights._asdict().items())


def print_effect(title: str, settings: list[list[JudgedTable]]) -> None:
    """Print decided matches and calibration errors of each setting, without and with the shipped weights."""
    print(f"{title}\nobjects  facts  kinds  missing  without coincidences; with the shipped weights")
    for (objects, facts, kinds, share, _), tables in zip(SETTINGS, settings, strict=True):
        effects = "; ".join(effect(tables, weights) for weights in (NO_COINCIDENCES, SHIPPED_WEIGHTS))
        print(f"{objects:7}  {facts:5}  {'yes' if kinds else 'no':5}  {share:7}  {effects}", flush=True)


def effect(tables: list[JudgedTable], weights: CoincidenceWeights) -> str:
    """Return the decided and the right matches and the calibration error of tables."""
    probabilities, right, decided = [], [], []
    for table in tables:
        remaining = table.found.remaining(weights)
        present, absent = table.found.probability * remaining, 1 - (1 - table.found.absent) * remaining
        probabilities.append(np.maximum(present, absent))
        right.append(np.where(absent > present, table.missing, table.right))
        decided.append(is_decided(present, table.errors) & (present > absent))
    p, r, d = (np.concatenate(part) for part in (probabilities, right, decided))
    error = expected_calibration_error(p, r)
    return f"{interval(int((d & r).sum()), int(d.sum()))} ({d.mean():.2f} decided), error {error:.3f}"


if __name__ == "__main__":
    main()
