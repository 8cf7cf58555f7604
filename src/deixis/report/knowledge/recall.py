"""Write answers to questions about then and now as lines of text and plain data."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.reasoning.temporal.bounds import Bounds
    from deixis.workflows.knowledge.recall_answer import Recall, Recalled


def recall_lines(found: Recall) -> Iterator[str]:
    """Yield the answer in a sentence.

    Parameters
    ----------
    found
        Answer of ``deixis recall``.

    Yields
    ------
    str
        The line.
    """
    yield found.answer if found.known else doubt(found.answer)


def recall_to_dict(found: Recall) -> dict[str, Any]:
    """Return an answer as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis recall``.

    Returns
    -------
    dict
        The object that ``deixis recall --json`` prints.
    """
    return {
        "question": found.question.text,
        "known": found.known,
        "answer": found.answer,
        "reason": found.reason,
        "facts": [_fact(found, fact) for fact in found.facts],
        "sparql": None if found.search is None else found.search.sparql(),
    }


def _fact(found: Recall, fact: Recalled) -> dict[str, Any]:
    fluent, statement = fact.fluent, fact.fluent.statement
    return {
        "fluent": fluent.id,
        "subject": statement.subject,
        "name": fact.name,
        "predicate": statement.predicate,
        "object": statement.object,
        "other": fact.other,
        "start": _bounds(found, fluent.start),
        "finish": _bounds(found, fluent.finish),
        "certainty": fluent.certainty,
        "times_known": fact.certainly,
        "source": {"origin": fluent.source.origin.value, "by": fluent.source.by, "event": fluent.source.event},
    }


def _bounds(found: Recall, bounds: Bounds) -> dict[str, Any]:
    ends = (bounds.lower, bounds.upper)
    moments = [found.moment(end) for end in ends]
    return {
        "seconds": [None if math.isinf(end) else end for end in ends],
        "time": [None if moment is None else moment.isoformat() for moment in moments],
    }


def recall_rows(found: Recall) -> Iterator[dict[str, Any]]:
    """Yield a row for each fluent that the answer rests on.

    Parameters
    ----------
    found
        Answer of ``deixis recall``.

    Yields
    ------
    dict
        The ``fluent`` with its ``subject``, its ``name``, ``predicate``, ``object`` and ``other``, the bounds of its
        start and finish in seconds (None for no bound), its ``certainty``, and ``origin`` and ``by`` of its source.
    """
    for fact in recall_to_dict(found)["facts"]:
        row = {key: fact[key] for key in ("fluent", "subject", "name", "predicate", "object", "other")}
        for end in ("start", "finish"):
            row[f"earliest_{end}"], row[f"latest_{end}"] = fact[end]["seconds"]
        yield row | {"certainty": fact["certainty"], "origin": fact["source"]["origin"], "by": fact["source"]["by"]}
