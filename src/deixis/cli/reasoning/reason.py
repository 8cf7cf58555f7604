"""The command ``deixis reason``: infer what ontologies or the memory entail."""

from __future__ import annotations

import re
import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    MemoryDir,
    TimeLimit,
    print_json,
    print_line,
    print_lines,
    print_note,
)
from deixis.cli.progress import time_bar
from deixis.deadline import Deadline

if TYPE_CHECKING:
    from deixis.reasoning.description_logic.justification import Justification
    from deixis.reasoning.description_logic.owl_rl.materialisation import InferenceStep
    from deixis.reasoning.description_logic.terms import Triple


STATEMENT_EXAMPLE = "write it like 'dx:Fork rdfs:subClassOf dx:Thing'"


class EngineChoice(StrEnum):
    """Reasoners over ontologies."""

    AUTO = "auto"
    RL = "rl"
    HERMIT = "hermit"
    PELLET = "pellet"


def reason(
    files: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[FILE]...", help="Ontologies (.ttl, .nt, .rdf, .owl); default: the memory."),
    ] = None,
    engine: Annotated[
        EngineChoice, typer.Option(help="rl: rules, for many facts; hermit, pellet: all of OWL 2 DL.")
    ] = EngineChoice.AUTO,
    triples: Annotated[bool, typer.Option("--triples", help="Print each inferred triple.")] = False,
    explain: Annotated[
        str | None, typer.Option(metavar="STATEMENT", help="Print why 'SUBJECT PREDICATE OBJECT' follows.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="Print all justifications, not only one.")] = False,
    verdict: Annotated[bool, typer.Option("--verdict", help="Print only the verdict, not the reasons.")] = False,
    turtle: Annotated[bool, typer.Option("--turtle", help="Print only the justifications, as Turtle.")] = False,
    time_limit: TimeLimit = 60.0,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Infer what an ontology entails; exit 1, with the reasons, if it or one of its classes is unsatisfiable."""
    from deixis.errors import DeixisError
    from deixis.reasoning.errors import LimitError, NotEntailedError
    from deixis.workflows.reasoning.reason import read_ontology, read_remembered

    if verdict and (explain is not None or every or turtle or triples):
        raise DeixisError("reason: --verdict excludes --explain, --all, --turtle and --triples")
    if files:
        stated, prefixes = read_ontology(files)
    else:
        from deixis.session import Session

        with Session(memory) as session:
            stated, prefixes = read_remembered(session.memory())
    try:
        if explain is not None:
            _explain(stated, _statement(explain, prefixes), every, turtle, time_limit, as_json)
            code = 0
        else:
            code = _entail(stated, engine, triples, verdict, every, turtle, time_limit, as_json)
    except LimitError as error:
        print_note(error)
        code = UNDECIDED
    except NotEntailedError as error:
        print_note(error)
        code = NO
    raise typer.Exit(code)


def _entail(
    stated: list[Triple],
    engine: EngineChoice,
    triples: bool,
    verdict: bool,
    every: bool,
    turtle: bool,
    time_limit: float,
    as_json: bool,
) -> int:
    """Print the verdict as soon as it is known, then the reasons found in time, then what follows."""
    from deixis.reasoning.description_logic.entailment import explained
    from deixis.reasoning.description_logic.terms import write_ntriples
    from deixis.report.reasoning import reason as report
    from deixis.workflows.reasoning.reason import entailment

    deadline = Deadline.after(time_limit)
    with time_bar("reasoning", time_limit):
        found = entailment(stated, engine.value, time_limit)
    if not (turtle or as_json):
        print_line(report.verdict(found))
        sys.stdout.flush()
    if not (verdict or found.possible):
        last = deadline.for_reasons(time_limit)
        with time_bar("finding the reasons", last.left):
            found = explained(write_ntriples(stated), found, last, every)
    if turtle:
        _print_turtle(*found.inconsistency, *found.impossible)
    elif as_json:
        print_json(found.to_dict())
    elif not verdict:
        print_lines(report.impossibility_lines(found))
        print_lines(report.inferred_lines(found, triples))
    return 0 if found.possible else NO


def _explain(stated: list[Triple], asked: Triple, every: bool, turtle: bool, time_limit: float, as_json: bool) -> None:
    """Print one justification, or each of all as it is found; raise LimitError where more may exist."""
    from deixis.reasoning.description_logic.justification import justify, justify_all
    from deixis.reasoning.description_logic.terms import write_ntriples
    from deixis.reasoning.description_logic.verbalisation import Words, labels_of
    from deixis.reasoning.errors import LimitError
    from deixis.report.reasoning.reason import explanation_lines, justification_to_dict

    deadline, ntriples, words = Deadline.after(time_limit), write_ntriples(stated), Words(labels_of(stated))
    found, unfinished = [], None
    try:
        for one in justify_all(ntriples, asked, deadline) if every else [justify(ntriples, asked, deadline)]:
            found.append(one)
            if not (turtle or as_json):
                print_lines(explanation_lines(one, _steps(one), words))
                sys.stdout.flush()
    except LimitError as error:
        if not found:
            raise
        unfinished = error
    if turtle:
        _print_turtle(*found)
    elif as_json:
        justifications = [justification_to_dict(one, words, _steps(one)) for one in found]
        print_json({"justifications": justifications, "complete": unfinished is None} if every else justifications[0])
    if unfinished is not None:
        raise unfinished


def _steps(found: Justification) -> tuple[InferenceStep, ...]:
    """Return the rule steps from a justification's axioms to its conclusion; none where the rules do not reach it."""
    from deixis.reasoning.description_logic.owl_rl.materialisation import Materialisation
    from deixis.reasoning.description_logic.terms import read_ntriples

    known = Materialisation(read_ntriples(found.ntriples))
    return known.derivation([found.entailed]) if found.entailed is not None and found.entailed in known else ()


def _statement(text: str, prefixes: dict[str, str]) -> Triple:
    """Parse one statement in Turtle, without its full stop."""
    import pyoxigraph as ox

    from deixis.errors import DeixisError
    from deixis.reasoning.description_logic.terms import Triple

    head = "".join(f"@prefix {prefix}: <{base}> .\n" for prefix, base in prefixes.items())
    try:
        found = [quad.triple for quad in ox.parse(f"{head}{text.rstrip(' .')} .".encode(), format=ox.RdfFormat.TURTLE)]
    except (SyntaxError, ValueError) as error:
        unknown = re.search(r"The prefix (\S+) has not been declared", str(error))
        why = f"the prefix {unknown[1]} is not declared" if unknown else STATEMENT_EXAMPLE
        raise DeixisError(f"--explain: '{text}' is not one statement; {why}") from None
    if len(found) != 1:
        raise DeixisError(f"--explain: '{text}' is not one statement; {STATEMENT_EXAMPLE}")
    return Triple(str(found[0].subject), str(found[0].predicate), str(found[0].object))


def _print_turtle(*justifications: Justification) -> None:
    """Print justifications as one Turtle document."""
    import pyoxigraph as ox

    from deixis.memory.semantic.rdf.files import turtle

    text = "".join(justification.ntriples for justification in justifications)
    sys.stdout.write(turtle(quad.triple for quad in ox.parse(text.encode(), format=ox.RdfFormat.N_TRIPLES)))
