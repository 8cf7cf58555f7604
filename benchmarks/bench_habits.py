"""Measure habits: places of unseen things in the scenarios of TidyBot, from the examples of each scenario alone.

    python benchmarks/bench_habits.py
    python benchmarks/bench_habits.py --wrong
    python benchmarks/bench_habits.py --sharpness    # fit the exponent of the probabilities by cross-validation

A scenario has the places of four to ten things of a person, and other things with their right places. The peers' shares
are published figures on all 96 scenarios (Wu and others 2023), of which ``DEIXIS_DATA`` may hold a part.
"""

from __future__ import annotations

import time
from collections.abc import Sequence

import numpy as np
import yaml
from common import data_folder
from records import command_line, figure, recorded, share

from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.reasoning.habits.habits import Habits, Placement

PUBLISHED = {
    "large language model, examples only": 0.785,
    "large language model, its own summary": 0.912,
    "large language model, people's summaries": 0.975,
}
"""Shares of the unseen things that were placed right, on 96 scenarios."""


EXPONENTS = np.arange(0.5, 4.01, 0.1)
"""Exponents of the probabilities that are compared, relative to the present one."""


def cross_validate(scenarios: Sequence[Sequence[tuple[Placement, str]]]) -> None:
    """Print the exponents that fit all scenarios but one, and the calibration error in the scenario left out."""

    def changed(found: Placement, exponent: float) -> dict[str, float]:
        shares = {place: share**exponent for place, share in found.alternatives}
        return {place: share / sum(shares.values()) for place, share in shares.items()}

    def surprise(scenario: Sequence[tuple[Placement, str]], exponent: float) -> float:
        return -sum(float(np.log(changed(found, exponent)[place])) for found, place in scenario)

    losses = np.array([[surprise(scenario, one) for one in EXPONENTS] for scenario in scenarios])
    best = [float(EXPONENTS[(losses.sum(axis=0) - own).argmin()]) for own in losses]
    pairs = [(pair, one) for scenario, one in zip(scenarios, best, strict=True) for pair in scenario]
    probable = np.array([max(changed(found, one).values()) for (found, _), one in pairs])
    right = np.array([found.place == place for (found, place), _ in pairs])
    error = expected_calibration_error(probable, right)
    print(f"exponents {min(best):.1f} to {max(best):.1f}, calibration error of the scenarios left out {error:.3f}")


def main() -> None:
    """Print the share of the unseen things that are placed right, overall and by scenario, and the calibration."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--wrong", action="store_true", help="print the things that were put elsewhere")
    parser.add_argument("--sharpness", action="store_true", help="cross-validate the exponent of the probabilities")
    with recorded(parser) as arguments:
        folder = data_folder("tidybot")
        if folder is None:
            return
        scenarios = yaml.safe_load((folder / "scenarios.yml").read_text(encoding="utf-8"))
        probable, right, known, by_scenario, placed = [], [], [], [], []
        started = time.process_time()
        for scenario in scenarios:
            habits = Habits(dict(map(tuple, scenario["seen_placements"])), scenario["receptacles"])
            ours = [(habits.place_of(thing), place) for thing, place in scenario["unseen_placements"]]
            placed.append(ours)
            probable += [found.probability for found, _ in ours]
            known += [found.known for found, _ in ours]
            right += [found.place == place for found, place in ours]
            by_scenario.append(np.mean([found.place == place for found, place in ours]))
            for found, place in ours if arguments.wrong else ():
                if found.place != place:
                    print(f"{found.thing}: {found.place}, not {place}; because of {found.because}")
        spent = time.process_time() - started
        error = expected_calibration_error(np.array(probable), np.array(right))
        share("placed right", sum(right), len(right))
        figure("mean share of a scenario", float(np.mean(by_scenario)), "share")
        share("known to the lexicon", sum(known), len(known))
        figure("calibration error", error, "probability")
        print(f"{len(scenarios)} scenarios, {len(right)} unseen things, {spent / len(scenarios):.3f} s each")
        print(f"placed right {sum(right) / len(right):.3f}, mean of the scenarios {np.mean(by_scenario):.3f}")
        print(f"known to the lexicon {sum(known) / len(known):.3f}, calibration error {error:.3f}")
        if arguments.sharpness:
            cross_validate(placed)
        for peer, value in PUBLISHED.items():
            print(f"published, {peer}: {value:.3f}")


if __name__ == "__main__":
    main()
