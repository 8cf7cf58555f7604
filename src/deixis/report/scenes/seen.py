"""Perceived, taught and recognised things as lines of text and as plain data for JSON."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from deixis.answers import count
from deixis.report.marks import doubt

if TYPE_CHECKING:
    from deixis.learning.views.views import Recognised, Taught
    from deixis.perception.recognition.recogniser import Candidate, Recognition
    from deixis.perception.scene import Scene


def scene_lines(scene: Scene) -> list[str]:
    """Return a line for each object: its id, the sides of its box and the place of its centre.

    Parameters
    ----------
    scene
        Scene in pixels or metres.

    Returns
    -------
    list of str
        Lines in pixels, or in centimetres for a scene in metres; one sentence for a scene without objects.
    """
    unit, scale, digits = ("px", 1, 0) if scene.unit == "px" else ("cm", 100, 1)
    lines = []
    for thing in scene.objects:
        low, high = ([scale * value for value in corner] for corner in (thing.minimum, thing.maximum))
        sides = " x ".join(f"{b - a:.{digits}f}" for a, b in zip(low, high, strict=True))
        x, y = ((low[k] + high[k]) / 2 for k in (0, 1))
        lines.append(f"{thing.id:<5} {sides:>20} {unit} at {x:6.{digits}f}, {y:6.{digits}f}")
    return lines or ["Nothing was found."]


_SHOWN = {
    "table": "The cloud shows a table.",
    "tables": "The cloud shows several tables; only one was examined (--table).",
    "object": "The cloud shows one object, without a table.",
    "room": "The cloud shows a room.",
    "nothing": "The cloud shows neither a table nor an object.",
}


def shows_line(shows: str) -> str:
    """Return the kind of scene that a cloud shows, as a sentence.

    Parameters
    ----------
    shows
        Kind of scene: ``table``, ``tables``, ``object``, ``room`` or ``nothing``.

    Returns
    -------
    str
        Sentence for the terminal.
    """
    return _SHOWN[shows]


def taught_line(taught: Taught, name: str) -> str:
    """Return the category of a taught view, and how many views the category now has.

    Parameters
    ----------
    taught
        Result of teaching a view.
    name
        Id of the object in its scene.

    Returns
    -------
    str
        Sentence for the terminal; it names the earlier category of a corrected view.
    """
    corrected = f", no longer of '{taught.before}'" if taught.before else ""
    return f"{name} is a view of '{taught.category}'{corrected}; {count(taught.views, 'view')} in all."


def taught_to_dict(taught: Taught) -> dict[str, Any]:
    """Return a taught view as plain data.

    Parameters
    ----------
    taught
        Result of teaching a view.

    Returns
    -------
    dict
        Data for JSON with the keys ``view``, ``category``, ``views`` and ``before``.
    """
    return {"view": taught.view, "category": taught.category, "views": taught.views, "before": taught.before}


def taught_lines(taught: Taught) -> list[str]:
    """Return a line about a taught view, without the id of its object, which the view does not have.

    Parameters
    ----------
    taught
        Result of teaching a view.

    Returns
    -------
    list of str
        One line: the category, the earlier category of a corrected view, and the number of views.
    """
    summary = taught.summary()
    return [f"{summary[0].upper()}{summary[1:]}."]


def meant_lines(given: str, known: str) -> list[str]:
    """Return a line that names the category of a word where their spelling differs by case.

    Parameters
    ----------
    given
        Category as the user wrote it.
    known
        Category as the memory spells it.

    Returns
    -------
    list of str
        One line; none where the spellings are equal.
    """
    return [] if given == known else [f"'{given}' is read as '{known}', which differs only by case."]


MAX_NAMES = 3
"""Maximum number of candidates in a line."""

MIN_LISTED = 0.05
"""Minimum probability at which a candidate is listed."""


def recognised_lines(found: Recognised, why: bool = False) -> list[str]:
    """Return a line for each object that has a cloud: its id, its label and probability, and other candidates.

    With ``why``, each line is followed by the reasons for the label, and by the distances of the candidates. An object
    that was compared with no view has its reason in its line.

    Parameters
    ----------
    found
        Answer of ``deixis recognise``.
    why
        True to add the reasons and distances.

    Returns
    -------
    list of str
        The lines, marked as doubt for unknown things; one sentence if no object has a cloud.
    """
    width = max((len(name) for name in found.answers), default=0)
    lines: list[str] = []
    for name, answer in found.answers.items():
        line = f"{name:<{max(width, 5)}} {answer_words(answer)}"
        line = line if answer.candidates else f"{line}   {'; '.join(answer.reasons)}"
        lines.append(doubt(line, answer.label is None))
        if why and answer.candidates:
            lines += [f"      {reason}" for reason in answer.reasons]
            lines += [_distances_line(candidate) for candidate in answer.candidates[:MAX_NAMES]]
    return lines or ["No object in this scene has a cloud; recognise a scene that 'deixis perceive -o' wrote."]


def _distances_line(candidate: Candidate) -> str:
    """Return the probability of a candidate, and the distances of equations 2 and 4 behind it."""
    views = f"{candidate.views} view" + ("" if candidate.views == 1 else "s")
    if candidate.nearest is None:
        return f"      {candidate.category:<20} {candidate.probability:.2f}   no comparable view among {views}"
    distances = f"ND {candidate.normalised:.3g}, D_C {candidate.distance:.3g}"
    return f"      {candidate.category:<20} {candidate.probability:.2f}   {distances}, {views}"


def answer_words(answer: Recognition) -> str:
    """Return a label and its probability.

    Without a label, return what the thing may be, most probable first: its candidates, the first of them with a
    question mark if it is more probable than ``unknown``, and ``unknown``, the case of no known category.

    Parameters
    ----------
    answer
        Recognition of one object.

    Returns
    -------
    str
        Label and its probability, or at most :data:`MAX_NAMES` candidates and ``unknown`` with theirs.
    """
    if answer.label is not None or not answer.candidates:
        return f"{answer.label or 'unknown':<20} {answer.probability:.2f}"
    listed = [(one.probability, one.category) for one in answer.candidates[:MAX_NAMES] if one.probability >= MIN_LISTED]
    ranked = sorted([*listed, (answer.unknown, "unknown")], key=lambda pair: -pair[0])
    (probability, first), rest = ranked[0], ranked[1:]
    name = first if first == "unknown" else f"{first}?"
    return f"{name:<20} {probability:.2f}" + "".join(f", {other} {value:.2f}" for value, other in rest)


def recognised_to_dict(found: Recognised) -> dict[str, Any]:
    """Return the label of each thing, its probability, and the distances behind it.

    The probabilities of the candidates and of ``unknown``, the case of no known category, sum to 1. A thing has a
    label where its probability is at least ``min_probability``.

    Parameters
    ----------
    found
        Answer of ``deixis recognise``.

    Returns
    -------
    dict
        Data for JSON with a list ``objects``. Probabilities are rounded to 6 digits.
    """
    from deixis.perception.recognition.settings import MIN_LABEL_PROBABILITY

    return {
        "objects": [
            {
                "id": id,
                "label": answer.label,
                "probability": round(answer.probability, 6),
                "unknown": round(answer.unknown, 6),
                "min_probability": MIN_LABEL_PROBABILITY,
                "reasons": list(answer.reasons),
                "candidates": [_candidate(candidate) for candidate in answer.candidates],
            }
            for id, answer in found.answers.items()
        ]
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    finite = math.isfinite(candidate.distance)
    return {
        "category": candidate.category,
        "D_C": round(candidate.distance, 6) if finite else None,
        "ICD": None if candidate.spread.width.icd is None else round(candidate.spread.width.icd, 6),
        "divisor": round(candidate.spread.value, 6),
        "divisor_from": candidate.spread.source,
        "ND": round(candidate.normalised, 6) if finite else None,
        "nearest": candidate.nearest,
        "views": candidate.views,
        "probability": round(candidate.probability, 6),
    }
