"""The command ``deixis time``: when fluents held, which order is certain, and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from deixis.cli.common import (
    NO,
    UNDECIDED,
    AsJson,
    Picture,
    TimeLimit,
    draw_answer,
    print_json,
    print_lines,
    require_plot,
)
from deixis.cli.progress import progress_bar, time_bar

if TYPE_CHECKING:
    from deixis.reasoning.constraints.proof import Proof
    from deixis.reasoning.temporal.chronology import Chronology
    from deixis.reasoning.temporal.errors import TemporalConflictError
    from deixis.reasoning.temporal.fluent import Pattern
    from deixis.reasoning.temporal.timeline import Timeline

ANY = "*"


def time_command(
    fluents: Annotated[str, typer.Argument(metavar="FLUENTS", help="A file of fluents (.fluents.json).")],
    at: Annotated[
        float | None, typer.Option(metavar="T", help="Print what held, or may have held, at this time.")
    ] = None,
    window: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="FROM TO", help="Print what held, or may have held, at some time in [FROM, TO)."),
    ] = None,
    relate: Annotated[
        tuple[str, str] | None, typer.Option(metavar="A B", help="Print the possible Allen relations of A to B.")
    ] = None,
    explain: Annotated[
        tuple[str, str] | None,
        typer.Option(metavar="A B", help="Print why the relation of A to B, or the bounds of two points, are certain."),
    ] = None,
    pattern: Annotated[
        tuple[str, str, str],
        typer.Option(metavar="S P O", help="Only statements with this subject, predicate and object; * is anything."),
    ] = (ANY, ANY, ANY),
    time_limit: TimeLimit = 10.0,
    plot: Picture = None,
    as_json: AsJson = False,
) -> None:
    """Print the known bounds of when things held, and what follows; exit 1 if the statements contradict."""
    from deixis.errors import DeixisError
    from deixis.grammar.formats.fluents import read_fluents
    from deixis.reasoning.temporal.errors import TemporalConflictError
    from deixis.workflows.reasoning.time import chronology_of, timeline_of

    asked = [name for name, value in (("--at", at), ("--window", window), ("--relate", relate)) if value is not None]
    if len(asked) + (explain is not None) > 1:
        raise DeixisError("time: --at, --window, --relate and --explain exclude one another")
    if pattern != (ANY, ANY, ANY) and (relate is not None or explain is not None):
        raise DeixisError("time: --pattern excludes --relate and --explain")
    require_plot(plot)
    content = read_fluents(fluents)
    try:
        with progress_bar("adding the statements") as progress:
            timeline = timeline_of(content, time_limit, progress)
        with time_bar("inferring", time_limit):
            chronology = chronology_of(content, timeline, time_limit)
    except TemporalConflictError as conflict:
        _print_conflict(conflict, as_json)
        raise typer.Exit(NO) from conflict
    if explain is not None:
        _print_explanation(timeline, *explain, time_limit, as_json)
    elif relate is not None:
        _print_relation(chronology, *relate, as_json)
    elif at is not None or window is not None:
        _print_held(chronology, at, window, _pattern(*pattern), as_json)
    else:
        _print_chronology(chronology, _pattern(*pattern), as_json)
    draw_answer(chronology, plot, as_json)
    if chronology.status == "undecided" or not chronology.exact:
        raise typer.Exit(UNDECIDED)


def _pattern(subject: str, predicate: str, object: str) -> Pattern:
    from deixis.reasoning.temporal.fluent import Pattern

    return Pattern(*(None if word == ANY else word for word in (subject, predicate, object)))


def _print_conflict(conflict: TemporalConflictError, as_json: bool) -> None:
    from deixis.report.reasoning.time import conflict_lines, conflict_to_dict

    _print(conflict_to_dict(conflict) if as_json else conflict_lines(conflict))


def _print_explanation(timeline: Timeline, a: str, b: str, time_limit: float, as_json: bool) -> None:
    from deixis.report.reasoning.time import explanation_lines, explanation_to_dict

    explanations = _explanations(timeline, a, b, time_limit)
    if as_json:
        _print({"a": a, "b": b, "explanations": [explanation_to_dict(explanation) for explanation in explanations]})
    else:
        _print(explanation_lines(explanations, a, b))


def _explanations(timeline: Timeline, a: str, b: str, time_limit: float) -> list[Proof[str]]:
    """Return the proofs of the lower and upper bound between two points, or of the relation between two fluents."""
    if {a, b} <= set(timeline.network.points):
        found = [timeline.explain_bound(b, a, time_limit), timeline.explain_bound(a, b, time_limit)]
    else:
        found = [timeline.explain_relation(a, b, time_limit)]
    return [explanation for explanation in found if explanation is not None]


def _print_relation(chronology: Chronology, a: str, b: str, as_json: bool) -> None:
    from deixis.report.reasoning.time import relation_lines, relation_to_dict

    _print(relation_to_dict(a, b, chronology) if as_json else relation_lines(a, b, chronology))


def _print_held(
    chronology: Chronology, at: float | None, window: tuple[float, float] | None, pattern: Pattern, as_json: bool
) -> None:
    from deixis.reasoning.temporal.chronology import Window
    from deixis.report.reasoning.time import held_lines, held_to_dict

    if window is not None:
        span = Window(*window)
        certain, possible = chronology.held_within(span, pattern), chronology.may_have_held_within(span, pattern)
    else:
        assert at is not None
        certain, possible = chronology.held_at(at, pattern), chronology.may_have_held(at, pattern)
    show = held_to_dict if as_json else held_lines
    _print(show(certain, possible, chronology))


def _print_chronology(chronology: Chronology, pattern: Pattern, as_json: bool) -> None:
    from deixis.report.reasoning.time import chronology_lines, chronology_to_dict

    chosen = [fluent for fluent in chronology.fluents if pattern.matches(fluent.statement)]
    _print(chronology_to_dict(chronology, chosen) if as_json else chronology_lines(chronology, chosen))


def _print(answer: dict[str, Any] | list[str]) -> None:
    """Print plain data as JSON, and lines as they are."""
    print_lines(answer) if isinstance(answer, list) else print_json(answer)
