"""Imagined tables as lines of text and as plain data for JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from deixis.answers import share
from deixis.ontology.graph.export import fact_to_dict
from deixis.ontology.graph.facts import Fact
from deixis.ontology.things.sizes import Extent
from deixis.perception.formats.scene_json import scene_to_dict
from deixis.reasoning.grounding.answers.claims import ClaimVerdict
from deixis.report.json_answers import claim_outcome_to_dict
from deixis.report.marks import doubt, violation
from deixis.workflows.layouts.imagine import Imagination, ImaginedTable, NoTable, Sized


def imagination_lines(found: Imagination) -> list[str]:
    """Return the tables and the facts that they give up, or the facts that allow no table, with file and line.

    Parameters
    ----------
    found
        Answer of ``deixis imagine``.

    Returns
    -------
    list of str
        The tables, with a heading for each where there are several; the conflict where no table is possible; or one
        line, marked as doubt, where the time limit ended the search.
    """
    if found.none is not None:
        return list(_none_lines(found.none))
    if not found.tables:
        line = "Undecided: time limit reached before a table was found or proved impossible; raise --time-limit."
        return [doubt(line)]
    lines: list[str] = []
    for number, table in enumerate(found.tables, start=1):
        if len(found.tables) > 1:
            lines += ["", f"Table {number}"] if lines else [f"Table {number}"]
        lines += _table_lines(table)
    return lines


def _table_lines(table: ImaginedTable) -> Iterator[str]:
    for thing, sized in zip(table.scene.objects, table.objects, strict=True):
        (x, y), (right, top) = thing.minimum[:2], thing.maximum[:2]
        kind = sized.kind.label if sized.kind else "kind not known"
        size, place = f"{_cm(right - x)} x {_cm(top - y)} cm", f"at {_cm((x + right) / 2)}, {_cm((y + top) / 2)}"
        yield f"{sized.name:<24} {size:<16} {place:<16} {kind}"
    total = len(table.holds) + len(table.waived) + len(table.not_shown)
    yield _held_line(len(table.holds), total)
    if table.claims:
        satisfied = sum(entry.verdict is ClaimVerdict.SATISFIED for entry in table.claims)
        yield _held_line(satisfied, len(table.claims), "claim")
    for waived in table.waived:
        what = "optional" if waived.fact.optional else f"weight {waived.fact.weight:g}"
        yield f"Given up: {waived.fact}{_source(waived.fact)} [{what}]" + (
            ", which goes against" if waived.because else ""
        )
        yield from (f"    {fact.source or 'stated'}: {fact}" for fact in waived.because)
        yield from (f"    {sized}" for sized in waived.sizes)
    for a, b in table.overlapping:
        yield f"Overlap: {a} and {b} could not be placed apart."
    for fact in table.named_otherwise:
        yield f"Note: {fact}{_source(fact)} holds, but the exact word for these two overlapping boxes is another one."
    for fact in table.not_shown:
        yield f"Note: {fact}{_source(fact)} does not hold on this table; no place was found where it does."
    for entry in table.claims:
        if entry.verdict in (ClaimVerdict.VIOLATED, ClaimVerdict.WAIVED):
            yield f"Note: {entry} does not hold on this table; no place was found where it does."
        elif entry.verdict is ClaimVerdict.UNDECIDABLE:
            yield f"Note: {entry.claim} is not shown: {entry.measured}."
    if not table.finished:
        yield "Note: time limit reached before everything was in its best place; all firm facts hold."


def _held_line(held: int, total: int, noun: str = "fact") -> str:
    """Return how many of the stated facts or claims hold."""
    if total == 0:
        return f"The script states no {noun}s."
    if total == 1:
        return f"The only {noun} holds." if held else f"The only {noun} does not hold."
    words = share(held, total, noun)
    return f"{words[0].upper()}{words[1:]} {'holds' if held == 1 or words.startswith('neither') else 'hold'}."


def _cm(metres: float) -> str:
    return f"{100 * metres:.1f}"


def _source(fact: Fact) -> str:
    return f" ({fact.source})" if fact.source else ""


def _none_lines(none: NoTable) -> Iterator[str]:
    if none.sizes:
        yield violation("There is no such table with things of usual size: these cannot all hold.")
    else:
        reason = f": {none.reason}" if none.reason else ""
        yield violation(f"There is no such table with things of any size{reason}.")
    yield from (violation(f"    {fact.source or 'stated'}: {fact}") for fact in none.facts)
    yield from (violation(f"    {sized}") for sized in none.sizes)
    if not none.minimal:
        yield "Time limit reached before it was known whether all of these are needed."
    elif none.sizes:
        yield "Leaving out any one of these makes a table possible; --any-size allows unusual sizes."
    else:
        yield "Leave out or change any one of these."


def imagination_to_dict(found: Imagination) -> dict[str, Any]:
    """Return imagined tables as plain data: ``tables``, each with its scene, or ``conflict``.

    Parameters
    ----------
    found
        Answer of ``deixis imagine``.

    Returns
    -------
    dict
        Data for JSON with the keys ``decided``, ``tables`` and ``conflict``, which is None unless no table is possible.
    """
    return {
        "decided": found.decided,
        "tables": [_table_to_dict(table) for table in found.tables],
        "conflict": found.none
        and {
            "facts": _facts(found.none.facts),
            "sizes": _sizes(found.none.sizes),
            "minimal": found.none.minimal,
            "reason": found.none.reason,
        },
    }


def _table_to_dict(table: ImaginedTable) -> dict[str, Any]:
    return {
        "scene": scene_to_dict(table.scene),
        "kinds": {sized.name: sized.kind.name if sized.kind else None for sized in table.objects},
        "facts": {"stated": len(table.holds) + len(table.waived), "satisfied": len(table.holds)},
        "given_up": [
            {**fact_to_dict(w.fact), "because": _facts(w.because), "sizes": _sizes(w.sizes)} for w in table.waived
        ],
        "overlapping": [list(pair) for pair in table.overlapping],
        "named_otherwise": _facts(table.named_otherwise),
        "not_shown": _facts(table.not_shown),
        "claims": [claim_outcome_to_dict(entry) for entry in table.claims],
        "finished": table.finished,
    }


def _facts(facts: Iterable[Fact]) -> list[dict[str, Any]]:
    return [fact_to_dict(fact) for fact in facts]


def _sizes(sizes: Iterable[Sized]) -> list[dict[str, Any]]:
    return [
        {
            "object": sized.name,
            "kind": sized.kind.name if sized.kind else None,
            "outline": sized.size.outline.value,
            "length": _range(sized.size.length),
            "width": _range(sized.size.width),
        }
        for sized in sizes
    ]


def _range(extent: Extent) -> list[float]:
    return [extent.least, extent.greatest]
