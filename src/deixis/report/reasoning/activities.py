"""Write grounded, recognised and predicted activities as lines of text and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.reasoning.activities.prediction import TABLE
from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.reasoning.activities.grounding import ActivityGrounding, RecognisedActivity
    from deixis.reasoning.activities.prediction import Prediction


def grounded_lines(found: ActivityGrounding) -> Iterator[str]:
    """Yield a line for each step, each pair in another order, and the fluents that match no step.

    Parameters
    ----------
    found
        Answer of ``deixis activity ground``.

    Yields
    ------
    str
        A line of text.
    """
    width = max((len(str(match.step)) for match in found.matches), default=0)
    for match in found.matches:
        if match.fluent is None:
            yield doubt(f"{match.step!s:<{width}}  missing, probability {match.probability:.2f}")
        else:
            yield f"{match.step!s:<{width}}  {match.fluent}, probability {match.probability:.2f}"
    for first, second in found.swapped:
        yield doubt(f"{second} came before {first}")
    if found.other:
        yield f"no step: {', '.join(found.other)}"


def grounded_to_dict(found: ActivityGrounding) -> dict[str, Any]:
    """Return a grounded activity as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis activity ground``.

    Returns
    -------
    dict
        The object that ``deixis activity ground --json`` prints.
    """
    return {
        "activity": found.activity,
        "steps": [
            {"step": str(match.step), "fluent": match.fluent, "probability": match.probability}
            for match in found.matches
        ],
        "missing": [str(step) for step in found.missing],
        "swapped": [[str(first), str(second)] for first, second in found.swapped],
        "other": list(found.other),
        "evidence": found.evidence,
    }


def recognised_lines(found: RecognisedActivity) -> Iterator[str]:
    """Yield the known activities with their probabilities, and the steps of the most probable one.

    Parameters
    ----------
    found
        Answer of ``deixis activity recognise``.

    Yields
    ------
    str
        A line of text.
    """
    for name, probability in found.probabilities:
        yield f"{name or 'none of them'}: probability {probability:.2f}"
    if found.grounding is not None:
        yield from grounded_lines(found.grounding)


def recognised_to_dict(found: RecognisedActivity) -> dict[str, Any]:
    """Return a recognised activity as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis activity recognise``.

    Returns
    -------
    dict
        The object that ``deixis activity recognise --json`` prints.
    """
    return {
        "activity": found.name,
        "probabilities": [{"activity": name, "probability": share} for name, share in found.probabilities],
        "grounding": None if found.grounding is None else grounded_to_dict(found.grounding),
    }


def predicted_lines(found: Prediction) -> Iterator[str]:
    """Yield a line for each thing that may be laid next, with its place, and one for the end.

    Parameters
    ----------
    found
        Answer of ``deixis activity predict``.

    Yields
    ------
    str
        A line of text.
    """
    for thing in found.things:
        where = ""
        if thing.place is not None:
            (x, y), (dx, dy) = thing.place.place, thing.place.offset
            where = f", at ({x:.2f}, {y:.2f}) m, within {100 * thing.place.spread:.0f} cm"
            if thing.place.anchor != TABLE:
                where += f": ({dx:+.2f}, {dy:+.2f}) m from the {thing.place.anchor.replace('_', ' ')}"
        yield f"{thing.kind.replace('_', ' ')}: probability {thing.probability:.2f}{where}"
    yield f"nothing more: probability {found.finished:.2f}"


def predicted_to_dict(found: Prediction) -> dict[str, Any]:
    """Return a prediction as plain data.

    Parameters
    ----------
    found
        Answer of ``deixis activity predict``.

    Returns
    -------
    dict
        The object that ``deixis activity predict --json`` prints.
    """
    return {
        "activity": found.activity,
        "laid": list(found.laid),
        "next": [
            {
                "kind": thing.kind,
                "probability": thing.probability,
                "place": None
                if thing.place is None
                else {
                    "at": list(thing.place.place),
                    "spread": thing.place.spread,
                    "anchor": thing.place.anchor,
                    "offset": list(thing.place.offset),
                },
            }
            for thing in found.things
        ],
        "finished": found.finished,
    }


def grounded_rows(found: ActivityGrounding) -> Iterator[dict[str, Any]]:
    """Yield a row for each step.

    Parameters
    ----------
    found
        Answer of ``deixis activity ground``.

    Yields
    ------
    dict
        ``step``, its ``fluent`` (None if it is missing) and ``probability``.
    """
    yield from grounded_to_dict(found)["steps"]


def recognised_rows(found: RecognisedActivity) -> Iterator[dict[str, Any]]:
    """Yield a row for each known activity, and one for none of them.

    Parameters
    ----------
    found
        Answer of ``deixis activity recognise``.

    Yields
    ------
    dict
        ``activity`` (None for none of them) and ``probability``.
    """
    yield from recognised_to_dict(found)["probabilities"]


def predicted_rows(found: Prediction) -> Iterator[dict[str, Any]]:
    """Yield a row for each thing that may be laid next, and one for the end.

    Parameters
    ----------
    found
        Answer of ``deixis activity predict``.

    Yields
    ------
    dict
        ``kind`` (None for nothing more), ``probability``, and the place as ``x``, ``y`` and ``spread`` in metres, which
        are None if it is unknown.
    """
    for thing in found.things:
        x, y = (None, None) if thing.place is None else thing.place.place
        spread = None if thing.place is None else thing.place.spread
        yield {"kind": thing.kind, "probability": thing.probability, "x": x, "y": y, "spread": spread}
    yield {"kind": None, "probability": found.finished, "x": None, "y": None, "spread": None}
