"""Run the scoreboard of ``deixis experiment scoreboard`` with other solvers beside the engines.

The peers get the same problem as the engines (log-likelihood ratios of graded meaning) and run at the settings in the
table, their best in ``bench_peers.py``; peers that are not installed, and sizes that are too large for them, are
skipped with a note. ``pip install ortools pygmtools`` installs them. Options are those of the command: ``--quick``,
``--cases``, ``--seed``, ``--time-limit``, ``--plot``, ``--json``.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path

from peers import annealing, cp_sat, faq, graph_matching
from records import command_line, figure, recorded

from deixis.cli.common import print_json, print_lines
from deixis.cli.progress import step_bar
from deixis.experiments.photographs import photographs_folder
from deixis.experiments.scoreboard.contestants import Contestant, ContestantAnswer, engines, peer
from deixis.experiments.scoreboard.plot import plot_scoreboard
from deixis.experiments.scoreboard.report import lines, to_dict
from deixis.experiments.scoreboard.run import ScoreboardPlan, run, steps
from deixis.reasoning.grounding.matching.problem import Problem

MOST = {"annealing": 300, "faq": 100, "cp-sat": 8, "pygmtools": 30}
"""Maximum number of objects; larger cases take minutes, or more memory than a desktop has."""

LEAST_STEPS = 2_000_000
"""Minimum number of proposals of the annealing; its usual number if that is more."""


def peers() -> list[Contestant]:
    """Return swap annealing, FAQ, CP-SAT and three spectral or iterative solvers of pygmtools."""
    found = [
        peer("annealing", f"swap annealing, {LEAST_STEPS:,} proposals or more", _annealing, most=MOST["annealing"]),
        peer("faq", "Frank-Wolfe (Vogelstein et al. 2015), ten starts", _faq, most=MOST["faq"]),
        peer(
            "cp-sat",
            f"ortools, {cp_sat.WORKERS} workers, to the time limit",
            _cp_sat,
            most=MOST["cp-sat"],
            lacking=_lacking("ortools"),
        ),
    ]
    papers = {
        "sm": "Leordeanu and Hebert 2005",
        "rrwm": "Cho et al. 2010",
        "ipfp": "Leordeanu et al. 2009",
    }
    found.extend(
        peer(
            settings.solver,
            f"pygmtools ({papers[settings.solver]}), {settings}",
            partial(_graph_matching, settings=settings),
            most=MOST["pygmtools"],
            lacking=_lacking("pygmtools"),
        )
        for settings in graph_matching.BEST
    )
    return found


def _lacking(package: str) -> str:
    return "" if find_spec(package) else f"{package} is not installed"


def _annealing(problem: Problem, seconds: float) -> ContestantAnswer:
    return ContestantAnswer(annealing.solve(problem, steps=max(LEAST_STEPS, annealing.proposals(len(problem.absent)))))


def _faq(problem: Problem, seconds: float) -> ContestantAnswer:
    return ContestantAnswer(faq.solve(problem))


def _cp_sat(problem: Problem, seconds: float) -> ContestantAnswer:
    solved = cp_sat.solve(problem, seconds)
    return ContestantAnswer(solved.assignment, solved.proved)


def _graph_matching(problem: Problem, seconds: float, settings: graph_matching.Settings) -> ContestantAnswer:
    return ContestantAnswer(graph_matching.solve(problem, settings))


def main(arguments: Sequence[str] | None = None) -> None:
    parser = command_line(__file__, __doc__)
    parser.add_argument("--quick", action="store_true", help="a small part of the cases")
    parser.add_argument("--cases", type=int, default=10, help="tables of each setting; fewer of large ones")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--time-limit", type=float, default=5.0, help="time limit of an engine per case, in seconds")
    parser.add_argument(
        "--size", type=int, action="append", help="only tables of this number of objects; may be repeated"
    )
    parser.add_argument("--plot", type=Path, help="draw the scoreboard (.png, .svg, .pdf)")
    parser.add_argument("--json", action="store_true")
    with recorded(parser, arguments) as options:
        plan = ScoreboardPlan(
            cases=options.cases, seed=options.seed, time_limit=options.time_limit, photographs=photographs_folder()
        )
        plan = plan.quick() if options.quick else plan
        plan = plan.only(options.size) if options.size else plan
        with step_bar(steps(plan)) as tick:
            found = run(plan, [*engines(), *peers()], tick)
        for group in found.main.groups:
            for one in found.main.contestants:
                right = found.main.mean(one.name, group, "right")
                if right.count:
                    ends = right.mean - right.half, right.mean + right.half
                    figure(f"{group}: {one.name}", right.mean, "share", ends)
        if options.plot:
            plot_scoreboard(found, options.plot)
        if options.json:
            print_json(to_dict(found))
        else:
            print_lines(lines(found))


if __name__ == "__main__":
    main()
