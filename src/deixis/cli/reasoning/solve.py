"""The command ``deixis solve``: decide whether constraint networks are consistent."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    TimeLimit,
    print_json,
    print_line,
    print_lines,
    print_note,
    print_written,
    tell_of_compiling,
)
from deixis.cli.completion import complete_calculi
from deixis.cli.progress import progress_bar

if TYPE_CHECKING:
    from deixis.workflows.reasoning.solve import Solved, SolvedNetwork


def solve(
    network: Annotated[str, typer.Argument(metavar="NETWORK", help="Constraint networks in GQR's format (.csp).")],
    calculus: Annotated[
        str,
        typer.Option(
            metavar="NAME[+NAME…]",
            help="point, allen, ra, ba, rcc8, cd, …; or FILE.spec.",
            autocompletion=complete_calculi,
        ),
    ],
    closure: Annotated[bool, typer.Option("--closure", help="Print the closed network.")] = False,
    scenario: Annotated[bool, typer.Option("--scenario", help="Print one solution.")] = False,
    explain: Annotated[
        tuple[int, int] | None, typer.Option(metavar="I J", help="Print a derivation of the relation of I and J.")
    ] = None,
    verdict: Annotated[bool, typer.Option("--verdict", help="Print only the verdict, not the reasons.")] = False,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the network.")] = None,
    time_limit: TimeLimit = 60.0,
    as_json: AsJson = False,
) -> None:
    """Decide whether constraint networks are consistent; exit 1 if one is not, 3 if one stays undecided."""
    from deixis.errors import DeixisError
    from deixis.grammar.formats.networks import read_networks
    from deixis.reasoning.qualitative.networks.search.consistency import Verdict
    from deixis.report.reasoning.solve import reason_lines
    from deixis.workflows.reasoning.solve import Solved, SolveRequest, calculi_named, solve_text

    if closure and scenario:
        raise DeixisError("--closure and --scenario must not be given together; choose one")
    if out is not None and not (closure or scenario):
        raise DeixisError("-o writes the network that --closure or --scenario prints; give one of them")
    if verdict and (closure or scenario or explain is not None):
        raise DeixisError("--verdict must not be given with --closure, --scenario or --explain; leave it out")
    request = SolveRequest(closure, scenario, explain, not verdict, time_limit)
    calculi, notes = calculi_named(calculus)
    for note in notes:
        print_note(note)
    texts = read_networks(network, calculi)
    tell_of_compiling()
    aside = as_json or (out is None and (closure or scenario))  # then a program reads the output
    found = []
    with progress_bar("closing") as progress:
        for text in texts:
            found.append(solve_text(text, request, progress, _print_nothing if aside else _print_verdict))
            if not aside:
                print_lines(reason_lines(found[-1], not verdict))
    solved = Solved(network, tuple(found))
    _report(solved, out, as_json, aside)
    raise typer.Exit({Verdict.INCONSISTENT: NO, Verdict.UNDECIDED: UNDECIDED}.get(solved.verdict, 0))


def _print_verdict(solved: SolvedNetwork) -> None:
    from deixis.report.reasoning.solve import verdict_line

    print_line(verdict_line(solved))
    sys.stdout.flush()


def _print_nothing(solved: SolvedNetwork) -> None:
    pass


def _report(solved: Solved, out: Path | None, as_json: bool, aside: bool) -> None:
    """Print what did not come with the verdicts: JSON, or networks with the findings as comments."""
    from deixis.grammar.formats.networks import network_lines
    from deixis.report.reasoning.solve import file_lines
    from deixis.text_files import replace_text

    shown = [line for each in solved.networks if each.shown for line in network_lines(each.shown, each.text.comment)]
    if out is not None:
        replace_text(out, "".join(f"{line}\n" for line in shown))
    if as_json:
        print_json(solved.to_dict())
        return
    if aside:
        lines = file_lines(solved)
        print_lines([f"# {line}" for line in lines] + shown if shown else lines)
    print_written(out)
