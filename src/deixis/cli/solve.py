"""The command that solves constraint networks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, TimeLimit, compiled, print_json, print_written, progress_bar

if TYPE_CHECKING:
    from deixis.workflows.solve import SolvedNetwork


def solve(
    network: Annotated[str, typer.Argument(metavar="NETWORK", help="Constraint networks in GQR's format (.csp).")],
    calculus: Annotated[str, typer.Option(metavar="NAME[+NAME…]", help="point, allen, ra, ba, rcc8, cd, …")],
    closure: Annotated[bool, typer.Option("--closure", help="Print the closed network.")] = False,
    scenario: Annotated[bool, typer.Option("--scenario", help="Print one way all of it can hold.")] = False,
    explain: Annotated[
        tuple[int, int] | None, typer.Option(metavar="I J", help="Print why I and J are related as they are.")
    ] = None,
    out: Annotated[Path | None, typer.Option("-o", "--out", metavar="FILE", help="Write the network there.")] = None,
    time_limit: TimeLimit = 60.0,
    as_json: AsJson = False,
) -> None:
    """Say whether constraint networks are consistent: exit 0, 1 where one is not, 3 where one stays undecided."""
    from deixis.errors import DeixisError
    from deixis.grammar.formats.networks import read_networks
    from deixis.workflows.solve import Wish, calculi_named, ready_to_solve, solve_text

    if closure and scenario:
        raise DeixisError("--closure and --scenario exclude each other")
    if out is not None and not (closure or scenario):
        raise DeixisError("-o writes the network that --closure or --scenario prints; give one of them")
    wish = Wish(closure, scenario, explain, time_limit)
    texts = read_networks(network, calculi_named(calculus))
    compiled(ready_to_solve)
    with progress_bar("closing") as progress:
        solved = [solve_text(text, wish, progress) for text in texts]
    _report(network, solved, out, as_json)
    raise typer.Exit(_code(solved))


def _report(file: str, solved: list[SolvedNetwork], out: Path | None, as_json: bool) -> None:
    from deixis.grammar.formats.networks import network_lines
    from deixis.report.solve import solved_lines, solved_to_dict

    shown = [line for each in solved if each.shown for line in network_lines(each.shown, each.text.comment)]
    if out is not None:
        out.write_text("".join(f"{line}\n" for line in shown), encoding="utf-8")
    if as_json:
        data = {"file": file, "networks": [solved_to_dict(each) for each in solved]}
        print_json(data)
        return
    said = [line for each in solved for line in solved_lines(each)]
    # what is printed as a network can be read again: the verdict is a comment beside it
    print("\n".join([f"# {line}" for line in said] + shown if shown and out is None else said))
    print_written(out)


def _code(solved: list[SolvedNetwork]) -> int:
    from deixis.reasoning.qualitative.networks.search import Verdict

    verdicts = {each.verdict for each in solved}
    if Verdict.INCONSISTENT in verdicts:
        return NO
    return UNDECIDED if Verdict.UNDECIDED in verdicts else 0
