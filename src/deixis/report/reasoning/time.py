"""Chronologies of fluents as lines of text and as plain data for JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.report.marks import doubt, violation

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from deixis.reasoning.constraints.proof import Proof
    from deixis.reasoning.temporal.bounds import Bounds
    from deixis.reasoning.temporal.chronology import Chronology
    from deixis.reasoning.temporal.errors import TemporalConflictError
    from deixis.reasoning.temporal.fluent import Fluent


def chronology_lines(chronology: Chronology, fluents: Sequence[Fluent] | None = None) -> list[str]:
    """Return each fluent with the tightened bounds of its start, its finish and its duration, in seconds.

    Parameters
    ----------
    chronology
        Solved network of the fluents.
    fluents
        Fluents to list; None for all.

    Returns
    -------
    list of str
        A heading and one aligned line for each fluent; then a notice if the bounds are not exact.
    """
    fluents = chronology.fluents if fluents is None else fluents
    rows = [
        (
            fluent.id,
            str(fluent.statement),
            f"start {chronology.start(fluent.id)}",
            f"finish {chronology.finish(fluent.id)}",
            f"duration {chronology.duration(fluent.id)}",
        )
        for fluent in fluents
    ]
    head = f"{chronology.file}: {count(len(fluents), 'fluent')}, in seconds since: {chronology.origin}"
    return [head, *_aligned(rows), *_caveat(chronology)]


def _aligned(rows: Sequence[tuple[str, ...]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def _caveat(chronology: Chronology) -> list[str]:
    from deixis.reasoning.temporal.chronology import Status

    if chronology.status is Status.UNDECIDED:
        line = "Undecided: time limit reached; the certain facts are certain only if the statements can all hold."
        return [doubt(line)]
    if not chronology.exact:
        return [doubt("There are too many alternatives to try all of them: more may be certain than is printed here.")]
    return []


def held_lines(certain: Sequence[Fluent], possible: Sequence[Fluent], chronology: Chronology) -> list[str]:
    """Return which fluents certainly held, and which others may have held.

    Parameters
    ----------
    certain
        Fluents that held in every solution.
    possible
        Fluents that held in some solution, the certain ones included.
    chronology
        Solved network that both were taken from.

    Returns
    -------
    list of str
        One aligned line for each possible fluent, or one sentence where there is none.
    """
    rows = [("certain" if fluent in certain else "possible", fluent.id, str(fluent.statement)) for fluent in possible]
    return [*(_aligned(rows) if rows else ["No fluent can have held then."]), *_caveat(chronology)]


def relation_lines(a: str, b: str, chronology: Chronology) -> list[str]:
    """Return the possible Allen relations between two fluents, and the order that is certain.

    Parameters
    ----------
    a, b
        Ids of two fluents.
    chronology
        Solved network of the fluents.

    Returns
    -------
    list of str
        The relations, then the order of the two if it is certain.
    """
    names = [relation.name.lower() for relation in chronology.relations(a, b)]
    order = chronology.certain_order(a, b)
    lines = [f"certain: {names[0]}({a}, {b})" if len(names) == 1 else f"possible: {', '.join(names)} ({a}, {b})"]
    return [*lines, *([f"certain order: {a} {order} {b}"] if order else []), *_caveat(chronology)]


def explanation_lines(explanations: Sequence[Proof[str]], a: str, b: str) -> list[str]:
    """Return the proofs of what is certain about two fluents or points.

    Parameters
    ----------
    explanations
        Proofs, one for each certain statement.
    a, b
        Names of the two fluents or points, for the sentence where there are no proofs.

    Returns
    -------
    list of str
        Lines of the proofs, one proof after another.
    """
    if not explanations:
        return [f"Nothing is certain about '{a}' and '{b}'."]
    return [line for explanation in explanations for line in explanation.lines()]


def conflict_lines(conflict: TemporalConflictError) -> list[str]:
    """Return the statements that contradict each other, and the proof.

    Parameters
    ----------
    conflict
        Error of an inconsistent chronology.

    Returns
    -------
    list of str
        The statements with their places, marked as violations; then the advice and the proof.
    """
    lines = [violation("These cannot all hold:")]
    places = [f"{stated.source}: " if stated.source else "" for stated in conflict.statements]
    lines += [
        violation(f"    {place}{stated.claim}") for place, stated in zip(places, conflict.statements, strict=True)
    ]
    minimal, unsure = "Leave out or change any one of these.", "Time limit reached before all were tried."
    return [*lines, minimal if conflict.minimal else unsure, "The proof:", *conflict.explanation.lines("    ")]


def chronology_to_dict(chronology: Chronology, fluents: Sequence[Fluent] | None = None) -> dict[str, Any]:
    """Return each fluent with its tightened bounds in seconds; an unknown bound is None.

    Parameters
    ----------
    chronology
        Solved network of the fluents.
    fluents
        Fluents to list; None for all.

    Returns
    -------
    dict
        Data for JSON with the keys ``file``, ``origin``, ``verdict``, ``exact`` (False if more may be certain) and
        ``fluents``.
    """
    return {
        "file": chronology.file,
        "origin": chronology.origin,
        "verdict": chronology.status.value,
        "exact": chronology.exact,
        "fluents": [
            {
                "id": fluent.id,
                "statement": str(fluent.statement),
                "start": _bounds(chronology.start(fluent.id)),
                "finish": _bounds(chronology.finish(fluent.id)),
                "duration": _bounds(chronology.duration(fluent.id)),
            }
            for fluent in (chronology.fluents if fluents is None else fluents)
        ],
    }


def chronology_rows(chronology: Chronology) -> Iterator[dict[str, Any]]:
    """Yield a row for each fluent, with the tightened bounds of its times in seconds.

    Parameters
    ----------
    chronology
        Solved network of the fluents.

    Yields
    ------
    dict
        ``id``, ``statement``, and the earliest and latest start and finish (``start_from``, ``start_to``,
        ``finish_from``, ``finish_to``); an unknown bound is infinite.
    """
    for fluent in chronology.fluents:
        start, finish = chronology.start(fluent.id), chronology.finish(fluent.id)
        yield {
            "id": fluent.id,
            "statement": str(fluent.statement),
            "start_from": start.lower,
            "start_to": start.upper,
            "finish_from": finish.lower,
            "finish_to": finish.upper,
        }


def _bounds(bounds: Bounds) -> dict[str, Any]:
    from math import isinf

    ends = [None if isinf(bound) else bound for bound in (bounds.lower, bounds.upper)]
    return {"lower": ends[0], "upper": ends[1], "lower_open": bounds.lower_open, "upper_open": bounds.upper_open}


def held_to_dict(certain: Sequence[Fluent], possible: Sequence[Fluent], chronology: Chronology) -> dict[str, Any]:
    """Return the ids of the fluents that certainly held, and of all that may have held.

    Parameters
    ----------
    certain
        Fluents that held in every solution.
    possible
        Fluents that held in some solution, the certain ones included.
    chronology
        Solved network that both were taken from.

    Returns
    -------
    dict
        Data for JSON with the keys ``verdict``, ``exact``, ``certain`` and ``possible``.
    """
    known = {"verdict": chronology.status.value, "exact": chronology.exact}
    return {**known, "certain": [fluent.id for fluent in certain], "possible": [fluent.id for fluent in possible]}


def relation_to_dict(a: str, b: str, chronology: Chronology) -> dict[str, Any]:
    """Return the possible Allen relations between two fluents, and the order that is certain.

    Parameters
    ----------
    a, b
        Ids of two fluents.
    chronology
        Solved network of the fluents.

    Returns
    -------
    dict
        Data for JSON. ``certain`` is the only possible relation, or None; ``order`` is None if the order is not
        certain.
    """
    names = [relation.name.lower() for relation in chronology.relations(a, b)]
    order = chronology.certain_order(a, b)
    return {
        "verdict": chronology.status.value,
        "exact": chronology.exact,
        "a": a,
        "b": b,
        "possible": names,
        "certain": names[0] if len(names) == 1 else None,
        "order": order.value if order else None,
    }


def explanation_to_dict(explanation: Proof[str]) -> dict[str, Any]:
    """Return a proof as a tree, down to the stated facts.

    Parameters
    ----------
    explanation
        Proof of a statement about times.

    Returns
    -------
    dict
        Nested data for JSON: ``conclusion``, ``rule``, ``source`` and ``premises``, which are dictionaries of the same
        form.
    """
    return {
        "conclusion": explanation.claim,
        "rule": explanation.rule.value,
        "source": explanation.source,
        "premises": [explanation_to_dict(premise) for premise in explanation.premises],
    }


def conflict_to_dict(conflict: TemporalConflictError) -> dict[str, Any]:
    """Return the statements that contradict each other, and the proof.

    Parameters
    ----------
    conflict
        Error of an inconsistent chronology.

    Returns
    -------
    dict
        Data for JSON with the keys ``verdict``, ``minimal``, ``statements`` and ``explanation``.
    """
    statements = [{"statement": stated.claim, "source": stated.source} for stated in conflict.statements]
    proof = explanation_to_dict(conflict.explanation)
    return {"verdict": "inconsistent", "minimal": conflict.minimal, "statements": statements, "explanation": proof}
