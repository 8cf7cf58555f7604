"""Rules about where things go, and placements, as lines of text, plain data and rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.reasoning.habits.habits import Placement
    from deixis.workflows.knowledge.habits import Placements

SURE = 0.8
"""Probability below which the alternatives of a place are printed."""


def habits_lines(found: Placements) -> Iterator[str]:
    """Yield the rules with the examples that they explain, the exceptions, and a line for each placed thing.

    Parameters
    ----------
    found
        Answer of ``deixis habits``.

    Yields
    ------
    str
        The rules with their probabilities or *stated*, the exceptions, then the placements.
    """
    width = max((len(_words(rule.concept, rule.other)) for rule in found.rules), default=0) + 1
    for rule in found.rules:
        why = "stated" if rule.stated else f"probability {rule.probability:.2f}"
        seen = f"; {', '.join(rule.examples)}" if rule.examples else ""
        yield f"{_words(rule.concept, rule.other) + ':':<{width}} {rule.place}  ({why}{seen})"
    for placement in found.exceptions:
        yield f"{placement.thing}: {placement.place}  (no rule explains this example)"
    if not found.rules:
        yield doubt("No rule explains the examples in fewer words than the examples themselves.")
    if found.things:
        yield ""
    for placement in found.things:
        yield _line(placement)


def _words(concept: str, other: bool) -> str:
    return f"other {concept}" if other else concept


def _line(placement: Placement) -> str:
    line = f"{placement.thing}: {placement.place}, probability {placement.probability:.2f}"
    if placement.because == "example":
        return f"{placement.thing}: {placement.place}, as in the examples"
    if placement.because is not None:
        line += f", by the rule about {placement.because}"
    if not placement.known:
        line += "; the lexicon does not know it, so its words alone count"
    if placement.probability < SURE:
        others = ", ".join(f"{place} {share:.2f}" for place, share in placement.alternatives[1:3])
        return doubt(f"{line}; else {others}") if others else doubt(line)
    return line


def habits_to_dict(found: Placements) -> dict[str, Any]:
    """Return the places, the rules, the exceptions and the placements.

    Parameters
    ----------
    found
        Answer of ``deixis habits``.

    Returns
    -------
    dict
        Data for JSON with the keys ``places``, ``rules``, ``exceptions`` (place by thing) and ``things``. Probabilities
        are rounded to 6 digits.
    """
    return {
        "places": list(found.places),
        "rules": [
            {
                "concept": rule.concept,
                "other": rule.other,
                "place": rule.place,
                "probability": round(rule.probability, 6),
                "examples": list(rule.examples),
                "stated": rule.stated,
            }
            for rule in found.rules
        ],
        "exceptions": {placement.thing: placement.place for placement in found.exceptions},
        "things": [_placement(placement) for placement in found.things],
    }


def habits_rows(found: Placements) -> list[dict[str, Any]]:
    """Return a row for each placed thing.

    Parameters
    ----------
    found
        Answer of ``deixis habits``.

    Returns
    -------
    list of dict
        Rows without the alternatives of a placement: that column is None.
    """
    return [{**_placement(placement), "alternatives": None} for placement in found.things]


def _placement(placement: Placement) -> dict[str, Any]:
    return {
        "thing": placement.thing,
        "place": placement.place,
        "probability": round(placement.probability, 6),
        "alternatives": [{"place": place, "probability": round(p, 6)} for place, p in placement.alternatives],
        "because": placement.because,
        "known": placement.known,
    }
