"""Measure habits: places of unseen things in the scenarios of TidyBot, from the examples of each scenario alone.

    python benchmarks/bench_habits.py
    python benchmarks/bench_habits.py --wrong

A scenario has the places of four to ten things of a person, and other things with their right places. The peers' shares
are published figures on all 96 scenarios (Wu and others 2023), of which ``DEIXIS_DATA`` may hold a part.
"""

from __future__ import annotations

import time

import numpy as np
import yaml
from common import data_folder
from records import command_line, figure, recorded, share

from deixis.perception.recognition.calibration import expected_calibration_error
from deixis.reasoning.habits.habits import Habits

PUBLISHED = {
    "large language model, examples only": 0.785,
    "large language model, its own summary": 0.912,
    "large language model, people's summaries": 0.975,
}
"""Shares of the unseen things that were placed right, on 96 scenarios."""


def main() -> None:
    """Print the share of the unseen things that are placed right, overall and by scenario, and the calibration."""
    parser = command_line(__file__, __doc__)
    parser.add_argument("--wrong", action="store_true", help="print the things that were put elsewhere")
    with recorded(parser) as arguments:
        folder = data_folder("tidybot")
        if folder is None:
            return
        scenarios = yaml.safe_load((folder / "scenarios.yml").read_text(encoding="utf-8"))
        probable, right, known, by_scenario = [], [], [], []
        started = time.process_time()
        for scenario in scenarios:
            habits = Habits(dict(map(tuple, scenario["seen_placements"])), scenario["receptacles"])
            ours = [(habits.place_of(thing), place) for thing, place in scenario["unseen_placements"]]
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
        for peer, value in PUBLISHED.items():
            print(f"published, {peer}: {value:.3f}")


if __name__ == "__main__":
    main()
