"""Write grounded and recognised activities as lines of text and plain data."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.reasoning.activities.grounding import ActivityGrounding, RecognisedActivity


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
