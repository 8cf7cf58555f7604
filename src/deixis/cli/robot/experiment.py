"""The commands that run experiments: the paper's Figure 6, the scoreboard of engines, open-ended learning."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from deixis.cli.common import AsJson, print_json, print_lines, print_written, require_plot
from deixis.cli.progress import progress_bar, step_bar

experiment = typer.Typer(
    help="Run an experiment of the paper or of this project.", no_args_is_help=True, rich_markup_mode=None
)

Seed = Annotated[int, typer.Option(metavar="N", min=0, help="Seed of the random numbers.")]


@experiment.command()
def figure6(
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Folder for the pictures.")] = Path("out"),
    variants: Annotated[int, typer.Option(metavar="N", min=1, help="Number of generated place settings.")] = 50,
    orders: Annotated[
        int, typer.Option(metavar="N", min=1, help="Number of random node orders to average over.")
    ] = 200,
    seed: Seed = 1,
    as_json: AsJson = False,
) -> None:
    """Repeat the paper's Figure 6: the accuracy of the matches against the graph similarity."""
    from deixis.experiments.figure6 import figure6_lines, run, steps

    with step_bar(steps(variants)) as tick:
        result = run(out, variants=variants, orders=orders, seed=seed, tick=lambda: tick("place settings"))
    if as_json:
        print_json(result.to_dict())
    else:
        print_lines(figure6_lines(result))


@experiment.command()
def scoreboard(
    cases: Annotated[int, typer.Option(min=1, metavar="N", help="Tables per setting; fewer for large ones.")] = 10,
    seed: Seed = 1,
    time_limit: Annotated[float, typer.Option(min=0.01, metavar="SECONDS", help="Per engine and case.")] = 5.0,
    quick: Annotated[bool, typer.Option("--quick", help="Run a small part, in a minute or two.")] = False,
    size: Annotated[
        list[int] | None, typer.Option(metavar="N", min=4, max=1000, help="Only tables of this many objects.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the answer (.png, .svg, .pdf).")] = None,
    as_json: AsJson = False,
) -> None:
    """Compare the engines on generated tables, and on the photographs in $DEIXIS_DATA if it is set."""
    from deixis.experiments.photographs import photographs_folder
    from deixis.experiments.scoreboard.report import lines
    from deixis.experiments.scoreboard.run import ScoreboardPlan, run, steps

    require_plot(plot)
    plan = ScoreboardPlan(cases=cases, seed=seed, time_limit=time_limit, photographs=photographs_folder())
    plan = plan.quick() if quick else plan
    plan = plan.only(size) if size else plan
    with step_bar(steps(plan)) as tick:
        found = run(plan, tick=tick)
    if plot is not None:
        from deixis.experiments.scoreboard.plot import plot_scoreboard

        with progress_bar("drawing"):
            plot_scoreboard(found, plot)
    if as_json:
        print_json(found.to_dict())
    else:
        print_lines(lines(found))
        print_written(plot)


@experiment.command("open-ended")
def open_ended(
    orders: Annotated[int, typer.Option(metavar="N", min=1, help="Number of random teaching orders.")] = 10,
    seed: Seed = 1,
    quick: Annotated[bool, typer.Option("--quick", help="Nine kinds, no meshes, at most three orders.")] = False,
    cache: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder that keeps the computed descriptors.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Draw the answer (.png, .svg, .pdf).")] = None,
    as_json: AsJson = False,
) -> None:
    """Teach each learner one kind after another, in random orders, until it learns no more."""
    from deixis.experiments.open_ended.report import lines
    from deixis.experiments.open_ended.run import OpenEndedPlan, run
    from deixis.experiments.open_ended.things import meshes_folder

    require_plot(plot)
    plan = OpenEndedPlan(orders=orders, seed=seed, meshes=meshes_folder(), cache=cache)
    found = run(plan.quick() if quick else plan, stage=step_bar)
    if plot is not None:
        from deixis.experiments.open_ended.plot import plot_open_ended

        with progress_bar("drawing"):
            plot_open_ended(found, plot)
    if as_json:
        print_json(found.to_dict())
    else:
        print_lines(lines(found))
        print_written(plot)


@experiment.command()
def apprentice(
    tables: Annotated[int, typer.Option(min=1, metavar="N", help="Number of tables that are checked.")] = 100,
    seed: Seed = 1,
    noise: Annotated[
        float, typer.Option(min=0.0, max=10.0, metavar="FACTOR", help="Factor on the noise of the depth camera.")
    ] = 1.0,
    story: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Write key frames of a small run, and a page, to a folder.")
    ] = None,
    as_json: AsJson = False,
) -> None:
    """Show a robot four things, describe six layouts on example tables, and have it check further tables."""
    from deixis.experiments.apprentice.report import lines
    from deixis.experiments.apprentice.run import ApprenticePlan, run

    if story is not None:
        from deixis.experiments.apprentice.story import FIRST
        from deixis.plots.figure import require_picture

        require_picture(story / FIRST)  # before the tables, which take minutes
    plan = ApprenticePlan(tables=tables, seed=seed, noise=noise)
    with step_bar(plan.steps) as tick:
        found = run(plan, tick=lambda: tick("tables"))
    if story is not None:
        from deixis.experiments.apprentice.story import write_story

        with progress_bar("drawing the story"):
            write_story(plan, story)
    if as_json:
        print_json(found.to_dict())
    else:
        print_lines(lines(found))
