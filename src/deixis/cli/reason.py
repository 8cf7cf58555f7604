"""The command that reasons over ontologies, or over everything remembered."""

from __future__ import annotations

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from deixis.cli.common import NO, UNDECIDED, AsJson, MemoryDir, TimeLimit, print_json, print_lines
from deixis.deadline import Deadline

if TYPE_CHECKING:
    from deixis.reasoning.description_logic.justification import Justification
    from deixis.reasoning.description_logic.materialisation import InferenceStep
    from deixis.reasoning.description_logic.terms import Triple


class EngineChoice(StrEnum):
    AUTO = "auto"
    RL = "rl"
    HERMIT = "hermit"
    PELLET = "pellet"


def reason(
    files: Annotated[
        list[Path] | None, typer.Argument(metavar="[FILE]...", help="Ontologies (.ttl, .nt, .rdf, .owl); else memory.")
    ] = None,
    engine: Annotated[
        EngineChoice, typer.Option(help="rl: rules, for many facts; hermit, pellet: all of OWL 2 DL.")
    ] = EngineChoice.AUTO,
    triples: Annotated[bool, typer.Option("--triples", help="Print each triple that was inferred.")] = False,
    explain: Annotated[
        str | None, typer.Option(metavar="STATEMENT", help="Print why 'SUBJECT PREDICATE OBJECT' follows.")
    ] = None,
    turtle: Annotated[bool, typer.Option("--turtle", help="Print justifications as Turtle, and nothing else.")] = False,
    time_limit: TimeLimit = 60.0,
    memory: MemoryDir = None,
    as_json: AsJson = False,
) -> None:
    """Infer what an ontology entails; exit 1 where it, or a class of it, is impossible, and say why."""
    from deixis.reasoning.errors import LimitError, NotEntailedError
    from deixis.workflows.reason import read_ontology, read_remembered

    if files:
        stated, prefixes = read_ontology(files)
    else:
        from deixis.session import Session

        with Session(memory) as session:
            stated, prefixes = read_remembered(session.memory())
    try:
        if explain is not None:
            code = _explain(stated, _statement(explain, prefixes), turtle, time_limit, as_json)
        else:
            code = _entail(stated, engine, triples, turtle, time_limit, as_json)
    except LimitError as error:
        print(f"deixis: {error}", file=sys.stderr)
        code = UNDECIDED
    except NotEntailedError as error:
        print(f"deixis: {error}", file=sys.stderr)
        code = NO
    raise typer.Exit(code)


def _entail(
    stated: list[Triple], engine: EngineChoice, triples: bool, turtle: bool, time_limit: float, as_json: bool
) -> int:
    from deixis.reasoning.description_logic.entailment import entail
    from deixis.reasoning.description_logic.terms import write_ntriples
    from deixis.reasoning.description_logic.verbalisation import Words, labels_of
    from deixis.report.reason import entailment_lines, entailment_to_dict

    found = entail(write_ntriples(stated), engine.value, time_limit)
    words = Words(labels_of(stated))
    if turtle:
        _print_turtle(*([found.inconsistency] if found.inconsistency else []), *found.impossible)
    elif as_json:
        print_json(entailment_to_dict(found, words))
    else:
        print_lines(entailment_lines(found, words, triples))
    return 0 if found.consistent and not found.unsatisfiable else NO


def _explain(stated: list[Triple], asked: Triple, turtle: bool, time_limit: float, as_json: bool) -> int:
    from deixis.reasoning.description_logic.justification import justify
    from deixis.reasoning.description_logic.terms import write_ntriples
    from deixis.reasoning.description_logic.verbalisation import Words, labels_of
    from deixis.report.reason import explanation_lines, justification_to_dict

    found = justify(write_ntriples(stated), asked, Deadline.after(time_limit))
    words, steps = Words(labels_of(stated)), _steps(found)
    if turtle:
        _print_turtle(found)
    elif as_json:
        print_json(justification_to_dict(found, words, steps))
    else:
        print_lines(explanation_lines(found, steps, words))
    return 0


def _steps(found: Justification) -> tuple[InferenceStep, ...]:
    """The steps by which the rules lead from a justification's axioms to what it justifies, if they do."""
    from deixis.reasoning.description_logic.materialisation import Materialisation
    from deixis.reasoning.description_logic.terms import read_ntriples

    known = Materialisation(read_ntriples(found.ntriples))
    return known.derivation([found.entailed]) if found.entailed is not None and found.entailed in known else ()


def _statement(text: str, prefixes: dict[str, str]) -> Triple:
    """One statement in Turtle, without its full stop."""
    import pyoxigraph as ox

    from deixis.errors import DeixisError
    from deixis.reasoning.description_logic.terms import Triple

    head = "".join(f"@prefix {prefix}: <{base}> .\n" for prefix, base in prefixes.items())
    try:
        found = [quad.triple for quad in ox.parse(f"{head}{text.rstrip(' .')} .".encode(), format=ox.RdfFormat.TURTLE)]
    except (SyntaxError, ValueError) as error:
        raise DeixisError(f"--explain: '{text}' is not one statement: {' '.join(str(error).split())}") from None
    if len(found) != 1:
        raise DeixisError(f"--explain: '{text}' is not one statement; write it like 'dx:Fork rdfs:subClassOf dx:Thing'")
    return Triple(str(found[0].subject), str(found[0].predicate), str(found[0].object))


def _print_turtle(*justifications: Justification) -> None:
    """All of them as one document."""
    import pyoxigraph as ox

    from deixis.memory.semantic.rdf.files import turtle

    text = "".join(justification.ntriples for justification in justifications)
    sys.stdout.write(turtle(quad.triple for quad in ox.parse(text.encode(), format=ox.RdfFormat.N_TRIPLES)))
