"""Run the scoreboard's photographs alone, in more node orders: people's descriptions, grounded by each engine.

Visual Relationship Detection (Lu et al. 2016); see :mod:`deixis.experiments.photographs`. Prints means over images,
each a mean over random node orders, with 95 per cent intervals.
"""

from __future__ import annotations

from common import data_folder
from records import command_line, figure, recorded

from deixis.experiments.photographs import FOLDER
from deixis.experiments.scoreboard.board import run_contestants
from deixis.experiments.scoreboard.cases import photograph_cases
from deixis.experiments.scoreboard.contestants import engines


def main() -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--orders", type=int, default=10, help="random node orders per image")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--time-limit", type=float, default=2.0, help="time limit per alignment, in seconds")
    with recorded(parser) as options:
        folder = data_folder(FOLDER)
        if folder is None:
            return
        cases = photograph_cases(folder, options.orders, None, options.seed)
        board = run_contestants(engines(), cases, options.time_limit, lambda _: None)
        (group,) = board.groups
        for one in board.contestants:
            right, grouped = (board.mean(one.name, group, measure) for measure in ("right", "grouped"))
            ends = right.mean - right.half, right.mean + right.half
            figure(f"{one.name}: share named right", right.mean, "share", ends)
            print(
                f"{one.name:<14} share right {right.mean:.3f} ± {right.half:.3f}, up to interchangeability "
                f"{grouped.mean:.3f} ± {grouped.half:.3f}, {right.count} images, {options.orders} node orders"
            )


if __name__ == "__main__":
    main()
