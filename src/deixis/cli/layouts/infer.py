"""The command ``deixis infer``: what follows from a script, why it follows, and why a fact does not follow."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, Script, TimeLimit, print_json, print_line, print_lines
from deixis.cli.progress import time_bar

if TYPE_CHECKING:
    from deixis.ontology.graph.facts import Fact
    from deixis.workflows.layouts.infer import Inference


def infer(
    script: Script,
    explain: Annotated[
        str | None, typer.Option(metavar="FACT", help="Print why a fact holds: 'left(fork, plate)'.")
    ] = None,
    why_not: Annotated[
        str | None, typer.Option("--why-not", metavar="FACT", help="Print why a fact does not follow.")
    ] = None,
    ntriples: Annotated[bool, typer.Option("--ntriples", help="Print all facts that hold as N-Triples.")] = False,
    verdict: Annotated[bool, typer.Option("--verdict", help="Print only whether the facts can all hold.")] = False,
    time_limit: TimeLimit = 10.0,
    as_json: AsJson = False,
) -> None:
    """Print what a script states and implies, or a minimal contradiction in it (exit 1)."""
    from deixis.errors import DeixisError
    from deixis.report.layouts.script import inference_lines
    from deixis.workflows.layouts.infer import infer as run
    from deixis.workflows.layouts.infer import plain_fact

    if explain is not None and why_not is not None:
        raise DeixisError("infer: --explain and --why-not exclude each other")
    if ntriples and (as_json or explain is not None or why_not is not None):
        raise DeixisError("infer: --ntriples excludes --json, --explain and --why-not")
    if verdict:
        if ntriples or explain is not None or why_not is not None:
            raise DeixisError("infer: --verdict excludes --explain, --why-not and --ntriples")
        raise typer.Exit(_verdict(script, time_limit, as_json))
    text, option = (explain, "--explain") if explain is not None else (why_not, "--why-not")
    fact = None if text is None else replace(plain_fact(text, option), source=None)
    with time_bar("inferring", time_limit, source=script):
        inference = run(script, time_limit)
    if fact is not None and inference.consistent and inference.decided:
        (_explain if explain is not None else _why_not)(inference, fact, as_json)
        return
    if ntriples and inference.consistent and inference.decided:
        sys.stdout.write(inference.implications.ntriples())
    elif as_json:
        from deixis.report.json_answers import inference_to_dict

        print_json(inference_to_dict(inference))
    else:
        print_lines(inference_lines(inference))
    if not inference.consistent:
        raise typer.Exit(NO)
    if not inference.decided or not inference.complete:
        raise typer.Exit(UNDECIDED)


def _verdict(script: str, time_limit: float, as_json: bool) -> int:
    from deixis.workflows.layouts.infer import verdict_of

    with time_bar("inferring", time_limit, source=script):
        found = verdict_of(script, time_limit)
    if as_json:
        print_json({"consistent": found})
    else:
        words = {True: "consistent", False: "The script contradicts itself.", None: "Undecided within the time limit."}
        print(words[found])
    return {True: 0, False: NO, None: UNDECIDED}[found]


def _explain(inference: Inference, fact: Fact, as_json: bool) -> None:
    from deixis.ontology.graph.export import fact_to_dict
    from deixis.report.json_answers import derivation_to_dict
    from deixis.workflows.layouts.infer import require_names

    require_names(inference, fact, "--explain")
    derivation = inference.derive(fact.relations[0], fact.subject, fact.object)
    if as_json:
        print_json({"fact": fact_to_dict(fact), "derivation": derivation and derivation_to_dict(derivation)})
    elif derivation is None:
        print_line(f"{fact} does not follow from the script (--why-not says why).")
    else:
        print_lines(derivation.lines())
    if derivation is None:
        raise typer.Exit(NO)


def _why_not(inference: Inference, fact: Fact, as_json: bool) -> None:
    """Print why a fact does not follow; exit with NO where it does follow."""
    from deixis.reasoning.entailment.why_not import why_not
    from deixis.report.json_answers import why_not_to_dict
    from deixis.report.layouts.script import why_not_lines
    from deixis.workflows.layouts.infer import require_names

    require_names(inference, fact, "--why-not")
    found = why_not(inference.implications, fact)
    if as_json:
        print_json(why_not_to_dict(found))
    else:
        print_lines(why_not_lines(found))
    if found.follows is not None:
        raise typer.Exit(NO)
